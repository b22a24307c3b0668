// Mouse, touch and keyboard on the picture.
// @ts-check
import {byId} from "./dom.js";

/** @param {import("./page.js").Page} app @param {{step: (by: number) => void, toggle: () => void}} time */
export function listen(app, time) {
    const picture = byId("picture");
    /** @type {Map<number, {x: number, y: number}>} */ const fingers = new Map();
    let way = 0, button = 0, pinch = 0;

    const spread = () => {
        const [a, b] = [...fingers.values()];
        return {size: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2};
    };
    picture.onpointerdown = (e) => {
        picture.setPointerCapture(e.pointerId);
        fingers.set(e.pointerId, {x: e.clientX, y: e.clientY});
        if (fingers.size === 1) {
            way = 0;
            button = e.button;
        }
        if (fingers.size === 2) pinch = spread().size;
    };
    picture.onpointermove = (e) => {
        const f = fingers.get(e.pointerId);
        if (!f) return;
        const before = fingers.size === 2 ? spread() : null, dx = e.clientX - f.x, dy = e.clientY - f.y;
        f.x = e.clientX;
        f.y = e.clientY;
        way += Math.abs(dx) + Math.abs(dy);
        if (way < 4) return;
        if (before && fingers.size === 2) {
            const now = spread();
            app.camera.shift(now.x - before.x, now.y - before.y, app.height);
            if (now.size > 0 && pinch > 0) app.camera.zoom(pinch / now.size, app.bounds());
            pinch = now.size;
        } else if (e.altKey && app.view.cut) return app.dragCut(dx, dy);
        else if (button === 0 && !e.shiftKey) app.camera.turn(dx, dy);
        else app.camera.shift(dx, dy, app.height);
        app.change("camera");
    };
    const up = (/** @type {PointerEvent} */ e) => {
        const one = fingers.size === 1;
        fingers.delete(e.pointerId);
        if (one && way < 4 && e.type === "pointerup" && button === 0)
            app.pickAt(e.clientX, e.clientY, e.shiftKey || e.ctrlKey || e.metaKey);
    };
    picture.onpointerup = up;
    picture.onpointercancel = up;
    picture.oncontextmenu = (e) => e.preventDefault();
    picture.addEventListener("wheel", (e) => {
        e.preventDefault();
        app.zoomAt(Math.exp(Math.max(-1, Math.min(1, e.deltaY * (e.deltaMode ? 0.05 : 0.0015)))), e.clientX, e.clientY);
    }, {passive: false});

    document.addEventListener("keydown", (e) => {
        const on = /** @type {HTMLElement} */ (e.target);
        const typing = on.matches?.("input, select, pre") || (e.key === " " && on.matches?.("button"));
        if (e.key === "Escape") return app.pick(-1);
        if (typing || e.ctrlKey || e.metaKey || e.altKey || (app.run && app.run.key(e.key))) return;
        const by = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[e.key];
        if (by) {
            if (e.shiftKey) app.camera.shift(by[0] * 30, by[1] * 30, app.height);
            else app.camera.turn(by[0] * 12, by[1] * 12);
            app.change("camera");
        } else if (e.key === "+" || e.key === "=") {
            app.camera.zoom(1 / 1.15, app.bounds());
            app.change("camera");
        } else if (e.key === "-") {
            app.camera.zoom(1.15, app.bounds());
            app.change("camera");
        } else if (e.key === ",") time.step(-1);
        else if (e.key === ".") time.step(1);
        else if (e.key === " ") time.toggle();
        else if (e.key === "h") app.hidePicked();
        else if (e.key === "s") app.showAll();
        else if (e.key === "f") app.fit();
        else return;
        e.preventDefault();
    });
}
