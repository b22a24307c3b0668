-- The tunnel of tunnel.lua in rock that deforms: the wedge falls as in rigid rock, and the roof lets go of it where joints are stiff.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require("reference_generation").tunnel
local tunnel = require "examples.deformable_tunnel"

figures.case("E3.zones", "The paper's tunnel with zones in all blocks: the wedge's acceleration, and which friction holds it "
    .. "in rock that bears its own weight", reference.source)

-- Relative: the rock springs back when the wedge leaves, and takes it along a little.
local ACCELERATION = 0.01
local row = reference.acceleration[3]
figures.relative(string.format("acceleration over gravity at mu = %g", row[1]),
    tunnel.drop(tunnel.zoned, math.deg(math.atan(row[1]))), row[2], ACCELERATION)

local function holds(build, friction, kn, expected)
    figures.equal(string.format("%s, joints of %g Pa/m: friction %g holds", build, kn, friction),
        (tunnel.holds(tunnel[build], friction, kn)), expected)
end

-- Pressure on the wedge. Rigid rock shares stress and weight by area, for springs are alike in all directions, however stiff they are.
local _, soft_rigid = tunnel.holds(tunnel.rigid, 62, 1e8)
local _, stiff_rigid = tunnel.holds(tunnel.rigid, 62, 1e10)
figures.relative("rigid: pressure with stiff joints, over that with soft ones", stiff_rigid, soft_rigid, 1e-3)
holds("rigid", 23, 1e8, true)
holds("rigid", 18, 1e8, false)
holds("rigid", 23, 1e10, true)
holds("rigid", 18, 1e10, false)
-- Joints of 0.1 GPa/m give more than rock of 5 GPa: zones change a tenth.
local _, soft = tunnel.holds(tunnel.zoned, 62, 1e8)
figures.relative("zones, soft joints: pressure", soft, soft_rigid, 0.1)
holds("zoned", 23, 1e8, true)
holds("zoned", 18, 1e8, false)
-- Stiff ones bear what the rock leaves, and the roof is relieved.
local _, stiff = tunnel.holds(tunnel.zoned, 62, 1e10)
figures.equal("zones, stiff joints: less than a fifth of the pressure is left", stiff < stiff_rigid / 5, true)
holds("zoned", 45, 1e10, false)
figures.finish()
