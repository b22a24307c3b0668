-- Springs at the corners of blocks that a joint has cut: their edges lie on each other, and cross at small angles as they are kicked. Energy stays,
-- and no face presses on one that faces it from the other side of a block.
local check = require "check"
local talus = require "talus"

local MADE, BALANCE = 2e-3, 3e-3 -- of the kick; of the largest term, at a tenth of the stable step

local function between(low, high)
    return low + (high - low) * math.random()
end

local function build(seed)
    math.randomseed(seed, 5)
    local model = talus.model { gravity = { 0, 0, -10 }, contact_points = "corners" }
    local kn, high, dip = 10 ^ between(8, 10), 10 ^ between(-1, 0), between(5, 60)
    model:generate("box", { min = { -10, -10, -2 }, max = { 10, 10, 0 }, density = 2000 })
    model:generate("box", { min = { -1, -1, 0 }, max = { 1, 1, high }, density = 2000 })
    model:blocks { id = 1 }:fix():hide()
    model:generate("joint", { joint = "J", dip = dip, dip_direction = between(0, 360), origin = { 0, 0, high / 2 } })
    model:blocks { hidden = "any" }:show()
    model:joint("*", "coulomb", { kn = kn, ks = kn, friction = 40 })
    model:timestep { fraction = 0.1 }
    local v, w = 10 ^ between(-2, -0.5), 10 ^ between(-2, 0)
    for _, b in ipairs(model:blocks { fixed = false }) do
        model:blocks { id = b.id }:set { velocity = { between(-v, v), between(-v, v), between(-v, v) },
            angular_velocity = { between(-w, w), between(-w, w), 0.3 * between(-w, w) } }
    end
    return model
end

local function held(energy)
    return energy.kinetic + energy.potential + energy.stored - energy.external
end

-- Seeds that made up to 1e8 times the kick among them; 52 and 98 are off their balance where corners that are almost straight count in full.
for _, seed in ipairs { 53, 57, 60, 1, 2, 3, 4, 5, 52, 98 } do
    local model = build(seed)
    model:cycle(1)
    local kick, from = model:energy().kinetic, held(model:energy())
    for _ = 1, 125 do
        model:cycle(20)
        local energy = model:energy()
        check.holds((held(energy) - from) / kick < MADE, ("seed %d makes %.1e of the kick"):format(seed, (held(energy) - from) / kick))
        check.holds(math.abs(energy.balance) < BALANCE, ("seed %d: balance %.1e"):format(seed, energy.balance))
    end
end
