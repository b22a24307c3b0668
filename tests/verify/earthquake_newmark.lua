-- A block on a plane that shakes by a record slips while the plane outruns friction (Newmark, 1965). The plane lies level
-- here, and the gravity dips.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_earthquakes"

local GRAVITY, DENSITY, HEIGHT = 9.81, 2000, 0.2
local STIFFNESS = 1e10 -- Pa/m: the block's own frequencies are far above those of the record
local SLIP, SAMPLE, BALANCE = 0.02, 1e-9, 1e-3

local function build(case)
    local dip = math.rad(case.dip)
    local model = talus.model { gravity = { GRAVITY * math.sin(dip), 0, -GRAVITY * math.cos(dip) } }
    model:generate("box", { min = { -5, -2, -1 }, max = { 5, 2, 0 }, density = DENSITY, group = "base" })
    model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, HEIGHT }, density = DENSITY, group = "block" })
    local base, block = model:blocks { group = "base" }, model:blocks { group = "block" }
    base:fix()
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = math.deg(math.atan(case.mu)) })
    model:damping "local"
    model:solve { ratio = 1e-8 }
    model:damping "none"
    base:reset_displacement()
    block:reset_displacement()
    return model, base, block
end

for _, case in ipairs(reference.newmark) do
    figures.case(case.name, string.format("Record scaled to %g m/s2, friction coefficient %g, dip %g degrees: slip of the block",
        case.scaled_to, case.mu, case.dip), reference.newmark.source)
    local at = reference.accelerogram(case.seed, case.scaled_to)
    local dip = math.rad(case.dip)
    local function record(scale)
        return talus.record { at = at, dt = 0.005, baseline = "parabola", scale = scale }
    end
    local along, across, whole = record(math.cos(dip)), record(math.sin(dip)), record(1)
    for k, expected in pairs(case.samples) do
        figures.near("sample " .. k .. ", m/s2", whole:acceleration(0.005 * k), expected, SAMPLE)
    end
    figures.relative("peak, m/s2", whole:peak(), case.peak, SAMPLE)
    local model, base, block = build(case)
    base:drive { velocity = { along, 0, across } }
    local times, slips, worst, last, total = {}, {}, 0, 0, 0
    local stop = model.time + whole.duration
    while model.time < stop do
        model:cycle(50)
        local slip = block[1].displacement[1] - base[1].displacement[1]
        total = total + math.abs(slip - last)
        last = slip
        times[#times + 1], slips[#slips + 1] = model.time, slip
        worst = math.max(worst, math.abs(model:energy().balance))
    end
    figures.relative("slip down the dip, m", last, case.slip, SLIP)
    figures.relative("slip of either way, m", total, case.total, SLIP)
    figures.between("worst energy balance, of the largest term", worst, 0, BALANCE)
    figures.plot { title = case.name .. ": slip", x = "time, s", y = "slip, m",
        series = { { name = "obtained", x = times, y = slips, style = "line" } } }
end
figures.finish()
