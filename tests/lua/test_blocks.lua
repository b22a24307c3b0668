-- Selections of blocks: filters, fields, sums, verbs, stale handles.
local talus = require "talus"
local check = require "check"

local model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2000, group = "rock" })
model:generate("joint", { joint = "J1", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
model:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 3 }, density = 1000, group = "cap" })

-- Filters.
local all = model:blocks()
check.equal(#all, 3)
check.equal(tostring(all), "selection of 3 blocks")
local count, last = 0, 0
for i, block in ipairs(all) do
    count = i
    check.holds(block.id > last, "ascending ids")
    last = block.id
end
check.equal(count, 3)
check.equal(all[4], nil)
check.equal(all[0], nil)
check.equal(#model:blocks { group = "rock" }, 2)
check.equal(#model:blocks { group = "nothing" }, 0)
check.equal(#model:blocks { joint = "J1" }, 2)
check.equal(#model:blocks { joint = "J1:1", group = "cap" }, 0)
local left = model:blocks { containing = { 0.5, 0.5, 0.5 } }
check.equal(#left, 1)
check.near(left[1].centroid, { 0.5, 0.5, 0.5 }, 1e-15)
check.equal(model:blocks { id = left[1].id }[1], left[1])
check.holds(left[1] ~= model:blocks { group = "cap" }[1], "different blocks differ")
check.equal(#model:blocks { inside = { min = { 0, 0, 0 }, max = { 2, 1, 1 } } }, 2)
local plane = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } }
check.equal(#model:blocks { above = plane }, 1)
check.equal(#model:blocks { below = plane }, 2)
check.equal(#model:blocks { where = function(b) return b.volume > 1.5 end }, 1)
check.equal(#all:where(function(b) return b.volume < 1.5 end), 2)
check.equal(#all, 3)

-- Fields.
local cap = model:blocks { group = "cap" }[1]
check.equal(tostring(cap), "block " .. cap.id)
check.equal(math.type(cap.id), "integer")
check.equal(cap.group, "cap")
check.near(cap.density, 1000, 0)
check.near(cap.volume, 2, 1e-14)
check.near(cap.mass, 2000, 1e-11)
check.near(cap.centroid, { 0.5, 0.5, 2 }, 1e-14)
check.near(cap.inertia.xx, 2000 * 5 / 12, 1e-9)
check.near(cap.inertia.zz, 2000 * 2 / 12, 1e-9)
check.near(cap.inertia.xy, 0, 1e-9)
check.near(cap.rotation, { 1, 0, 0, 0 }, 0)
for _, name in ipairs { "displacement", "velocity", "angular_velocity" } do
    check.near(cap[name], { 0, 0, 0 }, 0)
end
check.equal(#cap.force, 3)
check.equal(#cap.moment, 3)
check.equal(cap.fixed, false)
check.equal(cap.hidden, false)
check.equal(cap.body, cap.id)
check.equal(cap.speed, 0)
check.equal(cap.kinetic_energy, 0)

-- Shape: closed, with outward normals and the joint's name where a cut made the face.
check.equal(#cap.vertices, 8)
check.equal(#cap.faces, 6)
local joints = 0
for _, face in ipairs(left[1].faces) do
    check.equal(#face.vertices, 4)
    for _, index in ipairs(face.vertices) do
        check.holds(left[1].vertices[index], "a vertex of that number")
    end
    if face.joint then
        joints = joints + 1
        check.equal(face.joint, "J1:1")
        check.near(face.normal, { 1, 0, 0 }, 1e-15)
    end
end
check.equal(joints, 1)

-- Sums and extremes.
check.near(all:sum("volume"), 4, 1e-14)
check.near(all:sum("centroid"), { 0.5 + 1.5 + 0.5, 1.5, 3 }, 1e-14)
check.near(all:max("volume"), 2, 1e-14)
check.near(all:min("volume"), 1, 1e-14)
check.equal(all:sum("fixed"), 0)
check.near(all:bounds().min, { 0, 0, 0 }, 0)
check.near(all:bounds().max, { 2, 1, 3 }, 1e-15)
check.equal(model:blocks { group = "nothing" }:sum("volume"), 0)

-- Verbs: each gives the selection.
check.equal(left:set { density = 3000, group = "left" }, left)
check.near(left[1].mass, 3000, 1e-9)
check.equal(left[1].group, "left")
check.equal(left:fix(), left)
check.equal(left[1].fixed, true)
check.equal(#model:blocks { fixed = true }, 1)
check.equal(left:free()[1].fixed, false)
check.equal(left:fix { x = true, rotation = true }[1].fixed, false)
check.equal(left:fix {}[1].fixed, true)
left:free():set { velocity = { 1, 2, 2 }, angular_velocity = { 0, 0, 1 } }
check.near(left[1].velocity, { 1, 2, 2 }, 0)
check.near(left[1].speed, 3, 1e-15)
check.near(left[1].angular_velocity, { 0, 0, 1 }, 0)
check.near(left[1].kinetic_energy, 0.5 * 3000 * 9 + 0.5 * 3000 / 6, 1e-8)
left:set { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } }:reset_displacement()
check.equal(left:hide()[1].hidden, true)
check.equal(#model:blocks(), 2)
check.equal(#model:blocks { hidden = true }, 1)
check.equal(#model:blocks { hidden = false }, 2)
check.equal(#model:blocks { hidden = "any" }, 3)
left:show()
check.equal(#model:blocks(), 3)

-- Wrong filters, fields and verbs.
check.refused(model, function() model:blocks { grup = "rock" } end, "did you mean 'group'?")
check.refused(model, function() model:blocks { abov = plane } end, "did you mean 'above'?")
check.refused(model, function() model:blocks { group = 3 } end, "group must be a string")
check.refused(model, function() model:blocks { id = 0 } end, "id = 0 is outside [1, 4294967295]")
check.refused(model, function() model:blocks { id = 1.5 } end, "whole number")
check.refused(model, function() model:blocks { containing = { 1, 2 } } end, "a list of 2 numbers")
check.refused(model, function() model:blocks { inside = { min = { 0, 0, 0 } } } end, "'max' is missing")
check.refused(model, function()
    model:blocks { inside = { min = { 0, 0, 1 }, max = { 1, 1, 0 } } }
end, "min must be at most that of max")
check.refused(model, function() model:blocks { above = { dip = 95 } } end, "dip = 95 deg is outside [0, 90]")
check.refused(model, function() model:blocks { hidden = "all" } end, "true, false or \"any\"")
check.refused(model, function() model:blocks { where = 3 } end, "where must be a function")
check.refused(model, function() model:blocks { joint = "J2" } end, "unknown joint 'J2'")
check.refused(model, function() model:blocks { where = function(b) return b.volum end } end,
    "a block has no field 'volum'; did you mean 'volume'?")
check.refused(model, function() return cap.volum end, "did you mean 'volume'?")
check.refused(model, function() return cap[1] end, "no field the number 1")
check.refused(model, function() cap.density = 3 end, "selection")
check.refused(model, function() all:sum("volum") end, "did you mean 'volume'?")
check.refused(model, function() all:sum("group") end, "is not a number")
check.refused(model, function() all:sum() end, "the field's name must be a string")
check.refused(model, function() all:max("centroid") end, "is a vector")
check.refused(model, function() model:blocks { group = "nothing" }:max("volume") end, "the selection is empty")
check.refused(model, function() model:blocks { group = "nothing" }:bounds() end, "the selection is empty")
check.refused(model, function() all:hid() end, "did you mean 'hide'?")
check.refused(model, function() all.hide() end, "write selection:hide(...)")
check.refused(model, function() all:hide(true) end, "1 argument too many")
check.refused(model, function() all[1] = 3 end, "cannot be assigned to")
check.refused(model, function() all:fix { z = 1 } end, "z must be true or false")
check.refused(model, function() all:fix { w = true } end, "unknown parameter 'w'")
check.refused(model, function() all:fix { x = false } end, "nothing is to be held")
check.refused(model, function() all:set { density = 0 } end, "density = 0 kg/m3 must be > 0")
check.refused(model, function() all:set { density = 0 / 0 } end, "density = nan")
check.refused(model, function() all:set { velocity = { 0, 0, 1 / 0 } } end, "velocity.z = inf")
check.refused(model, function() all:set {} end, "give density, group")

-- What was deleted or cut is gone, and says so; a call with one stale block does nothing at all.
local cut, id = left[1], left[1].id
model:generate("joint", { joint = "J3", dip = 0, dip_direction = 0, origin = { 0, 0, 0.5 } })
local stale = { [true] = 0, [false] = 0 }
for _, block in ipairs(all) do
    local alive = pcall(function() return block.volume end)
    stale[alive] = stale[alive] + 1
end
check.holds(stale[false] >= 1, "a cut block loses its id")
check.near(model:blocks():sum("volume"), 4, 1e-14)
local lower = model:blocks()
check.equal(lower:delete(), lower)
check.equal(#model:blocks { hidden = "any" }, 0)
check.refused(model, function() return cut.volume end, "no longer exists: it was cut or deleted")
check.refused(model, function() return cut.vertices end, "no longer exists")
check.refused(model, function() return cut.neighbours end, "no longer exists")
check.refused(model, function() lower:sum("volume") end, "no longer exists")
check.refused(model, function() lower:bounds() end, "no longer exists")
check.refused(model, function() lower:hide() end, "no longer exists")
check.refused(model, function() lower:delete() end, "no longer exists")
check.equal(#model:blocks { id = id }, 0)

-- Blocks that cannot be computed with are refused, whole, by whatever way they come.
model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
for _, case in ipairs {
    { 1e100, 2000, "farther from zero than 1e+50 m" }, { 1e300, 2000, "farther from zero than 1e+50 m" },
    { 1, 1e308, "the mass 8e+308 kg" }, { 1, 1e-300, "the mass 8e-300 kg" }, { 1e50, 1e120, "the mass 8e+270 kg" },
    { 1e-100, 2000, "the volume 8e-300 m3" }, { 1e-60, 2000, "the moment of inertia" },
    { 1e49, 1e50, "the moment of inertia" } } do
    local size, density, part = table.unpack(case)
    if part == "the mass 8e+308 kg" then part = "the mass inf kg" end
    local p, q = { -size, -size, -size }, { size, size, size }
    check.refused(model, function() model:generate("box", { min = p, max = q, density = density }) end, part)
    check.refused(model, function()
        model:generate("polyhedron", { vertices = { p, { size, -size, -size }, { -size, size, -size }, q }, density = density })
    end, size == 1 and "kg, outside [1e-250, 1e+250]" or size > 1e50 and part or "") -- hulls have bounds of their own
end
for _, density in ipairs { 1e308, 1e300, 1e-300 } do
    check.refused(model, function() model:blocks():set { density = density } end, "kg, outside [1e-250, 1e+250]")
end
for _, far in ipairs { 1e300, -1e300, 1e60 } do
    check.refused(model, function()
        model:generate("joint", { joint = "F", dip = 30, dip_direction = 90, origin = { far, 0, far } })
    end, "farther from zero than 1e+50 m")
    check.refused(model, function()
        model:generate("jointset", { joint = "F", dip = 30, dip_direction = 90, spacing = 1, number = 3, origin = { far, 0, 0 } })
    end, "farther from zero than 1e+50 m")
end
local large = talus.model {} -- as large as may be
large:generate("box", { min = { -1e40, -1e40, -1e40 }, max = { 1e40, 1e40, 1e40 }, density = 1e20 })
check.near(large:blocks()[1].mass, 8e140, 1e130)
