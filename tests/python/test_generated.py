#!/usr/bin/env python3
"""What tools write is up to date and whole: from the help the reference in docs/lua.md, scripts/meta/talus.d.lua and
.luarc.json, which leads an editor to it; from the tutorial its pictures; from comments docs/c_api.md and docs/tolerances.md."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ.get("TALUS_PROGRAM", ROOT / "build/release/talus")).resolve()
META = "scripts/meta/talus.d.lua"
WRITTEN = {"scripts/tools/reference.lua": "docs/lua.md", "scripts/tools/meta.lua": META, "scripts/tools/c_api.lua": "docs/c_api.md",
           "scripts/tools/tolerances.lua": "docs/tolerances.md", "scripts/tools/from_3dec.lua": "docs/from_3dec.md"}

# Constants that say what they are for or need not, and others that fail.
TOLD = """/* Tolerance: a | b, relative to the size. Test: unit/test_hull,
 * python/test_generated. */
#define NEAR 1e-9 /* m */
#define FAR (8 * DBL_EPSILON)

#define PI 3.14159265358979323846
#define ROWS 64
/* Constant: seconds. */
#define PERIOD 0.1
"""
UNTOLD = ("#define NEAR 1e-9\n", "#define NEAR (1. / 3)\n", "/* A comment. */\n#define NEAR (4 * FLT_EPSILON)\n",
          "/* Tolerance: a. */\n\n#define NEAR 0.5\n", "/* Tolerance: a. Test: unit/test_none. */\n#define NEAR 1\n")

# Every name that the program knows, as its own errors list them.
NAMES = """
package.path = "scripts/tools/?.lua;" .. package.path
local found = require "usage_model"()
local function known(object, what)
    local _, message = pcall(function() return object.no_such_name_at_all end)
    for name in assert(tostring(message):match("known: (.*)%)")):gmatch("[%w_]+") do
        print(what, name)
    end
end
known(found.model, "Model")
known(found.selection, "Blocks")
known(found.model:contacts(), "Contacts")
known(found.block, "Block")
known(found.contact, "Contact")
local talus = require "talus"
for name in pairs(talus) do
    print("talus", name)
end
for _, name in ipairs { "back_analysis", "bolt_pattern", "bolt_test", "convert", "plot", "poles", "realisations", "stereonet" } do -- loaded when they are first used
    print("talus", talus[name] and not rawget(_G, name) and name)
end
"""

faults = []


def run(*arguments, folder=ROOT):
    environment = dict(os.environ, TALUS_PROGRAM=str(PROGRAM))
    environment.pop("TALUS_PLUGIN_PATH", None)
    return subprocess.run([PROGRAM, "--quiet", *arguments], cwd=folder, env=environment, stdin=subprocess.DEVNULL, text=True,
                          capture_output=True, check=False)


def check_fresh(folder):
    for tool, path in WRITTEN.items():
        done = run(tool, path, "--check")
        if done.returncode != 0:
            faults.append(f"{path}: {done.stderr.strip()}")
        stale = folder / "stale"
        text = (ROOT / path).read_text(encoding="utf-8")
        stale.write_text(text.rstrip("\n") + " \n", encoding="utf-8")
        done = run(tool, str(stale), "--check")
        if done.returncode == 0 or "out of date" not in done.stderr:
            faults.append(f"{tool} --check does not see that a file is out of date")
        if run(tool, str(stale)).returncode != 0 or stale.read_text(encoding="utf-8") != text:
            faults.append(f"{tool} does not renew a file that is out of date")


def check_tolerances(folder):
    """A constant without a word on what it is for is an error, and so is a test that there is not."""
    tool, page, source = str(ROOT / "scripts/tools/tolerances.lua"), folder / "page.md", folder / "core/base/a.c"
    source.parent.mkdir(parents=True)
    (folder / "tests").symlink_to(ROOT / "tests")
    page.write_text("<!-- Below this line: written by scripts/tools/tolerances.lua. -->\n", encoding="utf-8")
    source.write_text(TOLD, encoding="utf-8")
    done = run(tool, str(page), folder=folder)
    row = "| `NEAR`, `FAR` | 1e-9, 8 \\* DBL_EPSILON | a.c | tolerance | a \\| b, relative to the size. | unit/test_hull, python/test_generated |"
    if row not in page.read_text(encoding="utf-8") or "PERIOD" in page.read_text(encoding="utf-8"):
        faults.append(f"tolerances.lua writes {page.read_text(encoding='utf-8')}{done.stderr}")
    for text in UNTOLD:
        source.write_text(text, encoding="utf-8")
        if run(tool, str(page), folder=folder).returncode == 0:
            faults.append(f"tolerances.lua takes {text}")


def check_whole():
    """Every method and field of the program is in the file for editors, and only these."""
    text = (ROOT / META).read_text(encoding="utf-8")
    done = run("-e", NAMES)
    names = {tuple(line.split("\t")) for line in done.stdout.splitlines()}
    if len(names) < 80:
        faults.append(f"the program does not list its names: {done.stdout}{done.stderr}")
    told = set()
    for name, body in re.findall(r"^---@class (?:\(exact\) )?(?:talus\.)?(\w+)\n((?:---.*\n)*)", text, flags=re.M):
        told |= {(name, field) for field in re.findall(r"^---@field (\w+)", body, flags=re.M)}
    told |= set(re.findall(r"^function (\w+)[:.](\w+)\(", text, flags=re.M))
    for owner, name in sorted(names - told):
        faults.append(f"{META}: {owner} has no '{name}': has it a topic in core/lua/topics.c?")
    for owner, name in sorted(told - names):
        if owner in ("Model", "Blocks", "Contacts", "Block", "Contact", "talus"):
            faults.append(f"{META}: {owner} has a '{name}' that the program does not know")
    if re.search(r"^---@field \w+\?? any\b", text, flags=re.M):
        faults.append(f"{META}: a field without a type")


def check_pictures(folder):
    """The tool for the pictures of the tutorial still draws every script of the page, and the page shows each."""
    page = (ROOT / "docs/tutorial.md").read_text(encoding="utf-8")
    done = run(str(ROOT / "scripts/tools/tutorial_pictures.lua"), str(ROOT / "docs/tutorial.md"), ".", folder=folder)
    if done.returncode != 0:
        faults.append(f"tutorial_pictures.lua: {done.stderr}")
        return
    for name in re.findall(r"<!-- file: (\w+)\.lua -->", page):
        drawn = xml.etree.ElementTree.parse(folder / f"tutorial_{name}.svg")
        if len(drawn.findall(".//{http://www.w3.org/2000/svg}polygon")) < 3:
            faults.append(f"tutorial_pictures.lua: too little in the picture of {name}")
        if f"(pictures/tutorial_{name}.svg)" not in page:
            faults.append(f"docs/tutorial.md does not show {name}")


def check_settings():
    settings = json.loads((ROOT / ".luarc.json").read_text(encoding="utf-8"))
    if not any((ROOT / folder / "talus.d.lua").exists() for folder in settings["workspace.library"]):
        faults.append(".luarc.json does not lead to talus.d.lua")
    if not settings["runtime.version"].endswith("5.4"):
        faults.append(".luarc.json: another Lua")


def main():
    with tempfile.TemporaryDirectory() as folder:
        if run("help", "browser").returncode == 0:
            check_fresh(pathlib.Path(folder))
        else:
            print("skipped: the reference tells of the screen 'browser', which was not built")
        check_pictures(pathlib.Path(folder))
        check_tolerances(pathlib.Path(folder))
    check_whole()
    check_settings()
    for text in faults:
        print(text)
    print(f"generated: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
