-- lists.lua - the pages that test_lists.py opens: slivers.html, blocks of which some are thin and some small, with cuts that were refused, in
-- three frames; sound.html, where nothing was refused. NAME.json has what the program says of each frame.
--
--     talus tests/viewer/lists.lua FOLDER
local talus = require "talus"

local folder = assert(arg[1], "the folder is missing")
local model = talus.model { gravity = { 0, 0, -9.81 } }
local MIDDLE = { 3, 2, 2 }

local function plane(joint, dip, direction, origin)
    model:generate("joint", { joint = joint, dip = dip, dip_direction = direction, origin = origin })
end

local function quoted(text)
    return '"' .. text:gsub('["\\]', "\\%0") .. '"'
end

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

local function from(a, b)
    return { b[1] - a[1], b[2] - a[2], b[3] - a[3] }
end

local function surface(block)
    local v, sum = block.vertices, 0
    for _, face in ipairs(block.faces) do
        local list = face.vertices
        for i = 2, #list - 1 do
            local c = cross(from(v[list[1]], v[list[i]]), from(v[list[1]], v[list[i + 1]]))
            sum = sum + math.sqrt(c[1] ^ 2 + c[2] ^ 2 + c[3] ^ 2) / 2
        end
    end
    return sum
end

local frames = {}
local function frame(name)
    model:write_html(folder .. "/" .. name, { title = "Slivers", contacts = false })
    local refused, blocks = {}, {}
    for i, cut in ipairs(talus.report(model).refused_cuts) do
        refused[i] = string.format('{"reason":%s,"block":%d,"normal":[%.17g,%.17g,%.17g],"point":[%.17g,%.17g,%.17g]}', quoted(cut.reason), cut.block,
            cut.normal[1], cut.normal[2], cut.normal[3], cut.point[1], cut.point[2], cut.point[3])
    end
    for i, block in ipairs(model:blocks()) do
        blocks[i] = string.format('{"id":%d,"bulk":%.17g}', block.id, block.volume / surface(block))
    end
    local report = talus.report(model)
    frames[#frames + 1] = string.format('{"refused":[%s],"blocks":[%s],"aspect":%.17g,"aspect_block":%d}', table.concat(refused, ","),
        table.concat(blocks, ","), report.worst_aspect, report.worst_aspect_block.id)
end
local function finish(name)
    local file = assert(io.open(folder .. "/" .. name .. ".json", "w"))
    file:write("[", table.concat(frames, ",\n"), "]\n")
    file:close()
    frames = {}
end

model:generate("box", { min = { 0, 0, 0 }, max = { 6, 4, 4 }, density = 2600 })
plane("bedding", 12, 90, MIDDLE)
frame "slivers"
model:generate("jointset", { joint = "A", dip = 80, dip_direction = 100, spacing = 1.1, number = 5, origin = MIDDLE })
model:generate("jointset", { joint = "B<i>", dip = 75, dip_direction = 190, spacing = 1.3, number = 3, origin = MIDDLE })
plane("bedding", 12, 90, { 3, 2, 2 + 1e-5 }) -- refused all along the first
plane("thin", 60, 45, { 0.04, 0.04, 0 }) -- corners only
frame "slivers"
model:blocks { id = talus.report(model).refused_cuts[1].block }:delete()
frame "slivers"
finish "slivers"

model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = 2600 })
plane("one", 50, 90, { 1, 1, 1 })
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 35 })
model:history { name = "work", value = "kinetic" }
model:history { name = "how <b>often</b>", value = function() return 7.5 end }
model:cycle(1)
frame "sound"
finish "sound"
