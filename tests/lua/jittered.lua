-- jittered.lua - assemblies of six-sided stones that do not quite fit: every corner is moved at random, and faces are
-- made plane again, here or, where `imported`, by the generator "import", which reads the corners as they are.
local files = require "import_files"

local jittered = {}

-- Over the jitter: a face of four moved corners is no farther off its plane.
local FLAT = 4

-- Random numbers of a seed, in [-1, 1): xorshift.
function jittered.random(seed)
    local state = seed * 0x9E3779B97F4A7C15 + 1
    return function()
        state = state ~ (state << 13)
        state = state ~ (state >> 7)
        state = state ~ (state << 17)
        return (state >> 11) * 2.0 ^ -52 - 1
    end
end

local function dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

local function minus(a, b)
    return { a[1] - b[1], a[2] - b[2], a[3] - b[3] }
end

-- The corner number of bits i, j, k.
local function at(i, j, k)
    return 1 + i + 2 * j + 4 * k
end

-- The plane of four corners, normal and offset: across their diagonals, through their mean.
local function plane(p, a, b, c, d)
    local n = cross(minus(p[c], p[a]), minus(p[d], p[b]))
    local length, mean = math.sqrt(dot(n, n)), {}
    for x = 1, 3 do
        n[x] = n[x] / length
        mean[x] = (p[a][x] + p[b][x] + p[c][x] + p[d][x]) / 4
    end
    return { n, dot(n, mean) }
end

-- Where three planes meet.
local function meet(u, v, w)
    local det = dot(u[1], cross(v[1], w[1]))
    local a, b, c = cross(v[1], w[1]), cross(w[1], u[1]), cross(u[1], v[1])
    local x = {}
    for i = 1, 3 do
        x[i] = (u[2] * a[i] + v[2] * b[i] + w[2] * c[i]) / det
    end
    return x
end

-- The eight corners of a stone, each moved by up to `jitter` along each axis.
local function moved(corner, jitter, random)
    local p = {}
    for c = 1, 8 do
        p[c] = { corner[c][1] + jitter * random(), corner[c][2] + jitter * random(), corner[c][3] + jitter * random() }
    end
    return p
end

-- The same with plane faces, in the order of `at`.
function jittered.corners(corner, jitter, random)
    if jitter == 0 then
        return corner
    end
    local p, out = moved(corner, jitter, random), {}
    local planes = { {}, {}, {} }
    for s = 0, 1 do
        planes[1][s] = plane(p, at(s, 0, 0), at(s, 1, 0), at(s, 1, 1), at(s, 0, 1))
        planes[2][s] = plane(p, at(0, s, 0), at(1, s, 0), at(1, s, 1), at(0, s, 1))
        planes[3][s] = plane(p, at(0, 0, s), at(1, 0, s), at(1, 1, s), at(0, 1, s))
    end
    for k = 0, 1 do
        for j = 0, 1 do
            for i = 0, 1 do
                out[at(i, j, k)] = meet(planes[1][i], planes[2][j], planes[3][k])
            end
        end
    end
    return out
end

local function stone(corner, o)
    local place = o.place or function(x) return x end
    local vertices, jitter = {}, o.jitter * o.size
    for c, x in ipairs(o.imported and moved(corner, jitter, o.random) or jittered.corners(corner, jitter, o.random)) do
        vertices[c] = place(x)
    end
    o.parts[#o.parts + 1] = { vertices = vertices, density = o.density or 2500 }
end

local QUADS = { { at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0) }, { at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1) },
    { at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1) }, { at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0) },
    { at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0) }, { at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1) } }

-- Writes the stones into a file, and imports them.
local function import(model, o)
    local objects = {}
    for i, part in ipairs(o.parts) do
        objects[i] = { name = "stone_" .. i, group = "rock", vertices = part.vertices, faces = QUADS }
    end
    local path = os.tmpname()
    os.remove(path)
    path = path .. ".obj"
    local file = assert(io.open(path, "wb"))
    file:write(files.writers[".obj"](objects, files.digits "%.17g"))
    file:close()
    local good, message = pcall(model.generate, model, "import", { file = path, density = o.parts[1].density, flat = math.max(FLAT * o.jitter * o.size, 1e-9 * o.size) })
    os.remove(path)
    return good or error(message, 0)
end

-- Generates the stones, in their order or backward.
local function generate(model, o)
    if o.imported then
        return import(model, o)
    end
    local from, to, step = 1, #o.parts, 1
    if o.backward then
        from, to, step = #o.parts, 1, -1
    end
    for i = from, to, step do
        model:generate("polyhedron", o.parts[i])
    end
end

local function polar(r, angle, y)
    return { r * math.cos(angle), y, r * math.sin(angle) }
end

-- An arch of `count` voussoirs between two radii. The first and the last are held; with `springers` two more, below them.
-- o: jitter (over the size of a stone), random, count, inner, outer, width, springers.
function jittered.arch(model, o)
    local count, width, below = o.count or 20, o.width or 0.5, o.springers and 1 or 0
    o.size, o.parts = o.outer - o.inner, {}
    for n = -below, count - 1 + below do
        local corner = {}
        for k = 0, 1 do
            for j = 0, 1 do
                for i = 0, 1 do
                    corner[at(i, j, k)] = polar(i == 0 and o.inner or o.outer, math.pi * (n + k) / count, j * width)
                end
            end
        end
        stone(corner, o)
    end
    generate(model, o)
    local ids = {}
    for _, b in ipairs(model:blocks()) do
        ids[#ids + 1] = b.id
    end
    model:blocks { id = ids[1] }:fix()
    model:blocks { id = ids[#ids] }:fix()
end

local function brick(low, high)
    local corner = {}
    for k = 0, 1 do
        for j = 0, 1 do
            for i = 0, 1 do
                corner[at(i, j, k)] = { i == 0 and low[1] or high[1], j == 0 and low[2] or high[2], k == 0 and low[3] or high[3] }
            end
        end
    end
    return corner
end

-- A wall in running bond: courses of bricks 1 x 0.5 x 0.5 m; the lowest course is held.
function jittered.wall(model, o)
    o.size, o.parts = 0.5, {}
    local held = 0
    for course = 0, (o.courses or 4) - 1 do
        local x, last = 0, o.length or 3
        while x < last - 1e-9 do
            local next = math.min(last, x + (x == 0 and course % 2 == 1 and 0.5 or 1))
            stone(brick({ x, 0, 0.5 * course }, { next, 0.5, 0.5 * course + 0.5 }), o)
            held = course == 0 and held + 1 or held
            x = next
        end
    end
    generate(model, o)
    local blocks = model:blocks()
    for i = 1, held do
        model:blocks { id = blocks[o.backward and #blocks + 1 - i or i].id }:fix()
    end
end

-- A dome of rings of stones, half of a sphere without its crown; the lowest ring is held.
function jittered.dome(model, o)
    local rings, around, held = o.rings or 4, o.around or 12, 0
    o.size, o.parts = o.outer - o.inner, {}
    for ring = 0, rings - 1 do
        for n = 0, around - 1 do
            local corner = {}
            for k = 0, 1 do
                for j = 0, 1 do
                    for i = 0, 1 do
                        local r, up = i == 0 and o.inner or o.outer, math.rad(70) * (ring + k) / rings
                        local a = 2 * math.pi * (n + j) / around
                        corner[at(i, j, k)] = { r * math.cos(up) * math.cos(a), r * math.cos(up) * math.sin(a), r * math.sin(up) }
                    end
                end
            end
            stone(corner, o)
            held = ring == 0 and held + 1 or held
        end
    end
    generate(model, o)
    local blocks = model:blocks()
    for i = 1, held do
        model:blocks { id = blocks[o.backward and #blocks + 1 - i or i].id }:fix()
    end
end

return jittered
