-- shake.lua - a wall of wall.lua whose base, with all that is fixed, is driven to and fro.
--
--     talus tests/bench/shake.lua layout=bond n=10 threads=1,2
--
-- The stretches that are measured make one period.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local bench = require "bench"
local wall = require "wall"

local SPEED, FREQUENCY = 0.1, 2           -- m/s, Hz
local DAMPING = 0.05                      -- share of the force
local WARM, STEPS, STRETCHES = 500, 250, 10

local function build(layout, n, threads)
    local model = wall.build(layout, n, threads)
    if layout == "bond" then
        wall.settle(model)
    end
    model:damping("local", { alpha = DAMPING })
    local began = model.time
    model:blocks { fixed = true }:drive { velocity = function(t)
        return SPEED * math.sin(2 * math.pi * FREQUENCY * (t - began)), 0, 0
    end }
    return model
end

local given = bench.arguments { layout = "lattice", n = "10", threads = "1" }
for _, n in ipairs(bench.list(given.n)) do
    for _, threads in ipairs(bench.list(given.threads)) do
        bench.measure_moving(function()
            return build(given.layout, n, threads)
        end, { workload = given.layout == "bond" and "shake bond" or "shake wall", size = n * n * n },
            { warm = WARM, steps = STEPS, reps = STRETCHES })
    end
end
