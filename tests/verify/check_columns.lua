-- check_columns.lua - columns on a stepped base (Goodman and Bray, 1976), as the tests of toppling build
-- them: case of reference_dynamics.lua, contact_points, friction angle. Gives the model and its columns.
local talus = require "talus"

local GRAVITY = 10
local STIFFNESS = 1e10 -- Pa/m, normal and shear: a column settles by 1e-4 m at the most

-- Each column on its own fixed base. u runs up along the base, w normal to it; the section lies in
-- the x-z plane.
return function(case, points, friction)
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, contact_points = points }
    local s, c = math.sin(math.rad(case.psi)), math.cos(math.rad(case.psi))
    local function prism(u0, u1, w0, w1, group)
        local vertices = {}
        for _, u in ipairs { u0, u1 } do
            for _, w in ipairs { w0, w1 } do
                for _, y in ipairs { 0, case.thickness } do
                    vertices[#vertices + 1] = { u * c - w * s, y, u * s + w * c }
                end
            end
        end
        model:generate("polyhedron", { vertices = vertices, group = group,
            density = case.unit_weight / GRAVITY })
    end
    for i, height in ipairs(case.heights) do
        local u0, u1, base = (i - 1) * case.dx, i * case.dx, (i - 1) * case.b
        prism(u0, u1, -20, base, "base")
        prism(u0, u1, base, base + height, "column " .. i)
    end
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = friction })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    return model, model:blocks { fixed = false }
end
