"""Measures how long a page of many blocks takes until its first picture, and what that is spent on. Not a test: nothing is required of the times.

    python3 tests/viewer/loading.py [--blocks 100000] [--repeats 3] [--talus build/release/talus] [PAGE.html ...]

Without pages it makes two of rock (loading.lua): one frame without contacts, and one frame with the contacts that slip. Of several
measurements the one with the shortest time until the first picture is told. CPU times are those of the browser's processes: the
page's own ("page") and the software graphics ("graphics"), which run side by side where there are two processors.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile
import time

from chrome import Chrome

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Runs in front of the page's script: takes the time of what blocks the page, by the calls of the browser in which it waits.
SPY = """
(() => {
    const spent = window.spent = {};
    const spy = (owner, name, as) => {
        const old = owner[name];
        owner[name] = function (...given) {
            const begun = performance.now();
            try { return old.apply(this, given); } finally { spent[as] = (spent[as] ?? 0) + performance.now() - begun; }
        };
    };
    spy(HTMLCanvasElement.prototype, "getContext", "graphics opened");
    const gl = WebGL2RenderingContext.prototype;
    spy(gl, "bufferData", "buffers handed over");
    spy(gl, "texSubImage2D", "buffers handed over");
    spy(gl, "getShaderParameter", "programs made");
    spy(gl, "getProgramParameter", "programs made");
    spy(gl, "readPixels", "waited for drawing");
})();
"""
FIRST = "new Promise((done) => { const look = () => (window.talus?.app?.number > 0 ? done([performance.now(), { ...spent }]) : setTimeout(look, 1)); look(); })"


def cpu_times(chrome):
    """CPU seconds of the browser's processes so far: of pages, of graphics and of the rest."""
    ticks, out = os.sysconf("SC_CLK_TCK"), {"page": 0.0, "graphics": 0.0, "rest": 0.0}
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            command, fields = (process / "cmdline").read_text(), (process / "stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if chrome.folder in command:
            kind = "page" if "--type=renderer" in command else "graphics" if "--type=gpu" in command else "rest"
            out[kind] += (int(fields[11]) + int(fields[12])) / ticks
    return out


def measure(page):
    """Seconds of one opening of a page: the whole, the parts of it, and the CPU times."""
    with Chrome() as chrome:
        chrome.call("Page.addScriptToEvaluateOnNewDocument", source=SPY)
        before = cpu_times(chrome)
        begun = time.monotonic()
        chrome.call("Page.navigate", url=pathlib.Path(page).resolve().as_uri())
        wall, spent = chrome.run(FIRST)
        # the page's clock begins when the file is opened; the wall clock bounds it
        assert wall / 1000 < time.monotonic() - begun + 0.1
        after = cpu_times(chrome)
        read = chrome.run("performance.getEntriesByType('navigation')[0].domInteractive")
        blocks, errors = chrome.run("talus.app.frame.poses.n"), chrome.log
        assert not errors, errors
    parts = {"file read": read / 1000, **{name: t / 1000 for name, t in spent.items()}}
    parts["script"] = wall / 1000 - sum(parts.values())
    return {"blocks": blocks, "first": wall / 1000, "parts": parts, "cpu": {k: after[k] - before[k] for k in after}}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--blocks", type=int, default=100000)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--talus", type=pathlib.Path, default=ROOT / "build/release/talus")
    parser.add_argument("--json", action="store_true", help="one line of JSON for each page")
    parser.add_argument("pages", nargs="*")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        pages = given.pages
        if not pages:
            subprocess.run([given.talus, "--quiet", ROOT / "tests/viewer/loading.lua", folder, str(given.blocks)], cwd=ROOT, check=True)
            pages = [f"{folder}/still.html", f"{folder}/slipping.html"]
        for page in pages:
            best = min((measure(page) for _ in range(given.repeats)), key=lambda m: m["first"])
            if given.json:
                print(json.dumps({"page": pathlib.Path(page).name, **best}))
                continue
            print(f"{pathlib.Path(page).name}, {os.path.getsize(page) / 1e6:.0f} MB, {best['blocks']} blocks: first picture after {best['first']:.2f} s")
            print("  wall: " + ", ".join(f"{name} {t:.2f} s" for name, t in best["parts"].items()))
            print("  CPU: " + ", ".join(f"{name} {t:.2f} s" for name, t in best["cpu"].items()), flush=True)


if __name__ == "__main__":
    main()
