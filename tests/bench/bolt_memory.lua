-- bolt_memory.lua - bytes that a node of a bolt takes with all it needs: 1000 bolts of 30 nodes across a joint, put on blocks that
-- have not moved, and on blocks that have.
--
--     talus tests/bench/bolt_memory.lua
local talus = require "talus"

local BOLTS, ROW, NODES = 1000, 32, 30

local function bytes(moved)
    local model, list = talus.model { gravity = { 0, 0, 0 } }, {}
    model:generate("box", { min = { 0, 0, 0 }, max = { 40, 40, 3 }, density = 2500 })
    model:generate("joint", { joint = "J", dip = 0, dip_direction = 0, origin = { 0, 0, 1.4 } })
    model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
    if moved then
        model:blocks():set { velocity = { 1e-3, 0, 0 } }
        model:cycle(10)
    end
    for i = 0, BOLTS - 1 do
        local x, y = 0.5 + i % ROW, 0.5 + i // ROW
        list[i + 1] = { from = { x, y, 0 }, to = { x, y, 2.8 }, spacing = 0.1 }
    end
    local bolts = model:element("bolt", list)
    assert(#bolts[1].nodes == NODES)
    model:cycle(2)
    return model:memory().elements / (BOLTS * NODES)
end

print(string.format("%.0f bytes a node, on blocks that had moved %.0f", bytes(false), bytes(true)))
