-- Steps that have no meaning end with a sentence: places that would be no numbers, blocks that would fly off, overlaps that
-- no contact can part. The model is as usable as before, and the same step fails again.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local stem = string.format("%s/limits_%s", assert(os.getenv("TALUS_TEST_TMP")),
    tostring({}):match("0x(%x+)") or "0")

local function finite(x)
    return x == x and math.abs(x) < math.huge
end

-- A cube of `size` (m) on a fixed slab, after three steps.
local function stack(threads, size, kn)
    local a = size or 1
    local m = talus.model { threads = threads, gravity = { 0, 0, -9.81 * a } }
    m:generate("box", { min = { 0, 0, 0 }, max = { 4 * a, 4 * a, a }, density = 2000, group = "base" })
    m:generate("box", { min = { a, a, a }, max = { 2 * a, 2 * a, 2 * a }, density = 2000, group = "top" })
    m:blocks { group = "base" }:fix()
    m:joint("*", "coulomb", { kn = kn or 1e8, ks = kn or 1e8, friction = 30 })
    m:cycle(3)
    return m, m:blocks { group = "top" }
end

-- Every number that can be asked for is finite, and files are written.
local function is_usable(m)
    for _, block in ipairs(m:blocks { hidden = "any" }) do
        for _, field in ipairs { "centroid", "displacement", "velocity", "angular_velocity" } do
            for _, x in ipairs(block[field]) do
                check.holds(finite(x), field .. " is finite")
            end
        end
    end
    check.holds(#m:contacts() >= 0, "contacts can be asked for")
    m:energy()
    m:state_hash()
    m:write_vtk(stem)
    m:write_section(stem, { dip = 90, dip_direction = 90, origin = { 0.5, 0.5, 0.5 } })
    m:write_blocks(stem .. ".json")
end

-- The run fails with a sentence that names block 2, the contact and the cycle, the same again and on any number of threads.
local function refuses(change, part)
    local sentence
    for _, threads in ipairs { 1, 3 } do
        local m, top = stack(threads)
        change(m, top)
        local text = check.raises(function() m:cycle(300) end, part):gsub("^.-:%d+: ", "")
        check.holds(text:find("cycle " .. m.cycles + 1, 1, true), "the cycle in: " .. text)
        check.holds(text:find("block 2", 1, true) or text:find("blocks 1 and 2", 1, true), "the block in: " .. text)
        check.holds(text:find("contact", 1, true), "the contact in: " .. text)
        sentence = sentence or text
        check.equal(text, sentence)
        local cycles, time = m.cycles, m.time
        is_usable(m)
        check.equal(check.raises(function() m:cycle(1) end, part):gsub("^.-:%d+: ", ""), sentence)
        check.equal(m.cycles, cycles)
        check.equal(m.time, time)
    end
end

-- Motion that no model can run with is refused when it is given; what some could, by the step that would follow.
local function motion(verb, values)
    local name = next(values)
    local most = 0
    for _, x in ipairs(values[name]) do
        most = math.max(most, math.abs(x))
    end
    if most <= 1e50 then
        refuses(function(_, top) top[verb](top, values) end, "block 2 would move")
        return
    end
    local m, top = stack(1)
    check.refused(m, function() top[verb](top, values) end, string.format("%s: %s = {", verb, name))
    check.refused(m, function() top[verb](top, values) end, "must be three finite numbers of at most 1e+50: no model can run")
    m:cycle(3)
end

for _, x in ipairs { 1e9, 1e50, 1e80, 1e160, 1e305, 1.7e308 } do
    for _, sign in ipairs { 1, -1 } do
        refuses(function(m) m.gravity = { 0, 0, -sign * x } end, "block 2 would move")
        refuses(function(m) m.gravity = { x, sign * x, 0 } end, "block 2 would move")
        motion("drive", { velocity = { sign * x, 0, 0 } })
        motion("drive", { angular_velocity = { x, sign * x, x } })
        refuses(function(_, top) top:drive { velocity = function() return { 0, sign * x, 0 } end } end,
            "block 2 would move")
        motion("set", { velocity = { 0, 0, sign * x } })
        motion("set", { angular_velocity = { 0, sign * x, 0 } })
        refuses(function(_, top) top:load { force = { sign * math.min(x * 1e3, 1e308), 0, 0 } } end, "block 2 would move")
        refuses(function(_, top) top:load { moment = { 0, 0, sign * math.min(x * 1e3, 1e308) } } end, "block 2 would move")
    end
end
refuses(function(m) m:timestep { dt = 1e90 } end, "block 2 would move")
refuses(function(_, top) top:set { density = 1e240 } end, "block 2 would move")
refuses(function(m) m:damping("viscous", { alpha = 0.1 }) m.gravity = { 0, 0, 1e300 } end, "block 2 would move")
refuses(function(m) m:damping("local", { alpha = 0.8 }) m.gravity = { 0, 0, 1e300 } end, "block 2 would move")
refuses(function(m) m.rotation = "paper" m.gravity = { 0, 0, 1e300 } end, "block 2 would move")

for _, bad in ipairs { 0 / 0, 1 / 0, -1 / 0 } do
    for _, verb in ipairs { "set", "drive" } do
        for _, name in ipairs { "velocity", "angular_velocity" } do
            local m, top = stack(1)
            check.refused(m, function() top[verb](top, { [name] = { 0, bad, 0 } }) end, name)
            check.refused(m, function() top[verb](top, { [name] = { bad, bad, bad } }) end, name)
        end
    end
end

-- Parts of a body that spins as fast as that.
do
    local m, top = stack(1)
    m:generate("box", { min = { 1, 1, 2 }, max = { 2, 2, 3 }, density = 2000, group = "top" })
    local both = m:blocks { group = "top" }
    both:join()
    both:set { angular_velocity = { 0, 9e49, 0 } }
    check.refused(m, function() both:unjoin() end, "cannot unjoin blocks: parts of the body of block 2 move at up to ")
    check.refused(m, function() top:unjoin() end, "set its velocities first")
    both:set { angular_velocity = { 0, 9e9, 0 } }
    both:unjoin()
    is_usable(m)
    both:join()
    both:set { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } }
    both:unjoin()
    m:cycle(3)
end

-- A given step that is too long makes motion grow from small to wild without anything being set: such a step is undone,
-- too, and with the step that the program chooses the run goes on.
local ended = 0
for _, times in ipairs { 3, 8, 20, 25, 40, 100 } do
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 1 }, density = 2000, group = "base" })
    m:generate("box", { min = { 1, 1, 1.5 }, max = { 2, 2, 2.5 }, density = 2000, group = "top" })
    m:blocks { group = "base" }:fix()
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    m:timestep { dt = times * 2 * math.sqrt(2000 / 2e8) }
    m:blocks { group = "top" }:set { velocity = { 0, 0, -0.3 } }
    local hash
    local good = pcall(function()
        for _ = 1, 200 do
            hash = m:state_hash()
            m:cycle(1)
        end
    end)
    if not good then
        ended = ended + 1
        check.equal(m:state_hash(), hash)
        m:timestep {}
        m:blocks { group = "top" }:set { velocity = { 0, 0, 0 } }
        m:cycle(5)
    end
end
check.holds(ended >= 3, "steps that are far too long end with a sentence") -- others throw the cube away before

-- A load far off a block's centroid begins to turn it only when the block has moved a little: that step is undone, too.
do
    local m, top = stack(1)
    top:load { force = { 1e6, 1e6, 1e6 }, at = { 1e6, 1e6, 1e6 } }
    local hash
    check.raises(function()
        for _ = 1, 50 do
            hash = m:state_hash()
            m:cycle(1)
        end
    end, "block 2 would move")
    check.equal(m:state_hash(), hash)
    top:load {}
    top:set { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } }
    m:cycle(5)
end

-- Steps whose squares are no numbers.
do
    local m = stack(1)
    for _, wild in ipairs { { dt = 1e-320 }, { dt = 1e300 }, { fraction = 1e-308 }, { fraction = 0 } } do
        check.refused(m, function() m:timestep(wild) end, "timestep")
    end
end

-- What was wrong is put right, and the run goes on.
local m, top = stack(1)
m.gravity = { 0, 0, -1e305 }
check.raises(function() m:cycle(10) end, "is no finite number")
m.gravity = { 0, 0, -9.81 }
m:cycle(2000)
check.near(top[1].displacement[3], 0, 1e-3)

-- The limit is a motion of ten diameters in a step, whatever the units: 0.99 of it goes on and 1.01 of it does not.
for _, size in ipairs { 1e-3, 1, 1e3 } do
    for _, share in ipairs { 0.99, 1.01 } do
        m, top = stack(1, size, 1e8 * size)
        local speed = share * 10 * math.sqrt(3) * size / 1e-3
        m:timestep { dt = 1e-3 }
        top:drive { velocity = { 0.6 * speed, 0, 0.8 * speed } }
        if share < 1 then
            m:cycle(5)
        else
            check.raises(function() m:cycle(5) end, "more than 10 times its diameter")
        end
    end
end

-- Fast platens, blasts and long falls are no mistakes.
m, top = stack(2)
top:drive { velocity = { 1000, 0, 0 } }
m:cycle(200)
m, top = stack(2)
top:set { velocity = { 0, 0, 300 }, angular_velocity = { 20, 0, 0 } }
m:cycle(200)
m = talus.model { gravity = { 0, 0, -10 } }
m:generate("box", { min = { 0, 0, 0 }, max = { 0.05, 0.05, 0.05 }, density = 2000 })
m:timestep { dt = 1e-3 }
m:cycle(30000)
check.near(m:blocks()[1].velocity[3], -300, 0.1)

-- ---------------------------------------------------------------- overlaps

-- Two cubes in each other: the first step says so, unless both are held or one is gone.
local function twins(shift)
    local model = talus.model { gravity = { 0, 0, 0 } }
    for i = 0, 1 do
        model:generate("box", { min = { i * shift, 0, 0 }, max = { i * shift + 1, 1, 1 }, density = 2000 })
    end
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    return model
end

-- Remarks on blocks placed into each other are not at issue here.
for shift = 0.02, 0.3, 0.02 do
    m = twins(shift)
    local function run() m:cycle(1) end
    if shift < 0.1 - 1e-9 then
        local text = check.raises(run, "cycle 1, contact of blocks 1 and 2 (no joint): they overlap by")
        check.equal(#m:contacts(), 1)
        check.equal(check.raises(run, "overlap by"), text)
        is_usable(m)
        check.raises(run, "overlap by")
        m:blocks():fix()
        m:cycle(3)
        m:blocks():free()
        check.raises(run, "overlap by")
        m:blocks { id = 2 }:delete()
        m:cycle(3)
    elseif shift > 0.1 + 1e-9 then
        run()
    end
end

-- A cube that sinks into soft ground: at the same overlap in any units and on any number of threads. Down to its own
-- diameter and a quarter it goes on.
local deepest, sentence
for _, size in ipairs { 1, 1e-3, 250 } do
    for _, threads in ipairs { 1, 3 } do
        m = talus.model { threads = threads, gravity = { 0, 0, -9.81 * size } }
        m:generate("box", { min = { -9 * size, -9 * size, -9 * size }, max = { 9 * size, 9 * size, 0 }, density = 2000 })
        m:generate("box", { min = { 0, 0, 0 }, max = { size, size, size }, density = 2000, group = "top" })
        m:blocks { id = 1 }:fix()
        m:joint("*", "coulomb", { kn = 0.6 * 2000 * 9.81 * size, ks = 1e-3 * size, friction = 30 })
        m:timestep { fraction = 0.01 }
        top = m:blocks { group = "top" }
        local text = check.raises(function() m:cycle(100000) end, "contact of blocks 1 and 2 (no joint): they overlap by")
        local depth = -top[1].displacement[3] / size
        deepest = deepest or depth
        check.near(depth, deepest, 1e-6)
        check.near(depth, 1.25 * math.sqrt(3), 0.05)
        -- The sentence tells the limit that was exceeded, %.3g of it.
        check.near(tonumber(text:match("more than the (%S+) m up to")) / size, 1.25 * math.sqrt(3), 5e-3)
        check.equal(check.raises(function() m:cycle(1) end, "overlap by"):gsub("^.-:%d+: ", ""),
            (text:gsub("^.-:%d+: ", "")))
        is_usable(m)
    end
end

-- A cube that rests legally deeper in soft ground than one may be born is followed on its way, whatever blocks come or go
-- elsewhere.
local function sunk(size, threads, depth)
    local model = talus.model { threads = threads, gravity = { 0, 0, -9.81 } }
    local function box(group, x, y, z, wide)
        model:generate("box", { min = { x * size, y * size, z * size },
            max = { (x + wide) * size, (y + wide) * size, (z + 1) * size }, density = 2000, group = group })
    end
    box("ground", 0, 0, 0, 4)
    box("top", 1.5, 1.5, 1, 1)
    box("far one", 20, 0, 0, 1)
    box("far two", 21, 0, 0, 1)
    model:blocks { where = function(b) return b.group ~= "top" end }:fix()
    model:blocks { group = "top" }:fix { x = true, y = true, rotation = true }
    local k = 2000 * 9.81 / depth
    model:joint("*", "elastic", { kn = k, ks = k })
    model:damping("viscous", { alpha = 20 / math.sqrt(size) })
    model:cycle(3000)
    check.near(model:blocks { group = "top" }[1].displacement[3] / size, -depth, 1e-6)
    return model
end
local function far_of(model)
    return model:blocks { where = function(b) return b.group:find("far") end }
end
local changes = {
    function(model) model:blocks { group = "far one" }:delete() end,
    function(model) far_of(model):join() end,
    function(model) far_of(model):join() model:cycle(1) far_of(model):unjoin() end,
    function(model) model:generate("box", { min = { 90, 90, 90 }, max = { 91, 91, 91 }, density = 2000 }) end,
    function(model) model:blocks { group = "far one" }:delete() model:cycle(1) model:blocks { group = "far two" }:delete() end,
    function(model) model:contact_area { fraction = 0.5 } end,
}
for _, size in ipairs { 1, 0.01, 30 } do
    for i, change in ipairs(changes) do
        local depth = 0.92 + 0.01 * i
        m = sunk(size, i % 3 + 1, depth)
        change(m)
        m:cycle(10)
        check.near(m:blocks { group = "top" }[1].displacement[3] / size, -depth, 1e-6)
    end
end

-- What was placed into each other stays so when blocks elsewhere come or go.
m = twins(0.05)
m:generate("box", { min = { 20, 0, 0 }, max = { 21, 1, 1 }, density = 2000 })
sentence = check.raises(function() m:cycle(1) end, "contact of blocks 1 and 2 (no joint): they overlap by 0.95 m, more than the 0.9 m")
m:blocks { id = 3 }:delete()
check.equal(check.raises(function() m:cycle(1) end, "overlap by"):gsub("^.-:%d+: ", ""), (sentence:gsub("^.-:%d+: ", "")))

-- Walls that are held may overlap, and what stands between them runs.
m = talus.model {}
m:generate("box", { min = { -2, -2, -1 }, max = { 2, 2, 0 }, density = 2000, group = "wall" })
m:generate("box", { min = { -2, -2, -1 }, max = { -1, 2, 2 }, density = 2000, group = "wall" })
m:generate("box", { min = { -2.1, -2.1, -1 }, max = { -1.1, 2, 2 }, density = 2000, group = "wall" })
m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
m:blocks { group = "wall" }:fix()
m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
m:cycle(50)

for _, part in ipairs { ".json", "_blocks.vtk.series", "_contacts.vtk.series", "_joints.vtk.series", "_section.vtk.series" } do
    os.remove(stem .. part)
end
-- Of the contacts of a body that would move too far the one that presses most is named, in any order of blocks; of its load what counts.
for _, order in ipairs { { 1, 2, 3 }, { 3, 1, 2 }, { 2, 3, 1 } } do
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    local parts = { { "floor", -1, 0 }, { "middle", 0, 1 }, { "top", 1, 1.5 } }
    for _, i in ipairs(order) do
        model:generate("box", { min = { 0, 0, parts[i][2] }, max = { 1, 1, parts[i][3] }, density = 2500, group = parts[i][1] })
    end
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:damping "local"
    model:solve {}
    local function id(group) return model:blocks { group = group }[1].id end
    local middle = model:blocks { group = "middle" }
    middle:set { velocity = { 1e9, 0, 0 } }
    local low, high = math.min(id "floor", id "middle"), math.max(id "floor", id "middle")
    check.refused(model, function() model:cycle(1) end,
        ("most of all presses the contact of blocks %d and %d (no joint), with 3.68e+04 N"):format(low, high))
    middle:set { velocity = { 0, 0, 0 } }
    middle:load { force = { 1, 0, 0 }, at = { 0, 1e300, 0 } }
    check.refused(model, function() model:cycle(1) end, "the moment of its load is 1e+300 N m")
end

for frame = 0, 1 do
    for _, part in ipairs { "blocks", "contacts", "joints", "section" } do
        os.remove(string.format("%s_%s_%06d.vtk", stem, part, frame))
    end
end
