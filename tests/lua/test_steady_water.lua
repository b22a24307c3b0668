-- Forces of water are kept while blocks hardly move: how far they are off while a block flies, how often they are asked for, and
-- that they are exact where it stands.
local talus = require "talus"
local check = require "check"

local WEIGHT, LEVEL, GAP, SPEED, STEP = 9810, 5, 0.01, 0.01, 1e-3
local RADIUS = math.sqrt(3) / 2

local m = talus.model { gravity = { 0, 0, 0 } }
m:generate("box", { { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2500 },
    { min = { 0, 0, GAP }, max = { 1, 1, 1 + GAP }, density = 2.5e7 } })
m:blocks { id = 1 }:fix()
m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
m:water("table", { level = LEVEL, unit_weight = WEIGHT })
local upper = m:blocks { id = 2 }
upper:set { velocity = { 0, 0, SPEED } }
m:timestep { dt = STEP }

-- Of the water on the upper block, less what its place asks for, as a head over the radius.
local function off()
    local force = 0
    for _, node in ipairs(m:elements { kind = "water" }[1].nodes) do
        force = force + (node.block.id == 2 and node.force[3] or 0)
    end
    return math.abs(force / WEIGHT - (LEVEL - GAP - upper[1].displacement[3])) / RADIUS, force
end

m:cycle(1)
local worst, asked, last = 0, 0, nil
for _ = 1, 200 do
    m:cycle(1)
    local head, force = off()
    worst, asked, last = math.max(worst, head), asked + (force ~= last and 1 or 0), force
end
-- a step is 1.2e-5 radii long, and the place is that at its end
check.holds(worst > 5e-5 and worst < 1.3e-4, ("a block that flies is pressed as if it were %g radii off"):format(worst))
check.holds(asked > 10 and asked < 60, ("forces were asked for in %d of 200 steps"):format(asked))

-- Where it stands they are asked for within 64 steps.
upper:set { velocity = { 0, 0, 0 } }
upper:fix()
m:cycle(64)
check.near(off(), 0, 1.5e-6)

-- Polygons of walls that slide by more than 1e-3 of their size in a step are found again: once, also by a copy and by who asks.
local slides = talus.model { gravity = { 0, 0, -10 } }
slides:generate("box", { { min = { -3, -1, -1 }, max = { 8, 2, 0 }, density = 2500 },
    { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2500 } })
slides:generate("joint", { joint = "J", dip = 80, dip_direction = 90, origin = { 1, 0, 0 } })
slides:blocks { inside = { min = { -9, -9, -9 }, max = { 9, 9, 0 } } }:fix()
slides:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
slides:water("uniform", { pressure = 1e3 })
slides:blocks { containing = { 0.5, 0.5, 0.5 } }:set { velocity = { 0.2, 0, 0.5 }, angular_velocity = { 0.7, 0.3, -0.3 } }
slides:blocks { containing = { 1.5, 0.5, 0.5 } }:set { velocity = { 2, -0.3, 0.2 } }
for _ = 1, 12 do
    slides:cycle(16) -- it is looked at every 16 steps
    local before = slides:copy()
    local hash = slides:state_hash()
    local after = slides:copy()
    check.equal(before:state_hash(), hash)
    check.equal(after:state_hash(), hash)
    for _, one in ipairs { before, after, slides } do
        one:cycle(16)
    end
    hash = slides:state_hash()
    check.equal(before:state_hash(), hash)
    check.equal(after:state_hash(), hash)
end

-- A run ends at rest only with forces that are exact: they follow from where the block is.
for _, stiffness in ipairs { 1e7, 1e8, 1e9 } do
    for _, ratio in ipairs { 1e-3, 1e-5, 1e-7 } do
        local rests = talus.model { gravity = { 0, 0, -10 } }
        rests:generate("box", { { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2500 },
            { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 } })
        rests:blocks { id = 1 }:fix()
        rests:joint("*", "coulomb", { kn = stiffness, ks = stiffness, friction = 30 })
        rests:water("table", { level = 0.5, unit_weight = WEIGHT })
        rests:damping "local"
        rests:solve { ratio = ratio }
        local force = 0
        for _, node in ipairs(rests:elements()[1].nodes) do
            force = force + (node.block.id == 2 and node.force[3] or 0)
        end
        local wrong = math.abs(force / WEIGHT - (0.5 - rests:blocks { id = 2 }[1].displacement[3])) / RADIUS
        check.holds(wrong < 1.1e-6, ("kn %g, ratio %g: at rest as if it were %g radii off"):format(stiffness, ratio, wrong))
    end
end
