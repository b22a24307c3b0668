-- Velocities set between two steps: no slip comes of them for the step before, and their energy is
-- external work.
local talus = require "talus"
local check = require "check"

local KN = 1e8

-- A cube pressed on a fixed block by 1e-4 m and sheared by 5e-5 m.
local function loaded()
    local model, base, cube = require "cube_on_block"({ -2, -2, -1 }, { 3, 3, 0 })
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 45 })
    model:timestep { dt = 1e-3 }
    cube:drive { velocity = { 5e-4, 0, -1e-3 } }
    model:cycle(100)
    cube:drive { velocity = { 0, 0, 0 } }
    model:cycle(1)
    return model, cube, model:contacts()[1]
end

-- The forces of the next step are those of the motion made, whatever is set in between.
for _, change in ipairs {
    function(cube) cube:drive { velocity = { 4, 3, 0 } } end,
    function(cube) cube:drive { velocity = function() return { 4, 3, 0 } end } end,
    function(cube) cube:drive { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 5 } } end,
    function(cube) cube:fix() end,
    function(cube) cube:free():set { velocity = { 4, 0, 0 }, angular_velocity = { 1, 2, 3 } } end,
} do
    local model, cube, contact = loaded()
    check.near(contact.shear_force, { -5000, 0, 0 }, 1e-6)
    change(cube)
    model:cycle(1)
    check.near(contact.shear_force, { -5000, 0, 0 }, 1e-6)
    check.near(contact.normal_force, 1e4, 1e-6)
end

-- A body thrown, spun, held and thrown again: its kinetic energy comes from outside and goes there.
local model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 2, 3 }, density = 1000 })
model:timestep { dt = 1e-3 }
model:cycle(10)
local block = model:blocks()
block:set { velocity = { 3, 0, 10 }, angular_velocity = { 0.1, 2, 0.2 } }
model:cycle(1)
local thrown = model:energy()
check.near(thrown.external / thrown.kinetic, 1, 1e-2)
model:cycle(500)
check.near(model:energy().balance, 0, 1e-6)
block:fix()
model:cycle(10)
check.near(model:energy().kinetic, 0, 0)
check.near(model:energy().balance, 0, 1e-3)
block:free():set { velocity = { 0, 5, 0 } }
model:cycle(100)
check.near(model:energy().balance, 0, 1e-3)

-- A velocity is that of the block's own centroid, as the field tells it, though its body turns about another; of several blocks of a
-- body, that of their common centroid.
do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 }, { min = { 1, 0, 0 }, max = { 2, 1, 1 }, density = 5000 } })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8 })
    model:blocks():join()
    local one, other = model:blocks { id = 1 }, model:blocks { id = 2 }
    one:set { velocity = { 1, 2, 3 }, angular_velocity = { 0, 0, 1 } }
    check.near(one[1].velocity, { 1, 2, 3 }, 1e-14)
    check.near(other[1].velocity, { 1, 3, 3 }, 1e-14)
    other:set { velocity = { 0, 0, 0 } }
    check.near(other[1].velocity, { 0, 0, 0 }, 1e-14)
    check.near(one[1].velocity, { 0, -1, 0 }, 1e-14)
    check.near(one[1].angular_velocity, { 0, 0, 1 }, 0)
    model:blocks():set { velocity = { 0, 0, 0 } }
    check.near(one[1].velocity, { 0, -2 / 3, 0 }, 1e-14)
    check.near(other[1].velocity, { 0, 1 / 3, 0 }, 1e-14)
end
