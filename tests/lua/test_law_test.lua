-- talus.law_test: curves of the laws against closed forms, energies that balance, and calls that are refused.
local talus = require "talus"
local check = require "check"

local KN, KS, PHI, COHESION = 1e10, 2e9, 30, 1e5
local MU = math.tan(math.rad(PHI))
local params = { kn = KN, ks = KS, friction = PHI, cohesion = COHESION }

-- Energies of the curve balance, to a share of the work.
local function balanced(curve, share)
    for i = 1, #curve.time do
        check.near(curve.work[i] - curve.stored[i] - curve.heat[i], 0,
            share * (curve.stored[i] + curve.heat[i]))
    end
end

-- Direct shear under constant normal stress, to and fro: elastic, then at the strength.
local SN = 1e6
local PEAK = COHESION + SN * MU
local shear = talus.law_test { law = "coulomb", params = params, normal_stress = SN,
    path = { PEAK / KS, 0.002, -0.002 } }
check.equal(#shear.time, 601)
check.equal(#shear.ends, 3)
check.equal(shear.ends[3], 601)
local half, far, back = 101, shear.ends[2], shear.ends[3] -- half-way to the strength, which a step meets
check.near(shear.shear_stress[half], PEAK / 2, 1e-9 * PEAK)
check.equal(shear.slipping[half], false)
check.near(shear.shear_stress[far], PEAK, 1e-9 * PEAK)
check.equal(shear.slipping[far], true)
check.near(shear.shear[far], 0.002, 0)
check.near(shear.shear_stress[back], -PEAK, 1e-9 * PEAK)
for i = 1, 601 do
    check.near(shear.normal_stress[i], SN, 1e-9 * SN)
    check.near(shear.closure[i], SN / KN, 1e-9 * SN / KN)
    check.equal(shear.open[i], false)
end
check.near(shear.heat[far], PEAK * (0.002 - PEAK / KS), 1e-9 * PEAK * 0.002)
check.near(shear.time[far], 0.002 / 1e-5, 1e-6) -- at 1e-5 m/s
balanced(shear, 1e-9)

-- Constant normal stiffness: slip s opens the joint by s tan(dilation), less what the joint itself gives way.
local K, DILATION, SLIDE = 1e9, 10, 0.005
local held = talus.law_test { law = "coulomb", normal_stress = SN, stiffness = K, path = { SLIDE },
    params = { kn = KN, ks = KS, friction = PHI, dilation = DILATION } }
local n = #held.time
local opening = held.states.opening[n]
check.near(opening, math.tan(math.rad(DILATION)) * (SLIDE - held.shear_stress[n] / KS), 1e-9 * SLIDE)
check.near(held.normal_stress[n], SN + K * held.dilation[n], 1e-9 * SN)
check.near(held.normal_stress[n], SN + opening * K * KN / (K + KN), 1e-8 * SN)
check.near(held.shear_stress[n], held.normal_stress[n] * MU, 1e-9 * SN)
balanced(held, 1e-9)

-- Closure: in, out, beyond the tensile strength, and in again. Every tenth step is told, and the end of each leg.
local T = 1e5
local pulled = talus.law_test { law = "coulomb_tensile", steps = 105, every = 10,
    params = { kn = KN, ks = KS, friction = PHI, tension = T },
    path = { { closure = 1e-4 }, { closure = -0.99 * T / KN, steps = 7 }, { closure = -2 * T / KN },
        { closure = 1e-5 } } }
check.equal(#pulled.time, 1 + 11 + 1 + 11 + 11)
local in1, out1, out2, in2 = table.unpack(pulled.ends)
check.near(pulled.normal_stress[in1], KN * 1e-4, 1)
check.near(pulled.normal_stress[out1], -0.99 * T, 1e-6)
check.equal(pulled.failed[out1], false)
check.equal(pulled.failed[out2], true)
check.equal(pulled.open[out2], true)
check.equal(pulled.states.bond[out1], 1.0)
check.equal(pulled.states.bond[out2], 0.0)
check.near(pulled.normal_stress[in2], KN * 1e-5, 1e-3)
check.near(pulled.dilation[out2], 2 * T / KN, 1e-18)

-- A normal stress that changes while nothing is sheared; a leg that waits; a leg with a time and one with a speed.
local timed = talus.law_test { law = "coulomb", params = params, normal_stress = SN, steps = 3,
    path = { { normal_stress = 3 * SN }, { time = 50 }, { shear = 1e-3, time = 7 }, { shear = 0, speed = 1e-4 } } }
check.near(timed.normal_stress[timed.ends[1]], 3 * SN, 1e-9 * SN)
check.near(timed.normal_stress[timed.ends[4]], 3 * SN, 1e-9 * SN)
for i, wanted in ipairs { 1, 51, 58, 68 } do
    check.near(timed.time[timed.ends[i]], wanted, 1e-9)
end

-- The same call gives the same numbers.
local again = talus.law_test { law = "coulomb", params = params, normal_stress = SN,
    path = { PEAK / KS, 0.002, -0.002 } }
for i = 1, 601 do
    check.equal(again.shear_stress[i], shear.shear_stress[i])
    check.equal(again.heat[i], shear.heat[i])
end

-- Refusals. The joint that opens and the bond that breaks cannot hold what is asked of them.
local function refused(part, change)
    local test = { law = "coulomb", params = params, normal_stress = SN, path = { 0.001 } }
    for key, value in pairs(change) do
        test[key] = value ~= "none" and value or nil
    end
    check.raises(function() talus.law_test(test) end, part)
end
refused("law_test: parameter 'law' is missing", { law = "none" })
refused("unknown law 'coulom'; did you mean 'coulomb'?", { law = "coulom" })
refused("law_test, law 'coulomb': parameter 'kn' is missing, in Pa/m", { params = "none" })
refused("law_test, law 'coulomb': unknown parameter 'frction'; did you mean 'friction'?",
    { params = { kn = 1, ks = 1, frction = 1 } })
refused("law_test, law 'coulomb': friction = 95 deg is outside [0, 90]", { params = { kn = 1, ks = 1, friction = 95 } })
refused("law 'coulomb' of plugin 'talus.coulomb': dilation = 10 deg must be <=", { params = { kn = 1, ks = 1, dilation = 10 } })
refused("law_test: unknown parameter 'pth'; did you mean 'path'?", { pth = {} })
refused("law_test: normal_stress = inf is not a finite number", { normal_stress = math.huge })
refused("law_test: stiffness = -1 Pa/m must be >= 0", { stiffness = -1 })
refused("law_test: speed = 0 m/s must be > 0", { speed = 0 })
refused("law_test: steps = 0 is outside [1, 1e+07]", { steps = 0 })
refused("law_test: path must be a list of legs, as in {0.005, -0.005}, not the number 3", { path = 3 })
refused("law_test: path must be a list of legs, without names and gaps", { path = { shear = 1 } })
refused("law_test: path has no legs", { path = {} })
refused("law_test, path[2] must be a shear displacement in m or a table {shear = ...}, not the string 'x'", { path = { 0, "x" } })
refused("law_test, path[1]: unknown parameter 'sher'; did you mean 'shear'?", { path = { { sher = 1 } } })
refused("law_test, path[2]: shear = nan is not a finite number", { path = { 1, 0 / 0 } })
refused("law_test, path[1]: nothing is to happen", { path = { {} } })
refused("law_test, path[1]: time = 0 s must be > 0", { path = { { time = 0 } } })
refused("law_test, path[1]: closure is given in a test by normal_stress", { path = { { closure = 1 } } })
refused("law_test: stiffness needs normal_stress", { normal_stress = "none", stiffness = 1 })
refused("law_test, path[1]: normal_stress can change only in a test", { stiffness = 1, path = { { normal_stress = 2 } } })
refused("law_test, path[2]: the test has more than 10000000 steps", { path = { { shear = 1, steps = 1e7 }, 1 } })
refused("law_test, start of the path: law 'coulomb' cannot hold the normal stress of -1e+06 Pa", { normal_stress = -1e6 })
refused("law_test, path[1]: law 'coulomb_tensile' cannot hold the normal stress of", { law = "coulomb_tensile",
    params = { kn = KN, ks = KS, tension = T }, normal_stress = 0, path = { { normal_stress = -2 * T } } })
check.raises(function() talus.law_test({}, 1) end, "law_test: 1 argument too many")
check.raises(function() talus.law_test(3) end, "law_test: the parameters must be a table, not the number 3")

-- A law that fails, that is found by its plugin, and a tangent state: in a program of its own.
local chunk = [[
    local talus = require "talus"
    local function test(fails, more)
        return talus.law_test { law = "failing", steps = 4, params = { kn = 1e9, ks = 1e9, fails = fails, beyond = 5e-4 },
            path = { { closure = 1e-3, shear = 2e-3 } } }
    end
    local curve = test(false)
    print(curve.states.calls[5], curve.states.slid[5][1], curve.states.slid[5][2], pcall(test, true))
]]
local pipe = io.popen(string.format("'%s' --quiet --plugin '%s/failing.so' -e '%s' 2>&1", os.getenv "TALUS_PROGRAM",
    os.getenv "TALUS_BAD_PLUGIN_DIR", chunk))
local text = pipe:read "a"
pipe:close()
check.holds(text:find("5.0\t0.002\t0.0\tfalse", 1, true), "states in: " .. text)
check.holds(text:find("law_test, path[1]: law 'failing': it was told to fail", 1, true), "the failure in: " .. text)
