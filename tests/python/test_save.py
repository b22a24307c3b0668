#!/usr/bin/python3
"""Saved models from one process to another.

    TALUS_MODULE_DIR=BUILD_FOLDER tests/python/test_save.py [KILLS]

A process that is killed while it saves leaves the last model that was saved whole, which goes on as the one that was not killed:
KILLS times, at random moments (default 8; ./bootstrap soak: 200). So does a run under `talus run --autosave` that is killed and resumed, with its histories. A law's plugin that is missing, or there in another version, is named in one sentence. Files of one script have the same bytes in every run."""
import ctypes
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

MODEL = """
local model = talus.model { gravity = {0, 0, -10} }
model:generate("box", { min = {-3, -3, -1}, max = {9, 9, 0}, density = 2500, group = "floor" })
model:blocks():fix()
for i = 0, 39 do
    local x, y, z = i % 4 * 1.2, i // 4 % 4 * 1.2, i // 16 * 1.1 + 0.05
    model:generate("polyhedron", { density = 2500, vertices = { {x, y, z}, {x + 1, y + 0.1, z}, {x + 0.9, y + 1, z + 0.1},
        {x + 0.1, y + 0.9, z}, {x + 0.5, y + 0.5, z + 0.9}, {x + 0.8, y + 0.2, z + 0.8} } })
end
model:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 30 })
"""
# Histories, and what they have sampled.
WATCH = """
model:history { name = "kinetic", every = 1, value = "kinetic" }
model:history { name = "hulls", every = 3, of = model:blocks { fixed = false }, field = "displacement" }
model:history { name = "clock", every = 2, value = time }
"""
SAMPLES = """
model:write_histories(arg[0] .. ".csv")
for line in io.lines(arg[0] .. ".csv") do print(line) end"""
STEPS, SAVES = 7, 60
# What the program says after each run of STEPS steps; the same, saving each.
RUN = MODEL + f"for _ = 1, {SAVES} do model:cycle({STEPS}) print(model.cycles, model:state_hash()) end"
SAVE = MODEL + f"""
io.stdout:setvbuf "line"
while true do
    model:cycle({STEPS})
    model:save(arg[1])
    print(model.cycles)
    if model.cycles == {STEPS * SAVES} then os.exit(0) end
end"""
RESTORE = """
local model = talus.restore(arg[1])
print(model.cycles, model:state_hash())
if model.cycles < tonumber(arg[2]) then
    model:cycle(tonumber(arg[2]) - model.cycles)
end
print(model.cycles, model:state_hash())"""

faults = []


def run(program, script, *arguments, folder, options=(), **variables):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("TALUS_")}
    path = folder / "script.lua"
    path.write_text('local talus = require "talus"\n' + script)
    return subprocess.run([program, "--quiet", *options, path, *map(str, arguments)], capture_output=True, text=True, check=False,
                          env={**environment, **variables})


def check_kills(program, folder, kills):
    expected = dict(line.split() for line in run(program, RUN, folder=folder).stdout.splitlines())
    last, saved = STEPS * SAVES, folder / "run.talus"
    path = folder / "save.lua"
    path.write_text('local talus = require "talus"\n' + SAVE)
    chance = random.Random(1)
    for kill in range(kills):
        saved.unlink(missing_ok=True)
        process = subprocess.Popen([program, "--quiet", path, saved], stdout=subprocess.PIPE, text=True)
        told = "".join(process.stdout.readline() for _ in range(chance.randrange(1, SAVES)))
        time.sleep(0.02 * chance.random())  # somewhere in a step or a save
        process.send_signal(signal.SIGKILL)
        told = int((told + process.communicate()[0]).split()[-1])
        done = run(program, RESTORE, saved, last, folder=folder)
        lines = [line.split() for line in done.stdout.splitlines()]
        if done.returncode or int(lines[0][0]) < told or any(expected[cycle] != hash_ for cycle, hash_ in lines):
            faults.append(f"kill {kill}: {told} steps were saved; restored: {done.stdout}{done.stderr}")


def check_autosave(program, folder):
    """A run that is killed again and again, and resumed each time, ends as one that was not."""
    path = folder / "long run.lua"
    path.write_text('local talus = require "talus"\nlocal function time(m) return m.time end\n'
                    "local model = talus.resumed { histories = { clock = time } }\nif not model then\n" +
                    MODEL.replace("local model", "model") + WATCH + f"end\nprint(model.cycles)\nmodel:cycle({STEPS * SAVES} - model.cycles)\n" +
                    SAMPLES + "\nprint(model:state_hash())")

    def start(*options):
        return subprocess.Popen([program, "--quiet", "run", *options, path.name], cwd=folder, stdout=subprocess.PIPE, text=True)

    whole = start().communicate()[0].split()[1:]
    saved, chance, begun = folder / "long run.lua.autosave.talus", random.Random(2), []
    for _ in range(8):
        process = start("--resume", "--autosave", "0.00001")
        while not saved.exists() and process.poll() is None:
            time.sleep(0.01)
        time.sleep(0.1 * chance.random())
        process.send_signal(signal.SIGKILL)
        begun.append(process.communicate()[0].split()[:1])
    done = start("--resume").communicate()[0].split()
    if done[1:] != whole or len(whole) != STEPS * SAVES + 3 or done[0] == "0" or not saved.exists():
        faults.append(f"resumed from {begun} and {done[0]}: {done}, in one go {whole}")
    for name in ("twin", "twin.lua"):  # each has a file of its own
        (folder / name).write_text('local talus = require "talus"\nlocal model = talus.resumed()\nprint(model and model:blocks()[1].group)\n'
                                   'model = talus.model {}\nmodel:timestep { dt = 1e-3 }\nmodel:generate("box", { min = {0, 0, 0}, max = {1, 1, 1}, density = 1, group = arg[0] })\n'
                                   "for _ = 1, 50 do model:cycle(10) end")
    for _ in range(2):
        told = [subprocess.run([program, "--quiet", "run", "--resume", "--autosave", "0.000001", name], cwd=folder, capture_output=True,
                               text=True, check=False).stdout for name in ("twin", "twin.lua")]
    if told != ["twin\n", "twin.lua\n"]:
        faults.append(f"scripts twin and twin.lua resume as {told}")
    for words, sentence in ((["run"], "name the script"), (["--autosave", "0", "x.lua"], "number of minutes"),
                            (["--resume", "-e", "print(1)"], "for a script in a file")):
        bad = subprocess.run([program, *words], capture_output=True, text=True, check=False)
        if bad.returncode != 1 or sentence not in bad.stderr:
            faults.append(f"{words}: {bad.returncode} {bad.stderr}")


def check_unknown(program, build, folder):
    """A file may hold a history of what this version cannot sample."""
    saved = folder / "histories.talus"
    run(program, MODEL + 'model:history { name = "k", value = "kinetic" } model:save(arg[1])', saved, folder=folder)
    kernel = ctypes.CDLL(build / "libtalus.so")
    kernel.tl_history_at.restype = ctypes.c_void_p
    kernel.tl_plugins_load_default()
    model, error = ctypes.c_void_p(), ctypes.create_string_buffer(1 << 16)
    if kernel.tl_model_restore(bytes(saved), ctypes.c_int64(1), None, None, ctypes.byref(model), error):
        faults.append("a model with a history is not restored")
        return
    history = kernel.tl_history_at(model, ctypes.c_size_t(0))
    name, asked = ctypes.string_at(history), ctypes.string_at(history + 64)
    ctypes.memmove(history + 64, b"magic", 6)
    kernel.tl_model_save(model, bytes(saved))
    kernel.tl_model_destroy(model)
    done = run(program, RESTORE, saved, 1, folder=folder)
    if (name, asked, done.returncode) != (b"k", b"kinetic", 1) or "history 'k' asks for 'magic', which cannot be sampled" not in done.stderr:
        faults.append(f"an unknown value of {name}: {asked}: {done.returncode} {done.stdout}{done.stderr}")


def check_plugins(program, build, folder):
    saved = folder / "law.talus"
    law = 'model:joint("*", "crasher", { how = "never" }) model:save(arg[1])'
    crasher = build / "bad_plugins" / "crasher.so"
    run(program, MODEL + law, saved, folder=folder, options=("--plugin", crasher))
    done = run(program, RESTORE, saved, 1, folder=folder)
    if done.returncode != 1 or "which is not loaded" not in done.stderr or "crasher" not in done.stderr:
        faults.append(f"a law that is not loaded: {done.returncode} {done.stdout}{done.stderr}")
    if run(program, RESTORE, saved, 1, folder=folder, options=("--plugin", crasher)).returncode:
        faults.append("the same law, loaded, is refused")

    run(program, MODEL + 'model:joint("*", "elastic", { kn = 1e8, ks = 1e8 }) model:save(arg[1])', saved, folder=folder)
    other = folder / "plugins"
    other.mkdir()
    elastic = (build / "plugins" / "elastic.so").read_bytes()
    version = subprocess.run([program, "-e", "print(talus.version)"], capture_output=True, text=True, check=True).stdout.strip()
    later = "9" * len(version)
    at = elastic.index(version.encode() + b"\0")
    (other / "elastic.so").write_bytes(elastic[:at] + later.encode() + elastic[at + len(later):])
    done = run(program, RESTORE, saved, 1, folder=folder, TALUS_PLUGIN_PATH=str(other))
    if done.returncode != 1 or f"talus.elastic {version}, and talus.elastic {later} is loaded" not in done.stderr:
        faults.append(f"another version: {done.returncode} {done.stdout}{done.stderr}")


# Zones, water, bolts, a relaxation and a cut: most of what files have.
RICH = """
local model = talus.model { gravity = {0, 0, -10}, threads = 2 }
model:generate("box", { min = {0, 0, 0}, max = {4, 1, 4}, density = 2500 })
model:generate("jointset", { joint = "A", dip = 20, dip_direction = 90, spacing = 1, origin = {2, 0.5, 2}, number = 3 })
model:generate("joint", { joint = "B", dip = 80, dip_direction = 95, origin = {1.5, 0.5, 2} })
model:boundary { zmin = "fixed" }
model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 40 })
model:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
local free = model:blocks { fixed = false }
model:blocks { id = free[1].id }:deformable { zone = 0.5, solid = "rock" }
model:water("table", { level = 3 })
model:element("bolt", { from = {2, 0.5, 4}, to = {2.2, 0.5, 0.5}, diameter = 0.025 })
model:history { name = "way", of = free, field = "displacement" }
model:cycle(20)
model:relax { max_cycles = 60 }
model:generate("joint", { joint = "C", dip = 60, dip_direction = 270, origin = {3, 0.5, 2} })
model:cycle(20)
model:save(arg[1])
"""


def check_same_bytes(program, folder):
    """Files of one script hold the same bytes, whatever lay in the memory that a process gets."""
    first = None
    for garbage in 0, 85, 170:
        path = folder / f"garbage_{garbage}.talus"
        done = run(program, RICH, path, folder=folder, MALLOC_PERTURB_=str(garbage))
        data = path.read_bytes() if done.returncode == 0 else b""
        if not data or (first is not None and data != first):
            faults.append(f"with {garbage} in memory: {done.returncode} {done.stderr} {len(data)} bytes, others than before")
        first = first or data


def main():
    build = pathlib.Path(os.environ["TALUS_MODULE_DIR"]).resolve()
    kills = int(sys.argv[1]) if len(sys.argv) > 1 else 8
    folder = pathlib.Path(tempfile.mkdtemp(prefix="save_", dir=build / "tests" / "tmp"))
    try:
        check_kills(build / "talus", folder, kills)
        check_autosave(build / "talus", folder)
        check_same_bytes(build / "talus", folder)
        check_unknown(build / "talus", build, folder)
        check_plugins(build / "talus", build, folder)
    finally:
        shutil.rmtree(folder)
    for fault in faults:
        print(fault)
    print(f"save: {kills} kills, {len(faults)} faults")
    sys.exit(1 if faults else 0)


main()
