// Stereonet, equal area, lower hemisphere: joint planes as great circles and poles, motions of the moving blocks,
// keyblocks, the circle of friction, and the joint pyramid of the picked block.
// @ts-check
import {byId} from "./dom.js";
import {category} from "./colours.js";
import {css, inks, penOf} from "./overlay.js";
import {add, areaOf, cross, dot, figure, norm, scale, trendPlunge, triple, turned, unit} from "./math.js";
import {pyramid, touchedFaces} from "./pyramid.js";

/** @typedef {{joint: number, plane: number, pole: number[], area: number}} JointPlane */

const SETS = 12;                   // names of sets that are written
const CIRCLES = 24, CONTOURS = 50; // great circles up to so many planes, contours of density from so many on

/**
 * Mean poles of the joints' planes, as their faces lie in a frame: of each joint and plane the sum of areas times
 * normals.
 * @param {import("./frames.js").Model} model
 * @param {import("./frames.js").Frame} frame
 * @returns {JointPlane[]}
 */
export function jointPlanes(model, frame) {
    /** @type {Map<string, JointPlane>} */ const planes = new Map();
    for (let i = 0; i < frame.poses.n; i++) {
        const row = frame.rows[i], s = model.shape[row], v = s.shapes.vertex, loop = s.shapes.loop;
        model.eachFace(row, (_f, corner, count, joint, plane) => {
            if (!joint) return;
            const n = turned(
                frame.poses.turn, 4 * i,
                areaOf(Array.from({length: count}, (_p, c) => triple(v, s.vertex + loop[corner + c]))));
            const key = `${joint}:${plane}`;
            const known = planes.get(key) ?? {joint, plane, pole: [0, 0, 0], area: 0};
            // both sides of a joint count: their normals are opposite
            known.pole =
                add(known.pole, dot(known.pole, n) < 0 || (norm(known.pole) === 0 && n[2] < 0) ? scale(n, -1) : n);
            known.area += norm(n) / 2;
            planes.set(key, known);
        });
    }
    return [...planes.values()].map((p) => ({...p, pole: unit(p.pole)}));
}

/** Place of a direction on the net, in radii; upward ones are turned round. @param {number[]} v */
export function onNet(v) {
    const d = v[2] > 0 ? scale(v, -1) : v, r = Math.sqrt(Math.max(0, 1 + d[2])), flat = Math.hypot(d[0], d[1]);
    return flat > 0 ? [d[0] / flat * r, -d[1] / flat * r] : [0, 0];
}

/**
 * Density of poles on a grid: smoothed by a cap of 1 % of the hemisphere (Fisher), as multiples of the uniform density.
 * @param {number[][]} poles
 * @param {number} side
 */
function density(poles, side) {
    const out = new Float32Array(side * side), kappa = 2 * (1 + poles.length / 9);
    for (let y = 0; y < side; y++) {
        for (let x = 0; x < side; x++) {
            const d = fromNet(2 * x / (side - 1) - 1, 2 * y / (side - 1) - 1);
            if (!d) continue;
            for (const p of poles) out[y * side + x] += Math.exp(kappa * (Math.abs(dot(p, d)) - 1));
            out[y * side + x] *= kappa / poles.length;
        }
    }
    return out;
}

/**
 * The friction of a joint, or of all joints with faces where they agree; else NaN.
 * @param {import("./scene.js").Head} head
 * @param {JointPlane[]} planes
 * @param {string} name
 */
function frictionOf(head, planes, name) {
    const all = new Set(name ? [head.friction[head.joints.indexOf(name)]] : planes.map((p) => head.friction[p.joint]));
    return all.size === 1 ? [...all][0] ?? NaN : NaN;
}

/**
 * A direction on the lower hemisphere at a place of the net, in radii; null beyond it.
 * @param {number} u
 * @param {number} v
 */
function fromNet(u, v) {
    const r2 = u * u + v * v, s = Math.sqrt(2 - r2);
    return r2 > 1 ? null : [u * s, -v * s, r2 - 1];
}

/**
 * The directions of a joint pyramid: shaded, the upward ones hatched, and bounded, degenerate ones by their bounds
 * alone.
 * @param {CanvasRenderingContext2D} pen
 * @param {import("./pyramid.js").Pyramid} cone
 * @param {number[][]} normals
 * @param {number} ox
 * @param {number} oy
 * @param {number} R
 */
function drawPyramid(pen, cone, normals, ox, oy, R) {
    for (const up of [false, true]) {
        for (let y = Math.ceil(-R); y < R; y += up ? 4 : 1) {
            let from = NaN;
            for (let x = Math.ceil(-R); x <= R + 1; x++) {
                const d = fromNet(x / R, y / R), inside = d !== null && cone.holds(up ? scale(d, -1) : d);
                if (inside && isNaN(from)) from = x;
                if (inside || isNaN(from)) continue;
                pen.globalAlpha = up ? 0.9 : 0.3;
                pen.fillRect(ox + from, oy + y, x - from, 1);
                from = NaN;
            }
        }
    }
    pen.globalAlpha = 1;
    for (const n of normals) {
        const a = unit(Math.abs(n[2]) < 0.9 ? cross(n, [0, 0, 1]) : cross(n, [1, 0, 0])), b = cross(n, a);
        for (let i = 0; i < 360; i++) {
            const t = i * Math.PI / 180, d = add(scale(a, Math.cos(t)), scale(b, Math.sin(t)));
            if (!cone.holds(d) || (d[2] > 0 && i % 6 > 2)) continue;
            const p = onNet(d);
            pen.fillRect(ox + R * p[0] - 1, oy + R * p[1] - 1, 2, 2);
        }
    }
    for (const d of cone.edges) {
        const p = onNet(d);
        pen.beginPath();
        pen.arc(ox + R * p[0], oy + R * p[1], 2.5, 0, 7);
        d[2] > 0 ? pen.stroke() : pen.fill();
    }
}

/**
 * Writes the names of the joint sets at the poles of their planes' means, of at most SETS of them, the largest first;
 * none over another.
 * @param {CanvasRenderingContext2D} pen
 * @param {JointPlane[]} planes
 * @param {string[]} names
 * @param {(v: number[]) => number[]} place
 * @param {number} side
 */
function nameSets(pen, planes, names, place, side) {
    /** @type {Map<number, {sum: number[], area: number}>} */ const sets = new Map();
    for (const p of planes) {
        const set = sets.get(p.joint) ?? {sum: [0, 0, 0], area: 0};
        set.sum = add(set.sum, scale(p.pole, dot(set.sum, p.pole) < 0 ? -p.area : p.area));
        set.area += p.area;
        sets.set(p.joint, set);
    }
    /** @type {number[][]} */ const taken = [];
    pen.font = "600 10px system-ui, sans-serif";
    pen.textBaseline = "middle";
    for (const [joint, set] of [...sets].sort((a, b) => b[1].area - a[1].area).slice(0, SETS)) {
        const at = place(unit(set.sum[2] < 0 ? scale(set.sum, -1) : set.sum));
        const text = names[joint].length > 12 ? `${names[joint].slice(0, 11)}…` : names[joint];
        const wide = pen.measureText(text).width;
        const x = at[0] + 7 + wide < side ? at[0] + 6 : at[0] - 6 - wide;
        const free = (/** @type {number} */ y) =>
            !taken.some((t) => Math.abs(t[1] - y) < 11 && x < t[2] && t[0] < x + wide);
        const y = [0, -11, 11].map((by) => at[1] + by).find(free);
        if (y === undefined) continue;
        taken.push([x, y, x + wide]);
        pen.textAlign = "left";
        pen.fillStyle = css(category(joint - 1));
        pen.fillText(text, x, y);
    }
}

/** @param {import("./page.js").Page} app */
export function makeStereonet(app) {
    const box = byId("net");
    const canvas = /** @type {HTMLCanvasElement} */ (box.querySelector("canvas"));
    const text = byId("nettext"), rubbed = byId("netfriction");
    /** @type {{x: number, y: number, joint: number, words: string}[]} */ let marks = [];
    let chosen = -1;

    /** @param {number} i */
    function choose(i) {
        chosen = i;
        const mark = marks[i], name = mark && app.frame ? app.frame.head.joints[mark.joint] : "";
        app.view.joint = name === app.view.joint || !mark ? "" : name;
        text.textContent = mark ? mark.words : "";
        app.change("colour");
    }

    canvas.onclick = (e) => {
        const r = canvas.getBoundingClientRect();
        let best = -1, near = 12;
        marks.forEach((m, i) => {
            const d = Math.hypot(m.x - (e.clientX - r.left), m.y - (e.clientY - r.top));
            if (d < near) {
                near = d;
                best = i;
            }
        });
        choose(best);
    };
    canvas.onkeydown = (e) => {
        const by = e.key === "ArrowRight" || e.key === "ArrowDown" ? 1
            : e.key === "ArrowLeft" || e.key === "ArrowUp"         ? -1
                                                                   : 0;
        if (!by || !marks.length) return;
        e.preventDefault();
        e.stopPropagation();
        app.view.joint = "";
        choose((chosen + by + marks.length) % marks.length);
    };

    return {
        update() {
            box.hidden = !app.view.net;
            const frame = app.frame;
            if (box.hidden || !frame) return;
            const side = 210, pen = penOf(canvas, side, side + 14), c = inks(), R = side / 2 - 4;
            const ox = side / 2, oy = side / 2 + 12;
            canvas.style.width = `${side}px`;
            canvas.style.height = `${side + 14}px`;
            const place = (/** @type {number[]} */ v) => {
                const p = onNet(v);
                return [ox + R * p[0], oy + R * p[1]];
            };
            const planes = jointPlanes(app.model, frame);
            pen.lineWidth = 0.6;
            pen.strokeStyle = c.line;
            for (const r of [1 / 3, 2 / 3]) {
                pen.beginPath();
                pen.arc(ox, oy, R * Math.sqrt(2) * Math.sin(r * Math.PI / 4), 0, 7);
                pen.stroke();
            }
            for (let i = 0; i < 6; i++) {
                const a = i * Math.PI / 6;
                pen.beginPath();
                pen.moveTo(ox - R * Math.cos(a), oy - R * Math.sin(a));
                pen.lineTo(ox + R * Math.cos(a), oy + R * Math.sin(a));
                pen.stroke();
            }
            if (planes.length >= CONTOURS) {
                const grid = 53, d = density(planes.map((p) => p.pole), grid),
                      most = d.reduce((a, b) => Math.max(a, b), 0);
                pen.fillStyle = c.soft;
                for (let i = 0; i < d.length; i++) {
                    pen.globalAlpha = 0.5 * Math.floor(d[i] / most * 6) / 6;
                    if (d[i] > 0)
                        pen.fillRect(
                            ox + R * (2 * (i % grid) / (grid - 1) - 1) - R / grid,
                            oy + R * (2 * Math.floor(i / grid) / (grid - 1) - 1) - R / grid, 2 * R / grid,
                            2 * R / grid);
                }
                pen.globalAlpha = 1;
            }
            const picked = app.picks();
            const normals = picked.length === 1 ? touchedFaces(app.model, frame, picked[0]) : null;
            const cone = normals && pyramid(normals);
            pen.fillStyle = pen.strokeStyle = c.accent;
            if (cone && !cone.empty) drawPyramid(pen, cone, normals ?? [], ox, oy, R);
            const phi = frictionOf(frame.head, planes, app.view.joint);
            pen.strokeStyle = c.ink;
            pen.lineWidth = 1.2;
            for (const [angle, dash] of /** @type {[number, number[]][]} */ (
                     [[90, []], [90 - phi, []], [phi, [3, 3]]])) {
                pen.beginPath();
                pen.setLineDash(dash);
                if (angle > 0) pen.arc(ox, oy, R * Math.sqrt(2) * Math.sin(angle * Math.PI / 360), 0, 7);
                pen.stroke();
            }
            pen.setLineDash([]);
            pen.fillStyle = c.ink;
            pen.font = "600 11px system-ui, sans-serif";
            pen.textAlign = "center";
            pen.textBaseline = "bottom";
            pen.fillText("N", ox, oy - R - 1);
            marks = [];
            const one = new Map();
            for (const p of planes) one.set(p.joint, (one.get(p.joint) ?? 0) + 1);
            for (const p of planes) {
                const colour = css(category(p.joint - 1)), name = frame.head.joints[p.joint];
                const lit = app.view.joint === name;
                const up = p.pole[2] < 0 ? scale(p.pole, -1) : p.pole;
                pen.globalAlpha = app.view.joint && !lit ? 0.25 : 1;
                if (planes.length <= CIRCLES || lit) {
                    const strike = unit(cross([0, 0, 1], up)), down = cross(up, strike);
                    pen.beginPath();
                    for (let i = 0; i <= 60; i++) {
                        const a = Math.PI * i / 60;
                        const v = add(scale(strike, Math.cos(a)), scale(down, -Math.sin(a)));
                        const at = place(down[2] > 0 ? v : add(scale(strike, Math.cos(a)), scale(down, Math.sin(a))));
                        i ? pen.lineTo(at[0], at[1]) : pen.moveTo(at[0], at[1]);
                    }
                    pen.strokeStyle = colour;
                    pen.lineWidth = lit ? 2 : 1;
                    pen.stroke();
                }
                const at = place(up), tp = trendPlunge(scale(up, -1)), dip = 90 - tp.plunge;
                const direction = (tp.trend + 180) % 360;
                pen.fillStyle = colour;
                pen.beginPath();
                pen.arc(at[0], at[1], lit ? 4.5 : 3, 0, 7);
                pen.fill();
                const numbered = (one.get(p.joint) ?? 0) > 1 ? ` ${p.plane}` : "";
                const towards = String(Math.round(direction) % 360).padStart(3, "0");
                const words = `${name}${numbered}: dip ${Math.round(dip)}°, dip direction ${towards}°`;
                marks.push({x: at[0], y: at[1], joint: p.joint, words});
            }
            pen.globalAlpha = 1;
            nameSets(pen, planes, frame.head.joints, (v) => place(v), side);
            let moving = 0;
            const least = app.threshold(), d = frame.poses.displacement;
            pen.lineWidth = 1.4;
            for (let i = 0; i < frame.poses.n; i++) {
                const v = triple(d, i);
                if (norm(v) < least) continue;
                const at = place(unit(v)), picked = frame.poses.id[i] === app.view.picked, s = picked ? 5 : 3;
                moving++;
                pen.strokeStyle = picked ? c.accent : c.warm;
                pen.beginPath();
                if (v[2] > 0) pen.arc(at[0], at[1], s, 0, 7); // upward
                else {
                    pen.moveTo(at[0] - s, at[1] - s);
                    pen.lineTo(at[0] + s, at[1] + s);
                    pen.moveTo(at[0] + s, at[1] - s);
                    pen.lineTo(at[0] - s, at[1] + s);
                }
                pen.stroke();
            }
            const keys = frame.data.keys;
            for (let i = 0; keys && i < keys.n; i++) {
                const v = triple(keys.direction, i);
                if (keys.mode[i] === 0 || norm(v) === 0) continue;
                const at = place(unit(v));
                pen.strokeStyle = c.ink;
                pen.strokeRect(at[0] - 4, at[1] - 4, 8, 8);
            }
            let body = "";
            if (picked.length === 1 && frame.poses.id.includes(picked[0]))
                body = `Block ${picked[0]} ` +
                    (!normals?.length  ? "lies on no other."
                         : cone?.empty ? "cannot move: its joint pyramid is empty."
                                       : "can move where it is shaded, upward where hatched.");
            const steeper = "steeper motions lie in the circle, poles of steeper planes out of the dashed one.";
            const rub = phi >= 0 ? `Friction ${figure(phi)}°: ${steeper}` : "";
            const words =
                `${planes.length} joint planes, ${moving} moving blocks${keys ? `, ${keys.n} keyblocks` : ""}`;
            canvas.setAttribute(
                "aria-label",
                `Stereonet, lower hemisphere, equal area: ${words}. ${rub} ${body} Arrow keys choose a pole.`);
            canvas.title = rub;
            if (!app.view.joint && chosen < 0)
                text.textContent =
                    body || (keys?.n ? "× motion, □ keyblock, ● pole" : "× motion, ● pole; lower hemisphere");
            rubbed.textContent = rub;
        }
    };
}
