-- Files that the generator "import" refuses: each sentence tells the file, what is wrong, where, and what to do; the model stays as it
-- was. And files that look wrong and are not.
local talus = require "talus"
local check = require "check"

local folder = assert(os.getenv("TALUS_TEST_TMP"))
local stem = string.format("%s/errors_%s_", folder, tostring({}):match("0x(%x+)") or "0")

local function write(name, content)
    local path = stem .. name
    local file = assert(io.open(path, "wb"))
    file:write(content)
    file:close()
    return path
end

local model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 1 })

-- `file`: how its name ends. All parts stand in the sentence.
local function refused(file, content, ...)
    local path = write(file, content)
    for _, part in ipairs { path, ... } do
        check.refused(model, function() model:generate("import", { file = path, density = 1 }) end, part)
    end
    os.remove(path)
end

local function taken(file, content, blocks, volume)
    local path, other = write(file, content), talus.model {}
    other:generate("import", { file = path, density = 1 })
    check.equal(#other:blocks(), blocks)
    check.near(other:blocks():sum "volume", volume, 1e-12)
    os.remove(path)
end

-- A cube, as rows of vertices and of faces with numbers from `first`.
local function vertices(x, begin)
    local text = ""
    for i = 0, 7 do
        text = text .. ("%s%d %d %d\n"):format(begin or "", x + i % 2, i // 2 % 2, i // 4)
    end
    return text
end
local FACES = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } }
local function faces(first, begin, count, turned)
    local text = ""
    for k = 1, count or #FACES do
        local f, words = FACES[k], {}
        for i = 1, 4 do
            words[i] = first + f[turned and 5 - i or i]
        end
        text = text .. begin .. " " .. table.concat(words, " ") .. "\n"
    end
    return text
end

-- ---- no file, an empty one, an unknown ending ----

for _, ending in ipairs { ".obj", ".stl", ".ply", ".vtk", ".json", ".dat", ".3ddat", ".3dec", ".txt" } do
    refused("empty" .. ending, "", "is empty (0 bytes); export it again")
end
for _, ending in ipairs { "no_ending", "stones.step", "stones.obj.gz", "stonesobj" } do
    refused(ending, vertices(0, "v "), "does not end in .obj, .stl, .ply, .vtk, .json, .dat, .3ddat, .3dec or .txt; export it so")
end
for _, ending in ipairs { ".obj", ".dat" } do
    refused(ending, "\n", "holds no faces; export the solids with the faces of their surfaces")
end

-- ---- OBJ ----

local OBJ = vertices(0, "v ") .. faces(1, "f")
refused("cut.obj", OBJ:sub(1, -4), "object '1': the surface is open at 3 edges, the first from {1, 0, 0} to", "close it, so that every edge")
refused("cut.obj", vertices(0, "v "):sub(1, -4), ", line 8: three numbers are expected after 'v', the line ends")
for _, number in ipairs { "nan", "inf", "1e31" } do
    refused(number .. ".obj", (OBJ:gsub("v 1 1 1", "v 1 " .. number .. " 1")), ", line 8: the corner {1, " .. (number == "1e31" and "1e+31" or number),
        "is not finite or beyond 1e+30; the file is damaged")
end
refused("index.obj", OBJ .. "f 1 2 99999999999999999999\n", ", line 15: '99999999999999999999' names none of the 8 vertices")
refused("index.obj", OBJ .. "f 0 1 2\n", ", line 15: '0' names none of the 8 vertices given before it; the file is damaged")
refused("index.obj", OBJ .. "f -9 1 2\n", "'-9' names none of the 8 vertices")
local second = "o bad\n" .. vertices(4, "v ")
refused("open.obj", "o good\n" .. OBJ .. second .. faces(9, "f", 5), "1 of 2 objects are refused (skip = true leaves them out): object 'bad': "
    .. "the surface is open at 4 edges, the first from {5, 0, 0} to {5, 1, 0}")
do -- left aside, and reported
    local path, other = write("open.obj", "o good\n" .. OBJ .. second .. faces(9, "f", 5)), talus.model {}
    local report = other:generate("import", { file = path, density = 1, skip = true }).report
    check.equal(report.refused, 1)
    check.equal(#other:blocks(), 1)
    check.equal(report[1].name, "bad")
    check.holds(report[1].refused:find("open at 4 edges", 1, true), "the reason")
    os.remove(path)
end
-- A name that comes again is no fault. It is told with its number.
do
    local bad = vertices(4, "v ") .. faces(9, "f", 5)
    local path = write("names.obj", "o same\n" .. OBJ .. "o same\n" .. bad .. "o same\n" .. vertices(8, "v ") .. faces(17, "f", 4))
    local report = talus.model {}:generate("import", { file = path, density = 1, skip = true }).report
    check.equal(report.refused, 2)
    check.equal(report[1].name .. " " .. report[2].name, "same (2) same (3)")
    os.remove(path)
end
taken("names.obj", "o same\n" .. OBJ .. "o same\n" .. vertices(4, "v ") .. faces(9, "f"), 2, 2)

-- ---- PLY ----

local HEAD = "ply\nformat %s 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\nelement face %s\n"
    .. "property list uchar int vertex_indices\nend_header\n"
local function ply(vertex_count, face_count, data, format)
    return HEAD:format(format or "ascii", vertex_count, face_count) .. data
end
local CUBE = vertices(0) .. faces(0, "4")
refused("cut.ply", ply(8, 6, CUBE):sub(1, -12), "ends in face 6 of the 6 it announces: it is truncated; export it again")
refused("cut.ply", ply(8, 6, CUBE):sub(1, 60), "line 5:", "is expected in the header of a PLY; the file is damaged")
refused("billion.ply", ply(8, "1000000000", CUBE), "ends in face 7 of the 1000000000 it announces: it is truncated")
refused("billion.ply", ply(8, "1000000000", ("\0"):rep(96) .. "\4", "binary_little_endian"), "ends in face 1 of the 1000000000 it announces")
refused("trillion.ply", ply(8, "1000000000000", CUBE), ", line 7: '1000000000000' is not a whole number from 0 to 2147483647")
refused("nan.ply", ply(8, 6, (CUBE:gsub("1 1 1", "1 1 nan", 1))), "vertex 8: the corner {1, 1, nan} is not finite")
refused("points.ply", ply(8, 0, vertices(0)), "holds no faces; export the solids with the faces of their surfaces")
refused("open.ply", ply(16, 11, vertices(0) .. vertices(4) .. faces(0, "4") .. faces(8, "4", 5)), "the surface is open at 4 edges, the first from {5, 0, 0}")

-- ---- VTK ----

local VTK = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS %d float\n%sPOLYGONS %s %s\n%s"
local function vtk(points, count, faces_count, numbers, list)
    return VTK:format(count, points, faces_count, numbers, list)
end
local ONE = { vertices(0), 8, 6, 30, faces(0, "4") }
refused("cut.vtk", vtk(table.unpack(ONE)):sub(1, -12), "ends at line 19", "it is truncated; export it again")
refused("billion.vtk", vtk(vertices(0), 8, "1000000000", "1000000000", faces(0, "4")), "where a number is expected: it is truncated")
refused("billion.vtk", vtk(vertices(0), 8, "1000000000", "5000000000", faces(0, "4")), "line 14: '5000000000' is not a whole number from 0 to")
refused("nan.vtk", vtk((vertices(0):gsub("1 1 1", "1 1 nan")), 8, 6, 30, faces(0, "4")), "point 8: the corner {1, 1, nan} is not finite")
refused("index.vtk", vtk(vertices(0), 8, 6, 30, faces(4, "4")), "names vertex 8, but there are 8, counted from 0; the file is damaged")
refused("other.vtk", "<?xml version=\"1.0\"?>\n<VTKFile>\n", "is no VTK legacy file: it does not begin with '# vtk DataFile'")

-- ---- solids turned inside out, and solids that touch, in files without objects ----

for _, turned in ipairs { "none", "second", "both" } do
    local one, two = faces(0, "4", 6, turned == "both"), faces(8, "4", 6, turned ~= "none")
    for _, x in ipairs { 1, 4 } do -- beside the first one, and away from it
        local points = vertices(0) .. vertices(x)
        taken("turned.ply", ply(16, 12, points .. one .. two), 2, 2)
        taken("turned.vtk", vtk(points, 16, 12, 60, one .. two), 2, 2)
    end
end
-- One face turned in each of two cubes with a common side; and four cubes about an edge.
taken("face.ply", ply(16, 12, vertices(0) .. vertices(1) .. faces(0, "4"):gsub("4 0 2 3 1", "4 1 3 2 0") .. faces(8, "4"):gsub("4 8 10 11 9", "4 9 11 10 8")), 2, 2)
do
    local points, list = "", ""
    for k = 0, 3 do
        points = points .. vertices(k % 2):gsub("(%d) (%d) (%d)", function(x, y, z) return ("%d %d %d"):format(x, y + k // 2, z) end)
        list = list .. faces(8 * k, "4", 6, k == 2)
    end
    taken("four.ply", ply(32, 24, points .. list), 4, 4)
end

-- ---- JSON ----

local MESH = '{"vertex": {"0": {"x": 0, "y": 0, "z": 0}, "1": {"x": 1, "y": 0, "z": 0}, "2": {"x": 0, "y": 1, "z": 0}, "3": {"x": 0, "y": 0, "z": 1}},\n'
    .. '"face": {"0": [0, 2, 1], "1": [0, 1, 3], "2": [1, 2, 3], "3": [2, 0, 3]}}'
taken("mesh.json", MESH, 1, 1 / 6)
taken("names.json", '{"a": ' .. MESH .. ', "a": ' .. MESH:gsub('"x": 0', '"x": 5'):gsub('"x": 1', '"x": 6') .. "}", 2, 1 / 3)
refused("cut.json", MESH:sub(1, -20), "ends at line 2 where", "it is truncated; export it again")
refused("nan.json", (MESH:gsub('"x": 1', '"x": NaN')), "line 1: a vertex of finite numbers is expected at '\"1\": {\"x\": NaN")
refused("word.json", (MESH:gsub('"x": 1', '"x": one')), "line 1: a value is expected at 'one")
refused("index.json", (MESH:gsub("2, 0, 3", "2, 0, 7")), "line 2: the number of one of the vertices of the mesh is expected at '7]}}'")
refused("open.json", (MESH:gsub(', "3": %[2, 0, 3%]', "")), "has 3 faces: it closes no solid")

-- ---- STL ----

refused("billion.stl", ("x"):rep(80) .. string.pack("<I4", 1000000000) .. ("\0"):rep(50), "says it has 1000000000 triangles, which take 50000000084 bytes, but holds 134 bytes")
refused("cut.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n", "ends at line 5 where 'vertex' is expected: it is truncated")
refused("nan.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", "line 4: the corner {0, 0, nan} is not finite")
