-- Properties and stresses that are out of all proportion are refused with a sentence before they make forces or energies that are no
-- numbers; the largest and the smallest that are taken do not.
local talus = require "talus"
local check = require "check"

local function stack()
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { 0, 0, -1 }, max = { 2, 2, 0 }, density = 2500, group = "base" })
    m:blocks():fix()
    m:generate("box", { min = { 0.5, 0.5, 0 }, max = { 1.5, 1.5, 1 }, density = 2500, group = "top" })
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    return m
end

local LAWS = {
    elastic = { kn = 1e8, ks = 1e8 },
    coulomb = { kn = 1e8, ks = 1e8, friction = 30, cohesion = 1, dilation = 5, dilation_limit = 0.1 },
    coulomb_tensile = { kn = 1e8, ks = 1e8, friction = 30, cohesion = 1e4, tension = 1e4, dilation_limit = 0.1 },
    cohesive = { kn = 1e8, ks = 5e7, tension = 2e4, cohesion = 3e4, energy_tension = 50, energy_shear = 100 },
    slip_weakening = { kn = 1e8, ks = 5e7, friction = 35, residual_friction = 20, cohesion = 10, distance = 1e-3 },
    rate_state = { kn = 1e8, ks = 5e7, a = 0.01, b = 0.015, distance = 1e-3, velocity = 1e-6, damping = 1, theta = 1 },
    barton_bandis = { jrc = 5, jcs = 5e7, kni = 1e8, vm = 1e-2, ks = 1e8, linear_from = 1e6, length = 1, phi_r = 20, reduction = 1 },
    continuously_yielding = { an = 1e8, as = 5e7, en = 0.1, es = 0.1, kn_max = 1e9, ks_max = 1e9, phi_i = 40, phi = 20, roughness = 1e-2 },
}
local BOUNDED = { friction = true, residual_friction = true, dilation = true, a = true, b = true, jrc = true, phi_r = true, en = true,
    es = true, phi_i = true, phi = true }

local function finite(m)
    for term, energy in pairs(m:energy()) do
        check.holds(energy == energy and math.abs(energy) < math.huge, term .. " is a number")
    end
end

local function with(properties, name, value)
    local changed = {}
    for key, own in pairs(properties) do
        changed[key] = own
    end
    changed[name] = value
    return changed
end

for law, properties in pairs(LAWS) do
    for name in pairs(properties) do
        for _, size in ipairs(BOUNDED[name] and { 5e-324, 1e-200 } or { 5e-324, 1e-200, 1e-51, 1e51, 1e200, 1.7e308 }) do
            local m = stack()
            m:cycle(3)
            local changed = with(properties, name, size)
            check.refused(m, function() m:joint("*", law, changed) end, "joint '*', law '" .. law .. "': " .. name .. " = ")
            check.refused(m, function() m:joint("*", law, changed) end, "out of all proportion: give ")
            check.raises(function() talus.law_test { law = law, params = changed, normal_stress = 1e5, path = { 1e-3 } } end,
                "out of all proportion: give ")
        end
        -- the smallest and the largest: refused for a reason of the law's own, or numbers
        for _, size in ipairs(BOUNDED[name] and { 1e-50 } or { 1e-50, 1e-30, 1e30, 1e50 }) do
            local m = stack()
            if pcall(m.joint, m, "*", law, with(properties, name, size)) then
                m:blocks { group = "top" }:set { velocity = { 1e-3, 0, 0 } }
                local good, text = pcall(m.cycle, m, 30)
                check.holds(good or not (text:find "taken back" or text:find "%f[%a]nan%f[%A]" or text:find "%f[%a]inf%f[%A]"), text)
                finite(m)
            end
        end
    end
end

-- One property of several, later.
local m = stack()
m:cycle(3)
check.refused(m, function() m:joint("*", { ks = 1e200 }) end,
    "joint '*', law 'coulomb': ks = 1e+200 Pa/m is out of all proportion: give a size from 1e-50 to 1e+50, or check the units")
check.refused(m, function() m:joint("*", { cohesion = 1e-200 }) end, "give 0 or a size from 1e-50 to 1e+50")

-- Dampings.
for _, alpha in ipairs { 1e51, 1.7e308, 1e-200 } do
    check.refused(m, function() m:damping("viscous", { alpha = alpha }) end, "damping 'viscous': alpha = ")
    check.refused(m, function() m:damping("adaptive", { start = alpha, minimum = alpha, maximum = alpha }) end, "out of all proportion")
end
for _, alpha in ipairs { 1e50, 1e-50, 0 } do
    m:damping("viscous", { alpha = alpha })
    m:cycle(10)
    finite(m)
end

-- A stress that the gradient makes.
for _, away in ipairs { 1e60, 1e200, -1.7e308 } do
    m = stack()
    check.refused(m, function() m:insitu { stress = { zz = -1 }, gradient = { zz = -1 }, at = { 0, 0, away } } end,
        "insitu: the gradient, 1 Pa/m, over the height of")
    check.refused(m, function() m:insitu { stress = { xz = -1 }, gradient = { xz = 5 }, at = { 0, 0, away } } end,
        "between at and block 1 makes more than the 1e+50 Pa that are taken: give an at near the blocks")
end
m = stack()
m:insitu { stress = { zz = -1 }, gradient = { zz = -1 }, at = { 0, 0, 1e3 } }
check.near(m:contacts()[1].normal_stress, -999, 1e-9)
