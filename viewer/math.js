// Vectors as lists of 3, quaternions x y z w, matrices of 4 x 4 in columns as WebGL wants them.
// @ts-check

/** @typedef {number[] | Float32Array | Float64Array} Vec */

/** @param {Vec} a @param {Vec} b @returns {number[]} */
export function add(a, b) { return [a[0] + b[0], a[1] + b[1], a[2] + b[2]]; }

/** @param {Vec} a @param {Vec} b @returns {number[]} */
export function sub(a, b) { return [a[0] - b[0], a[1] - b[1], a[2] - b[2]]; }

/** @param {Vec} a @param {number} s @returns {number[]} */
export function scale(a, s) { return [a[0] * s, a[1] * s, a[2] * s]; }

/** @param {Vec} a @param {Vec} b */
export function dot(a, b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/** @param {Vec} a @param {Vec} b @returns {number[]} */
export function cross(a, b) {
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** The i-th vector of a column. @param {Vec} column @param {number} i @returns {number[]} */
export function triple(column, i) { return [column[3 * i], column[3 * i + 1], column[3 * i + 2]]; }

/** @param {Vec} a */
export function norm(a) { return Math.sqrt(dot(a, a)); }

/** The direction of a; (0, 0, 1) of a zero vector. @param {Vec} a @returns {number[]} */
export function unit(a) {
    const length = norm(a);
    return length > 0 ? scale(a, 1 / length) : [0, 0, 1];
}

/** Area times normal of a polygon, counter-clockwise seen against the normal. @param {number[][]} points */
export function areaOf(points) {
    let n = [0, 0, 0];
    for (let i = 2; i < points.length; i++)
        n = add(n, scale(cross(sub(points[i - 1], points[0]), sub(points[i], points[0])), 0.5));
    return n;
}

/** Unit quaternions multiplied: turn by b, then by a. @param {Vec} a @param {Vec} b @returns {number[]} */
export function turnAfter(a, b) {
    return [
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]
    ];
}

/**
 * The vector v turned by the quaternion at q[at].
 * @param {Vec} q
 * @param {number} at
 * @param {Vec} v
 * @returns {number[]}
 */
export function turned(q, at, v) {
    const x = q[at], y = q[at + 1], z = q[at + 2], w = q[at + 3];
    const tx = 2 * (y * v[2] - z * v[1]), ty = 2 * (z * v[0] - x * v[2]), tz = 2 * (x * v[1] - y * v[0]);
    return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx];
}

/** @param {Float32Array | number[]} a @param {Float32Array | number[]} b */
export function multiply(a, b) {
    const out = new Float32Array(16);
    for (let c = 0; c < 4; c++) {
        for (let r = 0; r < 4; r++) {
            out[4 * c + r] =
                a[r] * b[4 * c] + a[4 + r] * b[4 * c + 1] + a[8 + r] * b[4 * c + 2] + a[12 + r] * b[4 * c + 3];
        }
    }
    return out;
}

/** The inverse by cofactors. @param {Float32Array} m */
export function inverse(m) {
    const out = new Float32Array(16);
    const minor = (/** @type {number} */ r, /** @type {number} */ c) => {
        const rows = [0, 1, 2, 3].filter((i) => i !== r), cols = [0, 1, 2, 3].filter((i) => i !== c);
        const e = (/** @type {number} */ i, /** @type {number} */ j) => m[4 * cols[j] + rows[i]];
        return e(0, 0) * (e(1, 1) * e(2, 2) - e(1, 2) * e(2, 1)) - e(0, 1) * (e(1, 0) * e(2, 2) - e(1, 2) * e(2, 0)) +
            e(0, 2) * (e(1, 0) * e(2, 1) - e(1, 1) * e(2, 0));
    };
    let det = 0;
    for (let c = 0; c < 4; c++) det += (c % 2 ? -1 : 1) * m[4 * c] * minor(0, c);
    for (let r = 0; r < 4; r++) {
        for (let c = 0; c < 4; c++) out[4 * r + c] = ((r + c) % 2 ? -1 : 1) * minor(r, c) / det;
    }
    return out;
}

/** The point p through the matrix m, divided by w. @param {Float32Array} m @param {Vec} p @returns {number[]} */
export function project(m, p) {
    const w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
    return [0, 1, 2].map((r) => (m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]) / w);
}

/**
 * Unit vector of a trend and plunge in degrees, x = east, y = north, z = up.
 * @param {number} trend
 * @param {number} plunge
 */
export function lineation(trend, plunge) {
    const t = trend * Math.PI / 180, p = plunge * Math.PI / 180;
    return [Math.cos(p) * Math.sin(t), Math.cos(p) * Math.cos(t), -Math.sin(p)];
}

/** The upward normal of a plane. @param {number} dip degrees @param {number} direction degrees */
export function planeNormal(dip, direction) {
    const d = dip * Math.PI / 180, t = direction * Math.PI / 180;
    return [Math.sin(d) * Math.sin(t), Math.sin(d) * Math.cos(t), Math.cos(d)];
}

/** Trend and plunge in degrees of a direction; plunge positive downward. @param {Vec} v */
export function trendPlunge(v) {
    const u = unit(v);
    const trend = (Math.atan2(u[0], u[1]) * 180 / Math.PI + 360) % 360;
    return {trend, plunge: Math.asin(Math.max(-1, Math.min(1, -u[2]))) * 180 / Math.PI};
}

/** With a capital. @param {string} words */
export function capital(words) { return words.charAt(0).toUpperCase() + words.slice(1); }

export const BEYOND = 3e38; // numbers above it stand for infinite ones

/** A number in at most three figures, as an engineer writes it. @param {number} x */
export function figure(x) {
    if (!Number.isFinite(x)) return "–";
    if (x > BEYOND) return "∞";
    if (x === 0) return "0";
    const size = Math.abs(x);
    if (size >= 1e6 || size < 1e-3)
        return x.toExponential(2).replace("e+", "e").replace(/\.?0+e/, "e").replace("-", "−").replace("e-", "e−");
    return String(Number(x.toPrecision(size >= 100 ? 4 : 3))).replace("-", "−");
}
