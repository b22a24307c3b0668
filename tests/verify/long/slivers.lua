-- The filter that the remark on slivers proposes gains what it says. tests/lua/test_sliver_remark.lua does the same with fewer models.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local slivers = require "slivers"

local MODELS = 400
local NEARLY, LEAST = 0.75, 0.25 -- of what was told: what is joined has larger faces, and weighs little more

figures.case("L.slivers", MODELS .. " boxes cut by three sets of joints, of which some lie close together: the time step before and after the filter "
    .. "that the remark proposes, beside the gain that it tells.", "the time step that is used")
local list, short, least, off = slivers.gains(MODELS), 0, math.huge, 0
for _, model in ipairs(list) do
    short = short + (model.gain < NEARLY * model.told and 1 or 0)
    least, off = math.min(least, model.gain / model.told), math.max(off, model.off)
end
figures.between("models with a remark", #list, MODELS / 2, MODELS)
figures.between("share that gains less than 0.75 of what was told", short / #list, 0, 0.01)
figures.between("least gain over what was told", least, LEAST, math.huge)
figures.between("largest difference of the share of the rock, relative (two digits)", off, 0, 0.06)
figures.finish()
