-- Hulls and cubes that fall on a floor with friction, in other places, attitudes and units. tests/lua/
-- test_falling_invariance.lua does the same for the first seeds.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local invariance = require "invariance"

local SEEDS, TIME = 40, 0.3 -- s

figures.case("D.invariance", "Six cubes and twelve hulls of 1 m fall on a floor, 0.3 s, in five forms: turned, mirrored, "
    .. "both, in millimetres, 1 km away", "the scene as first given")
for seed = 1, SEEDS do
    invariance.run(seed, TIME, function(form, off)
        figures.near(string.format("seed %d, %s: largest difference of places and turns, m", seed, form.name), off, 0,
            invariance.SAME)
    end)
end
figures.finish()
