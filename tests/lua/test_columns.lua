-- No law makes a block weaker than none: columns under a load beside their middle, and slender blocks on inclines, on a joint of
-- every law and attitude, as exact statics of an elastic joint without tension has them. tests/verify/long/columns.lua tries many
-- more models.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local columns = require "columns"
local every_law = require "every_law"
local inclines = require "inclines"

local COLUMNS, INCLINES = 1.5, 0.1 -- models for each law

-- The laws, each with models of its own, so that few for each are many in all.
local function try(of, models)
    local number = 0
    for k, law in ipairs(every_law(1e9, 1e5)) do
        for _ = 1, math.floor(k * models) - math.floor((k - 1) * models) do
            number = number + 1
            local case = of.draw(number)
            local joint = every_law(case.kn, case.pressure)[k]
            local wrong = of.try(case, joint)
            check.equal(wrong and ("%s: %s: %s"):format(law.name, of.title(case), wrong), nil)
        end
    end
end

try(columns, COLUMNS)
try(inclines, INCLINES)
