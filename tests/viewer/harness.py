"""What the tests of a page in a browser have in common: a model's page is written, a browser opens it, faults are sentences."""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from chrome import Chrome, program

HERE = pathlib.Path(__file__).parent
PROGRAM = os.environ.get("TALUS_PROGRAM", "build/release/talus")
faults = []


def check(condition, sentence):
    if not condition:
        faults.append(sentence)
        print("  " + sentence)


def show(chrome, page, fragment=""):
    """Opens a page and waits for its first picture."""
    chrome.log.clear()
    chrome.open(page, fragment)
    chrome.run("talus.ready.then(() => talus.app.drawn())")
    check(not chrome.log, f"{page.name} reports {chrome.log}")


def run_tests(name, script, tests, size=(720, 400)):
    """Runs a Lua script that writes pages into a folder, and the tests (or those that are asked for) on it. Gives the status to exit with: without
    Chromium 77, and 1 where TALUS_BROWSER is "required"."""
    if not program():
        required = os.environ.get("TALUS_BROWSER") == "required"
        print(f"{name}: no Chromium, so pages were not looked at" + (", which is required here" if required else ": skipped"))
        return 1 if required else 77
    with tempfile.TemporaryDirectory(prefix="talus_viewer_") as folder:
        subprocess.run([PROGRAM, "--quiet", str(HERE / script), folder], check=True, cwd=HERE.parents[1])
        with Chrome(*size) as chrome:
            for test in sys.argv[1:] or tests:
                begun = time.monotonic()
                tests[test](chrome, pathlib.Path(folder))
                print(f"{test}: {time.monotonic() - begun:.1f} s")
    print(f"{name}: {len(faults)} faults")
    return 1 if faults else 0
