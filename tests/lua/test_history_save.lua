-- Histories of a model that is saved, restored or copied: all that was sampled is there, and sampling goes on as in one run.
local talus = require "talus"
local check = require "check"

local TMP = os.getenv "TALUS_TEST_TMP" .. "/history_save" .. tostring({}):match "0x(%x+)"
local FILE = TMP .. "/run.talus"

local function scene()
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -1, -1, -1 }, max = { 8, 2, 0 }, density = 2000, group = "base" })
    for i = 0, 2 do
        m:generate("box", { min = { 2 * i, 0, 0 }, max = { 2 * i + 1, 1, 1 }, density = 2000, group = "cube" })
    end
    m:blocks { group = "base" }:fix()
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    m:blocks { id = 3 }:set { velocity = { 3, 0, 0 } }
    return m
end

local function steps(m) return m.cycles, 2 * m.time end

local function watch(m)
    local cubes = m:blocks { group = "cube" }
    m:history { name = "kinetic", every = 3, value = "kinetic" }
    m:history { name = "open", every = 5, value = "open" }
    m:cycle(4)
    m:history { name = "cubes", every = 2, of = cubes, field = "displacement", take = "sum" }
    m:history { name = "one, \"quoted\"", every = 7, of = cubes[2], field = "speed" }
    m:history { name = "press", every = 4, of = m:contacts(), field = "normal_force", take = "max" }
    m:history { name = "contact", every = 1, of = m:contacts()[1], field = "normal" }
    m:history { name = "steps", every = 2, value = steps }
    return m
end

local function text(m)
    m:write_histories(TMP .. "/run.csv")
    local file <close> = assert(io.open(TMP .. "/run.csv"))
    return file:read "a"
end

-- The same rows as in one run, from saves at any step, also of what was restored before.
local whole = watch(scene())
local kept, copied = watch(scene()), watch(scene())
for k, count in ipairs { 1, 5, 12, 3, 6, 1 } do
    whole:cycle(count)
    kept:cycle(count)
    copied:cycle(count)
    kept:save(FILE)
    kept = talus.restore(FILE, { threads = 1 + k % 2, histories = { steps = steps } })
    local before = copied
    copied = copied:copy()
    check.equal(text(kept), text(whole))
    check.equal(text(copied), text(whole))
    before:cycle(1) -- its samples are its own
    check.equal(text(copied), text(whole))
end
check.equal(#kept:histories().kinetic.cycle, 11)
check.equal(#kept:histories().cubes.value[1], 3)
check.equal(kept:state_hash(), whole:state_hash())
local with, without = scene(), scene()
watch(with)
without:cycle(4)
check.equal(with:state_hash(), without:state_hash())

-- What is gone is left out afterwards, and told once.
for _, m in ipairs { whole, kept } do
    m:blocks { id = 3 }:delete()
    m:cycle(8)
end
kept:save(FILE)
kept = talus.restore(FILE, { histories = { steps = steps } })
for _, m in ipairs { whole, kept } do
    m:cycle(9)
    m:history { name = "open", remove = true }
    m:history { name = "open", value = "open" }
end
check.equal(text(kept), text(whole))
check.raises(function() kept:history { name = "kinetic", value = "kinetic" } end, "there is one of that name")

-- A save in the middle of a run has the sample of its step.
do
    local m = scene()
    m:history { name = "kinetic", every = 1, value = "kinetic" }
    m:solve { ratio = 1e-12, max_cycles = 20, every = 7, on_progress = function(model)
        if model.cycles == 7 then
            model:save(FILE)
        end
    end }
    local r = talus.restore(FILE)
    check.equal(#r:histories().kinetic.cycle, 8)
    r:cycle(m.cycles - 7)
    check.equal(text(r), text(m))
end

-- The functions of histories are the script's.
do
    local m = scene()
    m:history { name = "roof", every = 2, value = function(model) return model.time end }
    m:history { name = "kinetic", every = 2, value = "kinetic" }
    m:cycle(3)
    m:save(FILE)
    local function time(model) return model.time end
    check.raises(function() talus.restore(FILE) end, "history 'roof' samples a function, which has to be given again")
    check.raises(function() talus.restore(FILE, { histories = { rof = time, roof = time } }) end, "there was no history 'rof'")
    check.raises(function() talus.restore(FILE, { histories = { roof = time, kinetic = time } }) end, "sampled no function")
    check.raises(function() talus.restore(FILE, { histories = { roof = 3 } }) end, "needs a function(model), or false, not the number 3")
    check.raises(function() talus.restore(FILE, { histories = { roof = true } }) end, "needs a function(model), or false")
    check.raises(function() talus.restore(FILE, { histories = { time } }) end, "the name of no history")
    check.raises(function() talus.restore(FILE, { histories = time }) end, "must be a table of functions by name")
    check.raises(function() talus.resumed { histories = 7 } end, "must be a table of functions by name")
    local r = talus.restore(FILE, { histories = { roof = false } })
    check.equal(r:histories().roof, nil)
    check.equal(#r:histories().kinetic.value, 2)
    r:cycle(3)
    check.equal(#r:histories().kinetic.value, 4)
    r = talus.restore(FILE, { histories = { roof = time, kinetic = false } })
    m:cycle(5)
    r:cycle(5)
    check.equal(table.concat(r:histories().roof.value, " "), table.concat(m:histories().roof.value, " "))
    check.equal(r:histories().kinetic, nil)
    r = talus.restore(FILE, { histories = { roof = function() return 1, 2 end } })
    check.equal((select(2, pcall(r.cycle, r, 2))):match "must give as many each time", "must give as many each time")
    local bare = scene()
    bare:save(FILE)
    check.equal(next(talus.restore(FILE):histories()), nil)
end

-- Copies in a loop, with their histories, are let go of.
do
    local m = scene()
    m:history { name = "roof", every = 1, value = function(model) return model.time end }
    for _ = 1, 50 do
        local twin <close> = m:copy()
        twin:cycle(1)
        check.equal(#twin:histories().roof.value, 2)
    end
    check.equal(#m:histories().roof.value, 1)
end
