-- orders.lua - the same bodies, whole, in parts, and with their parts in another order: what is said of them must be the same.
--
--     orders.shapes(seed)     how far volume, shortest edge and aspect of a body in parts are from those of the whole, relative
--     orders.verdicts(seed)   what is said of a mast that stands or topples, and whether it topples; and what differs when its parts come in
--                             another order, or in more pieces, or nil; and by how much, relative, it then has moved another way
local parts = require "parts"
local shapes = require "shapes"
local talus = require "talus"

local orders = {}
local DENSITY = parts.DENSITY
local ALL = 1e9 -- m3: a filter that takes every body

-- ---------------------------------------------------------------- shapes

local function measured(vertices, cuts)
    local model = talus.model {}
    parts.add(model, "body", vertices, cuts)
    local found = model:filter { volume = ALL }
    return found.slivers[1], found.found, #model:blocks()
end

function orders.shapes(seed)
    local random = shapes.random(seed)
    local vertices = seed % 2 == 0 and shapes.hull(random, 4, random(0.3, 3)) or shapes.box(random(0.1, 3), random(0.1, 3), random(0.1, 3))
    vertices = shapes.placed(vertices, shapes.attitude(random))
    local whole = measured(vertices, {}) -- of planes: a hull of more points is flattened a little, which cutting takes back
    local inside, found, blocks = measured(vertices, parts.random_cuts(random, vertices, 1 + seed % 5))
    local off = 0
    for _, name in ipairs { "volume", "edge", "aspect" } do
        off = math.max(off, math.abs(inside[name] / whole[name] - 1))
    end
    return found == 1 and off or math.huge, blocks
end

-- ---------------------------------------------------------------- verdicts

-- A mast with a head to one side and chips on it: whether its weight is over its foot, and its parts.
local function mast(random)
    local high, wide, topples = random(1, 2), random(0.3, 0.6), random(0, 1) < 0.5
    local head = random(0.6, 1.5) * high -- as long as the mast, and as wide
    local off = (topples and random(1.2, 1.6) or random(0, 0.6)) * 0.5 * wide * (1 + high / head)
    local list = { { { -wide / 2, -0.5, 0 }, { wide / 2, 0.5, high } },
        { { -wide / 2, -0.5, high }, { wide / 2 + off, 0.5, high + 0.1 } }, -- the arm
        { { off - wide / 2, -0.5, high + 0.1 }, { off + wide / 2, 0.5, high + 0.1 + head } } }
    for k = 1, math.floor(random(0, 4)) do
        local size, z = random(0.01, 0.05), random(0, 0.8) * high
        list[#list + 1] = { { -size / 2, k % 2 == 0 and 0.5 or -0.5 - size, z }, { size / 2, k % 2 == 0 and 0.5 + size or -0.5, z + size } }
    end
    return list, topples
end

local function build(list, order, cuts)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    for _, i in ipairs(order) do
        model:generate("box", { min = list[i][1], max = list[i][2], density = DENSITY, group = "mast" })
    end
    for _, plane in ipairs(cuts) do
        model:generate("joint", plane)
    end
    model:blocks():join()
    model:generate("box", { min = { -9, -9, -1 }, max = { 9, 9, 0 }, density = DENSITY, group = "floor" })
    model:generate("box", { min = { 5, 5, 0 }, max = { 6, 6, 1 }, density = DENSITY })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 40 }) -- stiff enough for a mast not to buckle
    model:damping "local"
    return model
end

-- What is said, without the numbers of blocks; and how far the model has moved, m, when it came to rest.
local function said(model)
    local result = model:solve { ratio = 1e-3, stop_at_failure = true, max_cycles = 200000 }
    local verdict, found = model:verdict(), model:filter { volume = 0.1, edge = 0.05, aspect = 8 }
    local text = verdict.text:match("^[^,(]*"):gsub("more than %S+ m", "more than so many m")
    return ("%s; %s; moved %d, %.6g m3; %d slivers, %.6g m3; %s"):format(result.reason, verdict.standing, verdict.moved, verdict.volume, found.found,
        found.volume, text), result.reason == "ratio" and verdict.displacement or nil
end

function orders.verdicts(seed)
    local random = shapes.random(seed)
    local list, topples = mast(random)
    local order, other = {}, {}
    for i = 1, #list do
        order[i] = i
        table.insert(other, 1 + math.floor(random(0, #other + 0.999)), i)
    end
    local cuts = parts.random_cuts(random, { list[1][1], list[1][2], list[3][1], list[3][2] }, 1 + seed % 4)
    local first, moved = said(build(list, order, {}))
    local differs, off = nil, 0
    for _, model in ipairs { build(list, other, {}), build(list, other, cuts) } do
        local told, way = said(model)
        differs = differs or told ~= first and told or nil
        off = math.max(off, moved and way and math.abs(way / moved - 1) or 0)
    end
    return first, topples, differs, off
end

return orders
