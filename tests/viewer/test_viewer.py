#!/usr/bin/env python3
"""The page that model:write_html writes, in a browser: what it shows is compared with what the program says of the model.

    test_viewer.py                  all tests; without Chromium one sentence, and status 77 (status 1 where TALUS_BROWSER is "required")
    test_viewer.py --renew          writes the golden pictures anew
    test_viewer.py --picture FILE   writes the picture of docs/screen.md
    test_viewer.py NAME...          some tests

Pictures are drawn by SwiftShader, in software, the same on all machines.
"""
import base64
import json
import math
import os
import pathlib
import random
import re
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from chrome import SIMILAR, Chrome, program, read_png, similarity  # noqa: E402

HERE = pathlib.Path(__file__).parent
PROGRAM = os.environ.get("TALUS_PROGRAM", "build/release/talus")
SECTION = "#frame=3&cut=1&dip=70&direction=200"  # with tests/viewer/pages.lua
SECTION_AT = (30, 20, 14)
WIDTH, HEIGHT = 640, 400
AREA = 1e-5       # relative difference of a section polygon's area
COLOUR = 3        # of 255
CONTRAST = 4.5    # of text (WCAG 2.1, level AA)
RAYS = 200
SCRIPT = 120000   # characters of the page's script
NOTHING = 0xffffffff

faults = []


def check(condition, sentence):
    if not condition:
        faults.append(sentence)
        print("  " + sentence)


def show(chrome, page, fragment=""):
    """Opens a page and waits for its first picture."""
    chrome.log.clear()
    chrome.open(page, fragment)
    chrome.run("talus.ready.then(() => talus.app.drawn())")


def close_to(a, b, tolerance):
    return all(abs(x - y) <= tolerance for x, y in zip(a, b))


# ---------------------------------------------------------------- what is seen

def test_not_empty(chrome, folder):
    """Most of the middle of the picture shows blocks, many of them, neither black nor white, and the failed ones in their colour."""
    show(chrome, folder / "slope.html")
    chrome.run("talus.app.settled()")
    names = chrome.run(f"[...{names_of()}]")
    seen = {n & 0xffffff for n in names if n != NOTHING}
    share = sum(n != NOTHING for n in names) / len(names)
    check(0.1 < share < 0.8, f"blocks cover {share:.2f} of the picture")
    check(20 < len(seen) <= 49, f"{len(seen)} blocks are seen")
    picture = canvas(chrome)
    inside = [p for y, row in enumerate(picture) for x, p in enumerate(row) if names[(HEIGHT - 1 - y) * WIDTH + x] != NOTHING]
    mean = sum(map(sum, inside)) / 3 / len(inside)
    check(120 < mean < 220, f"the blocks' mean brightness is {mean:.0f}")
    red = sum(r > g + 60 and r > b + 60 for r, g, b in inside)
    check(red > 0.01 * len(inside), f"{red} of {len(inside)} pixels show a failed block")
    words = chrome.run("document.getElementById('findings').textContent")
    check("accelerating: 4 blocks" in words, f"the page says: {words}")


def reds(chrome):
    """Pixels in the colour of what has moved."""
    return sum(r > g + 60 and r > b + 60 for row in canvas(chrome) for r, g, b in row)


def test_verdict(chrome, folder):
    """At first look what has but closed is grey and at rest, what slides is red and has failed, in the words of the program."""
    for name, word, red, bad in (("column", "at rest", False, False), ("stands", "at rest", False, False), ("slide", "failed", True, True)):
        show(chrome, folder / f"{name}.html")
        words, loud = chrome.run("(e => [e.textContent, e.className === 'bad'])(document.getElementById('findings'))")
        check(words == (folder / f"{name}.txt").read_text().replace(" m3)", " m³)") and word in words, f"{name}: the page says: {words}")
        check(loud == bad and (reds(chrome) > 200) == red, f"{name}: {reds(chrome)} red pixels, and a finding that is{'' if loud else ' not'} loud")
    check(chrome.run("document.getElementById('counts').textContent").endswith("1 contacts, 1 slipping · stage “weaker”"), "the counts are not those of the model")
    show(chrome, folder / "slide.html", "#colour=safety")
    classes = chrome.run("talus.app.legends[0].items.map(i => i.name)")
    check(classes == ["below 1.0", "1.0 to 1.2", "1.2 to 1.3 (limit)", "1.3 (limit) to 1.5", "1.5 to 2", "above 2", "no keyblock"], f"classes of safety: {classes}")
    colours = chrome.run("talus.app.legends[0].items.map(i => i.colour.join())")
    check(len(set(colours)) == len(colours), f"two classes have one colour: {colours}")


def test_contact(chrome, folder):
    """A picked contact tells what it carries, a picked block its contacts."""
    show(chrome, folder / "slide.html")
    chrome.run("talus.app.pick(2), talus.app.drawn()")
    check(chrome.run("[...document.querySelectorAll('#picked details button')].map(b => b.textContent)") == ["1: slipping, 100 %"], "the contacts of a block are not listed")
    chrome.run("document.querySelector('#picked details button').click(), talus.app.drawn()")
    check(chrome.run("document.querySelector('#picked h2').textContent") == "Contact of blocks 1 and 2", "the contact is not picked")
    table = dict(chrome.run("[...document.querySelectorAll('#picked tr')].map(r => [...r.cells].map(c => c.textContent))"))
    check(table["state"] == "slipping" and table["blocks"] == "1 and 2" and table["strength used"] == "100 %", f"the contact is told as {table}")
    check(abs(float(table["normal force"].split()[0]) / 8e4 - 1) < 0.02 and abs(float(table["shear stress"].split()[0]) / (2e4 * math.tan(math.radians(25))) - 1) < 0.02, f"the contact carries {table}")


def test_narrow(chrome, folder):
    """On a telephone no panel lies on another one."""
    overlap = """(() => { const seen = ['head', 'picked', 'legend', 'controls', 'net', 'time', 'more', 'status'].map(i => document.getElementById(i)).filter(e => e.checkVisibility() && e.textContent + e.childElementCount !== '0');
        const box = seen.map(e => e.getBoundingClientRect()), out = [];
        for (let i = 0; i < seen.length; i++) for (let k = 0; k < i; k++) if (Math.min(box[i].right, box[k].right) - Math.max(box[i].left, box[k].left) > 1 && Math.min(box[i].bottom, box[k].bottom) - Math.max(box[i].top, box[k].top) > 1) out.push(`${seen[k].id} and ${seen[i].id}`);
        return out; })()"""
    chrome.resize(390, 760)
    for fragment, act in (("", ""), ("#net=1", ""), ("#frame=3", "talus.app.pick(92)"), ("#frame=3&net=1&contacts=state", "talus.app.pickContact(talus.app.frame.data.contacts.id[0])")):
        show(chrome, folder / "slope.html", fragment)
        chrome.run(f"{act or 0}, talus.app.drawn()")
        found = chrome.run(overlap)
        check(found == [], f"at {fragment or 'the beginning'} {act} these lie on each other: {found}")
    chrome.resize(WIDTH, HEIGHT)


WORDS = {"stable": "stable", "falling": "falls", "sliding": "slides on one face", "sliding on two": "slides on two faces"}


def test_table(chrome, folder):
    """A click on a block shows what the program says of it, and Escape lets it go; keyblocks are those of model:keyblocks."""
    show(chrome, folder / "slope.html")
    blocks, seen = json.loads((folder / "slope.json").read_text()), set()
    for block in blocks:
        if not block["key"] or block["key"] in seen:
            continue
        seen.add(block["key"])
        chrome.run(f"talus.app.pick({block['id']}), talus.app.drawn()")
        table = dict(chrome.run("[...document.querySelectorAll('#picked tr')].map(r => [...r.cells].map(c => c.textContent))"))
        check(table["keyblock"] == WORDS[block["key"]], f"block {block['id']}: {table['keyblock']}, the program says {block['key']}")
        check(abs(float(table["volume"].split()[0]) - block["volume"]) <= 0.01 * block["volume"], f"block {block['id']}: volume {table['volume']}, the program says {block['volume']}")
    check(len(seen) >= 3, f"the model has only keyblocks that are {seen}")
    x, y, block = chrome.run("""(a => { const s = a.sight(a.width, a.height), row = a.frame.rows[a.frame.poses.id.indexOf(92)], p = talus.toPixel(s, a.shown.place.subarray(3 * row, 3 * row + 3), a.width, a.height);
        const b = a.at(p[0], p[1]); return [p[0], p[1], b.kind === 'block' ? a.frame.poses.id[a.frame.at[b.index]] : -1]; })(talus.app)""")
    chrome.click(x, y)
    chrome.run("talus.app.drawn()")
    check(block > 0 and chrome.run("document.querySelector('#picked h2').textContent") == f"Block {block}", f"a click at {x:.0f}, {y:.0f} does not pick block {block}")
    chrome.key("Escape", 27)
    chrome.run("talus.app.drawn()")
    check(chrome.run("document.getElementById('picked').hidden"), "Escape does not let go of the block")


def names_of():
    return (f"(a => a.gpu.names(a.sight({WIDTH}, {HEIGHT}), a.lookNow(), {WIDTH}, {HEIGHT}, [0, 0, {WIDTH}, {HEIGHT}]))(talus.app)")


def canvas(chrome):
    """The picture alone, without the page around it."""
    return read_png(base64.b64decode(chrome.run("talus.app.canvas.toDataURL('image/png')").split(",")[1]))


def planes_of(folder, section, hidden):
    """Of each block that is shown: id and planes n x <= d, also that of the section."""
    blocks = json.loads((folder / "slope.json").read_text())
    return [(b["id"], b["planes"] + ([section] if section else [])) for b in blocks if b["id"] not in hidden]


def cast(blocks, start, way):
    """Id of the block that a ray meets first, NOTHING when it meets none."""
    first, found = math.inf, NOTHING
    for block, planes in blocks:
        enter, leave = 0.0, math.inf
        for a, b, c, d in planes:
            speed, away = a * way[0] + b * way[1] + c * way[2], d - a * start[0] - b * start[1] - c * start[2]
            if speed > 0:
                leave = min(leave, away / speed)
            elif speed < 0:
                enter = max(enter, away / speed)
            elif away < 0:
                leave = -1
            if leave < enter:
                break
        if enter < leave and enter < first:
            first, found = enter, block
    return found


def test_ids(chrome, folder):
    """The block at a pixel is the one that a ray through it meets first: whole, cut, with hidden blocks, in perspective and parallel."""
    dip, direction = math.radians(70), math.radians(200)
    normal = (math.sin(dip) * math.sin(direction), math.sin(dip) * math.cos(direction), math.cos(dip))
    plane = [*normal, sum(n * p for n, p in zip(normal, SECTION_AT))]
    for fragment, section, hidden in (("", None, ()), ("#frame=3&hidden=90,92&parallel=1", None, (90, 92)), ("cut", plane, ())):
        show(chrome, folder / "slope.html", place_section(chrome, folder) if fragment == "cut" else fragment)
        blocks = planes_of(folder, section, hidden)
        names = chrome.run(f"[...{names_of()}]")
        rows = chrome.run("Object.fromEntries([...talus.app.frame.rows].map((r, i) => [r, talus.app.frame.poses.id[i]]))")
        back, origin = chrome.run(f"[...talus.app.sight({WIDTH}, {HEIGHT}).back]"), chrome.run("talus.app.model.head.origin")

        def place(x, y, depth):
            v = (2 * x / WIDTH - 1, 2 * y / HEIGHT - 1, depth, 1)
            p = [sum(back[4 * c + r] * v[c] for c in range(4)) for r in range(4)]
            return [p[i] / p[3] + origin[i] for i in range(3)]

        def ray(x, y):
            a, b = place(x, y, -1), place(x, y, 1)
            return cast(blocks, a, [q - p for p, q in zip(a, b)])

        pick, compared, wrong = random.Random(7), 0, 0
        while compared < RAYS:
            x, y = pick.randrange(WIDTH), pick.randrange(HEIGHT)
            expected = {ray(x + 0.5 + dx, y + 0.5 + dy) for dx, dy in ((0, 0), (0.8, 0), (-0.8, 0), (0, 0.8), (0, -0.8))}
            if len(expected) > 1 or (NOTHING in expected and pick.random() < 0.9):
                continue  # an edge; and the sky is mostly left out
            name = names[y * WIDTH + x]
            wrong += (NOTHING if name == NOTHING else rows[str(name & 0xffffff)]) not in expected
            compared += 1
        check(wrong == 0, f"{wrong} of {RAYS} rays meet another block than the picture shows ({fragment or 'whole'})")


# ---------------------------------------------------------------- section and colours

def place_section(chrome, folder):
    """Address of the section that pages.lua has written."""
    show(chrome, folder / "slope.html", SECTION)
    position = chrome.run(f"""(a => {{ const n = a.plane.normal, o = a.model.head.origin, at = {list(SECTION_AT)};
        return a.view.position + n.reduce((t, v, i) => t + v * (at[i] - o[i]), 0) - a.plane.position; }})(talus.app)""")
    return f"{SECTION}&position={position:.9g}"


def read_section(path):
    """Area by block of a section that write_section wrote (legacy VTK, binary, big-endian)."""
    data = path.read_bytes()

    def numbers(pattern, code, per):
        found = re.search(pattern, data)
        count = int(found.group(1)) * per
        return struct.unpack_from(f">{count}{code}", data, found.end())

    points = numbers(rb"POINTS (\d+) double\n", "d", 3)
    polygons, ids = numbers(rb"POLYGONS \d+ (\d+)\n", "i", 1), numbers(rb"CELL_DATA (\d+)\nSCALARS block_id int 1\nLOOKUP_TABLE default\n", "i", 1)
    areas, at = {}, 0
    for block in ids:
        corners = [points[3 * i:3 * i + 3] for i in polygons[at + 1:at + 1 + polygons[at]]]
        total = [0.0, 0.0, 0.0]
        for a, b in zip(corners[1:], corners[2:]):
            u, v = [a[i] - corners[0][i] for i in range(3)], [b[i] - corners[0][i] for i in range(3)]
            for i in range(3):
                total[i] += (u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2]) / 2
        areas[block] = areas.get(block, 0) + math.hypot(*total)
        at += polygons[at] + 1
    return areas


def test_section(chrome, folder):
    """The section's polygons are those of write_section."""
    show(chrome, folder / "slope.html", place_section(chrome, folder))
    cuts = dict(chrome.run("talus.app.cuts.map(c => [talus.app.frame.poses.id[talus.app.frame.at[c.row]], c.area])"))
    wanted = read_section(next(folder.glob("slope_section_*.vtk")))
    check(len(wanted) > 15 and set(cuts) == set(wanted), f"the page cuts {sorted(cuts)}, write_section {sorted(wanted)}")
    for block in set(cuts) & set(wanted):
        check(abs(cuts[block] - wanted[block]) <= AREA * wanted[block], f"block {block}: area {cuts[block]} instead of {wanted[block]}")


def test_colours(chrome, folder):
    """A pixel of a section has the colour that the legend has at the block's value."""
    moved = {b["id"]: b["displacement"] for b in json.loads((folder / "slope.json").read_text())}
    show(chrome, folder / "slope.html", "#frame=3&cut=1&dip=90&direction=180&position=-3&edges=0&colour=displacement&camera=20,15,32,28,20,13")
    chrome.run("talus.app.settled()")
    found = chrome.run("""(a => { const s = a.sight(a.width, a.height), box = document.querySelector('#legend canvas').getBoundingClientRect(), h = a.legends[0];
        return { box: [box.x, box.y], high: h.high, cuts: a.cuts.map(c => [a.frame.poses.id[a.frame.at[c.row]], ...talus.toPixel(s, c.middle, a.width, a.height),
            a.at(...talus.toPixel(s, c.middle, a.width, a.height)).face === talus.CAP_FACE]) }; })(talus.app)""")
    window, picture, values = chrome.picture(), canvas(chrome), set()
    for block, x, y, _depth, visible in found["cuts"]:
        if not (visible and 0 < x < WIDTH and 0 < y < HEIGHT):
            continue
        share = moved[block] / found["high"]
        legend = window[int(found["box"][1] + 27)][int(found["box"][0] + min(179, share * 179) + 0.5)]
        pixel = picture[int(y)][int(x)]
        values.add(round(share, 1))
        check(close_to(pixel, legend, COLOUR), f"block {block}: {pixel} in the picture, {legend} in the legend at {moved[block]:.4g} m")
    check(len(values) > 1, f"the section shows only the values {values}")


def test_contacts(chrome, folder):
    """Contacts are seen within transparent blocks, and as traces in a section of solid ones; a joint that is chosen has a legend of its own."""
    seen = f"(n => [n.filter(v => v >= 0x80000000 && v < 0xc0000000).length, talus.app.shown.ghosts])({names_of()})"
    found = {}
    for solid in ("", "yes", "no"):
        for cut in (0, 1):
            show(chrome, folder / "slope.html", f"#frame=3&contacts=state&solid={solid}&cut={cut}&dip=90&direction=180&position=3&camera=20,15,40,28,20,13")
            found[solid, cut] = chrome.run(seen)
    for key, clear in {("", 0): True, ("", 1): False, ("yes", 0): False, ("yes", 1): False, ("no", 0): True, ("no", 1): True}.items():
        check(found[key][1] == clear, f"contacts with blocks shown '{key[0]}' and cut {key[1]}: ghosts are {found[key][1]}")
    check(found["", 0][0] > 5000 and found["no", 1][0] > 5000, f"pixels of contacts in transparent blocks: {found}")
    check(300 < found["", 1][0] < 10000, f"pixels of contacts in a section: {found}")
    show(chrome, folder / "slope.html", "#frame=3")
    names = chrome.run("talus.app.view.joint = talus.app.frame.head.joints[2], talus.app.change('colour'), talus.app.drawn().then(() => [talus.app.view.joint, ...talus.app.legends[0].items.map(i => i.name)])")
    check(names[1:] == [names[0], "other faces"], f"of the joint {names[0]} the legend has {names[1:]}")


# ---------------------------------------------------------------- golden pictures

GOLDEN = {
    "first": "",
    "section": "#frame=3&cut=1&dip=90&direction=180&position=3&parallel=1&arrows=displacement&camera=0,0,32,28,20,14",
    "contacts": "#frame=3&contacts=state&opacity=0.15&camera=60,30,48,28,20,12",
    "exploded": "#frame=3&explode=0.4&colour=joint&dark=1&camera=130,30,70,28,20,12",
    "picked": "#frame=2&colour=group&picked=92&hidden=90&moved=0.001&camera=110,40,42,28,20,12",
}


def test_golden(chrome, folder, renew=False):
    """Five views look as they did. Edges are smoothed less than in the golden pictures: similarities are 0.99 and more."""
    chrome.samples = 4
    for name, fragment in GOLDEN.items():
        show(chrome, folder / "slope.html", fragment)
        chrome.run("talus.app.settled()")
        data = base64.b64decode(chrome.run("talus.app.canvas.toDataURL('image/png')").split(",")[1])
        path = HERE / "golden" / f"{name}.png"
        if renew:
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(data)
            continue
        found = similarity(read_png(data), read_png(path.read_bytes()))
        if found <= SIMILAR:
            (folder / f"{name}.png").write_bytes(data)
        check(found > SIMILAR, f"{name}: similarity {found:.4f}; the picture is {folder}/{name}.png")
    chrome.samples = 1


# ---------------------------------------------------------------- the page

def test_damage(chrome, folder):
    """Streams that are cut off or changed end in a sentence, and leave the model as it was."""
    show(chrome, folder / "names.html")
    result = chrome.run("""(a => {
        const good = new Uint8Array(a.model.frames[0].buffer), Model = a.model.constructor, other = [];
        let refused = 0, taken = 0, seed = 12345;
        const next = (n) => { seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0; return Math.floor(seed / 4294967296 * n); };
        for (let i = 0; i < 600; i++) {
            let bytes = good.slice();
            if (i % 3 === 0) bytes = bytes.slice(0, next(bytes.length));
            else for (let k = 0; k <= i % 3; k++) bytes[next(bytes.length)] ^= 1 << next(8);
            const model = new Model();
            try { model.addFrame(bytes.buffer, null); taken++; }
            catch (e) { refused++; if (!/^(The|A|Frame) .*\\.$/.test(e.message) || e.constructor !== Error) other.push(String(e)); if (model.frames.length || model.rows) other.push("it kept something"); }
        }
        return { refused, taken, other: other.slice(0, 5) };
    })(talus.app)""")
    check(result["refused"] > 200 and not result["other"], f"of 600 damaged streams: {result}")
    page = (folder / "names.html").read_text()
    for name, text in (("cut", re.sub(r"(<script type=.text/talus[^>]*>[\w+/=]{400})[\w+/=]*", r"\1", page)), ("none", re.sub(r"<script type=.text/talus.*?</script>", "", page, flags=re.S))):
        path = folder / f"{name}.html"
        path.write_text(text)
        chrome.open(path)
        chrome.run("talus.ready.catch(() => 0)")
        words = chrome.run("new Promise(done => setTimeout(() => done(document.getElementById('status').textContent), 50))")
        check(words.endswith(".") and "page" in words, f"a page that is damaged ({name}) says: {words!r}")
    source = "(given => { HTMLCanvasElement.prototype.getContext = function (kind, ...more) { return kind === 'webgl2' ? null : given.call(this, kind, ...more); }; })(HTMLCanvasElement.prototype.getContext)"
    script = chrome.call("Page.addScriptToEvaluateOnNewDocument", source=source)["identifier"]
    chrome.open(folder / "slope.html")
    chrome.run("talus.ready.then(() => talus.app.drawn())")
    words = chrome.run("document.getElementById('status').textContent")
    check("WebGL 2" in words and "finding, chart and stereonet are" in words, f"a browser without WebGL 2 is told: {words!r}")
    seen = chrome.run("[document.getElementById('findings').textContent.length, ...['#net canvas', '#time .chart canvas'].map(s => (c => new Set(c.getContext('2d').getImageData(0, 0, c.width, c.height).data).size)(document.querySelector(s)))]")
    check(all(n > 10 for n in seen), f"without WebGL 2 finding, net and chart are {seen}")
    chrome.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


def test_policy(chrome, folder):
    """Names are text, whatever is in them; scripts added afterwards do not run and nothing is fetched."""
    show(chrome, folder / "names.html")
    hostile = "</script><img src=x onerror=alert(1)>"
    chrome.run("talus.app.view.net = true, talus.app.view.colour = 'group', talus.app.pick(talus.app.frame.poses.id[0]), talus.app.drawn()")
    check(chrome.log == [], f"the page reports {chrome.log}")
    check(chrome.run("document.title") == hostile and chrome.run("document.getElementById('title').textContent") == hostile, "the title is not as the model has it")
    check(chrome.run("document.images.length + document.querySelectorAll('b, iframe, object, link').length") == 0, "a name has become an element")
    check(hostile in chrome.run("document.getElementById('picked').textContent"), "the table does not show the name")
    check(chrome.run("document.querySelector('script').textContent.length") < SCRIPT, f"the page's script has {SCRIPT} characters or more")
    check(chrome.run("talus.app.legends[0].items[0].name") == hostile, "the legend does not show the name")
    ran = chrome.run("""new Promise(done => { window.ran = []; const s = document.createElement('script'); s.textContent = 'window.ran.push("script")'; document.body.append(s);
        const d = document.createElement('div'); d.setAttribute('onclick', 'window.ran.push("handler")'); document.body.append(d); d.click();
        try { setTimeout('window.ran.push("text")', 0); } catch {}
        fetch('http://127.0.0.1:9/').then(() => window.ran.push('fetch'), () => 0).then(() => setTimeout(() => done(window.ran), 100)); })""")
    check(ran == [], f"what the page's policy should refuse has run: {ran}")
    check(sum("Content Security Policy" in line for line in chrome.log) >= 3, f"the browser has not refused by the policy: {chrome.log}")


LUMINANCE = """const L = (c) => { const v = c.slice(0, 3).map(x => (x /= 255) <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4); return 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]; };
    const rgb = (text) => { const e = document.createElement('i'); document.body.append(e); e.style.color = text; const c = getComputedStyle(e).color.match(/[\\d.]+/g).map(Number); e.remove(); return c; };"""


def test_access(chrome, folder):
    """Every control has a name and is reached by Tab; keys turn, step, pick and hide; text has contrast; nothing moves by itself."""
    chrome.resize(720, 500)  # smaller windows fold the controls away
    chrome.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
    show(chrome, folder / "slope.html")
    chrome.run("talus.app.view.net = true, talus.app.pick(90), talus.app.drawn()")
    wanted = chrome.run("""[...document.querySelectorAll('button, select, input, canvas[tabindex]')].filter(e => e.checkVisibility()).map((e, i) => {
        e.dataset.mark = i; const label = e.closest('label');
        return [i, e.getAttribute('aria-label') || (label ? label.textContent : e.textContent)]; })""")
    for mark, name in wanted:
        check(re.search(r"\w", name or "") is not None, f"control {mark} has no name")
    reached, last = set(), None
    chrome.run("document.activeElement.blur()")
    for _ in range(len(wanted) + 5):
        chrome.key("Tab", 9)
        last = chrome.run("document.activeElement.dataset.mark ?? ''")
        reached.add(last)
        if len(reached) == 8:
            check(chrome.run("getComputedStyle(document.activeElement).outlineStyle") == "solid", "the focus is not seen")
    missing = [name for mark, name in wanted if str(mark) not in reached]
    check(not missing, f"Tab does not reach {missing}")
    state = "JSON.stringify([talus.app.view.frame, talus.app.camera.bearing, talus.app.camera.height, talus.app.view.picked, talus.app.view.hidden.size])"
    chrome.run("document.getElementById('picture').focus()")
    before = json.loads(chrome.run(state))
    for key, code, index in (("ArrowLeft", 37, 1), ("+", 187, 2), (",", 188, 0), (".", 190, 0), ("h", 72, 4), ("s", 83, 4)):
        chrome.key(key, code, key if len(key) == 1 else "")
        chrome.run("talus.app.drawn()")
        now = json.loads(chrome.run(state))
        check(now[index] != before[index], f"the key {key} changes nothing: {now}")
        before = now
    chrome.run("talus.app.pick(92)")
    chrome.key("Escape", 27)
    check(chrome.run("talus.app.view.picked") == -1, "Escape does not let go of the block")
    check(chrome.run("document.getElementById('status').getAttribute('aria-live')") == "polite", "the state has no aria-live line")
    frame, bearing = chrome.run("talus.app.view.frame"), chrome.run("talus.app.camera.bearing")
    chrome.run("new Promise(done => setTimeout(done, 400))")
    check((frame, bearing) == (chrome.run("talus.app.view.frame"), chrome.run("talus.app.camera.bearing")), "the picture moves by itself")
    for dark in ("false", "true"):
        poor = chrome.run(f"""(() => {{ document.documentElement.classList.toggle('dark', {dark}); {LUMINANCE}
            const style = getComputedStyle(document.documentElement), of = (n) => rgb(style.getPropertyValue(n));
            return ['--ink', '--soft', '--warm', '--accent'].flatMap(a => ['--panel', '--top', '--low'].map(b => {{ const x = L(of(a)) + 0.05, y = L(of(b)) + 0.05;
                return [a, b, Math.max(x, y) / Math.min(x, y)]; }})).filter(c => c[2] < {CONTRAST}); }})()""")
        check(not poor, f"contrasts below {CONTRAST}: {poor}")
    check(chrome.run("document.querySelectorAll('#time table td').length") > 2, "the history is not there as text")
    chrome.call("Emulation.setEmulatedMedia", features=[])
    chrome.resize(WIDTH, HEIGHT)


def test_controls(chrome, folder):
    """Every choice, slider, box and button does something without an error, and playing goes to the last frame."""
    chrome.resize(720, 400)
    show(chrome, folder / "slope.html", "#frame=3&picked=92&camera=56,25,66,26,22,8")
    same = chrome.run("""(async () => {
        const a = talus.app, same = [], shot = () => a.gpu.names(a.sight(180, 100), a.lookNow(), 180, 100, [0, 0, 180, 100]).join() + a.legends.map(l => l.title).join() + JSON.stringify(a.view) + a.camera.text();
        const use = async (e, name, act) => { const before = shot(); act(); e.dispatchEvent(new Event('input')); e.dispatchEvent(new Event('change'));
            await a.drawn(); if (shot() === before) same.push(name); };
        for (const e of [...document.querySelectorAll('#controls select')].filter(e => e.checkVisibility())) {
            for (const o of [...e.options].reverse()) if (o.value !== e.value) await use(e, e.ariaLabel + ': ' + o.textContent, () => { e.value = o.value; });
            await use(e, e.ariaLabel, () => { e.value = e.options[0].value; });
        }
        for (const e of document.querySelectorAll('#controls input[type=range]')) {
            const was = e.value;
            await use(e, e.ariaLabel, () => { e.value = (Number(e.min) + 2 * Number(e.max)) / 3; });
            await use(e, e.ariaLabel, () => { e.value = was; });
        }
        for (const e of [...document.querySelectorAll('#controls input[type=checkbox]')].filter(e => e.checkVisibility())) for (const twice of [0, 1]) await use(e, e.parentNode.textContent, () => { e.checked = !e.checked; });
        for (const e of [...document.querySelectorAll('#controls button')].filter(b => !['Image', 'Find', 'Add'].includes(b.textContent))) {
            a.view.hidden.add(88); a.pick(92); a.camera.turn(31, 17);
            await use(e, e.textContent, () => e.click());
        }
        return same;
    })()""")
    # the first of a list is chosen twice
    check([s for s in same if s not in ("arrows", "contacts", "blocks", "shown")] == [], f"these change nothing: {same}")
    check(chrome.run("document.getElementById('status').className") == "" and chrome.log == [], f"the page reports {chrome.log}")
    check(chrome.run("talus.app.gpu.gl.getError()") == 0, "WebGL reports an error")
    chrome.run("talus.app.goTo(0)")
    chrome.run("document.querySelector('#time .play').click()")
    check(chrome.run("new Promise(done => { const t = Date.now(), look = () => talus.app.view.frame === 3 || Date.now() - t > 60000 ? done(talus.app.view.frame) : setTimeout(look, 20); look(); })") == 3, "playing stops before the last frame")
    for name in ("largest", "picked", "line:4", "line:5"):
        chrome.run(f"talus.app.chart = '{name}', talus.app.change('look'), talus.app.drawn()")
        words = chrome.run("document.querySelector('#time canvas').getAttribute('aria-label')")
        check(re.search(r"[\d.]+ at the end", words) is not None, f"the chart {name} says: {words}")
    chrome.resize(WIDTH, HEIGHT)


def test_address(chrome, folder):
    """The address holds the view: what a page writes there shows the same when it is opened anew."""
    show(chrome, folder / "slope.html", "#frame=1&cut=1&dip=60&direction=120&position=1.5&colour=velocity&moved=0.01&hidden=88&opacity=0.3&parallel=1")
    chrome.run("talus.app.settled()")
    text = chrome.run("location.hash")
    for part in ("frame=1", "cut=1", "dip=60", "direction=120", "position=1.5", "colour=velocity", "moved=0.01", "hidden=88", "parallel=1", "camera="):
        check(part in text, f"{part} is not in {text}")
    names = chrome.run(f"[...{names_of()}].join()")
    show(chrome, folder / "slope.html", text)
    check(chrome.run(f"[...{names_of()}].join()") == names, "the same address shows another picture")
    show(chrome, folder / "slope.html", "#frame=99&dip=-400&direction=x&camera=1,2&hidden=a,-1&colour=%ZZ&__proto__=1&motion=Infinity")
    check(chrome.run("talus.app.view.frame") == 3 and chrome.run("document.getElementById('status').textContent") == "", "a wrong address is not put up with")


def test_image(chrome, folder):
    """The exported image has twice the resolution, title and legend."""
    show(chrome, folder / "slope.html", "#frame=3&camera=60,30,45,28,20,12")
    data = chrome.run("""talus.makeImage(2).then(b => new Promise(done => { const r = new FileReader(); r.onload = () => done(r.result); r.readAsDataURL(b); }))""")
    picture = read_png(base64.b64decode(data.split(",")[1]))
    check((len(picture[0]), len(picture)) == (2 * WIDTH, 2 * HEIGHT), f"the image has {len(picture[0])} x {len(picture)} pixels")
    colours = {p for row in picture[-160:-20] for p in row[40:400]}
    check(any(r > g + 100 and r > b + 60 for r, g, b in colours), "the image has no legend")
    check(sum(sum(p) < 200 for row in picture[30:70] for p in row[40:500]) > 300, "the image has no title")


TESTS = {name[5:]: value for name, value in list(globals().items()) if name.startswith("test_")}


def main():
    words = [w for w in sys.argv[1:] if w != "--renew"]
    if not program():
        required = os.environ.get("TALUS_BROWSER") == "required"
        print("test_viewer.py: no Chromium, so the pages of write_html were not looked at" + (", which is required here" if required else ": skipped"))
        return 1 if required else 77
    with tempfile.TemporaryDirectory(prefix="talus_viewer_") as name:
        folder = pathlib.Path(name)
        subprocess.run([PROGRAM, "--quiet", str(HERE / "pages.lua"), name], check=True, cwd=HERE.parents[1])
        if "--picture" in words:
            with Chrome(1280, 800) as chrome:
                chrome.samples = 0
                show(chrome, folder / "slope.html", "#frame=3&net=1&picked=92&camera=56,25,66,26,22,8")
                chrome.run("talus.app.settled()")
                pathlib.Path(words[-1]).write_bytes(base64.b64decode(chrome.call("Page.captureScreenshot", format="png")["data"]))
            return 0
        with Chrome(WIDTH, HEIGHT) as chrome:
            for test in words or TESTS:
                begun = time.monotonic()
                if test == "golden":
                    test_golden(chrome, folder, "--renew" in sys.argv)
                else:
                    TESTS[test](chrome, folder)
                print(f"{test}: {time.monotonic() - begun:.1f} s")
    print(f"test_viewer.py: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
