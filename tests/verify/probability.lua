-- Probability of failure of a block on a plane, by realisations whose factor of safety is that of keyblocks; intervals
-- of probabilities; back-analysis.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_site"

local plane, chance = reference.plane, reference.probability
local EXACT = 1e-9 -- relative: closed forms on a block whose corners are rounded

local s, c = math.sin(math.rad(plane.dip)), math.cos(math.rad(plane.dip))

-- The prism on a held base.
local function build()
    local model = talus.model { gravity = { 0, 0, -plane.gravity } }
    model:generate("box", { min = { 2, 0, 0 }, max = { 10, 1, 12 }, density = plane.density })
    model:generate("joint", { joint = "plane", dip = plane.dip, dip_direction = plane.dip_direction,
        origin = { 0, 0, 0 } })
    model:blocks { below = { dip = plane.dip, dip_direction = plane.dip_direction, origin = { 0, 0, 0 } } }:fix()
    return model
end

-- The factor of safety with water in the crack up to a depth: its thrust and uplift act as a further acceleration.
local function safety(model, friction, cohesion, depth)
    local thrust, uplift = plane.V * (depth / plane.crack) ^ 2, plane.U * depth / plane.crack
    local mass = plane.weight / plane.gravity
    local list = model:keyblocks { friction = friction, cohesion = cohesion,
        gravity = { (-thrust - uplift * s) / mass, 0, -plane.gravity + uplift * c / mass } }
    return #list > 0 and list[1].safety or math.huge
end

local model = build()
figures.case("PF.plane.friction", "A block on a plane whose friction is normal: probability that it slides.",
    chance.friction.source)
figures.relative("factor of safety, dry, 40 degrees", safety(model, 40, 0, 0), plane.safety_dry_40, EXACT)
figures.relative("factor of safety, full, 45 degrees", safety(model, 45, 0, plane.crack), plane.safety_full_45, EXACT)

local function one(number, latin)
    return talus.realisations { number = number, seed = 5, latin = latin,
        build = build,
        measure = function(m, draw)
            local friction = draw.normal("friction", chance.friction.mean, chance.friction.sd, { min = 0, max = 90 })
            return { failed = safety(m, friction, 0, 0) < 1 }
        end }
end

local p = chance.friction.probability
local N = 1000
local spread = one(N, true)
local hits = spread:probability "failed" * N
figures.near("Latin hypercube: rows of 1000 that slide", hits, p * N, 1)
local free = one(N, false)
figures.near("independent draws: probability", (free:probability "failed"), p, 3 * math.sqrt(p * (1 - p) / N))
figures.near("mean friction of the hypercube", spread:mean "friction", chance.friction.mean, 0.01)
figures.near("its deviation", spread:sd "friction", chance.friction.sd, 0.03)

figures.case("PF.plane.three", "The same with friction, cohesion and depth of water at random: probability, moments of "
    .. "the factor of safety, and its correlation with each.", chance.three.source)
local three = chance.three
local ROWS = 2000
local set = talus.realisations { number = ROWS, seed = 7, latin = true, build = build,
    measure = function(m, draw)
        local f = safety(m, draw.normal("friction", three.friction[1], three.friction[2]),
            draw.lognormal("cohesion", three.cohesion[1], three.cohesion[2]), draw.uniform("water", 0, plane.crack))
        return { failed = f < 1, safety = f }
    end }
figures.near("probability", (set:probability "failed"), three.probability,
    3 * math.sqrt(three.probability * (1 - three.probability) / ROWS))
figures.near("mean factor of safety", set:mean "safety", three.mean, 3 * three.sd / math.sqrt(ROWS))
figures.near("its deviation", set:sd "safety", three.sd, 3 * three.sd / math.sqrt(2 * ROWS))
for _, item in ipairs(set:sensitivity "safety") do
    local r = three.correlation[item.name]
    figures.near("correlation with " .. item.name, item.correlation, r, 3 * (1 - r * r) / math.sqrt(ROWS))
end
local histogram = set:histogram("safety", 40)
local x, y = {}, {}
for i, count in ipairs(histogram.counts) do
    x[i], y[i] = (histogram.edges[i] + histogram.edges[i + 1]) / 2, count
end
figures.plot { title = "Factor of safety of 2,000 realisations", x = "factor of safety", y = "realisations",
    series = { { name = "realisations", x = x, y = y } } }

figures.case("PF.interval", "Interval of a probability of which k hits of n trials tell, 95 %.", chance.interval.source)
for _, row in ipairs(chance.interval) do
    local few = talus.realisations { number = row[2], build = function() return model end,
        measure = function(_, draw) return { hit = draw.row <= row[1] } end }
    local share, low, high = few:probability "hit"
    figures.near(("%d of %d: share"):format(row[1], row[2]), share, row[1] / row[2], 1e-15)
    figures.near(("%d of %d: low"):format(row[1], row[2]), low, row[3], 1e-11)
    figures.near(("%d of %d: high"):format(row[1], row[2]), high, row[4], 1e-11)
end

figures.case("BACK.plane", "Back-analysis: the friction at which the block with a full crack is at its limit.",
    reference.back.source)
for _, row in ipairs(reference.back) do
    local found = talus.back_analysis { build = function(values)
        return model, { safety = safety(model, values.friction, row[1], plane.crack) }
    end, unknown = { friction = { 20, 70 } }, observed = { safety = 1 } }
    -- half of the interval that is left: 50 degrees times 1e-4
    figures.near(("friction, cohesion %g kPa"):format(row[1] / 1000), found.value, row[2], 0.0025)
end

figures.finish()
