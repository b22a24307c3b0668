#!/usr/bin/env python3
"""Slivers and refused cuts in the page, against what the program says of them (lists.lua).

    test_lists.py            all tests; without Chromium one sentence, and status 77 (status 1 where TALUS_BROWSER is "required")
    test_lists.py NAME...    some tests
"""
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from harness import check, run_tests, show  # noqa: E402

WORST = 20
SINGLE = 2e-6  # what single precision leaves of a ratio of sizes; of an aspect, so many times more as the aspect is


def told(folder, name="slivers"):
    return json.loads((folder / f"{name}.json").read_text())


def go(chrome, frame):
    chrome.run(f"talus.app.goTo({frame}).then(() => talus.app.drawn())")


def part(chrome, words):
    """Opens the list of this heading: whether it is hidden, what it says, and the words of its buttons."""
    return chrome.run(f"""(async () => {{ const d = [...document.querySelectorAll('#controls details')].find(d => d.firstChild.textContent.startsWith({words!r}));
        window.list = d; d.open = true; await talus.app.drawn(); await new Promise(r => setTimeout(r, 20));
        return {{ hidden: d.hidden, heading: d.firstChild.textContent, text: d.textContent, cells: [...d.querySelectorAll('td')].map(t => t.textContent),
            buttons: [...d.querySelectorAll('button')].map(b => [b.textContent, b.disabled, b.getAttribute('aria-label') ?? b.textContent]) }}; }})()""")


def near(a, b):
    return abs(a - b) <= SINGLE * abs(b)


def test_slivers(chrome, folder):
    """The list has the blocks of the least volume over surface of the frame, and a click picks one and zooms to it."""
    show(chrome, folder / "slivers.html")
    for number, frame in enumerate(told(folder)):
        go(chrome, number)
        wanted = sorted(frame["blocks"], key=lambda b: (b["bulk"], b["id"]))[:WORST]
        got = part(chrome, "Slivers")
        ids = [int(text) for text, _off, _label in got["buttons"]]
        # blocks alike may stand in another order
        bulk = {b["id"]: b["bulk"] for b in frame["blocks"]}
        check(len(ids) == min(WORST, len(bulk)) and all(near(bulk[i], w["bulk"]) for i, w in zip(ids, wanted)), f"frame {number}: the slivers are {ids}, not {[b['id'] for b in wanted]}")
        check(all(abs(float(x.replace("−", "-")) / bulk[i] - 1) < 6e-3 for x, i in zip(got["cells"][1::3], ids)), f"frame {number}: volumes over surfaces are {got['cells'][1::3]}")
    check(len(bulk) > WORST, f"there are {len(bulk)} blocks only")
    before = chrome.run("talus.app.camera.height")
    chrome.run("list.querySelectorAll('button')[0].click(), talus.app.drawn()")
    picked, height = chrome.run("[talus.app.view.picked, talus.app.camera.height]")
    check(picked == ids[0] and height < before / 2, f"a click picks block {picked} in a picture of {height} m")


def test_measures(chrome, folder):
    """Aspects are those of the report, volumes over surfaces those of the faces; the thinnest block has the darkest colour."""
    show(chrome, folder / "slivers.html")
    frames = told(folder)
    go(chrome, 1)
    block = frames[1]["aspect_block"]
    rows = chrome.run(f"talus.app.pick({block}), talus.app.drawn().then(() => [...document.querySelectorAll('#picked tr')].map(r => [...r.cells].map(c => c.textContent)))")
    aspect = float(dict(rows)["aspect"])
    check(abs(aspect / frames[1]["aspect"] - 1) < 6e-3 + SINGLE * aspect, f"block {block} has the aspect {aspect} instead of {frames[1]['aspect']}")
    chrome.run("talus.app.pick(-1); const old = talus.app.gpu.table; talus.app.gpu.table = (name, data, wide) => { if (name === 'colour') window.colours = data; old(name, data, wide); };")
    lowest = min(b["bulk"] for f in frames for b in f["blocks"])
    highest = max(b["bulk"] for f in frames for b in f["blocks"])
    least = min(frames[1]["blocks"], key=lambda b: b["bulk"])["id"]
    for name, words, low, high, which in (("bulk", "Volume over surface, m", lowest, highest, least), ("aspect", "Aspect: diameter over thickness", None, max(f["aspect"] for f in frames), max(frames, key=lambda f: f["aspect"])["aspect_block"])):
        legend, offered, colour = chrome.run(f"""(async a => {{ a.view.colour = {name!r}; a.change('colour'); await a.goTo({0 if which in (1, 2) else 1}); await a.drawn();
            const row = a.model.rowOf({which}, a.frame.since);
            return [a.legends[0], [...document.querySelector('select[aria-label="blocks"]').options].map(o => o.value), [...colours.slice(4 * row, 4 * row + 3)]]; }})(talus.app)""")
        check(legend["title"] == words and name in offered, f"{name}: {legend['title']}, and {offered} are offered")
        check((low is None or near(legend["low"], low)) and abs(legend["high"] / high - 1) < SINGLE * max(1, high), f"{name}: the scale goes from {legend['low']} to {legend['high']}, not from {low} to {high}")
        check(colour == [134, 19, 39], f"{name}: block {which} has the colour {colour}")


def test_histories(chrome, folder):
    """The histories of a model can be chosen by their names and units."""
    show(chrome, folder / "sound.html")
    names, offered, last = chrome.run("(a => [a.frame.head.histories, [...document.querySelectorAll('option')].map(o => o.textContent), [...a.frame.summary.line.histories]])(talus.app)")
    check(len(names) == 2 and names[0].startswith("work, ") and names[1] == "how <b>often</b>", f"the histories are called {names}")
    check(all(name in offered for name in names), f"{names} are not among {offered}")
    check(len(last) == 2 and last[1] == 7.5, f"the last values of the histories are {last}")


def test_refused(chrome, folder):
    """Refused cuts stand in the list with the report's sentences; a click picks the block and lays the section where the cut would be."""
    show(chrome, folder / "slivers.html")
    frames = told(folder)
    without = re.compile(r"[-+−.\de]*\d")
    for number, frame in enumerate(frames):
        go(chrome, number)
        got, cuts = part(chrome, "Refused"), frame["refused"]
        there = {b["id"] for b in frame["blocks"]}
        check(got["hidden"] == (not cuts) and (not cuts or got["heading"] == f"Refused cuts: {len(cuts)}"), f"frame {number}: {got['heading']}")
        if not cuts:
            continue
        for (text, off, _label), cut in zip(got["buttons"], cuts):
            there_now = cut["block"] in there
            wanted = cut["reason"][0].upper() + cut["reason"][1:] + ("" if there_now else "; the block was cut or deleted since")
            numbers = [float(x.replace("−", "-")) for x in re.findall(r"[-+−.\de]*\d", text)]
            check(without.sub("", text) == without.sub("", wanted) and numbers == [float(x) for x in re.findall(r"[-+.\de]*\d", wanted)], f"frame {number}: {text!r} instead of {wanted!r}")
            check(off == (not there_now), f"frame {number}: the button of block {cut['block']} is {'off' if off else 'on'}")
        check(len(got["buttons"]) == len(cuts) > 2, f"frame {number}: {len(got['buttons'])} cuts are listed")
        check(number != 2 or any(off for _text, off, _label in got["buttons"]), "no block of a refused cut was deleted")
        for i, cut in enumerate(cuts):
            if cut["block"] not in there:
                continue
            chrome.run(f"list.querySelectorAll('button')[{i}].click(), talus.app.view.cut = true, talus.app.change('pose'), talus.app.drawn()")
            picked, plane, origin = chrome.run("[talus.app.view.picked, talus.app.plane, talus.app.model.head.origin]")
            away = sum(n * (p - o) for n, p, o in zip(plane["normal"], cut["point"], origin)) - plane["position"]
            cosine = sum(a * b for a, b in zip(plane["normal"], cut["normal"]))
            check(picked == cut["block"] and cosine > 1 - 1e-10 and abs(away) < 1e-5, f"frame {number}: the section of cut {i} lies {away} m away, turned by a cosine of {cosine}, and block {picked} is picked")
    show(chrome, folder / "sound.html")
    check(part(chrome, "Refused")["hidden"], "cuts are listed where none was refused")


def test_damage(chrome, folder):
    """A damaged list of refused cuts is refused in a sentence."""
    show(chrome, folder / "slivers.html")
    for at, value, wanted in ((4, 1000, "values of"), (8, 99, "joint"), (0, 7, None)):
        said = chrome.run(f"""(async m => {{ const good = m.frames[1].buffer ?? (await m.frame(1), m.frames[1].buffer), bytes = new Uint8Array(good.slice(0)), view = new DataView(bytes.buffer);
            let k = 0;
            while (String.fromCharCode(...bytes.subarray(k, k + 4)) !== 'REFU') k += 8 + ((view.getUint32(k + 4, true) + 3) & ~3);
            view.setUint32(k + 8 + {at}, {value}, true);
            const other = new m.constructor();
            other.addFrame(m.frames[0].buffer, null);
            try {{ other.addFrame(bytes.buffer, null); return null; }} catch (e) {{ return e.message; }} }})(talus.app.model)""")
        check(said is None if wanted is None else said and said.startswith("The chunk REFU") and wanted in said and said.endswith("."), f"a list with {value} at {at} says {said!r}")


TESTS = {name[5:]: value for name, value in list(globals().items()) if name.startswith("test_")}

if __name__ == "__main__":
    sys.exit(run_tests("test_lists.py", "lists.lua", TESTS))
