// The panel of controls.
// @ts-check
import {blockColours, contactColours, zoneColours} from "./colours.js";
import {button, byId, checkBox, choice, element, labelled, slider} from "./dom.js";
import {elementColours} from "./elements.js";
import {makeLists} from "./lists.js";
import {figure} from "./math.js";

const MOTIONS = [0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];
const STEPS = 100; // of the slider of least displacement: four powers of ten below the largest

/** @param {import("./page.js").Page} app */
export function makeControls(app) {
    const {view} = app;
    /** @type {{update: () => void}[]} */ const all = [];
    const keep = (/** @type {{node: HTMLElement, update: () => void}} */ c) => {
        all.push(c);
        return c.node;
    };
    /** What sets a part of the view. @param {keyof typeof view} name @param {string} change */
    const set = (name, change) => (/** @type {any} */ v) => {
        Object.assign(view, {[name]: v});
        app.change(change);
    };
    /**
     * @param {"mesh" | "smooth" | "crosses" | "edges" | "parallel" | "net" | "dark" | "cut" | "other" | "shadows"} name
     * @param {string} words
     * @param {string} change
     */
    const check = (name, words, change) => keep(checkBox(words, () => view[name], set(name, change)));
    const group =
        (/** @type {string} */ title, /** @type {(Node | string)[]} */...nodes) => [element("h2", {}, title), ...nodes];
    const checks = (/** @type {Node[]} */...nodes) => element("div", {className: "checks"}, ...nodes);

    const least = {
        get: () =>
            (view.moved > 0
                 ? Math.max(1, Math.min(STEPS, Math.round(STEPS * (1 + Math.log10(view.moved / app.mostMoved()) / 4))))
                 : 0),
        set: (/** @type {number} */ v) => {
            view.moved = v > 0 ? app.mostMoved() * Math.pow(10, 4 * (v / STEPS - 1)) : 0;
            app.change("pose");
        }
    };
    const lists = makeLists(app);
    all.push(lists);
    const id = element("input", {
        type: "number",
        min: 0,
        onkeydown: (/** @type {KeyboardEvent} */ e) => {
            if (e.key === "Enter") find();
        }
    });
    const find = () => {
        if (id.value !== "") {
            app.pick(Number(id.value));
            app.zoomPicked();
        }
    };
    const zones = element(
        "div", {},
        ...group(
            "Zones", keep(choice("zones", () => zoneColours(app.model), () => view.zones, set("zones", "colour"))),
            checks(
                check("mesh", "mesh", "colour"), check("smooth", "smooth", "colour"),
                check("crosses", "principal stresses", "colour"))));
    const elements = element(
        "div", {},
        keep(choice("elements", () => elementColours(app.model.head), () => view.elements, set("elements", "pose"))));
    all.push({
        update() {
            zones.hidden = !app.model.surface;
            elements.hidden = !app.frame?.data.elements;
        }
    });
    const nodes = [
        ...group(
            "Colour", keep(choice("blocks", () => blockColours(app.model), () => view.colour, set("colour", "colour"))),
            keep(choice("contacts", () => contactColours(app.model), () => view.contacts, set("contacts", "pose"))),
            keep(choice(
                "arrows",
                () => [
                    ["", "none"], ["displacement", "displacement"], ["velocity", "velocity"],
                    ["force", "contact forces"]],
                () => view.arrows, set("arrows", "pose"))),
            elements),
        ...group(
            "Blocks",
            keep(choice(
                "shown", () => [["", "as is best"], ["yes", "solid"], ["no", "transparent"]], () => view.solid,
                set("solid", "pose"))),
            keep(slider(
                "moved over", 0, STEPS, 1, least.get, least.set,
                () => (view.moved > 0 ? `${figure(view.moved)} m` : "0 m"))),
            keep(slider(
                "ghosts", 0, 1, 0.01, () => view.opacity, set("opacity", "pose"),
                () => `${Math.round(view.opacity * 100)} %`)),
            keep(slider("explode", 0, 2, 0.01, () => view.explode, set("explode", "pose"), () => figure(view.explode))),
            keep(slider(
                "motion", 0, MOTIONS.length - 1, 1, () => Math.max(0, MOTIONS.findIndex((m) => m >= view.motion)),
                (v) => {
                    view.motion = MOTIONS[v];
                    app.change("pose");
                },
                () => `× ${figure(view.motion)}`)),
            checks(check("edges", "edges", "look"), check("shadows", "shadows", "look")),
            labelled("block", id, button("Find", find, "Find the block of this number")),
            element(
                "div", {className: "buttons"},
                button(
                    "Add",
                    () => {
                        if (id.value !== "") app.pickMore(Number(id.value));
                    },
                    "Pick the block of this number as well, or let go of it"),
                button("Hide", () => app.hidePicked(), "Hide the picked blocks"),
                button("Show all", () => app.showAll())),
            ...lists.nodes),
        zones,
        ...group(
            "Section", checks(check("cut", "cut", "pose"), check("other", "other side", "pose")),
            keep(slider("dip", 0, 90, 1, () => view.dip, set("dip", "cut"), () => `${figure(view.dip)}°`)),
            keep(slider(
                "direction", 0, 360, 1, () => view.direction,
                (v) => {
                    view.direction = v % 360;
                    app.change("cut");
                },
                () => `${String(Math.round(view.direction)).padStart(3, "0")}°`)),
            keep(slider(
                "position", -1, 1, 0.002, () => view.position / app.reach(),
                (v) => {
                    view.position = v * app.reach();
                    app.change("cut");
                },
                () => `${figure(Number(view.position.toPrecision(3)))} m`)),
            element(
                "div", {className: "buttons"}, button("Face it", () => app.faceCut(), "View square onto the section"),
                button(
                    "Through block", () => app.cutThrough(),
                    "Section through the picked or the farthest moved block"))),
        ...group(
            "View",
            element(
                "div", {className: "buttons"}, button("Plan", () => app.look(0, 90), "Plan: from above"),
                button("N", () => app.look(0, 0), "Towards north"), button("E", () => app.look(90, 0), "Towards east"),
                button("Oblique", () => app.look(app.oblique, 25)),
                button("Fit", () => app.fit(), "Fit the model into the window"),
                button("Image", () => app.saveImage(), "Save the picture as a PNG file")),
            checks(
                check("parallel", "parallel", "look"), check("net", "stereonet", "colour"),
                check("dark", "dark", "look"))),
    ];
    byId("controls").replaceChildren(...(app.run ? [app.run.node] : []), ...nodes);
    return {
        update() {
            for (const c of all) c.update();
        }
    };
}
