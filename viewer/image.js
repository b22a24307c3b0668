// The picture as a PNG file in twice the resolution, with title, legend, axes and scale bar.
// @ts-check
import { drawAxes, drawLegends, inks, legendSize } from "./overlay.js";
import { byId, element } from "./dom.js";

/** @param {import("./page.js").Page} app @param {number} factor @returns {Promise<Blob>} */
export async function makeImage(app, factor) {
    const { gpu, canvas, width, height } = app, most = Math.max(width, height) * factor > 8192 ? 8192 / Math.max(width, height) : factor;
    const w = Math.round(width * most), h = Math.round(height * most), c = inks();
    const page = element("canvas", { width: w, height: h }), pen = page.getContext("2d");
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
    pen.font = "600 17px system-ui, 'DejaVu Sans', sans-serif";
    pen.fillText(app.model.head?.title ?? "", 20, 32);
    pen.font = "13px system-ui, 'DejaVu Sans', sans-serif";
    pen.fillStyle = c.soft;
    pen.fillText(`${app.counts()} · ${byId("time").querySelector("output")?.textContent}`, 20, 52);
    const size = legendSize(app.legends, app.note);
    drawLegends(pen, app.legends, app.note, 20, height - 20 - size[1]);
    drawAxes(pen, app.camera, 60, height - 70 - size[1], height);
    app.change("camera");
    return new Promise((done, fail) => page.toBlob((/** @type {Blob | null} */ b) => (b ? done(b) : fail(new Error("The browser could not make the image."))), "image/png"));
}

/** @param {import("./page.js").Page} app */
export async function saveImage(app) {
    const url = URL.createObjectURL(await makeImage(app, 2)), name = (app.model.head?.title || "talus").replace(/[^A-Za-z0-9]+/g, "_").slice(0, 60);
    element("a", { href: url, download: `${name}_${app.view.frame}.png` }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
}
