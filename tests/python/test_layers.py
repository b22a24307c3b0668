"""Checks the walls of the house: who may include whom, and what no source may contain.

The rules are those of docs/architecture.md. Every rule is first shown to catch a bad sample made
for it, so that a rule that has gone blind fails this test too.
"""
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Modules of core, from the ground up: each with those that it may know, by including their headers or calling their functions.
MODULES = {
    "base": (),
    "geometry": ("base",),
    "plugin": ("base",),
    "mesh": ("base", "geometry"),
    "narrow": ("base", "geometry"),
    "model": ("base", "geometry"),
    "generate": ("base", "geometry", "plugin", "model", "mesh"),
    "zone": ("base", "geometry", "plugin", "model", "mesh"),
    "element": ("base", "geometry", "narrow", "plugin", "model", "zone"),
    "contact": ("base", "geometry", "narrow", "model", "zone"),
    "force": ("base", "plugin", "narrow", "model", "zone", "contact"),
    "segment": ("base", "geometry", "narrow", "model", "zone", "contact", "force"),
    "detect": ("base", "geometry", "narrow", "model", "zone", "contact", "force"),
    "query": ("base", "geometry", "narrow", "model", "zone", "contact", "segment", "detect", "element"),
    "edit": ("base", "geometry", "plugin", "model", "zone", "contact", "segment", "detect", "query", "cycle", "element"),
    "cycle": ("base", "geometry", "plugin", "model", "zone", "contact", "force", "segment", "detect", "element"),
    "state": ("base", "geometry", "narrow", "plugin", "model", "zone", "contact", "force", "segment", "detect", "cycle", "element"),
    "safety": ("base", "model", "zone", "cycle", "query", "state"),
    "io": ("base", "geometry", "model", "zone", "element", "contact", "force", "query", "cycle", "state"),
    "check": ("base",),
    "lua": (),
    "main": ("lua",),
}
# Public header -> public headers it may include.
PUBLIC = {
    "types.h": set(),
    "elementary.h": set(),
    "vmath.h": {"elementary.h", "types.h"},
    "plugin.h": {"types.h"},
    "number.h": {"plugin.h"},
    "text.h": set(),
    "kit.h": {"elementary.h", "number.h", "plugin.h", "vmath.h"},
    "solid_kit.h": {"kit.h"},
    "solid_returns.h": {"solid_kit.h"},
    "plugins.h": {"types.h", "plugin.h"},
    "output.h": {"types.h", "plugin.h"},
    "state.h": {"types.h", "plugin.h"},
    "record.h": {"types.h", "plugin.h"},
    "history.h": {"types.h", "plugin.h"},
    "keyblocks.h": {"types.h"},
    "safety.h": {"types.h"},
    "workers.h": {"types.h"},
    "log_file.h": {"types.h"},
    "draws.h": {"types.h"},
    "distributions.h": {"elementary.h", "types.h", "vmath.h"},
    "csv.h": {"number.h"},
    "poles.h": {"csv.h", "distributions.h", "kit.h"},
    "skyline.h": set(),
    "verdict.h": {"types.h", "plugin.h"},
    "watch.h": {"types.h", "plugin.h"},
    "settings.h": {"types.h", "plugin.h"},
    "law_test.h": {"types.h", "plugin.h"},
    "solid_test.h": {"types.h", "plugin.h"},
    "view.h": {"types.h", "plugin.h", "values.h"},
    "values.h": {"types.h", "plugin.h"},
    "check.h": {"plugins.h", "values.h"},
    "talus.h": {"types.h", "plugin.h", "plugins.h", "record.h", "history.h", "keyblocks.h", "safety.h", "law_test.h", "solid_test.h", "output.h", "state.h", "watch.h", "settings.h", "values.h",
                "version.h", "verdict.h", "view.h", "defaults.h"},
    "defaults.h": {"talus.h"},
    "fields.h": {"talus.h"},
    "zones.h": {"talus.h"},
    "elements.h": {"talus.h"},
    "views.h": {"talus.h"},
    "modes.h": {"talus.h"},
    "boundary.h": {"talus.h"},
}
PLUGIN_HEADERS = {"talus/version.h", "talus/types.h", "talus/elementary.h", "talus/vmath.h", "talus/plugin.h",
                  "talus/kit.h", "talus/solid_kit.h", "talus/solid_returns.h", "talus/number.h", "talus/text.h",
                  "talus/distributions.h", "talus/csv.h", "talus/poles.h", "talus/skyline.h"}
# What a plugin may include besides: the headers of standard C.
STANDARD_HEADERS = {
    name + ".h"
    for name in "assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp "
    "signal stdalign stdarg stdatomic stdbool stddef stdint stdio stdlib stdnoreturn string tgmath "
    "threads time uchar wchar wctype".split()
}
# What a screen may include besides: the system's headers of threads and sockets, and of its server.
SCREEN_HEADERS = {"pthread.h", "unistd.h", "poll.h", "strings.h", "netinet/in.h", "sys/eventfd.h", "sys/random.h", "sys/socket.h",
                  "microhttpd.h"}
LUA_HEADERS = {"lua.h", "lauxlib.h", "lualib.h", "luaconf.h", "lua.hpp"}
KIND_FOLDERS = ("laws", "damping", "generators", "solids", "elements", "screens")
# Kinds whose names are also words of the model (a joint is a thing, a field and a generator; a
# contact's state may be elastic, a ratio local, energy kinetic, a boundary in a box): only a look-up or comparison with them is a fault.
WORDS_OF_THE_MODEL = {"joint", "blocks", "elastic", "local", "kinetic", "box", "zones"}

MAX_FILE_LINES = 900
MAX_FUNCTION_LINES = 70
MAX_HEADER_LINES = 400
# The one place that finds the poses of a contact's sides, the modules that go through it, and their files that read poses
# of bodies as such: who moves and shows them, how far they go, and where the bounds and outer faces of blocks are.
SIDES = "core/contact/sides.h"
SIDE_MODULES = {"contact", "force", "detect", "cycle", "query", "io"}
POSES_OF_BODIES = {f"core/{file}.c" for file in (
    "cycle/failing cycle/insitu cycle/limits cycle/meshes cycle/motion cycle/put_back cycle/settle detect/broad io/scene io/vtk_contacts io/vtk_section query/touching query/views").split()}
# First folders of paths that exist on one machine only.
MACHINE_FOLDERS = "data|home|media|mnt|opt|root|scratch|srv|tmp|var|work|Users"
TEXT_SUFFIXES = {".c", ".h", ".lua", ".py", ".md", ".txt", ".json", ".sh", ".cmake", ""}
UNREAD_FOLDERS = {"build", "out", ".git", ".cache", "__pycache__"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
# What begins a line of C and may name a function or an object that other files see.
OUTER = re.compile(r"^(?!static\b|typedef\b|struct \w+(?:;| \{))[A-Za-z_][^\n;={}()]*?\b(tl_\w+)(?=\(|\[|;| =)", re.M)
NAME = re.compile(r"\btl_\w+")
COMMENT = re.compile(r'/\*.*?\*/|//[^\n]*|("(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\')', re.S)
STRING = re.compile(r'"((?:\\.|[^"\\\n])*)"')
MACHINE_PATH = re.compile(r"(?<![\w.*/:)\]}>?%-])/(?:" + MACHINE_FOLDERS + r")/[\w.]")
# Functions of the C library whose last bits depend on its version and on the processor. What talus/elementary.h
# uses instead (fma, fmod, frexp, ldexp, floor, sqrt and the like) is defined to the bit.
INEXACT = re.compile(
    r"(?<![\w.>])(?:sin|cos|tan|sincos|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|exp|exp2|expm1|log|"
    r"log2|log10|log1p|pow|cbrt|hypot|erf|erfc|tgamma|lgamma)[fl]?\(")
# Functions whose numbers have the decimal point of the process's locale. talus/number.h reads and writes numbers instead.
LOCALE_ALWAYS = re.compile(r"(?<![\w.>])(?:strtod|strtof|strtold|atof|v[fs]?scanf|v(?:s|sn|f|as|d)?printf)\s*\(")
LOCALE_FLOATING = re.compile(r"(?<![\w.>])(?:[fs]?scanf|(?:s|sn|f|as|d)?printf|lua_pushfstring|luaL_error)\s*\(")
FLOATING = re.compile(r"%[-+ #0-9.*]*[lL]?[aAeEfFgG]")
LETTER = re.compile(r"'(?:\\.|[^'\\])'")
# A row of poses, and the body of the block of a contact: looked up at once, or by a name that the block is given before.
POSE = re.compile(r"(?:\.|->)pose\b")
BODY_OF_SIDE = re.compile(r"blocks(?:\.|->)body\[[^][;]*(?:\.|->)[ab]\[")
NAMED_SIDE = re.compile(r"\b(\w+) = [^,;=]*(?:\.|->)[ab]\[[^,;]*(?=[,;])")
UNFINISHED = re.compile(r"\b(?:TO" + r"DO|FIX" + r"ME|XX" + r"X)\b")


def without_comments(text):
    """Source text with comments blanked, lines and strings kept."""

    def replace(match):
        return match.group(1) or "\n" * match.group(0).count("\n")

    return COMMENT.sub(replace, text)


def includes(text):
    return [(m.group(1) == '"', m.group(2)) for m in INCLUDE.finditer(text)]


def call_at(text, begin):
    """The arguments of a call, from behind its bracket on."""
    depth, quoted, at = 1, False, begin
    while depth and at < len(text):
        letter = text[at]
        if quoted:
            at += letter == "\\"
            quoted = letter != '"'
        else:
            quoted = letter == '"'
            depth += (letter == "(") - (letter == ")")
        at += 1
    return text[begin:at - 1]


def check_numbers_as_text(path, text):
    """Numbers are read and written by talus/number.h alone."""
    if path.parts[-2:] == ("talus", "number.h"):
        return
    plain = LETTER.sub("0", without_comments(text))
    for match in LOCALE_ALWAYS.finditer(plain):
        yield f"'{match.group(0)}' hangs on the locale: tl_number_read and tl_text_vprint do not"
    for match in LOCALE_FLOATING.finditer(plain):
        arguments = call_at(plain, match.end())
        if FLOATING.search("".join(STRING.findall(arguments)).replace("%%", "")):
            yield f"'{match.group(0)}{arguments[:40]}...' has numbers as the locale has them: tl_text_print has not"


def module_of(parts):
    return parts[1] if len(parts) > 2 else "main"


def may_know(module, other):
    return other == module or other in MODULES.get(module, ())


def check_core_includes(path, parts, text):
    module = module_of(parts)
    for quoted, name in includes(text):
        if name in LUA_HEADERS and module not in ("lua", "main"):
            yield f"includes {name}: only core/lua and core/main.c know Lua"
        if quoted and module == "include":
            yield f'includes "{name}": public headers include only <talus/...>'
        elif quoted and not may_know(module, name.split("/")[0] if "/" in name else module):
            yield f'module {module} includes "{name}": it may know {sorted(MODULES.get(module, ()))}'
        elif module == "include" and name.startswith("talus/"):
            if name[len("talus/"):] not in PUBLIC.get(path.name, set()):
                yield f"public header {path.name} includes <{name}>"


def check_plugin_includes(path, parts, text):
    allowed = PLUGIN_HEADERS | STANDARD_HEADERS | (SCREEN_HEADERS if "screens" in parts else set())
    for quoted, name in includes(text):
        if quoted and ("/" in name or not (path.parent / name).exists()):
            yield f'a plugin includes "{name}", which is not of its own folder'
        if not quoted and name not in allowed:
            yield f"a plugin includes <{name}>"


def check_kind_names(path, text, kinds):
    """Nothing in core names a law, a damping or a generator; only model:water and quiet faces have kinds of
    their own."""
    if path.as_posix().endswith(("core/lua/water.c", "core/lua/quiet.c")):
        return
    for number, line in enumerate(without_comments(text).splitlines(), 1):
        for literal in STRING.findall(line):
            looks_up = "tl_plugin_find" in line or "->name" in line
            if literal in kinds and (literal not in WORDS_OF_THE_MODEL or looks_up):
                yield f'line {number}: core names the plugin kind "{literal}"'


def check_functions(text):
    """The same bits on every machine: sines and the like come from talus/elementary.h."""
    code = STRING.sub('""', without_comments(text))
    for number, line in enumerate(code.splitlines(), 1):
        for match in INEXACT.finditer(line):
            yield f"line {number}: {match.group(0)}...) has other bits on other machines: use talus/elementary.h"


def check_sides(name, text):
    """Where the sides of a contact are is asked of one header."""
    plain = STRING.sub('""', without_comments(text))
    if POSE.search(plain) and name not in POSES_OF_BODIES:
        yield f"reads a row of poses: {SIDES} finds those of a contact's sides"
    for function in re.split(r"^}", plain, flags=re.M):
        blocks = "|".join(map(re.escape, NAMED_SIDE.findall(function)))
        if BODY_OF_SIDE.search(function) or blocks and re.search(rf"blocks(?:\.|->)body\[(?:{blocks})\]", function):
            yield f"looks up the body of a contact's block: {SIDES} knows its sides and bodies"


def check_lengths(path, text):
    lines = text.splitlines()
    if len(lines) > MAX_FILE_LINES and not path.name.endswith((".d.lua", "page_asset.c")):  # written by a tool
        yield f"{len(lines)} lines, more than {MAX_FILE_LINES}"
    begin = None
    for number, line in enumerate(lines if path.suffix == ".c" else [], 1):
        if line == "{":
            begin = number
        elif line == "}" and begin is not None:
            if number - begin - 1 > MAX_FUNCTION_LINES:
                yield f"line {begin}: a function of {number - begin - 1} lines"
            begin = None


def bare(text):
    """Source text without comments, directives and strings."""
    return re.sub(r"^\s*#[^\n]*", "", STRING.sub('""', without_comments(text)), flags=re.M)


def outer_names(text):
    """Names of functions and objects at the outer level of bare text: (name, whether they are defined there)."""
    for match in OUTER.finditer(text):
        depth, at = 0, match.end()
        while at < len(text) and (depth or text[at] not in ";{="):
            depth += {"(": 1, ")": -1}.get(text[at], 0)
            at += 1
        yield match.group(1), at < len(text) and text[at] != ";"


def check_module_header(path, text):
    """A header declares the functions of the source of its name, or types only."""
    lines = len(text.splitlines())
    if lines >= MAX_HEADER_LINES:
        yield f"{lines} lines: a header of core/{path.parent.name} has fewer than {MAX_HEADER_LINES}"
    source = path.with_suffix(".c")
    there = bare(source.read_text(encoding="utf-8")) if source.exists() else ""
    defined = {name for name, here in outer_names(there) if here}
    for name, here in outer_names(bare(text)):
        if not here and name not in defined:
            yield f"declares {name}, which {source.name} does not define"


class Core:
    """The files of core, a source and its header as one, by the names "MODULE/STEM", and which others each one needs.

    It needs those whose headers it includes and those whose functions it names."""

    def __init__(self, root):
        self.public = {name for path in (root / "core/include/talus").glob("*.h")
                       for name, _ in outer_names(bare(path.read_text(encoding="utf-8")))}
        self.texts, self.defined = {}, {}
        for path in sorted((root / "core").rglob("*.[ch]")):
            parts = path.relative_to(root).parts
            if parts[1] == "include":
                continue
            text = path.read_text(encoding="utf-8", errors="replace")
            file = f"{module_of(parts)}/{path.stem}"
            self.texts.setdefault(file, []).append((path.suffix, text))
            if path.suffix == ".c":
                self.defined.update({name: file for name, here in outer_names(bare(text)) if here})
        self.needs = {file: self.needs_of(file) for file in self.texts}

    def needs_of(self, file):
        needs = {}
        for suffix, text in self.texts[file]:
            plain = bare(text)
            declared = {name for name, here in outer_names(plain) if not here and suffix == ".h"}
            for name in set(NAME.findall(plain)) - declared:
                if name in self.defined:
                    needs.setdefault(self.defined[name], set()).add(name)
            for quoted, name in includes(text):
                other = (name if "/" in name else f"{file.split('/')[0]}/{name}")[:-2]
                if quoted and other in self.texts:
                    needs.setdefault(other, set())
        needs.pop(file, None)
        return needs

    def module_graph(self):
        graph = {}
        for file, needs in self.needs.items():
            module = file.split("/")[0]
            graph.setdefault(module, set()).update(other.split("/")[0] for other in needs)
        return {module: {other for other in needs if other != module and other in graph} for module, needs in graph.items()}


def drawing(graph):
    """The modules floor by floor, each with those it needs; what it reaches by others is left out."""
    def height(module):
        return 1 + max((height(other) for other in graph[module]), default=-1)

    def below(module):
        return graph[module].union(*(below(other) for other in graph[module]))

    lines = []
    for floor in sorted({height(module) for module in graph}, reverse=True):
        for module in sorted(graph):
            if height(module) == floor:
                direct = {other for other in graph[module] if not any(other in below(one) for one in graph[module])}
                lines.append(f"    {floor:2}  {module:9}" + (" ▶ " + ", ".join(sorted(direct)) if direct else ""))
    return "\n".join(lines) + "\n"


def circles(graph):
    """The sets of files that need each other, each as its names in order."""

    def reached(stem):
        seen, left = set(), [stem]
        while left:
            for other in graph[left.pop()] - seen:
                seen.add(other)
                left.append(other)
        return seen

    all_reached = {stem: reached(stem) for stem in graph}
    return {
        " ".join(sorted({other for other in there if stem in all_reached[other]}))
        for stem, there in all_reached.items() if stem in there
    }


def check_walls(core):
    """No file and no module needs one that needs it, and none calls what it may not know."""
    for circle in sorted(circles({file: set(needs) for file, needs in core.needs.items()})):
        yield "core", f"files that need each other: {circle}"
    for circle in sorted(circles(core.module_graph())):
        yield "core", f"modules that need each other: {circle}"
    for file, needs in core.needs.items():
        module = file.split("/")[0]
        for other, names in needs.items():
            strangers = names - core.public
            if strangers and not may_know(module, other.split("/")[0]):
                yield f"core/{file}.c", f"module {module} calls {sorted(strangers)[0]} of {other}.c: it may know {sorted(MODULES.get(module, ()))}"


def check_words(text):
    for number, line in enumerate(text.splitlines(), 1):
        if UNFINISHED.search(line):
            yield f"line {number}: unfinished work"
        for match in MACHINE_PATH.finditer(line):
            yield f"line {number}: a path of some machine: {match.group(0)}..."


def source_files(root):
    for path in sorted(root.rglob("*")):
        parts = path.relative_to(root).parts
        if path.is_file() and path.suffix in TEXT_SUFFIXES and not UNREAD_FOLDERS & set(parts):
            if not parts[-1].startswith("."):
                yield path, parts


def kind_names(root):
    return {p.name for kind in KIND_FOLDERS for p in (root / "plugins" / kind).glob("*") if p.is_dir()}


def check_tree(root):
    """All faults in the tree, as (file, sentence)."""
    kinds = kind_names(root)
    faults = []
    for path, parts in source_files(root):
        text = path.read_text(encoding="utf-8", errors="replace")
        is_c = path.suffix in (".c", ".h")
        found = [*check_words(text)]
        # Documents may be long, sources may not.
        found += check_lengths(path, text) if path.suffix not in (".md", ".json", ".txt", "") else []
        if is_c and parts[0] == "core":
            found += [*check_core_includes(path, parts, text), *check_kind_names(path, text, kinds)]
            if path.suffix == ".h" and parts[1] != "include" and len(parts) > 2:
                found += check_module_header(path, text)
            if module_of(parts) in SIDE_MODULES and "/".join(parts) != SIDES:
                found += check_sides("/".join(parts), text)
        if is_c and parts[0] in ("core", "plugins"):
            found += [*check_functions(text), *check_numbers_as_text(path, text)]
        if is_c and parts[0] == "plugins" and len(parts) > 2 and parts[1] in KIND_FOLDERS:
            found += check_plugin_includes(path, parts, text)
        faults += [("/".join(parts), fault) for fault in found]
    core = Core(root)
    faults += check_walls(core)
    paper = root / "docs/architecture.md"
    if paper.exists() and not any("need each other" in sentence for _, sentence in faults):
        if drawing(core.module_graph()) not in paper.read_text(encoding="utf-8"):
            faults.append(("docs/architecture.md", "its drawing of the modules is not this one:\n" + drawing(core.module_graph())))
    return faults


# One bad sample for each rule, and a part of the sentence it must bring about.
BAD = [
    ("core/base/a.c", '#include "model/model.h"\n', "module base includes"),
    ("core/geometry/a.c", '#include "model/model.h"\n', "module geometry includes"),
    ("core/narrow/a.c", '#include "model/model.h"\n', "module narrow includes"),
    ("core/model/a.c", '#include "detect/detect.h"\n', "module model includes"),
    ("core/contact/a.c", '#include "detect/detect.h"\n', "module contact includes"),
    ("core/detect/a.c", '#include "cycle/cycle.h"\n', "module detect includes"),
    ("core/force/a.c", '#include "detect/detect.h"\n', "module force includes"),
    ("core/query/a.c", '#include "cycle/cycle_data.h"\n', "module query includes"),
    ("core/cycle/e.c", '#include "query/touching.h"\n', "module cycle includes"),
    ("core/cycle/a.c", '#include "io/vtk_file.h"\n', "module cycle includes"),
    ("core/io/a.c", '#include "plugin/loader.h"\n', "module io includes"),
    ("core/plugin/a.c", '#include "cycle/cycle.h"\n', "module plugin includes"),
    ("core/lua/a.c", '#include "model/model.h"\n', "module lua includes"),
    ("core/main.c", '#include "model/model.h"\n', "module main includes"),
    ("core/io/b.c", "#include <lua.h>\n", "know Lua"),
    ("core/include/talus/plugin.h", "#include <talus/talus.h>\n", "public header plugin.h"),
    ("core/include/talus/talus.h", '#include "base/error.h"\n', "public headers include only"),
    ("plugins/laws/springy/springy.c", "#include <talus/talus.h>\n", "a plugin includes <talus"),
    ("plugins/laws/springy/b.c", "#include <unistd.h>\n", "a plugin includes <unistd.h>"),
    ("plugins/laws/springy/c.c", '#include "model/model.h"\n', "not of its own folder"),
    ("core/cycle/b.c", 'int x = strcmp(law, "springy"); /* "no" */\n', "core names"),
    ("core/cycle/c.c", 'tl_plugin_find(TL_KIND_GENERATOR, "joint");\n', "core names"),
    ("core/cycle/long.c", "\n" * (MAX_FILE_LINES + 1), f"more than {MAX_FILE_LINES}"),
    ("core/cycle/d.c", "int f(void)\n{\n" + "    ;\n" * (MAX_FUNCTION_LINES + 1) + "}\n", "a function of"),
    ("core/cycle/f.c", "double x = sin(y);\n", "has other bits"),
    ("plugins/laws/springy/f.c", "double x = 1 + atan2(y, z);\n", "has other bits"),
    ("core/base/f.h", "float x = powf(y, z);\n", "has other bits"),
    ("core/force/p.c", "tl_vec3 u = m->bodies.pose[side].u;\n", "reads a row of poses"),
    ("core/cycle/p.c", "uint32_t body = m->blocks.body[m->detect->contacts.a[c]];\n", "looks up the body"),
    ("core/detect/p.c", "uint32_t a = c->a[i], b = c->b[i];\nd->touched[m->blocks.body[b]] = true;\n", "looks up the body"),
    ("core/io/n.c", "double x = strtod(text, &end);\n", "hangs on the locale"),
    ("core/n.c", 'int n = sscanf(text, "%lf", &x);\n', "as the locale has them"),
    ("plugins/laws/springy/n.c", "x = atof (text);\n", "hangs on the locale"),
    ("core/base/n.c", "vsnprintf(text, size, format, list);\n", "hangs on the locale"),
    ("core/lua/n.c", 'lua_pushfstring(L, "dt = %f s", dt);\n', "as the locale has them"),
    ("plugins/laws/springy/o.c", 'snprintf(text, size, "%s (%d) is "\n    "%.3g m", "a)", 5, x);\n', "as the locale has them"),
    ("core/io/o.c", "fprintf(f, x == '\"' ? \"%d\" : \"%+9.4e\", y);\n", "as the locale has them"),
    ("scripts/a.lua", "-- TO" + "DO\n", "unfinished work"),
    ("docs/a.md", "see /home" + "/someone/notes.md\n", "path of some machine"),
]
# Bad samples of several files.
BAD_TREES = [
    ([("core/force/long.h", "\n" * MAX_HEADER_LINES)], "has fewer than"),
    ([("core/force/a.h", "void tl_b(void);\n"), ("core/force/b.c", "void tl_b(void)\n{\n}\n")], "declares tl_b"),
    ([("core/force/a.h", "int tl_b(int x,\n         int y);\n"), ("core/force/a.c", "void tl_a(void)\n{\n}\n")],
     "declares tl_b"),
    ([("core/detect/a.h", '#include "detect/b.h"\n'), ("core/detect/b.c", '#include "detect/b.h"\n'),
      ("core/detect/b.h", '#include "detect/a.h"\n')], "need each other: detect/a detect/b"),
    ([("core/cycle/a.c", "void tl_a(void)\n{\n    tl_b();\n}\n"),
      ("core/cycle/b.c", "int tl_b(void)\n{\n    return tl_c;\n}\n"),
      ("core/cycle/c.c", "const int tl_c = 1;\nvoid tl_d(void)\n{\n    tl_a();\n}\n")], "need each other: cycle/a cycle/b cycle/c"),
    ([("core/model/a.c", "void tl_upward(void);\nvoid tl_a(void)\n{\n    tl_upward();\n}\n"),
      ("core/cycle/b.c", "void tl_upward(void)\n{\n}\n")], "module model calls tl_upward of cycle/b.c"),
    ([("core/model/a.c", "void tl_a(void)\n{\n    tl_b();\n}\n"), ("core/cycle/b.c", "void tl_b(void)\n{\n}\n"),
      ("core/cycle/c.c", "void tl_c(void)\n{\n    tl_d();\n}\n"), ("core/model/d.c", "void tl_d(void)\n{\n}\n"),
      ("core/include/talus/talus.h", "void tl_b(void);\n")], "modules that need each other: cycle model"),
]
GOOD = [
    ("core/force/types.h", "struct tl_s;\ntypedef int (*tl_fn)(struct tl_s *s);\nstatic inline int tl_f(int x)\n{\n    return x;\n}\n"),
    ("core/force/a.h", '#include "force/types.h"\nstruct tl_s *tl_a(tl_fn a, /* tl_b(); */\n                  int b);\n'),
    ("core/force/a.c", '#include "force/a.h"\nstruct tl_s *tl_a(tl_fn a, int b)\n{\n    return tl_f(b) ? 0 : 0;\n}\n'),
    ("core/force/b.c", '#include "force/a.h"\nvoid tl_b(void)\n{\n    tl_a(0, 1);\n}\n'),
    ("core/io/fine.c", '#include "io/vtk_file.h"\n#include "model/model.h"\n#include <talus/talus.h>\n'),
    ("core/lua/fine.c", '#include "front.h"\n#include <lua.h>\n#include <talus/talus.h>\n'),
    ("core/model/fine.c", 'int f = 0; /* "springy" is a law */ const char *s = "joint";\n'),
    ("plugins/laws/springy/springy.c", "#include <math.h>\n#include <talus/plugin.h>\n"),
    ("plugins/generators/joint/joint.c", "#include <talus/plugin.h>\n"),
    ("plugins/screens/glass/glass.c", "#include <pthread.h>\n#include <talus/plugin.h>\n"),
    ("core/detect/broad.c", "uint32_t body = m->blocks.body[pair->a];\ntl_vec3 u = m->bodies.pose[body].u;\n"),
    ("core/contact/sides.h", "#define TL_BODY m->bodies.pose[m->blocks.body[c->a[i]]]\n"),
    ("core/model/f.c", 'double x = tl_sin(y) + sqrt(y) + m->log(fma(y, y, y)); /* sin(y) */ char *s = "sin(y)";\n'),
    ("core/model/n.c", 'snprintf(text, size, "100 %% of %s, %zu", "f", n); /* sscanf(a, "%g") */ tl_text_print(t, 9, "%g", x);\n'),
    ("core/include/talus/number.h", '#include <talus/plugin.h>\ndouble x = strtod(text, NULL); /* vsnprintf( */\n'),
    ("docs/a.md", "kn in Pa/m, https://example.org/a/b, /usr/bin/python3, a/b/c\n"),
]


def write_tree(root, samples):
    for name, text in samples:
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def check_the_checks():
    """Faults of this test itself: rules that miss their bad sample or refuse a good one."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        write_tree(root, GOOD)
        for name, sentence in check_tree(root):
            yield f"a good sample is refused: {name}: {sentence}"
    for files, expected in [([(name, text)], expected) for name, text, expected in BAD] + BAD_TREES:
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "plugins/laws/springy").mkdir(parents=True)
            (root / "plugins/generators/joint").mkdir(parents=True)
            write_tree(root, files)
            if not any(expected in sentence for _, sentence in check_tree(root)):
                yield f"the bad sample {files[0][0]} passes: expected '{expected}'"


def main():
    blind = [*check_the_checks()]
    for fault in blind:
        print(f"test_layers.py: {fault}")
    faults = check_tree(ROOT)
    for name, sentence in faults:
        print(f"{name}: {sentence}")
    files = sum(1 for _ in source_files(ROOT))
    if files == 0:
        print(f"test_layers.py: no sources found under {ROOT}")
    print(f"layers: {files} files, {len(BAD) + len(BAD_TREES) + len(GOOD)} samples, {len(faults) + len(blind)} faults")
    return 1 if faults or blind or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
