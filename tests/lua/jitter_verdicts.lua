-- jitter_verdicts.lua - random walls, arches and domes of which it is known whether they stand, with stones that are a little off.
--
-- Every corner of every stone is moved at random. The stones are written into a file and imported, which makes their faces plane, and
-- seated. They stand or fall as the stones that fit exactly, with the same thrust.
--
--     jitter_verdicts.kinds                     "arch", "wall", "dome"
--     local case = jitter_verdicts.draw(seed)   kind, and whether it stands
--     case:exact()                              reason of model:relax, and thrust, N, of stones that fit
--     case:moved(jitter)                        the same of stones whose corners are off by that share of a stone's size
--
-- Arches are semicircular. Without friction's limit the least thickness over the mean radius is 0.1075, and some per cent less of few stones.
-- The thrust is of an arch the horizontal force of its springer, of a dome what its lowest ring takes outward, and of a wall what its
-- lowest course takes along it.
local jittered = require "jittered"
local shapes = require "shapes"
local talus = require "talus"

local jitter_verdicts = { kinds = { "arch", "wall", "dome" } }

local DENSITY, GRAVITY, KN = 2500, 10, 1e10
local RATIO = 1e-7

local draws, builds, thrusts = {}, {}, {}

function draws.arch(random, stands)
    local mean = random(2, 8)
    local share = stands and random(0.125, 0.2) or random(0.05, 0.085)
    return { count = math.floor(random(9, 22)), inner = mean * (1 - share / 2), outer = mean * (1 + share / 2), width = mean * random(0.05, 0.2),
        friction = random(45, 60), down = { 0, 0, -1 } }
end

function builds.arch(model, o)
    o.springers = true
    jittered.arch(model, o)
end

local function held(model)
    return model:blocks { fixed = true }
end

-- The force of its contacts on a held block, {x, y, z}.
local function force_on(model, block)
    return model:blocks { id = block.id }:reaction()
end

function thrusts.arch(model)
    return math.abs(force_on(model, held(model)[1])[1])
end

-- On a table tilted along the wall, less steep than friction or steeper.
function draws.wall(random, stands)
    local friction = random(25, 40)
    local tilt = math.rad(stands and random(0.2, 0.5) * friction or friction + random(4, 10))
    return { friction = friction, courses = math.floor(random(3, 6)), length = math.floor(random(2, 5)), down = { math.sin(tilt), 0, -math.cos(tilt) } }
end

builds.wall = jittered.wall

function thrusts.wall(model)
    local sum = 0
    for _, block in ipairs(held(model)) do
        sum = sum + force_on(model, block)[1]
    end
    return math.abs(sum)
end

-- Half of a sphere without its crown; on its side and on smoother joints it falls.
function draws.dome(random, stands)
    local mean, share, tilt = random(3, 6), random(0.12, 0.2), math.rad(stands and 0 or random(60, 80))
    return { friction = stands and random(40, 50) or random(10, 20), inner = mean * (1 - share / 2), outer = mean * (1 + share / 2), rings = 3,
        around = math.floor(random(8, 13)), down = { math.sin(tilt), 0, -math.cos(tilt) } }
end

builds.dome = jittered.dome

function thrusts.dome(model)
    local sum = 0
    for _, block in ipairs(held(model)) do
        local f, at = force_on(model, block), block.centroid
        sum = sum + (f[1] * at[1] + f[2] * at[2]) / math.sqrt(at[1] ^ 2 + at[2] ^ 2)
    end
    return math.abs(sum)
end

local function verdict(case, options)
    local down, o = case.values.down, { random = jittered.random(case.seed), density = DENSITY }
    for key, value in pairs(case.values) do
        o[key] = value
    end
    for key, value in pairs(options) do
        o[key] = value
    end
    local model = talus.model { gravity = { GRAVITY * down[1], GRAVITY * down[2], GRAVITY * down[3] }, seed = case.seed }
    builds[case.kind](model, o)
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = o.friction })
    if o.jitter > 0 then
        model:seat { gap = 0.05 * o.size, overlap = 0.05 * o.size }
    end
    local reason = model:relax { ratio = RATIO }.reason
    return reason, reason == "rest" and thrusts[case.kind](model) or 0
end

function jitter_verdicts.draw(seed)
    local random = shapes.random(seed)
    local kind, stands = jitter_verdicts.kinds[seed % 3 + 1], seed // 3 % 2 == 0
    return {
        kind = kind, stands = stands, seed = seed, values = draws[kind](random, stands),
        exact = function(self) return verdict(self, { jitter = 0 }) end,
        moved = function(self, jitter) return verdict(self, { jitter = jitter, imported = true }) end,
    }
end

return jitter_verdicts
