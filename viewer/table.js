// The picked block in figures, and what can be done with it.
// @ts-check
import { plain } from "./colours.js";
import { button, byId, element } from "./dom.js";
import { capital, figure, norm, trendPlunge, triple } from "./math.js";

const KEYS = ["stable", "falls", "slides on one face", "slides on two faces"];

/** Trend and plunge as 270/33. @param {number[]} v */
export function directionText(v) {
    const d = trendPlunge(v), trend = Math.round(d.trend) % 360;
    return `${String(trend).padStart(3, "0")}/${d.plunge < -0.5 ? "−" : ""}${String(Math.abs(Math.round(d.plunge))).padStart(2, "0")}`;
}

/** @param {number} kg */
function massText(kg) { return kg >= 1000 ? `${figure(kg / 1000)} t` : `${figure(kg)} kg`; }

/** Names and values of what is known of a block. @param {import("./frames.js").Model} model @param {import("./frames.js").Frame} frame @param {number} id @returns {[string, string][] | null} */
export function blockRows(model, frame, id) {
    const i = frame.poses.id.indexOf(id);
    if (i < 0) return null;
    const row = frame.rows[i], { shapes, block } = model.shape[row], p = frame.poses, head = frame.head;
    const three = (/** @type {Float32Array} */ c) => triple(c, i);
    const moved = three(p.displacement), speed = norm(three(p.velocity)), joints = new Set(), k = frame.data.contacts;
    model.eachFace(row, (_f, _c, _n, joint) => { if (joint) joints.add(head.joints[joint]); });
    let contacts = 0, slipping = 0;
    for (let c = 0; k && c < k.n; c++) {
        if (k.a[c] !== id && k.b[c] !== id) continue;
        contacts++;
        slipping += k.state[c] === 1 ? 1 : 0;
    }
    /** @type {[string, string][]} */ const rows = [["group", head.groups[shapes.group[block]] || "none"], ["volume", `${figure(shapes.volume[block])} m³`],
        ["mass", massText(shapes.volume[block] * shapes.density[block])], ["centroid", `${three(p.place).map((v, c) => (v + head.origin[c]).toFixed(2).replace("-", "−")).join(", ")} m`],
        ["displacement", `${figure(norm(moved))} m`], ["direction", norm(moved) > 0 ? directionText(moved) : "–"], ["velocity", `${figure(speed)} m/s`],
        ["turned", `${figure(norm(three(p.rotation)) * 180 / Math.PI)}°`], ["held", p.flags[i] & 1 ? "yes" : "no"], ["unbalanced", `${figure(p.unbalanced[i])} N`]];
    if (shapes.body[block] !== id) rows.push(["body", String(shapes.body[block])]);
    if (k) rows.push(["contacts", `${contacts}, ${slipping} slipping`]);
    rows.push(["joints", [...joints].join(", ") || "none"]);
    const keys = frame.data.keys, at = keys ? keys.id.indexOf(shapes.body[block]) : -1;
    if (keys && at >= 0) {
        rows.push(["keyblock", KEYS[keys.mode[at]]]);
        if (Number.isFinite(keys.factor[at])) rows.push(["safety", figure(keys.factor[at])]);
    }
    for (const e of frame.data.extras) if (e.of === 0) rows.push([plain(head.fields[e.field].name), `${figure(e.value[i])} ${head.fields[e.field].unit}`]);
    return rows;
}

/** @param {import("./page.js").Page} app */
export function makeTable(app) {
    const box = byId("picked");
    let known = "";
    return { update() {
        const id = app.view.picked, rows = id >= 0 && app.frame ? blockRows(app.model, app.frame, id) : null;
        const now = JSON.stringify([id, rows]);
        box.hidden = id < 0;
        if (now === known) return;
        known = now;
        const focused = box.contains(document.activeElement) ? document.activeElement?.textContent : null;
        const command = (/** @type {string} */ op) => button(capital(op), () => app.command({ op, blocks: [id] }));
        const set = (/** @type {Set<number>} */ s) => { s.has(id) ? s.delete(id) : s.add(id); app.change("pose"); };
        box.replaceChildren(element("h2", {}, `Block ${id}`), rows ? element("table", {}, ...rows.map(([name, value]) => element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, value)))) :
            element("p", {}, "There is no such block in this frame."), element("div", { className: "buttons" }, button("Hide", () => app.hidePicked()), button("Only", () => set(app.view.only)),
            button("Ghost", () => set(app.view.ghosts)), button("Zoom", () => app.zoomPicked()), ...(app.model.head?.commands ? ["fix", "free", "delete"].map(command) : []),
            button("Close", () => app.pick(-1))));
        if (focused) for (const b of box.querySelectorAll("button")) if (b.textContent === focused) b.focus();
    } };
}
