#!/usr/bin/env python3
"""The joint pyramid and the circle of friction on the stereonet: against theory, a grid of directions, and model:keyblocks (nets.lua).

    test_stereonet.py            all tests; without Chromium one sentence, and status 77 (status 1 where TALUS_BROWSER is "required")
    test_stereonet.py NAME...    some tests
"""
import json
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from harness import check, run_tests, show  # noqa: E402

SINGLE = 1e-4   # what is left of a direction where faces meet at small angles in single precision
CASES = 600
MARGIN = 0.03   # of the grid: sine of the angle to its nearest direction, with room

# Brute force: of each set of normals the least that a direction of a grid of 20,000 runs into its worst face, by the page's own grid-free answer.
GRID = """((cases) => {
    const grid = [], golden = Math.PI * (3 - Math.sqrt(5));
    for (let i = 0; i < 20000; i++) { const z = 1 - 2 * (i + 0.5) / 20000, r = Math.sqrt(1 - z * z); grid.push([r * Math.cos(golden * i), r * Math.sin(golden * i), z]); }
    return cases.map((normals) => {
        const cone = talus.pyramid(normals), worst = (d) => normals.reduce((m, n) => Math.max(m, d[0] * n[0] + d[1] * n[1] + d[2] * n[2]), -1);
        let least = 1, differ = 0, spanned = 0;
        for (const d of grid) { const w = worst(d); least = Math.min(least, w); if ((w < -1e-3 && !cone.holds(d)) || (w > 1e-3 && cone.holds(d))) differ++; }
        // what edges span lies in the cone, and so do they
        for (let k = 0; k < 20 && cone.edges.length; k++) {
            const d = [0, 0, 0];
            cone.edges.forEach((e, i) => { const f = (i * 7 + k * 13) % 11; e.forEach((x, c) => { d[c] += f * x; }); });
            if (worst(d) > 2e-3 * Math.hypot(...d) + 1e-9) spanned++;
        }
        return { empty: cone.empty, edges: cone.edges.length, least, differ, spanned };
    });
})"""


def unit(v):
    size = math.hypot(*v)
    return [x / size for x in v]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def normal_of(dip, direction):
    d, t = math.radians(dip), math.radians(direction)
    return [math.sin(d) * math.sin(t), math.sin(d) * math.cos(t), math.cos(d)]


def told(folder, name):
    return json.loads((folder / f"{name}.json").read_text())


def faces(chrome, block):
    return chrome.run(f"talus.touchedFaces(talus.app.model, talus.app.frame, {block})")


def upper(chrome):
    """The highest block."""
    return chrome.run("(p => [...p.id].sort((a, b) => p.place[3 * p.id.indexOf(b) + 2] - p.place[3 * p.id.indexOf(a) + 2])[0])(talus.app.frame.poses)")


def net(chrome, block, joint=""):
    """Picks a block and shows the net: its words, and what a spy saw of its picture."""
    return chrome.run(f"""(async a => {{ a.view.net = true; a.pick({block}); a.view.joint = {joint!r}; a.change('colour'); await a.drawn(); await new Promise(r => setTimeout(r, 30));
        return [document.getElementById('nettext').textContent, document.getElementById('netfriction').textContent, document.querySelector('#net canvas').getAttribute('aria-label')]; }})(talus.app)""")


def test_planes(chrome, folder):
    """A block on a plane that dips 30 degrees to 90 moves into the half-space above; on two planes into what lies above both; a cube in the middle of 27 nowhere."""
    for name, planes in (("plane", [(30, 90)]), ("wedge", [(50, 60), (60, 140)])):
        show(chrome, folder / f"{name}.html")
        block = upper(chrome)
        normals, up = faces(chrome, block), [normal_of(*p) for p in planes]
        check(len(normals) == len(up) and all(min(math.dist(n, [-x for x in u]) for n in normals) < 1e-6 for u in up), f"{name}: the block lies on faces of {normals}")
        seed = random.Random(7)
        directions = [unit([seed.gauss(0, 1) for _ in range(3)]) for _ in range(500)]
        held = chrome.run(f"(cone => {json.dumps(directions)}.map(d => cone.holds(d)))(talus.pyramid({json.dumps(normals)}))")
        wrong = [d for d, h in zip(directions, held) if h != all(dot(d, u) >= 0 for u in up) and min(abs(dot(d, u)) for u in up) > 1e-3]
        check(not wrong and any(held) and not all(held), f"{name}: {len(wrong)} directions are wrong")
        words = net(chrome, block)
        check("can move where it is shaded" in words[0] and words[0] in words[2], f"{name}: the net says {words}")
    down = chrome.run(f"(c => [c.edges.length, c.empty])(talus.pyramid({json.dumps(normals)}))")
    check(down == [2, False], f"the wedge's pyramid has {down[0]} edges, the line where its planes meet both ways")
    show(chrome, folder / "inside.html")
    middle = chrome.run("(p => [...p.id].find((_id, i) => [0, 1, 2].every(c => Math.abs(p.place[3 * i + c] + talus.app.model.head.origin[c] - 1.5) < 1e-4)))(talus.app.frame.poses)")
    normals = faces(chrome, middle)
    words = net(chrome, middle)
    check(len(normals) == 6 and words[0] == f"Block {middle} cannot move: its joint pyramid is empty.", f"the cube inside has {len(normals)} faces on others, and the net says {words}")
    corner = chrome.run("talus.app.frame.poses.id[0]")
    check(len(faces(chrome, corner)) == 3 and "can move" in net(chrome, corner)[0], "a cube at a corner cannot move, or has others about it than three")


def test_grid(chrome, folder):
    """Whether a pyramid is empty, and what it holds, against a grid of directions, in random cases: loose ones, tight ones, slabs, and normals that are there twice."""
    show(chrome, folder / "plane.html")
    seed = random.Random(20)
    cases = []
    for k in range(CASES):
        normals = [unit([seed.gauss(0, 1) for _ in range(3)]) for _ in range(seed.randint(1, 7))]
        if k % 4 == 1:  # about a direction that is free
            free = unit([seed.gauss(0, 1) for _ in range(3)])
            normals = [n if dot(n, free) < 0 else [-x for x in n] for n in normals]
        elif k % 4 == 2:
            normals.append([-x for x in normals[0]])
        elif k % 4 == 3:
            normals.append(list(normals[-1]))
        cases.append(normals)
    got = chrome.run(f"{GRID}({json.dumps(cases)})")
    unclear = 0
    for case, g in zip(cases, got):
        check(g["differ"] == 0 and g["spanned"] == 0, f"{case}: {g}")
        if g["least"] < 0:
            check(not g["empty"], f"{case}: it is told to be empty, and a direction of the grid is free")
        elif g["least"] > MARGIN:
            check(g["empty"], f"{case}: it is not told to be empty, and each direction of the grid runs into a face by {g['least']}")
        else:
            unclear += 1
    empty = sum(g["empty"] for g in got)
    check(0.1 * CASES < empty < 0.9 * CASES and unclear < 0.3 * CASES, f"{empty} of {CASES} cases are empty, and {unclear} are beyond a grid")


def test_keyblocks(chrome, folder):
    """The pyramids are those of model:keyblocks, of cubes and of blocks as joints have cut them."""
    for name, least in (("inside", 20), ("rock", 20), ("slope", 4)):
        show(chrome, folder / f"{name}.html")
        bodies = told(folder, name)
        cones = chrome.run(f"{json.dumps([b['id'] for b in bodies])}.map(id => (c => c.empty ? null : c.edges)(talus.pyramid(talus.touchedFaces(talus.app.model, talus.app.frame, id))))")
        free = 0
        for body, edges in zip(bodies, cones):
            wanted = body["edges"]
            free += wanted is not None
            same = edges is None if wanted is None else edges is not None and len(edges) == len(wanted) and all(min(math.dist(e, w) for e in edges) < SINGLE for w in wanted)
            check(same, f"{name}: the pyramid of block {body['id']} has the edges {edges} instead of {wanted}")
        check(free >= least and (name == "slope" or free < len(bodies)), f"{name}: {free} of {len(bodies)} bodies can move")


def test_settled(chrome, folder):
    """Cubes that have come to rest with a slight turn lie on the base and on each other, however far its corners are."""
    show(chrome, folder / "tower.html")
    for block, count in ((2, 2), (3, 1)):
        words = net(chrome, block)[0]
        check(len(faces(chrome, block)) == count and "lies on no other" not in words, f"block {block} lies on {len(faces(chrome, block))} faces instead of {count}: {words}")


# What the net shows at places: how far its pixels about them differ from those without a picked block.
PIXELS = """(async (places) => {
    const c = document.querySelector('#net canvas'), pen = c.getContext('2d'), take = () => pen.getImageData(0, 0, c.width, c.height), now = take();
    const picked = talus.app.view.picked;
    talus.app.pick(-1);
    await talus.app.drawn();
    await new Promise(r => setTimeout(r, 30));
    const before = take(), R = 101, ox = 105, oy = 117;
    talus.app.pick(picked);
    await talus.app.drawn();
    return places.map(([u, v]) => { let n = 0; for (let y = -3; y <= 3; y++) for (let x = -3; x <= 3; x++) { const k = 4 * ((Math.round(oy + R * v) + y) * c.width + Math.round(ox + R * u) + x);
        n += [0, 1, 2, 3].some(i => now.data[k + i] !== before.data[k + i]) ? 1 : 0; } return n / 49; });
})"""


def on_net(d):
    d = [-x for x in d] if d[2] > 0 else d
    flat, r = math.hypot(d[0], d[1]), math.sqrt(max(0, 1 + d[2]))
    return [d[0] / flat * r, -d[1] / flat * r] if flat > 0 else [0, 0]


def test_drawn(chrome, folder):
    """Downward directions of the pyramid are shaded whole, upward ones hatched, the rest of the net is as it was."""
    seed = random.Random(3)
    for name, planes in (("plane", [(30, 90)]), ("wedge", [(50, 60), (60, 140)])):
        show(chrome, folder / f"{name}.html")
        net(chrome, upper(chrome))
        up, places, wanted = [normal_of(*p) for p in planes], [], []
        while len(places) < 60:
            d = unit([seed.gauss(0, 1) for _ in range(3)])
            d = [d[0], d[1], -abs(d[2])]
            if min(abs(dot(d, u)) for u in up) < 0.15 or abs(d[2]) < 0.15:
                continue  # a bound
            places.append(on_net(d))
            wanted.append((all(dot(d, u) > 0 for u in up), all(dot(d, u) < 0 for u in up)))
        got = chrome.run(f"{PIXELS}({json.dumps(places)})")
        for share, (down, above), place in zip(got, wanted, places):
            check(share > 0.95 if down else 0.05 < share < 0.7 if above else share < 0.05, f"{name}: at {place} {share:.2f} of the net has changed, where the block can move {'down' if down else 'up' if above else 'nowhere'}")
        check(any(d for d, _a in wanted) and any(a for _d, a in wanted) and (name == "plane" or any(not d and not a for d, a in wanted)), f"{name}: not all kinds of places were tried")


def test_friction(chrome, folder):
    """The circles of friction: of all joints where they agree, else of the chosen one; drawn at the angle, and told."""
    show(chrome, folder / "plane.html")
    spy = """(() => { window.arcs = []; const p = CanvasRenderingContext2D.prototype, old = p.arc; p.arc = function (x, y, r, ...rest) { if (this.canvas.closest('#net')) arcs.push([r, this.getLineDash().length]); return old.call(this, x, y, r, ...rest); }; })()"""
    chrome.run(spy)
    words = net(chrome, -1)
    arcs = chrome.run("arcs")
    inside, cone = 101 * math.sqrt(2) * math.sin(math.radians(55 / 2)), 101 * math.sqrt(2) * math.sin(math.radians(35 / 2))
    check(any(abs(r - inside) < 1e-6 and not dashed for r, dashed in arcs) and any(abs(r - cone) < 1e-6 and dashed for r, dashed in arcs), f"circles are drawn with the radii {arcs}")
    check(words[1].startswith("Friction 35°: steeper motions") and words[1] in words[2], f"the net says {words}")
    show(chrome, folder / "wedge.html")
    check(net(chrome, -1)[1] == "", "joints of several frictions have one circle")
    for joint, friction in (("left", 35), ("right", 20)):
        said = net(chrome, -1, joint)[1]
        check(said.startswith(f"Friction {friction}°"), f"joint {joint}: the net says {said!r}")
    show(chrome, folder / "inside.html")
    check(net(chrome, -1)[1] == "", "a model without joints has a friction")


TESTS = {name[5:]: value for name, value in list(globals().items()) if name.startswith("test_")}

if __name__ == "__main__":
    sys.exit(run_tests("test_stereonet.py", "nets.lua", TESTS))
