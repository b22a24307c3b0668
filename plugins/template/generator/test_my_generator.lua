-- test_my_generator.lua - a wall stands on a floor.
--
--     talus --plugin build/my_generator.so test_my_generator.lua
local talus = require "talus"

local model = talus.model { gravity = {0, 0, -10} }
model:generate("box", { min = {-1, -1, -1}, max = {4, 1, 0}, density = 2000, group = "floor" })
model:generate("my_generator", { courses = 4, number = 5, density = 2000, group = "wall" })

local wall = model:blocks { group = "wall" }
local volume = 0
for i = 1, #wall do
    volume = volume + wall[i].volume
end
print("bricks", #wall, "volume", volume)
assert(#wall == 20, "there are not 20 bricks")
assert(math.abs(volume - 20 * 0.4 * 0.2 * 0.2) < 1e-12, "the volume is wrong")

model:blocks { group = "floor" }:fix()
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 35 })
local result = model:relax {}
print("rests after", result.cycles, "steps")
assert(result.reason == "rest", "the wall does not stand")
