#!/usr/bin/env python3
"""model:view: what is done on the page is done between two steps, told, and repeated bit for bit by its log; and looking changes nothing.

    TALUS_PROGRAM=BUILD/talus tests/python/test_view.py [NAME...]

Without the plugin that serves pages one sentence, and status 77."""
import math
import os
import re
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from scene_stream import Program  # noqa: E402

PROGRAM = os.environ.get("TALUS_PROGRAM", "build/release/talus")

# A floor with a stack of blocks cut out of a box.
MODEL = """
local talus = require "talus"
local function build()
    local model = talus.model {}
    model:generate("box", { min = {-2, -2, -1}, max = {6, 6, 0}, density = 2500, group = "floor" })
    model:blocks():fix()
    model:generate("box", { min = {0, 0, 0}, max = {4, 4, 4}, density = 2500 })
    model:blocks { group = "floor" }:hide()
    model:generate("jointset", { joint = "slip", dip = 35, dip_direction = 90, spacing = 1.3, number = 3, origin = {2, 2, 2} })
    model:generate("jointset", { joint = "steep", dip = 80, dip_direction = 200, spacing = 1.7, number = 2, origin = {2, 2, 2} })
    model:blocks { hidden = true }:show()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 45 })
    model:damping("local")
    return model
end
"""
faults = []


def check(condition, sentence):
    if not condition:
        faults.append(sentence)
        print("  " + sentence)


def run(script, *arguments):
    return subprocess.run([PROGRAM, "--quiet", "-", *arguments], input=script, capture_output=True, text=True, check=False)


def repeated(build, log):
    """The state hash after the log was repeated on a new model."""
    done = run(build + f'local model = build() loadfile("{log}")(model) print(model.cycles, model:state_hash())')
    check(done.returncode == 0, f"the log cannot be repeated: {done.stderr}")
    return done.stdout.strip()


def test_looking_changes_nothing(folder):
    """The state after a run is the same without a view, with one that nobody looks at, and with two who look."""
    script = MODEL + 'local model = build() %s model:cycle(3000) print(model:state_hash())'
    plain = run(script % "").stdout.strip()
    check(len(plain) > 8, "no hash")
    alone = run(script % "model:view {}").stdout.strip()
    check(alone == plain, f"a view without anybody: {alone}, without a view {plain}")
    program = Program(PROGRAM, script % 'model:view { wait = true, block_fields = { "speed", height = function(b) return b.centroid[3] end }, contact_fields = { "gap" } }')
    first, second = program.look(), program.look()
    check(first.until(lambda w: w.state == "waiting"), "the run ends before it waits")
    check([f["name"] for f in first.head["fields"]] == ["speed", "height", "gap"], f"fields {first.head['fields']}")
    program.command(op="go")
    while first.frame() and second.frame():
        pass
    out, status = program.end()
    check(status == 0 and out.strip() == plain, f"with two who look: {out.strip()}, without {plain}; {''.join(program.log)}")
    check(first.cycle == 3000, f"the last frame is of cycle {first.cycle}")


def test_commands_are_repeated(folder):
    """Every command, given to a run that goes and to one that is paused, is done, told and repeated by the log."""
    log = folder / "out/work.lua"
    program = Program(PROGRAM, MODEL + f"""
        local model = build()
        model:view {{ log = "{log}", prefix = "{folder}/out/seen" }}
        local r = model:solve {{ ratio = 0, max_cycles = 20000 }}
        print(model.cycles, model:state_hash())""")
    watcher = program.look()
    check(program.command(op="pause")[0] == 202, "pause is not taken")
    check(watcher.until(lambda w: w.state == "paused"), "the run does not pause")
    at = watcher.cycle
    program.command(op="step", n=7)
    check(watcher.until(lambda w: w.state == "paused" and w.cycle == at + 7), f"7 steps from {at} lead to {watcher.cycle}")
    ids = watcher.ids
    commands = [dict(op="fix", blocks=[ids[1]]), dict(op="free", blocks=[ids[1]]), dict(op="hide", blocks=ids[1:4]), dict(op="show", blocks=[ids[2]]),
                dict(op="join", blocks=[ids[1], ids[2]]), dict(op="unjoin", blocks=[ids[1]]), dict(op="friction", joint="slip", value=21.5),
                dict(op="fix", blocks=[ids[2], ids[3]]), dict(op="delete", blocks=[ids[-1]]), dict(op="show"), dict(op="cut", joint="new \"joint\"", dip=50.25, dip_direction=271, origin=[2, 2, 2.125]),
                dict(op="snapshot"), dict(op="write_vtk")]
    for number, command in enumerate(commands):
        check(program.command(**command)[0] == 202, f"{command} is not taken")
        program.command(op="step", n=3 + number)
    check(watcher.until(lambda w: len(w.refused) + sum(not line.startswith("model:cycle") for line in w.lines) == len(commands)), "not all is told")
    check(not watcher.refused, f"refused: {watcher.refused}")
    program.command(op="go")
    check(watcher.until(lambda w: w.state == "running"), "the run does not go on")
    check(ids[-1] not in watcher.ids and len(watcher.ids) > len(ids), f"blocks {watcher.ids}")
    check(len(watcher.held) > 1, f"held {watcher.held}")
    check("new \"joint\"" in watcher.head["joints"], f"joints {watcher.head['joints']}")
    while watcher.frame():
        pass
    out, status = program.end()
    check(status == 0 and out.startswith("20000"), f"the run ends with {status}: {out} {''.join(program.log[-3:])}")
    again = repeated(MODEL, log)
    check(again == out.strip(), f"the log gives {again}, the run gave {out.strip()}")
    check([line for line in log.read_text().splitlines()[2:]][:len(watcher.lines)] == watcher.lines, "the log is not what was told")
    saved = list((folder / "out").glob("seen_*.talus"))
    check(len(saved) == 1 and list((folder / "out").glob("seen_blocks_*.vtk")), f"files {os.listdir(folder / 'out')}")
    restored = run(f'local model = require "talus".restore("{saved[0]}") print(model.cycles)')
    check(restored.stdout.strip() == str(int(saved[0].stem.split("_")[1])), f"restored: {restored.stdout} {restored.stderr}")


def test_refused(folder):
    """What cannot be done is told in one sentence, and the run goes on as without it."""
    script = MODEL + 'local model = build() model:view { wait = true } print(model.cycles, model:state_hash())'
    program = Program(PROGRAM, script)
    watcher = program.look()
    watcher.until(lambda w: w.state == "waiting")
    for number, (command, words) in enumerate([
            (dict(op="delete", blocks=[9999]), "delete: block 9999"), (dict(op="friction", joint="slip", value=95), "friction = 95"),
            (dict(op="friction", joint="slap", value=30), "'slap'"),
            (dict(op="cut", joint="a:b:c", dip=3, dip_direction=3, origin=[0, 0, 0]), "a:b:c")]):
        check(program.command(**command)[0] == 202, f"{command} is not taken")
        check(watcher.until(lambda w: len(w.refused) > number or w.lines), "it is not told")
        if watcher.lines:
            check(False, f"{command} is done: {watcher.lines}")
            break
        check(words in watcher.refused[-1] and "view:1:" not in watcher.refused[-1] and "\n" not in watcher.refused[-1], f"{command}: {watcher.refused[-1]}")
    for body, words in [('{"op":"pause"', "'}' is missing"), ('{"op":"run","path":"x"}', "no command 'run'"), ("x", "JSON"), ('{"op":"step","n":1e30}', "whole number")]:
        connection, answer = program.ask("POST", "/command", body)
        text = answer.read().decode()
        connection.close()
        check(answer.status == 400 and words in text, f"{body}: {answer.status} {text}")
    program.command(op="go")
    out, status = program.end()
    check(status == 0 and out == run(script.replace("model:view { wait = true }", "")).stdout, f"{status} {out}")


SLIDE = """
local talus = require "talus"
local function build()
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -2, -1, -1 }, max = { 2, 1, 1 }, density = 2000 })
    model:generate("joint", { joint = "A", dip = 30, dip_direction = 90, origin = { 0, 0, 0 } })
    model:blocks { below = { dip = 30, dip_direction = 90, origin = { 0, 0, -0.1 } } }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 40 })
    model:damping("local")
    return model
end
"""


def test_safety(folder):
    """A factor of safety is found between steps, on copies: the line tells it with the blocks that fail, and the state is what it was. A model that moves is refused."""
    log = folder / "safety.lua"
    script = SLIDE + f"""
        local model = build()
        model:view {{ wait = true, log = "{log}" }}
        model:cycle(4000)
        print(model.cycles, model:state_hash())"""
    program = Program(PROGRAM, script)
    watcher = program.look()
    watcher.until(lambda w: w.state == "waiting")
    program.command(op="factor_of_safety")
    check(watcher.until(lambda w: w.lines or w.refused) and not watcher.refused, f"refused: {watcher.refused}")
    program.command(op="step", n=3)
    watcher.until(lambda w: w.state == "waiting" and w.cycle == 3)
    program.command(op="factor_of_safety")
    check(watcher.until(lambda w: w.refused or len(w.lines) > 2) and "moves" in "".join(watcher.refused), f"while it moves: {watcher.refused} {watcher.lines}")
    program.command(op="step", n=1500)
    watcher.until(lambda w: w.state == "waiting" and w.cycle == 1503)
    program.command(op="factor_of_safety")
    done = lambda w: sum(line.startswith("model:factor_of_safety {} -- ") for line in w.lines)  # noqa: E731
    check(watcher.until(lambda w: done(w) == 2 or len(w.refused) > 1) and done(watcher) == 2, f"at rest: {watcher.refused} {watcher.lines}")
    free = [i for i in watcher.ids if i not in watcher.held]
    exact = math.tan(math.radians(40)) / math.tan(math.radians(30))
    for line in watcher.lines:
        found = re.fullmatch(r"model:factor_of_safety {} -- factor of safety ([\d.]+) .*; blocks ([\d, ]+)", line)
        check(found is not None or line.startswith("model:cycle"), f"the line {line}")
        if found:
            check(abs(float(found[1]) / exact - 1) < 0.011 and [int(i) for i in found[2].split(", ")] == free, f"{line}, and not {exact:.3f} of blocks {free}")
    program.command(op="go")
    out, status = program.end()
    plain = run(SLIDE + "local model = build() model:cycle(1503) model:cycle(4000) print(model.cycles, model:state_hash())")
    check(status == 0 and out == plain.stdout, f"looked at for safety {out}, else {plain.stdout}")
    again = repeated(SLIDE, log)
    check(again == out.strip(), f"the log gives {again}, the run gave {out.strip()}: {log.read_text()}")


def test_waiting(folder):
    """While view waits, steps are made on the page; a pause in them, and going on, are a run's. Commands in a callback's run wait for it."""
    log = folder / "wait.lua"
    program = Program(PROGRAM, MODEL + f'local model = build() model:view {{ wait = true, log = "{log}" }} print(model.cycles, model:state_hash())')
    watcher = program.look()
    watcher.until(lambda w: w.state == "waiting")
    program.command(op="step", n=1000000)
    watcher.until(lambda w: w.state == "running" and w.cycle > 5)
    program.command(op="pause")
    watcher.until(lambda w: w.state == "paused")
    program.command(op="delete", blocks=[watcher.ids[-1]])
    watcher.until(lambda w: w.lines)
    program.process.send_signal(signal.SIGINT)
    out, status = program.end()
    check(status == 130, f"Ctrl-C in a pause ends with {status}: {''.join(program.log)}")
    check("model:blocks" in log.read_text(), f"the log: {log.read_text()}")
    program = Program(PROGRAM, MODEL + f'local model = build() model:view {{ wait = true, log = "{log}" }} print(model.cycles, model:state_hash())')
    watcher = program.look()
    watcher.until(lambda w: w.state == "waiting")
    program.command(op="step", n=40)
    watcher.until(lambda w: w.state == "waiting" and w.cycle == 40)
    program.command(op="delete", blocks=[watcher.ids[-1]])
    program.command(op="step", n=50)
    watcher.until(lambda w: w.state == "waiting" and w.cycle == 90)
    program.command(op="go")
    out, status = program.end()
    check(status == 0 and repeated(MODEL, log) == out.strip(), f"the log of a wait does not repeat it: {status} {out}")
    check(log.read_text().splitlines()[2:] == ["model:cycle(40)", f"model:blocks {{ id = {watcher.lines[1].split('= ')[1].split(' ')[0]} }}:delete()", "model:cycle(50)"], log.read_text())


def test_what_a_script_may_do(folder):
    """A log of steps alone repeats them; a field whose function fails is told, and the run goes on; a view that is begun in a run takes commands in it."""
    log = folder / "steps.lua"
    program = Program(PROGRAM, MODEL + f'local model = build() model:view {{ wait = true, log = "{log}" }} print(model.cycles, model:state_hash())')
    watcher = program.look()
    watcher.until(lambda w: w.state == "waiting")
    program.command(op="step", n=30)
    watcher.until(lambda w: w.state == "waiting" and w.cycle == 30)
    program.command(op="go")
    out, status = program.end()
    check(status == 0 and repeated(MODEL, log) == out.strip(), f"steps alone: {status} {out} {log.read_text()}")
    program = Program(PROGRAM, MODEL + """local model = build()
        local first = model:blocks { where = function(b) return not b.fixed end }[1]
        model:view { wait = true, block_fields = { rel = function(b) return b.centroid[1] - first.centroid[1] end } }
        model:cycle(50)
        print(model.cycles)""")
    watcher = program.look()
    watcher.until(lambda w: w.state == "waiting")
    free = min(i for i in watcher.ids if i not in watcher.held)
    program.command(op="delete", blocks=[free])
    check(watcher.until(lambda w: w.refused) and "'rel'" in watcher.refused[0] and not watcher.head["fields"] or watcher.until(lambda w: not w.head["fields"]), f"told: {watcher.refused}")
    program.command(op="go")
    out, status = program.end()
    check(status == 0 and out.split() == ["50"], f"the run goes on without the field: {status} {out} {program.log}")
    program = Program(PROGRAM, MODEL + """local model = build()
        model:cycle(1000000000, { every = 10, on_progress = function() model:view {} end })""")
    watcher = program.look()
    program.command(op="pause")
    check(watcher.until(lambda w: w.state == "paused"), "a view begun in a run takes no commands")
    program.process.send_signal(signal.SIGINT)
    check(program.end()[1] == 130, "Ctrl-C does not end it")


SLOPE = """
local talus = require "talus"
local function build()
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 60, 40, 28 }, density = 2000 })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    model:damping("local")
    return model
end
"""


def test_example_4(folder):
    """Example 4 of Hart, Cundall and Lemos (1988), all of it on the screen: cut, excavate, cut, hold, run, and the wedge goes. The log repeats it."""
    import math
    log, toe = folder / "slope.lua", (20, 20, 10)

    def at(dip, direction, distance):
        d, a = math.radians(dip), math.radians(direction)
        return [t + distance * n for t, n in zip(toe, (math.sin(d) * math.sin(a), math.sin(d) * math.cos(a), math.cos(d)))]

    program = Program(PROGRAM, SLOPE + f"""
        local model = build()
        model:view {{ wait = true, log = "{log}" }}
        print(#model:blocks(), model.cycles, model:state_hash())
        for _, b in ipairs(model:blocks {{ fixed = false }}) do
            local d = b.displacement
            if d[1]^2 + d[2]^2 + d[3]^2 > 0.05^2 then print("moved", b.id) end
        end""")
    watcher = program.look()
    watcher.until(lambda w: w.state == "waiting")

    def do(**command):
        before = len(watcher.lines) + len(watcher.refused)
        check(program.command(**command)[0] == 202, f"{command} is not taken")
        watcher.until(lambda w: len(w.lines) + len(w.refused) > before)
        check(not watcher.refused, f"refused: {watcher.refused}")

    def side(dip, direction, distance, sign):
        """Blocks on one side of a plane, as one sees on the page."""
        origin, n = at(dip, direction, distance), [c - t for c, t in zip(at(dip, direction, 1), toe)]
        return {i for i, place in watcher.places.items() if sign * sum(a * (x - o) for a, x, o in zip(n, place, origin)) > 0}

    for k in range(5):
        do(op="cut", joint="foliation", dip=76, dip_direction=270, origin=at(76, 270, -6 * k))
    for k in range(3):
        do(op="cut", joint="fracture", dip=12, dip_direction=270, origin=at(12, 270, 12 * k))
    gone = sorted(side(76, 270, 0, 1) & side(12, 270, 0, 1))
    do(op="delete", blocks=gone)
    do(op="cut", joint="D1", dip=70, dip_direction=200, origin=[26, 22, 15])
    do(op="cut", joint="D2", dip=60, dip_direction=330, origin=[38, 32, 16])
    held = sorted(side(12, 270, 0, -1) | side(76, 270, -24, -1))
    for k in range(0, len(held), 40):
        do(op="fix", blocks=held[k:k + 40])
    check(len(watcher.ids) == 49, f"{len(watcher.ids)} blocks, the paper has 49")
    do(op="friction", joint="*", value=20)
    program.command(op="step", n=12000)
    watcher.until(lambda w: w.state == "waiting" and w.cycle == 12000)
    program.command(op="go")
    out, status = program.end()
    moved = [line for line in out.splitlines() if line.startswith("moved")]
    check(status == 0 and len(moved) == 4, f"{len(moved)} blocks slide, four are the wedge: {out}")
    again = run(SLOPE + f'local model = build() loadfile("{log}")(model) print(#model:blocks(), model.cycles, model:state_hash())')
    check(again.stdout.strip() == out.splitlines()[0], f"the log gives {again.stdout} {again.stderr}, the screen {out.splitlines()[0]}")


def main():
    probe = run('local model = require "talus".model {} model:view {}')
    if "no plugin with a screen" in probe.stderr:
        print("skipped: this build has no plugin that serves pages")
        return 77
    tests = {name[5:]: value for name, value in globals().items() if name.startswith("test_")}
    wanted = sys.argv[1:] or list(tests)
    for name in wanted:
        print(name)
        with tempfile.TemporaryDirectory() as folder:
            tests[name](pathlib.Path(folder))
    print(f"test_view: {len(wanted)} tests, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
