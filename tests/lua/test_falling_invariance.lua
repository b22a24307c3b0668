-- program only
-- Hulls and cubes that fall on a floor and on each other with friction do so alike wherever the scene lies, however it is
-- turned, in a mirror and in other units, as long as their motion is not chaotic.
-- tests/verify/long/falling_invariance.lua has more.
local check = require "check"
local invariance = require "invariance"

local SEEDS, TIME = check.cases(6), 0.3 -- s

local failed = 0
for seed = 1, SEEDS do
    invariance.run(seed, TIME, function(form, off, loaded)
        local good = off < invariance.SAME and loaded > 0
        print(string.format("%sseed %d %s: %.1e m off, %d contacts", good and "" or "FAILED ", seed, form.name, off, loaded))
        failed = failed + (good and 0 or 1)
    end)
end
check.equal(failed, 0)
