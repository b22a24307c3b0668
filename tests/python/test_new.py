#!/usr/bin/python3
"""`talus new` and `talus check`, from an installed Talus whose folder has been moved.

    tests/python/test_new.py BUILD_FOLDER

Each template is written under the name it has in docs/writing_a_plugin.md, whose code and output it must have; is built as
its README says, without a warning; passes its own tests; and is found once installed. What `talus new` cannot do it
says, and leaves nothing behind."""
import pathlib
import re
import shutil
import sys
import tempfile

from package import ROOT, build_project, install, run

PAGE = (ROOT / "docs/writing_a_plugin.md").read_text(encoding="utf-8")
STRICT = "-DCMAKE_C_FLAGS=-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror"
KINDS = {"law": "weakening", "damping": "drag", "generator": "bricks", "solid": "putty"}

faults = []


def expect(holds, what):
    if not holds:
        faults.append(what)


def words(text):
    """Text without regard to where lines end, which goes with the length of names."""
    return re.sub(r"[\s*]+", " ", text)


def shown(name, language):
    """The page's block of that file."""
    for block in re.findall(rf"```{language}\n(.*?)```", PAGE, re.S):
        if re.match(rf"\W* (test_)?{name}\.", block):
            return block
    return ""


def check_project(prefix, folder, kind, name):
    program = prefix / "bin/talus"
    said = run([program, "new", kind, name], cwd=folder).stdout
    made = folder / name
    expect(f"-DCMAKE_PREFIX_PATH='{prefix}'\n" in said, f"new {kind}: {said}")
    files = sorted(path.name for path in made.iterdir())
    expect(files == sorted(["CMakeLists.txt", f"{name}.c", f"test_{name}.lua", "README.md"]), f"{name}: {files}")
    for path in made.iterdir():
        text = path.read_text(encoding="utf-8")
        expect("my_" not in text, f"{path.name} speaks of the template")
        expect(path.suffix != ".md" or text.startswith(f"# {name}\n"), f"{path.name}: {text[:40]}")
    for file, language in ((f"{name}.c", "c"), (f"test_{name}.lua", "lua")):
        expect(words((made / file).read_text(encoding="utf-8")) == words(shown(name, language)),
               f"docs/writing_a_plugin.md shows another {file} than the template of a {kind}")

    warnings = build_project(made, made / "build", prefix, STRICT)
    expect("warning" not in warnings, f"{name}: {warnings}")
    tests = run(["ctest", "--test-dir", made / "build", "--output-on-failure", "--no-tests=error"]).stdout
    expect("100% tests passed, 0 tests failed out of 2" in tests, f"{name}: {tests}")
    plugin = made / "build" / f"{name}.so"
    told = run([program, "check", plugin]).stdout
    expect(told.endswith(" checks, 0 faults\n") and f"{kind} '{name}'" in told, f"{name}: {told}")
    printed = run([program, "--plugin", plugin, made / f"test_{name}.lua"]).stdout
    expect(not (lines := [line for line in printed.splitlines() if kind != "generator" and line not in PAGE]),
           f"{name}: the page does not show {lines}")

    run(["cmake", "--install", made / "build"])
    text = run([program, "help", name]).stdout
    expect(text.startswith(f"{kind} '{name}'"), f"{name}, installed: {text}")


def check_refusals(prefix, folder):
    program = prefix / "bin/talus"
    (folder / "taken").mkdir()
    cases = [(["new"], "usage"), (["new", "law"], "usage"), (["new", "spring", "x"], "'spring' is not law, damping"),
             (["new", "law", "My-Law"], "small letters"), (["new", "law", "2nd"], "begin with a letter"),
             (["new", "law", "x" * 61], "up to 60"), (["new", "law", "test"], "means something else"),
             (["new", "law", "coulomb"], "a law 'coulomb' is there already"),
             (["new", "law", "x", "taken"], "the folder taken cannot be made: File exists"),
             (["new", "law", "x", "no/such/folder"], "No such file or directory"), (["new", "law", "x", ""], "empty"),
             (["check"], "usage"), (["check", "none.so"], "none.so"), (["check", "none.so", "friction"], "not NAME=VALUE")]
    for arguments, sentence in cases:
        done = run([program, *arguments], cwd=folder, check=False)
        expect(done.returncode == 1 and sentence in done.stderr, f"talus {' '.join(arguments)}: {done.stdout}{done.stderr}")
    done = run([program, "check", "none.so"], cwd=folder, check=False)
    expect("NAME=VALUE" not in done.stderr, f"a file that is not there is no matter of values: {done.stderr}")
    expect(not list((folder / "taken").iterdir()) and not (folder / "x").exists(), "something is left of what was refused")

    templates = prefix / "share/talus/templates/law"
    (templates / "README.md").rename(templates / "away")
    done = run([program, "new", "law", "halfway"], cwd=folder, check=False)
    expect(done.returncode == 1 and "README.md cannot be read" in done.stderr, f"a lost template: {done.stderr}")
    expect(not (folder / "halfway").exists(), "half a folder is left")
    (templates / "away").rename(templates / "README.md")


def check_a_fault(build, prefix):
    """The exit status tells that a check has found something."""
    done = run([prefix / "bin/talus", "check", build / "bad_plugins/unfit.so", "law_fault=softer", "damping_fault=none",
                "generator_fault=none", "screen_fault=none", "kn=1e8"], check=False)
    expect(done.returncode == 1 and done.stdout.endswith("47 checks, 1 fault\n"), f"a fault: {done.stdout}{done.stderr}")
    expect("FAULT  stiffness" in done.stdout and "kn = 1e+08" in done.stdout, f"a fault: {done.stdout}")
    expect(done.stdout.count("\n  ok ") == 46, f"a fault: {done.stdout}")


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prefix = install(build, folder)
        for kind, plugin in KINDS.items():
            check_project(prefix, folder, kind, plugin)
        check_refusals(prefix, folder)
        check_a_fault(build, prefix)
        shutil.rmtree(prefix)
    print("\n".join(faults) or "new plugins are ready to be changed")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
