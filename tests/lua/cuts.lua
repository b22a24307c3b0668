-- cuts.lua - a block at rest, under an initial stress, that has slid, that slides or is in flight, on a joint of any law, that is cut by a
-- random plane: how far it and its parts are from the same block that is not cut. A block that has slid lies on a tilted joint, which
-- it may overhang, under a load that may be so far from its middle that the joint is open in part.
--
--     cuts.draw(number)       a random case: what does not depend on the law
--     cuts.try(case, joint)   force on the floor after the cut over that of the block that is not cut, less 1; the largest difference of
--                             the velocities of both in some steps, over their speed or that at which the block would swing on its springs;
--                             and whether the joint is open in part
--                             nil where what touches the floor is no patch: an edge, or faces that are too tilted or too deep
--     cuts.title(case)
local shapes = require "shapes"
local talus = require "talus"

local cuts = {}

local G, DENSITY = 10, 2500
local STEPS, SLIDE = 10, 100
local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
cuts.HISTORIES = { "rest", "insitu", "slides", "flies", "slid" }

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
    case.tilt, case.towards = case.history == "slid" and random(0, 25) or 0, random(0, 360)
    case.overhang = case.history == "slid" and random(0, 1) < 0.5 and random(0, 0.45) or 0
    case.off = { random(-0.3, 0.3), random(-0.3, 0.3) }
    return case
end

function cuts.title(case)
    return ("model %d, kn %.3g Pa/m, %s, cut at %.3g of the height, dip %.3g"):format(case.number, case.kn, case.history, case.thin, case.dip)
end

-- As much as the block weighs, on a point off its middle, on the side of the floor where it overhangs.
local function load_off_middle(case, block)
    local weight = case.pressure * case.size[1] * case.size[2]
    local x, y = case.off[1] * case.size[1], case.off[2] * case.size[2]
    x = case.overhang > 0 and -math.abs(x) or x
    block:load { force = { 0, 0, -weight }, moment = { -2 * weight * y, 2 * weight * x, 0 } }
end

local function settle(model)
    model:damping "local"
    model:solve { ratio = 1e-9, max_cycles = 20000 }
    model:damping "none"
end

local function build(case, joint)
    local tilt, towards = math.rad(case.tilt), math.rad(case.towards)
    local g = case.history == "flies" and 0 or G
    local model = talus.model { gravity = { g * math.sin(tilt) * math.cos(towards), g * math.sin(tilt) * math.sin(towards), -g * math.cos(tilt) } }
    model:generate("box", { min = { -4, -4, -1 }, max = { 4, 4, 0 }, density = DENSITY, group = "floor" })
    local x = case.overhang > 0 and 4 - (0.5 - case.overhang) * case.size[1] or 0
    model:generate("polyhedron", { vertices = shapes.placed(shapes.box(table.unpack(case.size)), NONE,
        { x, 0, case.size[3] / 2 + (case.history == "flies" and 1 or 0) }), density = DENSITY, group = "block" })
    model:blocks { group = "floor" }:fix():hide()
    model:joint("*", joint.law, joint.params)
    local block = model:blocks { group = "block" }
    if case.history == "insitu" then
        model:insitu { stress = { zz = -case.initial } }
        block:load { force = { 0, 0, case.pressure * case.size[1] * case.size[2] - case.initial * case.size[1] * case.size[2] } }
    elseif case.history == "slid" then
        load_off_middle(case, block)
    end
    if case.history ~= "flies" then
        settle(model)
    end
    if case.history == "slid" then
        block:set { velocity = { 0.3 * case.speed[1], 0.3 * case.speed[2], 0 } }
        settle(model)
    elseif case.history == "slides" then
        block:set { velocity = { case.speed[1], case.speed[2], 0 } }
        model:cycle(SLIDE)
    elseif case.history == "flies" then
        block:set { velocity = case.speed, angular_velocity = case.spin }
        model:cycle(1)
    end
    return model
end

-- What presses on the floor: what holds it but for its weight.
local function floor_force(model)
    local floor = model:blocks { group = "floor", hidden = true }
    return floor:reaction()[3] + floor[1].mass * model.gravity[3]
end

-- Velocity of a block's centroid, had it gone on as part of the whole.
local function carried(whole, place)
    local arm = shapes.sum(place, -1, whole.centroid)
    return shapes.sum(whole.velocity, 1, shapes.cross(whole.angular_velocity, arm))
end

-- Whether the floor is touched by patches only, and whether some of their points are open.
local function on_patches(model)
    local open = false
    for _, contact in ipairs(model:contacts()) do
        for _, point in ipairs(contact.points) do
            if (contact.blocks[1].group == "floor") ~= (contact.blocks[2].group == "floor") and #contact.points == 1 then
                return false
            end
            open = open or not (point.normal_force > 0)
        end
    end
    return true, open
end

function cuts.try(case, joint)
    local model = build(case, joint)
    local whole = model:copy()
    whole:cycle(1)
    local flat, open = on_patches(whole)
    if not flat or case.history == "slides" and open then
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
            if not on_patches(model) then
                return nil
            end
            local before = floor_force(whole)
            force = before > 0 and floor_force(model) / before - 1 or 0
        end
        for _, part in ipairs(model:blocks { group = "block" }) do
            off = math.max(off, shapes.length(shapes.sum(part.velocity, -1, carried(one, part.centroid))))
        end
    end
    return math.abs(force), off / math.max(speed, math.sqrt(G * case.pressure / case.kn)), open
end

return cuts
