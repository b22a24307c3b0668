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

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/tools"))
from short_names import shortened, tokens  # noqa: E402

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

# The script of it: comments and spaces that part nothing are left out, names are shorter, texts stay as they are.
TIGHT = ("function h(x){console.log(x,`\u00fc?? \\\\ \"`)}\nlet b=[];for(let a of[1,2]){b.push(`a - ${a+`, b  ${a}`+\"} \"}  // c`);"
         "if(a/2>1&&/[/ '] x/.test(b[0]))b.push('const  a  ;  '+ +a)}\nfunction e(a){return[a].map(x=>x/2)[0]}\n"
         "let d=`\n#define A  1\nvec2 f(float x){return vec2(x,1.0-x);}\n`;let i=2;class c{}\nasync function g(){}\nlet f=1;h(i,new c(e(b)));")

# Scripts, and what they are with shorter names. What is no name, or perhaps not the script's own, stays.
SHORT = [("let word=1;use(word,o.word,o?.word,word?.x,...word);", "let a=1;use(a,o.word,o?.word,a?.x,...a);"),
         ("let word=1;f({word:word,b:word?word:2,word(){return word},c:{d:[word]}});", "let a=1;f({word:a,b:a?a:2,word(){return a},c:{d:[a]}});"),
         ("let word=1;g(word,word+word);f({a,word});", "let b=1;g(b,b+b);f({a,word:b});"),
         ("let{word,other=1,x:[inner]}=o;f(word+word+word+word,other+other+other+other+other,inner);", "let{word:b,other:a=1,x:[c]}=o;f(b+b+b+b,a+a+a+a+a,c);"),
         ("let word=1;f(`word ${word+`word ${word}`} word`,'word',\"word\",/word'/);", "let a=1;f(`word ${a+`word ${a}`} word`,'word',\"word\",/word'/);"),
         ("class Thing{word=1;constructor(word){this.word=word}static word(){}get word(){return Thing}}\nlet word=1;f(word,new Thing);",
          "class a{word=1;constructor(b){this.word=b}static word(){}get word(){return a}}\nlet b=1;f(b,new a);"),
         ("if(screen){word={a:word};}for(let[i,word]of o){f(word/2/word)}", "if(screen){a={a:a};}for(let[i,a]of o){f(a/2/a)}"),
         ("let screen=1,name=2;f(document,Math.max(unknown,name));", "let screen=1,name=2;f(document,Math.max(unknown,name));"),
         ("let one=(word,{key},...rest)=>word+key+key+key+key+rest;try{one()}catch(error){f(error)}", "let e=(d,{key:b},...c)=>d+b+b+b+b+c;try{e()}catch(a){f(a)}")]

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
    if '"connect-src \'none\'",\n' not in out.read_text(encoding="ascii"):
        faults.append("the rule on connections is no string of its own")
    if run("--viewer", folder, "--out", out, "--check").returncode != 0:
        faults.append("--check does not take what was written")
    (folder / "one.js").write_text(GOOD["one.js"].replace("log", "warn"), encoding="utf-8")
    done = run("--viewer", folder, "--out", out, "--check")
    if done.returncode != 1 or "out of date" not in done.stderr:
        faults.append("--check does not see that the file is out of date")


def check_short():
    for code, wanted in SHORT:
        if "".join(text for _kind, text in tokens(code)) != code:
            faults.append(f"the pieces of {code!r} are not the whole of it")
        found = shortened(code, [code], [])
        if found != wanted:
            faults.append(f"with shorter names {code!r} became {found!r}")
    # a name that one module declares and another does not is a name of the browser's for all that is known
    code = "function f(word){return word+word}\n", "f(word);"
    if shortened("".join(code), code, ["f"]) != "".join(code):
        faults.append("a name that a module uses without having declared it was changed")


def main():
    done = run("--check")
    if done.returncode != 0:
        faults.append(done.stderr.strip())
    with tempfile.TemporaryDirectory() as folder:
        check_good(pathlib.Path(folder))
    check_short()
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
