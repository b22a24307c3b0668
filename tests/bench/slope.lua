-- slope.lua - a slope cut by three joint sets that slides on its bedding.
--
--     talus tests/bench/slope.lua blocks=5000 threads=1,2
--
-- A box with a face of 60 degrees, over a base of 30 degrees parallel to the bedding, which is steeper than the friction
-- of its joints: from the first step on the slope slides, undamped. The number of blocks is about that asked for; they
-- are 0.85 m wide on average. The step is that of the dynamics: the few slivers, which would make it a thousand times as
-- short, get inertia instead.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"

local FACE = { dip = 60, dip_direction = 270, origin = { 4, 0, 2 } }
local BASE = { dip = 30, dip_direction = 270, origin = { 5.5, 0, 4 } }
local SETS = { { joint = "bed", dip = 30, dip_direction = 270 },
    { joint = "cross", dip = 85, dip_direction = 0 },
    { joint = "back", dip = 72, dip_direction = 90 } }
local DISPERSION = 1                      -- deg, of dip and dip direction
local SPACING, DEVIATION = 0.85, 0.1      -- m
local LONG = 1.5                          -- length of the box over its width and height
local SHARE = 0.76                        -- blocks a cubic metre of a cube as wide as the box: what face and base leave
local SEED = 3
local DENSITY, KN, KS, FRICTION = 2600, 1e9, 5e8, 20
local DT, ADDED = 8e-5, 0.01              -- s; mass that slivers may get, as a share of all
local SLIDES = 0.05                       -- m/s, mean speed
local WARM, STEPS, STRETCHES = 250, 20, 10

local function plane(joint, at)
    return { joint = joint, dip = at.dip, dip_direction = at.dip_direction, origin = at.origin }
end

local function build(count, threads)
    local side = math.floor((count / SHARE) ^ (1 / 3) + 0.5)
    local model = talus.model { threads = threads, seed = SEED }
    model:generate("box", { min = { 0, 0, 0 }, max = { LONG * side, side, side }, density = DENSITY })
    model:generate("joint", plane("face", FACE))
    model:blocks { above = FACE }:delete()
    model:generate("joint", plane("base", BASE))
    model:blocks { below = BASE }:set { group = "base" }
    model:blocks { group = "base" }:fix():hide()
    for _, set in ipairs(SETS) do
        model:generate("jointset", { joint = set.joint, dip = set.dip, dip_direction = set.dip_direction,
            dip_dev = DISPERSION, dip_direction_dev = DISPERSION, spacing = SPACING,
            spacing_dev = DEVIATION, number = 3 * side,
            origin = { LONG * side / 2, side / 2, side / 2 } })
    end
    model:blocks { hidden = true }:show()
    model:joint("*", "coulomb", { kn = KN, ks = KS, friction = FRICTION })
    model:damping "none"
    model:timestep { rule = "body", fraction = 0.5 }
    model:mass_scaling { dt = DT, most = ADDED }
    return model
end

local given = bench.arguments { blocks = "5000", threads = "1" }
for _, count in ipairs(bench.list(given.blocks)) do
    for _, threads in ipairs(bench.list(given.threads)) do
        local model = bench.measure_moving(function()
            return build(count, threads)
        end, { workload = "slope", size = count }, { warm = WARM, steps = STEPS, reps = STRETCHES })
        local pieces = model:blocks { fixed = false }
        assert(pieces:sum "speed" / #pieces > SLIDES, "the slope does not slide")
    end
end
