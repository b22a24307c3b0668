-- quiet.lua - what a node of a quiet face costs in a step: n x n blocks that drift apart from each other, with a quiet face
-- below or without.
--
--     talus tests/bench/quiet.lua n=20,60
--
-- Prints ns of processor time for each node, the least of some stretches.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local bench = require "bench"
local talus = require "talus"

local WARM, STEPS, STRETCHES = 50, 100, 7

-- s of a step
local function step(n, quiet)
    local model, list = talus.model { gravity = { 0, 0, 0 } }, {}
    for i = 0, n * n - 1 do
        local x, y = i % n, i // n
        list[i + 1] = { min = { x, y, 0 }, max = { x + 0.9, y + 0.9, 1 }, density = 2500 }
    end
    model:generate("box", list)
    model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
    model:blocks():set { velocity = { 1e-3, 1e-4, 1e-3 } }
    if quiet then
        model:boundary { zmin = { quiet = true } }
    end
    model:timestep { dt = 1e-5 }
    model:cycle(WARM)
    local best = math.huge
    for _ = 1, STRETCHES do
        local began = os.clock()
        model:cycle(STEPS)
        best = math.min(best, os.clock() - began)
    end
    return best / STEPS
end

local given = bench.arguments { n = "60" }
for _, n in ipairs(bench.list(given.n)) do
    local without, with = step(n, false), step(n, true)
    print(string.format("%d nodes: %.1f ns a node and step", 3 * n * n, (with - without) / (3 * n * n) * 1e9))
end
