// Scales of colour and their legends. Sequential scales are monotone in lightness; categories are those of Okabe and
// Ito.
// @ts-check
import {column, lengths} from "./frames.js";
import {BEYOND, capital, figure} from "./math.js";
import {slimness} from "./slimness.js";
import {atPoints, zoneColumn, zoneNames, zoneUnit} from "./zones.js";

/** @typedef {import("./frames.js").Frame} Frame */
/** @typedef {import("./frames.js").Model} Model */
/**
 * @typedef {{title: string, kind: "scale", low: number, high: number, log: boolean, ramp: number[][],
 *   grey?: number} | {title: string, kind: "list", items: {name: string, colour: number[]}[]} | {title: string,
 *   kind: "text", text: string}} Legend
 */
/** @typedef {{colours: Uint8Array, palette: number[][], faces: boolean, legend: Legend}} Colouring */

const WARM = [[214, 217, 221], [240, 207, 144], [238, 154, 77], [206, 78, 46], [134, 19, 39]];
const COOL = [[240, 244, 247], [185, 211, 232], [106, 165, 207], [45, 106, 168], [12, 47, 102]];
export const NONE = [190, 194, 199];
export const QUIET = WARM[0]; // what has but closed its joints
/* Factors of safety: below 1, then up to the limit that is asked for, then beyond it. */
const UNSAFE = [134, 19, 39];
const SCARCE = [[222, 92, 48], [238, 154, 77], [240, 207, 144]];
const SAFE = [[160, 200, 226], [92, 150, 198], [36, 92, 150]];
const HOLDS = [0, 158, 115]; // at every factor that was tried
const FACTORS = [1, 1.2, 1.5, 2];
const OKABE = [
    [86, 180, 233], [230, 159, 0], [0, 158, 115], [204, 121, 167], [240, 228, 66], [0, 114, 178], [213, 94, 0],
    [150, 150, 150]
];
const MODES = [
    ["stable", [150, 180, 205]], ["falls", [134, 19, 39]], ["slides on one face", [230, 110, 40]],
    ["slides on two faces", [240, 200, 70]]
];
export const STATES = [
    {name: "elastic", colour: [150, 170, 190]}, {name: "slipping", colour: [213, 94, 0]},
    {name: "open", colour: [86, 180, 233]}, {name: "failed", colour: [150, 40, 110]},
    {name: "slipped before", colour: [240, 190, 90]}
];

/** A field's name in words. @param {string} name */
export function plain(name) { return name.replaceAll("_", " "); }

/** @param {number} i */
export function category(i) {
    const base = OKABE[i % OKABE.length], round = Math.floor(i / OKABE.length);
    const s = round === 0 ? 1 : Math.pow(0.78, round % 3 + 1);
    return base.map((c) => Math.round(round > 3 ? 255 - (255 - c * s) * 0.8 : c * s));
}

/** A quiet colour of a number, never the same beside its neighbours' numbers. @param {number} id */
function tint(id) {
    const h = ((id * 2654435761) >>> 0) / 4294967296, a = 2 * Math.PI * h;
    const l = 150 + 38 * ((((id * 40503) >>> 0) % 7) / 6 - 0.5);
    return [l + 20 * Math.cos(a), l + 16 * Math.cos(a - 2.1), l + 22 * Math.cos(a + 2.1)].map(Math.round);
}

/** @param {number[][]} ramp @param {number} t @returns {number[]} */
export function ramp(ramp, t) {
    const x = Math.max(0, Math.min(1, t)) * (ramp.length - 1), i = Math.min(ramp.length - 2, Math.floor(x)), f = x - i;
    return ramp[i].map((c, k) => Math.round(c + (ramp[i + 1][k] - c) * f));
}

/** Next round number above. @param {number} x */
export function roundUp(x) {
    if (!(x > 0)) return 1;
    const ten = Math.pow(10, Math.floor(Math.log10(x)));
    for (const s of [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10])
        if (s * ten >= x * (1 - 1e-6)) return s * ten;
    return 10 * ten;
}

/** Ways to colour blocks: name and words. @param {Model} model @returns {[string, string][]} */
export function blockColours(model) {
    const head = model.head, keys = model.keys;
    return [
        ["displacement", "displacement"], ["velocity", "velocity"], ["rotation", "rotation"],
        ["unbalanced", "unbalanced force"], ["volume", "volume"], ["bulk", "volume over surface"], ["aspect", "aspect"],
        ["group", "group"], ["body", "body"], ["joint", "joint (faces)"], ["block", "block"], ["held", "held"],
        .../** @type {[string, string][]} */ (keys ? [["keys", "keyblocks"], ["safety", "factor of safety"]] : []),
        .../** @type {[string, string][]} */ (
            (head?.fields ?? []).filter((f) => f.of === "blocks").map((f) => [`field:${f.name}`, plain(f.name)]))
    ];
}

/** Ways to colour contacts. @param {Model} model @returns {[string, string][]} */
export function contactColours(model) {
    const fields = (model.head?.fields ?? []).filter((f) => f.of === "contacts");
    const own = ["state", "normal stress", "shear stress", "slip", "joint", ...(model.head?.laws[2] ? ["law"] : [])];
    return [
        ["", "none"], .../** @type {[string, string][]} */ (own.map((name) => [name, name])),
        .../** @type {[string, string][]} */ (fields.map((f) => [`contact field:${f.name}`, plain(f.name)]))
    ];
}

/** Ways to colour zones. @param {Model} model @returns {[string, string][]} */
export function zoneColours(model) {
    const head = model.head;
    const names = ["displacement", "state", "solid", ...(head ? zoneNames(head) : [])];
    return [["", "as blocks"], .../** @type {[string, string][]} */ (names.map((name) => [name, plain(name)]))];
}

/**
 * A ramp from low to high that is light at 0: cool below, warm above, as strong as the value is large.
 * @param {number} low
 * @param {number} high
 */
function signed(low, high) {
    const most = Math.max(-low, high), steps = 64;
    const warm = low < 0 ? [COOL[0], ...WARM.slice(1)] : WARM;
    return Array.from({length: steps + 1}, (_v, i) => {
        const value = low + i / steps * (high - low);
        return value < 0 ? ramp(COOL, -value / most) : ramp(warm, value / most);
    });
}

/** @param {string} name @param {string} unit @param {number} least @param {number} most */
function signedScale(name, unit, least, most) {
    const low = least < 0 ? -roundUp(-least) : 0;
    const high = most > 0 ? roundUp(most) : low < 0 ? 0 : 1;
    const title = capital(plain(name)) + (unit ? `, ${unit}` : "");
    return {title, kind: /** @type {const} */ ("scale"), low, high, log: false, ramp: signed(low, high)};
}

/**
 * The scale of a column, one for all frames.
 * @param {Model} model
 * @param {string} name
 * @returns {Extract<Legend, {kind: "scale"}>}
 */
export function scaleOf(model, name) {
    const head = /** @type {import("./scene.js").Head} */ (model.head);
    const most = model.largest(name), least = model.least(name), size = head.size;
    const [kind, of] = name.split(":");
    if (kind === "zone") return signedScale(of, zoneUnit(head, of), least, most);
    if (kind === "element")
        return signedScale(of, head.elementFields.find((f) => f.name === of)?.unit ?? "", least, most);
    const weight = 1e-3 * Math.hypot(...head.gravity) * model.density * size ** 3;
    /** @type {Record<string, [string, number]>} */
    const floors = {
        displacement: ["Displacement, m", model.surface ? 0 : size / 1000], // zones strain by little
        velocity: ["Velocity, m/s", size / 1000],
        rotation: ["Rotation, °", 0.05],
        unbalanced: ["Unbalanced force, N", weight],
        "normal stress": ["Normal stress, Pa", 1],
        "shear stress": ["Shear stress, Pa", 1],
        slip: ["Slip, m", size / 1e5],
        force: ["Force, N", weight]
    };
    const known = floors[name];
    if (known && name !== "normal stress")
        return {
            title: known[0],
            kind: "scale",
            low: 0,
            high: roundUp(Math.max(most, known[1])),
            log: false,
            ramp: WARM
        };
    const field = head.fields.find((f) => (f.of === "blocks" ? "field:" : "contact field:") + f.name === name);
    const title = known ? known[0] : field ? capital(plain(field.name)) + (field.unit ? `, ${field.unit}` : "") : name;
    const low = least >= 0 || !Number.isFinite(least) ? 0 : -roundUp(-least);
    const high = most > 0 ? roundUp(most) : low < 0 ? 0 : 1;
    return {title, kind: "scale", low, high, log: false, ramp: COOL};
}

/**
 * Colour of a value on a scale.
 * @param {Extract<Legend, {kind: "scale"}>} scale
 * @param {number} value
 * @returns {number[]}
 */
export function scaled(scale, value) {
    if (!Number.isFinite(value)) return NONE;
    const {low, high} = scale;
    if (value <= (scale.grey ?? -Infinity)) return QUIET;
    return ramp(scale.ramp, scale.log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
}

/**
 * Classes of factors of safety, ascending: 1 and the limit that is asked for are between two of them.
 * @param {number} limit NaN: none
 */
export function safetyClasses(limit) {
    const ends = [...new Set([...FACTORS, ...(limit > 1 ? [limit] : [])])].sort((a, b) => a - b);
    const safe = limit > 1 ? limit : 1.5;
    const name = (/** @type {number} */ x) => (x === limit ? `${figure(x)} (limit)` : x === 1 ? "1.0" : figure(x));
    const scarce = ends.filter((e) => e < safe).length;
    const shade = (/** @type {number[][]} */ of, /** @type {number} */ i, /** @type {number} */ n) =>
        of[Math.round(i * (of.length - 1) / Math.max(1, n - 1))];
    return [
        {name: `below ${name(1)}`, colour: UNSAFE, from: -Infinity},
        ...ends.map((from, i) => ({
                        from,
                        name: i + 1 < ends.length ? `${name(from)} to ${name(ends[i + 1])}` : `above ${name(from)}`,
                        colour: from < safe ? shade(SCARCE, i, scarce) : shade(SAFE, i - scarce, ends.length - scarce)
                    }))
    ];
}

/**
 * The class of a factor; one that is not finite is that of a stable block.
 * @param {ReturnType<typeof safetyClasses>} classes
 * @param {number} factor
 */
export function classOf(classes, factor) {
    return Number.isFinite(factor) ? classes.filter((c) => c.from <= factor).pop() ?? classes[0]
                                   : classes[classes.length - 1];
}

/**
 * Colours of the blocks of a frame, by row.
 * @param {Model} model
 * @param {Frame} frame
 * @param {string} by
 * @returns {Colouring}
 */
export function colourBlocks(model, frame, by) {
    const colours = new Uint8Array(4 * model.rows), head = frame.head;
    const palette = [[206, 209, 213], ...head.joints.slice(1).map((_n, i) => category(i))];
    /** @param {(i: number, row: number) => number[]} colour */
    const paint = (colour) => {
        for (let i = 0; i < frame.poses.n; i++) colours.set(colour(i, frame.rows[i]), 4 * frame.rows[i]);
    };
    const of = (/** @type {number} */ row, /** @type {"group" | "body" | "volume" | "id"} */ what) =>
        model.shape[row].shapes[what][model.shape[row].block];
    const done = (/** @type {Legend} */ legend) => ({colours, palette, faces: by === "joint", legend});
    const title = capital(by);
    if (by === "group") {
        const list = head.groups.map((name, i) => ({name: name || "none", colour: category(i)}));
        paint((_i, row) => list[of(row, "group")]?.colour ?? NONE);
        return done({title, kind: "list", items: list});
    }
    if (by === "joint") {
        paint(() => palette[0]);
        return done({
            title: "Joint",
            kind: "list",
            items: head.joints.map((name, i) => ({name: name || "outer faces", colour: palette[i]}))
        });
    }
    if (by === "block" || by === "body") {
        paint((_i, row) => tint(of(row, by === "body" ? "body" : "id")));
        return done({title, kind: "text", text: `one tint for each ${by}`});
    }
    if (by === "held") {
        const items = [{name: "free", colour: WARM[1]}, {name: "held", colour: [110, 130, 155]}];
        paint((i) => items[frame.poses.flags[i] & 1].colour);
        return done({title: "Held", kind: "list", items});
    }
    const map = by === "field:safety" ? column(frame.data, head, by) : null;
    if (by === "keys" || by === "safety" || map) {
        const modes = new Map(), factors = new Map();
        const items = MODES.map(([name, colour]) => ({name: String(name), colour: /** @type {number[]} */ (colour)}));
        const keys = frame.data.keys;
        for (let i = 0; keys && i < keys.n; i++) {
            modes.set(keys.id[i], keys.mode[i]);
            factors.set(keys.id[i], keys.mode[i] === 1 ? 0 : keys.factor[i]);
        }
        const classes = safetyClasses(head.limit);
        paint((i, row) => {
            if (map) return Number.isNaN(map[i]) ? NONE : map[i] > BEYOND ? HOLDS : classOf(classes, map[i]).colour;
            const id = of(row, "body");
            return !modes.has(id) ? NONE
                : by === "keys"   ? items[modes.get(id)].colour
                                  : classOf(classes, factors.get(id)).colour;
        });
        return done({
            title: by === "keys" ? "Keyblocks" : "Factor of safety",
            kind: "list",
            items: [
                ...(by === "keys" ? items : classes), ...(map ? [{name: "holds in all trials", colour: HOLDS}] : []),
                {name: map ? "cannot move" : "no keyblock", colour: NONE}
            ]
        });
    }
    if (by === "volume" || by === "bulk" || by === "aspect") { // slivers are dark in the last two
        const slim = by === "volume" ? null : slimness(model)[by];
        const value = (/** @type {number} */ row) => (slim ? slim[row] : of(row, "volume"));
        let low = Infinity, high = 0;
        for (let row = 0; row < model.rows; row++) {
            low = Math.min(low, value(row));
            high = Math.max(high, value(row));
        }
        /** @type {Extract<Legend, {kind: "scale"}>} */ const scale = {
            title:
                {volume: "Volume, m³", bulk: "Volume over surface, m", aspect: "Aspect: diameter over thickness"}[by],
            kind: "scale",
            low,
            high: Math.max(high, low * 1.01),
            log: true,
            ramp: slim ? by === "bulk" ? [...WARM].reverse() : WARM : COOL
        };
        paint((_i, row) => scaled(scale, value(row)));
        return done(scale);
    }
    const values = column(frame.data, head, by), scale = scaleOf(model, by);
    if (by === "displacement" && frame.data.finding && !frame.surface) scale.grey = frame.data.finding.closed;
    paint((i) => (values ? scaled(scale, values[i]) : NONE));
    return done(scale);
}

/**
 * Colours of the contacts of a frame.
 * @param {Model} model
 * @param {Frame} frame
 * @param {string} by
 * @returns {{colour: (i: number) => number[], legend: Legend}}
 */
export function colourContacts(model, frame, by) {
    const k = frame.data.contacts;
    if (by === "joint" || by === "law") {
        const of = by === "joint" ? k?.joint : frame.data.laws;
        const names = by === "joint" ? frame.head.joints : frame.head.laws;
        return {
            colour: (i) => (of?.[i] ? category(of[i] - 1) : NONE),
            legend: {
                title: `Contacts: ${by}`,
                kind: "list",
                items: names.map((name, i) => ({name: name || "none", colour: i ? category(i - 1) : NONE}))
            }
        };
    }
    if (by === "state") {
        const least = scaleOf(model, "slip").high / 100;
        const stateOf = (/** @type {number} */ i) => {
            if (!k) return 0;
            return k.state[i] === 0 && k.slip[i] > least ? 4 : k.state[i];
        };
        return {
            colour: (i) => STATES[stateOf(i)].colour,
            legend: {title: "Contacts: state", kind: "list", items: STATES}
        };
    }
    const values = column(frame.data, frame.head, by), scale = scaleOf(model, by);
    return {colour: (i) => (values ? scaled(scale, values[i]) : NONE), legend: scale};
}

const YIELDS =
    [[200, 206, 212], [213, 94, 0], [150, 40, 110], [0, 114, 178], [240, 190, 140], [215, 170, 205], [160, 205, 235]];

/** Colours of values, three bytes each. @param {Float32Array} values @param {(v: number) => number[]} colour */
function bytesOf(values, colour) {
    const out = new Uint8Array(3 * values.length);
    for (let i = 0; i < values.length; i++) out.set(colour(values[i]), 3 * i);
    return out;
}

/**
 * Colours of zones, or of gridpoints, and their legend; null: zones have the colour of their blocks.
 * @param {Model} model
 * @param {Frame} frame
 * @param {string} by
 * @param {boolean} smooth whether numbers of zones are shown by their means at gridpoints
 * @returns {{points: Uint8Array | null, zones: Uint8Array | null, legend: Legend} | null}
 */
export function colourZones(model, frame, by, smooth) {
    const {surface, head, data} = frame, {points} = data;
    if (!surface || !points || by === "") return null;
    if (by === "displacement") {
        const legend = scaleOf(model, by);
        return {points: bytesOf(lengths(points.displacement), (v) => scaled(legend, v)), zones: null, legend};
    }
    if (by === "state" || by === "solid") {
        const list = by === "state" ? head.zoneStates : head.solids;
        const items = list.map((name, i) => ({name, colour: by === "state" ? YIELDS[i] ?? NONE : category(i)}));
        const values = by === "state" ? zoneColumn(data, head, by) : Float32Array.from(surface.solid);
        const there = new Set(values ?? []);
        return {
            points: null,
            zones: values && bytesOf(values, (v) => items[v]?.colour ?? NONE),
            legend: {
                title: by === "state" ? "Zones: state" : "Zones: solid",
                kind: "list",
                items: items.filter((_item, i) => there.has(i))
            }
        };
    }
    const values = zoneColumn(data, head, by), legend = scaleOf(model, `zone:${by}`);
    if (!values) return null;
    const colours = bytesOf(smooth ? atPoints(surface, values) : values, (v) => scaled(legend, v));
    return {points: smooth ? colours : null, zones: smooth ? null : colours, legend};
}

/** Words of a legend, for those who do not see it. @param {Legend} legend */
export function legendText(legend) {
    if (legend.kind === "scale") {
        const grey = legend.grey ? `, grey up to ${figure(legend.grey)}: what only closed` : "";
        return `${legend.title}: from ${figure(legend.low)} to ${figure(legend.high)}${grey}`;
    }
    return `${legend.title}: ${legend.kind === "list" ? legend.items.map((i) => i.name).join(", ") : legend.text}`;
}
