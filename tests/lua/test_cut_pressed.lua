-- A cut changes nothing that its joint can bear: parts press on the neighbours of the whole with the force that it pressed with, whether
-- their faces lie flush or tilted.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local cuts = require "cuts"
local every_law = require "every_law"
local shapes = require "shapes"
local talus = require "talus"

local SEEDS = check.cases(12)
local STRESS = 1e6

-- Sum of the normal forces of a block and of its parts on the others.
local function pressed(model)
    local sum = 0
    for _, contact in ipairs(model:contacts()) do
        local a, b = contact.blocks[1].group, contact.blocks[2].group
        if a ~= b then
            sum = sum + contact.normal_force
        end
    end
    return sum
end

local function plane(dip, direction, place)
    return { joint = "cut", dip = dip, dip_direction = direction, origin = place }
end

-- ---------------------------------------------------------------- initial stress

-- A cube between two held walls under an initial stress is turned, up to a degree: from 0.05 degrees on its contacts are pressed by faces
-- that are moved outward. At the border that the cut makes the stress falls off within
-- their overlap.
for seed = 1, SEEDS do
    local random = shapes.random(seed)
    local function draw() return random(0, 1) end
    local kn = 10 ^ (9 + draw())
    local tilt = math.rad(draw() ^ 2)
    local model = talus.model()
    model:generate("box", { min = { -1, -1, -1 }, max = { 0, 2, 2 }, density = 2500, group = "walls" })
    model:generate("box", { min = { 1, -1, -1 }, max = { 2, 2, 2 }, density = 2500, group = "walls" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "cube" })
    model:blocks { group = "walls" }:fix()
    model:blocks { group = "walls" }:hide()
    model:joint("*", "coulomb", { kn = kn, ks = kn / 10, friction = 60 })
    model:insitu { stress = { xx = -STRESS } }
    local steps = 100
    model:cycle(1)
    local cube = model:blocks { group = "cube" }
    cube:drive { velocity = { 0, 0, 0 }, angular_velocity = { 0, tilt / (steps * model.dt), 0 } }
    model:timestep { dt = model.dt }
    model:cycle(steps)
    cube:drive { velocity = { 0, 0, 0 } } -- what is driven to turn is not cut
    local whole = model:copy()
    local thin = 10 ^ (-3 * draw())
    local dip = draw() < 0.5 and 90 * math.floor(2 * draw()) or 90 * draw()
    model:generate("joint", plane(dip, 360 * draw(), { 0.5, 0.5 * thin, 0.5 * thin }))
    model:joint("cut", "elastic", { kn = 100 * kn, ks = 100 * kn })
    whole:cycle(1)
    model:cycle(1)
    local overlap = STRESS / kn + tilt / 2
    check.near(pressed(model) / pressed(whole), 1, 2 * overlap + 1e-9)
end

-- ---------------------------------------------------------------- opened by slip

-- A block slides, opens its joint by another way at each of its points, and comes to rest.
local OPENING = {
    { "coulomb", { friction = 30, dilation = 10 } },
    { "coulomb", { friction = 30, dilation = 10, dilation_limit = 1e-3 } },
    { "coulomb", { friction = 40, cohesion = 1e3, dilation = 5 } },
}
for seed = 1, SEEDS do
    local random = shapes.random(100 + seed)
    local function draw() return random(0, 1) end
    local k = 10 ^ (8 + draw())
    local law = OPENING[1 + math.floor(#OPENING * draw())]
    local params = { kn = k, ks = k }
    for name, value in pairs(law[2]) do
        params[name] = value
    end
    local model = talus.model { contact_points = draw() < 0.5 and "corners" or "consistent" }
    model:generate("box", { min = { -3, -3, -1 }, max = { 8, 4, 0 }, density = 2500, group = "floor" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 0.5 }, density = 2500, group = "block" })
    model:blocks { group = "floor" }:fix()
    model:blocks { group = "floor" }:hide()
    model:joint("*", law[1], params)
    model:damping "local"
    model:solve { ratio = 1e-7, max_cycles = 20000 }
    model:blocks { group = "block" }:set { velocity = { 0.2 * draw(), 0.2 * draw(), 0 } }
    model:solve { ratio = 1e-7, max_cycles = 20000 }
    local whole = model:copy()
    whole:cycle(1)
    local at = model:blocks { group = "block" }[1].centroid
    local thin = 10 ^ (-3 * draw())
    local place = { at[1] + 0.5 - 0.5 * thin, at[2], at[3] }
    model:generate("joint", plane(60 + 30 * draw(), 90, place))
    model:joint("cut", "elastic", { kn = 100 * k, ks = 100 * k })
    model:cycle(1)
    check.near(pressed(model) / pressed(whole), 1, 1e-8)
end

-- Blocks that have slid on a tilted joint, which they may overhang, under a load off their middle: the joint may be open in part. Nothing
-- starts to move.
local open_in_part = 0
for number = 4, 5 * SEEDS, 5 do
    local case = cuts.draw(number)
    for _, joint in ipairs(every_law(case.kn, case.pressure)) do
        local force, off, open
        if joint.opens and joint.tension == 0 then
            force, off, open = cuts.try(case, joint)
        end
        if force then
            check.near(force, 0, 1e-6)
            check.near(off, 0, 1e-3)
            open_in_part = open_in_part + (open and 1 or 0)
        end
    end
end
check.holds(open_in_part > SEEDS, "joints are open in part")
