-- Columns and slender blocks on a joint of every law stand, sink, tilt and topple as exact statics of an elastic joint without
-- tension has it: no law makes a block weaker than none. tests/lua/test_columns.lua does the same with the first models.
package.path = "tests/verify/?.lua;tests/lua/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local columns = require "columns"
local every_law = require "every_law"
local figures = require "check_figures"
local inclines = require "inclines"

local COLUMNS, INCLINES = 300, 30 -- models for each law
local SOURCE = "statics of a rigid foot on an elastic joint without tension, by Newton's method (tests/lua/no_tension.lua)"

-- For each law the number of models that were wrong, of how many, and the largest error where there is one. `try` gives what is
-- wrong with a model.
local function survey(of, try, models)
    local rows = {}
    for number = 1, models do
        local case = of.draw(number)
        for k, joint in ipairs(every_law(case.kn, case.pressure)) do
            local row = rows[k] or { name = joint.name, joint = joint, wrong = 0, worst = 0 }
            rows[k] = row
            local wrong, off = try(case, joint)
            row.worst = math.max(row.worst, off or 0)
            if wrong then
                row.wrong = row.wrong + 1
                print(("%s: %s: %s"):format(joint.name, of.title(case), wrong))
            end
        end
    end
    return rows
end

figures.case("LAW.columns", COLUMNS .. " columns of 3 to 100 corners, in any attitude, with kn from 1e8 to 1e11 Pa/m, on a joint of "
    .. "every law, made flush, dropped from a gap, under initial stress that is then gone, slid, or loaded farther out before. A load goes to "
    .. "0.5 to 1.03 of the way from the middle of the foot to its border: tilt and closure are the exact ones, and the column topples beyond "
    .. "the border only. Of laws with a bond the tilt is between that of a whole bond and that of none.", SOURCE)
for _, row in ipairs(survey(columns, columns.try, COLUMNS)) do
    figures.equal(row.name .. ": models that are wrong", row.wrong, 0)
    figures.between(row.name .. ": largest error of tilt or closure", row.worst, 0, columns.within(row.joint))
end

figures.case("LAW.inclines", INCLINES .. " blocks, 2 to 5 times as high as wide, in any attitude, with kn from 1e8 to 1e11 Pa/m, on a "
    .. "joint of every law, on an incline that is tilted in portions: they stand up to 0.98 of the slope at which an elastic joint without "
    .. "tension lets them topple, whatever dilation, cohesion or bond there is, and topple at 1.03 of it where there is no bond.", SOURCE)
for _, row in ipairs(survey(inclines, inclines.try, INCLINES)) do
    figures.equal(row.name .. ": models that are wrong", row.wrong, 0)
end

figures.case("LAW.relaxed", INCLINES .. " such blocks, to which gravity comes at once: relax tells no failure up to 0.96 of that slope, and "
    .. "no rest at 1.03 of it.", SOURCE)
for _, row in ipairs(survey(inclines, function(case, joint) return inclines.relax(case, joint) end, INCLINES)) do
    figures.equal(row.name .. ": models that are wrong", row.wrong, 0)
end
figures.finish()
