#!/usr/bin/python3
"""The Debian package on a clean Debian 12: installed, used by newcomers (tests/newcomer), and removed.

    tests/python/test_clean_root.py BUILD_FOLDER [ROOT]

Makes a minimal root with debootstrap, or takes a copy of the one that is given, and works in it by chroot. The mirror is that of
the machine. Where there is no debootstrap, no root or no network, one sentence says so and the status is 77."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from package import ROOT, environment, make_package, run

CODENAME = "bookworm"
SKIPPED = 77
# What the people of tests/newcomer have installed besides Talus.
COMPILER = ("cmake", "make", "gcc", "libc6-dev", "pkg-config")


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def mirror():
    """Where the machine's apt gets Debian 12 from."""
    lines = run(["apt-get", "indextargets", "--format", "$(CODENAME) $(COMPONENT) $(CREATED_BY) $(SITE)"]).stdout.splitlines()
    sites = [line.split()[3] for line in lines if line.split()[:3] == [CODENAME, "main", "Packages"]]
    if not sites:
        skip(f"this machine's apt knows no mirror of Debian {CODENAME}")
    return sites[0]


def check_machine(folder):
    if os.geteuid() != 0:
        skip("only root can make a root")
    for program in ("debootstrap", "apt-get", "dpkg-shlibdeps"):
        if not shutil.which(program):
            skip(f"there is no {program}")
    site = mirror()
    told = run(["/usr/lib/apt/apt-helper", "download-file", f"{site}/dists/{CODENAME}/InRelease", folder / "InRelease"], check=False)
    if told.returncode:
        skip("the mirror of Debian cannot be reached")
    return site


class Root:
    """A root folder and what is run in it."""

    def __init__(self, path):
        self.path = path

    def make(self, site, given):
        if given:
            run(["cp", "-a", given, self.path])
        else:
            done = run(["debootstrap", "--variant=minbase", CODENAME, self.path, site], check=False)
            if done.returncode:
                sys.exit(f"debootstrap: status {done.returncode}\n{done.stdout[-3000:]}{done.stderr}")
        apt = self.path / "etc/apt"
        (apt / "sources.list").write_text(f"deb {site} {CODENAME} main\n")
        settings = run(["apt-config", "dump", "--format", "%F \"%v\";%n", "Acquire"]).stdout
        (apt / "apt.conf.d/99machine").write_text("".join(
            line + "\n" for line in settings.splitlines() if re.match(r"Acquire::https?::(Proxy|Timeout)", line, re.I)))
        shutil.copy("/etc/resolv.conf", self.path / "etc/resolv.conf")

    def __enter__(self):
        """A program finds its own place by /proc."""
        if run(["mount", "-t", "proc", "proc", self.path / "proc"], check=False).returncode:
            skip("this machine does not let /proc be mounted")
        return self

    def __exit__(self, *_):
        run(["umount", self.path / "proc"])

    def go(self, *command, check=True, cwd="/", **variables):
        plain = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LANG": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive"}
        proxies = {name: value for name, value in environment().items() if name.lower().endswith("_proxy")}
        done = subprocess.run(["chroot", str(self.path), "env", "-C", cwd, *map(str, command)], capture_output=True, text=True,
                              check=False, stdin=subprocess.DEVNULL, env={**plain, **proxies, **variables})
        if check and done.returncode:
            sys.exit(f"in the root: {' '.join(map(str, command))}: status {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
        return done

    def newcomer(self, name):
        work = self.path / "root" / name
        work.mkdir()
        shutil.copy(ROOT / "tests/newcomer" / f"{name}.sh", work.parent)
        self.go("sh", "-eu", f"/root/{name}.sh", cwd=f"/root/{name}", PREFIX="/usr")
        print(f"{name}: done", flush=True)


def install(root, package):
    """As a person does it: dpkg names what is missing, apt gets it."""
    shutil.copy(package, root.path / "root")
    root.go("apt-get", "-qq", "update")
    told = root.go("dpkg", "-i", f"/root/{package.name}", check=False)
    assert told.returncode == 1 and "talus depends on " in told.stderr and "warning" not in told.stderr, told
    root.go("apt-get", "-qq", "-y", "--no-install-recommends", "--fix-broken", "install")
    status = root.go("dpkg-query", "-W", "-f", "${Status}", "talus").stdout
    assert status == "install ok installed", status
    assert not root.go("dpkg", "--audit").stdout
    assert "libtalus.so" in root.go("ldconfig", "-p").stdout
    version = root.go("talus", "--version").stdout
    assert version.startswith("Talus "), version
    print(f"installed: {version.splitlines()[0]}", flush=True)


def remove(root):
    files = root.go("dpkg-query", "-L", "talus").stdout.split("\n")
    own = [name for name in files if "talus" in name]
    assert len(own) > 50, own
    root.go("dpkg", "--purge", "talus")
    left = [name for name in own if os.path.lexists(root.path / name.lstrip("/"))]
    assert not left, left
    assert "libtalus" not in root.go("ldconfig", "-p").stdout


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        site = check_machine(folder)
        package = make_package(build, folder)
        root = Root(folder / "root")
        root.make(site, sys.argv[2] if len(sys.argv) > 2 else None)
        with root:
            install(root, package)
            root.newcomer("scenario_writer")  # before there is a compiler
            root.go("apt-get", "-qq", "-y", "--no-install-recommends", "install", *COMPILER)
            for script in sorted((ROOT / "tests/newcomer").glob("*.sh")):
                if script.stem != "scenario_writer":
                    root.newcomer(script.stem)
            remove(root)
    print("the package serves newcomers on a clean root")


if __name__ == "__main__":
    main()
