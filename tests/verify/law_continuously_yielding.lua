-- A continuously yielding joint: sheared in one direction and to and fro, with and without softening after the peak.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_laws"

local TAU = 1e-3    -- relative, as in the reference
local ANGLE = 0.02  -- deg: the friction of that error
local STEP = 1e-6   -- m, as in the reference
local WORK = 1e-3   -- relative

local function run(given, path, softening)
    local legs, from = {}, 0
    for i, to in ipairs(path) do
        legs[i] = { shear = to, steps = math.max(1, math.floor(math.abs(to - from) / STEP + 0.5)) }
        from = to
    end
    return talus.law_test { law = "continuously_yielding", normal_stress = given.sn, path = legs,
        params = { an = given.an, en = given.en, as = given.as_, es = given.es, phi_i = math.deg(given.phi_i),
            phi = math.deg(given.phi), roughness = given.R, softening = softening, dilation = false } }
end

local function check(id, sentence)
    local case = reference[id]
    local given, path = case.inputs, {}
    for i, at in ipairs(case.expected.at) do
        path[i] = at.u
    end
    local curve = run(given, path, false)
    figures.case(id, sentence, case.source)
    local x, y, peak = {}, {}, 0
    for i, at in ipairs(case.expected.at) do
        local k = curve.ends[i]
        local name = string.format("leg %d, to %g mm: ", i, 1e3 * at.u)
        local tau = curve.shear_stress[k]
        figures.relative(name .. "shear stress, Pa", tau, at.tau, TAU)
        figures.near(name .. "angle of the strength, deg", math.deg(given.phi_i) - curve.states.wear[k], at.phi_m_deg, ANGLE)
        figures.near(name .. "angle of dilation, deg", math.deg(math.atan(math.abs(tau) / given.sn) - given.phi),
            at.dilation_deg, ANGLE)
        figures.relative(name .. "work, J/m2", curve.work[k] - curve.work[1], at.work, WORK)
        x[i], y[i] = at.u, at.tau
    end
    for i = 1, #curve.time do
        peak = math.max(peak, math.abs(curve.shear_stress[i]))
    end
    figures.relative("peak, Pa", peak, case.expected.peak_tau, TAU)
    local soft = run(given, path, true)
    figures.plot { title = id, x = "shear displacement, m", y = "shear stress, Pa", series = {
        { name = "without softening", x = curve.shear, y = curve.shear_stress },
        { name = "with softening", x = soft.shear, y = soft.shear_stress },
        { name = "expected", x = x, y = y, style = "points", colour = 1 } } }
end
check("LAW.cy.monotonic", "A joint is sheared in one direction, without softening: the stress stays at its peak.")
check("LAW.cy.cycle", "A joint is sheared to and fro, without softening.")

-- ---------------------------------------------------------------- softening

-- The equations of the law by the midpoint rule in short steps, F free to be negative.
local function integrate(given, path, steps)
    local tau, phi, u, r, way, out = 0, given.phi_i, 0, 0, 0, {}
    for k, target in ipairs(path) do
        local d, sign = (target - u) / steps, target > u and 1 or -1
        if way ~= 0 and sign ~= way then
            r = math.min(tau / (given.sn * math.tan(phi) * sign), 0.75)
        end
        way = sign
        local function rate(t, p)
            local F = math.min((1 - t / (given.sn * math.tan(p) * sign)) / (1 - r), 1)
            return F * given.as_ * d, -(p - given.phi) * (1 - F) * math.abs(d) / given.R
        end
        for _ = 1, steps do
            local a, b = rate(tau, phi)
            a, b = rate(tau + a / 2, phi + b / 2)
            tau, phi = tau + a, phi + b
        end
        u = target
        out[k] = { tau = tau, phi = math.deg(phi) }
    end
    return out
end

local given = reference["LAW.cy.cycle"].inputs
local path = { 1e-3, 2e-3, 5e-3, -2e-3, 2e-3, 1.8e-3, 3e-3 }
local expected, curve = integrate(given, path, 20000), run(given, path, true)
figures.case("LAW.cy.softening", "A joint is sheared to and fro, and back and forth by a little; the stress follows the strength that "
    .. "wears. Expected is what the same equations give in short steps.", reference["LAW.cy.cycle"].source)
for i, at in ipairs(expected) do
    local k, name = curve.ends[i], string.format("leg %d, to %g mm: ", i, 1e3 * path[i])
    figures.relative(name .. "shear stress, Pa", curve.shear_stress[k], at.tau, TAU)
    figures.near(name .. "angle of the strength, deg", math.deg(given.phi_i) - curve.states.wear[k], at.phi, ANGLE)
end
for _, name in ipairs { "monotonic", "cycle" } do
    local soft = run(reference["LAW.cy." .. name].inputs, { 2e-3, -2e-3, 2e-3, 0 }, name == "cycle")
    local worst = 0
    for i = 2, #soft.time do
        worst = math.max(worst, math.abs(soft.work[i] - soft.stored[i] - soft.heat[i]) / soft.work[i])
    end
    figures.near(name .. ": error of the energies over the work", worst, 0, 1e-9)
end
figures.finish()
