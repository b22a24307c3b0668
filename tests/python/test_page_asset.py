#!/usr/bin/env python3
"""core/io/page_asset.c is what scripts/tools/page_asset.py makes of viewer/; where the esbuild that made it is not installed, this is skipped (77).

Everywhere: lines of viewer/ have at most 120 columns, and the page names no host."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLUMNS = 120

faults = []
for path in sorted((ROOT / "viewer").iterdir()):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if len(line) > COLUMNS:
            faults.append(f"{path.name}:{number}: {len(line)} columns, more than {COLUMNS}")
asset = (ROOT / "core/io/page_asset.c").read_text(encoding="ascii")
faults += [f"the page names a host: {host}" for host in re.findall(r"\w+://[^\s\"'`]*", asset)]

done = subprocess.run([sys.executable, ROOT / "scripts/tools/page_asset.py", "--check"], capture_output=True, text=True, check=False)
if done.returncode not in (0, 77):
    faults.append(done.stderr.strip())
for fault in faults:
    print(fault)
if done.returncode == 77:
    print(f"skipped: the page was not compared with viewer/: {done.stderr.strip()}")
print(f"page asset: {len(faults)} faults")
sys.exit(1 if faults else done.returncode)
