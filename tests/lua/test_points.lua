-- Contact points, states of laws, and fields of many at once.
local talus = require "talus"
local check = require "check"

-- A block pressed on a slab that slides off: a patch whose points slip.
local function sliding()
    local model = talus.model { gravity = { 5, 0, -10 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 4, 2, 2 }, density = 2000 })
    model:generate("joint", { joint = "floor", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
    local low = model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }
    low:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 10, dilation = 2 })
    model:damping("local")
    model:cycle(200)
    return model
end

local model = sliding()
local contact = model:contacts {}[1]
check.equal(contact.law, "coulomb")
local points = contact.points
check.holds(#points >= 4, "a patch has several points")
local area, normal, shear, opening = 0, 0, 0, 0
for _, p in ipairs(points) do
    area, normal, shear = area + p.area, normal + p.normal_force, shear + p.shear_force[1]
    opening = opening + p.area * p.opening
    check.near(p.gap, -p.closure, 1e-12)
    check.near(p.position[3], 1, 1e-3)
    check.equal(#p.position, 3)
end
check.near(area, contact.area, 1e-9)
check.near(normal, contact.normal_force, 1e-6 * contact.normal_force)
check.near(shear, contact.shear_force[1], 1e-6 * math.abs(shear))
check.holds(opening > 0, "slip has opened the joint")
check.near(contact.states.opening, opening / area, 1e-12)
check.equal(contact.state, "slipping")
local slipping = 0
for _, p in ipairs(points) do
    slipping = slipping + (p.state == "slipping" and 1 or 0)
end
check.holds(slipping > 0, "some point slips")

-- The slip that the law has opened the joint by: tan(dilation) times the way.
local way = model:blocks {}[2].displacement[1]
check.near(contact.states.opening, math.tan(math.rad(2)) * way, 0.05 * contact.states.opening)

-- Names that are not there.
check.refused(model, function() return points[1].openin end, "did you mean 'opening'?")
check.refused(model, function() return points[1][1] end, "a contact point has no field the number 1")
check.refused(model, function() return contact.states.slip end, "(known: opening)")
check.refused(model, function() points[1].width = 2 end, "can only be read")
check.refused(model, function() return contact.pionts end, "did you mean 'points'?")

-- Tilted: one point, which carries it all.
do
    local m = talus.model {}
    m:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = 2000 })
    m:generate("tetrahedron", { vertices = { { 0, 0, -1e-3 }, { 1, 0, 1 }, { -1, 1, 1 }, { -1, -1, 1 } }, density = 2000 })
    m:blocks {}:fix()
    m:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
    m:cycle(1)
    local tip = m:contacts {}[1]
    check.equal(#tip.points, 1)
    check.holds(tip.normal_force > 0, "pressed in")
    check.near(tip.points[1].normal_force, tip.normal_force, 0)
    check.near(tip.points[1].position, tip.point, 1e-12)
    check.raises(function() return tip.states.slip end, "the law of this contact has no state 'slip': it has none")
    check.equal(next(tip.states), nil)
end

-- Bulk reads are the same as one by one.
local blocks, contacts = model:blocks {}, model:contacts {}
for _, field in ipairs { "displacement", "centroid", "rotation", "velocity" } do
    local values, flat = blocks:values(field), blocks:values(field, "flat")
    check.equal(#values, #blocks)
    local width = #values[1]
    for i, block in ipairs(blocks) do
        check.near(values[i], block[field], 0)
        for k = 1, width do
            check.equal(flat[width * (i - 1) + k], block[field][k])
        end
    end
    check.equal(#flat, width * #blocks)
end
for _, field in ipairs { "id", "volume", "group", "fixed", "body", "speed" } do
    local values, flat = blocks:values(field), blocks:values(field, true)
    for i, block in ipairs(blocks) do
        check.equal(values[i], block[field])
        check.equal(flat[i], block[field])
        check.equal(math.type(values[i]), math.type(block[field]))
    end
end
check.near(blocks:values("inertia")[1].zz, blocks[1].inertia.zz, 0)
check.near(blocks:values("inertia", "flat")[3], blocks[1].inertia.zz, 0)
check.equal(blocks:values("displacement", "nested")[2][1], blocks[2].displacement[1])
check.equal(contacts:values("state")[1], contact.state)
check.equal(contacts:values("blocks")[1][2], contact.blocks[2].id)
check.equal(contacts:values("blocks", "flat")[1], contact.blocks[1].id)
check.near(contacts:values("opening")[1], contact.states.opening, 0)
check.near(contacts:max("opening"), contact.states.opening, 0)
check.near(contacts:values("normal_force")[1], contact.normal_force, 0)
check.equal(#model:blocks { group = "none" }:values("displacement"), 0)
check.equal(#model:blocks { group = "none" }:values("displacement", "flat"), 0)

check.refused(model, function() blocks:values("displacment") end, "did you mean 'displacement'?")
check.refused(model, function() blocks:values("opening") end, "a block has no field 'opening'")
check.refused(model, function() blocks:values("neighbours") end,
    "values: 'neighbours' of a block is a list and has no column of numbers; ask each block for it: selection[1].neighbours")
check.refused(model, function() blocks:sum("vertices") end, "sum: 'vertices' of a block is a list")
check.refused(model, function() contacts:values("states") end, "'states' of a contact is a table")
check.refused(model, function() contacts:values("openin") end, "did you mean 'opening'?")
check.refused(model, function() blocks:values("mass", "long") end, "\"flat\" or \"nested\"")
check.refused(model, function() blocks:values("mass", "flat", 3) end, "1 argument too many")
check.refused(model, function() blocks:values() end, "the field's name must be a string")

-- A contact whose law has no such state: NaN.
do
    local m = talus.model {}
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 3 }, density = 2000 })
    m:generate("joint", { joint = "a", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
    m:generate("joint", { joint = "b", dip = 0, dip_direction = 0, origin = { 0, 0, 2 } })
    m:joint("a", "elastic", { kn = 1e9, ks = 1e9 })
    m:joint("b", "coulomb_tensile", { kn = 1e9, ks = 1e9, tension = 1e6 })
    local bond = {}
    for i, value in ipairs(m:contacts {}:values("bond")) do
        bond[m:contacts {}[i].joint] = value
    end
    check.equal(bond["b:1"], 1)
    check.equal(m:contacts {}:sum("bond"), 1)
    check.equal(m:contacts {}:min("bond"), 1)
    check.equal(m:contacts {}:max("opening"), 0)
    check.refused(m, function() m:contacts { joint = "a" }:max("bond") end, "no contact of the selection has a law with the state 'bond'")
    check.refused(m, function() m:contacts {}:sum("bnod") end, "a contact has no field of numbers")
    check.refused(m, function() m:contacts {}:sum("bond", 2) end, "1 argument too many")
    check.equal(m:contacts { joint = "a" }:sum("bond"), 0)
    check.holds(bond["a:1"] ~= bond["a:1"], "NaN where the law has no bond")
end

-- A block that is gone.
local stale = model:blocks {}
model:blocks { fixed = false }:delete()
check.raises(function() stale:values("mass") end, "no longer exists")
