-- relax.lua - steps and seconds that model:relax{} takes for models of very different kinds: the table of docs/how_long.md.
--
--     talus --quiet tests/bench/relax.lua [most=10000]
--
-- `most` is the largest number of blocks of the rock, as rock.lua takes it. Seconds are of the processor, on one thread.
package.path = "scripts/?.lua;" .. (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"
local rock = require "rock"
local slope = require "examples.slope"
local tunnel = require "examples.tunnel"

local given = bench.arguments { most = 10000 }

local function row(what, model, ratio)
    local begin = os.clock()
    local run = model:relax { ratio = ratio }
    print(("%-36s %6d %-8s %6d steps %8.3f s  %s"):format(what, #model:blocks { fixed = false }, run.reason, run.cycles,
        os.clock() - begin, run.message))
    io.stdout:flush()
end

-- Bricks, each set back by a share of what makes rigid ones topple: joints that press on their edges.
local function bricks(share)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -1, 0, -0.5 }, max = { 0, 0.6, 0 }, density = 2300 })
    model:blocks():fix()
    local x = 0
    for i = 5, 1, -1 do
        local z = (5 - i) * 0.25
        x = x + share / (2 * i)
        model:generate("box", { min = { x - 1, 0, z }, max = { x, 0.6, z + 0.25 }, density = 2300 })
    end
    model:joint("*", "coulomb", { kn = 3e10, ks = 3e10, friction = 35 })
    return model
end

-- Cubes on each other.
local function column(count)
    local model = talus.model { gravity = { 0, 0, -10 } }
    for k = 0, count do
        model:generate("box", { min = { 0, 0, k - 1 }, max = { 1, 1, k }, density = 2500, group = k == 0 and "floor" or "column" })
    end
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    return model
end

-- A plate that falls on a floor, beside a cube that rests on it.
local function plate(thick, far)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", {
        { min = { 0, 0, -1 }, max = { 4, 4, 0 }, density = 2500, group = "floor" },
        { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 },
        { min = { 2, 2, far }, max = { 3, 3, far + thick }, density = 2500 } })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    return model
end

-- A cube on a plane with a friction of 35 degrees.
local function incline(dip)
    local angle = math.rad(dip)
    local model = talus.model { gravity = { 10 * math.sin(angle), 0, -10 * math.cos(angle) } }
    model:generate("box", {
        { min = { -5, 0, -1 }, max = { 50, 1, 0 }, density = 2500, group = "plane" },
        { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 } })
    model:blocks { group = "plane" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    return model
end

for _, count in ipairs { 8, 27, 125, 1000, 8000, 10000, 100000 } do
    if count <= given.most then
        row("rock", (rock.build(count, 1)))
    end
end
for _, friction in ipairs { 30, 27.6, 25 } do
    row(("slope, friction %g"):format(friction), slope.build(friction))
end
row("tunnel, friction 25", (tunnel.build(25)))
row("column", column(50))
for _, share in ipairs { 0.5, 0.9, 0.97, 0.98, 1.02 } do
    row(("bricks set back by %g"):format(share), bricks(share))
end
for _, dip in ipairs { 34.9, 36, 40 } do
    row(("cube on a plane of %g degrees"):format(dip), incline(dip))
end
for _, case in ipairs { { 1, 1 }, { 0.01, 1 }, { 0.001, 10 } } do
    row(("plate of %g m falls %g m"):format(case[1], case[2]), plate(case[1], case[2]))
end
