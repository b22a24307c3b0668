-- Meshes made elsewhere: legacy VTK and gmsh 2.2, for blocks that there are and as blocks; what Talus has written comes back; bad files.
local talus = require "talus"
local check = require "check"
local meshes = require "meshes"

local folder = assert(os.getenv("TALUS_TEST_TMP"))
local stem = string.format("%s/zone_files_%s", folder, tostring({}):match("0x(%x+)") or "0")
local made = {}

local function path(ending)
    made[#made + 1] = stem .. ending
    return stem .. ending
end

local function named_solid(model)
    model:solid("granite", "elastic", { young = 1e10, poisson = 0.25 })
    model:joint("*", "coulomb", { kn = 1e11, ks = 1e11, friction = 30 })
    return model
end

-- One block under another.
local function two_blocks()
    local model = named_solid(talus.model { gravity = { 0, 0, -10 } })
    model:generate("box", { { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2500, group = "low" },
        { min = { 0, 0, 1 }, max = { 2, 1, 2 }, density = 2500, group = "high" } })
    return model
end

local function layered()
    return meshes.box({ 0, 0, 0 }, { 2, 1, 2 }, { 4, 2, 4 }, function(_, _, z) return z < 1 and 1 or 2 end)
end

-- ---------------------------------------------------------------- every kind of file

local mesh = layered()
local files = {
    meshes.vtk(path("_ascii.vtk"), mesh, {}),
    meshes.vtk(path("_binary.vtk"), mesh, { binary = true }),
    meshes.vtk(path("_single.vtk"), mesh, { binary = true, single = true }),
    meshes.vtk(path("_offsets.vtk"), mesh, { offsets = true, group = "material" }),
    meshes.vtk(path("_offsets_binary.vtk"), mesh, { offsets = true, binary = true, text = "group" }),
    meshes.gmsh(path(".msh"), mesh),
    meshes.gmsh(path("_named.msh"), mesh, { "low", "high" }, { "1 15 2 0 1 1", "2 2 2 7 1 1 2 3" }),
}
do -- ends of lines of Windows
    local text = io.open(files[6], "rb"):read "a"
    files[#files + 1] = meshes.write(path("_crlf.msh"), (text:gsub("\n", "\r\n")))
    text = io.open(files[1], "rb"):read "a"
    files[#files + 1] = meshes.write(path("_crlf.vtk"), (text:gsub("\n", "\r\n")))
end
local hash
for _, file in ipairs(files) do
    local model = two_blocks()
    local report = model:blocks():deformable { file = file, solid = "granite" }
    check.equal(report.zones, 192)
    check.equal(report.gridpoints, 2 * 5 * 3 * 3)
    check.equal(report.blocks, 2)
    check.near(report.smallest_altitude, 0.5 / math.sqrt(2), 1e-12)
    check.holds(report.altitude_ratio > 0.4 and report.altitude_ratio < 1)
    check.equal(#model:zones { group = "low" }, 96)
    check.near(model:zones():sum "volume", 4, 1e-12)
    check.near(model:gridpoints():sum "mass", 10000, 1e-8)
    hash = hash or model:state_hash()
    check.equal(model:state_hash(), hash)
end

-- Of the blocks that are given only: each group gets its solid.
do
    local model = two_blocks()
    model:solid("slate", "elastic", { young = 1e9, poisson = 0.2 })
    model:blocks { group = "low" }:deformable { file = files[1], solid = "granite" }
    check.equal(#model:zones(), 96)
    model:blocks { group = "high" }:deformable { file = files[1], solid = "slate" }
    check.equal(#model:zones { solid = "slate" }, 96)
end

-- Joined blocks share gridpoints, whether the file's points are shared or there twice.
for twice = 0, 1 do
    local halves = { points = {}, cells = {} }
    local lower = meshes.box({ 0, 0, 0 }, { 2, 1, 1 }, { 4, 2, 2 })
    local upper = meshes.box({ 0, 0, 1 }, { 2, 1, 2 }, { 4, 2, 2 })
    table.move(lower.points, 1, #lower.points, 1, halves.points)
    table.move(upper.points, 1, #upper.points, #lower.points + 1, halves.points)
    table.move(lower.cells, 1, #lower.cells, 1, halves.cells)
    for _, c in ipairs(upper.cells) do
        local moved = { region = 2 }
        for a = 1, 4 do
            moved[a] = c[a] + #lower.points
        end
        table.insert(halves.cells, moved)
    end
    local model = two_blocks()
    model:blocks():join()
    local report = model:blocks():deformable { solid = "granite",
        file = twice == 1 and meshes.vtk(path("_twice.vtk"), halves, { binary = true }) or files[1] }
    check.equal(report.zones, 192)
    check.equal(report.gridpoints, 5 * 3 * 5)
    check.equal(#model:blocks(), 2)
end

-- ---------------------------------------------------------------- blocks of a mesh

local function blocks_of(file, more)
    local model = named_solid(talus.model { gravity = { 0, 0, -10 } })
    local summary = model:generate("zones", { file = file, density = 2500, group = more })
    return model, summary
end
for file, groups in pairs { [files[1]] = { "rock" }, [files[4]] = { "1", "2" }, [files[5]] = { "layer 1", "layer 2" }, [files[6]] = { "rock", "rock" },
    [files[7]] = { "low", "high" } } do
    local model, summary = blocks_of(file)
    check.equal(summary.after, #groups)
    check.near(model:blocks():sum "volume", 4, 1e-12)
    for k, group in ipairs(groups) do
        check.equal(model:blocks()[k].group, group)
        check.equal(#model:blocks()[k].vertices, 8)
    end
    check.equal(model:blocks():deformable { file = file, solid = "granite" }.zones, 192)
end
check.equal(blocks_of(files[1], "clay"):blocks()[1].group, "clay")
-- Two pieces of one group that do not hang together are two blocks; one that is not convex is none.
do
    local apart = meshes.box({ 0, 0, 0 }, { 3, 1, 1 }, { 3, 1, 1 })
    local kept = {}
    for _, c in ipairs(apart.cells) do
        local x = (apart.points[c[1]][1] + apart.points[c[2]][1] + apart.points[c[3]][1] + apart.points[c[4]][1]) / 4
        kept[#kept + 1] = (x < 1 or x > 2) and c or nil
    end
    apart.cells = kept
    check.equal(#blocks_of(meshes.gmsh(path("_apart.msh"), apart, { "rock" })):blocks(), 2)
    local bent = meshes.box({ 0, 0, 0 }, { 2, 1, 2 }, { 2, 1, 2 })
    bent.cells = table.move(bent.cells, 1, 18, 1, {}) -- three cubes of four
    local empty = talus.model {}
    check.refused(empty, function() empty:generate("zones", { file = meshes.vtk(path("_bent.vtk"), bent, {}), density = 1 }) end,
        "is not convex, or has gaps: it holds 3 m3, the hull of its corners 3.5 m3")
end

-- ---------------------------------------------------------------- what Talus has written comes back

-- Rock that is cut at random, in some cases with joined blocks.
local seed = 7
local function random(low, high)
    seed = (seed * 1103515245 + 12345) % 2147483648
    return low + (high - low) * seed / 2147483648
end

local function picture(model) -- zones by their places and volumes, in an order that hangs on these alone
    local list = {}
    for _, z in ipairs(model:zones()) do
        local c = z.centroid
        list[#list + 1] = string.format("%.8f %.8f %.8f %.8f", c[1] + 1e-9, c[2] + 1e-9, c[3] + 1e-9, z.volume)
    end
    table.sort(list)
    return table.concat(list, "\n")
end

local function unbalanced(model)
    local most = 0
    for _, force in ipairs(model:gridpoints():values "force") do
        most = math.max(most, math.sqrt(force[1] ^ 2 + force[2] ^ 2 + force[3] ^ 2))
    end
    return most
end

for case = 1, check.cases(10) do
    local function rock()
        return named_solid(talus.model { gravity = { 0, 0, 0 }, seed = case })
    end
    local first = rock()
    first:generate("box", { min = { -2, -2, -2 }, max = { 2, 2, 2 }, density = 2500, group = "rock" })
    for k = 1, 2 + case % 3 do
        first:generate("joint", { joint = "J" .. k, dip = random(0, 90), dip_direction = random(0, 360),
            origin = { random(-1, 1), random(-1, 1), random(-1, 1) } })
    end
    if case % 2 == 0 then -- some of them are joined
        first:blocks { above = { dip = 10, dip_direction = 30, origin = { 0, 0, 0 } } }:join()
    end
    local second = first:copy()
    local report = first:blocks():deformable { zone = random(0.8, 1.5), solid = "granite" }
    local name = string.format("%s_out%d", stem, case)
    first:write_vtk(name)
    local file = name .. "_zones_000000.vtk"
    local again = second:blocks():deformable { file = file, solid = "granite" }
    check.equal(again.zones, report.zones)
    check.equal(again.gridpoints, report.gridpoints)
    check.near(again.smallest_altitude, report.smallest_altitude, 1e-12)
    check.equal(picture(second), picture(first))
    -- Blocks of the mesh are those that it was made of.
    local third = rock()
    third:generate("zones", { file = file, density = 2500 })
    check.equal(#third:blocks(), #first:blocks())
    check.near(third:blocks():sum "volume", 64, 1e-9)
    check.equal(third:blocks { group = "rock" }:deformable { file = file, solid = "granite" }.zones, report.zones)
    check.equal(picture(third), picture(first))
    -- Under the same stress inside and outside they are at rest at once.
    for _, model in ipairs { second, third } do
        local stress = { xx = -3e6, yy = -4e6, zz = -5e6, xy = 0.5e6, yz = 0.2e6, zx = -0.4e6 }
        model:insitu { stress = stress }
        for _, side in ipairs { "xmin", "xmax", "ymin", "ymax", "zmin", "zmax" } do
            model:boundary { side = side, stress = stress }
        end
        model:cycle(1)
        check.holds(unbalanced(model) < 1e-9 * 5e6, string.format("case %d rests in its first step: %g N", case, unbalanced(model)))
    end
    -- They are kept as other meshes are.
    local twin = second:copy()
    second:save(name .. ".talus")
    local restored = talus.restore(name .. ".talus")
    check.equal(twin:state_hash(), second:state_hash())
    check.equal(restored:state_hash(), second:state_hash())
    for _, model in ipairs { second, twin, restored } do
        model.gravity = { 0, 0, -10 }
        model:cycle(5)
    end
    check.equal(twin:state_hash(), second:state_hash())
    check.equal(restored:state_hash(), second:state_hash())
    for _, ending in ipairs { "_zones_000000.vtk", "_blocks_000000.vtk", "_contacts_000000.vtk", "_joints_000000.vtk", ".talus",
        "_zones.vtk.series", "_blocks.vtk.series", "_contacts.vtk.series", "_joints.vtk.series" } do
        os.remove(name .. ending)
    end
end

-- Blocks that have moved are filled where they are.
do
    local model = two_blocks()
    model:blocks():set { velocity = { 3, 0, 0 } }
    model.gravity = { 0, 0, 0 }
    model:cycle(1)
    while model.time < 0.01 do
        model:cycle(1)
    end
    local moved = layered()
    local way = model:blocks()[1].displacement[1]
    for _, p in ipairs(moved.points) do
        p[1] = p[1] + way
    end
    check.refused(model, function() model:blocks():deformable { file = files[1], solid = "granite" } end, "outside of block 1")
    check.equal(model:blocks():deformable { file = meshes.vtk(path("_moved.vtk"), moved, { binary = true }), solid = "granite" }.zones, 192)
    check.near(model:gridpoints()[1].velocity, { 3, 0, 0 }, 1e-9)
end

-- ---------------------------------------------------------------- bad calls and bad files

local model = two_blocks()
local all = model:blocks()
check.refused(model, function() all:deformable { file = files[1], zone = 1, solid = "granite" } end, "not both")
check.refused(model, function() all:deformable { file = 7, solid = "granite" } end, "file")
check.refused(model, function() all:deformable { file = stem .. "_none.vtk", solid = "granite" } end, "cannot be opened: No such file")
check.refused(model, function() all:deformable { file = folder, solid = "granite" } end, "is a folder: only regular files are read")
check.refused(model, function() all:deformable { file = files[1] } end, "solid")

local bad = path("_bad")
local function refused(text, part, other)
    meshes.write(bad, text)
    check.refused(model, function() all:deformable { file = bad, solid = "granite" } end, other or part)
    check.refused(model, function() model:generate("zones", { file = bad, density = 1 }) end, part)
end
local function changed(file, what, by, part, other)
    local text = io.open(file, "rb"):read "a"
    local found, last = text:find(what, 1, true)
    assert(found, what)
    refused(text:sub(1, found - 1) .. by .. text:sub(last + 1), part, other)
end
local vtk, binary, msh, named, late = files[1], files[2], files[6], files[7], files[4]

refused("", "is no mesh that Talus knows")
refused("<VTKFile>", "is XML: save it as legacy VTK")
changed(vtk, "ASCII", "BSCII", "line 3: ASCII or BINARY is expected, not 'BSCII'")
changed(vtk, "UNSTRUCTURED_GRID", "POLYDATA", "line 4: the data are of the kind 'POLYDATA'")
changed(vtk, "POINTS 75", "POINTS 1000000000", "line 5: 3000000000 coordinates are announced, but only")
changed(vtk, "POINTS 75 double", "POINTS 75 quadruple", "line 5: 'quadruple', the type of coordinates")
changed(vtk, "POINTS 75 double\n0", "POINTS 75 double\nnan", "point 0 is at {nan, 0, 0}: coordinates must be finite")
changed(vtk, "POINTS 75 double\n0", "POINTS 75 double\nx", "line 6: a coordinate is expected, a number, not 'x'")
changed(vtk, "CELLS 192 960", "CELLS 1000000000 5000000000", "how many numbers the cells have is 5000000000")
changed(vtk, "CELLS 192 960", "CELLS 1000000000 4000000000", "4000000000 numbers of cells are announced, but only")
changed(vtk, "CELLS 192 960\n4", "CELLS 192 960\n-4", "how many points a cell has is -4: it must be a whole number")
changed(vtk, "CELLS 192 960\n4", "CELLS 192 960\n900", "the first 1 cells have more than the 960 numbers that are announced")
changed(vtk, "CELL_TYPES 192\n10", "CELL_TYPES 192\n24", "cell 0 is a tetrahedron of higher order (type 24)")
changed(vtk, "CELL_TYPES 192\n10", "CELL_TYPES 192\n12", "cell 0 is of type 12: zones are tetrahedra of four points")
changed(vtk, "CELL_TYPES 192", "CELL_TYPES 191", "there are 191 types of 192 cells")
changed(vtk, "CELL_TYPES 192", "BELL_TYPES 192", "'BELL_TYPES' begins nothing that a legacy VTK file")
changed(late, "SCALARS material int 1", "SCALARS material int x", "SCALARS have 1 to 9 numbers, not 'x'")
refused((io.open(vtk, "rb"):read "a"):sub(1, -20), "is expected: it is truncated")
for _, file in ipairs { vtk, binary, files[5], msh, named, late } do -- cut off anywhere
    local text = io.open(file, "rb"):read "a"
    for part = 1, 40 do
        meshes.write(bad, text:sub(1, #text * part // 41))
        local good, message = pcall(function() model:copy():generate("zones", { file = bad, density = 1 }) end)
        check.holds(not good or (file == late or file == files[5]) and part > 20, "a file that is cut off is refused")
        check.holds(good or (message:find("^[^\n]+:%d+: [^\n]+$") and message:find("_bad", 1, true)), message)
    end
end
changed(msh, "2.2 0 8", "4.1 0 8", "line 2: the file is of gmsh's format 4.1: save it as 2.2")
changed(msh, "2.2 0 8", "2.2 1 8", "the file is binary: save it as text")
changed(msh, "$EndMeshFormat", "$EndMeshFormat\n$Wind\n$EndWind", "line 4: '$Wind' is no section of gmsh 2.2")
changed(msh, "$Nodes\n75", "$Nodes\n1000000000", "line 5: 1000000000 nodes are announced, but only")
changed(msh, "$Elements\n192", "$Elements\n1000000000", "1000000000 elements are announced, but only")
changed(msh, "$Elements\n192", "$Elements\n193", "the number of an element is expected, a number, not '$EndElements'")
changed(msh, "$Nodes\n75\n1 0 0 0", "$Nodes\n75\n2 0 0 0", "two nodes before it have the number 2")
changed(msh, "1 4 2 0 1 ", "1 11 2 0 1 ", "element 1 is a tetrahedron of higher order (type 11)")
changed(msh, "1 4 2 0 1 ", "1 5 2 0 1 ", "element 1 is of type 5")
changed(msh, "1 4 2 0 1 1 ", "1 4 2 0 1 99 ", "element 1 has the node 99, which is not among the 75 nodes")
changed(msh, "$EndElements", "$EndElefants", "$EndElements is expected, not '$EndElefants'")
changed(named, '3 1 "low"', "3 1 low", "the name of a physical group in quotes is expected")

-- Shapes. What fits no block is no fault of the file.
local function shaped(change, part, other)
    local spoilt = layered()
    change(spoilt)
    local file = meshes.gmsh(bad, spoilt)
    check.refused(model, function() all:deformable { file = file, solid = "granite" } end, part)
    if other then
        check.refused(model, function() model:generate("zones", { file = file, density = 1 }) end, other)
    end
end
local INSIDE = 15 + 1 * 5 + 2 + 1 -- a point inside the lower block: (1, 0.5, 0.5)
shaped(function(m) m.cells[5][1], m.cells[5][2] = m.cells[5][2], m.cells[5][1] end, "element 5 is turned inside out", "element 5 is turned inside out")
shaped(function(m) m.cells[9][4] = m.cells[9][1] end, "element 9 is flat", "element 9 is flat")
shaped(function(m) m.points[INSIDE + 7] = { 5, 0, 0 } end, "element", "element")
shaped(function(m) table.remove(m.cells, 60) end, "no other tetrahedron has it: the mesh has a gap there")
shaped(function(m) -- a point is there twice
    table.insert(m.points, { table.unpack(m.points[INSIDE]) })
    for _, c in ipairs(m.cells) do
        for a = 1, 4 do
            if c[a] == INSIDE then
                c[a] = #m.points
                return
            end
        end
    end
end, string.format("its points %d and %d are in one place, {1, 0.5, 0.5} in block 1", 76, INSIDE))
shaped(function(m) -- one tetrahedron is divided in two at an edge, and those beside it are not
    for k, c in ipairs(m.cells) do
        local p, q = m.points[c[1]], m.points[c[4]]
        if c[1] == INSIDE or c[4] == INSIDE then
            table.insert(m.points, { (p[1] + q[1]) / 2, (p[2] + q[2]) / 2, (p[3] + q[3]) / 2 })
            m.cells[k] = { c[1], c[2], c[3], #m.points, region = c.region }
            table.insert(m.cells, { #m.points, c[2], c[3], c[4], region = c.region })
            return
        end
    end
end, "points that hang on sides")
shaped(function(m) table.insert(m.cells, { table.unpack(m.cells[1]) }); m.cells[#m.cells].region = 1 end, "overlap", "overlap")
shaped(function(m) -- off the face by 2e-6 of the block
    for _, p in ipairs(m.points) do
        p[1] = p[1] > 1.9 and p[1] + 5e-6 or p[1]
    end
end, "outside of block 1, in which it is")
shaped(function(m)
    for _, p in ipairs(m.points) do
        p[3] = 1000 * p[3]
    end
end, "has no tetrahedra in block")
shaped(function(m) -- the mesh does not end at the joint
    for _, p in ipairs(m.points) do
        p[3] = p[3] > 0.9 and p[3] < 1.1 and 1.1 or p[3]
    end
end, "outside of block 1, in which it is")
do -- off by less than the tolerance
    local near = layered()
    for _, p in ipairs(near.points) do
        p[1] = p[1] > 1.9 and p[1] + 1e-6 or p[1]
    end
    check.equal(two_blocks():blocks():deformable { file = meshes.gmsh(bad, near), solid = "granite" }.zones, 192)
end
do -- blocks of one body whose triangles differ
    local joined = two_blocks()
    joined:blocks():join()
    local odd = { points = {}, cells = {} }
    for z, count in pairs { [0] = { 4, 2, 2 }, [1] = { 2, 2, 2 } } do
        local part = meshes.box({ 0, 0, z }, { 2, 1, z + 1 }, count)
        for _, c in ipairs(part.cells) do
            table.insert(odd.cells, { c[1] + #odd.points, c[2] + #odd.points, c[3] + #odd.points, c[4] + #odd.points, region = z + 1 })
        end
        table.move(part.points, 1, #part.points, #odd.points + 1, odd.points)
    end
    local file = meshes.gmsh(bad, odd)
    check.refused(joined, function() joined:blocks():deformable { file = file, solid = "granite" } end, "its zones do not fit those of the blocks")
    check.equal(two_blocks():blocks():deformable { file = file, solid = "granite" }.zones, 144)
end

for _, file in ipairs(made) do
    os.remove(file)
end
