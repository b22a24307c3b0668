#!/usr/bin/python3
"""Reads the program, the module and the plugins as files, and checks that they are built to resist errors in memory.

    tests/python/test_hardening.py BUILD_FOLDER

What cmake/harden.cmake asks for must be in the files: tables of addresses that are read-only (RELRO, BIND_NOW), no
stack that can be run, no code that is changed on loading, a program that is loaded anywhere, calls of the stack
protector and of the checked functions of the C library, and on x86 the marks of checked jumps. A plugin of a few lines
may have nothing to protect, so of plugins the options of the compiler are looked at instead."""
import json
import pathlib
import platform
import re
import subprocess
import sys
import tempfile


def readelf(path, *options):
    done = subprocess.run(["readelf", "-W", *options, str(path)], capture_output=True, text=True, check=True)
    return done.stdout


def faults(path, program=False, checked=True):
    """What is wrong with one file, as sentences."""
    dynamic, segments = readelf(path, "-d"), readelf(path, "-l")
    if not re.search(r"\bBIND_NOW\b|FLAGS_1.*\bNOW\b", dynamic):
        yield "addresses of functions are bound late: no BIND_NOW"
    if "GNU_RELRO" not in segments:
        yield "the table of addresses stays writable: no RELRO"
    stack = re.search(r"GNU_STACK.*", segments)
    if not stack or "E" in stack.group(0).split()[-2]:
        yield "the stack can be run"
    if "TEXTREL" in dynamic:
        yield "code is changed on loading: TEXTREL"
    if any("RWE" in line for line in segments.splitlines() if line.strip().startswith("LOAD")):
        yield "a segment can be written and run"
    if program and not re.search(r"FLAGS_1.*\bPIE\b", dynamic):
        yield "the program has a fixed address: no PIE"
    if not checked:
        return
    symbols = readelf(path, "--dyn-syms")
    if "__stack_chk_fail" not in symbols:
        yield "no function has a stack protector"
    if not re.search(r"__\w+_chk\b", symbols.replace("__stack_chk", "")):
        yield "no call of the C library is checked: no FORTIFY"


def check_marks(build):
    """Jumps and returns of each object of the kernel are marked (CET). What is linked bears the mark only if the C
    library's own objects do."""
    if platform.machine() != "x86_64":
        return
    archive = build / "libtalus.a"
    objects = readelf(archive, "-n").split("\nFile: ")[1:]
    for text in objects:
        if not re.search(r"x86 feature: .*IBT.*SHSTK", text):
            yield f"{text.splitlines()[0]}: jumps and returns are not marked: no CET"
    if not objects:
        yield f"{archive}: no objects"


def check_the_checks():
    """A file built without any of it must have every fault."""
    with tempfile.TemporaryDirectory() as folder:
        source, made = pathlib.Path(folder) / "a.c", pathlib.Path(folder) / "a"
        source.write_text("int main(void) { return 0; }\n", encoding="utf-8")
        subprocess.run(["cc", "-fno-stack-protector", "-fno-pie", "-no-pie", "-Wl,-z,lazy", "-Wl,-z,norelro",
                        "-Wl,-z,execstack", "-o", str(made), str(source)], check=True, capture_output=True)
        found = " ".join(faults(made, program=True))
    for word in ("BIND_NOW", "RELRO", "run", "PIE", "protector", "FORTIFY"):
        if word not in found:
            yield f"a program without protection passes: {word}"


def check_options(build):
    """Every source of core and plugins is compiled with the options."""
    commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    for entry in commands:
        if not re.search(r"/(core|plugins)/", entry["file"]):
            continue
        for option in ("-fstack-protector-strong", "-D_FORTIFY_SOURCE="):
            if option not in entry["command"]:
                yield f"{entry['file']}: compiled without {option}"


def main():
    build = pathlib.Path(sys.argv[1])
    plugins = sorted((build / "plugins").glob("*.so"))
    found = [*check_the_checks(), *check_options(build), *check_marks(build)]
    for path in [build / "talus", build / "talus.so", *plugins]:
        own = path.parent == build
        found += [f"{path}: {fault}" for fault in faults(path, program=path.name == "talus", checked=own)]
    if not plugins:
        found.append(f"no plugins in {build}")
    for fault in found:
        print(fault)
    print(f"hardening: {2 + len(plugins)} files, {len(found)} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
