-- A contact between held blocks needs no law. It stores nothing, also when an initial stress is put on it.
local check = require "check"
local talus = require "talus"

local model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = 2500, group = "held" })
model:generate("joint", { joint = "J", dip = 0, dip_direction = 0, origin = { 1, 1, 1 } })
model:generate("box", { min = { 5, 0, 0 }, max = { 6, 1, 1 }, density = 2500 })
model:blocks { group = "held" }:fix()
model:timestep { dt = 1e-4 }
model:insitu { stress = { zz = -1e6 } }
model:cycle(3)
check.equal(model:energy().stored, 0)
check.near(model:energy().balance, 0, 1e-9)

model:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
model:insitu { stress = { zz = -1e6 } }
model:cycle(3)
check.near(model:energy().stored, 0.5 * 1e6 ^ 2 / 1e9 * 4, 1e-6)
