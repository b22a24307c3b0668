-- generate: summaries, and every kind of wrong input, which leaves the model as it was.
local talus = require "talus"
local check = require "check"

local model = talus.model { gravity = { 0, 0, -10 } }
local summary = model:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 3 }, density = 2000,
    group = "rock" })
check.equal(summary.before, 0)
check.equal(summary.after, 1)
check.equal(summary.cuts, 0)
check.near(summary.smallest_volume, 48, 1e-12)
check.near(summary.smallest_edge, 3, 1e-12)
check.near(summary.smallest_face, 12, 1e-12)
check.near(summary.volume_error, 0, 1e-14)

summary = model:generate("joint", { joint = "fault", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
check.equal(summary.before, 1)
check.equal(summary.after, 2)
check.equal(summary.cuts, 1)
check.near(model:blocks():sum("volume"), 48, 1e-12)

summary = model:generate("polyhedron", { density = 2400, group = "footing",
    vertices = { { 0, 0, 3 }, { 1, 0, 3 }, { 0, 1, 3 }, { 0, 0, 4 } } })
check.equal(summary.after, 3)
check.near(model:blocks { group = "footing" }:sum("volume"), 1 / 6, 1e-14)

-- Hidden blocks are not cut.
model:blocks { group = "footing" }:hide()
summary = model:generate("joint", { joint = "bed", dip = 0, dip_direction = 0, origin = { 0, 0, 3.5 } })
check.equal(summary.cuts, 0)
model:blocks { hidden = true }:show()

local function box(values)
    local all = { min = { 8, 8, 8 }, max = { 9, 9, 9 }, density = 2000 }
    for key, value in pairs(values) do
        all[key] = value
    end
    return all
end

check.refused(model, function() model:generate("box", box { denisty = 3 }) end,
    "generator 'box': unknown parameter 'denisty'; did you mean 'density'?")
check.refused(model, function() model:generate("box", box { density = 0 }) end, "density = 0 kg/m3")
check.refused(model, function() model:generate("box", box { density = -1 }) end, "density = -1")
check.refused(model, function() model:generate("box", box { density = "heavy" }) end,
    "density must be a number, not the string 'heavy'")
check.refused(model, function() model:generate("box", box { min = { 8, 0 / 0, 8 } }) end,
    "min.y = nan is not a finite number")
check.refused(model, function() model:generate("box", box { max = { 8, 9, 9 } }) end, "generator 'box'")
check.refused(model, function() model:generate("box", box { min = { 8, 9 } }) end, "a list of 2 numbers")
check.refused(model, function() model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 } }) end,
    "parameter 'density' is missing")
check.refused(model, function() model:generate("box", box { group = 3 }) end, "group must be a string")
check.refused(model, function() model:generate("box", box { group = print }) end, "function")

-- Hulls: too few points, flat, a point inside the hull of the others, rows of the wrong length.
local function hull(vertices)
    return { vertices = vertices, density = 2400 }
end
check.refused(model, function() model:generate("polyhedron", hull { { 0, 0, 0 }, { 1, 0, 0 } }) end,
    "generator 'polyhedron'")
check.refused(model, function()
    model:generate("polyhedron", hull { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } })
end, "lie in one plane")
check.refused(model, function()
    model:generate("polyhedron",
        hull { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0.1, 0.1, 0.1 } })
end, "generator 'polyhedron'")
check.refused(model, function()
    model:generate("polyhedron", hull { { 0, 0, 0 }, { 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 } })
end, "row 2 has 2 numbers, not 3")
check.refused(model, function()
    model:generate("polyhedron", hull { { 0, 0, 0 }, { 1, 0, "a" }, { 0, 1, 0 }, { 0, 0, 1 } })
end, "row 2 has the string 'a' in place 3")
check.refused(model, function()
    model:generate("polyhedron", hull { { 0, 0, 0 }, { 1, 0, 0 / 0 }, { 0, 1, 0 }, { 0, 0, 1 } })
end, "vertices, row 2, z = nan")
check.refused(model, function() model:generate("polyhedron", hull {}) end, "generator 'polyhedron'")
check.refused(model, function() model:generate("polyhedron", hull { a = 1 }) end, "table with the key 'a': the keys of a list are 1, 2, 3 and so on, without gaps")

check.refused(model, function()
    model:generate("joint", { joint = "J1", dip = 95, dip_direction = 0 })
end, "dip = 95 deg is outside [0, 90]")
check.refused(model, function()
    model:generate("jointset", { joint = "J1", dip = 45, dip_direction = 0, spacing = 0, number = 3 })
end, "spacing = 0")
check.refused(model, function() model:generate("jont", {}) end, "unknown generator 'jont'; did you mean 'joint'?")
check.refused(model, function() model:generate() end, "the generator's name must be a string, not nil")
check.refused(model, function() model:generate("box", 3) end, "must be a table, not the number 3")
check.refused(model, function() model:generate("box", { 1, 2 }) end, "given by name")
check.refused(model, function() model:generate("box", {}, 3) end, "1 argument too many")
check.refused(model, function() model:generate("box\0y", {}) end, "zero byte")
