-- When a solve calls a model at rest: not while any one block is not.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local DENSITY, GRAVITY = 2500, 10
local AVERAGE = "average" -- the measure that says nothing of single blocks

local function plain(gravity, k)
    local model = talus.model { gravity = { 0, 0, -gravity } }
    model:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = DENSITY, group = "base" })
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = k or 1e8, ks = k or 1e8, friction = 30 })
    return model
end

local function cube(model, z, x)
    model:generate("box", { min = { x or 0, 0, z }, max = { (x or 0) + 1, 1, z + 1 },
        density = DENSITY, group = "cube" })
    return model:blocks { group = "cube" }
end

-- Columns of large blocks, and aside a small one on a slope with friction for a share of what would hold it.
local COLUMNS, HIGH = 8, 4
local function small_among_large(seed, factor_of_safety)
    math.randomseed(seed)
    local dip, size = math.rad(25 + 15 * math.random()), 0.05 + 0.1 * math.random()
    local slope = math.tan(dip)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { 0, 0, -1 }, max = { COLUMNS, COLUMNS, 0 }, density = DENSITY,
        group = "base" })
    for x = 0, COLUMNS - 1 do
        for y = 0, COLUMNS - 1 do
            for z = 0, HIGH - 1 do
                model:generate("box", { min = { x, y, z }, max = { x + 1, y + 1, z + 1 },
                    density = DENSITY })
            end
        end
    end
    local foot = COLUMNS + 2
    model:generate("polyhedron", { density = DENSITY, group = "base", vertices = { { foot, 0, 0 },
        { foot + 4, 0, 0 }, { foot, 4, 0 }, { foot + 4, 4, 0 }, { foot, 0, 4 * slope },
        { foot, 4, 4 * slope } } })
    local x, y, vertices = 0.5 + math.random(), 1 + math.random(), {}
    for _, along in ipairs { 0, size } do
        for _, across in ipairs { 0, size } do
            for _, up in ipairs { 0, size / 2 } do
                vertices[#vertices + 1] = { foot + x + along * math.cos(dip) + up * math.sin(dip),
                    y + across, (4 - x) * slope - along * math.sin(dip) + up * math.cos(dip) }
            end
        end
    end
    model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "small" })
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9,
        friction = math.deg(math.atan(factor_of_safety * slope)) })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    return model, model:blocks { group = "small" }[1]
end
for seed = 1, check.cases(10) do
    local model, small = small_among_large(seed, 0.83)
    local result = model:solve { max_cycles = 1000 }
    check.equal(result.reason, "cycles")
    check.equal(result.measure, "local")
    check.equal(result.worst, small)
    check.holds(result.ratio_local > 0.01 and small.speed > 1e-3, "the small block slides")
end
-- The mean of them all falls below its limit all the same; and a block that is held comes to rest.
local model = small_among_large(1, 0.83)
local result = model:solve { measure = AVERAGE, max_cycles = 5000 }
check.equal(result.reason, "ratio")
check.equal(result.measure, AVERAGE)
check.holds(result.ratio < 1e-5 and result.ratio_local > 0.01, "at rest on average only")
model = small_among_large(1, 1.2)
result = model:solve { max_cycles = 20000 }
check.equal(result.reason, "ratio")
check.holds(result.ratio_local < 1e-5 and result.ratio <= result.ratio_local, "each block is at rest")

-- One that tips over its edge, held by nothing but its weight, is not in balance: moments of each block count.
model = plain(GRAVITY)
local blocks = cube(model, 0)
for x = 2, 4 do
    cube(model, 0, x)
end
model:damping "local"
blocks:load { moment = { 0, 0.6 * DENSITY * GRAVITY, 0 } }
result = model:solve { max_cycles = 2000 }
check.equal(result.reason, "cycles")
check.equal(result.worst, blocks[1])

-- A block that swings without damping is not at rest when it passes through equilibrium.
model = plain(GRAVITY)
cube(model, 0)
result = model:solve { ratio = 1e-2, max_cycles = 20000 }
check.equal(result.reason, "cycles")
check.holds(plain(GRAVITY):solve { ratio = 1e-2 }.cycles == 1, "nothing to move is at rest at once")
model = plain(GRAVITY)
cube(model, 0)
result = model:solve { ratio = 1e-2, measure = AVERAGE, max_cycles = 20000 }
check.equal(result.reason, "ratio")

-- Without weight: blocks that fly or spin touch nothing and feel no force. One that is still is at rest.
for _, motion in ipairs { { velocity = { 0, 0, 1e-3 } }, { angular_velocity = { 0, 0, 1e-3 } } } do
    model = plain(0)
    blocks = cube(model, 1)
    blocks:set(motion)
    result = model:solve { max_cycles = 100 }
    check.equal(result.reason, "cycles")
    check.equal(result.worst, blocks[1])
end
model = plain(0)
cube(model, 1)
result = model:solve { max_cycles = 100 }
check.equal(result.reason, "ratio")
check.equal(result.worst, nil)
-- One that falls is not, nor one that only its load holds and turns.
model = plain(GRAVITY)
cube(model, 1)
result = model:solve { max_cycles = 50 }
check.equal(result.reason, "cycles")
check.near(result.ratio_local, 1, 1e-12)
for _, turning in ipairs { 0, 1e-3 } do
    model = plain(GRAVITY)
    blocks = cube(model, 1)
    blocks:load { force = { 0, 0, DENSITY * GRAVITY }, moment = { 0, 0, turning } }
    check.equal(model:solve { max_cycles = 50 }.reason, turning > 0 and "cycles" or "ratio")
end

-- Moments count by themselves: beside a block that rests and stores energy, one that only its load holds begins to turn.
for _, gravity in ipairs { GRAVITY, 0 } do
    model = plain(gravity)
    cube(model, 0):load { force = { 0, 0, -1e4 } }
    cube(model, 1, 3)
    blocks = model:blocks { above = { dip = 0, dip_direction = 0, origin = { 0, 0, 0.5 } }, group = "cube" }
    blocks = blocks:where(function(b) return b.centroid[1] > 3 end)
    blocks:load { force = { 0, 0, gravity * DENSITY } }
    model:damping "local"
    check.equal(model:solve { ratio = 1e-3, max_cycles = 5000 }.reason, "ratio")
    blocks:load { force = { 0, 0, gravity * DENSITY }, moment = { 0, 0, 200 } }
    result = model:solve { ratio = 1e-3, max_cycles = 1 }
    check.equal(result.reason, "cycles")
    check.equal(result.worst, blocks[1])
end

-- A block that bears next to nothing: by the ratio to its own forces alone it would never rest, for rounding of the
-- overlap is as large as they are.
model = plain(0)
blocks = cube(model, 0)
model:damping "local"
blocks:load { force = { 0, 0, -1e-6 } }
result = model:solve { max_cycles = 5000 }
check.equal(result.reason, "ratio")
-- A block that hardly touches has its weight for a measure, so the ratio of what falls is no larger than 1.
model = plain(GRAVITY)
blocks = cube(model, 0)
blocks:load { force = { 0, 0, 0.999 * DENSITY * GRAVITY } }
result = model:cycle(1)
check.holds(result.ratio_local <= 1, "the weight counts")

-- A block that slides on without friction between clamps, at a velocity that is nothing beside what the clamps could give
-- it, is not at rest.
do
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = 2700 })
    m:generate("box", { min = { -5, -5, 1 }, max = { 5, 5, 2 }, density = 2700 })
    m:blocks():fix()
    m:generate("box", { min = { -.5, -.5, 0 }, max = { .5, .5, 1 }, density = 2700, group = "b" })
    m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 0 })
    m:insitu { stress = { zz = -1e7 } }
    m:damping "local"
    m:blocks { group = "b" }:set { velocity = { .01, 0, 0 } }
    check.equal(m:solve { max_cycles = 500 }.reason, "cycles")
end
