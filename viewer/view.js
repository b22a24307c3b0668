// What is looked at and how: the state that the controls change and the address holds (#frame=3&cut=1&dip=60 ...).
// @ts-check

/**
 * @typedef {{frame: number, colour: string, edges: boolean, contacts: string, arrows: string, solid: string,
 *   opacity: number, moved: number, explode: number, motion: number, cut: boolean, other: boolean, dip: number,
 *   direction: number, position: number, parallel: boolean, net: boolean, dark: boolean, shadows: boolean,
 *   picked: number, contact: number, also: Set<number>, joint: string, hidden: Set<number>, ghosts: Set<number>,
 *   only: Set<number>, zones: string, mesh: boolean, smooth: boolean, crosses: boolean, elements: string}} View also:
 * all picked blocks, where there are several
 */

/** @returns {View} */
export function makeView() {
    return {
        frame: -1,
        colour: "displacement",
        edges: true,
        contacts: "",
        arrows: "",
        solid: "",
        opacity: 0.12,
        moved: 0,
        explode: 0,
        motion: 1,
        cut: false,
        other: false,
        dip: 90,
        direction: 90,
        position: 0,
        parallel: false,
        net: false,
        dark: false,
        shadows: true,
        picked: -1,
        contact: -1,
        also: new Set(),
        joint: "",
        hidden: new Set(),
        ghosts: new Set(),
        only: new Set(),
        zones: "",
        mesh: true,
        smooth: false,
        crosses: false,
        elements: ""
    };
}

/** The whole view as text, without what is as at the beginning. @param {View} view @param {string} camera */
export function viewText(view, camera) {
    /** @type {Record<string, any>} */ const start = makeView();
    const parts = [];
    for (const [name, value] of Object.entries(view)) {
        if (value instanceof Set) {
            if (value.size > 0 && value.size <= 2000) parts.push(`${name}=${[...value].join(",")}`);
        } else if (value !== start[name] || name === "frame") {
            const number = typeof value === "number" ? Number(value.toPrecision(6)) : Number(value);
            parts.push(`${name}=${typeof value === "string" ? encodeURIComponent(value) : number}`);
        }
    }
    return `#${parts.join("&")}&camera=${camera}`;
}

/**
 * Takes a view from an address; what it does not understand is left out. Gives the camera's text.
 * @param {View} view
 * @param {string} text
 */
export function readView(view, text) {
    let camera = "";
    /** @type {Record<string, any>} */ const out = view;
    const limits = /** @type {Record<string, [number, number]>} */ ({
        opacity: [0, 1],
        dip: [0, 90],
        direction: [0, 360],
        explode: [0, 3],
        motion: [0, 10000],
        moved: [0, Infinity],
        picked: [-1, 4294967295],
        contact: [-1, 2 ** 64],
        frame: [-1, Infinity]
    });
    for (const part of text.replace(/^#/, "").split("&")) {
        const at = part.indexOf("="), name = part.slice(0, at);
        let value;
        try {
            value = decodeURIComponent(part.slice(at + 1));
        } catch {
            continue;
        }
        if (name === "camera") camera = value;
        if (at < 1 || !Object.hasOwn(out, name)) continue;
        const number = Number(value), [low, high] = limits[name] ?? [-Infinity, Infinity];
        if (out[name] instanceof Set)
            for (const id of value.split(",").map(Number)) {
                if (Number.isInteger(id) && id >= 0) out[name].add(id);
            }
        else if (typeof out[name] === "boolean") out[name] = value === "1";
        else if (typeof out[name] === "number" && value !== "" && Number.isFinite(number))
            out[name] = Math.max(low, Math.min(high, number));
        else if (typeof out[name] === "string") out[name] = value;
    }
    return camera;
}
