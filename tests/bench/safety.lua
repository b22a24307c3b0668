-- safety.lua - what a factor of safety costs, and a map of them.
--
--     talus tests/bench/safety.lua factor=slope,4,2.5,1.8 map=4,1.75 workers=1
--
-- The slope is that of the examples, 49 blocks with joints of 1e7 Pa/m. Numbers are spacings of the joints of the bench of
-- tests/lua/cut_bench.lua: 168 free blocks for 4 m, 966 for 1.8 m and 1,039 for 1.75 m. Factors are found to 1 %, with
-- least_volume = 0.1 m3; a map goes from 1 to 3 by steps of 0.02. Seconds are those of this process, with several workers those of
-- the clock. The second row of each has the steps of all trials.
local HERE = arg[0]:match "^(.*)/" or "."
package.path = HERE .. "/?.lua;" .. HERE .. "/../lua/?.lua;" .. HERE .. "/../../scripts/?.lua;" .. package.path
local bench = require "bench"
local cut_bench = require "cut_bench"
local slope = require "examples.slope"

local SEED, FRICTION = 2, 35 -- of the bench; degrees
local SLOPE_FRICTION, SLOPE_STIFFNESS = 30, 1e7 -- degrees, Pa/m

local function build(size)
    if size ~= "slope" then
        return cut_bench.build(tonumber(size), SEED, FRICTION), { from = 0.1, to = 20, resolution = 0.01, least_volume = 0.1 }
    end
    local model = slope.build(SLOPE_FRICTION)
    model:joint("*", { kn = SLOPE_STIFFNESS, ks = SLOPE_STIFFNESS })
    return model, { from = 1, to = 1.5, resolution = 0.002 }
end

local given = bench.arguments { factor = "slope,4,2.5,1.8", map = "slope,4,1.75", workers = "1" }
local workers = math.tointeger(given.workers) or math.tointeger(tonumber(given.workers))
local clock = bench.clock(workers)

local function time(what, size, model, options)
    options.workers = workers
    local began = clock()
    local found = model[what](model, options)
    local seconds = clock() - began
    local blocks = #model:blocks { fixed = false }
    assert(found.undecided == 0, "a trial is undecided")
    bench.figure { workload = what, size = size, blocks = blocks, threads = workers, rate = seconds, unit = "s" }
    bench.figure { workload = what, size = size, blocks = blocks, threads = workers, rate = found.cycles, unit = "steps" }
end

for size in tostring(given.factor):gmatch "[^,]+" do
    time("factor_of_safety", size, build(size))
end
for size in tostring(given.map):gmatch "[^,]+" do
    time("safety_map", size, (build(size)), { from = 1, to = 3, step = 0.02 })
end
