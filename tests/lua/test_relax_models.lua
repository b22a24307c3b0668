-- The random models of verify/long/relax are the same for a seed in any order, and a factor changes what it says only.
package.path = (os.getenv("TALUS_SOURCE_DIR") or ".") .. "/tests/lua/?.lua;" .. package.path
local check = require "check"
local models = require "relax_models"

local MODELS = 60

local hashes, kinds, blocks = {}, {}, 0
for seed = 1, MODELS do
    local model, about = models.build(seed)
    hashes[seed] = model:state_hash() .. about.text
    kinds[about.kind] = true
    blocks = math.max(blocks, #model:blocks())
    check.holds(#model:blocks() >= 2 and #about.stages >= 1, about.text)
end
check.holds(blocks <= 90, "a block too many")
local count = 0
for _ in pairs(kinds) do
    count = count + 1
end
check.holds(count >= 10, "kinds of models")
for seed = MODELS, 1, -7 do
    local model, about = models.build(seed)
    check.equal(model:state_hash() .. about.text, hashes[seed])
    local other, of_other = models.build(seed, { friction = 0.99 })
    check.equal(#other:blocks(), #model:blocks())
    check.equal(of_other.text, about.text)
end
