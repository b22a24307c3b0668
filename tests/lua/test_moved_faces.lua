-- A change of law leaves forces as they are, on faces, edges and corners, and makes no energy; nor does the hand-over of a joint that a
-- stress or slip has opened otherwise from place to place. tests/verify/long/moved_faces.lua tries many more.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local every_law = require "every_law"
local moved_faces = require "moved_faces"

local KN, PRESSURE = 1e8, 1e5
local JUMP, OPENED = 1e-9, 0.1            -- of the force; where slip opens the joint in the step
-- Of the largest term of the energy, beside what either law has alone; where a face presses in part, a curve is not quite at its force.
local BALANCE, CURVED = 5e-3, 0.02
local LEAN_JUMP, LEAN_HEAT = 0.02, -0.01  -- of the force; of the energy stored
local joints = every_law(KN, PRESSURE)

for seed = 1, check.cases(2 * #joints) do
    local joint, other = joints[seed % #joints + 1], joints[(7 * seed + seed // #joints) % #joints + 1]
    local name = joint.name .. " -> " .. other.name
    local result = moved_faces.changed(joint, other, seed, KN)
    check.holds(result.jump <= (other.opens and OPENED or JUMP), string.format("%s: the force jumps by %g", name, result.jump))
    local alone = math.max(moved_faces.changed(joint, joint, seed, KN).balance, moved_faces.changed(other, other, seed, KN).balance)
    check.holds(result.balance <= alone + (other.curved and CURVED or BALANCE), string.format("%s: balance %g, alone %g", name, result.balance, alone))
    result = moved_faces.leaned(joint, seed, KN)
    if not joint.tension then -- bonds hold faces together
        check.holds(result.points == 1, joint.name .. ": an edge presses")
    end
    check.holds(result.jump <= LEAN_JUMP and result.heat >= LEAN_HEAT,
        string.format("%s, model %d: the force jumps by %g, heat falls to %g", joint.name, seed, result.jump, result.heat))
end
