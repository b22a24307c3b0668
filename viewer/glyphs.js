// Arrows and contact polygons.
// @ts-check
import {add, cross, dot, norm, scale, sub, triple, unit} from "./math.js";
import {offset} from "./poses.js";

/** @typedef {import("./buffers.js").Arrow} Arrow */

// names in the picture: the highest bits tell contacts, elements and arrows from blocks
const CONTACT = 0x80000000, ARROW = 0xc0000000;
export const ELEMENT = 0xa0000000;
const INKS = [[16, 30, 66], [150, 205, 255]], PUSHES = [[120, 20, 90], [255, 150, 220]]; // light, dark
const TRACE = 0.03; // width of a contact's trace in a section, as a share of the blocks' size
const LEAST = 0.02; // arrows shorter than this share of the longest are left out

/**
 * What a name in the picture stands for.
 * @param {number} name
 * @returns {{kind: "none" | "block" | "contact" | "element" | "arrow", index: number, face: number}}
 */
export function named(name) {
    if (name === 0xffffffff) return {kind: "none", index: -1, face: -1};
    if (name >= ARROW) return {kind: "arrow", index: name - ARROW, face: -1};
    if (name >= ELEMENT) return {kind: "element", index: name - ELEMENT, face: -1};
    if (name >= CONTACT) return {kind: "contact", index: name - CONTACT, face: -1};
    return {kind: "block", index: name & 0xffffff, face: Math.floor(name / 0x1000000)};
}

/**
 * The part of a convex polygon below a plane. Corners may have more numbers than their places.
 * @param {number[][]} corners
 * @param {import("./section.js").Plane} plane
 */
export function below(corners, plane) {
    /** @type {number[][]} */ const out = [];
    corners.forEach((a, i) => {
        const b = corners[(i + 1) % corners.length], x = dot(plane.normal, a) - plane.position;
        const y = dot(plane.normal, b) - plane.position;
        if (x <= 0) out.push(a);
        if (x <= 0 !== y <= 0) out.push(a.map((v, c) => v + (b[c] - v) * x / (x - y)));
    });
    return out;
}

/**
 * Where a polygon goes through a plane: a strip in it, towards who looks.
 * @param {number[][]} corners
 * @param {import("./section.js").Plane} plane
 * @param {number} wide
 */
function trace(corners, plane, wide) {
    /** @type {number[][]} */ const ends = [];
    corners.forEach((a, i) => {
        const b = corners[(i + 1) % corners.length], x = dot(plane.normal, a) - plane.position;
        const y = dot(plane.normal, b) - plane.position;
        if (x <= 0 !== y <= 0) ends.push(add(a, add(scale(sub(b, a), x / (x - y)), scale(plane.normal, wide / 20))));
    });
    if (ends.length !== 2) return [];
    const side = scale(unit(cross(plane.normal, sub(ends[1], ends[0]))), wide / 2);
    return [add(ends[0], side), sub(ends[0], side), sub(ends[1], side), add(ends[1], side)].flat();
}

/**
 * The contacts' polygons, and their traces in a section.
 * @param {import("./frames.js").Model} model
 * @param {import("./frames.js").Frame} frame
 * @param {import("./poses.js").Shown} shown
 * @param {(i: number) => number[]} colour
 * @param {import("./section.js").Plane | null} plane what lies above it is left out
 * @param {string} joint of which, or ""
 * @returns {import("./buffers.js").Sheet[]}
 */
export function contactSheets(model, frame, shown, colour, plane, joint) {
    const k = frame.data.contacts, out = [];
    for (let p = 0, corner = 0; k && p < k.contact.length; corner += k.corners[p++]) {
        const i = k.contact[p];
        const rows =
            [model.rowOf(k.a[i], frame.since), model.rowOf(k.b[i], frame.since)].filter((r) => r >= 0 && shown.kind[r]);
        if (!rows.length || (joint !== "" && frame.head.joints[k.joint[i]] !== joint)) continue;
        const away = scale(rows.map((r) => offset(frame, shown, r)).reduce(add), 1 / rows.length), whole = [];
        for (let c = corner; c < corner + k.corners[p]; c++) whole.push(add(triple(k.corner, c), away));
        const place = plane ? below(whole, plane).flat() : whole.flat();
        if (place.length > 6)
            out.push({place, normal: triple(k.normal, i), colour: colour(i), flat: false, name: CONTACT + i});
        const strip = plane ? trace(whole, plane, frame.head.size * TRACE) : [];
        if (strip.length)
            out.push({
                place: strip,
                normal: /** @type {import("./section.js").Plane} */ (plane).normal,
                colour: colour(i),
                flat: true,
                name: CONTACT + i
            });
    }
    return out;
}

/**
 * Arrows with a common scale: the longest has the given length, or its own when `factor` of the true length is longer.
 * @param {{at: number[], way: number[], colour: number[], ends: boolean}[]} list
 * @param {number} longest
 * @param {number} factor
 */
function arrowsOf(list, longest, factor) {
    const most = list.reduce((m, a) => Math.max(m, norm(a.way)), 0);
    const times = factor > 0 && most * factor > longest * 0.4 ? factor : most > 0 ? longest / most : 1;
    /** @type {Arrow[]} */ const arrows = [];
    for (const a of list) {
        const length = norm(a.way);
        if (length < LEAST * most || length === 0) continue;
        const way = scale(a.way, times), tail = a.ends ? sub(a.at, way) : a.at;
        arrows.push({
            tail,
            way,
            width: longest * 0.09 * Math.min(1, 0.15 + 1.3 * length * times / longest),
            colour: a.colour,
            name: ARROW + arrows.length
        });
    }
    return {arrows, times, most};
}

/**
 * Arrows of a frame: "displacement", "velocity" of blocks, "force" of contacts. With a section: of the cut blocks only,
 * in its plane.
 * @param {import("./frames.js").Model} model
 * @param {import("./frames.js").Frame} frame
 * @param {import("./poses.js").Shown} shown
 * @param {string} what
 * @param {number} motion
 * @param {import("./section.js").Plane | null} plane
 * @param {import("./section.js").Cut[]} cuts
 * @param {boolean} dark
 */
export function arrowsFor(model, frame, shown, what, motion, plane, cuts, dark) {
    const size = frame.head.size, p = frame.poses, list = [], colour = (what === "force" ? PUSHES : INKS)[Number(dark)];
    const flat = (/** @type {number[]} */ v) => (plane ? sub(v, scale(plane.normal, dot(v, plane.normal))) : v);
    if (what === "force") {
        const k = frame.data.contacts;
        for (let i = 0; k && i < k.n; i++) {
            const b = model.rowOf(k.b[i], frame.since), a = model.rowOf(k.a[i], frame.since), at = triple(k.point, i);
            if (b < 0 || !(shown.kind[b] || (a >= 0 && shown.kind[a]))) continue;
            if (plane && Math.abs(dot(plane.normal, at) - plane.position) > size / 2) continue;
            list.push({at: add(at, offset(frame, shown, b)), way: flat(triple(k.force, i)), colour, ends: false});
        }
        return arrowsOf(list, size * 1.2, 0);
    }
    const column = what === "velocity" ? p.velocity : p.displacement;
    const middles = plane ? cuts.map((c) => ({row: c.row, at: c.middle}))
                          : Array.from(frame.rows, (row) => ({row, at: triple(shown.place, row)}));
    for (const {row, at} of middles) {
        const i = frame.at[row];
        if (i < 0 || !shown.kind[row]) continue;
        list.push({at, way: flat(triple(column, i)), colour, ends: what === "displacement"});
    }
    return arrowsOf(list, size, what === "displacement" ? Math.max(1, motion) : 0);
}

/**
 * Direction of the sum of the displacements of the blocks that moved, weighted by volume.
 * @param {import("./frames.js").Model} model
 * @param {import("./frames.js").Frame} frame
 * @param {number} least displacement
 */
export function meanMotion(model, frame, least) {
    let sum = [0, 0, 0], volume = 0, count = 0;
    const d = frame.poses.displacement, ids = new Set();
    for (let i = 0; i < frame.poses.n; i++) {
        const v = triple(d, i), s = model.shape[frame.rows[i]];
        if (norm(v) < least) continue;
        sum = add(sum, scale(v, s.shapes.volume[s.block]));
        volume += s.shapes.volume[s.block];
        count++;
        ids.add(frame.poses.id[i]);
    }
    return {direction: unit(sum), volume, count, ids};
}
