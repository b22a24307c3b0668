-- A body of parts is the body: cut by random planes and joined again it presses, moves and rests as before, and no inner face
-- is ever an overlap. Depth in a convex body is the same however it is cut, and so is all that follows from it. Where a body
-- turns inward the parts see a little more or less of it, as far as they overlap.
local talus = require "talus"
local check = require "check"
local shapes = require "shapes"

local DENSITY, KN = 2500, 1e8
local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
-- Sums over the parts of a convex body, over those of the whole.
local ROUNDING = 1e-9
local STRIP = 3 -- kn overlap^2 per metre of edge

local function distance(a, b)
    return shapes.length(shapes.sum(a, -1, b))
end

-- Random planes, each through a point between the middle of the vertices and one of them.
local function random_cuts(random, vertices, count)
    local cuts, middle = {}, { 0, 0, 0 }
    for _, v in ipairs(vertices) do
        middle = shapes.sum(middle, 1 / #vertices, v)
    end
    for i = 1, count do
        local toward = vertices[1 + math.floor(random(0, #vertices - 1e-6))]
        cuts[i] = { dip = random(0, 90), dip_direction = random(0, 360), joint = "cut",
            origin = shapes.sum(middle, random(0, 0.8), shapes.sum(toward, -1, middle)) }
    end
    return cuts
end

-- Cuts the blocks of a group, and no others.
local function cut(model, group, cuts)
    local others = model:blocks { where = function(b) return b.group ~= group end }
    if #others > 0 then
        others:hide()
    end
    for _, plane in ipairs(cuts) do
        model:generate("joint", plane)
    end
    if #others > 0 then
        others:show()
    end
end

-- Joins the blocks of a group; the first of them.
local function joined(model, group)
    local body = model:blocks { group = group }
    if #body > 1 then
        body:join()
    end
    return body
end

local function add(model, group, vertices, cuts)
    model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = group })
    cut(model, group, cuts)
    return joined(model, group)
end

-- The force on the upper of two bodies at a place, and its moment about its centroid.
local function press(model, upper)
    model:blocks { group = "lower" }:fix()
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 0 })
    model:timestep { dt = 1e-9 }
    model:cycle(1)
    return { force = upper[1].force, moment = upper[1].moment }
end

local function pressed(lower, upper, lower_cuts, upper_cuts)
    local model = talus.model { gravity = { 0, 0, 0 } }
    add(model, "lower", lower, lower_cuts)
    return press(model, add(model, "upper", upper, upper_cuts))
end

-- How far forces and moments of 1 m are from others, N.
local function off(got, wanted)
    return math.max(distance(got.force, wanted.force), distance(got.moment, wanted.moment))
end

-- Two shapes that overlap by `deep` somewhere: hulls at their corners and edges, boxes flush or nearly so at their faces.
local function drawn(random, seed)
    local s = { hulls = seed % 3 == 0, way = { 0, 0, 1 }, deep = 10 ^ random(-6, -2) }
    if s.hulls then
        s.way, s.deep = shapes.direction(random), 10 ^ random(-3, -1)
        s.lower = shapes.hull(random, 8 + seed % 7, 1)
        s.upper = shapes.placed(shapes.hull(random, 9, 0.7), shapes.attitude(random))
    else
        local tilt = seed % 3 == 1 and 0 or 10 ^ random(-4, -1)
        s.lower = shapes.box(1.4, 1.6, 0.6)
        s.upper = shapes.placed(shapes.box(1, 0.7, 0.5), shapes.product(shapes.turn(shapes.direction(random), tilt),
            shapes.turn({ 0, 0, 1 }, random(0, 3))))
    end
    local aside = s.hulls and { 0, 0, 0 } or { random(-0.4, 0.4), random(-0.4, 0.4), 0 }
    s.upper = shapes.placed(s.upper, NONE, shapes.sum(aside, shapes.beyond(s.lower, s.upper, s.way, -s.deep), s.way))
    return s
end

-- 1. Convex bodies. Fields are the same to the last digits. Flush parts go over from patches to fields by the overlap over the
-- size of their own areas, which makes a difference in a strip as wide as the overlap: kn overlap^2 per metre.
local MOST = tonumber(arg and arg[1]) or check.cases(40)
local presses = 0
for seed = 1, MOST do
    local random = shapes.random(seed)
    local s = drawn(random, seed)
    local whole = pressed(s.lower, s.upper, {}, {})
    local force = shapes.length(whole.force)
    presses = presses + (force > 0 and 1 or 0)
    for count = 1, 3 do
        local parts = pressed(s.lower, s.upper, random_cuts(random, s.lower, count), random_cuts(random, s.upper, 4 - count))
        local most = ROUNDING * force + (s.hulls and 0 or STRIP * KN * s.deep ^ 2)
        check.near(off(parts, whole), 0, most)
    end
end
check.holds(presses > MOST / 2, "most press")

-- A body that turns inward: a body in pieces without one of them, in pieces that are cut on.
local function carved(model, group, vertices, pieces, without, cuts)
    model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = group })
    cut(model, group, pieces)
    local all = model:blocks { group = group }
    if #all > 2 then
        model:blocks { id = all[1 + without % #all].id }:delete()
    end
    cut(model, group, cuts)
    return joined(model, group)
end

-- 2. Bodies that turn inward: there too it makes no more difference than that.
presses = 0
for seed = 1, MOST do
    local random = shapes.random(1000 + seed)
    local s = drawn(random, seed)
    local a, b = random_cuts(random, s.lower, 2), random_cuts(random, s.upper, 2)
    local function go(more_a, more_b)
        local model = talus.model { gravity = { 0, 0, 0 } }
        carved(model, "lower", s.lower, a, seed, more_a)
        return press(model, carved(model, "upper", s.upper, b, seed + 1, more_b))
    end
    local whole = go({}, {})
    presses = presses + (shapes.length(whole.force) > 0 and 1 or 0)
    for count = 1, 3 do
        local parts = go(random_cuts(random, s.lower, count), random_cuts(random, s.upper, 4 - count))
        local most = ROUNDING * shapes.length(whole.force) + STRIP * KN * s.deep ^ 2
        check.near(off(parts, whole), 0, most)
    end
end
check.holds(presses > MOST / 2, "most press")

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
