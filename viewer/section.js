// The polygons in which a plane cuts the blocks as they are shown.
// @ts-check
import {cross, dot, planeNormal, turned, unit} from "./math.js";
import {faceName} from "./buffers.js";

/** @typedef {{row: number, place: number[], area: number, middle: number[]}} Cut */
/** @typedef {{normal: number[], position: number}} Plane points p with normal · p = position */

export const CAP_FACE = 126; // number of a section polygon among the faces of a block

/**
 * @param {number} dip degrees
 * @param {number} direction degrees
 * @param {number} position metres from the middle of the model along the upward normal
 * @param {number[]} middle
 * @returns {Plane}
 */
export function sectionPlane(dip, direction, position, middle) {
    const normal = planeNormal(dip, direction);
    return {normal, position: dot(normal, middle) + position};
}

/**
 * @param {import("./frames.js").Model} model
 * @param {Float32Array} place by row
 * @param {Float32Array} turn by row, 4 each
 * @param {Uint8Array} shown by row: 0 is left out
 * @param {Plane} plane
 * @returns {Cut[]}
 */
export function cutBlocks(model, place, turn, shown, plane) {
    const n = plane.normal, u = unit(Math.abs(n[2]) < 0.9 ? cross(n, [0, 0, 1]) : cross(n, [1, 0, 0])), v = cross(n, u);
    /** @type {Cut[]} */ const out = [];
    const distance = new Float64Array(65536);
    for (let row = 0; row < model.rows; row++) {
        const s = model.shape[row];
        const away = n[0] * place[3 * row] + n[1] * place[3 * row + 1] + n[2] * place[3 * row + 2] - plane.position;
        if (!shown[row] || Math.abs(away) > s.radius) continue;
        const local = turned([-turn[4 * row], -turn[4 * row + 1], -turn[4 * row + 2], turn[4 * row + 3]], 0, n);
        const {vertex, loop, vertices} = s.shapes;
        for (let i = 0, k = 3 * s.vertex; i < vertices[s.block]; i++, k += 3) {
            distance[i] = away + local[0] * vertex[k] + local[1] * vertex[k + 1] + local[2] * vertex[k + 2];
        }
        /** @type {number[][]} */ const points = []; // in the plane, and in the block's axes
        model.eachFace(row, (_f, corner, count) => {
            for (let i = 0; i < count; i++) {
                const a = loop[corner + i], b = loop[corner + (i + 1) % count];
                if (a > b || distance[a] > 0 === distance[b] > 0) continue; // the other face has the edge from b to a
                const t = distance[a] / (distance[a] - distance[b]), k = 3 * (s.vertex + a), m = 3 * (s.vertex + b);
                const p =
                    turned(turn, 4 * row, [0, 1, 2].map((c) => vertex[k + c] + t * (vertex[m + c] - vertex[k + c])));
                points.push([
                    dot(p, u), dot(p, v), p[0] + place[3 * row], p[1] + place[3 * row + 1], p[2] + place[3 * row + 2]
                ]);
            }
        });
        if (points.length < 3) continue;
        const x = points.reduce((t, p) => t + p[0], 0) / points.length;
        const y = points.reduce((t, p) => t + p[1], 0) / points.length;
        points.sort((a, b) => Math.atan2(a[1] - y, a[0] - x) - Math.atan2(b[1] - y, b[0] - x));
        let area = 0;
        const middle = [0, 0, 0];
        for (let i = 0; i < points.length; i++) {
            const a = points[i], b = points[(i + 1) % points.length];
            const part = ((a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x)) / 2;
            area += part;
            for (let c = 0; c < 3; c++) middle[c] += part * (a[c + 2] + b[c + 2]) / 3;
        }
        if (!(area > 0)) continue;
        // the fan's common corner has a third of each part
        const mean = [0, 1, 2].map((c) => points.reduce((t, p) => t + p[c + 2], 0) / points.length);
        out.push({
            row,
            area,
            place: points.flatMap((p) => p.slice(2)),
            middle: middle.map((m, c) => m / area + mean[c] / 3)
        });
    }
    return out;
}

/**
 * @param {Cut[]} cuts
 * @param {Uint8Array} colours by row
 * @param {number[]} normal
 * @returns {import("./buffers.js").Sheet[]}
 */
export function capSheets(cuts, colours, normal) {
    return cuts.map((c) => ({
                        place: c.place,
                        normal,
                        flat: true,
                        name: faceName(c.row, CAP_FACE),
                        colour: Array.from(colours.subarray(4 * c.row, 4 * c.row + 3))
                    }));
}
