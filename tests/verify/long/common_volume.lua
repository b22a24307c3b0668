-- Random cut, tunnelled, joined and unjoined rock: no contact presses where blocks have no common volume, and nothing
-- moves without force. tests/lua/test_common_volume.lua does the same for the first seeds.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local common = require "common_volume"

local MODELS = 2000
local AT_REST = 1e-9 -- m/s

figures.case("common_volume", string.format("%d random models cut by joint sets and tunnels, with joined bodies",
    MODELS), "a brute-force search for a separating plane, with each block pair's vertices")
local counts = { moving = 0, fresh = 0, fallen = 0 }
for seed = 1, MODELS do
    local model = common.rock(seed, false)
    model:cycle(30)
    counts.moving = counts.moving + (model:blocks():max "speed" < AT_REST and 0 or 1)
    model = common.rock(seed, true)
    model:cycle(1)
    counts.fresh = counts.fresh + common.false_contacts(model)
    model:cycle(200)
    counts.fallen = counts.fallen + common.false_contacts(model)
end
figures.equal("models that move without gravity in 30 steps", counts.moving, 0)
figures.equal("false contacts of fresh models", counts.fresh, 0)
figures.equal("false contacts after 200 steps under gravity", counts.fallen, 0)
figures.finish()
