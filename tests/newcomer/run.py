#!/usr/bin/python3
"""The first ten minutes of a person who has installed Talus.

    tests/newcomer/run.py BUILD_FOLDER SCRIPT.sh

Installs the build, moves the folder, and runs the script in an empty folder with nothing but the installed program in PATH,
as somebody would who knows the pages only. The script ends at the first command that fails; what it must see it asks for
itself."""
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from package import install  # noqa: E402


def main():
    build, script = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prefix = install(build, folder)
        work = folder / "work"
        work.mkdir()
        environment = {"PATH": f"{prefix}/bin:{os.environ['PATH']}", "HOME": str(work), "LANG": "C.UTF-8", "PREFIX": str(prefix)}
        done = subprocess.run(["sh", "-eu", str(script)], cwd=work, env=environment, check=False, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        print(f"{script.name} ended with status {done.returncode}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
