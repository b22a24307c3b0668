-- fixed.lua - a small model and a number of steps, for counting instructions: tests/bench/instructions.py.
--
--     talus tests/bench/fixed.lua case=wall reuse=on steps=20 [file=pile_30.json]
--
-- Prints the number of contacts that carry a force. The wall is that of wall.lua with n = 4, the pile the
-- thirty blocks of `file`.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local bench = require "bench"

local CASES = {
    wall = function() return require "wall".build("lattice", 4, 1) end,
    pile = function(file) return require "pile".load(file, 1) end,
}
local WARM = 10 -- steps in which contacts are born

local given = bench.arguments { case = "wall", reuse = "on", steps = 20, file = "" }
local model = CASES[given.case](given.file)
model.reuse_geometry = given.reuse == "on"
model:cycle(WARM)
model:cycle(given.steps)
print(model:profile().loaded)
