// The joint pyramid of a block: the directions into which it can move, all others at rest (Goodman and Shi 1985).
// @ts-check
import { below } from "./glyphs.js";
import { add, areaOf, dot, cross, norm, scale, sub, turned, triple, unit } from "./math.js";

/** @typedef {import("./frames.js").Frame} Frame */
/** @typedef {import("./frames.js").Model} Model */
/** @typedef {{edges: number[][], empty: boolean, holds: (d: number[]) => boolean}} Pyramid edges: where its faces meet; empty: it holds no direction */

const ALONG = 1e-4;    // sine within which directions are the same, and lie in a face: above single precision
const FLUSH = 0.9998;  // cosine from which two faces lie on each other
const GAP = 1e-4, OVERLAP = 1e-2; // of the blocks' size: how far they may be apart, and within each other
const SHARED = 1e-4;   // of the smaller face: least part that they share

/** The faces of a block as they lie in a frame. @param {Model} model @param {Frame} frame @param {number} i */
function placedFaces(model, frame, i) {
    const row = frame.rows[i], s = model.shape[row], place = triple(frame.poses.place, i);
    /** @type {{points: number[][], area: number, normal: number[]}[]} */ const out = [];
    model.eachFace(row, (_f, corner, count) => {
        const points = Array.from({ length: count }, (_p, c) => add(place, turned(frame.poses.turn, 4 * i, triple(s.shapes.vertex, s.vertex + s.shapes.loop[corner + c])))), n = areaOf(points);
        out.push({ points, area: norm(n), normal: unit(n) });
    });
    return out;
}

/** Outward normals of the faces of a block's body that lie on faces of other bodies. @param {Model} model @param {Frame} frame @param {number} id */
export function touchedFaces(model, frame, id) {
    const { n, place, id: ids } = frame.poses, size = frame.head.size, shape = (/** @type {number} */ i) => model.shape[frame.rows[i]];
    const body = (/** @type {number} */ i) => shape(i).shapes.body[shape(i).block], own = ids.indexOf(id);
    /** @type {number[]} */ const mine = [], others = /** @type {number[]} */ ([]);
    /** @type {number[][]} */ const out = [];
    for (let i = 0; own >= 0 && i < n; i++) (body(i) === body(own) ? mine : others).push(i);
    for (const i of mine) {
        const faces = placedFaces(model, frame, i);
        for (const k of others) {
            if (norm(sub(triple(place, i), triple(place, k))) > shape(i).radius + shape(k).radius + GAP * size) continue;
            for (const b of placedFaces(model, frame, k)) {
                for (const a of faces) {
                    const cosine = dot(a.normal, b.normal);
                    if (cosine > -FLUSH || out.some((o) => norm(sub(o, a.normal)) <= ALONG)) continue;
                    let rest = a.points;
                    b.points.forEach((p, c) => {
                        const normal = cross(sub(b.points[(c + 1) % b.points.length], p), b.normal);
                        rest = below(rest, { normal, position: dot(normal, p) });
                    });
                    // where they share area: other corners of large faces may be far apart
                    const gap = Math.min(...rest.map((p) => dot(b.normal, sub(b.points[0], p)) / cosine / size));
                    if (gap <= GAP && gap >= -OVERLAP && norm(areaOf(rest)) > SHARED * Math.min(a.area, b.area)) out.push(a.normal);
                }
            }
        }
    }
    return out;
}

/** The directions d with d · n <= 0 for all normals n. @param {number[][]} normals @returns {Pyramid} */
export function pyramid(normals) {
    const holds = (/** @type {number[]} */ d, a = -1, b = -1) => normals.every((n, k) => k === a || k === b || dot(d, n) <= ALONG);
    /** @type {number[][]} */ const edges = [];
    let parallel = true;
    normals.forEach((n, i) => {
        for (let k = 0; k < i; k++) {
            const line = cross(n, normals[k]);
            if (norm(line) <= ALONG) continue;
            parallel = false;
            for (const d of [unit(line), unit(scale(line, -1))]) if (holds(d, i, k) && !edges.some((e) => norm(sub(e, d)) <= ALONG)) edges.push(d);
        }
    });
    // a cone that holds more than zero has an edge, or all its normals are parallel
    return { edges, empty: !edges.length && !parallel, holds: (d) => holds(d) };
}
