"""Other programs beside Talus on the same blocks: Yade, Rockable and Box3D, each where it is installed."""

import os
import pathlib
import shutil
import subprocess
import sys

import rockable_blocks
import table

BENCH = pathlib.Path("tests/bench")
# Times that Talus and the others run in turn.
ROUNDS = 3
# Of a row of several: the others are the same in all, or belong to Talus alone.
FIGURES = ("contacts", "points", "rate", "block_steps_per_s", "speed")
# Step of all in *collapse*, s. A rule of Talus chooses longer ones.
COLLAPSE_STEP, RULE = 2e-4, "balance"


# ---------------------------------------------------------------------- Yade


def yade(r, pile_file):
    """The same blocks in Yade's polyhedra, where Debian's package is there."""
    program = shutil.which("yade-double") or shutil.which("yade")
    if not program:
        print("    no yade here (Debian: apt-get install yade)")
        return
    count, path = pile_file(r)
    cases = [("wall", 5, 10), ("bond", 10, 5)] if r.quick else [("wall", 5, 20), ("wall", 10, 5), ("wall", 20, 2),
                                                                ("bond", 10, 10)]
    for layout, n, steps in cases:
        blocks = r.out / f"{layout}_{n}.json"
        r.script("wall", f"layout={'bond' if layout == 'bond' else 'lattice'}", f"n={n}", f"write={blocks}")
        r.run(program, "-n", "-x", "-j1", BENCH / "yade_blocks.py",
              env={"BLOCKS": str(blocks), "WORKLOAD": f"yade {layout}", "SIZE": str(n ** 3), "STEPS": str(steps),
                   "VERLET": "0.001" if layout == "bond" else "0.01", "OMP_NUM_THREADS": "1"})
    r.run(program, "-n", "-x", "-j1", BENCH / "yade_blocks.py",
          env={"BLOCKS": str(path), "WORKLOAD": "yade pile", "SIZE": str(count), "STEPS": "3" if r.quick else "10",
               "DT": "5e-4", "DAMPING": "0.7", "VERLET": "0.02", "OMP_NUM_THREADS": "1"})


# ---------------------------------------------------------------------- Rockable and Box3D, in turn with Talus


def build_box3d(r):
    """Builds box3d_blocks.c against the Box3D whose prefix the variable BOX3D tells; nothing where there is none."""
    prefix = os.environ.get("BOX3D")
    if not prefix:
        print("    no Box3D here (set BOX3D to the prefix it is installed at)")
        return None
    found = sorted(pathlib.Path(prefix).glob("lib*/**/libbox3d.*"))
    if not found:
        sys.exit(f"bench: no libbox3d under '{prefix}', which BOX3D names")
    folder, program = found[0].parent, r.out / "box3d_blocks"
    done = subprocess.run([os.environ.get("CC", "cc"), "-std=c17", "-D_POSIX_C_SOURCE=200809L", "-O3", "-march=native",
                           "-Wall", "-Wextra", "-isystem", f"{prefix}/include", BENCH / "box3d_blocks.c", "-o", program,
                           f"-L{folder}", f"-Wl,-rpath,{folder}", "-lbox3d", "-lm", "-lpthread"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"bench: box3d_blocks.c cannot be built against '{prefix}':\n{done.stderr[-2000:]}")
    return program


def find_rockable(_r):
    program = rockable_blocks.find_program()
    if not program:
        print("    no Rockable here (set ROCKABLE to its program, or put it on the PATH)")
    return program


class Case:
    """A workload: how Talus measures it (`script`), how it writes the blocks (`write`), and what the others are told."""

    def __init__(self, name, size, script, write, rockable=None, box3d=None):
        self.name, self.size, self.script, self.write = name, str(size), script, write
        self.rockable, self.box3d = rockable, box3d


def cases(quick, pile, count, falling):
    """What Talus does is in wall.lua, pile.lua, collapse.lua and falling.lua: steps, damping and what goes before are the same
    here, as far as the others can. Candidates are looked for in Rockable within the distance (--verlet) with which it was
    fastest."""
    found = []
    for layout, n in [("wall", 5), ("bond", 5)] if quick else [("wall", 5), ("wall", 10), ("wall", 20), ("bond", 10)]:
        script = ("wall", f"layout={'bond' if layout == 'bond' else 'lattice'}", f"n={n}")
        slow, fast = {5: (2000, 10000), 10: (2000, 1000), 20: (1000, 200)}[n]
        found.append(Case(layout, n ** 3, (*script, "reps=3"), script,
                          ["--verlet=0.002", f"--area={0.3 if layout == 'bond' else 1}", f"--settle={slow}",
                           f"--steps={100000 // n ** 3}"],
                          [f"settle={fast}", f"steps={200000 // n ** 3}"]))
    found.append(Case("pile", count, ("pile", f"blocks={count}", f"write={pile}", "reps=3"), None,
                      ["--dt=5e-4", "--damping=0.7", "--area=0.1", "--gap=0.008", "--verlet=0.05", "--settle=20000",
                       "--still=5e-4", "--steps=500"],
                      ["dt=5e-4", "settle=10000", "steps=400"]))
    found.append(Case("collapse", count, ("collapse", f"file={pile}"), ("collapse", f"file={pile}"),
                      ["--damping=0", "--area=0.1", "--gap=0.008", "--verlet=0.05", "--settle=0", "--warm=500", "--steps=100",
                       "--reps=15", f"--start={pathlib.Path(pile).parent}/rockable_pile_{count}/settled.txt"],
                      ["warm=500", "steps=100", "reps=15"]))
    found.append(Case("falling", "", ("falling", f"blocks={falling}"), ("falling", f"blocks={falling}"), None,
                      ["dt=5e-4", "drag=4", "down=0.1", "still=0.005"]))
    return found


def medians(rows):
    """One row for the rows of each program, workload and kind, with the medians of their figures."""
    groups = {}
    for row in rows:
        groups.setdefault((row["workload"], row.get("reuse")), []).append(row)
    merged = []
    for group in groups.values():
        row = dict(group[0])
        for name in FIGURES:
            values = [table.number(other, name) for other in group]
            if all(value == value for value in values):
                row[name] = f"{rockable_blocks.median(values):.5g}"
        merged.append(row)
    return merged


def rockable_folder(r, case):
    return r.out / f"rockable_{case.name}_{case.size}"


def seconds(rows, name, step):
    """Rows of the seconds that a second of a model takes whose steps were measured."""
    return [{**row, "workload": f"{row['workload'].split()[0]} {name}", "unit": "s/s", "block_steps_per_s": "",
             "rate": f"{table.number(row, 'blocks') / (table.number(row, 'block_steps_per_s') * step):.5g}"}
            for row in rows]


def run_case(r, case, model, rockable, box3d):
    """Rows of one turn: Talus, Rockable, Box3D."""
    rows = r.script(*case.script, keep=False)
    for row in rows:
        row["workload"] = f"talus {case.name}"
    rows += run_others(r, case, model, rockable, box3d)
    if case.name != "collapse":
        return rows
    by_rule = [row for row in r.script(*case.script, f"rule={RULE}", keep=False)
               if row["workload"] == f"collapse by {RULE}"]
    others = [row for row in rows if not row["workload"].startswith("talus ")]
    for row in by_rule:
        row.update(workload=f"talus collapse, a second by {RULE}", blocks=rows[0]["blocks"], reuse="on")
    return (rows + seconds(rows, "collapse, a second", COLLAPSE_STEP) + by_rule
            + seconds(others, f"collapse, a second by {RULE}", COLLAPSE_STEP))


def run_others(r, case, model, rockable, box3d):
    rows = []
    if rockable and case.rockable:
        folder = rockable_folder(r, case)
        rows += r.run(sys.executable, BENCH / "rockable_blocks.py", model, f"--workload=rockable {case.name}",
                      f"--size={case.size}", f"--folder={folder}", f"--settled={folder}/settled.txt", *case.rockable, env={"ROCKABLE": rockable}, keep=False)
    for recycle in ("on", "off") if box3d and case.name != "falling" else ("on",) if box3d else ():
        rows += r.run(box3d, f"file={model.with_suffix('.txt')}", f"workload=box3d {case.name}", f"size={case.size}",
                      f"recycle={recycle}", *case.box3d, keep=False)
    return rows


def beside(r, pile_file, only=None):
    """Talus, Rockable and Box3D in turn, so that what else the machine does disturbs all of them alike."""
    rockable, box3d = find_rockable(r), build_box3d(r)
    if not rockable and not box3d:
        return
    count, pile = pile_file(r)
    for case in cases(r.quick, pile, count, 200 if r.quick else 2000):
        if not box3d and not case.rockable or only and case.name not in only:
            continue
        model = pathlib.Path(pile)
        if case.write:
            model = r.out / f"beside_{case.name}_{case.size}.json"
            r.script(*case.write, f"write={model}")
        subprocess.run([sys.executable, BENCH / "blocks.py", model, model.with_suffix(".txt")], check=True)
        shutil.rmtree(rockable_folder(r, case), ignore_errors=True)
        rows = []
        for _ in range(1 if r.quick else ROUNDS):
            rows += run_case(r, case, model, rockable, box3d)
        r.rows += medians(rows)
