-- An undamped column of four blocks that a record rocks: the balance is of second order in the step, elements included.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local G, PERIOD, STEP = 9.81, 0.8, 0.005

-- Four periods of a ground acceleration of 4 m/s2.
local at = {}
for i = 0, 800 do
    local t = i * STEP
    at[#at + 1] = t < 4 * PERIOD and 4 * math.sin(2 * math.pi * t / PERIOD) or 0
end
local shake = talus.record { at = at, dt = STEP, quantity = "acceleration" }

-- The worst balance in 2 s.
local function rock(dt, elements)
    local model = talus.model { gravity = { 0, 0, -G } }
    model:generate("box", { min = { -2, -2, -1 }, max = { 2, 2, 0 }, density = 2000, group = "base" })
    for k = 1, 4 do
        model:generate("box", { min = { -0.5, -0.5, k - 1 }, max = { 0.5, 0.5, k }, density = 2000, group = "column" })
    end
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    model:blocks { group = "base" }:fix()
    model:damping "local"
    model:solve { ratio = 1e-7 }
    model:damping "none"
    if elements then
        model:element("spring", { from = { 0, 0, 2.5 }, to = { 6, 0, 2.5 }, stiffness = 1e5, damping = 500 })
        model:element("bolt", { from = { 0.3, 0, 4 }, to = { 0.3, 0, 2.5 }, diameter = 0.025 })
    end
    model:blocks { group = "base" }:drive { velocity = { shake, 0, 0 } }
    model:timestep { dt = dt }
    local worst, moved = 0, 0
    local top = model:blocks { group = "column" }[4]
    local begin = model.time
    while model.time < begin + 2 do
        model:cycle(50)
        worst = math.max(worst, math.abs(model:energy().balance))
        moved = math.max(moved, math.abs(top.angular_velocity[2]))
    end
    check.holds(moved > 0.2, "it rocks")
    return worst
end

for _, elements in ipairs { false, true } do
    local coarse, fine = rock(2e-4, elements), rock(5e-5, elements)
    check.holds(coarse < 2e-3, "a step of 0.2 ms")
    check.holds(fine < 2e-4 and fine < coarse / 8, "a quarter of it")
end
