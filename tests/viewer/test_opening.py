#!/usr/bin/env python3
"""How a page is opened: what goes to the graphics, and what the first picture waits for. (How long it takes: loading.py.)

    test_opening.py            all tests; without Chromium one sentence, and status 77 (status 1 where TALUS_BROWSER is "required")
    test_opening.py NAME...    some tests
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from harness import check, run_tests, show  # noqa: E402

# Notes what the page hands over to the graphics and asks of the browser until the first picture.
SPY = """
(() => {
    const gl = WebGL2RenderingContext.prototype, seen = window.seen = { buffers: [], programs: 0, sizes: [], unpacked: 0, chunks: 0 };
    const open = () => !window.talus?.app || talus.app.number === 0, { bufferData, linkProgram, viewport } = gl;
    gl.bufferData = function (target, data, use) { seen.buffers.push([target, data.slice?.(0)]); return bufferData.call(this, target, data, use); };
    gl.linkProgram = function (p) { if (open()) seen.programs++; return linkProgram.call(this, p); };
    gl.viewport = function (x, y, w, h) { if (open()) seen.sizes.push(w); return viewport.call(this, x, y, w, h); };
    const Old = DecompressionStream;
    window.DecompressionStream = class extends Old { constructor(kind) { super(kind); seen.unpacked++; } };
})();
"""
# The triangles of the picture against the faces of the blocks: every one once, in its face's name, joint and normal.
TRIANGLES = """(() => {
    const m = talus.app.model, [, place] = seen.buffers.find(([t, d]) => t === 0x8892 && d?.length > 1000), [, index] = seen.buffers.find(([t]) => t === 0x8893);
    const f32 = new Float32Array(place.buffer, place.byteOffset, place.length), u32 = new Uint32Array(f32.buffer, f32.byteOffset, f32.length), i16 = new Int16Array(f32.buffer, f32.byteOffset, 2 * f32.length);
    const found = new Map(), vertices = f32.length / 7, wrong = [];
    let corners = 0, wanted = 0;
    const at = (v) => [f32[7 * v], f32[7 * v + 1], f32[7 * v + 2]], key = (row, face, joint) => `${row}:${face}:${joint}`;
    const area = (a, b, c) => { const p = b.map((x, k) => x - a[k]), q = c.map((x, k) => x - a[k]); return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]; };
    for (let i = 0; i < index.length; i += 3) {
        const [a, b, c] = index.subarray(i, i + 3), name = u32[7 * c + 5], rows = [a, b, c].map((v) => u32[7 * v + 5] & 0xffffff);
        if (rows[0] !== rows[1] || rows[0] !== rows[2]) wrong.push(`triangle ${i / 3} of rows ${rows}`);
        const k = key(rows[2], name >>> 24, u32[7 * c + 6]), sum = found.get(k) ?? { n: [0, 0, 0], of: c, count: 0 };
        area(at(a), at(b), at(c)).forEach((x, d) => { sum.n[d] += x; });
        if (sum.of !== c) wrong.push(`face ${k} has two last corners`);
        sum.count++;
        found.set(k, sum);
    }
    for (let row = 0; row < m.rows; row++) {
        const s = m.shape[row], v = s.shapes.vertex;
        m.eachFace(row, (face, corner, count, joint) => {
            const p = Array.from({ length: count }, (_x, i) => { const k = 3 * (s.vertex + s.shapes.loop[corner + i]); return [v[k], v[k + 1], v[k + 2]]; }), n = [0, 0, 0], k = key(row, face, joint), sum = found.get(k);
            corners += count;
            wanted++;
            for (let i = 1; i + 1 < count; i++) area(p[0], p[i], p[i + 1]).forEach((x, d) => { n[d] += x; });
            const size = Math.hypot(...n);
            if (!sum || sum.count !== count - 2) { wrong.push(`face ${k} has ${sum?.count} triangles of ${count - 2}`); return; }
            if (n.some((x, d) => Math.abs(x - sum.n[d]) > 1e-5 * size)) wrong.push(`face ${k} has area ${sum.n} instead of ${n}`);
            if (n.some((x, d) => Math.abs(x / size * 32767 - i16[14 * sum.of + 6 + d]) > 1.01)) wrong.push(`face ${k} has another normal`);
        });
    }
    return { wrong: wrong.slice(0, 3), faces: found.size, wanted, vertices, corners };
})()"""


def spied(chrome, source):
    return chrome.call("Page.addScriptToEvaluateOnNewDocument", source=source)["identifier"]


def test_triangles(chrome, folder):
    """Blocks go to the graphics with every face once, and with fewer vertices than faces have corners: also shapes of more faces than vertices."""
    script = spied(chrome, SPY)
    for page in ("rock", "gems"):
        show(chrome, folder / f"{page}.html")
        got = chrome.run(TRIANGLES)
        check(not got["wrong"] and got["faces"] == got["wanted"] > 0, f"{page}: {got}")
        check(got["vertices"] < 0.6 * got["corners"], f"{page}: {got['vertices']} vertices for {got['corners']} corners")
    chrome.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


def test_first(chrome, folder):
    """The first picture is a draft of few programs, at half the resolution where there are many triangles, and no frame is unpacked twice for it."""
    script = spied(chrome, SPY)
    for page, half in (("rock", 2), ("gems", 1)):
        show(chrome, folder / f"{page}.html")
        seen = chrome.run("(({ programs, sizes, unpacked }) => ({ programs, sizes, unpacked, triangles: talus.app.model.triangles, width: talus.app.canvas.width }))(seen)")
        check((seen["triangles"] > 200000) == (half == 2), f"{page} has {seen['triangles']} triangles")
        check(seen["programs"] == 3, f"{page}: {seen['programs']} programs are made for the first picture: blocks, draft and showing it")
        check(sorted(set(seen["sizes"])) == sorted({seen["width"] // half, seen["width"]}), f"{page}: the first picture is drawn {seen['sizes']} pixels wide")
        check(seen["unpacked"] == 1, f"{page}: frames are unpacked {seen['unpacked']} times")
    chrome.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


def test_old_browser(chrome, folder):
    """A browser that knows base64 of texts only shows the same."""
    for page in ("gems",):
        show(chrome, folder / f"{page}.html")
        new = chrome.run("[...new Uint8Array(talus.app.model.frames[0].buffer)].reduce((a, b) => (Math.imul(a, 31) + b) | 0, 7)")
        script = spied(chrome, "delete Uint8Array.fromBase64;")
        show(chrome, folder / f"{page}.html")
        old = chrome.run("Uint8Array.fromBase64 ? null : [...new Uint8Array(talus.app.model.frames[0].buffer)].reduce((a, b) => (Math.imul(a, 31) + b) | 0, 7)")
        chrome.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)
        check(new == old, f"{page}: an old browser unpacks {old} instead of {new}")


TESTS = {name[5:]: value for name, value in list(globals().items()) if name.startswith("test_")}

if __name__ == "__main__":
    sys.exit(run_tests("test_opening.py", "opening.lua", TESTS))
