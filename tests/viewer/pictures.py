#!/usr/bin/env python3
"""The pictures of docs/examples.md and of README.md, of the pages that the examples and scripts/tools/large_slope.lua write.

    pictures.py [NAME...]            writes them anew, all or those named (fig2, tunnel, tunnel_section, slope, slope_section, large_slope)
    pictures.py --check [NAME...]    compares them with those that are there; 1 and their names where they differ. Without names, one
                                     in TALUS_TEST_SHARE of all

The large slope, which takes a minute, is made and compared when it is named. Runs the examples in a folder of its own, opens each page in Chromium and saves its image (talus.makeImage). Pictures are drawn by SwiftShader,
in software, and text in DejaVu Sans, which comes with Debian's Chromium: the same on all machines that have it.
Without Chromium one sentence, and status 77 (status 1 where TALUS_BROWSER is "required").
"""
import argparse
import base64
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from chrome import Chrome, program, read_png, similarity, write_png  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("TALUS_PROGRAM", "build/release/talus")
FOLDER = ROOT / "docs/pictures"
WIDTH, HEIGHT, FACTOR = 640, 430, 1.4  # of the window, and of the picture against it
LARGEST = 200000                       # bytes of a picture
ALIKE = 0.96                           # structural similarity of the part that differs most; letters differ a little from system to system
TILES = (4, 3)                         # parts of a picture that are compared, across and down

# Each picture: the example, and the address of its page. The camera: bearing and plunge of the line of sight, the height that is seen,
# and the point looked at. A section keeps what lies behind it; its position is that against the middle of the model, southwards.
PICTURES = {
    "fig2": ("fig2", "#camera=34,28,2.9,-1,0.65,0.2"),
    "tunnel": ("tunnel", "#cut=1&dip=90&direction=180&position=2.5&camera=3,-13,14,-6,0.3,1.9"),
    "tunnel_section": ("tunnel", "#cut=1&dip=90&direction=180&position=-0.14&parallel=1&arrows=displacement&camera=0,0,11.5,-5.7,0,1.9"),
    "slope": ("slope", "#camera=56,30,44,18.9,32.5,13"),
    "yielding_tunnel": ("yielding_tunnel", "#zones=state&contacts=slip&mesh=0&camera=0,0,26,-9,1,-1.2"),
    "yielding_tunnel_stress": ("yielding_tunnel", "#zones=largest%20principal%20stress&crosses=1&mesh=0&camera=0,0,26,-9,1,-1.2"),
    "deformable_tunnel": ("deformable_tunnel", "#zones=largest%20principal%20stress&crosses=1&cut=1&dip=90&direction=180&position=-0.14&parallel=1&camera=0,0,12.3,-5.8,0,1.3"),
    "large_slope": ("large_slope", "#camera=60,18,78,40,35,27"),
    "bolted_roof": ("bolted_roof", "#colour=field%3Asafety&cut=1&dip=90&direction=180&position=0.15&camera=8,-24,13,-2.5,0,3"),
    "dam": ("dam", "#elements=pressure&camera=40,22,80,14,0,18"),
    "slope_section": ("slope", "#cut=1&dip=90&direction=180&position=-3&parallel=1&arrows=displacement&camera=0,0,36.7,14.1,20,16.3"),
}
SLOW = {"large_slope": "scripts/tools/large_slope.lua"}


def run_examples(names, folder):
    """Runs the examples beside each other."""
    runs = {name: subprocess.Popen([PROGRAM, "--quiet", SLOW.get(name, f"scripts/examples/{name}.lua"), str(folder)], cwd=ROOT, stdout=subprocess.DEVNULL) for name in names}
    failed = [name for name, run in runs.items() if run.wait() != 0]
    if failed:
        sys.exit(f"pictures.py: these examples have failed: {', '.join(failed)}")


def picture_of(chrome, page, fragment):
    """The image that the page saves of a view, as PNG."""
    chrome.log.clear()
    chrome.open(page, fragment)
    chrome.run("talus.ready.then(() => new Promise(done => { const look = () => (talus.app.reading ? setTimeout(look, 20) : done()); look(); })).then(() => talus.app.drawn())")
    if chrome.log:
        sys.exit(f"pictures.py: the page {page.name} reports {chrome.log}")
    data = chrome.run(f"talus.makeImage({FACTOR}).then(b => new Promise(done => {{ const r = new FileReader(); r.onload = () => done(r.result); r.readAsDataURL(b); }}))")
    return write_png(read_png(base64.b64decode(data.split(",")[1])))  # smaller than the browser's


def same(data, path):
    """Structural similarity with a picture that is there, of the part of TILES that differs most: what moves fills only a small part of a
    picture. 0 when there is none."""
    if not path.exists():
        return 0.0
    if path.read_bytes() == data:
        return 1.0
    new, old = read_png(data), read_png(path.read_bytes())
    if (len(new), len(new[0])) != (len(old), len(old[0])):
        return 0.0
    high, wide = -(-len(new) // TILES[1]), -(-len(new[0]) // TILES[0])

    def tile(rows, x, y):
        return [row[x:x + wide] for row in rows[y:y + high]]

    return min(similarity(tile(new, x, y), tile(old, x, y)) for y in range(0, len(new), high) for x in range(0, len(new[0]), wide))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--check", action="store_true", help="write nothing; 1 where a picture is not as the page shows it")
    parser.add_argument("--folder", type=pathlib.Path, default=FOLDER, help="the folder of the pictures")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(PICTURES))
    given = parser.parse_args()
    unknown = [name for name in given.names if name not in PICTURES]
    if unknown:
        parser.error(f"there is no picture {', '.join(unknown)}; there are {', '.join(PICTURES)}")
    share = int(os.environ.get("TALUS_TEST_SHARE", 1)) if given.check else 1
    names = given.names or [name for name in PICTURES if name not in SLOW][::share]
    if not program():
        required = os.environ.get("TALUS_BROWSER") == "required"
        print("pictures.py: no Chromium, so no pictures were made" + (", which is required here" if required else ": skipped"))
        return 1 if required else 77
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="talus_pictures_") as text:
        folder = pathlib.Path(text)
        run_examples(sorted({PICTURES[name][0] for name in names}), folder)
        with Chrome(WIDTH, HEIGHT) as chrome:
            chrome.samples = 4 if given.check else 0  # edges are smoothed less: the similarity is 0.98 and more
            for name in names:
                example, fragment = PICTURES[name]
                data, path = picture_of(chrome, folder / f"{example}.html", fragment), given.folder / f"{name}.png"
                if len(data) >= LARGEST:
                    wrong += 1
                    print(f"{name}: {len(data)} bytes, and must be less than {LARGEST}")
                elif not given.check:
                    path.write_bytes(data)
                    print(path)
                elif (found := same(data, path)) < ALIKE:
                    wrong += 1
                    print(f"{name}: similarity {found:.4f} with {path}, and must be {ALIKE}; tests/viewer/pictures.py {name} makes it anew: look at it")
    print(f"pictures.py: {len(names)} pictures, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
