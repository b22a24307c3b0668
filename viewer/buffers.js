// Vertex buffers of the picture: all blocks in one, sheets (polygons) and arrows in others.
// @ts-check
import { cross, unit } from "./math.js";

/** @typedef {import("./frames.js").Model} Model */
/** @typedef {{place: number[], normal: number[], colour: number[], flat: boolean, name: number}} Sheet corners x y z of a convex polygon */
/** @typedef {{tail: number[], way: number[], width: number, colour: number[], name: number}} Arrow */

const BLOCK_BYTES = 28, SHEET_BYTES = 36;

/** All blocks' faces as triangles. @param {WebGL2RenderingContext} gl @param {Model} model */
export function blockBuffer(gl, model) {
    let corners = 0;
    for (let row = 0; row < model.rows; row++) model.eachFace(row, (_f, _c, count) => { corners += count; });
    const data = new ArrayBuffer(corners * BLOCK_BYTES), f32 = new Float32Array(data), i16 = new Int16Array(data), u32 = new Uint32Array(data);
    const index = new Uint32Array(3 * model.triangles), first = new Uint32Array(model.rows + 1);
    let v = 0, k = 0;
    for (let row = 0; row < model.rows; row++) {
        const s = model.shape[row], vertex = s.shapes.vertex, loop = s.shapes.loop;
        first[row] = k;
        model.eachFace(row, (face, corner, count, joint) => {
            const at = (/** @type {number} */ i) => 3 * (s.vertex + loop[corner + i]);
            // Newell's normal: the sum over all corners, exact for flat faces, also with very short edges
            let n = [0, 0, 0];
            const o = at(0);
            for (let i = 1; i + 1 < count; i++) {
                const a = at(i), b = at(i + 1);
                const c = cross([vertex[a] - vertex[o], vertex[a + 1] - vertex[o + 1], vertex[a + 2] - vertex[o + 2]],
                    [vertex[b] - vertex[o], vertex[b + 1] - vertex[o + 1], vertex[b + 2] - vertex[o + 2]]);
                n = [n[0] + c[0], n[1] + c[1], n[2] + c[2]];
                index[k++] = v;
                index[k++] = v + i;
                index[k++] = v + i + 1;
            }
            n = unit(n);
            for (let i = 0; i < count; i++, v++) {
                const a = at(i);
                f32.set([vertex[a], vertex[a + 1], vertex[a + 2]], 7 * v);
                i16.set([n[0] * 32767, n[1] * 32767, n[2] * 32767], 14 * v + 6);
                u32[7 * v + 5] = faceName(row, face % 126);
                u32[7 * v + 6] = joint;
            }
        });
    }
    first[model.rows] = k;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const buffer = gl.createBuffer(), elements = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, elements);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, index, gl.DYNAMIC_DRAW);
    attribute(gl, 0, 3, gl.FLOAT, BLOCK_BYTES, 0);
    attribute(gl, 1, 3, gl.SHORT, BLOCK_BYTES, 12);
    attribute(gl, 2, 2, gl.UNSIGNED_INT, BLOCK_BYTES, 20);
    gl.bindVertexArray(null);
    return { array, buffer, elements, index, first, count: k };
}

/** Name of a face in the picture's names: 24 bits of row, 7 of face (modulo 126; 126 is a section polygon). @param {number} row @param {number} face */
export function faceName(row, face) { return row + face * 0x1000000; }

/** @param {WebGL2RenderingContext} gl @param {number} at @param {number} size @param {number} type @param {number} stride @param {number} offset */
function attribute(gl, at, size, type, stride, offset) {
    gl.enableVertexAttribArray(at);
    if (type === gl.UNSIGNED_INT) gl.vertexAttribIPointer(at, size, type, stride, offset);
    else gl.vertexAttribPointer(at, size, type, type !== gl.FLOAT, stride, offset);
}

/** Convex polygons as triangles. @param {WebGL2RenderingContext} gl */
export function sheetBuffer(gl) {
    const array = gl.createVertexArray(), buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    attribute(gl, 0, 3, gl.FLOAT, SHEET_BYTES, 0);
    attribute(gl, 1, 3, gl.FLOAT, SHEET_BYTES, 12);
    attribute(gl, 2, 4, gl.UNSIGNED_BYTE, SHEET_BYTES, 24);
    attribute(gl, 3, 1, gl.UNSIGNED_INT, SHEET_BYTES, 28);
    gl.bindVertexArray(null);
    return { array, count: 0, set(/** @type {Sheet[]} */ sheets) {
        let n = 0;
        for (const s of sheets) n += Math.max(0, s.place.length / 3 - 2) * 3;
        const data = new ArrayBuffer(n * SHEET_BYTES), f32 = new Float32Array(data), u8 = new Uint8Array(data), u32 = new Uint32Array(data);
        let v = 0;
        for (const s of sheets) {
            for (let i = 1; i + 1 < s.place.length / 3; i++) {
                for (const c of [0, i, i + 1]) {
                    f32.set([s.place[3 * c], s.place[3 * c + 1], s.place[3 * c + 2], s.normal[0], s.normal[1], s.normal[2]], 9 * v);
                    u8.set([s.colour[0], s.colour[1], s.colour[2], s.flat ? 0 : 255], SHEET_BYTES * v + 24);
                    u32[9 * v++ + 7] = s.name;
                }
            }
        }
        this.count = n;
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    } };
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
            corner(r, i); corner(r, i + 1); corner(r + 1, i + 1);
            corner(r, i); corner(r + 1, i + 1); corner(r + 1, i);
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
    return { array, corners: mesh.length / 4, count: 0, set(/** @type {Arrow[]} */ arrows) {
        const data = new ArrayBuffer(36 * arrows.length), f32 = new Float32Array(data), u8 = new Uint8Array(data), u32 = new Uint32Array(data);
        arrows.forEach((a, i) => {
            f32.set([...a.tail, ...a.way, a.width], 9 * i);
            u8.set([...a.colour, 255], 36 * i + 28);
            u32[9 * i + 8] = a.name;
        });
        this.count = arrows.length;
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    } };
}
