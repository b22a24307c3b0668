-- Nothing goes through anything: boxes tumble onto a floor on joints of every law. Without damping the energy stays, and heat only
-- grows: what is handed over from patches to fields is booked as heat, and must not hide energy that is made. With damping
-- they come to rest on a face, pressed in by what their weight needs at that stiffness.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local landing = require "landing"
local shapes = require "shapes"
local talus = require "talus"

local KN, DENSITY, GRAVITY = 1e9, 2500, 10
local FRACTION = 0.05 -- of the critical step: impacts are to be resolved
local BALANCE = 1e-3  -- of the largest term of the energy
local NO_HEAT = 1e-4  -- of what a box may fall through
local SPRINGS = { kn = KN, ks = KN, friction = 35 }

local function springs(more)
    for key, value in pairs(SPRINGS) do
        more[key] = value
    end
    return more
end

local LAWS = {
    { "coulomb", springs {} },
    { "coulomb", springs { cohesion = 1e5 } },
    { "coulomb_tensile", springs { tension = 1e5, cohesion = 1e5 } },
    { "cohesive", springs { tension = 1e5, cohesion = 1e5, energy_tension = 10, energy_shear = 10 } },
    { "slip_weakening", springs { distance = 0.01 } },
    { "coulomb", springs { dilation = 8 } },
    { "coulomb_tensile", springs { tension = 1e5, cohesion = 1e5, dilation = 8 } },
    { "barton_bandis", { kn = KN, ks = KN, jrc = 8, jcs = 1e7, phi_r = 30, vm = 2e-2 } },
    { "barton_bandis", { kn = KN, ks = KN, jrc = 8, jcs = 1e7, phi_r = 30, vm = 2e-2, dilation = false } },
    { "continuously_yielding", { an = KN, as = KN, phi_i = 50, phi = 30, roughness = 0.01 } },
    { "continuously_yielding", { an = KN, as = KN, phi_i = 50, phi = 30, roughness = 0.01, dilation = false } },
    { "rate_state", { kn = KN, ks = KN, a = 0.01, b = 0.015, distance = 1e-4, mu0 = 0.7 } },
}

local function build(law, seed)
    local random = shapes.random(seed)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { -20, -20, -3 }, max = { 20, 20, 0 }, density = DENSITY })
    local turn = shapes.turn(shapes.direction(random), random(-0.6, 0.6))
    local box = shapes.placed(shapes.box(random(0.3, 1.3), random(0.3, 1.3), random(0.5, 2.5)), turn)
    local up = shapes.farthest(box, { 0, 0, -1 }) + (seed % 3 == 0 and 0 or random(0, 0.3))
    model:generate("polyhedron", { vertices = shapes.placed(box, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
        { 0, 0, up }), density = DENSITY })
    model:blocks { id = 1 }:fix()
    model:joint("*", law[1], law[2])
    model:timestep { fraction = FRACTION }
    return model, model:blocks { id = 2 }[1]
end

for k, law in ipairs(LAWS) do
    local model, block = build(law, k)
    local what = ("%s, model %d: "):format(law[1], k)
    local heat, all = 0, block.mass * GRAVITY * block.centroid[3]
    for _ = 1, 20 do
        model:solve { ratio = 0, max_time = 0.05 }
        local energy = model:energy()
        check.holds(math.abs(energy.balance) < BALANCE, ("%sbalance %.1e"):format(what, energy.balance))
        check.holds(energy.friction >= heat - NO_HEAT * all, ("%sheat falls by %.1e J"):format(what, heat - energy.friction))
        heat = energy.friction
    end
    model:damping "local"
    model:timestep { fraction = 0.5 }
    check.equal(model:solve { ratio = 1e-6, max_cycles = 60000 }.reason, "ratio")
    local weight, contact = block.mass * GRAVITY, model:contacts()[1]
    local closure = weight / (KN * contact.area)
    check.near(contact.normal_force / weight, 1, 1e-4)
    local low = 0
    for _, v in ipairs(block.vertices) do
        low = math.min(low, v[3])
    end
    check.holds(#contact.points > 1 and -low < 4 * closure, ("%slies %.1e m deep, not %.1e"):format(what, -low, closure))
end

-- Two boxes that law elastic holds swing on each other for a second: 2e-3 were gained where their points were laid anew all the time.
local swing = landing.run({ law = "elastic", params = { kn = KN, ks = KN } }, 13053, KN, 0.1)
check.holds(swing.balance < BALANCE, ("elastic, two boxes: balance %.1e"):format(swing.balance))
