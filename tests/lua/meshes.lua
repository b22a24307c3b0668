-- meshes.lua - meshes of tetrahedra in files, as other programs write them, for the tests.
local meshes = {}

-- A box of nx x ny x nz cubes, each in six tetrahedra around its diagonal. Points are numbered from 1; each tetrahedron has the number
-- of its region, which region(x, y, z) gives of its cube's middle.
function meshes.box(low, high, count, region)
    local mesh, number = { points = {}, cells = {} }, {}
    for k = 0, count[3] do
        for j = 0, count[2] do
            for i = 0, count[1] do
                local at, p = { i, j, k }, {}
                for a = 1, 3 do
                    p[a] = low[a] + (high[a] - low[a]) * at[a] / count[a]
                end
                table.insert(mesh.points, p)
                number[i .. " " .. j .. " " .. k] = #mesh.points
            end
        end
    end
    local ways = { { 1, 2, 3 }, { 2, 3, 1 }, { 3, 1, 2 }, { 1, 3, 2 }, { 3, 2, 1 }, { 2, 1, 3 } }
    for k = 0, count[3] - 1 do
        for j = 0, count[2] - 1 do
            for i = 0, count[1] - 1 do
                local middle = {}
                for a, m in ipairs { i, j, k } do
                    middle[a] = low[a] + (high[a] - low[a]) * (m + 0.5) / count[a]
                end
                for w, way in ipairs(ways) do
                    local at = { i, j, k }
                    local cell = { number[table.concat(at, " ")], region = region and region(table.unpack(middle)) or 1 }
                    for _, axis in ipairs(way) do
                        at[axis] = at[axis] + 1
                        cell[#cell + 1] = number[table.concat(at, " ")]
                    end
                    if w > 3 then -- the odd permutations are turned the other way
                        cell[3], cell[4] = cell[4], cell[3]
                    end
                    table.insert(mesh.cells, cell)
                end
            end
        end
    end
    return mesh
end

local function write(path, text)
    local file = assert(io.open(path, "wb"))
    file:write(text)
    file:close()
    return path
end
meshes.write = write

-- gmsh 2.2. `names[region]`: of its physical group. `more`: lines of other elements.
function meshes.gmsh(path, mesh, names, more)
    local lines = { "$MeshFormat", "2.2 0 8", "$EndMeshFormat" }
    local function add(format, ...)
        lines[#lines + 1] = string.format(format, ...)
    end
    if names then
        add("$PhysicalNames\n%d", #names)
        for k, name in ipairs(names) do
            add('3 %d "%s"', k, name)
        end
        add("$EndPhysicalNames")
    end
    add("$Nodes\n%d", #mesh.points)
    for k, p in ipairs(mesh.points) do
        add("%d %.17g %.17g %.17g", k, p[1], p[2], p[3])
    end
    add("$EndNodes\n$Elements\n%d", #mesh.cells + #(more or {}))
    for _, line in ipairs(more or {}) do
        add("%s", line)
    end
    for k, c in ipairs(mesh.cells) do
        add("%d 4 2 %d %d %d %d %d %d", k + #(more or {}), names and c.region or 0, c.region, c[1], c[2], c[3], c[4])
    end
    add("$EndElements\n")
    return write(path, table.concat(lines, "\n"))
end

-- Legacy VTK. how: binary, offsets (those of version 5.1), group (the name of an array), text (it is one of texts).
function meshes.vtk(path, mesh, how)
    local parts = { "# vtk DataFile Version " .. (how.offsets and "5.1" or "3.0") .. "\na mesh\n" ..
        (how.binary and "BINARY" or "ASCII") .. "\nDATASET UNSTRUCTURED_GRID\n" }
    local function add(text)
        parts[#parts + 1] = text
    end
    local function list(format, numbers)
        for k, number in ipairs(numbers) do
            add(how.binary and string.pack(format, number) or (math.type(number) and string.format("%.17g", number)) .. (k % 6 > 0 and " " or "\n"))
        end
        add("\n")
    end
    local places, cells, kinds, groups, offsets = {}, {}, {}, {}, { 0 }
    for _, p in ipairs(mesh.points) do
        table.move(p, 1, 3, #places + 1, places)
    end
    for _, c in ipairs(mesh.cells) do
        if not how.offsets then
            cells[#cells + 1] = 4
        end
        for a = 1, 4 do
            cells[#cells + 1] = c[a] - 1
        end
        kinds[#kinds + 1], groups[#groups + 1], offsets[#offsets + 1] = 10, c.region, offsets[#offsets] + 4
    end
    add(string.format("POINTS %d %s\n", #mesh.points, how.single and "float" or "double"))
    list(how.single and ">f" or ">d", places)
    if how.offsets then
        add(string.format("CELLS %d %d\nOFFSETS vtktypeint64\n", #offsets, #cells))
        list(">i8", offsets)
        add("CONNECTIVITY vtktypeint64\n")
        list(">i8", cells)
    else
        add(string.format("CELLS %d %d\n", #kinds, #cells))
        list(">i4", cells)
    end
    add(string.format("CELL_TYPES %d\n", #kinds))
    list(">i4", kinds)
    if how.group then
        add(string.format("CELL_DATA %d\nSCALARS %s %s 1\nLOOKUP_TABLE default\n", #kinds, how.group, how.real and "double" or "int"))
        list(how.real and ">d" or ">i4", groups)
    elseif how.text then
        add(string.format("CELL_DATA %d\nFIELD FieldData 1\n%s 1 %d string\n", #kinds, how.text, #kinds))
        for _, c in ipairs(mesh.cells) do
            local name = "layer " .. c.region
            add(how.binary and string.char(0xc0 | #name) .. name or name:gsub(" ", "%%20") .. "\n")
        end
        add("\n")
    end
    return write(path, table.concat(parts))
end

return meshes
