-- falling.lua - the hulls of pile.lua from where they are let go, apart and over the box, until they lie still in it:
-- timed from the first hull made to the last step.
--
--     talus tests/bench/falling.lua blocks=2000 threads=1,2
--     talus tests/bench/falling.lua blocks=2000 write=falling.json
--
-- With `write` the blocks are written before they fall, and nothing is measured.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local bench = require "bench"
local pile = require "pile"

local given = bench.arguments { blocks = "2000", threads = "1", write = "" }
if given.write ~= "" then
    pile.hang(tonumber(given.blocks), 1):write_blocks(given.write)
    return
end
for _, count in ipairs(bench.list(given.blocks)) do
    for _, threads in ipairs(bench.list(given.threads)) do
        local now = bench.clock(threads)
        local began = now()
        local model = pile.drop(count, threads)
        local taken = now() - began
        bench.figure { workload = "falling", size = model.cycles .. " steps", blocks = count,
            contacts = model:profile().loaded, threads = threads, reuse = "on", rate = taken, unit = "s" }
    end
end
