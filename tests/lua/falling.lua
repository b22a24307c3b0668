-- falling.lua - scenes in which blocks fall, slide and strike with friction, and how well the energy ledger closes.
--
-- Each scene gives the model, ready to run without damping at a tenth of the critical step, and the time to run. tray:
-- stones, hulls of 8 corners, fall into a tray. dominoes: slabs, the first of which is pushed. heap: a pile of hulls at
-- rest, the walls of whose box are taken away. shaken: the same pile, its box shaken.
local talus = require "talus"
local shapes = require "shapes"

local falling = {}

local DENSITY, FRICTION = 2500, 30 -- kg/m3, degrees
local FRACTION = 0.1               -- of the critical step
local LOOKS = 200                  -- at the ledger in a run
local PILE = "tests/bench/pile_30.json"
local SETTLE = 3000                -- steps that a pile has to come to rest at its stiffness

-- Largest error of the ledger, of its largest term: of trays, of the other scenes.
falling.TRAY, falling.OTHERS = 2e-3, 5e-3

local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

local function box(model, min, max, group)
    model:generate("box", { min = min, max = max, density = DENSITY, group = group })
end

local function begin(model, kn, held)
    model:joint("*", "coulomb", { kn = kn, ks = kn / 2, friction = FRICTION })
    model:blocks { group = held }:fix()
    model:timestep { fraction = FRACTION }
    return model
end

-- `layers` times `side` times `side` stones of 0.8 m, one metre apart. Six layers of five by five are 150.
function falling.tray(kn, seed, side, layers)
    local random, model = shapes.random(seed), talus.model {}
    local half = side / 2 + 0.1
    local outer, high = half + 0.4, layers + 1
    box(model, { -outer, -outer, -1 }, { outer, outer, 0 }, "tray")
    box(model, { -outer, -outer, 0 }, { -half, outer, high }, "tray")
    box(model, { half, -outer, 0 }, { outer, outer, high }, "tray")
    box(model, { -half, -outer, 0 }, { half, -half, high }, "tray")
    box(model, { -half, half, 0 }, { half, outer, high }, "tray")
    for k = 0, layers - 1 do
        for i = 0, side - 1 do
            for j = 0, side - 1 do
                local centre = { i - (side - 1) / 2, j - (side - 1) / 2, k + 0.5 }
                model:generate("polyhedron", { density = DENSITY, group = "stone",
                    vertices = shapes.placed(shapes.hull(random, 8, 0.42), NONE, centre) })
            end
        end
    end
    return begin(model, kn, "tray"), 1
end

function falling.dominoes(kn, seed)
    local random, model = shapes.random(seed), talus.model {}
    local slabs, thick, high = 20, 0.2, 2
    box(model, { -5, -5, -1 }, { 25, 5, 0 }, "floor")
    for k = 0, slabs - 1 do
        local x, skew = 0.7 * k + random(-0.05, 0.05), random(-0.1, 0.1)
        local turned = shapes.placed(shapes.box(thick, 1, high), shapes.turn({ 0, 0, 1 }, skew), { x, 0, high / 2 })
        model:generate("polyhedron", { vertices = turned, density = DENSITY, group = k == 0 and "first" or "slab" })
    end
    model:blocks { group = "first" }:set { velocity = { high / 2, 0, 0 }, angular_velocity = { 0, 1, 0 } }
    return begin(model, kn, "floor"), 3
end

-- The pile of 30 hulls in a box, at rest.
local function pile(kn)
    local model = talus.model {}
    model:generate("blocks", { file = PILE })
    model:blocks { fixed = true }:set { group = "box" }
    begin(model, kn, "box")
    model:timestep { fraction = 0.5 }
    model:damping("local", { alpha = 0.7 })
    model:cycle(SETTLE)
    model:damping "none"
    model:timestep { fraction = FRACTION }
    return model
end

function falling.heap(kn)
    local model = pile(kn)
    local low = math.huge
    for _, block in ipairs(model:blocks { group = "box" }) do
        low = math.min(low, block.centroid[3])
    end
    model:blocks { group = "box", where = function(b) return b.centroid[3] > low end }:delete()
    return model, 0.8
end

function falling.shaken(kn, seed)
    local random, model = shapes.random(seed), pile(kn)
    local level, rate, start, way = random(0.4, 0.6), random(18, 22), model.time, random(0, 6.28)
    model:blocks { group = "box" }:drive { velocity = function(t)
        local v = level * math.sin(rate * (t - start))
        return v * math.cos(way), v * math.sin(way), 0.3 * v
    end }
    return model, 0.8
end

-- Runs a scene; gives the worst balance of the ledger, the last one, the steps, the share of energy turned to heat and
-- the largest overlap.
function falling.run(model, time)
    local start, worst, overlap, steps = model.time, 0, 0, model.cycles
    for look = 1, LOOKS do
        model:solve { ratio = 0, max_time = math.max(1e-9, start + look * time / LOOKS - model.time) }
        worst = math.max(worst, math.abs(model:energy().balance))
        overlap = math.max(overlap, #model:contacts() > 0 and -model:contacts():min "gap" or 0)
    end
    local energy = model:energy()
    local largest = math.max(energy.kinetic, math.abs(energy.potential), math.abs(energy.external), energy.friction)
    return { worst = worst, last = math.abs(energy.balance), steps = model.cycles - steps, heat = energy.friction / largest,
        overlap = overlap }
end

return falling
