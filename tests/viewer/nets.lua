-- nets.lua - the pages that test_stereonet.py opens, and what the program says of their joint pyramids.
--
--     talus tests/viewer/nets.lua FOLDER
--
-- plane.html: block 3 lies on a plane dipping 30 degrees to the east; wedge.html: a wedge on two planes; inside.html: 27 cubes;
-- rock.html: blocks of three sets, cut and at rest; tower.html: two cubes on each other, at rest on a wide base; slope.html: the wedge of examples/slope.lua, before it slides. NAME.json: bodies that can move, with
-- the edges of their pyramids, and those that cannot.
package.path = "scripts/?.lua;" .. package.path
local talus = require "talus"
local slope = require "examples.slope"

local folder = assert(arg[1], "the folder is missing")

local function write(model, name)
    model:write_html(folder .. "/" .. name, { title = name, contacts = false })
    local free, out = {}, {}
    for _, key in ipairs(model:keyblocks { friction = 30 }) do
        local edges = {}
        for i, d in ipairs(key.pyramid) do
            edges[i] = string.format("[%.17g,%.17g,%.17g]", d[1], d[2], d[3])
        end
        free[key.block.id] = table.concat(edges, ",")
    end
    for _, block in ipairs(model:blocks()) do
        if not block.fixed and block.body == block.id then
            out[#out + 1] = string.format('{"id":%d,"edges":%s}', block.id, free[block.id] and "[" .. free[block.id] .. "]" or "null")
        end
    end
    local file = assert(io.open(folder .. "/" .. name .. ".json", "w"))
    file:write("[", table.concat(out, ",\n"), "]\n")
    file:close()
end

local function box(group, min, max, model)
    model = model or talus.model {}
    model:generate("box", { min = min, max = max, density = 2600, group = group })
    return model
end

local function cut(model, joint, dip, direction, origin)
    model:generate("joint", { joint = joint, dip = dip, dip_direction = direction, origin = origin })
end

local plane = box("rock", { 0, 0, 0 }, { 4, 4, 4 })
cut(plane, "bed", 30, 90, { 2, 2, 2 })
plane:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
write(plane, "plane")

local wedge = box("rock", { 0, 0, 0 }, { 4, 4, 4 })
cut(wedge, "left", 50, 60, { 2, 2, 1.5 })
cut(wedge, "right", 60, 140, { 2, 2, 1.5 })
wedge:joint("left", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
wedge:joint("right", "coulomb", { kn = 1e9, ks = 1e9, friction = 20 })
write(wedge, "wedge")

local inside = talus.model {}
for i = 0, 26 do
    local x, y, z = i % 3, i // 3 % 3, i // 9
    box("cubes", { x, y, z }, { x + 1, y + 1, z + 1 }, inside)
end
write(inside, "inside")

local rock = box("rock", { 0, 0, 0 }, { 6, 5, 4 })
for i, set in ipairs { { 35, 70 }, { 70, 160 }, { 65, 290 } } do
    rock:generate("jointset", { joint = "J" .. i, dip = set[1], dip_direction = set[2], spacing = 1.3, number = 4, dip_dev = 6, dip_direction_dev = 6,
        origin = { 3, 2.5, 2 } })
end
rock:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 0.3 } } }:fix()
write(rock, "rock")

write(slope.build(20), "slope")

local tower = box("base", { -30, -30, -5 }, { 30, 30, 0 })
tower:blocks():fix()
box("tower", { 0, 0, 0 }, { 1, 1, 1 }, tower)
box("tower", { 0.35, 0.3, 1 }, { 1.35, 1.3, 2 }, tower)
tower:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
tower:damping "local"
tower:solve { ratio = 1e-5, max_cycles = 50000 }
write(tower, "tower")
