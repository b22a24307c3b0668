// The picture as a PNG file in twice the resolution, with title, finding, legend, axes, scale bar, net, and where it
// comes from.
// @ts-check
import {FONT, drawAxes, drawLegends, inks, legendSize} from "./overlay.js";
import {byId, element} from "./dom.js";
import {figure} from "./math.js";

/**
 * Writes words in lines. Gives the place below them.
 * @param {CanvasRenderingContext2D} pen
 * @param {string} text
 * @param {number} x
 * @param {number} y
 * @param {number} wide
 */
function wrap(pen, text, x, y, wide) {
    let line = "";
    for (const word of text.split(" ")) {
        const longer = line ? `${line} ${word}` : word;
        if (line && pen.measureText(longer).width > wide) {
            pen.fillText(line, x, y);
            y += 17;
            line = word;
        } else line = longer;
    }
    pen.fillText(line, x, y);
    return y + 4;
}

/** Where a picture comes from: program, day, friction and state. @param {import("./page.js").Page} app */
function origins(app) {
    const head = app.model.head, hash = app.frame?.data.finding?.hash;
    const rub = (head?.friction ?? [])
                    .flatMap((f, i) => (i > 0 && Number.isFinite(f) ? [`${head?.joints[i]} ${figure(f)}°`] : []))
                    .slice(0, 8);
    return [
        head?.program ?? "Talus", new Date().toISOString().slice(0, 10),
        ...(rub.length ? [`friction ${rub.join(", ")}`] : []), ...(hash ? [`state ${hash}`] : [])
    ].join(" · ");
}

/** @param {import("./page.js").Page} app @param {number} factor @returns {Promise<Blob>} */
export async function makeImage(app, factor) {
    const {gpu, canvas, width, height} = app;
    const most = Math.max(width, height) * factor > 8192 ? 8192 / Math.max(width, height) : factor;
    const w = Math.round(width * most), h = Math.round(height * most), c = inks();
    const page = element("canvas", {width: w, height: h}), pen = page.getContext("2d");
    const before = [canvas.width, canvas.height];
    canvas.width = w;
    canvas.height = h;
    for (let i = 0; i < app.samples; i++) app.drawOne(w, h, i, true);
    const sky = pen.createLinearGradient(0, 0, 0, h);
    sky.addColorStop(0, c.top);
    sky.addColorStop(1, c.low);
    pen.fillStyle = sky;
    pen.fillRect(0, 0, w, h);
    pen.drawImage(canvas, 0, 0);
    [canvas.width, canvas.height] = before;
    pen.setTransform(most, 0, 0, most, 0, 0);
    pen.fillStyle = c.ink;
    pen.font = `600 17px ${FONT}`;
    pen.fillText(app.model.head?.title ?? "", 20, 32);
    pen.font = `13px ${FONT}`;
    pen.fillStyle = c.soft;
    pen.fillText(`${app.counts()} · ${byId("time").querySelector("output")?.textContent}`, 20, 52);
    pen.fillStyle = byId("findings").classList.contains("bad") ? c.warm : c.soft;
    const below = wrap(pen, byId("findings").textContent ?? "", 20, 70, width - 40);
    const size = legendSize(app.legends, app.note);
    const net = /** @type {HTMLCanvasElement} */ (byId("net").querySelector("canvas"));
    drawLegends(pen, app.legends, app.note, 20, height - 40 - size[1]);
    drawAxes(pen, app.camera, 60, Math.max(height - 90 - size[1], below + 44), height);
    if (!byId("net").hidden && net.width)
        pen.drawImage(
            net, width - 20 - net.clientWidth, Math.max(below + 8, height - 40 - net.clientHeight), net.clientWidth,
            net.clientHeight);
    pen.textAlign = "left";
    pen.textBaseline = "alphabetic";
    pen.fillStyle = c.soft;
    pen.font = `10px ${FONT}`;
    pen.fillText(origins(app), 20, height - 12, width - 40);
    app.change("camera");
    return new Promise(
        (done, fail) => page.toBlob(
            (/** @type {Blob | null} */ b) => (b ? done(b) : fail(new Error("The browser could not make the image."))),
            "image/png"));
}

/** @param {import("./page.js").Page} app */
export async function saveImage(app) {
    const url = URL.createObjectURL(await makeImage(app, 2));
    const name = (app.model.head?.title || "talus").replace(/[^A-Za-z0-9]+/g, "_").slice(0, 60);
    element("a", {href: url, download: `${name}_${app.view.frame}.png`}).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
}
