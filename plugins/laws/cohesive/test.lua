-- Law cohesive: unloading, friction under pressure, walls that were never bonded, a joint of a model, and what it refuses.
-- Energies and modes: tests/verify/law_cohesive.lua.
local talus = require "talus"
local check = require "check"

local KN, KS, T, C, GI, GII, PHI = 4e10, 1.6e10, 0.25e6, 0.35e6, 18, 125, 35
local MU = math.tan(math.rad(PHI))
local params, refused = require "law_tests".of("cohesive", {
    kn = KN, ks = KS, tension = T, cohesion = C, gi = GI, gii = GII, friction = PHI
})
local function test(more)
    more.law, more.params = "cohesive", more.params or params()
    return talus.law_test(more)
end
-- Work is stored or heat, step by step; the heat only grows. The mean force of a step is exact but where s changes its sign.
local function balanced(curve, share)
    for i = 2, #curve.time do
        check.near(curve.work[i] - curve.stored[i] - curve.heat[i], 0, share * (curve.heat[i] + curve.stored[i] + 1))
        check.holds(curve.heat[i] >= curve.heat[i - 1], "heat grows")
    end
end

-- Half opened, closed and opened again: by (1 - D) kn to the origin and back, kn in compression.
local FAR = 2 * GI / T
local opened = test { path = { { closure = -FAR / 2 }, { closure = -FAR / 4 }, { closure = 1e-5 }, { closure = -FAR / 2 },
    { closure = -FAR } } }
local e = opened.ends
local damage = opened.states.damage[e[1]]
check.near(opened.normal_stress[e[1]], -T * (FAR - FAR / 2) / (FAR - T / KN), 1e-6 * T)
check.near(opened.normal_stress[e[2]], opened.normal_stress[e[1]] / 2, 1e-9 * T)
check.near(opened.normal_stress[e[3]], KN * 1e-5, 1e-6)
check.near(opened.normal_stress[e[4]], opened.normal_stress[e[1]], 1e-9 * T)
check.near(opened.states.damage[e[4]], damage, 1e-9)
check.near(opened.heat[e[3]], opened.heat[e[1]], 0)
check.near(opened.heat[e[5]], GI, 1e-3 * GI)
check.near(opened.normal_stress[e[5]], 0, 0)
check.equal(opened.failed[e[5]] and opened.open[e[5]], true)

-- Sheared under pressure: c first, friction of the broken share as it breaks, all of it in the end, and on the way back.
local SN, SLIDE = 4e5, 2 * GII / C
local pressed = test { normal_stress = SN, steps = 3000, path = { C / KS, SLIDE * 0.6, SLIDE * 1.5, -SLIDE } }
e = pressed.ends
check.near(pressed.shear_stress[e[1]], C, 1e-9 * C)
damage = pressed.states.damage[e[2]]
check.holds(damage > 0.1 and damage < 0.99, "half broken")
check.near(pressed.shear_stress[e[2]], (1 - damage) * KS * SLIDE * 0.6 + damage * SN * MU, 1e-6 * C)
check.near(pressed.shear_stress[e[3]], SN * MU, 1e-9 * C)
check.near(pressed.shear_stress[e[4]], -SN * MU, 1e-9 * C)
check.equal(pressed.failed[e[3]] and pressed.slipping[e[3]], true)
balanced(pressed, 1e-9)

-- Any way of shear and closing makes no energy.
for seed = 1, 20 do
    math.randomseed(seed)
    local path = {}
    for k = 1, 12 do
        path[k] = { shear = (math.random() - 0.5) * SLIDE, closure = (math.random() - 0.5) * FAR, steps = 500 }
    end
    path[13] = { shear = 0, closure = 0 }
    balanced(test { path = path }, 2e-3)
end

-- Refusals.
refused("energy_tension = 0.5 J/m2 must be > tension^2 / (2 k) = 0.78125 J/m2", { gi = 0.5 })
refused("energy_shear = 3 J/m2 must be > cohesion^2 / (2 k) = 3.82812 J/m2", { gii = 3 })
refused("tension = 0 Pa must be > 0", { tension = 0 })
refused("energy_tension and gi are the same parameter", { energy_tension = 5 })

-- In a model: a cube is pulled off a block on which it was made, and the heat is GI times its face. One that comes from above
-- does not stick.
local function pull(gap)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 2, 2, 0 }, density = 2000 })
    model:generate("box", { min = { 0, 0, gap }, max = { 1, 1, 1 + gap }, density = 2000 })
    model:blocks():fix()
    local upper = model:blocks { containing = { 0.5, 0.5, 0.5 + gap } }
    model:joint("*", "cohesive", params())
    model:timestep { dt = 1e-5 }
    local speed = 0
    upper:drive { velocity = function() return { 0, 0, speed } end }
    local function move(way)
        speed = way / 4000 / 1e-5
        model:cycle(4000)
        local contacts = model:contacts()
        return #contacts > 0 and contacts:sum "normal_force" or 0
    end
    if gap > 0 then
        move(-gap - 1e-6)
    end
    local half = move(FAR / 2)
    move(FAR)
    return half, model:energy()
end
local half, energy = pull(0)
check.near(half, -T * (FAR - FAR / 2) / (FAR - T / KN), 1e-3 * T)
check.near(energy.friction, GI, 1e-3 * GI)
check.near(energy.balance, 0, 1e-3)
half, energy = pull(5e-4)
check.near(half, 0, 0)
check.near(energy.friction, 0, 1e-12)
