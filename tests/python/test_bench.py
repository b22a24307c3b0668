#!/usr/bin/env python3
"""What the benchmark tables compute from rows: shares, rates of face contacts, ratios, the page."""

import importlib.util
import pathlib
import sys
import tempfile

BENCH = pathlib.Path(__file__).resolve().parent.parent / "bench"


def load(name):
    spec = importlib.util.spec_from_file_location(name, BENCH / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


table = load("table")
run = load("run")
FAULTS = []


def equal(what, actual, expected):
    if actual != expected:
        FAULTS.append(f"{what}: {actual!r}, expected {expected!r}")


TEXT = """talus: a remark, with a comma
workload,size,contacts,threads,rate,unit
limit step,in cache,3000,1,4e7,contacts/s
limit clip,in cache,2000,1,1e7,contacts/s
limit step,out of cache,1000000,1,2e7,contacts/s
42 lines of something else
workload,size,blocks,contacts,face_contacts,threads,reuse,rate,unit,block_steps_per_s
wall,125,125,1000,400,1,on,4e6,contacts/s,5e5
wall,125,125,1000,400,1,off,1e6,contacts/s,1e5
yade wall,125,125,1000,400,1,,5000,contacts/s,600
example tunnel,780 steps,21,,,1,on,0.05,s,
"""

rows, rest = run.parse(TEXT)
equal("rows found among other lines", len(rows), 7)
equal("other lines", rest, ["talus: a remark, with a comma", "42 lines of something else"])
known = table.limits(rows)
equal("limits", known[("step", "in cache", "1")], 4e7)
walls = [row for row in rows if row["workload"] == "wall"]
equal("share with reuse", round(table.share(walls[0], known), 12), 0.1)
equal("share without: step and clip one after the other", round(table.share(walls[1], known), 12), 0.125)
large = dict(walls[0], contacts="500000")
equal("share out of cache", round(table.share(large, known), 12), 0.2)
equal("no share without a limit", table.percent(table.share(dict(large, threads="7"), known)), "")
equal("face contacts a second", table.faces(walls[0]), 4e6 * 0.4)
equal("face contacts that were not told apart", table.faces({"rate": "7", "contacts": "3"}), 7)
head, body = table.peer_table(rows)
equal("ratios to Yade", body, [["wall", "125", "2 k", "5 k", "800", "800", "200", "200"]])
equal("whole runs", table.figure_table(rows)[1], [["example tunnel", "780 steps", "21", "1", "0.05", "s"]])
equal("short numbers", [table.short(x) for x in (0.05, 12.34, 1234.5, 2.5e6, float("nan"))],
      ["0.05", "12.3", "1.23 k", "2.5 M", ""])
equal("file name", table.slug("Some CPU @ 2.0 GHz, family 6"), "some-cpu-2-0-ghz-family-6")

with tempfile.TemporaryDirectory() as folder:
    page = pathlib.Path(folder) / "performance.md"
    page.write_text(f"before\n{table.BEGIN}\nold\n{table.END}\nafter\n")
    figures = pathlib.Path(folder) / "performance" / "some-cpu.csv"
    run.write_csv(figures, rows, ["Some CPU", "2 processors", "today"])
    equal("rows come back from their file",
          [row["workload"] for row in table.read_csv(figures)[1]], [row["workload"] for row in rows])
    table.write_page(page)
    text = page.read_text()
    table.write_page(page)
    equal("written twice, the page is the same", page.read_text(), text)
    equal("what stands around the marks stays", (text[:7], text[-7:]), ("before\n", "\nafter\n"))
    for piece in ("### Some CPU", "2 processors; today.", "| wall | 125 | 1000 | 1 | on | 4 M |", "performance/some-cpu.csv"):
        equal(f"the page says '{piece}'", piece in text, True)
    equal("old figures are gone", "old" in text, False)

for fault in FAULTS:
    print(f"test_bench.py: {fault}")
print(f"bench: {len(FAULTS)} faults")
sys.exit(1 if FAULTS else 0)
