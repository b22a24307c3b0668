-- moved_faces.lua - faces that a law, a stress or slip has moved: what changes of a law, and hand-overs, keep.
--
--     local result = moved_faces.changed(joint, other, seed, kn)   a box falls on a face, an edge or a corner, and while it presses its
--                                                                  joint comes under another law
--     result.jump        change of the normal force in the step after, where nothing moves, of the force; where slip that the new law
--                        lets go opens the joint that is in it
--     result.balance     the worst balance of the ledger from then on
--     local result = moved_faces.leaned(joint, seed, kn)           an initial stress that is not the same everywhere, or slip of a face
--                                                                  that turned, has opened a joint; its faces tilt until edges press
--     result.jump        the largest change of the normal force in a step, of the force
--     result.heat        the lowest heat, of the energy stored, J/J: 0 but for roundings
--
-- `joint` and `other` have law and params of model:joint.
local shapes = require "shapes"
local talus = require "talus"

local moved_faces = {}

local DENSITY = 2500

local function floor_of(model)
    model:generate("box", { min = { -6, -6, -1 }, max = { 6, 6, 0 }, density = DENSITY, group = "floor" })
    model:blocks { group = "floor" }:fix()
end

-- Turns of a box: flat, about an edge, about a corner.
local function turn_of(random, kind)
    if kind == 0 then
        return shapes.turn({ 0, 0, 1 }, random(0, 1))
    elseif kind == 1 then
        return shapes.turn({ 0, 1, 0 }, random(0.02, 0.7))
    end
    return shapes.attitude(random)
end

local AXES = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

function moved_faces.changed(joint, other, seed, kn)
    local random = shapes.random(seed)
    local model = talus.model { gravity = { 0, 0, -10 } }
    floor_of(model)
    local box = shapes.placed(shapes.box(random(0.5, 1.2), random(0.5, 1.2), random(0.5, 1.2)), turn_of(random, seed % 3))
    local low = shapes.farthest(box, { 0, 0, -1 })
    model:generate("polyhedron", { vertices = shapes.placed(box, AXES, { 0, 0, low }), density = DENSITY, group = "box" })
    model:joint("*", joint.law, joint.params)
    model:timestep { fraction = 0.03 }
    local body = model:blocks { group = "box" }
    local weight = body[1].mass * 10
    body:set { velocity = { random(-0.3, 0.3), random(-0.3, 0.3), -random(0.3, 0.6) },
        angular_velocity = { random(-0.3, 0.3), random(-0.3, 0.3), 0 } }
    local contact
    for _ = 1, 20000 do
        model:cycle(1)
        contact = model:contacts()[1]
        if contact and contact.normal_force > 2 * weight then
            break
        end
    end
    local velocity, spin = body[1].velocity, body[1].angular_velocity
    body:drive { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } } -- it stands still in the step after
    model:cycle(2)
    local force = model:contacts()[1].normal_force
    model:joint("*", other.law, other.params)
    model:cycle(1)
    local jump = math.abs(model:contacts()[1].normal_force / force - 1)
    body:free()
    body:set { velocity = velocity, angular_velocity = spin }
    local balance = 0
    for _ = 1, 40 do
        model:cycle(75)
        balance = math.max(balance, math.abs(model:energy().balance))
    end
    return { jump = jump, balance = balance, force = force / weight }
end

-- Stresses, Pa, at the ends of the joint: of the mean `p`.
local function put_stress(model, random, p)
    local share = random(-1, 1)
    model:insitu { stress = { xx = -p }, gradient = { xx = share * 2 * p }, at = { 0, 0, 0 } }
end

-- The upper block slips while it turns about its face's middle: opened most at the rim.
local function slip(model, body, kn, p)
    body:drive { velocity = { -p / kn / 0.05, 0, 0 } }
    model:cycle(500)
    body:drive { angular_velocity = { 0.2, 0, 0 }, velocity = { 0, 0.04, 0.02 } }
    model:cycle(1000)
end

function moved_faces.leaned(joint, seed, kn)
    local random = shapes.random(seed)
    local p = kn * 10 ^ random(-3.3, -2.3)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { -2, -2, -3 }, max = { 0, 2, 3 }, density = DENSITY, group = "floor" })
    model:blocks { group = "floor" }:fix()
    model:generate("box", { min = { 0, -0.5, -0.5 }, max = { 1, 0.5, 0.5 }, density = DENSITY })
    model:joint("*", joint.law, joint.params)
    model:timestep { dt = 1e-4 }
    local body = model:blocks { fixed = false }
    if seed % 2 == 0 then
        put_stress(model, random, p)
    else
        slip(model, body, kn, p)
    end
    body:drive { velocity = { 0, 0, 0 } }
    model:cycle(2)
    -- tilted about an axis of the joint through the middle of the face
    local a, rate = random(0, 2 * math.pi), 0.004
    local spin = { 0, rate * math.cos(a), rate * math.sin(a) }
    local middle = { 0, body[1].centroid[2], body[1].centroid[3] }
    body:drive { angular_velocity = spin, velocity = shapes.cross(spin, shapes.sum(body[1].centroid, -1, middle)) }
    local force, jump, heat, first, stored = model:contacts()[1].normal_force, 0, 0, model:energy().friction, 0
    for _ = 1, 8000 do
        model:cycle(1)
        local now, e = model:contacts()[1].normal_force, model:energy()
        jump = math.max(jump, math.abs(now - force) / math.max(now, force))
        force, stored = now, math.max(stored, e.stored)
        heat = math.min(heat, e.friction - first)
    end
    return { jump = jump, heat = heat / stored, points = #model:contacts()[1].points }
end

return moved_faces
