"""Modules written in Lua are found beside a build and in an installed Talus that was moved, by the program and by a stock Lua.

They come from the same Talus as the program does, before any of that name in the search path of scripts, and not from a
file that other users may write.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

BUILD = pathlib.Path(os.environ["TALUS_MODULE_DIR"])
STOCK = os.environ.get("TALUS_STOCK_LUA")
MODULES = ("back_analysis", "convert", "plot", "poles", "realisations", "stereonet")

faults = []


def run(command, **variables):
    environment = {key: value for key, value in os.environ.items() if key not in ("LUA_PATH", "LUA_CPATH")}
    environment.update(variables)
    return subprocess.run([str(word) for word in command], env=environment, capture_output=True, text=True, check=False)


def expect(what, condition, result):
    if not condition:
        faults.append(f"{what}: status {result.returncode}, {result.stdout!r}, {result.stderr!r}")


def check_places(what, program, module_folder, library):
    """All ways in which a script may ask for the modules."""
    cpath = f"{module_folder}/?.so"
    for name in MODULES:
        file = library / f"{name}.lua"
        tell = f"local f, place = require 'talus.{name}'; print(type(f), place)"
        first = f"local talus = require 'talus'; local f = talus.{name}; print(f == require 'talus.{name}')"
        ways = {"program": [program, "-e"]}
        if STOCK:
            ways["stock"] = [STOCK, "-e"]
        for way, command in ways.items():
            result = run(command + [tell], LUA_CPATH=cpath)
            text = result.stdout.split("\t")
            expect(f"{what}, {way}, require '{name}'", result.returncode == 0 and text[0] == "function", result)
            if way == "program" or len(text) > 1 and text[1].strip().endswith(".lua"):
                expect(f"{what}, {way}, place of '{name}'", text[-1].strip() == str(file), result)
            result = run(command + [first], LUA_CPATH=cpath)
            expect(f"{what}, {way}, talus.{name}", result.stdout == "true\n", result)
    with tempfile.TemporaryDirectory() as other:
        folder = pathlib.Path(other) / "talus"
        folder.mkdir()
        (folder / "plot.lua").write_text("return 'another Talus'\n")
        (folder / "own.lua").write_text("return 'my own'\n")
        result = run([program, "-e", "print(type(talus.plot), require 'talus.own')"], LUA_PATH=f"{other}/?.lua")
        expect(f"{what}: another plot.lua in the search path", result.stdout.startswith("function\tmy own"), result)
    result = run([program, "-e", "require 'talus.plto'"])
    expect(f"{what}: no such module", result.returncode == 1 and "no file 'talus/plto.lua' of Talus" in result.stderr, result)


def main():
    check_places("build", BUILD / "talus", BUILD, BUILD.resolve() / "lib" / "talus")
    with tempfile.TemporaryDirectory() as folder:
        first, moved = pathlib.Path(folder).resolve() / "first", pathlib.Path(folder).resolve() / "moved" / "here"
        result = run(["cmake", "--install", BUILD, "--prefix", first])
        expect("cmake --install", result.returncode == 0, result)
        moved.parent.mkdir()
        shutil.move(first, moved)
        library = moved / "share" / "lua" / "5.4" / "talus"
        check_places("moved", moved / "bin" / "talus", moved / "lib" / "lua" / "5.4", library)
        # A file that everybody may write is not run.
        (library / "plot.lua").chmod(0o666)
        result = run([moved / "bin" / "talus", "-e", "talus.plot()"])
        expect("a file that others may write", result.returncode == 1 and "may write" in result.stderr, result)
        (library / "plot.lua").chmod(0o644)
        # Without its library the rest of Talus works.
        shutil.rmtree(library)
        result = run([moved / "bin" / "talus", "-e", "print(#talus.model{}:blocks(), pcall(function() return talus.plot end))"])
        expect("no library", result.returncode == 0 and result.stdout.startswith("0\tfalse") and
               "no file 'talus/plot.lua' of Talus" in result.stdout, result)
    for fault in faults:
        print(fault)
    print(f"library: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
