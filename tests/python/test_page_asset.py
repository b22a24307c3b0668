#!/usr/bin/env python3
"""core/io/page_asset.c is what scripts/tools/page_asset.py makes of viewer/; modules that it cannot put together are refused."""
import base64
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOL = ROOT / "scripts/tools/page_asset.py"

# Modules of a small page, and what each mistake in them is to be told with.
GOOD = {"main.js": '// Starts.\nimport { one } from "./one.js";\nimport { half, text } from "./text.js";\nimport {\n    two,\n    Three,\n} from "./two.js";\none(two, new Three(half(text)));\n',
        "one.js": "/** Says it. */\nexport function one(x) { console.log(x, `\u00fc?? \\\\ \"`); }\n",
        "text.js": "/** @type {string[]} */ export const text = [];\nfor (const a of [1, 2]) {\n    text.push(`a - ${a + `, b  ${ a }` + \"} \"}  // c`); // it's last\n"
                   "    if (a / 2 > 1 && /[/ '] x/.test(text[0])) text.push('const  a  ;  ' + + a);\n}\n"
                   "/** @param {number} a */\nexport function half(a) { return [a].map((x) => x /* by */ / 2)[0]; }\n"
                   "export const PROGRAM = `\n#define A  1\nvec2 f(float x) { return vec2(x, 1.0 - x); } // GLSL\n`;\n",
        "two.js": "export const two = 2;\n\nexport class Three { }\nexport async function later() { }\nlet inner = 1;\n"}
BAD = [({"one.js": "export default function one(x) { }\n"}, "one"),
       ({"one.js": "export { one };\nfunction one() { }\n"}, "export"),
       ({"one.js": 'import * as all from "./two.js";\nexport function one() { }\n'}, "import"),
       ({"one.js": 'import { two as other } from "./two.js";\nexport function one() { }\n'}, "as"),
       ({"one.js": "export function other() { }\n"}, "one"),
       ({"one.js": "export function one() { }\nconst inner = 2;\n"}, "inner"),
       ({"one.js": 'import { two } from "./none.js";\nexport function one() { }\n'}, "none.js"),
       ({"one.js": 'export function one() { return "</scr" + "ipt></script>"; }\n'}, "</script"),
       ({"one.js": 'export function one() { return "<!--"; }\n'}, "<!--"),
       ({"two.js": 'import { one } from "./one.js";\nexport const two = one;\nexport class Three { }\n',
         "one.js": 'import { two } from "./two.js";\nexport function one() { return two; }\n'}, "import each other"),
       ({"alone.js": "export const alone = 1;\n"}, "alone.js"),
       ({"page.html": "<!doctype html>\n"}, "page.html"),
       ({"style.css": "p { content: '</style>'; }\n"}, "</style")]

# The script of it: comments and spaces that part nothing are left out, texts stay as they are.
TIGHT = ("function one(x){console.log(x,`\u00fc?? \\\\ \"`)}\nlet text=[];for(let a of[1,2]){text.push(`a - ${a+`, b  ${a}`+\"} \"}  // c`);"
         "if(a/2>1&&/[/ '] x/.test(text[0]))text.push('const  a  ;  '+ +a)}\nfunction half(a){return[a].map(x=>x/2)[0]}\n"
         "let PROGRAM=`\n#define A  1\nvec2 f(float x){return vec2(x,1.0-x);}\n`;let two=2;class Three{}\nasync function later(){}\nlet inner=1;one(two,new Three(half(text)));")

faults = []


def run(*arguments):
    return subprocess.run([sys.executable, TOOL, *arguments], capture_output=True, text=True, check=False)


def write(folder, files):
    shutil.copy(ROOT / "viewer/page.html", folder / "page.html")
    shutil.copy(ROOT / "viewer/style.css", folder / "style.css")
    for name, text in {**GOOD, **files}.items():
        (folder / name).write_text(text, encoding="utf-8")


def text_of(source, name):
    """The text of an array of strings in C."""
    body = source.split(f"{name}[] = {{\n")[1].split("NULL};")[0]
    literals = b"".join(line.strip()[1:-2].encode() for line in body.splitlines() if line.strip())
    unescaped = re.sub(rb"\\(\d{3}|.)", lambda m: {b"n": b"\n"}.get(m[1], bytes([int(m[1], 8)]) if len(m[1]) == 3 else m[1]), literals)
    return unescaped.decode("utf-8")


def check_good(folder):
    out = folder / "asset.c"
    write(folder, {})
    done = run("--viewer", folder, "--out", out)
    if done.returncode != 0:
        faults.append(f"good modules are refused: {done.stderr}")
        return
    page = text_of(out.read_text(encoding="ascii"), "tl_page_before") + text_of(out.read_text(encoding="ascii"), "tl_page_after")
    script = re.search(r'<script type="module">(.*?)</script>', page, re.S)[1]
    if script != TIGHT:
        faults.append(f"the modules became {script!r}, not {TIGHT!r}")
    for name, text in (("script", script), ("style", re.search(r"<style>(.*?)</style>", page, re.S)[1])):
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        if f"{name}-src 'sha256-{digest}'" not in page:
            faults.append(f"the policy does not allow the {name}")
    if run("--viewer", folder, "--out", out, "--check").returncode != 0:
        faults.append("--check does not take what was written")
    (folder / "one.js").write_text(GOOD["one.js"].replace("log", "warn"), encoding="utf-8")
    done = run("--viewer", folder, "--out", out, "--check")
    if done.returncode != 1 or "out of date" not in done.stderr:
        faults.append("--check does not see that the file is out of date")


def main():
    done = run("--check")
    if done.returncode != 0:
        faults.append(done.stderr.strip())
    with tempfile.TemporaryDirectory() as folder:
        check_good(pathlib.Path(folder))
    for files, part in BAD:
        with tempfile.TemporaryDirectory() as folder:
            write(pathlib.Path(folder), files)
            done = run("--viewer", folder, "--out", pathlib.Path(folder) / "asset.c")
            if done.returncode != 1 or part not in done.stderr or len(done.stderr.strip().splitlines()) != 1:
                faults.append(f"{files}: '{part}' is not in: {done.stderr}")
            if (pathlib.Path(folder) / "asset.c").exists():
                faults.append(f"{files}: a file was written")
    for fault in faults:
        print(fault)
    print(f"page asset: {len(BAD)} mistakes, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
