-- Faces of deformable blocks from Lua: tractions, rollers, velocities, quiet faces; initial stress; whole blocks.
local talus = require "talus"
local check = require "check"

local function cube(size)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { { min = { 0, 0, 0 }, max = size or { 1, 1, 1 }, density = 2500 } })
    model:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
    model:blocks():deformable { zone = 0.4, solid = "rock" }
    return model
end

-- ---------------------------------------------------------------- initial stress

-- Under the same stress inside and outside nothing moves.
local model = cube()
local stress = { xx = -3e6, yy = -2e6, zz = -4e6, xy = 5e5 }
model:boundary { box = { min = { -1, -1, -1 }, max = { 2, 2, 2 } }, stress = stress }
model:insitu { stress = stress }
for _, zone in ipairs(model:zones()) do
    check.near(zone.stress.zz, -4e6, 1e-6)
end
check.near(model:energy().strain, 0, 1e-9)
model:cycle(20)
for _, point in ipairs(model:gridpoints()) do
    check.near(point.displacement[1], 0, 1e-14)
end
check.holds(model:energy().strain > 1000, "zones store what their stress stores")

-- In blocks around a tunnel as well: its roof and its floor look at each other across the rock in it, which bears all of the stress. Once that
-- is gone nothing bears it.
local rock = talus.model { gravity = { 0, 0, 0 } }
rock:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 1 }, density = 2500 })
rock:generate("joint", { joint = "bed", dip = 0, dip_direction = 0, origin = { 1, 1, 0.46 } })
rock:generate("tunnel", { face1 = { { 0.8, -0.1, 0.4 }, { 1.2, -0.1, 0.4 }, { 1.2, -0.1, 0.6 }, { 0.8, -0.1, 0.6 } },
    face2 = { { 0.8, 2.1, 0.4 }, { 1.2, 2.1, 0.4 }, { 1.2, 2.1, 0.6 }, { 0.8, 2.1, 0.6 } } })
rock:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 60 })
rock:solid("rock", "elastic", { young = 1e10, poisson = 0.2 })
rock:blocks():deformable { zone = 0.7, solid = "rock" }
rock:insitu { stress = stress }
rock:boundary { facing = { 0, 0, 1 }, within = 180, stress = stress }
rock:cycle(1)
for _, axis in ipairs { "force.x", "force.y", "force.z" } do
    check.near(rock:gridpoints():max(axis), 0, 1e-6)
    check.near(rock:gridpoints():min(axis), 0, 1e-6)
end
rock:blocks { group = "tunnel" }:delete()
rock:cycle(1)
for _, contact in ipairs(rock:contacts()) do
    check.holds(contact.gap < 0.1 or contact.normal_force == 0, "nothing presses across a tunnel")
end

-- In chosen blocks alone, and on their joints.
local three = talus.model { gravity = { 0, 0, 0 } }
three:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "a" },
    { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500, group = "b" },
    { min = { 0, 0, 2 }, max = { 1, 1, 3 }, density = 2500, group = "c" } })
three:joint("*", "elastic", { kn = 1e10, ks = 1e10 })
three:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
three:blocks():deformable { zone = 0.6, solid = "rock" }
three:insitu { stress = { zz = -1e6 }, blocks = three:blocks { group = "a" } }
for _, zone in ipairs(three:zones()) do
    check.near(zone.stress.zz, zone.group == "a" and -1e6 or 0, 1e-6)
end
three:cycle(1)
check.holds(three:energy().stored > 1, "a joint of a chosen block is pressed")
check.refused(three, function() three:insitu { stress = { zz = 1 }, blocks = 3 } end, "blocks must be a selection")
check.refused(three, function() three:insitu { stress = { zz = 1 }, blocks = model:blocks() } end, "another model")

-- ---------------------------------------------------------------- rollers and tractions

model = cube { 1, 1, 4 }
local sides = model:boundary { xmin = "roller", ymin = "roller", zmin = "roller", zmax = { pressure = 1e6 } }
check.near(sides.zmax.area, 1, 1e-12)
check.near(sides.zmax.force[3], -1e6, 1e-6)
check.equal(#sides.zmax.faces, 1)
model:damping "local"
model:solve { ratio = 1e-6 }
for _, zone in ipairs(model:zones()) do
    check.near(zone.stress.zz, -1e6, 5e3)
end
check.near(sides.zmin.reaction[3], 1e6, 1e3)
-- what holds a face goes when another call does something else to it
model:boundary { side = "zmax", fixed = true }
model:boundary { side = "zmax", traction = { 0, 0, 0 } }
check.equal(#model:gridpoints { near = { 0.5, 0.5, 4 }, fixed = true }, 1)
check.equal(#model:gridpoints { inside = { min = { 0.1, 0.1, 3.9 }, max = { 2, 2, 5 } }, fixed = true }, 0)

-- Part of a face: a strip is loaded triangle by triangle.
model = cube { 4, 1, 1 }
local strip = model:boundary { side = "zmax", box = { min = { -1, -1, 0 }, max = { 2, 2, 2 } }, pressure = 1e5 }
check.holds(strip.area > 1 and strip.area < 2.3, "the triangles of a part are loaded, not the face")

-- ---------------------------------------------------------------- velocities

model = cube()
local told = 0
model:boundary { zmin = "fixed", zmax = { velocity = function(t) told = told + 1; return 0, 0, -1e-3 end } }
model:cycle(100)
check.equal(told, 100)
check.near(model:gridpoints { near = { 0.5, 0.5, 1 } }[1].displacement[3], -1e-3 * model.time, 1e-15)
local copy = model:copy()
copy:cycle(50)
model:cycle(50)
check.equal(copy:state_hash(), model:state_hash())
model:boundary { side = "zmax", velocity = { 0, 0, 0 } }
local before = told
model:cycle(10)
check.equal(told, before, "another velocity ends the function")
model:boundary { side = "zmax", velocity = function() error "no speed" end }
local went, message = pcall(model.cycle, model, 1)
check.holds(not went and tostring(message):find "no speed", "errors of the function end the run")

-- ---------------------------------------------------------------- quiet faces

model = cube { 8, 1, 1 }
model:gridpoints():fix { y = true, z = true }
model:boundary { side = "xmax", quiet = true }
for step = 1, 40 do -- a pulse without corners: sharp ones ring on for long between zones
    model:boundary { side = "xmin", pressure = 1e5 * math.sin(math.pi * step / 40) ^ 2 }
    model:cycle(1)
end
model:boundary { side = "xmin", pressure = 0 }
local energy = model:energy()
local pulse = energy.kinetic + energy.strain
check.holds(pulse > 0)
while model.time < 0.025 do
    model:cycle(20)
end
energy = model:energy()
check.holds(energy.kinetic + energy.strain < 0.05 * pulse, "the pulse has left")
check.holds(math.abs(energy.balance) < 0.01)

-- ---------------------------------------------------------------- whole blocks

model = cube()
local block = model:blocks()
block:fix()
check.equal(#model:gridpoints { fixed = true }, #model:gridpoints())
block:free()
check.equal(#model:gridpoints { fixed = true }, 0)
block:load { force = { 0, 0, 100 }, at = { 0.5, 0.5, 1 } }
model:cycle(1)
block:load {}
block:set { velocity = { 1, 2, 3 } }
check.near(model:gridpoints()[1].velocity[2], 2, 0)
block:drive { velocity = { 0, 1, 0 } }
model:cycle(10)
check.near(model:gridpoints()[3].velocity[2], 1, 0)
block:free()

-- ---------------------------------------------------------------- errors

model:generate("box", { { min = { 5, 0, 0 }, max = { 6, 1, 1 }, density = 2500 } })
check.refused(model, function() model:boundary { side = "xmax", quiet = true } end,
    "joint '*' has no law to take the stiffness")
check.refused(model, function() model:boundary { side = "zmax", quiet = true, roller = true } end, "a quiet face moves")
check.refused(model, function() model:boundary { side = "xmin", velocity = { 0, 0, 1 }, fixed = true } end,
    "is held by that")
check.refused(model, function() model:boundary { side = "xmin", velocity = 3 } end,
    "velocity must be a list of 3 numbers or a function(t), not the number 3")
check.refused(model, function() block:fix { rotation = true } end, "it has no rotation to hold")
check.refused(model, function() block:load { force = { 1, 0, 0 }, at = { 9, 9, 9 } } end, "lies in no zone of block 1")
check.refused(model, function() block:set { density = 3000 } end, "set it before it gets zones")

-- A rigid block moves whole with the velocity of its face.
model:boundary { side = "xmax", velocity = { 0.5, 0, 0 } }
model:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
model:cycle(5)
check.near(model:blocks { id = 2 }[1].velocity[1], 0.5, 0)
