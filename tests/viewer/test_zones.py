#!/usr/bin/env python3
"""Deformable blocks on a page, against what the program says of their zones and gridpoints (zones.lua).

    test_zones.py            all tests; without Chromium one sentence, and status 77 (status 1 where TALUS_BROWSER is "required")
    test_zones.py NAME...    some tests; "renew" writes the golden pictures anew: look at them
"""
import base64
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from chrome import SIMILAR, read_png, similarity  # noqa: E402
from harness import HERE, check, run_tests, show  # noqa: E402

WIDTH, HEIGHT = 640, 400
SINGLE = 1e-6  # what single precision leaves of a number, against the largest of its kind
COLOUR = 3     # of 255
CUT = "cut=1&dip=90&direction=180&position=0&parallel=1&camera=0,0,3.4,0,0,1.2"
GOLDEN = {
    "zones_mesh": "#frame=2&motion=3&camera=25,20,5,0,0.5,1.2",
    "zones_section": f"#frame=2&zones=stress%20zz&colour=group&{CUT}",
    "zones_smooth": f"#frame=2&zones=deviator&smooth=1&mesh=0&colour=group&{CUT}",
    "zones_cross_section": f"#frame=2&mesh=0&crosses=1&colour=group&{CUT}",
    "zones_crosses": "#frame=2&crosses=1&colour=group&camera=15,12,4.4,0,0.5,1.2",
}


def told(folder, name):
    return json.loads((folder / f"{name}.json").read_text())


def canvas(chrome):
    return read_png(base64.b64decode(chrome.run("talus.app.canvas.toDataURL('image/png')").split(",")[1]))


def names_of():
    return f"(a => a.gpu.names(a.sight({WIDTH}, {HEIGHT}), a.lookNow(), {WIDTH}, {HEIGHT}, [0, 0, {WIDTH}, {HEIGHT}]))(talus.app)"


def close_to(a, b, tolerance):
    return all(abs(x - y) <= tolerance for x, y in zip(a, b))


def test_numbers(chrome, folder):
    """Numbers of zones are those of the program, also those that the page finds of the stress; gridpoints are where they are."""
    show(chrome, folder / "zones.html", "#frame=2")
    zones, points = told(folder, "zones"), told(folder, "points")
    states = chrome.run("talus.app.frame.head.zoneStates")
    for name, of in (("mean stress", lambda z: z["mean"]), ("deviator", lambda z: z["deviator"]), ("largest principal stress", lambda z: z["principal"][0]),
                     ("least principal stress", lambda z: z["principal"][2]), ("stress xx", lambda z: z["stress"][0]), ("stress zx", lambda z: z["stress"][5]),
                     ("plastic_shear", lambda z: z["plastic_shear"]), ("state", lambda z: states.index(z["state"]))):
        got, wanted = chrome.run(f"[...talus.column('zone:{name}')]"), [of(z) for z in zones]
        size = max(max(map(abs, z["stress"])) for z in zones) if "plastic" not in name and name != "state" else max(map(abs, wanted))
        worst = max(abs(a - b) for a, b in zip(got, wanted)) if len(got) == len(wanted) else math.inf
        check(len(zones) > 500 and worst <= 4 * SINGLE * size, f"{name} of {len(got)} zones is off by {worst:.3g} of {size:.3g}")
    check(0 < sum(z["state"] != "elastic" for z in zones) < len(zones), "all zones have yielded, or none")
    place, moved = chrome.run("[[...talus.app.frame.data.points.place], [...talus.app.frame.data.points.displacement]]")
    origin = chrome.run("talus.app.model.head.origin")
    check(len(place) == 3 * len(points), f"{len(place) / 3} gridpoints, not {len(points)}")
    for i, p in enumerate(points):
        here = [place[3 * i + c] + origin[c] for c in range(3)]
        check(close_to(here, p["position"], 1e-5) and close_to(moved[3 * i:3 * i + 3], p["displacement"], 1e-6), f"gridpoint {i}: at {here}, moved by {moved[3 * i:3 * i + 3]}")


def test_axes(chrome, folder):
    """Principal stresses and directions make up the stress again, also where two or three are the same."""
    show(chrome, folder / "zones.html", "#frame=2")
    tensors = [z["stress"] for z in told(folder, "zones")]
    tensors += [[-1, -1, -1, 0, 0, 0], [5, 2, 2, 0, 0, 0], [2, 2, 5, 0, 0, 0], [2, 5, 2, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 1, 0, 0], [1, 2, 3, 0, 0, 0], [3, 3, 3, 1e-3, 0, 0]]
    for tensor, (values, axes) in zip(tensors, chrome.run(f"{json.dumps(tensors)}.map(s => {{ const v = talus.principal(s); return [v, talus.principalAxes(s, v)]; }})")):
        size = max(map(abs, tensor)) or 1
        again = [sum(v * a[i] * a[k] for v, a in zip(values, axes)) for i, k in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))]
        check(values[0] >= values[1] - 1e-9 * size and values[1] >= values[2] - 1e-9 * size, f"{tensor}: {values} do not descend")
        check(close_to(again, tensor, 2e-5 * size), f"{tensor}: principal stresses {values} about {axes} are {again}")


def test_section(chrome, folder):
    """The section of the zones has the area of the block, and a pixel of it the colour of its zone's value in the legend."""
    show(chrome, folder / "zones.html", f"#frame=2&zones=stress%20zz&edges=0&{CUT}")
    chrome.run("talus.app.settled()")
    found = chrome.run("""(a => { const c = a.zoneCut, s = a.sight(a.width, a.height), box = document.querySelector('#legend canvas').getBoundingClientRect(), h = a.legends[1], out = []; let area = 0;
        for (let t = 0; t < c.row.length; t++) { const p = [0, 1, 2].map(k => c.place.slice(9 * t + 3 * k, 9 * t + 3 * k + 3)), e = [0, 1].map(k => p[k + 1].map((v, i) => v - p[0][i]));
            const n = [e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2], e[0][0] * e[1][1] - e[0][1] * e[1][0]], own = Math.hypot(...n) / 2; area += own;
            if (own > 0.02) out.push([c.zone[t], ...talus.toPixel(s, p[0].map((v, i) => (v + p[1][i] + p[2][i]) / 3), a.width, a.height)]); }
        return { area, low: h.low, high: h.high, title: h.title, box: [box.x, box.y], top: 58, out }; })(talus.app)""")
    check(abs(found["area"] / 15 - 1) < 0.01, f"the section has {found['area']} m2, not 15")
    check(found["title"] == "Stress zz, Pa" and found["low"] < 0, f"the legend is {found['title']} from {found['low']}")
    zones, window, picture, shares = told(folder, "zones"), chrome.picture(), canvas(chrome), set()
    for zone, x, y, _depth in found["out"]:
        share = (zones[zone]["stress"][2] - found["low"]) / (found["high"] - found["low"])
        legend = window[int(found["box"][1] + found["top"] + 27)][int(found["box"][0] + min(179, share * 179) + 0.5)]
        shares.add(round(share, 1))
        check(close_to(picture[int(y)][int(x)], legend, 2 * COLOUR), f"zone {zone}: {picture[int(y)][int(x)]} in the picture, {legend} in the legend")
    check(len(found["out"]) > 30 and len(shares) > 3, f"{len(found['out'])} zones are seen in the section, of the values {shares}")


def test_mesh(chrome, folder):
    """Each triangle of a mesh has a name of its own, all of them stand for the block; enlarged motion enlarges the mesh; a ghost is drawn as one."""
    seen = {}
    for mesh in (0, 1):
        show(chrome, folder / "zones.html", f"#frame=2&mesh={mesh}&camera=25,20,5,0,0.5,1.2")
        seen[mesh] = set(chrome.run(f"[...{names_of()}]"))
        rows = chrome.run("talus.app.model.rowOf(2, 2)")
        check(any(n & 0xffffff == rows for n in seen[mesh]), f"with mesh={mesh} the block is not seen")
    check(len(seen[0]) < 20 and len(seen[1]) > 60, f"names: {len(seen[0])} without a mesh, {len(seen[1])} with one")
    x, y = chrome.run("(a => talus.toPixel(a.sight(a.width, a.height), [0, 0, 1], a.width, a.height))(talus.app)")[:2]
    chrome.click(x, y)
    chrome.run("talus.app.drawn()")
    table = dict(chrome.run("[...document.querySelectorAll('#picked tr')].map(r => [...r.cells].map(c => c.textContent))"))
    zones = told(folder, "zones")
    yielded = sum(z["state"] != "elastic" for z in zones)
    check(chrome.run("document.querySelector('#picked h2').textContent") == "Block 2" and table["zones"] == f"{len(zones)}, {yielded} yielded", f"a click on the mesh tells {table}")
    check(table["held"] == "no", f"a deformable block that nothing holds counts as held: {table}")
    low = {}
    for motion in (1, 10):
        show(chrome, folder / "zones.html", f"#frame=2&motion={motion}")
        low[motion] = chrome.run("Math.min(...[...talus.app.shown.points].filter((_v, i) => i % 3 === 2 && talus.app.frame.surface.made[i] > 2.4))")
    made, points = 2.5, told(folder, "points")
    deepest = min(p["displacement"][2] for p in points if p["position"][2] - p["displacement"][2] > 2.4)
    for motion in (1, 10):
        check(abs(low[motion] - made - motion * deepest) < 1e-4, f"with its motion enlarged {motion} times the surface lies at {low[motion]}")
    show(chrome, folder / "zones.html", "#frame=2&ghosts=2&opacity=0.2")
    check(chrome.run("talus.app.gpu.zones.solid") == 0 and chrome.run("talus.app.gpu.zones.ghosts") > 300, "a ghost is solid")
    show(chrome, folder / "zones.html", "#frame=2&hidden=2")
    check(chrome.run("talus.app.gpu.zones.solid + talus.app.gpu.zones.ghosts") == 0, "a hidden block is drawn")


def test_controls(chrome, folder):
    """The controls of zones are there where there are zones; each colour has a legend; crosses tell their size."""
    show(chrome, folder / "zones.html", "#frame=2")
    names = chrome.run("[...[...document.querySelectorAll('#controls select')].find(s => s.getAttribute('aria-label') === 'zones').options].map(o => o.value)")
    check({"", "displacement", "state", "solid", "largest principal stress", "least principal stress", "mean stress", "deviator", "stress zz", "plastic_shear"} <= set(names), f"zones are coloured by {names}")
    for name in names[1:]:
        title = chrome.run(f"(talus.app.view.zones = {name!r}, talus.app.change('colour'), talus.app.drawn()).then(() => talus.app.legends.map(l => l.title).join('|'))")
        check(name == "displacement" or title.startswith("Displacement, m|") and len(title.split("|")) == 2, f"the legend of {name} is {title}")
    chrome.run("(talus.app.view.zones = 'state', talus.app.view.crosses = true, talus.app.change('colour'), talus.app.drawn())")
    label = chrome.run("document.getElementById('legend').getAttribute('aria-label')")
    check("elastic" in label and "compression, tension" in label and "longest cross" in label, f"the legend says {label}")
    check(chrome.run("talus.app.gpu.sheets.solid") > 300, "there are no crosses")


def test_damage(chrome, folder):
    """Damaged meshes and numbers end in a sentence, and leave the model as it was."""
    show(chrome, folder / "zones.html", "#frame=0")
    for name, at, value, wanted in (("SURF", 4, 10 ** 6, "values of"), ("SURF", 20 + 16, 0, None), ("SPOS", 0, 5, "does not fit its mesh"), ("ZFLD", 0, 99, "has no name"),
                                    ("ZFLD", 4, 3, "does not fit its mesh")):
        said = chrome.run(f"""(async m => {{ await m.frame(0); const bytes = new Uint8Array(m.frames[0].buffer.slice(0)), view = new DataView(bytes.buffer);
            let k = 0;
            while (String.fromCharCode(...bytes.subarray(k, k + 4)) !== {name!r}) k += 8 + ((view.getUint32(k + 4, true) + 3) & ~3);
            view.setUint32(k + 8 + {at}, {value}, true);
            const other = new m.constructor();
            try {{ other.addFrame(bytes.buffer, null); return null; }} catch (e) {{ return e.message + (other.frames.length ? ' kept' : ''); }} }})(talus.app.model)""")
        check(said is None if wanted is None else said and wanted in said and said.endswith("."), f"{name} with {value} at {at} says {said!r}")


def test_golden(chrome, folder, renew=False):
    """Five views look as they did."""
    chrome.samples = 4
    for name, fragment in GOLDEN.items():
        show(chrome, folder / "zones.html", fragment)
        chrome.run("talus.app.settled()")
        data = base64.b64decode(chrome.run("talus.app.canvas.toDataURL('image/png')").split(",")[1])
        path = HERE / "golden" / f"{name}.png"
        if renew:
            path.write_bytes(data)
            continue
        found = similarity(read_png(data), read_png(path.read_bytes()))
        check(found > SIMILAR, f"{name}: similarity {found:.4f}")
    chrome.samples = 1


def test_renew(chrome, folder):
    """Writes the golden pictures anew."""
    test_golden(chrome, folder, renew=True)


TESTS = {name[5:]: value for name, value in list(globals().items()) if name.startswith("test_")}

if __name__ == "__main__":
    if len(sys.argv) == 1:
        sys.argv += [name for name in TESTS if name != "renew"]
    sys.exit(run_tests("test_zones.py", "zones.lua", TESTS, (WIDTH, HEIGHT)))
