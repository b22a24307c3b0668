-- Hundreds of small models of each law in which boxes are kicked and rock on their foot. Nothing makes or loses energy, and no more comes
-- back than was put in. tests/lua/test_rocking_dilation.lua does a little of it.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local every_law = require "every_law"
local rocking_boxes = require "rocking_boxes"

local MODELS = 300             -- of each law, at the least
local FRACTION = 0.05          -- of the critical step
local BALANCE, MADE = 1e-3, 1e-3 -- of the largest term of the energy; of the kick
local KN, PRESSURE = 1e9, 1e5  -- Pa/m; Pa, of the strengths

local joints, sets = every_law(KN, PRESSURE), {}
for _, joint in ipairs(joints) do
    sets[joint.law] = (sets[joint.law] or 0) + 1
end

figures.case("D.rocking_boxes", "boxes that are kicked and rock, 300 models of each law", "conservation of energy")
for k, joint in ipairs(joints) do
    local balance, made = 0, 0
    for seed = 1, math.ceil(MODELS / sets[joint.law]) do
        local result = rocking_boxes.run(joint, 1000 * k + seed, FRACTION)
        balance, made = math.max(balance, result.balance), math.max(made, result.made)
    end
    figures.between(joint.name .. ": worst energy balance, of the largest term", balance, 0, BALANCE)
    figures.between(joint.name .. ": most energy made, of the kick", made, 0, MADE)
end
figures.finish()
