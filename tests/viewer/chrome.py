"""Drives a headless Chromium over its DevTools protocol, with the standard library only.

    with Chrome() as chrome:
        chrome.open("/path/page.html")
        chrome.run("document.title")

A page is evaluated with software graphics (SwiftShader), so that pictures do not depend on the machine's graphics card.
"""
import base64
import json
import os
import pathlib
import shutil
import socket
import struct
import subprocess
import tempfile
import time
import urllib.parse
import zlib

PATIENCE = 120  # seconds until an answer counts as missing
SIMILAR = 0.98  # structural similarity from which pictures count as the same


def program():
    """Path of the browser, or None."""
    return next((p for p in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if p), None)


class WebSocket:
    """A client's end of a WebSocket (RFC 6455) without extensions."""

    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.socket = socket.create_connection((parts.hostname, parts.port), timeout=PATIENCE)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET {parts.path} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        self.stream = self.socket.makefile("rb")
        if b" 101 " not in self.stream.readline():
            raise RuntimeError("the browser refuses the connection")
        while self.stream.readline().strip():
            pass

    def send(self, text):
        data, mask = text.encode(), os.urandom(4)
        length = bytes([0x80 | len(data)]) if len(data) < 126 else \
            b"\xfe" + struct.pack(">H", len(data)) if len(data) < 65536 else b"\xff" + struct.pack(">Q", len(data))
        pad = (mask * (len(data) // 4 + 1))[:len(data)]
        masked = (int.from_bytes(data, "big") ^ int.from_bytes(pad, "big")).to_bytes(len(data), "big")
        self.socket.sendall(b"\x81" + length + mask + masked)

    def receive(self):
        text = b""
        while True:
            first, second = self.stream.read(2)
            length = second & 127
            if length > 125:
                length = int.from_bytes(self.stream.read(2 if length == 126 else 8), "big")
            data = self.stream.read(length)
            if first & 15 == 8:
                raise RuntimeError("the browser has closed the connection")
            if first & 15 in (0, 1):
                text += data
                if first & 128:
                    return text.decode()


class Chrome:
    """A browser with one page. `log` collects what the page reports: exceptions, refused resources, console messages. The page averages
    `samples` pictures when nothing changes, each drawn by the processor; 0: as many as it does for its users."""

    def __init__(self, width=1440, height=900, path=None, arguments=()):
        self.folder = tempfile.mkdtemp(prefix="talus_chrome_")
        self.samples = 1
        self.errors = open(os.path.join(self.folder, "stderr"), "w+")
        self.process = subprocess.Popen(
            [path or program(), "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--remote-debugging-port=0", f"--user-data-dir={self.folder}/profile", "--no-first-run", "--disable-extensions",
             "--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage", "--force-device-scale-factor=1",
             "--hide-scrollbars", f"--window-size={width},{height}", *arguments, "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self.errors)
        port_file, end = pathlib.Path(self.folder, "profile", "DevToolsActivePort"), time.monotonic() + PATIENCE
        while not (port_file.exists() and port_file.read_text().count("\n")):
            if time.monotonic() > end or self.process.poll() is not None:
                self.errors.seek(0)
                raise RuntimeError("the browser does not start: " + self.errors.read()[-2000:])
            time.sleep(0.05)
        port, path = port_file.read_text().split("\n")[:2]
        self.socket, self.number, self.session, self.log = WebSocket(f"ws://127.0.0.1:{port}{path}"), 0, None, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(domain + ".enable")
        self.resize(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.session = None
            self.call("Browser.close")
            self.process.wait(10)
        except (OSError, RuntimeError, subprocess.TimeoutExpired):
            self.process.kill()
        self.errors.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        self.socket.send(json.dumps(message))
        while True:
            answer = json.loads(self.socket.receive())
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.note(answer)

    def note(self, event):
        name, p = event.get("method"), event.get("params", {})
        if name == "Runtime.exceptionThrown":
            d = p["exceptionDetails"]
            self.log.append(d.get("exception", {}).get("description") or d["text"])
        elif name == "Log.entryAdded":
            self.log.append(p["entry"]["text"])
        elif name == "Runtime.consoleAPICalled":
            self.log.append(" ".join(str(a.get("value", a.get("description"))) for a in p["args"]))

    def resize(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def open(self, path, fragment=""):
        """Opens a file, or an address of http; returns when its script has run."""
        address = path if str(path).startswith("http") else pathlib.Path(path).resolve().as_uri()
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url=address + fragment)
        end = time.monotonic() + PATIENCE
        while self.run("location.protocol + document.readyState") != address.split("/")[0] + "complete":
            if time.monotonic() > end:
                raise RuntimeError("the page does not load")
            time.sleep(0.02)
        if self.samples:
            self.run(f"if (window.talus) talus.app.samples = {self.samples}")

    def run(self, expression):
        """Value of an expression in the page, a promise's when it is kept."""
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            d = result["exceptionDetails"]
            raise RuntimeError(d.get("exception", {}).get("description") or d["text"])
        return result["result"].get("value")

    def picture(self):
        """The window as rows of (r, g, b)."""
        return read_png(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))

    def key(self, key, code=0, text="", modifiers=0):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, windowsVirtualKeyCode=code, modifiers=modifiers, text=text if kind == "keyDown" else "")

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)


def read_png(data):
    """Rows of (r, g, b), over white, of a PNG of 8 bits, colour type 2 or 6, not interlaced."""
    at, packed, width, height, channels = 8, b"", 0, 0, 3
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack_from(">IIBB", body)
            channels = {2: 3, 6: 4}[colour]
            assert depth == 8, "only PNG of 8 bits are read"
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    raw, stride = zlib.decompress(packed), width * channels
    line, rows = bytearray(stride), []
    for y in range(height):
        begin = y * (stride + 1) + 1
        line = unfiltered(raw[begin - 1], bytearray(raw[begin:begin + stride]), line, channels)
        colours = [line[k::channels] for k in range(3)]
        if channels == 4:  # over white
            alpha = line[3::4]
            colours = [[255 + (v - 255) * a // 255 for v, a in zip(column, alpha)] for column in colours]
        rows.append(list(zip(*colours)))
    return rows


def unfiltered(kind, line, above, channels):
    """The bytes of a row, which a PNG gives by their differences from those to the left and in the row above."""
    if kind == 2:
        return bytearray([(v + b) & 255 for v, b in zip(line, above)])
    for k in range(channels) if kind else ():
        a = c = 0  # to the left, and above that
        for i in range(k, len(line), channels):
            b = above[i]
            if kind == 1:
                add = a
            elif kind == 3:
                add = (a + b) >> 1
            else:
                pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
                add = a if pa <= pb and pa <= pc else b if pb <= pc else c
            a, c = (line[i] + add) & 255, b
            line[i] = a
    return line


def similarity(a, b):
    """Mean structural similarity (Wang et al. 2004) of two pictures' brightness, in windows of 8 x 8; 0 where their sizes differ."""
    if (len(a), len(a[0])) != (len(b), len(b[0])):
        return 0.0
    total = count = 0
    for y in range(0, len(a) - 7, 8):
        for x in range(0, len(a[0]) - 7, 8):
            p = [sum(v) / 3 for row in a[y:y + 8] for v in row[x:x + 8]]
            q = [sum(v) / 3 for row in b[y:y + 8] for v in row[x:x + 8]]
            mp, mq = sum(p) / 64, sum(q) / 64
            vp, vq = sum(v * v for v in p) / 64 - mp * mp, sum(v * v for v in q) / 64 - mq * mq
            cov = sum(v * w for v, w in zip(p, q)) / 64 - mp * mq
            total += (2 * mp * mq + 6.5) * (2 * cov + 58.5) / ((mp * mp + mq * mq + 6.5) * (vp + vq + 58.5))
            count += 1
    return total / count


def write_png(rows):
    """PNG of rows of (r, g, b), without filters, which packs even surfaces best."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    raw = b"".join(b"\0" + bytes(value for pixel in row for value in pixel) for row in rows)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b"")
