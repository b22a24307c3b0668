-- Bonds that break make no energy: what they had stored, by the work of the forces that did act, is heat. Blocks of random shape are
-- thrown off their base, pulled, bent, sheared and twisted at once, until the last bond is gone.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

-- Residual tension: walls that have parted are not pulled in again before they have met; then it holds once more. Each parting costs
-- T^2 / (2 kn).
local KN, LEFT = 1e9, 5e4
local curve = talus.law_test {
    law = "coulomb_tensile",
    params = { kn = KN, ks = KN, friction = 30, tension = 1e5, cohesion = 2e5, residual_tension = LEFT },
    path = { { closure = -1e-3 }, { closure = -1e-5 }, { closure = -1e-3 }, { closure = 1e-5 }, { closure = -4e-5 },
        { closure = -1e-3 } },
    steps = 2000
}
local ends, heat = curve.ends, curve.heat
local CROSSING = KN * (1.01e-3 / 2000) ^ 2 / 8 -- what a mean force is wrong by where walls meet or part within a step
for i = 1, #curve.time do
    check.near(curve.work[i] - curve.stored[i] - heat[i], 0, 3 * CROSSING)
end
check.near(heat[ends[1]], 1e5 ^ 2 / (2 * KN), 2e-2 * heat[ends[1]]) -- to half a step
for i = ends[1], ends[3] do
    check.equal(curve.normal_stress[i], 0)
end
check.near(curve.normal_stress[ends[5]], -4e-5 * KN, 1e-9 * LEFT)
check.near(heat[ends[6]] - heat[ends[1]], LEFT ^ 2 / (2 * KN), 2e-2 * heat[ends[1]])

-- A block on a foot of `sides` corners.
local function thrown(law, params, points, seed)
    math.randomseed(seed)
    local sides, speed, vertices = math.random(3, 7), 0.1 + 0.5 * math.random(), {}
    for j = 1, sides do
        local a = 2 * math.pi * j / sides
        vertices[#vertices + 1] = { 0.5 * math.cos(a), 0.5 * math.sin(a), 0 }
        vertices[#vertices + 1] = { 0.5 * math.cos(a), 0.5 * math.sin(a), 0.8 }
    end
    local function random()
        return speed * (2 * math.random() - 1)
    end
    local model = talus.model { gravity = { 0, 0, 0 }, contact_points = points }
    model:generate("box", { min = { -2, -2, -1 }, max = { 2, 2, 0 }, density = 2500, group = "floor" })
    model:generate("polyhedron", { vertices = vertices, density = 2500, group = "thrown" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", law, params)
    model:timestep { fraction = 0.1 }
    model:blocks { group = "thrown" }:set { velocity = { random(), random(), math.abs(random()) },
        angular_velocity = { random(), random(), random() } }
    local worst, last, put_in = 0, 0, model:blocks { group = "thrown" }[1].kinetic_energy
    for _ = 1, 100 do
        model:cycle(10)
        local energy = model:energy()
        worst = math.max(worst, math.abs(energy.balance))
        check.holds(energy.friction >= last - 1e-4 * put_in, ("%s: heat falls by %g J"):format(law, last - energy.friction))
        last = energy.friction
    end
    check.holds(worst < 1e-3, ("%s, %s points, seed %d: balance %g"):format(law, points, seed, worst))
    return last
end

local K, T = 5e8, 5e4
local laws = {
    { "coulomb_tensile", { kn = K, ks = K, friction = 30, tension = T, cohesion = 2 * T } },
    { "coulomb_tensile", { kn = K, ks = K, friction = 30, tension = T, cohesion = 2 * T, residual_tension = T / 3,
        residual_cohesion = T / 4, residual_friction = 20 } },
    { "cohesive", { kn = K, ks = K, friction = 30, tension = T, cohesion = 2 * T, gi = 5 * T ^ 2 / K, gii = 20 * T ^ 2 / K } },
    { "glue", { stiff = K, soft = K, angle = 30, strength = T } }
}
for _, law in ipairs(laws) do
    local broke = 0
    for seed = 1, 8 do
        for _, points in ipairs { "consistent", "corners" } do
            broke = broke + (thrown(law[1], law[2], points, seed) > 0 and 1 or 0)
        end
    end
    check.holds(broke >= 12, ("%s: only %d of 16 broke"):format(law[1], broke))
end

-- A heptagon tilts beyond 5 degrees while its bond, softened and not yet broken, still pulls: its springs at the corners end with the
-- contact, and what they held is heat.
local S, strength, foot = 3.55e8, 8.22e4, {}
for j = 1, 7 do
    local a = 2 * math.pi * j / 7
    foot[#foot + 1] = { 0.5 * math.cos(a), 0.5 * math.sin(a), 0 }
    foot[#foot + 1] = { 0.5 * math.cos(a), 0.5 * math.sin(a), 0.8 }
end
local model = talus.model { gravity = { 0, 0, 0 }, contact_points = "corners" }
model:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = 2500, group = "floor" })
model:generate("polyhedron", { vertices = foot, density = 2500, group = "thrown" })
model:blocks { group = "floor" }:fix()
model:joint("*", "cohesive", { kn = S, ks = S, friction = 30, tension = strength, cohesion = 2 * strength,
    gi = 5 * strength ^ 2 / S, gii = 20 * strength ^ 2 / S })
model:timestep { fraction = 0.2 }
model:blocks { group = "thrown" }:set { velocity = { 0.122, -0.289, 0.304 }, angular_velocity = { 0.151, 0.506, 0.188 } }
local pulled = 0
while #model:contacts() > 0 and model.time < 0.3 do
    pulled = model:contacts():sum "normal_force"
    model:cycle(1)
end
check.holds(pulled < -1000, "the bond pulls to the end")
check.near(model:energy().balance, 0, 1e-3)
