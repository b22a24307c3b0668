-- round_trips.lua - random models that are written to files and read again, and how far the blocks that come back are off.
--
-- Models are boxes cut by joints, walls, polyhedra beside each other, and blocks joined to bodies that are not convex, turned by any angle.
--
--     local errors, clear = round_trips.written(seed, ".stl")         by model:write_blocks
--     local errors, clear = round_trips.of_others(seed, ".stl", unit) by writers of import_files.lua: any order, faces inside out, in units of a metre
--     local errors = round_trips.welded(seed, weld)                    each triangle with its own corners, off by up to half of `weld`
--
-- The first two give as well whether the model is clear: no feature of it is so small that a reader takes it for none, by `flat` or because
-- any block knows its faces to 2e-4 of its size only.
--
-- Errors: `lost`, blocks that did not come back or came back with other faces; `vertex` and `centroid`, largest distances over the size of
-- the model; `volume`, relative. Of welded models distances are over `weld`, and the volume is over the
-- area times `weld`.
local files = require "import_files"
local shapes = require "shapes"
local talus = require "talus"

local round_trips = {
    written_endings = { ".obj", ".stl", ".ply", ".vtk", ".json" },
    units = { 1e-3, 1, 25.4, 1e4 }, -- of the file, m
}

local DENSITY = 2500
local IN_PLANE = 1e-9 -- a corner is that near to the plane of its own face, over the face's size
local CLEAR = 10      -- features are so many times larger than what import takes for none
local BENT = 2e-4     -- over the size of a block: what any block takes for none

-- ---------------------------------------------------------------- models

local kinds = {}

-- A box with up to five joints through it.
function kinds.cut(model, random)
    local size = { random(1, 4), random(1, 4), random(1, 4) }
    model:generate("box", { min = { 0, 0, 0 }, max = size, density = DENSITY })
    for k = 1, math.floor(random(1, 6)) do
        model:generate("joint", { joint = "J" .. k, dip = random(0, 90), dip_direction = random(0, 360),
            origin = { size[1] * random(0.2, 0.8), size[2] * random(0.2, 0.8), size[3] * random(0.2, 0.8) } })
    end
end

-- A wall of bricks of random lengths in courses of random heights.
function kinds.wall(model, random)
    local z, depth, length = 0, random(0.2, 0.6), random(2, 3)
    for _ = 1, math.floor(random(2, 5)) do
        local x, height = 0, random(0.2, 0.5)
        while x < length do
            local next = x + random(0.3, 0.8)
            next = next > length - 0.3 and length or next
            model:generate("box", { min = { x, 0, z }, max = { next, depth, z + height }, density = DENSITY })
            x = next
        end
        z = z + height
    end
end

-- Hulls of points of ellipsoids, each in a cell of its own.
function kinds.polyhedra(model, random)
    for i = 1, math.floor(random(2, 7)) do
        local vertices = {}
        local axes = { random(0.5, 1), random(0.5, 1), random(0.5, 1) }
        for k = 1, math.floor(random(5, 14)) do
            local p = shapes.direction(random)
            vertices[k] = { axes[1] * p[1] + 2.5 * (i % 2), axes[2] * p[2] + 2.5 * (i // 2), axes[3] * p[3] }
        end
        model:generate("polyhedron", { vertices = vertices, density = DENSITY })
    end
end

-- Parts of a cut box that are joined at random, beside an L of two boxes.
function kinds.joined(model, random)
    kinds.cut(model, random)
    for _ = 1, 3 do
        local blocks = model:blocks()
        local first = blocks[math.floor(random(1, #blocks + 1))]
        pcall(function() -- those that do not hang together stay as they are
            model:blocks { where = function(b) return b.id == first.id or random(0, 1) < 0.3 end }:join()
        end)
    end
    model:generate("box", { min = { 6, 0, 0 }, max = { 8, 1, 1 }, density = DENSITY, group = "L" })
    model:generate("box", { min = { 6, 0, 1 }, max = { 7, 1, 2 }, density = DENSITY, group = "L" })
    model:blocks { group = "L" }:join()
end

round_trips.kinds = { "cut", "wall", "polyhedra", "joined" }

-- The model of a seed.
local function drawn(seed)
    local model, random = talus.model { seed = seed }, shapes.random(seed)
    kinds[round_trips.kinds[seed % #round_trips.kinds + 1]](model, random)
    return model, random
end

-- ---------------------------------------------------------------- comparison

local function distance(a, b)
    return math.sqrt((a[1] - b[1]) ^ 2 + (a[2] - b[2]) ^ 2 + (a[3] - b[3]) ^ 2)
end

local function nearest(list, from)
    local best, least = nil, math.huge
    for _, one in ipairs(list) do
        local d = distance(one.at, from)
        if d < least then
            best, least = one, d
        end
    end
    return best, least
end

local function size_of(objects)
    local low, high = { math.huge, math.huge, math.huge }, { -math.huge, -math.huge, -math.huge }
    for _, o in ipairs(objects) do
        for _, p in ipairs(o.vertices) do
            for k = 1, 3 do
                low[k], high[k] = math.min(low[k], p[k]), math.max(high[k], p[k])
            end
        end
    end
    return distance(low, high)
end

-- The least length by which the corners of an object can be told from a triangle that is not their own: their height above it, which a
-- triangle of height h knows at a distance L only 1 + L / h times less well.
local function least_above(o, t, own)
    local u, w = shapes.sum(t[2], -1, t[1]), shapes.sum(t[3], -1, t[1])
    local n = shapes.cross(u, w)
    local twice, longest = shapes.length(n), math.max(shapes.length(u), shapes.length(w), distance(t[2], t[3]))
    local height = twice / longest
    local least = height
    for v, p in ipairs(o.vertices) do
        local above = math.abs(shapes.dot(n, shapes.sum(p, -1, t[1]))) / twice
        if not own[v] then
            least = math.min(least, above / (1 + distance(p, t[1]) / height))
        elseif above > IN_PLANE * longest then -- a block's face may be bent a little
            return 0
        end
    end
    return least
end

-- The same of all triangles of objects.
local function least_feature(objects)
    local least = math.huge
    for _, o in ipairs(objects) do
        for _, f in ipairs(o.faces) do
            local own = {}
            for _, v in ipairs(f) do
                own[v] = true
            end
            for _, t in ipairs(files.fans { vertices = o.vertices, faces = { f } }) do
                least = math.min(least, least_above(o, t, own))
            end
        end
    end
    return least
end

-- The size of the largest object.
local function largest(objects)
    local size = 0
    for _, o in ipairs(objects) do
        size = math.max(size, size_of { o })
    end
    return size
end

-- The blocks of a model as objects, with what they are compared by.
local function objects_of(model)
    local objects = files.objects_of(model)
    for i, b in ipairs(model:blocks()) do
        local o = objects[i]
        o.at, o.volume, o.area = { b.centroid[1], b.centroid[2], b.centroid[3] }, b.volume, 0
        for _, t in ipairs(files.fans(o)) do
            o.area = o.area + shapes.length(shapes.cross(shapes.sum(t[2], -1, t[1]), shapes.sum(t[3], -1, t[1]))) / 2
        end
    end
    return objects
end

-- How far the blocks of `model` are off the objects. Distances are over `length`, without it over the size of all of them.
local function compared(objects, model, length)
    local errors = { lost = math.abs(#model:blocks() - #objects), vertex = 0, centroid = 0, volume = 0 }
    local size = length or size_of(objects)
    for _, b in ipairs(model:blocks()) do
        local o, off = nearest(objects, b.centroid)
        errors.centroid = math.max(errors.centroid, off / size)
        errors.volume = math.max(errors.volume, math.abs(b.volume - o.volume) / (length and o.area * length or o.volume))
        errors.lost = errors.lost + ((#b.faces ~= #o.faces or #b.vertices ~= #o.vertices) and 1 or 0)
        for _, p in ipairs(b.vertices) do
            local least = math.huge
            for _, q in ipairs(o.vertices) do
                least = math.min(least, distance(p, q))
            end
            errors.vertex = math.max(errors.vertex, least / size)
        end
    end
    return errors
end

-- The model of a file, and whether its objects have no feature that import may take for none.
local function imported(path, values, objects)
    local model, all = talus.model {}, { file = path, density = DENSITY }
    for key, value in pairs(values or {}) do
        all[key] = value
    end
    local report = model:generate("import", all).report
    return model, objects and least_feature(objects) > CLEAR * math.max(report.flat, BENT * largest(objects))
end

local function with_file(ending, use)
    local path = os.tmpname()
    os.remove(path)
    path = path .. ending
    local good, result, clear = pcall(use, path)
    os.remove(path)
    if not good then
        error(result, 0)
    end
    return result, clear
end

-- ---------------------------------------------------------------- round trips

local function bodies(model)
    local seen, count = {}, 0
    for _, b in ipairs(model:blocks()) do
        count = count + (seen[b.body] and 0 or 1)
        seen[b.body] = true
    end
    return count
end

function round_trips.written(seed, ending)
    local model = drawn(seed)
    return with_file(ending, function(path)
        model:write_blocks(path)
        if ending ~= ".json" then
            local objects = objects_of(model)
            local other, clear = imported(path, {}, objects)
            return compared(objects, other), clear
        end
        local objects, other = objects_of(model), talus.model {}
        other:generate("blocks", { file = path })
        local errors = compared(objects, other)
        errors.lost = errors.lost + math.abs(bodies(other) - bodies(model))
        return errors, least_feature(objects) > CLEAR * BENT * largest(objects)
    end)
end

-- The objects turned by any angle, and the same in units of `unit` metres.
local function in_units(objects, random, unit)
    local turn, turned, written = shapes.attitude(random), {}, {}
    for i, o in ipairs(objects) do
        turned[i] = { name = o.name, group = o.group, faces = o.faces, vertices = {}, at = shapes.apply(turn, o.at), volume = o.volume, area = o.area }
        written[i] = { name = o.name, group = o.group, vertices = {}, faces = {} }
        for k, p in ipairs(o.vertices) do
            local q = shapes.apply(turn, p)
            turned[i].vertices[k], written[i].vertices[k] = q, { q[1] / unit, q[2] / unit, q[3] / unit }
        end
        for k, f in ipairs(o.faces) do
            written[i].faces[k] = { table.unpack(f) }
        end
    end
    return turned, written
end

function round_trips.of_others(seed, ending, unit)
    math.randomseed(seed)
    local model, random = drawn(seed)
    local objects, written = in_units(objects_of(model), random, unit)
    -- Faces of PLY and VTK are turned as one object, which leaves shells that touch as they are.
    local one_object = ending:lower():find "ply" or ending:lower():find "vtk"
    return with_file(ending, function(path)
        local file = assert(io.open(path, "wb"))
        file:write(files.writers[ending](files.disturbed(written, not one_object), files.digits "%.17g"))
        file:close()
        local other, clear = imported(path, { scale = unit }, objects)
        return compared(objects, other), clear
    end)
end

-- nil: some feature of the model is too small for so large a `weld`.
function round_trips.welded(seed, weld)
    math.randomseed(seed)
    local model, random = drawn(seed)
    local objects, written = in_units(objects_of(model), random, 1)
    if least_feature(objects) < CLEAR * weld then
        return nil
    end
    return with_file(".stl", function(path)
        local lines = {}
        for _, o in ipairs(files.disturbed(written, true)) do
            lines[#lines + 1] = "solid " .. o.name
            for _, t in ipairs(files.fans(o)) do
                lines[#lines + 1] = "facet normal 0 0 0\nouter loop"
                for _, p in ipairs(t) do
                    local q = shapes.sum(p, 0.5 * weld * random(0, 1), shapes.direction(random))
                    lines[#lines + 1] = string.format("vertex %.17g %.17g %.17g", q[1], q[2], q[3])
                end
                lines[#lines + 1] = "endloop\nendfacet"
            end
            lines[#lines + 1] = "endsolid"
        end
        local file = assert(io.open(path, "wb"))
        file:write(table.concat(lines, "\n"), "\n")
        file:close()
        return compared(objects, imported(path, { weld = weld, flat = 2 * weld }), weld)
    end)
end

-- Tries seeds 1 to `count` by `try(seed)`, which gives errors and whether the model is clear. Gives the largest errors, with
-- `count`, of those that are clear, and of the others with `refused`.
function round_trips.many(count, try)
    local clear, others = {}, {}
    for _, worst in ipairs { clear, others } do
        worst.count, worst.refused, worst.lost, worst.vertex, worst.centroid, worst.volume = 0, 0, 0, 0, 0, 0
    end
    for seed = 1, count do
        local good, errors, is_clear = pcall(try, seed)
        local worst = good and is_clear and clear or others
        if not good and not errors:find("is flat within flat", 1, true) then
            error("seed " .. seed .. ": " .. errors, 0)
        end
        worst.refused = worst.refused + (good and 0 or 1)
        if good and errors then
            worst.count, worst.lost = worst.count + 1, worst.lost + errors.lost
            for _, name in ipairs { "vertex", "centroid", "volume" } do
                worst[name] = math.max(worst[name], errors[name])
            end
        end
    end
    return clear, others
end

return round_trips
