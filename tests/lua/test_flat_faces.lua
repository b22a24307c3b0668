-- Faces as meshes give them, in triangles and off their planes by up to 1e-4 of their size, are faces: from every generator and
-- file that takes them, a column of such blocks has the contacts, the points and the steps of one of plain blocks.
local talus = require "talus"
local check = require "check"

local folder = assert(os.getenv("TALUS_TEST_TMP"))
local stem = string.format("%s/flat_%s", folder, tostring({}):match("0x(%x+)") or "0")
local LEVELS = 6
local QUADS = { { 1, 4, 3, 2 }, { 5, 6, 7, 8 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 4, 8, 7 }, { 4, 1, 5, 8 } }
local TAKES_QUADS = { blocks = true, obj = true }

local function write(ending, content)
    local path = stem .. ending
    local file = assert(io.open(path, "wb"))
    file:write(content)
    file:close()
    return path
end

-- The levels' corners, off by up to `most` each.
local function corners(most)
    local levels = {}
    for level = 0, LEVELS do
        levels[level] = {}
        for i, at in ipairs { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } } do
            local off = {}
            for k = 1, 3 do
                off[k] = most * (2 * math.random() - 1) / math.sqrt(3)
            end
            levels[level][i] = { at[1] + off[1], at[2] + off[2], level + off[3] }
        end
    end
    return levels
end

-- A block of the column: its corners, and its faces whole or divided at random.
local function block(levels, level, divided)
    local vertices = { table.unpack(levels[level - 1]) }
    table.move(levels[level], 1, 4, 5, vertices)
    local faces = {}
    for _, q in ipairs(QUADS) do
        if not divided then
            faces[#faces + 1] = q
        else
            local turn = math.random(0, 3)
            local function corner(k) return q[(k + turn) % 4 + 1] end
            faces[#faces + 1] = { corner(0), corner(1), corner(2) }
            faces[#faces + 1] = { corner(0), corner(2), corner(3) }
        end
    end
    return vertices, faces
end

local function text(numbers)
    local words = {}
    for i, x in ipairs(numbers) do
        words[i] = math.type(x) == "integer" and tostring(x) or string.format("%.9g", x)
    end
    return words
end

local writers = {}

function writers.polyhedron(model, vertices)
    model:generate("polyhedron", { density = 2400, vertices = vertices })
end

function writers.blocks(model, vertices, faces)
    local points, lists = {}, {}
    for i, x in ipairs(vertices) do
        points[i] = "[" .. table.concat(text(x), ", ") .. "]"
    end
    for i, face in ipairs(faces) do
        local from_zero = {}
        for k, v in ipairs(face) do
            from_zero[k] = v - 1
        end
        lists[i] = '{"vertices": [' .. table.concat(text(from_zero), ", ") .. "]}"
    end
    local file = write(".json", string.format(
        '{"format": "talus block model", "version": 1, "joints": [], "blocks": [{"density": 2400, "vertices": [%s], "faces": [%s]}]}',
        table.concat(points, ", "), table.concat(lists, ", ")))
    model:generate("blocks", { file = file })
end

function writers.obj(model, vertices, faces)
    local lines = {}
    for _, x in ipairs(vertices) do
        lines[#lines + 1] = "v " .. table.concat(text(x), " ")
    end
    for _, face in ipairs(faces) do
        lines[#lines + 1] = "f " .. table.concat(text(face), " ")
    end
    model:generate("import", { file = write(".obj", table.concat(lines, "\n") .. "\n"), density = 2400 })
end

function writers.stl(model, vertices, faces)
    local lines = { "solid" }
    for _, face in ipairs(faces) do
        lines[#lines + 1] = "facet normal 0 0 0\nouter loop"
        for _, v in ipairs(face) do
            lines[#lines + 1] = "vertex " .. table.concat(text(vertices[v]), " ")
        end
        lines[#lines + 1] = "endloop\nendfacet"
    end
    lines[#lines + 1] = "endsolid"
    model:generate("import", { file = write(".stl", table.concat(lines, "\n") .. "\n"), density = 2400 })
end

function writers.stl_binary(model, vertices, faces)
    local parts = { string.rep(" ", 80), string.pack("<I4", #faces) }
    for _, face in ipairs(faces) do
        parts[#parts + 1] = string.pack("<fff", 0, 0, 0)
        for _, v in ipairs(face) do
            parts[#parts + 1] = string.pack("<fff", table.unpack(vertices[v]))
        end
        parts[#parts + 1] = string.pack("<I2", 0)
    end
    model:generate("import", { file = write("_binary.stl", table.concat(parts)), density = 2400 })
end

local function column(writer, off, divided)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    local levels = corners(off)
    for level = 1, LEVELS do
        writer(model, block(levels, level, divided))
    end
    return model
end

local function solved(model)
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    model:damping "local"
    model:blocks { id = 1 }:fix()
    return model:solve { ratio = 1e-5, max_cycles = 20000 }.cycles
end

local plain = column(writers.polyhedron, 0, false)
local steps = solved(plain)

local function as_plain(model, name)
    for _, b in ipairs(model:blocks()) do
        check.equal(#b.faces, 6)
        check.equal(#b.vertices, 8)
    end
    local taken = solved(model)
    check.holds(taken <= 1.3 * steps, string.format("%s: %d steps for %d", name, taken, steps))
    check.equal(#model:contacts(), #plain:contacts())
    for i, c in ipairs(model:contacts()) do
        check.equal(#c.points, #plain:contacts()[i].points)
        check.near(c.normal_force, plain:contacts()[i].normal_force, 2e-3 * plain:contacts()[i].normal_force)
        check.near(c.area, 1, 1e-3)
    end
end

-- What is cut of such blocks is kept by files.
local function cut(model)
    model:generate("jointset", { joint = "J", dip = 40, dip_dev = 20, dip_direction = 100, dip_direction_dev = 60, spacing = 0.7, number = 12,
        origin = { 0.5, 0.5, 0.5 * LEVELS } })
    check.near(model:blocks():sum("volume"), LEVELS, 6e-3)
    model:joint("J", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    model:cycle(50)
    local saved = stem .. ".talus"
    model:save(saved)
    check.equal(talus.restore(saved):state_hash(), model:state_hash())
    local again = talus.model {}
    model:write_blocks(stem .. "_cut.json")
    again:generate("blocks", { file = stem .. "_cut.json" })
    check.equal(#again:blocks(), #model:blocks())
    check.near(again:blocks():sum("volume"), model:blocks():sum("volume"), 1e-4 * LEVELS)
    os.remove(saved)
    os.remove(stem .. "_cut.json")
end

math.randomseed(34)
for _, name in ipairs { "polyhedron", "blocks", "obj", "stl", "stl_binary" } do
    for _, off in ipairs { 0, 1e-6, 1e-5, 1e-4 } do
        for _, divided in ipairs(TAKES_QUADS[name] and { true, false } or { true }) do
            local what = string.format("%s off by %g%s", name, off, divided and ", in triangles" or "")
            local model = column(writers[name], off, divided)
            as_plain(model, what)
            cut(model)
        end
    end
end
for _, ending in ipairs { ".json", ".obj", ".stl", "_binary.stl" } do
    os.remove(stem .. ending)
end
