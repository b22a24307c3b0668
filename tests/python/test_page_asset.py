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
TIGHT = ("function ad(a){console.log(a,`\u00fc?? \\\\ \"`)}\nlet aa=[];for(let a of[1,2]){aa.push(`a - ${a+`, b  ${a}`+\"} \"}  // c`);"
         "if(a/2>1&&/[/ '] x/.test(aa[0]))aa.push('const  a  ;  '+ +a)}\nfunction ac(a){return[a].map(b=>b/2)[0]}\n"
         "let af=`\n#define A  1\nvec2 f(float x){return vec2(x,1.0-x);}\n`;let ae=2;class ab{}\nasync function ah(){}\nlet ag=1;ad(ae,new ab(ac(aa)));")

# Scripts, and what they are with shorter names. What is no name, or perhaps not the script's own, stays.
SHORT = [("let word=1;use(word,o.word,o?.word,word?.x,...word);", "let aa=1;use(aa,o.word,o?.word,aa?.x,...aa);"),
         ("let word=1;f({word:word,b:word?word:2,word(){return word},c:{d:[word]}});", "let aa=1;f({word:aa,b:aa?aa:2,word(){return aa},c:{d:[aa]}});"),
         ("let word=1;g(word,word+word);f({a,word});", "let aa=1;g(aa,aa+aa);f({a,word:aa});"),
         ("let{word,other=1,x:[inner]}=o;f(word+word+word+word,other+other+other+other+other,inner);",
          "let{word:ab,other:aa=1,x:[ac]}=o;f(ab+ab+ab+ab,aa+aa+aa+aa+aa,ac);"),
         ("let word=1;f(`word ${word+`word ${word}`} word`,'word',\"word\",/word'/);", "let aa=1;f(`word ${aa+`word ${aa}`} word`,'word',\"word\",/word'/);"),
         ("class Thing{word=1;constructor(word){this.word=word}static word(){}get word(){return Thing}}\nlet word=1;f(word,new Thing);",
          "class ab{word=1;constructor(aa){this.word=aa}static word(){}get word(){return ab}}\nlet aa=1;f(aa,new ab);"),
         ("if(screen){word={a:word};}for(let[i,word]of o){f(word/2/word)}", "if(screen){a={a:a};}for(let[b,a]of o){f(a/2/a)}"),
         ("let screen=1,name=2;f(document,Math.max(unknown,name));", "let screen=1,name=2;f(document,Math.max(unknown,name));"),
         ("let one=(word,{key},...rest)=>word+key+key+key+key+rest;try{one()}catch(error){f(error)}",
          "let ab=(ad,{key:aa},...ac)=>ad+aa+aa+aa+aa+ac;try{ab()}catch(a){f(a)}"),
         # true and false, what is often used of Math, and names of programs for the picture
         ("let far=true;f({true:false,a:true,b:o.true},far,far);if(far===false)f(`${true}`,'true',far);function g(){return true}",
          "let aa=!0;f({true:!1,a:!0,b:o.true},aa,aa);if(aa===!1)f(`${!0}`,'true',aa);function g(){return!0}"),
         ("let wide=(a,b)=>Math.max(Math.hypot(a,b),Math.hypot(a,1));f(Math.max(1,wide()),Math.max(2,3),o.Math.max(1),Math.round(2),Math.max,Math.max(5));",
          "let{hypot:ab,max:aa}=Math;let ac=(a,b)=>aa(ab(a,b),ab(a,1));f(aa(1,ac()),aa(2,3),o.Math.max(1),Math.round(2),aa,aa(5));"),
         ("let text=`uniform float u_size;in vec3 a_place;void main(){float y=u_size;v=a_place*u_size;}`;f(at.u_size,{u_size:1},'u_size');",
          "let aa=`uniform float _0;in vec3 _1;void main(){float y=_0;v=_1*_0;}`;f(at._0,{_0:1},'_0');"),
         ("f('u_size',_1);", "f('u_size',_1);"),
         # in a function: no name that it uses from outside is taken
         ("let outer=1,second=2;function f(word){let a=word,b;return()=>{b=a*outer*Math.max(word,x);return{a,word}}}\nf(second,outer);function g(second){return second+outer}",
          "let aa=1,ab=2;function f(b){let a=b,c;return()=>{c=a*aa*Math.max(b,x);return{a,word:b}}}\nf(ab,aa);function g(ab){return ab+aa}")]

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
    code = "function inner(word){return word+word}\n", "inner(word);"
    if shortened("".join(code), code, ["inner"]) != "".join(code).replace("inner", "aa"):
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
