#!/usr/bin/env python3
"""Ctrl-C (SIGINT) at random moments: in scripts, in callbacks, in generators, while files are written, at the prompt, and in
the module inside a stock Lua. No check depends on how fast the machine is: a script says when it has begun."""

import glob
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = os.environ["TALUS_PROGRAM"]
STOCK = os.environ.get("TALUS_STOCK_LUA", "")
FAULTS = []

HEAD = """
local talus = require "talus"
local function say(word) io.write(word, "\\n") io.flush() end
local function rock(n, model)
    local m = model or talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { 0, 0, 0 }, max = { n, n, n }, density = 2500 })
    for i, d in ipairs { { 0, 0 }, { 90, 0 }, { 90, 90 } } do
        m:generate("jointset", { joint = "J" .. i, dip = d[1], dip_direction = d[2], spacing = 1, number = n - 1,
            origin = { n / 2, n / 2, n / 2 } })
    end
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    m:damping "local"
    m:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }:fix()
    return m
end
local forever = { ratio = 0, max_cycles = 1000000000, every = 1 }
"""

# Scripts that never end; each says "ready" when it is where Ctrl-C is to find it.
ENDLESS = {
    "many runs": 'local m = rock(5) say "ready" while true do m:cycle(3) end',
    "one run": 'local m = rock(5) say "ready" m:cycle(1000000000)',
    "solve": 'local m = rock(5) say "ready" m:solve(forever)',
    "two threads": 'local m = rock(5, talus.model { gravity = { 0, 0, -10 }, threads = 2 }) say "ready" m:solve(forever)',
    "Lua": 'say "ready" local i = 0 while true do i = i + 1 end',
    "sort": 'say "ready" while true do local t = {} for i = 1, 9999 do t[i] = i * 7919 % 10007 end '
            'table.sort(t, function(a, b) return a < b end) end',
    "stop": 'local m = rock(3) say "ready" function forever.stop() for i = 1, 1e5 do end end m:solve(forever)',
    "progress": 'local m = rock(3) say "ready" function forever.on_progress() for i = 1, 1e5 do end end m:solve(forever)',
    "drive": 'local m = rock(3) m:blocks { fixed = true }:drive { velocity = function() for i = 1, 1e5 do end '
             'return 0, 0, 0 end } say "ready" m:cycle(1000000000)',
    "where": 'local m = rock(9) say "ready" while true do m:blocks { where = function(b) return b.volume > 0 end } end',
    "joint sets": 'say "ready" while true do rock(25) end',
    "tunnels": 'local m = rock(12) say "ready" for i = 1, 1e9 do local x = 2 + i * 1e-3 m:generate("tunnel", { '
               'face1 = { { x, -1, 2 }, { x + 1, -1, 2 }, { x, -1, 3 } }, face2 = { { x, 13, 2 }, { x + 1, 13, 2 }, '
               '{ x, 13, 3 } } }) end',
    "block model": 'rock(12):write_blocks("out/rock.json") say "ready" while true do '
                   'talus.model {}:generate("blocks", { file = "out/rock.json" }) end',
    "VTK": 'local m = rock(9) m:cycle(1) say "ready" while true do m:write_vtk("out/run") end',
    "page": 'local m = rock(9) m:cycle(1) say "ready" while true do m:write_html("out/run", { block_fields = { '
            'twice = function(block) return 2 * block.volume end } }) end',
    "factor of safety": 'local m = rock(5) say "ready" while true do m:factor_of_safety { to = 0.6, from = 0.1, resolution = 1e-3 } end',
    "safety map": 'local m = rock(5) say "ready" while true do m:safety_map { from = 0.1, to = 0.6 } end',
    "blocks to a file": 'local m = rock(12) say "ready" while true do m:write_blocks("out/rock.json") end',
    "coroutine": 'local m = rock(3) local go = coroutine.wrap(function() while true do m:cycle(2) end end) say "ready" go()',
}


def fault(what, *values):
    FAULTS.append(f"{what}: " + " ".join(repr(value) for value in values))


def start(command, folder, **options):
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


def wait_for(process, word):
    """Reads lines up to that word; False when the script has ended without it."""
    for line in process.stdout:
        if line.strip() == word:
            return True
    return False


def write(folder, text):
    with open(os.path.join(folder, "script.lua"), "w", encoding="utf-8") as file:
        file.write(HEAD + text)


def check_series(what, folder):
    """Every file an index names is there and whole, and there is nothing else beside."""
    if glob.glob(f"{folder}/out/*.tmp"):
        fault(what, "temporary files", os.listdir(f"{folder}/out"))
    for index in glob.glob(f"{folder}/out/*.vtk.series"):
        with open(index, encoding="utf-8") as file:
            text = file.read()
        if not text.endswith("]\n}\n"):
            fault(what, "half an index", text[-80:])
        for name in re.findall(r'"name": "([^"]+)"', text):
            if os.path.getsize(os.path.join(folder, "out", name)) < 100:
                fault(what, "half a file", name)


def check_pages(what, folder):
    for page in glob.glob(f"{folder}/out/*.html"):
        with open(page, encoding="utf-8") as file:
            text = file.read()
        frames = re.findall(r'<script type="text/talus" data-frame="(\d+)"', text)
        if not re.search(r"</script>\n+<!---->\n$", text):
            fault(what, "a page without its end", text[-80:])
        if frames != [str(i) for i in range(len(frames))]:
            fault(what, "frames of a page", frames)


def check_endless(draw):
    """Uncaught, the error ends the program with status 130 and one sentence with its place."""
    for what, script in ENDLESS.items():
        with tempfile.TemporaryDirectory() as folder:
            write(folder, script)
            process = start([PROGRAM, "script.lua"], folder)
            if not wait_for(process, "ready"):
                fault(what, "did not begin", process.communicate())
                continue
            time.sleep(draw.uniform(0, 0.2))
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate()
            if process.returncode != 130 or not re.fullmatch(
                    r"talus: script\.lua:\d+: [^\n]*stopped by Ctrl-C[^\n]*\n", errors):
                fault(what, process.returncode, errors)
            check_series(what, folder)
            check_pages(what, folder)


# The run itself ends, for an arch on soft joints falls; its trial, in which the arch stands, never ends. "ready" is said
# at the end of the run.
TRIAL = """
local function arch()
    local m, n = talus.model { gravity = { 0.3, 0, -10 } }, 7
    for i = 0, n - 1 do
        local vertices = {}
        for _, k in ipairs { i, i + 1 } do
            local a = math.pi * (1 - k / n)
            for _, r in ipairs { 4.6, 5.4 } do
                for y = 0, 1 do vertices[#vertices + 1] = { r * math.cos(a), y, r * math.sin(a) } end
            end
        end
        m:generate("polyhedron", { vertices = vertices, density = 2400 })
    end
    m:generate("box", { { min = { -5.4, 0, -1 }, max = { -4.6, 1, 0 }, density = 2400, group = "ground" },
        { min = { 4.6, 0, -1 }, max = { 5.4, 1, 0 }, density = 2400, group = "ground" } })
    m:blocks { group = "ground" }:fix()
    m:joint("*", "coulomb", { kn = 3e7, ks = 3e7, friction = 60 })
    return m
end
local plain, m = arch(), arch()
forever.ratio = 1e-30
local ended = plain:relax(forever)
assert(ended.reason == "failure", ended.reason)
function forever.stop(model) if model.cycles == ended.cycles then say "ready" end end
forever.try_stiffer = true
local good, message = pcall(m.relax, m, forever)
assert(not good and message:find("stopped by Ctrl%-C"), message)
assert(m:state_hash() == plain:state_hash() and m.cycles == ended.cycles and m:laws()[1].parameters.kn == 3e7)
say "same"
"""


def check_trial(draw):
    """A trial with stiffer joints that is interrupted leaves the model as its run has left it."""
    with tempfile.TemporaryDirectory() as folder:
        write(folder, TRIAL)
        process = start([PROGRAM, "script.lua"], folder)
        if not wait_for(process, "ready"):
            fault("trial", "did not begin", process.communicate())
            return
        time.sleep(draw.uniform(0.1, 0.3))
        process.send_signal(signal.SIGINT)
        out, errors = process.communicate()
        if process.returncode != 0 or "same" not in out:
            fault("trial", process.returncode, out, errors)


CAUGHT = """
local function catch(f)
    local good, message = pcall(f)
    assert(not good and message:find("^script.lua:%d+: .*stopped by Ctrl%-C"), message)
    assert(not message:find("\\n"))
    return message
end
local m = rock(4)
for k = 1, 10 do
    catch(function() say "ready" while true do if k % 2 == 0 then m:solve(forever) else m:cycle(7) end end end)
    say "caught"
end
local twin = rock(4)
twin:cycle(m.cycles)
assert(twin:state_hash() == m:state_hash(), "another state after " .. m.cycles .. " cycles")

-- A generator is done whole or not at all. Between generators it may be stopped, too: then in the loop at the end.
local base, after, seconds, cancelled
local function cut(model, i)
    return model:generate("jointset", { joint = "J" .. i, dip = 30 * i, dip_direction = 70 * i, spacing = 0.2,
        number = 60, origin = { 4, 4, 4 } })
end
local function attempt()
    base = talus.model {}
    base:generate("box", { min = { 0, 0, 0 }, max = { 8, 8, 8 }, density = 2500 })
    after = base:state_hash()
    say "ready"
    for i = 1, 2 do
        cut(base, i)
        after = base:state_hash()
    end
    while true do end
end
for k = 1, 10 do
    local message = catch(function() attempt() end)
    if message:find("the model is as it was", 1, true) then
        assert(message:find("generator 'jointset'", 1, true) and base:state_hash() == after, message)
        cut(base, 1) -- the model goes on
    end
    say "caught"
end
say "good"
"""


def check_caught(draw):
    """What was caught leaves the model as an uninterrupted run does after as many cycles."""
    with tempfile.TemporaryDirectory() as folder:
        write(folder, CAUGHT)
        process = start([PROGRAM, "script.lua"], folder)
        good = True
        for _ in range(20):
            good = good and wait_for(process, "ready")
            time.sleep(draw.uniform(0, 0.3))
            process.send_signal(signal.SIGINT)
            good = good and wait_for(process, "caught")
        good = good and wait_for(process, "good")
        _, errors = process.communicate()
        if not good or process.returncode != 0 or errors:
            fault("caught", process.returncode, errors)


def end_twice(wait):
    """Exit status of a script that reads what never comes, after one Ctrl-C upon another."""
    with tempfile.TemporaryDirectory() as folder:
        write(folder, 'say "ready" io.read()')
        process = start([PROGRAM, "script.lua"], folder, stdin=subprocess.PIPE)
        wait_for(process, "ready")
        time.sleep(wait)
        while process.poll() is None:
            process.send_signal(signal.SIGINT)
            time.sleep(0.02)
        process.communicate()
        return process.returncode


def check_second():
    """Where nothing can be raised, in a function of C that does not return, the second Ctrl-C ends the program."""
    for wait in (0.1, 1, 5, 20):  # s: on a slow machine the script may not have begun to read
        status = end_twice(wait)
        if status != 130:
            break
    if status != -signal.SIGINT:
        fault("second", status)


def check_rethrown():
    """Status 130 is for Ctrl-C only: not for an error after one that was caught."""
    for last, status in (("error(message, 0)", 130), ('error("another")', 1), ("os.exit(7)", 7)):
        with tempfile.TemporaryDirectory() as folder:
            write(folder, f'local _, message = pcall(function() say "ready" while true do end end) {last}')
            process = start([PROGRAM, "script.lua"], folder)
            wait_for(process, "ready")
            process.send_signal(signal.SIGINT)
            process.communicate()
            if process.returncode != status:
                fault("rethrown", last, process.returncode)


class Prompt:
    """The program on a terminal of its own."""

    def __init__(self):
        self.seen = ""  # and not taken yet
        self.pid, self.terminal = os.forkpty()
        if self.pid == 0:
            os.environ.update(TERM="dumb", HOME="")  # no history
            os.environ.pop("XDG_STATE_HOME", None)
            os.execv(PROGRAM, [PROGRAM, "--quiet"])

    def read_to(self, end):
        """Takes what comes, up to the text `end`."""
        while end not in self.seen:
            try:
                self.seen += os.read(self.terminal, 4096).decode()
            except OSError:
                break
        if end not in self.seen:
            fault("prompt", "no", end, "in", self.seen)
        before, _, self.seen = self.seen.partition(end)
        return before

    def send(self, text):
        os.write(self.terminal, text.encode())

    def line(self, text, end):
        self.send(text + "\n")
        self.read_to(end)


def check_prompt():
    """Ctrl-C drops a line that is typed or runs, and keeps the model."""
    prompt = Prompt()
    prompt.read_to("> ")
    prompt.line('m = talus.model { gravity = { 0, 0, -10 } } m:timestep { dt = 1e-4 }', "> ")
    prompt.line('m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 }) print("ma" .. "de")', "made")
    prompt.read_to("> ")
    prompt.line('print("be" .. "gun") while true do end', "begun")
    prompt.send("\x03")
    prompt.read_to("stdin:1: stopped by Ctrl-C")
    prompt.read_to("> ")
    prompt.line('print("be" .. "gun") for i = 1, 1e9 do m:cycle(3) end', "begun")
    prompt.send("\x03")
    prompt.read_to("stopped by Ctrl-C")
    prompt.read_to("> ")
    prompt.line("result = false", "> ")
    for wait in (0.1, 1, 5, 20):  # s: on a slow machine the run may not have begun
        prompt.line('print("be" .. "gun") result = m:cycle(1000000000)', "begun")
        time.sleep(wait)
        prompt.send("\x03")
        prompt.read_to("> ")
        prompt.line('print(result and result.reason or "not " .. "begun")', "\n")
        if "interrupt" in prompt.read_to("\n"):
            break
    else:
        fault("prompt", "no result of the run")
    prompt.read_to("> ")
    prompt.line('print("blo" .. "cks", #m:blocks(), m.cycles > 0)', "blocks\t1\ttrue")
    prompt.read_to("> ")
    prompt.send("nonsense that is never ended")
    prompt.read_to("ended")
    prompt.send("\x03")
    prompt.read_to("\n> ")
    prompt.send("for i = 1, 3 do\n")
    prompt.read_to(">> ")
    prompt.send("\x03")
    prompt.read_to("\n> ")
    prompt.line('print("still " .. "there", #m:blocks())', "still there\t1")
    prompt.read_to("> ")
    prompt.send("\x04")
    _, status = os.waitpid(prompt.pid, 0)
    if status != 0:
        fault("prompt", "ended with", status)


def check_stock(draw):
    """In a stock Lua a call of the kernel is stopped, and before and after it the interpreter's own handler is in force."""
    for what, sentence in (("one run", "stopped by Ctrl-C"), ("solve", "stopped by Ctrl-C"), ("stop", "stopped by Ctrl-C"),
                           ("joint sets", "Ctrl-C|interrupted!"), ("many runs", "Ctrl-C|interrupted!"),
                           ("Lua", "interrupted!")):
        with tempfile.TemporaryDirectory() as folder:
            write(folder, ENDLESS[what])
            process = start([STOCK, "script.lua"], folder)
            wait_for(process, "ready")
            time.sleep(draw.uniform(0, 0.2))
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate()
            if process.returncode != 1 or not re.search(sentence, errors):
                fault("stock, " + what, process.returncode, errors)
    with tempfile.TemporaryDirectory() as folder:
        write(folder, """
local m = rock(4)
for k = 1, 3 do
    local good, message = pcall(function() say "ready" m:solve(forever) end)
    assert(not good and message:find("stopped by Ctrl-C", 1, true), message)
end
local twin = rock(4)
twin:cycle(m.cycles)
assert(twin:state_hash() == m:state_hash())
say "ready"
while true do end
""")
        process = start([STOCK, "script.lua"], folder)
        for k in range(4):
            wait_for(process, "ready")
            time.sleep(0.2 if k < 3 else 0)  # a moment later it is in the run
            process.send_signal(signal.SIGINT)
        _, errors = process.communicate()
        if process.returncode != 1 or "interrupted!" not in errors:
            fault("stock, its own handler", process.returncode, errors)


def main():
    draw = random.Random(12)
    check_endless(draw)
    check_trial(draw)
    check_caught(draw)
    check_second()
    check_rethrown()
    check_prompt()
    if STOCK:
        check_stock(draw)
    for line in FAULTS:
        print(line)
    return 1 if FAULTS else 0


sys.exit(main())
