-- Every law gives the same motion whichever block was made first, however the whole model is turned, and at
-- an offset of a million block sizes.
local talus = require "talus"
local check = require "check"

local LAWS = {
    { "elastic", { kn = 1e8, ks = 5e7 } },
    { "coulomb", { kn = 1e8, ks = 5e7, friction = 25, cohesion = 500, dilation = 4 } },
    { "coulomb_tensile", { kn = 1e8, ks = 5e7, friction = 25, cohesion = 2e3, tension = 2e3 } },
}
-- The motion is some 1e-3 m; coordinates are rounded to 1e-16 of theirs, and what is exact at 0 is exact at
-- the offset: multiples of 2^-13.
local SAME = 1e-9 -- of the motion

local function turned(q, v)
    local w, x, y, z = q[1], q[2], q[3], q[4]
    local tx, ty, tz = 2 * (y * v[3] - z * v[2]), 2 * (z * v[1] - x * v[3]), 2 * (x * v[2] - y * v[1])
    return { v[1] + w * tx + y * tz - z * ty, v[2] + w * ty + z * tx - x * tz,
        v[3] + w * tz + x * ty - y * tx }
end

local function corners(min, max, place)
    local list = {}
    for i = 0, 7 do
        list[#list + 1] = place { i % 2 == 0 and min[1] or max[1], i // 2 % 2 == 0 and min[2] or max[2],
            i // 4 == 0 and min[3] or max[3] }
    end
    return list
end

-- A block thrown obliquely over a fixed one, in the frame of the model: how it moved, and turned.
local function throw(law, options)
    local q, o = options.turn or { 1, 0, 0, 0 }, options.offset or { 0, 0, 0 }
    local function place(v)
        local r = turned(q, v)
        return { r[1] + o[1], r[2] + o[2], r[3] + o[3] }
    end
    local model = talus.model { gravity = turned(q, { 0, 0, -10 }) }
    local base = { vertices = corners({ -1, -1, -1 }, { 2, 2, 0 }, place), density = 2000, group = "base" }
    local block = { vertices = corners({ 0, 0.25, 0 }, { 1, 1, 1 }, place), density = 2000, group = "block" }
    model:generate("polyhedron", options.swapped and block or base)
    model:generate("polyhedron", options.swapped and base or block)
    model:blocks { group = "base" }:fix()
    model:joint("*", law[1], law[2])
    model:timestep { dt = 2e-4 }
    local thrown = model:blocks { group = "block" }
    thrown:set { velocity = turned(q, { 0.05, 0.03, -0.01 }), angular_velocity = turned(q, { 0, 0, 0.02 }) }
    model:cycle(150)
    local back = { q[1], -q[2], -q[3], -q[4] }
    return turned(back, thrown[1].displacement), turned(back, thrown[1].angular_velocity)
end

local function agree(what, a, b)
    local size = math.sqrt(a[1] ^ 2 + a[2] ^ 2 + a[3] ^ 2)
    check.holds(size > 0, what .. ": it moves")
    for k = 1, 3 do
        check.holds(math.abs(a[k] - b[k]) <= SAME * size,
            string.format("%s: component %d: %.17g and %.17g", what, k, a[k], b[k]))
    end
end

local norm = math.sqrt(0.8 ^ 2 + 0.3 ^ 2 + 0.4 ^ 2 + 0.33 ^ 2)
local turn = { 0.8 / norm, 0.3 / norm, -0.4 / norm, 0.33 / norm }
for _, law in ipairs(LAWS) do
    local u, w = throw(law, {})
    for name, options in pairs { swapped = { swapped = true }, turned = { turn = turn },
        ["far away"] = { offset = { 1e6, -1e6, 1e6 } } } do
        local u1, w1 = throw(law, options)
        agree(law[1] .. ", " .. name .. ", displacement", u, u1)
        agree(law[1] .. ", " .. name .. ", angular velocity", w, w1)
    end
end
