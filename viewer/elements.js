// Elements: bolts and other bars as rods, water between walls as polygons, and their colours.
// @ts-check
import {NONE, plain, scaleOf, scaled} from "./colours.js";
import {ELEMENT, below} from "./glyphs.js";
import {add, cross, figure, sub, triple, unit} from "./math.js";
import {offset} from "./poses.js";
import {rowsOf} from "./zones.js";

/** @typedef {import("./frames.js").Frame} Frame */

const FACE = 8;     // flag of an element that is a polygon
const WIDTH = 0.02;  // of a rod, as a share of half the size of the model
const STATES = [
    {name: "sound", colour: [150, 170, 190]}, {name: "yielded", colour: [230, 159, 0]},
    {name: "broken", colour: [190, 40, 20]}, {name: "detached", colour: [120, 60, 140]}
];

/** State of an element by its flags: the worst. @param {number} flags */
const stateOf = (flags) => STATES[flags & 4 ? 3 : flags & 2 ? 2 : flags & 1];

/** Ways to colour elements. @param {import("./scene.js").Head | null} head @returns {[string, string][]} */
export function elementColours(head) {
    const names = ["none", "state", ...(head?.elementFields ?? []).map((f) => f.name)];
    return [["", "bars"], .../** @type {[string, string][]} */ (names.map((name) => [name, plain(name)]))];
}

/** Whether polygons of elements are shown, which lie within the model. @param {Frame} frame @param {string} by */
export function showsWalls(frame, by) {
    return by !== "" && by !== "none" && (frame.data.elements?.flags.some((f) => f & FACE) ?? false);
}

/**
 * What is drawn of the elements of a frame; "bars": each line by the first of its numbers.
 * @param {import("./frames.js").Model} model
 * @param {Frame} frame
 * @param {import("./poses.js").Shown} shown
 * @param {string} by
 * @param {import("./section.js").Plane | null} plane what lies above it is left out
 * @param {number} reach half the size of the model, m
 */
export function elementsFor(model, frame, shown, by, plane, reach) {
    const e = frame.data.elements, {head, data} = frame;
    /** @type {import("./buffers.js").Arrow[]} */ const rods = [];
    /** @type {import("./buffers.js").Sheet[]} */ const sheets = [];
    /** @type {Map<string, import("./colours.js").Legend>} */ const legends = new Map();
    if (!e || by === "none") return {rods, sheets, legends: []};
    if (by === "state") legends.set(by, {title: "Elements: state", kind: "list", items: STATES});
    const rows = rowsOf(model, frame, e.block), name = (/** @type {number} */ field) => head.elementFields[field].name;
    for (let i = 0, p = 0; i < e.n; p += e.points[i++]) {
        const face = (e.flags[i] & FACE) > 0, state = stateOf(e.flags[i]).colour;
        const of = data.elementFields.find((f) => (by === "" || name(f.field) === by) && !Number.isNaN(f.value[p]));
        if (face && (by === "" || (!of && by !== "state"))) continue;
        const scale = of && by !== "state" ? scaleOf(model, `element:${name(of.field)}`) : null;
        if (of && scale) legends.set(name(of.field), scale);
        const paint = (/** @type {number} */ v) => (scale ? scaled(scale, v) : by === "state" ? state : NONE);
        let at = Array.from(
            {length: e.points[i]},
            (_v, k) => [...add(triple(e.place, p + k), offset(frame, shown, rows[p + k])), of?.value[p + k] ?? NaN]);
        if (face && plane) at = below(at, plane);
        if (face && at.length > 2)
            sheets.push({
                place: at.flatMap((a) => a.slice(0, 3)),
                normal: unit(cross(sub(at[1], at[0]), sub(at[2], at[0]))),
                colour: NONE,
                colours: at.map((a) => paint(a[3])),
                flat: true,
                name: ELEMENT + i
            });
        for (let k = 1; k < at.length && !face; k++) {
            const [a, b] = plane ? below([at[k - 1], at[k]], plane) : [at[k - 1], at[k]];
            if (b)
                rods.push({
                    tail: a.slice(0, 3),
                    way: sub(b, a),
                    width: -WIDTH * reach,
                    colour: paint((at[k - 1][3] + at[k][3]) / 2),
                    name: ELEMENT + i
                });
        }
    }
    return {rods, sheets, legends: [...legends.values()]};
}

/** What an element is, and its state and numbers, in words. @param {Frame} frame @param {number} i its place */
export function elementText(frame, i) {
    const e = /** @type {import("./scene.js").Elements} */ (frame.data.elements), {head, data} = frame;
    const first = e.points.subarray(0, i).reduce((a, b) => a + b, 0);
    const numbers = data.elementFields.flatMap((f) => {
        const of = f.value.subarray(first, first + e.points[i]), {name, unit} = head.elementFields[f.field];
        const ends = [Math.min(...of), Math.max(...of)].map(figure);
        return Number.isNaN(of[0]) ? [] : [`${plain(name)} ${[...new Set(ends)].join(" to ")} ${unit}`];
    });
    return `Element ${e.id[i]}, ${head.elements[e.kind[i]]}, ${stateOf(e.flags[i]).name}: ${numbers.join(", ")}`;
}
