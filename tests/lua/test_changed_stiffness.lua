-- A joint whose stiffness or law changes keeps its force, where it is closed, open in part, or bears on an edge, and whatever slip has
-- opened: a block that stands under an eccentric load goes on standing.
local check = require "check"
local shapes = require "shapes"
local talus = require "talus"

local KN, SAME = 1e9, 1e-9

local function floor_of(model)
    model:generate("box", { min = { -4, -4, -1 }, max = { 4, 4, 0 }, density = 2500, group = "floor" })
    model:blocks { group = "floor" }:fix()
end

-- A cube that is loaded off its middle; it stands on all of its face, on a part of it, or near an edge.
local function loaded(eccentricity, points)
    local model = talus.model { gravity = { 0, 0, -10 }, contact_points = points }
    floor_of(model)
    model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 0.5 }, density = 2500, group = "block" })
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 40 })
    local block = model:blocks { group = "block" }
    block:load { force = { 2e4, 0, -1e5 }, at = { eccentricity * 1.125, 0.05, 0 } }
    model:damping "local"
    model:solve { ratio = 1e-9, max_cycles = 50000 }
    model:timestep { dt = model.dt * 1e-3 }
    model:cycle(1)
    return model, block
end

for _, points in ipairs { "consistent", "corners" } do
    for _, eccentricity in ipairs { 0, 0.2, 0.3, 0.35, 0.4 } do
        for _, factor in ipairs { 0.25, 1.001, 4 } do
            local model, block = loaded(eccentricity, points)
            local before = model:contacts()[1]
            local normal, shear = before.normal_force, before.shear_force
            local flush = #before.points > 1
            model:joint("*", { kn = factor * KN, ks = factor * KN })
            model:cycle(1)
            local now = model:contacts()[1]
            local name = string.format("%s, %g, kn times %g", points, eccentricity, factor)
            check.holds(math.abs(now.normal_force / normal - 1) < SAME, name .. ": normal force")
            check.holds(shapes.length(shapes.sum(now.shear_force, -1, shear)) < SAME * normal, name .. ": shear force")
            check.holds(not flush or shapes.length(block[1].moment) < SAME * normal, name .. ": moment")
        end
    end
end

-- A cube that has slid on an edge and opened the joint: laws that open it, and those that do not.
local function slid()
    local model = talus.model { gravity = { 0, 0, -10 } }
    floor_of(model)
    local turn = shapes.turn({ 0, 1, 0 }, 0.35)
    local cube = shapes.placed(shapes.box(0.6, 0.6, 0.5), turn)
    local up = shapes.farthest(cube, { 0, 0, -1 })
    model:generate("polyhedron", { vertices = shapes.placed(cube, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, { 0, 0, up }), density = 2500, group = "block" })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30, dilation = 10 })
    local block = model:blocks { group = "block" }
    block:fix { rotation = true }
    model:timestep { fraction = 0.1 }
    model:damping "local"
    model:solve { ratio = 1e-7, max_cycles = 20000 }
    block:set { velocity = { 1, 0, 0 } }
    model:cycle(60)
    model:timestep { dt = model.dt * 1e-4 }
    model:cycle(1)
    return model
end

local COULOMB = { kn = 1e8, ks = 1e8, friction = 89 }
for name, change in pairs { ["no dilation"] = { "coulomb", COULOMB }, bond = { "coulomb_tensile", COULOMB },
    ["less dilation"] = { { dilation = 3, friction = 89 } }, ["without it"] = { { dilation = 0, friction = 89 } },
    stiffer = { { kn = 4e8, ks = 4e8, friction = 89 } }, elastic = { "elastic", { kn = 2e8, ks = 2e8 } } } do
    local model = slid()
    local before = model:contacts()[1].normal_force
    model:joint("*", table.unpack(change))
    model:cycle(1)
    local now = model:contacts()[1].normal_force
    check.holds(math.abs(now / before - 1) < 1e-3, string.format("%s: %g becomes %g N", name, before, now))
end
