#!/usr/bin/python3
"""The Debian package: unpacked into a folder, it runs there; it depends on what its files need; its pages belong together.

    tests/python/test_deb.py BUILD_FOLDER

Also: the version stands in one place, and the manual page knows the words of the program."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from package import ROOT, build_project, make_package, run

faults = []


def expect(holds, what):
    if not holds:
        faults.append(what)


def version():
    return re.search(r"^project\(talus VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"), re.M)[1]


def check_one_version():
    """What tells the version is made from project() in CMakeLists.txt."""
    pattern = re.compile(rf"(?<![\d.]){re.escape(version())}(?![\d.])")
    for path in sorted(ROOT.rglob("*")):
        parts = path.relative_to(ROOT).parts
        if parts[0] in ("build", "out", ".git") or "__pycache__" in parts or not path.is_file():
            continue
        if path.suffix in (".c", ".h", ".lua", ".py", ".md", ".in", ".cmake", ".txt", ".json", "") and parts != ("CMakeLists.txt",):
            for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
                expect(not pattern.search(line), f"{'/'.join(parts)}:{number} names the version: {line.strip()}")


def pack(build, folder):
    package = make_package(build, folder)
    expect(re.fullmatch(rf"talus_{re.escape(version())}_\w+\.deb", package.name), package.name)
    run(["dpkg-deb", "-x", package, folder / "root"])
    return package, folder / "root/usr"


def check_dependencies(package, usr):
    """Each library that a file needs is found, is of the package, or of one it depends on."""
    field = run(["dpkg-deb", "-f", package, "Depends"]).stdout
    depends = {word.split()[0] for word in field.split(",")}
    expect({"libc6", "libccd2", "liblua5.4-0", "libedit2"} <= depends, f"Depends: {field}")
    screen = next(usr.rglob("browser.so"), None)
    expect(not screen or "libmicrohttpd12" in depends, f"Depends, with the screen: {field}")
    for path in [usr / "bin/talus", *usr.rglob("*.so*")]:
        if path.is_symlink():
            continue
        for line in run(["ldd", path]).stdout.splitlines():
            expect("not found" not in line, f"{path.name}: {line.strip()}")
            match = re.search(r"=> (/\S+)", line)
            if match:
                owner = owner_of(match[1])
                # a library may come with one that is depended on
                needed = match[1].split("/")[-1] in directly_needed(path)
                expect(not needed or owner in depends, f"{path.name} needs {match[1]} of {owner}, not in Depends: {field}")


def owner_of(path):
    """The package of a file, by the name it was installed under before /lib became a link to /usr/lib."""
    real = os.path.realpath(path)
    for name in (path, real, real.removeprefix("/usr"), "/usr" + path):
        done = run(["dpkg", "-S", name], check=False)
        if done.returncode == 0:
            return done.stdout.split(":")[0]
    return "?"


def directly_needed(path):
    return set(re.findall(r"NEEDED.*\[(.*)\]", run(["readelf", "-d", path]).stdout))


def check_files(package, usr):
    listing = run(["dpkg-deb", "-c", package]).stdout.splitlines()
    for line in listing:
        mode, owner, *_, name = re.sub(r" -> .*", "", line).split()
        expect(owner == "root/root", f"{name} belongs to {owner}")
        expect(mode[0] == "l" or mode[5] != "w" and mode[8] != "w", f"others may write {name}: {mode}")
        expect(name.startswith("./usr/") , f"{name} is outside of /usr")
    for name in ("bin/talus", "lib/libtalus.so", "lib/libtalus.a", "lib/lua/5.4/talus.so", "lib/pkgconfig/talus.pc",
                 "lib/cmake/talus/talusConfig.cmake", "include/talus/talus.h", "share/man/man1/talus.1",
                 "share/doc/talus/copyright", "share/doc/talus/README.md", "share/doc/talus/SECURITY.md",
                 "share/talus/templates/law/my_law.c", "share/talus/examples/quickstart.lua"):
        expect((usr / name).exists(), f"{name} is missing")
    maintainer = run(["dpkg-deb", "-f", package, "Maintainer"])
    expect(re.fullmatch(r"[\w ]+ <[\w.]+@[\w.]+\.\w+>\n", maintainer.stdout) and not maintainer.stderr, f"maintainer: {maintainer.stdout}")
    control = run(["dpkg-deb", "-I", package, "triggers", "shlibs"]).stdout
    soname = re.search(r"SONAME.*\[libtalus\.so\.(.*)\]", run(["readelf", "-d", usr / "lib/libtalus.so"]).stdout)[1]
    expect(control == f"activate-noawait ldconfig\nlibtalus {soname} talus (>= {version()})\n", f"control files: {control}")
    symbols = run(["readelf", "-S", usr / "bin/talus"]).stdout
    expect(".symtab" not in symbols and ".debug_info" not in symbols, "the program is not stripped")
    for path in [usr / "bin/talus", *usr.rglob("*.so")]:
        expect(str(ROOT).encode() not in path.read_bytes(), f"{path.name} names the folder it was built in")


def check_links(doc):
    """Pages link to pages that are there, or to sources, which are in the source tree only."""
    pages = list(doc.rglob("*.md"))
    expect(len(pages) > 10, f"only {len(pages)} pages")
    for page in pages:
        text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for link in re.findall(r"\]\(([^)#\s]+)", text):
            if "://" in link:
                continue
            there = page.parent / link
            if link.startswith(("../core/", "../tests/")):
                there = ROOT / page.parent.relative_to(doc) / link
            expect(there.exists(), f"{page.relative_to(doc)} links to {link}, which is not there")


def check_program(usr, folder):
    """In an environment that knows nothing of Talus, from the folder the package was unpacked into."""
    plain = {"PATH": "/usr/bin:/bin", "HOME": str(folder)}
    work = folder / "work"
    work.mkdir()

    def go(*command):
        done = subprocess.run([str(word) for word in command], cwd=work, env=plain, capture_output=True, text=True, check=False,
                              stdin=subprocess.DEVNULL)
        expect(done.returncode == 0, f"{command}: status {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    expect(go(usr / "bin/talus", "--version").startswith(f"Talus {version()}\n"), "the version")
    plugins = go(usr / "bin/talus", "plugins")
    names = [path.stem for path in (usr / "lib/talus").glob("plugins-*/*.so")]
    expect(names and all(f"talus.{name} " in plugins for name in names if name != "import_solid"), f"plugins: {plugins}")
    expect(f" {version()}" in plugins, f"the plugins' version: {plugins}")
    go(usr / "bin/talus", "--quiet", usr / "share/talus/examples/quickstart.lua")
    expect(any(work.rglob("*.vtk")), "the first example writes no file")
    lua = shutil.which("lua5.4")
    if lua:
        done = subprocess.run([lua, "-e", "print(require('talus').version)"], capture_output=True, text=True, check=False,
                              env={**plain, "LUA_CPATH": f"{usr}/lib/lua/5.4/?.so"})
        expect(done.stdout == version() + "\n", f"a stock Lua: {done.stdout}{done.stderr}")
    build_project(usr / "share/talus/examples/embed", folder / "embedded", usr)
    expect("expected" in run([folder / "embedded/slide", folder / "slide"]).stdout, "a program that embeds it")


def check_manual(usr):
    page = usr / "share/man/man1/talus.1"
    text = page.read_text(encoding="utf-8")
    expect(f'"Talus {version()}"' in text and "@" not in text, "the manual page is not filled in")
    plain = text.replace("\\-", "-")
    overview = run([usr / "bin/talus", "help"]).stdout.split("Functions:")[0]
    words = set(re.findall(r"^  talus ([a-z]+)", overview, re.M)) | set(re.findall(r"(?<= )--?[a-z]+", overview))
    expect(len(words) >= 8, f"only {words} seen in the overview")
    for word in sorted(words):
        expect(re.search(rf"(?<![\w-]){word}(?![\w-])", plain), f"the manual page does not know {word}")
    if shutil.which("groff"):
        done = run(["groff", "-man", "-ww", "-Tutf8", "-z", page])
        expect(not done.stderr, f"groff: {done.stderr}")


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    check_one_version()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        package, usr = pack(build, folder)
        check_files(package, usr)
        check_dependencies(package, usr)
        check_links(usr / "share/doc/talus")
        check_program(usr, folder)
        check_manual(usr)
    print("\n".join(faults) or "the package holds together")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
