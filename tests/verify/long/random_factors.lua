-- Factors of safety of 300 random wedges and slopes, in all the forms of tests/lua/test_safety_random.lua.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local models = require "safety_models"

local SHARE = tonumber(os.getenv "TALUS_TEST_SHARE" or 1)

figures.case("FS.many", "240 random wedges with friction, cohesion, loads and water, and 60 slopes cut by three sets: as limit equilibrium has "
    .. "them or, where a wedge is held by other forces than those along its line, between that and the largest factor with which "
    .. "forces balance; the same number in other units, places, attitudes, orders, on 3 threads and with 2 workers.",
    "model:keyblocks; equilibrium of a block with forces of any direction on two planes")
for _, of in ipairs { { "wedges", 240, models.compare_wedge }, { "slopes", 60, models.compare_slope } } do
    local what, number, compare = table.unpack(of)
    local wrong, first = 0, nil
    for seed = 1, math.max(4, number // SHARE) do
        local good, why = compare(seed)
        wrong = wrong + (good and 0 or 1)
        first = first or (not good and why or nil)
    end
    figures.between(what .. " with another factor" .. (first and ", first " .. first or ""), wrong, 0, 0)
end
figures.finish()
