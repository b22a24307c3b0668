-- The generator "fracture": convex polygons that cut blocks in their path, and only those.
local talus = require "talus"
local check = require "check"

local function grid(options)
    local model = talus.model(options or {})
    for i = 0, 3 do
        for j = 0, 3 do
            model:generate("box", { min = { i, j, 0 }, max = { i + 1, j + 1, 2 }, density = 2000 })
        end
    end
    return model
end

local function centroids_cut(model)
    local cut = {}
    for _, block in ipairs(model:blocks { joint = "F" }) do
        local c = block.centroid
        cut[math.floor(c[1]) .. "," .. math.floor(c[2])] = true
    end
    return cut
end

local function count(set)
    local n = 0
    for _ in pairs(set) do
        n = n + 1
    end
    return n
end

-- A triangle cuts the columns that it reaches into: x + y < 2.5 at z = 1.
local model = grid()
local summary = model:generate("fracture", { joint = "F", vertices = { { 0, 0, 1 }, { 2.5, 0, 1 }, { 0, 2.5, 1 } } })
check.equal(summary.cuts, 6)
check.near(summary.volume_error, 0, 1e-14)
for _, place in ipairs { "0,0", "1,0", "2,0", "0,1", "1,1", "0,2" } do
    check.holds(centroids_cut(model)[place], place)
end
check.equal(model:joints()[1].planes, 1)

-- A polygon that ends at the border of a section does not reach into it, to the digits that it is given with.
for _, off in ipairs { 0, 1e-7, -1e-7 } do
    model = grid()
    model:generate("fracture", { joint = "F", vertices =
        { { 1 - off, 1 - off, 1 }, { 3 + off, 1 - off, 1 }, { 3 + off, 3 + off, 1 }, { 1 - off, 3 + off, 1 } } })
    check.equal(count(centroids_cut(model)), 4)
end

-- Several in one call are all made or none.
model = grid()
check.raises(function()
    model:generate("fracture", {
        { joint = "F", vertices = { { 0, 0, 1 }, { 4, 0, 1 }, { 4, 4, 1 } } },
        { joint = "F", vertices = { { 0, 0, 1 }, { 4, 0, 1 }, { 1, 1, 1 }, { 0, 4, 1 } } } })
end, "entry 2")
check.equal(#model:blocks(), 16)
summary = model:generate("fracture", {
    { joint = "F", vertices = { { 0, 0, 1 }, { 4, 0, 1 }, { 4, 4, 1 }, { 0, 4, 1 } } },
    { joint = "F", vertices = { { 0.5, -1, 0 }, { 0.5, 9, 0 }, { 0.5, 9, 4 }, { 0.5, -1, 4 } } } })
check.equal(summary.cuts, 16 + 8)

-- What is refused, with a sentence, and changes nothing.
local function refused(vertices, part, more)
    local given = { joint = "F", vertices = vertices }
    for key, value in pairs(more or {}) do
        given[key] = value
    end
    local hash = model:state_hash()
    check.raises(function()
        model:generate("fracture", given)
    end, part)
    check.equal(model:state_hash(), hash)
end
refused({ { 0, 0, 0 }, { 1, 0, 0 } }, "has 2 corners")
refused({ { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } }, "enclose no area")
refused({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, "coincide")
refused({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0.1 }, { 0, 1, 0 } }, "off its plane")
refused({ { 0, 0, 0 }, { 1, 1, 0 }, { 1, 0, 0 }, { 0, 2, 0 } }, "not convex or crosses itself")
refused({ { 0, 0, 0 }, { 4, 0, 0 }, { 1, 1, 0 }, { 0, 4, 0 } }, "not convex or crosses itself")
refused({ { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 } }, "persistence", { persistence = 2 })
refused({ { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1e100 } }, "farther from zero")
refused({ { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 } }, "vertices", { vertexes = 2 })

-- One that meets nothing leaves the blocks alone.
model:generate("fracture", { joint = "G", vertices = { { 9, 9, 9 }, { 10, 9, 9 }, { 9, 10, 9 } } })
check.equal(#model:blocks { joint = "G" }, 0)

-- Random polygons, in random models, under random changes that must not matter.

local function unit(random)
    local z, a = 2 * random() - 1, 2 * math.pi * random()
    local r = math.sqrt(1 - z * z)
    return { r * math.cos(a), r * math.sin(a), z }
end

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

local function scaled(a, s, from)
    from = from or { 0, 0, 0 }
    return { from[1] + s * a[1], from[2] + s * a[2], from[3] + s * a[3] }
end

-- A convex polygon of n corners on a circle about a point, and its plane.
local function polygon(random, middle, radius, n)
    local normal = unit(random)
    local e = cross(normal, unit(random))
    local length = math.sqrt(e[1] ^ 2 + e[2] ^ 2 + e[3] ^ 2)
    e = scaled(e, 1 / length)
    local f, vertices = cross(normal, e), {}
    local start = random()
    for i = 1, n do
        local angle = 2 * math.pi * (i + start + 0.3 * random()) / n
        vertices[i] = scaled(f, radius * math.sin(angle), scaled(e, radius * math.cos(angle), middle))
    end
    return vertices, normal
end

local function plane_of(normal, point)
    local n = normal[3] < 0 and scaled(normal, -1) or normal
    local direction = math.deg(math.atan(n[1], n[2]))
    return { joint = "F", dip = math.deg(math.acos(n[3])), dip_direction = direction % 360, origin = point }
end

local function volumes(model)
    local list = model:blocks():values "volume"
    table.sort(list)
    return list
end

-- The square about a disc.
local function square_about(normal, middle, radius)
    local e = cross(normal, { 0.123, 0.456, 0.789 })
    e = scaled(e, 1 / math.sqrt(e[1] ^ 2 + e[2] ^ 2 + e[3] ^ 2))
    local f, r = cross(normal, e), 1.001 * radius
    local corners = {}
    for i, at in ipairs { { -r, -r }, { r, -r }, { r, r }, { -r, r } } do
        corners[i] = scaled(f, at[2], scaled(e, at[1], middle))
    end
    return corners
end

local function by(cut, scale, shift)
    scale, shift = scale or 1, shift or { 0, 0, 0 }
    local model = talus.model {}
    local function at(x, y, z)
        return { scale * x + shift[1], scale * y + shift[2], scale * z + shift[3] }
    end
    model:generate("box", { min = at(0, 0, 0), max = at(4, 4, 4), density = 2000 })
    for axis, plane in ipairs { { 90, 90 }, { 90, 0 }, { 0, 0 } } do
        model:generate("jointset", { joint = "J" .. axis, dip = plane[1], dip_direction = plane[2], spacing = scale,
            number = 3, origin = at(2, 2, 2) })
    end
    return model, cut(model, at)
end

local function cut_by(vertices, scale, shift)
    return by(function(model, at)
        local moved = {}
        for i, v in ipairs(vertices) do
            moved[i] = at(v[1], v[2], v[3])
        end
        return model:generate("fracture", { joint = "F", vertices = moved })
    end, scale, shift)
end

for seed = 1, check.cases(120) do
    math.randomseed(seed)
    local random = math.random
    local middle = { 4 * random(), 4 * random(), 4 * random() }
    local n = random(3, 9)
    local vertices, normal = polygon(random, middle, 0.3 + 3 * random(), n)
    local model, summary = cut_by(vertices, 1, { 0, 0, 0 })
    check.near(model:blocks():sum "volume", 64, 1e-12)
    local reference = volumes(model)

    -- Turned round, begun elsewhere, in other units and places: the same blocks.
    local turned = {}
    local from = random(n)
    for i = 1, n do
        turned[i] = vertices[(from - i) % n + 1]
    end
    check.near(volumes((cut_by(turned, 1, { 0, 0, 0 }))), reference, 1e-10)
    local other = volumes((cut_by(vertices, 1000, { 3e5, -2e5, 1e4 })))
    for i = 1, #other do
        other[i] = other[i] / 1e9
    end
    check.near(other, reference, 1e-7)

    -- A polygon far larger than the model cuts as the plane does.
    local huge = {}
    for i, v in ipairs(vertices) do
        huge[i] = scaled({ v[1] - middle[1], v[2] - middle[2], v[3] - middle[3] }, 300, middle)
    end
    local whole = talus.model {}
    whole:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2000 })
    whole:generate("fracture", { joint = "F", vertices = huge })
    local plane = talus.model {}
    plane:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2000 })
    plane:generate("joint", plane_of(normal, middle))
    check.near(volumes(whole), volumes(plane), 1e-9)

    -- A polygon inscribed in a disc lies in what the disc reaches into: it cuts no block that the disc leaves whole.
    local radius = 0
    for _, v in ipairs(vertices) do
        radius = math.max(radius, math.sqrt((v[1] - middle[1]) ^ 2 + (v[2] - middle[2]) ^ 2 + (v[3] - middle[3]) ^ 2))
    end
    local disc = plane_of(normal, middle)
    disc.radius = radius * (1 + 1e-9)
    local about, inside = by(function(m) return m:generate("joint", disc) end)
    check.holds(inside.cuts >= summary.cuts, "the disc cuts as many")
    -- And what surrounds the disc cuts all that the disc does.
    local around = square_about(normal, middle, radius)
    local _, outer = by(function(m) return m:generate("fracture", { joint = "F", vertices = around }) end)
    check.holds(outer.cuts >= inside.cuts, "the square cuts as many")
    check.near(about:blocks():sum "volume", 64, 1e-12)
end
