-- sliding.lua - blocks that slide, creep, rock and roll with friction, against what is known of them.
local talus = require "talus"
local shapes = require "shapes"

local sliding = {}

local DENSITY, GRAVITY = 2500, 9.81 -- kg/m3, m/s2
local FRACTION = 0.1                -- of the critical step

-- A floor under a space in which gravity is turned by `dip` degrees, so that things go towards +x.
local function floor(dip)
    local t = math.rad(dip)
    local model = talus.model { gravity = { GRAVITY * math.sin(t), 0, -GRAVITY * math.cos(t) } }
    model:generate("box", { min = { -5, -5, -1 }, max = { 30, 5, 0 }, density = DENSITY, group = "floor" })
    model:blocks { group = "floor" }:fix()
    return model
end

local function ready(model, kn, friction)
    model:joint("*", "coulomb", { kn = kn, ks = kn / 2, friction = friction })
    model:timestep { fraction = FRACTION }
    return model
end

-- A cube of a metre on an incline.
local function cube(dip, kn, friction)
    local model = floor(dip)
    model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 1 }, density = DENSITY, group = "block" })
    ready(model, kn, friction)
    model:damping "local"
    model.gravity = { 0, 0, model.gravity[3] } -- pressed on first
    model:solve { ratio = 1e-9 }
    model:damping "none"
    return model, model:blocks { group = "block" }
end

-- A cube on an incline of 20 degrees with a friction of 30. With `spin` 0 it is pressed on the level first, and jolted by
-- the slope's pull all at once; else it rests, and is jolted by a turning of `spin` about y, rad/s, and 0.3 of it about x.
-- Gives m by which it has crept down `time` later, its oscillations damped out, and the balance of the ledger.
function sliding.creep(kn, spin, time)
    local model, block = cube(20, kn, 30)
    local t = math.rad(20)
    model.gravity = { GRAVITY * math.sin(t), 0, -GRAVITY * math.cos(t) }
    if spin > 0 then
        model:damping "local"
        model:solve { ratio = 1e-9 }
        model:damping "none"
        block:set { angular_velocity = { 0.3 * spin, spin, 0 } }
    end
    block:reset_displacement()
    model:solve { ratio = 0, max_time = time }
    model:damping "local"
    model:solve { ratio = 1e-9, max_cycles = 50000 }
    return block[1].displacement[1], math.abs(model:energy().balance)
end

-- A cube let go on an incline of 35 degrees with a friction of 30: its way in `time`, and what it should be.
function sliding.slide(kn, time)
    local model, block = cube(35, kn, 30)
    local t = math.rad(35)
    model.gravity = { GRAVITY * math.sin(t), 0, -GRAVITY * math.cos(t) }
    block:reset_displacement()
    local start = model.time
    model:solve { ratio = 0, max_time = time }
    local taken = model.time - start
    local level = GRAVITY * (math.sin(t) - math.cos(t) * math.tan(math.rad(30)))
    return block[1].displacement[1], level * taken ^ 2 / 2, math.abs(model:energy().balance)
end

-- A slab 0.5 by 0.5 by 2 m let go at a tilt of 4 degrees rocks: the share of the energy it could lose that has turned to
-- heat in 8 s, the number of its half swings, the share of this energy that the ledger misses, and m it has wandered.
function sliding.rocking(kn, friction, time)
    local model, tilt, vertices = floor(0), math.rad(4), {}
    for _, x in ipairs(shapes.box(0.5, 0.5, 2)) do
        x = { x[1] - 0.25, x[2], x[3] + 1 } -- turned about its edge at x = 0
        vertices[#vertices + 1] = { x[1] * math.cos(tilt) + x[3] * math.sin(tilt), x[2],
            x[3] * math.cos(tilt) - x[1] * math.sin(tilt) }
    end
    model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "block" })
    ready(model, kn, friction)
    local block = model:blocks { group = "block" }
    -- over that of the slab upright: its middle falls from this height to a metre
    local height = block[1].centroid[3] - 1
    local scale = block[1].mass * GRAVITY * height
    local x0, swings, last = block[1].centroid[1], 0, 1
    while model.time < time do
        model:solve { ratio = 0, max_time = 5e-3 }
        local v = block[1].velocity[1]
        if v * last < 0 then
            swings, last = swings + 1, v
        end
    end
    local e = model:energy()
    local missing = math.abs(e.kinetic + e.potential + e.stored + e.friction + e.damping - e.external) / scale
    return e.friction / scale, swings, missing, block[1].centroid[1] - x0, block[1].centroid[2]
end

-- A prism of `sides` sides rolls down an incline of `dip` degrees: its way in `time`, that of rolling without slip by its
-- own mass, inertia and mean radius, the share of work turned to heat, and the balance.
function sliding.rolling(kn, sides, dip, time)
    local model, radius = floor(dip), 0.5
    model:generate("drum", { axis = { 0, 1, 0 }, radius = radius, height = 1, sides = sides, density = DENSITY,
        center = { 0, 0, 0 }, group = "drum" })
    local drum = model:blocks { group = "drum" }
    local low = math.huge
    for _, v in ipairs(drum[1].vertices) do
        low = math.min(low, v[3])
    end
    drum:delete()
    model:generate("drum", { axis = { 0, 1, 0 }, radius = radius, height = 1, sides = sides, density = DENSITY,
        center = { 0, 0, -low }, group = "drum" })
    drum = model:blocks { group = "drum" }
    ready(model, kn, 40)
    local mass, inertia = drum[1].mass, drum[1].inertia.yy
    local arm = radius * (1 + math.cos(math.pi / sides)) / 2 -- the mean radius
    local level = model.gravity[1] / (1 + inertia / (mass * arm ^ 2))
    drum:reset_displacement()
    model:solve { ratio = 0, max_time = time }
    local e = model:energy()
    return drum[1].displacement[1], level * model.time ^ 2 / 2, e.friction / math.abs(e.potential), math.abs(e.balance)
end

return sliding
