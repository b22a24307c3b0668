-- elements.lua - the page that test_elements.py opens, and what is in it by the program itself.
--
--     talus tests/viewer/elements.lua FOLDER
--
-- elements.html: a slab hung on bolts and a stay far from zero, with water in two joints and quiet faces below, two frames. elements.json: what
-- the elements are in the last one.
local talus = require "talus"
local folder = assert(arg[1], "the folder is missing")
local far = { 412345.25, -98765.5, 1234 }

local function at(x, y, z)
    return { far[1] + x, far[2] + y, far[3] + z }
end

local model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = at(0, 0, 0), max = at(6, 4, 4), density = 2500 })
model:generate("joint", { joint = "roof", dip = 0, dip_direction = 0, origin = at(0, 0, 1) })
model:generate("joint", { joint = "steep", dip = 70, dip_direction = 90, origin = at(3, 0, 2) })
model:generate("joint", { joint = "wide", dip = 90, dip_direction = 0, origin = at(0, 2, 2) })
model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
model:blocks { above = { dip = 0, dip_direction = 0, origin = at(0, 0, 1) } }:fix()
model:damping "local"
for x = 1, 5, 2 do
    model:element("bolt", { from = at(x, 1, 0), to = at(x, 1.1, 3), yield = x == 3 and 2e4 or 2.4e5, group = "bolts" })
end
model:element("spring", { from = at(1, 3, 0.5), to = at(1, 3, 3.5), stiffness = 1e6 })
model:water("table", { dip = 20, dip_direction = 60, origin = at(3, 2, 2.2), joints = "steep", unit_weight = 1e4 })
model:water("uniform", { pressure = 2e3, joints = "wide" })
model:boundary { side = "zmax", quiet = true, p_velocity = 4000, s_velocity = 2300, density = 2600 }
model:write_html(folder .. "/elements", { title = "Slab" })
model:cycle(400)
model:write_html(folder .. "/elements")

local function json(value)
    if type(value) == "table" then
        local parts = {}
        for i, one in ipairs(value) do
            parts[i] = json(one)
        end
        for key, one in pairs(value) do
            if type(key) == "string" then
                parts[#parts + 1] = string.format("%q: %s", key, json(one))
            end
        end
        return (#value > 0 and "[%s]" or "{%s}"):format(table.concat(parts, ", "))
    end
    return type(value) == "string" and string.format("%q", value) or string.format("%.17g", value)
end

local told, all = {}, model:elements {}
local area, axial = all:values "area", all:values "axial"
local function known(value)
    return value == value and value or nil
end
for i, element in ipairs(all) do
    local nodes = {}
    for k, node in ipairs(element.nodes) do
        nodes[k] = { place = node.position, weight = node.weight, tension = element.kind == "bolt" and node.tension or nil,
            pressure = element.kind == "water" and node.pressure or nil }
    end
    told[i] = { id = element.id, kind = element.kind, nodes = nodes, area = known(area[i]), axial = known(axial[i]),
        yielded = element.yielded and 1 or 0 }
end
local file = assert(io.open(folder .. "/elements.json", "w"))
file:write(json(told), "\n")
file:close()
