-- Friction of rate and state: steady slip, a step of the velocity, and a spring slider that is stable or sticks and slips.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_laws"

local STEADY = 1e-6 -- of the coefficient, as in the reference
local STEP = 1e-4   -- relative, as in the reference
local PERIOD = 0.05 -- relative, as in the reference

local case = reference["LAW.rate_state"]
local given, expected = case.inputs, case.expected
local SN = given.sn
local STIFF = 1e14 -- Pa/m: the spring stretches by 1e-4 of D_c while the rate changes e-fold

local function parameters(more)
    local p = { kn = 1e11, ks = STIFF, mu0 = given.mu0, a = given.a, b = given.b, dc = given.Dc, v0 = given.V0 }
    for key, value in pairs(more or {}) do
        p[key] = value
    end
    return p
end

figures.case("LAW.rate_state", "One point is slid at a given velocity through a stiff spring: steady friction, and a step of the "
    .. "velocity. Through a soft spring it slides steadily or sticks and slips.", case.source)

-- ---------------------------------------------------------------- steady slip

for _, velocity in ipairs { 1e-9, 1e-6, 1e-3 } do
    for _, evolution in ipairs { "aging", "slip" } do
        local curve = talus.law_test { law = "rate_state", params = parameters { evolution = evolution }, normal_stress = SN,
            speed = velocity, path = { 40 * given.Dc }, steps = 20000, every = 20000 }
        figures.near(string.format("%s: steady coefficient at %g m/s", evolution, velocity), curve.shear_stress[2] / SN,
            expected.steady_mu[velocity], STEADY)
    end
end

-- ---------------------------------------------------------------- a step of the velocity

local before, slips = 40 * given.Dc, {}
for slip in pairs(expected.step_1e6_to_1e5) do
    slips[#slips + 1] = slip
end
table.sort(slips)
local path = { { shear = before, speed = 1e-6, steps = 4000 } }
for _, slip in ipairs(slips) do
    -- the spring must be stretched first: the first point comes when the rate has changed
    path[#path + 1] = { shear = before + math.max(slip, 2e-4 * given.Dc), speed = 1e-5, steps = 4000 }
end
local step = talus.law_test { law = "rate_state", params = parameters { ks = 1e16 }, normal_stress = SN, path = path }
for i, slip in ipairs(slips) do
    figures.relative(string.format("coefficient %g um after the step", 1e6 * slip), step.shear_stress[step.ends[i + 1]] / SN,
        expected.step_1e6_to_1e5[slip], STEP)
end

-- ---------------------------------------------------------------- spring slider

-- The joint's own spring is that of the slider. It is stretched at once, to where it slides slowly; then it is drawn until
-- `time`, by steps of 0.05 s, or of FINE s from BEFORE s before to AFTER s after the given times.
local DAMPING = 5e6 -- Pa s/m
local COARSE, FINE, BEFORE, AFTER = 0.05, 1e-4, 3, 0.5
local function slide(ratio, time, fine_at, every)
    local k = ratio * expected.k_critical
    local start = given.mu0 * SN / k
    local legs, now = { { shear = start, time = 1, steps = 1000 } }, 0
    local function to(at, dt)
        if at > now then
            legs[#legs + 1] = { shear = start + 1e-6 * at, time = at - now, steps = math.ceil((at - now) / dt) }
            now = at
        end
    end
    for _, at in ipairs(fine_at) do
        to(at - BEFORE, COARSE)
        to(at + AFTER, FINE)
    end
    to(time, COARSE)
    return talus.law_test { law = "rate_state", normal_stress = SN, path = legs, every = every or 20,
        params = parameters { ks = k, damping = DAMPING } }
end

local steady = slide(1.5, 2000, {})
figures.relative("rate of slip in the end at k = 1.5 k_c, m/s", steady.states.slip_rate[#steady.time],
    expected.final_V_at_1_5_kc, 1e-3)

-- The next time after `from` at which the stress has fallen by a good part of its range.
local function next_slip(curve, from)
    local most = 0
    for i = 1, #curve.time do
        if curve.time[i] > from then
            most = math.max(most, curve.shear_stress[i])
            if curve.shear_stress[i] < most - expected.stress_range_at_0_5_kc / 3 then
                return curve.time[i]
            end
        end
    end
end
-- The times come from coarse steps, one after the other.
local EVENTS, FIRST, GAP = 5, 2, 100
local times, jerky = {}, slide(0.5, 600, {})
for k = 1, EVENTS do
    local from = k > 1 and times[k - 1] + GAP or 0
    -- the clock of the curve is 1 s ahead
    times[k] = assert(next_slip(jerky, from), "it slips again") - 1
    jerky = slide(0.5, times[k] + 600, times)
    times[k] = next_slip(jerky, from) - 1
end
jerky = slide(0.5, times[EVENTS] + 1, times, 2)
-- Range of the friction, without the viscous part.
local low, high = math.huge, 0
for i = 1, #jerky.time do
    local friction = jerky.shear_stress[i] - DAMPING * jerky.states.slip_rate[i]
    if jerky.time[i] > times[FIRST] then
        low, high = math.min(low, friction), math.max(high, friction)
    end
end
figures.relative("period at k = 0.5 k_c, s", (times[EVENTS] - times[FIRST]) / (EVENTS - FIRST),
    expected.stick_slip_period_at_0_5_kc, PERIOD)
figures.relative("range of the shear stress, Pa", high - low, expected.stress_range_at_0_5_kc, PERIOD)
local n = #jerky.time
figures.relative("work, J/m2", jerky.work[n], jerky.stored[n] + jerky.heat[n], 1e-6)
local x, y = {}, {}
for i = 1, n, 100 do
    x[#x + 1], y[#y + 1] = jerky.time[i], jerky.shear_stress[i]
end
figures.plot { title = "LAW.rate_state: stick and slip at k = 0.5 k_c", x = "time, s", y = "shear stress, Pa",
    series = { { name = "shear stress", x = x, y = y } } }
figures.finish()
