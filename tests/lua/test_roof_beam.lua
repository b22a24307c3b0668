-- test_roof_beam.lua - how the weight of a roof bed comes matters where nothing presses its joints together, and does not
-- where rock is under stress.
package.path = "scripts/?.lua;" .. package.path -- run in the source root
local check = require "check"
local beam = require "examples.roof_beam"

local THICK, STRESS = 1, -1e6 -- m; Pa, along the bed
local SAME = 0.02             -- relative, of sags
local HELD = 0.05             -- of the sag: what the springs of a joint give

-- How far midspan sags, and the end of the bed slips at the wall.
local function rest(bring, stress)
    local model = beam.build(THICK, THICK / 2)
    if stress then
        model:cycle(0)
        model:insitu { stress = { xx = stress } }
    end
    check.equal(bring(model).reason, "rest")
    local middle = model:gridpoints { near = { beam.span / 2, beam.wide / 2, 0 } }[1]
    local wall = model:gridpoints { near = { 0, beam.wide / 2, THICK / 2 } }[1]
    return -middle.displacement[3], -wall.displacement[3]
end

local function at_once(model)
    return model:relax { ratio = 1e-4 }
end

local function in_parts(model)
    return model:relax { ratio = 1e-4, load_steps = 5 }
end

do -- blocks slip at the walls before the arch has closed: farther where weight comes at once, and friction holds that
    local sag, slip = rest(at_once)
    local sag_of_parts, slip_of_parts = rest(in_parts)
    check.holds(slip > 2 * slip_of_parts)
    check.near(sag - slip, sag_of_parts - slip_of_parts, 0.1 * sag_of_parts)
end

do -- a bed under stress: it sags by the same in all ways, and does not slip
    local sag, slip = rest(at_once, STRESS)
    check.near(rest(in_parts, STRESS), sag, SAME * sag)
    check.holds(slip < HELD * sag)
end
