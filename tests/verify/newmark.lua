-- A block on a shaken base slips while the base outruns friction (Newmark, 1965): slip against the base
-- at the end of every cycle, largest speed against it, and the balance of energy.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference_dynamics").newmark

local GRAVITY, DENSITY, HEIGHT = 10, 2000, 0.2
-- Pa/m: the block's own frequencies are some 400 times those of the base, so that the elastic part of
-- the motion is lost in the slip.
local STIFFNESS = 1e10
local PHASE = 0.03     -- of the block's fastest oscillation in one step: omega dt
local SAMPLES = 200    -- of the speed, in a cycle
local SLIP, SPEED, BALANCE = 0.01, 0.01, 1e-3

-- A flat block at rest on its base, which lies level: the gravity dips instead. Down the dip is x.
local function build(case)
    local dip = math.rad(case.beta)
    local model = talus.model { gravity = { GRAVITY * math.sin(dip), 0, -GRAVITY * math.cos(dip) } }
    model:generate("box", { min = { -5, -2, -1 }, max = { 5, 2, 0 }, density = DENSITY,
        group = "base" })
    model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, HEIGHT }, density = DENSITY,
        group = "block" })
    local base, block = model:blocks { group = "base" }, model:blocks { group = "block" }
    base:fix()
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS,
        friction = math.deg(math.atan(case.mu)) })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.1 }
    model:solve { ratio = 1e-9 }
    model:damping "none"
    base:reset_displacement()
    block:reset_displacement()
    return model, base, block
end

for _, case in ipairs(reference) do
    figures.case(case.name, string.format("Base velocity of %g / (2 pi f) sin(2 pi f t) with f = %g per "
        .. "second, friction coefficient %g, dip %g: slip of the block after each cycle", case.A,
        case.f, case.mu, case.beta), reference.source)
    local model, base, block = build(case)
    local start, omega = model.time, 2 * math.pi * case.f
    base:drive { velocity = function(t)
        return case.A / omega * math.sin(omega * (t - start)), 0, 0
    end }
    local fastest = math.sqrt(STIFFNESS / (DENSITY * HEIGHT))
    local stride = math.ceil(fastest / (case.f * PHASE * SAMPLES))
    model:timestep { dt = 1 / (case.f * SAMPLES * stride) }

    local speed, worst = 0, 0
    local times, slips = {}, {}
    for cycle, expected in ipairs(case.slip) do
        local slip
        for _ = 1, SAMPLES do
            model:cycle(stride)
            local u = block[1].velocity[1] - base[1].velocity[1]
            speed = math.max(speed, math.abs(u))
            slip = block[1].displacement[1] - base[1].displacement[1]
            worst = math.max(worst, math.abs(model:energy().balance))
            times[#times + 1], slips[#slips + 1] = model.time - start, slip
        end
        figures.relative(string.format("slip after %d cycles, m", cycle), slip, expected, SLIP)
    end
    figures.relative("largest speed against the base, m/s", speed, case.speed, SPEED)
    figures.between("energy balance, of the largest term", worst, 0, BALANCE)
    local at = {}
    for cycle = 1, #case.slip do
        at[cycle] = cycle / case.f
    end
    figures.plot { title = case.name .. ": slip against the base", x = "time, s", y = "slip, m",
        series = {
            { name = "obtained", x = times, y = slips, style = "line" },
            { name = "expected at the end of a cycle", x = at, y = case.slip, style = "points" },
        } }
end
figures.finish()
