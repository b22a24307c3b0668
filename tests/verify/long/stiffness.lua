-- Stacks of boxes under stress, on joints of every law: where nothing slips the stiffness is symmetric, and nothing turns to heat.
-- tests/lua/test_symmetric_stiffness.lua does the same with some scenes, and lets blocks swing.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local every_law = require "every_law"
local figures = require "check_figures"
local stiffness = require "stiffness"

local MODELS = 300 -- of each law
local ASYMMETRY = 1e-8 -- over the largest entry
-- Of a law that mobilises its friction as it slips: points that have hardly moved slip. Of the energy that is stored.
local MOBILISED, ROUNDING = 1e-6, 1e-15

local rows = {}
for number = 1, MODELS do
    local case = stiffness.draw(number)
    for k, joint in ipairs(every_law(case.kn, case.kn * case.state.closure)) do
        local row = rows[k] or { joint = joint, asymmetry = 0, heat = 0 }
        rows[k] = row
        if not joint.yields then
            local asymmetry, heat = stiffness.try(case, joint)
            row.asymmetry, row.heat = math.max(row.asymmetry, asymmetry), math.max(row.heat, math.abs(heat))
        end
    end
end

figures.case("LAW.stiffness", MODELS .. " stacks of three boxes in any attitude, with kn from 1e8 to 1e11 Pa/m, under a random stress of 1e-3 or 0.1 "
    .. "of kn times 1 m, moved a little, on joints of every law but those whose shear yields from the first: the tangent stiffness matrix, by central "
    .. "differences, is symmetric, and nothing turns to heat.", "a potential has a symmetric matrix of second derivatives")
for _, row in ipairs(rows) do
    if not row.joint.yields then
        figures.between(row.joint.name .. ": largest asymmetry, of the largest entry", row.asymmetry, 0, ASYMMETRY)
        figures.between(row.joint.name .. ": heat, of the energy that is stored", row.heat, 0,
            row.joint.law == "barton_bandis" and MOBILISED or ROUNDING)
    end
end
figures.finish()
