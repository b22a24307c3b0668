"""The line that shows how a run or a generator goes: on a terminal, in a log, and not with --quiet.

TALUS_PROGRESS=0 writes a line at every step, so nothing here depends on how fast the machine is.
"""
import fcntl
import os
import re
import struct
import subprocess
import sys
import tempfile
import termios

PROGRAM = os.environ["TALUS_PROGRAM"]
CLEAR = "\r\x1b[K"

SCRIPT = """
local talus = require "talus"
local m = talus.model { gravity = { 0, 0, -10 } }
m:generate("box", { min = { -1, -1, -1 }, max = { 7, 2, 0 }, density = 2000, group = "base" })
m:blocks():fix()
m:generate("box", { min = { 0, 0, 0 }, max = { 6, 1, 1 }, density = 2000, group = "row" })
m:generate("jointset", { { joint = "J1", dip = 90, dip_direction = 90, spacing = 1, number = 5, origin = { 3, 0.5, 0.5 } },
    { joint = "J2", dip = 0, dip_direction = 0, spacing = 1, number = 1, origin = { 3, 0.5, 0.5 } } })
m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
m:damping("local", { alpha = 0.8 })
m:blocks { group = "row" }:set { velocity = { 5, 0, 0 } }
m:cycle(20)
m:solve { ratio = 1e-5, max_cycles = 40, every = 10, on_progress = function() print("here") end }
m:solve { ratio = 0, max_time = 20.5 * m.dt }
print("hash " .. m:state_hash())
"""

# What is said of the run that ends by its limit.
REMARK = "talus: solve: ended by max_cycles"
faults = []


def expect(what, condition, *seen):
    if not condition:
        faults.append(f"{what}: {' '.join(repr(one) for one in seen)}")


def environment(variables):
    result = {key: value for key, value in os.environ.items() if key != "TALUS_PROGRESS"}
    result.update(variables)
    return result


def on_terminal(arguments, columns, **variables):
    """All that comes to a terminal of that width."""
    pid, terminal = os.forkpty()
    if pid == 0:
        fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        os.execve(PROGRAM, [PROGRAM] + arguments, environment(variables))
    text = b""
    while True:
        try:
            piece = os.read(terminal, 65536)
        except OSError:
            break
        if not piece:
            break
        text += piece
    _, status = os.waitpid(pid, 0)
    os.close(terminal)
    expect("exit status on a terminal", status == 0, status, text)
    return text.decode().replace("\r\n", "\n")


def in_log(arguments, **variables):
    result = subprocess.run([PROGRAM] + arguments, env=environment(variables), capture_output=True, text=True, check=False)
    return result


def hash_of(text):
    found = re.search(r"hash ([0-9a-f]{32})", text)
    return found and found.group(1)


def check_terminal(script, wanted):
    text = on_terminal([script], 200, TALUS_PROGRESS="0")
    expect("hash", hash_of(text) == wanted, text)
    lines = [line for line in re.split(r"\r\x1b\[K", text)]
    cycle = [line for line in lines if re.match(r"\d+ %  ", line)]
    expect("a line for every step", len(cycle) >= 40, len(cycle))
    parts = (r"100 %  0 s left  cycle 20  t \S+ s  dt \S+ s  v \S+e\S+ m/s  \d+ sliding  \d+ open  [\d.]+/s")
    expect("parts of the line of cycle", any(re.fullmatch(parts, line) for line in cycle), cycle[:30])
    expect("blocks slide", any(re.search(r"  [1-9]\d* sliding", line) for line in cycle), cycle[:30])
    parts = (r"ratio \d\.\de[-+]\d\d(?: falling| rising| steady)? \(to 1e-05\)  (?:[\d.]+ (?:s|min|h|days) left  )?cycle 60  "
             r"t \S+ s  dt \S+ s  v \S+ m/s  \d+ sliding  \d+ open  [\d.]+/s")
    expect("parts of the line of solve", any(re.fullmatch(parts, line) for line in lines), lines[-60:])
    expect("a trend", any(re.search(r"falling|rising|steady", line) for line in lines), lines[-60:])
    expect("share of the time", any(line.startswith("50 %  ") or line.startswith("48 %  ") for line in cycle), cycle[-20:])
    expect("a generator", any(re.match(r"jointset  \d+ %  .*entry 2 of 2  \d+ cuts  \d+ blocks", line) for line in lines), lines[:20])
    expect("the line is gone before a function prints", len(re.findall(r"\r\x1b\[Khere\n", text)) == 4, text)
    expect("the line is gone in the end", "\r\x1b[Khash" in text, text[-200:])
    for columns in (80, 40, 20):
        text = on_terminal([script], columns, TALUS_PROGRESS="0")
        longest = max(len(line) for line in re.split(r"\r\x1b\[K|\n", text) if not line.startswith(("hash", REMARK)))
        expect(f"{columns} columns", 5 < longest < columns, longest)
        expect("the share is kept", "100 %" in text, text[-300:])
    expect("quiet", on_terminal(["--quiet", script], 80, TALUS_PROGRESS="0") == "here\n" * 4 + f"hash {wanted}\n")


def check_log(script, wanted):
    result = in_log([script], TALUS_PROGRESS="0")
    expect("hash", hash_of(result.stdout) == wanted, result.stdout)
    lines = result.stderr.splitlines()
    expect("lines of a log", len(lines) >= 80 and all(line.startswith("talus: ") for line in lines), lines)
    expect("no terminal's codes", "\r" not in result.stderr and "\x1b" not in result.stderr, result.stderr)
    expect("the last step of cycle", any(re.match(r"talus: 100 %  0 s left  cycle 20  ", line) for line in lines), lines)
    result = in_log([script], TALUS_PROGRESS="1e6")
    said = [line for line in result.stderr.splitlines() if not line.startswith(REMARK)]
    expect("no line of a short run", not said and hash_of(result.stdout) == wanted, result.stderr)
    result = in_log(["--quiet", script], TALUS_PROGRESS="0")
    expect("quiet log", result.stderr == "" and hash_of(result.stdout) == wanted, result.stderr)
    for word in ("often", "-1", "nan", "inf", "1 s"):
        result = in_log([script], TALUS_PROGRESS=word)
        expect("bad TALUS_PROGRESS", result.returncode == 1 and re.search(
            r"script\.lua:\d+: the environment's TALUS_PROGRESS = '" + word + "' is not a number of seconds >= 0", result.stderr),
            result.stderr)


def main():
    with tempfile.TemporaryDirectory() as folder:
        script = os.path.join(folder, "script.lua")
        with open(script, "w", encoding="utf-8") as file:
            file.write(SCRIPT)
        wanted = hash_of(in_log(["--quiet", script]).stdout)
        expect("the script runs", wanted)
        check_terminal(script, wanted)
        check_log(script, wanted)
    for fault in faults:
        print(fault)
    print(f"progress: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
