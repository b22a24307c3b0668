-- pages.lua - the pages that test_viewer.py opens, and what is in them by the program itself.
--
--     talus tests/viewer/pages.lua FOLDER
--
-- slope.html: the wedge of examples/slope.lua sliding, four frames; slope.json the last frame's blocks, slope_section a section of it.
-- names.html: two blocks whose names are HTML.
package.path = "scripts/?.lua;" .. package.path
local talus = require "talus"
local slope = require "examples.slope"

local folder = assert(arg[1], "the folder is missing")
local SECTION = { dip = 70, dip_direction = 200, origin = { 30, 20, 14 } }

local model = slope.build(20)
model:timestep { rule = "body", fraction = 0.3 }
for frame = 0, 3 do
    while model.time < 0.25 * frame do
        model:cycle(50)
    end
    model:write_html(folder .. "/slope", { title = "Slope with a wedge", block_fields = { "kinetic_energy" }, keyblocks = { friction = 20 } })
end
model:write_section(folder .. "/slope", SECTION)

-- The blocks as lines of JSON: id, how they are keyblocks, and planes n x <= d of the faces.
local out, keys = {}, {}
for _, key in ipairs(model:keyblocks { friction = 20 }) do
    keys[key.block.id] = key.mode
end
for _, block in ipairs(model:blocks()) do
    local planes, vertices = {}, block.vertices
    for _, face in ipairs(block.faces) do
        local n, p = face.normal, vertices[face.vertices[1]]
        planes[#planes + 1] = string.format("[%.17g,%.17g,%.17g,%.17g]", n[1], n[2], n[3], n[1] * p[1] + n[2] * p[2] + n[3] * p[3])
    end
    local d = block.displacement
    out[#out + 1] = string.format('{"id":%d,"volume":%.17g,"displacement":%.17g,"key":"%s","planes":[%s]}', block.id, block.volume,
        math.sqrt(d[1] ^ 2 + d[2] ^ 2 + d[3] ^ 2), keys[block.id] or "", table.concat(planes, ","))
end
local file = assert(io.open(folder .. "/slope.json", "w"))
file:write("[", table.concat(out, ",\n"), "]\n")
file:close()

-- A column that has but closed its joints, and a block that stood until its joint was made weaker: with the verdicts of the program.
local function told(name, one, options)
    one:write_html(folder .. "/" .. name, options)
    local to = assert(io.open(folder .. "/" .. name .. ".txt", "w"))
    to:write(one:verdict().text)
    to:close()
end
local column = talus.model {}
for i = 0, 9 do
    column:generate("box", { min = { 0, 0, i }, max = { 1, 1, i + 1 }, density = 2500 })
end
column:blocks { id = 1 }:fix()
column:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 40 })
column:damping "local"
column:solve { ratio = 1e-5 }
told("column", column)
local slide = talus.model { gravity = { 5, 0, -8 } }
slide:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = 2500 })
slide:generate("box", { min = { -1, -1, 0 }, max = { 1, 1, 1 }, density = 2500 })
slide:blocks { id = 1 }:fix()
slide:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 40 })
slide:damping "local"
slide:solve { ratio = 1e-5 }
told("stands", slide)
slide:stage "weaker"
slide:joint("*", { friction = 25 })
slide:solve { ratio = 1e-5, stop_at_failure = true }
told("slide", slide, { keyblocks = { friction = 25 }, safety_limit = 1.3 })

local HOSTILE = "</script><img src=x onerror=alert(1)>"
local names = talus.model { gravity = { 0, 0, -10 } }
names:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = 2000, group = HOSTILE })
names:generate("joint", { joint = "J<b>1</b>", dip = 30, dip_direction = 90, origin = { 1, 1, 1 } })
names:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 40 })
names:write_html(folder .. "/names", { title = HOSTILE, block_fields = { number = function(block) return block.id end } })
