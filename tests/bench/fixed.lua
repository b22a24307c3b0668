-- fixed.lua - a small model and a number of steps, for counting instructions: tests/bench/instructions.py.
--
--     talus tests/bench/fixed.lua case=wall reuse=on steps=20 [folder=tests/bench]
--
-- Prints the number of contacts that carry a force. The wall is that of wall.lua with n = 4, the pile the
-- thirty hulls of pile_30.json, which still settle; in collapse they fall apart. In rest plates lie still on three tips
-- each, so that contacts go by the slopes of their force.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"
local collapse = require "collapse"
local pile = require "pile"
local wall = require "wall"

local PILE = "/pile_30.json"
local PLATES, PITCH, TURN = 16, 2, 0.35 -- number, m, rad: each is turned against the one before
local TIPS = { { -0.4, -0.3 }, { 0.45, -0.25 }, { 0.05, 0.4 } } -- m
local BASE = { { -0.1, -0.08 }, { 0.12, -0.05 }, { 0, 0.1 } }   -- of a tip, about its top, m
local HIGH, HALF, THICK = 0.2, 0.6, 0.3 -- tip, plate, m
local SUNK = 0.0165                     -- plate into its tips, about as far as at rest, m
local DENSITY, DAMPING = 2600, 0.8      -- kg/m3; share of the force
local DT = 4e-3                         -- s: as long as is stable, to be at rest soon
local STILL = 1e-5                      -- unbalanced force ratio of what rests

local function rest()
    local model = talus.model()
    for k = 1, PLATES do
        local c, s = math.cos(k * TURN), math.sin(k * TURN)
        local function turned(x, y, z)
            return { k * PITCH + c * x - s * y, s * x + c * y, z }
        end
        for _, tip in ipairs(TIPS) do
            local corners = { turned(tip[1], tip[2], 0) }
            for i, low in ipairs(BASE) do
                corners[i + 1] = turned(tip[1] + low[1], tip[2] + low[2], -HIGH)
            end
            model:generate("polyhedron", { density = DENSITY, group = "tips", vertices = corners })
        end
        local corners = {}
        for i = 0, 7 do
            corners[i + 1] = turned(i & 1 == 0 and -HALF or HALF, i & 2 == 0 and -HALF or HALF,
                (i & 4 == 0 and 0 or THICK) - SUNK)
        end
        model:generate("polyhedron", { density = DENSITY, vertices = corners })
    end
    model:blocks { group = "tips" }:fix()
    pile.laws(model)
    model:damping("local", { alpha = DAMPING })
    model:timestep { dt = DT }
    return model
end

-- Steps before those that are counted: contacts are born, begin to move, or have stayed for long enough to go by slopes.
local CASES = {
    wall = { warm = 10, build = function() return wall.build("lattice", 4, 1) end },
    pile = { warm = 10, build = function(folder) return pile.load(folder .. PILE, 1) end },
    rest = { warm = 520, build = rest, ratio = STILL },
    collapse = { warm = 100, build = function(folder) return collapse.build(folder .. PILE, 1) end },
}

local given = bench.arguments { case = "wall", reuse = "on", steps = 20, folder = "tests/bench" }
local case = CASES[given.case]
local model = case.build(given.folder)
model.reuse_geometry = given.reuse == "on"
model:cycle(case.warm)
local run = model:cycle(given.steps)
assert(run.ratio_local < (case.ratio or math.huge), string.format("it does not rest: %g", run.ratio_local))
print(model:profile().loaded)
