// What the controls, the mouse and the keys ask for.
// @ts-check
import {App} from "./app.js";
import {say} from "./dom.js";
import {elementText} from "./elements.js";
import {named} from "./glyphs.js";
import {saveImage} from "./image.js";
import {add, planeNormal, scale, trendPlunge} from "./math.js";
import {tightBox} from "./poses.js";
import {pairOf} from "./scene.js";

/** The page's state with what can be done to it. */
export class Page extends App {
    /** The block, contact or arrow at a place of the window. @param {number} x @param {number} y */
    at(x, y) {
        const w = this.canvas.width, h = this.canvas.height, px = Math.floor(x * w / this.width);
        const py = h - 1 - Math.floor(y * h / this.height);
        if (this.dirty >= 0) this.refresh();
        const sight = this.sight(w, h), look = this.lookNow();
        const solid = named(this.gpu.names(sight, look, w, h, [px, py, 1, 1])[0]);
        if (solid.kind !== "none" || !look.ghosts) return solid;
        return named(this.gpu.names(sight, look, w, h, [px, py, 1, 1], true)[0]);
    }

    /** @param {number} x @param {number} y @param {boolean} more picks the block as well, or lets go of it */
    pickAt(x, y, more) {
        const what = this.at(x, y);
        const i = what.kind === "block" && this.frame ? this.frame.at[what.index] : -1;
        const k = this.frame?.data.contacts;
        if (more) {
            if (i >= 0 && this.frame) this.pickMore(this.frame.poses.id[i]);
        } else if (what.kind === "contact" && k) this.pickContact(k.id[what.index]);
        else if (what.kind === "element" && this.frame) say(elementText(this.frame, what.index));
        else this.pick(i >= 0 && this.frame ? this.frame.poses.id[i] : -1);
    }

    /** @param {number} id */
    pickContact(id) {
        this.pick(-1);
        this.view.contact = id;
        say(`Contact of blocks ${pairOf(id)}`);
    }

    /** @param {number} id */
    pick(id) {
        this.view.picked = id;
        this.view.contact = -1;
        this.view.also.clear();
        this.view.joint = "";
        this.chart = id >= 0 ? "picked" : "largest";
        say(id >= 0 ? `Block ${id}` : "");
        this.change("colour");
    }

    /** Picks a block beside those that are picked, or lets go of it. @param {number} id */
    pickMore(id) {
        const {view} = this, all = new Set(this.picks());
        if (!all.delete(id)) all.add(id);
        const last = [...all].pop() ?? -1;
        if (last !== view.picked) this.pick(last);
        view.also = all.size > 1 ? all : new Set();
        say(all.size > 1 ? `${all.size} blocks are picked` : last >= 0 ? `Block ${last}` : "");
        this.change("colour");
    }

    /** The picked blocks. @returns {number[]} */
    picks() { return this.view.also.size ? [...this.view.also] : this.view.picked >= 0 ? [this.view.picked] : []; }

    hidePicked() {
        for (const id of this.picks()) this.view.hidden.add(id);
        if (this.view.picked >= 0) {
            this.pick(-1);
            this.change("pose");
        }
    }
    showAll() {
        for (const s of [this.view.hidden, this.view.ghosts, this.view.only]) s.clear();
        this.view.moved = 0;
        this.change("pose");
    }

    fit(/** @type {import("./camera.js").Bounds | null} */ box = null) {
        if (this.dirty >= 3) this.refresh();
        if (this.shown)
            this.camera.fit(box ?? tightBox(this.model, this.shown, () => true) ?? this.home, this.width, this.height);
        this.change("camera");
    }

    zoomPicked() {
        const {frame} = this;
        const rows = frame ? this.picks().map((id) => this.model.rowOf(id, frame.since)) : [];
        const box = this.shown ? tightBox(this.model, this.shown, (r) => rows.includes(r)) : null;
        if (!box) return say("There is no such block in this frame, or it is hidden.");
        const out = box.max.map((v, c) => (v - box.min[c]) * 0.7);
        this.fit({min: box.min.map((v, c) => v - out[c]), max: box.max.map((v, c) => v + out[c])});
    }

    /** @param {number} bearing @param {number} plunge */
    look(bearing, plunge) {
        this.camera.bearing = bearing;
        this.camera.plunge = plunge;
        this.fit();
    }

    /** @param {number} factor @param {number} x @param {number} y the place of the window that stays where it is */
    zoomAt(factor, x, y) {
        const before = this.camera.height, m = this.camera.margins;
        const cx = (this.width + m.left - m.right) / 2, cy = (this.height + m.top - m.bottom) / 2;
        this.camera.zoom(factor, this.bounds());
        const k = 1 - before / this.camera.height;
        this.camera.shift((x - cx) * k, (y - cy) * k, this.height);
        this.change("camera");
    }

    faceCut() {
        const n = this.plane?.normal ?? planeNormal(this.view.dip, this.view.direction), t = trendPlunge(scale(n, -1));
        this.view.cut = this.view.parallel = this.camera.parallel = true;
        this.change("pose");
        this.look(Math.abs(n[2]) > 0.999 ? 0 : t.trend, t.plunge);
    }

    cutThrough() {
        const id = this.view.picked >= 0 ? this.view.picked : this.frame?.summary.mover ?? -1;
        const row = this.frame ? this.model.rowOf(id, this.frame.since) : -1;
        if (row < 0 || !this.shown) return;
        const middle = scale(add(this.home.min, this.home.max), 0.5);
        const n = planeNormal(this.view.dip, this.view.direction);
        this.view.position =
            [0, 1, 2].reduce((t, c) => t + n[c] * (/** @type {any} */ (this.shown).place[3 * row + c] - middle[c]), 0);
        this.view.cut = true;
        this.change("pose");
    }

    /** @param {number} dx @param {number} dy pixels */
    dragCut(dx, dy) {
        const {right, up} = this.camera.axes();
        const n = planeNormal(this.view.dip, this.view.direction);
        const x = n[0] * right[0] + n[1] * right[1];
        const y = n[0] * up[0] + n[1] * up[1] + n[2] * up[2];
        const long = Math.hypot(x, y), by = long > 0.15 ? (x * dx - y * dy) / long / long : -dy;
        this.view.position = Math.max(
            -this.reach(), Math.min(this.reach(), this.view.position + by / this.camera.perMetre(this.height)));
        this.change("cut");
    }

    saveImage() { saveImage(this).catch((e) => say(e.message, true)); }
}
