-- program only
-- A stack, an arch, a beam on two edges and a cube in a groove come to rest under damping, to rounding, and in few steps.
-- test_pile_rests.lua has a pile, tests/verify/long/coming_to_rest.lua has larger ones and more of all.
local check = require "check"
local resting = require "resting"

local SLOWER = 1.5

local failed, taken, allowed = 0, {}, {}
for _, scene in ipairs(resting.scenes) do
    for i, kn in ipairs { 1e9, 1e10 } do
        if scene.steps[i] ~= false and scene.make ~= resting.pile then
            local result = resting.run(scene.make(kn))
            local most = scene.steps[i] and SLOWER * scene.steps[i] or resting.MOST
            local among = scene.among and ("%s, kn %.0e"):format(scene.among, kn)
            if among then
                taken[among] = (taken[among] or 0) + (result.steps or resting.MOST)
                allowed[among] = (allowed[among] or 0) + most
            end
            local good = result.rest and result.steps and (among or result.steps <= most)
            print(string.format("%s%s, kn %.0e: ratio after %s steps, of %.0f, %.3f s; rest after %s, %.1e m/s, balance %.1e",
                good and "" or "FAILED ", scene.name, kn, result.steps, most, result.time, result.rest, result.speed,
                result.balance))
            failed = failed + (good and 0 or 1)
        end
    end
end
check.equal(failed, 0)
for among, steps in pairs(taken) do
    check.equal(steps > allowed[among] and ("%s: %d steps, of %.0f"):format(among, steps, allowed[among]), false)
end
