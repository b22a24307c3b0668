-- Data files of 3DEC are converted and run to what 3DEC 7.00 itself gives for these models.
package.path = "tests/verify/?.lua;tests/lua/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local files = require "threedec_files"
local reference = require "reference_3dec"

local PRINTED = 1e-3 -- relative: 3DEC's steps end at a ratio of forces of 1e-4 or less
local SLIPS = 1e-2   -- relative: what slips on its way to rest depends on the way (peers_arch.lua)
local CLOSURE = 5e-3 -- relative: the cube's ratio of forces is 1e-7, and closures have three digits

-- Runs a file. All of it must be converted.
local function run(text)
    local model, said, result = files.run(text)
    figures.equal("commands that are mistaken, left out or done in part", #result.mistakes + #result.left_out + #result.in_part, 0)
    return model, said
end

local function between(model, a, b)
    return model:contacts { between = { model:blocks { id = a }, model:blocks { id = b } } }[1]
end

local function length(v)
    return math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2)
end

do
    local case = reference.M1_161
    figures.case("S.3dec.arch20", "The data file of an arch of 20 voussoirs, with 3DEC's own commands, is converted and run: thrust, reaction and the force of the "
        .. "first joint.", case.source)
    local model = run(files.arch_20(0.5))
    local joint, reaction = between(model, 1, 2), model:blocks { id = 1 }:reaction()
    figures.relative("thrust, N", math.abs(reaction[1]), case.thrust, PRINTED)
    figures.relative("vertical force at a support, N", reaction[3], case.vertical, PRINTED)
    figures.relative("first joint: normal force, N", joint.normal_force, case.normal_force, PRINTED)
    figures.relative("first joint: shear force, N", length(joint.shear_force), case.shear_force, PRINTED)
    figures.relative("first joint: area, m2", joint.area, case.joint_area, 1e-4)
end

do
    local case = reference.five
    figures.case("S.3dec.arch5", "The data file of an arch of five voussoirs on soft joints, which slip a little, is converted and run. "
        .. "Gravity comes on in ten portions.", case.source)
    local model = run(files.arch_5())
    local reaction = model:blocks { id = 1 }:reaction()
    figures.relative("thrust, N", math.abs(reaction[1]), case.thrust, SLIPS)
    figures.relative("vertical force at a support, N", reaction[3], case.vertical, PRINTED)
    figures.relative("way of the crown, m", model:blocks { id = 3 }[1].displacement[3], case.crown, SLIPS)
    figures.relative("volume of the second block, m3", model:blocks { id = 2 }[1].volume, case.volume, 1e-5)
end

do
    local case = reference.cube
    figures.case("S.3dec.cube", "The data file of a cube that stands beside the middle of another one is converted and run: force and closures at the corners.",
        case.source)
    local model = run(files.cube())
    local joint, closures = model:contacts {}[1], {}
    for i, p in ipairs(joint.points) do
        closures[i] = -p.gap
    end
    table.sort(closures)
    figures.relative("normal force, N", joint.normal_force, case.normal_force, 1e-4)
    figures.relative("least closure of a corner, m", closures[1], case.closures[1], CLOSURE)
    figures.relative("largest closure of a corner, m", closures[#closures], case.closures[2], CLOSURE)
end

do
    local case = reference.thin
    figures.case("S.3dec.thin", "The data file of an arch of 20 voussoirs that is too thin is converted and run: it falls by the hinges by which it does in 3DEC.",
        case.source)
    local model, said = run(files.arch_20(0.3))
    figures.equal("the script says that it fails", said:match "fails", "fails")
    figures.equal("hinges, degrees", files.hinges(model, 0.3), case.hinges)
end
figures.finish()
