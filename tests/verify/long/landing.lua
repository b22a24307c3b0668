-- Hundreds of small models of each law in which boxes land and tumble. Nothing makes or loses energy, and nothing goes through
-- anything. tests/lua/test_landing.lua does a little of it.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local every_law = require "every_law"
local landing = require "landing"

local MODELS = 300       -- of each law, at the least
local FRACTION = 0.1     -- of the critical step: impacts are to be resolved
local BALANCE = 1e-3     -- of the largest term of the energy
local KN, STIFF, EVERY = 1e9, 1e10, 4 -- Pa/m: every fourth model is stiff
local PRESSURE = 1e5     -- Pa, of the strengths

local joints, stiff, sets = every_law(KN, PRESSURE), every_law(STIFF, PRESSURE), {}
for _, joint in ipairs(joints) do
    sets[joint.law] = (sets[joint.law] or 0) + 1
end

figures.case("D.landing", "boxes that land on a floor and on each other and tumble, 300 models of each law", "conservation of energy")
for k, joint in ipairs(joints) do
    local balance, depth = 0, 0
    for seed = 1, math.ceil(MODELS / sets[joint.law]) do
        local hard = seed % EVERY == 0
        local result = landing.run(hard and stiff[k] or joint, 1000 * k + seed, hard and STIFF or KN, FRACTION)
        balance, depth = math.max(balance, result.balance), math.max(depth, result.depth)
    end
    figures.between(joint.name .. ": worst energy balance, of the largest term", balance, 0, BALANCE)
    figures.between(joint.name .. ": deepest overlap, of what the energy allows", depth, 0, 1)
end
figures.finish()
