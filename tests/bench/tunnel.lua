-- tunnel.lua - the tunnel of scripts/examples from a cold start until the fall of its roof is identified. The figure is
-- the time of the whole process, which tests/bench/run.py takes.
package.path = "scripts/?.lua;" .. (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local bench = require "bench"
local tunnel = require "examples.tunnel"

local result = tunnel.identify(25)
assert(result.failed, "the wedge holds")
bench.figure { workload = "tunnel", size = result.run.cycles .. " steps", blocks = #result.model:blocks(),
    threads = 1, reuse = "on", unit = "s" }
