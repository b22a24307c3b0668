// Where the model is looked at from. x is east, y north, z up; `bearing` and `plunge` are those of the line of sight.
// @ts-check
import {add, cross, dot, inverse, lineation, multiply, project, scale, sub, unit} from "./math.js";

/** @typedef {import("./gpu.js").Sight} Sight */
/** @typedef {{min: number[], max: number[]}} Bounds */

const HALF_ANGLE = 15 * Math.PI / 180; // of the perspective

export class Camera {
    constructor() {
        this.bearing = 30;
        this.plunge = 25;
        this.target = [0, 0, 0];
        this.height = 10; // of the model seen at the target, m
        this.parallel = false;
        /** Part of the window that no panel covers: left, right, top, bottom in pixels. */
        this.margins = {left: 0, right: 0, top: 0, bottom: 0};
    }

    /** Right, up and forward. */
    axes() {
        const forward = lineation(this.bearing, this.plunge);
        const b = this.bearing * Math.PI / 180, right = [Math.cos(b), -Math.sin(b), 0];
        return {right, up: cross(right, forward), forward};
    }

    /**
     * @param {number} width
     * @param {number} height of the window, pixels
     * @param {Bounds} bounds of the model
     * @returns {Sight}
     */
    sight(width, height, bounds) {
        const {right, up, forward} = this.axes(), far = this.height / 2 / Math.tan(HALF_ANGLE);
        const middle = scale(add(bounds.min, bounds.max), 0.5);
        const radius = Math.hypot(...sub(bounds.max, bounds.min)) / 2 * 1.02 + 1e-9;
        // parallel: the eye stands outside of the model
        const away = this.parallel ? Math.abs(dot(sub(middle, this.target), forward)) + 2 * radius : far;
        const eye = sub(this.target, scale(forward, away));
        const deep = dot(sub(middle, eye), forward);
        const near = Math.max(deep - radius, this.parallel ? deep - radius : away * 0.01);
        const end = Math.max(deep + radius, near * 1.01 + 1e-9);
        const view = new Float32Array([
            right[0], up[0], -forward[0], 0, right[1], up[1], -forward[1], 0, right[2], up[2], -forward[2], 0,
            -dot(right, eye), -dot(up, eye), dot(forward, eye), 1
        ]);
        const m = this.margins;
        const free = Math.max(1, height - m.top - m.bottom);
        const zoom = free / height, aspect = width / height;
        const sx = (m.left - m.right) / width, sy = (m.bottom - m.top) / height;
        const y = this.parallel ? 2 * zoom / this.height : zoom / Math.tan(HALF_ANGLE), x = y / aspect;
        const lens = this.parallel
            ? [x, 0, 0, 0, 0, y, 0, 0, 0, 0, -2 / (end - near), 0, sx, sy, -(end + near) / (end - near), 1]
            : [
                  x, 0, 0, 0, 0, y, 0, 0, -sx, -sy, -(end + near) / (end - near), -1, 0, 0,
                  -2 * end * near / (end - near), 0
              ];
        const matrix = multiply(lens, view);
        const towards = scale(forward, -1);
        const sun = unit(add(add(scale(towards, 0.55), scale(right, -0.55)), [0, 0, 0.9]));
        return {matrix, back: inverse(matrix), towards, sun, up: [0, 0, 1], pixels: y / 2};
    }

    /** Pixels of a metre at the target. @param {number} height of the window, pixels */
    perMetre(height) { return Math.max(1, height - this.margins.top - this.margins.bottom) / this.height; }

    /** @param {number} dx @param {number} dy pixels */
    turn(dx, dy) {
        this.bearing = ((this.bearing + dx * 0.4) % 360 + 360) % 360;
        this.plunge = Math.max(-90, Math.min(90, this.plunge + dy * 0.4));
    }

    /** @param {number} dx @param {number} dy pixels @param {number} height of the window */
    shift(dx, dy, height) {
        const {right, up} = this.axes(), m = 1 / this.perMetre(height);
        this.target = add(this.target, add(scale(right, -dx * m), scale(up, dy * m)));
    }

    /** @param {number} factor of the height @param {Bounds} bounds */
    zoom(factor, bounds) {
        const size = Math.hypot(...sub(bounds.max, bounds.min)) + 1e-9;
        this.height = Math.max(size * 1e-4, Math.min(size * 20, this.height * factor));
    }

    /**
     * Fits a box into the free part of the window.
     * @param {Bounds} box
     * @param {number} width
     * @param {number} height of the window
     */
    fit(box, width, height) {
        const m = this.margins;
        const free = [Math.max(60, width - m.left - m.right), Math.max(60, height - m.top - m.bottom)];
        this.target = scale(add(box.min, box.max), 0.5);
        for (let round = 0; round < 4; round++) {
            const {right, up, forward} = this.axes(), far = this.height / 2 / Math.tan(HALF_ANGLE);
            let low = [Infinity, Infinity], high = [-Infinity, -Infinity];
            for (let i = 0; i < 8; i++) {
                const p = sub(
                    [i & 1 ? box.max[0] : box.min[0], i & 2 ? box.max[1] : box.min[1], i & 4 ? box.max[2] : box.min[2]],
                    this.target);
                const s = this.parallel ? 1 : far / Math.max(far * 0.2, far + dot(p, forward));
                [dot(p, right) * s, dot(p, up) * s].forEach((v, k) => {
                    low[k] = Math.min(low[k], v);
                    high[k] = Math.max(high[k], v);
                });
            }
            this.target =
                add(this.target, add(scale(right, (low[0] + high[0]) / 2), scale(up, (low[1] + high[1]) / 2)));
            this.height = Math.max(high[1] - low[1], (high[0] - low[0]) * free[1] / free[0], 1e-9) * 1.06;
        }
    }

    /**
     * Light from far away, as a matrix to clip space, around the model.
     * @param {number[]} sun
     * @param {Bounds} bounds
     */
    light(sun, bounds) {
        const middle = scale(add(bounds.min, bounds.max), 0.5);
        const r = Math.hypot(...sub(bounds.max, bounds.min)) / 2 * 1.02 + 1e-9;
        const x = unit(cross([0, 0, 1], sun)), y = cross(sun, x);
        return new Float32Array([
            x[0] / r, y[0] / r, -sun[0] / r, 0, x[1] / r, y[1] / r, -sun[1] / r, 0, x[2] / r, y[2] / r, -sun[2] / r, 0,
            -dot(x, middle) / r, -dot(y, middle) / r, dot(sun, middle) / r, 1
        ]);
    }

    text() {
        return [this.bearing, this.plunge, this.height, ...this.target].map((v) => Number(v.toPrecision(5))).join(",");
    }

    /** @param {string} text @returns {boolean} */
    read(text) {
        const v = text.split(",").map(Number);
        if (v.length !== 6 || !v.every(Number.isFinite) || v[2] <= 0) return false;
        [this.bearing, this.plunge, this.height] = [v[0], Math.max(-90, Math.min(90, v[1])), v[2]];
        this.target = v.slice(3);
        return true;
    }
}

/**
 * Pixel of a place in the window.
 * @param {Sight} sight
 * @param {number[]} place
 * @param {number} width
 * @param {number} height
 */
export function toPixel(sight, place, width, height) {
    const p = project(sight.matrix, place);
    return [(p[0] + 1) / 2 * width, (1 - p[1]) / 2 * height, p[2]];
}
