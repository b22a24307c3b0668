"""What the tests of an installed Talus share: a prefix that has been moved, and running things in it."""
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What the build and the developer's shell may have set and a user has not.
FOREIGN = ("TALUS_", "LUA_", "CMAKE_", "PKG_CONFIG", "LD_LIBRARY_PATH", "LD_PRELOAD", "ASAN_OPTIONS")


def environment(**variables):
    plain = {name: value for name, value in os.environ.items() if not name.startswith(FOREIGN)}
    return {**plain, **variables}


def run(command, cwd=None, check=True, **variables):
    """The output of a command, both streams; ends the test when the command fails."""
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True, check=False,
                          stdin=subprocess.DEVNULL, env=environment(**variables))
    if check and done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def install(build, folder):
    """Installs a build and moves it: the prefix in `folder` that nothing was told of."""
    first, prefix = folder / "first", folder / "moved here"
    run(["cmake", "--install", build, "--prefix", first])
    shutil.move(first, prefix)
    return prefix


def make_package(build, folder):
    """The Debian package of a build, made in `folder`."""
    run(["cpack", "-G", "DEB", "--config", build / "CPackConfig.cmake", "-B", folder], cwd=folder)
    package, = folder.glob("*.deb")
    return package


def build_project(source, build, prefix, *options):
    """Configures and builds a project against the prefix, as its README says; the compiler's warnings."""
    run(["cmake", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}", *options])
    return run(["cmake", "--build", build]).stderr
