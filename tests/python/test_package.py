#!/usr/bin/python3
"""Builds upon an installed Talus whose folder has been moved.

    tests/python/test_package.py BUILD_FOLDER

The library exports the functions of the headers and nothing else, with a soname; the example that embeds it is built with
find_package (library and archive) and with pkg-config, and computes what its head says; a plugin is built with
talus_add_plugin and with the flags of talus.pc; the headers are C++; a wrong version is refused."""
import os
import pathlib
import re
import shutil
import sys
import tempfile

from package import ROOT, build_project, install, run

faults = []


def expect(holds, what):
    if not holds:
        faults.append(what)


def declared(prefix):
    """Functions that the installed headers declare for others."""
    names = set()
    for path in (prefix / "include/talus").glob("*.h"):
        text = re.sub(r"/\*.*?\*/", "", path.read_text(encoding="utf-8"), flags=re.S)
        names |= set(re.findall(r"^TL_API\b[^;(]*?\b(tl_\w+)\(", text, re.M))
    return names


def check_symbols(prefix, version):
    library = prefix / "lib/libtalus.so"
    lines = run(["nm", "-D", "--defined-only", library]).stdout.split("\n")
    exported = {line.split()[-1] for line in lines if line}
    names = declared(prefix)
    expect(len(names) > 50, f"only {len(names)} functions seen in the headers")
    expect(exported == names, f"exported and declared differ: {sorted(exported ^ names)}")
    dynamic = run(["readelf", "-d", library]).stdout
    major_minor = ".".join(version.split(".")[:2])
    expect(f"soname: [libtalus.so.{major_minor}]" in dynamic, f"soname: {dynamic}")
    expect(library.resolve().name == f"libtalus.so.{version}", f"the library is {library.resolve()}")
    expect("RPATH" not in dynamic and "RUNPATH" not in dynamic, "the library has a path in it")
    outer = run(["nm", "-g", "--defined-only", prefix / "lib/libtalus.a"]).stdout
    others = [name for name in re.findall(r" [A-Z] (\S+)", outer) if not name.startswith("tl_")]
    expect(not others, f"names of the archive that others may use, too: {others[:5]}")


def check_example(program, folder, what, **variables):
    out = folder / f"out {what}"
    text = run([program, out], **variables).stdout
    match = re.search(r"acceleration (\S+) m/s2, expected (\S+)", text)
    expect(match and abs(float(match[1]) - float(match[2])) < 0.01, f"{what}: {text}")
    expect(re.search(r"contact of blocks \d+ and \d+: normal force [1-9]\d+ kN", text), f"{what}: no contact in {text}")
    expect((out / "slide_blocks_000002.vtk").exists() or len(list(out.glob("slide_blocks_*.vtk"))) == 2,
           f"{what}: files {sorted(p.name for p in out.glob('*'))}")


def check_embedding(prefix, folder, plugins):
    # the copy that was installed
    source = folder / "embed"
    shutil.copytree(prefix / "share/talus/examples/embed", source)
    warnings = build_project(source, folder / "cmake", prefix, "-DCMAKE_C_FLAGS=-Wall -Wextra -Wpedantic -Werror")
    expect("warning" not in warnings, warnings)
    check_example(folder / "cmake/slide", folder, "find_package")
    said = run([folder / "cmake/column"]).stdout
    found = re.search(r"settlement (\S+) mm, expected (\S+) mm", said)
    expect(found and abs(float(found[1]) / float(found[2]) - 1) < 0.02, f"the column of zones: {said}")

    listing = (source / "CMakeLists.txt").read_text(encoding="utf-8")
    (source / "CMakeLists.txt").write_text(listing.replace("talus::talus", "talus::static"), encoding="utf-8")
    # it saves, too: that takes libraries of its own out of the archive
    code = (source / "slide.c").read_text(encoding="utf-8")
    saving = code.replace("    tl_model_destroy(model);", '    must(model, tl_model_save(model, "slide.talus"));\n    tl_model_destroy(model);', 1)
    expect(saving != code, "slide.c does not destroy its model")
    (source / "slide.c").write_text(saving, encoding="utf-8")
    build_project(source, folder / "static", prefix)
    needed = run(["readelf", "-d", folder / "static/slide"]).stdout
    expect("libtalus" not in needed, "the archive's program needs the library")
    check_example(folder / "static/slide", folder, "archive", TALUS_PLUGIN_PATH=str(plugins))

    path = {"PKG_CONFIG_PATH": str(prefix / "lib/pkgconfig")}
    command = f"cc -std=c17 -O2 slide.c $(pkg-config --cflags --libs talus) -Wl,-rpath,'{prefix}/lib' -o by_hand"
    run(["sh", "-c", f'eval "{command}"'], cwd=source, **path)  # eval: the prefix has a blank in it
    check_example(source / "by_hand", folder, "pkg-config")
    command = "cc -std=c17 -O2 slide.c $(pkg-config --static --cflags --libs talus | sed s/-ltalus/-l:libtalus.a/) -o from_archive"
    run(["sh", "-c", f'eval "{command}"'], cwd=source, **path)
    check_example(source / "from_archive", folder, "archive by pkg-config", TALUS_PLUGIN_PATH=str(plugins))
    given = run(["pkg-config", "--variable=plugindir", "talus"], **path).stdout.strip().replace("\\", "")
    expect(os.path.samefile(given, plugins), f"plugindir = {given}")


def check_versions(prefix, folder, version):
    path = {"PKG_CONFIG_PATH": str(prefix / "lib/pkgconfig")}
    expect(run(["pkg-config", "--modversion", "talus"], **path).stdout.strip() == version, "version of talus.pc")
    expect(version in run([prefix / "bin/talus", "--version"]).stdout.split("\n")[0], "version of the program")
    source = folder / "newer"
    source.mkdir()
    (source / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(newer LANGUAGES C)\nfind_package(talus 99 REQUIRED)\n", encoding="utf-8")
    done = run(["cmake", "-S", source, "-B", folder / "newer build", f"-DCMAKE_PREFIX_PATH={prefix}"], check=False)
    expect(done.returncode != 0 and "version" in done.stderr, "find_package(talus 99) is taken")


def check_plugin(prefix, folder):
    """The example of docs/writing_a_plugin.md, from outside: with CMake, and with the flags of talus.pc."""
    page = (ROOT / "docs/writing_a_plugin.md").read_text(encoding="utf-8")
    source = folder / "weakening"
    source.mkdir()
    code = next(text for text in re.findall(r"```c\n(.*?)```", page, re.S) if text.startswith("/* weakening.c"))
    (source / "weakening.c").write_text(code, encoding="utf-8")
    (source / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(weakening LANGUAGES C)\nfind_package(talus REQUIRED)\n"
        "talus_add_plugin(weakening weakening.c)\n", encoding="utf-8")
    strict = "-DCMAKE_C_FLAGS=-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror"
    build_project(source, folder / "weakening build", prefix, strict, "-DCMAKE_BUILD_TYPE=Release")
    run(["sh", "-c", 'eval "cc $(pkg-config --variable=plugin_cflags talus) -shared -o weakening.so weakening.c -lm"'], cwd=source,
        PKG_CONFIG_PATH=str(prefix / "lib/pkgconfig"))
    for made in (folder / "weakening build/weakening.so", source / "weakening.so"):
        exported = run(["nm", "-D", "--defined-only", made]).stdout.split()
        expect(exported[2:] == ["tl_plugin_entry"], f"{made.name} exports {exported}")
        text = run([prefix / "bin/talus", "--plugin", made, "help", "weakening"]).stdout
        expect("law 'weakening'" in text, f"{made}: {text}")


def check_headers(prefix, folder):
    """Each header stands alone, in C and in C++."""
    for path in (prefix / "include/talus").glob("*.h"):
        for language, compiler in (("c", ["cc", "-std=c17"]), ("c++", ["c++", "-std=c++17"])):
            if shutil.which(compiler[0]):
                source = folder / f"header.{'c' if language == 'c' else 'cc'}"
                source.write_text(f"#include <talus/{path.name}>\nint main() {{ return 0; }}\n", encoding="utf-8")
                run([*compiler, "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I", prefix / "include", source])


def check_page(prefix, folder):
    """The program of docs/c_api.md, in C and in C++."""
    page = (ROOT / "docs/c_api.md").read_text(encoding="utf-8")
    code = re.search(r"```c\n(.*?)```", page, re.S)[1]
    for language, compiler in (("c", ["cc", "-std=c17"]), ("cc", ["c++", "-std=c++17"])):
        if shutil.which(compiler[0]):
            source, program = folder / f"page.{language}", folder / f"page_{language}"
            source.write_text(code, encoding="utf-8")
            run([*compiler, "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I", prefix / "include", source, "-o", program,
                 f"-L{prefix}/lib", "-ltalus", f"-Wl,-rpath,{prefix}/lib"])
            expect(run([program]).stdout == "after 0.100 s\n", f"the program of c_api.md in {language}")


def check_text(prefix):
    """Nothing installed names the place it was built or first installed in."""
    for path in [*prefix.rglob("*.cmake"), *prefix.rglob("*.pc")]:
        text = path.read_text(encoding="utf-8")
        for word in (str(ROOT), "/first"):
            expect(word not in text, f"{path.name} names {word}")


def main():
    build = pathlib.Path(sys.argv[1])
    listing = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    version = re.search(r"^project\(talus VERSION (\S+)", listing, re.M)[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prefix = install(build, folder)
        plugins, = (prefix / "lib/talus").glob("plugins-*")
        check_symbols(prefix, version)
        check_text(prefix)
        check_headers(prefix, folder)
        check_page(prefix, folder)
        check_versions(prefix, folder, version)
        check_plugin(prefix, folder)
        check_embedding(prefix, folder, plugins)
    print("\n".join(faults) or "an installed Talus can be built upon")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
