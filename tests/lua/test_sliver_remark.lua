-- program only
-- The remark on slivers proposes a filter that makes the step as much longer as it says: nearly, for what is joined has larger faces and weighs
-- little more. tests/verify/long/slivers.lua tries more models.
local check = require "check"
local slivers = require "slivers"

local MODELS = check.cases(60)

local list = slivers.gains(MODELS)
check.holds(#list > MODELS / 2, "most models have slivers")
for _, model in ipairs(list) do
    check.holds(model.gain > 0.75 * model.told, ("model %d: told %g, gained %g"):format(model.seed, model.told, model.gain))
    check.near(model.off, 0, 0.06) -- of two digits
end
