-- Stones that bend inward, from files with corners off their faces: what touches such a body where its parts meet, and no more,
-- presses on nothing. The corners of all parts lie on the planes of their faces, seams included.
package.path = "tests/lua/?.lua;" .. package.path -- run in the source root
local check = require "check"
local masonry = require "masonry"
local talus = require "talus"

local path = string.format("%s/seam_touch_%s.obj", assert(os.getenv("TALUS_TEST_TMP")), tostring({}):match("0x(%x+)") or "0")
local KN = 1e10 -- Pa/m
local SIDE = 0.1 -- m, half the width of blocks that touch
-- Imports leave corners within 1e-9 of a stone's size on their planes: 3 m, and some planes meet in a corner.
local ON = 2e-8 -- m
local FORCE = KN * ON * (2 * SIDE) ^ 2 -- N, of a face as far in

local function add(a, s, b) return { a[1] + s * b[1], a[2] + s * b[2], a[3] + s * b[3] } end
local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
local function unit(a) return add({ 0, 0, 0 }, 1 / math.sqrt(dot(a, a)), a) end
local function cross(a, b) return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] } end

-- Upright prisms over polygons that bend inward.
local outlines = {
    L = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } },
    V = { { 0, 0 }, { 1.4, 0.6 }, { 1.2, 1.4 }, { 0, 0.8 }, { -1.2, 1.4 }, { -1.4, 0.6 } },
    U = { { 0, 0 }, { 3, 0 }, { 3, 2 }, { 2, 2 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } },
}

local function prism(outline)
    local n, stone = #outline, { name = "stone", group = "stone", vertices = {}, faces = { {}, {} } }
    for k, p in ipairs(outline) do
        stone.vertices[k], stone.vertices[n + k] = { p[1], p[2], 0 }, { p[1], p[2], 1 }
        stone.faces[1][n + 1 - k], stone.faces[2][k] = k, n + k
        stone.faces[#stone.faces + 1] = { k, k % n + 1, n + k % n + 1, n + k }
    end
    return stone
end

-- Stones of a cross vault's groins. Their seam has four corners, which are in no plane when they are off, and halves a right angle
-- between two faces.
local groins = {}
for _, stone in ipairs(masonry.cross { thick = 0.5, stones = 3, courses = 1 }) do
    if stone.name:match("^groin%d_0$") then groins[#groins + 1] = stone end
end

local function import()
    local model = talus.model {}
    model:generate("import", { file = path, density = 2000, flat = 0.03 })
    model:blocks():fix()
    return model
end

-- The edges at which two parts meet on the surface, and the corners there: ends, and the outward normals of the faces.
local function seam_places(model)
    local edges, corners = {}, {}
    local function key(p) return ("%.5f %.5f %.5f"):format(p[1] + 0, p[2] + 0, p[3] + 0) end
    local function note(list, name, at, block, normal)
        list[name] = list[name] or { at = at, of = {}, count = 0, normals = {} }
        local place = list[name]
        if not place.of[block] then place.of[block], place.count = true, place.count + 1 end
        place.normals[#place.normals + 1] = normal
    end
    local all = model:blocks()
    for b, block in ipairs(all) do
        for _, f in ipairs(block.faces) do
            for i, v in ipairs(f.vertices) do
                local p, q = block.vertices[v], block.vertices[f.vertices[i % #f.vertices + 1]]
                local kp, kq = key(p), key(q)
                note(corners, kp, { p }, b, f.normal)
                note(edges, kp < kq and kp .. kq or kq .. kp, { p, q }, b, f.normal)
            end
        end
    end
    local places = {}
    for _, list in ipairs { edges, corners } do
        for _, place in pairs(list) do
            if place.count > 1 then places[#places + 1] = place end
        end
    end
    table.sort(places, function(a, b)
        if #a.at ~= #b.at then return #a.at < #b.at end
        return key(a.at[1]) .. key(a.at[#a.at]) < key(b.at[1]) .. key(b.at[#b.at])
    end)
    return places
end

-- The way out of the body, along all faces at a place but the walls of seams, which face each other; and the normals of these.
local function way_out(place)
    local sum, outer = { 0, 0, 0 }, {}
    for i, n in ipairs(place.normals) do
        local wall = false
        for k, other in ipairs(place.normals) do wall = wall or (i ~= k and dot(n, other) < -0.99999) end
        if not wall then
            outer[#outer + 1] = n
            sum = add(sum, 1, n)
        end
    end
    if #outer == 0 or dot(sum, sum) < 0.01 then return nil end
    local m = unit(sum)
    for _, n in ipairs(outer) do
        if dot(m, n) < 0.5 then return nil end
    end
    return m, outer
end

-- Whether the whole body lies behind a plane, as nearly as corners lie on theirs.
local function bears(model, p, m)
    for _, b in ipairs(model:blocks()) do
        for _, v in ipairs(b.vertices) do
            if dot(m, add(v, -1, p)) > ON then return false end
        end
    end
    return true
end

-- Blocks that touch a place: by a tip or an edge, and by a face where the whole body is behind its plane, as it is on a face.
local function touching(model, place)
    local m, outer = way_out(place)
    if not m then return {} end
    local p, q = place.at[1], place.at[2]
    local along = q and unit(add(q, -1, p)) or unit(cross(m, { 0.3, 0.5, 0.8 }))
    m = unit(add(m, -dot(m, along), along))
    local side, list = cross(m, along), {}
    local from = q and add(p, 0.3, add(q, -1, p)) or p
    local to = q and add(p, 0.7, add(q, -1, p)) or p
    local over = { { from, -1 }, { from, 1 }, { to, -1 }, { to, 1 } }
    local wedge = q and { from, to } or { p }
    for _, c in ipairs(over) do
        local end_of = q and c[1] or add(p, c == over[1] and -SIDE / 4 or c == over[4] and SIDE / 4 or 0, along)
        wedge[#wedge + 1] = add(add(end_of, SIDE, m), c[2] * SIDE / 4, side)
    end
    list[1] = wedge
    outer[#outer + 1] = m
    for _, n in ipairs(outer) do
        local u = unit(add(along, -dot(along, n), n))
        local w = cross(n, u)
        for turn = 0, bears(model, p, n) and 1 or -1 do -- near both ends of the edge, along and across it
            local slab, c, d = {}, math.cos(turn), math.sin(turn)
            local middle = q and add(p, 0.1 + 0.8 * turn, add(q, -1, p)) or p
            for i = 0, 7 do
                local x, y = (i % 2 * 2 - 1) * SIDE, (i // 2 % 2 * 2 - 1) * SIDE
                slab[i + 1] = add(add(add(middle, c * x - d * y, w), d * x + c * y, u), i // 4 * SIDE, n)
            end
            list[#list + 1] = slab
        end
    end
    return list
end

local touched = 0
local function try(stone, name, seed)
    masonry.write.obj(path, masonry.survey({ stone }, { seed = seed, own = 0.012 }))
    local model = import()
    check.holds(#model:blocks() > 1, name .. ": has parts")
    for _, b in ipairs(model:blocks()) do
        for _, f in ipairs(b.faces) do
            local at = b.vertices[f.vertices[1]]
            for _, v in ipairs(f.vertices) do check.near(dot(f.normal, add(b.vertices[v], -1, at)), 0, ON) end
        end
    end
    for _, place in ipairs(seam_places(model)) do
        for kind, vertices in ipairs(touching(model, place)) do
            local pair, force = import(), 0
            pair:generate("polyhedron", { vertices = vertices, density = 2000 })
            pair:joint("*", "coulomb", { kn = KN, ks = KN, friction = 35 })
            pair:cycle(1)
            for _, c in ipairs(pair:contacts {}) do force = math.max(force, math.abs(c.normal_force)) end
            check.holds(force <= FORCE, ("%s %d: %d corners of a seam, %s: %g N"):format(name, seed, #place.at, kind == 1 and "wedge" or "slab", force))
            touched = touched + 1
        end
    end
end

local cases = check.cases(4)
for seed = 1, cases do
    for _, name in ipairs { "L", "V", "U" } do try(prism(outlines[name]), name, seed) end
    for _, stone in ipairs(groins) do try(stone, stone.name, seed) end
end
check.holds(touched >= 12 * cases, ("%d blocks touched"):format(touched))
os.remove(path)
