// The model over time: a row for each block that ever was, and the frames, packed until they are looked at.
// @ts-check
import {readFrame} from "./scene.js";
import {BEYOND, norm, triple} from "./math.js";
import {zoneColumn, zoneNames} from "./zones.js";

/** @typedef {import("./scene.js").FrameData} FrameData */
/** @typedef {import("./scene.js").Refused} Refused */
/** @typedef {import("./scene.js").Touches} Touches */
/** @typedef {import("./scene.js").Surface} Surface */
/**
 * @typedef {{largest: Record<string, number>, least: Record<string, number>, time: number, cycle: number, most: number,
 *   mover: number, slipping: number, contacts: number, line: import("./scene.js").Line | null, blocks: number}} Summary
 */
/**
 * @typedef {{packed: string | null, length: number, buffer: ArrayBuffer | null, used: number,
 *   head: import("./scene.js").Head, refused: Refused | null, touches: Touches | null, surface: Surface | null,
 *   since: number, summary: Summary,
 *   whole: boolean, rows: Int32Array | null, data: FrameData | null}} Stored whole: the summary is of the frame itself;
 *   rows and data: of the blocks and the chunks, while they are known
 */
/**
 * @typedef {{index: number, since: number, data: FrameData, head: import("./scene.js").Head,
 *   poses: import("./scene.js").Poses, rows: Int32Array, at: Int32Array, summary: Summary, refused: Refused | null,
 *   touches: Touches | null, surface: Surface | null}} Frame
 */

const UNPACKED = 256 * 1024 * 1024; // bytes of unpacked frames that are kept
const FEW = 8;                      // frames of a run that are kept whatever their size
const SPARE = 1000;                 // rows of blocks that are gone, and stay until there are more

/** Base64 of a zlib stream to bytes. @param {string} text @param {number} length @returns {Promise<ArrayBuffer>} */
async function unpack(text, length) {
    if (!(length >= 0 && length <= 1 << 30)) throw new Error("A frame of this page has no length of at most 1 GB.");
    let bytes;
    try {
        const fast = /** @type {any} */ (Uint8Array).fromBase64; // of browsers since 2025
        if (fast) bytes = fast.call(Uint8Array, text);
        else {
            const raw = atob(text);
            bytes = new Uint8Array(raw.length);
            for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
        }
    } catch {
        throw new Error("A frame of this page is no base64 text: the file was changed or cut off.");
    }
    const out = new Uint8Array(length);
    const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
    let at = 0;
    try {
        for (let part = await reader.read(); !part.done; part = await reader.read()) {
            if (at + part.value.length > length) throw new Error();
            out.set(part.value, at);
            at += part.value.length;
        }
    } catch {
        throw new Error("A frame of this page cannot be unpacked: the file was changed or cut off.");
    }
    if (at !== length) throw new Error(`A frame of this page has ${at} bytes instead of ${length}.`);
    return out.buffer;
}

/** Lengths of the vectors of a column. @param {Float32Array} column @returns {Float32Array} */
export function lengths(column) {
    const out = new Float32Array(column.length / 3);
    for (let i = 0, k = 0; i < out.length; i++, k += 3)
        out[i] = Math.sqrt(column[k] * column[k] + column[k + 1] * column[k + 1] + column[k + 2] * column[k + 2]);
    return out;
}

/**
 * The numbers of a frame that a colour can show: of its blocks, or of its contacts.
 * @param {FrameData} data
 * @param {import("./scene.js").Head} head
 * @param {string} name
 * @returns {Float32Array | null}
 */
export function column(data, head, name) {
    const p = data.poses, k = data.contacts;
    if (!p) return null;
    if (name === "displacement") return lengths(p.displacement);
    if (name === "velocity") return lengths(p.velocity);
    if (name === "rotation") return lengths(p.rotation).map((x) => x * 180 / Math.PI);
    if (name === "unbalanced") return p.unbalanced;
    if (name.startsWith("zone:")) return zoneColumn(data, head, name.slice(5));
    if (name.startsWith("element:"))
        return data.elementFields.find((f) => head.elementFields[f.field].name === name.slice(8))?.value ?? null;
    if (name.startsWith("field:") || name.startsWith("contact field:")) {
        const of = name.startsWith("field:") ? 0 : 1, wanted = name.slice(name.indexOf(":") + 1);
        return data.extras.find((e) => e.of === of && head.fields[e.field].name === wanted)?.value ?? null;
    }
    if (!k) return null;
    if (name === "slip") return k.slip;
    if (name === "force") return lengths(k.force);
    if (name !== "normal stress" && name !== "shear stress") return null;
    const out = new Float32Array(k.n), shear = name === "shear stress", f = k.force, n = k.normal;
    for (let i = 0, c = 0; i < k.n; i++, c += 3) {
        const push = f[c] * n[c] + f[c + 1] * n[c + 1] + f[c + 2] * n[c + 2];
        const x = f[c] - push * n[c], y = f[c + 1] - push * n[c + 1], z = f[c + 2] - push * n[c + 2];
        out[i] = k.area[i] > 0 ? (shear ? Math.sqrt(x * x + y * y + z * z) : push) / k.area[i] : NaN;
    }
    return out;
}

/** Names of the columns of a frame. @param {FrameData} data @param {import("./scene.js").Head} head */
export function columnNames(data, head) {
    const extra = data.extras.map((e) => (e.of ? "contact field:" : "field:") + head.fields[e.field].name);
    return [
        "displacement", "velocity", "rotation", "unbalanced",
        ...(data.contacts ? ["slip", "normal stress", "shear stress", "force"] : []), ...extra,
        ...(data.zones.length ? zoneNames(head).map((name) => `zone:${name}`) : []),
        ...data.elementFields.map((f) => `element:${head.elementFields[f.field].name}`)
    ];
}

/** @param {FrameData} data @param {import("./scene.js").Head} head @returns {Summary} */
function summarise(data, head) {
    const poses = /** @type {import("./scene.js").Poses} */ (data.poses);
    /** @type {Record<string, number>} */ const largest = {};
    /** @type {Record<string, number>} */ const least = {};
    let most = 0, mover = -1, slipping = 0;
    for (const name of columnNames(data, head)) {
        const values = column(data, head, name) ?? new Float32Array(0);
        let low = Infinity, high = -Infinity;
        for (let i = 0; i < values.length; i++) {
            if (values[i] < low) low = values[i];
            if (values[i] > high && values[i] < BEYOND) {
                high = values[i];
                if (name === "displacement") {
                    most = high;
                    mover = poses.id[i];
                }
            }
        }
        if (high >= low) {
            largest[name] = high;
            least[name] = low;
        }
    }
    for (const moved of data.points ? lengths(data.points.displacement) : [])
        largest.displacement = Math.max(largest.displacement ?? 0, moved);
    for (const state of data.contacts?.state ?? []) slipping += state === 1 ? 1 : 0;
    return {
        largest,
        least,
        time: poses.time,
        cycle: poses.cycle,
        most,
        mover,
        slipping,
        contacts: data.contacts?.n ?? 0,
        line: data.line,
        blocks: poses.n
    };
}

/**
 * Numbers of gridpoints and zones must be those of the mesh. @param {FrameData} data @param {Surface | null} surface
 */
function checkZones(data, surface) {
    const {points} = data, P = surface?.P ?? 0, Z = surface?.Z ?? 0;
    if ((points && points.n !== P) || data.zones.some((z) => z.value.length !== Z))
        throw new Error(`A frame does not fit its mesh of ${P} gridpoints and ${Z} zones.`);
}

/** All frames of a page or of a run, and the blocks' shapes by row. */
export class Model {
    constructor() {
        /** @type {Stored[]} */ this.frames = [];
        /** @type {import("./scene.js").Head | null} */ this.head = null;
        /** @type {Refused | null} */ this.refused = null; // cuts so far
        /** @type {Touches | null} */ this.touches = null; // as they are now
        /** @type {Surface | null} */ this.surface = null; // likewise
        this.density = 0;                                  // of the first block, kg/m³
        this.keys = false;                                 // whether any frame has keyblocks
        this.rows = 0;
        this.kept = 0;                                        // rows after the last sweep
        /** @type {Record<string, number>} */ this.most = {}; // of frames that were let go
        /** @type {Record<string, number>} */ this.fewest = {};
        this.triangles = 0;
        /**
         * @type {{shapes: import("./scene.js").Shapes, block: number, vertex: number, face: number, corner: number,
         *     radius: number}[]}
         */
        this.shape = [];
        /** @type {Map<number, {row: number, since: number}[]>} */ this.versions = new Map();
        this.version = 0; // of the shapes
        this.serial = 0;  // of the frames, also of those let go
        this.clock = 0;
        /** @type {{buffer: ArrayBuffer, data: FrameData} | null} */ this.last = null; // what was read last
    }

    /** A frame as the page holds it. @param {string} text @param {number} length */
    async addPacked(text, length) { this.addFrame(await unpack(text, length), text); }

    /**
     * A frame that sends no shapes: it is unpacked when it is looked at.
     * @param {string} text
     * @param {number} length
     * @param {number} time
     * @param {number} cycle
     * @param {number} most largest displacement
     */
    addLater(text, length, time, cycle, most) {
        const head = /** @type {import("./scene.js").Head} */ (this.head);
        this.frames.push({
            packed: text,
            length,
            buffer: null,
            used: 0,
            head,
            refused: this.refused,
            touches: this.touches,
            surface: this.surface,
            since: this.serial++,
            whole: false,
            rows: null,
            data: null,
            summary: {
                largest: {displacement: most},
                least: {displacement: 0},
                time,
                cycle,
                most,
                mover: -1,
                slipping: 0,
                contacts: 0,
                line: null,
                blocks: 0
            }
        });
    }

    /**
     * A frame's chunks; without `packed` it stays unpacked.
     * @param {ArrayBuffer} buffer
     * @param {string | null} packed
     */
    addFrame(buffer, packed) { this.store(readFrame(buffer, this.head), buffer, packed); }

    /**
     * A frame of a run; its rows are those of the frame before where no block has come, changed or gone.
     * @param {ArrayBuffer} news
     * @param {ArrayBuffer} now
     */
    addLive(news, now) {
        const data = readFrame(now, this.head, news), before = this.frames[this.frames.length - 1];
        const stored = this.store(data, now, null), id = data.poses?.id;
        const old = before?.data?.poses?.id;
        const same = data.shapes.length === 0 && id?.length === old?.length && id?.every((v, i) => v === old?.[i]);
        stored.rows = same ? before.rows : this.rowsOf(data, stored.since);
        stored.data = data;
        if (before) before.data = null;
        return data;
    }

    /** @param {FrameData} data @param {ArrayBuffer} buffer @param {string | null} packed @returns {Stored} */
    store(data, buffer, packed) {
        const serial = this.serial++;
        this.last = {buffer, data};
        if (data.head) this.head = data.head;
        const head = /** @type {import("./scene.js").Head} */ (this.head);
        for (const shapes of data.shapes) this.addShapes(shapes, serial);
        this.refused = data.refused ?? this.refused;
        this.touches = data.touches ?? this.touches;
        this.surface = data.surface ?? this.surface;
        checkZones(data, this.surface);
        this.density ||= data.shapes[0]?.density[0] ?? 0;
        this.keys ||= data.keys !== null;
        /** @type {Stored} */ const stored = {
            packed,
            length: buffer.byteLength,
            buffer,
            used: ++this.clock,
            head,
            refused: this.refused,
            touches: this.touches,
            surface: this.surface,
            since: serial,
            summary: summarise(data, head),
            whole: true,
            rows: null,
            data: null
        };
        this.frames.push(stored);
        this.forget();
        return stored;
    }

    /** Rows of the blocks of a frame. @param {FrameData} data @param {number} since */
    rowsOf(data, since) {
        const {n, id} = /** @type {import("./scene.js").Poses} */ (data.poses), rows = new Int32Array(n);
        for (let i = 0; i < n; i++) {
            rows[i] = this.rowOf(id[i], since);
            if (rows[i] < 0) throw new Error(`A frame shows block ${id[i]}, whose shape was not sent.`);
        }
        return rows;
    }

    /** @param {import("./scene.js").Shapes} shapes @param {number} since */
    addShapes(shapes, since) {
        let vertex = 0, face = 0, corner = 0;
        for (let block = 0; block < shapes.n; block++) {
            let radius = 0;
            for (let v = vertex; v < vertex + shapes.vertices[block]; v++) {
                radius = Math.max(radius, norm(triple(shapes.vertex, v)));
            }
            const list = this.versions.get(shapes.id[block]) ?? [];
            list.push({row: this.rows, since});
            this.versions.set(shapes.id[block], list);
            this.shape.push({shapes, block, vertex, face, corner, radius});
            vertex += shapes.vertices[block];
            for (const last = face + shapes.faces[block]; face < last; face++) {
                corner += shapes.corners[face];
                this.triangles += Math.max(0, shapes.corners[face] - 2);
            }
            this.rows++;
        }
        this.version++;
    }

    /** Frames that were not used for long are packed again: their text is still there. */
    forget() {
        let total = 0;
        for (const f of [...this.frames].sort((a, b) => b.used - a.used)) {
            if (!f.buffer) continue;
            total += f.length;
            if (total > UNPACKED && f.packed !== null) f.buffer = null;
        }
    }

    /**
     * Of a run: lets go of every second frame but the newest and the one that is seen, when there are too many.
     * @param {number} limit
     * @param {Stored | undefined} seen
     */
    thin(limit, seen) {
        const end = this.frames.length, bytes = this.frames.reduce((n, f) => n + f.length, 0);
        if (end <= limit && (bytes <= UNPACKED || end <= FEW)) return;
        this.frames = this.frames.filter((f, i) => {
            if (i % 2 === 0 || i > end - 3 || f === seen) return true;
            for (const name in f.summary.largest) {
                this.most[name] = Math.max(this.most[name] ?? -Infinity, f.summary.largest[name]);
                this.fewest[name] = Math.min(this.fewest[name] ?? Infinity, f.summary.least[name]);
            }
            return false;
        });
    }

    /**
     * Of a run: lets go of the shapes that no kept frame shows, when they are many. Gives whether rows have other
     * numbers now.
     */
    sweep() {
        if (this.rows < 2 * Math.max(this.kept, this.frames[this.frames.length - 1].summary.blocks) + SPARE)
            return false;
        const lists = new Set(this.frames.map((f) => f.rows ?? new Int32Array(0)));
        const place = new Int32Array(this.rows).fill(-1);
        for (const list of lists)
            for (const row of list) place[row] = 0;
        this.kept = 0;
        for (let row = 0; row < this.rows; row++)
            if (place[row] === 0) place[row] = this.kept++;
        if (this.kept === this.rows) return false;
        for (const list of lists)
            list.forEach((row, i) => {
                list[i] = place[row];
            });
        for (const [id, list] of this.versions) {
            const left = list.filter((v) => place[v.row] >= 0);
            for (const v of left) v.row = place[v.row];
            if (left.length) this.versions.set(id, left);
            else this.versions.delete(id);
        }
        this.shape = this.shape.filter((_s, row) => place[row] >= 0);
        this.rows = this.kept;
        this.triangles = 0;
        for (let row = 0; row < this.rows; row++)
            this.eachFace(row, (_f, _c, corners) => {
                this.triangles += Math.max(0, corners - 2);
            });
        this.version++;
        return true;
    }

    /** Row of a block in a frame, or -1. @param {number} id @param {number} since */
    rowOf(id, since) {
        let row = -1;
        for (const v of this.versions.get(id) ?? [])
            if (v.since <= since) row = v.row;
        return row;
    }

    /** @param {number} index @returns {Promise<Frame>} */
    async frame(index) {
        const stored = this.frames[index];
        stored.used = ++this.clock;
        if (!stored.buffer) {
            const {packed, length} = stored;
            stored.buffer = await unpack(packed ?? "", length);
            this.forget();
        }
        const data = stored.data ??
            (this.last?.buffer === stored.buffer ? this.last.data : readFrame(stored.buffer, stored.head));
        this.last = {buffer: stored.buffer, data};
        checkZones(data, stored.surface);
        if (!stored.whole) stored.summary = summarise(data, stored.head);
        stored.whole = true;
        this.keys ||= data.keys !== null;
        const poses = /** @type {import("./scene.js").Poses} */ (data.poses);
        const rows = stored.rows ?? this.rowsOf(data, stored.since), at = new Int32Array(this.rows).fill(-1);
        for (let i = 0; i < poses.n; i++) at[rows[i]] = i;
        return {
            index,
            since: stored.since,
            data,
            head: stored.head,
            poses,
            rows,
            at,
            summary: stored.summary,
            refused: stored.refused,
            touches: stored.touches,
            surface: data.points ? stored.surface : null
        };
    }

    /** Largest value of a column over all frames. @param {string} name */
    largest(name) {
        return this.frames.reduce(
            (m, f) => Math.max(m, f.summary.largest[name] ?? -Infinity), this.most[name] ?? -Infinity);
    }

    /** Least value of a column over all frames. @param {string} name */
    least(name) {
        return this.frames.reduce(
            (m, f) => Math.min(m, f.summary.least[name] ?? Infinity), this.fewest[name] ?? Infinity);
    }

    /**
     * Faces of a row, with the place of their first corner.
     * @param {number} row
     * @param {(face: number, corner: number, corners: number, joint: number, plane: number) => void} see
     */
    eachFace(row, see) {
        const {shapes, block, face, corner} = this.shape[row];
        for (let f = face, c = corner; f < face + shapes.faces[block]; f++) {
            see(f - face, c, shapes.corners[f], shapes.joint[f], shapes.plane[f]);
            c += shapes.corners[f];
        }
    }
}
