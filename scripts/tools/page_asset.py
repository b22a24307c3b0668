#!/usr/bin/env python3
"""Makes core/io/page_asset.c, the page that model:write_html writes, of the files in viewer/.

    scripts/tools/page_asset.py            writes the file
    scripts/tools/page_asset.py --check    says whether it is up to date

The modules become one script: main.js after all that it imports, without the words import and export. Lines of comments, blank
lines and indentation are left out, and names become shorter (short_names.py). The content security policy allows this script and this style by their hashes, and
nothing else. docs/scene_format.md tells what modules may be like; what is not so is refused.
"""
import argparse
import base64
import hashlib
import pathlib
import re
import sys

from short_names import REGULAR, shortened

ROOT = pathlib.Path(__file__).resolve().parents[2]
ASSET = ROOT / "core/io/page_asset.c"

IMPORT = re.compile(r'^import\s*\{([^}]*)\}\s*from\s*"\./([\w.-]+\.js)";[ \t]*\n', re.M)
EXPORT = re.compile(r"^export (?=(?:async )?function\b|const\b|let\b|class\b)", re.M)
TOP = re.compile(r"^(?:export )?(?:(?:async )?function\*?|const|let|class) +(\w+)", re.M)
LEFT = re.compile(r"^(?:import|export)\b.*|\bimport\(.*", re.M)
COMMENT = re.compile(r"^[ \t]*/\*(?:(?!\*/).)*\*/[ \t]*\n", re.S | re.M)
TYPE_COMMENT = re.compile(r"/\*\* @\w+ [^`\n]*?\*/ ?")
LINE_COMMENT = re.compile(r"^[ \t]*//.*\n", re.M)
ONE_PARAMETER = re.compile(r"\((\w+)\) ?=>")
WORD = "".join(map(chr, [*range(48, 58), *range(65, 91), *range(97, 123)])) + "_$"
# What the program replaces in the page of a run that it serves: a string of its own.
NO_CONNECTION = "connect-src 'none'"
# Bytes of a string in C that every compiler takes, with room for what is escaped.
LONGEST = 1000


class Unfit(Exception):
    """What a file may not be like."""


def without_comments(text):
    return LINE_COMMENT.sub("", TYPE_COMMENT.sub("", COMMENT.sub("", text)))


def squeezed(text):
    """Without blank lines and indentation, also of template literals: those over several lines are programs for the picture."""
    return "".join(line.strip() + "\n" for line in text.splitlines() if line.strip())


def tightened_program(text):
    """A program for the picture (GLSL), without comments and spaces; the preprocessor's lines stay."""
    lines = [line.split("//")[0].rstrip() for line in text.split("\n")]
    lines = [line if line.startswith("#") else re.sub(r" ?([-+*/=<>(){},;:?&|]) ?", r"\1", line) for line in lines]
    return re.sub(r"\n+", "\n", "\n".join(lines))


def tightened(code):
    """A script without comments, and without the spaces, ends of lines, brackets and semicolons that part nothing. Strings, templates and regular expressions stay as they are."""
    out, ends, at = [], [], 0  # ends: what ends the literals and blocks that are open
    while at < len(code):
        char = code[at]
        quote = ends[-1] if ends and ends[-1] in "`'\"" else None
        if quote:
            if char == "\\":
                out.append(code[at:at + 2])
                at += 2
                continue
            if quote == "`" and code.startswith("${", at):
                out.append("${")
                ends.append("}")
                at += 2
                continue
            if char == quote:
                ends.pop()
        elif char == "`" and "\n" in (program := code[at + 1:code.index("`", at + 1)]) and "${" not in program:
            out.append(f"`{tightened_program(program)}`")
            at += len(program) + 2
            continue
        elif char in "`'\"":
            ends.append(char)
        elif code.startswith("const ", at) and (not out or out[-1][-1] not in WORD + "."):
            out.append("let ")  # shorter, and no more than that
            at += len("const ")
            continue
        elif code.startswith("//", at):
            at = code.index("\n", at)
            continue
        elif code.startswith("/*", at):
            at = code.index("*/", at) + 2
            continue
        elif char == "/" and (found := REGULAR.match(code, at)) and out and out[-1][-1] in "(,=:&|!?;{[":
            out.append(found.group(0))
            at = found.end()
            continue
        elif char == "(" and (found := ONE_PARAMETER.match(code, at)) and out[-1][-1] not in WORD:
            out.append(found.group(1))
            at = found.end() - len("=>")
            continue
        elif char == "{":
            ends.append("}")
        elif char == "}" and ends:
            ends.pop()
            if out[-1] == ";" and out[-2][-1] in WORD + "])":  # no loop has an empty body
                out.pop()
        elif char == "\n" and out and (out[-1][-1] in ";{,(" or code[at + 1:at + 2] == "}"):
            at += 1
            continue
        elif char == " ":
            before, after = out[-1][-1], code[at + 1]
            needed = (before in WORD and after in WORD) or (before == after and before in "+-")
            if not needed:
                at += 1
                continue
        out.append(char)
        at += 1
    return "".join(out)


class Bundle:
    """Modules, each after those that it imports."""

    def __init__(self, folder):
        self.folder = folder
        self.parts, self.owner, self.exports, self.begun = [], {}, {}, set()

    def add(self, name, asked_by=None):
        if name in self.exports:
            return
        if name in self.begun:
            raise Unfit(f"{name} and {asked_by} import each other")
        self.begun.add(name)
        path = self.folder / name
        if not path.exists():
            raise Unfit(f"{asked_by} imports {name}, which is not there")
        text = path.read_text(encoding="utf-8")
        code = without_comments(text)
        for names, other in IMPORT.findall(code):
            self.add(other, name)
            for word in filter(None, re.split(r"[\s,]+", names)):
                if word not in self.exports[other]:
                    raise Unfit(f"{name} imports {word}, which {other} does not export")
        rest = IMPORT.sub("", code)
        self.exports[name] = {match for line in re.findall(r"^export .*", rest, re.M) for match in TOP.findall(line)}
        for word in TOP.findall(rest):
            if word in self.owner:
                raise Unfit(f"{word} is defined in {self.owner[word]} and in {name}")
            self.owner[word] = name
        rest = EXPORT.sub("", rest)
        left = LEFT.search(rest)
        if left:
            raise Unfit(f"{name}: '{left.group(0)}' is no import or export that this script knows")
        self.parts.append(squeezed(rest))


def check_text(name, text):
    if "</script" in text.lower() or "</style" in text.lower() or "<!--" in text:
        raise Unfit(f"{name} has </script, </style or <!-- in it")
    if "\r" in text or "\0" in text:
        raise Unfit(f"{name} has a carriage return or a zero in it")


def policy(style, script):
    def hashed(text):
        return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"

    rules = ["default-src 'none'", f"script-src {hashed(script)}", f"style-src {hashed(style)}", "img-src data: blob:",
             NO_CONNECTION, "base-uri 'none'", "form-action 'none'"]
    return f'<meta http-equiv="Content-Security-Policy" content="{"; ".join(rules)}">\n'


def once(page, mark):
    if page.count(mark) != 1:
        raise Unfit(f"page.html must have once: {mark.strip()}")
    return page.split(mark)


def page_of(folder):
    """The page in front of the title and after it."""
    page = (folder / "page.html").read_text(encoding="utf-8")
    style = squeezed(re.sub(r"/\*.*?\*/", "", (folder / "style.css").read_text(encoding="utf-8"), flags=re.S))
    bundle = Bundle(folder)
    bundle.add("main.js")
    script = shortened(tightened("".join(bundle.parts)), [tightened(part) for part in bundle.parts], bundle.owner)
    check_text("the script", script)
    check_text("style.css", style)
    unused = {path.name for path in folder.glob("*.js")} - set(bundle.exports)
    if unused:
        raise Unfit(f"main.js does not lead to {', '.join(sorted(unused))}")
    page, end = once(page, "<!-- frames -->\n")
    if re.sub(r"\s", "", end) != "</body></html>":
        raise Unfit("in page.html the end of the body must follow <!-- frames -->")
    before, after = once(page, '<meta charset="utf-8">\n')
    page = before + '<meta charset="utf-8">\n' + policy(style, script) + after
    before, after = once(page, '<link rel="stylesheet" href="style.css">\n')
    page = before + f"<style>{style}</style>\n" + after
    before, after = once(page, '<script type="module" src="main.js"></script>\n')
    page = before + f'<script type="module">{script}</script>\n' + after
    before, after = once(page, "<title>Talus</title>")
    return before + "<title>", "</title>" + after


def literal(line):
    """A line as a string in C, its bytes beyond ASCII as octal numbers."""
    text = ""
    for byte in line.encode("utf-8"):
        char = chr(byte)
        if char == "\n":
            text += "\\n"
        elif char in '"\\':
            text += "\\" + char
        elif char == "?":
            text += "\\?"  # two of them begin a trigraph
        elif 32 <= byte < 127:
            text += char
        else:
            text += f"\\{byte:03o}"
    return f'"{text}"'


def array(name, text):
    pieces = []
    for line in text.splitlines(keepends=True):
        for part in re.split(f"({NO_CONNECTION})", line):
            pieces += [part[i:i + LONGEST] for i in range(0, len(part), LONGEST)]
    return f"const char *const {name}[] = {{\n" + "".join(f"    {literal(piece)},\n" for piece in pieces) + "    NULL};\n"


def source(folder):
    before, after = page_of(folder)
    return ("/* page_asset.c - made by scripts/tools/page_asset.py of the files in viewer/: change those. */\n"
            "/* clang-format off */\n"
            '#include "io/page_asset.h"\n\n#include <stddef.h>\n\n'
            + array("tl_page_before", before) + "\n" + array("tl_page_after", after))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--check", action="store_true", help="write nothing; 1 when the file is out of date")
    parser.add_argument("--viewer", type=pathlib.Path, default=ROOT / "viewer", help="the folder of the page's files")
    parser.add_argument("--out", type=pathlib.Path, default=ASSET, help="the file to write")
    given = parser.parse_args()
    try:
        text = source(given.viewer)
    except Unfit as fault:
        print(f"page_asset.py: {fault}", file=sys.stderr)
        return 1
    if not given.check:
        given.out.write_text(text, encoding="ascii")
    elif not given.out.exists() or given.out.read_text(encoding="ascii") != text:
        print(f"{given.out.name} is out of date: run scripts/tools/page_asset.py", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
