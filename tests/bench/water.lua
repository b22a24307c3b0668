-- water.lua - what a water table costs in a step, at rest and while blocks move: n^3 cubes in a trough that is held or shakes.
--
--     talus tests/bench/water.lua n=5
--
-- Prints microseconds a step without water and with it, medians of stretches in turn, and how much longer it is. The sides of
-- the trough bear the water's thrust, so that joints are closed in both models: what opens costs more with any load.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local bench = require "bench"
local talus = require "talus"

local STEPS, STRETCHES = 50, 7

local function build(n, water, speed)
    local model, list = talus.model { gravity = { 0, 0, -10 } }, {}
    for z = 0, n do
        for y = 0, z == 0 and 0 or n - 1 do
            for x = 0, z == 0 and 0 or n - 1 do
                list[#list + 1] = z == 0 and { min = { -1, -1, -1 }, max = { n + 1, n + 1, 0 }, density = 2500, group = "base" }
                    or { min = { x, y, z - 1 }, max = { x + 1, y + 1, z }, density = 2500 }
            end
        end
    end
    for side = -1, n, n + 1 do
        list[#list + 1] = { min = { side, -1, 0 }, max = { side + 1, n + 1, n }, density = 2500, group = "base" }
        list[#list + 1] = { min = { 0, side, 0 }, max = { n, side + 1, n }, density = 2500, group = "base" }
    end
    model:generate("box", list)
    model:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 35 })
    local base = model:blocks { group = "base" }
    base:fix()
    model:damping "local"
    if water then
        model:water("table", { level = n / 2 })
    end
    model:relax { ratio = 1e-6 }
    model:timestep { dt = 2e-4 }
    if speed > 0 then
        base:drive { velocity = function(t)
            return speed * math.sin(4 * math.pi * t), 0, 0
        end }
    end
    model:cycle(200)
    return model
end

local function step(model)
    local began = os.clock()
    model:cycle(STEPS)
    return (os.clock() - began) / STEPS * 1e6
end

local function median(list)
    table.sort(list)
    return list[(#list + 1) // 2]
end

local given = bench.arguments { n = "5" }
for _, n in ipairs(bench.list(given.n)) do
    for _, speed in ipairs { 0, 1e-2, 0.1 } do
        local dry, wet = build(n, false, speed), build(n, true, speed)
        local without, with = {}, {}
        for k = 1, STRETCHES do
            without[k], with[k] = step(dry), step(wet)
        end
        local a, b = median(without), median(with)
        print(("%d blocks, base at %g m/s: %.0f us a step, with water %.0f: %+.0f %%"):format(n ^ 3, speed, a, b, 100 * (b / a - 1)))
    end
end
