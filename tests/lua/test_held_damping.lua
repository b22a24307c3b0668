-- A damping does nothing in components that are held: a velocity set there stays, costs no energy, and tells no servo.
local talus = require "talus"
local check = require "check"

local DAMPINGS = { { "none" }, { "viscous", { alpha = 20 } }, { "local" }, { "combined" }, { "adaptive" }, { "kinetic" } }
local HELD = {
    { { x = true }, { velocity = { 1, 0, 0 } } },
    { { rotation = true }, { velocity = { 0, 0, 0 }, angular_velocity = { 0.3, 0, 1 } } },
    { { x = true, y = true, rotation = true }, { velocity = { 0.2, -0.1, 0 }, angular_velocity = { 0, 0, 1 } } },
}

-- A plate on a fixed slab moves on in what is held of it; another block falls beside them.
local function run(damping, held, change)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { 0, 0, -1 }, max = { 6, 6, 0 }, density = 2500, group = "base" })
    m:blocks():fix()
    m:generate("box", { min = { 1, 1, 0 }, max = { 2, 3, 0.5 }, density = 2500, group = "plate" })
    m:generate("box", { min = { 4, 4, 1 }, max = { 5, 5, 2 }, density = 2500, group = "falls" })
    m:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 30 })
    m:damping(table.unpack(damping))
    m:timestep { dt = 1e-4 }
    change(m)
    local plate = m:blocks { group = "plate" }
    plate:fix(held[1])
    m:cycle(5)
    plate:set(held[2])
    local worst = 0
    for step = 1, 300 do
        change(m, step)
        m:cycle(1)
        worst = math.max(worst, math.abs(m:energy().balance))
    end
    return worst, plate[1]
end

local undamped = {}
for _, damping in ipairs(DAMPINGS) do
    for k, held in ipairs(HELD) do
        local name = ("%s, held %d"):format(damping[1], k)
        local worst, plate = run(damping, held, function() end)
        check.holds(worst < 1e-5, ("%s: balance %g"):format(name, worst))
        if held[1].x then
            check.near(plate.velocity[1], held[2].velocity[1], 0)
        end
        if held[1].rotation then
            check.near(plate.angular_velocity, held[2].angular_velocity, 0)
        end
        -- steps that change, whose kicks have two unequal halves
        worst = run(damping, held, function(m, step) m:timestep { dt = step and step % 3 == 0 and 5e-5 or 1e-4 } end)
        check.holds(worst < 1e-3, ("%s, changing step: balance %g"):format(name, worst))
        -- more inertia than their own
        worst = run(damping, held, function(m, step)
            if not step then
                m:timestep {}
                m:mass_scaling { dt = 2e-3, most = 100 }
            end
        end)
        undamped[k] = undamped[k] or worst -- the steps are long
        check.holds(worst < 2 * undamped[k], ("%s, mass scaling: balance %g"):format(name, worst))
    end
end

-- The servo follows what can be damped: a heavy block that is held at a velocity changes nothing for another one.
local function height(speed)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { 0, 0, -1 }, max = { 2, 2, 0 }, density = 2500, group = "base" })
    m:blocks():fix()
    m:generate("box", { min = { 0.5, 0.5, 0 }, max = { 1.5, 1.5, 1 }, density = 2500, group = "top" })
    m:generate("box", { min = { 50, 0, 0 }, max = { 59, 9, 9 }, density = 2500, group = "train" })
    m:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 30 })
    m:damping "adaptive"
    m:timestep { dt = 1e-3 }
    m:blocks { group = "train" }:fix { x = true, z = true }
    m:blocks { group = "train" }:set { velocity = { speed, 0, 0 } }
    m:cycle(300)
    return m:blocks { group = "top" }[1].displacement[3]
end
check.near(height(5) / height(0), 1, 1e-4) -- the energy that stays is rounded

-- A held velocity that is out of proportion is no less so where a damping would stop the block.
do
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    m:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 30 })
    m:damping("viscous", { alpha = 4000 })
    m:timestep { dt = 1e-3 }
    m:blocks():fix { x = true }
    m:blocks():set { velocity = { 1e5, 0, 0 } }
    check.raises(function() m:cycle(1) end, "block 1 would move")
end
