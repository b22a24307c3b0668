-- Hundreds of small models of each law whose joints come under another law while they press, and of joints that a stress or slip has
-- opened otherwise from place to place and that are tilted until edges press. tests/lua/test_moved_faces.lua does a little of it.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local every_law = require "every_law"
local moved_faces = require "moved_faces"

local MODELS, KN, PRESSURE = 300, 1e8, 1e5
local joints = every_law(KN, PRESSURE)

figures.case("LAW.moved", "faces that laws, stress and slip have moved, 300 models of each law", "continuity and conservation of energy")
for k, joint in ipairs(joints) do
    local jump, balance, curved, leap, heat = 0, 0, 0, 0, 0
    for seed = 1, MODELS do
        local other = joints[seed % #joints + 1]
        local result = moved_faces.changed(joint, other, 1000 * k + seed, KN)
        local alone = math.max(moved_faces.changed(joint, joint, 1000 * k + seed, KN).balance,
            moved_faces.changed(other, other, 1000 * k + seed, KN).balance)
        if not other.opens then -- slip that it lets go opens the joint
            jump = math.max(jump, result.jump)
        end
        if other.curved then
            curved = math.max(curved, result.balance - alone)
        else
            balance = math.max(balance, result.balance - alone)
        end
        if seed <= MODELS / 3 then
            result = moved_faces.leaned(joint, 1000 * k + seed, KN)
            leap, heat = math.max(leap, result.jump), math.max(heat, -result.heat)
        end
    end
    figures.between(joint.name .. ": change of the force where its law is changed, of the force", jump, 0, 1e-9)
    figures.between(joint.name .. ": energy balance after it, beyond that of either law, of the largest term", balance, 0, 5e-3)
    figures.between(joint.name .. ": the same where the law becomes one that is no line", curved, 0, 0.02)
    figures.between(joint.name .. ": largest change of the force in a step of 0.4 microradians, of the force", leap, 0, 0.02)
    figures.between(joint.name .. ": fall of the heat while faces tilt, of the energy stored", heat, 0, 0.01)
end
figures.finish()
