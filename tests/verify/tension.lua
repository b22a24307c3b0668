-- A bonded joint is pulled apart: it carries tension up to its strength, then nothing for good.
package.path = "tests/verify/?.lua;tests/lua/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local case = require("reference_statics")["S.tension"]

local STRESS = 1e-6     -- relative
local FAILURE = 1e-4    -- relative: the step of the opening near failure
local SHEAR = 0.2       -- shear displacement over opening, so that there is shear to lose
local DT = 1e-4         -- s; everything is driven, so any step will do
local STEPS = 100       -- from one opening to the next

local function build()
    local model, lower, upper = require "cube_on_block"({ -1, -1, -1 }, { 2, 2, 0 })
    -- The cohesion is out of reach: the joint fails in tension.
    model:joint("*", "coulomb_tensile", { kn = case.kn, ks = case.kn, friction = 30,
        cohesion = 100 * case.tension, tension = case.tension })
    model:timestep { dt = DT }
    local speed = 0
    upper:drive { velocity = function() return { SHEAR * speed, 0, speed } end }
    model:cycle(1)
    -- Opens the joint to `opening` in so many steps.
    local function open(opening, steps)
        speed = (opening - upper[1].displacement[3]) / (steps * DT)
        model:cycle(steps)
        speed = 0
        model:cycle(1) -- forces are those of the places at the step's beginning
        local contacts = model:contacts { between = { lower, upper } }
        local stress, shear = 0, 0
        if #contacts > 0 then
            stress = contacts:sum "normal_force" / contacts:sum "area"
            shear = contacts[1].shear_force[1] / contacts:sum "area"
        end
        return stress, shear
    end
    return open
end

figures.case("S.tension", "A cube bonded to a fixed block is pulled off it, and a little "
    .. "sideways: the stress at given openings, the opening at which the bond breaks, and that "
    .. "nothing is left then, nor when the joint has closed and opens again.", case.source)

local open = build()
for _, row in ipairs(case.rows) do
    local stress, shear = open(row.opening, STEPS)
    local name = string.format("opening %.4f mm: ", 1e3 * row.opening)
    figures.near(name .. "normal stress, Pa", stress, row.sigma, STRESS * math.abs(row.sigma))
    -- kn = ks: both springs are drawn in the ratio of the displacements.
    figures.near(name .. "shear stress, Pa", math.abs(shear), SHEAR * math.abs(row.sigma),
        STRESS * math.abs(row.sigma))
end
open(0, STEPS)
local stress, shear = open(0.5 * case.opening_at_failure, STEPS)
figures.near("closed and opened again: normal stress, Pa", stress, 0, 0)
figures.near("closed and opened again: shear stress, Pa", shear, 0, 0)

-- Where does it break?
open = build()
local way, normal, across, failed = {}, {}, {}, nil
local opening = 0
while opening < 1.5 * case.opening_at_failure do
    -- Fine steps in the last and the first percent beside the failure.
    local near = math.abs(opening / case.opening_at_failure - 1) < 0.01
    opening = opening + (near and FAILURE or 0.008) * case.opening_at_failure
    local n = #way + 1
    way[n] = opening
    normal[n], across[n] = open(opening, 1)
    if not failed and normal[n] == 0 then
        failed = (way[n - 1] + way[n]) / 2
    end
end
figures.relative("opening at failure, m", failed, case.opening_at_failure, FAILURE)
local x, y = {}, {}
for i, row in ipairs(case.rows) do
    x[i], y[i] = row.opening, row.sigma
end
figures.plot { title = "S.tension: a bond breaks", x = "opening, m", y = "stress, Pa", series = {
    { name = "normal stress, obtained", x = way, y = normal },
    { name = "normal stress, expected", x = x, y = y, style = "points", colour = 1 },
    { name = "shear stress, obtained", x = way, y = across, colour = 2 } } }
figures.finish()
