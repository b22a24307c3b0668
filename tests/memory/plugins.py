"""Runs plugins.lua for the allocations of the loading of plugins, one program each: the first ones, then one in a few.

    TALUS_PROGRAM=talus TALUS_TEST_MEMORY=FOLDER tests/memory/plugins.py MEMORY_FAILURE.so
"""
import os
import sys
import subprocess

PROGRAM = os.environ["TALUS_PROGRAM"]
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "plugins.lua")
FIRST, STEP = 30, 11
IN_SPITE, REFUSED, NOTHING_FAILED = 0, 3, 4

faults = []


def run(*words, **variables):
    return subprocess.run([PROGRAM, SCRIPT, *words], capture_output=True, text=True, check=False, env={**os.environ, **variables})


def main():
    preload = {"LD_PRELOAD": sys.argv[1], "ASAN_OPTIONS": "verify_asan_link_order=0:allocator_may_return_null=1:detect_leaks=0"}
    wanted = run(str(10 ** 9), **preload)
    refused = tried = 0
    for more in ((), ("more",)):
        number, status = 1, IN_SPITE
        while status != NOTHING_FAILED and len(faults) < 5:
            done = run(str(number), *more, **preload)
            status = done.returncode
            number += 1 if number < FIRST else STEP
            refused += status == REFUSED
            tried += 1
            if "cannot allocate memory for thread-local data" in done.stderr:
                continue  # with which the C library itself ends a program
            if status not in (IN_SPITE, REFUSED, NOTHING_FAILED) or done.stdout != wanted.stdout:
                faults.append(f"an allocation before {number} {' '.join(more)}: status {status}, {done.stdout}{done.stderr}")
    if wanted.returncode != NOTHING_FAILED or refused < tried / 4:
        faults.append(f"{refused} of {tried} were refused; without failures the status is {wanted.returncode}: {wanted.stderr}")
    for fault in faults:
        print(f"plugins: {fault}")
    print(f"plugins: {tried} allocations failed, {refused} refused, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
