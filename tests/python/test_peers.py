#!/usr/bin/env python3
"""What the benchmarks hand to other programs: masses, inertias and faces of the blocks are the model's; contacts are counted as they should
be; and where a program is missing the benchmark says so. Needs none of these programs."""

import argparse
import contextlib
import io
import math
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BENCH = ROOT / "tests" / "bench"
sys.path.insert(0, str(BENCH))

import blocks  # noqa: E402
import peers  # noqa: E402
import rockable_blocks  # noqa: E402
import table  # noqa: E402

MODEL = BENCH / "pile_30.json"
PROGRAM = os.environ.get("TALUS_PROGRAM", ROOT / "build" / "release" / "talus")
FAULTS = []


def equal(what, actual, expected):
    if actual != expected:
        FAULTS.append(f"{what}: {actual!r}, expected {expected!r}")


def near(what, actual, expected, tolerance):
    if not abs(actual - expected) <= tolerance:
        FAULTS.append(f"{what}: {actual!r}, expected {expected!r} to {tolerance:g}")


def refused(what, call, piece):
    try:
        call()
    except SystemExit as stop:
        equal(f"{what} is refused for '{piece}'", piece in str(stop), True)
        return
    FAULTS.append(f"{what} is not refused")


def ask_talus(folder):
    """Mass, centre and number of faces of each block, fixed ones first, as the program finds them."""
    script = folder / "ask.lua"
    script.write_text(f"""local model = require("talus").model {{}}
model:generate("blocks", {{ file = "{MODEL}" }})
for _, fixed in ipairs {{ true, false }} do
    for _, block in ipairs(model:blocks {{ fixed = fixed }}) do
        print(string.format("%.17g %.17g %.17g %.17g %d", block.mass, block.centroid[1], block.centroid[2], block.centroid[3],
            #block.faces))
    end
end
""")
    text = subprocess.run([PROGRAM, "--quiet", script], capture_output=True, text=True, check=True).stdout
    return [list(map(float, line.split())) for line in text.splitlines()]


def turn(q, v):
    """The vector turned by the quaternion."""
    w, u = q[0], q[1:]
    s = blocks.cross(u, v)
    t = blocks.cross(u, [a + w * b for a, b in zip(s, v)])
    return [a + 2 * b for a, b in zip(v, t)]


def check_moments(found):
    box = blocks.Block({"density": 1, "vertices": [[x, y, z] for z in (5, 8) for y in (0, 2) for x in (0, 1)],
                        "faces": [{"vertices": f} for f in ([0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1],
                                                            [4, 5, 7, 6])]})
    near("volume of a box", box.volume, 6, 1e-12)
    for i, (b, c) in enumerate(((2, 3), (3, 1), (1, 2))):
        near(f"inertia of a box, axis {i}", box.inertia[i][i], (b * b + c * c) / 12, 1e-12)
    equal("edges of a box", len(box.edges()), 12)
    for number, block in enumerate(found):
        moments, axes = blocks.principal(block.inertia)
        for i in range(3):
            for j in range(3):
                back = sum(moments[k] * axes[k][i] * axes[k][j] for k in range(3))
                near(f"inertia of block {number} from its axes", back, block.inertia[i][j], 1e-12 * max(moments))
        q = blocks.quaternion(axes)
        for k in range(3):
            for a, b in zip(turn(q, [float(i == k) for i in range(3)]), axes[k]):
                near(f"axis {k} of block {number} from its quaternion", a, b, 1e-12)


def read_shapes(path):
    shapes = {}
    for text in path.read_text().split("<\n")[1:]:
        lines, shape = iter(text.splitlines()), {}
        for line in lines:
            key, *rest = line.split()
            if key in ("nv", "ne", "nf"):
                shape[key] = [list(map(float, next(lines).split())) for _ in range(int(rest[0]))]
            elif rest:
                shape[key] = rest
        shapes[shape["name"][0]] = shape
    return shapes


def flatness(block, known, exact):
    """To what masses agree: the program makes one face of facets that are bent by less than 1e-4 of their size."""
    return exact if len(block.faces) == known[4] else 1e-4


def check_shapes(found, known, folder):
    radius = 0.02
    particles = rockable_blocks.write_shapes(found, folder / "blocks.shp", radius)
    shapes = read_shapes(folder / "blocks.shp")
    equal("particles", len(particles), len(found))
    for number, (line, block) in enumerate(zip(particles, found)):
        name, group, _, size, *rest = line.split()
        shape, rest = shapes[name], list(map(float, rest))
        what = f"particle {number}"
        near(f"{what}: mass", float(shape["volume"][0]) * block.density, known[number][0],
             flatness(block, known[number], 1e-10) * known[number][0])
        for a, b in zip(rest[:3], known[number][1:4]):
            near(f"{what}: place", a, b, flatness(block, known[number], 1e-9))
        equal(f"{what}: group and size", (group, size), ("0" if block.fixed else "1", "1"))
        for a, b in zip(sorted(map(float, shape["I/m"])), sorted(blocks.principal(block.inertia)[0])):
            near(f"{what}: inertia", a, b, 1e-11)
        equal(f"{what}: corners, edges and faces", (len(shape["nv"]) - len(shape["ne"]) + len(shape["nf"]), len(shape["nv"])),
              (2, len(block.vertices)))
        # A face lies a radius within the block's: all of a box, which has three faces at a corner; of a hull the mean.
        points = [[p + c for p, c in zip(turn(rest[9:13], v), block.centre)] for v in shape["nv"]]
        depths = [blocks.dot(block.normal(face), blocks.subtract(block.vertices[face[0]], points[i]))
                  for face in block.faces for i in face]
        near(f"{what}: depth of its faces", sum(depths) / len(depths), radius, 0.05 * radius)
        if len(block.vertices) == 8 and len(block.faces) == 6:
            near(f"{what}: greatest depth of a box's face", max(depths), radius, 1e-9)
            near(f"{what}: least depth of a box's face", min(depths), radius, 1e-9)
    cubes = [found[0], found[0]]
    equal("blocks that are alike have one shape", {line.split()[0] for line in
          rockable_blocks.write_shapes(cubes, folder / "alike.shp")}, {"S0"})


def check_points(found, known, folder):
    blocks.write_points(found, folder / "blocks.txt")
    lines = iter((folder / "blocks.txt").read_text().splitlines())
    equal("blocks in the file of points", int(next(lines)), len(found))
    for number, block in enumerate(found):
        kind, density, mass, count = next(lines).split()
        corners = list(map(float, next(lines).split()))
        centre = list(map(float, next(lines).split()))
        equal(f"block {number}: kind, corners", (kind, int(count), len(corners)),
              ("fixed" if block.fixed else "free", len(block.vertices), 3 * len(block.vertices)))
        near(f"block {number}: mass", float(mass), known[number][0],
             flatness(block, known[number], 1e-12) * known[number][0])
        near(f"block {number}: density", float(density), block.density, 0)
        near(f"block {number}: a corner", corners[0] + centre[0], block.vertices[0][0], 1e-12)


def check_rockable(found, folder):
    """A program that is none: what is asked of it, and what is read from its answers."""
    program = folder / "rockable"
    program.write_text("""#!/bin/sh
cp input.txt asked.txt
{ sed -n '1,/^Particles/p' input.txt; echo '#name a comment'
  sed '1,/^Particles/d;/^Interactions/,$d' input.txt | sed 's/^\\(S[0-9]* 1 0 1 [^ ]* [^ ]* [^ ]*\\) [^ ]* [^ ]* [^ ]*/\\1 0 3 4/'
  echo Interactions 4
  tail='0 0 1 -1e-4 0 0 0 0 0 0'
  echo "5 6 1 0 0 $tail 7.5 0 0 0 0 0 0 0"
  echo "6 5 1 0 1 $tail 2.5 0 0 0 0 0 0 0"
  echo "0 7 3 0 0 $tail 1 0 0 0 0 0 0 0"
  echo "7 8 1 0 0 $tail 0 0 0 0 0 0 0 0"
  echo Interfaces 0; } > conf1
""")
    program.chmod(0o755)
    given = argparse.Namespace(folder=folder / "run", dt=1e-3, damping=0.2, area=0.5, gap=0.0, verlet=0.01, settle=0, settling=0.7,
                               still=1, steps=10)
    model = rockable_blocks.Rockable(str(program), given, found)
    equal("contacts before the first step", model.carrying(), (0, 0))
    model.points = 4.0
    model.run(10, 0.3)
    asked = dict(line.split(" ", 1) for line in (folder / "run" / "asked.txt").read_text().splitlines() if " " in line)
    near("steps asked for", float(asked["tmax"]) / 1e-3, 9.5, 1e-9)
    near("damping asked for", float(asked["numericalDampingCoeff"]), 0.3, 0)
    near("stiffness of a point", float((folder / "run" / "asked.txt").read_text().split("knContact 1 1 ")[1].split()[0]),
         1e9 * 0.5 / 4, 1e-3)
    equal("fixed ones asked for", int(asked["nDriven"]), model.fixed)
    equal("pairs that carry, and points", model.carrying(), (2, 3))
    near("mean speed", model.speed(), 5, 1e-12)
    near("what the fixed blocks bear", model.borne() * model.weight, -1.0, 1e-9)
    model.keep(folder / "kept.txt")
    other = rockable_blocks.Rockable(str(program), given, found)
    other.resume(folder / "kept.txt")
    equal("a state comes back", (other.points, other.state), (4.0, model.state))
    moved = rockable_blocks.Rockable(str(program), given, [found[0], *found[5:]])
    moved.start(folder / "kept.txt")
    equal("blocks start from another model's places", [row[4:7] for row in moved.particles()[1:]],
          [row[4:7] for row in model.particles()[5:]])
    equal("and stand still", moved.speed(), 0.0)
    given.folder = folder / "two"
    heavy = blocks.read(MODEL)
    heavy[-1].density = 3000
    refused("a second density", lambda: rockable_blocks.Rockable("x", given, heavy), "one density")
    program.write_text("#!/bin/sh\nexit 3\n")
    refused("a program that fails", lambda: model.run(1, 0), "failed")


def check_absence(folder):
    said = io.StringIO()
    runner = argparse.Namespace(out=folder, quick=True, rows=[])
    for name in ("BOX3D", "ROCKABLE"):
        os.environ.pop(name, None)
    os.environ["PATH"] = str(folder / "nothing")
    with contextlib.redirect_stdout(said):
        peers.beside(runner, None)
    equal("lines where neither is installed", len(said.getvalue().splitlines()), 2)
    equal("figures then", runner.rows, [])
    os.environ["BOX3D"] = str(folder)
    refused("a prefix without Box3D", lambda: peers.build_box3d(runner), "no libbox3d")


def check_tables():
    def row(**given):
        return {"threads": "1", "unit": "contacts/s", **given}

    rows = [row(workload="talus wall", size="8", blocks="8", contacts="10", points="90", reuse="on", rate=rate,
                block_steps_per_s=steps) for rate, steps in (("1e6", "8e5"), ("4e6", "3.2e6"), ("3e6", "2.4e6"))]
    merged = peers.medians(rows)
    equal("medians of three turns", [(r["rate"], r["block_steps_per_s"]) for r in merged], [("3e+06", "2.4e+06")])
    merged.append(row(workload="rockable wall", size="8", blocks="8", contacts="10", points="40", reuse="", rate="1e5",
                      block_steps_per_s="8e4"))
    head, body = table.beside_table(merged, "rockable")
    equal("columns", len(head), len(body[0]))
    equal("ratios with reuse, a contact, a point and a block", body[0][7:10], ["30", "67.5", "30"])
    equal("none without", body[0][10:], ["", "", ""])
    timed = [row(workload="talus falling", blocks="20", contacts="9", reuse="on", rate="8", unit="s"),
             row(workload="box3d falling", blocks="20", contacts="7", points="9", reuse="on", rate="2", unit="s")]
    equal("a time: how many times as fast", table.beside_table(timed, "box3d")[1][0][9], "0.25")
    equal("other tables leave these rows out", (table.workload_table(merged)[1], table.figure_table(timed)[1]), ([], []))
    near("median of an even number", rockable_blocks.median([4, 1, 2, 9]), 3, 0)


with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    model_blocks, told = blocks.read(MODEL), ask_talus(place)
    equal("blocks", len(model_blocks), len(told))
    equal("fixed ones first", [block.fixed for block in model_blocks[:6]], [True] * 5 + [False])
    check_moments(model_blocks)
    check_shapes(model_blocks, told, place)
    check_points(model_blocks, told, place)
    check_rockable(model_blocks, place)
    check_tables()
    check_absence(place)

for fault in FAULTS:
    print(f"test_peers.py: {fault}")
print(f"peers: {len(FAULTS)} faults")
sys.exit(1 if FAULTS else 0)
