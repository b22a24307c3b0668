-- program only
-- The remark of `insitu` about outer faces names as many blocks as there are: counted here from the polygons of all faces, in
-- rock that joint sets and tunnels cut at random, with blocks joined, held around the outside, or one taken out.
local talus = require "talus"
local check = require "check"

local BARE = 0.01 -- a face is outer when more of it, and of the block's mean face, lies on nothing
local PARTLY_INSIDE = { 95, 129, 143, 149 } -- with faces that lie partly on their own body

---------------------------------------------------------------- polygons
local function minus(a, b) return { a[1] - b[1], a[2] - b[2], a[3] - b[3] } end
local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

local function area_of(polygon, normal)
    local sum = 0
    for i = 2, #polygon - 1 do
        sum = sum + dot(cross(minus(polygon[i], polygon[1]), minus(polygon[i + 1], polygon[1])), normal) / 2
    end
    return sum
end

-- Area of convex polygon p inside convex polygon q of the same plane, which runs counter-clockwise about `normal`.
local function common_area(p, q, normal)
    for i, a in ipairs(q) do
        local inward, rest = cross(normal, minus(q[i % #q + 1], a)), {}
        for k, s in ipairs(p) do
            local t = p[k % #p + 1]
            local hs, ht = dot(inward, minus(s, a)), dot(inward, minus(t, a))
            if hs >= 0 then
                rest[#rest + 1] = s
            end
            if hs * ht < 0 then
                local u = hs / (hs - ht)
                rest[#rest + 1] = { s[1] + u * (t[1] - s[1]), s[2] + u * (t[2] - s[2]), s[3] + u * (t[3] - s[3]) }
            end
        end
        p = rest
    end
    return #p < 3 and 0 or math.abs(area_of(p, normal))
end

---------------------------------------------------------------- counting
local function faces_of(model)
    local faces = {}
    for _, block in ipairs(model:blocks { hidden = "any" }) do
        local vertices, own, total = block.vertices, {}, 0
        for i, face in ipairs(block.faces) do
            local polygon = {}
            for k, number in ipairs(face.vertices) do
                polygon[k] = vertices[number]
            end
            own[i] = { block = block.id, fixed = block.fixed, normal = face.normal, polygon = polygon,
                offset = dot(face.normal, polygon[1]), area = area_of(polygon, face.normal) }
            total = total + own[i].area
            faces[#faces + 1] = own[i]
        end
        for _, face in ipairs(own) do
            face.mean = total / #own
        end
    end
    return faces
end

-- Number of blocks that are not held and have an outer face, and the first of them.
local function outer_blocks(model)
    local faces, count, first = faces_of(model), 0, nil
    for _, face in ipairs(faces) do
        local bare = face.area
        for _, other in ipairs(face.fixed and {} or faces) do
            if math.abs(face.offset + other.offset) < 1e-6 and other.block ~= face.block and
                dot(face.normal, other.normal) < -1 + 1e-9 then
                bare = bare - common_area(face.polygon, other.polygon, other.normal)
            end
        end
        if not face.fixed and bare > BARE * math.max(face.area, face.mean) and face.block ~= first then
            if not face.seen then
                count, first = count + 1, first or face.block
            end
            for _, other in ipairs(faces) do
                other.seen = other.seen or other.block == face.block
            end
        end
    end
    return count, first
end

---------------------------------------------------------------- models
local SIZE = 8
local random = math.random

local function tunnel(model, group)
    local w, h, x, z = 1 + 2 * random(), 1 + 2 * random(), 4 * (random() - 0.5), 4 * (random() - 0.5)
    local faces = { {}, {} }
    for i, p in ipairs { { -w, -h }, { w, -h }, { w, 0.3 * h }, { w / 2, h }, { -w / 2, h }, { -w, 0.3 * h } } do
        faces[1][i] = { x + p[1], -SIZE / 2, z + p[2] }
        faces[2][i] = { x + p[1], SIZE / 2, z + p[2] }
    end
    model:generate("tunnel", { face1 = faces[1], face2 = faces[2], group = group })
end

local function joint_set(model, name)
    model:generate("jointset", { joint = name, dip = random() * 90, dip_direction = random() * 360,
        spacing = 2 + 3 * random(), number = random(3, 6), dip_dev = 4 * random(),
        dip_direction_dev = 6 * random(), persistence = random() < 0.5 and 1 or 0.5 + 0.5 * random() })
end

local function join_neighbours(model)
    local blocks = model:blocks()
    local block = blocks[random(#blocks)]
    model:joint("*", "coulomb", { kn = 5e9, ks = 2e9, friction = 30 })
    for _, neighbour in ipairs(block.neighbours) do
        model:blocks { where = function(b) return b.id == block.id or b.id == neighbour.id end }:join()
    end
end

local function hold_around(model)
    model:blocks { where = function(block)
        for _, v in ipairs(block.vertices) do
            if math.abs(v[1]) > SIZE - 1e-3 or math.abs(v[2]) > SIZE / 2 - 1e-3 or math.abs(v[3]) > SIZE - 1e-3 then
                return true
            end
        end
    end }:fix()
end

local function rock(seed)
    math.randomseed(seed)
    local model = talus.model { seed = seed }
    model:generate("box", { min = { -SIZE, -SIZE / 2, -SIZE }, max = { SIZE, SIZE / 2, SIZE }, density = 2700 })
    local plan = {}
    for i = 1, random(2, 4) do
        plan[i] = random() < 0.3
    end
    for i, is_tunnel in ipairs(plan) do
        (is_tunnel and tunnel or joint_set)(model, "J" .. i)
    end
    if random() < 0.5 then
        join_neighbours(model)
    end
    model:joint("*", "coulomb", { kn = 5e9, ks = 2e9, friction = 30 })
    local mode = random(3)
    if mode > 1 then
        hold_around(model)
    end
    local free = model:blocks { fixed = false }
    if mode == 3 and #free > 0 then
        model:blocks { id = free[random(#free)].id }:delete()
    end
    return model
end

---------------------------------------------------------------- the check
-- Run by itself with a seed the script makes the model, and its remark is read from outside.
if arg[1] then
    for seed in arg[1]:gmatch("%d+") do
        local model = rock(tonumber(seed))
        io.stderr:write(string.format("expect %d %s %s\n", seed, outer_blocks(model)))
        model:insitu { stress = { xx = -1e6, yy = -2e6, zz = -3e6 } }
        io.stderr:write("<\n")
    end
    return
end

local seeds = {}
for seed = 1, 30 do
    seeds[#seeds + 1] = seed
end
for _, seed in ipairs(PARTLY_INSIDE) do
    seeds[#seeds + 1] = seed
end
local pipe = assert(io.popen(string.format("'%s' '%s' '%s' 2>&1", os.getenv("TALUS_PROGRAM") or arg[-1], arg[0],
    table.concat(seeds, " "))))
local text = pipe:read("a")
check.holds(pipe:close(), text)
local outer, models = 0, 0
for seed, count, first, rest in text:gmatch("expect (%d+) (%d+) (%S+)\n([^<]*)<\n") do
    local said, block = rest:match("insitu: (%d+) blocks? that can move %(first: block (%d+)%)")
    check.equal(seed .. ": " .. (said or "0") .. " " .. (block or "nil"), seed .. ": " .. count .. " " .. first)
    outer, models = outer + (tonumber(count) > 0 and 1 or 0), models + 1
end
check.equal(models, #seeds)
check.holds(outer > 5 and outer < models - 5, "models with and without outer faces")
