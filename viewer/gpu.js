// The picture by WebGL2: what is seen goes into textures of colour, normal, name and depth; from these come light and
// edges. While nothing changes, pictures with sub-pixel offsets are averaged; while something moves, one draft without
// shadow and occlusion.
// @ts-check
import {arrowBuffer, blockBuffer, meshBuffer} from "./buffers.js";
import {
    ARROW_VERTEX,
    DEPTH_FRAGMENT,
    MESH_VERTEX,
    SHOW_FRAGMENT,
    WHOLE_VERTEX,
    blockVertex,
    fragment,
    lightFragment
} from "./shaders.js";

/**
 * @typedef {{matrix: Float32Array, back: Float32Array, towards: number[], sun: number[], up: number[], pixels: number}}
 *   Sight
 */
/**
 * @typedef {{ghosts: boolean, ghost: number, cut: boolean, plane: number[], edges: number, picked: number,
 *   radius: number, dark: boolean, faces: boolean, light: Float32Array, shadows: number, reach: number}} Look
 *   reach: half the size of what the shadow covers, m
 */

export const SAMPLES = 16; // pictures that are averaged
const SHADOW = 1536, WIDE = 2048, NOTHING = 0xffffffff;

/**
 * A program with the places of its uniforms.
 * @param {WebGL2RenderingContext} gl
 * @param {string} vertex
 * @param {string} fragment
 */
function makeProgram(gl, vertex, fragment) {
    const program = /** @type {WebGLProgram} */ (gl.createProgram());
    for (const [type, text] of /** @type {[number, string][]} */ (
             [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]])) {
        const shader = /** @type {WebGLShader} */ (gl.createShader(type));
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
            throw new Error(`The graphics driver refuses a program: ${gl.getShaderInfoLog(shader)}`);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS))
        throw new Error(`The graphics driver refuses a program: ${gl.getProgramInfoLog(program)}`);
    /** @type {Record<string, WebGLUniformLocation | null>} */ const at = {};
    for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; i >= 0; i--) {
        const name = /** @type {WebGLActiveInfo} */ (gl.getActiveUniform(program, i)).name;
        at[name] = gl.getUniformLocation(program, name);
    }
    return {program, at};
}

/** @param {WebGL2RenderingContext} gl @param {number} format @param {number} width @param {number} height */
function makeTexture(gl, format, width, height) {
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
        gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    return texture;
}

/** @param {WebGL2RenderingContext} gl @param {(WebGLTexture | null)[]} colours @param {WebGLTexture | null} depth */
function makeTarget(gl, colours, depth) {
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    colours.forEach((c, i) => gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, c, 0));
    if (depth) gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
    gl.drawBuffers(colours.length ? colours.map((_c, i) => gl.COLOR_ATTACHMENT0 + i) : [gl.NONE]);
    return frame;
}

/**
 * The textures of one size of picture.
 * @param {WebGL2RenderingContext} gl
 * @param {number} width
 * @param {number} height
 * @param {boolean} sums
 */
function makeStage(gl, width, height, sums) {
    const layer = () => {
        const colour = makeTexture(gl, gl.RGBA8, width, height), normal = makeTexture(gl, gl.RGBA8, width, height);
        const name = makeTexture(gl, gl.R32UI, width, height);
        const depth = makeTexture(gl, gl.DEPTH_COMPONENT24, width, height);
        return {colour, normal, name, depth, target: makeTarget(gl, [colour, normal, name], depth)};
    };
    const solid = layer();
    const sample = makeTexture(gl, gl.RGBA8, width, height);
    const sum = sums ? makeTexture(gl, gl.RGBA16F, width, height) : null;
    /** @type {ReturnType<typeof layer> | null} */ let ghost = null;
    const stage = {
        width,
        height,
        solid,
        sample,
        sum,
        sampleTarget: makeTarget(gl, [sample], null),
        sumTarget: sum ? makeTarget(gl, [sum], null) : null,
        count: 0,
        ghost() { return ghost ??= layer(); },
        free() {
            for (const l of ghost ? [solid, ghost] : [solid]) {
                for (const t of [l.colour, l.normal, l.name, l.depth]) gl.deleteTexture(t);
                gl.deleteFramebuffer(l.target);
            }
            gl.deleteTexture(sample);
            gl.deleteTexture(sum);
            gl.deleteFramebuffer(stage.sampleTarget);
            gl.deleteFramebuffer(stage.sumTarget);
        }
    };
    return stage;
}

/** @param {HTMLCanvasElement} canvas */
function openGl(canvas) {
    const gl = canvas.getContext(
        "webgl2", {antialias: false, alpha: true, preserveDrawingBuffer: true, powerPreference: "high-performance"});
    if (!gl)
        throw new Error(
            "This browser offers no WebGL 2, which the picture needs: switch on graphics acceleration, " +
            "or use a current Firefox, Chrome or Safari.");
    return gl;
}

/** Everything that draws. @param {HTMLCanvasElement} canvas */
export function makeGpu(canvas) {
    const gl = openGl(canvas);
    const sums =
        gl.getExtension("EXT_color_buffer_float") !== null || gl.getExtension("EXT_color_buffer_half_float") !== null;
    // programs are made when they are first needed: most of them not for the first picture
    const texts = {
        block: [blockVertex(""), fragment("", "flat")],
        cut: [blockVertex(""), fragment("#define CUT\n", "flat")],
        depth: [blockVertex("#define DEPTH\n"), DEPTH_FRAGMENT],
        mesh: [MESH_VERTEX, fragment("")],
        meshCut: [MESH_VERTEX, fragment("#define CUT\n")],
        meshDepth: [MESH_VERTEX, DEPTH_FRAGMENT],
        arrow: [ARROW_VERTEX, fragment("")],
        show: [WHOLE_VERTEX, SHOW_FRAGMENT],
        draft: [WHOLE_VERTEX, lightFragment("")],
        full: [WHOLE_VERTEX, lightFragment("#define FULL\n")],
        draftGhost: [WHOLE_VERTEX, lightFragment("#define GHOST\n")],
        fullGhost: [WHOLE_VERTEX, lightFragment("#define GHOST\n#define FULL\n")]
    };
    /** @type {Partial<Record<keyof typeof texts, ReturnType<typeof makeProgram>>>} */ const programs = {};
    const [zones, zoneCaps, caps, sheets] = [0, 0, 0, 0].map(() => meshBuffer(gl));
    const arrows = arrowBuffer(gl), empty = gl.createVertexArray();
    const shadow = makeTexture(gl, gl.DEPTH_COMPONENT24, SHADOW, SHADOW), shadowTarget = makeTarget(gl, [], shadow);
    gl.bindTexture(gl.TEXTURE_2D, shadow);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.LINEAR);
    /** @type {ReturnType<typeof blockBuffer> | null} */ let blocks = null;
    /** @type {Record<string, {texture: WebGLTexture | null, height: number}>} */ const tables = {};
    /** @type {Map<number, ReturnType<typeof makeStage>>} */ const stages = new Map();

    /**
     * Numbers by block, 2048 texels a row.
     * @param {string} name
     * @param {Float32Array | Uint8Array} data
     * @param {number} [wide]
     */
    function table(name, data, wide = WIDE) {
        const floats = data instanceof Float32Array, height = Math.max(1, Math.ceil(data.length / 4 / wide));
        if (tables[name]?.height !== height || name === "palette") {
            gl.deleteTexture(tables[name]?.texture ?? null);
            tables[name] = {texture: makeTexture(gl, floats ? gl.RGBA32F : gl.RGBA8, wide, height), height};
        }
        gl.bindTexture(gl.TEXTURE_2D, tables[name].texture);
        const whole = Math.floor(data.length / 4 / wide), rest = data.length / 4 - whole * wide;
        const type = floats ? gl.FLOAT : gl.UNSIGNED_BYTE;
        if (whole)
            gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, wide, whole, gl.RGBA, type, data.subarray(0, whole * wide * 4));
        if (rest) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, whole, rest, 1, gl.RGBA, type, data.subarray(whole * wide * 4));
    }

    /** @param {keyof typeof texts} kind @param {[string, WebGLTexture | null][]} textures */
    function use(kind, textures) {
        const p = programs[kind] ??= makeProgram(gl, texts[kind][0], texts[kind][1]);
        gl.useProgram(p.program);
        textures.forEach(([name, texture], i) => {
            gl.activeTexture(gl.TEXTURE0 + i);
            gl.bindTexture(gl.TEXTURE_2D, texture);
            if (name in p.at) gl.uniform1i(p.at[name], i);
        });
        gl.activeTexture(gl.TEXTURE0);
        return p.at;
    }

    /**
     * @param {keyof typeof texts} kind
     * @param {Float32Array} matrix
     * @param {number} pixels
     * @param {Look} look
     * @param {number} group
     */
    function drawBlocks(kind, matrix, pixels, look, group) {
        if (!blocks || !tables.pose) return;
        const at = use(kind, [
            ["u_pose", tables.pose.texture], ["u_colour", tables.colour.texture], ["u_palette", tables.palette.texture]
        ]);
        gl.uniformMatrix4fv(at.u_matrix, false, matrix);
        gl.uniform1f(at.u_class, group);
        if (at.u_pixels) gl.uniform1f(at.u_pixels, pixels);
        if (at.u_faces) gl.uniform1i(at.u_faces, look.faces ? 1 : 0);
        if (at.u_plane) gl.uniform4fv(at.u_plane, look.plane);
        gl.bindVertexArray(blocks.array);
        gl.enable(gl.CULL_FACE);
        gl.drawElements(gl.TRIANGLES, blocks.count, gl.UNSIGNED_INT, 0);
        gl.disable(gl.CULL_FACE);
    }

    /**
     * @param {keyof typeof texts} kind
     * @param {ReturnType<typeof meshBuffer>} mesh
     * @param {Float32Array} matrix
     * @param {number} pixels
     * @param {number[]} plane
     * @param {boolean} ghosts
     */
    function drawMesh(kind, mesh, matrix, pixels, plane, ghosts) {
        const count = ghosts ? mesh.ghosts : mesh.solid;
        if (!count) return;
        const at = use(kind, []);
        gl.uniformMatrix4fv(at.u_matrix, false, matrix);
        if (at.u_pixels) gl.uniform1f(at.u_pixels, pixels);
        if (at.u_plane) gl.uniform4fv(at.u_plane, plane);
        gl.bindVertexArray(mesh.array);
        gl.drawArrays(gl.TRIANGLES, ghosts ? mesh.solid : 0, count);
    }

    /** What hides nothing: for the shadow of a whole model. @param {Look} look */
    const planeOf = (look) => (look.cut ? look.plane : [0, 0, 0, 1]);

    /**
     * @param {ReturnType<typeof makeStage>} stage
     * @param {Sight} sight
     * @param {Float32Array} matrix
     * @param {Look} look
     * @param {boolean} ghosts
     */
    function drawLayer(stage, sight, matrix, look, ghosts) {
        const layer = ghosts ? stage.ghost() : stage.solid;
        gl.bindFramebuffer(gl.FRAMEBUFFER, layer.target);
        gl.viewport(0, 0, stage.width, stage.height);
        gl.enable(gl.DEPTH_TEST);
        gl.disable(gl.BLEND);
        gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
        gl.clearBufferfv(gl.COLOR, 1, [0, 0, 0, 0]);
        gl.clearBufferuiv(gl.COLOR, 2, [NOTHING, 0, 0, 0]);
        gl.clearBufferfv(gl.DEPTH, 0, [1]);
        drawBlocks(look.cut ? "cut" : "block", matrix, sight.pixels * stage.height, look, ghosts ? 2 : 1);
        const pixels = sight.pixels * stage.height;
        gl.enable(gl.CULL_FACE);
        drawMesh(look.cut ? "meshCut" : "mesh", zones, matrix, pixels, look.plane, ghosts);
        gl.disable(gl.CULL_FACE);
        if (ghosts) return;
        for (const m of [zoneCaps, caps, sheets]) drawMesh("mesh", m, matrix, pixels, look.plane, false);
        if (!arrows.count) return;
        const at = use("arrow", []);
        gl.uniformMatrix4fv(at.u_matrix, false, matrix);
        gl.uniform3fv(at.u_towards, sight.towards);
        gl.bindVertexArray(arrows.array);
        gl.drawArraysInstanced(gl.TRIANGLES, 0, arrows.corners, arrows.count);
    }

    /**
     * @param {ReturnType<typeof makeStage>} stage
     * @param {Sight} sight
     * @param {Float32Array} matrix
     * @param {Look} look
     * @param {boolean} ghosts
     * @param {boolean} full
     * @param {number} random
     */
    function lightLayer(stage, sight, matrix, look, ghosts, full, random) {
        const layer = ghosts ? stage.ghost() : stage.solid;
        const at =
            use(full         ? (ghosts ? "fullGhost" : "full")
                    : ghosts ? "draftGhost"
                             : "draft",
                [
                    ["u_colours", layer.colour], ["u_normals", layer.normal], ["u_names", layer.name],
                    ["u_depth", layer.depth], ["u_before", stage.solid.depth], ["u_shadow", shadow]
                ]);
        gl.uniformMatrix4fv(at.u_back, false, sight.back);
        gl.uniformMatrix4fv(at.u_forth, false, matrix);
        gl.uniformMatrix4fv(at.u_light, false, look.light);
        for (const [name, v] of Object.entries({
                 u_sun: sight.sun,
                 u_up: sight.up,
                 u_ink: look.dark ? [0.03, 0.04, 0.05] : [0.1, 0.12, 0.15],
                 u_mark: look.dark ? [0.42, 0.7, 1] : [0.04, 0.4, 0.95]
             }))
            gl.uniform3fv(at[name], v);
        for (const [name, v] of Object.entries({
                 u_layer: ghosts ? look.ghost : 1,
                 u_radius: look.radius,
                 u_random: random,
                 u_line: look.edges,
                 u_shadows: look.shadows,
                 u_texel: look.reach * 2 / SHADOW
             }))
            gl.uniform1f(at[name], v);
        gl.uniform1ui(at.u_picked, look.picked >= 0 ? look.picked : NOTHING);
        gl.bindFramebuffer(gl.FRAMEBUFFER, stage.sampleTarget);
        gl.disable(gl.DEPTH_TEST);
        if (ghosts) {
            gl.enable(gl.BLEND);
            gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        } else gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
        gl.bindVertexArray(empty);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        gl.disable(gl.BLEND);
    }

    /** @param {WebGLTexture | null} texture @param {number} share @param {number} width @param {number} height */
    function show(texture, share, width, height) {
        gl.viewport(0, 0, width, height);
        const at = use("show", [["u_sum", texture]]);
        gl.uniform1f(at.u_share, share);
        gl.uniform2f(at.u_size, width, height);
        gl.bindVertexArray(empty);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    }

    /** @param {number} width @param {number} height @param {boolean} floats */
    function stageOf(width, height, floats) {
        const key = width * 65536 + height;
        let stage = stages.get(key);
        if (!stage) {
            for (const [k, s] of stages)
                if (stages.size > 2) {
                    s.free();
                    stages.delete(k);
                }
            stages.set(key, stage = makeStage(gl, width, height, floats && sums));
        }
        return stage;
    }

    return {
        gl,
        zones,
        zoneCaps,
        caps,
        sheets,
        arrows,
        table,
        sums,
        /** @param {import("./frames.js").Model} model */
        setBlocks(model) {
            if (blocks) {
                gl.deleteBuffer(blocks.buffer);
                gl.deleteBuffer(blocks.elements);
                gl.deleteVertexArray(blocks.array);
            }
            blocks = blockBuffer(gl, model);
        },
        /** The shadow as it falls now. @param {Look} look */
        drawShadow(look) {
            gl.bindFramebuffer(gl.FRAMEBUFFER, shadowTarget);
            gl.viewport(0, 0, SHADOW, SHADOW);
            gl.enable(gl.DEPTH_TEST);
            gl.clearBufferfv(gl.DEPTH, 0, [1]);
            drawBlocks("depth", look.light, 0, look, 1);
            gl.enable(gl.CULL_FACE);
            drawMesh("meshDepth", zones, look.light, 0, planeOf(look), false);
            gl.disable(gl.CULL_FACE);
        },
        /**
         * One picture; number 0 begins a new average.
         * @param {Sight} sight
         * @param {Float32Array} matrix
         * @param {Look} look
         * @param {number} width
         * @param {number} height
         * @param {number} number
         * @param {boolean} full
         */
        draw(sight, matrix, look, width, height, number, full) {
            const stage = stageOf(width, height, true), ghosts = look.ghosts && look.ghost > 0;
            drawLayer(stage, sight, matrix, look, false);
            if (ghosts) drawLayer(stage, sight, matrix, look, true);
            lightLayer(stage, sight, matrix, look, false, full, number);
            if (ghosts) lightLayer(stage, sight, matrix, look, true, full, number);
            let picture = stage.sample, share = 1;
            if (full && stage.sum) {
                gl.bindFramebuffer(gl.FRAMEBUFFER, stage.sumTarget);
                if (number === 0) gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
                gl.enable(gl.BLEND);
                gl.blendFunc(gl.ONE, gl.ONE);
                show(stage.sample, 1, width, height);
                gl.disable(gl.BLEND);
                picture = stage.sum;
                share = 1 / (number + 1);
            }
            gl.bindFramebuffer(gl.FRAMEBUFFER, null);
            show(picture, share, canvas.width, canvas.height);
        },
        /**
         * Names of what a small picture shows, from below to above.
         * @param {Sight} sight
         * @param {Look} look
         * @param {number} width
         * @param {number} height
         * @param {number[]} box x, y, width, height
         * @param {boolean} [ghosts]
         */
        names(sight, look, width, height, box, ghosts = false) {
            const stage = stageOf(width, height, true), out = new Uint32Array(4 * box[2] * box[3]);
            drawLayer(stage, sight, sight.matrix, look, ghosts);
            gl.readBuffer(gl.COLOR_ATTACHMENT2);
            gl.readPixels(box[0], box[1], box[2], box[3], gl.RGBA_INTEGER, gl.UNSIGNED_INT, out);
            return out.filter((_v, i) => i % 4 === 0);
        },
        /** Waits until the picture is made: for measuring. */
        wait() {
            gl.bindFramebuffer(gl.FRAMEBUFFER, null);
            gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        },
    };
}

/** What stands in where a browser cannot draw. @returns {ReturnType<typeof makeGpu>} */
export function noGpu() {
    const nothing = () => {}, sheets = {set: nothing, solid: 0};
    /** @type {any} */ const gpu = {
        gl: null,
        zones: sheets,
        zoneCaps: sheets,
        caps: sheets,
        sheets,
        arrows: sheets,
        sums: false,
        table: nothing,
        setBlocks: nothing,
        drawShadow: nothing,
        draw: nothing,
        wait: nothing,
        names:
            (/** @type {any} */ _sight, /** @type {any} */ _look, /** @type {number} */ _w, /** @type {number} */ _h,
             /** @type {number[]} */ box) => new Uint32Array(box[2] * box[3]).fill(NOTHING)
    };
    return gpu;
}
