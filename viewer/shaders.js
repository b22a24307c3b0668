// The programs of the picture. A first pass writes colour, normal and name (block and face) of what is seen; a second
// makes light, shadow, occlusion and edges from them.
// @ts-check

const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
precision highp sampler2DShadow;
`;

// Poses are two texels a block: place and class; quaternion without w (which is not negative) and radius. Classes: 0
// not there, 1 solid, 2 ghost; 4 more where the section cuts the block.
const POSE = `
uniform highp sampler2D u_pose;
uniform sampler2D u_colour;
uniform sampler2D u_palette;
uniform mat4 u_matrix;
uniform float u_class, u_pixels;
ivec2 at(int i, sampler2D s) { int w = textureSize(s, 0).x; return ivec2(i % w, i / w); }
vec3 turn(vec4 q, vec3 v) { vec3 t = 2.0 * cross(q.xyz, v); return v + q.w * t + cross(q.xyz, t); }
vec4 quaternion(vec4 t) { return vec4(t.xyz, sqrt(max(0.0, 1.0 - dot(t.xyz, t.xyz)))); }
`;

/** @param {string} define */
export function blockVertex(define) {
    return HEAD + define + POSE + `
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in uvec2 a_name; // block row and face; joint
uniform bool u_faces;
flat out vec4 v_colour; // w: how strong its edges are
flat out vec4 v_normal;
flat out uint v_name;
flat out float v_cut;
out vec3 v_world;
void main() {
    int row = int(a_name.x & 0xffffffu);
    vec4 place = texelFetch(u_pose, at(2 * row, u_pose), 0);
    bool cut = place.w >= 4.0;
    if (place.w - (cut ? 4.0 : 0.0) != u_class) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
    vec4 second = texelFetch(u_pose, at(2 * row + 1, u_pose), 0), q = quaternion(second);
    v_world = place.xyz + turn(q, a_place);
    gl_Position = u_matrix * vec4(v_world, 1.0);
#ifndef DEPTH
    v_normal = vec4(turn(q, a_normal), 1.0);
    v_colour = texelFetch(u_colour, at(row, u_colour), 0); // w: its own colour, whatever its faces have
    if (u_faces && v_colour.w < 0.5)
        v_colour = texelFetch(u_palette, ivec2(int(a_name.y) % textureSize(u_palette, 0).x, 0), 0);
    v_colour.w = clamp(second.w * u_pixels / gl_Position.w / 9.0, 0.0, 1.0);
    v_name = a_name.x;
#endif
    v_cut = cut ? 1.0 : 0.0;
}`;
}

/**
 * What is seen of blocks, meshes, polygons and arrows. The sides of a polygon are lit alike.
 * @param {string} define
 * @param {string} flat blocks have one colour for each face
 */
export function fragment(define, flat = "") {
    return HEAD + define + `
${flat} in vec4 v_colour;
flat in vec4 v_normal;
flat in uint v_name;
flat in float v_cut;
in vec3 v_world;
uniform vec4 u_plane;
layout(location = 0) out vec4 o_colour;
layout(location = 1) out vec4 o_normal;
layout(location = 2) out uint o_name;
void main() {
#ifdef CUT
    if (v_cut > 0.0 && dot(u_plane.xyz, v_world) > u_plane.w) discard;
#endif
    o_colour = v_colour;
    o_normal = vec4(v_normal.xyz * (gl_FrontFacing ? 0.5 : -0.5) + 0.5, v_normal.w);
    o_name = v_name;
}`;
}

export const DEPTH_FRAGMENT = HEAD + `
flat in float v_cut;
in vec3 v_world;
uniform vec4 u_plane;
void main() { if (v_cut > 0.0 && dot(u_plane.xyz, v_world) > u_plane.w) discard; }`;

// Triangles of deformable blocks and of their sections, polygons of contacts and sections: places in the model. The
// fourth number of a normal is 1 where it is lit, 0 flat: sections have the colours of the legend. Edges of small
// triangles fade.
export const MESH_VERTEX = HEAD + `
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec4 a_normal;
layout(location = 2) in vec4 a_colour;
layout(location = 3) in uint a_name;
layout(location = 4) in float a_size;
uniform mat4 u_matrix;
uniform float u_pixels;
out vec4 v_colour;
flat out vec4 v_normal;
flat out uint v_name;
flat out float v_cut;
out vec3 v_world;
void main() {
    v_world = a_place;
    gl_Position = u_matrix * vec4(a_place, 1.0);
    v_cut = 1.0;
    v_colour = vec4(a_colour.rgb, clamp(a_size * u_pixels / gl_Position.w / 9.0, 0.0, 1.0));
    v_normal = a_normal;
    v_name = a_name;
}`;

// Arrows: one mesh (along z, from 0 to 1) drawn for each. They lie in front of everything else. One of negative width
// is a rod, without a head.
export const ARROW_VERTEX = HEAD + `
layout(location = 0) in vec4 a_mesh; // radius direction x, y; radius; z: negative z counts from the tip in heads
layout(location = 1) in vec3 a_tail;
layout(location = 2) in vec4 a_way; // w: width
layout(location = 3) in vec4 a_colour;
layout(location = 4) in uint a_name;
uniform mat4 u_matrix;
uniform vec3 u_towards;
out vec4 v_colour;
flat out vec4 v_normal;
flat out uint v_name;
void main() {
    float l = max(length(a_way.xyz), 1e-20), head = clamp(a_way.w * 4.5, 0.0, l);
    vec3 z = a_way.xyz / l;
    vec3 x = normalize(abs(z.z) < 0.9 ? cross(z, vec3(0, 0, 1)) : cross(z, vec3(1, 0, 0))), y = cross(z, x);
    vec3 out_ = x * a_mesh.x + y * a_mesh.y;
    float along = a_mesh.w < 0.0 ? l + a_mesh.w * head : a_mesh.w * (l - head);
    float radius = a_way.w < 0.0 ? -min(a_mesh.z, 0.5) : a_mesh.z;
    gl_Position = u_matrix * vec4(a_tail + z * along + out_ * radius * a_way.w, 1.0);
    gl_Position.z = mix(-gl_Position.w, gl_Position.z, 0.01);
    float light = 0.72 + 0.28 * dot(normalize(out_ + z * 0.3), u_towards);
    v_colour = vec4(a_colour.rgb * light, a_way.w < 0.0 ? 0.3 : 1.0);
    v_normal = vec4(out_, 0.0);
    v_name = a_name;
}`;

export const WHOLE_VERTEX = HEAD + `
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;

/** Light, shadow, occlusion and edges of one layer. @param {string} define */
export function lightFragment(define) {
    return HEAD + define + `
uniform sampler2D u_colours, u_normals;
uniform usampler2D u_names;
uniform highp sampler2D u_depth, u_before;
uniform highp sampler2DShadow u_shadow;
uniform mat4 u_back, u_forth, u_light;
uniform vec3 u_sun, u_up, u_ink, u_mark;
uniform float u_layer, u_radius, u_random, u_line, u_shadows, u_texel;
uniform uint u_picked;
out vec4 o;
const uint NONE = 0xffffffffu;
// Different in neighbouring pixels, and even over the pictures that are averaged.
float noise(vec2 p, float step) {
    return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715))) + u_random * step);
}
vec3 world(vec2 uv, float depth) { vec4 p = u_back * vec4(vec3(uv, depth) * 2.0 - 1.0, 1.0); return p.xyz / p.w; }
uint whole(uint name) { return (name & 0x80000000u) != 0u ? name : name & 0xffffffu; }
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy), end = textureSize(u_names, 0) - 1;
    uint name = texelFetch(u_names, p, 0).r;
    vec4 colour = vec4(0.0);
    float strength = 0.0;
    if (name != NONE) {
        vec4 albedo = texelFetch(u_colours, p, 0), n4 = texelFetch(u_normals, p, 0);
        vec3 n = normalize(n4.xyz * 2.0 - 1.0);
        strength = albedo.a;
        float depth = texelFetch(u_depth, p, 0).r;
#ifdef GHOST
        if (depth > texelFetch(u_before, p, 0).r) discard;
#endif
        vec3 lit = albedo.rgb;
        if (n4.a > 0.5) {
            float sun = max(0.0, dot(n, u_sun)), open = 1.0;
#ifdef FULL
            vec2 uv = gl_FragCoord.xy / vec2(end + 1);
            vec3 here = world(uv, depth);
            vec4 s = u_light * vec4(here + n * u_texel * (1.5 + 2.5 * (1.0 - sun)), 1.0);
            float a0 = 6.2832 * noise(gl_FragCoord.xy, 0.618034), r0 = sqrt(noise(gl_FragCoord.yx + 17.0, 0.7548777));
            s.xyz = s.xyz * 0.5 + 0.5;
            if (u_shadows > 0.0 && s.x > 0.0 && s.y > 0.0 && s.x < 1.0 && s.y < 1.0) {
                vec2 aside = 0.0025 * r0 * vec2(cos(a0), sin(a0));
                sun *= mix(1.0, texture(u_shadow, vec3(s.xy + aside, s.z - 0.0015)), u_shadows);
            }
            vec3 t = normalize(abs(n.z) < 0.9 ? cross(n, vec3(0, 0, 1)) : cross(n, vec3(1, 0, 0))), b = cross(n, t);
            float shut = 0.0;
            for (int i = 0; i < 6; i++) {
                float f = (float(i) + noise(gl_FragCoord.xy, 0.7548777)) / 6.0;
                float a = 6.2832 * (noise(gl_FragCoord.yx + 31.0, 0.5698403) + float(i) * 0.618034);
                float h = sqrt(1.0 - f);
                float share = 0.15 + 0.85 * fract(noise(gl_FragCoord.xy + 53.0, 0.8191725) + float(i) * 0.381966);
                vec3 q = here + (t * cos(a) * sqrt(f) + b * sin(a) * sqrt(f) + n * h) * u_radius * share;
                vec4 c = u_forth * vec4(q, 1.0);
                vec3 d = c.xyz / c.w * 0.5 + 0.5;
                if (d.x <= 0.0 || d.y <= 0.0 || d.x >= 1.0 || d.y >= 1.0) continue;
                ivec2 e = ivec2(d.xy * vec2(end + 1));
                float z = texelFetch(u_depth, e, 0).r;
                if (z < d.z - 1e-5) shut += 1.0 - smoothstep(0.5, 2.0, distance(world(d.xy, z), here) / u_radius);
            }
            open = 1.0 - 0.75 * shut / 6.0;
#endif
            float sky = 0.5 + 0.5 * dot(n, u_up);
            lit *= (0.56 + 0.14 * sky) * open + 0.36 * sun;
        }
        colour = vec4(lit, 1.0);
    }
    // An edge is where the next pixel to the right or below has another name: one line, none doubled.
    float line = 0.0;
    bool mark = false;
    int w = int(max(1.0, u_line));
    for (int i = 1; i <= w; i++) {
        uint x = texelFetch(u_names, min(p + ivec2(i, 0), end), 0).r;
        uint y = texelFetch(u_names, min(p + ivec2(0, i), end), 0).r;
        if (x != name || y != name) {
            bool block = whole(x) != whole(name) || whole(y) != whole(name) || x == NONE || y == NONE || name == NONE;
            line = max(line, block ? 0.85 : 0.5);
            if (name == NONE) strength = max(x != NONE ? texelFetch(u_colours, min(p + ivec2(i, 0), end), 0).a : 0.0,
                y != NONE ? texelFetch(u_colours, min(p + ivec2(0, i), end), 0).a : 0.0);
        }
    }
    line *= u_line > 0.0 ? strength : 0.0;
    colour = vec4(mix(colour.rgb, u_ink, line), max(colour.a, line));
    if (u_picked != NONE) {
        bool inside = name != NONE && whole(name) == u_picked;
        for (int i = 0; i < 12; i++) {
            float a = float(i) * 0.5236;
            ivec2 beside = p + ivec2(round(2.5 * max(1.0, u_line) * vec2(cos(a), sin(a))));
            uint k = texelFetch(u_names, clamp(beside, ivec2(0), end), 0).r;
            if ((k != NONE && whole(k) == u_picked) != inside) mark = true;
        }
        if (mark) colour = vec4(u_mark, 1.0);
        else if (inside) colour.rgb = mix(colour.rgb, u_mark, 0.12);
    }
    if (u_layer < 1.0) { // a ghost: its edges stay visible
        float a = colour.a * mix(u_layer, 1.0, max(0.35 * line, mark ? 1.0 : 0.0));
        colour.a = a;
    }
    o = vec4(colour.rgb * colour.a, colour.a);
}`;
}

export const SHOW_FRAGMENT = HEAD + `
uniform sampler2D u_sum;
uniform float u_share;
uniform vec2 u_size;
out vec4 o;
void main() { o = texture(u_sum, gl_FragCoord.xy / u_size) * u_share; }`;
