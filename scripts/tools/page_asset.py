#!/usr/bin/env python3
"""Makes core/io/page_asset.c, the page that model:write_html writes, of the files in viewer/. It needs esbuild (Debian: esbuild).

    scripts/tools/page_asset.py            writes the file
    scripts/tools/page_asset.py --check    says whether it is up to date: 0, 1, or 77 where the esbuild that made it is not installed

esbuild makes one script of main.js and what it imports, and makes script and style short. The content security policy of
the page allows these two by their hashes, and nothing else.
"""
import argparse
import base64
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
VIEWER = ROOT / "viewer"
ASSET = ROOT / "core/io/page_asset.c"
SCRIPT = ("main.js", "--bundle", "--format=esm", "--target=es2022")
STYLE = ("style.css",)
SHADERS = VIEWER / "shaders.js"
# What the program replaces in the page of a run that it serves: a string of its own.
NO_CONNECTION = "connect-src 'none'"
# Bytes of a string in C that every compiler takes, with room for what is escaped.
LONGEST = 1000
SKIPPED = 77


def esbuild(*arguments):
    done = subprocess.run(["esbuild", *arguments], cwd=VIEWER, capture_output=True, encoding="utf-8", check=False)
    if done.returncode != 0 or "warning" in done.stderr.lower():
        sys.exit(f"page_asset.py: esbuild says: {done.stderr.strip()}")
    return done.stdout


def squeezed(line):
    """A line of a shader without the spaces and comments that it does not need."""
    line = line.partition("//")[0].strip()
    return line if line.startswith("#") else re.sub(r" ?([=*/,;:?<>(){}|&!]+) ?", r"\1", line)


def short(arguments):
    """A script or style as the page has it. esbuild makes script and style short, but leaves texts as they are: shaders are made short here."""
    text = esbuild(*arguments, "--minify", "--charset=utf8").strip()
    shaders = {line.strip() for line in SHADERS.read_text(encoding="utf-8").splitlines() if "`" not in line}
    text = "\n".join(squeezed(line) if line.strip() in shaders else line for line in text.split("\n"))
    text = re.sub(r"\n\n+", "\n", text)
    for mark in ("</script", "</style", "<!--"):
        if mark in text.lower():
            sys.exit(f"page_asset.py: {arguments[0]} would have {mark} in it, which ends an element of the page")
    return text


def hashed(text):
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"


def whole_page():
    page = (VIEWER / "page.html").read_text(encoding="utf-8")
    script, style = short(SCRIPT), short(STYLE)
    policy = (f"default-src 'none'; script-src {hashed(script)}; style-src {hashed(style)}; img-src data: blob:; {NO_CONNECTION}; "
              "base-uri 'none'; form-action 'none'")
    charset = '<meta charset="utf-8">\n'
    for mark, new in ((charset, f'{charset}<meta http-equiv="Content-Security-Policy" content="{policy}">\n'),
                      ('<link rel="stylesheet" href="style.css">', f"<style>{style}</style>"),
                      ('<script type="module" src="main.js"></script>', f'<script type="module">{script}</script>')):
        if page.count(mark) != 1:
            sys.exit(f"page_asset.py: page.html must have once: {mark.strip()}")
        page = page.replace(mark, new)
    return page


def literal(text):
    """A string in C, with bytes beyond ASCII as octal numbers."""
    def escaped(byte):
        char = chr(byte)
        if char in '"\\?':  # two question marks begin a trigraph
            return "\\" + char
        return "\\n" if char == "\n" else char if 32 <= byte < 127 else f"\\{byte:03o}"

    return '"' + "".join(escaped(byte) for byte in text.encode("utf-8")) + '"'


def array(name, text):
    pieces = [part[i:i + LONGEST] for line in text.splitlines(keepends=True) for part in re.split(f"({NO_CONNECTION})", line)
              for i in range(0, len(part), LONGEST)]
    return f"const char *const {name}[] = {{\n" + "".join(f"    {literal(piece)},\n" for piece in pieces) + "    NULL};\n"


def source(first_line):
    before, title, rest = whole_page().partition("<title>")
    after, end, _rest = rest.removeprefix("Talus").partition("<!-- frames -->\n")
    if not title or not end:
        sys.exit("page_asset.py: page.html must have <title>Talus</title> and, last in its body, a line <!-- frames -->")
    return (f'{first_line}\n/* clang-format off */\n#include "io/page_asset.h"\n\n#include <stddef.h>\n\n'
            + array("tl_page_before", before + title) + "\n" + array("tl_page_after", after))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--check", action="store_true", help="write nothing; 1 when the file is out of date")
    given = parser.parse_args()
    if not shutil.which("esbuild"):
        print("page_asset.py: esbuild is not installed (Debian: apt install esbuild)", file=sys.stderr)
        return SKIPPED if given.check else 1
    first_line = f"/* page_asset.c - made by scripts/tools/page_asset.py of the files in viewer/ with esbuild {esbuild('--version').strip()}: change those. */"
    if not given.check:
        ASSET.write_text(source(first_line), encoding="ascii")
        return 0
    there = ASSET.read_text(encoding="ascii")
    if not there.startswith(first_line):
        print(f"page_asset.py: another esbuild than the one of this machine made {ASSET.name}: {there.splitlines()[0]}", file=sys.stderr)
        return SKIPPED
    if there != source(first_line):
        print(f"{ASSET.name} is out of date: run scripts/tools/page_asset.py", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
