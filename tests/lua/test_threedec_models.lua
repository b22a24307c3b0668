-- Data files of 3DEC run to the figures that 3DEC 7.00 gives on four public models: thrust, reactions, joint forces,
-- closures, and which arch falls by which hinges. Without contact_points = "corners" they would be other ones.
require "talus"
local check = require "check"
local files = require "threedec_files"

local said
local function run(text)
    local model, last, result = files.run(text)
    said = last
    check.equal(#result.mistakes, 0)
    check.equal(#result.left_out, 0)
    check.equal(#result.in_part, 0)
    return model
end

local function share(actual, expected, tolerance)
    check.near(actual / expected, 1, tolerance)
end

-- Arch of 20: the first joint lies between the support, block 1, and block 2.
local model = run(files.arch_20(0.5))
assert(said:match "at rest", said)
local joint = model:contacts { between = { model:blocks { id = 1 }, model:blocks { id = 2 } } }[1]
local normal, shear = joint.normal_force, joint.shear_force
share(joint.area, 0.25006, 1e-4)
share(normal, 46232.3, 0.01)
share((shear[1] ^ 2 + shear[2] ^ 2 + shear[3] ^ 2) ^ 0.5, 13680, 0.01)
local thrust = math.abs(model:blocks { id = 1 }:reaction()[1])
share(thrust, 20723.4, 0.01)
share(model:blocks { id = 1 }:reaction()[3], 48366.2, 0.001)
share(model:blocks { group = "Supports" }:reaction()[3], model:blocks {}:sum "mass" * 9.81, 1e-5)
assert(model:blocks { id = 10 }[1].displacement[3] < -5e-5 and model:blocks { id = 10 }[1].displacement[3] > -7e-5)

-- Arch of five.
model = run(files.arch_5())
share(math.abs(model:blocks { id = 1 }:reaction()[1]), 2705.2, 0.01)
share(model:blocks { id = 2 }[1].volume, 0.0661876, 1e-5)
share(model:blocks { id = 3 }[1].displacement[3], -1.112e-3, 0.01)
share(model:blocks { id = 1 }:reaction()[3], 3571.23, 0.001)

-- The refined joint: with other points the thrust is another one.
local refined = run(files.arch_5():gsub("block contact generate%-subcontacts", "block face triangulate edge-max 0.02"))
share(math.abs(refined:blocks { id = 1 }:reaction()[1]), 3812, 0.03)

-- Cube: the closures of its corners.
model = run(files.cube())
joint = model:contacts {}[1]
share(joint.normal_force, 9806.0, 1e-4)
local closures = {}
for i, p in ipairs(joint.points) do
    closures[i] = -p.gap
end
table.sort(closures)
share(closures[1], 0.933e-7, 0.01)
share(closures[#closures], 2.07e-7, 0.01)

-- Thin arch: falls, by hinges at these sections, where it touches at one edge only: a contact of one point.
model = run(files.arch_20(0.3))
assert(said:match "fails", said)
check.equal(files.hinges(model, 0.3), "9 extrados, 36 intrados, 90 extrados, 144 intrados, 171 extrados")
