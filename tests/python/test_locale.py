"""Numbers as text do not depend on the locale of the process.

Once a script sets a locale with a decimal comma, and once a host program has done so before it loads Talus
(tests/locale/host_locale.c, the library named as the argument). All that is read and written then is compared, byte by byte, with the same in the locale "C".
The locales are made for the test, in its own folder: one with a comma, and one whose decimal point has two bytes, with which
Lua does not read a script; it may be set by one."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROGRAM = os.environ["TALUS_PROGRAM"]
BUILD = pathlib.Path(os.environ["TALUS_MODULE_DIR"])
HOST = sys.argv[1]
LOCALES = ("de_DE", "ps_AF")
# Programs of the tests that read and write texts; what they expect has decimal points.
UNITS = ("test_damping", "test_histories", "test_jointset", "test_lies", "test_loader", "test_options", "test_params",
         "test_regressions", "test_services", "test_view_command", "test_vtk")

SCRIPT = r"""
local talus = require "talus"
local folder, locale = arg[1], arg[2]
local _ = talus.plot, talus.stereonet -- which are read now
if locale ~= "C" then
    assert(os.setlocale(locale) == locale, "the locale cannot be set")
    assert(not string.format("%g", 0.5):find(".", 1, true), "the locale has a decimal point")
end

local function write(name, text)
    local file = assert(io.open(folder .. "/" .. name, "wb"))
    file:write(text)
    file:close()
    return folder .. "/" .. name
end

-- ------------------------------------------------------------------ readers

local corners = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local faces = { { 1, 3, 2 }, { 1, 2, 4 }, { 1, 4, 3 }, { 2, 3, 4 } }
-- Texts of numbers: what is added to the corners, by coordinates.
local function corner(i)
    return string.format("%d.5 %s %de-1", corners[i][1], corners[i][2] == 0 and ".25" or "1.25E+0", 10 * corners[i][3] + 5)
end
local obj, stl = {}, { "solid one" }
for i in ipairs(corners) do
    obj[#obj + 1] = "v " .. corner(i)
end
for _, f in ipairs(faces) do
    obj[#obj + 1] = "f " .. table.concat(f, " ")
    stl[#stl + 1] = "facet normal 0.5 0.5 0.5\nouter loop\nvertex " .. corner(f[1]) .. "\nvertex " .. corner(f[2]) ..
        "\nvertex " .. corner(f[3]) .. "\nendloop\nendfacet"
end
stl[#stl + 1] = "endsolid one"
local binary = { ("x"):rep(80), string.pack("<I4", #faces) }
for _, f in ipairs(faces) do
    binary[#binary + 1] = string.pack("<fff", 0, 0, 0)
    for _, i in ipairs(f) do
        binary[#binary + 1] = string.pack("<fff", corners[i][1] + 0.5, corners[i][2] + 0.25, corners[i][3] + 0.5)
    end
    binary[#binary + 1] = "\0\0"
end

local hashes = {}
local function imported(name, text, generator, density)
    local model = talus.model {}
    model:generate(generator, { file = write(name, text), density = density })
    model:write_blocks(folder .. "/" .. name .. ".again.json")
    hashes[#hashes + 1] = name .. " " .. model:state_hash()
end
imported("one.obj", table.concat(obj, "\n") .. "\n", "import", 2500.5)
imported("one.stl", table.concat(stl, "\n") .. "\n", "import", 2500.5)
imported("two.stl", table.concat(binary), "import", 2500.5)
imported("one.json", [=[{"format": "talus block model", "version": 1.0, "blocks": [{"density": 2.6505e3,
  "vertices": [[0.125, 0, 0], [1.3e0, 0, 0], [0.1, 1.0000000000000002, 0], [0, 0, 12345678901234567890e-19]],
  "faces": [{"vertices": [0, 2, 1]}, {"vertices": [0, 1, 3]}, {"vertices": [0, 3, 2]}, {"vertices": [1, 2, 3]}]}]}]=],
    "blocks")

-- ------------------------------------------------------------------ writers

local model = talus.model { gravity = { 0, 0, -9.81 } }
model:generate("box", { min = { -0.5, -1, -1 }, max = { 7.25, 2, 0 }, density = 2000, group = "base" })
model:blocks():fix()
model:generate("box", { min = { 0, 0, 0 }, max = { 6, 1.1, 1 }, density = 2000.5, group = "row" })
model:generate("jointset", { joint = "J1", dip = 88.5, dip_direction = 91.5, spacing = 0.9, number = 5, origin = { 3, 0.5, 0.5 } })
model:joint("*", "coulomb_tensile", { kn = 1.5e8, ks = 1e8, friction = 30.5, tension = 0.1 })
model:damping("local", { alpha = 0.75 })
model:timestep { fraction = 0.35 }
model:contact_area { fraction = 0.0125 }
model:history { name = "ratio, J1", value = "ratio", every = 5 }
model:history { name = "place", value = function(m) return m:blocks()[2].centroid end, every = 5 }
model:history { name = "odd", value = function(m) return m.time * 1e-12, 1 / 3, 0 / 0, 1 / 0 end, every = 5 }
model:cycle(20)
model:write_vtk(folder .. "/run", { block_fields = { share = function(b) return b.id / 7 end } })
model:cycle(25)
model:write_vtk(folder .. "/run")
model:write_section(folder .. "/cut", { dip = 30.5, dip_direction = 12.5, origin = { 0.5, 0.5, 0.5 } })
model:write_html(folder .. "/page", { title = "0.5, 1.5", keyblocks = { friction = 30.5 } })
model:write_blocks(folder .. "/blocks.json")
model:write_histories(folder .. "/run.csv")
model:save(folder .. "/model.talus")
hashes[#hashes + 1] = "model " .. model:state_hash()
hashes[#hashes + 1] = "restored " .. talus.restore(folder .. "/model.talus", { histories = { place = false, odd = false } }):state_hash()
os.remove(folder .. "/model.talus") -- beside what it keeps it has room whose bytes mean nothing
talus.plot { file = folder .. "/plot.svg", model = model, histories = { "ratio, J1", "place" }, y_axis = { range = { 0.5, 3.75 } } }
talus.plot { file = folder .. "/log.svg", series = { { x = { 0.001, 0.5, 70 }, y = { 1, 2, 3 } } }, x_axis = { log = true } }
talus.stereonet { file = folder .. "/net.svg", model = model, keyblocks = model:keyblocks { friction = 30.5 } }
local again = talus.model {}
again:generate("blocks", { file = folder .. "/blocks.json" })
again:write_blocks(folder .. "/again.json")
write("hashes", table.concat(hashes, "\n"))

-- ------------------------------------------------------------------ sentences

talus.report(model)
model:parameters()
model:memory()
model:timestep { dt = 0.0025 }
model:cycle(1) -- with a remark
local sentences = {}
local function refused(f)
    local good, sentence = pcall(f)
    assert(not good, "this should be refused")
    sentences[#sentences + 1] = sentence
end
refused(function() model:timestep { fraction = 2.5 } end)
refused(function() model:timestep { dt = -0.5 } end)
refused(function() model:timestep(0.5) end)
refused(function() model:cycle(1.5) end)
refused(function() model:cycle({ 0.5 }) end)
refused(function() model:joint("*", "coulomb", { kn = 1e8, ks = -0.125, friction = 30 }) end)
refused(function() model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30.25, dilation = 45.5 }) end)
refused(function() model:joint(0.5, "coulomb") end)
refused(function() model:contact_area { fraction = 0.5, absolute = 0.25 } end)
refused(function() model:blocks():set { density = -2.5 } end)
refused(function() model:keyblocks { friction = 99.5 } end)
refused(function() model:generate("box", { min = { 0, 0, 0 }, max = { 1.5, 1e-30, 1 }, density = 2000 }) end)
refused(function() model:generate("box", { min = { 0, 0, 0 }, max = { 1.5, -0.5, 1 }, density = 2000 }) end)
refused(function() model:generate("box", { min = { 0, 0, 0.5 }, max = { 1, 1, "x" }, density = 2000 }) end)
refused(function() model:generate("import", { file = write("bad.obj", "v 0.5 1,5 2\n"), density = 2000 }) end)
refused(function() model:generate("import", { file = write("far.obj", "v 0.5 1.5e300 2\n"), density = 2000 }) end)
refused(function() model:generate("blocks", { file = write("bad.json", '{"format": 0,5}') }) end)
refused(function() model:generate("blocks", { file = write("half.json",
    '{"format": "talus block model", "version": 1, "joints": [{"name": "a", "planes": 1.5}], "blocks": []}') }) end)
refused(function() model:generate("tunnel", { axis = { { 0.5, 0, 0 }, { 0.5, 0, 0 } } }) end)
refused(function() model:mass_scaling { dt = 0.5, most = 1e-9 } model:cycle(1) end)
refused(function() talus.plot { file = folder .. "/x.svg", width = 0.5, series = { { y = { 1, 2 } } } } end)
refused(function() talus.law_test { law = "coulomb", normal_stress = 1.5, speed = -0.5 } end)
refused(function() model:view { share = 1.5 } end)
write("sentences", table.concat(sentences, "\n"):gsub(folder:gsub("%p", "%%%0"), "FOLDER") .. "\n")
"""

# What comes after the host has set the locale; NAME stands for the folder of plugins.
COMMANDS = [
    ["check", "PLUGINS/coulomb.so", "kn=1.5e8", "ks=1e8", "friction=30.5"],
    ["check", "PLUGINS/coulomb.so", "kn=1.5e8", "ks=-0.5", "friction=30.5"],
    ["check", "PLUGINS/tunnel.so"],
    ["help", "coulomb"],
    ["help", "timestep"],
    ["help", "mass_scaling"],
    ["--autosave", "0.5", "SCRIPT", "FOLDER", "C"],
    ["--autosave", "0,5", "SCRIPT", "FOLDER", "C"],
]

faults = []


def expect(holds, what):
    if not holds:
        faults.append(what)


def make_locales(folder):
    """The locales that could be made; texts of the system stay English."""
    made = []
    for name in LOCALES:
        done = subprocess.run(["localedef", "-c", "-i", name, "-f", "UTF-8", str(folder / f"{name}.UTF-8")],
                              capture_output=True, text=True, check=False) if shutil.which("localedef") else None
        if done and (folder / f"{name}.UTF-8").exists():
            made.append(f"{name}.UTF-8")
    return made


def run(arguments, environment):
    done = subprocess.run(arguments, capture_output=True, check=False, env=environment)
    return done.returncode, done.stdout, done.stderr


def files_of(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def compare(what, one, other):
    expect(one.keys() == other.keys(), f"{what}: the files are {sorted(one)} and {sorted(other)}")
    for name in one.keys() & other.keys():
        if one[name] != other[name]:
            at = next((i for i, (a, b) in enumerate(zip(one[name], other[name])) if a != b), min(len(one[name]), len(other[name])))
            begin = max(at - 40, 0)
            faults.append(f"{what}: {name} differs at byte {at}: {one[name][begin:at + 40]!r}, {other[name][begin:at + 40]!r}")


def check_script(folder, script, plain, locales):
    """A script that sets the locale."""
    results = {}
    for name in ["C", *locales]:
        out = folder / "out"
        out.mkdir()
        environment = {**plain, "LOCPATH": str(folder), "LANGUAGE": "C"}
        status, said, told = run([PROGRAM, script, str(out), name], environment)
        expect(status == 0, f"the script in the locale {name}: {told.decode(errors='replace')}")
        results[name] = {**files_of(out), "standard output": said, "standard error": told}
        shutil.rmtree(out)
        compare(f"the script in the locale {name}", results["C"], results[name])
    expect(len(results["C"]) > 25, f"the script wrote {sorted(results['C'])}")
    return results["C"]


def check_host(folder, script, plain, locales, of_script):
    """A host that has set the locale: commands, and the script again."""
    results = {}
    out = folder / "out"
    words = {"PLUGINS": os.environ["TALUS_TEST_PLUGIN_DIR"], "SCRIPT": str(script), "FOLDER": str(out)}
    for name in ["C", *locales]:
        environment = {**plain, "LOCPATH": str(folder), "LC_ALL": name, "LANGUAGE": "C", "LD_PRELOAD": HOST,
                       "ASAN_OPTIONS": "verify_asan_link_order=0:detect_leaks=0"}
        results[name] = {}
        for command in COMMANDS:
            if name.startswith("ps_AF") and "SCRIPT" in command:
                results[name][" ".join(command)] = results["C"][" ".join(command)]
                continue
            out.mkdir()
            arguments = [re.sub("[A-Z]{6,}", lambda m: words.get(m.group(), m.group()), word) for word in command]
            status, said, told = run([PROGRAM, *arguments], environment)
            results[name][" ".join(command)] = b"%d\n%s\n%s" % (status, said, told)
            if "0.5" in command:
                compare(f"the script under a host in the locale {name}", of_script,
                        {**files_of(out), "standard output": said, "standard error": told})
            shutil.rmtree(out)
        compare(f"commands in the locale {name}", results["C"], results[name])
        # The line of a run tells times, which differ.
        status, _, told = run([PROGRAM, "-e", "m = talus.model {} m:generate('box', {min = {0, 0, 0}, max = {1, 1, 1}, density = 2000}) "
                               "m:damping('local') m:timestep {dt = 1 / 512} m:cycle(30)"], {**environment, "TALUS_PROGRESS": "0.0"})
        lines = told.decode()
        expect(status == 0 and "dt " in lines and not re.search(r"\d[^\d\s.e%/]+\d", lines.replace("(to ", "")),
               f"the line of a run in the locale {name}: {status} {lines[:400]}")


def check_units(folder, plain, locales):
    for name in locales:
        environment = {**plain, "LOCPATH": str(folder), "LC_ALL": name, "LANGUAGE": "C", "LD_PRELOAD": HOST,
                       "ASAN_OPTIONS": "verify_asan_link_order=0:detect_leaks=0",
                       "TALUS_PLUGIN_PATH": os.environ["TALUS_TEST_PLUGIN_DIR"],
                       "TALUS_TEST_SHARE": "10"}  # texts are the same in all cases
        for unit in UNITS:
            status, said, told = run([str(BUILD / "tests" / "unit" / unit)], environment)
            expect(status == 0, f"{unit} in the locale {name}: {said.decode(errors='replace')[-400:]}{told.decode(errors='replace')[-400:]}")


def main():
    plain = {key: value for key, value in os.environ.items()
             if not key.startswith(("LC_", "LANG")) and key not in ("LOCPATH", "TALUS_PROGRESS")}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        locales = make_locales(folder)
        if not locales:
            print("locale: skipped: localedef makes no locale with a decimal comma here (Debian: the package locales)")
            return 77
        script = folder / "script.lua"
        script.write_text(SCRIPT, encoding="utf-8")
        of_script = check_script(folder, script, plain, locales)
        check_host(folder, script, plain, locales, of_script)
        check_units(folder, plain, locales)
    for fault in faults:
        print(f"locale: {fault}")
    print(f"locale: {len(locales)} locales, {len(of_script)} texts, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
