-- The generator "import" gives the blocks of random models back out of every format that it reads: with objects and faces in any
-- order, faces turned, other units, and vertices off by up to `weld`; a vault rounded to a millimetre comes in and meets flush.
local talus = require "talus"
local check = require "check"

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

-- ---------------------------------------------------------------- writers

-- An object: name, group, vertices and faces, counted from 1. Every writer takes a list of them, and how numbers are written.
local function shuffled(list)
    for i = #list, 2, -1 do
        local k = math.random(i)
        list[i], list[k] = list[k], list[i]
    end
    return list
end

local writers = {}

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

local function fans(o)
    local list = {}
    for _, f in ipairs(o.faces) do
        for i = 2, #f - 1 do
            list[#list + 1] = { o.vertices[f[1]], o.vertices[f[i]], o.vertices[f[i + 1]] }
        end
    end
    return list
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

-- The blocks as objects.
local function objects_of(model)
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

-- Objects and faces in another order, faces turned, each with a chance.
local function disturbed(objects, turned)
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

local function place(b) return string.format("%.4f %.4f %.4f", b.centroid[1] + 10, b.centroid[2] + 10, b.centroid[3] + 10) end

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

local function digits(format) return function(x) return string.format(format, x) end end

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

print "formats: all models came back"
