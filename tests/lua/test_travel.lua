-- The step heeds what moves: no block is carried past or into another, or turned too far, by one step. The program shortens its
-- own step for that, and refuses a given one before anything moves.
local talus = require "talus"
local check = require "check"

-- A chip of 1 cm before a plate of 2 m of the given thickness, or off to its side.
local function chip(options)
    local size, thick, gap, beside = 0.01, options.thick or 0.01, options.gap, options.beside or 0
    local high = options.high or size
    local m = talus.model { threads = options.threads, gravity = options.gravity or { 0, 0, 0 } }
    m:generate("box", { min = { -1, -1, -thick }, max = { 1, 1, 0 }, density = 2500 })
    m:generate("box", { min = { beside, 0, gap }, max = { beside + size, size, gap + high }, density = 2500 })
    m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    return m, m:blocks { id = 1 }, m:blocks { id = 2 }
end

local function refuses(m, parts, what)
    local hash, cycles = m:state_hash(), m.cycles
    local ok, why = pcall(m.cycle, m, 1)
    check.holds(not ok, what .. ": refused")
    for _, part in ipairs(parts) do
        check.holds(tostring(why):find(part, 1, true), what .. ": '" .. part .. "' in: " .. tostring(why))
    end
    check.equal(m:state_hash(), hash, what .. ": the state")
    check.equal(m.cycles, cycles, what .. ": steps")
    return why
end

-- ---------------------------------------------------------------- past each other

-- A given step that would carry the chip past the plate or far into it, whichever of the two moves and whether it is held, free or
-- driven; the step that the sentence allows is made, and so are steps that the program chooses.
math.randomseed(3)
for case = 1, 60 do
    local thick, speed = 0.01 * 2 ^ math.random(0, 3), 10 ^ (1 + 2 * math.random())
    local dt, mover, options = 1e-3, math.random(1, 3), { thick = thick, gap = 0.08 * math.random(), threads = case % 2 + 1 }
    dt = (options.gap + 0.01 + math.random() * thick) / speed -- ends beyond half of the chip, or of the plate
    local what = ("case %d: plate %g m, %g m/s"):format(case, thick, speed)
    local m, plate, piece = chip(options)
    local function move(model, a, b)
        if mover == 1 then
            a:fix()
            b:set { velocity = { 0, 0, -speed } }
        elseif mover == 2 then
            a:drive { velocity = { 0, 0, speed } }
        else
            a:set { velocity = { 0, 0, 0.5 * speed } }
            b:set { velocity = { 0, 0, -0.5 * speed } }
        end
    end
    move(m, plate, piece)
    m:timestep { dt = dt }
    local why = refuses(m, { "cycle 1: block ", " would be carried ", " into or past block ", " give a dt of " }, what)
    local allowed = tonumber(why:match("give a dt of (%S+) s or less"))
    check.holds(allowed < dt and allowed > 0.05 * dt, what .. ": " .. why)
    m:timestep { dt = allowed }
    m:cycle(1)
    m, plate, piece = chip(options)
    move(m, plate, piece)
    local from = piece[1].centroid[3] - plate[1].centroid[3]
    for _ = 1, 200 do
        m:cycle(1)
        local to = piece[1].centroid[3] - plate[1].centroid[3]
        -- a quarter of the chip at the most once they are together
        check.holds(to > math.min(from, 0.5 * (thick + 0.01)) - 0.0026, what .. ": chosen step")
        from = to
        if from < 0.5 * (thick + 0.01) - 0.0026 then break end
    end
end

-- ---------------------------------------------------------------- relaxation

-- A leaf far thinner than its way in a step, which a relaxation lets fall on a plate, lands on it: it is held back.
for _, thick in ipairs { 1e-4, 1e-2 } do
    local gap = 0.4
    local m, plate, piece = chip { thick = thick, gap = gap, high = 1e-4, gravity = { 0, 0, -9810 } }
    plate:fix()
    local r = m:relax { stop_at_failure = false, max_cycles = 4000 }
    local what = ("on a plate of %g m"):format(thick)
    check.equal(r.reason, "rest", what)
    check.near(piece[1].displacement[3], -gap, 1e-4 * gap, what .. ": way down, m")
end

-- ---------------------------------------------------------------- what is not slowed down

-- In empty space, away from a plate, along it and off to its side a chip may go as far as it likes.
for _, case in ipairs {
    { "away", { 0, 0, 100 } }, { "along", { 100, 0, 0 } }, { "beside", { 140, 0, -50 }, beside = 1.1 } } do
    local m, plate, piece = chip { gap = 0.0005, beside = case.beside }
    plate:fix()
    local dt = m.dt
    piece:set { velocity = case[2] }
    check.equal(m.dt, dt, case[1])
    m:cycle(1)
    check.equal(m.time, dt, case[1])
    m, plate, piece = chip { gap = 0.0005, beside = case.beside }
    plate:fix()
    piece:set { velocity = case[2] }
    m:timestep { dt = 1e-3 } -- ten of its sizes
    m:cycle(1)
end

-- A stone that falls past a floor of others at a distance keeps its step until it comes near.
do
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -1, -1, -0.01 }, max = { 1, 1, 0 }, density = 2500 })
    m:generate("box", { min = { 0, 0, 20 }, max = { 0.1, 0.1, 20.1 }, density = 2500, group = "stone" })
    m:blocks { id = 1 }:fix()
    m:joint("*", "coulomb", { kn = 1e6, ks = 1e6, friction = 30 })
    local dt, stone = m.dt, m:blocks { group = "stone" }
    local steps = {}
    while m.time < 2.5 and stone[1].velocity[3] <= 0 do
        local before = m.time
        local near = stone[1].centroid[3] - 0.05 < -2 * dt * stone[1].velocity[3]
        m:cycle(1)
        steps[#steps + 1] = m.time - before
        if not near then check.near(steps[#steps], dt, 1e-12) end
    end
    check.holds(math.min(table.unpack(steps)) < 0.5 * dt, "shorter where it lands")
end

-- ---------------------------------------------------------------- turns

for _, rate in ipairs { 20, 200, 2000 } do
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 2, 3 }, density = 2500 })
    m:joint("*", "coulomb", { kn = 1e6, ks = 1e6, friction = 30 })
    local top = m:blocks()
    top:set { angular_velocity = { 0, rate, 0 } }
    check.near(m.dt * rate, math.min(0.1, m.dt * rate), 1e-9, "chosen")
    local t = m:timestep()
    check.equal(t.block.id, 1)
    m:timestep { dt = 0.3 / rate }
    refuses(m, { "cycle 1: block 1, at ", " rad/s, would turn by 0.3 rad in this step of dt = ", "more than the 0.25 rad", "give a dt of " },
        "turn")
    m:timestep { dt = 0.2 / rate }
    m:cycle(10)
end

-- Free rotation about no axis of symmetry, in the steps that are chosen where soft joints would allow any, is right to 0.1 %.
do
    local function spinning()
        local m = talus.model { gravity = { 0, 0, 0 } }
        m:generate("box", { min = { 0, 0, 0 }, max = { 1, 2, 3 }, density = 2500 })
        m:joint("*", "coulomb", { kn = 1e4, ks = 1e4, friction = 30 })
        m:blocks():set { angular_velocity = { 3, 7, 2 } }
        return m
    end
    local m, exact = spinning(), spinning()
    while m.time < 1 do m:cycle(1) end
    check.holds(m.cycles > 70, "steps of a tenth of a radian")
    exact:timestep { dt = m.time / 5000 }
    exact:cycle(5000)
    for i, v in ipairs(exact:blocks()[1].vertices) do
        for k = 1, 3 do
            check.near(m:blocks()[1].vertices[i][k], v[k], 1e-3 * 7.9 * 1.9)
        end
    end
end

-- ---------------------------------------------------------------- the same bits

-- For any number of threads, in any order of blocks as far as the step goes, and after being saved.
local stem = string.format("%s/travel_%s.talus", assert(os.getenv("TALUS_TEST_TMP")), tostring({}):match("0x(%x+)") or "0")
local function storm(threads, reversed)
    local m = talus.model { threads = threads, gravity = { 0, 0, 0 } }
    for i = 0, 29 do
        local k = reversed and 29 - i or i
        local x, y, z = k % 3 * 0.3, k // 3 % 3 * 0.3, k // 9 * 0.3
        m:generate("box", { min = { x, y, z }, max = { x + 0.02 * (1 + k % 4), y + 0.1, z + 0.1 }, density = 2500 })
        m:blocks { id = i + 1 }:set { velocity = { 40 * (k % 5 - 2), 30 * (k % 7 - 3), 20 * (k % 3 - 1) } }
    end
    m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    return m
end
local one, three, turned = storm(1), storm(3), storm(1, true)
check.equal(one.dt, turned.dt, "order")
for k = 1, 10 do
    one:cycle(20)
    three:cycle(20)
    check.equal(one:state_hash(), three:state_hash(), "threads")
    if k == 5 then
        one:save(stem)
        one = talus.restore(stem)
    end
end
os.remove(stem)

-- A given step that is far above what is stable is looked at, too, while all is slow: what it would do is not done.
local slow = talus.model { gravity = { 0, 0, -9.81 } }
slow:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2500, group = "floor" })
slow:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
slow:blocks { group = "floor" }:fix()
slow:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
slow:damping "local"
slow:cycle(20)
slow:timestep { dt = 300 * slow.dt }
slow:cycle(1)
check.refused(slow, function() slow:cycle(1) end, "would be carried")
