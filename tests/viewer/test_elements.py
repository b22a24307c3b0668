#!/usr/bin/env python3
"""Elements in the page, against what the program says of them (elements.lua).

    test_elements.py            all tests; without Chromium one sentence, and status 77 (status 1 where TALUS_BROWSER is "required")
    test_elements.py NAME...    some tests
"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from harness import check, run_tests, show  # noqa: E402

SINGLE = 2e-6      # what single precision leaves of places and numbers, with room for a few roundings
FACE = 8           # flag of an element that is a polygon


def told(folder):
    return {e["id"]: e for e in json.loads((folder / "elements.json").read_text())}


def drawn(chrome):
    """The elements of the frame: lists of points with their numbers by name, by id."""
    return {e["id"]: e for e in chrome.run("""(f => { const e = f.data.elements, out = []; let p = 0;
        for (let i = 0; i < e.n; p += e.points[i++])
            out.push({ id: e.id[i], kind: f.head.elements[e.kind[i]], flags: e.flags[i],
                points: Array.from({ length: e.points[i] }, (_v, k) => [0, 1, 2].map(c => e.place[3 * (p + k) + c] + f.head.origin[c])),
                numbers: Object.fromEntries(f.data.elementFields.map(n => [f.head.elementFields[n.field].name, [...n.value.subarray(p, p + e.points[i])].map(v => isNaN(v) ? null : v)])) });
        return out; })(talus.app.frame)""")}


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def moments(element):
    """Area of a polygon, the force of a pressure that is linear on it, and the force times its place."""
    corners, pressure = element["points"], element["numbers"]["pressure"]
    area, force, moment = 0.0, 0.0, [0.0, 0.0, 0.0]
    for k in range(1, len(corners) - 1):
        tri, p = [corners[0], corners[k], corners[k + 1]], [pressure[0], pressure[k], pressure[k + 1]]
        part = sum(x * x for x in cross(sub(tri[1], tri[0]), sub(tri[2], tri[0]))) ** 0.5 / 2
        area += part
        force += part * sum(p) / 3
        for a in range(3):
            for b in range(3):
                for c in range(3):
                    moment[c] += part * p[a] * (tri[b][c] - corners[0][c]) * (2 if a == b else 1) / 12
    return area, force, moment


def near(a, b, scale):
    return abs(a - b) <= SINGLE * scale


def test_lines(chrome, folder):
    """Bars have the places, tensions and states that the program tells; quiet faces are not there."""
    show(chrome, folder / "elements.html")
    wanted, got = told(folder), drawn(chrome)
    lines = {i for i, e in wanted.items() if e["kind"] in ("bolt", "spring")}
    check({i for i, e in got.items() if not e["flags"] & FACE} == lines and len(lines) == 4, f"lines {sorted(got)} instead of {sorted(lines)}")
    check(not any(e["kind"] == "quiet" for e in got.values()) and any(e["kind"] == "quiet" for e in wanted.values()), "quiet faces are shown")
    for i in lines:
        nodes, points = wanted[i]["nodes"], got[i]["points"]
        # places are in single precision from an origin within 10 m
        check(len(nodes) == len(points) and all(near(a, b, 10) for n, p in zip(nodes, points) for a, b in zip(n["place"], p)), f"element {i} is elsewhere")
        most = max(abs(n.get("tension", 0)) for n in nodes)
        check(wanted[i]["kind"] == "spring" or all(near(n["tension"], t, most) for n, t in zip(nodes, got[i]["numbers"]["tension"])), f"element {i} has other tensions")
        check(near(got[i]["numbers"]["axial"][0], wanted[i]["axial"], abs(wanted[i]["axial"])), f"element {i} has another axial force")
        check(got[i]["flags"] & 1 == wanted[i]["yielded"], f"element {i} has the flags {got[i]['flags']}")
    check(sum(wanted[i]["yielded"] for i in lines) > 0, "no bolt has yielded")


def test_walls(chrome, folder):
    """Wet polygons have the areas of the program, and their pressures its forces and moments; nothing dry is drawn."""
    show(chrome, folder / "elements.html")
    wanted, got = told(folder), drawn(chrome)
    wet = {i for i, e in wanted.items() if e["kind"] == "water" and max(n["pressure"] for n in e["nodes"]) > 0}
    check({i for i, e in got.items() if e["flags"] & FACE} == wet and len(wet) > 4, f"walls {[i for i in got if got[i]['flags'] & FACE]} instead of {sorted(wet)}")
    for i in wet:
        nodes = wanted[i]["nodes"][:len(wanted[i]["nodes"]) // 2]
        area, force, moment = moments(got[i])
        corner = got[i]["points"][0]
        whole = sum(n["pressure"] * n["weight"] for n in nodes)
        # walls have moved by some 1e-4 m against each other since their polygons were found
        check(abs(area / wanted[i]["area"] - 1) < 1e-3, f"wall {i} has {area} m2 instead of {wanted[i]['area']}")
        check(abs(force / whole - 1) < 2e-3, f"wall {i} bears {force} N instead of {whole}")
        for c in range(3):
            by = sum(n["pressure"] * n["weight"] * (n["place"][c] - corner[c]) for n in nodes)
            check(abs(moment[c] - by) < 2e-3 * whole * area ** 0.5, f"wall {i} has the moment {moment} N m, of which {c} should be {by}")


def test_colours(chrome, folder):
    """Bars are there at first look, walls when they are asked for; the highest number has the darkest colour; a click tells what an element is."""
    show(chrome, folder / "elements.html")
    titles, rods, sheets, ghosts = chrome.run("(a => [a.legends.map(l => l.title), a.gpu.arrows.count, a.gpu.sheets.solid, a.shown.ghosts])(talus.app)")
    nodes = sum(len(e["nodes"]) - 1 for e in told(folder).values() if e["kind"] in ("bolt", "spring"))
    check("Tension, N" in titles and "Axial, N" in titles and rods == nodes and sheets == 0 and not ghosts, f"at first look there are {titles}, {rods} of {nodes} rods, {sheets} corners of walls")
    offered = chrome.run("[...document.querySelector('select[aria-label=\"elements\"]').options].map(o => o.value)")
    check(offered[:3] == ["", "none", "state"] and {"tension", "pressure", "axial", "slip"} <= set(offered) and "cut" not in offered and "shift_x" not in offered, f"colours {offered}")
    titles, sheets, ghosts, colours = chrome.run("""(async a => { const old = a.gpu.sheets.set; let mesh; a.gpu.sheets.set = function (m) { mesh = m; old.call(this, m); };
        a.view.elements = 'pressure'; a.change('pose'); await a.drawn(); const u8 = new Uint8Array(mesh.data);
        return [a.legends.map(l => l.title), a.gpu.sheets.solid, a.shown.ghosts, Array.from({ length: mesh.solid }, (_v, k) => [...u8.subarray(32 * k + 20, 32 * k + 23)])]; })(talus.app)""")
    check("Pressure, Pa" in titles and sheets > 0 and ghosts, f"walls: {titles}, {sheets} corners, ghosts {ghosts}")
    check(len({tuple(c) for c in colours}) > 4 and all(c[0] <= 240 for c in colours), f"walls have the colours {colours}")
    words = chrome.run("""(async a => { a.view.elements = 'state'; a.change('pose'); await a.drawn(); const w = a.canvas.width, h = a.canvas.height;
        const names = a.gpu.names(a.sight(w, h), a.lookNow(), w, h, [0, 0, w, h]), k = names.findIndex(n => n >= 0xa0000000 && n < 0xc0000000 && !(a.frame.data.elements.flags[n - 0xa0000000] & 8));
        if (k < 0) return null; const x = (k % w + 0.5) * a.width / w, y = (h - 0.5 - Math.floor(k / w)) * a.height / h; a.pickAt(x, y, false);
        return [a.legends.map(l => l.title), document.getElementById('status').textContent]; })(talus.app)""")
    check(words and "Elements: state" in words[0] and words[1].startswith("Element ") and ("bolt" in words[1] or "spring" in words[1]) and " N" in words[1], f"a click says {words}")
    gone = chrome.run("(async a => { a.view.elements = 'none'; a.change('pose'); await a.drawn(); return [a.gpu.arrows.count, a.gpu.sheets.solid, a.shown.ghosts]; })(talus.app)")
    check(gone == [0, 0, False], f"with none there are {gone}")


def test_section(chrome, folder):
    """A section leaves out what lies above it of bars and walls, and the blocks are solid."""
    show(chrome, folder / "elements.html", "#elements=pressure&cut=1&dip=0&direction=0&position=-0.5")
    high, ghosts = chrome.run("""(a => { const e = a.frame.data.elements, top = a.plane.position; let most = -Infinity; const old = a.gpu.arrows.set;
        a.gpu.arrows.set = function (list) { for (const r of list) most = Math.max(most, r.tail[2], r.tail[2] + r.way[2]); old.call(this, list); };
        a.change('colour'); return a.drawn().then(() => [most - top, a.shown.ghosts]); })(talus.app)""")
    check(abs(high) < 1e-4 and not ghosts, f"bars end {high} m above the section")


def test_damage(chrome, folder):
    """Damaged elements are refused in a sentence."""
    show(chrome, folder / "elements.html")
    for chunk, at, value, wanted in (("ELEM", 0, 1000000, "values of"), ("ELEM", 4, 3, "add up"), ("EFLD", 0, 99, "has no name"), ("EFLD", 4, 7, "values for")):
        said = chrome.run(f"""(async m => {{ const good = m.frames[1].buffer ?? (await m.frame(1), m.frames[1].buffer), bytes = new Uint8Array(good.slice(0)), view = new DataView(bytes.buffer);
            let k = 0;
            while (String.fromCharCode(...bytes.subarray(k, k + 4)) !== {chunk!r}) k += 8 + ((view.getUint32(k + 4, true) + 3) & ~3);
            view.setUint32(k + 8 + {at}, {value}, true);
            const other = new m.constructor();
            other.addFrame(m.frames[0].buffer, null);
            try {{ other.addFrame(bytes.buffer, null); return null; }} catch (e) {{ return e.message; }} }})(talus.app.model)""")
        check(said and said.startswith(f"The chunk {chunk}") and wanted in said and said.endswith("."), f"{chunk} with {value} at {at} says {said!r}")


TESTS = {name[5:]: value for name, value in list(globals().items()) if name.startswith("test_")}

if __name__ == "__main__":
    sys.exit(run_tests("test_elements.py", "elements.lua", TESTS))
