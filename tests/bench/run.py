#!/usr/bin/python3
"""Runs the benchmarks, prints one table, keeps the figures as CSV, and renews docs/performance.md.

    tests/bench/run.py [--quick] [--renew] [--build FOLDER] [NAME...]

NAME is a job below (limit wall bond pile rock collapse slope shake falling consolidate rest realisations safety edits output terrain
examples yade beside million cuts solids zones deformable elements); without names all run. --quick takes smaller models. --renew writes
docs/performance/MACHINE.csv and the tables of docs/performance.md from the figures of this run; --page writes the tables from the CSV files there
are.

A job is a program that prints rows of CSV after a line with the names of their columns (the first of which
is "workload"); what else it prints is let through. A row has any of these:

    workload, size            what was done
    blocks, contacts          free blocks; contacts that carry a force
    face_contacts             those of them over a face
    points                    contact points
    threads, reuse            "on", "off" or nothing
    rate, unit                the figure: contacts/s, s, GB/s, ...
    block_steps_per_s         blocks times steps over seconds
    detect_ns ... energy_ns   time of the phases, a contact update
    total_bytes, blocks_bytes ... memory a block, in all and by what it is for (model:memory())

Other columns are kept in the CSV. A C program tests/bench/NAME.c is built as build/PRESET/tests/bench/NAME."""

import argparse
import csv
import datetime
import os
import pathlib
import resource
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BENCH = pathlib.Path("tests/bench")
sys.path.insert(0, str(ROOT / BENCH))

import peers  # noqa: E402
import table  # noqa: E402

# Share of the machine's memory that a model may take, by what a smaller one takes a block: laying contacts out
# anew needs them twice.
MOST_MEMORY = 0.5
# Times a cold start is repeated.
COLD = 5
MEMORY = pathlib.Path("/dev/shm")


def machine():
    """Model of the processor as the kernel names it, with family and model where the name says little."""
    fields, described = {}, pathlib.Path("/proc/cpuinfo")
    for line in described.read_text().splitlines() if described.exists() else []:
        if not line.strip():
            break
        key, _, value = line.partition(":")
        fields.setdefault(key.strip(), value.strip())
    name = " ".join(fields.get("model name", "unknown processor").replace("(R)", "").replace("(TM)", "").split())
    return f"{name}, family {fields.get('cpu family', '?')} model {fields.get('model', '?')}"


def first_line(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[0]
    except (OSError, subprocess.CalledProcessError, IndexError):
        return "unknown"


def parse(text):
    """Rows of CSV among other lines."""
    rows, names, rest = [], None, []
    for line in text.splitlines():
        cells = next(csv.reader([line]), [])
        if cells and cells[0] == "workload":
            names = cells
        elif names and len(cells) == len(names):
            rows.append(dict(zip(names, cells)))
        else:
            rest.append(line)
    return rows, rest


class Runner:
    def __init__(self, build, out, quick):
        self.build, self.out, self.quick = build, out, quick
        self.talus = build / "talus"
        self.rows = []

    def run(self, *command, env=None, cold=1, keep=True):
        """One program's rows, which belong to the run's figures unless `keep` is false; a row without a figure gets the median
        time of the whole process."""
        times = []
        for _ in range(cold):
            began = time.perf_counter()
            done = subprocess.run([str(c) for c in command], cwd=ROOT, capture_output=True, text=True,
                                  env={**os.environ, **(env or {})}, check=False)
            times.append(time.perf_counter() - began)
            if done.returncode != 0:
                sys.exit(f"bench: {' '.join(map(str, command))} failed:\n{done.stderr[-2000:]}")
        rows, rest = parse(done.stdout)
        for line in rest if not rows else []:
            print(f"    {line}")
        for row in rows:
            if not row.get("rate") and row.get("unit") == "s":
                row["rate"] = f"{sorted(times)[len(times) // 2]:.4g}"
            print("    " + table.line(row), flush=True)
        self.rows += rows if keep else []
        return rows

    def script(self, name, *arguments, cold=1, keep=True):
        return self.run(self.talus, "--quiet", BENCH / f"{name}.lua", *arguments, cold=cold, keep=keep)

    def program(self, name, *arguments, env=None):
        return self.run(self.build / "tests" / "bench" / name, *arguments, env=env)


# ---------------------------------------------------------------------- jobs


def limit(r):
    r.program("limit", *(["quick"] if r.quick else []))


def wall(r):
    if r.quick:
        r.script("wall", "n=5,10", "threads=1,2", "reps=3")
    else:
        r.script("wall", "n=5,10,20", "threads=1,2")
        r.script("wall", "n=46", "threads=1,2", "reps=3")


def bond(r):
    r.script("wall", "layout=bond", "n=10", "threads=1,2", f"reps={3 if r.quick else 5}")


def pile_file(r):
    """The pile: settled once, kept for later runs until the script changes."""
    count = 200 if r.quick else 500
    path = r.out / f"pile_{count}.json"
    if path.exists() and path.stat().st_mtime < (ROOT / BENCH / "pile.lua").stat().st_mtime:
        path.unlink()
    if not path.exists():
        r.script("pile", f"blocks={count}", f"write={path}", "reps=0")
    return count, path


def pile(r):
    count, path = pile_file(r)
    r.script("pile", f"blocks={count}", f"write={path}", "threads=1,2", f"reps={3 if r.quick else 5}")


def rock(r):
    r.script("rock", f"blocks={'1000' if r.quick else '1000,10000,100000'}", "threads=1,2",
             f"reps={3 if r.quick else 5}")
    if not r.quick:
        need = 1e6 * table.number(r.rows[-1], "total_bytes")
        if need < MOST_MEMORY * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"):
            r.script("rock", "blocks=1000000", "threads=1,2", "reps=3")
        else:
            print(f"    a million blocks need some {need / 2 ** 30:.0f} GiB, more than half of what this machine has")


def collapse(r):
    r.script("collapse", f"file={pile_file(r)[1]}", "threads=1,2")
    r.script("collapse", f"file={pile_file(r)[1]}", "rule=balance")


def slope(r):
    r.script("slope", f"blocks={1000 if r.quick else 5000}", "threads=1,2")


def shake(r):
    for layout in ("lattice", "bond"):
        r.script("shake", f"layout={layout}", f"n={5 if r.quick else 10}", "threads=1,2")


def falling(r):
    r.script("falling", f"blocks={200 if r.quick else 2000}", "threads=1,2")


def consolidate(r):
    r.script("consolidate", f"blocks={200 if r.quick else 1000}")


def rest(r):
    r.script("rest")


def realisations(r):
    """Rows of a slope whose joints are drawn anew, screened by keyblocks."""
    r.script("realisations", f"rows={300 if r.quick else 10000}", "workers=1,2")


def safety(r):
    """Factors of safety of cut rock, and maps of them."""
    r.script("safety", *(["factor=slope,4", "map=slope"] if r.quick else []))


def output(r):
    """Where there is one, in a folder that is memory: the figures are of the program and not of the disk."""
    r.script("output", f"blocks={5000 if r.quick else 100000}", "threads=1,2", f"reps={3 if r.quick else 5}",
             f"folder={MEMORY if MEMORY.is_dir() else r.out}")


def edits(r):
    r.script("edits", f"blocks={'1000' if r.quick else '10000,100000'}", f"reps={3 if r.quick else 5}")


def terrain(r):
    """Blocks divided by the ground."""
    r.script("terrain", f"cells={20 if r.quick else 100}")


def examples(r):
    for example in ("slope", "tunnel"):
        r.script("examples", f"example={example}", cold=COLD)


def yade(r):
    peers.yade(r, pile_file)


def beside(r):
    peers.beside(r, pile_file)


def million(r):
    """Making a million blocks."""
    if not r.quick:
        r.script("rock_million")


def cuts(r):
    """Cutting, timed in C."""
    if (ROOT / BENCH / "cuts.c").exists():
        r.program("cuts")


def solids(r):
    """Dividing solids that are not convex, timed in C."""
    r.program("solids", *(["quick"] if r.quick else []))


def zones(r):
    """Dividing blocks into zones, timed in C."""
    r.program("zones", *(["quick"] if r.quick else []))


def deformable(r):
    """Steps of zones and points of segments, beside a bare loop, timed in C."""
    r.program("deformable", *(["quick"] if r.quick else []), env={"TALUS_PLUGIN_PATH": str(r.build / "plugins")})


def elements(r):
    """Bolts, quiet faces and water; only their lines of text."""
    r.program("bolts")
    r.script("bolt_memory")
    r.script("quiet", f"n={20 if r.quick else 60}")
    r.script("water", f"n={4 if r.quick else 5}")
    r.script("flow", "10000" if r.quick else "100000")


JOBS = {job.__name__: job for job in (limit, wall, bond, pile, rock, collapse, slope, shake, falling, consolidate, rest,
                                      realisations, safety, edits, output, terrain, examples, yade, beside, million, cuts, solids, zones, deformable,
                                      elements)}


# ---------------------------------------------------------------------- figures


def write_csv(path, rows, notes):
    names = []
    for row in rows:
        names += [name for name in row if name not in names]
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        for note in notes:
            file.write(f"# {note}\n")
        writer = csv.DictWriter(file, names, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="smaller models, some two minutes")
    parser.add_argument("--renew", action="store_true", help="write docs/performance/*.csv and the page's tables")
    parser.add_argument("--page", action="store_true", help="write the page's tables from the CSV files; run nothing")
    parser.add_argument("--build", default="build/release", help="folder of the build")
    parser.add_argument("names", nargs="*", metavar="NAME", help=" ".join(JOBS))
    given = parser.parse_args()
    page = ROOT / "docs" / "performance.md"
    if given.page:
        return table.write_page(page)
    unknown = [name for name in given.names if name not in JOBS]
    if unknown:
        sys.exit(f"bench: no job '{unknown[0]}'; there are {' '.join(JOBS)}")
    if given.renew and given.names:
        sys.exit("bench: --renew takes all jobs: leave the names out")
    out = ROOT / "build" / "bench"
    out.mkdir(parents=True, exist_ok=True)
    runner = Runner(ROOT / given.build, out, given.quick)
    name = machine()
    now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d")
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2 ** 30
    notes = [name, f"{os.cpu_count()} processors, {memory:.0f} GiB, {first_line('cc', '--version')}",
             f"{now}, load {os.getloadavg()[0]:.1f} at the start"]
    if given.quick:
        notes.append("smaller models (--quick)")
    print("\n".join(notes), flush=True)
    stamp = "quick" if given.quick else "full"
    for job in given.names or JOBS:
        print(f"{job}:", flush=True)
        JOBS[job](runner)
        write_csv(out / f"{stamp}.csv", runner.rows, notes)  # a later job may fail
    print()
    print(table.text(runner.rows))
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 2 ** 20
    print(f"largest process {peak:.1f} GiB; figures in build/bench/{stamp}.csv")
    if given.renew:
        write_csv(page.parent / "performance" / f"{table.slug(name)}.csv", runner.rows, notes)
        return table.write_page(page)
    return 0


if __name__ == "__main__":
    sys.exit(main())
