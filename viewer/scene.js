// Reads the scene stream (docs/scene_format.md). It knows nothing of pictures. Every count is compared with the length
// of its chunk before anything is taken; what is wrong ends in a sentence (an Error), never in a crash.
// @ts-check

/** @typedef {{name: string, unit: string, of: string}} Field */
/**
 * @typedef {{format: number, program: string, title: string, origin: number[], gravity: number[], size: number,
 *   groups: string[], joints: string[], laws: string[], friction: number[], limit: number, fields: Field[], histories:
 * string[], live: boolean, commands: boolean, solids: string[], zoneStates: string[], zoneFields: {name: string, unit:
 * string}[], elements: string[], elementFields: {name: string, unit: string}[]}} Head
 */
/**
 * @typedef {{n: number, id: Uint32Array, body: Uint32Array, group: Uint32Array, vertices: Uint32Array,
 *   faces: Uint32Array, volume: Float32Array, density: Float32Array, centroid: Float32Array, vertex: Float32Array,
 *   joint: Uint32Array, plane: Uint32Array, corners: Uint16Array, loop: Uint16Array}} Shapes
 */
/**
 * @typedef {{n: number, time: number, cycle: number, id: Uint32Array, place: Float32Array, turn: Float32Array,
 *   velocity: Float32Array, displacement: Float32Array, rotation: Float32Array, spin: Float32Array,
 *   unbalanced: Float32Array, flags: Uint8Array}} Poses
 */
/**
 * @typedef {{n: number, id: Float64Array, a: Uint32Array, b: Uint32Array, joint: Uint32Array, plane: Uint32Array,
 *   point: Float32Array, normal: Float32Array, force: Float32Array, area: Float32Array, gap: Float32Array,
 *   slip: Float32Array, used: Float32Array, state: Uint8Array, contact: Uint32Array, corners: Uint32Array, corner:
 * Float32Array}} Contacts
 */
/** @typedef {{of: number, field: number, value: Float32Array}} Extra */
/** @typedef {{numbers: number[], histories: Float64Array}} Line */
/** @typedef {{n: number, id: Uint32Array, mode: Uint32Array, factor: Float32Array, direction: Float32Array}} Keys */
/**
 * @typedef {{total: number, joint: Uint32Array, plane: Uint32Array, block: Uint32Array, normal: Float32Array,
 *   point: Float32Array, thickness: Float32Array, limit: Float32Array}} Refused
 */
/**
 * @typedef {{P: number, Z: number, T: number, whole: boolean, body: Uint32Array, points: Uint32Array,
 *   zones: Uint32Array, triangles: Uint32Array, made: Float32Array, corner: Uint32Array, solid: Uint16Array, home:
 * Uint32Array, triangle: Uint32Array, zone: Uint32Array, block: Uint32Array, face: Uint32Array}} Surface meshes of
 * deformable bodies: gridpoints, zones and the triangles of their surfaces; not whole: without zones inside
 */
/** @typedef {{n: number, place: Float32Array, displacement: Float32Array}} Points gridpoints of a frame */
/** @typedef {{field: number, value: Float32Array}} Numbers of zones, or of points of elements */
/**
 * @typedef {{n: number, P: number, id: Uint32Array, kind: Uint32Array, points: Uint32Array, flags: Uint32Array, block:
 * Uint32Array, place: Float32Array}} Elements lines and polygons
 */
/**
 * @typedef {{n: number, body: Uint32Array, normal: Float32Array}} Touches outward normals of the faces with which
 *   bodies lie on others, body by body
 */
/**
 * @typedef {{head: Head | null, shapes: Shapes[], gone: Uint32Array[], refused: Refused | null, touches: Touches |
 *   null, surface: Surface | null, points: Points | null, zones: Numbers[], elements: Elements | null, elementFields:
 *   Numbers[], poses: Poses | null, contacts: Contacts | null, laws: Uint32Array | null, extras: Extra[], line: Line |
 *   null, keys: Keys | null, finding: Finding | null, live: Live[], number: number}} FrameData
 */
/**
 * @typedef {{standing: string, text: string, stage: string, closed: number, contacts: number, slipping: number,
 *   hash: string}} Finding how the model stands
 */
/**
 * @typedef {{state: string, line: string, refused: string}} Live what a run does, and a line that was done or why it
 *   was not ("" where there is none)
 */

/** Takes columns one after the other from a payload. */
class Columns {
    /** @param {string} name @param {ArrayBuffer} buffer @param {number} at @param {number} bytes */
    constructor(name, buffer, at, bytes) {
        this.name = name;
        this.buffer = buffer;
        this.at = at;
        this.end = at + bytes;
    }

    /** @param {string} what @returns {Error} */
    bad(what) { return new Error(`The chunk ${this.name} of the scene is damaged: ${what}.`); }

    /** @param {number} count @param {number} width @param {string} what */
    take(count, width, what) {
        const at = this.at;
        if (count === 0) return 0;
        if (!(count * width <= this.end - at)) throw this.bad(`${count} values of ${what} do not fit into it`);
        this.at = at + ((count * width + 3) & ~3);
        return at;
    }

    /** @param {number} count @param {string} what */
    u32(count, what) { return new Uint32Array(this.buffer, this.take(count, 4, what), count); }

    /** @param {number} count @param {string} what */
    u16(count, what) { return new Uint16Array(this.buffer, this.take(count, 2, what), count); }

    /** @param {number} count @param {string} what */
    u8(count, what) { return new Uint8Array(this.buffer, this.take(count, 1, what), count); }

    /**
     * Finite numbers; with `none` also NaN, for "there is none".
     * @param {number} count
     * @param {string} what
     * @param {boolean} [none]
     */
    f32(count, what, none) {
        const out = new Float32Array(this.buffer, this.take(count, 4, what), count);
        this.finite(out, what, none);
        return out;
    }

    /** @param {Float32Array | Float64Array} list @param {string} what @param {boolean} [none] */
    finite(list, what, none) {
        const i = list.findIndex((value) => !Number.isFinite(value) && !(none && Number.isNaN(value)));
        if (i >= 0) throw this.bad(`value ${i} of ${what} is not a number`);
    }

    /** @param {number} count @param {string} what @param {boolean} [none] */
    f64(count, what, none) {
        const view = new DataView(this.buffer, this.take(count, 8, what), count * 8), out = new Float64Array(count);
        for (let i = 0; i < count; i++) out[i] = view.getFloat64(8 * i, true);
        this.finite(out, what, none);
        return out;
    }

    /** @returns {any} an object */
    json() {
        let h;
        try {
            h = JSON.parse(new TextDecoder("utf-8", {
                               fatal: true
                           }).decode(new Uint8Array(this.buffer, this.at, this.end - this.at)));
        } catch {
            throw this.bad("its text is no JSON");
        }
        if (typeof h !== "object" || h === null) throw this.bad("its text is no object");
        return h;
    }

    /** @param {Uint32Array | Uint16Array | Uint8Array} list @param {number} limit @param {string} what */
    below(list, limit, what) {
        for (let i = 0; i < list.length; i++) {
            if (list[i] >= limit) throw this.bad(`value ${i} of ${what} is ${list[i]}, and must be less than ${limit}`);
        }
    }

    /** @param {Uint32Array | Uint16Array} list @param {number} total @param {string} what */
    sum(list, total, what) {
        let sum = 0;
        for (let i = 0; i < list.length; i++) sum += list[i];
        if (sum !== total) throw this.bad(`the numbers of ${what} add up to ${sum} instead of ${total}`);
    }
}

/** @param {any} value @param {string} name @returns {string[]} */
function names(value, name) {
    if (!Array.isArray(value) || !value.every((v) => typeof v === "string"))
        throw new Error(`The chunk HEAD of the scene is damaged: ${name} is no list of texts.`);
    return value;
}

/** @param {Columns} c @returns {Head} */
function readHead(c) {
    const h = c.json();
    if (h.format !== 2) throw new Error(`The scene has format ${String(h.format)}; this page reads format 2.`);
    const triple = (/** @type {any} */ v) => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite);
    if (!triple(h.origin) || !triple(h.gravity)) throw c.bad("origin and gravity must be lists of three numbers");
    if (!(Number.isFinite(h.size) && h.size > 0)) throw c.bad("the size must be a positive number");
    const list = (/** @type {any} */ of) =>
        (Array.isArray(of) ? of : [])
            .map((/** @type {any} */ f) => ({name: String(f?.name), unit: String(f?.unit ?? ""), of: String(f?.of)}));
    const friction =
        (Array.isArray(h.friction) ? h.friction : []).map((/** @type {any} */ x) => (Number.isFinite(x) ? x : NaN));
    return {
        format: 2,
        program: String(h.program),
        title: String(h.title ?? ""),
        origin: h.origin,
        gravity: h.gravity,
        size: h.size,
        groups: names(h.groups, "groups"),
        joints: names(h.joints, "joints"),
        laws: names(h.laws ?? [""], "laws"),
        histories:
            names(h.histories?.map?.((/** @type {any} */ x) => x.name + (x.unit && ", " + x.unit)) ?? [], "histories"),
        fields: list(h.fields),
        friction,
        limit: Number.isFinite(h.safety_limit) && h.safety_limit > 0 ? h.safety_limit : NaN,
        solids: names(h.solids ?? [], "solids"),
        zoneStates: names(h.zone_states ?? [], "zone_states"),
        zoneFields: list(h.zone_fields),
        elements: names(h.elements ?? [], "elements"),
        elementFields: list(h.element_fields),
        live: h.live === true,
        commands: h.commands === true
    };
}

/** @param {Columns} c @param {Head} head @returns {Shapes} */
function readShapes(c, head) {
    const [n, V, F, L] = c.u32(4, "counts");
    const s = {
        n,
        id: c.u32(n, "id"),
        body: c.u32(n, "body"),
        group: c.u32(n, "group"),
        vertices: c.u32(n, "vertices"),
        faces: c.u32(n, "faces"),
        volume: c.f32(n, "volume"),
        density: c.f32(n, "density"),
        centroid: c.f32(3 * n, "centroid"),
        vertex: c.f32(3 * V, "vertex"),
        joint: c.u32(F, "joint"),
        plane: c.u32(F, "plane"),
        corners: c.u16(F, "corners"),
        loop: c.u16(L, "loop")
    };
    c.sum(s.vertices, V, "vertices");
    c.sum(s.faces, F, "faces");
    c.sum(s.corners, L, "corners");
    c.below(s.group, Math.max(1, head.groups.length), "group");
    c.below(s.joint, Math.max(1, head.joints.length), "joint");
    for (let block = 0, face = 0, corner = 0; block < n; block++) {
        for (const last = face + s.faces[block]; face < last; face++) {
            for (const end = corner + s.corners[face]; corner < end; corner++) {
                if (s.loop[corner] >= s.vertices[block])
                    throw c.bad(
                        `a face of block ${s.id[block]} names vertex ${s.loop[corner]} of ${s.vertices[block]}`);
            }
        }
    }
    return s;
}

/** @param {Columns} c @returns {Poses} */
function readPoses(c) {
    const [time, cycle] = c.f64(2, "time and cycle"), n = c.u32(1, "count")[0];
    return {
        n,
        time,
        cycle,
        id: c.u32(n, "id"),
        place: c.f32(3 * n, "place"),
        turn: c.f32(4 * n, "turn"),
        velocity: c.f32(3 * n, "velocity"),
        displacement: c.f32(3 * n, "displacement"),
        rotation: c.f32(3 * n, "rotation"),
        spin: c.f32(3 * n, "spin"),
        unbalanced: c.f32(n, "unbalanced"),
        flags: c.u8(n, "flags")
    };
}

/** A contact's number is that of its older block times this, plus the other's: exact up to block 2097151. */
const PAIR = 2 ** 32;

/** The blocks of a contact, in words. @param {number} id */
export function pairOf(id) { return `${Math.floor(id / PAIR)} and ${id % PAIR}`; }

/** @param {Columns} c @param {Head} head @returns {Contacts} */
function readContacts(c, head) {
    const [n, P, C] = c.u32(3, "counts");
    const a = c.u32(n, "a"), b = c.u32(n, "b");
    const k = {
        n,
        id: Float64Array.from(a, (block, i) => block * PAIR + b[i]),
        a,
        b,
        joint: c.u32(n, "joint"),
        plane: c.u32(n, "plane"),
        point: c.f32(3 * n, "point"),
        normal: c.f32(3 * n, "normal"),
        force: c.f32(3 * n, "force"),
        area: c.f32(n, "area"),
        gap: c.f32(n, "gap"),
        slip: c.f32(n, "slip", true),
        used: c.f32(n, "used", true),
        state: c.u8(n, "state"),
        contact: c.u32(P, "contact"),
        corners: c.u32(P, "corners"),
        corner: c.f32(3 * C, "corner")
    };
    c.sum(k.corners, C, "corners");
    c.below(k.contact, n, "contact");
    c.below(k.joint, Math.max(1, head.joints.length), "joint");
    c.below(k.state, 4, "state");
    return k;
}

/** @param {Columns} c @param {number} field @param {object[]} fields */
function checkField(c, field, fields) {
    if (field >= fields.length) throw c.bad(`field ${field} has no name`);
}

/** @param {Columns} c @param {number} n @param {number | undefined} rows */
function checkCount(c, n, rows) {
    if (rows !== n) throw c.bad(`it has ${n} values for ${rows ?? "no"} rows`);
}

/**
 * Which law each contact has.
 * @param {Columns} c @param {FrameData} frame @param {Head} head @returns {Uint32Array}
 */
function readLaws(c, frame, head) {
    const n = c.u32(1, "count")[0];
    checkCount(c, n, frame.contacts?.n);
    const laws = c.u32(n, "law");
    c.below(laws, head.laws.length || 1, "law");
    return laws;
}

/** @param {Columns} c @param {FrameData} frame @param {Head} head @returns {Extra} */
function readExtra(c, frame, head) {
    const [of, field, n] = c.u32(3, "counts");
    const rows = of === 0 ? frame.poses?.n : of === 1 ? frame.contacts?.n : undefined;
    checkCount(c, n, rows);
    checkField(c, field, head.fields);
    return {of, field, value: c.f32(n, "value", true)};
}

/** @param {Columns} c @returns {Keys} */
function readKeys(c) {
    const n = c.u32(1, "count")[0];
    const k = {
        n,
        id: c.u32(n, "id"),
        mode: c.u32(n, "mode"),
        factor: c.f32(n, "factor", true),
        direction: c.f32(3 * n, "direction")
    };
    c.below(k.mode, 4, "mode");
    return k;
}

/** @param {Columns} c @param {Head} head @returns {Refused} */
function readRefused(c, head) {
    const [total, n] = c.u32(2, "counts");
    const r = {
        total,
        joint: c.u32(n, "joint"),
        plane: c.u32(n, "plane"),
        block: c.u32(n, "block"),
        normal: c.f32(3 * n, "normal"),
        point: c.f32(3 * n, "point"),
        thickness: c.f32(n, "thickness"),
        limit: c.f32(n, "limit")
    };
    c.below(r.joint, Math.max(1, head.joints.length), "joint");
    return r;
}

/** @param {Columns} c @returns {Touches} */
function readTouches(c) {
    const n = c.u32(1, "count")[0];
    return {n, body: c.u32(n, "body"), normal: c.f32(3 * n, "normal")};
}

/** @param {Columns} c @param {Head} head @returns {Surface} */
function readSurface(c, head) {
    const [n, P, Z, T, whole] = c.u32(5, "counts");
    const s = {
        P,
        Z,
        T,
        whole: whole !== 0,
        body: c.u32(n, "body"),
        points: c.u32(n, "points"),
        zones: c.u32(n, "zones"),
        triangles: c.u32(n, "triangles"),
        made: c.f32(3 * P, "made"),
        corner: c.u32(4 * Z, "corner"),
        solid: c.u16(Z, "solid"),
        home: c.u32(Z, "home"),
        triangle: c.u32(3 * T, "triangle"),
        zone: c.u32(T, "zone"),
        block: c.u32(T, "block"),
        face: c.u32(T, "face")
    };
    c.sum(s.points, P, "points");
    c.sum(s.zones, Z, "zones");
    c.sum(s.triangles, T, "triangles");
    c.below(s.corner, P, "corner");
    c.below(s.triangle, P, "triangle");
    c.below(s.zone, Z, "zone");
    c.below(s.solid, Math.max(1, head.solids.length), "solid");
    return s;
}

/** @param {Columns} c @returns {Points} */
function readPoints(c) {
    const n = c.u32(1, "count")[0];
    return {n, place: c.f32(3 * n, "place"), displacement: c.f32(3 * n, "displacement")};
}

/** @param {Columns} c @param {object[]} fields @returns {Numbers} */
function readNumbers(c, fields) {
    const [field, n] = c.u32(2, "counts");
    checkField(c, field, fields);
    return {field, value: c.f32(n, "value", true)};
}

/** @param {Columns} c @param {Head} head @returns {Elements} */
function readElements(c, head) {
    const [n, P] = c.u32(2, "counts");
    const e = {
        n,
        P,
        id: c.u32(n, "id"),
        kind: c.u32(n, "kind"),
        points: c.u32(n, "points"),
        flags: c.u32(n, "flags"),
        block: c.u32(P, "block"),
        place: c.f32(3 * P, "place")
    };
    c.sum(e.points, P, "points");
    c.below(e.kind, head.elements.length, "kind");
    return e;
}

/** @param {Columns} c @param {FrameData} frame @param {Head} head @returns {Numbers} */
function readElementField(c, frame, head) {
    const numbers = readNumbers(c, head.elementFields);
    checkCount(c, numbers.value.length, frame.elements?.P);
    return numbers;
}

/** @param {Columns} c @returns {Finding} */
function readFinding(c) {
    const f = c.json(), text = (/** @type {any} */ v) => (typeof v === "string" ? v : "");
    for (const name of ["closed", "contacts", "slipping"])
        if (!(Number.isFinite(f[name]) && f[name] >= 0)) throw c.bad(`${name} must be a number that is not negative`);
    return {
        standing: text(f.standing),
        text: text(f.text),
        stage: text(f.stage),
        closed: f.closed,
        contacts: f.contacts,
        slipping: f.slipping,
        hash: text(f.hash)
    };
}

/** @param {Columns} c @returns {Live} */
function readLive(c) {
    const h = c.json(), text = (/** @type {any} */ v) => (typeof v === "string" ? v : "");
    if (!["running", "paused", "waiting", "ended"].includes(h.state))
        throw c.bad("the state must be running, paused, waiting or ended");
    return {state: h.state, line: text(h.line), refused: text(h.refused)};
}

/**
 * Reads the chunks of one frame. `head` is the last one read before; of a run, `news` has the chunks that are in front
 * of the others.
 * @param {ArrayBuffer} buffer
 * @param {Head | null} head
 * @param {ArrayBuffer} [news]
 * @returns {FrameData}
 */
export function readFrame(buffer, head, news) {
    /** @type {FrameData} */
    const frame = {
        head: null,
        shapes: [],
        gone: [],
        refused: null,
        touches: null,
        surface: null,
        points: null,
        zones: [],
        elements: null,
        elementFields: [],
        poses: null,
        contacts: null,
        laws: null,
        extras: [],
        line: null,
        keys: null,
        finding: null,
        live: [],
        number: -1
    };
    if (news) readChunks(news, head, frame);
    readChunks(buffer, frame.head ?? head, frame);
    if (!frame.poses || frame.number < 0) throw new Error("A frame of the scene has no FRAM or no DONE.");
    return frame;
}

/** @param {ArrayBuffer} buffer @param {Head | null} head @param {FrameData} frame */
function readChunks(buffer, head, frame) {
    const view = new DataView(buffer);
    for (let at = 0; at < buffer.byteLength;) {
        if (at + 8 > buffer.byteLength) throw new Error("The scene ends within the head of a chunk.");
        const name = String.fromCharCode(...new Uint8Array(buffer, at, 4)).replace(/[^A-Za-z0-9 ]/g, "?");
        const bytes = view.getUint32(at + 4, true);
        if (bytes > buffer.byteLength - at - 8) throw new Error(`The scene ends within the chunk ${name}.`);
        const c = new Columns(name, buffer, at + 8, bytes);
        at += 8 + ((bytes + 3) & ~3);
        if (name === "HEAD") frame.head = head = readHead(c);
        else if (!head) throw new Error(`The scene begins with the chunk ${name} instead of HEAD.`);
        else if (name === "SHAP") frame.shapes.push(readShapes(c, head));
        else if (name === "GONE") frame.gone.push(c.u32(c.u32(1, "count")[0], "id"));
        else if (name === "REFU") frame.refused = readRefused(c, head);
        else if (name === "TOUC") frame.touches = readTouches(c);
        else if (name === "SURF") frame.surface = readSurface(c, head);
        else if (name === "SPOS") frame.points = readPoints(c);
        else if (name === "ZFLD") frame.zones.push(readNumbers(c, head.zoneFields));
        else if (name === "ELEM") frame.elements = readElements(c, head);
        else if (name === "EFLD") frame.elementFields.push(readElementField(c, frame, head));
        else if (name === "FRAM") frame.poses = readPoses(c);
        else if (name === "CONT") frame.contacts = readContacts(c, head);
        else if (name === "LAWS") frame.laws = readLaws(c, frame, head);
        else if (name === "FIEL") frame.extras.push(readExtra(c, frame, head));
        else if (name === "LINE")
            frame.line = {
                numbers: Array.from(c.f64(8, "numbers", true)),
                histories: c.f64(c.u32(1, "count")[0], "histories", true)
            };
        else if (name === "KEYS") frame.keys = readKeys(c);
        else if (name === "FIND") frame.finding = readFinding(c);
        else if (name === "LIVE") frame.live.push(readLive(c));
        else if (name === "DONE") frame.number = c.u32(1, "number")[0];
    }
}
