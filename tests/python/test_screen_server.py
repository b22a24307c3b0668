"""The screen "browser" over its socket: who is let in, what is answered, and how frames and commands go through.

    tests/python/test_screen_server.py DRIVER PLUGIN TIMED_PLUGIN

DRIVER (tests/screen/driver.c) is in the place of the model. TIMED_PLUGIN gives a silent request up after 2 s, and lets those who look
have what they have not got at the end however long that takes. What must not wait for something is tried where it would wait for
ever."""
import http.client
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import threading
import time  # to sleep

ADDRESS = re.compile(r"^http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})$")
HEADERS = {"x-frame-options": "DENY", "x-content-type-options": "nosniff", "cross-origin-resource-policy": "same-origin",
           "referrer-policy": "no-referrer", "cache-control": "no-store"}
PAGE = "<!doctype html><title>Müller's page</title>".encode()

faults = []


def expect(holds, what):
    if not holds:
        faults.append(what)
    return holds


class Run:
    """A driver with an open screen."""

    def __init__(self, driver, plugin, port=0, commands=1):
        self.process = subprocess.Popen([driver, plugin], stdin=subprocess.PIPE, stdout=subprocess.PIPE, encoding="utf-8")
        self.said = self.tell(f"open {port} {commands}")
        match = ADDRESS.match(self.said.removeprefix("at "))
        self.port, self.token = (int(match[1]), match[2]) if match else (0, "")

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def hear(self):
        return self.process.stdout.readline().rstrip("\n")

    def tell(self, line):
        self.ask(line)
        return self.hear()

    def put(self, begin, news, now):
        """The number of the frame."""
        return int(self.tell(f"put {begin} {news} {now}").removeprefix("put "))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        expect(self.process.wait() == 0, f"the driver ends with {self.process.returncode}")
        self.process.stdout.close()

    def request(self, method="GET", path="/", token=True, body=None, headers=None, query=None):
        """Status, headers and body of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port)
        connection.putrequest(method, path + (f"?token={query}" if query is not None else ""), skip_host=True,
                              skip_accept_encoding=True)
        sent = {"Host": f"127.0.0.1:{self.port}", **({"X-Talus-Token": self.token} if token is True else {}), **(headers or {})}
        if isinstance(token, str):
            sent["X-Talus-Token"] = token
        if body is not None:
            sent["Content-Length"] = str(len(body))
        for name, value in sent.items():
            if value is not None:
                connection.putheader(name, value)
        connection.endheaders(body)
        answer = connection.getresponse()
        found = answer.status, {k.lower(): v for k, v in answer.getheaders()}, answer.read()
        connection.close()
        return found

    def post(self, text, **more):
        return self.request("POST", "/command", body=text if isinstance(text, bytes) else text.encode(), **more)

    def dial(self, text=b""):
        """A bare connection, with that sent."""
        found = socket.create_connection(("127.0.0.1", self.port))
        found.sendall(text)
        return found

    def scene_request(self):
        return f"GET /scene HTTP/1.1\r\nHost: localhost:{self.port}\r\nX-Talus-Token: {self.token}\r\n\r\n".encode()


class Watcher(threading.Thread):
    """Reads frames, as (numbers of the news, number) each; with `later` only from when it is let go on."""

    def __init__(self, run, later=False):
        super().__init__(daemon=True)
        self.frames, self.fault, self.ended, self.whole = [], "", False, False
        self.goes_on, self.news = threading.Event(), threading.Condition()
        if not later:
            self.goes_on.set()
        self.connection = http.client.HTTPConnection("127.0.0.1", run.port)
        self.connection.request("GET", "/scene", headers={"X-Talus-Token": run.token})
        self.answer = self.connection.getresponse()
        expect(self.answer.status == 200 and self.answer.getheader("Content-Type") == "application/octet-stream" and
               self.answer.getheader("Transfer-Encoding") == "chunked", f"head of the frames: {self.answer.headers}")
        self.start()

    def run(self):
        self.goes_on.wait()
        try:
            news, now = [], None
            while head := self.answer.read(8):
                name, length = head[:4], struct.unpack("<I", head[4:])[0]
                payload = self.answer.read(length)
                number = struct.unpack("<I", payload[:4])[0]
                if len(payload) != length or payload[4:] != bytes([number % 251]) * (length - 4):
                    self.fault = f"{name} of frame {number} is not what was put"
                if name == b"NEWS":
                    news.append(number)
                    self.fault = self.fault or ("news after the moment" if now is not None else "")
                elif name == b"NOWF":
                    self.fault = self.fault or ("two moments in a frame" if now is not None else "")
                    now = number
                elif name == b"DONE":
                    if now != number:
                        self.fault = f"DONE {number} after {now}"
                    with self.news:
                        self.frames.append((news, number))
                        self.news.notify_all()
                    news, now = [], None
                else:
                    self.fault = f"a chunk {name}"
            self.whole = not news and now is None
        except Exception as error:  # told by the test
            self.fault = self.fault or repr(error)
        with self.news:
            self.ended = True
            self.news.notify_all()

    def wait(self, number):
        """Until that frame has come; the number of the newest."""
        with self.news:
            self.news.wait_for(lambda: self.ended or (self.frames and self.frames[-1][1] >= number))
        return self.frames[-1][1] if self.frames else None

    def leave(self):
        self.connection.sock = None
        self.answer.fp.raw._sock.shutdown(socket.SHUT_RDWR)  # close() would wait for the thread that reads

    def done(self):
        """Whether the frames ended as they should."""
        self.join()
        return self.whole and not self.fault


def check_requests(run):
    """Who is let in, and what is answered."""
    host = f"127.0.0.1:{run.port}"
    status, headers, body = run.request(token=None, query=run.token)
    expect(status == 200 and body == PAGE and headers["content-type"] == "text/html; charset=utf-8", f"the page: {status}")
    expect(run.request()[0] == 200, "the token in the header")
    expect(run.request(headers={"Host": "localhost:1"})[0] == 200, "another port, as through a tunnel")
    expect(run.request(headers={"Origin": f"http://{host}", "Sec-Fetch-Site": "same-origin"})[0] == 200, "its own origin")
    expect(run.request(headers={"Sec-Fetch-Site": "none"})[0] == 200, "an address that was typed")
    wrong = ("0" if run.token[0] != "0" else "1") + run.token[1:]
    refused = [
        ("no token", {"token": None}, "token is missing or wrong"),
        ("a wrong token", {"token": wrong}, "token is missing or wrong"),
        ("a wrong token in the address", {"token": None, "query": wrong}, "token is missing or wrong"),
        ("a wrong token, the right one in the address", {"token": wrong, "query": run.token}, "token is missing or wrong"),
        ("half a token", {"token": run.token[:16]}, "token is missing or wrong"),
        ("a foreign host", {"headers": {"Host": f"evil.example:{run.port}"}}, "only to its own page"),
        ("no host", {"headers": {"Host": None}}, None),
        ("a foreign origin", {"headers": {"Origin": "http://evil.example"}}, "only to its own page"),
        ("an origin of another port", {"headers": {"Origin": f"http://127.0.0.1:{run.port ^ 1}"}}, "only to its own page"),
        ("another site", {"headers": {"Sec-Fetch-Site": "cross-site"}}, "only to its own page"),
        ("the same site", {"headers": {"Sec-Fetch-Site": "same-site"}}, "only to its own page"),
    ]
    for path, method in (("/", "GET"), ("/scene", "GET"), ("/command", "POST"), ("/nothing", "GET")):
        for what, how, sentence in refused:
            status, headers, body = run.request(method, path, body=b"{}" if method == "POST" else None, **how)
            if path == "/" and sentence and "token" in sentence:  # it holds nothing of the run
                expect(status == 200 and body == PAGE, f"{what}: {status} of the page")
                continue
            if sentence is None:  # the library's own answer
                expect(status == 400, f"{what} at {path}: {status}")
                continue
            expect(status == 403 and sentence in body.decode(), f"{what} at {path}: {status} {body}")
    for method, path, status, allow in (("GET", "/nothing", 404, None), ("GET", "/scene/", 404, None), ("GET", "//", 404, None),
                                        ("POST", "/", 405, "GET"), ("POST", "/scene", 405, "GET"), ("HEAD", "/", 405, "GET"),
                                        ("GET", "/command", 405, "POST"), ("PUT", "/command", 405, "POST"),
                                        ("DELETE", "/", 405, "GET"), ("OPTIONS", "/command", 405, "POST")):
        for body in (None, b"x" * 3000):
            answer = run.request(method, path, body=body)
            expect(answer[0] == status and answer[1].get("allow") == allow, f"{method} {path}: {answer[:2]}")
    answer = run.request(path="/favicon.ico", token=None)
    expect(answer[0] == 404, f"favicon: {answer[0]}")
    for answer in (run.request(), run.request(token=None), run.request(path="/x"), run.request("PUT"), run.post("{}"), run.post("x")):
        for name, value in HEADERS.items():
            expect(answer[1].get(name) == value, f"{name} of a {answer[0]}: {answer[1].get(name)}")
        expect(not [name for name in answer[1] if name.startswith("access-control")], f"headers of CORS in a {answer[0]}")
    expect(run.tell("take 0") == "took {}" and run.tell("take 0") == "none", "one command of these came through")
    two = run.dial(f"GET /?token={run.token} HTTP/1.1\r\nHost: {host}\r\nHost: {host}\r\n\r\n".encode())
    expect(two.recv(100).split(b" ")[1] in (b"400", b"403"), "two hosts")
    two.close()
    nonsense = run.dial(b"\x16\x03\x01 this is no HTTP\r\n\r\n")
    expect(b" 200 " not in nonsense.recv(1000), "nonsense")
    nonsense.close()


def check_commands(run, driver, plugin):
    """What becomes of commands."""
    answer = run.post('{"op":"step","n":100}')
    expect(answer[0] == 202 and run.tell("take 0") == 'took {"op":"step","n":100}', f"a command: {answer}")
    answer = run.post("os.execute('x')")
    expect(answer[0] == 400 and "is no command: it is one JSON object" in answer[2].decode(), f"a bad command: {answer}")
    expect(run.post("")[0] == 400, "an empty command")
    expect(run.post(b'{"a":"\0"}')[0] == 400, "a byte 0")
    expect(run.post("{" + "x" * 509 + "}")[0] == 202 and len(run.tell("take 0")) == 5 + 511, "511 bytes")
    for length in (512, 2048, 65536, 65537, 3000000):
        try:
            answer = run.post("{" + "x" * (length - 2) + "}")
            expect(answer[0] == 413 and b"at most 511 bytes" in answer[2], f"{length} bytes: {answer[0]}")
        except OSError as error:  # what is too long to be read may end in a reset
            expect(length > 65536, f"{length} bytes: {error}")
    parts = run.dial(f"POST /command HTTP/1.1\r\nHost: localhost\r\nX-Talus-Token: {run.token}\r\nContent-Length: 8\r\n\r\n".encode())
    for letter in b'{"a":12}':
        parts.sendall(bytes([letter]))
        time.sleep(0.002)
    expect(b" 202 " in parts.recv(1000) and run.tell("take 1e9") == 'took {"a":12}', "a command byte by byte")
    parts.close()
    chunked = run.dial(f"POST /command HTTP/1.1\r\nHost: localhost\r\nX-Talus-Token: {run.token}\r\n"
                       'Transfer-Encoding: chunked\r\n\r\n3\r\n{"a\r\n3\r\n":1\r\n1\r\n}\r\n0\r\n\r\n'.encode())
    expect(b" 202 " in chunked.recv(1000) and run.tell("take 1e9") == 'took {"a":1}', "a command in chunks")
    chunked.close()
    for i in range(64):
        expect(run.post(f'{{"n":{i}}}')[0] == 202, f"command {i} of 64")
    answer = run.post("{}")
    expect(answer[0] == 503 and b"64 commands wait" in answer[2], f"the 65th command: {answer}")
    for i in range(64):
        expect(run.tell("take 0") == f'took {{"n":{i}}}', f"command {i} comes in turn")
    expect(run.tell("take 0") == "none" and run.post("{}")[0] == 202 and run.tell("take 0") == "took {}", "room again")
    run.ask("take 1e9")
    expect(run.post("{}")[0] == 202 and run.hear() == "took {}", "a wait is ended by a command")
    with Run(driver, plugin, commands=0) as shows:
        answer = shows.post("{}")
        expect(answer[0] == 403 and b"only shows" in answer[2] and shows.tell("take 0") == "none", f"commands off: {answer}")
        expect(shows.request()[0] == 200, "the page of one that only shows")
        shows.tell("close")


def check_frames(run):
    """Frames reach who looks: in order, whole, all alike, and in time."""
    run.ask("take 1e9")
    first = Watcher(run)
    expect(run.hear() == "none", "a wait is ended by who begins to look")
    expect(run.tell("wait 1") == "watchers 1", "one watcher")
    expect(run.put(1, 1000, 5000) >= 0 and first.wait(0) == 0, "the first frame")
    second = Watcher(run)
    expect(run.tell("wait 2") == "watchers 2" and second.wait(0) == 0, "a second watcher gets what there is")
    for number in (1, 2, 3):
        run.put(0, 100, 200000)
        expect(first.wait(number) == second.wait(number) == number, f"frame {number} reaches both")
    count = 28
    run.ask("run 25 40 100 200000")
    answer = run.post('{"op":"pause"}')
    expect(answer[0] == 202 and run.hear() == 'took {"op":"pause"}', "a command during a run")
    run.hear()
    for watcher in (first, second):
        expect(watcher.wait(count) == count, f"the last frame: {watcher.frames[-1:]} {watcher.fault}")
        news = [number for frame in watcher.frames for number in frame[0]]
        expect(news == list(range(count + 1)), f"all news in their order: {news}")
    expect(run.put(1, 400, 8) >= 0 and first.wait(count + 1) == count + 1, "a new beginning")
    late = Watcher(run)
    expect(late.wait(count + 1) == count + 1 and late.frames[0] == ([count + 1], count + 1), f"a late one: {late.frames} {late.fault}")
    for i in range(3):
        expect(run.put(0, 4 * (i % 2), 8) >= 0, "frames of a few bytes")
    for watcher in (first, second, late):
        watcher.wait(count + 4)
    late.leave()
    expect(run.tell("wait 2") == "watchers 2", "a watcher that leaves while there is nothing new is missed")
    return first, second


def check_trouble(run, first):
    """Watchers that stop, leave and crowd; the others go on."""
    begin = run.put(0, 4, 8)
    slow = Watcher(run, later=True)
    expect(run.tell("wait 3") == "watchers 3", "a watcher that does not read")
    run.ask("run 30 20 400 4000000")
    leaver = run.dial(run.scene_request())
    leaver.recv(100000)  # in the middle of a frame
    leaver.close()
    expect(run.hear() == "ran", "frames are put while one does not read")
    expect(first.wait(begin + 30) == begin + 30, f"the others get all: {first.frames[-1]} {first.fault}")
    slow.goes_on.set()  # now it reads: what was on its way to it, and then the newest
    expect(slow.wait(begin + 30) == begin + 30 and not slow.fault, f"the slow one: {slow.frames[-1:]} {slow.fault}")
    expect(len(slow.frames) < 10, f"frames of the slow one: {len(slow.frames)}")
    news = [number for frame in slow.frames for number in frame[0]]
    expect(news[-30:] == list(range(begin + 1, begin + 31)), f"all its news: {news}")
    slow.leave()
    expect(run.tell("wait 2") == "watchers 2", "those who left are missed")


def check_crowd(run):
    """Two look already: eight may look, twelve connections are served, and the others are told."""
    six = [run.dial(run.scene_request()) for _ in range(6)]
    heads = [one.recv(15) for one in six]
    expect(heads == [b"HTTP/1.1 200 OK"] * 6 and run.tell("wait 8") == "watchers 8", f"eight watchers: {heads}")
    status, _, body = run.request(path="/scene")
    expect(status == 503 and b"8 pages" in body, f"a ninth that looks: {status}")
    expect(run.request()[0] == 200, "those who look can still ask")
    four = [run.dial() for _ in range(4)]
    time.sleep(0.1)
    status, _, body = run.request()
    expect(status == 503 and b"12 connections" in body, f"a thirteenth: {status}")
    silent = four + [run.dial() for _ in range(12)]
    time.sleep(0.1)
    more = run.dial()
    try:
        more.sendall(run.scene_request())
        said = more.recv(100)
    except OSError:
        said = b""
    expect(b" 200 " not in said, f"one beyond those that are told: {said}")
    expect(run.put(0, 4, 8) >= 0, "a crowd does not disturb the run")
    for one in six + silent + [more]:
        one.close()
    expect(run.tell("wait 2") == "watchers 2" and run.request()[0] == 200, "room again")


def check_end(driver, plugin, timed):
    """Who looks gets the newest, and a proper end; one who does not read is waited for, but not for ever."""
    with Run(driver, timed) as run:
        first, slow = Watcher(run), Watcher(run, later=True)
        expect(run.tell("wait 2") == "watchers 2", "one who reads, and one who will begin late")
        run.put(1, 4, 8000000)
        last = run.put(0, 4, 20000000)
        run.ask("close")
        time.sleep(0.1)
        slow.goes_on.set()
        expect(run.hear() == "closed" and first.done() and slow.done(), f"the ends: {first.fault} {slow.fault}")
        ends = [watcher.frames[-1][1] for watcher in (first, slow)]
        expect(ends == [last] * 2, f"the newest frame came before the end: {ends}, {last}")
    with Run(driver, plugin) as run:
        stuck, idle = run.dial(run.scene_request()), run.dial()
        run.tell("wait 1")
        run.put(1, 4, 20000000)
        expect(run.tell("close") == "closed", "one who does not read")
        try:
            socket.create_connection(("127.0.0.1", run.port)).close()
            expect(False, "the port is free after the end")
        except OSError:
            pass
        stuck.close()
        idle.close()


def check_ports(driver, plugin):
    with Run(driver, plugin) as run:
        with Run(driver, plugin, port=run.port) as other:
            expect(other.said == f"failed port {run.port} of 127.0.0.1 is in use; give another one, or 0 for any that is free",
                   f"a port in use: {other.said}")
        Watcher(run)
        run.put(1, 8, 8)
        port, token = run.port, run.token
        run.tell("close")
        said = run.tell(f"open {port} 1")
        expect(said.startswith(f"at http://127.0.0.1:{port}/?token=") and token not in said, f"the same port again: {said}")
        run.tell("close")


def check_silence(driver, timed):
    """Half a request is given up after a while; a watcher without news is not, nor one that does not read."""
    with Run(driver, timed) as run:
        watcher, slow = Watcher(run), Watcher(run, later=True)
        run.tell("wait 2")
        run.put(1, 8, 9000000)
        watcher.wait(0)
        halves = [run.dial(text) for text in (b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: localhost\r\n",
                                              f"POST /command HTTP/1.1\r\nHost: localhost\r\nX-Talus-Token: {run.token}\r\n"
                                              "Content-Length: 20\r\n\r\n{".encode())]
        for i, half in enumerate(halves):
            try:
                said = b"".join(iter(lambda one=half: one.recv(1000), b""))
            except OSError:
                said = b""
            expect(b" 200 " not in said and b" 202 " not in said, f"half request {i}: {said}")
            half.close()
        time.sleep(1)
        last = run.put(0, 4, 8)
        slow.goes_on.set()
        for one in (watcher, slow):
            expect(one.wait(last) == last, f"a watcher after silence: {one.frames} {one.fault}")
        expect(run.tell("close") == "closed" and watcher.done() and slow.done(), "the end after silence")


def check_threads(run):
    """The server's thread leaves signals to the others, and what it opens is closed in programs that are started."""
    process = f"/proc/{run.process.pid}"
    for task in os.listdir(f"{process}/task"):
        with open(f"{process}/task/{task}/status", encoding="ascii") as file:
            blocked = int(re.search(r"SigBlk:\s*(\w+)", file.read())[1], 16)
        wanted = [signal.SIGINT, signal.SIGTERM, signal.SIGPIPE, signal.SIGALRM, signal.SIGCHLD, signal.SIGUSR1]
        missing = [number.name for number in wanted if not blocked >> (number - 1) & 1]
        expect(task == str(run.process.pid) or not missing, f"thread {task} takes {missing}")
    for name in os.listdir(f"{process}/fd"):
        with open(f"{process}/fdinfo/{name}", encoding="ascii") as file:
            flags = int(re.search(r"flags:\s*(\w+)", file.read())[1], 8)
        expect(int(name) <= 2 or flags & os.O_CLOEXEC, f"open in programs that are started: {os.readlink(f'{process}/fd/{name}')}")


def cpu_seconds(process):
    with open(f"/proc/{process.pid}/stat", encoding="ascii") as file:
        words = file.read().rsplit(")", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def check_rest(driver, plugin):
    """With nothing to do the server does nothing, whoever looks."""
    with Run(driver, plugin) as run:
        watcher = Watcher(run)
        run.put(1, 8, 8)
        watcher.wait(0)
        idle = run.dial(b"GET /")
        before = cpu_seconds(run.process)
        time.sleep(0.5)
        used = cpu_seconds(run.process) - before
        expect(used < 0.1, f"an idle server uses {used} s of 0.5")
        check_threads(run)
        idle.close()
        run.tell("close")


def main():
    driver, plugin, timed = sys.argv[1:4]
    with Run(driver, plugin) as run:
        expect(run.port > 0, f"the address: {run.said}")
        check_requests(run)
        check_commands(run, driver, plugin)
        first, _ = check_frames(run)
        check_trouble(run, first)
        check_crowd(run)
        run.tell("close")
    check_end(driver, plugin, timed)
    check_ports(driver, plugin)
    check_silence(driver, timed)
    check_rest(driver, plugin)
    for fault in faults:
        print(fault)
    print(f"screen server: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
