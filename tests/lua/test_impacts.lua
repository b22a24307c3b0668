-- program only
-- Blocks that meet without friction keep energy, momentum and angular momentum, whatever their shapes, attitudes and
-- stiffness; what error of energy there is falls with the square of the step. tests/verify/long/frictionless_impacts.lua
-- does the same for many more.
local check = require "check"
local impacts = require "impacts"

local SEEDS = check.cases(4)

local failed = 0
local function holds(condition, row, what)
    if not condition then
        failed = failed + 1
        print("FAILED " .. row.name .. ": " .. what)
    end
end

impacts.survey(SEEDS, function(row)
    print(string.format("%-34s energy %.1e parted %.1e, mean %.1e, half the step %.1e, momentum %.0e, angular %.0e",
        row.name, row.worst, row.parted, row.mean, row.half, row.momentum, row.angular))
    holds(row.met == SEEDS and row.apart == SEEDS, row, "that blocks meet and part")
    holds(row.worst < impacts.ENERGY, row, "the energy ledger")
    holds(row.parted < impacts.ENERGY, row, "the energy after the impact")
    holds(row.half < impacts.FALL * row.mean or row.half < row.least, row, "that half the step has a quarter of the error")
    holds(row.momentum < impacts.MOMENTUM and row.angular < impacts.MOMENTUM, row, "momentum")
end)
check.equal(failed, 0)
