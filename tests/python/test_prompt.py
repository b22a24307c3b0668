#!/usr/bin/env python3
"""The prompt on a terminal of its own: completion of names, its words help, exit and quit, chunks of several lines, and the
file of what was typed. What a line became by completion is read from that file."""
import os
import pathlib
import sys
import tempfile

PROGRAM = os.environ.get("TALUS_PROGRAM", "build/release/talus")
faults = []


def fault(*values):
    faults.append(" ".join(repr(value) for value in values))


class Prompt:
    def __init__(self, quiet=True, **variables):
        self.seen = ""
        self.pid, self.terminal = os.forkpty()
        if self.pid == 0:
            os.environ.pop("XDG_STATE_HOME", None)
            os.environ.update(variables, TERM="dumb", COLUMNS="200", LC_ALL="C.UTF-8")
            os.execv(PROGRAM, [PROGRAM] + (["--quiet"] if quiet else []))

    def read(self):
        try:
            text = os.read(self.terminal, 4096).decode()
        except OSError:
            text = ""
        self.seen += text
        return text

    def read_to(self, end):
        while end not in self.seen and self.read():
            pass
        if end not in self.seen:
            fault("no", end, "in", self.seen)
        before, _, self.seen = self.seen.partition(end)
        return before

    def send(self, text):
        os.write(self.terminal, text.encode())

    def line(self, text, end="> "):
        self.send(text + "\n")
        return self.read_to(end)

    def end(self, how="\x04"):
        """At the prompt: gives what was printed to the end, and the exit status."""
        self.send(how)
        while self.read():
            pass
        _, status = os.waitpid(self.pid, 0)
        os.close(self.terminal)
        return self.seen, os.waitstatus_to_exitcode(status)


def lines_of(file):
    return file.read_text(encoding="utf-8").splitlines() if file.exists() else []


def completed(prompt, file, text):
    """The line after the tabulator. It is made a comment, so that it does nothing."""
    def comments():
        return [line[2:] for line in lines_of(file) if line.startswith("--")]

    before = len(comments())
    prompt.send(text + "\t\x01--\n")
    while len(comments()) == before and prompt.read():  # after the line there is another prompt
        pass
    return comments()[-1]


def check_completion(folder):
    file = folder / "talus/history"
    prompt = Prompt(XDG_STATE_HOME=str(folder))
    prompt.read_to("> ")
    for line in ('m = talus.model{gravity = {0, 0, -10}}', 'm:generate("box", {min = {0,0,0}, max = {1,1,1}, density = 2000})',
                 's = m:blocks()', 'b = s[1]', 'nest = {models = {m}, deep = {er = 1}}', 'word = "text"'):
        prompt.line(line)
    for text, expected in (
            # globals and Lua's words
            ("tal", "talus"), ("retu", "return"), ("x = nes", "x = nest"), ("no_such", "no_such"),
            # tables, models, selections and their items, by what they are
            ("talus.mod", "talus.model"), ("math.flo", "math.floor"), ("nest.dee", "nest.deep"), ("nest.deep.e", "nest.deep.er"),
            ("word:rev", "word:reverse"), ("m:gen", "m:generate"), ("m.cyc", "m.cycles"), ("m.gen", "m.gen"), ("m:cycles", "m:cycles"),
            ("s:reset", "s:reset_displacement"), ("s:su", "s:sum"), ("b.kin", "b.kinetic_energy"), ("b.neigh", "b.neighbours"),
            ("s[1].disp", "s[1].displacement"), ("nest.models[1].grav", "nest.models[1].gravity"), ("nil_value.dee", "nil_value.dee"),
            # by the name of the function, without a call
            ("m:blocks{group = 'x'}:reset", "m:blocks{group = 'x'}:reset_displacement"),
            ("m:blocks():hide():boun", "m:blocks():hide():bounds"), ("m:contacts()[2].normal_s", "m:contacts()[2].normal_stress"),
            ("talus.model{}.reu", "talus.model{}.reuse_geometry"), ('m:blocks{group = "}"}[1].cen', 'm:blocks{group = "}"}[1].centroid'),
            # keys of options, of front end and kernel, and of plugins
            ("m:solve{max_c", "m:solve{max_cycles"), ("m:solve{ratio = 1e-3, on_", "m:solve{ratio = 1e-3, on_progress"),
            ("m:blocks{cont", "m:blocks{containing"), ("m:blocks{ins", "m:blocks{inside"), ("s:fix{rot", "s:fix{rotation"),
            ('m:generate("jointset", {dip_direction_', 'm:generate("jointset", {dip_direction_dev'),
            ('m:generate("box", {{dens', 'm:generate("box", {{density'), ('m:joint("J1", "coulomb_tensile", {coh', 'm:joint("J1", '
             '"coulomb_tensile", {cohesion'), ('m:joint("*", {fric', 'm:joint("*", {friction'),
            ('m:damping("adaptive", {max', 'm:damping("adaptive", {maximum'), ("m:solve{ratio = nes", "m:solve{ratio = nest"),
            ("m:blocks{inside = {dens", "m:blocks{inside = {dens"),
            # in quotes
            ('m:generate("joints', 'm:generate("jointset'), ('m:damping "adap', 'm:damping "adaptive'),
            ('m:joint("J1", "coulomb_', 'm:joint("J1", "coulomb_tensile'), ('m:timestep{rule = "bo', 'm:timestep{rule = "body'),
            ('m:generate("jointset", {distribution = "fi', 'm:generate("jointset", {distribution = "fisher'),
            ('m:history{name = "k", value = "fric', 'm:history{name = "k", value = "friction'),
            ('m:history{of = s, field = "displ', 'm:history{of = s, field = "displacement'),
            ('m:history{take = "me', 'm:history{take = "mean'), ('m:solve{measure = "loc', 'm:solve{measure = "local'),
            ('talus.stereonet{projection = "equal_an', 'talus.stereonet{projection = "equal_angle'),
            ('talus.stereonet{great_circles = "no', 'talus.stereonet{great_circles = "none'),
            ('m:history{name = "fric', 'm:history{name = "fric'),
            ('s:sum "kin', 's:sum "kinetic_energy'), ('talus.help "solv', 'talus.help "solve'), ('print("tal', 'print("tal'),
            ("help mass_", "help mass_scaling"), ("-- tal", "-- tal")):
        got = completed(prompt, file, text)
        if got != expected:
            fault("completion of", text, "gives", got)
    prompt.send("m:\t\t")  # twice: all there are
    prompt.read_to("blocks")
    prompt.read_to("write_vtk")
    prompt.send("\x15")
    # keys in the second line of a chunk
    prompt.line("#m:blocks{fixed = false,", ">> ")
    if completed(prompt, file, "contain") != "containing":
        fault("completion in a second line", lines_of(file)[-1])
    prompt.line("containing = {0.5, 0.5, 0.5}}", "\n1\r\n")  # an expression of three lines
    # what it looks at is not run: no metamethod, no call
    prompt.line('calls = 0 trap = setmetatable({}, {__index = function() calls = calls + 1 return {inside = 1} end})')
    prompt.line("function count() calls = calls + 1 return {inside = 1} end")
    if completed(prompt, file, "trap.x.ins") != "trap.x.ins" or completed(prompt, file, "count().ins") != "count().ins":
        fault("completion has run something", lines_of(file)[-2:])
    prompt.line('print("calls " .. calls)', "calls 0")
    prompt.read_to("> ")
    _, status = prompt.end()
    if status != 0:
        fault("ended with", status)


def check_words(folder):
    prompt = Prompt(quiet=False, XDG_STATE_HOME=str(folder))
    prompt.read_to("`exit` ends.")
    prompt.read_to("> ")
    prompt.line("help", "Generators:")
    prompt.line("  help   solve ", "on_progress")
    prompt.line("help coulomb", "angle of friction")
    prompt.line("help solv", "there is no help on 'solv'; did you mean 'solve'?")
    prompt.line("help solve cycle", "stdin:1: syntax error")
    prompt.line("help = 3", "> ")
    prompt.line("help", "\n3\r\n")  # the variable, now
    prompt.line("for i = 1, 2 do", ">> ")
    prompt.line("exit = i", ">> ")  # in a chunk it is a name
    prompt.line("end", "> ")
    prompt.line("exit", "\n2\r\n")
    prompt.read_to("> ")
    _, status = prompt.end("quit\n")
    if status != 0:
        fault("quit ends with", status)
    prompt = Prompt(XDG_STATE_HOME=str(folder))
    prompt.read_to("> ")
    _, status = prompt.end("exit\n")
    if status != 0:
        fault("exit ends with", status)


def check_history(folder):
    home = folder / "home"
    home.mkdir()
    file = home / ".local/state/talus/history"
    for variables in ({}, {"XDG_STATE_HOME": "relative"}, {"XDG_STATE_HOME": ""}):  # these are to be ignored
        prompt = Prompt(HOME=str(home), **variables)
        prompt.read_to("> ")
        prompt.line("first = 1")
        prompt.line("first = 1")  # once only
        prompt.line('second = "ä"')
        prompt.end()
        if lines_of(file) != ["first = 1", 'second = "ä"']:
            fault("history", variables, lines_of(file))
        if file.stat().st_mode & 0o777 != 0o600 or file.parent.stat().st_mode & 0o777 != 0o700:
            fault("others may read the history")
        # the next prompt has it at hand: twice upwards
        prompt = Prompt(HOME=str(home), **variables)
        prompt.read_to("> ")
        prompt.line("\x10\x10.. 'again'", "malformed number")
        prompt.read_to("> ")
        prompt.end()
        if lines_of(file)[2:3] != ["first = 1.. 'again'"]:
            fault("history of a second session", lines_of(file))
        file.unlink()
    # a long file is cut to its end
    file.write_text("".join(f"line_{i} = 1\n" for i in range(2500)), encoding="utf-8")
    prompt = Prompt(HOME=str(home))
    prompt.read_to("> ")
    prompt.line("last = 1")
    prompt.end()
    if lines_of(file) != [f"line_{i} = 1" for i in range(1500, 2500)] + ["last = 1"]:
        fault("a long history", len(lines_of(file)), lines_of(file)[:1], lines_of(file)[-1:])
    if sorted(os.listdir(file.parent)) != ["history"]:
        fault("beside the history", os.listdir(file.parent))


def check_no_history(folder):
    """Where the file cannot be used the prompt works all the same, and says once why."""
    in_the_way = folder / "in_the_way"
    in_the_way.write_text("", encoding="utf-8")
    pipe = folder / "pipe/talus/history"
    pipe.parent.mkdir(parents=True)
    os.mkfifo(pipe)
    (folder / "folder/talus/history").mkdir(parents=True)
    long_name = str(folder) + "/x" * 4096
    for place, reason in ((in_the_way, "Not a directory"), (pipe.parents[1], "not a regular file"),
                          (folder / "folder", "directory"), (long_name, None), (None, None)):
        variables = {"XDG_STATE_HOME": str(place)} if place else {"HOME": ""}
        for quiet in (False, True):
            prompt = Prompt(quiet=quiet, **variables)
            if reason and not quiet:
                prompt.read_to("what is typed is not kept: ")
                prompt.read_to(reason)
            prompt.read_to("> ")
            prompt.line("value = 41")
            prompt.line("value + 1", "\n42\r\n")
            prompt.read_to("> ")
            text, status = prompt.end()
            if status != 0 or "not kept" in text:
                fault("without history", place, status, text)


def main():
    for check in (check_completion, check_words, check_history, check_no_history):
        with tempfile.TemporaryDirectory() as folder:
            check(pathlib.Path(folder))
    for text in faults:
        print(text)
    print(f"prompt: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
