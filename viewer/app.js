// The state of the page: what is changed decides what is made anew; the rest of the time pictures are averaged.
// @ts-check
import {sheetMesh} from "./buffers.js";
import {Camera} from "./camera.js";
import {category, colourBlocks, colourContacts, colourZones, legendText} from "./colours.js";
import {byId, say} from "./dom.js";
import {elementsFor} from "./elements.js";
import {Model} from "./frames.js";
import {arrowsFor, contactSheets} from "./glyphs.js";
import {SAMPLES, makeGpu, noGpu} from "./gpu.js";
import {add, figure, multiply, scale} from "./math.js";
import {drawAxes, drawLegends, legendSize, penOf} from "./overlay.js";
import {fillTable, showFrame, tightBox} from "./poses.js";
import {capSheets, cutBlocks, sectionPlane} from "./section.js";
import {makeView, readView, viewText} from "./view.js";
import {PRESSED, PULLED, capMesh, crossSheets, cutZones, surfaceMesh} from "./zones.js";

const STILL = 160;             // ms without a change after which pictures are averaged
const SLOW = 80;               // ms of a draft from which it is drawn at half the resolution
const MANY = 200000;           // triangles from which the first draft is drawn at half the resolution
const TELLING = 200;           // ms between two states of the panels while frames of a run follow each other
const PICKED = [10, 102, 242]; // colour of the picked blocks, where there are several
const ORDER = ["camera", "look", "colour", "cut", "pose", "frame"]; // each makes anew what those before it do

export class App {
    constructor() {
        this.model = new Model();
        this.view = makeView();
        this.camera = new Camera();
        this.canvas = /** @type {HTMLCanvasElement} */ (byId("picture"));
        this.blind = ""; // why nothing is drawn; finding, chart and net are there all the same
        this.gpu = this.seeing();
        this.width = this.height = 1;
        /** @type {import("./frames.js").Frame | null} */ this.frame = null;
        /** @type {import("./poses.js").Shown | null} */ this.shown = null;
        /** @type {import("./section.js").Plane | null} */ this.plane = null;
        /** @type {import("./section.js").Cut[]} */ this.cuts = [];
        /** @type {import("./zones.js").ZoneCut | null} */ this.zoneCut = null;
        /** @type {import("./colours.js").Legend[]} */ this.legends = [];
        this.note = "";
        this.live = false;
        this.following = true; // the newest frame of a run
        this.loud = true;      // something but the newest frame has changed
        this.told = this.telling = 0;
        this.reading = false; // frames that the first picture does not need
        /** @type {ReturnType<typeof import("./live.js").makeRun> | null} */ this.run = null;
        this.token = "";
        this.chart = "largest";
        this.speed = 1;
        this.oblique = 30;
        this.home = {min: [-1, -1, -1], max: [1, 1, 1]};
        this.dirty = -1;
        this.samples = SAMPLES;
        this.sample = 0;
        this.changed = 0;
        this.draftCost = this.fullCost = 0;
        this.asked = false;
        this.shapes = -1;
        this.shadow = false;
        this.number = 0; // of pictures drawn
        this.light = new Float32Array(16);
        /** @type {(() => void)[]} */ this.waiting = [];
        /** @type {{update: () => void}[]} */ this.parts = []; // of the window around the picture
        this.address = "";
    }

    /** What draws, or where the browser cannot, what does nothing. */
    seeing() {
        try {
            return makeGpu(this.canvas);
        } catch (error) {
            this.blind = String(/** @type {Error} */ (error).message);
            this.view.net = true;
            return noGpu();
        }
    }

    resize() {
        const ratio = Math.min(2, devicePixelRatio || 1);
        this.width = Math.max(1, this.canvas.clientWidth);
        this.height = Math.max(1, this.canvas.clientHeight);
        const w = Math.round(this.width * ratio), h = Math.round(this.height * ratio);
        // even the same number would empty it
        if (this.canvas.width !== w) this.canvas.width = w;
        if (this.canvas.height !== h) this.canvas.height = h;
        const wide = this.width > 700;
        this.camera.margins = {left: wide ? 220 : 0, right: wide ? 262 : 0, top: 84, bottom: 104};
        this.change("camera");
    }

    /** @param {string} what one of ORDER @param {boolean} [loud] the panels tell it at once */
    change(what, loud = true) {
        this.loud ||= loud;
        this.dirty = Math.max(this.dirty, ORDER.indexOf(what));
        this.sample = 0;
        this.changed = performance.now();
        if (!this.asked) {
            this.asked = true;
            requestAnimationFrame(() => this.tick());
        }
    }

    /** Until the next picture is there. @returns {Promise<void>} */
    drawn() {
        return new Promise((done) => {
            this.waiting.push(done);
            this.change("camera");
        });
    }

    /** Until the next picture that is asked for is there. @returns {Promise<void>} */
    painted() {
        return new Promise((done) => {
            this.waiting.push(done);
        });
    }

    /** Until the average is complete. */
    async settled() {
        do await new Promise((done) => setTimeout(done, 20));
        while (this.sample < this.samples || this.asked || this.reading);
    }

    /** @param {number} index @param {boolean} [loud] */
    async goTo(index, loud = true) {
        const last = this.model.frames.length - 1, at = Math.max(0, Math.min(last, Math.round(index)));
        this.view.frame = at;
        this.following = at === last;
        try {
            const frame = await this.model.frame(at);
            if (this.view.frame === at) {
                this.frame = frame;
                this.change("frame", loud);
            }
        } catch (error) {
            say(String(/** @type {Error} */ (error).message), true);
        }
    }

    /** Displacement from which a block counts as moving: a twentieth of the largest, and no closing of joints. */
    threshold() {
        return Math.max(
            0.05 * this.mostMoved(), this.frame?.data.finding?.closed ?? (this.model.head?.size ?? 1) / 1000);
    }
    mostMoved() { return Math.max(this.model.largest("displacement"), 1e-12); }
    reach() { return boxReach(this.home); }
    bounds() { return this.shown?.bounds ?? this.home; }

    /** @param {number} width @param {number} height */
    sight(width, height) {
        const m = this.camera.margins, k = height / this.height;
        this.camera.margins = {
            left: m.left * width / this.width,
            right: m.right * width / this.width,
            top: m.top * k,
            bottom: m.bottom * k
        };
        const s = this.camera.sight(width, height, this.bounds());
        this.camera.margins = m;
        return s;
    }

    /** @returns {import("./gpu.js").Look} */
    lookNow() {
        const v = this.view;
        const at = v.picked >= 0 && this.frame ? this.model.rowOf(v.picked, this.frame.since) : -1;
        const n = this.plane?.normal ?? [0, 0, 1];
        return {
            ghosts: this.shown?.ghosts ?? false,
            ghost: v.opacity,
            cut: this.plane !== null,
            plane: [...n, this.plane?.position ?? 0],
            edges: v.edges ? 1 : 0,
            picked: at,
            radius: (this.model.head?.size ?? 1) * 0.6,
            dark: v.dark,
            faces: v.colour === "joint" || v.joint !== "",
            light: this.light,
            shadows: v.shadows ? 0.75 : 0,
            reach: boxReach(this.bounds())
        };
    }

    refresh() {
        const {model, view, gpu} = this;
        const frame = this.frame;
        const level = this.shapes === model.version ? this.dirty : ORDER.length;
        this.dirty = -1;
        document.documentElement.classList.toggle("dark", view.dark);
        if (!frame) return;
        if (this.shapes !== model.version) {
            gpu.setBlocks(model);
            this.shapes = model.version;
        }
        if (level >= 4 || !this.shown) this.shown = showFrame(model, frame, view);
        const shown = this.shown;
        if (level >= 3) {
            const side = view.other ? -1 : 1;
            const whole =
                sectionPlane(view.dip, view.direction, view.position, scale(add(this.home.min, this.home.max), 0.5));
            this.plane = view.cut ? {normal: scale(whole.normal, side), position: whole.position * side} : null;
            this.cuts = this.plane ? cutBlocks(
                                         model, shown.place, shown.turn,
                                         shown.kind.map((k, row) => (k === 1 && !shown.zoned[row] ? 1 : 0)), this.plane)
                                   : [];
            this.zoneCut = this.plane ? cutZones(model, frame, shown, this.plane) : null;
            fillTable(model, shown, this.plane);
            gpu.table("pose", shown.table);
        }
        if (level >= 1) this.recolour(frame, shown);
        this.camera.parallel = view.parallel;
        this.shadow = false;
        if (level >= 1) this.tellSoon();
    }

    /** Brings the panels up to date: now when something but the newest frame has changed, else some times a second. */
    tellSoon() {
        const wait = this.told + TELLING - performance.now();
        if (this.loud || wait <= 0) this.tell();
        else this.telling ||= setTimeout(() => this.tell(), wait);
    }

    /** Brings the panels up to date. */
    tell() {
        clearTimeout(this.telling);
        this.telling = 0;
        this.loud = false;
        for (const part of this.parts) part.update();
        byId("title").textContent = this.model.head?.title ?? "";
        byId("counts").textContent = this.counts();
        this.tellFindings();
        const head = byId("head");
        byId("picked").style.top = `${head.offsetTop + head.offsetHeight + 6}px`;
        this.told = performance.now();
    }

    /** @param {import("./frames.js").Frame} frame @param {import("./poses.js").Shown} shown */
    recolour(frame, shown) {
        const {model, view, gpu} = this, c = colourBlocks(model, frame, view.colour);
        if (view.joint !== "") {
            const rest = [214, 217, 221], at = frame.head.joints.indexOf(view.joint);
            c.palette = frame.head.joints.map((_name, i) => (i === at ? category(i - 1) : rest));
            c.legend = {
                title: "Joint",
                kind: "list",
                items: [{name: view.joint, colour: c.palette[at] ?? rest}, {name: "other faces", colour: rest}]
            };
        }
        for (const id of view.also) {
            const row = model.rowOf(id, frame.since);
            if (row >= 0 && view.picked >= 0)
                c.colours.set([...PICKED.map((p, i) => 0.7 * p + 0.3 * c.colours[4 * row + i]), 255], 4 * row);
        }
        gpu.table("colour", c.colours);
        gpu.table("palette", new Uint8Array(c.palette.flatMap((p) => [...p, 255])), c.palette.length);
        gpu.caps.set(this.plane ? sheetMesh(capSheets(this.cuts, c.colours, this.plane.normal)) : null);
        this.legends = [c.legend];
        this.note = "";
        const crosses = this.paintZones(frame, shown, c);
        const contacts = view.contacts === "" ? null : colourContacts(model, frame, view.contacts);
        const elements = elementsFor(model, frame, shown, view.elements, this.plane, this.reach());
        gpu.sheets.set(sheetMesh([
            ...(contacts ? contactSheets(model, frame, shown, contacts.colour, this.plane, view.joint) : []),
            ...crosses, ...elements.sheets
        ]));
        if (contacts) this.legends.push(contacts.legend);
        this.legends.push(...elements.legends);
        const arrows = view.arrows === ""
            ? null
            : arrowsFor(model, frame, shown, view.arrows, view.motion, this.plane, this.cuts, view.dark);
        gpu.arrows.set([...elements.rods, ...(arrows?.arrows ?? [])]);
        if (arrows) {
            const unit = view.arrows === "force" ? "N" : view.arrows === "velocity" ? "m/s" : "m";
            this.note += this.note && ", ";
            this.note += arrows.arrows.length ? `longest arrow: ${figure(arrows.most)} ${unit}` : "no arrows";
        }
        if (view.motion !== 1) this.note += `${this.note && ", "}motion × ${view.motion}`;
        const [w, h] = legendSize(this.legends, this.note);
        const box = byId("legend");
        const canvas = /** @type {HTMLCanvasElement} */ (box.querySelector("canvas"));
        canvas.style.width = `${w}px`;
        canvas.style.height = `${h}px`;
        drawLegends(penOf(canvas, w, h), this.legends, this.note, 0, 0);
        box.setAttribute("aria-label", [...this.legends.map(legendText), this.note].filter(Boolean).join("; "));
        box.hidden = false;
    }

    /**
     * Meshes of deformable blocks into the picture. Gives the crosses of principal stresses.
     * @param {import("./frames.js").Frame} frame
     * @param {import("./poses.js").Shown} shown
     * @param {import("./colours.js").Colouring} blocks
     */
    paintZones(frame, shown, blocks) {
        const {model, view, gpu} = this, there = frame.surface !== null && shown.points !== null;
        const by = view.zones || (view.colour === "displacement" && view.joint === "" ? "displacement" : "");
        const zones = there ? colourZones(model, frame, by, view.smooth) : null;
        const paint = {
            points: zones?.points ?? null,
            zones: zones?.zones ?? null,
            blocks: blocks.colours,
            faces: blocks.faces || view.joint !== "" ? blocks.palette : null,
            own: view.also.size > 0
        };
        gpu.zones.set(there ? surfaceMesh(model, frame, shown, paint, view.mesh) : null);
        gpu.zoneCaps.set(
            this.zoneCut && this.plane ? capMesh(model, this.zoneCut, this.plane.normal, paint, view.mesh) : null);
        if (zones && view.zones !== "" && view.zones !== view.colour) this.legends.push(zones.legend);
        if (this.plane && there && !frame.surface?.whole) this.note = "only the surface of zones is sent";
        if (!view.crosses || !there) return [];
        const crosses = crossSheets(model, frame, shown, this.zoneCut, this.plane, this.reach());
        this.legends.push(crossLegend);
        this.note += `${this.note && ", "}longest cross: ${figure(crosses.most)} Pa`;
        return crosses.sheets;
    }

    counts() {
        const s = this.frame?.summary, f = this.frame?.data.finding, told = f ?? s;
        if (!s) return "";
        const contacts = told?.contacts ? ` · ${told.contacts} contacts, ${told.slipping} slipping` : "";
        return `${s.blocks} blocks${contacts}${f?.stage ? ` · stage “${f.stage}”` : ""}`;
    }

    tellFindings() {
        if (!this.frame) return;
        const finding = this.frame.data.finding, line = byId("findings");
        line.classList.toggle("bad", finding?.standing === "failed" || finding?.standing === "accelerating");
        line.textContent = finding?.text.replaceAll(" m3)", " m³)") ?? "";
    }

    /** @param {number} w @param {number} h @param {number} number @param {boolean} full */
    drawOne(w, h, number, full) {
        const sight = this.sight(w, h), look = this.lookNow();
        if (full && !this.shadow && look.shadows) {
            this.light = look.light = this.camera.light(sight.sun, this.bounds());
            this.gpu.drawShadow(look);
            this.shadow = true;
        }
        look.edges *= Math.max(1, Math.round(w / this.width));
        const jitter = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
        if (full) {
            // Halton's points: even over the pixel for any number of pictures
            jitter[12] = (halton(number + 1, 2) - 0.5) * 2 / w;
            jitter[13] = (halton(number + 1, 3) - 0.5) * 2 / h;
        }
        this.gpu.draw(sight, multiply(jitter, sight.matrix), look, w, h, number, full);
    }

    tick() {
        this.asked = false;
        if (this.dirty >= 0) this.refresh();
        const {canvas} = this;
        const begun = performance.now();
        const full = this.number > 0 && (begun - this.changed > STILL || (this.fullCost > 0 && this.fullCost < 20));
        if (this.sample < this.samples && this.frame) {
            const half = !full && (this.number ? this.draftCost > SLOW : this.model.triangles > MANY) ? 2 : 1;
            if (full || this.sample === 0)
                this.drawOne(
                    Math.ceil(canvas.width / half), Math.ceil(canvas.height / half), full ? this.sample : 0, full);
            this.gpu.wait();
            const cost = performance.now() - begun;
            if (full) {
                if (this.sample > 0) this.fullCost = cost;
                this.sample++;
            } else if (this.number > 1) this.draftCost = half * half * cost * (half > 1 ? 0.8 : 1);
            if (this.sample <= 1) this.drawOverlay();
            this.number++;
        }
        for (const done of this.waiting.splice(0)) done();
        if (this.sample < this.samples && this.frame && !this.asked) {
            this.asked = true;
            setTimeout(
                () => requestAnimationFrame(() => this.tick()),
                full ? 0 : Math.max(0, STILL + 5 - (performance.now() - this.changed)));
        }
        if (this.sample === this.samples) this.keepAddress();
    }

    drawOverlay() {
        const pen = penOf(/** @type {HTMLCanvasElement} */ (byId("overlay")), this.width, this.height);
        drawAxes(pen, this.camera, 60, this.height - 158 - legendSize(this.legends, this.note)[1], this.height);
    }

    keepAddress() {
        const text = viewText(this.view, this.camera.text());
        if (text === this.address) return;
        this.address = text;
        try {
            history.replaceState(null, "", text);
        } catch { /* a browser that does not let files change their address */
        }
    }

    async fromAddress() {
        Object.assign(this.view, makeView(), {dark: this.view.dark, net: this.blind !== ""});
        const camera = readView(this.view, location.hash), found = this.camera.read(camera);
        this.address = location.hash;
        await this.goTo(this.view.frame < 0 ? this.model.frames.length - 1 : this.view.frame);
        return found;
    }
}

/** @type {import("./colours.js").Legend} */
const crossLegend = {
    title: "Principal stresses",
    kind: "list",
    items: [{name: "compression", colour: PRESSED}, {name: "tension", colour: PULLED}]
};

/** Half the diagonal of a box. @param {import("./camera.js").Bounds} box */
function boxReach(box) { return Math.hypot(...[0, 1, 2].map((c) => box.max[c] - box.min[c])) / 2; }

/** Point i of a sequence that is even over [0, 1). @param {number} i @param {number} base */
function halton(i, base) {
    let out = 0;
    for (let f = 1 / base; i > 0; i = Math.floor(i / base), f /= base) out += f * (i % base);
    return out;
}
