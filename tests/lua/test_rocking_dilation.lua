-- A pressed block that is let go slips and rocks on a joint that dilates, so that each point of it is opened by its own way and a part of the
-- face is apart. It lands on that, over and over, and makes no energy.
local check = require "check"
local talus = require "talus"

-- Dilation, degrees; kn, Pa/m, of which slip opens the joint by a share of its closure; worst balance: the more it opens, the more what slip
-- opens in a step is off until the next.
for _, case in ipairs { { 5, 1e9, 1e-3 }, { 10, 1e10, 1e-3 }, { 20, 3e10, 1e-3 } } do
    local dilation, kn, balance = table.unpack(case)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -4, -4, -1 }, max = { 4, 4, 0 }, density = 2500, group = "floor" })
    model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 1.5 }, density = 2500, group = "block" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = kn, ks = kn, friction = 40, dilation = dilation })
    model:timestep { fraction = 0.05 }
    local block = model:blocks { group = "block" }
    block:load { force = { 0, 0, -4e5 } }
    model:damping "local"
    model:solve { ratio = 1e-8 }
    model:damping "none"
    block:load {}
    local rate = math.sqrt(kn / block[1].mass)
    local v = 4.4e5 / kn * rate
    block:set { velocity = { 0.7 * v, 0.5 * v, 0 }, angular_velocity = { -0.3 * v, 0.4 * v, 0.3 * v } }
    for _ = 1, 20 do
        model:solve { ratio = 0, max_time = 6 / rate }
        check.holds(math.abs(model:energy().balance) < balance, ("dilation %g, kn %g: balance %g"):format(dilation, kn, model:energy().balance))
    end
end
