-- The generator "import": STL of both kinds and OBJ, written here, read back; and files that are open,
-- turned, not convex, truncated or garbled.
local talus = require "talus"
local check = require "check"

local folder = assert(os.getenv("TALUS_TEST_TMP"))
-- The same tests may run in two programs at once.
local stem = string.format("%s/import_%s", folder, tostring({}):match("0x(%x+)") or "0")

local function write(ending, content)
    local path = stem .. ending
    local file = assert(io.open(path, "wb"))
    file:write(content)
    file:close()
    return path
end

-- ---------------------------------------------------------------- what is no regular file

-- A pipe that nobody writes to would never open; links are followed.
for ending, generator in pairs { [".stl"] = "import", [".obj"] = "import", [".json"] = "blocks" } do
    local pipe, link = stem .. "_pipe" .. ending, stem .. "_link" .. ending
    assert(os.execute(string.format("mkfifo '%s' && ln -s '%s' '%s'", pipe, pipe, link)))
    for path, what in pairs { [pipe] = "a pipe", [link] = "a pipe" } do
        local model = talus.model {}
        check.refused(model, function()
            model:generate(generator, { file = path, density = generator == "import" and 2000 or nil })
        end, "file '" .. path .. "' is " .. what .. ": only regular files are read")
    end
    os.remove(link)
    os.remove(pipe)
end
check.refused(talus.model {}, function() talus.model {}:generate("blocks", { file = folder }) end, "is a folder: only regular files are read")
check.refused(talus.model {}, function() talus.model {}:generate("blocks", { file = "/dev/zero" }) end, "is a device: only regular files")

-- ---------------------------------------------------------------- solids as lists of triangles

-- Twelve triangles of a box, counter-clockwise from outside.
local function box(x0, y0, z0, x1, y1, z1)
    local p = {}
    for i = 0, 7 do
        p[i] = { i % 2 == 0 and x0 or x1, i // 2 % 2 == 0 and y0 or y1, i < 4 and z0 or z1 }
    end
    local quads = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 },
        { 1, 3, 7, 5 } }
    local triangles = {}
    for _, q in ipairs(quads) do
        triangles[#triangles + 1] = { p[q[1]], p[q[2]], p[q[3]] }
        triangles[#triangles + 1] = { p[q[1]], p[q[3]], p[q[4]] }
    end
    return triangles
end

local function joined(...)
    local all = {}
    for _, triangles in ipairs { ... } do
        table.move(triangles, 1, #triangles, #all + 1, all)
    end
    return all
end

local function mapped(triangles, change)
    local all = {}
    for i, t in ipairs(triangles) do
        all[i] = { change(t[1]), change(t[2]), change(t[3]) }
    end
    return all
end

-- Every triangle in four, again and again.
local function refined(triangles, times)
    for _ = 1, times do
        local finer = {}
        local function middle(a, b)
            return { (a[1] + b[1]) / 2, (a[2] + b[2]) / 2, (a[3] + b[3]) / 2 }
        end
        for _, t in ipairs(triangles) do
            local ab, bc, ca = middle(t[1], t[2]), middle(t[2], t[3]), middle(t[3], t[1])
            for _, small in ipairs { { t[1], ab, ca }, { ab, t[2], bc }, { ca, bc, t[3] }, { ab, bc, ca } } do
                finer[#finer + 1] = small
            end
        end
        triangles = finer
    end
    return triangles
end

local function turned(t)
    return { t[1], t[3], t[2] }
end

local function inside_out(triangles)
    local all = {}
    for i, t in ipairs(triangles) do
        all[i] = turned(t)
    end
    return all
end

-- A rotation by no round angles.
local function rotated(p)
    local c, s, d, e = math.cos(0.7), math.sin(0.7), math.cos(0.3), math.sin(0.3)
    local x, y = c * p[1] - s * p[2], s * p[1] + c * p[2]
    return { x, d * y - e * p[3], e * y + d * p[3] }
end

-- ---------------------------------------------------------------- the three kinds of files

local function binary_stl(triangles)
    local parts = { ("solid or so it says"):rep(5):sub(1, 80), string.pack("<I4", #triangles) }
    for _, t in ipairs(triangles) do
        parts[#parts + 1] = string.pack("<fff", 0, 0, 0)
        for _, p in ipairs(t) do
            parts[#parts + 1] = string.pack("<fff", p[1], p[2], p[3])
        end
        parts[#parts + 1] = "\0\0"
    end
    return table.concat(parts)
end

local function text_stl(triangles)
    local lines = { "solid name of it" }
    for _, t in ipairs(triangles) do
        lines[#lines + 1] = "  facet normal 0 0 0\n    outer loop"
        for _, p in ipairs(t) do
            lines[#lines + 1] = string.format("      vertex %.9g %.9g %.9g", p[1], p[2], p[3])
        end
        lines[#lines + 1] = "    endloop\n  endfacet"
    end
    lines[#lines + 1] = "endsolid name of it\n"
    return table.concat(lines, "\r\n")
end

-- The same with all between the first line and the last in one line.
local function joined_stl(triangles)
    return (text_stl(triangles):gsub("\r?\n", " "):gsub("of it ", "of it\n", 1))
end

local function obj(triangles)
    local lines = { "# a comment", "o thing", "vn 0 0 1" }
    for i, t in ipairs(triangles) do
        for _, p in ipairs(t) do
            lines[#lines + 1] = string.format("v %.17g %.17g %.17g", p[1], p[2], p[3])
        end
        lines[#lines + 1] = i % 2 == 0 and "f -3//1 -2//1 -1//1"
            or string.format("f %d/1/1 %d/1/1 %d # rest", 3 * i - 2, 3 * i - 1, 3 * i)
    end
    return table.concat(lines, "\n")
end

local writers = { { ".stl", binary_stl }, { "_text.STL", text_stl }, { "_joined.stl", joined_stl }, { ".obj", obj } }

local function import(path, values)
    local model = talus.model {}
    local all = { file = path, density = 2700 }
    for key, value in pairs(values or {}) do
        all[key] = value
    end
    model:generate("import", all)
    return model
end

-- Blocks of these volumes come of each kind of file, in this order.
local function comes_out(triangles, volumes, faces, tolerance, values)
    for _, writer in ipairs(writers) do
        local model = import(write(writer[1], writer[2](triangles)), values)
        local blocks = model:blocks()
        check.equal(#blocks, #volumes)
        for i, volume in ipairs(volumes) do
            check.near(blocks[i].volume, volume, tolerance * volume)
            if faces then
                check.equal(#blocks[i].faces, faces)
            end
        end
    end
end

local unit = box(0, 0, 0, 1, 1, 1)
comes_out(unit, { 1 }, 6, 1e-14)
comes_out(box(-1, 2, 0.5, 2, 4, 1.5), { 6 }, 6, 1e-14)
comes_out(unit, { 8e-9 }, 6, 1e-12, { scale = 0.002, translate = { 5, 6, 7 } })
comes_out(joined(unit, box(5, 0, 0, 7, 1, 1)), { 1, 2 }, 6, 1e-14)
-- Solids that touch along a face, an edge, at a corner; and eight about a point.
comes_out(joined(unit, box(1, 0, 0, 3, 1, 1)), { 1, 2 }, 6, 1e-14)
comes_out(joined(unit, box(1, 1, 0, 3, 2, 1)), { 1, 2 }, 6, 1e-14)
comes_out(joined(unit, box(1, 1, 1, 3, 2, 2)), { 1, 2 }, 6, 1e-14)
local eight, ones = {}, {}
for i = 0, 7 do
    local x, y, z = i % 2, i // 2 % 2, i // 4
    eight = joined(eight, box(x, y, z, x + 1, y + 1, z + 1))
    ones[i + 1] = 1
end
comes_out(eight, ones, 6, 1e-14)
-- Flat sides divided into many triangles, also where rounding has put their points beside the plane.
comes_out(refined(unit, 4), { 1 }, 6, 1e-14)
comes_out(mapped(refined(unit, 4), rotated), { 1 }, nil, 1e-6)
comes_out(mapped(unit, rotated), { 1 }, nil, 1e-6)
-- A tetrahedron, and a ball of many faces.
comes_out({ { { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 } }, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 0, 1 } },
    { { 0, 0, 0 }, { 0, 0, 1 }, { 0, 1, 0 } }, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }, { 1 / 6 }, 4,
    1e-14)
local function on_ball(p)
    local r = math.sqrt(p[1] ^ 2 + p[2] ^ 2 + p[3] ^ 2)
    return { p[1] / r, p[2] / r, p[3] / r }
end
local octahedron = {}
for i = 0, 7 do
    local x, y, z = { 1 - 2 * (i % 2), 0, 0 }, { 0, 1 - 2 * (i // 2 % 2), 0 }, { 0, 0, 1 - 2 * (i // 4) }
    octahedron[i + 1] = x[1] * y[2] * z[3] > 0 and { x, y, z } or { x, z, y }
end
comes_out(octahedron, { 4 / 3 }, 8, 1e-14)
comes_out(mapped(refined(octahedron, 4), on_ball), { 4 / 3 * math.pi }, nil, 0.02)

-- Quads of an OBJ file, and what a block gets from the call.
local quads = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 2 2 0\nv 0 0 2\nv 2 0 2\nv 0 2 2\nv 2 2 2\n" ..
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
local model = import(write(".obj", quads), { group = "footing" })
check.equal(model:blocks()[1].group, "footing")
check.equal(model:blocks()[1].density, 2700)
check.near(model:blocks()[1].volume, 8, 1e-14)
check.equal(#model:blocks()[1].faces, 6)

-- ---------------------------------------------------------------- refusals

model:generate("joint", { joint = "J", dip = 30, dip_direction = 10, origin = { 1, 1, 1 } })

local function refused_file(path, part, values)
    local all = { file = path, density = 2700 }
    for key, value in pairs(values or {}) do
        all[key] = value
    end
    local message = check.refused(model, function() model:generate("import", all) end, part)
    check.holds(message:find(path, 1, true), "the file is named in '" .. message .. "'")
end

local function refused(triangles, part)
    for _, writer in ipairs(writers) do
        refused_file(write(writer[1], writer[2](triangles)), part)
    end
end

local function without(triangles, which)
    local rest = table.move(triangles, 1, #triangles, 1, {})
    table.remove(rest, which)
    return rest
end

local function exchanged(triangles, which, by)
    local all = table.move(triangles, 1, #triangles, 1, {})
    all[which] = by
    return all
end

refused(without(unit, 5), "the surface is open at 3 edges, the first from {")
refused(joined(box(4, 4, 4, 5, 5, 5), without(unit, 5)), "close it, so that every edge belongs to two faces")
refused({ unit[1] }, "has 1 face: it closes no solid, which takes 4 or more")
refused(exchanged(unit, 3, { { 0, 0, 0 }, { 0, 0, 0 }, { 1, 1, 1 } }), "the surface is open")
refused(exchanged(unit, 3, { { 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 } }), "the surface is open")
refused(joined(unit, unit), "faces lie on each other")
refused(joined(unit, { unit[5] }), "an odd number of faces meet, more than two, at 3 edges, the first from {")
refused_file(write(writers[1][1], writers[1][2](unit)), "and 12 without: it closes no solid; set weld lower", { weld = 9 })
refused({}, "holds no faces")
-- Faces turned, one of them or all, are turned back.
comes_out(inside_out(unit), { 1 }, 6, 1e-14)
comes_out(joined(unit, inside_out(box(3, 3, 3, 4, 4, 4))), { 1, 1 }, 6, 1e-14)
comes_out(exchanged(unit, 7, turned(unit[7])), { 1 }, 6, 1e-14)

-- A corner pushed in; a spike. (Both are divided, or refused with split = false.)
local function pushed(p)
    return p[1] + p[2] + p[3] == 3 and { 0.3, 0.3, 0.3 } or p
end
local function spiked(p)
    return p[1] == 0.5 and p[2] == 0.5 and p[3] == 1 and { 0.5, 0.5, 3 } or p
end
for _, writer in ipairs(writers) do
    refused_file(write(writer[1], writer[2](mapped(unit, pushed))), "is not convex: it bends inward at the edge", { split = false })
    refused_file(write(writer[1], writer[2](mapped(refined(unit, 1), spiked))), "is not convex", { split = false })
end
-- Both sides of two triangles.
refused({ unit[1], unit[2], turned(unit[1]), turned(unit[2]) }, "holds no volume")

local path = write(".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 9\n")
refused_file(path, "line 6: '9' names none of the 4 vertices")
refused_file(write(".obj", "v 0 0 0\nf 1 1\n"), "line 2: a face of 2 corners; it must have 3 or more")
refused_file(write(".obj", "v 0 0\n"), "line 1: three numbers are expected after 'v', the line ends")
refused_file(write(".obj", "v 0 0 1e\n"), "line 1: '1e' is not a number")
refused_file(write(".obj", "v 0 0 1,5\n"), "line 1: '1,5' is not a number; write a point in the place of the decimal comma")
refused_file(write(".obj", "v 0 0 nan\n"), "is not finite")
refused_file(write(".obj", "v 0 0 1e300\n"), "beyond 1e+30")
refused_file(write(".obj", "v 0 0 1\0\n"), "holds a zero byte at byte 8")
refused_file(write(".obj", "vertex 1 2 3\n"), "line 1: 'vertex' is not a word of OBJ")
refused_file(write(".obj", "\n"), "holds no faces; export the solids with the faces of their surfaces")
refused_file(write(".obj", (quads:gsub("v 2 2 2", "v 2 2 2.1"))), "flat = 0.0253 would take it")
refused_file(write(".stl", "\n"), "is no STL: it holds 1 bytes")
refused_file(write(".stl", binary_stl(unit):sub(1, -30)), "truncated")
refused_file(write(".stl", text_stl(unit):sub(1, 400)), "it is truncated")
refused_file(write(".stl", "solid x\n"), "ends at line 1 where 'endsolid' is expected: it is truncated")
refused_file(write(".stl", "solid x\nvertex 1 2 3\n"), "line 2: 'facet' is expected, not 'vertex'")
refused_file(stem .. "_missing.stl", "cannot be opened: No such file")
refused_file(folder .. "/.obj", "cannot be opened")
refused_file(stem .. ".xyz", "does not end in .obj, .stl, .ply, .vtk, .json,")
check.refused(model, function() model:generate("import", { file = stem .. ".obj", density = 1, scale = 0 }) end,
    "scale = 0 must be > 0")
check.refused(model, function() model:generate("import", { file = stem .. ".obj" }) end,
    "parameter 'density' is missing")
check.refused(model, function() model:generate("import", { density = 1 }) end, "parameter 'file' is missing")

-- ---------------------------------------------------------------- truncated and garbled files

-- Whatever the bytes, there is a sentence and no change, or blocks of some volume.
math.randomseed(20240607)
local function try(ending, content)
    local garbled = write(ending, content)
    local before = model:state_hash()
    local good, message = pcall(model.generate, model, "import", { file = garbled, density = 1000, group = "odd" })
    if good then
        local odd = model:blocks { group = "odd" }
        check.holds(#odd > 0 and odd:min("volume") > 0, "blocks of some volume")
        odd:delete()
        return 1
    end
    check.holds(type(message) == "string" and message:find("generator 'import' of plugin '", 1, true), "a sentence")
    check.equal(model:state_hash(), before)
    return 0
end

local accepted, tried = 0, 0
for _, writer in ipairs(writers) do
    local whole = writer[2](joined(unit, box(1, 0, 0, 3, 1, 1)))
    for length = 0, #whole - 1, math.max(1, #whole // 150) do
        accepted, tried = accepted + try(writer[1], whole:sub(1, length)), tried + 1
    end
    for _ = 1, 300 do
        local bytes = { whole:byte(1, -1) }
        for _ = 1, math.random(1, 6) do
            bytes[math.random(1, #bytes)] = math.random(0, 255)
        end
        local parts = {}
        for from = 1, #bytes, 4096 do
            parts[#parts + 1] = string.char(table.unpack(bytes, from, math.min(from + 4095, #bytes)))
        end
        accepted, tried = accepted + try(writer[1], table.concat(parts)), tried + 1
    end
end
check.holds(accepted < tried / 2, "most garbled files are refused")

for _, ending in ipairs { ".stl", "_text.STL", ".obj" } do
    os.remove(stem .. ending)
end
