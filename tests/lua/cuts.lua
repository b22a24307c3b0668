-- cuts.lua - a block at rest, under an initial stress, sliding or in flight, on a joint of any law, that is cut by a random plane: how far
-- it and its parts are from the same block that is not cut.
--
--     cuts.draw(number)       a random case: what does not depend on the law
--     cuts.try(case, joint)   force on the floor after the cut over that of the block that is not cut, less 1, and the largest difference of
--                             the velocities of both in some steps, over their speed or that at which the block would swing on its springs
--                             nil where the block does not lie on all of its joint: closures at points tell little of it there
--     cuts.title(case)
local shapes = require "shapes"
local talus = require "talus"

local cuts = {}

local G, DENSITY = 10, 2500
local STEPS, SLIDE = 10, 100
local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
cuts.HISTORIES = { "rest", "insitu", "slides", "flies" }

-- Cut off by shares of the size down to 1e-3, from any side.
function cuts.draw(number)
    local random = shapes.random(number)
    local case = { number = number, kn = 10 ^ random(8, 11), size = { random(0.5, 1.5), random(0.5, 1.5), random(0.3, 1) } }
    case.history = cuts.HISTORIES[number % #cuts.HISTORIES + 1]
    case.speed = { random(-1, 1), random(-1, 1), random(0.5, 1) }
    case.spin = { random(-1, 1), random(-1, 1), random(-1, 1) }
    if case.history == "slides" then
        case.size[3] = 0.3 * case.size[3] -- it would rock
    end
    case.dip = random(0, 1) < 0.5 and 90 * math.floor(random(0, 2)) or random(0, 90)
    case.direction, case.thin, case.at = random(0, 360), 10 ^ random(-3, 0), random(0, 1)
    case.pressure = DENSITY * G * case.size[3]
    case.initial = case.pressure * random(1, 8)
    return case
end

function cuts.title(case)
    return ("model %d, kn %.3g Pa/m, %s, cut at %.3g of the height, dip %.3g"):format(case.number, case.kn, case.history, case.thin, case.dip)
end

local function build(case, joint)
    local model = talus.model { gravity = { 0, 0, case.history == "flies" and 0 or -G } }
    model:generate("box", { min = { -4, -4, -1 }, max = { 4, 4, 0 }, density = DENSITY, group = "floor" })
    model:generate("polyhedron", { vertices = shapes.placed(shapes.box(table.unpack(case.size)), NONE,
        { 0, 0, case.size[3] / 2 + (case.history == "flies" and 1 or 0) }), density = DENSITY, group = "block" })
    model:blocks { group = "floor" }:fix():hide()
    model:joint("*", joint.law, joint.params)
    local block = model:blocks { group = "block" }
    if case.history == "insitu" then
        model:insitu { stress = { zz = -case.initial } }
        block:load { force = { 0, 0, case.pressure * case.size[1] * case.size[2] - case.initial * case.size[1] * case.size[2] } }
    end
    if case.history ~= "flies" then
        model:damping "local"
        model:solve { ratio = 1e-9, max_cycles = 20000 }
        model:damping "none"
    end
    if case.history == "slides" then
        block:set { velocity = { case.speed[1], case.speed[2], 0 } }
        model:cycle(SLIDE)
    elseif case.history == "flies" then
        block:set { velocity = case.speed, angular_velocity = case.spin }
        model:cycle(1)
    end
    return model
end

local function floor_force(model)
    local sum = 0
    for _, contact in ipairs(model:contacts()) do
        if (contact.blocks[1].group == "floor") ~= (contact.blocks[2].group == "floor") then
            sum = sum + contact.normal_force
        end
    end
    return sum
end

-- Velocity of a block's centroid, had it gone on as part of the whole.
local function carried(whole, place)
    local arm = shapes.sum(place, -1, whole.centroid)
    return shapes.sum(whole.velocity, 1, shapes.cross(whole.angular_velocity, arm))
end

-- Whether a block lies on all of its joint, or on none.
local function lies_flat(model)
    for _, contact in ipairs(model:contacts()) do
        for _, point in ipairs(contact.points) do
            if #contact.points == 1 or not (point.normal_force > 0) then
                return false
            end
        end
    end
    return true
end

function cuts.try(case, joint)
    local model = build(case, joint)
    local whole = model:copy()
    whole:cycle(1)
    if not lies_flat(whole) then
        return nil
    end
    whole = model:copy()
    local c = model:blocks { group = "block" }[1].centroid
    local origin = { c[1] + (case.at - 0.5) * case.size[1] * 0.8, c[2], c[3] + (case.thin - 0.5) * case.size[3] }
    model:generate("joint", { joint = "cut", dip = case.dip, dip_direction = case.direction, origin = origin })
    model:joint("cut", "elastic", { kn = 10 * case.kn, ks = 10 * case.kn })
    local force, off, speed = 0, 0, shapes.length(whole:blocks { group = "block" }[1].velocity)
    for step = 1, STEPS do
        model:cycle(1)
        whole:timestep { dt = model.dt }
        whole:cycle(1)
        local one = whole:blocks { group = "block" }[1]
        if step == 1 then
            local before = floor_force(whole)
            force = before > 0 and floor_force(model) / before - 1 or 0
        end
        for _, part in ipairs(model:blocks { group = "block" }) do
            off = math.max(off, shapes.length(shapes.sum(part.velocity, -1, carried(one, part.centroid))))
        end
    end
    return math.abs(force), off / math.max(speed, math.sqrt(G * case.pressure / case.kn))
end

return cuts
