-- Contacts of deformable blocks that lie flush on others: their forces, stresses, filters, neighbours and histories, beside those of rigid blocks.
local talus = require "talus"
local check = require "check"

-- A column of zones on a floor, a rigid block on it, and two rigid blocks aside.
local model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { { min = { -2, -2, -1 }, max = { 2, 2, 0 }, density = 2500, group = "floor" },
    { min = { -1, -1, 0 }, max = { 1, 1, 2 }, density = 2000, group = "column" },
    { min = { -0.5, -0.5, 2 }, max = { 0.5, 0.5, 3 }, density = 2500, group = "top" },
    { min = { 1.5, 1.5, 0 }, max = { 2, 2, 1 }, density = 2500, group = "aside" } })
model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
model:blocks { group = "floor" }:fix()
model:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
model:blocks { group = "column" }:deformable { zone = 0.5, solid = "rock" }
model:damping "local"

-- Before the first step they are listed as it finds them. Asking changes nothing of what comes.
local unasked = model:copy()
check.equal(#model:contacts(), 3)
check.near(model:contacts { between = { model:blocks { group = "column" }, model:blocks { group = "top" } } }[1].area, 1, 1e-9)
check.equal(#model:blocks { group = "column" }[1].neighbours, 2)
check.equal(model:state_hash(), unasked:state_hash())
check.equal(#model:contacts(), 3)
model:joint("*", { friction = 30 })
unasked:joint("*", { friction = 30 })
model:cycle(3)
unasked:cycle(3)
check.equal(model:state_hash(), unasked:state_hash())

model:solve { ratio = 1e-6, max_cycles = 30000 }

local column, top, floor = model:blocks { group = "column" }[1], model:blocks { group = "top" }[1], model:blocks { group = "floor" }[1]
local contacts = model:contacts()
check.equal(#contacts, 3)

-- The weight of what lies above, in vertical forces; areas of the faces; closures by the stiffness of the joint.
local below = model:contacts { between = { column, floor } }[1]
local above = model:contacts { between = { column, top } }[1]
check.near(below.normal_force, 8 * 2000 * 10 + 2500 * 10, 1)
check.near(above.normal_force, 2500 * 10, 1)
check.near(below.area, 4, 1e-9)
check.near(above.area, 1, 1e-9)
check.near(below.normal_stress, below.normal_force / below.area, 1e-6)
check.near(above.normal[3], 1, 1e-9)
check.near(above.point[3], 2, 1e-3)
check.near(below.point[1], 0, 1e-6)
check.holds(above.gap < 0 and above.gap > -1e-4)
check.equal(below.state, "elastic")
check.equal(below.law, "coulomb")
check.equal(below.blocks[1], floor)
check.equal(below.blocks[2], column)
check.near(contacts:sum("normal_force"), 8 * 2000 * 10 + 2 * 2500 * 10 + 0.25 * 2500 * 10, 1)
check.near(model:contacts { where = function(c) return c.area < 2 and c.area > 0.5 end }:sum("normal_force"), 25000, 1)
check.equal(#column.neighbours, 2)

-- Their points bear them, three a segment.
for _, c in ipairs { below, above } do
    local force, area, shear = 0, 0, 0
    for _, p in ipairs(c.points) do
        force, area, shear = force + p.normal_force, area + p.area, shear + p.shear_force[1]
        check.near(p.position[3], c == below and 0 or 2, 1e-3)
        check.near(p.closure, p.normal_force / (1e9 * p.area), 1e-11) -- places are those behind the last step
        check.near(p.gap, -p.closure, 1e-15)
        check.equal(p.state, "elastic")
    end
    check.holds(#c.points > 0 and #c.points % 3 == 0)
    check.near(force, c.normal_force, 1e-6)
    check.near(area, c.area, 1e-9)
    check.near(shear, c.shear_force[1], 1e-6)
end

-- A contact is known by its blocks and by when they met.
check.equal(above.born, 0)
local again = model:copy()
again:generate("box", { min = { 0.6, 0.6, 2 }, max = { 0.9, 0.9, 2.3 }, density = 2500, group = "late" })
again:cycle(2)
local late = again:contacts { between = { again:blocks { group = "column" }, again:blocks { group = "late" } } }[1]
check.equal(late.born, model.cycles)
again:cycle(40)
check.equal(late.born, model.cycles)

-- A push along the contact is borne by shear, or slips.
model:blocks { group = "top" }:load { force = { 5000, 0, 0 } }
model:solve { ratio = 1e-6, max_cycles = 30000 }
above = model:contacts { between = { column, top } }[1]
check.near(above.shear_force[1], -5000, 20)
check.near(above.shear_stress, 5000, 20)
check.holds(above.shear_displacement[1] > 4e-6)
model:blocks { group = "top" }:load { force = { 20000, 0, 0 } }
model:cycle(50)
above = model:contacts { between = { column, top } }[1]
check.equal(above.state, "slipping")

-- Files and pages show them.
local folder = assert(os.getenv "TALUS_TEST_TMP")
model:write_vtk(folder .. "/meetings")
model:write_html(folder .. "/meetings")

-- A block that goes takes its contacts with it.
model:blocks { group = "top" }:delete()
check.equal(#model:contacts(), 2)
local found, sentence = pcall(function() return above.area end)
check.holds(not found and sentence:find("no longer exists", 1, true))
