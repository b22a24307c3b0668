-- voussoirs.lua - a semicircular arch of voussoirs under its own weight.
--
--     model, arch = voussoirs.arch(count, thickness, stiffness)    of so many on two fixed springers, m; kn = ks over rho g, 1/m
local talus = require "talus"

local GRAVITY, DENSITY = 10, 2000
local DEPTH, GROUND = 0.2, 0.1 -- across; of the springers
local FRICTION = 60            -- degrees: no joint slides

local voussoirs = { RADIUS = 1, WEIGHT = GRAVITY * DENSITY } -- of the mean line, m; N/m3

function voussoirs.arch(count, thickness, stiffness)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    local inner, outer = voussoirs.RADIUS - thickness / 2, voussoirs.RADIUS + thickness / 2
    for k = 1, count do
        local vertices = {}
        for _, angle in ipairs { math.pi * (k - 1) / count, math.pi * k / count } do
            for _, radius in ipairs { inner, outer } do
                for _, y in ipairs { 0, DEPTH } do
                    vertices[#vertices + 1] = { radius * math.cos(angle), y,
                        radius * math.sin(angle) }
                end
            end
        end
        model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "arch" })
    end
    for _, side in ipairs { { inner, outer }, { -outer, -inner } } do
        model:generate("box", { min = { side[1], 0, -GROUND }, max = { side[2], DEPTH, 0 },
            density = DENSITY, group = "springer" })
    end
    model:blocks { group = "springer" }:fix()
    model:joint("*", "coulomb", { kn = stiffness * voussoirs.WEIGHT, ks = stiffness * voussoirs.WEIGHT, friction = FRICTION })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    return model, model:blocks { group = "arch" }
end

return voussoirs
