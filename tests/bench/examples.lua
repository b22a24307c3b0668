-- examples.lua - an example of scripts/examples from a cold start until its failure is identified. The figure is the
-- time of the whole process, which tests/bench/run.py takes.
--
--     talus tests/bench/examples.lua example=slope
package.path = "scripts/?.lua;" .. (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local bench = require "bench"

local EXAMPLES = {
    slope = function() return require "examples.slope".identify(25, 4) end,
    tunnel = function() return require "examples.tunnel".identify(25) end,
}

local given = bench.arguments { example = "slope" }
local result = EXAMPLES[given.example]()
assert(result.failed, "it holds")
bench.figure { workload = "example " .. given.example, size = result.run.cycles .. " steps",
    blocks = #result.model:blocks(), threads = 1, reuse = "on", unit = "s" }
