-- Rough joints: closure and its energy, peak strength over normal stress and roughness, the change with length, and the stress
-- along the shear displacement with the dilation there.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_laws"

local EXACT = 1e-9   -- relative, as in the reference
local ROUNDING = 3e-12 -- relative: the reference has 12 digits
local ENERGY = 1e-6  -- relative, as in the reference

-- ---------------------------------------------------------------- closure

local case = reference["LAW.bandis.closure"]
local kni, vm = case.inputs.kni, case.inputs.vm
figures.case("LAW.bandis.closure", "A joint without roughness is closed by a normal stress: closure, stiffness and stored energy.",
    case.source)
local stresses, closures, shown = {}, {}, {}
for stress in pairs(case.expected.by_stress) do
    stresses[#stresses + 1] = stress
end
table.sort(stresses)
local path = {}
for i, stress in ipairs(stresses) do
    path[i] = { normal_stress = stress }
end
local closing = talus.law_test { law = "barton_bandis", normal_stress = 0, path = path, steps = 2000,
    params = { jrc = 0, jcs = 1e8, phi_r = 30, kni = kni, vm = vm, ks = 1e10 } }
for i, stress in ipairs(stresses) do
    local at, expected = closing.ends[i], case.expected.by_stress[stress]
    local name = string.format("%g MPa: ", stress / 1e6)
    figures.relative(name .. "closure, m", closing.closure[at], expected.closure, EXACT)
    figures.relative(name .. "stored energy, J/m2", closing.stored[at], expected.energy_per_m2, ENERGY)
    figures.relative(name .. "work of closing, J/m2", closing.work[at], expected.energy_per_m2, ENERGY)
    -- the slope from a small step to either side, whose error is of the second order
    local h = 1e-4 * stress
    local slope = talus.law_test { law = "barton_bandis", normal_stress = stress - h, path = { { normal_stress = stress + h } },
        steps = 1, params = { jrc = 0, jcs = 1e8, phi_r = 30, kni = kni, vm = vm, ks = 1e10 } }
    figures.relative(name .. "stiffness, Pa/m", 2 * h / (slope.closure[2] - slope.closure[1]), expected.kn, 1e-6)
    closures[i], shown[i] = expected.closure, stress
end
figures.plot { title = "LAW.bandis.closure", x = "closure, m", y = "normal stress, Pa", series = {
    { name = "obtained", x = closing.closure, y = closing.normal_stress },
    { name = "expected", x = closures, y = shown, style = "points", colour = 1 } } }

-- ---------------------------------------------------------------- peak strength

case = reference["LAW.barton.peak"]
figures.case("LAW.barton.peak", "Peak shear strength over normal stress and roughness, with the angle limited to 70 degrees.",
    case.source)

-- Shear stress under a normal stress at a displacement over that of the peak; the joint is as long as the specimen.
local function shear(normal, jrc, jcs, phi, length, ratios, more)
    local peak = length / 500 * (jrc / length) ^ 0.33
    local p = { jrc = jrc, jcs = jcs, phi_r = phi, lab_length = length, kni = 1e11, vm = 1e-3, ks = 1e12, linear_from = 1e8,
        dilation = false }
    for key, value in pairs(more or {}) do
        p[key] = value
    end
    local legs = {}
    for i, ratio in ipairs(ratios) do
        legs[i] = ratio * peak
    end
    return talus.law_test { law = "barton_bandis", params = p, normal_stress = normal, path = legs, steps = 40 }, peak
end

local names = {}
for name in pairs(case.expected.tau) do
    names[#names + 1] = name
end
table.sort(names)
for _, name in ipairs(names) do
    local normal, jrc = name:match "^(%S+) MPa, JRC (%d+)$"
    local curve = shear(tonumber(normal) * 1e6, tonumber(jrc), case.inputs.JCS, case.inputs.phi_r, 0.1, { 1 })
    figures.relative(name .. ": peak shear stress, Pa", curve.shear_stress[curve.ends[1]], case.expected.tau[name], EXACT)
end
local low = shear(0.9999e6, 10, 1e8, 30, 0.1, { 1 })
local high = shear(1.0001e6, 10, 1e8, 30, 0.1, { 1 })
local slope = (high.shear_stress[high.ends[1]] - low.shear_stress[low.ends[1]]) / 200
figures.relative("slope at 1 MPa, JRC 10", slope, case.expected.slope_at_1MPa_JRC10, 1e-7)
figures.near("instantaneous angle of friction, deg", math.deg(math.atan(slope)), case.expected.instantaneous.formula, 1e-6)

-- ---------------------------------------------------------------- length

case = reference["LAW.barton.scale"]
figures.case("LAW.barton.scale", "Roughness and wall strength of longer joints, from the peak strength at two normal stresses: tan(phi_r + "
    .. "JRC log10(JCS / s)) s.", case.source)
for _, length in ipairs { 0.1, 0.5, 1, 5 } do
    local expected = case.expected[length == 0.1 and "0.1 m" or length == 0.5 and "0.5 m" or length .. ".0 m"]
    local function angle(normal)
        local peak = length / 500 * (expected.JRC / length) ^ 0.33
        local curve = talus.law_test { law = "barton_bandis", normal_stress = normal, path = { peak }, steps = 10,
            params = { jrc = case.inputs.JRC0, jcs = case.inputs.JCS0, phi_r = 30, lab_length = case.inputs.L0, length = length,
                kni = 1e11, vm = 1e-3, ks = 1e12, dilation = false } }
        return math.deg(math.atan(curve.shear_stress[11] / normal)) - 30
    end
    local one, ten = angle(1e6), angle(1e7)
    local jrc = one - ten
    figures.relative(string.format("%g m: JRC", length), jrc, expected.JRC, EXACT)
    figures.relative(string.format("%g m: JCS, Pa", length), 1e6 * 10 ^ (one / jrc), expected.JCS, EXACT)
end

-- ---------------------------------------------------------------- along the shear displacement

case = reference["LAW.barton.shear"]
local given = case.inputs
figures.case("LAW.barton.shear", "Shear stress along the displacement over that of the peak, and the angle of dilation there.",
    case.source)
local ratios = {}
for ratio in pairs(case.expected.tau) do
    if ratio > 0 then
        ratios[#ratios + 1] = ratio
    end
end
table.sort(ratios)
local curve, peak = shear(given.sigma_n, given.JRC, given.JCS, given.phi_r, given.L, ratios)
figures.relative("displacement at the peak, m", peak, case.expected.u_peak, ROUNDING)
local x, y = {}, {}
for i, ratio in ipairs(ratios) do
    figures.relative(string.format("shear stress at %g u_peak, Pa", ratio), curve.shear_stress[curve.ends[i]],
        case.expected.tau[ratio], EXACT)
    x[i], y[i] = curve.shear[curve.ends[i]] / peak, case.expected.tau[ratio]
end
for _, ratio in ipairs { 1, 2, 10 } do
    -- over a short way that ends there; the law opens by the angle of each step's end
    local way = 1e-3
    local dilates = shear(given.sigma_n, given.JRC, given.JCS, given.phi_r, given.L, { ratio * (1 - way), ratio },
        { dilation = true })
    local last = dilates.ends[2]
    local slope_there = (dilates.states.opening[last] - dilates.states.opening[last - 1]) /
        (dilates.states.slip[last] - dilates.states.slip[last - 1])
    figures.relative(string.format("angle of dilation at %g u_peak, deg", ratio), math.deg(math.atan(slope_there)),
        case.expected.dilation_deg[ratio], EXACT)
end
local steps = {}
for i = 1, #curve.shear do
    steps[i] = curve.shear[i] / peak
end
figures.plot { title = "LAW.barton.shear", x = "displacement over that of the peak", y = "shear stress, Pa", series = {
    { name = "obtained", x = steps, y = curve.shear_stress },
    { name = "expected", x = x, y = y, style = "points", colour = 1 } } }
figures.finish()
