// The picked block in figures, and what can be done with it.
// @ts-check
import {STATES, plain} from "./colours.js";
import {button, byId, element} from "./dom.js";
import {dot, figure, norm, scale, sub, trendPlunge, triple} from "./math.js";
import {pairOf} from "./scene.js";
import {slimness} from "./slimness.js";
import {zoneColumn} from "./zones.js";

const LISTED = 12; // ids of several blocks that are listed
const MOST = 60;   // contacts of a block that are listed
const KEYS = ["stable", "falls", "slides on one face", "slides on two faces"];

/** Trend and plunge as 270/33. @param {number[]} v */
export function directionText(v) {
    const d = trendPlunge(v), trend = Math.round(d.trend) % 360;
    const plunge = String(Math.abs(Math.round(d.plunge))).padStart(2, "0");
    return `${String(trend).padStart(3, "0")}/${d.plunge < -0.5 ? "−" : ""}${plunge}`;
}

/** @param {number} kg */
function massText(kg) { return kg >= 1000 ? `${figure(kg / 1000)} t` : `${figure(kg)} kg`; }

/**
 * What is known of the zones of a block.
 * @param {import("./frames.js").Frame} frame
 * @param {number} id
 * @returns {[string, string][]}
 */
function zoneRows(frame, id) {
    const {surface, head, data} = frame, states = zoneColumn(data, head, "state");
    const own = surface ? [...surface.home.keys()].filter((z) => surface.home[z] === id) : [];
    return own.length ? [["zones", `${own.length}, ${own.filter((z) => states && states[z] > 0).length} yielded`]] : [];
}

/**
 * Names and values of what is known of a block.
 * @param {import("./frames.js").Model} model
 * @param {import("./frames.js").Frame} frame
 * @param {number} id
 * @returns {[string, string][] | null}
 */
export function blockRows(model, frame, id) {
    const i = frame.poses.id.indexOf(id);
    if (i < 0) return null;
    const row = frame.rows[i], {shapes, block} = model.shape[row], p = frame.poses, head = frame.head;
    const three = (/** @type {Float32Array} */ c) => triple(c, i);
    const moved = three(p.displacement), speed = norm(three(p.velocity)), joints = new Set(), k = frame.data.contacts;
    model.eachFace(row, (_f, _c, _n, joint) => {
        if (joint) joints.add(head.joints[joint]);
    });
    let contacts = 0, slipping = 0;
    for (let c = 0; k && c < k.n; c++) {
        if (k.a[c] !== id && k.b[c] !== id) continue;
        contacts++;
        slipping += k.state[c] === 1 ? 1 : 0;
    }
    const centroid = three(p.place).map((v, c) => (v + head.origin[c]).toFixed(2).replace("-", "−"));
    /** @type {[string, string][]} */ const rows = [
        ["group", head.groups[shapes.group[block]] || "none"], ["volume", `${figure(shapes.volume[block])} m³`],
        ["aspect", figure(slimness(model).aspect[row])],
        ["mass", massText(shapes.volume[block] * shapes.density[block])], ["centroid", `${centroid.join(", ")} m`],
        ["displacement", `${figure(norm(moved))} m`], ["direction", norm(moved) > 0 ? directionText(moved) : "–"],
        ["velocity", `${figure(speed)} m/s`], ["turned", `${figure(norm(three(p.rotation)) * 180 / Math.PI)}°`],
        ["held", p.flags[i] & 1 ? "yes" : "no"], ["unbalanced", `${figure(p.unbalanced[i])} N`]
    ];
    if (shapes.body[block] !== id) rows.push(["body", String(shapes.body[block])]);
    rows.push(...zoneRows(frame, id));
    if (k) rows.push(["contacts", `${contacts}, ${slipping} slipping`]);
    rows.push(["joints", [...joints].join(", ") || "none"]);
    const keys = frame.data.keys, at = keys ? keys.id.indexOf(shapes.body[block]) : -1;
    if (keys && at >= 0) {
        rows.push(["keyblock", KEYS[keys.mode[at]]]);
        if (Number.isFinite(keys.factor[at])) rows.push(["safety", figure(keys.factor[at])]);
    }
    for (const e of frame.data.extras)
        if (e.of === 0)
            rows.push([plain(head.fields[e.field].name), `${figure(e.value[i])} ${head.fields[e.field].unit}`]);
    return rows;
}

/**
 * Names and values of what is known of a contact.
 * @param {import("./frames.js").Frame} frame
 * @param {number} id
 * @returns {[string, string][] | null}
 */
export function contactRows(frame, id) {
    const k = frame.data.contacts, c = k ? k.id.indexOf(id) : -1;
    if (!k || c < 0) return null;
    const n = triple(k.normal, c), force = triple(k.force, c), press = dot(force, n);
    const shear = norm(sub(force, scale(n, press))), area = k.area[c];
    const out = (/** @type {number} */ v, /** @type {string} */ unit) =>
        (Number.isFinite(v) ? `${figure(v)} ${unit}` : "–");
    /** @type {[string, string][]} */ const rows = [
        ["blocks", `${k.a[c]} and ${k.b[c]}`], ["joint", frame.head.joints[k.joint[c]] || "none"],
        ["law", frame.head.laws[frame.data.laws?.[c] ?? 0] || "none"], ["state", STATES[k.state[c]].name],
        ["area", out(area, "m²")], ["gap", out(k.gap[c], "m")], ["slip", out(k.slip[c], "m")],
        ["normal force", out(press, "N")], ["shear force", out(shear, "N")], ["normal stress", out(press / area, "Pa")],
        ["shear stress", out(shear / area, "Pa")],
        ["strength used", Number.isFinite(k.used[c]) ? `${figure(100 * k.used[c])} %` : "–"]
    ];
    for (const e of frame.data.extras)
        if (e.of === 1)
            rows.push([plain(frame.head.fields[e.field].name), out(e.value[c], frame.head.fields[e.field].unit)]);
    return rows;
}

/**
 * The contacts of a block: id, and what is known in a line.
 * @param {import("./frames.js").Frame} frame
 * @param {number} id
 * @returns {{id: number, text: string}[]}
 */
export function contactsOf(frame, id) {
    const k = frame.data.contacts, out = [];
    for (let c = 0; k && c < k.n; c++) {
        if (k.a[c] !== id && k.b[c] !== id) continue;
        const used = Number.isFinite(k.used[c]) ? `, ${figure(100 * k.used[c])} %` : "";
        out.push({id: k.id[c], text: `${k.a[c] === id ? k.b[c] : k.a[c]}: ${STATES[k.state[c]].name}${used}`});
    }
    return out;
}

/**
 * Names and values of what is known of several blocks together.
 * @param {import("./frames.js").Model} model
 * @param {import("./frames.js").Frame} frame
 * @param {number[]} ids
 * @returns {[string, string][]}
 */
export function togetherRows(model, frame, ids) {
    let volume = 0, mass = 0, held = 0, most = 0, known = 0;
    for (const id of ids) {
        const i = frame.poses.id.indexOf(id);
        if (i < 0) continue;
        const {shapes, block} = model.shape[frame.rows[i]];
        known++;
        volume += shapes.volume[block];
        mass += shapes.volume[block] * shapes.density[block];
        held += frame.poses.flags[i] & 1;
        most = Math.max(most, norm(triple(frame.poses.displacement, i)));
    }
    return [
        ["volume", `${figure(volume)} m³`], ["mass", massText(mass)], ["held", String(held)],
        ["most displaced", `${figure(most)} m`],
        ["ids", ids.slice(0, LISTED).join(", ") + (ids.length > LISTED ? " …" : "")],
        ...(known < ids.length ? /** @type {[string, string][]} */ ([["not in this frame", String(ids.length - known)]])
                               : [])
    ];
}

/** @param {import("./page.js").Page} app */
export function makeTable(app) {
    const box = byId("picked"), title = element("h2"), body = element("tbody");
    const none = element("p", {}, "There is no such block in this frame.");
    const set = (/** @type {Set<number>} */ s) => {
        const ids = app.picks(), all = ids.every((id) => s.has(id));
        for (const id of ids) all ? s.delete(id) : s.add(id);
        app.change("pose");
    };
    const commands = element("div", {className: "buttons"}), list = element("div", {className: "buttons"});
    const touching = element("details", {}, element("summary"), list);
    const views = element(
        "div", {className: "buttons"}, button("Hide", () => app.hidePicked(), "Hide in the picture"),
        button("Only", () => set(app.view.only)), button("Ghost", () => set(app.view.ghosts)),
        button("Zoom", () => app.zoomPicked()));
    box.replaceChildren(
        title, element("table", {}, body), none, views, touching, commands,
        element("div", {className: "buttons"}, button("Close", () => app.pick(-1))));
    return {
        update() {
            const ids = app.picks(), {frame} = app, contact = ids.length === 0 ? app.view.contact : -1;
            box.hidden = ids.length === 0 && contact < 0;
            if (!frame || box.hidden) return;
            const rows = contact >= 0 ? contactRows(frame, contact)
                : ids.length > 1      ? togetherRows(app.model, frame, ids)
                                      : blockRows(app.model, frame, ids[0]);
            const known = rows ?? [];
            title.textContent = contact >= 0 ? `Contact of blocks ${pairOf(contact)}`
                : ids.length > 1 ? `${ids.length} blocks`
                                 : `Block ${ids[0]}`;
            none.textContent = `There is no such ${contact >= 0 ? "contact" : "block"} in this frame.`;
            none.hidden = rows !== null;
            const near = ids.length === 1 ? contactsOf(frame, ids[0]) : [];
            views.hidden = contact >= 0;
            touching.hidden = near.length === 0;
            touching.firstChild.textContent = `${near.length} contacts: with block, state, strength used`;
            while (list.childElementCount > near.length) list.lastChild.remove();
            near.slice(0, MOST).forEach((c, i) => {
                const b = list.children[i] ?? list.appendChild(button("", () => app.pickContact(Number(b.value))));
                b.value = c.id;
                if (b.textContent !== c.text) b.textContent = c.text;
            });
            // buttons stay, and cells as far as they can: they are used while frames of a run come
            while (body.rows.length > known.length) body.lastChild.remove();
            known.forEach((row, i) => row.forEach((text, k) => {
                const line =
                    body.rows[i] ?? body.appendChild(element("tr", {}, element("th", {scope: "row"}), element("td")));
                const cell = line.cells[k];
                if (cell.textContent !== text) cell.textContent = text;
            }));
            if (app.run && !commands.firstChild && app.run.takes()) commands.append(...app.run.blockButtons());
            commands.hidden = contact >= 0 || !app.run?.takes();
        }
    };
}
