-- Blocks whose corners come rounded from a file have the faces they were made with: a bond across a joint holds, an initial
-- stress acts on it, and a block that weighs on it settles by its closure.
local talus = require "talus"
local check = require "check"

local DENSITY, KN, BOND, STRESS = 2500, 1e9, 1e6, -1e6

-- Two cubes on top of each other. Both have the same four corners in between, one of which is higher by `off`.
local function pair(off, gravity, law, parameters)
    local model = talus.model { gravity = { 0, 0, gravity } }
    for _, z in ipairs { -1, 1 } do
        local vertices = {}
        for i = 0, 3 do
            local x, y = i % 2, i // 2
            vertices[#vertices + 1] = { x, y, x * y * off }
            vertices[#vertices + 1] = { x, y, z }
        end
        model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = z < 0 and "low" or "high" })
    end
    model:joint("*", law, parameters)
    model:damping "local"
    return model
end

for _, off in ipairs { 0, 1e-9, 1e-8, 1e-7, 5e-7 } do
    local coulomb = { kn = KN, ks = KN, friction = 30 }
    local model = pair(off, 0, "coulomb", coulomb)
    check.equal(#model:blocks()[1].faces, 6)
    model:blocks():fix()
    model:insitu { stress = { xx = STRESS, yy = STRESS, zz = STRESS } }
    model:cycle(1)
    local contact = model:contacts()[1]
    check.near(contact.normal_force / contact.area, -STRESS, 1e-5 * -STRESS)

    local closure = DENSITY * 10 / KN
    model = pair(off, -10, "coulomb", coulomb)
    model:blocks { group = "low" }:fix()
    model:solve { ratio = 1e-8 }
    check.near(model:blocks { group = "high" }[1].displacement[3], -closure, 1e-3 * closure)

    model = pair(off, 10, "coulomb_tensile", { kn = KN, ks = KN, friction = 30, cohesion = BOND, tension = BOND })
    model:blocks { group = "low" }:fix()
    model:cycle(2000)
    check.near(model:blocks { group = "high" }[1].displacement[3], closure, 1e-3 * closure)
end
