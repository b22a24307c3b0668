-- A fixed block with its top at z = 0 and a cube of 1 m on it, without weight: model, lower, upper. `min` and `max` are the
-- block's corners.
local talus = require "talus"

return function(min, max)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = min, max = max, density = 2000, group = "lower" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000, group = "upper" })
    local lower, upper = model:blocks { group = "lower" }, model:blocks { group = "upper" }
    lower:fix()
    return model, lower, upper
end
