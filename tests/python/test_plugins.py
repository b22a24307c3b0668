#!/usr/bin/python3
"""What becomes of plugins that crash, and of folders that others may write.

    tests/python/test_plugins.py BUILD_FOLDER

A crash inside a plugin names plugin, kind and function on the standard error, and the program dies by the signal; a
crash elsewhere names none. A folder beside the program is not searched when others may write it or a folder above it,
and `talus plugins` says why; one named in TALUS_PLUGIN_PATH is searched, with a note."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile

CHUNK = """
local model = talus.model {{ threads = {threads} }}
for i = 0, 199 do
    model:generate("box", {{ min = {{ 2 * i, 0, 0 }}, max = {{ 2 * i + 1, 1, 1 }}, density = 2000 }})
    model:generate("box", {{ min = {{ 2 * i, 0, -1 }}, max = {{ 2 * i + 1, 1, 0 }}, density = 2000, group = "floor" }})
end
model:blocks {{ group = "floor" }}:fix()
model:joint("*", "crasher", {{ how = "{law}", when = "{when}" }})
model:damping("crasher", {{ how = "{damping}" }})
{then_}
model:cycle(5)
print("went through")
"""

faults = []


def expect(holds, what, done):
    if not holds:
        faults.append(f"{what}\n    status {done.returncode}, said: {done.stdout}{done.stderr}")


def run(command, **variables):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("TALUS_")}
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False,
                          env={**environment, **variables})


def check_crashes(program, folder):
    plugin = folder / "crasher.so"

    def crash(number, kind, function, law="never", when="update", damping="never", then_="", threads=1):
        chunk = CHUNK.format(law=law, when=when, damping=damping, then_=then_, threads=threads)
        done = run([program, "--plugin", plugin, "-e", chunk])
        what = f"{law} {when} {damping} {then_} on {threads} threads"
        expect(done.returncode == (-number if number else 0), f"{what}: status", done)
        if not number:
            expect("went through" in done.stdout and not done.stderr, f"{what}: quiet", done)
            return
        sentence = f"talus: {kind} 'crasher' of plugin 'bad.crasher' ({plugin}) crashed in its function '{function}'"
        named = sentence in done.stderr if kind else "plugin" not in done.stderr
        expect(named, f"{what}: sentence", done)
        if kind:
            expect(signal.Signals(number).name in done.stderr, f"{what}: signal", done)

    for threads in (1, 3):
        crash(0, None, None, threads=threads)
        for law, number in (("segv", signal.SIGSEGV), ("fpe", signal.SIGFPE), ("ill", signal.SIGILL),
                            ("abort", signal.SIGABRT), ("stack", signal.SIGSEGV)):
            crash(number, "law", "update", law=law, threads=threads)
        crash(signal.SIGABRT, "damping", "update", damping="abort", threads=threads)
    crash(signal.SIGSEGV, "law", "stiffness", law="segv", when="stiffness")
    crash(signal.SIGSEGV, "generator", "generate", then_='model:generate("crasher", {})')
    # outside plugins nothing is said, and the signal does what it did
    crash(signal.SIGSEGV, None, None, then_='os.execute("kill -SEGV $PPID")')
    crash(signal.SIGABRT, None, None, then_='os.execute("kill -ABRT $PPID")')


def listed(program, **variables):
    return run([program, "plugins"], **variables)


def check_folders(program, folder, root):
    """`root` is a folder of our own; the program is copied there, since plugins are looked for beside it."""
    home = root / "home"
    plugins = home / "plugins"
    plugins.mkdir(parents=True)
    own = home / "talus"
    shutil.copy(program, own)
    shutil.copy(folder / "liar.so", plugins)
    for path in (root, home, plugins):
        path.chmod(0o755)
    (plugins / "liar.so").chmod(0o644)
    loaded, refusal = f"bad.liar 1  {plugins}/liar.so", "nothing is loaded from there unless it is named"
    done = listed(own)
    expect(loaded in done.stdout and "refused" not in done.stdout, "a folder of one's own is searched", done)

    def refused(path, mode, what):
        before = path.stat().st_mode
        path.chmod(mode)
        done = listed(own)
        expect(done.returncode == 0 and loaded not in done.stdout, f"{what}: not loaded", done)
        expect("refused: " in done.stdout and refusal in done.stdout and f"may write {path} (mode {mode:04o})" in
               done.stdout, f"{what}: reason", done)
        done = listed(own, TALUS_PLUGIN_PATH=str(plugins))
        expect(loaded in done.stdout and "refused" not in done.stdout, f"{what}: named, it is loaded", done)
        if path != plugins / "liar.so":
            expect(f"note: {plugins}: " in done.stdout and "TALUS_PLUGIN_PATH names it" in done.stdout, f"{what}: note", done)
        done = run([own, "--plugin", plugins / "liar.so", "plugins"])
        expect(loaded in done.stdout, f"{what}: --plugin", done)
        path.chmod(before)

    refused(plugins, 0o757, "folder that all may write")
    refused(plugins, 0o1777, "folder like /tmp")
    refused(home, 0o757, "folder above that all may write")
    refused(plugins / "liar.so", 0o646, "file that all may write")
    home.chmod(0o1777)
    done = listed(own)
    expect(loaded in done.stdout, "a folder above like /tmp does no harm", done)
    home.chmod(0o755)
    if os.geteuid() == 0:
        os.chown(plugins, 4321, -1)
        done = listed(own)
        expect(loaded not in done.stdout and "belongs to user 4321" in done.stdout, "folder of another user", done)
        os.chown(own, 4321, -1)
        done = listed(own)
        expect(loaded in done.stdout, "folder of the program's owner", done)
        os.chown(plugins, 0, 4321)
        plugins.chmod(0o775)
        done = listed(own)
        expect(loaded not in done.stdout and "mode 0775" in done.stdout, "folder of another group", done)
        os.chown(plugins, 0, 0)
        done = listed(own)
        expect(loaded in done.stdout, "folder of root's group", done)


def check_pipes(program, folder, root):
    """A pipe in the place of a plugin is passed over with a reason; nobody writes to it."""
    plugins = root / "pipes"
    plugins.mkdir()
    os.mkfifo(plugins / "a.so")
    shutil.copy(folder / "liar.so", plugins / "b.so")
    reason = "it is a pipe: only regular files are loaded"
    done = listed(program, TALUS_PLUGIN_PATH=str(plugins))
    expect(reason in done.stdout and f"bad.liar 1  {plugins}/b.so" in done.stdout, "a pipe in a folder", done)
    done = run([program, "--plugin", plugins / "a.so", "plugins"])
    expect(done.returncode != 0 and reason in done.stderr, "a pipe that is named", done)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    check_crashes(build / "talus", build / "bad_plugins")
    with tempfile.TemporaryDirectory() as folder:
        check_folders(build / "talus", build / "bad_plugins", pathlib.Path(folder).resolve())
        check_pipes(build / "talus", build / "bad_plugins", pathlib.Path(folder).resolve())
    for fault in faults:
        print(fault)
    print(f"plugins: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
