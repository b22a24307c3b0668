-- parts.lua - bodies cut by random planes and joined again, which are to press as the whole does.
--
--     parts.add(model, group, vertices, cuts)   a body in parts
--     parts.random_cuts(random, vertices, count)
--     parts.convex(seed), parts.inward(seed)    two random bodies pressed into each other, whole and in parts: how far the sums of force and
--                                               moment are from those of the whole, of how far they may be; and the force, N
local shapes = require "shapes"
local talus = require "talus"

local parts = { DENSITY = 2500, KN = 1e8, NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
local DENSITY, KN, NONE = parts.DENSITY, parts.KN, parts.NONE
-- Sums over the parts of a convex body, over those of the whole.
local ROUNDING = 1e-9
local STRIP = 3 -- kn overlap^2 per metre of edge

local function distance(a, b)
    return shapes.length(shapes.sum(a, -1, b))
end

-- Random planes, each through a point between the middle of the vertices and one of them.
function parts.random_cuts(random, vertices, count)
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

function parts.add(model, group, vertices, cuts)
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
    parts.add(model, "lower", lower, lower_cuts)
    return press(model, parts.add(model, "upper", upper, upper_cuts))
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

-- Fields are the same to the last digits. Flush parts go over from patches to fields by the overlap over the size of their own areas,
-- which makes a difference in a strip as wide as the overlap: kn overlap^2 per metre.
function parts.convex(seed)
    local random = shapes.random(seed)
    local s = drawn(random, seed)
    local whole, worst = pressed(s.lower, s.upper, {}, {}), 0
    local force = shapes.length(whole.force)
    for count = 1, 3 do
        local cut_up = pressed(s.lower, s.upper, parts.random_cuts(random, s.lower, count),
            parts.random_cuts(random, s.upper, 4 - count))
        worst = math.max(worst, off(cut_up, whole) / (ROUNDING * force + (s.hulls and 0 or STRIP * KN * s.deep ^ 2)))
    end
    return worst, force
end

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

-- Bodies that turn inward: there too it makes no more difference than that.
function parts.inward(seed)
    local random = shapes.random(1000 + seed)
    local s = drawn(random, seed)
    local a, b = parts.random_cuts(random, s.lower, 2), parts.random_cuts(random, s.upper, 2)
    local function go(more_a, more_b)
        local model = talus.model { gravity = { 0, 0, 0 } }
        carved(model, "lower", s.lower, a, seed, more_a)
        return press(model, carved(model, "upper", s.upper, b, seed + 1, more_b))
    end
    local whole, worst = go({}, {}), 0
    local force = shapes.length(whole.force)
    for count = 1, 3 do
        local cut_up = go(parts.random_cuts(random, s.lower, count), parts.random_cuts(random, s.upper, 4 - count))
        worst = math.max(worst, off(cut_up, whole) / (ROUNDING * force + STRIP * KN * s.deep ^ 2))
    end
    return worst, force
end

return parts
