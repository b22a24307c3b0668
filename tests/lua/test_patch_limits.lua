-- How far a patch goes: bonds hold two faces up to a tilt of asin 0.05, and springs at corners bear as springs until they are pressed
-- in by a tenth of the root of the face's area.
local check = require "check"
local talus = require "talus"

local KN = 1e7 -- Pa/m

-- A cube of 1 m on a fixed floor, without weight, on a joint of a law.
local function build(points, law, params)
    local model = talus.model { gravity = { 0, 0, 0 }, contact_points = points }
    model:generate("box", { { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = 2500 },
        { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 1 }, density = 2500 } })
    model:blocks { id = 1 }:fix()
    params.kn, params.ks, params.friction = KN, KN, 40
    model:joint("*", law, params)
    model:damping "local"
    return model, model:blocks { id = 2 }
end

local function tilt_of(block)
    local q = block[1].rotation
    return 2 * math.atan(q[3], q[1])
end

-- A bond out of reach holds the moment kn b^4 / 12 times the tilt, far beyond the 0.05 degrees of a patch without bonds, and is lost
-- between 2.5 and 3 degrees (asin 0.05 is 2.87), after which nothing holds the cube.
local model, cube = build("consistent", "coulomb_tensile", { tension = 1e12, cohesion = 1e12 })
local function bend(degrees)
    cube:load { force = { 0, 0, -1e-4 * KN }, moment = { 0, KN / 12 * math.sin(math.rad(degrees)), 0 } }
    return model:solve { ratio = 1e-6, max_cycles = 20000, every = 50, stop = function() return tilt_of(cube) > 0.2 end }.reason
end
for _, degrees in ipairs { 0.5, 1, 1.5, 2, 2.5 } do
    check.equal(bend(degrees), "ratio")
    check.near(tilt_of(cube) / math.rad(degrees), 1, 2e-3) -- the load comes down with the tilt: sin^2 of 2.5 degrees
end
check.equal(bend(3), "stop")

-- Springs at corners: N = kn A c, exactly, up to a tenth of the root of the area. The default points pass into the pressure field from
-- 0.004 on, which bears less by c P / (4 A): 5 percent at c = 0.05.
for _, closure in ipairs { 0.01, 0.05, 0.09 } do
    model, cube = build("corners", "coulomb", {})
    cube:load { force = { 0, 0, -KN * closure } }
    check.equal(model:solve { ratio = 1e-8, max_cycles = 20000 }.reason, "ratio")
    check.near(-cube[1].displacement[3] / closure, 1, 1e-6)
end
model, cube = build("corners", "coulomb", {})
cube:load { force = { 0, 0, -KN * 0.3 } }
model:solve { ratio = 1e-8, max_cycles = 20000 }
check.holds(-cube[1].displacement[3] > 1.1 * 0.3, "deeper than a fifth of the root of the area the pressure field bears")
