-- A body of parts is the body: cut by random planes and joined again it presses, moves and rests as before, and no inner face
-- is ever an overlap. Depth in a convex body is the same however it is cut, and so is all that follows from it. Where a body
-- turns inward the parts see a little more or less of it, as far as they overlap.
-- tests/verify/long/parts.lua tries many more.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"
local orders = require "orders"
local parts = require "parts"
local shapes = require "shapes"

local DENSITY, KN, NONE = parts.DENSITY, parts.KN, parts.NONE
local add, random_cuts = parts.add, parts.random_cuts

-- 1, 2. Convex bodies, and bodies that turn inward, press as the whole does.
local MOST = tonumber(arg and arg[1]) or check.cases(40)
for _, try in ipairs { parts.convex, parts.inward } do
    local presses = 0
    for seed = 1, MOST do
        local off, force = try(seed)
        check.near(off, 0, 1)
        presses = presses + (force > 0 and 1 or 0)
    end
    check.holds(presses > MOST / 2, "most press")
end

-- 3. A body that falls on a floor, both in parts, moves and comes to rest as the whole does.
local function centre_of(body)
    local sum, volume = { 0, 0, 0 }, 0
    for _, part in ipairs(body) do
        sum, volume = shapes.sum(sum, part.volume, part.centroid), volume + part.volume
    end
    return shapes.sum({ 0, 0, 0 }, 1 / volume, sum)
end

local function fallen(vertices, body_cuts, floor_cuts)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    add(model, "floor", shapes.placed(shapes.box(4, 4, 1), NONE, { 0, 0, -0.5 }), floor_cuts):fix()
    local body = add(model, "body", vertices, body_cuts)
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 30 })
    model:damping "local"
    model:timestep { dt = 2e-4 }
    model:cycle(1000)
    local place = centre_of(body)
    return place, model:solve { ratio = 1e-5, max_cycles = 60000 }.reason, centre_of(body)
end

for seed = 1, math.max(1, MOST // 20) do
    local random = shapes.random(2000 + seed)
    local floor = shapes.placed(shapes.box(4, 4, 1), NONE, { 0, 0, -0.5 })
    local vertices = seed % 2 == 0 and shapes.box(1, 0.7, 0.5) or shapes.hull(random, 9, 0.7)
    vertices = shapes.placed(vertices, shapes.attitude(random))
    vertices = shapes.placed(vertices, NONE, { 0, 0, 0.002 + shapes.farthest(vertices, { 0, 0, -1 }) })
    local place, reason, rest = fallen(vertices, {}, {})
    local place_in_parts, reason_in_parts, rest_in_parts = fallen(vertices, random_cuts(random, vertices, 3), random_cuts(random, floor, 3))
    check.near(place_in_parts, place, 1e-4)
    check.equal(reason, "ratio")
    check.equal(reason_in_parts, "ratio")
    check.near(rest_in_parts[3], rest[3], 1e-6)
    check.near(rest_in_parts, rest, 0.02) -- they have slid along the floor, each in its time
end

-- 4. L profiles, which are generated in parts: pressed together by 1000 N on 1 m2, and side by side on a floor. Nothing is refused,
-- and no number is nan.
local HEIGHT = 3
local L = { { 0, 0 }, { 1, 0 }, { 1, 0.3 }, { 0.4, 0.3 }, { 0.4, 1 }, { 0, 1 } }

local function profile(model, group, shift, mirrored)
    local section = {}
    for i, p in ipairs(L) do
        section[mirrored and #L + 1 - i or i] = { (mirrored and -p[1] or p[1]) + shift, p[2] }
    end
    model:generate("profile", { section = section, to = 1, density = DENSITY, group = group })
    return model:blocks { group = group }
end

local function sound(model)
    for _, contact in ipairs(model:contacts()) do
        check.near(shapes.length(contact.normal), 1, 1e-12)
        check.holds(contact.normal_force >= 0, "forces are numbers")
    end
end

for _, overlap in ipairs { 0, 1e-10, 1e-6 } do
    local model = talus.model { gravity = { 0, 0, 0 } }
    local pushed = profile(model, "pushed", -overlap, false)
    profile(model, "held", 0, true):fix()
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 35 })
    model:damping "local"
    pushed:load { force = { -1000, 0, 0 } }
    check.equal(model:solve { ratio = 1e-6, max_cycles = 5000 }.reason, "ratio")
    -- the closure is linear over the joint, for the force acts below its middle
    local centre, part = centre_of(pushed), pushed[1]
    local closure = 1000 / KN * (1 + 12 * (0.5 - centre[HEIGHT]) * (0.5 - part.centroid[HEIGHT]))
    check.near(-part.displacement[1] + overlap, closure, 1e-9)
    sound(model)
end

for _, overlap in ipairs { 1e-14, 1e-9, 1e-6, 1e-4 } do
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    profile(model, "right", -overlap, false)
    profile(model, "left", -1, false)
    model:generate("box", { min = { -2, -1, -1 }, max = { 2, 2, 0 }, density = DENSITY, group = "floor" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    model:damping "local"
    for _ = 1, 40 do
        model:cycle(10)
        sound(model)
    end
end

-- 5. The order of parts decides nothing: a leaning mast with a chip on its side, which is its first part or its last.
local function mast(chip_at)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    model:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = DENSITY, group = "floor" })
    local parts = { { min = { -0.1, -0.5, 0 }, max = { 0.1, 0.5, 6 } }, { min = { 0, -0.5, 6 }, max = { 0.2, 0.5, 6.5 } } }
    table.insert(parts, chip_at, { min = { -0.01, -0.52, 3 }, max = { 0.01, -0.5, 3.02 } })
    for _, part in ipairs(parts) do
        part.density, part.group = DENSITY, "mast"
    end
    model:generate("box", parts)
    model:blocks { group = "mast" }:join()
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 3e8, ks = 3e8, friction = 35 })
    model:damping "local"
    return model:solve { ratio = 1e-5, stop_at_failure = true, max_cycles = 6000 }.reason
end
check.equal(mast(1), mast(3))

-- Nor does their number: filters and verdicts are of the body. tests/verify/long/orders.lua tries many more.
for seed = 1, MOST do
    check.near(orders.shapes(seed), 0, 1e-9)
    local said, topples, differs = orders.verdicts(seed)
    check.equal(differs, nil)
    check.equal(said:find("^failure") ~= nil, topples)
end
