-- Selections of contacts: filters, fields, sums.
local talus = require "talus"
local check = require "check"

local model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 2 }, density = 2000 })
model:generate("joint", { joint = "floor", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
model:generate("joint", { joint = "wall", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
local low = model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }
local high = model:blocks { above = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }
check.equal(#low, 2)
check.equal(#high, 2)
low:fix()
model:joint("floor", "elastic", { kn = 1e8, ks = 1e8 })
model:joint("wall", "coulomb", { kn = 1e8, ks = 1e8, friction = 10 })
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8 })
model:damping("local")
model:solve { ratio = 1e-6 }

local floor = model:contacts { joint = "floor", between = { low, high } }
check.holds(#floor >= 2, "each upper block stands on something")
check.near(floor:sum("normal_force"), 40000, 10)
check.near(model:contacts { joint = "floor" }:sum("normal_force"), 40000, 10)
check.equal(#model:contacts { between = { high, low } }, #model:contacts { between = { low, high } })
check.equal(#model:contacts { between = { low, model:blocks { group = "none" } } }, 0)
check.holds(#model:contacts { between = { high[1], low } } >= 1, "a single block serves too")

local contact = model:contacts { joint = "floor", where = function(c) return c.area > 0.5 end }[1]
check.equal(tostring(contact), "contact " .. contact.id)
check.equal(contact.joint, "floor:1")
check.near(contact.area, 1, 1e-3)
check.near(math.abs(contact.normal[3]), 1, 1e-6)
check.near(contact.point[3], 1, 1e-3)
check.near(contact.normal_stress, contact.normal_force / contact.area, 1e-6 * contact.normal_stress)
check.equal(#contact.shear_force, 3)
check.holds(contact.shear_stress >= 0, "a size")
check.equal(contact.state, "elastic")
check.holds(contact.gap < 0, "pressed together")
local pair = contact.blocks
check.equal(#pair, 2)
check.holds(pair[1].id < pair[2].id, "ordered by id")
check.near(pair[1].volume, 1, 1e-12)

-- Neighbours are blocks.
local found = false
for _, neighbour in ipairs(pair[1].neighbours) do
    found = found or neighbour == pair[2]
end
check.holds(found, "the blocks of a contact are neighbours")

check.holds(floor:max("normal_force") >= floor:min("normal_force"), "extremes in order")
check.equal(#floor:sum("shear_force"), 3)
check.equal(#floor:where(function(c) return c.state == "open" end), 0)

check.refused(model, function() model:contacts { jont = "floor" } end, "did you mean 'joint'?")
check.refused(model, function() model:contacts { joint = "flor" } end, "flor")
check.refused(model, function() model:contacts { between = { low } } end, "not a list of 1")
check.refused(model, function() model:contacts { between = { low, 3 } } end, "item 2 must be a selection")
check.refused(model, function()
    model:contacts { between = { low, talus.model {}:blocks() } }
end, "item 2 belongs to another model")
check.refused(model, function() return contact.froce end, "a contact has no field 'froce'")
check.refused(model, function() contact.area = 3 end, "can only be read")
check.refused(model, function() floor:sum("state") end, "is not a number")
check.refused(model, function() floor:hide() end, "a selection of contacts has no method 'hide'")

-- A contact that is gone says so.
high:delete()
model:cycle(1)
check.raises(function() return contact.area end, "contact")

-- A contact that begins later lies where its blocks are in the order, whatever its id.
local row = talus.model {}
for _, x in ipairs { 0, 1.01, 2.01 } do
    row:generate("box", { min = { x, 0, 0 }, max = { x + 1, 1, 1 }, density = 2000 })
end
row:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
row:blocks { id = 2 }:fix()
row:blocks { id = 3 }:fix()
check.equal(#row:contacts(), 1)
local first = row:contacts()[1]
row:blocks { id = 1 }:drive { velocity = { 1, 0, 0 } }
while #row:contacts() < 2 do
    row:cycle(10)
end
local order = {}
for _, each in ipairs(row:contacts()) do
    order[#order + 1] = each.blocks[1].id .. "-" .. each.blocks[2].id
end
check.equal(table.concat(order, " "), "1-2 2-3")
check.holds(row:contacts()[2] == first, "what was there stays the same contact")
