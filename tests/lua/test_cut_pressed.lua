-- A cut changes nothing that its joint can bear: parts press on the neighbours of the whole with the force that it pressed with, whether
-- their faces lie flush or tilted.
local check = require "check"
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
