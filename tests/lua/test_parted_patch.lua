-- A pillar is cut, and its upper part thrown off. The joint dilates, so slip opens it otherwise at each of its many points. As it parts its
-- patch becomes a field contact of moved faces that has no points: nothing is left that presses, and no energy is made.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local function pillar(radius, top, height, sides)
    local out = {}
    for i = 1, sides do
        local angle = 2 * math.pi * i / sides
        out[#out + 1] = { radius * math.cos(angle), radius * math.sin(angle), 0 }
        out[#out + 1] = { top * math.cos(angle), top * math.sin(angle), height }
    end
    return out
end

for number = 1, 6 do
    local by = 0.85 + 0.05 * number
    local model = talus.model { gravity = { 0, 0, -9.81 }, contact_points = "corners" }
    model:generate("box", { min = { -2.5, -2.5, -1 }, max = { 2.5, 2.5, 0 }, density = 2517, group = "floor" })
    model:blocks():fix()
    model:generate("polyhedron", { vertices = pillar(0.3644, 0.2617, 1.838, 12), density = 2517, group = "pillar" })
    model:joint("*", "coulomb_tensile", { kn = 7.417e8, ks = 9.891e8, friction = 27.37, residual_friction = 19.57, dilation = 19.07,
        cohesion = 4.567e4, tension = 5.917e3 })
    model:timestep { fraction = 0.1 }
    model:damping "local"
    model:solve { max_cycles = 1500, ratio = 1e-6 }
    model:damping "none"
    model:generate("joint", { joint = "C", dip = 57.42, dip_direction = 148.57, origin = { 0, 0, 0.919 } })
    local kicks = { { { 0.3067, -0.0326, 0.0184 }, { 0.1044, -0.3482, 0.3969 } }, { { 0.1417, -0.1534, -0.4119 }, { 0.4876, -0.1343, -0.5342 } } }
    local k = 0
    for _, block in ipairs(model:blocks { group = "pillar" }) do
        k = k + 1
        local v, w = table.unpack(kicks[k])
        model:blocks { id = block.id }:set { velocity = { by * v[1], by * v[2], by * v[3] },
            angular_velocity = { by * w[1], by * w[2], by * w[3] } }
    end
    model:cycle(1)
    local energy = model:energy()
    local most = 2 * (energy.kinetic + energy.stored) + 10
    while model.time < 0.12 do
        model:cycle(20)
        energy = model:energy()
        check.holds(energy.stored < most, ("kick %d: %g J stored of %g"):format(number, energy.stored, most))
    end
    check.near(energy.balance, 0, 3e-3)
end
