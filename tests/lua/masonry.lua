-- masonry.lua - vaults and domes as a mason's survey gives them: every corner is measured a little off, and the stones are
-- written as OBJ, PLY or JSON of compas.
local talus = require "talus"

local masonry = {}

-- Random numbers of a seed, in [-1, 1): xorshift.
function masonry.random(seed)
    local state = seed * 0x9E3779B97F4A7C15 + 1
    return function()
        state = state ~ (state << 13)
        state = state ~ (state >> 7)
        state = state ~ (state << 17)
        return (state >> 11) * 2.0 ^ -52 - 1
    end
end

local HEX = { { 1, 3, 4, 2 }, { 5, 6, 8, 7 }, { 1, 2, 6, 5 }, { 3, 7, 8, 4 }, { 1, 5, 7, 3 }, { 2, 4, 8, 6 } }

-- A stone of six faces. place(i, j, k) gives its corners; a right-handed order of i, j, k.
local function hex(list, name, group, place)
    local stone = { name = name, group = group, vertices = {}, faces = HEX }
    for n = 0, 7 do
        stone.vertices[n + 1] = place(n % 2, n // 2 % 2, n // 4)
    end
    list[#list + 1] = stone
    return stone
end

local function box(list, name, group, low, high)
    return hex(list, name, group, function(i, j, k)
        return { i == 0 and low[1] or high[1], j == 0 and low[2] or high[2], k == 0 and low[3] or high[3] }
    end)
end

-- A barrel vault of mean radius 3 m; every second ring begins with half a stone. o: thick, stones, rings, wide, bond.
function masonry.barrel(o)
    local list, R, thick, wide, n = {}, o.radius or 3, o.thick, o.wide or 0.4, o.stones or 21
    local bond = o.bond ~= false
    local function joint(ring, k) return math.pi * math.max(0, math.min(n, k - (bond and ring % 2 / 2 or 0))) / n end
    for ring = 1, o.rings or 20 do
        for k = 1, n + (bond and ring % 2 or 0) do
            hex(list, ("ring%d_%d"):format(ring, k), "stone", function(i, j, m)
                local r, a = R + (m - 0.5) * thick, joint(ring, k - i)
                return { r * math.cos(a), (ring - 1 + j) * wide, r * math.sin(a) }
            end)
        end
    end
    for side = -1, 1, 2 do
        box(list, side < 0 and "west" or "east", "support", { side * R - 0.4, 0, -0.5 }, { side * R + 0.4, (o.rings or 20) * wide, 0 })
    end
    return list
end

-- A hemispherical dome of mean radius 3 m, with an eye or a keystone. o: thick, rings, around, bond.
function masonry.dome(o)
    local list, R, thick, rings, around = {}, o.radius or 3, o.thick, o.rings or 14, o.around or 32
    local top = math.rad(o.top or 80)
    local function at(r, up, a) return { r * math.cos(up) * math.cos(a), r * math.cos(up) * math.sin(a), r * math.sin(up) } end
    for ring = 1, rings do
        local shift = o.bond and ring % 2 / 2 or 0
        for k = 1, around do
            hex(list, ("ring%d_%d"):format(ring, k), "stone", function(i, j, m)
                return at(R + (m - 0.5) * thick, top * (ring - 1 + j) / rings, 2 * math.pi * (k - 1 + i + shift) / around)
            end)
        end
    end
    if not o.eye then
        local key = { name = "key", group = "stone", vertices = {}, faces = { {}, {} } }
        local shift = o.bond and rings % 2 / 2 or 0
        for k = 1, around do
            for m = 0, 1 do
                key.vertices[2 * k - 1 + m] = at(R + (m - 0.5) * thick, top, 2 * math.pi * (k - 1 + shift) / around)
            end
            local n = k % around + 1
            key.faces[1][around + 1 - k], key.faces[2][k] = 2 * k - 1, 2 * k
            key.faces[#key.faces + 1] = { 2 * k - 1, 2 * n - 1, 2 * n, 2 * k }
        end
        list[#list + 1] = key
    end
    for k = 1, around do
        hex(list, "base" .. k, "support", function(i, j, m)
            local a, r = 2 * math.pi * (k - 1 + i) / around, R + (m - 0.5) * (thick + 0.4)
            return { r * math.cos(a), r * math.sin(a), (j - 1) * 0.5 }
        end)
    end
    return list
end

-- An upright prism over a polygon, anticlockwise from above.
local function prism(list, name, group, polygon, low, high)
    local stone, n = { name = name, group = group, vertices = {}, faces = { {}, {} } }, #polygon
    for k, p in ipairs(polygon) do
        stone.vertices[k], stone.vertices[n + k] = { p[1], p[2], low }, { p[1], p[2], high }
        stone.faces[1][n + 1 - k], stone.faces[2][k] = k, n + k
        stone.faces[#stone.faces + 1] = { k, k % n + 1, n + k % n + 1, n + k }
    end
    list[#list + 1] = stone
end

-- A cross vault of two barrels of mean radius 3 m over a square, on four piers. Stones along the groins belong to both
-- barrels; a springer of the shape of an L carries both, and so do courses of the piers, which are an L and a square by turns.
-- o: thick, stones (of half an arch), from (degrees, of the springers), arm (m, of the barrels beyond the square), courses of an arm,
-- pier (m), drums.
function masonry.cross(o)
    local list, R, thick, m = {}, o.radius or 3, o.thick, o.stones or 8
    local from, crown, courses, high, drums = math.rad(o.from or 25), math.rad(85), o.courses or 2, o.pier or 1.2, o.drums or 3
    local ends = R + thick / 2 + (o.arm or 1)
    local function radius(i) return R + (i - 0.5) * thick end
    local function level(j) return from + (crown - from) * j / m end
    local function angle(k) return k <= m and level(k) or math.pi - level(2 * m + 1 - k) end -- of a barrel's joints, 0 to 2 m + 1
    local function on(i, k, y) return { radius(i) * math.cos(angle(k)), y, radius(i) * math.sin(angle(k)) } end
    local function ring(i, c) -- y of a joint across a barrel: towards the crown where c < 0
        local y = radius(i) * math.cos(level(math.max(0, -c)))
        return y + (ends - y) * math.max(0, c) / courses
    end
    local function turn(stone, quarter)
        stone.name = stone.name .. "_" .. quarter
        for v, p in ipairs(stone.vertices) do
            for _ = 1, quarter do p = { -p[2], p[1], p[3] } end
            stone.vertices[v] = p
        end
    end
    for quarter = 0, 3 do
        for c = -m, courses - 1 do
            for k = math.max(0, -c), 2 * m - math.max(0, -c) do
                turn(hex(list, ("web%d_%d"):format(c + m, k), "stone", function(a, b, i)
                    return on(i, k + 1 - a, ring(i, c + b))
                end), quarter)
            end
        end
        for j = 0, m - 1 do -- corners: down the groin, in this barrel, up the groin, in the other one
            local v = {}
            for i = 0, 1 do
                local low, up = on(i, j, ring(i, -j)), on(i, j + 1, ring(i, -j - 1))
                local mine = on(i, j + 1, ring(i, -j))
                v[4 * i + 1], v[4 * i + 2], v[4 * i + 3], v[4 * i + 4] = low, { mine[2], mine[1], mine[3] }, up, mine
            end
            list[#list + 1] = { name = "groin" .. j, group = "stone", vertices = v, faces = { { 1, 2, 3 }, { 1, 3, 4 }, { 5, 7, 6 }, { 5, 8, 7 },
                { 1, 5, 6, 2 }, { 2, 6, 7, 3 }, { 3, 7, 8, 4 }, { 4, 8, 5, 1 } } }
            turn(list[#list], quarter)
        end
        local v = {}
        for up = 0, 1 do
            local function at(i) return radius(i) * (up == 1 and math.cos(from) or 1) end
            local function z(i) return up * radius(i) * math.sin(from) end
            for k, p in ipairs { { at(0), at(0), z(0) }, { ends, at(0), z(0) }, { ends, at(1), z(1) }, { at(1), at(1), z(1) }, { at(1), ends, z(1) }, { at(0), ends, z(0) } } do
                v[6 * up + k] = p
            end
        end
        list[#list + 1] = { name = "springer", group = "stone", vertices = v, faces = { { 6, 5, 4, 3, 2, 1 }, { 7, 8, 9, 10 }, { 7, 10, 11, 12 },
            { 1, 2, 8, 7 }, { 2, 3, 9, 8 }, { 3, 4, 10, 9 }, { 4, 5, 11, 10 }, { 5, 6, 12, 11 }, { 6, 1, 7, 12 } } }
        turn(list[#list], quarter)
        local a, b = radius(0) - 0.1, ends + (o.out or 0.3)
        for c = 1, drums do
            local low, up = -high + high * (c - 1) / drums, -high + high * c / drums
            local function pt(x, y)
                x, y = x - 0.5, y - 0.5
                for _ = 1, c % 4 do x, y = -y, x end
                return { a + (x + 0.5) * (b - a), a + (y + 0.5) * (b - a) }
            end
            prism(list, "quoin" .. c, "stone", { pt(0, 0), pt(1, 0), pt(1, 0.5), pt(0.5, 0.5), pt(0.5, 1), pt(0, 1) }, low, up)
            turn(list[#list], quarter)
            prism(list, "fill" .. c, "stone", { pt(0.5, 0.5), pt(1, 0.5), pt(1, 1), pt(0.5, 1) }, low, up)
            turn(list[#list], quarter)
        end
        prism(list, "foot", "support", { { a - 0.2, a - 0.2 }, { b + 0.2, a - 0.2 }, { b + 0.2, b + 0.2 }, { a - 0.2, b + 0.2 } }, -high - 0.4, -high)
        turn(list[#list], quarter)
    end
    hex(list, "boss", "stone", function(a, b, i)
        local x = radius(i) * math.cos(crown)
        return { a == 0 and -x or x, b == 0 and -x or x, radius(i) * math.sin(crown) }
    end)
    return list
end

-- Moves corners at random: by up to o.shared those of all stones at a place alike, by up to o.own those of each stone.
function masonry.survey(list, o)
    local random, known = masonry.random(o.seed or 1), {}
    local function off(size) return { size * random(), size * random(), size * random() } end
    local out = {}
    for s, stone in ipairs(list) do
        local moved = { name = stone.name, group = stone.group, faces = stone.faces, vertices = {}, key = {} }
        for v, p in ipairs(stone.vertices) do
            local key = ("%.6f %.6f %.6f"):format(p[1] + 10, p[2] + 10, p[3] + 10)
            known[key] = known[key] or off(o.shared or 0)
            local d, e = known[key], off(o.own or 0)
            if stone.group == "support" and not o.supports then d, e = { 0, 0, 0 }, { 0, 0, 0 } end
            moved.key[v] = key .. (stone.group == "support" and "s" or "")
            moved.vertices[v] = { p[1] + d[1] + e[1], p[2] + d[2] + e[2], p[3] + d[3] + e[3] }
        end
        out[s] = moved
    end
    return out
end

-- ---- writers ----

local function put(path, parts)
    local file = assert(io.open(path, "wb"))
    file:write(table.concat(parts))
    file:close()
    return path
end

-- Vertices of all stones, one for each place if `welded`, and faces counted from 0.
local function lists(list, welded)
    local vertices, number, faces = {}, {}, {}
    for s, stone in ipairs(list) do
        local mine = {}
        for v, p in ipairs(stone.vertices) do
            local key = welded and stone.key[v]
            mine[v] = key and number[key]
            if not mine[v] then
                vertices[#vertices + 1] = p
                mine[v] = #vertices - 1
                if key then number[key] = mine[v] end
            end
        end
        faces[s] = {}
        for f, face in ipairs(stone.faces) do
            faces[s][f] = {}
            for i, v in ipairs(face) do faces[s][f][i] = mine[v] end
        end
    end
    return vertices, faces
end

masonry.write = {}
local write = masonry.write

function write.obj(path, list, o)
    local parts = {}
    local vertices, faces = lists(list, o and o.welded)
    for _, p in ipairs(vertices) do parts[#parts + 1] = ("v %.8f %.8f %.8f\n"):format(p[1], p[2], p[3]) end
    for s, stone in ipairs(list) do
        parts[#parts + 1] = "o " .. stone.name .. "\ng " .. stone.group .. "\n"
        for _, f in ipairs(faces[s]) do
            parts[#parts + 1] = "f"
            for _, v in ipairs(f) do parts[#parts + 1] = " " .. v + 1 end
            parts[#parts + 1] = "\n"
        end
    end
    return put(path, parts)
end

function write.ply(path, list, o)
    local vertices, faces = lists(list, o and o.welded)
    local count, parts = 0, {}
    for s in ipairs(list) do count = count + #faces[s] end
    parts[1] = ("ply\nformat ascii 1.0\nelement vertex %d\nproperty double x\nproperty double y\nproperty double z\nelement face %d\n"
        .. "property list uchar int vertex_indices\nend_header\n"):format(#vertices, count)
    for _, p in ipairs(vertices) do parts[#parts + 1] = ("%.8f %.8f %.8f\n"):format(p[1], p[2], p[3]) end
    for s in ipairs(list) do
        for _, f in ipairs(faces[s]) do parts[#parts + 1] = #f .. " " .. table.concat(f, " ") .. "\n" end
    end
    return put(path, parts)
end

function write.json(path, list)
    local parts = { '{"dtype": "compas_dem.models/BlockModel", "data": {"graph": {"node": {' }
    for s, stone in ipairs(list) do
        parts[#parts + 1] = (s > 1 and ",\n" or "\n") .. ('"%s": {"is_support": %s, "block": {"data": {"vertex": {'):format(stone.name, stone.group == "support")
        for v, p in ipairs(stone.vertices) do
            parts[#parts + 1] = (v > 1 and "," or "") .. ('"%d": {"x": %.8f, "y": %.8f, "z": %.8f}'):format(v - 1, p[1], p[2], p[3])
        end
        parts[#parts + 1] = '}, "face": {'
        for f, face in ipairs(stone.faces) do
            local corners = {}
            for i, v in ipairs(face) do corners[i] = v - 1 end
            parts[#parts + 1] = (f > 1 and "," or "") .. ('"%d": [%s]'):format(f - 1, table.concat(corners, ", "))
        end
        parts[#parts + 1] = "}}}}"
    end
    parts[#parts + 1] = "}}}}\n"
    return put(path, parts)
end

-- ---- the way of docs/from_a_mesh.md ----

-- The model of a file of stones: imported, its supports held, seated. o: flat, seat (m, limit of gaps and overlaps), kn.
function masonry.model(path, o)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    model:generate("import", { file = path, density = 2000, flat = o.flat, weld = o.weld })
    local held = model:blocks { group = "support" }
    if #held == 0 then -- no file of PLY has groups: supports are the lowest stones
        local lowest = math.huge
        for _, b in ipairs(model:blocks()) do
            lowest = math.min(lowest, b.centroid[3])
        end
        held = model:blocks():where(function(b) return b.centroid[3] < lowest + 0.1 end)
    end
    held:fix()
    model:joint("*", "coulomb", { kn = o.kn or 1e10, ks = o.kn or 1e10, friction = 35 })
    return model, model:seat { gap = o.seat, overlap = o.seat }
end

-- Horizontal force of the stones on their supports, away from the middle, and the weight on them, N.
function masonry.thrust(model)
    local thrust, weight = 0, 0
    for _, b in ipairs(model:blocks { fixed = true }) do
        local f, c = model:blocks { id = b.id }:reaction(), b.centroid
        thrust = thrust - (f[1] * c[1] + f[2] * c[2]) / math.sqrt(c[1] ^ 2 + c[2] ^ 2)
        weight = weight + f[3]
    end
    return thrust, weight
end

return masonry
