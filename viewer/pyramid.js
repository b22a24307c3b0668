// The joint pyramid of a block: the directions into which it can move, all others at rest (Goodman and Shi 1985).
// @ts-check
import {cross, dot, norm, scale, sub, triple, unit} from "./math.js";

/** @typedef {import("./frames.js").Frame} Frame */
/** @typedef {import("./frames.js").Model} Model */
/**
 * @typedef {{edges: number[][], empty: boolean, holds: (d: number[]) => boolean}} Pyramid edges: where its faces meet;
 *   empty: it holds no direction
 */

const ALONG = 1e-4; // sine within which directions are the same, and lie in a face: above single precision

/**
 * Outward normals of the faces of a block's body that lie on faces of other bodies, as the program has found them.
 * @param {Model} model
 * @param {Frame} frame
 * @param {number} id
 */
export function touchedFaces(model, frame, id) {
    const at = frame.poses.id.indexOf(id), {touches} = frame;
    /** @type {number[][]} */ const out = [];
    if (at < 0 || !touches) return out;
    const {shapes, block} = model.shape[frame.rows[at]], body = shapes.body[block];
    for (let k = touches.body.indexOf(body); k >= 0 && k < touches.n && touches.body[k] === body; k++)
        out.push(triple(touches.normal, k));
    return out;
}

/** The directions d with d · n <= 0 for all normals n. @param {number[][]} normals @returns {Pyramid} */
export function pyramid(normals) {
    const holds = (/** @type {number[]} */ d, a = -1, b = -1) =>
        normals.every((n, k) => k === a || k === b || dot(d, n) <= ALONG);
    /** @type {number[][]} */ const edges = [];
    let parallel = true;
    normals.forEach((n, i) => {
        for (let k = 0; k < i; k++) {
            const line = cross(n, normals[k]);
            if (norm(line) <= ALONG) continue;
            parallel = false;
            for (const d of [unit(line), unit(scale(line, -1))])
                if (holds(d, i, k) && !edges.some((e) => norm(sub(e, d)) <= ALONG)) edges.push(d);
        }
    });
    // a cone that holds more than zero has an edge, or all its normals are parallel
    return {edges, empty: !edges.length && !parallel, holds: (d) => holds(d)};
}
