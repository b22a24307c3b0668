-- impacts.lua - two blocks that meet without friction, and what the impact does to energy, momentum and angular momentum.
--
-- A case is a shape (cube, hull, plate, needle) and a way to meet: "random" (two free blocks in any attitude), "floor"
-- (one block in any attitude on a fixed one, under gravity), "edges", "edges askew", "corners", "corners askew" (two
-- equal cubes, edge on edge or corner on corner, in the same attitude or nearly so). Blocks meet at 5 m/s.
--
-- Two figures of energy, over the initial kinetic energy: the worst error at any time of kinetic, potential and stored
-- energy from the model's ledger; and the error of the kinetic energy, plus m g z, from velocities and places after the
-- blocks have parted, which owes nothing to the ledger.
local talus = require "talus"
local shapes = require "shapes"

local impacts = {}

local DENSITY, SPEED = 2500, 5 -- kg/m3, m/s
local GRAVITY = 10             -- m/s2, where there is any
local APART = 1e-3             -- m at the start, along the line of approach
local PARTED = 0.01            -- s without a force: then they have parted
local LONGEST = 0.6            -- s: so long they are followed at most
local LOOK = 4                 -- steps between looks at the ledger
local INSTANT = 1e-12          -- s: a step in which nothing turns, for velocities are those of half a step ago
local ASKEW = 0.1              -- rad at most between cubes that meet askew
local OFF = 0.05               -- m at most between edges and corners that meet

impacts.shapes = { "cube", "hull", "plate", "needle" }
impacts.ways = { "random", "floor", "edges", "edges askew", "corners", "corners askew" }

local function shape(name, random)
    if name == "hull" then
        return shapes.hull(random, math.floor(random(12, 16.999)), 0.6)
    end
    local sides = { cube = { 1, 1, 1 }, plate = { 1, 1, 0.12 }, needle = { 0.2, 0.2, 1.4 } }
    return shapes.box(table.unpack(sides[name]))
end

-- The attitude in which a cube stands on its edge along y, or on its corner.
local function on_edge()
    return shapes.turn({ 0, 1, 0 }, math.pi / 4)
end

local function on_corner()
    local axis = { -math.sqrt(0.5), math.sqrt(0.5), 0 }
    return shapes.turn(axis, math.acos(1 / math.sqrt(3)))
end

-- Vertices of both blocks and the direction from the first to the second.
local function pair(name, way, random)
    local none = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
    if way == "floor" then
        local block = shapes.placed(shape(name, random), shapes.attitude(random))
        return shapes.placed(shapes.box(6, 6, 2), none), block, { 0, 0, 1 }
    elseif way == "random" then
        local a = shapes.placed(shape(name, random), shapes.attitude(random))
        local b = shapes.placed(shape(name, random), shapes.attitude(random))
        return a, b, shapes.direction(random)
    end
    local attitude = way:find "edges" and on_edge() or on_corner()
    local a, other = shapes.placed(shape(name, random), attitude), attitude
    if way:find "askew" then
        other = shapes.product(shapes.turn(shapes.direction(random), random(0, ASKEW)), attitude)
    end
    -- a third of the pairs meets exactly
    local off = random(0, 3) < 1 and 0 or OFF
    return a, shapes.placed(shape(name, random), other, { random(-off, off), random(-off, off), 0 }), { 0, 0, 1 }
end

local function scaled(v, factor)
    return { v[1] * factor, v[2] * factor, v[3] * factor }
end

-- Kinetic and potential energy, momentum and angular momentum about the origin, from what blocks tell of themselves.
local function tally(model)
    model:timestep { dt = INSTANT }
    model:cycle(2)
    local energy, momentum, angular = 0, { 0, 0, 0 }, { 0, 0, 0 }
    for _, block in ipairs(model:blocks { fixed = false }) do
        local mass, inertia, omega, v, x = block.mass, block.inertia, block.angular_velocity, block.velocity,
            block.centroid
        local spin = shapes.apply({ { inertia.xx, inertia.xy, inertia.zx }, { inertia.xy, inertia.yy, inertia.yz },
            { inertia.zx, inertia.yz, inertia.zz } }, omega)
        energy = energy + mass * shapes.dot(v, v) / 2 + shapes.dot(spin, omega) / 2
            - mass * shapes.dot(model.gravity, x)
        momentum = shapes.sum(momentum, mass, v)
        angular = shapes.sum(shapes.sum(angular, 1, spin), mass, shapes.cross(x, v))
    end
    return energy, momentum, angular
end

local function build(name, way, kn, seed)
    local random = shapes.random(seed)
    local a, b, direction = pair(name, way, random)
    local model = talus.model { gravity = { 0, 0, way == "floor" and -GRAVITY or 0 } }
    b = shapes.placed(b, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
        scaled(direction, shapes.beyond(a, b, direction, APART)))
    model:generate("polyhedron", { vertices = a, density = DENSITY })
    model:generate("polyhedron", { vertices = b, density = DENSITY })
    model:joint("*", "coulomb", { kn = kn, ks = kn / 2, friction = 0 })
    local first, second = model:blocks { id = 1 }, model:blocks { id = 2 }
    local stray = way == "random" or way == "floor" -- a little in any direction, and turning
    local function set(blocks, speed)
        local v, w = scaled(direction, speed), { 0, 0, 0 }
        if stray then
            v = shapes.sum(v, 0.5, shapes.direction(random))
            w = scaled(shapes.direction(random), 2)
        end
        blocks:set { velocity = v, angular_velocity = w }
    end
    if way == "floor" then
        first:fix()
        set(second, -SPEED)
    else
        set(first, SPEED / 2)
        set(second, -SPEED / 2)
    end
    return model
end

-- Runs one impact with a share of the critical step. Gives a table of errors: worst (of the ledger, at any time), parted
-- (of kinetic and potential energy, once the blocks have parted; nil if they never do), momentum and angular (over the
-- momentum of one block, times a metre for the latter; nil on the floor); and touched, whether they met at all.
function impacts.run(name, way, kn, seed, fraction)
    local model = build(name, way, kn, seed)
    local kinetic = model:blocks { fixed = false }:sum "kinetic_energy"
    local energy, momentum, angular = tally(model)
    local result, last = { worst = 0 }, nil
    local ledger = model:energy()
    local before = ledger.kinetic + ledger.potential + ledger.stored - ledger.external
    model:timestep { fraction = fraction }
    while model.time < LONGEST and not (last and model.time > last + PARTED) do
        model:cycle(LOOK)
        ledger = model:energy()
        local now = ledger.kinetic + ledger.potential + ledger.stored + ledger.friction + ledger.damping
            - ledger.external
        result.worst = math.max(result.worst, math.abs(now - before) / kinetic)
        last = ledger.stored > 0 and model.time or last
    end
    result.touched, result.steps = last ~= nil, model.cycles
    if ledger.stored == 0 then
        local energy_after, momentum_after, angular_after = tally(model)
        result.parted = math.abs(energy_after - energy) / kinetic
        if way ~= "floor" then
            local blocks = model:blocks()
            local unit = SPEED / 2 * math.max(blocks[1].mass, blocks[2].mass)
            result.momentum = shapes.length(shapes.sum(momentum_after, -1, momentum)) / unit
            result.angular = shapes.length(shapes.sum(angular_after, -1, angular)) / unit
        end
    end
    return result
end

-- What the targets are: of energy over the kinetic energy at a tenth of the critical step; by how much its error must
-- fall with half the step, where it is more than the least; of momentum.
impacts.ENERGY, impacts.FALL, impacts.SMALL, impacts.MOMENTUM = 1e-3, 1 / 3, 1e-6, 1e-11

-- The least error of a row that a shorter step need not make less. Cubes that meet edge on edge in the same attitude slide along
-- each other with flush faces at 3.5 m/s. A patch has no force at its borders (docs/theory.md, "Patch"), so what its area
-- stores comes and goes without work: while it is pressed in by up to 4e-3 of its width, up to 1.4e-4 of the energy.
function impacts.least(way)
    return way == "edges" and 2e-4 or impacts.SMALL
end

-- All shapes and ways at several stiffnesses, `seeds` of each: a list of rows with a name, the worst figures at a tenth of
-- the critical step, and the root mean square over the seeds of the ledger's error at a tenth (`mean`) and a twentieth
-- (`half`). `apart` counts those that parted.
function impacts.survey(seeds, each)
    for _, way in ipairs(impacts.ways) do
        for _, name in ipairs((way == "random" or way == "floor") and impacts.shapes or { "cube" }) do
            for _, kn in ipairs { 1e8, 1e9, 1e10 } do
                local row = { name = string.format("%s, %s, kn %.0e", name, way, kn), least = impacts.least(way), worst = 0,
                    parted = 0, momentum = 0, angular = 0, mean = 0, half = 0, met = 0, apart = 0, seeds = seeds }
                for seed = 1, seeds do
                    local result = impacts.run(name, way, kn, seed, 0.1)
                    for _, key in ipairs { "worst", "parted", "momentum", "angular" } do
                        row[key] = math.max(row[key], result[key] or 0)
                    end
                    row.met = row.met + (result.touched and 1 or 0)
                    row.apart = row.apart + (result.parted and 1 or 0)
                    row.mean = row.mean + result.worst ^ 2 / seeds
                    row.half = row.half + impacts.run(name, way, kn, seed, 0.05).worst ^ 2 / seeds
                end
                row.mean, row.half = math.sqrt(row.mean), math.sqrt(row.half)
                each(row)
            end
        end
    end
end

return impacts
