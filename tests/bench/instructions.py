#!/usr/bin/python3
"""Counts the instructions of a contact update on small fixed models, and compares with committed figures.

    tests/bench/instructions.py [--program build/release/talus]            fails when one has risen by more than a tenth
    tests/bench/instructions.py [--program build/release/talus] --renew    writes tests/bench/instructions.json

The models rest, settle or move: fixed.lua. callgrind counts a run of N steps and one of 2 N; the difference is N steps
without what comes before and after them. The count is the same on every run to a thousandth and hardly depends on the
machine; another compiler may change it by a few per cent. A fall of more than a tenth is told, so that the gain can be
kept with --renew."""

import argparse
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BENCH = pathlib.Path("tests/bench")
FIGURES = ROOT / BENCH / "instructions.json"
RISE = 1.10
# Case, reuse and steps: as many as make what varies outside the steps small. In rest contacts go by slopes.
CASES = [("wall", "on", 50), ("wall", "off", 50), ("pile", "on", 10), ("pile", "off", 10), ("rest", "on", 100),
         ("collapse", "on", 10)]


def count(program, case, reuse, steps):
    """Instructions of the whole run, and contacts that carry at its end."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", str(program), "--quiet",
               str(BENCH / "fixed.lua"), f"case={case}", f"reuse={reuse}", f"steps={steps}"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    collected = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not collected:
        sys.exit(f"instructions: {' '.join(command)} failed:\n{done.stderr[-2000:]}")
    return int(collected.group(1)), int(done.stdout)


def per_update(program, case, reuse, steps):
    once, contacts = count(program, case, reuse, steps)
    twice, later = count(program, case, reuse, 2 * steps)
    return (twice - once) / (steps * (contacts + later) / 2)  # what moves gains and loses contacts


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="build/release/talus")
    parser.add_argument("--renew", action="store_true", help="write the figures instead of comparing")
    given = parser.parse_args()
    program = (ROOT / given.program).resolve()
    found = {f"{case}, reuse {reuse}": round(per_update(program, case, reuse, steps))
             for case, reuse, steps in CASES}
    if given.renew:
        FIGURES.write_text(json.dumps(found, indent=2) + "\n")
    committed = json.loads(FIGURES.read_text())
    worse = 0
    for name, value in found.items():
        ratio = value / committed[name]
        remark = ""
        if ratio > RISE:
            worse += 1
            remark = f"  MORE THAN {RISE:.2f}"
        elif ratio < 1 / RISE:
            remark = "  keep the gain: tests/bench/instructions.py --renew"
        print(f"{name:18} {value:8} instructions a contact update, {ratio:.3f} of the committed "
              f"{committed[name]}{remark}")
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
