// Deformable blocks: numbers of their zones, where their gridpoints are shown, and what of them goes into the picture.
// @ts-check
import {CAP_FACE} from "./section.js";
import {cross, dot, norm, scale, sub, unit} from "./math.js";
import {MESH_BYTES, faceName} from "./buffers.js";

/** @typedef {import("./scene.js").Surface} Surface */
/** @typedef {import("./frames.js").Model} Model */
/** @typedef {import("./frames.js").Frame} Frame */
/**
 * @typedef {{count: number, place: Float32Array, from: Uint32Array, share: Float32Array, zone: Uint32Array,
 *   row: Uint32Array}} ZoneCut triangles of a section: nine numbers of place each, the two gridpoints between which
 * each corner lies, and its share of the second
 */
/**
 * @typedef {{points: Uint8Array | null, zones: Uint8Array | null, blocks: Uint8Array, faces: number[][] | null,
 *   own: boolean}} Paint colours by gridpoint, by zone or by row of the block, three or four bytes each; `faces`: of
 *   joints. `own`: blocks may have a colour of their own that goes before
 */

const STRESS = ["stress xx", "stress yy", "stress zz", "stress xy", "stress yz", "stress zx"];
const DERIVED = ["principal 1", "principal 3", "mean", "deviator"];
const WORDS = /** @type {Record<string, string>} */ ({
    "principal 1": "largest principal stress",
    "principal 3": "least principal stress",
    mean: "mean stress",
    deviator: "deviator"
});
const FACES = 126; // numbers of faces in names

/** Names of the numbers of zones that a colour can show. @param {import("./scene.js").Head} head */
export function zoneNames(head) {
    const fields = head.zoneFields.map((f) => f.name).filter((name) => name !== "state");
    return fields.length ? [...DERIVED, ...fields] : [];
}

/** A name in words. @param {string} name */
export function zoneWords(name) { return WORDS[name] ?? name.replaceAll("_", " "); }

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
        if (name === "mean") out[i] = (t[0] + t[1] + t[2]) / 3;
        else if (name === "deviator") {
            const a = t[0] - t[1], b = t[1] - t[2], c = t[2] - t[0];
            out[i] = Math.sqrt((a * a + b * b + c * c) / 2 + 3 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]));
        } else out[i] = principal(t)[name === "principal 1" ? 0 : 2];
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
        const x = [0, 1, 2, 3].map((a) => 3 * corner[4 * z + a]);
        const e = [1, 2, 3].map((a) => [0, 1, 2].map((c) => made[x[a] + c] - made[x[0] + c]));
        const volume = Math.abs(dot(e[0], cross(e[1], e[2])));
        for (let a = 0; a < 4; a++) {
            sum[corner[4 * z + a]] += volume * values[z];
            weight[corner[4 * z + a]] += volume;
        }
    }
    return Float32Array.from(sum, (s, i) => s / weight[i]);
}

/**
 * Rows of the meshes' bodies in a frame, -1 where a body is not there.
 * @param {Model} model
 * @param {Frame} frame
 * @param {Surface} surface
 */
export function meshRows(model, frame, surface) {
    return Int32Array.from(surface.body, (id) => model.rowOf(id, frame.since));
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
    const out = new Float32Array(3 * points.n), rows = meshRows(model, frame, surface);
    for (let m = 0, k = 0; m < surface.body.length; m++) {
        const i = rows[m] < 0 ? -1 : frame.at[rows[m]];
        const away = [0, 1, 2].map((c) => (i < 0 ? 0 : view.explode * (frame.poses.place[3 * i + c] - middle[c])));
        for (const end = k + 3 * surface.points[m]; k < end; k++)
            out[k] = points.place[k] + (view.motion - 1) * points.displacement[k] + away[k % 3];
    }
    return out;
}

/** Puts corners of triangles into a buffer. */
class MeshWriter {
    /** @param {number} triangles at the most */
    constructor(triangles) {
        this.data = new ArrayBuffer(3 * triangles * MESH_BYTES);
        this.f32 = new Float32Array(this.data);
        this.i16 = new Int16Array(this.data);
        this.u8 = new Uint8Array(this.data);
        this.u32 = new Uint32Array(this.data);
        this.corners = 0;
    }

    /**
     * @param {Float32Array} place
     * @param {number} at
     * @param {number[]} normal
     * @param {boolean} lit
     * @param {Uint8Array} colours
     * @param {number} colour
     * @param {number} name
     * @param {number} size m, of what edges it has: they fade where it is small
     */
    put(place, at, normal, lit, colours, colour, name, size) {
        const v = this.corners++;
        for (let c = 0; c < 3; c++) {
            this.f32[8 * v + c] = place[at + c];
            this.i16[16 * v + 6 + c] = 32767 * normal[c];
            this.u8[32 * v + 20 + c] = colours[colour + c];
        }
        this.i16[16 * v + 9] = lit ? 32767 : 0;
        this.u32[8 * v + 6] = name;
        this.f32[8 * v + 7] = size;
    }
}

/** Where a corner's colour is: the colours and a place in them. @param {Paint} paint @param {number} row */
function ownColour(paint, row) { return paint.own && paint.blocks[4 * row + 3] > 0; }

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
    const out = new MeshWriter(surface.T), counts = [0, 0], face = new Uint8Array(3);
    /** @type {Map<number, number>} */ const rows = new Map();
    for (const kind of [1, 2]) {
        for (let t = 0; t < surface.T; t++) {
            const id = surface.block[t];
            let row = rows.get(id);
            if (row === undefined) rows.set(id, row = model.rowOf(id, frame.since));
            if (row < 0 || shown.kind[row] !== kind) continue;
            const k = [0, 1, 2].map((c) => 3 * surface.triangle[3 * t + c]);
            const p = k.map((i) => [x[i], x[i + 1], x[i + 2]]);
            const area = cross(sub(p[1], p[0]), sub(p[2], p[0])), size = 0.6 * Math.sqrt(norm(area));
            const normal = unit(area);
            const name = faceName(row, mesh ? t % FACES : surface.face[t] % FACES);
            const zone = surface.zone[t], own = ownColour(paint, row);
            if (paint.faces && !own) {
                const s = model.shape[row], joint = s.shapes.joint[s.face + surface.face[t]];
                face.set(paint.faces[joint % paint.faces.length]);
            }
            for (let c = 0; c < 3; c++) {
                if (own) out.put(x, k[c], normal, true, paint.blocks, 4 * row, name, size);
                else if (paint.points) out.put(x, k[c], normal, true, paint.points, k[c], name, size);
                else if (paint.zones) out.put(x, k[c], normal, true, paint.zones, 3 * zone, name, size);
                else if (paint.faces) out.put(x, k[c], normal, true, face, 0, name, size);
                else out.put(x, k[c], normal, true, paint.blocks, 4 * row, name, size);
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
    const n = plane.normal, distance = new Float32Array(surface.P);
    for (let i = 0; i < surface.P; i++)
        distance[i] = n[0] * x[3 * i] + n[1] * x[3 * i + 1] + n[2] * x[3 * i + 2] - plane.position;
    /** @type {number[]} */ const place = [], from = [], share = [], zones = [], rows = [];
    const rowOf = meshRows(model, frame, surface);
    for (let m = 0, z = 0; m < rowOf.length; m++) {
        const row = rowOf[m], last = z + surface.zones[m];
        if (row < 0 || shown.kind[row] !== 1) {
            z = last;
            continue;
        }
        for (; z < last; z++) {
            /** @type {number[]} */ const up = [], down = [];
            for (let a = 0; a < 4; a++) {
                const i = surface.corner[4 * z + a];
                (distance[i] > 0 ? up : down).push(i);
            }
            if (!up.length || !down.length) continue;
            // the edges that the plane goes through, around the polygon
            const edges = up.length === 2 ? [[up[0], down[0]], [up[0], down[1]], [up[1], down[1]], [up[1], down[0]]]
                                          : up.flatMap((i) => down.map((k) => [i, k]));
            for (let i = 1; i + 1 < edges.length; i++) {
                for (const e of [0, i, i + 1]) {
                    const [a, b] = edges[e], t = distance[a] / (distance[a] - distance[b]);
                    for (let c = 0; c < 3; c++) place.push(x[3 * a + c] + t * (x[3 * b + c] - x[3 * a + c]));
                    from.push(a, b);
                    share.push(t);
                }
                zones.push(z);
                rows.push(row);
            }
        }
    }
    return {
        count: zones.length,
        place: Float32Array.from(place),
        from: Uint32Array.from(from),
        share: Float32Array.from(share),
        zone: Uint32Array.from(zones),
        row: Uint32Array.from(rows)
    };
}

/**
 * A section of zones as the picture reads it: flat, in the colours of the legend.
 * @param {ZoneCut} cut
 * @param {number[]} normal
 * @param {Paint} paint
 * @param {boolean} mesh
 */
export function capMesh(cut, normal, paint, mesh) {
    const out = new MeshWriter(cut.count), mixed = new Uint8Array(3), {place, from, share} = cut;
    for (let t = 0; t < cut.count; t++) {
        const row = cut.row[t], name = faceName(row, mesh ? cut.zone[t] % FACES : CAP_FACE);
        const p = [0, 1, 2].map((c) => Array.from(place.subarray(9 * t + 3 * c, 9 * t + 3 * c + 3)));
        const size = 0.6 * Math.sqrt(norm(cross(sub(p[1], p[0]), sub(p[2], p[0]))));
        for (let c = 0; c < 3; c++) {
            const k = 3 * t + c, at = 9 * t + 3 * c;
            if (!ownColour(paint, row) && paint.points) {
                const a = 3 * from[2 * k], b = 3 * from[2 * k + 1];
                for (let i = 0; i < 3; i++)
                    mixed[i] = Math.round(paint.points[a + i] + share[k] * (paint.points[b + i] - paint.points[a + i]));
                out.put(place, at, normal, false, mixed, 0, name, size);
            } else if (!ownColour(paint, row) && paint.zones)
                out.put(place, at, normal, false, paint.zones, 3 * cut.zone[t], name, size);
            else if (!ownColour(paint, row) && paint.faces) {
                mixed.set(paint.faces[0]);
                out.put(place, at, normal, false, mixed, 0, name, size);
            } else out.put(place, at, normal, false, paint.blocks, 4 * row, name, size);
        }
    }
    return {data: out.data, solid: 3 * cut.count, ghosts: 0};
}

export const PRESSED = [20, 70, 170], PULLED = [190, 30, 40]; // compression, tension
const ACROSS = 28;                                            // crosses across the model, at the most
const LEAST = 0.04;  // arms shorter than this share of the longest are left out
const LONGEST = 0.8; // of an arm, as a share of the distance of crosses
const ABOVE = 0.01;  // of a cross over its surface, likewise
const WIDTH = 0.03;  // half that of an arm, likewise

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
    /** @type {{at: number[], normal: number[], zone: number, row: number}[]} */ const list = [];
    /** @type {Set<string>} */ const taken = new Set();
    const add =
        (/** @type {number[][]} */ p, /** @type {number[]} */ normal, /** @type {number} */ zone,
         /** @type {number} */ row) => {
            const at = [0, 1, 2].map((c) => (p[0][c] + p[1][c] + p[2][c]) / 3);
            const key = at.map((v) => Math.floor(v / apart)).join();
            if (taken.has(key)) return;
            taken.add(key);
            list.push({at, normal, zone, row});
        };
    if (cut && plane) {
        for (let t = 0; t < cut.count; t++)
            add([0, 1, 2].map((c) => Array.from(cut.place.subarray(9 * t + 3 * c, 9 * t + 3 * c + 3))), plane.normal,
                cut.zone[t], cut.row[t]);
        return list;
    }
    for (let t = 0; t < surface.T; t++) {
        const row = model.rowOf(surface.block[t], frame.since);
        if (row < 0 || shown.kind[row] !== 1) continue;
        const p = [0, 1, 2].map((c) => {
            const k = 3 * surface.triangle[3 * t + c];
            return [x[k], x[k + 1], x[k + 2]];
        });
        if (!plane || p.every((v) => dot(plane.normal, v) < plane.position))
            add(p, unit(cross(sub(p[1], p[0]), sub(p[2], p[0]))), surface.zone[t], row);
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
        const middle = a.at.map((v, c) => v + a.normal[c] * apart * ABOVE);
        const corner = (/** @type {number} */ i, /** @type {number} */ k) =>
            middle.map((v, c) => v + i * way[c] + k * side[c]);
        sheets.push({
            place: [...corner(-1, -1), ...corner(1, -1), ...corner(1, 1), ...corner(-1, 1)],
            normal: a.normal,
            colour: a.value < 0 ? PRESSED : PULLED,
            flat: true,
            name: faceName(a.row, CAP_FACE)
        });
    }
    return {sheets, most};
}
