#!/usr/bin/env python3
"""The blocks of a block model in Rockable's sphero-polyhedra, timed as Talus is.

    tests/bench/rockable_blocks.py wall.json --workload "rockable wall" --size 1000 --folder build/bench/rockable

The program is that of the variable ROCKABLE, or `rockable` on the PATH. What rounds a sphero-polyhedron, RADIUS, is taken off its
faces first, so that they lie where those of the block do; mass and inertia are the block's. A contact is a pair of bodies with at
least one contact point (a vertex on a face, an edge or a vertex, or two edges) that bears a force. Each point has its own
stiffness: a first step tells how many points a pair has on average, and each gets that part of KN times --area, so that a
pair is as stiff as in Talus. The blocks then come to rest, unless --settle is 0. Stretches of --steps steps follow, each a
run of the program from the state the last one left, less the processor time of a run of one step from there. Prints rows of
CSV. Only Rockable's files are used."""

import argparse
import math
import os
import pathlib
import resource
import shutil
import subprocess
import sys

import blocks

KN, KS = 1e9, 5e8  # Pa/m
FRICTION = math.tan(0.6)
GRAVITY = 9.81
RADIUS = 0.02  # m
FIXED, FREE = 0, 1  # groups
# Interaction in a file of Rockable: i j type isub jsub n dn pos vel fn ft mom damp, vectors in three.
FIRST, SECOND, UP, FORCE, SHEAR_UP = 0, 1, 7, 15, 18
# Particle: shape group cluster size pos vel acc Q vrot arot.
PLACE, VELOCITY, TURN = slice(4, 7), slice(7, 10), slice(13, 17)
LOOSE = 2.0  # points of a pair where none touches at the start
BORNE = 0.25  # of the weight of all: jitter of blocks at rest
OFTEN = 500  # steps between looks at whether blocks lie still


def solve(matrix, right):
    """3 x 3, by Cramer's rule."""
    a, b, c = (list(column) for column in zip(*matrix))
    whole = blocks.dot(a, blocks.cross(b, c))
    return [blocks.dot(right, blocks.cross(b, c)) / whole, blocks.dot(a, blocks.cross(right, c)) / whole,
            blocks.dot(a, blocks.cross(b, right)) / whole]


def shrunk(block, radius):
    """Vertices of the block when each face goes inwards by `radius`. More than three faces of a corner meet in no point in general: the
    one that is nearest to all counts."""
    moved = []
    for number, vertex in enumerate(block.vertices):
        normals = [block.normal(face) for face in block.faces if number in face]
        matrix = [[sum(n[i] * n[j] for n in normals) for j in range(3)] for i in range(3)]
        right = [-radius * sum(n[i] for n in normals) for i in range(3)]
        moved.append([p + d for p, d in zip(vertex, solve(matrix, right))])
    return moved


def numbers(values):
    return " ".join(f"{value + 0.0:.12f}" for value in values)


def shape(block, radius, gap=0.0):
    """Rockable's text of a shape whose faces lie `gap` within the block's, without its name; the axes of the body in the space,
    rows."""
    moments, axes = blocks.principal(block.inertia)
    if max(moments) - min(moments) < 1e-9 * max(moments):  # a cube's: any axes will do
        axes = [[float(i == j) for j in range(3)] for i in range(3)]
    points = [[blocks.dot(axis, blocks.subtract(vertex, block.centre)) for axis in axes] for vertex in shrunk(block, radius + gap)]
    least, most = ([bound(column) for column in zip(*points)] for bound in (min, max))
    edges = block.edges()
    lines = [f"radius {radius}", "preCompDone y", f"volume {block.volume:.12g}", f"I/m {numbers(moments)}",
             "obb.extent " + numbers((q - p) / 2 + radius for p, q in zip(least, most)),
             "obb.center " + numbers((q + p) / 2 for p, q in zip(least, most)),
             "obb.e1 1 0 0", "obb.e2 0 1 0", "obb.e3 0 0 1", f"nv {len(points)}", *map(numbers, points),
             f"ne {len(edges)}", *(f"{a} {b}" for a, b in edges), f"nf {len(block.faces)}",
             *(" ".join(map(str, [len(face), *face])) for face in block.faces)]
    return "\n".join(lines) + "\n", axes


def write_shapes(found, path, radius=RADIUS, gap=0.0):
    """Writes the shape file: one shape for all blocks that are alike. Returns the particles' lines."""
    names, particles = {}, []
    with open(path, "w") as file:
        for block in found:
            text, axes = shape(block, radius, gap)
            if text not in names:
                names[text] = f"S{len(names)}"
                file.write(f"<\nname {names[text]}\n{text}>\n")
            where = " ".join(f"{x:.17g}" for x in [*block.centre, *[0] * 6, *blocks.quaternion(axes), *[0] * 6])
            particles.append(f"{names[text]} {FIXED if block.fixed else FREE} 0 1 {where}")
    return particles


class Rockable:
    """A model of Rockable in a folder of its own."""

    def __init__(self, program, given, found):
        self.program, self.given = program, given
        self.folder = pathlib.Path(given.folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        densities = {block.density for block in found}
        if len(densities) > 1:
            sys.exit(f"rockable: blocks have one density here, not {sorted(densities)}")
        self.density = densities.pop()
        self.fixed = sum(block.fixed for block in found)
        self.free = len(found) - self.fixed
        self.weight = sum(block.density * block.volume * GRAVITY for block in found if not block.fixed)
        particles = write_shapes(found, self.folder / "blocks.shp", gap=given.gap)
        self.state = "\n".join([f"Particles {len(particles)}", *particles]) + "\n"
        self.points = 1.0  # of a pair, on average

    def head(self, steps, damping):
        """What a file says before its particles. Lists of neighbours are made anew when a block has moved by a quarter of what
        they reach; how far blocks turn is left out, for that test of Rockable strikes at nearly every step."""
        given, kn = self.given, KN * self.given.area / self.points
        lines = ["Rockable 21-08-2022", "t 0", f"tmax {(steps - 0.5) * given.dt:.17g}", f"dt {given.dt:.17g}", "interVerlet 1e9",
                 f"interConf {steps * given.dt:.17g}", f"DVerlet {2 * given.verlet}", f"dVerlet {given.verlet}",
                 "dynamicUpdateNL 1", f"dispUpdateNL {given.verlet / 4}", "angleUpdateNL 400",
                 f"density {FIXED} {self.density}", f"density {FREE} {self.density}", f"gravity 0 0 {-GRAVITY}",
                 f"numericalDampingCoeff {damping}", "forceLaw Default", "AddOrRemoveInteractions bruteForce", "UpdateNL linkCells",
                 "Integrator velocityVerlet", "cellMinSizes 1.2 1.2 1.2", "boxForLinkCellsOpt 1", "ContactPartnership None"]
        for first in (FIXED, FREE):
            for name, value in (("kn", kn), ("kt", kn * KS / KN), ("en2", 1), ("mu", FRICTION), ("kr", 0), ("mur", 0)):
                lines.append(f"{name}Contact {first} {FREE} {value:.17g}")
        return "\n".join([*lines, "iconf 0", f"nDriven {self.fixed}", "shapeFile blocks.shp", "precision 16", ""])

    def run(self, steps, damping, keep=True):
        """Processor time of the program for so many steps. Goes on from where they lead, unless `keep` is false."""
        (self.folder / "input.txt").write_text(self.head(steps, damping) + self.state)
        last = self.folder / "conf1"
        last.unlink(missing_ok=True)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([self.program, "-v", "2", "input.txt"], cwd=self.folder, capture_output=True, text=True, check=False,
                              env={**os.environ, "OMP_NUM_THREADS": "1"})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode != 0 or not last.exists():
            sys.exit(f"rockable: the program failed in {self.folder}:\n{done.stdout[-1000:]}{done.stderr[-1000:]}")
        if keep:
            text = last.read_text()
            self.state = text[text.index("\nParticles ") + 1:]
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def interactions(self):
        """Their lines in the state, none before the first step."""
        if "\nInteractions " not in self.state:
            return []
        lines = self.state[self.state.index("\nInteractions ") + 1:].splitlines()
        return [line.split() for line in lines[1:1 + int(lines[0].split()[1])]]

    def borne(self):
        """Part of the weight of the free blocks that the fixed ones bear: 1 at rest."""
        force = 0.0
        for cells in self.interactions():
            first, second = int(cells[FIRST]) < self.fixed, int(cells[SECOND]) < self.fixed
            if first != second:
                up = float(cells[FORCE]) * float(cells[UP]) + float(cells[SHEAR_UP])
                force += -up if first else up
        return force / self.weight

    def carrying(self):
        """Pairs that bear a force, and their points that do; none before the first step."""
        pairs, points = set(), 0
        for cells in self.interactions():
            if float(cells[FORCE]) > 0:
                points += 1
                pairs.add((min(cells[FIRST], cells[SECOND]), max(cells[FIRST], cells[SECOND])))
        return len(pairs), points

    def speed(self):
        """Mean speed of the free blocks, m/s."""
        return sum(math.hypot(*map(float, row[VELOCITY])) for row in self.particles()[self.fixed:]) / self.free

    def settle(self):
        """Brings the blocks to rest, or near it: faces that lie corner on corner change the set of their points all the time."""
        for _ in range(0, self.given.settle, OFTEN):
            self.run(OFTEN, self.given.settling)
            if self.speed() < self.given.still:
                break
        if not abs(self.borne() - 1) < BORNE:
            sys.exit(f"rockable: the blocks are not at rest: what is fixed bears {self.borne():.3g} of their weight")

    def keep(self, path):
        """Writes the state, for other runs with the same options and for `start`."""
        path.write_text(f"{self.points:.17g}\n{self.state}")

    def resume(self, path):
        points, self.state = path.read_text().split("\n", 1)
        self.points = float(points)

    def particles(self):
        """Lines of the state: fixed blocks first."""
        lines = self.state.splitlines()
        return [line.split() for line in lines[1:2 + self.fixed + self.free] if not line.startswith("#")][:self.fixed + self.free]

    def start(self, path):
        """Free blocks stand still where those of another model's state do, which are as many; contacts begin anew."""
        other = path.read_text().split("\n", 1)[1].splitlines()
        count = int(other[0].split()[1])
        there = [line.split() for line in other[1:] if not line.startswith("#")][:count][-self.free:]
        mine = self.particles()
        for row, at in zip(mine[self.fixed:], there):
            row[PLACE], row[TURN] = at[PLACE], at[TURN]
        self.state = "\n".join([f"Particles {len(mine)}", *(" ".join(row) for row in mine)]) + "\n"

    def stretch(self):
        """Contacts, points, and processor time of a step, of one stretch."""
        pairs, points = self.carrying()
        idle = self.run(1, self.given.damping, keep=False)
        seconds = (self.run(1 + self.given.steps, self.given.damping) - idle) / self.given.steps
        pairs_after, points_after = self.carrying()
        return (pairs + pairs_after) / 2, (points + points_after) / 2, seconds


def median(values):
    values = sorted(values)
    return (values[(len(values) - 1) // 2] + values[len(values) // 2]) / 2


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", help="block model, JSON")
    parser.add_argument("--workload", default="rockable")
    parser.add_argument("--size", default="")
    parser.add_argument("--folder", default="build/bench/rockable", help="where Rockable's files go")
    parser.add_argument("--dt", type=float, default=2e-4, help="time step, s")
    parser.add_argument("--damping", type=float, default=0.2, help="share of the force")
    parser.add_argument("--area", type=float, default=1.0, help="of a contact, m2, for its stiffness")
    parser.add_argument("--gap", type=float, default=0.0, help="taken off every face: blocks start apart, m")
    parser.add_argument("--verlet", type=float, default=0.02, help="distance within which points are kept as candidates, m")
    parser.add_argument("--settle", type=int, default=20000, help="steps at most in which the blocks come to rest")
    parser.add_argument("--settling", type=float, default=0.7, help="damping meanwhile")
    parser.add_argument("--settled", help="file of the state at rest: taken from there, or written when it is not there")
    parser.add_argument("--start", help="such a file of another model with as many free blocks, which are set where those are")
    parser.add_argument("--still", type=float, default=1e-5, help="mean speed at rest, m/s")
    parser.add_argument("--warm", type=int, default=0, help="steps before the first stretch")
    parser.add_argument("--steps", type=int, default=100, help="of a stretch")
    parser.add_argument("--reps", type=int, default=3, help="stretches")
    return parser.parse_args()


def find_program():
    return os.environ.get("ROCKABLE") or shutil.which("rockable")


def prepare(model, given):
    """Chooses the stiffness, and brings the blocks to rest."""
    if given.start:
        model.start(pathlib.Path(given.start))
    fresh = model.state
    model.run(1, given.damping)
    pairs, points = model.carrying()
    model.points, model.state = points / pairs if pairs else LOOSE, fresh
    if given.settle:
        model.settle()


def main():
    given = arguments()
    program = find_program()
    if not program:
        sys.exit("rockable: no program; set ROCKABLE")
    model = Rockable(program, given, blocks.read(given.model))
    kept = given.settled and pathlib.Path(given.settled)
    if kept and kept.exists():
        model.resume(kept)
    else:
        prepare(model, given)
        if kept:
            model.keep(kept)
    if given.warm:
        model.run(given.warm, given.damping)
    stretches = [model.stretch() for _ in range(given.reps)]
    seconds = median(s for _, _, s in stretches)
    print("workload,size,blocks,contacts,points,threads,reuse,rate,unit,block_steps_per_s,speed")
    print(f"{given.workload},{given.size},{model.free},{median(c for c, _, _ in stretches):.0f},"
          f"{median(p for _, p, _ in stretches):.0f},1,,{median(c / s for c, _, s in stretches):.5g},contacts/s,"
          f"{model.free / seconds:.5g},{model.speed():.3g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
