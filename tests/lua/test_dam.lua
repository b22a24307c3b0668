-- The dam of the examples against statics: uplift and reservoir to rounding, keyblocks to rounding before it has settled (then it leans by
-- some 1e-5), strength reduction to 1 %.
local check = require "check"
package.path = "scripts/?.lua;" .. package.path
local dam = require "examples.dam"

for _, case in ipairs(dam.cases) do
    local before = dam.build(case):keyblocks { friction = case.friction, cohesion = case.cohesion }
    check.near(before[1].safety, dam.statics(case).factor, 1e-9)
    local r = dam.run(case)
    check.near(r.uplift, r.expected.uplift, 1e-5 * 6.08e6 + 1e-9)
    check.near(r.keyblock, r.expected.factor, 5e-5) -- where it has settled
    check.near(r.factor, r.expected.factor, 0.01 * r.expected.factor)
end
-- Figures of an independent calculation.
check.near(dam.statics(dam.cases[1]).factor, 1.28531855956, 1e-10)
check.near(dam.statics(dam.cases[2]).factor, 1.44741421246, 1e-10)
