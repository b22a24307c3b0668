-- No law makes a block weaker than none: columns under a load beside their middle, and slender blocks on inclines, on a joint of
-- every law and attitude, as exact statics of an elastic joint without tension has them. tests/verify/long/columns.lua tries many
-- more models.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local columns = require "columns"
local every_law = require "every_law"
local inclines = require "inclines"

local COLUMNS, INCLINES, RELAXED = 1.5, 0.1, 0.5 -- models for each law

-- The laws, each with models of its own, so that few for each are many in all.
local function try(of, what, models)
    local number = 0
    for k, law in ipairs(every_law(1e9, 1e5)) do
        for _ = 1, math.floor(k * models) - math.floor((k - 1) * models) do
            number = number + 1
            local case = of.draw(number)
            local joint = every_law(case.kn, case.pressure)[k]
            local wrong = what(case, joint)
            check.equal(wrong and ("%s: %s: %s"):format(law.name, of.title(case), wrong), nil)
        end
    end
end

try(columns, columns.try, COLUMNS)
try(inclines, inclines.try, INCLINES)
try(inclines, inclines.relax, RELAXED)

-- Where a face comes to stand on its edge its patch becomes a field. What was known of the stiffness of the one says nothing of
-- the other: leaps that went on by it carried this block beyond where it stands.
local edge = inclines.of(1, 0.96 / math.tan(math.rad(25)), 1, 1.25e10)
local slides_not = { law = "coulomb", params = { kn = edge.kn, ks = edge.kn, friction = 40 }, tension = 0 }
check.equal(inclines.relax(edge, slides_not, { 0.9, 0.99, 0.999, 1.001, 1.03 }), nil)
