-- landing.lua - boxes that land on a floor, or on a box that stands there, and tumble: how well the energy ledger closes and how deep
-- they go in.
--
--     local result = landing.run(joint, seed, kn, fraction)
--     result.balance     the worst balance of the ledger, of its largest term
--     result.depth       the deepest overlap over the deepest that the energy allows
--
-- `joint` has law and params of model:joint; `kn`, Pa/m, is the least normal stiffness of it, `fraction` that of the critical step.
local shapes = require "shapes"
local talus = require "talus"

local landing = {}

local DENSITY, GRAVITY = 2500, 10
local FALL = 0.3          -- m, at most
local TIME, LOOKS = 1, 50 -- s; at the ledger
local AXES = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

-- A box of random size; `tilt` in radians is how far it is turned at most, about any axis. It stands at `place`, a point of the plane
-- below its lowest corner.
local function add_box(model, random, tilt, place)
    local turn = shapes.turn(shapes.direction(random), random(-tilt, tilt))
    local box = shapes.placed(shapes.box(random(0.3, 1.3), random(0.3, 1.3), random(0.5, 1.5)), turn)
    local up = shapes.farthest(box, { 0, 0, -1 })
    model:generate("polyhedron", { vertices = shapes.placed(box, AXES, shapes.sum(place, up, { 0, 0, 1 })), density = DENSITY })
    local high = shapes.farthest(box, { 0, 0, 1 })
    return place[3] + up + high
end

-- A floor, one box that falls, and with every third seed another one below it.
local function build(joint, seed, fraction)
    local random = shapes.random(seed)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { -20, -20, -3 }, max = { 20, 20, 0 }, density = DENSITY })
    local top = 0
    if seed % 3 == 0 then
        top = add_box(model, random, 0, { 0, 0, 0 })
    end
    add_box(model, random, 0.6, { random(-0.2, 0.2), random(-0.2, 0.2), top + random(0, FALL) })
    model:blocks { id = 1 }:fix()
    model:joint("*", joint.law, joint.params)
    model:timestep { fraction = fraction }
    return model
end

-- Energy that blocks may spend on going in: what they weigh times the height of their centroids, J.
local function to_fall(model)
    local sum = 0
    for _, block in ipairs(model:blocks { fixed = false }) do
        sum = sum + block.mass * GRAVITY * block.centroid[3]
    end
    return sum
end

-- The energy of a field contact is 2 kn G. Of the corners of a box that go into a plane by D, the one on the diagonal has the smallest
-- G: there 1 - x1 - x2 - x3 and sqrt(3) x1, ... are the depths over D, and G = D^4 (3 sqrt(3) / 6) / 4 / (1 + sqrt(3)).
local LEAST = math.sqrt(3) / 8 / (1 + math.sqrt(3))

function landing.run(joint, seed, kn, fraction)
    local model = build(joint, seed, fraction)
    local energy, balance, overlap = to_fall(model), 0, 0
    for look = 1, LOOKS do
        model:solve { ratio = 0, max_time = math.max(1e-9, look * TIME / LOOKS - model.time) }
        balance = math.max(balance, math.abs(model:energy().balance))
        overlap = math.max(overlap, #model:contacts() > 0 and -model:contacts():min "gap" or 0)
    end
    return { balance = balance, depth = overlap / (energy / (2 * kn * LEAST)) ^ 0.25 }
end

return landing
