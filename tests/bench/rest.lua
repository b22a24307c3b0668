-- rest.lua - steps and seconds that model:relax{} takes until it tells that a model rests, or what of it fails.
--
--     talus tests/bench/rest.lua only=wall
--
-- The slope of a newcomer is cut by two scattered sets and a fault, and nothing of it is tuned. The others are those of the
-- examples slope (friction 30 degrees) and tunnel (25 degrees), a wall of 1000 cubes that only touch when their weight comes
-- on, and the rock of rock.lua with 1000 blocks. Rows have the steps in their size; seconds are of the processor, on one
-- thread, without the making of the model. What every kind of model takes is in relax.lua.
package.path = "scripts/?.lua;" .. (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"
local rock = require "rock"
local slope = require "examples.slope"
local tunnel = require "examples.tunnel"

local RATIO = 1e-5 -- unbalanced force ratio of each block at rest
local SEED = 7

-- A slope of 40 m, of some 144 blocks, as somebody makes it who has read the tutorial.
local function newcomer()
    local model = talus.model { gravity = { 0, 0, -9.81 }, seed = SEED }
    model:generate("profile", { from = 0, to = 16, density = 2650,
        section = { { 0, -15 }, { 100, -15 }, { 100, 0 }, { 60, 0 }, { 35, 40 }, { 0, 40 } } })
    model:generate("jointset", { joint = "J1", dip = 48, dip_direction = 90, dip_dev = 4, dip_direction_dev = 6,
        distribution = "normal", spacing = 6, spacing_dev = 1, number = 25, origin = { 45, 8, 10 } })
    model:generate("jointset", { joint = "J2", dip = 80, dip_direction = 270, dip_dev = 5, dip_direction_dev = 8,
        distribution = "normal", spacing = 8, spacing_dev = 1, number = 25, origin = { 45, 8, 10 } })
    model:generate("joint", { joint = "fault", dip = 38, dip_direction = 100, origin = { 58, 8, 2 } })
    model:boundary { xmin = "roller", xmax = "roller", ymin = "roller", ymax = "roller", zmin = "fixed" }
    model:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 60 })
    return model
end

-- Unit cubes face to face, n in each direction, on a fixed plate.
local function wall(n)
    local model, boxes = talus.model { gravity = { 0, 0, -10 } }, {}
    for i = 0, n ^ 3 - 1 do
        local x, y, z = i % n, i // n % n, i // (n * n)
        boxes[#boxes + 1] = { min = { x, y, z }, max = { x + 1, y + 1, z + 1 } }
    end
    boxes[#boxes + 1] = { min = { -1, -1, -1 }, max = { n + 1, n + 1, 0 }, fixed = true }
    bench.boxes(model, boxes, 2500)
    model:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 35 })
    return model
end

local CASES = {
    { "newcomer", newcomer },
    { "slope", function() return slope.build(30) end },
    { "tunnel", function() return (tunnel.build(25)) end },
    { "wall", function() return wall(10) end },
    { "rock", function() return (rock.build(1000, 1)) end },
}

local given = bench.arguments { only = "" }
for _, case in ipairs(CASES) do
    if given.only == "" or given.only == case[1] then
        local model = case[2]()
        local began = os.clock()
        local run = model:relax { ratio = RATIO, measure = "local" }
        bench.figure { workload = "rest " .. case[1], size = ("%d steps to %s"):format(run.cycles, run.reason),
            blocks = #model:blocks { fixed = false }, threads = 1, rate = os.clock() - began, unit = "s" }
    end
end
