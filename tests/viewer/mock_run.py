"""A running program as a page sees it: serves a page, an endless answer of frames, and takes commands (docs/scene_format.md).

    with MockRun(page) as run:            # a page that write_html wrote
        run.put(frame)                    # a frame of frames_of(page), or what edited(...) makes of it
        chrome.open(run.address)
        run.commands                      # what was posted

A watcher that is behind gets all news - what stands in front of FRAM - and the newest of the rest, as from the program.
"""
import base64
import http.server
import json
import re
import struct
import threading
import zlib

TOKEN = "0123456789abcdef"
FRAME = re.compile(r"<script type=.text/talus.[^>]*>([^<]*)<")


def chunks(data):
    at = 0
    while at < len(data):
        kind, length = struct.unpack_from("<4sI", data, at)
        yield kind.decode(), data[at + 8:at + 8 + length]
        at += 8 + (length + 3) // 4 * 4


def chunk(kind, body):
    return struct.pack("<4sI", kind.encode(), len(body)) + body + b"\0" * (-len(body) % 4)


def live(state, **more):
    """A chunk that tells what the run does."""
    return chunk("LIVE", json.dumps({"state": state, **more}).encode())


def frames_of(page, commands=True):
    """The frames of a page, unpacked, as a run sends them."""
    for text in FRAME.findall(page):
        data = zlib.decompress(base64.b64decode(text))
        yield b"".join(chunk(kind, json.dumps({**json.loads(body), "live": True, "commands": commands}).encode() if kind == "HEAD" else body)
                       for kind, body in chunks(data))


def split(frame):
    """News, and the rest."""
    at = 0
    while frame[at:at + 4] != b"FRAM":
        at += 8 + (struct.unpack_from("<I", frame, at + 4)[0] + 3) // 4 * 4
    return frame[:at], frame[at:]


def numbered(frame, number):
    return frame[:-4] + struct.pack("<I", number)


class Handler(http.server.BaseHTTPRequestHandler):
    def log_message(self, *_):
        pass

    def answer(self, status, body=b"", kind="text/plain; charset=utf-8"):
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def do_GET(self):
        run = self.server.run
        if self.path == "/" or self.path.startswith("/?token="):
            return self.answer(200, run.page, "text/html; charset=utf-8")
        if self.path != "/scene" or self.headers["X-Talus-Token"] != TOKEN:
            return self.answer(403)
        self.send_response(200)
        self.end_headers()
        told = last = beginning = 0
        while True:
            with run.change:
                run.change.wait_for(lambda: run.over or run.count > last)
                if run.count == last:
                    return None
                if beginning != run.beginning:
                    told, beginning = 0, run.beginning
                news, now, told, last = run.news[told:], run.now, len(run.news), run.count
            data = b"".join(news) + now
            try:
                for at in range(0, len(data), run.piece):
                    self.wfile.write(data[at:at + run.piece])
                self.wfile.flush()
            except OSError:
                return None

    def do_POST(self):
        run, body = self.server.run, self.rfile.read(int(self.headers["Content-Length"]))
        run.bodies.append(body)
        command = json.loads(body)
        run.commands.append(command)
        if self.path != "/command" or self.headers["X-Talus-Token"] != TOKEN:
            return self.answer(403, b"The token is not that of this run.")
        if len(body) > 511:
            return self.answer(413, b"A command has at most 511 bytes.")
        refused = run.refuse(command)
        return self.answer(*refused) if refused else self.answer(202)


class MockRun:
    """A run on a port of its own."""

    def __init__(self, page, piece=1 << 20):
        self.page = re.sub(r"<script type=.text/talus.*?</script>", "", page, flags=re.S).replace("connect-src 'none'", "connect-src 'self'").encode()
        self.news, self.now, self.number, self.count, self.beginning = [], b"", 0, 0, 0
        self.over, self.change, self.piece = False, threading.Condition(), piece
        self.commands, self.bodies, self.refuse = [], [], lambda command: None
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads, self.server.run = True, self
        self.address = f"http://127.0.0.1:{self.server.server_port}/?token={TOKEN}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()
        self.server.shutdown()
        self.server.server_close()

    def put(self, frame, *told):
        """Shows a frame, with what is told beside it in front."""
        news, now = split(frame)
        with self.change:
            self.news.append(news + b"".join(told))
            self.now = numbered(now, self.number)
            self.number += 1
            self.count += 1
            self.change.notify_all()

    def begin(self):
        """News begins anew with the next frame: it is to tell all."""
        with self.change:
            self.news, self.number = [], 0
            self.beginning += 1

    def end(self):
        """The program ends."""
        with self.change:
            self.over = True
            self.change.notify_all()
