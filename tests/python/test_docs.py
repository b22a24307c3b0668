#!/usr/bin/env python3
"""Runs every code block of README.md, docs/*.md and the other pages beside README.md and compares what it prints with the page; follows the pages' links,
and looks for the files and functions that docs/architecture.md names.

A block is fenced and says its language. Each page has a scratch folder of its own, in which all its blocks run:

    lua       run by the program
    sh        run by sh; the program is `talus` and build/release/talus, `core` and `scripts` are those of the source tree
    console   lines that begin with "$ " are run by sh, the lines below each are what it prints
    c         compiled with the public headers only, with warnings as errors
    json      parsed
    text      right after one of these: what it prints; elsewhere it is only read

A line `...` of an output stands for any lines, and `...` within a line for any text. A comment of the page before a block
(the blank line between them may be left out) says more:

    <!-- continues -->       this Lua block goes on with the state of the one before
    <!-- file: NAME -->      the block is written to this file of the scratch folder; a Lua block that a command further
                             down the page runs is run there only
    <!-- plugin: NAME.so --> the C block is a plugin: it is linked, too, into this file of the scratch folder
    <!-- run by: TEST -->    it needs an installed Talus or the like, and this other test runs the same commands
    <!-- fails -->           the block, or its last command, ends with an error, which belongs to what it prints
    <!-- not run: REASON --> it is only read; MOST_NOT_RUN tells how many there may be

The usage lines of the reference in docs/lua.md are run on a small model, but for those that have a word in capitals
("GENERATOR") for a name: these are compiled.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ.get("TALUS_PROGRAM", ROOT / "build/release/talus")).resolve()
STOCK_LUA = os.environ.get("TALUS_STOCK_LUA", "")
MARK = "<!-- Below this line: written by scripts/tools/reference.lua. -->"
MOST_NOT_RUN = 5
LANGUAGES = {"C", "lua", "sh", "console", "c", "json", "text"}
BETWEEN = "----8<---- end of a block"
COMMAND = re.compile(r"\s+(?:\$ |\./bootstrap |(?:[A-Z_]+=\S* )*(?:build/release/)?(?:talus|lua5\.4|cmake|gcc|xvfb-run) )")

# scripts/tools/usage_model.lua makes the model of each usage line.
TRY_USAGES = """
local build = require "usage_model"
local function try(usage)
    local chunk, message = load(usage, "=usage", "t", build())
    local good = chunk ~= nil
    if good then
        good, message = pcall(chunk)
    end
    if not good then
        print(usage .. " :", message)
    end
end
"""

faults = []


def fault(place, text):
    faults.append(f"{place}: {text}")


class Block:
    def __init__(self, page, line, language, text, notes):
        self.page, self.line, self.language, self.text = page, line, language, text
        self.expected = None
        self.continues = "continues" in notes
        self.fails = "fails" in notes
        self.file = next((n[5:].strip() for n in notes if n.startswith("file:")), None)
        self.plugin = next((n[7:].strip() for n in notes if n.startswith("plugin:")), None)
        self.run_by = next((n[7:].strip() for n in notes if n.startswith("run by:")), None)
        self.not_run = next((n[8:].strip() for n in notes if n.startswith("not run:")), None)

    @property
    def place(self):
        return f"{self.page}:{self.line}"


def read_blocks(page, text):
    """Blocks of a page in their order. Indented blocks are formulas, drawings and tables, and no code."""
    blocks, notes, lines, i, last, before = [], [], text.split("\n"), 0, None, ""
    while i < len(lines):
        line = lines[i]
        note = re.fullmatch(r"<!--\s*(.*?)\s*-->", line)
        if line.startswith("```"):
            language, first = line[3:].strip(), i + 1
            i += 1
            while i < len(lines) and not lines[i].startswith("```"):
                i += 1
            body = "".join(text + "\n" for text in lines[first:i])
            if language not in LANGUAGES:
                fault(f"{page}:{first}", f"a block of the language '{language}'; known: {', '.join(sorted(LANGUAGES))}")
            block = Block(page, first, language, body, notes)
            if language == "text" and last:
                last.expected = body
                last = None
            elif language != "text":
                blocks.append(block)
                last = block
            notes = []
        elif note:
            notes.append(note[1])
        elif line.strip():
            last, notes = None, []
            if COMMAND.match(line) and line.startswith("    ") and not before.startswith(" "):
                fault(f"{page}:{i + 1}", "a command in an indented block: fence it as sh or console")
        before = line
        i += 1
    return blocks


def pattern_of(expected):
    """A regular expression for what is printed."""
    parts = []
    for line in expected.rstrip("\n").split("\n"):
        if line.strip() == "...":
            parts.append(r"(?:[^\n]*\n)*?")
        else:
            parts.append(".*?".join(re.escape(part) for part in line.rstrip().split("...")) + r"[ \t]*\n")
    return re.compile("".join(parts))


def compare(place, expected, got):
    if expected is not None and not pattern_of(expected).fullmatch(got if got.endswith("\n") else got + "\n"):
        fault(place, f"the page gives\n{expected}but it prints\n{got}")


class Page:
    def __init__(self, name, folder):
        self.name, self.folder = name, folder
        text = (ROOT / name).read_text(encoding="utf-8")
        self.text, _, self.reference = text.partition(MARK)
        self.blocks = read_blocks(name, self.text)
        folder.mkdir(parents=True)
        (folder / "build").mkdir()
        (folder / "bin").mkdir()
        (folder / "build/release").symlink_to(PROGRAM.parent)
        (folder / "bin/talus").symlink_to(PROGRAM)
        if STOCK_LUA:
            (folder / "bin/lua5.4").symlink_to(STOCK_LUA)
        for name in ("core", "scripts", "plugins"):
            (folder / name).symlink_to(ROOT / name)
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith(("TALUS_", "LUA_"))}
        self.environment.update(HOME=str(folder / "home"), TALUS_PROGRESS="1e6",  # no line that depends on the clock
                                 PATH=f"{folder / 'bin'}:{os.environ['PATH']}")

    def run(self, command, both=True):
        return subprocess.run(command, cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT if both else subprocess.PIPE, check=False)

    def expect_status(self, block, done, what="", may_fail=True):
        if (done.returncode != 0) != (block.fails and may_fail):
            fault(block.place, f"{what}ended with status {done.returncode}:\n{done.stdout}")
            return False
        return True

    def run_lua(self, chain):
        """A block and those that continue it, as one script; what each prints is told apart by a line between them."""
        script = chain[0].file or f"line_{chain[0].line}.lua"
        text = f'print "{BETWEEN}"\n'.join(block.text for block in chain)
        (self.folder / script).write_text(text, encoding="utf-8")
        done = self.run([PROGRAM, script])
        if not self.expect_status(chain[-1], done):
            return
        outputs = done.stdout.split(BETWEEN + "\n")
        if len(outputs) != len(chain):
            fault(chain[-1].place, f"an error in a block before:\n{done.stdout}")
            return
        for block, output in zip(chain, outputs):
            compare(block.place, block.expected, output)

    def run_sh(self, block):
        lines = [line for line in block.text.split("\n") if STOCK_LUA or "lua5.4" not in line]
        done = self.run(["sh", "-euc", "\n".join(lines)])
        if self.expect_status(block, done) and len(lines) == len(block.text.split("\n")):
            compare(block.place, block.expected, done.stdout)

    def run_console(self, block):
        parts = re.split(r"^\$ ", block.text, flags=re.M)[1:]
        for part in parts:
            command, expected = part.split("\n", 1)
            if "lua5.4" in command and not STOCK_LUA:
                continue
            done = self.run(["sh", "-euc", command])
            if self.expect_status(block, done, f"`{command}` ", may_fail=part is parts[-1]):
                compare(block.place, expected, done.stdout)

    def run_C(self, _):
        """A declaration of a public header, as scripts/tools/c_api.lua gives it."""

    def run_c(self, block):
        source = self.folder / (block.file or f"line_{block.line}.c")
        source.parent.mkdir(parents=True, exist_ok=True)
        source.write_text(block.text, encoding="utf-8")
        compiler = os.environ.get("CC", "cc")
        done = self.run([compiler, "-std=c17", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror", "-fPIC",
                         "-O1", "-ffp-contract=off", "-Icore/include", "-Ibuild/release/generated", "-c", source, "-o", source.stem + ".o"])
        if self.expect_status(block, done, "the compiler ") and block.plugin:
            (self.folder / block.plugin).parent.mkdir(parents=True, exist_ok=True)
            done = self.run([compiler, "-shared", source.stem + ".o", "-o", block.plugin, "-lm"])
            self.expect_status(block, done, "the linker ")

    def run_json(self, block):
        try:
            json.loads(block.text)
        except ValueError as error:
            fault(block.place, f"no JSON: {error}")

    def write(self, block):
        (self.folder / block.file).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / block.file).write_text(block.text, encoding="utf-8")

    def check_run_by(self, block):
        """The other test has each command of the block: its first two words."""
        other = ROOT / block.run_by
        test = other.read_text(encoding="utf-8") if other.exists() else ""
        for line in block.text.splitlines():
            if " ".join(line.split()[:2]) not in test:
                fault(block.place, f"{block.run_by} does not run `{line}`")

    def run_block(self, block):
        if block.file:
            self.write(block)
        getattr(self, "run_" + block.language)(block)

    def is_run_later(self, i):
        """Whether a command further down the page runs the script of the i-th block."""
        return any(block.language in ("sh", "console") and block.not_run is None and
                   re.search(r"(?:talus|lua5\.4)\b.* " + re.escape(self.blocks[i].file), block.text)
                   for block in self.blocks[i + 1:])

    def run_blocks(self):
        """Gives how many blocks of each language were run."""
        counts, chain = {}, []
        for i, block in enumerate(self.blocks):
            if block.not_run is not None:
                continue
            if block.run_by:
                self.check_run_by(block)
                continue
            counts[block.language] = counts.get(block.language, 0) + 1
            if block.file and block.language == "lua" and self.is_run_later(i):
                self.write(block)
                continue
            if block.language != "lua":
                if block.continues:
                    fault(block.place, "only Lua blocks can continue others")
                self.run_block(block)
                continue
            chain.append(block)
            following = next((b for j, b in enumerate(self.blocks[i + 1:], i + 1)
                              if b.language == "lua" and not (b.file and self.is_run_later(j))), None)
            if not (following and following.continues):
                self.run_lua(chain)
                chain = []
        return counts

    def run_usages(self):
        """The usage lines of the reference, each on a model of its own; gives how many."""
        usages = re.findall(r"^### (.*)\n\n```lua\n(.*)\n```$", self.reference, flags=re.M)
        lines = ['package.path = "scripts/tools/?.lua;" .. package.path', TRY_USAGES]
        for _, usage in usages:
            for call in usage.split("  or  "):
                call = call.strip()
                named = re.search(r'"[A-Z]{2,}"', call) is None
                lines.append(f"try [==[{call}]==]" if named else f"assert(load [==[{call}]==])")
        script = self.folder / "usages.lua"
        script.write_text("\n".join(lines), encoding="utf-8")
        done = self.run([PROGRAM, "--quiet", script.name])
        if done.returncode != 0 or done.stdout.strip():
            fault(self.name, f"a usage line of the reference (on the model of this test):\n{done.stdout}")
        return len(usages)


def slug(heading):
    """The anchor that a heading gets on the usual hosts."""
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading.strip().lower().replace("`", ""))
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def anchors_of(text):
    """Of all headings of a page; the second of the same heading ends with -1."""
    seen, anchors = {}, set()
    for heading in re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S), flags=re.M):
        name = slug(heading)
        anchors.add(f"{name}-{seen[name]}" if name in seen else name)
        seen[name] = seen.get(name, 0) + 1
    return anchors


def without_code(text):
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S))


def check_links(pages):
    texts = {name: (ROOT / name).read_text(encoding="utf-8") for name in pages}
    anchors = {name: anchors_of(text) for name, text in texts.items()}
    count = 0
    for name, text in texts.items():
        for target in re.findall(r"\]\(([^)\s]+)\)", without_code(text)):
            if re.match(r"\w+:", target):
                continue
            count += 1
            path, _, anchor = target.partition("#")
            full = (ROOT / name).parent / path if path else ROOT / name
            if not full.exists():
                fault(name, f"the link {target} leads nowhere")
                continue
            page = full.resolve().relative_to(ROOT).as_posix()
            if anchor and page in anchors and anchor not in anchors[page]:
                fault(name, f"the link {target}: {page} has no such heading")
        for word in re.findall(r"\./bootstrap (\w+)", text):
            if not re.search(rf"^{word}\)", (ROOT / "bootstrap").read_text(encoding="utf-8"), flags=re.M):
                fault(name, f"./bootstrap has no word '{word}'")
    check_names(texts)
    if check_places("docs/architecture.md", texts["docs/architecture.md"]) < 40:
        fault("docs/architecture.md", "hardly says where anything is")
    readme = texts["README.md"]
    for name in pages:
        if name != "README.md" and f"({name})" not in readme:
            fault("README.md", f"does not link {name}")
    return count


def check_names(texts):
    """Functions and fields that a page names in its text exist: `model:solve`, `sel:fix`, `block.mass`, `talus.report`."""
    known = {}
    owner = None
    for line in (ROOT / "scripts/meta/talus.d.lua").read_text(encoding="utf-8").split("\n"):
        owner_line = re.match(r"---@class (?:\(exact\) )?(?:talus\.)?(\w+)$", line)
        name = re.match(r"---@field (\w+)", line)
        function = re.match(r"function (\w+)[:.](\w+)\(", line)
        owner = owner_line[1] if owner_line else owner
        if function:
            known.setdefault(function[1], set()).add(function[2])
        elif name:
            known.setdefault(owner, set()).add(name[1])
    owners = {"model": {"Model"}, "sel": {"Blocks", "Contacts"}, "selection": {"Blocks", "Contacts"}, "block": {"Block"},
              "contact": {"Contact"}, "talus": {"talus"}}
    for page, text in texts.items():
        for code in re.findall(r"`([^`\n]+)`", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)):
            for of, name in re.findall(r"(?<![\w./])(model|sel|selection|block|contact|talus)[:.](\w+)(?![\w/]*\.\w)", code):
                if not any(name in known[owner] for owner in owners[of]) and name not in ("so", "h", "d", "lua", "c"):
                    fault(page, f"`{code}`: {of} has no '{name}'")


def check_places(page, text):
    """The files and functions that a page names exist, and where it says `FILE`: `NAME`, or beside each other in a drawing, that file has it."""
    sources = {path.relative_to(ROOT).as_posix(): path for top in ("core", "plugins", "scripts", "tests", "viewer", "cmake") for path in (ROOT / top).rglob("*.*")
               if path.suffix in (".c", ".h", ".lua", ".py", ".js", ".cmake")}
    texts = {name: path.read_text(encoding="utf-8") for name, path in sources.items() if name.startswith(("core/", "plugins/"))}
    words = set(re.findall(r"\btl_\w+", "".join(texts[name] for name in texts if name.startswith("core/"))))

    def found(name):
        return next((full for full in (name, "core/" + name, "core/include/" + name, "tests/" + name) if full in sources), None)

    for name in sorted(set(re.findall(r"(?<![\w/.*])(?:[a-z_]+/)*[a-z_0-9]+\.(?:c|h|lua|py|js|cmake)\b", text))):
        if name in ("lua.h", "microhttpd.h") or found(name):
            continue
        if "/" in name or not any(full.endswith("/" + name) for full in sources):
            fault(page, f"there is no file {name}")
    for name in sorted(set(re.findall(r"\btl_\w+", text)) - words):
        fault(page, f"there is no {name}")
    places = [(file, name) for file, names in re.findall(r"`([\w/]+\.[ch])`: ((?:`\w+`(?:, )?)+)", text) for name in re.findall(r"\w+", names)]
    places += [(file, name) for name, file in re.findall(r"^ {4,}(\w+) {2,}([a-z]+/\w+\.[ch])\b", text, flags=re.M)]
    for file, name in places:
        if found(file) and not re.search(rf"\b{name}\b", texts.get(found(file), "")):
            fault(page, f"{file} has no {name}")
    return len(places)


def check_itself(folder):
    """A checker that sees no mistake sees none in the docs either."""
    sample = ('```lua\nx = 1\n```\n\n<!-- continues -->\n```lua\nprint(x)\n```\n```text\n2\n```\n\n```sh\nfalse\n```\n\n'
              '```c\nint f(void) { return talus; }\n```\n\n```json\n{,}\n```\n\n```console\n$ echo one\ntwo\n```\n\n'
              'Text.\n\n    talus help\n\n[gone](nowhere.md)\n\n```lua\nerror "x"\n```\n\n```perl\n```\n')
    before = list(faults)
    page = Page.__new__(Page)
    page.name, page.folder, page.reference = "sample", folder, ""
    folder.mkdir()
    (folder / "core").symlink_to(ROOT / "core")
    page.environment = dict(os.environ)
    page.blocks = [block for block in read_blocks("sample", sample) if block.language in LANGUAGES]
    page.run_blocks()
    check_names({"sample": "`model:solv{...}`, `model:solve`, `block.masses`"})
    check_places("sample", "`cycle/rest.c`: `tl_at_rest`, `tl_at_work`; `cycle/none.c`, none.h\n\n    tl_step   cycle/rest.c   a drawing\n")
    here, faults[:] = faults[len(before):], before
    for what in ("sample:32: a command", "language 'perl'", "sample:6: the page gives\n2", "sample:13: ended", "sample:17: the comp",
                 "no JSON", "model has no 'solv'", "block has no 'masses'", "the page gives\ntwo", "ended with status 1",
                 "no file cycle/none.c", "no file none.h", "no tl_at_work", "rest.c has no tl_at_work", "rest.c has no tl_step"):
        if not any(what in text for text in here):
            fault("test_docs", f"'{what}' was not found in the bad sample: {here}")
    if not pattern_of("a ... c\n...\nz\n").fullmatch("a b c\n1\n2\nz\n") or pattern_of("a\n").fullmatch("ab\n"):
        fault("test_docs", "outputs are not compared")


def main():
    pages = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"] + sorted(f"docs/{path.name}" for path in (ROOT / "docs").glob("*.md"))
    if len(sys.argv) > 1:
        pages = sys.argv[1:]
    counts, not_run = {}, []
    with tempfile.TemporaryDirectory() as folder:
        top = pathlib.Path(folder)
        check_itself(top / "itself")
        for number, name in enumerate(pages):
            page = Page(name, top / f"page_{number}")
            for language, count in page.run_blocks().items():
                counts[language] = counts.get(language, 0) + count
            not_run += [block for block in page.blocks if block.not_run is not None]
            if page.reference:
                counts["usages"] = page.run_usages()
            shutil.rmtree(page.folder, ignore_errors=True)
    links = check_links(pages) if "README.md" in pages else 0
    for block in not_run:
        print(f"not run: {block.place}: {block.not_run}")
    if len(not_run) > MOST_NOT_RUN:
        fault("docs", f"{len(not_run)} blocks are not run, and {MOST_NOT_RUN} may be: make fragments whole")
    for text in faults:
        print(text)
    print("docs: " + ", ".join(f"{count} {what}" for what, count in sorted(counts.items())) +
          f", {links} links, {len(not_run)} blocks not run, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
