-- The example of a wall in an earthquake: its parts, in a short run.
package.path = "scripts/?.lua;" .. package.path
local check = require "check"
local wall = require "examples.masonry_earthquake"

local model, record = wall.build(), wall.record(3)
check.near(record:peak(), 3, 0.1)
check.holds(model:relax { ratio = 1e-5 }.reason == "rest", "the wall rests")
local first = model:modes { count = 1 }[1]
check.holds(first.frequency > 4 and first.frequency < 60 and first.mass[2] > 0.5, "it sways across first")
local run = wall.shake(model, record, 0.1)
local n = #run.time
check.near(run.ground[n], 1000 * record:displacement(run.time[n]), 0.01)
check.holds(run.damped > 0, "dashpots took energy")
