// Deformable blocks: numbers of their zones, where their gridpoints are shown, and what of them goes into the picture.
// @ts-check
import {CAP_FACE} from "./section.js";
import {add, cross, dot, norm, scale, sub, triple, unit} from "./math.js";
import {faceName, makeMesh} from "./buffers.js";

/** @typedef {import("./scene.js").Surface} Surface */
/** @typedef {import("./frames.js").Model} Model */
/** @typedef {import("./frames.js").Frame} Frame */
/**
 * @typedef {{place: number[], from: number[], share: number[], zone: number[], row: number[]}} ZoneCut triangles of a
 *   section: places of the corners, the two gridpoints between which each corner lies, and its share of the second
 */
/**
 * @typedef {{points: Uint8Array | null, zones: Uint8Array | null, blocks: Uint8Array, faces: number[][] | null,
 *   own: boolean}} Paint colours by gridpoint, by zone or by row of the block, three or four bytes each; `faces`: of
 *   joints. `own`: blocks may have a colour of their own that goes before
 */

const STRESS = ["stress xx", "stress yy", "stress zz", "stress xy", "stress yz", "stress zx"];
const HIGHEST = "largest principal stress", LOWEST = "least principal stress", MEAN = "mean stress";
const DERIVED = [HIGHEST, LOWEST, MEAN, "deviator"];
const FACES = 126; // numbers of faces in names

/** Names of the numbers of zones that a colour can show. @param {import("./scene.js").Head} head */
export function zoneNames(head) {
    const fields = head.zoneFields.map((f) => f.name).filter((name) => name !== "state");
    return fields.length ? [...DERIVED, ...fields] : [];
}

/** Unit of a number of zones. @param {import("./scene.js").Head} head @param {string} name */
export function zoneUnit(head, name) {
    return DERIVED.includes(name) ? "Pa" : head.zoneFields.find((f) => f.name === name)?.unit ?? "";
}

/**
 * The six columns of stress.
 * @param {import("./scene.js").FrameData} data
 * @param {import("./scene.js").Head} head
 */
function stressOf(data, head) {
    const of = STRESS.map((name) => data.zones.find((z) => head.zoneFields[z.field].name === name)?.value);
    return of.every((c) => c) ? /** @type {Float32Array[]} */ (of) : null;
}

/**
 * Principal stresses of a tensor xx yy zz xy yz zx, the largest first.
 * @param {number[]} s
 * @returns {number[]}
 */
export function principal(s) {
    const p = (s[0] + s[1] + s[2]) / 3, a = s[0] - p, b = s[1] - p, c = s[2] - p;
    const j2 = (a * a + b * b + c * c) / 2 + s[3] * s[3] + s[4] * s[4] + s[5] * s[5], r = Math.sqrt(j2 / 3);
    if (!(r > 0)) return [p, p, p];
    const det = a * (b * c - s[4] * s[4]) - s[3] * (s[3] * c - s[4] * s[5]) + s[5] * (s[3] * s[4] - b * s[5]);
    const angle = Math.acos(Math.max(-1, Math.min(1, det / (2 * r * r * r)))) / 3;
    const high = p + 2 * r * Math.cos(angle), low = p + 2 * r * Math.cos(angle + 2 * Math.PI / 3);
    return [high, 3 * p - high - low, low];
}

/**
 * Directions of principal stresses: each the longest product of two rows of s - value; the middle one stands square to
 * the others.
 * @param {number[]} s
 * @param {number[]} values
 */
export function principalAxes(s, values) {
    const axis = (/** @type {number} */ x) => {
        const r = [[s[0] - x, s[3], s[5]], [s[3], s[1] - x, s[4]], [s[5], s[4], s[2] - x]];
        const all = [cross(r[0], r[1]), cross(r[1], r[2]), cross(r[2], r[0])];
        return unit(all.reduce((m, v) => (norm(v) > norm(m) ? v : m)));
    };
    const spread = values[0] - values[2];
    if (!(spread > 1e-9 * Math.max(Math.abs(values[0]), Math.abs(values[2])))) return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    // of two values that are the same, any direction square to the third one
    const alone = values[0] - values[1] > values[1] - values[2] ? 0 : 2, first = axis(values[alone]);
    let other = axis(values[2 - alone]);
    const left = sub(other, scale(first, dot(other, first)));
    other = norm(left) > 1e-6 ? unit(left) : unit(cross(first, Math.abs(first[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    const middle = cross(other, first);
    return alone === 0 ? [first, middle, other] : [other, middle, first];
}

/**
 * A number of each zone of a frame, or null.
 * @param {import("./scene.js").FrameData} data
 * @param {import("./scene.js").Head} head
 * @param {string} name
 * @returns {Float32Array | null}
 */
export function zoneColumn(data, head, name) {
    if (!DERIVED.includes(name)) return data.zones.find((z) => head.zoneFields[z.field].name === name)?.value ?? null;
    const s = stressOf(data, head);
    if (!s) return null;
    const out = new Float32Array(s[0].length), t = [0, 0, 0, 0, 0, 0];
    for (let i = 0; i < out.length; i++) {
        for (let c = 0; c < 6; c++) t[c] = s[c][i];
        if (name === MEAN) out[i] = (t[0] + t[1] + t[2]) / 3;
        else if (name === "deviator") {
            const a = t[0] - t[1], b = t[1] - t[2], c = t[2] - t[0];
            out[i] = Math.sqrt((a * a + b * b + c * c) / 2 + 3 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]));
        } else out[i] = principal(t)[name === HIGHEST ? 0 : 2];
    }
    return out;
}

/**
 * Numbers of gridpoints: means of their zones, weighted by the zones' volumes when they were made.
 * @param {Surface} surface
 * @param {Float32Array} values by zone
 */
export function atPoints(surface, values) {
    const sum = new Float64Array(surface.P), weight = new Float64Array(surface.P), {corner, made} = surface;
    for (let z = 0; z < surface.Z; z++) {
        const x = [0, 1, 2, 3].map((a) => triple(made, corner[4 * z + a]));
        const volume = Math.abs(dot(sub(x[1], x[0]), cross(sub(x[2], x[0]), sub(x[3], x[0]))));
        for (let a = 0; a < 4; a++) {
            sum[corner[4 * z + a]] += volume * values[z];
            weight[corner[4 * z + a]] += volume;
        }
    }
    return Float32Array.from(sum, (s, i) => s / weight[i]);
}

/**
 * Rows of blocks in a frame by their ids, -1 where one is not there.
 * @param {Model} model
 * @param {Frame} frame
 * @param {Uint32Array} ids
 */
export function rowsOf(model, frame, ids) {
    const known = new Map([...new Set(ids)].map((id) => [id, model.rowOf(id, frame.since)]));
    return Int32Array.from(ids, (id) => known.get(id) ?? -1);
}

/**
 * Where gridpoints are shown: their motion enlarged, and with their body where the model is exploded.
 * @param {Model} model
 * @param {Frame} frame
 * @param {import("./view.js").View} view
 * @param {number[]} middle of the model
 * @returns {Float32Array | null}
 */
export function shownPoints(model, frame, view, middle) {
    const {surface} = frame, {points} = frame.data;
    if (!surface || !points) return null;
    const out = new Float32Array(3 * points.n), rows = rowsOf(model, frame, surface.body);
    for (let m = 0, k = 0; m < surface.body.length; m++) {
        const i = rows[m] < 0 ? -1 : frame.at[rows[m]];
        const away = [0, 1, 2].map((c) => (i < 0 ? 0 : view.explode * (frame.poses.place[3 * i + c] - middle[c])));
        for (const end = k + 3 * surface.points[m]; k < end; k++)
            out[k] = points.place[k] + (view.motion - 1) * points.displacement[k] + away[k % 3];
    }
    return out;
}

/**
 * The size of triangles by which their edges fade: that of the mean one, for edges of the whole lie along small ones
 * too.
 * @param {number} count
 * @param {(t: number, c: number) => number[]} corner
 */
function meanSize(count, corner) {
    let sum = 0;
    for (let t = 0; t < count; t++) sum += norm(acrossOf(corner, t));
    return 0.6 * Math.sqrt(sum / Math.max(1, count));
}

/**
 * Twice the area of a triangle, along its normal. @param {(t: number, c: number) => number[]} corner @param {number} t
 */
function acrossOf(corner, t) {
    const a = corner(t, 0);
    return cross(sub(corner(t, 1), a), sub(corner(t, 2), a));
}

/**
 * The colour of a triangle; null: its corners have their own.
 * @param {Paint} paint
 * @param {number} row
 * @param {number} zone
 * @param {number} joint
 */
function colourOf(paint, row, zone, joint) {
    const block = paint.blocks.subarray(4 * row, 4 * row + 3);
    if (paint.own && paint.blocks[4 * row + 3] > 0) return block;
    if (paint.points) return null;
    if (paint.zones) return paint.zones.subarray(3 * zone, 3 * zone + 3);
    return paint.faces ? paint.faces[joint % paint.faces.length] : block;
}

/**
 * The surfaces' triangles as the picture reads them: solid ones, then those of ghosts.
 * @param {Model} model
 * @param {Frame} frame
 * @param {import("./poses.js").Shown} shown
 * @param {Paint} paint
 * @param {boolean} mesh whether each triangle has edges
 */
export function surfaceMesh(model, frame, shown, paint, mesh) {
    const surface = /** @type {Surface} */ (frame.surface), x = /** @type {Float32Array} */ (shown.points);
    const out = makeMesh(surface.T), counts = [0, 0], {triangle, face} = surface;
    const corner = (/** @type {number} */ t, /** @type {number} */ c) => triple(x, triangle[3 * t + c]);
    const small = meanSize(surface.T, corner), rows = rowsOf(model, frame, surface.block);
    for (const kind of [1, 2]) {
        for (let t = 0; t < surface.T; t++) {
            const row = rows[t];
            if (row < 0 || shown.kind[row] !== kind) continue;
            const s = model.shape[row], joint = s.shapes.joint[s.face + face[t]];
            const colour = colourOf(paint, row, surface.zone[t], joint), normal = unit(acrossOf(corner, t));
            const name = faceName(row, (mesh ? t : face[t]) % FACES), size = mesh ? small : s.radius;
            for (let c = 0; c < 3; c++) {
                const own = colour ?? triple(/** @type {any} */ (paint.points), triangle[3 * t + c]);
                out.put(corner(t, c), normal, true, own, name, size);
            }
            counts[kind - 1] += 3;
        }
    }
    return {data: out.data, solid: counts[0], ghosts: counts[1]};
}

/**
 * The polygons in which a plane cuts the zones of solid blocks, as triangles.
 * @param {Model} model
 * @param {Frame} frame
 * @param {import("./poses.js").Shown} shown
 * @param {import("./section.js").Plane} plane
 * @returns {ZoneCut | null}
 */
export function cutZones(model, frame, shown, plane) {
    const {surface} = frame, x = shown.points;
    if (!surface || !x || !surface.whole) return null;
    const distance =
        Float32Array.from({length: surface.P}, (_v, i) => dot(plane.normal, triple(x, i)) - plane.position);
    /** @type {ZoneCut} */ const cut = {place: [], from: [], share: [], zone: [], row: []};
    const rows = rowsOf(model, frame, surface.home);
    for (let z = 0; z < surface.Z; z++) {
        const row = rows[z];
        if (row < 0 || shown.kind[row] !== 1) continue;
        /** @type {number[]} */ const up = [], down = [];
        for (const i of surface.corner.subarray(4 * z, 4 * z + 4)) (distance[i] > 0 ? up : down).push(i);
        if (!up.length || !down.length) continue;
        // the edges that the plane goes through, around the polygon
        const edges = up.flatMap((i, k) => (k ? [...down].reverse() : down).map((j) => [i, j]));
        for (let i = 1; i + 1 < edges.length; i++) {
            for (const [a, b] of [edges[0], edges[i], edges[i + 1]]) {
                const t = distance[a] / (distance[a] - distance[b]);
                cut.place.push(...add(triple(x, a), scale(sub(triple(x, b), triple(x, a)), t)));
                cut.from.push(a, b);
                cut.share.push(t);
            }
            cut.zone.push(z);
            cut.row.push(row);
        }
    }
    return cut;
}

/**
 * A section of zones as the picture reads it: flat, in the colours of the legend.
 * @param {Model} model
 * @param {ZoneCut} cut
 * @param {number[]} normal
 * @param {Paint} paint
 * @param {boolean} mesh
 */
export function capMesh(model, cut, normal, paint, mesh) {
    const {row, zone, from, share} = cut, out = makeMesh(row.length);
    const corner = (/** @type {number} */ t, /** @type {number} */ c) => triple(cut.place, 3 * t + c);
    const small = meanSize(row.length, corner);
    for (let t = 0; t < row.length; t++) {
        const name = faceName(row[t], mesh ? zone[t] % FACES : CAP_FACE),
              size = mesh ? small : model.shape[row[t]].radius;
        const colour = colourOf(paint, row[t], zone[t], 0);
        for (let k = 3 * t; k < 3 * t + 3; k++) {
            const [a, b] = colour ? [] : [0, 1].map((e) => triple(/** @type {any} */ (paint.points), from[2 * k + e]));
            out.put(
                triple(cut.place, k), normal, false, colour ?? add(a, scale(sub(b, a), share[k])).map(Math.round), name,
                size);
        }
    }
    return {data: out.data, solid: 3 * row.length, ghosts: 0};
}

export const PRESSED = [30, 80, 255], PULLED = [230, 20, 60]; // compression, tension
const ACROSS = 28;                                            // crosses across the model, at the most
const LEAST = 0.04;  // arms shorter than this share of the longest are left out
const LONGEST = 0.8; // of an arm, as a share of the distance of crosses
const ABOVE = 0.01;  // of a cross over its surface, likewise
const WIDTH = 0.045; // half that of an arm, likewise

/**
 * Places where crosses may stand: centres of the section's triangles, or of the surfaces', thinned.
 * @param {Frame} frame
 * @param {import("./poses.js").Shown} shown
 * @param {ZoneCut | null} cut
 * @param {import("./section.js").Plane | null} plane
 * @param {Model} model
 * @param {number} apart m
 */
function crossPlaces(frame, shown, cut, plane, model, apart) {
    const surface = /** @type {Surface} */ (frame.surface), x = /** @type {Float32Array} */ (shown.points);
    const {zone, row} = cut ?? {zone: surface.zone, row: rowsOf(model, frame, surface.block)}, list = [];
    const corner = (/** @type {number} */ t, /** @type {number} */ c) =>
        (cut ? triple(cut.place, 3 * t + c) : triple(x, surface.triangle[3 * t + c]));
    /** @type {Set<string>} */ const taken = new Set();
    for (let t = 0; t < row.length; t++) {
        const p = [0, 1, 2].map((c) => corner(t, c)), at = scale(p.reduce(add), 1 / 3);
        const key = at.map((v) => Math.floor(v / apart)).join();
        if (row[t] < 0 || shown.kind[row[t]] !== 1 || taken.has(key)) continue;
        if (!cut && plane && p.some((v) => dot(plane.normal, v) > plane.position)) continue;
        taken.add(key);
        list.push({at, normal: cut && plane ? plane.normal : unit(acrossOf(corner, t)), zone: zone[t], row: row[t]});
    }
    return list;
}

/**
 * Principal stresses as crosses, laid onto the section or the surfaces: an arm has the length that its stress has
 * there.
 * @param {Model} model
 * @param {Frame} frame
 * @param {import("./poses.js").Shown} shown
 * @param {ZoneCut | null} cut
 * @param {import("./section.js").Plane | null} plane
 * @param {number} reach half the size of the model, m
 * @returns {{sheets: import("./buffers.js").Sheet[], most: number}} most: the largest stress, Pa
 */
export function crossSheets(model, frame, shown, cut, plane, reach) {
    const s = stressOf(frame.data, frame.head), apart = 2 * reach / ACROSS;
    /** @type {import("./buffers.js").Sheet[]} */ const sheets = [];
    if (!frame.surface || !shown.points || !s) return {sheets, most: 0};
    const arms = crossPlaces(frame, shown, cut, plane, model, apart).flatMap((p) => {
        const t = s.map((c) => c[p.zone]), values = principal(t), axes = principalAxes(t, values);
        return values.map((value, k) => {
            const flat = sub(axes[k], scale(p.normal, dot(axes[k], p.normal)));
            return {...p, value, way: scale(flat, Math.abs(value))};
        });
    });
    const most = arms.reduce((m, a) => Math.max(m, Math.abs(a.value)), 0),
          times = most > 0 ? LONGEST * apart / most : 0;
    for (const a of arms) {
        if (!(norm(a.way) > LEAST * most)) continue;
        const way = scale(a.way, times), side = scale(unit(cross(a.normal, a.way)), apart * WIDTH);
        const middle = add(a.at, scale(a.normal, apart * ABOVE)), ends = [add(middle, way), sub(middle, way)];
        sheets.push({
            place: [sub(ends[1], side), sub(ends[0], side), add(ends[0], side), add(ends[1], side)].flat(),
            normal: a.normal,
            colour: a.value < 0 ? PRESSED : PULLED,
            flat: true,
            name: faceName(a.row, CAP_FACE)
        });
    }
    return {sheets, most};
}
