-- Law barton_bandis: unloading, dilation under constant stiffness, in situ stress, a block on a rough joint, and what it refuses.
-- Closure and strength against published formulas: tests/verify/law_barton_bandis.lua.
local talus = require "talus"
local check = require "check"

local KNI, VM, KS, JRC, JCS, PHI = 2e9, 5e-4, 2e10, 8, 5e7, 28
local params, refused = require "law_tests".of("barton_bandis", {
    jrc = JRC, jcs = JCS, phi_r = PHI, kni = KNI, vm = VM, ks = KS
})
local function closure(stress)
    return stress * VM / (KNI * VM + stress)
end
local function peak_strength(stress)
    return stress * math.tan(math.rad(PHI + JRC * math.log(JCS / stress, 10)))
end
local U_PEAK = 0.1 / 500 * (JRC / 0.1) ^ 0.33

-- Closing and opening is elastic, also beyond the stress from which it is linear.
local LINEAR = 2e6
local pressed = talus.law_test { law = "barton_bandis", params = params { linear_from = LINEAR }, normal_stress = 1e5, steps = 500,
    path = { { normal_stress = 2 * LINEAR }, { normal_stress = 1e5 } } }
local e = pressed.ends
check.near(pressed.closure[e[1]], closure(LINEAR) + LINEAR / (KNI * (1 + LINEAR / (KNI * VM)) ^ 2), 1e-9 * VM)
check.near(pressed.closure[e[2]], closure(1e5), 1e-9 * VM)
check.near(pressed.stored[e[2]], pressed.stored[1], 1e-9 * pressed.stored[1])
check.near(pressed.work[e[2]], pressed.work[1], 1e-4 * pressed.stored[e[1]])
check.equal(pressed.heat[e[2]], 0.0)

-- Sheared under constant normal stress: the peak, the residual strength, dilation, energies.
local SN = 1e6
local sheared = talus.law_test { law = "barton_bandis", params = params(), normal_stress = SN, steps = 2000,
    path = { U_PEAK, 120 * U_PEAK, 119 * U_PEAK } }
e = sheared.ends
check.near(sheared.shear_stress[e[1]], peak_strength(SN), 1e-9 * SN)
check.near(sheared.shear_stress[e[2]], SN * math.tan(math.rad(PHI)), 1e-9 * SN)
check.holds(sheared.dilation[e[2]] > 0.5 * sheared.dilation[e[1]], "the joint has opened")
check.near(sheared.dilation[e[2]], sheared.states.opening[e[2]], 1e-9 * sheared.dilation[e[2]])
for i = 2, #sheared.time do
    check.holds(sheared.heat[i] >= sheared.heat[i - 1], "heat grows")
end
-- In each step the walls part first and slip presses them together again, which costs kn lift^2 / 2 in the books.
local STEPS = 1e-3
check.near(sheared.work[e[3]], sheared.stored[e[3]] + sheared.heat[e[3]], STEPS * sheared.heat[e[3]])

-- In surroundings of constant stiffness dilation raises the stress; with dilation = false it does not.
for _, dilates in ipairs { true, false } do
    local held = talus.law_test { law = "barton_bandis", params = params { dilation = dilates }, normal_stress = SN, stiffness = 1e9,
        path = { 4 * U_PEAK }, steps = 2000 }
    local n = #held.time
    check.near(held.normal_stress[n], SN + 1e9 * held.dilation[n], 1e-9 * SN)
    if dilates then
        check.holds(held.normal_stress[n] > 1.05 * SN, "the stress rises")
    else
        check.near(held.normal_stress[n], SN, 1e-9 * SN)
    end
    check.near(held.work[n], held.stored[n] + held.heat[n], STEPS * held.heat[n])
end

-- The strength over `reduction`.
local weaker = talus.law_test { law = "barton_bandis", params = params { reduction = 1.5 }, normal_stress = SN, path = { U_PEAK } }
check.near(weaker.shear_stress[#weaker.time], peak_strength(SN) / 1.5, 1e-9 * SN)

-- Walls that part while slip lifts them stay together, in steps of any length.
local coarse = talus.law_test { law = "barton_bandis", params = params(), normal_stress = SN, path = { 10 * U_PEAK }, steps = 10 }
check.near(coarse.normal_stress[11], SN, 1e-9 * SN)
check.holds(coarse.dilation[11] > 0, "it opens")

-- Any way of shear and closing makes no energy: what is off is the rule of trapezoids on a curved spring.
for seed = 1, 20 do
    math.randomseed(seed)
    local path = {}
    for k = 1, 12 do
        path[k] = { shear = (math.random() - 0.5) * 4 * U_PEAK, closure = (math.random() - 0.2) * 0.8 * VM, steps = 1000 }
    end
    path[13] = { shear = 0, closure = 0 }
    local way = talus.law_test { law = "barton_bandis", params = params(), path = path }
    local n = #way.time
    check.near(way.work[n] - way.stored[n] - way.heat[n], 0, 2e-3 * way.heat[n])
    check.holds(way.work[n] > 0, "work goes in")
end

-- Refusals.
refused("phi_r = 70 deg is outside [0, 70)", { phi_r = 70 })
refused("jrc = 31 is outside [0, 30]", { jrc = 31 })
refused("jcs = 0 Pa must be > 0", { jcs = 0 })
refused("linear_from = 1e+50 Pa is too much for kni vm = 1e+06 Pa", { linear_from = 1e50 })

-- In a model: a block comes to rest on a rough joint at the closure of its weight, also from an in situ stress, and the energy
-- balances.
local function rest(insitu)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 2, 2, 0 }, density = 2500 })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 4 }, density = 2500 })
    model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 0 } } }:fix()
    model:joint("*", "barton_bandis", params { linear_from = 1e6 })
    if insitu then
        model:insitu { stress = { zz = -insitu } }
    end
    model:damping "local"
    model:solve { ratio = 1e-9 }
    local block = model:blocks { fixed = false }[1]
    return -block.displacement[3], model:contacts():sum "normal_force", model:energy().balance
end
local WEIGHT = 2500 * 4 * 10
local sunk, force, balance = rest()
check.near(force, WEIGHT, 1e-6 * WEIGHT)
check.near(sunk, closure(WEIGHT), 1e-5 * VM)
check.near(balance, 0, 2e-3)
sunk, force = rest(WEIGHT / 2)
check.near(force, WEIGHT, 1e-6 * WEIGHT)
check.near(sunk, closure(WEIGHT) - closure(WEIGHT / 2), 1e-5 * VM)
