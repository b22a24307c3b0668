-- program only
-- A cube slides down an incline as friction lets it and hardly creeps on one less steep when it is jolted; a slab rocks
-- without losing much; prisms of many sides roll like cylinders.
local check = require "check"
local sliding = require "sliding"

-- Of the way that is expected: the cube starts with a jolt, for friction holds it first; a prism of 16 sides starts where
-- it stands, one of 64 is all but round.
local SLIDE, ROLL = { 0.04, 0.015 }, { [16] = 0.05, [64] = 0.015 }
local BALANCE = 1e-3 -- of the energy ledger
local LESS = 1.5     -- times the figures that contacts by a common plane with points gave, which stand beside each case

local failed = 0
local function holds(condition, format, ...)
    print((condition and "" or "FAILED ") .. string.format(format, ...))
    failed = failed + (condition and 0 or 1)
end

for i, kn in ipairs(check.few { 1e9, 1e10 }) do
    -- how far it creeps differs by half from one jolt to the next that is like it
    for _, case in ipairs { { { 0 }, 4.54e-4, 4.66e-5 }, { { 0.01, 0.02, 0.03, 0.04, 0.05 }, 1.68e-4, 1.86e-4 } } do
        local way = 0
        for _, spin in ipairs(case[1]) do
            way = way + math.abs(sliding.creep(kn, spin, 1)) / #case[1]
        end
        holds(way < LESS * case[1 + i], "kn %.0e: creeps %.3e m, was %.3e, jolted by up to %g rad/s", kn, way, case[1 + i],
            case[1][#case[1]])
    end
    local way, expected, balance = sliding.slide(kn, 1)
    holds(math.abs(way / expected - 1) < SLIDE[i] and balance < BALANCE, "kn %.0e: slides %.4f m, expected %.4f, balance %.1e",
        kn, way, expected, balance)
    for _, sides in ipairs(check.few { 16, 64 }) do
        local heat
        way, expected, heat, balance = sliding.rolling(kn, sides, 20, 2)
        holds(math.abs(way / expected - 1) < ROLL[sides] and balance < BALANCE,
            "kn %.0e: %d sides roll %.4f m, expected %.4f, heat %.4f, balance %.1e", kn, sides, way, expected, heat, balance)
    end
    for _, case in ipairs { { 0.3, 0.165, 0.602 }, { 1, 0.102, 0.380 } } do
        local heat, swings, missing = sliding.rocking(kn, math.deg(math.atan(case[1])), 8)
        holds(heat < LESS * case[1 + i] and swings > 8 and missing < BALANCE,
            "kn %.0e: rocking, friction %g: %.3f to heat, was %.3f, %d half swings, ledger misses %.1e", kn, case[1], heat,
            case[1 + i], swings, missing)
    end
end
check.equal(failed, 0)
