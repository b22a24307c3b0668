-- slope.lua - the slope of scripts/examples from a cold start until its failure is identified. The figure is the time
-- of the whole process, which tests/bench/run.py takes.
package.path = "scripts/?.lua;" .. (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local bench = require "bench"
local slope = require "examples.slope"

local result = slope.identify(25, 4)
assert(result.failed, "the slope holds")
bench.figure { workload = "slope", size = result.run.cycles .. " steps", blocks = #result.model:blocks(),
    threads = 1, reuse = "on", unit = "s" }
