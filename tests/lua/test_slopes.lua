-- Contacts that stay near a place go by the slopes of their force there. What vibrates, within or beyond where these are
-- used, and what creeps goes on as with contacts that are integrated in every step.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local talus = require "talus"

local KN, SIZE = 1e9, 1.2 -- Pa/m, m
local FRICTION, FRACTION = 35, 0.2
local STEPS, SOME = 20000, 1000
local SAME = 1e-4    -- share by which slopes may change kinetic energies and ways
local BALANCE = 1e-5 -- of the ledger
local PARTS = { 1e-6, 1e-5, 1e-4, 1e-3, 1e-2 } -- amplitudes, over the overlap

-- A plate on three tips, at rest in the same place whether slopes are used from then on or not.
local function plate(reuse)
    local model = talus.model { gravity = { 0, 0, -9.81 }, reuse_geometry = false }
    local tips = { { -0.4, -0.3 }, { 0.45, -0.25 }, { 0.05, 0.4 } }
    for _, at in ipairs(tips) do
        local x, y = at[1], at[2]
        model:generate("polyhedron", { density = 2600, group = "tips", vertices = {
            { x, y, 0 }, { x - 0.1, y - 0.08, -0.2 }, { x + 0.12, y - 0.05, -0.2 }, { x, y + 0.1, -0.2 },
        } })
    end
    model:generate("box", { density = 2600, group = "plate",
        min = { -SIZE / 2, -SIZE / 2, 0 }, max = { SIZE / 2, SIZE / 2, 0.3 } })
    model:blocks { group = "tips" }:fix()
    model:joint("*", "coulomb", { kn = KN, ks = KN / 2, friction = FRICTION })
    model:damping("local", { alpha = 0.8 })
    model:timestep { fraction = FRACTION }
    model:solve { ratio = 1e-9, max_cycles = 60000 }
    model.reuse_geometry = reuse
    model:cycle(2000)
    return model
end

-- Mean kinetic energy over some steps.
local function kinetic(model, steps)
    local sum = 0
    for _ = 1, steps do
        model:cycle(1)
        sum = sum + model:energy().kinetic
    end
    return sum / steps
end

local overlap = 0
for _, contact in ipairs(plate(true):contacts()) do
    overlap = math.max(overlap, -contact.gap)
end
for _, part in ipairs(PARTS) do
    local kept = {}
    for _, reuse in ipairs { true, false } do
        local model = plate(reuse)
        model:damping "none"
        local speed = part * overlap / (model.dt / FRACTION)
        model:blocks { group = "plate" }:set { velocity = { 0.3 * speed, 0.2 * speed, speed },
            angular_velocity = { 0.1 * speed, 0.2 * speed, 0.3 * speed } }
        local first = kinetic(model, SOME)
        model:cycle(STEPS)
        kept[#kept + 1] = kinetic(model, SOME) / first
        check.holds(math.abs(model:energy().balance) < BALANCE, "the energy ledger")
    end
    check.near(kept[1], kept[2], SAME * kept[2])
end

-- On a floor that is tilted slowly it begins to slide at the same time, and as far.
local slid = {}
for _, reuse in ipairs { true, false } do
    local model = plate(reuse)
    local start = model:blocks { group = "plate" }[1].centroid
    for k = 0, 100 do
        local tilt = math.rad(FRICTION - 0.5 + 0.01 * k)
        model.gravity = { 9.81 * math.sin(tilt), 0, -9.81 * math.cos(tilt) }
        model:cycle(50)
    end
    slid[#slid + 1] = model:blocks { group = "plate" }[1].centroid[1] - start[1]
end
check.holds(slid[2] > 1e-3, "that it slides")
check.near(slid[1], slid[2], SAME * slid[2])
