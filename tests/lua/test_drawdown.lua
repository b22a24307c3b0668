-- A reservoir before a slope is lowered in stages: fast, with the water in the joints as it was, slowly, and with flow.
local talus = require "talus"
local check = require "check"

local WATER, DIP, FRICTION, DENSITY, G = 1e4, 35, 47, 2500, 10
local rise = math.tan(math.rad(DIP))

-- A block on a plane that daylights at x = 2, with a crack behind it at x = 10; with `parts` it is cut into four.
local function slope(parts)
    local model = talus.model { gravity = { 0, 0, -G } }
    model:generate("box", { min = { 2, 0, -2 }, max = { 14, 1, 12 }, density = DENSITY })
    model:generate("joint", { joint = "P", dip = DIP, dip_direction = 270, origin = { 0, 0, 0 } })
    model:generate("joint", { joint = "C", dip = 90, dip_direction = 90, origin = { 10, 0, 0 } })
    if parts then
        model:generate("joint", { joint = "V", dip = 90, dip_direction = 90, origin = { 6, 0, 0 } })
        model:generate("joint", { joint = "H", dip = 0, dip_direction = 90, origin = { 0, 0, 9 } })
    end
    model:blocks { where = function(one)
        return one.centroid[1] > 10 or one.centroid[3] < one.centroid[1] * rise
    end }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = FRICTION })
    model:joint("C", "coulomb", { kn = 1e7, ks = 1e5, friction = 0 }) -- a crack
    model:damping "local"
    return model
end

local function reservoir(model, level)
    model:boundary { facing = { -1, 0, 0 }, box = { min = { 1, 0, 1 }, max = { 3, 1, 13 } }, water_level = level,
        unit_weight = WATER }
end

local function solve(model)
    return model:solve { measure = "local", ratio = 1e-5, stop_at_failure = true, max_cycles = 100000 }
end

-- Limit equilibrium of the block, with the reservoir and the table in the joints at their levels.
local function factor(outside, inside)
    local a, weight = math.rad(DIP), DENSITY * G * (8 * 12 - rise * (10 ^ 2 - 2 ^ 2) / 2)
    local deep, crack = math.max(0, outside - 2 * rise), math.max(0, inside - 10 * rise)
    local push = WATER * (crack ^ 2 - deep ^ 2) / 2
    local to = math.max(2, math.min(10, inside / rise))
    local uplift = WATER * (inside * (to - 2) - rise * (to ^ 2 - 2 ^ 2) / 2) / math.cos(a)
    local across = weight * math.cos(a) - push * math.sin(a) - uplift
    return across * math.tan(math.rad(FRICTION)) / (weight * math.sin(a) + push * math.cos(a))
end

-- Fast: the table stays. It fails in the first stage whose factor is below 1.
local fast = slope()
fast:water("table", { level = 10, unit_weight = WATER, drain_gap = 0.5 })
local failed
for level = 10, 4, -1 do
    reservoir(fast, level)
    local reason = solve(fast).reason
    local safety = fast:keyblocks { friction = FRICTION }[1].safety
    if reason == "failure" then
        failed = level
        break
    end
    check.equal(reason, "ratio")
    check.near(safety, factor(level, 10), 2e-3)
    check.holds(math.abs(fast:energy().balance) < 1e-3)
end
check.equal(failed, 6)
check.holds(factor(7, 10) > 1 and factor(6, 10) < 1)

-- Slowly: the table goes with it, and the slope stands at every level.
local slow = slope()
for level = 10, 3, -1 do
    slow:water("table", { level = level, unit_weight = WATER })
    reservoir(slow, level)
    check.equal(solve(slow).reason, "ratio")
    check.near(slow:keyblocks { friction = FRICTION }[1].safety, factor(level, level), 2e-3)
end
check.refused(slow, function() slow:boundary { facing = { -1, 0, 0 }, water_level = -5 } end, "pressure = 0")
slow:boundary { facing = { -1, 0, 0 }, box = { min = { 1, 0, 1 }, max = { 3, 1, 13 } }, pressure = 0 }
slow:water "none"
check.equal(solve(slow).reason, "ratio")
check.near(slow:keyblocks { friction = FRICTION }[1].safety, factor(0, 0), 2e-3)

-- With flow to the reservoir: what comes in behind goes out in front, the more the lower it is.
local wet, before = slope(true), -1
for level = 11, 8, -1 do
    reservoir(wet, level)
    wet:water("flow", { aperture = 2e-4, unit_weight = WATER, every = 20, joints = { "P", "C", "V" }, heads = {
        { inside = { min = { 1.9, -1, 2 * rise - 0.1 }, max = { 2.1, 2, 2 * rise + 0.1 } }, head = level },
        { inside = { min = { 9.9, -1, 9 }, max = { 10.1, 2, 13 } }, head = 11 } } })
    check.equal(solve(wet).reason, "ratio")
    local flow = wet:flow()
    check.near(flow.heads[1].flow + flow.heads[2].flow, 0, 1e-9 * math.abs(flow.heads[2].flow) + 1e-13)
    check.holds(flow.heads[2].flow > before, "more flows")
    check.holds(math.abs(wet:energy().balance) < 1e-3)
    before = flow.heads[2].flow
end
