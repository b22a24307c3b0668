-- The order and the number of a body's parts decide nothing of what is said. tests/lua/test_bodies_of_parts.lua does the same with fewer.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local orders = require "orders"

local MODELS = 400

figures.case("L.parts", MODELS .. " boxes and tetrahedra, whole, and cut by random planes and joined again, as a filter measures them; and as many masts with a head "
    .. "to one side and chips on them, which stand or topple, with their parts in another order and in more pieces: how the run ends, the verdict, and what "
    .. "a filter finds.", "the same body; moments about its foot")
local worst, differ, wrong, way = 0, 0, 0, 0
for seed = 1, MODELS do
    worst = math.max(worst, (orders.shapes(seed)))
    local said, topples, differs, off = orders.verdicts(seed)
    differ = differ + (differs and 1 or 0)
    way = math.max(way, off)
    wrong = wrong + ((said:find("^failure") ~= nil) ~= topples and 1 or 0)
end
figures.between("largest difference of volume, shortest edge and aspect", worst, 0, 1e-9)
figures.between("masts of which something else is said", differ, 0, 0)
figures.between("largest relative difference of how far a mast at rest has moved", way, 0, 0.01)
figures.between("masts that are told wrongly", wrong, 0, 0)
figures.finish()
