-- Law slip_weakening: healing, cohesion, opening and what it refuses. Strengths and energies: tests/verify/law_slip_weakening.lua.
local talus = require "talus"
local check = require "check"

local SN, DC, MU, MU_R = 1e6, 1e-3, math.tan(math.rad(35)), math.tan(math.rad(25))
local params, refused = require "law_tests".of("slip_weakening", {
    kn = 1e10, ks = 1e10, friction = 35, residual_friction = 25, distance = DC
})
local function test(more, path, steps)
    return talus.law_test { law = "slip_weakening", params = params(more), normal_stress = SN, path = path, steps = steps }
end
-- Shear stress and slip at the end of each leg.
local function at_ends(curve)
    local stress, slip = {}, {}
    for k, i in ipairs(curve.ends) do
        stress[k], slip[k] = curve.shear_stress[i], curve.states.slip[i]
    end
    return stress, slip
end

-- Without healing: a rest, and a way back, change nothing; slip counts to and fro.
local far = 3 * DC
local stress, slip = at_ends(test({}, { far, { time = 1e5 }, { shear = 0 } }))
check.near(stress, { SN * MU_R, SN * MU_R, -SN * MU_R }, 1e-9 * SN)
check.near(slip[1], far - SN * MU_R / 1e10, 1e-12)
check.near(slip[2], slip[1], 0)
check.near(slip[3], slip[1] + far - 2 * SN * MU_R / 1e10, 1e-12)

-- At once: a point that has stopped has its peak strength again.
stress, slip = at_ends(test({ healing = "instant" }, { far, { time = 1, steps = 1 }, { shear = far + DC / 10, steps = 1000 } }))
check.near(slip[1], DC, 1e-12) -- no more than counts
check.equal(slip[2], 0.0)
check.near(stress[3], SN * (MU - (MU - MU_R) * slip[3] / DC), 1e-9 * SN)
check.holds(slip[3] < DC / 10 and slip[3] > 0, "it slips again")

-- In time: what was lost shrinks by exp(-t / healing_time), in any number of steps, and is gone in the end.
for _, steps in ipairs { 1, 37 } do
    for _, form in ipairs { "linear", "exponential" } do
        local heals = test({ healing = "time", healing_time = 100, form = form },
            { far, { time = 70, steps = steps }, { time = 1e4, steps = steps } })
        stress, slip = at_ends(heals)
        check.near(slip[2], slip[1] * math.exp(-0.7), 1e-12 * DC)
        check.equal(slip[3], 0.0)
    end
end

-- Cohesion falls with friction, and an open point keeps its slip and carries nothing.
local opened = talus.law_test { law = "slip_weakening", params = params { cohesion = 2e5, residual_cohesion = 1e5 },
    path = { { closure = 1e-4 }, { shear = far }, { closure = -1e-4 }, { shear = 0 }, { closure = 1e-4 }, { shear = far } } }
stress, slip = at_ends(opened)
check.near(stress, { 0, 1e5 + SN * MU_R, 0, 0, 0, 1e5 + SN * MU_R }, 1e-9 * SN)
check.equal(opened.open[opened.ends[3]], true)
check.near(slip[5], slip[3], 0)
for i = 1, #opened.time do
    check.holds(opened.heat[i] >= 0, "slip makes heat")
end

-- A spring softer than the weakening falls to the residual strength within a step, and gives off no more than it had.
local soft = talus.law_test { law = "slip_weakening", params = params { ks = 1e8 }, normal_stress = SN, path = { 0.02 } }
local fell = false
for i = 2, #soft.time do
    fell = fell or soft.shear_stress[i - 1] - soft.shear_stress[i] > 0.9 * SN * (MU - MU_R)
    check.near(soft.work[i] - soft.stored[i] - soft.heat[i], 0, 1e-9 * soft.work[i])
    check.holds(soft.heat[i] >= soft.heat[i - 1], "heat grows")
end
check.holds(fell, "the stress falls at once")

-- Refusals.
refused("residual_friction = 40 deg must be <= friction = 35 deg", { residual_friction = 40 })
refused("residual_cohesion = 1 Pa must be <= cohesion = 0 Pa", { residual_cohesion = 1 })
refused("healing = \"time\" needs healing_time, in s", { healing = "time" })
refused("healing_time is given, but healing is \"none\"", { healing_time = 5 })
refused("distance = 0 m must be > 0", { distance = 0 })
refused("unknown form 'linea'; did you mean 'linear'?", { form = "linea" })

-- In a model: a block slides down a slope between the two angles once it has been pushed.
local G, SLOPE = 10, math.rad(30)
local function slides(push)
    local model = talus.model { gravity = { G * math.sin(SLOPE), 0, -G * math.cos(SLOPE) } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 20, 4, 1 }, density = 2500 })
    model:generate("box", { min = { 1, 1, 1 }, max = { 3, 3, 2 }, density = 2500 })
    model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }:fix()
    local block = model:blocks { fixed = false }
    model:joint("*", "slip_weakening", { kn = 1e9, ks = 1e9, friction = 35, residual_friction = 25, distance = 0.01 })
    model:damping "local"
    model:solve {}
    model:damping "none"
    block:set { velocity = { push, 0, 0 } }
    model:solve { ratio = 0, max_time = 1.5 }
    return block[1].velocity[1], model:energy().balance
end
local still = slides(0.02)
check.near(still, 0, 0.02) -- it trembles on its springs
local V0, LENGTH, TIME = 0.5, 0.01, 1.5
local fast, balance = slides(V0)
-- While it weakens, the friction is the mean of the two on the way D_c; what the springs hold is small.
local function gain(mu)
    return G * (math.sin(SLOPE) - math.cos(SLOPE) * mu)
end
local weak = math.sqrt(V0 ^ 2 + 2 * LENGTH * gain((MU + MU_R) / 2))
local expected = weak + gain(MU_R) * (TIME - 2 * LENGTH / (V0 + weak))
check.near(fast / expected, 1, 5e-3)
check.near(balance, 0, 1e-3)
