-- common_volume.lua - random cut, tunnelled, joined and unjoined rock, and an independent check of its contacts: blocks
-- that have no common volume do not press on each other, whatever seams their bodies have.
--
-- The check knows nothing of the program's contacts: two convex blocks have no common volume when a face's normal of
-- one, or the cross product of an edge of each, separates them.
local talus = require "talus"

local common = {}

local function sub(a, b)
    return { a[1] - b[1], a[2] - b[2], a[3] - b[3] }
end

local function dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

-- Vertices, outward normals and edge directions of a block in its present place.
local function shape(block)
    local s = { vertices = block.vertices, normals = {}, edges = {} }
    for _, face in ipairs(block.faces) do
        s.normals[#s.normals + 1] = face.normal
        local count = #face.vertices
        for i, v in ipairs(face.vertices) do
            local w = face.vertices[i % count + 1]
            if v < w then
                s.edges[#s.edges + 1] = sub(s.vertices[w], s.vertices[v])
            end
        end
    end
    return s
end

-- Least of b minus largest of a along n.
local function gap_along(a, b, n)
    local low, high = math.huge, -math.huge
    for _, x in ipairs(b.vertices) do
        low = math.min(low, dot(n, x))
    end
    for _, x in ipairs(a.vertices) do
        high = math.max(high, dot(n, x))
    end
    return low - high
end

-- The largest gap over all directions that matter: minus the least overlap where there is common volume.
local function separation(a, b)
    local best = -math.huge
    for _, n in ipairs(a.normals) do
        best = math.max(best, gap_along(a, b, n))
    end
    for _, n in ipairs(b.normals) do
        best = math.max(best, gap_along(b, a, n))
    end
    for _, u in ipairs(a.edges) do
        for _, v in ipairs(b.edges) do
            local n = cross(u, v)
            local length = math.sqrt(dot(n, n))
            if length > 1e-6 * math.sqrt(dot(u, u) * dot(v, v)) then
                n = { n[1] / length, n[2] / length, n[3] / length }
                best = math.max(best, gap_along(a, b, n), gap_along(b, a, n))
            end
        end
    end
    return best
end

-- Numbers that do not depend on Lua's own generator.
local function generator(seed)
    local state = (seed * 2654435761) % 2147483648
    return function(low, high)
        state = (state * 1103515245 + 12345) % 2147483648
        return low + (high - low) * ((state >> 7) / 16777216)
    end
end

local SIZE = 2 -- m: half of the box

local function tunnel(model, random)
    local corners, radius = math.floor(random(3, 8)), random(0.3, 1.4)
    local y, z = random(-1, 1), random(-1, 1)
    local skew_y, skew_z, along_y = random(-0.5, 0.5), random(-0.5, 0.5), random(0, 1) < 0.3
    local one, other = {}, {}
    for i = 1, corners do
        local angle = 2 * math.pi * i / corners + 0.1
        local u, v = y + radius * math.cos(angle), z + radius * math.sin(angle)
        one[i] = along_y and { u, -3 * SIZE, v } or { -3 * SIZE, u, v }
        other[i] = along_y and { u + skew_y, 3 * SIZE, v + skew_z } or { 3 * SIZE, u + skew_y, v + skew_z }
    end
    model:generate("tunnel", { face1 = one, face2 = other })
end

local function joints(model, random, k)
    model:generate("jointset", { joint = "J" .. k, dip = random(0, 90), dip_direction = random(0, 360),
        dip_dev = random(0, 6), spacing = random(0.6, 2), number = math.floor(random(1, 4)),
        origin = { random(-1, 1), random(-1, 1), random(-1, 1) }, persistence = random(0.5, 1.3) > 1 and 1 or 0.8 })
end

-- One body of blocks that touch, or one block less in a body, at random.
local function regroup(model, random)
    local blocks = model:blocks()
    for _ = 1, math.floor(random(0, 4)) do
        local block = blocks[math.floor(random(1, #blocks + 0.999))]
        local near = block.neighbours
        if near and #near > 0 then
            local other = near[math.floor(random(1, #near + 0.999))]
            local ids = { [block.id] = true, [type(other) == "number" and other or other.id] = true }
            model:blocks { where = function(b) return ids[b.id] end }:join()
        end
    end
    if random(0, 1) < 0.3 then
        local id = blocks[math.floor(random(1, #blocks + 0.999))].id
        model:blocks { id = id }:unjoin()
    end
end

-- Random rock of a seed; falls apart under gravity when `falls`.
function common.rock(seed, falls)
    local random = generator(seed)
    local model = talus.model { gravity = falls and { 0, 0, -9.81 } or { 0, 0, 0 }, seed = seed }
    model:generate("box", { min = { -SIZE, -SIZE, -SIZE }, max = { SIZE, SIZE, SIZE }, density = 2500 })
    for k = 1, math.floor(random(2, 5.999)) do
        local ok, message = pcall(random(0, 1) < 0.4 and tunnel or joints, model, random, k)
        assert(ok or not message:find "memory", message)
    end
    regroup(model, random)
    local stiffness = 10 ^ random(7, 10)
    model:joint("*", "coulomb", { kn = stiffness, ks = stiffness, friction = random(0, 40) })
    if falls then
        model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, -SIZE + 0.7 } } }:fix()
        if random(0, 1) < 0.7 then
            model:blocks { group = "tunnel" }:delete()
        end
        model:damping "local"
    end
    return model
end

-- How far apart blocks may be whose contact presses: areas are reused for so much motion, m (REUSE), ...
local REUSED = 2e-6
-- ... and a patch is what two faces have in common in projection. At an acute edge that overlaps by o, blocks may be o
-- apart beside it.
-- A contact's overlap is measured along a wall that may not be the nearest one: from how many times the true one on, and
-- how much more relative to the smaller block's size, it is false (TIMES, MORE).
local TIMES, MORE = 10, 0.002

-- Contacts that press although their blocks have no common volume, and those with a false overlap; a sentence on
-- the first.
function common.false_contacts(model)
    local shapes, bodies, count, first = {}, {}, 0, nil
    for _, block in ipairs(model:blocks()) do
        bodies[block.body] = bodies[block.body] or {}
        table.insert(bodies[block.body], block.id)
    end
    for _, contact in ipairs(model:contacts()) do
        local overlap = -contact.gap
        if overlap > 0 and contact.area > 0 then
            local a, b = contact.blocks[1], contact.blocks[2]
            shapes[a.id] = shapes[a.id] or shape(a)
            shapes[b.id] = shapes[b.id] or shape(b)
            local depth = -separation(shapes[a.id], shapes[b.id])
            local size = math.min(a.volume, b.volume) ^ (1 / 3)
            -- forces and overlaps are those of the last step, places those after it
            local moved = 0
            for _, block in ipairs { a, b } do
                local w = block.angular_velocity
                local turned = math.sqrt(dot(w, w)) * block.volume ^ (1 / 3)
                moved = moved + model.dt * (block.speed + 2 * turned)
            end
            local presses = contact.normal_force > 0 and -depth > REUSED + overlap + moved
            -- beside a seam the overlap is the depth under the body's surface, not that of the part
            local parts = a.body ~= a.id or b.body ~= b.id
            for _, block in ipairs { a, b } do
                parts = parts or #(bodies[block.body] or {}) > 1
            end
            if presses or (not parts and overlap > TIMES * math.max(depth, 0) + MORE * size) then
                count = count + 1
                first = first or string.format("blocks %d and %d, overlap %g m, in truth %g m, force %g N", a.id, b.id,
                    overlap, depth, contact.normal_force)
            end
        end
    end
    return count, first
end

return common
