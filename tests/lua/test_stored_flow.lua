-- Water that is stored in joints: it follows closed forms whatever the steps, and none is lost.
local talus = require "talus"
local check = require "check"

local GW, MU, BULK, WIDE = 1e4, 1e-3, 2e9, 1e-4 -- N/m3, Pa s, Pa, m

-- A held strip with a level joint, in parts that end at `ends`, m. Water comes in at x = 0.
local function strip(ends, given)
    local length = ends[#ends]
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, -1 }, max = { length, 1, 1 }, density = 2500 })
    model:generate("joint", { joint = "level", dip = 0, dip_direction = 0, origin = { 0, 0, 0 } })
    for k = 1, #ends - 1 do
        model:generate("joint", { joint = "parts", dip = 90, dip_direction = 90, origin = { ends[k], 0, 0 } })
    end
    model:blocks():fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    local with = { joints = "level", aperture = WIDE, viscosity = MU, unit_weight = GW, bulk = BULK, steady = false,
        heads = { { inside = { min = { -1e-3, -1, -1e-3 }, max = { 1e-3, 2, 1e-3 } }, head = 1 } } }
    for key, value in pairs(given or {}) do
        with[key] = value
    end
    model:water("flow", with)
    return model
end

local function even(length, parts)
    local ends = {}
    for k = 1, parts do
        ends[k] = length * k / parts
    end
    return ends
end

-- Heads of the joints along x, and the volume that is stored, m3.
local function heads(model)
    local list, volume = {}, 0
    for _, joint in ipairs(model:flow().joints) do
        local x = 0
        for _, node in ipairs(joint.nodes) do
            x = x + node.rest[1] / #joint.nodes
        end
        list[#list + 1] = { x, joint.head }
        volume = volume + GW * joint.head * joint.area * joint.aperture / BULK
    end
    table.sort(list, function(a, b) return a[1] < b[1] end)
    return list, volume
end

-- Goes on in steps of dt; the volume that has come in, m3.
local function fill(model, dt, steps, every)
    local sum, last = 0, model.time
    model:timestep { dt = dt }
    for k = 1, steps do
        model:cycle(1)
        if (k - 1) % every == 0 and k > 1 then -- this step has found what came since the one `every` steps ago
            sum = sum + model:flow().heads[1].flow * (model.time - dt - last)
            last = model.time - dt
        end
    end
    return sum
end

-- One joint: 1 - exp(-rate t), in one step of any length or many.
local LENGTH = 2
local rate = 2 * WIDE ^ 2 * BULK / (12 * MU * LENGTH ^ 2)
for _, case in ipairs { { 0.01, 200 }, { 0.2, 11 }, { 1, 3 }, { 2, 2 }, { 20, 2 }, { 1e4, 2 } } do
    local dt, steps = case[1] / rate, case[2]
    local model = strip { LENGTH }
    local came = fill(model, dt, steps, 1)
    local list, volume = heads(model)
    check.near(list[1][2], 1 - math.exp(-rate * dt * (steps - 1)), 2e-4)
    check.near(came / volume, 1, 1e-9)
end

-- A strip that fills: heat conduction, closed at its end. Halved cells have a quarter of the error.
local function conduction(x, length, time)
    local sum, d = 1, WIDE ^ 2 * BULK / (12 * MU)
    for m = 1, 399, 2 do
        sum = sum - 4 / (math.pi * m) * math.sin(m * math.pi * x / (2 * length)) *
            math.exp(-m ^ 2 * math.pi ^ 2 * d * time / (4 * length ^ 2))
    end
    return sum
end

local STRIP = 20
local diffusivity = WIDE ^ 2 * BULK / (12 * MU)
local function error_of(ends, share, steps, every)
    local dt = share * STRIP ^ 2 / diffusivity / (steps - 1)
    local model = strip(ends, { every = every })
    local came = fill(model, dt, steps, every)
    local list, volume = heads(model)
    local worst = 0
    for _, one in ipairs(list) do
        worst = math.max(worst, math.abs(one[2] - conduction(one[1], STRIP, dt * (steps - 1))))
    end
    check.near(came / volume, 1, 1e-9)
    return worst
end
local uneven = {}
for k = 1, 30 do
    uneven[k] = STRIP * (k + 0.4 * (k % 2) * (k < 30 and 1 or 0)) / 30
end
for _, share in ipairs { 0.1, 0.4, 1 } do
    local coarse, fine = error_of(even(STRIP, 10), share, 2, 1), error_of(even(STRIP, 20), share, 2, 1)
    check.holds(fine < 0.4 * coarse and fine < 1e-3, "of second order in the size of the cells")
    check.holds(error_of(uneven, share, 2, 1) < 1e-3, "cells of two sizes")
    for _, steps in ipairs { { 41, 1 }, { 41, 4 }, { 41, 40 } } do
        local e = error_of(even(STRIP, 20), share, steps[1], steps[2])
        check.near(e, fine, 1e-4)
    end
end
