-- A joint that weakens with slip: strength along the slip, fracture energy, the stiffness of the spring from which on it is
-- stable, and how far the stress falls when a block that hangs on a softer spring jumps.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_laws"

local EXACT = 1e-9     -- relative: the force lies on the curve at any length of step
local ENERGY = 1e-3    -- relative, as in the reference: work by the trapezoidal rule
local TINY = 1e-9      -- m, step in which it falls or does not
local STABLE = 1e-5    -- relative: a stable joint falls by TINY k k_c / (k - k_c)
local OVERSHOOT = 5e-3 -- relative: the load goes on while the block jumps, and the area shrinks by 0.1 %

local stiff, soft = reference["LAW.slip_weakening.5e+09"], reference["LAW.slip_weakening.5e+08"]
local given = stiff.inputs
local SN, DROP = given.sigma_n, given.sigma_n * (given.mu_peak - given.mu_residual)
local RESIDUAL = SN * given.mu_residual

local function parameters(ks, form, distance)
    return { kn = 1e11, ks = ks, distance = distance or given.Dc, form = form,
        friction = math.deg(math.atan(given.mu_peak)),
        residual_friction = math.deg(math.atan(given.mu_residual)) }
end

-- The joint's own shear spring is the one that loads it: k in the place of ks.
local function shear(ks, way, steps, form)
    local weak = given.Dc + RESIDUAL / ks -- a step meets the slip D_c
    return talus.law_test { law = "slip_weakening", params = parameters(ks, form), normal_stress = SN,
        path = { SN * given.mu_peak / ks, weak < way and weak or way, way }, steps = steps }
end

-- Fall of the stress in one tiny step from the peak on.
local function jump(ks)
    local peak = SN * given.mu_peak / ks
    local curve = talus.law_test { law = "slip_weakening", params = parameters(ks), normal_stress = SN,
        path = { peak, peak + TINY }, steps = 1 }
    return curve.shear_stress[2] - curve.shear_stress[3]
end

-- ---------------------------------------------------------------- strength and energy

figures.case("LAW.slip_weakening", "One point is sheared through a stiff spring, its strength falling from peak to residual: "
    .. "stress along the slip and work of fracture, of the linear and of the exponential form.", stiff.source)

local function follow(form, expected, energy)
    local curve = shear(given.spring, 2e-2, 20000, form)
    local slips = {}
    for slip in pairs(expected) do
        slips[#slips + 1] = slip
    end
    table.sort(slips)
    for _, slip in ipairs(slips) do
        -- the stress on the way between the two points beside this slip, where the strength is a line or nearly so
        local i = 1
        while curve.states.slip[i + 1] <= slip do
            i = i + 1
        end
        local a, b = curve.states.slip[i], curve.states.slip[i + 1]
        local t = (slip - a) / (b - a)
        figures.relative(string.format("%s: strength at slip %g mm, Pa", form, 1e3 * slip),
            curve.shear_stress[i] * (1 - t) + curve.shear_stress[i + 1] * t, expected[slip],
            form == "linear" and EXACT or 1e-6)
    end
    local n = #curve.shear
    figures.relative(form .. ": heat above the residual strength, J/m2",
        curve.heat[n] - RESIDUAL * curve.states.slip[n], energy, ENERGY)
    figures.relative(form .. ": work, J/m2", curve.work[n], curve.stored[n] + curve.heat[n], EXACT)
    return curve
end

local line = follow("linear", stiff.expected.strength_at, stiff.expected.fracture_energy)
local at = {}
for slip in pairs(stiff.expected.strength_at) do
    at[slip] = RESIDUAL + DROP * math.exp(-slip / given.Dc)
end
local bent = follow("exponential", at, DROP * given.Dc)

-- ---------------------------------------------------------------- stability

figures.equal("stable at k = 5e9 Pa/m", jump(given.spring) < 0.5 * DROP, stiff.expected.stable)
figures.equal("stable at k = 5e8 Pa/m", jump(soft.inputs.spring) < 0.5 * DROP, soft.expected.stable)
local low, high = soft.inputs.spring, given.spring
while high / low > 1 + 1e-9 do
    local k = math.sqrt(low * high)
    if jump(k) < 0.5 * DROP then
        high = k
    else
        low = k
    end
end
figures.relative("stiffness from which on it is stable, Pa/m", high, stiff.expected.k_critical, STABLE)
local slack = shear(soft.inputs.spring, 2e-2, 2000)
figures.plot { title = "LAW.slip_weakening: k = 5 GPa/m, stable, and 0.5 GPa/m, which jumps", x = "shear displacement, m",
    y = "shear stress, Pa", series = { { name = "linear", x = line.shear, y = line.shear_stress },
        { name = "exponential", x = bent.shear, y = bent.shear_stress },
        { name = "linear, soft spring", x = slack.shear, y = slack.shear_stress } } }

-- ---------------------------------------------------------------- a block that jumps

-- A plate is drawn slowly over a block that lies on a base: the joint of plate and block is the spring. The shear stress
-- begins just below the peak.
local function overshoot(distance)
    local SPRING, KS, LONG = soft.inputs.spring, 1e12, 10
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { LONG, 1, 3 }, density = 2500 })
    model:generate("joint", { joint = "weak", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
    model:generate("joint", { joint = "spring", dip = 0, dip_direction = 0, origin = { 0, 0, 2 } })
    local function part(z)
        return model:blocks { containing = { LONG / 2, 0.5, z } }
    end
    local base, block, plate = part(0.5), part(1.5), part(2.5)
    base:fix()
    block:fix { y = true, z = true, rotation = true }
    model:joint("weak", "slip_weakening", parameters(KS, "linear", distance))
    model:joint("spring", "elastic", { kn = 1e11, ks = SPRING })
    local peak = SN * given.mu_peak
    model:insitu { stress = { zz = -SN, zx = 0.9995 * peak } }
    plate:drive { velocity = { 1e-3, 0, 0 } }
    local k = 1 / (1 / SPRING + 1 / KS)
    local time = 2e-3 * peak / k / 1e-3 -- until four times what is missing has been drawn
    model:solve { ratio = 0, max_time = time, max_cycles = 1e6 }
    local contact = model:contacts { joint = "spring" }[1]
    return math.abs(contact.shear_force[1]) / LONG, k, model:energy().balance
end

figures.case("LAW.slip_weakening.jump", "A block on a weakening joint is drawn by a soft spring until it jumps, without damping: "
    .. "the spring gives up as much energy as the slip takes, so the stress ends below the residual strength by sqrt(drop^2 - "
    .. "2 k G), G the work of fracture.", soft.source .. "; energy balance")
for _, distance in ipairs { 1e-5, given.Dc } do
    local stress, k, balance = overshoot(distance)
    local name = string.format("D_c = %g mm: ", 1e3 * distance)
    local fracture = DROP * distance / 2
    figures.relative(name .. "stress after the jump, Pa", stress,
        RESIDUAL - math.sqrt(DROP ^ 2 - 2 * k * fracture), OVERSHOOT)
    if distance == 1e-5 then
        figures.relative(name .. "the same, of a vanishing D_c, Pa", stress, soft.expected.stress_after_instability, OVERSHOOT)
    end
    figures.near(name .. "error of the energy balance", balance, 0, 1e-3)
end
figures.finish()
