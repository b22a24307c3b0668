-- Which pairs of blocks model:seat takes as fitting already, and which it leaves as drawn: the limits of detect/fit.c and cycle/seat.c.
local check = require "check"
local jittered = require "jittered"
local shapes = require "shapes"
local talus = require "talus"

local DENSITY = 2500

local function seat(model, limits)
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    return model:seat(limits or {})
end

local function place_of(random)
    local turn = shapes.attitude(random)
    local shift = { random(-10, 10), random(-10, 10), random(-10, 10) }
    return function(x) return shapes.sum(shapes.apply(turn, x), 1, shift) end
end

-- ---- what fits to the rounding of places is left (FITS) ----

for seed = 1, 4 * check.cases(10) do
    local random = shapes.random(seed)
    -- stones that were drawn one by one
    local wall = talus.model {}
    jittered.wall(wall, { jitter = 0, place = place_of(random), density = DENSITY })
    local result = seat(wall)
    check.equal(result.contacts, 0)
    check.equal(#result.beyond, 0)
    -- and parts of a block, slender ones among them
    local rock = talus.model {}
    rock:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = DENSITY })
    for k = 1, 5 do
        rock:generate("joint", { joint = "J" .. k, dip = random(0, 90), dip_direction = random(0, 360), origin = { random(0.8, 1.2), 1, random(0.8, 1.2) } })
    end
    result = seat(rock, { gap = 1e-3, overlap = 1e-3 })
    check.equal(result.contacts, 0)
    check.equal(#result.beyond, 0)
end

-- Thin plates on each other, whose middles are near: their places have the rounding of their size.
for seed = 1, 4 * check.cases(10) do
    local random = shapes.random(seed)
    local place, model = place_of(random), talus.model {}
    for level = 0, 2 do
        local vertices, x, y = {}, random(0, 0.1), random(0, 0.1)
        for k = 0, 7 do
            vertices[k + 1] = place { x + k % 2, y + k // 2 % 2, 1e-3 * (level + k // 4) }
        end
        model:generate("polyhedron", { vertices = vertices, density = DENSITY })
    end
    check.equal(seat(model, { gap = 1e-5, overlap = 1e-5 }).contacts, 0)
end

-- An overlap or a gap of 1e-10 of a block is none of rounding, and an overlap would press.
local function pair(along, low, size)
    local random = shapes.random(7)
    local place, model = place_of(random), talus.model { gravity = { 0, 0, 0 } }
    local function box(min, max)
        local vertices = {}
        for k = 0, 7 do
            vertices[k + 1] = place { k % 2 == 0 and min[1] or max[1], k // 2 % 2 == 0 and min[2] or max[2], k // 4 == 0 and min[3] or max[3] }
        end
        model:generate("polyhedron", { vertices = vertices, density = DENSITY })
    end
    box({ 0, 0, -1 }, { along, 1, 0 })
    box({ along - 2 * size, 0.5, low }, { along - size, 0.5 + size, low + size })
    return seat(model, { gap = 1e-3 * size, overlap = 1e-3 * size }), model
end
for _, low in ipairs { -1e-10, 1e-10 } do
    local result, model = pair(2, low, 1)
    check.equal(result.contacts, 1)
    check.near(result.largest_gap + result.largest_overlap, 1e-10, 1e-14)
    check.near(model:contacts()[1].normal_force, 0, 1e-4) -- an overlap of 1e-10 m presses by 0.1 N
end

-- ---- a small block far from the middle of a large one has the rounding of the large one's places (ROUNDED) ----

check.equal(pair(1000, 0, 0.01).contacts, 0)
check.equal(pair(1000, -1e-9, 0.01).contacts, 1)

-- ---- a block may not be drawn back by more than a quarter of its thickness (MOST_THIN) ----

local THICK = 0.04
-- It gives way by 2/3 of the overlap, by the areas of both faces.
for _, share in ipairs { 0.1, 0.3, 0.4, 0.6 } do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, -1 }, max = { 3, 1, 0 }, density = DENSITY })
    model:generate("box", { min = { 0.5, 0, -share * THICK }, max = { 2, 1, (1 - share) * THICK }, density = DENSITY })
    local result = seat(model, { gap = THICK, overlap = THICK })
    local thin = 2 / 3 * share > 0.25
    check.equal(result.contacts, thin and 0 or 1)
    check.equal(#result.beyond, thin and 1 or 0)
    if thin then
        check.near(result.beyond[1].overlap, share * THICK, 1e-12)
    end
end
