"""Reads the frames of a running model, and posts commands to it, as the page of model:view does (docs/scene_format.md)."""
import http.client
import json
import re
import struct
import subprocess
import threading
import urllib.parse


class Program:
    """A script that runs, with the model that it shows."""

    def __init__(self, program, script, *arguments):
        self.process = subprocess.Popen([program, "-", *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.process.stdin.write(script)
        self.process.stdin.close()
        self.log = []
        self.address = None
        while self.address is None:
            line = self.process.stderr.readline()
            if not line:
                raise RuntimeError("the script ends without a view: " + "".join(self.log))
            self.log.append(line)
            found = re.search(r"view: open (\S+) in a browser", line)
            self.address = found and urllib.parse.urlsplit(found.group(1))
        self.token = urllib.parse.parse_qs(self.address.query)["token"][0]
        self.out = None
        self.reader = threading.Thread(target=lambda: self.log.extend(self.process.stderr), daemon=True)
        self.reader.start()

    def ask(self, method, path, body=None, headers=None):
        connection = http.client.HTTPConnection(self.address.hostname, self.address.port)
        connection.request(method, path, body, {"X-Talus-Token": self.token, **(headers or {})})
        return connection, connection.getresponse()

    def command(self, **command):
        """Posts a command; its status and what is said of it."""
        connection, answer = self.ask("POST", "/command", json.dumps(command))
        text = answer.read().decode()
        connection.close()
        return answer.status, text

    def look(self):
        return Watcher(self)

    def end(self):
        """Waits for the script's end: its output and its status."""
        out = self.process.stdout.read()
        status = self.process.wait()
        self.reader.join()
        return out, status


class Watcher:
    """Somebody who looks: an endless answer, read frame by frame."""

    def __init__(self, program):
        self.connection, self.answer = program.ask("GET", "/scene")
        if self.answer.status != 200:
            raise RuntimeError(f"GET /scene gives {self.answer.status}")
        self.head, self.lines, self.refused, self.state = None, [], [], None
        self.ids, self.places, self.cycle, self.ended, self.names = [], {}, None, False, []

    def close(self):
        self.connection.close()

    def frame(self):
        """Reads the next frame; False when the answer ends."""
        self.names = []
        while not self.names or self.names[-1] != "DONE":
            begin = self.answer.read(8)
            if len(begin) < 8:
                self.ended = True
                return False
            letters, length = begin[:4].decode(), struct.unpack("<I", begin[4:])[0]
            payload = self.answer.read((length + 3) // 4 * 4)[:length]
            self.names.append(letters)
            if letters == "HEAD":
                self.head = json.loads(payload)
            elif letters == "LIVE":
                told = json.loads(payload)
                self.state = told["state"]
                self.lines += [told["line"]] if "line" in told else []
                self.refused += [told["refused"]] if "refused" in told else []
            elif letters == "FRAM":
                self.cycle, count = int(struct.unpack_from("<d", payload, 8)[0]), struct.unpack_from("<I", payload, 16)[0]
                self.ids = list(struct.unpack_from(f"<{count}I", payload, 20))
                place = struct.unpack_from(f"<{3 * count}f", payload, 20 + 4 * count)
                self.places = {i: [x + o for x, o in zip(place[3 * k:3 * k + 3], self.head["origin"])] for k, i in enumerate(self.ids)}
                flags = payload[20 + 84 * count:20 + 85 * count]
                self.held = {i for i, f in zip(self.ids, flags) if f & 1}
                self.hidden = {i for i, f in zip(self.ids, flags) if f & 2}
        return True

    def until(self, condition):
        """Reads frames until something is so; False when the answer ends first."""
        while self.head is None or not condition(self):
            if not self.frame():
                return False
        return True
