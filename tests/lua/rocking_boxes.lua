-- rocking_boxes.lua - boxes that stand on a floor, are kicked, and rock and spin on their foot: how well the energy ledger closes, and whether
-- more comes back than was put in. Where slip opens the joint each point of it is opened by its own way.
--
--     local result = rocking_boxes.run(joint, seed, fraction)
--     result.balance     the worst balance of the ledger, of its largest term
--     result.made        kinetic, potential and stored energy less that of the kick, at the most, over this
--
-- `joint` has law and params of model:joint; `fraction` is that of the critical step.
local shapes = require "shapes"
local talus = require "talus"

local rocking_boxes = {}

local DENSITY, GRAVITY = 2000, 9.81
local TIME, EVERY = 0.05, 20 -- s; steps between looks at the ledger

local function build(joint, seed, fraction)
    local random = shapes.random(seed)
    local x, y, z = random(0.3, 0.6), random(0.3, 0.6), random(0.5, 1.2)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { -10, -10, -2 }, max = { 10, 10, 0 }, density = DENSITY })
    model:generate("box", { min = { -x, -y, 0 }, max = { x, y, z }, density = DENSITY })
    model:blocks { id = 1 }:fix()
    model:joint("*", joint.law, joint.params)
    model:timestep { fraction = fraction }
    model:blocks { id = 2 }:set {
        velocity = { random(-0.02, 0.02), random(-0.02, 0.02), 0 },
        angular_velocity = { random(-0.3, 0.3), random(-0.3, 0.3), random(-0.1, 0.1) },
    }
    return model
end

local function held(energy)
    return energy.kinetic + energy.potential + energy.stored - energy.external
end

function rocking_boxes.run(joint, seed, fraction)
    local model = build(joint, seed, fraction)
    local kick, from = nil, nil
    local balance, made = 0, 0
    model:cycle(1)
    kick, from = model:energy().kinetic, held(model:energy())
    while model.time < TIME do
        model:cycle(EVERY)
        local energy = model:energy()
        balance = math.max(balance, math.abs(energy.balance))
        made = math.max(made, (held(energy) - from) / kick)
    end
    return { balance = balance, made = made }
end

return rocking_boxes
