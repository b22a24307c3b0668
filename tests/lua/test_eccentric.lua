-- Loads beside the middle: their work has a part of the turn, and bonds break where the outermost fibre has their strength.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local talus = require "talus"

-- A free box in space under a load at a corner: what the load does is what moves, along and around.
for _, at in ipairs { { 0, 0, 0 }, { 1, 0.5, 2 }, { 0.2, 0.1, 0.3 } } do
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 0.5, 2 }, density = 2000 })
    m:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
    local box = m:blocks()
    box:load { force = { 300, -200, 100 }, at = at, moment = { 50, 20, -30 } }
    m:timestep { dt = 1e-3 }
    m:cycle(1500)
    local e, block = m:energy(), box[1]
    check.holds(e.kinetic > 100, "it moves")
    check.near(e.external / e.kinetic, 1, 1e-5)
    check.near(e.balance, 0, 1e-5)
    local v = block.velocity
    local along = 0.5 * block.mass * (v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2)
    check.holds(e.kinetic - along > 1e-3 * e.kinetic, "and turns: the work is not that of the path alone")
end

-- A bonded face of b x w under a pull N at the eccentricity e: its outermost fibre has N / (b w) (1 + 6 e / b). It breaks where that is the
-- strength, whether the pull comes at once or is turned up slowly.
local STRENGTH, B, W = 1e5, 1.2, 0.7
local function breaks_at(law, params, e, fraction)
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { -B / 2, -W / 2, -1 }, max = { B / 2, W / 2, 0 }, density = 2500, group = "held" })
    m:generate("box", { min = { -B / 2, -W / 2, 0 }, max = { B / 2, W / 2, 1 }, density = 2500, group = "pulled" })
    m:blocks { group = "held" }:fix()
    m:joint("*", law, params)
    m:damping("local", { alpha = 0.8 })
    local pull = fraction * STRENGTH * B * W / (1 + 6 * e / B)
    for k = 1, 20 do -- in portions, so that nothing swings beyond its rest
        m:blocks({ group = "pulled" }):load { force = { 0, 0, pull * k / 20 }, at = { e, 0, 0 } }
        m:cycle(400)
    end
    m:cycle(3000)
    local contact = m:contacts()[1]
    return not contact or m:blocks({ group = "pulled" })[1].displacement[3] > 1e-3
end
for _, law in ipairs {
    { "coulomb_tensile", { kn = 1e10, ks = 1e10, friction = 30, tension = STRENGTH, cohesion = 1e7 } },
    { "cohesive", { kn = 1e10, ks = 1e10, friction = 30, tension = STRENGTH, cohesion = 1e7, gi = 0.51, gii = 1e4 } },
} do
    for _, e in ipairs { 0, B / 12, B / 6, B / 3 } do
        local title = ("%s, eccentricity %.2f m: "):format(law[1], e)
        check.holds(not breaks_at(law[1], law[2], e, 0.97), title .. "it holds 0.97 of the strength at the outermost fibre")
        check.holds(breaks_at(law[1], law[2], e, 1.05), title .. "it breaks at 1.05 of it")
    end
end
