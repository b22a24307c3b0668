-- test_my_law.lua - a block that slides on a table until only the residual friction is left.
--
--     talus --plugin build/my_law.so test_my_law.lua
local talus = require "talus"

-- gravity is tilted by 25 degrees instead of the table
local g, slope, residual = 10, math.rad(25), 15
local model = talus.model { gravity = { g * math.sin(slope), 0, -g * math.cos(slope) } }
model:generate("box", { min = {0, 0, 0}, max = {20, 4, 1}, density = 2500, group = "table" })
model:generate("box", { min = {1, 1, 1}, max = {3, 3, 2}, density = 2500, group = "block" })
model:blocks { group = "table" }:fix()
model:joint("*", "my_law", { kn = 1e9, ks = 1e9, friction = 22, residual = residual, distance = 0.005 })

model:timestep { dt = 1e-4 }

local block = model:blocks { group = "block" }[1]
model:cycle(5000) -- past the whole distance
local v, t = block.velocity[1], model.time
model:cycle(5000)
local acceleration = (block.velocity[1] - v) / (model.time - t)
local expected = g * (math.sin(slope) - math.cos(slope) * math.tan(math.rad(residual)))
print(("acceleration %.6g, expected %.6g m/s2"):format(acceleration, expected))
assert(math.abs(acceleration - expected) < 0.01 * expected, "the block does not slide as it should")
assert(math.abs(model:energy().balance) < 1e-3, "the energies do not balance")
