-- Steps of changing length: what is set between two steps acts from then on, however long the last step was, and a step that changes
-- all the time is of second order still.
local talus = require "talus"
local check = require "check"

local LONG, SHORT = 0.0138, 4.4e-4

-- A cube in empty space that has made long steps.
local function drifting(velocity)
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
    m:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
    m:timestep { dt = LONG }
    m:blocks():set { velocity = velocity or { 0, 0, 0 } }
    m:cycle(5)
    return m, m:blocks()
end

-- ---------------------------------------------------------------- what is put on

-- After n steps of h under an acceleration a: a h (n - 1/2), and a (n h)^2 / 2, whatever the step before was.
for _, h in ipairs { SHORT, LONG, 3 * LONG } do
    for _, what in ipairs { "gravity", "load", "both", "moment" } do
        local m, cube = drifting { 0.3, 0, 0.2 }
        local from = cube[1].displacement
        if what == "gravity" or what == "both" then m.gravity = { 0, 0, -10 } end
        if what == "load" or what == "both" then cube:load { force = { 2000, 0, -4000 } } end
        if what == "moment" then cube:load { moment = { 0, 0, 100 } } end
        local az = what == "gravity" and -10 or what == "load" and -2 or what == "both" and -12 or 0
        local ax = (what == "load" or what == "both") and 1 or 0
        local spin = what == "moment" and 100 / (2000 / 6) or 0
        m:timestep { dt = h }
        for n = 1, 4 do
            m:cycle(1)
            local label, t = ("%s, step %g, %d"):format(what, h, n), n * h
            check.near(cube[1].velocity, { 0.3 + ax * h * (n - 0.5), 0, 0.2 + az * h * (n - 0.5) }, 1e-12, label)
            check.near(cube[1].angular_velocity, { 0, 0, spin * h * (n - 0.5) }, 1e-12, label)
            local u = cube[1].displacement
            check.near(u[3] - from[3], 0.2 * t + 0.5 * az * t * t, 1e-12, label)
            check.near(u[1] - from[1], 0.3 * t + 0.5 * ax * t * t, 1e-12, label)
        end
    end
end

-- Set and taken back, or set to what it is, nothing has happened: not to the hash either.
do
    local m, cube = drifting { 0.3, 0, 0.2 }
    cube:load { force = { 1, 2, 3 }, at = { 1, 0, 0 } }
    m:cycle(3)
    local twin, hash = m:copy(), m:state_hash()
    m.gravity = { 0, 0, -10 }
    m.gravity = { 0, 0, 0 }
    m:cycle(4)
    twin:cycle(4)
    check.equal(m:state_hash(), twin:state_hash())
    check.holds(hash ~= m:state_hash(), "it has moved")
end

-- What was set counts in a copy and in a file, and is part of the state.
do
    local stem = os.getenv("TALUS_TEST_TMP") .. "/changing_step_" .. (tostring({}):match("0x(%x+)") or "0") .. ".talus"
    local m, cube = drifting { 0.3, 0, 0.2 }
    local before = m:state_hash()
    m.gravity = { 0, 0, -10 }
    cube:load { force = { 1e3, 2e3, 3e3 }, at = { 1, 0, 0 } }
    check.holds(m:state_hash() ~= before, "hash")
    local copy = m:copy()
    m:save(stem)
    local restored = talus.restore(stem)
    os.remove(stem)
    for _, other in ipairs { copy, restored } do check.equal(other:state_hash(), m:state_hash()) end
    for _, model in ipairs { m, copy, restored } do
        model:timestep { dt = SHORT }
        model:cycle(5)
    end
    for _, other in ipairs { copy, restored } do check.equal(other:state_hash(), m:state_hash()) end
end

-- A gravity beyond all numbers is put right.
do
    local m = drifting()
    m.gravity = { 0, 0, 1e308 }
    check.raises(function() m:cycle(1) end, "for gravity is 1e+308 m/s2")
    m.gravity = { 0, 0, -1e308 }
    check.raises(function() m:cycle(1) end, "for gravity is 1e+308 m/s2")
    m.gravity = { 0, 0, -10 }
    m:cycle(1)
end

-- A block that rests on a floor keeps its velocity small when its weight comes on with a step that falls, and the ledger its balance.
do
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2000 })
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
    m:blocks { id = 1 }:fix()
    m:joint("*", "elastic", { kn = 1e6, ks = 1e6 })
    m:timestep { dt = LONG }
    m:cycle(5)
    m.gravity = { 0, 0, -10 }
    m:timestep { dt = SHORT }
    m:cycle(1)
    check.near(m:blocks { id = 2 }[1].velocity[3], -10 * SHORT / 2, 1e-9)
    m:cycle(2000)
    check.near(m:energy().balance, 0, 1e-3)
end

-- ---------------------------------------------------------------- steps that change all the time

-- A cube that swings on a floor under its weight, always pressed, in steps between a longest one and a thirtieth of that. Returns
-- how far it is off the closed form after ten periods, over the amplitude, and the worst balance of energy.
local function swing(longest, seed)
    math.randomseed(seed)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2000 })
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
    m:blocks { id = 1 }:fix()
    m:blocks { id = 2 }:fix { x = true, y = true, rotation = true }
    local kn = 2e7
    m:joint("*", "elastic", { kn = kn, ks = kn })
    local omega, worst = math.sqrt(kn / 2000), 0
    local static, last = 10 / omega ^ 2, 20 * math.pi / omega
    while last - m.time > 1e-12 do
        m:timestep { dt = math.min(longest * 30 ^ -math.random(), last - m.time) }
        m:cycle(1)
        if m.time > math.pi / omega then -- before that all terms are small
            worst = math.max(worst, math.abs(m:energy().balance))
        end
    end
    return math.abs(m:blocks { id = 2 }[1].displacement[3] + static * (1 - math.cos(omega * m.time))) / static, worst
end

local period = 2 * math.pi / math.sqrt(2e7 / 2000)
local errors, balances = {}, {}
for k, parts in ipairs { 25, 50, 100 } do
    errors[k], balances[k] = 0, 0
    for seed = 1, 6 do
        local off, balance = swing(period / parts, seed)
        errors[k] = math.max(errors[k], off)
        balances[k] = math.max(balances[k], balance)
    end
    check.holds(k == 1 or errors[k] < 0.4 * errors[k - 1], ("error %g after %g"):format(errors[k], errors[k - 1] or 0))
end
check.holds(errors[3] < 1e-3 and balances[3] < 1e-3, ("error %g, balance %g"):format(errors[3], balances[3]))

-- A damping that stops bodies in one kick takes out what they had, however unequal the halves of the kick are, and that they turn.
for _, motion in ipairs { { velocity = { 0.05, 0.02, -0.1 } }, { angular_velocity = { 0.05, 0.1, 0 } } } do
    local stopped = talus.model { gravity = { 0, 0, -9.81 } }
    stopped:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2500, group = "floor" })
    stopped:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "cube" })
    stopped:blocks { group = "floor" }:fix()
    stopped:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    stopped:damping "kinetic"
    stopped:blocks { group = "cube" }:set(motion)
    local whole = stopped.dt / 4
    for k = 1, 400 do
        stopped:timestep { dt = whole * (k % 2 == 0 and 1 or 0.3) }
        stopped:cycle(1)
    end
    check.near(stopped:energy().balance, 0, 0.005)
end
