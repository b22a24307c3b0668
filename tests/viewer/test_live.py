#!/usr/bin/env python3
"""The page of a run in a browser: frames that come, the state of the run, and commands. A program of its own (mock_run.py) sends what a page
of model:write_html holds, so that every answer can be made to come.

    test_live.py            all tests; without Chromium one sentence, and status 77 (status 1 where TALUS_BROWSER is "required")
    test_live.py NAME...    some tests
"""
import base64
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from chrome import Chrome, program  # noqa: E402
from mock_run import MockRun, TOKEN, chunk, chunks, frames_of, live, split  # noqa: E402

HERE = pathlib.Path(__file__).parent
PROGRAM = os.environ.get("TALUS_PROGRAM", "build/release/talus")
WIDTH, HEIGHT = 900, 700
SOON = 30  # seconds in which something is to happen
HOSTILE = "</script><img src=x onerror=alert(1)>"
CTRL = 2   # modifier of an event

faults = []


def check(condition, sentence):
    if not condition:
        faults.append(sentence)
        print("  " + sentence)


def until(chrome, expression, seconds=SOON):
    """Value of an expression as soon as it counts as true, or its last value."""
    return chrome.run(f"""new Promise(done => {{ const end = Date.now() + {seconds * 1000}, look = () => {{ let v = null; try {{ v = {expression}; }} catch (e) {{ v = null; }}
        v || Date.now() > end ? done(v) : setTimeout(look, 20); }}; look(); }})""")


def watch(chrome, run):
    """Opens the page of a run and waits for its first picture."""
    chrome.log.clear()
    chrome.open(run.address)
    until(chrome, "talus.app.model.frames.length")
    chrome.run("talus.app.drawn()")


def words(chrome):
    return chrome.run("document.getElementById('status').textContent")


def press(chrome, name, part="body"):
    """Presses the button that has these words on it."""
    found = chrome.run(f"""(b => b && (b.click(), 1))([...document.querySelector({part!r}).querySelectorAll('button')].find(b => b.textContent === {name!r} && b.checkVisibility()))""")
    check(found, f"there is no button '{name}' in {part}")


def command_of(run, count):
    end = time.monotonic() + SOON
    while len(run.commands) < count and time.monotonic() < end:
        time.sleep(0.01)
    return run.commands[count - 1] if len(run.commands) >= count else None


def test_follow(chrome, page):
    """Frames are shown as they come, also in pieces; the state is told; the token leaves the address; after the end the picture stays."""
    frames = list(frames_of(page))
    with MockRun(page, piece=1000) as run:
        run.put(frames[0], live("running"))
        watch(chrome, run)
        check("token" not in chrome.run("location.href"), "the token stays in the address")
        for count, frame in enumerate(frames[1:], 2):
            run.put(frame)
            until(chrome, f"talus.app.view.frame === {count - 1} && talus.app.model.frames.length === {count}")
        check(chrome.run("talus.app.view.frame") == 3, "the newest frame is not shown")
        numbers = struct.unpack_from("<4d", dict(chunks(frames[3]))["LINE"])
        check(until(chrome, f"document.querySelector('.facts').textContent.includes('cycle {numbers[1]:.0f},')"), "the cycle is not told")
        facts = chrome.run("document.querySelector('.facts').textContent")
        found = re.fullmatch(r"cycle (\d+), time (\S+) s, dt\s(\S+)\ss, ratio (\S+)", facts)
        check(found is not None and all(abs(float(word.replace("−", "-")) - v) <= 0.005 * v for word, v in zip(found.groups(), (numbers[1], *numbers[:1], *numbers[2:]))), f"the state says: {facts}")
        check(chrome.run("document.querySelector('.state').textContent") == "Running", "the run is not said to run")
        run.put(frames[3], live("paused"))
        check(until(chrome, "document.querySelector('[role=status].unseen').textContent.startsWith('Paused: cycle ')"), "the pause is not told in a line for the state")
        check(chrome.run("document.querySelector('[role=status].unseen').getAttribute('aria-live')") == "polite", "the state has no aria-live line")
        # what is looked at stays, while frames come
        chrome.run("talus.app.goTo(1), talus.app.drawn()")
        run.put(frames[2], live("running"))
        until(chrome, "talus.app.model.frames.length === 6")
        check(chrome.run("talus.app.view.frame") == 1, "the page leaves the frame that is looked at")
        chrome.run("(e => { e.value = e.max; e.dispatchEvent(new Event('input')); })(document.querySelector('#time input'))")
        run.put(frames[3])
        check(until(chrome, "talus.app.view.frame === 6"), "the page does not follow the run again")
        run.put(frames[3], live("ended"))
        until(chrome, "talus.app.model.frames.length === 8")
        run.end()
        check(until(chrome, "document.getElementById('status').textContent === 'The run has ended.'"), f"after the end the page says: {words(chrome)}")
        check(chrome.run("document.querySelector('.state').textContent") == "Ended", "the state is not ended")
        check(not chrome.run("[...document.querySelectorAll('button')].some(b => b.checkVisibility() && /^(Pause|Go|Step|Delete)$/.test(b.textContent))"), "after the end commands are offered")
        chrome.run("talus.app.goTo(0).then(() => { talus.app.camera.turn(30, 0); return talus.app.drawn(); })")
        check(chrome.run("talus.app.frame.index") == 0 and chrome.run("new Set(talus.app.gpu.names(talus.app.sight(90, 70), talus.app.lookNow(), 90, 70, [0, 0, 90, 70])).size") > 10, "the picture cannot be used after the end")
        check(chrome.log == [], f"the page reports {chrome.log}")
    with MockRun(page) as run:
        run.put(frames[0])
        chrome.open(run.address.replace(TOKEN, TOKEN[::-1]))
        check(until(chrome, "document.getElementById('status').textContent").startswith("The program refuses this page"), f"with a wrong token the page says: {words(chrome)}")


def test_broken(chrome, page):
    """A run that ends within a frame has broken off; a frame that is damaged ends in a sentence."""
    frames = list(frames_of(page))
    with MockRun(page) as run:
        run.put(frames[0])
        watch(chrome, run)
        run.put(chunk("CONT", b"\xff" * 12).join(split(frames[1])))
        check(until(chrome, "/damaged/.test(document.getElementById('status').textContent)"), f"a damaged frame says: {words(chrome)}")
        check(chrome.run("talus.app.model.frames.length") == 1, "a damaged frame is kept")
    with MockRun(page) as run:
        run.put(frames[0])
        watch(chrome, run)
        run.put(frames[1][:-200])
        run.end()
        check(until(chrome, "document.getElementById('status').textContent.startsWith('The run has broken off: the program is gone.')"), f"a run that breaks off within a frame says: {words(chrome)}")
        check(chrome.run("document.querySelector('.state').textContent") == "Broken off", "the state is not broken off")


def test_again(chrome, page):
    """A page that is loaded again goes on with the run."""
    frames = list(frames_of(page))
    with MockRun(page) as run:
        run.put(frames[0], live("running"))
        watch(chrome, run)
        chrome.call("Page.reload")
        run.put(frames[0], live("running"))
        check(until(chrome, "talus.app.model.frames.length && !document.getElementById('status').classList.contains('bad')"), f"loaded again the page says: {words(chrome)}")


def test_log(chrome, page):
    """Lines and refusals are there as text, for those who come late as well, and once only when all is told anew."""
    frames = list(frames_of(page))
    lines = ["model:cycle(100)", "model:blocks { id = 17 }:delete()", f'model:joint("{HOSTILE}", "coulomb")']
    with MockRun(page) as run:
        run.put(frames[0], live("running"), live("paused", line=lines[0]))
        run.put(frames[1], live("paused", line=lines[1]), live("paused", refused=f"there is no joint '{HOSTILE}'"))
        wanted = [lines[0], lines[1], f"-- refused: there is no joint '{HOSTILE}'"]
        watch(chrome, run)
        log = "document.querySelector('.log').textContent.trim().split('\\n')"
        check(chrome.run(log) == wanted, f"the log has {chrome.run(log)}")
        run.put(frames[2], live("running", line=lines[2]))
        wanted.append(lines[2])
        until(chrome, f"{log}.length === 4")
        check(chrome.run(log) == wanted and words(chrome) == lines[2], f"the log has {chrome.run(log)}, and the page says: {words(chrome)}")
        run.put(frames[2], live("running", refused="a number is missing"))
        until(chrome, f"{log}.length === 5")
        check(words(chrome) == "a number is missing" and chrome.run("document.getElementById('status').className") == "bad", f"a refusal says: {words(chrome)}")
        run.begin()
        run.put(frames[0], *(live("running", line=line) for line in lines))
        until(chrome, f"{log}.length === 3")
        check(chrome.run(log) == lines, f"told anew, the log has {chrome.run(log)}")
        check(chrome.run("document.images.length") == 0, "a line has become an element")
        chrome.run("getSelection().selectAllChildren(document.querySelector('.log'))")
        check(chrome.run("getSelection().toString()").split("\n")[:3] == lines, "the log cannot be selected")
        press(chrome, "Copy")
        check(until(chrome, "/^The log is/.test(document.getElementById('status').textContent)"), f"Copy says: {words(chrome)}")
        check(chrome.log == [], f"the page reports {chrome.log}")


def test_safety(chrome, page):
    """What a factor of safety names is picked: one block, or all of them."""
    frames = list(frames_of(page))
    with MockRun(page) as run:
        run.put(frames[0], live("waiting"))
        watch(chrome, run)
        for number, ids in enumerate(([90], [92, 88, 90]), 1):
            line = f"model:factor_of_safety {{}} -- factor of safety 1.13 (holds at 1.12, fails at 1.14): {len(ids)} blocks of 3 m3 slide; blocks {', '.join(map(str, ids))}"
            run.put(frames[number], live("waiting", line=line))
            check(until(chrome, f"talus.app.picks().join() === '{','.join(map(str, ids))}'"), f"{chrome.run('talus.app.picks()')} are picked, and not {ids}")
            check(words(chrome) == line, f"the page says: {words(chrome)}")


def test_commands(chrome, page):
    """Every button sends its command; what is refused is told; long lists go in parts."""
    frames = list(frames_of(page))
    with MockRun(page) as run:
        run.put(frames[0])
        run.put(frames[3], live("running"))
        watch(chrome, run)
        origin = chrome.run("talus.app.model.head.origin")
        wanted = []

        def sends(name, command, part="#controls"):
            press(chrome, name, part)
            wanted.append(command)
            found = command_of(run, len(wanted))
            check(found == command, f"'{name}' sends {found}, not {command}")

        sends("Pause", {"op": "pause"})
        sends("Go", {"op": "go"})
        sends("Step", {"op": "step", "n": 100})
        chrome.run("document.querySelector('#controls section input[type=number]').value = '7'")
        sends("Step", {"op": "step", "n": 7})
        sends("Save", {"op": "snapshot"})
        sends("VTK", {"op": "write_vtk"})
        sends("Show all", {"op": "show"})
        sends("Safety", {"op": "factor_of_safety"})
        chrome.run("talus.app.pick(92), talus.app.pickMore(88), talus.app.drawn()")
        table = dict(chrome.run("[...document.querySelectorAll('#picked tr')].map(r => [...r.cells].map(c => c.textContent))"))
        check(chrome.run("document.querySelector('#picked h2').textContent") == "2 blocks" and table["ids"] == "92, 88", f"of two blocks the table says {table}")
        for name, op in (("Fix", "fix"), ("Free", "free"), ("Join", "join"), ("Unjoin", "unjoin"), ("Hide in run", "hide")):
            sends(name, {"op": op, "blocks": [92, 88]}, "#picked")
        chrome.run("talus.app.pick(90), talus.app.drawn()")
        sends("Delete", {"op": "delete", "blocks": [90]}, "#picked")
        # friction and cut
        chrome.run("(e => { e.value = e.options[1].value; })(document.querySelector('#controls select'))")
        joint = chrome.run("talus.app.model.head.joints[2]")
        sends("Set", {"op": "friction", "joint": joint, "value": 30})
        press(chrome, "Cut all visible blocks here")
        check(chrome.run("talus.app.view.cut") and len(run.commands) == len(wanted), "a cut that was not seen is made")
        fields = "[...document.querySelectorAll('#controls section input')]"
        chrome.run(f"""(f => {{ f.find(e => e.type === 'text').value = {HOSTILE!r}; const values = [62.5, 123.25, 30.125, 20.25, 14.5];
            f.filter(e => /dip|point/i.test(e.ariaLabel)).forEach((e, i) => {{ e.value = values[i]; e.dispatchEvent(new Event('change')); }}); }})({fields})""")
        chrome.run("talus.app.drawn()")
        away = chrome.run(f"(p => p.normal.reduce((t, v, i) => t + v * ([30.125, 20.25, 14.5][i] - {origin}[i]), 0) - p.position)(talus.app.plane)")
        check(abs(away) < 1e-6, f"the section lies {away} m from the point")
        sends("Cut all visible blocks here", {"op": "cut", "joint": HOSTILE, "dip": 62.5, "dip_direction": 123.25, "origin": [30.125, 20.25, 14.5]})
        chrome.run("talus.app.view.position += 1.5, talus.app.change('cut'), talus.app.drawn()")
        point = chrome.run(f"{fields}.filter(e => /point/.test(e.ariaLabel)).map(e => Number(e.value))")
        away = chrome.run(f"(p => p.normal.reduce((t, v, i) => t + v * ({point}[i] - {origin}[i]), 0) - p.position)(talus.app.plane)")
        check(abs(away) < 1e-3, f"the point {point} lies {away} m from the section")
        # keys
        chrome.run("document.getElementById('picture').focus()")
        for key, command in (("p", {"op": "pause"}), ("n", {"op": "step", "n": 7})):
            chrome.key(key, ord(key.upper()), key)
            wanted.append(command)
            check(command_of(run, len(wanted)) == command, f"the key {key} sends {run.commands[len(wanted) - 1:]}")
        run.put(frames[3], live("paused"))
        until(chrome, "document.querySelector('.state').textContent === 'Paused'")
        chrome.key("p", 80, "p")
        wanted.append({"op": "go"})
        check(command_of(run, len(wanted)) == {"op": "go"}, "the key p does not let a run go on that is paused")
        # refusals
        for status, sentence in ((400, "blocks has no ids"), (403, "this run takes no commands"), (503, "64 commands wait already")):
            run.refuse = lambda command, answer=(status, sentence.encode()): answer
            press(chrome, "Save")
            check(until(chrome, f"document.getElementById('status').textContent === {sentence!r}"), f"status {status} says: {words(chrome)}")
            wanted.append({"op": "snapshot"})
        # parts of a long list; a queue that is full for a while
        ids = list(range(1000, 1300))
        for op in ("fix", "join"):
            command_of(run, len(wanted))
            before, full = len(run.bodies), [1]
            run.refuse = lambda command, left=full, first=before: (503, b"full") if len(run.bodies) > first + 1 and left and left.pop() else None
            chrome.run(f"(v => {{ v.picked = 1000; v.also = new Set({ids}); }})(talus.app.view), talus.app.change('colour'), talus.app.drawn()")
            press(chrome, {"fix": "Fix", "join": "Join"}[op], "#picked")
            end = time.monotonic() + SOON
            while (run.commands[before:] or [{}])[-1].get("blocks", [0])[-1] != ids[-1] and time.monotonic() < end:
                time.sleep(0.02)
            bodies, parts = run.bodies[before:], [c["blocks"] for c in run.commands[before:]]
            check(max(map(len, bodies)) <= 511 and len(bodies) > 3, f"{op}: bodies have {[len(b) for b in bodies]} bytes")
            check(parts[1] == parts[2], f"{op}: a part that found no room is not sent again")
            del parts[1]
            check(sum((p[1:] if i and op == "join" else p for i, p in enumerate(parts)), []) == ids, f"{op}: the parts are not the list")
            check(op == "fix" or all(a[-1] == b[0] for a, b in zip(parts, parts[1:])), "the parts of a join are not joined")
            wanted += [None] * len(bodies)
        check(all("status of" in line for line in chrome.log), f"the page reports {chrome.log}")


def test_picking(chrome, page):
    """Clicks with Ctrl or Shift pick several blocks, and let go of them."""
    frames = list(frames_of(page))
    with MockRun(page) as run:
        run.put(frames[0])
        run.put(frames[3])
        watch(chrome, run)
        places = chrome.run("""(a => { const s = a.sight(a.width, a.height), out = [], seen = new Set();
            for (let y = 150; y < 550; y += 15) for (let x = 240; x < 620; x += 15) { const b = a.at(x, y); if (b.kind !== 'block') continue;
                const id = a.frame.poses.id[a.frame.at[b.index]]; if (!seen.has(id)) { seen.add(id); out.push([x, y, id]); } } return out.slice(0, 3); })(talus.app)""")

        def click(x, y, modifiers):
            for kind in ("mousePressed", "mouseReleased"):
                chrome.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1, modifiers=modifiers)
            chrome.run("talus.app.drawn()")
            return chrome.run("talus.app.picks()")

        (ax, ay, a), (bx, by, b), (cx, cy, c) = places
        found = [click(ax, ay, 0), click(bx, by, CTRL), click(cx, cy, 8), click(ax, ay, CTRL), click(bx, by, CTRL)]
        check(found == [[a], [a, b], [a, b, c], [b, c], [c]], f"clicks pick {found}")
        for colour in ("displacement", "joint"):
            chrome.run(f"talus.app.view.colour = '{colour}', talus.app.pick({a}), talus.app.pickMore({b}), talus.app.drawn()")
            picture = chrome.picture()
            check(all(picture[y][x][2] > picture[y][x][0] + 50 for x, y in ((ax + 2, ay + 2), (bx + 2, by + 2))) and picture[cy + 2][cx + 2][2] < picture[cy + 2][cx + 2][0] + 50,
                  f"picked blocks are not told by their colour: {[picture[y + 2][x + 2] for x, y, _id in places]}")
        check(click(ax, ay, 0) == [a], "a click alone does not pick one block")
        chrome.run(f"talus.app.pickMore({b}), talus.app.hidePicked(), talus.app.drawn()")
        check(chrome.run("[...talus.app.view.hidden]") == [a, b] and chrome.run("talus.app.picks()") == [], "not all picked blocks are hidden")


def test_watching(chrome, page):
    """A run that takes no commands offers none, and shows its state all the same."""
    frames = list(frames_of(page, commands=False))
    with MockRun(page) as run:
        run.put(frames[0], live("running"))
        watch(chrome, run)
        chrome.run("talus.app.pick(92), talus.app.drawn()")
        seen = chrome.run("[...document.querySelectorAll('button')].filter(b => b.checkVisibility()).map(b => b.textContent)")
        check(not set(seen) & {"Pause", "Go", "Step", "Save", "VTK", "Set", "Fix", "Free", "Delete", "Join", "Hide in run", "Cut all visible blocks here"}, f"buttons of a run that takes no commands: {seen}")
        chrome.run("document.getElementById('picture').focus()")
        chrome.key("p", 80, "p")
        time.sleep(0.1)
        check(run.commands == [], f"a run that takes no commands is sent {run.commands}")
        check(chrome.run("document.querySelector('.state').textContent") == "Running", "the state is not shown")


def test_access(chrome, page):
    """Every control of a run has a name and is reached by Tab."""
    frames = list(frames_of(page))
    with MockRun(page) as run:
        run.put(frames[0])
        run.put(frames[3], live("paused", line="model:cycle(1)"))
        watch(chrome, run)
        chrome.run("talus.app.view.net = true, talus.app.pick(90), talus.app.drawn()")
        wanted = chrome.run("""[...document.querySelectorAll('button, select, input, canvas[tabindex], pre[tabindex]')].filter(e => e.checkVisibility()).map((e, i) => {
            e.dataset.mark = i; const label = e.closest('label');
            return [i, e.getAttribute('aria-label') || (label ? label.textContent : e.tagName === 'BUTTON' ? e.textContent : '')]; })""")
        for mark, name in wanted:
            check(re.search(r"\w", name or "") is not None, f"control {mark} has no name")
        reached = set()
        chrome.run("document.activeElement.blur()")
        for _ in range(len(wanted) + 5):
            chrome.key("Tab", 9)
            reached.add(chrome.run("document.activeElement.dataset.mark ?? ''"))
        missing = [name for mark, name in wanted if str(mark) not in reached]
        check(len(wanted) > 45 and not missing, f"Tab does not reach {missing}")
        wide = chrome.run("(c => c.scrollWidth - c.clientWidth)(document.getElementById('controls'))")
        check(wide <= 0, f"controls stand out by {wide} pixels")


def test_pace(chrome, page):
    """Frames that come faster than pictures are left out, but no news; buttons stay the same while frames come."""
    frames = list(frames_of(page))
    with MockRun(page) as run:
        run.put(frames[0])
        watch(chrome, run)
        chrome.run("talus.app.pick(92), talus.app.drawn(), window.button = document.querySelector('#picked button')")
        for i in range(200):
            run.put(split(frames[1 + i % 3])[1], live("running", line=f"-- {i}"))
            time.sleep(0.01)
        begun = time.monotonic()
        until(chrome, "document.querySelector('.log').textContent.includes('-- 199')")
        check(time.monotonic() - begun < 3, f"the page is {time.monotonic() - begun:.1f} s behind the run")
        check(chrome.run("document.querySelector('.log').textContent.trim().split('\\n').length") == 200, "lines are missing")
        check(chrome.run("talus.app.model.serial") < 150, "no frame is left out")
        check(chrome.run("button === document.querySelector('#picked button') && button.isConnected"), "the table's buttons are made anew with every frame")


def test_memory(chrome, page):
    """Frames and shapes of a long run are let go of: what is kept does not grow, and is what was sent."""
    frames = list(frames_of(page))
    with MockRun(page) as run:
        run.put(frames[0])
        watch(chrome, run)
        news, now = (base64.b64encode(part).decode() for part in split(frames[0]))
        found = chrome.run(f"""(async () => {{
            const bytes = (t) => Uint8Array.from(atob(t), c => c.charCodeAt(0)).buffer, news = bytes('{news}'), now = bytes('{now}'), m = new talus.app.model.constructor(), most = {{ frames: 0, rows: 0, swept: 0 }};
            for (let i = 0; i < 3000; i++) {{
                m.addLive(i % 3 === 0 ? news.slice() : new ArrayBuffer(0), now.slice());
                m.thin(50, undefined);
                most.swept += m.sweep() ? 1 : 0;
                most.frames = Math.max(most.frames, m.frames.length);
                most.rows = Math.max(most.rows, m.rows);
            }}
            const f = await m.frame(20), volume = (f) => [...f.rows].map(r => m.shape[r].shapes.volume[m.shape[r].block]).join(), first = await m.frame(0);
            return {{ ...most, n: f.poses.n, same: volume(f) === volume(first), ids: f.poses.id.every((id, i) => m.shape[f.rows[i]].shapes.id[m.shape[f.rows[i]].block] === id && m.rowOf(id, f.since) === f.rows[i]),
                at: f.at.length === m.rows, faces: m.triangles === m.shape.reduce((t, _s, row) => {{ m.eachFace(row, (a, b, c) => {{ t += c - 2; }}); return t; }}, 0), corners: m.versions.size }};
        }})()""")
        check(found["frames"] <= 51, f"{found['frames']} frames are kept")
        check(found["rows"] <= 2 * 51 * found["n"] + 1000 + found["n"] and found["swept"] > 3, f"{found['rows']} rows are kept, {found['swept']} times some were let go of")
        check(found["same"] and found["ids"] and found["at"] and found["faces"] and found["corners"] == found["n"], f"what is kept is not what was sent: {found}")


TESTS = {name[5:]: value for name, value in list(globals().items()) if name.startswith("test_")}


def main():
    if not program():
        required = os.environ.get("TALUS_BROWSER") == "required"
        print("test_live.py: no Chromium, so the page of a run was not looked at" + (", which is required here" if required else ": skipped"))
        return 1 if required else 77
    with tempfile.TemporaryDirectory(prefix="talus_live_") as name:
        subprocess.run([PROGRAM, "--quiet", str(HERE / "pages.lua"), name], check=True, cwd=HERE.parents[1])
        page = pathlib.Path(name, "slope.html").read_text()
        with Chrome(WIDTH, HEIGHT) as chrome:
            for test in sys.argv[1:] or TESTS:
                begun = time.monotonic()
                TESTS[test](chrome, page)
                print(f"{test}: {time.monotonic() - begun:.1f} s")
    print(f"test_live.py: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
