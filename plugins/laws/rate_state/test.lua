-- Law rate_state: rest and aging, opening, steps of any length, a block on a slope that creeps, and what it refuses.
-- Steady slip, steps of the velocity and stick-slip: tests/verify/law_rate_state.lua.
local talus = require "talus"
local check = require "check"

local SN, MU0, A, B, DC, V0, KS = 1e7, 0.6, 0.01, 0.015, 1e-5, 1e-6, 1e13
local params, refused = require "law_tests".of("rate_state", {
    kn = 1e11, ks = KS, mu0 = MU0, a = A, b = B, dc = DC, v0 = V0
})

-- A rest after steady slip: the surface ages by its length, and the friction of the next slip begins higher by b ln of it.
local REST = 1e4
for _, evolution in ipairs { "aging", "slip" } do
    local curve = talus.law_test { law = "rate_state", params = params { evolution = evolution }, normal_stress = SN, speed = V0,
        path = { { shear = 40 * DC, steps = 4000 }, { time = REST, steps = 100 }, { shear = 50 * DC, steps = 4000 } } }
    local slid, rested, again = table.unpack(curve.ends)
    check.near(curve.states.theta[slid], DC / V0, 1e-6 * DC / V0)
    check.near(curve.states.slip_rate[slid], V0, 1e-6 * V0)
    if evolution == "aging" then
        check.near(curve.states.theta[rested] / REST, 1, 0.05)
    end
    check.holds(curve.states.slip_rate[rested] < 1e-2 * V0, "it hardly slips")
    local peak = 0
    for i = rested, again do
        peak = math.max(peak, curve.shear_stress[i] / SN)
    end
    if evolution == "aging" then
        local old = curve.states.theta[rested]
        check.holds(peak < MU0 + B * math.log(V0 * old / DC), "no more than the age gives")
        check.holds(peak > MU0 + 0.5 * B * math.log(V0 * old / DC), "the rest strengthens")
    else
        check.near(peak, MU0, 0.2 * B) -- only slip changes this state
    end
    local n = #curve.time
    check.near(curve.work[n], curve.stored[n] + curve.heat[n], 1e-9 * curve.work[n])
    for i = 2, n do
        check.holds(curve.heat[i] >= curve.heat[i - 1], "heat grows")
    end
end

-- Slip of a thousand D_c in a step is steady slip, and so is one of a thousandth.
for _, steps in ipairs { 2, 50, 20000 } do
    local curve = talus.law_test { law = "rate_state", params = params(), normal_stress = SN, speed = 1e-3,
        path = { 200 * DC, 2000 * DC }, steps = steps, every = steps }
    check.near(curve.shear_stress[3] / SN, MU0 + (A - B) * math.log(1e-3 / V0), 1e-6)
end

-- The viscous part, and the state of a new contact.
local viscous = talus.law_test { law = "rate_state", params = params { damping = 1e8 }, normal_stress = SN, speed = 1e-3,
    path = { 200 * DC }, steps = 20000 }
local n = #viscous.time
check.near(viscous.shear_stress[n], SN * (MU0 + (A - B) * math.log(1e-3 / V0)) + 1e8 * 1e-3, 1e-6 * SN)
local old = talus.law_test { law = "rate_state", params = params { theta = 1e6 }, normal_stress = SN, path = { { time = 5, steps = 1 } } }
check.near(old.states.theta[2], 1e6 + 5, 1e-3)

-- An open point carries nothing and slips no further.
local opened = talus.law_test { law = "rate_state", params = params(), path = { { closure = 1e-4 }, { shear = 40 * DC },
    { closure = -1e-5 }, { shear = 0 } } }
n = #opened.time
check.equal(opened.shear_stress[n] == 0 and opened.normal_stress[n] == 0 and opened.open[n], true)
check.equal(opened.states.slip_rate[n], 0.0)

-- Refusals.
refused("a = 0 is outside (0, 1]", { a = 0 })
refused("b = 2 is outside [0, 1]", { b = 2 })
refused("distance = -1 m must be > 0", { dc = -1 })
refused("unknown evolution 'ageing'; did you mean 'aging'?", { evolution = "ageing" })

-- In a model: a block on a slope of which the tangent is above the friction slides; its friction is the steady one.
local G, SLOPE = 10, math.atan(0.7)
local model = talus.model { gravity = { G * math.sin(SLOPE), 0, -G * math.cos(SLOPE) } }
model:generate("box", { min = { 0, 0, 0 }, max = { 20, 4, 1 }, density = 2500 })
model:generate("box", { min = { 1, 1, 1 }, max = { 3, 3, 2 }, density = 2500 })
model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }:fix()
model:joint("*", "rate_state", { kn = 1e9, ks = 1e9, mu0 = 0.6, a = 0.02, b = 0.015, dc = 1e-4 })
local block = model:blocks { fixed = false }
-- it settles first, held along the slope
block:fix { x = true }
model:damping "local"
model:solve { ratio = 1e-6 }
model:damping "none"
block:free()
block:set { velocity = { 0.5, 0, 0 } }
model:solve { ratio = 0, max_time = 0.5 }
-- undamped, it rocks: the friction is that of the forces
local along, normal, speed = 0, 0, 0
for _ = 1, 500 do
    model:cycle(1)
    along = along - model:contacts():sum "shear_force"[1]
    normal = normal + model:contacts():sum "normal_force"
    speed = speed + block[1].velocity[1] / 500
end
check.near(along / normal, 0.6 + 0.005 * math.log(speed / 1e-6), 0.004)
check.near(model:energy().balance, 0, 2e-3)
