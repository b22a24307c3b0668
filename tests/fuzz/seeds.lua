-- seeds.lua FOLDER: writes what the fuzz targets begin with, into FOLDER/restore, json, obj,
-- stl, ply, vtk, poly, compas, mesh, command, fab, discs, poles, esri and record.
local talus = require "talus"
local folder = arg[1]

local function model(options)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -1, -1, -1 }, max = { 3, 3, 0 }, density = 2000, group = "floor" })
    m:blocks():fix()
    for i = 1, options.hulls or 0 do
        m:generate("polyhedron", { density = 2000, vertices = { { 0, 0, i - 0.9 }, { 1, 0.1, i - 1 }, { 0.9, 1, i - 0.95 }, { 0.1, 0.9, i - 0.9 },
            { 0.5, 0.4, i - 0.1 } } })
    end
    if options.rock then
        m:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2000, group = "rock" })
        m:generate("joint", { joint = "J1", dip = 60, dip_direction = 90, origin = { 1, 0, 0.5 } })
        m:generate("joint", { joint = "J2", dip = 10, dip_direction = 10, origin = { 1, 0, 0.5 } })
    end
    m:joint("*", options.law or "coulomb", options.law == "coulomb_tensile" and { kn = 1e8, ks = 1e8, friction = 30, tension = 1e4, dilation = 3 } or
        { kn = 1e8, ks = 1e8, friction = 30 })
    if options.damping then
        m:damping(options.damping)
    end
    return m
end

local saved = {
    model { hulls = 2, damping = "local" },
    model { hulls = 1, damping = "kinetic" },
    model { rock = true, law = "coulomb_tensile", damping = "adaptive" },
    model { rock = true },
    talus.model {},
}
saved[3]:blocks { group = "rock" }:where(function(b) return b.centroid[1] < 1 end):join()
saved[3]:blocks { group = "rock" }:load { force = { 100, 0, 0 } }
saved[4]:blocks { group = "rock" }:drive { velocity = { 0, 0, 0.1 } }
saved[1]:history { name = "kinetic", every = 2, value = "kinetic" }
saved[1]:history { name = "hulls", every = 1, of = saved[1]:blocks { fixed = false }, field = "displacement" }
saved[4]:history { name = "press", every = 3, of = saved[4]:contacts(), field = "normal_force", take = "max" }
saved[4]:history { name = "steps", every = 5, value = function(m) return m.cycles, m.time end }
for k, m in ipairs(saved) do
    if k < 5 then
        m:cycle(4 * k)
    end
    if k == 2 then
        m:blocks { fixed = false }:delete() -- what was found of contacts is out of date
    elseif k == 4 then
        m:generate("joint", { joint = "J3", dip = 90, dip_direction = 0, origin = { 1, 0.5, 0.5 } })
        assert(#m:contacts() > 0)
    end
    m:save(string.format("%s/restore/%d.talus", folder, k))
    m:write_blocks(string.format("%s/json/%d.json", folder, k))
end

local function write(name, text)
    local file = assert(io.open(folder .. "/" .. name, "wb"))
    file:write(text)
    file:close()
end
for _, kind in ipairs { "obj", "stl", "ply", "vtk", "poly", "compas", "mesh", "command", "fab", "discs", "poles",
    "esri", "record" } do -- makes the folders
    saved[5]:write_blocks(string.format("%s/%s/0", folder, kind))
end
write("obj/1", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng a\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
write("obj/2", "o b\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 4/1 3/2 2/3 1/4\nf 5 6 7 8\nf 1 2 6 5\n" ..
    "f 2 3 7 6\nf -6 -5 -1 -2\nf 4 1 5 8\n")
write("stl/1", "solid a\n" .. string.rep("facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n", 4) ..
    "endsolid a\n")
local corners = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local triangles = ""
for _, t in ipairs { { 1, 3, 2 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 1, 4 } } do
    triangles = triangles .. string.pack("<fff", 0, 0, 0)
    for _, c in ipairs(t) do
        triangles = triangles .. string.pack("<fff", table.unpack(corners[c]))
    end
    triangles = triangles .. string.pack("<I2", 0)
end
write("stl/2", string.rep(" ", 80) .. string.pack("<I4", 4) .. triangles)
for k = 1, 3 do
    for _, kind in ipairs { "obj", "stl", "ply", "vtk" } do
        saved[k]:write_blocks(string.format("%s/%s/%d.%s", folder, kind, 10 + k, kind))
    end
end
local PLY = "ply\nformat %s 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n" ..
    "property list uchar int vertex_indices\nend_header\n"
local VTK = "# vtk DataFile Version %s\nt\nBINARY\nDATASET POLYDATA\nPOINTS 4 float\n"
local sides = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } }
for format, order in pairs { binary_little_endian = "<", binary_big_endian = ">" } do
    local data = ""
    for _, c in ipairs(corners) do
        data = data .. string.pack(order .. "fff", table.unpack(c))
    end
    local points = data
    for _, t in ipairs(sides) do
        data = data .. string.pack(order .. "Bi4i4i4", 3, table.unpack(t))
    end
    write("ply/" .. format, PLY:format(format) .. data)
    if order == ">" then
        local counted, offsets, all = "", string.pack(">i8", 0), ""
        for k, t in ipairs(sides) do
            counted = counted .. string.pack(">i4i4i4i4", 3, table.unpack(t))
            offsets = offsets .. string.pack(">i8", 3 * k)
            all = all .. string.pack(">i8i8i8", table.unpack(t))
        end
        write("vtk/1", VTK:format("3.0") .. points .. "\nPOLYGONS 4 16\n" .. counted .. "\n")
        write("vtk/2", VTK:format("5.1") .. points .. "\nPOLYGONS 5 12\nOFFSETS vtktypeint64\n" .. offsets ..
            "\nCONNECTIVITY vtktypeint64\n" .. all .. "\nMETADATA\nINFORMATION 0\n\nCELL_DATA 4\n")
    end
end
write("poly/1", 'block create group "a" poly face 0,0,0 0,1,0 1,0,0 face 0,0,0 1,0,0 0,0,1 face 1,0,0 0,1,0 0,0,1 face 0,1,0 0,0,0 0,0,1 r=1\n')
write("poly/2", "new ; all\npoly reg 2 face 0 0 0  0 1 0  1 0 0 &\n face (0,0,0) (1,0,0) (0,0,1) ...\n face 1 0 0 0 1 0 0 0 1 face 0 1 0 0 0 0 0 0 1 group 'b'\n")
write("compas/1", '[{"dtype": "compas.datastructures/Mesh", "data": {"vertex": {"0": {"x": 0, "y": 0, "z": 0}, "1": {"x": 1, "y": 0.0, "z": 0}, ' ..
    '"2": {"x": 0, "y": 1, "z": 0}, "3": {"x": 0, "y": 0, "z": 1e0}}, "face": {"0": [0, 2, 1], "1": ["0", "1", "3"], "2": [1, 2, 3], "3": [2, 0, 3]}}}]')
write("compas/2", '{"is_support": true, "transformation": {"data": {"matrix": [[1, 0, 0, 0], [0, 1, 0, 2], [0, 0, 1, 0], [0, 0, 0, 1]]}}, "geometry": ' ..
    '{"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "faces": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]}}')
for k, text in ipairs { '{"op":"step","n":100}', '{"op":"delete","blocks":[3,5]}', '{"op":"friction","joint":"J\\u00e91:3","value":-3.5e1}',
    '{ "op" : "cut", "joint": "a\\"b", "dip": 60, "dip_direction": 90.5, "origin": [1, -2.5, 1e3] }' } do
    write("command/" .. k, text)
end

for k, text in ipairs { "\0time,acc\n0,0\n0.01,1\n0.02,-0.5\n", "\1 0\r\n1e-1\r\n-.5\r\n# end\n",
    "\8PEER\nX\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   4, DT=   .0100 SEC,\n .1E+00 .2\n .5 -1\n",
    "\22VELOCITY TIME HISTORY IN UNITS OF CM/S\n 4    0.0100    NPTS, DT\n 0 1 .5\n-1\n", "\97 0;1;2;3\n1;2;3;4\n" } do
    write("record/" .. k, text)
end
-- Data of the site.
write("fab/1", "BEGIN FORMAT\n  Format = Ascii\n  XAxis = East\n  Length_Unit = Meter\n  No_Fractures = 2\nEND FORMAT\n" ..
    "BEGIN PROPERTIES\n  Prop1 = (Real*4) \"T\"\nEND PROPERTIES\nBEGIN FRACTURE\n  1 4 1 1e-7\n  1 0 0 0\n  2 2 0 0\n  3 2 2 0\n" ..
    "  4 0 2 0\n  0 0 0 1\n  2 3 1\n 1 0 0 0\n 2 0 1.5 0\n 3 0 0 1e0\n 0 1 0 0\nEND FRACTURE\nBEGIN TESSFRACTURE\nEND TESSFRACTURE\n")
write("fab/2", "BEGIN FORMAT\nLength_Unit = Feet\nEND FORMAT\n")
write("discs/1", "x,y,z,dip,dip_direction,radius\n0,0,0,30,120,2.5\n1.5,-2,3,90,0,1e-3\n")
write("discs/2", '\xef\xbb\xbf# a remark\n"Radius";X;Y;Z;Dip Direction;DIP;name\r\n1;0;0;0;10;20;a\r\n\r\n')
write("poles/1", "dip,dip_direction\n30,120\n31,121.5\n89,300\n")
write("poles/2", "set\tdip\tdip-direction\tweight\nA\t30\t120\t1.5\nB\t0\t0\t0.1\n")

-- The ground: grids, and triangles as text and binary.
write("esri/1", "ncols 3\nnrows 2\nxllcorner -5.5\nyllcorner 0\ncellsize 5\nNODATA_value -9999\n1 2.5 3\n4 -9999 6e0\n")
write("esri/2", "NCOLS 2\r\nNROWS 2\r\nXLLCENTER 0\r\nYLLCENTER 0\r\nDX 1\r\nDY 2\r\n1 2\r\n3 4\r\n")
write("esri/3", "solid g\n" .. string.rep("facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 1\nvertex 0 1 0\nendloop\nendfacet\n", 2) .. "endsolid g\n")
write("esri/4", string.rep(" ", 80) .. string.pack("<I4", 4) .. triangles)

-- Meshes of a cube in all formats.
package.path = "tests/lua/?.lua;" .. package.path
local meshes = require "meshes"
local cube = meshes.box({ 0, 0, 0 }, { 1, 1, 1 }, { 1, 1, 2 }, function(_, _, z) return z < 0.5 and 1 or 2 end)
for k, how in ipairs { {}, { binary = true, group = "group" }, { offsets = true, text = "material" },
    { offsets = true, binary = true, text = "group" }, { binary = true, single = true, group = "region", real = true } } do
    meshes.vtk(string.format("%s/mesh/%d.vtk", folder, k), cube, how)
end
meshes.gmsh(folder .. "/mesh/1.msh", cube)
meshes.gmsh(folder .. "/mesh/2.msh", cube, { "low", "high" }, { "1 15 2 0 1 1", "2 2 2 7 1 1 2 3" })
