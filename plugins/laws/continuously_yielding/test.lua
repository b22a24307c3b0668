-- Law continuously_yielding: stiffness that grows with the stress, dilation, directions in the plane, a block that is shaken,
-- and what it refuses. Curves against the published equations: tests/verify/law_continuously_yielding.lua.
local talus = require "talus"
local check = require "check"

local AN, EN, AS, ES, PHI_I, PHI, R = 2e7, 0.5, 1e6, 0.5, 50, 30, 2e-3
local KN_MAX, KS_MAX = AN * 1e3, AS * 1e3 -- at 1 MPa
local params = require "law_tests".of("continuously_yielding", {
    an = AN, en = EN, as = AS, es = ES, kn_max = KN_MAX, ks_max = KS_MAX,
    phi_i = PHI_I, phi = PHI, roughness = R
})

-- Closure: ds/dv = an s^en up to kn_max, a line beyond; elastic.
local function closure(stress)
    local curved = math.min(stress, 1e6)
    return curved ^ (1 - EN) / ((1 - EN) * AN) + (stress - curved) / KN_MAX
end
local pressed = talus.law_test { law = "continuously_yielding", params = params(), normal_stress = 1e4, steps = 1000,
    path = { { normal_stress = 5e5 }, { normal_stress = 2e6 }, { normal_stress = 1e4 } } }
for i, stress in ipairs { 5e5, 2e6, 1e4 } do
    check.near(pressed.closure[pressed.ends[i]], closure(stress), 1e-9 * closure(2e6))
end
local n = #pressed.time
check.near(pressed.stored[n], pressed.stored[1], 1e-9 * pressed.stored[1])
check.near(pressed.work[pressed.ends[2]], pressed.stored[pressed.ends[2]], 1e-4 * pressed.stored[pressed.ends[2]])
check.equal(pressed.heat[n], 0.0)

-- The first slope is ks at the stress; far on, the friction is the worn one.
local SN = 2.5e5
local sheared = talus.law_test { law = "continuously_yielding", params = params(), normal_stress = SN, steps = 4000,
    path = { 1e-7, 20 * R } }
local first = sheared.ends[1]
check.near(sheared.shear_stress[first] / sheared.shear[first], AS * SN ^ ES, 1e-3 * AS * SN ^ ES)
n = #sheared.time
check.near(sheared.shear_stress[n], SN * math.tan(math.rad(PHI)), 1e-3 * SN)
check.near(sheared.states.wear[n], PHI_I - PHI, 0.01)

check.holds(sheared.dilation[n] > 0.1 * R, "it opens")

-- Slip opens the joint by the angle of the stress less the worn friction; with dilation = false it does not. (In a step the joint opens
-- after the shear is found, so the stress that held it is that of the walls before: steps are to be small beside the closure.)
local slow = talus.law_test { law = "continuously_yielding", params = params(), normal_stress = SN, steps = 40000, path = { 1e-7, R } }
for i = slow.ends[1] + 2, #slow.time, 400 do
    local opened = slow.states.opening[i] - slow.states.opening[i - 1]
    local angle = math.deg(math.atan(slow.shear_stress[i] / SN)) - PHI
    if angle > 0.5 then
        local d = slow.shear[i] - slow.shear[i - 1]
        local slip = d - (slow.shear_stress[i] - slow.shear_stress[i - 1]) / (AS * SN ^ ES)
        check.near(opened, math.tan(math.rad(angle)) * slip, 2e-3 * opened)
    end
end
local flat = talus.law_test { law = "continuously_yielding", params = params { dilation = false }, normal_stress = SN,
    path = { 5 * R } }
check.near(flat.dilation[#flat.time], 0, 1e-15)

-- Any way of shear and closing: heat never goes back, and what is off is the rule of trapezoids on a curved spring.
for seed = 1, 20 do
    math.randomseed(seed)
    local path = {}
    for k = 1, 12 do
        path[k] = { shear = (math.random() - 0.5) * R, closure = (math.random() + 0.1) * closure(1e6), steps = 2000 }
    end
    path[13] = { shear = 0, closure = 0 }
    local way = talus.law_test { law = "continuously_yielding", params = params(), path = path }
    n = #way.time
    check.near(way.work[n] - way.stored[n] - way.heat[n], 0, 2e-3 * way.heat[n])
    check.holds(way.work[n] > 0, "work goes in")
    for i = 2, n do
        check.holds(way.heat[i] >= way.heat[i - 1], "heat grows")
    end
end

-- Refusals.
local function refused(part, more, without)
    local p = params(more)
    p[without or 0] = nil
    check.raises(function() talus.law_test { law = "continuously_yielding", params = p, path = { 0.001 } } end, part)
end
refused("phi = 55 deg must be <= phi_i = 50 deg", { phi = 55 })
refused("en > 0 needs kn_max, the largest normal stiffness", {}, "kn_max")
refused("es > 0 needs ks_max, the largest shear stiffness", {}, "ks_max")
refused("en = 1 is outside [0, 1)", { en = 1 })
refused("roughness = 0 m must be > 0", { roughness = 0 })

-- In a model: a slab, too flat to rock, on a slope between the two angles holds, and slides once shaking has worn the joint.
local G, SLOPE = 10, math.rad(35)
local model = talus.model { gravity = { G * math.sin(SLOPE), 0, -G * math.cos(SLOPE) } }
model:generate("box", { min = { 0, 0, 0 }, max = { 20, 4, 1 }, density = 2500 })
model:generate("box", { min = { 1, 1, 1 }, max = { 3, 3, 1.5 }, density = 2500 })
local base = model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }
base:fix()
local block = model:blocks { fixed = false }
model:joint("*", "continuously_yielding", { an = 1e9, as = 1e9, phi_i = PHI_I, phi = PHI, roughness = R, dilation = false })
model:damping "local"
model:solve { ratio = 1e-6 }
check.near(block[1].velocity[1], 0, 1e-6)
model:damping "none"
base:drive { velocity = function(t) return { 0.25 * math.sin(40 * t), 0, 0 } end }
model:solve { ratio = 0, max_time = 1.5 }
base:drive { velocity = { 0, 0, 0 } }
model:solve { ratio = 0, max_time = 0.5 }
check.holds(block[1].velocity[1] > 0.5, "it slides")
-- undamped, it trembles: the friction is that of the forces
local along, normal = 0, 0
for _ = 1, 500 do
    model:cycle(1)
    along = along - model:contacts():sum "shear_force"[1]
    normal = normal + model:contacts():sum "normal_force"
end
check.near(along / normal, math.tan(math.rad(PHI)), 1e-3)
