-- test_my_damping.lua - a block that falls until drag and weight balance.
--
--     talus --plugin build/my_damping.so test_my_damping.lua
local talus = require "talus"

local g, drag = 10, 0.4 -- m/s2, 1/m
local model = talus.model { gravity = {0, 0, -g} }
model:generate("box", { min = {0, 0, 0}, max = {1, 1, 1}, density = 2500 })
model:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
model:damping("my_damping", { drag = drag })
model:timestep { dt = 1e-3 }
model:cycle(3000)

local speed, expected = -model:blocks()[1].velocity[3], math.sqrt(g / drag)
print("velocity", speed)
print("expected", expected)
assert(math.abs(speed - expected) < 1e-3 * expected, "the block does not fall as it should")
assert(model:energy().damping > 0, "the damping takes no energy")
