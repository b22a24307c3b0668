// Where the blocks of a frame are shown, and how: motion enlarged, model exploded, blocks hidden or as ghosts, cut by
// the section.
// @ts-check
import {showsWalls} from "./elements.js";
import {add, dot, norm, scale, sub, triple, turnAfter} from "./math.js";
import {rowsOf, shownPoints} from "./zones.js";

/** @typedef {import("./frames.js").Model} Model */
/** @typedef {import("./frames.js").Frame} Frame */
/**
 * @typedef {{place: Float32Array, turn: Float32Array, kind: Uint8Array, table: Float32Array, ghosts: boolean,
 *   bounds: import("./camera.js").Bounds, middle: number[], zoned: Uint8Array, points: Float32Array | null,
 *   meshRow: Int32Array, pointStart: number[]}} Shown by row; kind: 0 not there, 1 solid, 2 ghost; the table goes to
 * the picture; zoned: 1 where it is drawn by its mesh, whose gridpoints are at `points`
 */

/**
 * A turn with the block's rotation since the start enlarged.
 * @param {Float32Array} turn
 * @param {Float32Array} rotation vector
 * @param {number} i
 * @param {number} factor
 */
function enlarged(turn, rotation, i, factor) {
    const q = [turn[4 * i], turn[4 * i + 1], turn[4 * i + 2], turn[4 * i + 3]], r = triple(rotation, i);
    const angle = norm(r), half = angle * (factor - 1) / 2;
    if (angle < 1e-12 || factor === 1) return q;
    return turnAfter([...scale(r, Math.sin(half) / angle), Math.cos(half)], q);
}

/** @param {Model} model @param {Frame} frame @param {import("./view.js").View} view @returns {Shown} */
export function showFrame(model, frame, view) {
    const place = new Float32Array(3 * model.rows), turn = new Float32Array(4 * model.rows);
    const kind = new Uint8Array(model.rows), table = new Float32Array(8 * model.rows);
    const p = frame.poses, box = {min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity]};
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < 3 * p.n; i++) {
        low[i % 3] = Math.min(low[i % 3], p.place[i]);
        high[i % 3] = Math.max(high[i % 3], p.place[i]);
    }
    const middle = p.n ? scale(add(low, high), 0.5) : [0, 0, 0], threshold = view.moved;
    // contacts and walls lie within the model: unless a section shows them, blocks are transparent then
    const within = view.contacts !== "" || showsWalls(frame, view.elements);
    const clear = view.solid === "no" || (view.solid === "" && within && !view.cut && view.explode === 0);
    let ghosts = false;
    for (let i = 0; i < p.n; i++) {
        const row = frame.rows[i], id = p.id[i], k = 3 * i;
        const d = Math.hypot(p.displacement[k], p.displacement[k + 1], p.displacement[k + 2]);
        const still = (threshold > 0 && d < threshold) || clear || view.ghosts.has(id) ||
            (view.only.size > 0 && !view.only.has(id));
        const hidden = view.hidden.has(id) || (p.flags[i] & 2) > 0 || (still && view.opacity === 0);
        kind[row] = hidden ? 0 : still ? 2 : 1;
        ghosts ||= kind[row] === 2;
        for (let c = 0; c < 3; c++) {
            place[3 * row + c] = p.place[k + c] + (view.motion - 1) * p.displacement[k + c] +
                view.explode * (p.place[k + c] - middle[c]);
            const radius = model.shape[row].radius;
            if (kind[row] === 0) continue;
            box.min[c] = Math.min(box.min[c], place[3 * row + c] - radius);
            box.max[c] = Math.max(box.max[c], place[3 * row + c] + radius);
        }
        const q = enlarged(p.turn, p.rotation, i, view.motion), length = Math.hypot(...q) || 1;
        for (let c = 0; c < 4; c++) turn[4 * row + c] = q[c] / length;
    }
    if (!(box.max[0] >= box.min[0])) {
        box.min = [-1, -1, -1];
        box.max = [1, 1, 1];
    }
    const zoned = new Uint8Array(model.rows), points = shownPoints(model, frame, view, middle);
    const surface = points ? frame.surface : null;
    const meshRow = surface ? rowsOf(model, frame, surface.body) : new Int32Array(0), pointStart = [0];
    for (const id of new Set(surface?.block ?? [])) zoned[Math.max(0, model.rowOf(id, frame.since))] = 1;
    for (const count of surface?.points ?? []) pointStart.push(pointStart[pointStart.length - 1] + count);
    const shown = {place, turn, kind, table, ghosts, bounds: box, middle, zoned, points, meshRow, pointStart};
    fillTable(model, shown, null);
    return shown;
}

/**
 * The numbers that the picture reads; with a plane, blocks on its upper side are left out and those it goes through are
 * cut.
 * @param {Model} model
 * @param {Shown} shown
 * @param {import("./section.js").Plane | null} plane side that is kept: normal · p < position
 */
export function fillTable(model, shown, plane) {
    const {place, turn, kind, table} = shown;
    for (let row = 0; row < model.rows; row++) {
        const radius = model.shape[row].radius, sign = turn[4 * row + 3] < 0 ? -1 : 1;
        let group = shown.zoned[row] ? 0 : kind[row];
        if (plane && group) {
            const away = dot(plane.normal, triple(place, row)) - plane.position;
            group = away > radius ? 0 : away > -radius ? group + 4 : group;
        }
        table.set(
            [
                place[3 * row], place[3 * row + 1], place[3 * row + 2], group, sign * turn[4 * row],
                sign * turn[4 * row + 1], sign * turn[4 * row + 2], radius
            ],
            8 * row);
    }
}

/**
 * The box about the vertices of blocks as they are shown.
 * @param {Model} model
 * @param {Shown} shown
 * @param {(row: number) => boolean} wanted
 * @returns {import("./camera.js").Bounds | null}
 */
export function tightBox(model, shown, wanted) {
    const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
    for (let m = 0; shown.points && m < shown.meshRow.length; m++) {
        const row = shown.meshRow[m];
        if (row < 0 || !shown.kind[row] || !wanted(row)) continue;
        for (let k = 3 * shown.pointStart[m]; k < 3 * shown.pointStart[m + 1]; k++) {
            min[k % 3] = Math.min(min[k % 3], shown.points[k]);
            max[k % 3] = Math.max(max[k % 3], shown.points[k]);
        }
    }
    for (let row = 0; row < model.rows; row++) {
        if (shown.zoned[row] || !shown.kind[row] || !wanted(row)) continue;
        const s = model.shape[row], q = shown.turn, o = 4 * row;
        const x = q[o], y = q[o + 1], z = q[o + 2], w = q[o + 3];
        for (let i = 0, k = 3 * s.vertex; i < s.shapes.vertices[s.block]; i++, k += 3) {
            const a = s.shapes.vertex[k], b = s.shapes.vertex[k + 1], c = s.shapes.vertex[k + 2];
            const tx = 2 * (y * c - z * b), ty = 2 * (z * a - x * c), tz = 2 * (x * b - y * a);
            const p = [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
            for (let m = 0; m < 3; m++) {
                const v = p[m] + shown.place[3 * row + m];
                if (v < min[m]) min[m] = v;
                if (v > max[m]) max[m] = v;
            }
        }
    }
    return max[0] >= min[0] ? {min, max} : null;
}

/** How far a block is shown from where it is. @param {Frame} frame @param {Shown} shown @param {number} row */
export function offset(frame, shown, row) {
    const i = frame.at[row], p = frame.poses.place;
    return i < 0 ? [0, 0, 0] : sub(triple(shown.place, row), triple(p, i));
}
