#!/usr/bin/env python3
"""A running program in a browser: what is done on the page is done to the model, and the log repeats it.

    test_run.py            all tests; without Chromium or the screen "browser" one sentence, and status 77 (status 1 where TALUS_BROWSER is "required")
    test_run.py NAME...    some tests
"""
import http.client
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from chrome import Chrome, program  # noqa: E402
from test_live import HEIGHT, HOSTILE, PROGRAM, WIDTH, check, faults, press, until, words  # noqa: E402

HERE = pathlib.Path(__file__).parent
STATE = "document.querySelector('.state').textContent"
LOG = "document.querySelector('.log').textContent.trim().split('\\n')"
CYCLE = "talus.app.model.frames.at(-1).summary.cycle"
PATIENCE = 60  # seconds


class Run:
    """The program; `folder` has what it writes."""

    def __init__(self, *words_):
        self.place = tempfile.TemporaryDirectory(prefix="talus_run_")
        self.folder = pathlib.Path(self.place.name)
        self.process = subprocess.Popen([PROGRAM, "--quiet", str(HERE / "run.lua"), self.place.name, *words_], cwd=HERE.parents[1],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        match = re.match(r"http://127\.0\.0\.1:(\d+)/\?token=(\w+)$", self.address)
        self.port, self.token = (int(match[1]), match[2]) if match else (0, "")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()
        self.place.cleanup()

    def stop(self):
        """What the program prints at its end."""
        (self.folder / "stop").touch()
        out, err = self.process.communicate(timeout=PATIENCE)
        check(self.process.returncode == 0, f"the program ends with {self.process.returncode}: {err}")
        return out.splitlines()

    def viewer(self):
        """Another one who looks: the endless answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        connection.request("GET", "/scene", headers={"X-Talus-Token": self.token})
        return connection, connection.getresponse()


def watch(chrome, run):
    time.sleep(0.1)
    if run.process.poll() is not None:
        raise RuntimeError(f"the program has ended: {run.process.stderr.read()}")
    chrome.log.clear()
    chrome.open(run.address)
    until(chrome, "talus.app.model.frames.length")
    chrome.run("talus.app.drawn()")


def does(chrome, name, line, part="#controls"):
    """Presses a button, and waits for its line in the log."""
    press(chrome, name, part)
    check(until(chrome, f"{LOG}.includes({line!r})"), f"'{name}' did not become {line}, but {chrome.run(LOG)}; the page says: {words(chrome)}")


def blocks(chrome, expression):
    """Something of the newest frame's blocks."""
    chrome.run("talus.app.goTo(Infinity).then(() => talus.app.drawn())")
    return chrome.run(f"(p => {expression})(talus.app.frame.poses)")


def test_work(chrome):
    """Wait, go, pause, step, fix, free, hide, show, delete, join, friction, cut: each is done, and the log does the same again."""
    with Run() as run:
        watch(chrome, run)
        check(until(chrome, f"{STATE} === 'Waiting for Go'"), f"before Go the state is {chrome.run(STATE)}")
        check(chrome.run("document.getElementById('title').textContent") == HOSTILE and chrome.run("document.images.length") == 0, "the title is not shown as text")
        press(chrome, "Go")
        check(until(chrome, f"{STATE} === 'Running' && {CYCLE} > 0"), "Go does not let the program run")
        chrome.run("document.getElementById('picture').focus()")
        chrome.key("p", 80, "p")
        check(until(chrome, f"{STATE} === 'Paused'"), "the key p does not pause the run")
        time.sleep(0.3)
        before = chrome.run(CYCLE)
        time.sleep(0.3)
        check(chrome.run(CYCLE) == before, "the model moves while it is paused")
        press(chrome, "Step")
        check(until(chrome, f"{CYCLE} === {before + 100} && {STATE} === 'Paused'"), f"100 steps lead from {before} to {chrome.run(CYCLE)}")
        count = blocks(chrome, "p.n")
        chrome.run("talus.app.pick(90), talus.app.drawn()")
        does(chrome, "Fix", "model:blocks { id = 90 }:fix()", "#picked")
        check(until(chrome, "talus.app.model.frames.at(-1).data.poses.flags[talus.app.model.frames.at(-1).data.poses.id.indexOf(90)] & 1"), "the block is not held")
        does(chrome, "Free", "model:blocks { id = 90 }:free()", "#picked")
        chrome.run("talus.app.pick(88), talus.app.pickMore(90), talus.app.drawn()")
        does(chrome, "Hide in run", "model:blocks { id = { 88, 90 } }:hide()", "#picked")
        check(until(chrome, "talus.app.model.frames.at(-1).data.poses.flags.filter(f => f & 2).length === 2") and blocks(chrome, "talus.app.shown.kind[talus.app.frame.rows[p.id.indexOf(90)]]") == 0, "hidden blocks are shown")
        does(chrome, "Show all", "model:blocks { hidden = true }:show()")
        chrome.run("talus.app.pick(92), talus.app.drawn()")
        does(chrome, "Delete", "model:blocks { id = 92 }:delete()", "#picked")
        check(until(chrome, f"talus.app.model.frames.at(-1).summary.blocks === {count - 1}"), "the block is not deleted")
        chrome.run(f"""(f => {{ f.find(e => e.type === 'text').value = {HOSTILE!r}; const values = [60, 100, 30, 20, 14];
            f.filter(e => /dip|point/i.test(e.ariaLabel)).forEach((e, i) => {{ e.value = values[i]; e.dispatchEvent(new Event('change')); }}); }})([...document.querySelectorAll('#controls section input')])""")
        chrome.run("talus.app.drawn()")
        does(chrome, "Cut all visible blocks here", f'model:generate("joint", {{ joint = "{HOSTILE}", dip = 60, dip_direction = 100, origin = {{ 30, 20, 14 }} }})')
        check(until(chrome, f"talus.app.model.frames.at(-1).summary.blocks > {count + 10}") and chrome.run("talus.app.model.head.joints").count(HOSTILE) == 1, "the model is not cut")
        check(until(chrome, f"[...document.querySelectorAll('#controls option')].some(o => o.textContent === {HOSTILE!r})"), "the new joint cannot be chosen")
        joint = chrome.run("document.querySelector('#controls select').value")
        does(chrome, "Set", f'model:joint("{joint}", {{ friction = 30 }})')
        chrome.run("talus.app.pick(90), talus.app.drawn()")
        does(chrome, "Save", f'model:save("{run.folder}/view_{chrome.run(CYCLE):09}.talus")')
        # two blocks that touch, of bodies of their own
        a, b = blocks(chrome, """(k => { for (let i = 0; i < k.n; i++) if (k.state[i] === 0 && k.area[i] > 1 && !(p.flags[p.id.indexOf(k.a[i])] & 1) && !(p.flags[p.id.indexOf(k.b[i])] & 1)) return [k.a[i], k.b[i]]; })(talus.app.frame.data.contacts)""")
        chrome.run(f"talus.app.pick({a}), talus.app.pickMore({b}), talus.app.drawn()")
        does(chrome, "Join", f"model:blocks {{ id = {{ {a}, {b} }} }}:join()", "#picked")
        # what cannot be done is told, and changes nothing
        lines = chrome.run(LOG)
        chrome.run("talus.app.pick(92), talus.app.drawn()")
        press(chrome, "Fix", "#picked")
        check(until(chrome, "document.getElementById('status').className === 'bad'") and "92" in words(chrome), f"a block that is not there: {words(chrome)}")
        check(until(chrome, f"{LOG}.length === {len(lines) + 1}") and chrome.run(LOG)[-1].startswith("-- refused: "), f"the log has {chrome.run(LOG)[-1]}")
        press(chrome, "Go")
        check(until(chrome, f"{STATE} === 'Running'"), "the run does not go on")
        check(chrome.log == [], f"the page reports {chrome.log}")
        sums = run.stop()
        check(len(sums) == 2 and sums[0] == sums[1], f"the log leads to {sums[1:]} instead of {sums[:1]}")
        check(until(chrome, "document.getElementById('status').textContent === 'The run has ended.'"), f"after the end the page says: {words(chrome)}")
        check(chrome.run("new Set(talus.app.gpu.names(talus.app.sight(90, 70), talus.app.lookNow(), 90, 70, [0, 0, 90, 70])).size") > 10, "the picture is lost after the end")
        check(len(list(run.folder.glob("view_*.talus"))) == 1, "the model was not saved")


def test_viewers(chrome):
    """Another one who looks gets the same; who stops looking, or goes away within a frame, holds nobody up."""
    with Run("watch") as run:
        watch(chrome, run)
        seen = chrome.run("[...document.querySelectorAll('button')].filter(b => b.checkVisibility()).map(b => b.textContent)")
        check(not set(seen) & {"Pause", "Go", "Step"}, f"commands are offered: {seen}")
        stopped = socket.create_connection(("127.0.0.1", run.port))
        stopped.sendall(f"GET /scene HTTP/1.1\r\nHost: 127.0.0.1:{run.port}\r\nX-Talus-Token: {run.token}\r\n\r\n".encode())
        connection, answer = run.viewer()
        first = answer.read(300000)
        check(first[:4] == b"HEAD" and first.count(b"DONE") > 1, "another one who looks does not get frames")
        connection.sock and connection.sock.close()
        answer.close()
        connection.close()
        connection, answer = run.viewer()
        check(answer.read(5000)[:4] == b"HEAD", "one who comes late does not get all")
        before = chrome.run(CYCLE)
        check(until(chrome, f"{CYCLE} > {before + 1000}"), "the page stands still while another one does not read")
        chrome.call("Page.navigate", url="about:blank")
        watch(chrome, run)
        check(chrome.run(CYCLE) > before and chrome.log == [], f"the page opened again reports {chrome.log}")
        check(len(run.stop()) == 1, "the program prints not what the model has come to")
        check(until(chrome, "document.getElementById('status').textContent === 'The run has ended.'"), f"after the end the page says: {words(chrome)}")
        stopped.close()
        connection.close()


def test_killed(chrome):
    """A program that is killed is a run that has broken off."""
    with Run("watch") as run:
        watch(chrome, run)
        run.process.kill()
        check(until(chrome, "document.getElementById('status').textContent.startsWith('The run has broken off')"), f"after the program was killed the page says: {words(chrome)}")
        chrome.run("talus.app.camera.turn(30, 0), talus.app.drawn()")
        check(chrome.run("new Set(talus.app.gpu.names(talus.app.sight(90, 70), talus.app.lookNow(), 90, 70, [0, 0, 90, 70])).size") > 10, "the picture is lost after the end")


TESTS = {name[5:]: value for name, value in list(globals().items()) if name.startswith("test_")}


def main():
    required = os.environ.get("TALUS_BROWSER") == "required"
    missing = None if program() else "no Chromium"
    if not missing:
        with Run("watch") as run:
            if not run.port:
                error = run.process.stderr.read()
                missing = "no plugin with a screen" if "no plugin with a screen" in error else None
                check(missing, f"the program says: {error}")
    if missing:
        print(f"test_run.py: {missing}, so no run was looked at" + (", which is required here" if required else ": skipped"))
        return 1 if required else 77
    with Chrome(WIDTH, HEIGHT) as chrome:
        for test in sys.argv[1:] or TESTS:
            begun = time.monotonic()
            TESTS[test](chrome)
            print(f"{test}: {time.monotonic() - begun:.1f} s")
    print(f"test_run.py: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
