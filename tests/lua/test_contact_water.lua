-- What contacts tell of the water between their faces: pressure, aperture and flow of the wet joint.
local talus = require "talus"
local check = require "check"

local GW = 1e4 -- N/m3

-- Two layers of three blocks on a held floor.
local function rock()
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, -2 }, max = { 6, 1, 0 }, density = 2500, group = "floor" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 6, 1, 4 }, density = 2500 })
    model:generate("joint", { joint = "H", dip = 0, dip_direction = 0, origin = { 0, 0, 2 } })
    for x = 2, 4, 2 do
        model:generate("joint", { joint = "V", dip = 90, dip_direction = 90, origin = { x, 0, 0 } })
    end
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 60 })
    model:damping "local"
    model:cycle(1)
    return model
end

local function edge(x)
    return { min = { x - 0.01, -1, -0.01 }, max = { x + 0.01, 2, 0.01 } }
end

-- Without water there is nothing to tell.
local none = rock()
check.equal(none:contacts()[1].pressure, nil)
check.equal(none:contacts()[1].aperture, nil)
check.holds(none:contacts():values "flow"[1] ~= none:contacts():values "flow"[1])

-- Of flow: what the joint between the same two blocks has.
local model = rock()
model:water("flow", { joints = { "H", "V" }, aperture = 2e-4, unit_weight = GW, every = 10,
    heads = { { inside = { min = { -0.01, -1, 1.99 }, max = { 0.01, 2, 2.01 } }, head = 9 },
        { inside = { min = { 5.99, -1, 1.99 }, max = { 6.01, 2, 2.01 } }, head = 5 } } })
model:cycle(50)
local by = {}
for _, joint in ipairs(model:flow().joints) do
    local sum, weight, a, b = 0, 0, math.huge, 0
    for _, node in ipairs(joint.nodes) do
        sum, weight = sum + node.weight * node.pressure, weight + node.weight
        a, b = math.min(a, node.block.id), math.max(b, node.block.id)
    end
    by[a .. ":" .. b] = { sum / weight, joint.aperture, joint.flow }
end
local wet, dry = 0, 0
local contacts = model:contacts()
local lists = { contacts:values "pressure", contacts:values "aperture", contacts:values "flow" }
for i, contact in ipairs(contacts) do
    local joint = by[contact.blocks[1].id .. ":" .. contact.blocks[2].id]
    wet, dry = wet + (joint and 1 or 0), dry + (joint and 0 or 1)
    for k, name in ipairs { "pressure", "aperture", "flow" } do
        local value, listed = contact[name], lists[k][i]
        if joint then
            check.near(value, joint[k], 1e-12 * math.abs(joint[k]))
            check.equal(listed, value)
        else
            check.equal(value, nil)
            check.holds(listed ~= listed, "NaN")
        end
    end
end
check.equal(wet, 9) -- 3 level ones, and 2 of each layer and of the floor
check.equal(dry, 3) -- on the floor
check.holds(contacts:max "pressure" > 0 and contacts:max "flow" > 0 and contacts:min "aperture" > 1e-4)
check.near(contacts:where(function(c) return c.joint:sub(1, 1) == "H" end):max "flow",
    math.abs(model:flow().heads[1].flow), 0.01 * math.abs(model:flow().heads[1].flow))

-- Under a table: nothing above it, and no aperture or flow.
local still = rock()
still:water("table", { level = 1.5, unit_weight = GW })
still:cycle(1)
for _, contact in ipairs(still:contacts()) do
    check.equal(contact.aperture, nil)
    check.equal(contact.flow, nil)
    local z = contact.point[3] -- upright joints are 2 m high, and wet up to the table
    local mean = math.abs(contact.normal[3]) > 0.5 and 1.5 - z or z > 0 and 0.75 or 1.5 - z
    if z > 1.9 then
        check.equal(contact.pressure, nil)
    else
        check.near(contact.pressure, GW * mean, 1e-3 * GW * mean)
    end
end

-- A joint that has run dry tells nothing.
local gone = talus.model { gravity = { 0, 0, -10 } }
gone:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2500, group = "floor" })
gone:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "top" })
gone:blocks { group = "floor" }:fix()
gone:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 60 })
gone:water("uniform", { pressure = 1e4, drain_gap = 0.01 })
gone:cycle(1)
check.near(gone:contacts()[1].pressure, 1e4, 1e-9)
gone:blocks { group = "top" }:set { velocity = { 0, 0, 0.7 } }
gone:cycle(10)
while #gone:contacts() == 0 do
    gone:cycle(10)
end
check.equal(#gone:contacts(), 1) -- it has been 0.02 m above the floor, and is back
check.equal(gone:contacts()[1].pressure, nil)

-- Files have it where it is asked for.
local prefix = os.tmpname()
os.remove(prefix)
model:write_vtk(prefix, { contact_fields = { "pressure", "flow" } })
for _, kind in ipairs { "contacts", "joints" } do
    local file = assert(io.open(prefix .. "_" .. kind .. "_000000.vtk", "rb"))
    local text = file:read "a"
    file:close()
    check.holds(text:find "\npressure 1 %d+ double" and text:find "\nflow 1 %d+ double", kind)
end
for _, kind in ipairs { "elements", "blocks", "contacts", "joints" } do
    os.remove(prefix .. "_" .. kind .. "_000000.vtk")
    os.remove(prefix .. "_" .. kind .. ".vtk.series")
end

-- A contact that is no more, and a name that nothing has.
local lost = model:contacts()[1]
check.raises(function() return lost.presure end, "pressure")
model:blocks { id = lost.blocks[1].id }:delete()
check.raises(function() return lost.pressure end, "no longer exists")
