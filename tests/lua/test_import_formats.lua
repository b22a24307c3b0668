-- The generator "import" gives the blocks of random models back out of every format that it reads: with objects and faces in any
-- order, faces turned, other units, and vertices off by up to `weld`; a vault rounded to a millimetre comes in and meets flush.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"
local files = require "import_files"

local folder = assert(os.getenv("TALUS_TEST_TMP"))
local stem = string.format("%s/formats_%s", folder, tostring({}):match("0x(%x+)") or "0")
local MODELS = 60

local function write(ending, content)
    local path = stem .. ending
    local file = assert(io.open(path, "wb"))
    file:write(content)
    file:close()
    return path
end

local writers, fans, digits = files.writers, files.fans, files.digits
local objects_of, disturbed = files.objects_of, files.disturbed

local NO_GROUPS = { [".ply"] = true, [".vtk"] = true }
local function ending_of(name) return name:match("%.%w+$"):lower() end

-- ---------------------------------------------------------------- models

local function random_model(seed)
    math.randomseed(seed)
    local model = talus.model { seed = seed }
    model:generate("box", { min = { -1, -2, 0.5 }, max = { 2, 1, 3 }, density = 2000, group = "rock" })
    for k = 1, 1 + seed % 4 do
        model:generate("joint", { joint = "J" .. k, dip = 90 * math.random(), dip_direction = 360 * math.random(),
            origin = { 0.5 + math.random() - 0.5, -0.5 + math.random() - 0.5, 1.75 + math.random() - 0.5 } })
    end
    return model
end

-- The blocks of two models are the same within a tolerance.
local function same(model, other, tolerance, groups)
    local blocks, list = model:blocks(), {}
    check.equal(#other:blocks(), #blocks)
    for _, b in ipairs(blocks) do
        list[#list + 1] = b
    end
    for _, b in ipairs(other:blocks()) do
        local best, least = nil, math.huge
        for _, a in ipairs(list) do
            local d = (a.centroid[1] - b.centroid[1]) ^ 2 + (a.centroid[2] - b.centroid[2]) ^ 2 + (a.centroid[3] - b.centroid[3]) ^ 2
            if d < least then
                best, least = a, d
            end
        end
        check.near(math.sqrt(least), 0, tolerance)
        check.near(b.volume, best.volume, 20 * tolerance)
        check.equal(#b.faces, #best.faces)
        if groups then
            check.equal(b.group, groups[best.id])
        end
    end
end

for seed = 1, check.cases(MODELS) do
    local model = random_model(seed)
    local groups = {}
    for i, b in ipairs(model:blocks()) do
        groups[b.id] = i % 3 == 0 and "support" or "rock"
    end
    for ending, writer in pairs(writers) do
        local grouped = not NO_GROUPS[ending_of(ending)] and groups or nil
        -- all digits, faces turned: PLY and VTK have one object, whose faces are turned where shells touch
        local apart = ending_of(ending) ~= ".ply" and ending_of(ending) ~= ".vtk"
        local other = talus.model {}
        other:generate("import", { file = write(ending, writer(disturbed(objects_of(model), apart), digits("%.17g"))), density = 2000 })
        same(model, other, 1e-9, grouped)
        -- millimetres with one decimal
        local small = talus.model {}
        small:generate("import", { file = write(ending, writer(disturbed(objects_of(model), false), function(x) return string.format("%.1f", 1000 * x) end)),
            scale = 0.001, density = 2000, translate = { 0, 0, 0 } })
        if not ending:find("little") and not ending:find("big") and not ending:find("binary") and not ending:find("offsets") then
            same(model, small, 2e-4, grouped)
        end
    end
end

-- ---------------------------------------------------------------- vertices off by up to weld

-- Each triangle of an STL with its own corners, off by up to half of weld; and quads whose faces leave their planes.
for seed = 1, check.cases(MODELS) do
    local model = random_model(seed)
    local weld = 10 ^ -math.random(3, 6)
    local function moved(p)
        local q = {}
        for k = 1, 3 do
            q[k] = p[k] + weld * (2 * math.random() - 1) / (2 * math.sqrt(3))
        end
        return q
    end
    local objects = disturbed(objects_of(model), true)
    local lines = {}
    for _, o in ipairs(objects) do
        lines[#lines + 1] = "solid " .. o.name
        for _, t in ipairs(fans(o)) do
            lines[#lines + 1] = "facet normal 0 0 0\nouter loop"
            for _, p in ipairs(t) do
                lines[#lines + 1] = string.format("vertex %.17g %.17g %.17g", table.unpack(moved(p)))
            end
            lines[#lines + 1] = "endloop\nendfacet"
        end
        lines[#lines + 1] = "endsolid"
    end
    local shortest = math.huge
    for _, o in ipairs(objects) do
        for _, f in ipairs(o.faces) do
            for i, v in ipairs(f) do
                local a, b = o.vertices[v], o.vertices[f[i % #f + 1]]
                shortest = math.min(shortest, math.sqrt((a[1] - b[1]) ^ 2 + (a[2] - b[2]) ^ 2 + (a[3] - b[3]) ^ 2))
            end
        end
    end
    if shortest > 20 * weld then
        local other = talus.model {}
        local summary = other:generate("import", { file = write(".stl", table.concat(lines, "\n")), weld = weld, flat = 2 * weld, density = 2000 })
        same(model, other, 40 * weld)
        check.equal(summary.report.refused, 0)
        check.equal(summary.report.objects, #objects)
        check.holds(summary.report[1].welded > 0, "vertices welded")
    end
end

-- ---------------------------------------------------------------- faces divided on one side of an edge only

-- Divides some faces of an object between two of their edges, time and again. Neighbours know nothing of the new corners.
local function divided(object, times)
    for _ = 1, times do
        local f = math.random(#object.faces)
        local face, new = object.faces[f], { {}, {} }
        local i = math.random(#face - 1)
        local j = math.random(i + 1, #face)
        local at = {}
        for k, edge in ipairs { i, j } do
            local p, q, share = object.vertices[face[edge]], object.vertices[face[edge % #face + 1]], 0.2 + 0.6 * math.random()
            object.vertices[#object.vertices + 1] = { p[1] + share * (q[1] - p[1]), p[2] + share * (q[2] - p[2]), p[3] + share * (q[3] - p[3]) }
            at[k] = #object.vertices
        end
        new[1] = { at[1] }
        table.move(face, i + 1, j, 2, new[1])
        table.insert(new[1], at[2])
        new[2] = { at[2] }
        table.move(face, j + 1, #face, 2, new[2])
        table.move(face, 1, i, #new[2] + 1, new[2])
        table.insert(new[2], at[1])
        object.faces[f], object.faces[#object.faces + 1] = new[1], new[2]
    end
    return object
end

for seed = 1, check.cases(MODELS) do
    local model, corners = random_model(seed), 0
    for ending, writer in pairs { [".obj"] = writers[".obj"], [".stl"] = writers[".stl"] } do
        local objects = objects_of(model)
        for _, object in ipairs(objects) do
            divided(object, seed % 7)
        end
        local other = talus.model {}
        local summary = other:generate("import", { file = write(ending, writer(objects, digits("%.12f"))), density = 2000 })
        same(model, other, 1e-9)
        for _, row in ipairs(summary.report) do
            corners = corners + (row.between or 0)
        end
    end
    check.equal(corners > 0, seed % 7 > 0)
end

-- ---------------------------------------------------------------- a vault

-- A barrel vault of 20 courses with 35 stones, every other one offset by half a stone, rounded to `unit`.
local COURSES, STONES, RADIUS, THICK, LENGTH = 20, 35, 3, 0.3, 0.4
local function vault(unit)
    local objects = {}
    local function rounded(x) return unit and math.floor(x / unit + 0.5) * unit or x end
    for c = 0, COURSES - 1 do
        for k = 0, STONES - 1 do
            local o = { name = string.format("stone_%d_%d", c, k), group = c % (COURSES - 1) == 0 and "support" or "rock", vertices = {},
                faces = { { 1, 3, 4, 2 }, { 5, 6, 8, 7 }, { 1, 2, 6, 5 }, { 3, 7, 8, 4 }, { 1, 5, 7, 3 }, { 2, 4, 8, 6 } } }
            for i = 0, 7 do
                local angle = math.pi * (0.1 + 0.8 * (c + i % 2) / COURSES)
                local y = LENGTH * (k + i // 2 % 2 + c % 2 / 2)
                local r = RADIUS + THICK * (i // 4)
                local x, z = -r * math.cos(angle), r * math.sin(angle)
                x, y = 0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y -- no face along an axis
                y, z = 0.96 * y - 0.28 * z, 0.28 * y + 0.96 * z
                o.vertices[i + 1] = { rounded(x), rounded(y), rounded(z) }
            end
            objects[#objects + 1] = o
        end
    end
    return objects
end

local function import(ending, objects, format, values)
    local model = talus.model {}
    local all = { file = write(ending, writers[ending](objects, digits(format))), density = 2000 }
    for key, value in pairs(values or {}) do
        all[key] = value
    end
    local summary = model:generate("import", all)
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    return model, summary
end

local exact = import(".obj", vault(), "%.17g")
local coarse, summary = import(".obj", vault(0.001), "%.3f")
check.equal(#exact:blocks(), COURSES * STONES)
check.equal(#coarse:blocks(), COURSES * STONES)
check.equal(summary.report.refused, 0)
check.holds(summary.report.made_plane > 0 and summary.report.move < 0.003, "moved by some millimetres at most")
-- courses share 2 (COURSES - 1) STONES sides, stones of a course 2 (STONES - 1) COURSES
check.equal(summary.report.shared, 2 * (COURSES - 1) * STONES + 2 * (STONES - 1) * COURSES)
exact:cycle(1)
coarse:cycle(1)
check.equal(#coarse:contacts(), #exact:contacts())
-- they meet flush: what a face misses is far below the rounding of the file
check.holds(coarse:contacts():min "gap" > -1e-7, "no overlaps")
check.near(coarse:blocks():sum "volume", exact:blocks():sum "volume", 1e-3 * exact:blocks():sum "volume")
check.equal(#coarse:blocks { group = "support" }, 2 * STONES)

-- With less it is refused, by name, with what would take it, and that does.
local message = check.refused(talus.model {}, function()
    talus.model {}:generate("import", { file = stem .. ".obj", density = 2000, flat = 1e-5 })
end, "objects are refused (skip = true leaves them out): object 'stone_")
local needs = tonumber(message:match "flat = ([%d.e-]+) would take it")
check.holds(needs > 1e-5 and needs < 1e-3, "a tolerance is named")
local part = talus.model {}
local left = part:generate("import", { file = stem .. ".obj", density = 2000, flat = needs, skip = true })
check.holds(left.report.refused > 0 and left.report.refused + #part:blocks() == COURSES * STONES, "all others are there")
local worst = 0
for _, row in ipairs(left.report) do
    worst = math.max(worst, row.needs_flat or 0)
    check.equal(row.refused ~= nil, row.needs_flat ~= nil)
end
check.equal(#import(".obj", vault(0.001), "%.3f", { flat = worst }):blocks(), COURSES * STONES)

-- ---------------------------------------------------------------- OBJ by groups, names, transformations

local function cube(first, x, lines, turned)
    for i = 0, 7 do
        lines[#lines + 1] = string.format("v %g %g %g", x + i % 2, i // 2 % 2, i // 4)
    end
    for _, f in ipairs { { 1, 3, 4, 2 }, { 5, 6, 8, 7 }, { 1, 2, 6, 5 }, { 3, 7, 8, 4 }, { 1, 5, 7, 3 }, { 2, 4, 8, 6 } } do
        lines[#lines + 1] = string.format("f %d %d %d %d", first + f[1], first + f[2], first + f[3], first + f[4])
    end
end
local lines = { "o all", "g left stones" }
cube(0, 0, lines)
lines[#lines + 1] = "g right"
cube(8, 1.5, lines)
local named = talus.model {}
named:generate("import", { file = write(".obj", table.concat(lines, "\n")), density = 1 })
check.equal(#named:blocks { group = "left stones" }, 1)
check.equal(#named:blocks { group = "right" }, 1)
named:generate("import", { file = stem .. ".obj", density = 1, group = "mine", translate = { 0, 5, 0 } })
check.equal(#named:blocks { group = "mine" }, 2)

-- Names that agree in all of the letters that are kept stay apart.
lines = { "o " .. ("n"):rep(70) .. "A" }
cube(0, 0, lines)
lines[#lines + 1] = "o " .. ("n"):rep(70) .. "B"
cube(8, 1.5, lines)
local long = talus.model {}
local told = long:generate("import", { file = write(".obj", table.concat(lines, "\n")), density = 1 })
check.equal(told.report.long_names, 4)
local first, second = long:blocks()[1].group, long:blocks()[2].group
check.holds(first ~= second and #first == 63 and first:sub(1, 50) == ("n"):rep(50), first .. ", " .. second)

local turned = talus.model {}
turned:generate("import", { density = 1, file = write("_moved.json", [==[
{"data": {"transformation": {"dtype": "t", "data": {"matrix": [[0, -1, 0, 10], [1, 0, 0, 20], [0, 0, 1, 30], [0, 0, 0, 1]]}},
 "geometry": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "faces": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]}}}]==]) })
check.near(turned:blocks()[1].centroid, { 9.75, 20.25, 30.25 }, 1e-12)

-- ---------------------------------------------------------------- solids that touch along a sharp edge

-- Two wedges of 25 degrees whose sharp edges are one, as triangles without numbers. Faces far off their plane may not take
-- the angle of such a wedge for none.
local sharp, tan = {}, math.tan(math.rad(25))
for side = -1, 1, 2 do
    local at = { { 0, 0, 0 }, { 0, 1, 0 }, { side, 0, 0 }, { side, 1, 0 }, { side, 0, tan }, { side, 1, tan } }
    for _, f in ipairs { { 1, 5, 6 }, { 1, 6, 2 }, { 1, 2, 4 }, { 1, 4, 3 }, { 3, 4, 6 }, { 3, 6, 5 }, { 1, 3, 5 }, { 2, 6, 4 } } do
        sharp[#sharp + 1] = "facet normal 0 0 0\nouter loop"
        for k = 1, 3 do
            sharp[#sharp + 1] = ("vertex %.9f %.9f %.9f"):format(table.unpack(at[f[side < 0 and (5 - k) % 3 + 1 or k]]))
        end
        sharp[#sharp + 1] = "endloop\nendfacet"
    end
end
write(".stl", "solid a\n" .. table.concat(sharp, "\n") .. "\nendsolid a\n")
for _, flat in ipairs { 1e-3, 0.3 } do
    local wedges = talus.model {}
    wedges:generate("import", { file = stem .. ".stl", density = 1, weld = 1e-6, flat = flat })
    check.equal(#wedges:blocks(), 2)
    check.near(wedges:blocks():sum "volume", tan, 1e-8)
end

-- ---------------------------------------------------------------- what write_blocks writes

for seed = 1, check.cases(MODELS) do
    local model = random_model(seed)
    for _, ending in ipairs { ".obj", ".stl", ".ply", ".vtk" } do
        local path = stem .. "_out" .. ending
        model:write_blocks(path)
        local other = talus.model {}
        other:generate("import", { file = path, density = 2000 })
        same(model, other, 1e-9)
    end
end

-- ---------------------------------------------------------------- faults

local function refused(ending, content, part)
    check.refused(talus.model {}, function() talus.model {}:generate("import", { file = write(ending, content), density = 1 }) end, part)
end
local PLY = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n" ..
    "property list uchar int vertex_indices\nend_header\n"
refused(".ply", "plyy\n", "is no PLY")
refused(".ply", "ply\nformat ascii 1.0\n", "ends at line 2 within the header: it is truncated")
refused(".ply", (PLY:gsub("float x", "flot x")), "line 4: the type of a property")
refused(".ply", (PLY:gsub("vertex_indices", "corners")) .. "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n", "has no vertex_indices")
refused(".ply", PLY .. "0 0 0\n1 0 0\n0 1 0\n", "ends in vertex 4 of the 4 it announces: it is truncated")
refused(".ply", PLY .. "0 0 0\n1 0\n", "line 11: vertex 2 ends before all its properties are given")
refused(".ply", PLY .. "0 0 0\n1 0 0,5\n", "decimal comma")
refused(".ply", PLY .. "0 0 0\n1 0 nan\n", "vertex 2: the corner {1, 0, nan} is not finite")
refused(".ply", PLY .. "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 4\n", "face 1 names vertex 4, but there are 4")
refused(".ply", PLY .. "0 0 0\n1 0 0\n0 1 0\n0 0 1\n2 0 1\n", "has 2 entries; of corners it must be 3 to")
refused(".ply", (PLY:gsub("ascii", "binary_little_endian"):gsub("vertex 4", "vertex 1000000000")) .. "abcd", "ends in vertex 1 of the 1000000000")
refused(".ply", (PLY:gsub("vertex 4", "vertex 99999999999")), "'99999999999' is not a whole number from 0 to")
local VTK = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n"
refused(".vtk", "solid x", "is no VTK legacy file")
refused(".vtk", (VTK:gsub("POLYDATA", "UNSTRUCTURED_GRID")), "not POLYDATA")
refused(".vtk", VTK .. "POINTS 2 float\n0 0 0 1", "ends at line 6")
refused(".vtk", VTK .. "POINTS 1 flot\n0 0 0", "line 5: a type of numbers is expected, not 'flot'")
refused(".vtk", (VTK:gsub("ASCII", "BINARY")) .. "POINTS 1000000000 float\n0000", "are announced, but 4 bytes follow")
refused(".vtk", VTK .. "POINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 3\n", "face 1 names vertex 3")
refused(".vtk", VTK .. "POLYGONS 1 3\n2 0 1\n", "a polygon of 2 corners")
refused(".vtk", VTK .. "TRIANGLE_STRIPS 1 4\n", "strips of triangles are not read")
refused(".dat", "new\nset grav 0 0 -1\n", "holds no faces")
refused(".dat", "poly face 0 0 0 1 0 0\n", "line 1: a face of 2 corners")
refused(".dat", "poly face 0 0 0 1 0 0 0 1\n", "a corner has 2 coordinates, not 3; go on with &")
refused(".dat", "\npoly face 0 0 0 1 0 0 0 1 x\n", "line 2: 'x' is not a number")
refused(".json", "[1, 2", "ends at line 1 where ',' or ']' is expected: it is truncated")
refused(".json", "[1,\n2;]", "line 2: ',' or ']' is expected at ';]'")
refused(".json", ("["):rep(100), "less than 64 lists within each other")
refused(".json", '{"a": 1}', "holds no faces")
refused(".json", '{"format": "talus block model", "version": 1, "blocks": []}', "read it by the generator 'blocks'")
refused(".json", '{"vertex": {"0": {"x": 0, "y": 0, "z": 0}}, "face": {"0": [0, 1, 2]}}', "the number of one of the vertices")
refused(".json", '{"vertex": {"0": {"x": "a"}}, "face": {"0": [0, 1, 2]}}', "a vertex of three numbers")
refused(".json", '{"vertex": {"0": {"x": NaN, "y": 0, "z": 0}}, "face": {"0": [0, 1, 2]}}', "a vertex of")
-- ---------------------------------------------------------------- truncated and garbled files

-- Whatever the bytes, there is a sentence and no change, or blocks of some volume.
local unchanged = talus.model {}
local before = unchanged:state_hash()
local function try(ending, content)
    local good, result = pcall(unchanged.generate, unchanged, "import", { file = write(ending, content), density = 1000, skip = math.random(2) == 1 })
    if good then
        check.holds(#unchanged:blocks() > 0 and unchanged:blocks():min "volume" > 0, "blocks of some volume")
        unchanged = talus.model {}
        return
    end
    check.holds(type(result) == "string" and result:find("generator 'import' of plugin '", 1, true), "a sentence")
    check.equal(unchanged:state_hash(), before)
end
math.randomseed(11)
for ending, writer in pairs(writers) do
    local whole = writer(objects_of(random_model(3)), digits("%.6g"))
    for _ = 1, check.cases(300) do
        local bytes = { whole:byte(1, -1) }
        for _ = 1, math.random(0, 6) do
            bytes[math.random(1, #bytes)] = math.random(3) == 1 and math.random(0, 255) or whole:byte(math.random(#whole))
        end
        local last = math.random(4) == 1 and math.random(#bytes) or #bytes
        local parts = {}
        for from = 1, last, 4096 do
            parts[#parts + 1] = string.char(table.unpack(bytes, from, math.min(from + 4095, last)))
        end
        try(ending, table.concat(parts))
    end
end

for _, file in ipairs { ".obj", ".stl", ".ply", ".vtk", ".dat", ".json", "_moved.json", "_out.obj", "_out.stl", "_out.ply", "_out.vtk" } do
    os.remove(stem .. file)
end
for ending in pairs(writers) do
    os.remove(stem .. ending)
end
