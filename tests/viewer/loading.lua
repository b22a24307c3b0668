-- loading.lua - the pages that loading.py opens: rock of about 100,000 blocks, without contacts and with those that slip.
--
--     talus tests/viewer/loading.lua FOLDER [BLOCKS]
package.path = "tests/bench/?.lua;" .. package.path
local rock = require "rock"

local folder, count = assert(arg[1], "the folder is missing"), tonumber(arg[2] or 100000)

local model, side = rock.build(count, 2)
rock.stress(model, side)
model:write_html(folder .. "/still", { title = "Rock of " .. #model:blocks() .. " blocks", contacts = false })

-- One side stands free, and what the joints hold there is little: the rock behind it begins to slide.
model:blocks { above = { dip = 90, dip_direction = 90, origin = { side, 0, 0 } } }:delete()
model:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 8 })
model:mass_scaling(true)
model:cycle(200)
model:write_html(folder .. "/slipping", { title = "Rock that slides", contacts = "slipping" })
