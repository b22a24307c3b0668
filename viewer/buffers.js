// Vertex buffers of the picture: all blocks in one, triangles (meshes and polygons) and arrows in others.
// @ts-check
import {triple} from "./math.js";

/** @typedef {import("./frames.js").Model} Model */
/**
 * @typedef {{place: number[], normal: number[], colour: number[], colours?: number[][], flat: boolean, name: number}}
 *   Sheet corners x y z of a convex polygon; colours: of the corners
 */
/** @typedef {{tail: number[], way: number[], width: number, colour: number[], name: number}} Arrow */

const BLOCK_BYTES = 28, MESH_BYTES = 32; // of a corner
const WHOLE_EDGES = 1e30;                // size of triangles whose edges do not fade

/**
 * All blocks' faces as triangles. The last corner of a triangle tells its normal and name, so faces share
 * vertices: each has one of its own, and the rest of its corners are those of other faces.
 * @param {WebGL2RenderingContext} gl
 * @param {Model} model
 */
export function blockBuffer(gl, model) {
    let most = 0;
    for (const {shapes, block} of model.shape) most += shapes.vertices[block] + shapes.faces[block];
    const data = new ArrayBuffer(most * BLOCK_BYTES), f32 = new Float32Array(data);
    const i16 = new Int16Array(data), u32 = new Uint32Array(data);
    const index = new Uint32Array(3 * model.triangles), taken = new Uint32Array(65536);
    let end = 0, k = 0;
    // no lists and no functions in here: it is done for millions of corners while nothing is to be seen
    for (let row = 0; row < model.rows; row++) {
        const s = model.shape[row];
        const {vertex, loop, corners, joint} = s.shapes;
        const base = end, faces = s.shapes.faces[s.block];
        for (let a = 3 * s.vertex; end < base + s.shapes.vertices[s.block]; end++, a += 3) {
            f32[7 * end] = vertex[a];
            f32[7 * end + 1] = vertex[a + 1];
            f32[7 * end + 2] = vertex[a + 2];
            u32[7 * end + 5] = row;
        }
        for (let face = 0, corner = s.corner; face < faces; face++) {
            const count = corners[s.face + face];
            let own = 0, v = end;
            while (own < count && taken[loop[corner + own]] === row + 1) own++;
            if (own === count) {
                own = 0;
                end++;
                f32.copyWithin(7 * v, 7 * (base + loop[corner]), 7 * (base + loop[corner]) + 3);
            } else {
                v = base + loop[corner + own];
                taken[loop[corner + own]] = row + 1;
            }
            // Newell's normal: the sum over all corners, exact for flat faces, also with very short edges
            const o = 7 * v, ox = f32[o], oy = f32[o + 1], oz = f32[o + 2];
            let nx = 0, ny = 0, nz = 0, ax = 0, ay = 0, az = 0, before = 0;
            for (let i = 1; i < count; i++) {
                const next = base + loop[corner + (own + i) % count];
                const b = 7 * next, bx = f32[b] - ox, by = f32[b + 1] - oy, bz = f32[b + 2] - oz;
                if (i > 1) {
                    nx += ay * bz - az * by;
                    ny += az * bx - ax * bz;
                    nz += ax * by - ay * bx;
                    index[k++] = before;
                    index[k++] = next;
                    index[k++] = v;
                }
                ax = bx;
                ay = by;
                az = bz;
                before = next;
            }
            const length = Math.sqrt(nx * nx + ny * ny + nz * nz), to = length > 0 ? 32767 / length : 0;
            i16[14 * v + 6] = nx * to;
            i16[14 * v + 7] = ny * to;
            i16[14 * v + 8] = to ? nz * to : 32767;
            u32[7 * v + 5] = faceName(row, face % 126);
            u32[7 * v + 6] = joint[s.face + face];
            corner += count;
        }
    }
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const buffer = gl.createBuffer(), elements = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, f32.subarray(0, 7 * end), gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, elements);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, index, gl.STATIC_DRAW);
    attribute(gl, 0, 3, gl.FLOAT, BLOCK_BYTES, 0);
    attribute(gl, 1, 3, gl.SHORT, BLOCK_BYTES, 12);
    attribute(gl, 2, 2, gl.UNSIGNED_INT, BLOCK_BYTES, 20);
    gl.bindVertexArray(null);
    return {array, buffer, elements, count: k};
}

/**
 * Name of a face in the picture's names: 24 bits of row, 7 of face (modulo 126; 126 is a section polygon).
 * @param {number} row
 * @param {number} face
 */
export function faceName(row, face) { return row + face * 0x1000000; }

/**
 * @param {WebGL2RenderingContext} gl
 * @param {number} at
 * @param {number} size
 * @param {number} type
 * @param {number} stride
 * @param {number} offset
 */
function attribute(gl, at, size, type, stride, offset) {
    gl.enableVertexAttribArray(at);
    if (type === gl.UNSIGNED_INT) gl.vertexAttribIPointer(at, size, type, stride, offset);
    else gl.vertexAttribPointer(at, size, type, type !== gl.FLOAT, stride, offset);
}

/**
 * Triangles as the picture reads them.
 * @param {number} most triangles
 */
export function makeMesh(most) {
    const data = new ArrayBuffer(3 * most * MESH_BYTES), f32 = new Float32Array(data), i16 = new Int16Array(data);
    const u8 = new Uint8Array(data), u32 = new Uint32Array(data);
    let v = 0;
    return {
        data,
        /**
         * Adds a corner.
         * @param {number[]} place
         * @param {number[]} normal
         * @param {boolean} lit
         * @param {ArrayLike<number>} colour
         * @param {number} name
         * @param {number} size m: edges fade where it is small
         */
        put(place, normal, lit, colour, name, size) {
            for (let c = 0; c < 3; c++) {
                f32[8 * v + c] = place[c];
                i16[16 * v + 6 + c] = 32767 * normal[c];
                u8[32 * v + 20 + c] = colour[c];
            }
            i16[16 * v + 9] = lit ? 32767 : 0;
            u32[8 * v + 6] = name;
            f32[8 * v++ + 7] = size;
        }
    };
}

/**
 * Convex polygons as triangles.
 * @param {Sheet[]} sheets
 */
export function sheetMesh(sheets) {
    const out = makeMesh(sheets.reduce((n, s) => n + Math.max(0, s.place.length / 3 - 2), 0));
    let solid = 0;
    for (const s of sheets) {
        for (let i = 1; i + 1 < s.place.length / 3; i++) {
            for (const c of [0, i, i + 1])
                out.put(triple(s.place, c), s.normal, !s.flat, s.colours?.[c] ?? s.colour, s.name, WHOLE_EDGES);
            solid += 3;
        }
    }
    return {data: out.data, solid, ghosts: 0};
}

/** Triangles of deformable blocks, made by zones.js, or of polygons. @param {WebGL2RenderingContext} gl */
export function meshBuffer(gl) {
    const array = gl.createVertexArray(), buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    attribute(gl, 0, 3, gl.FLOAT, MESH_BYTES, 0);
    attribute(gl, 1, 4, gl.SHORT, MESH_BYTES, 12);
    attribute(gl, 2, 4, gl.UNSIGNED_BYTE, MESH_BYTES, 20);
    attribute(gl, 3, 1, gl.UNSIGNED_INT, MESH_BYTES, 24);
    attribute(gl, 4, 1, gl.FLOAT, MESH_BYTES, 28);
    gl.bindVertexArray(null);
    return {
        array,
        solid: 0,
        ghosts: 0,
        /**
           @param {{data: ArrayBuffer, solid: number, ghosts: number} | null} mesh corners of solid blocks, then of
               ghosts
         */
        set(mesh) {
            this.solid = mesh?.solid ?? 0;
            this.ghosts = mesh?.ghosts ?? 0;
            if (!mesh) return;
            gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
            gl.bufferData(gl.ARRAY_BUFFER, mesh.data, gl.DYNAMIC_DRAW);
        }
    };
}

/** Arrows: one mesh, drawn once for each. @param {WebGL2RenderingContext} gl */
export function arrowBuffer(gl) {
    /** @type {number[]} */ const mesh = [];
    const sides = 10;
    // rings: radius and place; places from -1 to 0 lie in the head
    const rings = [[0, 0], [0.5, 0], [0.5, 1], [1.5, -1], [0, 0 - 1e-9]];
    for (let r = 0; r + 1 < rings.length; r++) {
        for (let i = 0; i < sides; i++) {
            const corner = (/** @type {number} */ ring, /** @type {number} */ k) => {
                const a = 2 * Math.PI * k / sides;
                mesh.push(Math.cos(a), Math.sin(a), rings[ring][0], rings[ring][1]);
            };
            corner(r, i);
            corner(r, i + 1);
            corner(r + 1, i + 1);
            corner(r, i);
            corner(r + 1, i + 1);
            corner(r + 1, i);
        }
    }
    const array = gl.createVertexArray(), fixed = gl.createBuffer(), buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, fixed);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(mesh), gl.STATIC_DRAW);
    attribute(gl, 0, 4, gl.FLOAT, 16, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    attribute(gl, 1, 3, gl.FLOAT, 36, 0);
    attribute(gl, 2, 4, gl.FLOAT, 36, 12);
    attribute(gl, 3, 4, gl.UNSIGNED_BYTE, 36, 28);
    attribute(gl, 4, 1, gl.UNSIGNED_INT, 36, 32);
    for (let i = 1; i < 5; i++) gl.vertexAttribDivisor(i, 1);
    gl.bindVertexArray(null);
    return {
        array,
        corners: mesh.length / 4,
        count: 0,
        set(/** @type {Arrow[]} */ arrows) {
            const data = new ArrayBuffer(36 * arrows.length), f32 = new Float32Array(data);
            const u8 = new Uint8Array(data), u32 = new Uint32Array(data);
            arrows.forEach((a, i) => {
                f32.set([...a.tail, ...a.way, a.width], 9 * i);
                u8.set([...a.colour, 255], 36 * i + 28);
                u32[9 * i + 8] = a.name;
            });
            this.count = arrows.length;
            gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
            gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
        }
    };
}
