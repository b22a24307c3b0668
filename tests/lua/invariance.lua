-- invariance.lua - hulls and cubes that fall on a floor, in other places, attitudes and units: what happens is the same.
local talus = require "talus"
local shapes = require "shapes"

local invariance = {}

local KN, DENSITY, GRAVITY, FRICTION = 1e9, 2500, 9.81, 30 -- Pa/m, kg/m3, m/s2, degrees
local STEP = 2.5e-5 -- s

-- By how much places may differ (m, of blocks of a metre) and turns: rounding, grown by collisions.
invariance.SAME = 1e-8
local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

-- Vertices of the floor and of two layers of blocks, 0.7 to 1 m in size, which fall on it and on each other.
local function blocks(seed)
    local random = shapes.random(seed)
    local list = { shapes.placed(shapes.box(7, 7, 1), NONE, { 0, 0, -0.5 }) }
    for k = 0, 17 do
        local vertices = k % 3 == 0 and shapes.box(0.6, 0.6, 0.6)
            or shapes.hull(random, math.floor(random(12, 16.999)), 0.5)
        local centre = { 1.1 * (k % 3 - 1) + random(-0.03, 0.03), 1.1 * (k // 3 % 3 - 1) + random(-0.03, 0.03),
            0.62 + 1.02 * (k // 9) }
        list[#list + 1] = shapes.placed(vertices, shapes.attitude(random), centre)
    end
    return list
end

-- A form has a matrix, which may mirror, a shift in metres and a unit of length. Force stays newton and time second, so
-- density goes as length^-4, kn, force / length^3, as length^-3.
local function build(seed, form)
    local unit = form.unit or 1
    local function place(x, shift)
        local y = shapes.apply(form.matrix or NONE, x)
        y = shapes.sum(y, 1, shift)
        return { unit * y[1], unit * y[2], unit * y[3] }
    end
    local model = talus.model { gravity = place({ 0, 0, -GRAVITY }, { 0, 0, 0 }) }
    for _, vertices in ipairs(blocks(seed)) do
        local list = {}
        for i, x in ipairs(vertices) do
            list[i] = place(x, form.shift or { 0, 0, 0 })
        end
        model:generate("polyhedron", { vertices = list, density = DENSITY / unit ^ 4 })
    end
    model:joint("*", "coulomb", { kn = KN / unit ^ 3, ks = KN / 2 / unit ^ 3, friction = FRICTION })
    model:blocks { id = 1 }:fix()
    model:timestep { dt = STEP }
    return model
end

local function transposed(m)
    return { { m[1][1], m[2][1], m[3][1] }, { m[1][2], m[2][2], m[3][2] }, { m[1][3], m[2][3], m[3][3] } }
end

-- Displacements of all blocks and turns (the vector part of the quaternion, which is an axial vector), seen from the first
-- form.
local function motion(model, form)
    local m, unit, out = form.matrix or NONE, form.unit or 1, {}
    local back = transposed(m)
    local sense = shapes.dot(m[1], shapes.cross(m[2], m[3])) -- -1 in a mirror
    for _, block in ipairs(model:blocks()) do
        local u, q = shapes.apply(back, block.displacement), block.rotation
        local turn = shapes.apply(back, { q[2], q[3], q[4] })
        for i = 1, 3 do
            out[#out + 1] = u[i] / unit
            out[#out + 1] = sense * turn[i]
        end
    end
    return out
end

local MIRROR = { { -1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

function invariance.forms(seed)
    local random = shapes.random(seed + 1000)
    local d = shapes.direction(random)
    return {
        { name = "turned", matrix = shapes.attitude(random) },
        { name = "turned and mirrored", matrix = shapes.product(MIRROR, shapes.attitude(random)) },
        { name = "mirrored", matrix = MIRROR },
        { name = "in millimetres", unit = 1000 },
        { name = "moved by 1 km", shift = { 1e3 * d[1], 1e3 * d[2], 1e3 * d[3] } },
    }
end

-- Runs a scene for a time in all its forms, and calls each(form, largest difference, loaded contacts) for each.
function invariance.run(seed, time, each)
    local first = build(seed, {})
    first:cycle(math.floor(time / STEP + 0.5))
    local expected, contacts = motion(first, {}), first:contacts { where = function(c) return c.normal_force > 0 end }
    for _, form in ipairs(invariance.forms(seed)) do
        local model, worst = build(seed, form), 0
        model:cycle(math.floor(time / STEP + 0.5))
        for i, x in ipairs(motion(model, form)) do
            worst = math.max(worst, math.abs(x - expected[i]))
        end
        each(form, worst, #contacts)
    end
end

return invariance
