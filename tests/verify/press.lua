-- Two blocks pressed together push each other apart, whichever was made first and along every axis.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"

local SPEED, STIFFNESS, DENSITY = 0.01, 1e8, 2000

-- Two cubes of 1 m that touch at a face normal to `axis`, approaching each other.
local function collide(axis, swapped)
    local model = talus.model { gravity = { 0, 0, 0 } }
    for i = 1, 2 do
        local upper = (i == 2) ~= swapped
        local min, velocity = { 0, 0, 0 }, { 0, 0, 0 }
        min[axis] = upper and 0 or -1
        velocity[axis] = upper and -SPEED or SPEED
        model:generate("box", { min = min, max = { min[1] + 1, min[2] + 1, min[3] + 1 },
            density = DENSITY, group = upper and "upper" or "lower" })
        model:blocks { group = upper and "upper" or "lower" }:set { velocity = velocity }
    end
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = 30 })
    model:timestep { rule = "body", fraction = 0.1 }
    return model, model:blocks { group = "upper" }, model:blocks { group = "lower" }
end

for axis = 1, 3 do
    for _, swapped in ipairs { false, true } do
        local name = string.format("axis %d%s", axis, swapped and ", swapped" or "")
        local model, upper, lower = collide(axis, swapped)
        model:cycle(5)
        local contact = model:contacts()[1]
        -- The normal points from the first of the contact's blocks, the older, to the second.
        local towards_second = (upper[1].id > lower[1].id) and 1 or -1
        figures.between(name .. " gap", contact.gap, -1, -1e-9)
        figures.between(name .. " normal force", contact.normal_force, 1, math.huge)
        figures.near(name .. " normal", contact.normal[axis], towards_second, 1e-9)
        figures.between(name .. " force on the upper", upper[1].force[axis], 1, math.huge)
        figures.between(name .. " force on the lower", lower[1].force[axis], -math.huge, -1)
        figures.relative(name .. " reaction", lower[1].force[axis], -upper[1].force[axis], 1e-12)
        -- They part at the speed they met with: an elastic rebound.
        model:cycle(2000)
        figures.equal(name .. " parted", upper[1].force[axis], 0)
        figures.relative(name .. " rebound, upper", upper[1].velocity[axis], SPEED, 5e-3)
        figures.relative(name .. " rebound, lower", lower[1].velocity[axis], -SPEED, 5e-3)
    end
end
figures.finish()
