-- zones.lua - the page that test_zones.py opens, and what is in it by the program itself.
--
--     talus tests/viewer/zones.lua FOLDER
--
-- zones.html: a footing that is pressed into soil of zones, three frames; zones.json and points.json: zones and gridpoints of the last one.
local talus = require "talus"
local folder = assert(arg[1], "the folder is missing")

local model = talus.model { gravity = { 0, 0, -9.81 } }
model:generate("box", { min = { -4, -1, -1 }, max = { 4, 2, 0 }, density = 2500 })
model:generate("box", { min = { -3, 0, 0 }, max = { 3, 1, 2.5 }, density = 2000 })
model:generate("box", { min = { -0.75, 0, 2.5 }, max = { 0.75, 1, 3.2 }, density = 2500 })
model:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 30 })
model:blocks { id = 1 }:fix()
model:solid("soil", "mohr_coulomb", { young = 1e8, poisson = 0.3, cohesion = 5e4, friction = 20, tension = 1e4 })
model:blocks { id = 2 }:deformable { zone = 0.5, solid = "soil" }
model:damping "local"
model:write_html(folder .. "/zones", { title = "Footing" })
model:cycle(1000)
model:write_html(folder .. "/zones")
model:blocks { id = 3 }:load { force = { 0, 0, -4e5 } }
model:cycle(2500)
model:write_html(folder .. "/zones")

local function numbers(list)
    local parts = {}
    for i, value in ipairs(list) do
        parts[i] = string.format("%.17g", value)
    end
    return "[" .. table.concat(parts, ",") .. "]"
end

local zones, points = {}, {}
for i, z in ipairs(model:zones {}) do
    local s = z.stress
    zones[i] = string.format('{"stress":%s,"principal":%s,"mean":%.17g,"deviator":%.17g,"state":"%s","plastic_shear":%.17g,"volume":%.17g}',
        numbers { s.xx, s.yy, s.zz, s.xy, s.yz, s.zx }, numbers(z.principal), z.mean, z.deviator, z.state, z.plastic_shear, z.volume)
end
for i, p in ipairs(model:gridpoints {}) do
    points[i] = string.format('{"position":%s,"displacement":%s}', numbers(p.position), numbers(p.displacement))
end
for name, list in pairs { zones = zones, points = points } do
    local file = assert(io.open(folder .. "/" .. name .. ".json", "w"))
    file:write("[", table.concat(list, ",\n"), "]\n")
    file:close()
end
