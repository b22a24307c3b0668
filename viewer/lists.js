// Lists in the panel: the worst slivers, and the cuts that were refused. They are made when they are opened.
// @ts-check
import {button, element} from "./dom.js";
import {capital, dot, figure, scale, add, sub, trendPlunge, triple} from "./math.js";
import {slimness} from "./slimness.js";

const WORST = 20;

/**
 * Places in a frame of its worst slivers, those of the least volume over surface.
 * @param {import("./frames.js").Model} model
 * @param {import("./frames.js").Frame} frame
 */
function worst(model, frame) {
    const {bulk} = slimness(model), of = (/** @type {number} */ i) => bulk[frame.rows[i]];
    return [...frame.rows.keys()].sort((a, b) => of(a) - of(b) || a - b).slice(0, WORST);
}

/** @param {import("./page.js").Page} app */
export function makeLists(app) {
    /**
     * A list that is filled while it is open, and anew only when something else is in it.
     * @param {string} words
     * @param {(frame: import("./frames.js").Frame) => {key: string, make: () => Node[]}} fill
     */
    const list = (words, fill) => {
        const heading = element("summary", {}, words), inside = element("div");
        const node = element("details", {ontoggle: () => update()}, heading, inside);
        let known = "";
        function update() {
            if (!node.open || !app.frame) return;
            const {key, make} = fill(app.frame);
            if (key !== known) inside.replaceChildren(...make());
            known = key;
        }
        return {node, heading, update};
    };
    const zoom = (/** @type {number} */ id) => {
        app.pick(id);
        app.zoomPicked();
    };

    const slivers = list("Slivers", (frame) => {
        const rows = worst(app.model, frame), {aspect, bulk} = slimness(app.model);
        return {
            key: rows.map((i) => `${frame.poses.id[i]},${frame.rows[i]}`).join(),
            make: () =>
                [element(
                     "p", {},
                     `The ${rows.length} blocks of the least volume over surface. They make the time step small.`),
                 element(
                     "table", {},
                     element("tr", {}, ...["block", "m³/m²", "aspect"].map((t) => element("th", {scope: "col"}, t))),
                     ...rows.map((i) => {
                         const id = frame.poses.id[i], row = frame.rows[i];
                         return element(
                             "tr", {},
                             element("td", {}, button(String(id), () => zoom(id), `Pick block ${id} and zoom to it`)),
                             element("td", {}, figure(bulk[row])), element("td", {}, figure(aspect[row])));
                     }))]
        };
    });

    /** Lays the section where a cut would be. @param {number[]} normal @param {number[]} point */
    const showCut = (normal, point) => {
        const n = normal[2] < 0 ? scale(normal, -1) : normal, {trend, plunge} = trendPlunge(n);
        const away = sub(point, scale(add(app.home.min, app.home.max), 0.5));
        Object.assign(app.view, {dip: 90 + plunge, direction: trend, position: dot(n, away)});
        app.change("cut");
    };

    const refused = list("", (frame) => {
        const cuts = frame.refused;
        if (!cuts) return {key: "", make: () => []};
        const there = new Set(frame.poses.id), more = cuts.total - cuts.block.length;
        return {
            key: [cuts.total, ...cuts.block].map((id, i) => id + (i && there.has(id) ? "+" : "")).join(),
            make: () =>
                [...[...cuts.block].map((id, i) => {
                    const joint = frame.head.joints[cuts.joint[i]];
                    const plane = joint ? `joint '${joint}:${cuts.plane[i]}'` : "a plane without joint";
                    const side =
                        `${figure(cuts.thickness[i])} m thick, less than the limit of ${figure(cuts.limit[i])} m`;
                    const words = capital(`${plane} does not cut block ${id}: a side would be ${side}`);
                    const e = button(words + (there.has(id) ? "" : "; the block was cut or deleted since"), () => {
                        showCut(triple(cuts.normal, i), triple(cuts.point, i));
                        zoom(id);
                    });
                    e.disabled = !there.has(id);
                    return e;
                }),
                 ...(more > 0 ? [element("p", {}, `and ${more} more`)] : [])]
        };
    });

    return {
        nodes: [slivers.node, refused.node],
        update() {
            const total = app.frame?.refused?.total ?? 0;
            refused.node.hidden = total === 0;
            refused.heading.textContent = `Refused cuts: ${total}`;
            slivers.update();
            refused.update();
        }
    };
}
