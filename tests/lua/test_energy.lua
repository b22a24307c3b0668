-- The energy ledger closes in every kind of motion, and its terms are what they are said to be.
local talus = require "talus"
local check = require "check"

local G, K, DENSITY = 10, 1e8, 2000
-- Of the largest term: what the scheme is asked for where omega dt <= 0.03.
local BALANCE = 1e-3
-- The normal of a contact halves the angle between two faces, so sliding at a tilt of the block by t misplaces
-- t / 2 of the pressure's work. Where a horizontal force tilts the block on its joint the joint is stiff.
local STIFF = 1e9

local function block_on_floor(law, height, tilt, stiffness)
    local k = stiffness or K
    local dip = math.rad(tilt or 0)
    local model = talus.model { gravity = { G * math.sin(dip), 0, -G * math.cos(dip) } }
    model:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = DENSITY, group = "floor" })
    model:generate("box", { min = { 0, 0, height }, max = { 1, 1, height + 1 }, density = DENSITY,
        group = "block" })
    model:blocks { group = "floor" }:fix()
    law.kn, law.ks = k, k
    model:joint("*", "coulomb", law)
    model:timestep { dt = 0.03 / math.sqrt(k / DENSITY) } -- omega dt of a cube of 1 m on the joint
    return model, model:blocks { group = "block" }
end

-- Runs and keeps an eye on the balance every ten steps; gives the largest.
local function watch(model, cycles)
    local worst = 0
    for _ = 1, cycles // 10 do
        model:cycle(10)
        worst = math.max(worst, math.abs(model:energy().balance))
    end
    return worst
end

-- Nothing before the first step.
local model, block = block_on_floor({}, 0.01)
for _, value in pairs(model:energy()) do
    check.equal(value, 0)
end
check.refused(model, function() model:energy(1) end, "1 argument too many")

-- A bouncing block: fall, press, rebound; the sum of three terms stays.
check.holds(watch(model, 3000) < BALANCE, "the balance of a bounce")
local energy = model:energy()
check.near(energy.friction, 0, 1e-9)
check.near(energy.damping, 0, 0)
check.near(energy.external, 0, 0)
check.near(energy.kinetic + energy.potential + energy.stored, 0, BALANCE * 200)

-- A sliding block: friction takes what gravity gives beyond the gain of speed, mu m g cos(dip) a metre.
local dip, phi = 30, 20
model, block = block_on_floor({ friction = phi }, 0, dip)
check.holds(watch(model, 4000) < BALANCE, "the balance of sliding")
energy = model:energy()
local travel = block[1].displacement[1]
check.holds(travel > 0.05, "it slides")
local press = DENSITY * G * math.cos(math.rad(dip))
-- Tolerance: the first press swings about its mean.
check.near(energy.friction / (press * math.tan(math.rad(phi)) * travel), 1, 0.02)

-- With dilation slip lifts the block, against the pressure, until its limit; the ledger still closes.
local LIMIT, DILATION = 0.008, 5
model, block = block_on_floor({ friction = phi, dilation = DILATION, dilation_limit = LIMIT }, 0, dip)
model:damping("viscous", { alpha = 60 })
check.holds(watch(model, 8000) < BALANCE, "the balance of a dilating slide")
check.holds(block[1].displacement[1] > 2 * LIMIT, "it slides beyond the limit")
-- It stands on its opened joint, pressed in by its weight. Tolerance: it still swings a little.
check.near(block[1].displacement[3], LIMIT * math.tan(math.rad(DILATION)) - press / K, 1e-5)
check.refused(model, function() model:joint("*", { dilation = 30 }) end, "must be <= friction = 20 deg")

-- An oscillation under each damping: what is missing was taken out by it.
for _, damping in ipairs { { "none" }, { "viscous", { alpha = 20 } }, { "local", { alpha = 0.3 } },
    { "adaptive" }, { "combined", { alpha = 0.3 } }, { "kinetic" } } do
    model, block = block_on_floor({}, -1e-3)
    model:damping(damping[1], damping[2])
    check.holds(watch(model, 1000) < BALANCE, "the balance with damping " .. damping[1])
    energy = model:energy()
    check.holds(damping[1] == "none" and energy.damping == 0 or energy.damping > 0.01, damping[1])
end

-- Small motions of a column whose joints hold, from velocities that are set: dampers of masses, joints and springs book all that they
-- take, from the first step on, which is half a kick.
for name, damp in pairs {
    masses = function(m) m:damping("viscous", { alpha = 200 }) end,
    both = function(m) m:damping("rayleigh", { ratio = 0.5, from = 5, to = 100 }) end,
    joints = function(m) m:damping("dashpot", { ratio = 0.4, frequency = 100 }) end,
    springs = function(m)
        m:element("spring", { from = { 0.2, 0.2, 1.5 }, to = { 5, 3, 2 }, stiffness = 1e7, damping = 1e5 })
    end,
} do
    model = talus.model { gravity = { 0, 0, 0 } }
    for k = 0, 2 do
        model:generate("box", { min = { 0, 0, k }, max = { 1 - 0.2 * k, 0.8, k + 1 }, density = DENSITY })
    end
    model:joint("*", "elastic", { kn = 1e9, ks = 5e8 })
    model:blocks { id = 1 }:fix()
    damp(model)
    model:blocks { id = 3 }:set { velocity = { 1e-5, -2e-5, 1e-5 }, angular_velocity = { 2e-5, 1e-5, -1e-5 } }
    -- Tolerance: points of the joints move with their walls by 1e-6 of a block.
    check.holds(watch(model, 300) < 1e-6, "the balance of small motions damped at " .. name)
end

-- What damping takes out of bodies whose inertia is scaled is all there was, once they rest.
for _, damping in ipairs { { "viscous", { alpha = 100 } }, { "local" }, { "kinetic" } } do
    model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = DENSITY })
    model:blocks():fix()
    for i = 0, 2 do -- the lower, the smaller, and so the more their inertia is scaled
        model:generate("box", { min = { 0, 0, i * (i + 1) / 2 }, max = { 1, 1, (i + 1) * (i + 2) / 2 },
            density = DENSITY })
    end
    model:joint("*", "coulomb", { kn = K, ks = K, friction = 30 })
    model:mass_scaling(true)
    model:damping(damping[1], damping[2])
    check.equal(model:solve { ratio = 1e-7 }.reason, "ratio")
    check.holds(math.abs(model:energy().balance) < BALANCE, "the balance of scaled inertia, damping " .. damping[1])
end

-- Loads and drives do the external work.
model, block = block_on_floor({ friction = 30 }, 0, 0, STIFF)
block:load { force = { 1.5e4, 0, 0 } } -- slides, and does not tip
check.holds(watch(model, 6000) < BALANCE, "the balance of a pushed block")
check.near(model:energy().external, 1.5e4 * block[1].displacement[1], 1e-3 * model:energy().external)
model, block = block_on_floor({ friction = 10 }, 0, 0, STIFF)
model:blocks { group = "floor" }:drive { velocity = function(t) return 0.1 * math.sin(40 * t), 0, 0 end }
check.holds(watch(model, 6000) < BALANCE, "the balance of a shaken block")
check.holds(model:energy().friction > 10 and model:energy().external > 10, "work becomes heat")

-- A spinning top in free space: all is kinetic.
model = talus.model { gravity = { 0, 0, 0 } }
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 2, 3 }, density = DENSITY })
model:joint("*", "coulomb", { kn = K, ks = K })
model:blocks():set { angular_velocity = { 0.1, 3, 0.1 } }
model:timestep { dt = 0.01 }
check.holds(watch(model, 2000) < BALANCE, "the balance of a top")

-- A block deleted under load takes the energy of its contacts with it, and so does a softer law: external work.
model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = DENSITY, group = "floor" })
for i = 0, 2 do
    model:generate("box", { min = { 0, 0, i }, max = { 1, 1, i + 1 }, density = DENSITY, group = "block " .. i })
end
model:blocks { group = "floor" }:fix()
model:joint("*", "coulomb", { kn = K, ks = K, friction = 30 })
model:damping "local"
model:timestep { fraction = 0.05 }
model:cycle(4000)
local stored = model:energy().stored
model:blocks { group = "block 2" }:delete()
check.holds(watch(model, 4000) < BALANCE, "the balance after a block is deleted")
check.holds(model:energy().stored < 0.5 * stored and model:energy().external < -0.05 * stored, "taken out")
model:joint("*", { kn = K / 2 })
check.holds(watch(model, 2000) < BALANCE, "the balance after a change of stiffness")
