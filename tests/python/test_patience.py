#!/usr/bin/env python3
"""No test fails because a machine is slow or busy: limits of time are those against hanging, and no test looks at a clock."""

import pathlib
import re
import sys

TESTS = pathlib.Path(__file__).resolve().parent.parent
ENOUGH = 600  # s: ten times what the longest takes with sanitizers; no one waits longer for a test that hangs
CLOCKS = re.compile(r"os\.clock|os\.time\(|\btl_clock\(|\bclock\(\)|clock_gettime|\btime\(NULL\)|time\.(time|perf_counter|"
                    r"monotonic|process_time)|\btimeout\s*=|\balarm\(|\btimeout \d")
FAULTS = []


def main():
    text = (TESTS / "CMakeLists.txt").read_text()
    limits = {name: int(value) for name, value in re.findall(r"set\((hang_limit\w*) (\d+)\)", text)}
    for name, value in limits.items():
        if value < ENOUGH:
            FAULTS.append(f"{name} = {value} s is less than {ENOUGH} s")
    timeouts = re.findall(r"TIMEOUT\s+([^\s)]+)", text)
    for timeout in timeouts:
        if not re.fullmatch(r"\$\{hang_limit\w*\}", timeout):
            FAULTS.append(f"TIMEOUT {timeout} is not one of {', '.join(limits)}")
    adds = len(re.findall(r"add_test\(", text))
    if not limits or len(timeouts) < adds:
        FAULTS.append(f"{adds} kinds of tests are added and {len(timeouts)} limits set: those without have CTest's 1500 s")
    sources = [path for kind in ("unit", "property", "lua", "verify", "python", "golden")
               for path in sorted((TESTS / kind).rglob("*")) if path.suffix in (".c", ".h", ".lua", ".py")]
    for path in sources:
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if CLOCKS.search(line) and path.name != pathlib.Path(__file__).name:
                FAULTS.append(f"{path.relative_to(TESTS)}:{number} looks at a clock: {line.strip()}")
    for fault in FAULTS:
        print(fault)
    print(f"{len(sources)} sources, {len(timeouts)} limits, {len(FAULTS)} faults")
    return 1 if FAULTS else 0


if __name__ == "__main__":
    sys.exit(main())
