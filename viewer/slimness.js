// How thin and small blocks are: what tells slivers, which make the time step small.
// @ts-check

/**
 * @typedef {{version: number, aspect: Float32Array, bulk: Float32Array}} Slimness by row: largest distance of two
 *   vertices over the smallest extent along the normal of a face, as talus.report has it; volume over surface, m
 */

/** @type {WeakMap<import("./frames.js").Model, Slimness>} */ const slims = new WeakMap();

/** @param {import("./frames.js").Model} model @returns {Slimness} */
export function slimness(model) {
    let out = slims.get(model);
    if (out?.version === model.version) return out;
    out = {version: model.version, aspect: new Float32Array(model.rows), bulk: new Float32Array(model.rows)};
    for (const [row, s] of model.shape.entries()) {
        const {vertex: v, loop, vertices, volume} = s.shapes;
        const first = 3 * s.vertex, end = first + 3 * vertices[s.block];
        let wide = 0, thin = Infinity, surface = 0;
        for (let a = first; a < end; a += 3)
            for (let b = first; b < a; b += 3)
                wide = Math.max(wide, (v[a] - v[b]) ** 2 + (v[a + 1] - v[b + 1]) ** 2 + (v[a + 2] - v[b + 2]) ** 2);
        model.eachFace(row, (_f, corner, count) => {
            const at = (/** @type {number} */ i) => first + 3 * loop[corner + i], o = at(0);
            let x = 0, y = 0, z = 0, deep = 0;
            for (let i = 1; i + 1 < count; i++) {
                const a = at(i), b = at(i + 1), p = v[a] - v[o], q = v[a + 1] - v[o + 1];
                const r = v[a + 2] - v[o + 2], s = v[b] - v[o], t = v[b + 1] - v[o + 1];
                const u = v[b + 2] - v[o + 2];
                x += q * u - r * t;
                y += r * s - p * u;
                z += p * t - q * s;
            }
            const twice = Math.hypot(x, y, z);
            for (let a = first; a < end; a += 3)
                deep = Math.max(deep, x * (v[o] - v[a]) + y * (v[o + 1] - v[a + 1]) + z * (v[o + 2] - v[a + 2]));
            surface += twice / 2;
            if (twice > 0) thin = Math.min(thin, deep / twice);
        });
        out.aspect[row] = Math.sqrt(wide) / thin;
        out.bulk[row] = volume[s.block] / surface;
    }
    slims.set(model, out);
    return out;
}
