-- A bonded box stands over the edge of a floor. Its bond, strong in tension and weak in shear, breaks as the box begins to tip. Then nothing
-- holds the faces on each other, and the box tips on their edge as one that was never bonded: without friction nothing makes heat any
-- more, and no energy is made.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local function between(least, most)
    return least + (most - least) * math.random()
end

local function tips(law, seed)
    math.randomseed(seed)
    local points = seed % 3 == 0 and "consistent" or "corners"
    local kn, over = 1e8 * 10 ^ between(0, 1), between(0.3, 0.39)
    local ks, cohesion = kn * between(0.3, 1.5), 10 ^ between(3, 3.5)
    local params = { kn = kn, ks = ks, tension = 5e5, cohesion = cohesion, friction = 0 }
    if law == "cohesive" then
        params.gi, params.gii = 1e13 / kn, 5 * cohesion ^ 2 / ks
    end
    local model = talus.model { gravity = { 0, 0, -9.81 }, contact_points = points }
    model:generate("box", { min = { -2.5, -2.5, -1 }, max = { 2.5, 2.5, 0 }, density = 2500, group = "floor" })
    model:generate("box", { min = { 2.5 - over, -0.4, 0 }, max = { 3.3 - over, 0.4, 1 }, density = 2500, group = "box" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", law, params)
    model:timestep { fraction = 0.1 }
    model:blocks { group = "box" }:set { velocity = { between(0.01, 0.03), between(0.01, 0.03), 0 },
        angular_velocity = { 0, between(0, 0.06), between(0.02, 0.06) } }
    model:cycle(1)
    local function sum(energy)
        return energy.kinetic + energy.potential + energy.stored
    end
    local begun, top, fall, gain, largest = sum(model:energy()), 0, 0, 0, 0
    while model.time < 0.15 do
        model:cycle(10)
        local energy = model:energy()
        top = math.max(top, energy.friction)
        fall = math.max(fall, top - energy.friction)
        gain = math.max(gain, sum(energy) - begun)
        largest = math.max(largest, energy.kinetic, math.abs(energy.potential))
    end
    local what = ("%s, %s points, seed %d"):format(law, points, seed)
    check.holds(fall < 1e-4 * largest, ("%s: heat falls by %g of %g J"):format(what, fall, largest))
    check.holds(gain < 3e-4 * largest, ("%s: gains %g of %g J"):format(what, gain, largest))
    check.holds(math.abs(model:energy().balance) < 5e-4, ("%s: balance %g"):format(what, model:energy().balance))
    return top > 0 and 1 or 0
end

local broke = 0
for _, law in ipairs { "cohesive", "coulomb_tensile" } do
    for seed = 1, 9 do
        broke = broke + tips(law, seed)
    end
end
check.holds(broke >= 12, ("only %d of 18 bonds broke"):format(broke))
