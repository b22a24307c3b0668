-- A block slides on a joint that dilates as theory has it, in the long steps of a run: it keeps touching, though a step lifts it by
-- more than its weight closes the joint.
--
-- With the pressure N = m (g cos(dip) + a sin(dilation)) and friction N tan(friction) the acceleration along its path is
--     a = g (sin(dip) - cos(dip) tan(friction)) / (cos(dilation) + sin(dilation) tan(friction))
local talus = require "talus"
local check = require "check"

local DIP, FRICTION, G, SIDE, DENSITY, TIME = math.rad(45), 12, 10, 1, 2500, 0.3

local function slide(dilation, kn)
    local m = talus.model { gravity = { G * math.sin(DIP), 0, -G * math.cos(DIP) } }
    m:generate("box", { { min = { -5, -1, -1 }, max = { 50, 2, 0 }, density = DENSITY, group = "plane" },
        { min = { 0, 0, 0 }, max = { SIDE, SIDE, SIDE }, density = DENSITY, group = "block" } })
    m:blocks { group = "plane" }:fix()
    local block = m:blocks { group = "block" }
    block:fix { rotation = true }
    m:joint("*", "coulomb", { kn = kn, ks = kn, friction = 60 })
    m:relax { ratio = 1e-9 }
    m:joint("*", "coulomb", { kn = kn, ks = kn, friction = FRICTION, dilation = dilation })
    block:reset_displacement()
    local lifted, closed = 0, DENSITY * SIDE * G * math.cos(DIP) / kn
    m:cycle(1)
    while m.time < TIME do
        local before = block[1].displacement[3]
        m:cycle(1)
        lifted = math.max(lifted, block[1].displacement[3] - before)
    end
    local angle, tangent = math.rad(dilation), math.tan(math.rad(FRICTION))
    local a = G * (math.sin(DIP) - math.cos(DIP) * tangent) / (math.cos(angle) + math.sin(angle) * tangent)
    local way, u, energy = a * TIME ^ 2 / 2, block[1].displacement, m:energy()
    local weight = DENSITY * SIDE ^ 3
    check.holds(lifted > closed, ("a step lifts by %g m, more than weight closes, %g m"):format(lifted, closed))
    local scale = (m.time / TIME) ^ 2
    check.near(u[1], scale * way * math.cos(angle), 0.01 * way)
    check.near(u[3], scale * way * math.sin(angle), 0.02 * way * math.sin(angle))
    check.near(m:contacts()[1].normal_force, weight * (G * math.cos(DIP) + a * math.sin(angle)), 0.01 * weight * G)
    check.near(energy.balance, 0, 1e-4 * energy.friction)
end

for _, kn in ipairs { 1e8, 1e9, 1e10 } do
    slide(5, kn)
end
slide(10, 1e9)
