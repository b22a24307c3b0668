-- Blocks that have no common volume do not press on each other: random cut, tunnelled, joined and unjoined rock, fresh
-- and after it has moved (tests/verify/long/common_volume.lua does the same for many more). Without gravity nothing
-- moves.
-- program only: the models are the same ones with a stock Lua.
package.path = "tests/lua/?.lua;" .. package.path -- run in the source root
local check = require "check"
local common = require "common_volume"

local MODELS = check.cases(100)
local AT_REST = 1e-9 -- m/s

local function no_false_contacts(model, seed, when)
    local count, first = common.false_contacts(model)
    check.holds(count == 0, string.format("seed %d, %s: %d false contacts: %s", seed, when, count, tostring(first)))
end

for seed = 1, MODELS do
    local model = common.rock(seed, false)
    model:cycle(30)
    no_false_contacts(model, seed, "at rest")
    check.holds(model:blocks():max "speed" < AT_REST, string.format("seed %d: nothing moves without force", seed))
    model = common.rock(seed, true)
    model:cycle(1)
    no_false_contacts(model, seed, "fresh")
    model:cycle(200)
    no_false_contacts(model, seed, "after 200 steps")
end
