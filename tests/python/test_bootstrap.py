#!/usr/bin/python3
"""What ./bootstrap asks cmake for: `demo` builds the program, the module and the plugins and no test; `build` all.

bootstrap is run in a folder of its own with a cmake that only notes its arguments; what the target `product` stands
for is read from the real build."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def asked(word):
    """The lines of arguments with which bootstrap calls cmake."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        shutil.copy(ROOT / "bootstrap", root)
        tools, program = root / "tools", root / "build/release/talus"
        tools.mkdir()
        program.parent.mkdir(parents=True)
        (tools / "cmake").write_text(f'#!/bin/sh\necho "$@" >>{root}/asked\n', encoding="utf-8")
        program.write_text("#!/bin/sh\n", encoding="utf-8")
        for path in (tools / "cmake", program):
            path.chmod(0o755)
        environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"}
        done = subprocess.run(["./bootstrap", word], cwd=root, env=environment, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"./bootstrap {word} failed:\n{done.stdout}{done.stderr}")
        return (root / "asked").read_text(encoding="utf-8").splitlines()


def sources_of_product():
    """Objects that a fresh build of the target would make, as a dry run in a new tree tells."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["cmake", "-S", str(ROOT), "-B", folder, "-G", "Unix Makefiles"], check=True, capture_output=True)
        # -k: libraries that a dry run has not made are missed, which ends nothing
        done = subprocess.run(["cmake", "--build", folder, "--target", "product", "--", "-n", "-k"],
                              capture_output=True, text=True, check=False)
        return set(re.findall(r"-c \S*?/((?:core|plugins|tests)/\S+\.c)\b", done.stdout))


def main():
    faults = []
    demo, build = asked("demo"), asked("build")
    if not any("--target product" in line for line in demo):
        faults.append(f"demo builds more than the product: {demo}")
    if any("--target" in line or "TALUS_TESTS" in line for line in build):
        faults.append(f"build does not build all: {build}")
    if any("TALUS_TESTS" in line for line in demo):
        faults.append(f"demo leaves the tree without tests for those that come after: {demo}")
    made = sources_of_product()
    tests = sorted(name for name in made if name.startswith("tests/"))
    if tests:
        faults.append(f"product builds tests: {tests[:3]}")
    wanted = {str(path.relative_to(ROOT)) for room in ("core", "plugins") for path in (ROOT / room).rglob("*.c")}
    wanted = {name for name in wanted if not name.startswith("plugins/template/")}  # for projects elsewhere
    if wanted - made:
        faults.append(f"product leaves out {sorted(wanted - made)[:3]}")
    for fault in faults:
        print(fault)
    print(f"bootstrap: {len(made)} sources in the product, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
