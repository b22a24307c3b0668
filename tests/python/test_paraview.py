#!/usr/bin/python3
"""The macros for ParaView (scripts/paraview), run by its own pvpython on a run of the example of a slope.

    tests/python/test_paraview.py BUILD_FOLDER [--root ROOT] [--renew]

Debian's ParaView cannot be installed beside the VTK that other tests use, so it is tried in a minimal root of its own
(test_clean_root.py): ROOT is such a root with ParaView in it; without it one is made. --renew copies the pictures to docs/pictures.
Where that cannot be, one sentence says so and the status is 77."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from package import ROOT
from test_clean_root import Root, check_machine

FRAMES = 12
PACKAGES = ("paraview", "python3-paraview", "xvfb", "xauth", "libgl1-mesa-dri")
MACROS = ("displacement", "moved_blocks", "joints_by_state", "forces", "exploded_view")
SHOWN = ("displacement", "joints", "forces")  # in docs/paraview.md


def write_run(build, folder):
    code = 'package.path = "scripts/?.lua;" .. package.path\nrequire("examples.slope").film(20, math.tointeger(tonumber(arg[2])), arg[1])\n'
    script = folder / "film.lua"
    script.write_text(code)
    subprocess.run([build / "talus", "--quiet", script, folder / "slope", str(FRAMES)], check=True, cwd=ROOT)


def try_macros(root, run):
    place = root.path / "srv" / "paraview"
    shutil.copytree(ROOT / "scripts/paraview", place)
    shutil.copytree(run, place / "run")
    (place / "pictures").mkdir()
    commands = ["pvpython pictures.py run/slope pictures"]
    for macro in MACROS:  # each alone, as the menu runs it
        content = {"joints_by_state": "joints", "forces": "contacts"}.get(macro, "blocks")
        (place / f"{macro}.menu.py").write_text(
            f"from paraview.simple import *\nsource = OpenDataFile('run/slope_{content}.vtk.series')\nShow(source)\n"
            f"GetAnimationScene().GoToLast()\nSetActiveSource(source)\nexec(open('{macro}.py').read())\nprint('{macro}: done')\n")
        commands.append(f"pvpython {macro}.menu.py")
    (place / "all.sh").write_text("set -e\n" + "\n".join(commands) + "\n")
    told = root.go("xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", "sh", "all.sh", cwd=f"/srv/{place.name}").stdout
    made = sorted(path.name for path in (place / "pictures").iterdir())
    assert len(made) == 5 and told.count(" bytes") == 5 and all(f"{macro}: done" in told for macro in MACROS), told
    return place / "pictures"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    given = sys.argv[sys.argv.index("--root") + 1] if "--root" in sys.argv else None
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        site = check_machine(folder)
        run = folder / "run"
        run.mkdir()
        write_run(build, run)
        root = Root(folder / "root")
        root.make(site, given)
        with root:
            if not given:
                root.go("apt-get", "-qq", "update")
                root.go("apt-get", "-qq", "-y", "--no-install-recommends", "install", *PACKAGES)
            pictures = try_macros(root, run)
            if "--renew" in sys.argv:
                for shown in SHOWN:
                    shutil.copy(pictures / f"paraview_{shown}.png", ROOT / "docs/pictures")
    print("the macros for ParaView do what they say")


if __name__ == "__main__":
    os.environ.setdefault("LC_ALL", "C")
    main()
