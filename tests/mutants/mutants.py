#!/usr/bin/env python3
"""Changes one place of the kernel at a time, and sees whether a test finds it.

    mutants.py [--count 300] [--seed 1] [--build build/mutants] [--only N,N...]

A place is a sign, a bound, a factor, a term or a status that is looked at, in core/force, contact, cycle, state, query or edit; which ones are
changed follows from the seed. Each mutant is built in a copy of the sources. The tests that `./bootstrap test` runs are run until one
fails: those that need only the program first, and of these what has found most mutants, then what is short. A mutant that none finds
is printed, unless equivalent.txt argues that it changes nothing. The exit status is 1 when more than a tenth of the others are not
found.
"""

import argparse
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULES = ("force", "contact", "cycle", "state", "query", "edit")
WORKERS = os.cpu_count() or 1
SHARE = 0.9  # of the mutants that are not equivalent

NAME = r"[A-Za-z_][\w.\[\]]*(?:->[\w.\[\]]+)*"
# What is looked for, and what stands there instead.
CHANGES = [
    ("sign", re.compile(r" \+ "), " - "),
    ("sign", re.compile(r"(?<=[\w)\]]) - (?=[\w(])"), " + "),
    ("sign", re.compile(r" \+= "), " -= "),
    ("sign", re.compile(r" -= "), " += "),
    ("sign", re.compile(r"\btl_v3_add\("), "tl_v3_sub("),
    ("sign", re.compile(r"\btl_v3_sub\("), "tl_v3_add("),
    ("bound", re.compile(r"(?<=[\w)\]]) < (?=[\w(])"), " > "),
    ("bound", re.compile(r"(?<=[\w)\]]) > (?=[\w(])"), " < "),
    ("bound", re.compile(r" <= "), " > "),
    ("bound", re.compile(r" >= "), " < "),
    ("bound", re.compile(r"\bfmax\("), "fmin("),
    ("bound", re.compile(r"\bfmin\("), "fmax("),
    ("factor", re.compile(r"\b0\.5 \* "), ""),
    ("factor", re.compile(r"\b2 \* "), ""),
    ("term", re.compile(rf"\btl_v3_add\(({NAME}), {NAME}\)"), r"\1"),
    ("term", re.compile(rf"\btl_v3_madd\(({NAME}), {NAME}, {NAME}\)"), r"\1"),
    ("term", re.compile(r" && [!\w][\w.>()\[\]-]*(?=[ )])"), ""),
    ("term", re.compile(r" \|\| [!\w][\w.>()\[\]-]*(?=[ )])"), ""),
    ("status", re.compile(r"\bif \(status != TL_OK\)"), "if (false)"),
    ("status", re.compile(r"\bstatus == TL_OK && "), ""),
    ("status", re.compile(r"^(\s+)if \(!([^;{}|&]*)\)$"), r"\1if (false && !\2)"),
]


def places():
    """Every place that may be changed: (file, line number, kind, the line, the line instead)."""
    out = []
    for module in MODULES:
        for path in sorted((ROOT / "core" / module).glob("*.c")):
            comment = False
            for number, line in enumerate(path.read_text().splitlines()):
                bare = line.strip()
                comment = comment or bare.startswith("/*")
                skip = comment or bare.startswith(("#", "//", "static const")) or '"' in bare or "for (" in bare
                comment = comment and "*/" not in bare
                if skip or "/*" in bare:
                    continue
                for kind, pattern, instead in CHANGES:
                    for match in pattern.finditer(line):
                        changed = line[: match.start()] + match.expand(instead) + line[match.end() :]
                        out.append((path.relative_to(ROOT), number, kind, line, changed))
    return out


def choose(count, seed):
    """The same number of each kind, as far as there are so many."""
    by_kind, chosen = {}, []
    for place in places():
        by_kind.setdefault(place[2], []).append(place)
    draw = random.Random(seed)
    for some in by_kind.values():
        draw.shuffle(some)
    while len(chosen) < count and any(by_kind.values()):
        for some in by_kind.values():
            if some and len(chosen) < count:
                chosen.append(some.pop())
    return chosen


def equivalents():
    """Changes that are argued to change nothing: lines "FILE | line | line instead | why"."""
    out = set()
    for line in (ROOT / "tests/mutants/equivalent.txt").read_text().splitlines():
        parts = [part.strip() for part in line.split(" | ")]
        if line and not line.startswith("#"):
            out.add(tuple(parts[:3]))
    return out


class Copy:
    """The sources once more, with a build of their own."""

    def __init__(self, build):
        self.source = build / "source"
        self.build = self.source / "build/release"  # where tests look for it
        self.source.mkdir(parents=True, exist_ok=True)
        files = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        for name in files.splitlines():
            to = self.source / name
            if not to.exists() or to.read_bytes() != (ROOT / name).read_bytes():
                to.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / name, to)
        self.environment = {k: v for k, v in os.environ.items() if k not in ("LUA_PATH", "TALUS_PLUGIN_PATH")}
        self.environment["TALUS_TEST_SHARE"] = "10"
        self.run("cmake", "-S", str(self.source), "-B", str(self.build), "-DCMAKE_BUILD_TYPE=Release")

    def run(self, *command):
        return subprocess.run(command, cwd=self.source, env=self.environment,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0

    def program(self):
        """What the compiler makes of the sources."""
        return (self.build / "talus").read_bytes()

    def make(self, *targets):
        return self.run("cmake", "--build", str(self.build), "-j", str(WORKERS), *[a for t in targets for a in ("--target", t)])


class Test:
    """One test of ctest's list, with what it took when nothing was changed, s, and how many mutants it has found."""

    def __init__(self, listed, copy):
        properties = {p["name"]: p["value"] for p in listed["properties"]}
        self.name, self.command = listed["name"], listed["command"]
        self.folder = properties["WORKING_DIRECTORY"]
        self.environment = copy.environment | dict(e.split("=", 1) for e in properties.get("ENVIRONMENT", []))
        self.passing = (0, properties.get("SKIP_RETURN_CODE", 0))
        self.needs_all = properties["LABELS"][0] in ("unit", "property", "python") or self.name.startswith("memory/")
        self.reads_others = "FIXTURES_REQUIRED" in properties
        self.seconds, self.found = None, 0

    def start(self):
        self.began = time.time()
        self.process = subprocess.Popen(self.command, cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)

    def end(self):
        """Whether the test passed; None while it runs. One that takes far longer than it did has failed."""
        took = time.time() - self.began
        status = self.process.poll()
        if status is None and took < (600 if self.seconds is None else 30 + 10 * self.seconds):
            return None
        self.stop()
        self.seconds = self.seconds or took
        return status in self.passing

    def stop(self):
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()


class Suite:
    """The tests of `./bootstrap test`, but for what a stock interpreter runs once more."""

    def __init__(self, copy):
        self.copy = copy
        text = subprocess.run(["ctest", "--show-only=json-v1", "-LE", "long|full"], cwd=copy.build, capture_output=True, check=True).stdout
        tests = [Test(listed, copy) for listed in json.loads(text)["tests"] if not listed["name"].endswith("@stock")]
        self.tests = [t for t in tests if not t.reads_others]

    def first_failing(self, tests):
        """Those first that found most mutants, then the short ones."""
        queue = sorted(tests, key=lambda t: (-t.found, t.seconds or 0))
        running, failed = [], None
        while (queue or running) and not failed:
            while queue and len(running) < WORKERS:
                running.append(queue.pop(0))
                running[-1].start()
            time.sleep(0.01)
            for test in list(running):
                passed = test.end()
                if passed is None:
                    continue
                running.remove(test)
                failed = failed or (None if passed else test)
        for test in running:
            test.stop()
        return failed

    def finds(self):
        """The name of a test that finds what has been built; None: none does."""
        failed = self.first_failing([t for t in self.tests if not t.needs_all])
        if not failed:
            if not self.copy.make("all"):
                return "build"
            failed = self.first_failing([t for t in self.tests if t.needs_all])
        if failed:
            failed.found += 1
        return failed.name if failed else None


def try_one(copy, suite, place, plain):
    """What finds a mutant; "none" when it does not compile, or to the same code, None when nothing finds it."""
    path, number, _, line, changed = place
    file = copy.source / path
    text = file.read_text()
    lines = text.splitlines(keepends=True)
    lines[number] = lines[number].replace(line, changed)
    file.write_text("".join(lines))
    try:
        same = not copy.make("talus") or copy.program() == plain
        return "none" if same else suite.finds()
    finally:
        file.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/mutants")
    parser.add_argument("--only", help="numbers of mutants, in the order of the seed")
    options = parser.parse_args()
    chosen, known = choose(options.count, options.seed), equivalents()
    copy = Copy(options.build.resolve())
    if not copy.make("all"):
        sys.exit("mutants: the sources as they are do not build")
    suite = Suite(copy)
    failed = suite.finds()
    if failed:
        sys.exit(f"mutants: {failed} fails on the sources as they are")
    plain = copy.program()
    only = {int(n) for n in options.only.split(",")} if options.only else range(len(chosen))
    tried = found = 0
    for k, place in enumerate(chosen):
        path, number, kind, line, changed = place
        if k not in only or (str(path), line.strip(), changed.strip()) in known:
            continue
        began = time.time()
        by = try_one(copy, suite, place, plain)
        if by == "none":
            continue
        tried += 1
        found += by is not None
        print(f"{k} {kind} {path}:{number + 1}: {by or 'NOT FOUND'}, {time.time() - began:.0f} s", flush=True)
        if not by:
            print(f"    {line.strip()}\n    {changed.strip()}", flush=True)
    print(f"{found} of {tried} mutants found")
    return 0 if found >= SHARE * tried else 1


if __name__ == "__main__":
    sys.exit(main())
