-- import_files.lua - files of closed solids in every format that the generator "import" reads, as other programs write them.
--
-- An object has a name, a group, vertices and faces, which count vertices from 1. A writer takes a list of objects and a function
-- that writes a number, and gives the text of the file:
--
--     local text = files.writers[".obj"](objects, files.digits "%.17g")
--
-- Numbers of faces, orders and signs vary by math.random.
local files = { writers = {} }

-- The list in another order.
function files.shuffled(list)
    for i = #list, 2, -1 do
        local k = math.random(i)
        list[i], list[k] = list[k], list[i]
    end
    return list
end

-- The triangles of an object, of corners.
function files.fans(o)
    local list = {}
    for _, f in ipairs(o.faces) do
        for i = 2, #f - 1 do
            list[#list + 1] = { o.vertices[f[1]], o.vertices[f[i]], o.vertices[f[i + 1]] }
        end
    end
    return list
end

local shuffled, fans, writers = files.shuffled, files.fans, files.writers

writers[".obj"] = function(objects, number)
    local lines, first = { "# objects" }, 0
    for _, o in ipairs(objects) do
        lines[#lines + 1] = "o " .. o.name .. "\ng " .. o.group
        for _, p in ipairs(o.vertices) do
            lines[#lines + 1] = "v " .. number(p[1]) .. " " .. number(p[2]) .. " " .. number(p[3])
        end
        for _, f in ipairs(o.faces) do
            local words = {}
            for i, v in ipairs(f) do
                words[i] = math.random(2) == 1 and tostring(first + v) or (v - #o.vertices - 1) .. "/1/1"
            end
            lines[#lines + 1] = "f " .. table.concat(words, " ", 1, 2) .. " \\\n " .. table.concat(words, " ", 3)
        end
        first = first + #o.vertices
    end
    return table.concat(lines, "\r\n")
end

writers[".stl"] = function(objects, number)
    local lines = {}
    for _, o in ipairs(objects) do
        lines[#lines + 1] = "solid " .. o.group
        for _, t in ipairs(fans(o)) do
            lines[#lines + 1] = "facet normal 0 0 0\nouter loop"
            for _, p in ipairs(t) do
                lines[#lines + 1] = "vertex " .. number(p[1]) .. " " .. number(p[2]) .. " " .. number(p[3])
            end
            lines[#lines + 1] = "endloop\nendfacet"
        end
        lines[#lines + 1] = "endsolid"
    end
    return table.concat(lines, "\n") .. "\n"
end

-- All vertices, and all faces with numbers from 0.
local function lists(objects)
    local vertices, faces = {}, {}
    for _, o in ipairs(objects) do
        local first = #vertices - 1
        table.move(o.vertices, 1, #o.vertices, #vertices + 1, vertices)
        for _, f in ipairs(o.faces) do
            local face = {}
            for i, v in ipairs(f) do
                face[i] = first + v
            end
            faces[#faces + 1] = face
        end
    end
    return vertices, shuffled(faces)
end

local function ply(format, pack)
    return function(objects, number)
        local vertices, faces = lists(objects)
        local parts = { string.format("ply\nformat %s 1.0\ncomment made\nelement vertex %d\nproperty double x\nproperty uchar red\n" ..
            "property double y\nproperty double z\nelement face %d\nproperty list uchar int vertex_indices\nproperty float a\n" ..
            "element edge 1\nproperty int k\nend_header\n", format, #vertices, #faces) }
        for _, p in ipairs(vertices) do
            parts[#parts + 1] = pack and string.pack(pack .. "dBdd", p[1], 7, p[2], p[3]) or
                table.concat({ number(p[1]), "7", number(p[2]), number(p[3]) }, " ") .. "\n"
        end
        for _, f in ipairs(faces) do
            local values = { #f, table.unpack(f) }
            values[#values + 1] = 0.5
            parts[#parts + 1] = pack and string.pack(pack .. "B" .. ("i4"):rep(#f) .. "f", table.unpack(values)) or
                table.concat(values, " ") .. "\n"
        end
        parts[#parts + 1] = pack and string.pack(pack .. "i4", 3) or "3\n"
        return table.concat(parts)
    end
end
writers["_text.ply"] = ply("ascii")
writers["_little.ply"] = ply("binary_little_endian", "<")
writers["_big.PLY"] = ply("binary_big_endian", ">")

local function vtk(binary, offsets)
    return function(objects, number)
        local vertices, faces = lists(objects)
        local parts = { string.format("# vtk DataFile Version 3.0\ntitle\n%s\nDATASET POLYDATA\nPOINTS %d double\n",
            binary and "BINARY" or "ASCII", #vertices) }
        for _, p in ipairs(vertices) do
            parts[#parts + 1] = binary and string.pack(">ddd", p[1], p[2], p[3]) or
                number(p[1]) .. " " .. number(p[2]) .. " " .. number(p[3]) .. "\n"
        end
        local corners = 0
        for _, f in ipairs(faces) do
            corners = corners + #f
        end
        if offsets then
            parts[#parts + 1] = string.format("\nPOLYGONS %d %d\nOFFSETS vtktypeint64\n", #faces + 1, corners)
            local at, connectivity = 0, {}
            parts[#parts + 1] = binary and string.pack(">i8", 0) or "0 "
            for _, f in ipairs(faces) do
                at = at + #f
                parts[#parts + 1] = binary and string.pack(">i8", at) or at .. " "
                for _, v in ipairs(f) do
                    connectivity[#connectivity + 1] = binary and string.pack(">i8", v) or v .. " "
                end
            end
            parts[#parts + 1] = "\nCONNECTIVITY vtktypeint64\n" .. table.concat(connectivity)
        else
            parts[#parts + 1] = string.format("\nPOLYGONS %d %d\n", #faces, corners + #faces)
            for _, f in ipairs(faces) do
                parts[#parts + 1] = binary and string.pack(">i4" .. ("i4"):rep(#f), #f, table.unpack(f)) or
                    #f .. " " .. table.concat(f, " ") .. "\n"
            end
        end
        return table.concat(parts) .. "\nCELL_DATA 1\nwhatever follows"
    end
end
writers["_text.vtk"] = vtk(false, false)
writers["_binary.vtk"] = vtk(true, false)
writers["_offsets.vtk"] = vtk(true, true)
writers["_words.vtk"] = vtk(false, true)

writers[".dat"] = function(objects, number)
    local lines = { "; a data file", "new", "config gravity" }
    for k, o in ipairs(objects) do
        local faces = {}
        for i, f in ipairs(o.faces) do
            local corners = {}
            for j, v in ipairs(f) do
                local p = o.vertices[v]
                corners[j] = table.concat({ number(p[1]), number(p[2]), number(p[3]) }, k % 2 == 0 and "," or " ")
            end
            faces[i] = "face " .. table.concat(corners, "  ")
        end
        lines[#lines + 1] = k % 2 == 0 and "block create group \"" .. o.group .. "\" poly " .. table.concat(faces, " ... ; more\n ") .. " r=2"
            or "POLY " .. table.concat(faces, " &\n") .. " group '" .. o.group .. "'"
    end
    return table.concat(lines, "\n")
end

local function compas(objects, number, wrap, before, between, after)
    local parts = {}
    for k, o in ipairs(objects) do
        local vertices, faces = {}, {}
        for i, p in ipairs(o.vertices) do
            vertices[i] = string.format('"%d": {"y": %s, "x": %s, "z": %s}', 3 * i, number(p[2]), number(p[1]), number(p[3]))
        end
        for i, f in ipairs(o.faces) do
            local words = {}
            for j, v in ipairs(f) do
                words[j] = k % 2 == 0 and 3 * v or '"' .. 3 * v .. '"'
            end
            faces[i] = string.format('"%d": [%s]', i, table.concat(words, ", "))
        end
        local list = { '"vertex": {' .. table.concat(shuffled(vertices), ", ") .. "}", '"face": {' .. table.concat(faces, ",\n") .. "}",
            '"facedata": {"0": {}}', '"attributes": {"name": "Mesh"}' }
        parts[k] = wrap(o, k, "{" .. table.concat(shuffled(list), ", ") .. "}")
    end
    return before .. table.concat(parts, between) .. after
end
writers["_assembly.json"] = function(objects, number)
    return compas(objects, number, function(o, k, mesh)
        return string.format('"%d": {"is_support": %s, "block": {"dtype": "compas_assembly.datastructures/Block", "value": %s}}', k,
            o.group == "support" and "true" or "false", mesh)
    end, '{"dtype": "x/Assembly", "value": {"graph": {"edge": {"0": {"1": {"vertex": {"0": {}}, "face": {"0": [9]}}}}, "node": {', ", ", "}}}}")
end
writers["_model.json"] = function(objects, number)
    return compas(objects, number, function(o, k, mesh)
        return string.format('"guid-%d": {"dtype": "y/Block", "data": {"transformation": null, "is_support": %s, "geometry": ' ..
            '{"dtype": "compas.datastructures/Mesh", "data": %s}}}', k, o.group == "support" and "true" or "false", mesh)
    end, '\xef\xbb\xbf{"data": {"elements": {', ", ", "}}}")
end

-- The blocks of a model as objects; every third one is of the group "support".
function files.objects_of(model)
    local list = {}
    for i, b in ipairs(model:blocks()) do
        local o = { name = "stone_" .. i, group = i % 3 == 0 and "support" or "rock", vertices = {}, faces = {} }
        for k, p in ipairs(b.vertices) do
            o.vertices[k] = { p[1], p[2], p[3] }
        end
        for k, f in ipairs(b.faces) do
            o.faces[k] = { table.unpack(f.vertices) }
        end
        list[i] = o
    end
    return list
end

-- Objects and faces in another order; where `turned`, faces are turned inside out, each with a chance or all of an object.
function files.disturbed(objects, turned)
    for _, o in ipairs(objects) do
        local all = math.random() < 0.3
        for k, f in ipairs(o.faces) do
            if turned and (all or math.random() < 0.3) then
                local back = {}
                for i = #f, 1, -1 do
                    back[#back + 1] = f[i]
                end
                o.faces[k] = back
            end
        end
        shuffled(o.faces)
    end
    return shuffled(objects)
end

-- Writes numbers by a format of string.format.
function files.digits(format)
    return function(x)
        return string.format(format, x)
    end
end

return files
