-- cycle and solve: limits, reasons, callbacks and their errors; joints, damping, time step.
local talus = require "talus"
local check = require "check"

-- A cube on a fixed slab, pressed down by its weight.
local function stack(threads)
    local model = talus.model { gravity = { 0, 0, -10 }, threads = threads }
    model:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2000, group = "base" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000, group = "cube" })
    model:blocks { group = "base" }:fix()
    return model
end

local function ready(threads)
    local model = stack(threads)
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:damping("local", { alpha = 0.8 })
    return model
end

-- A run needs a law; the message says where it lacks.
local bare = stack()
check.refused(bare, function() bare:cycle(1) end, "law")

-- cycle runs exactly so many steps.
local model = ready()
local result = model:cycle(10)
check.equal(result.reason, "cycles")
check.equal(result.cycles, 10)
check.equal(model.cycles, 10)
check.near(model.time, 10 * model.dt, 1e-12)
check.near(result.time, model.time, 1e-12)
check.holds(result.wall >= 0 and result.max_velocity > 0 and result.ratio > 0, "a full result")
check.equal(model:cycle(0).cycles, 0)

-- solve reaches equilibrium: the contact carries the cube's weight.
result = model:solve { ratio = 1e-6 }
check.equal(result.reason, "ratio")
check.holds(result.ratio < 1e-6, "ratio below the limit")
local contacts = model:contacts()
check.equal(#contacts, 1)
check.near(contacts:sum("normal_force"), 20000, 1)

-- Limits.
model = ready()
check.equal(model:solve { ratio = 0, max_cycles = 7 }.reason, "cycles")
check.equal(model.cycles, 7)
result = model:solve { ratio = 0, max_time = 20.5 * model.dt }
check.equal(result.reason, "time")
check.equal(result.cycles, 21)

-- Callbacks.
local calls, last = 0, nil
result = model:solve { ratio = 0, max_cycles = 100, every = 10, on_progress = function(m, r)
    check.equal(m, model)
    check.equal(math.type(r.cycles), "integer")
    check.holds(r.ratio >= 0 and r.time > 0 and r.wall >= 0 and r.max_velocity >= 0, "a full result")
    calls, last = calls + 1, r.cycles
end }
check.holds(calls >= 9 and calls <= 11, "one call every ten steps")
check.holds(last >= 90, "the last call at the end")
-- cycle calls back, too.
calls = 0
result = model:cycle(100, { every = 25, on_progress = function(m, r)
    check.equal(m, model)
    calls = calls + 1
    check.equal(r.cycles, 25 * calls)
    check.equal(r.measure, "local")
    check.holds(r.ratio >= 0 and r.time == m.time and r.wall >= 0 and r.max_velocity >= 0, "a full result")
end })
check.equal(calls, 4)
check.equal(result.reason, "cycles")
check.equal(result.cycles, 100)
calls = 0
model:cycle(1000, { on_progress = function() calls = calls + 1 end }) -- every 500 steps when it is not told
check.equal(calls, 2)
local started = model.cycles
check.raises(function()
    model:cycle(1000, { every = 10, on_progress = function() error("enough") end })
end, "enough")
check.equal(model.cycles, started + 10)
local target = model.cycles + 30
result = model:solve { ratio = 0, max_cycles = 1000, every = 10,
    stop = function(m) return m.cycles >= target end }
check.equal(result.reason, "stop")
check.equal(model.cycles, target)

-- An error in a callback ends the run after the step and keeps its own place and value.
local before = model.cycles
check.raises(function()
    model:solve { ratio = 0, max_cycles = 1000, every = 1, stop = function(m) return m.cyles > 1 end }
end, "a model has no field 'cyles'; did you mean 'cycles'?")
check.holds(model.cycles <= before + 2, "the run ended")
check.raises(function()
    model:solve { ratio = 0, max_cycles = 1000, every = 1, on_progress = function() error("enough") end }
end, "enough")
local value = {}
local good, thrown = pcall(function()
    model:solve { ratio = 0, max_cycles = 1000, every = 1, on_progress = function() error(value) end }
end)
check.equal(good, false)
check.equal(thrown, value)
check.equal(model:cycle(1).cycles, 1)

-- Inside a callback blocks are neither made nor deleted, and no second run begins.
local refusals = {}
model:solve { ratio = 0, max_cycles = 1, every = 1, stop = function(m)
    for _, attempt in ipairs {
        function() m:generate("box", { min = { 5, 5, 5 }, max = { 6, 6, 6 }, density = 1 }) end,
        function() m:blocks { group = "cube" }:delete() end,
        function() m:cycle(1) end,
    } do
        refusals[#refusals + 1] = select(2, pcall(attempt)) or "no error"
    end
end }
check.equal(#refusals, 3)
for _, message in ipairs(refusals) do
    check.holds(message:find("running", 1, true) or message:find("a run has called", 1, true),
        "refused because of the callback, not: " .. message)
end
check.equal(#model:blocks(), 2)

-- A change of one property keeps law and forces.
model = ready()
model:solve { ratio = 1e-6 }
local force = model:contacts():sum("normal_force")
model:joint("*", { kn = 2e8 })
model:cycle(1)
check.near(model:contacts():sum("normal_force"), force, 1e-3 * force)

-- Time step.
model:timestep { fraction = 0.05 }
local half = model.dt
model:timestep { fraction = 0.1 }
check.near(model.dt / half, 2, 1e-12)
model:timestep { rule = "body", fraction = 0.1 }
check.holds(model.dt > 0, "a step by the body rule")
model:timestep { dt = 1e-5 }
check.near(model.dt, 1e-5, 0)
model:contact_area { fraction = 0.02 }
model:contact_area { absolute = 0.01 }

-- Wrong input of every kind.
local function refused(f, part)
    check.refused(model, f, part)
end
refused(function() model:cycle() end, "cycles")
refused(function() model:cycle(-1) end, "cycles = -1")
refused(function() model:cycle(1.5) end, "whole number, not the number 1.5")
refused(function() model:cycle("10") end, "not the string '10'")
refused(function() model:cycle(0 / 0) end, "cycles = nan")
refused(function() model:cycle(1, 2) end, "cycle: the parameters must be a table, not the number 2")
refused(function() model:cycle(1, {}, 3) end, "1 argument too many")
refused(function() model:cycle(1, { evry = 3 }) end, "cycle: unknown parameter 'evry'; did you mean 'every'?")
refused(function() model:cycle(1, { cycles = 3 }) end, "cycle: unknown parameter 'cycles'")
refused(function() model:cycle(1, { every = 0 }) end, "every = 0")
refused(function() model:cycle(1, { on_progress = 3 }) end, "cycle: on_progress must be a function, not the number 3")
refused(function() model:cycle(1, { stop = function() end }) end, "unknown parameter 'stop'")
refused(function() model:solve { ratoi = 1 } end, "solve: unknown parameter 'ratoi'; did you mean 'ratio'?")
refused(function() model:solve { stopp = 1 } end, "did you mean 'stop'?")
refused(function() model:solve { ratio = -1 } end, "ratio = -1")
refused(function() model:solve { every = 0 } end, "every = 0")
refused(function() model:solve { max_time = 0 } end, "max_time = 0 s must be > 0")
refused(function() model:solve { stop = 3 } end, "stop must be a function, not the number 3")
refused(function() model:joint("*", "columb", { kn = 1, ks = 1 }) end, "did you mean 'coulomb'?")
refused(function() model:joint("J9", "coulomb", { kn = 1, ks = 1 }) end, "J9")
refused(function() model:joint("*", "coulomb", { kn = 1e7, ks = 1e7, friction = 95 }) end,
    "joint '*', law 'coulomb': friction = 95 deg is outside [0, 90]")
refused(function() model:joint("*", "coulomb", { kn = 1e7, ks = 0 / 0 }) end, "ks = nan")
refused(function() model:joint("*", "coulomb", { kn = 1e7, ks = 1e7, frction = 3 }) end,
    "did you mean 'friction'?")
refused(function() model:joint("*", "coulomb", { ks = 1e7 }) end, "'kn' is missing")
refused(function() model:joint("*", { tension = 3 }) end, "tension")
refused(function() model:joint("*") end, "give a law's name")
refused(function() model:joint("*", 3) end, "give a law's name")
refused(function() model:joint("*", 3, {}) end, "the law's name must be a string")
refused(function() model:joint(nil, "coulomb") end, "the joint's name must be a string, not nil")
refused(function() model:damping("locl", {}) end, "did you mean 'local'?")
refused(function() model:damping("local", { alfa = 0.8 }) end, "did you mean 'alpha'?")
refused(function() model:damping("local", { alpha = 2 }) end, "alpha = 2")
refused(function() model:damping() end, "the damping's name must be a string")
refused(function() model:timestep { fraction = 0 } end, "fraction = 0 is outside [1e-09, 2]")
refused(function() model:timestep { rule = "bodies" } end, "unknown rule 'bodies'")
refused(function() model:timestep { dt = -1 } end, "dt = -1 s is outside [1e-100, 1e+100]")
refused(function() model:contact_area { fraction = -1 } end, "fraction = -1")
refused(function() model:contact_area { fraction = 0.5, absolute = 0.1 } end, "fraction = 0.5 and absolute = 0.1 m2 are both given: give one")
refused(function() model:contact_area { joint = "J9" } end, "J9")
refused(function() model:insitu {} end, "give stress")
refused(function() model:insitu { strss = {} } end, "did you mean 'stress'?")
refused(function() model:insitu { stress = { xw = 1 } } end, "insitu, stress: unknown parameter 'xw'")
refused(function() model:insitu { stress = { xx = "a" } } end, "xx must be a number")
refused(function() model:insitu { stress = { xx = 0 / 0 } } end, "insitu, stress: xx = nan")
refused(function() model:insitu { stress = 3 } end, "must be a table")
refused(function() model:insitu { stress = { xx = 1 }, at = 3 } end, "at must be a list of 3 numbers")
refused(function() model:write_vtk() end, "the prefix must be a string")
refused(function() model:write_vtk("/proc/nowhere/run") end, "/proc/nowhere/run")

-- The same bits twice and on two threads.
local function digest(threads)
    local m = ready(threads)
    m:cycle(200)
    return m:state_hash()
end
local first = digest(1)
check.holds(first:match("^%x+$") and #first == 32, "32 hexadecimal digits")
check.equal(digest(1), first)
check.equal(digest(2), first)

-- Asking does not change the answer, nor does running in pieces.
local asked = ready(1)
for _ = 1, 20 do
    asked:cycle(10)
    check.holds(asked.dt > 0 and #asked:contacts() == 1 and asked:contacts():sum("area") > 0, "answers")
end
check.equal(asked:state_hash(), first)
