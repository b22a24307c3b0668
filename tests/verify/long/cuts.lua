-- Blocks on joints of every law that are cut by random planes: nothing starts to move, and parts go on as the block did. tests/lua/test_cut_keeps.lua and
-- test_cut_pressed.lua have other cases.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local cuts = require "cuts"
local every_law = require "every_law"
local figures = require "check_figures"

local MODELS = 300 -- of each law
-- Force on the floor, over what it was: of bonds that slip breaks some may break at points of the parts. Velocities over those of the block, or
-- over that of a swing on its springs. A block in flight has its centrifugal stress in the springs of the new joint, which swing a little.
local FORCE, BROKEN, STANDING, MOVED, FLYING = 1e-6, 1e-4, 1e-6, 1e-3, 1e-2
-- Share of the blocks that have slid whose parts may begin to move: where the shear that their law bears there has more energy.
local MOVING = 0.06

local rows = {}
for number = 1, MODELS do
    local case = cuts.draw(number)
    for k, joint in ipairs(every_law(case.kn, case.pressure)) do
        local row = rows[k] or { joint = joint, force = 0, standing = 0, flying = 0, cut = 0, slid = 0, moved = 0, open = 0 }
        rows[k] = row
        if not (case.history == "slides" and (joint.opens or joint.tension_after > 0)) then
            local force, off, open = cuts.try(case, joint)
            if force then
                row.cut = row.cut + 1
                row.force = math.max(row.force, force)
                if case.history == "flies" then
                    row.flying = math.max(row.flying, off)
                elseif case.history == "slid" then
                    row.slid, row.moved = row.slid + 1, row.moved + (off > MOVED and 1 or 0)
                    row.open = row.open + (open and 1 or 0)
                elseif case.history ~= "slides" then
                    row.standing = math.max(row.standing, off)
                end
            end
        end
    end
end

figures.case("LAW.cuts", MODELS .. " boxes with kn from 1e8 to 1e11 Pa/m, on a joint of every law, at rest, under an initial stress, sliding, spinning in "
    .. "flight, or at rest after they have slid on a tilted joint, which they may overhang, under a load so far from their middle that it may be open in part. "
    .. "They are cut by a plane of any direction at 1e-3 to 1 of their height, with a joint that bears what it cuts: the force on the floor stays, and ten "
    .. "steps later parts move as the box that is not cut. Boxes that slide are compared where they lie on all of their joint, on laws that slip does "
    .. "not open and that leave no tension, and all where they and their parts lie on patches.", "Newton's and Euler's laws")
for _, row in ipairs(rows) do
    local name = row.joint.name
    figures.between(name .. ": largest change of the force on the floor", row.force, 0, row.joint.tension > 0 and BROKEN or FORCE)
    figures.between(name .. ": largest velocity of what stood, over that of a swing", row.standing, 0, STANDING)
    figures.between(name .. ": share of what has slid that moves by more than 1e-3 of it", row.moved / row.slid, 0, MOVING)
    figures.between(name .. ": models that have slid, on a joint that is open in part", row.open, 1, MODELS / 5)
    figures.between(name .. ": largest difference of velocities in flight", row.flying, 0, FLYING)
    figures.between(name .. ": models compared", row.cut, MODELS / 2, MODELS)
end
figures.finish()
