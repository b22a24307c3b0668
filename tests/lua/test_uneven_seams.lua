-- A body of two joined boxes of unequal heights: one's side lies on a part of the other's side. Pressed into a smooth floor, level
-- or tilted, it is pushed straight up, and a cube that slides over it on its edge has its energy back behind it.
local talus = require "talus"
local check = require "check"
local shapes = require "shapes"

local DENSITY, KN = 2500, 1e8
local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

for _, height in ipairs { 1, 1.1, 1.5 } do
    for _, tilt in ipairs { 0, 1e-4, 0.01, 0.3 } do
        local model = talus.model { gravity = { 0, 0, 0 } }
        model:generate("box", { min = { -9, -9, -3 }, max = { 9, 9, 0 }, density = DENSITY, group = "floor" })
        model:blocks { group = "floor" }:fix()
        local turn, down = shapes.turn({ 0, 1, 0 }, tilt), -0.05 - math.sin(tilt)
        for i, h in ipairs { 1, height } do
            local box = shapes.placed(shapes.box(1, 1, h), NONE, { i - 1, 0, h / 2 })
            model:generate("polyhedron", { vertices = shapes.placed(box, turn, { 0, 0, down }), density = DENSITY, group = "body" })
        end
        model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 0 })
        model:timestep { dt = 1e-5 }
        local body = model:blocks { group = "body" }
        body:join()
        model:cycle(1)
        local force = body[1].force
        local aside = math.sqrt(force[1] ^ 2 + force[2] ^ 2) / force[3]
        check.holds(force[3] > 0 and aside < 1e-12,
            string.format("heights 1 and %g, tilt %g: pushed aside by %g of the force", height, tilt, aside))
    end
end

-- The cube's edge goes over the seam at 1 m/s.
for _, height in ipairs { 1, 1.5 } do
    local model = talus.model { gravity = { 0, 0, -10 } }
    for i, h in ipairs { 1, height } do
        model:generate("box", { min = { 2 * i - 4, -2, -h }, max = { 2 * i - 2, 2, 0 }, density = DENSITY, group = "base" })
    end
    model:blocks():join()
    model:blocks():fix()
    local turn = shapes.turn({ 0, 1, 0 }, math.rad(30))
    local cube = shapes.placed(shapes.box(1, 1, 1), turn)
    local low = shapes.farthest(cube, { 0, 0, -1 })
    model:generate("polyhedron", { vertices = shapes.placed(cube, NONE, { -0.5, 0, low }), density = DENSITY, group = "cube" })
    model:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 0 })
    local slider = model:blocks { group = "cube" }
    slider:fix { rotation = true }
    model:damping "local"
    model:solve { ratio = 1e-8 }
    model:damping "none"
    slider:set { velocity = { 1, 0, 0 } }
    model:timestep { fraction = 0.1 }
    local before, start = model:energy(), model.time
    while model.time < start + 0.8 do
        model:cycle(200)
    end
    local after = model:energy()
    local change = after.kinetic + after.potential + after.stored - before.kinetic - before.potential - before.stored
        - after.external + before.external
    check.holds(math.abs(change) < 1e-4 * DENSITY / 2,
        string.format("heights 1 and %g: energy changes by %g J of 1250", height, change))
    check.near(slider[1].velocity[1], 1, 1e-4)
end
