// What is drawn flat over the picture: legends, scale bar, axes; the same in the window and in an exported image.
// @ts-check
import {figure} from "./math.js";
import {ramp, QUIET} from "./colours.js";

/** @typedef {CanvasRenderingContext2D} Pen */
/** @typedef {import("./colours.js").Legend} Legend */

export const FONT = "system-ui, 'DejaVu Sans', sans-serif";
const LIST = 14; // entries of a legend

/** The colours of the page, by the names they have in its style. @returns {Record<string, string>} */
export function inks() {
    const style = getComputedStyle(document.documentElement);
    return Object.fromEntries(["ink", "soft", "line", "top", "low", "accent", "warm", "east", "north"].map(
        (n) => [n, style.getPropertyValue(`--${n}`).trim()]));
}

/** @param {number[]} c */
export function css(c) { return `rgb(${c[0]},${c[1]},${c[2]})`; }

/** Width and height of legends drawn one under the other. @param {Legend[]} legends @param {string} note */
export function legendSize(legends, note) {
    let height = 0;
    for (const l of legends)
        height += l.kind === "scale" ? 58 : l.kind === "text" ? 40 : 26 + 18 * Math.min(LIST + 1, l.items.length);
    return [182, height + (note ? 18 : 0)];
}

/** @param {Pen} pen @param {Legend[]} legends @param {string} note @param {number} x @param {number} y */
export function drawLegends(pen, legends, note, x, y) {
    const {ink, soft} = inks();
    pen.textBaseline = "alphabetic";
    for (const l of legends) {
        pen.textAlign = "left";
        pen.fillStyle = ink;
        pen.font = `600 12px ${FONT}`;
        pen.fillText(l.title, x, y + 14, 182);
        pen.font = `11px ${FONT}`;
        if (l.kind === "scale") {
            for (let i = 0; i < 180; i++) {
                pen.fillStyle =
                    css(l.low + i / 179 * (l.high - l.low) <= (l.grey ?? -Infinity) ? QUIET : ramp(l.ramp, i / 179));
                pen.fillRect(x + i, y + 22, 1.5, 11);
            }
            pen.fillStyle = ink;
            [0, 0.5, 1].forEach((t) => {
                const value = l.log ? l.low * Math.pow(l.high / l.low, t) : l.low + t * (l.high - l.low);
                pen.textAlign = t === 0 ? "left" : t === 1 ? "right" : "center";
                pen.fillText(figure(value), x + t * 180, y + 47);
            });
            y += 58;
        } else if (l.kind === "text") {
            pen.fillStyle = soft;
            pen.fillText(l.text, x, y + 30, 182);
            y += 40;
        } else {
            const rest = l.items.length - LIST;
            l.items.slice(0, rest > 0 ? LIST : LIST + 1).forEach((item, i) => {
                pen.fillStyle = css(item.colour);
                pen.fillRect(x, y + 22 + 18 * i, 14, 12);
                pen.strokeStyle = soft;
                pen.lineWidth = 0.7;
                pen.strokeRect(x, y + 22 + 18 * i, 14, 12);
                pen.fillStyle = ink;
                pen.fillText(item.name, x + 21, y + 32 + 18 * i, 160);
            });
            pen.fillStyle = soft;
            if (rest > 0) pen.fillText(`and ${rest} more`, x + 21, y + 32 + 18 * LIST);
            y += 26 + 18 * Math.min(LIST + 1, l.items.length);
        }
    }
    pen.textAlign = "left";
    pen.fillStyle = ink;
    if (note) pen.fillText(note, x, y + 12, 182);
}

/** A length that is 1, 2 or 5 times a power of ten, at most `most`. @param {number} most */
function roundLength(most) {
    const ten = Math.pow(10, Math.floor(Math.log10(most)));
    return ten * (most / ten >= 5 ? 5 : most / ten >= 2 ? 2 : 1);
}

/**
 * Axes and scale bar.
 * @param {Pen} pen
 * @param {import("./camera.js").Camera} camera
 * @param {number} x
 * @param {number} y of the axes' origin
 * @param {number} height of the window
 */
export function drawAxes(pen, camera, x, y, height) {
    const c = inks(), {right, up, forward} = camera.axes();
    pen.lineWidth = 2.5;
    pen.lineCap = "round";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.font = `600 12px ${FONT}`;
    const axes = [
        {name: "E", v: [1, 0, 0], colour: c.east}, {name: "N", v: [0, 1, 0], colour: c.north},
        {name: "up", v: [0, 0, 1], colour: c.accent}
    ];
    const flat = axes.map((a) => ({
                              ...a,
                              x: right[0] * a.v[0] + right[1] * a.v[1],
                              y: -(up[0] * a.v[0] + up[1] * a.v[1] + up[2] * a.v[2]),
                              deep: forward[0] * a.v[0] + forward[1] * a.v[1] + forward[2] * a.v[2]
                          }));
    for (const a of flat.sort((p, q) => q.deep - p.deep)) {
        const length = Math.hypot(a.x, a.y);
        pen.strokeStyle = pen.fillStyle = a.colour;
        pen.beginPath();
        pen.moveTo(x, y);
        pen.lineTo(x + 30 * a.x, y + 30 * a.y);
        pen.stroke();
        if (length > 0.25) pen.fillText(a.name, x + (30 + 12 / length) * a.x, y + (30 + 10 / length) * a.y);
        else {
            pen.beginPath();
            pen.arc(x, y, 3.5, 0, 7);
            pen.fill();
            pen.fillText(a.name, x - 12, y + 12);
        }
    }
    const metres = roundLength(110 / camera.perMetre(height)), long = metres * camera.perMetre(height);
    pen.strokeStyle = pen.fillStyle = c.ink;
    pen.lineWidth = 1.2;
    pen.beginPath();
    pen.moveTo(x + 62, y + 8);
    pen.lineTo(x + 62, y + 14);
    pen.lineTo(x + 62 + long, y + 14);
    pen.lineTo(x + 62 + long, y + 8);
    pen.stroke();
    pen.font = `12px ${FONT}`;
    pen.fillText(
        metres < 0.01 ? `${figure(metres * 1000)} mm`
            : metres < 1 ? `${figure(metres * 100)} cm`
            : metres >= 1000 ? `${figure(metres / 1000)} km`
                             : `${figure(metres)} m`,
        x + 62 + long / 2, y + 26);
}

/**
 * A canvas for crisp drawing in its size on the page.
 * @param {HTMLCanvasElement} canvas
 * @param {number} width
 * @param {number} height
 * @returns {Pen}
 */
export function penOf(canvas, width, height) {
    const ratio = Math.min(3, globalThis.devicePixelRatio || 1);
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
    }
    const pen = /** @type {Pen} */ (canvas.getContext("2d"));
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    return pen;
}
