-- Loads and drives: point loads and moments, prescribed motion by vectors and by functions.
local talus = require "talus"
local check = require "check"

local DT = 1e-3

local function free_box(rotation)
    local model = talus.model { gravity = { 0, 0, 0 }, rotation = rotation }
    model:generate("box", { min = { -1, -0.5, -0.5 }, max = { 1, 0.5, 0.5 }, density = 1000 })
    model:joint("*", "elastic", { kn = 1e6, ks = 1e6 })
    model:timestep { dt = DT }
    return model, model:blocks()
end

-- A force at the centroid accelerates; one aside turns too: M = arm x F, w' = M / I.
local model, box = free_box()
check.equal(box:load { force = { 2000, 0, 0 } }, box)
model:cycle(1)
-- The first kick from rest is half a step.
check.near(box[1].velocity, { 1 * DT / 2, 0, 0 }, 1e-16)
model:cycle(999)
check.near(box[1].velocity, { 999.5 * DT, 0, 0 }, 1e-12)
check.near(box[1].displacement, { 0.5, 0, 0 }, 1e-12)
check.near(box[1].angular_velocity, { 0, 0, 0 }, 0)

model, box = free_box()
box:load { force = { 0, 0, 300 }, at = { 1, 0, 0 }, moment = { 50, 0, 0 } }
model:cycle(1)
-- I = m/12 (a^2 + b^2): 2000/12 * 2 about x, 2000/12 * 5 about y; M = (50, -300, 0).
-- Tolerance: free motion within the step couples the axes, second order in dt.
check.near(box[1].angular_velocity, { 50 / (2000 / 6) * DT / 2, -300 / (10000 / 12) * DT / 2, 0 }, 1e-10)
check.near(box[1].velocity, { 0, 0, 0.15 * DT / 2 }, 1e-17)
check.near(box[1].moment, { 50, -300, 0 }, 1e-10)

-- The point of action goes with the body: an arm along +z has, a quarter of a turn later, come to lie
-- along +x, where a force along x has no moment.
model, box = free_box()
box:load { force = { 1e-3, 0, 0 }, at = { 0, 0, 1 } }
box:set { angular_velocity = { 0, math.pi / 2, 0 } }
model:cycle(1)
check.near(box[1].moment, { 0, 1e-3, 0 }, 1e-15)
model:cycle(1000)
-- Tolerance: the load has turned the box by 1e-3 / 833 / 2.
check.near(box[1].moment, { 0, 0, 0 }, 2e-9)

-- A load is in the place of the one before; an empty one takes it off.
model, box = free_box()
box:load { force = { 10, 0, 0 } }:load { force = { 0, 20, 0 } }
model:cycle(1)
check.near(box[1].force, { 0, 20, 0 }, 0)
box:load {}
model:cycle(1)
check.near(box[1].force, { 0, 0, 0 }, 0)
check.near(box[1].moment, { 0, 0, 0 }, 0)

check.refused(model, function() box:load() end, "load{} takes the load off")
check.refused(model, function() box:load { forces = { 0, 0, 0 } } end, "did you mean 'force'?")
check.refused(model, function() box:load { force = 3 } end, "force must be")
check.refused(model, function() box:load { force = { 1, 2 } } end, "force must be")
check.refused(model, function() box:load { force = { 0, 0 / 0, 0 } } end, "force.y = nan")
check.refused(model, function() box:load { at = { 0, 0, 1 / 0 } } end, "at.z = inf")
check.refused(model, function() box:load({}, 1) end, "1 argument too many")

-- ---------------------------------------------------------------- drives

-- A constant velocity is kept, whatever pushes; rotation is held unless given.
model, box = free_box()
box:load { force = { 0, 0, 1e6 } }
check.equal(box:drive { velocity = { 0.1, 0, 0 } }, box)
check.equal(box[1].fixed, true)
model:cycle(500)
check.near(box[1].displacement, { 500 * DT * 0.1, 0, 0 }, 1e-14)
check.near(box[1].velocity, { 0.1, 0, 0 }, 0)
check.near(box[1].rotation, { 1, 0, 0, 0 }, 0)
box:load {}:free()
check.equal(box[1].fixed, false)
model:cycle(100)
-- It goes on as it was.
check.near(box[1].velocity, { 0.1, 0, 0 }, 1e-16)

-- An angular velocity turns about the centroid.
model, box = free_box()
box:drive { angular_velocity = { 0, 0, 0.5 } }
model:cycle(1000)
local q = box[1].rotation
check.near(2 * math.atan(q[4], q[1]), 0.5, 1e-12)
check.near(box[1].displacement, { 0, 0, 0 }, 0)

-- A function is asked for the middle of each step: its integral by the midpoint rule, in a table or
-- in three numbers.
local function shake(t)
    return 0.3 * math.sin(7 * t)
end
for _, motion in ipairs { function(t) return { shake(t), 0, 2 * t } end,
    function(t) return shake(t), 0, 2 * t end } do
    model, box = free_box()
    local times = {}
    box:drive { velocity = function(t)
        times[#times + 1] = t
        return motion(t)
    end, angular_velocity = function(t) return 0, 0, t end }
    model:cycle(300)
    check.equal(#times, 300)
    local u = 0
    for i, t in ipairs(times) do
        check.near(t, (i - 0.5) * DT, 1e-12)
        u = u + shake(t) * DT
    end
    check.near(box[1].displacement, { u, 0, (300 * DT) ^ 2 }, 1e-14)
    -- The integral itself, to the midpoint rule's (w dt)^2 / 24.
    check.near(u, 0.3 / 7 * (1 - math.cos(7 * 0.3)), 3e-7)
    q = box[1].rotation
    check.near(2 * math.atan(q[4], q[1]), 0.3 ^ 2 / 2, 1e-12)
end

-- A shaking table carries the block on it along.
model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { 0, 0, -1 }, max = { 3, 3, 0 }, density = 2000, group = "table" })
model:generate("box", { min = { 1, 1, 0 }, max = { 2, 2, 0.5 }, density = 2000, group = "block" })
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 40 })
model:damping("viscous", { alpha = 1 })
local base, block = model:blocks { group = "table" }, model:blocks { group = "block" }
base:drive { velocity = function(t) return 0.05 * math.sin(2 * t), 0, 0 end }
model:solve { ratio = 0, max_time = 0.5 }
check.near(block[1].displacement[1], base[1].displacement[1], 1e-5)
check.holds(base[1].displacement[1] > 5e-3, "the table has moved")

-- Errors in a function end the run after that step, in which the bodies go on as before, and keep their
-- own place.
local calls
local function broken(what)
    calls = 0
    model, box = free_box()
    box:drive { velocity = function(t)
        calls = calls + 1
        if calls == 5 then
            return what(t)
        end
        return 1, 0, 0
    end }
    return model
end
local m = broken(function() error("my own trouble") end)
local message = select(2, pcall(m.cycle, m, 100))
check.holds(message:find("test_loads.lua:%d+: my own trouble"), message)
check.equal(m.cycles, 5)
check.near(m:blocks()[1].displacement[1], 5 * DT, 1e-15)
m:cycle(10) -- the function is well again
check.equal(m.cycles, 15)
local thing = {}
m = broken(function() error(thing) end)
local _, raised = pcall(m.solve, m, { ratio = 0, max_cycles = 50 })
check.equal(raised, thing)
local bad = {
    { function() end, "must give three finite numbers: it gave 0 values" },
    { function() return 1 end, "it gave the number 1" },
    { function() return 1, 2 end, "it gave 2 values" },
    { function() return { 1, 2 } end, "it gave a list of 2" },
    { function() return { 1, 2, "x" } end, "it gave the string 'x'" },
    { function() return 1, 0 / 0, 2 end, "it gave not a number (NaN)" },
    { function() return 1, 2, 1 / 0 end, "it gave the number inf" },
}
for _, case in ipairs(bad) do
    m = broken(case[1])
    message = select(2, pcall(m.cycle, m, 100))
    check.holds(message:find("test_loads.lua:%d+: drive: velocity%(0.0045%)"), message)
    check.holds(message:find(case[2], 1, true), message)
end

-- What would change drives or blocks under the run's feet is refused there.
for _, case in ipairs {
    { function(s) s:free() end, "cannot free blocks from a drive's function" },
    { function(s) s:fix() end, "cannot fix blocks from a drive's function" },
    { function(s) s:drive { velocity = { 0, 0, 0 } } end, "cannot drive blocks from a drive's function" },
    { function(s) s:delete() end, "while the model is running" },
    { function(s) s:join() end, "while the model is running" },
    { function() model:cycle(1) end, "cannot be called from a function that a run has called" },
    { function() model:generate("box", { min = { 5, 5, 5 }, max = { 6, 6, 6 }, density = 1 }) end,
        "while the model is running" },
} do
    model, box = free_box()
    box:drive { velocity = function()
        case[1](box)
        return 0, 0, 0
    end }
    message = select(2, pcall(model.cycle, model, 3))
    check.holds(message:find(case[2], 1, true), message)
    check.equal(model.cycles, 1)
end
-- Other models may run in it.
model, box = free_box()
local other, other_box = free_box()
other_box:drive { velocity = function(t) return 2 * t, 0, 0 end }
box:drive { velocity = function()
    other:cycle(1)
    return 1, 0, 0
end }
model:cycle(10)
check.equal(other.cycles, 10)
check.near(other_box[1].displacement[1], (10 * DT) ^ 2, 1e-16)

check.refused(model, function() box:drive() end, "give velocity, angular_velocity or both")
check.refused(model, function() box:drive {} end, "give velocity, angular_velocity or both")
check.refused(model, function() box:drive { velocty = { 0, 0, 0 } } end, "did you mean 'velocity'?")
check.refused(model, function() box:drive { velocity = 3 } end, "a list of 3 numbers or a function(t)")
check.refused(model, function() box:drive { velocity = { 1, 2 } } end, "velocity must be")
check.refused(model, function() box:drive { angular_velocity = { 0, 0, 1 / 0 } } end, "inf")
check.refused(model, function() box:drive({ velocity = { 0, 0, 0 } }, 1) end, "1 argument too many")

-- A function is let go when its drive ends: by another drive, fix, free or delete, or with the model.
local function watched(end_it)
    local alive = setmetatable({}, { __mode = "k" })
    local the_model, the_box = free_box()
    do
        local token = { the_model } -- the function refers to its model
        local function motion()
            return #token, 0, 0
        end
        alive[motion] = true
        the_box:drive { velocity = motion }
        the_model:cycle(3)
    end
    collectgarbage()
    check.holds(next(alive), "kept while it drives")
    the_model:cycle(3)
    end_it(the_box)
    the_model, the_box = nil, nil
    collectgarbage()
    collectgarbage()
    check.holds(not next(alive), "let go")
end
local kept = {}
local function keep(f)
    return function(s)
        kept[#kept + 1] = s -- the model lives on
        f(s)
    end
end
watched(keep(function(s) s:free() end))
watched(keep(function(s) s:fix() end))
watched(keep(function(s) s:drive { velocity = { 0, 0, 0 } } end))
watched(keep(function(s) s:delete() end))
watched(function() end)

-- A refused or empty drive keeps nothing either.
do
    local alive = setmetatable({}, { __mode = "k" })
    model, box = free_box()
    local function empty_and_refused()
        local motion = function() return 0, 0, 0 end
        alive[motion] = true
        model:blocks { group = "nothing" }:drive { velocity = motion }
        pcall(box.drive, box, { velocity = motion, angular_velocity = 3 })
    end
    empty_and_refused()
    box:free()
    collectgarbage()
    check.holds(not next(alive), "let go")
end

-- The parts of a driven block that is cut follow the same function.
model, box = free_box()
local asked = 0
box:drive { velocity = function(t)
    asked = asked + 1
    return t, 0, 0
end }
model:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 0, 0, 0 } })
check.equal(#model:blocks(), 2)
model:cycle(10)
check.equal(asked, 10)
for _, part in ipairs(model:blocks()) do
    check.near(part.velocity, { 9.5 * DT, 0, 0 }, 1e-16)
end
model:blocks { id = model:blocks()[1].id }:delete()
model:cycle(1)
check.equal(asked, 11)
model:blocks():delete()
check.equal(#model:blocks(), 0)

-- Fields and reports.
model, box = free_box()
check.equal(model.mass_scaled, false)
model:mass_scaling(true)
check.equal(model.mass_scaled, true)
check.equal(model:mass_scaling().on, true)
check.equal(model:mass_scaling().dt, nil)
check.refused(model, function() model:mass_scaling(1) end, "on must be true or false")
check.raises(function() model.mass_scaled = true end, "model:mass_scaling(true)")
model:mass_scaling(false)
check.near(model:timestep().dt, DT, 0)
model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2000, group = "base" })
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000, group = "cube" })
model:blocks { group = "base" }:fix()
check.raises(function() model:timestep() end, "no time step follows")
model:joint("*", "elastic", { kn = 1e8, ks = 5e7 })
local report = model:timestep()
local cube = model:blocks { group = "cube" }[1]
check.equal(report.block, cube)
check.near(report.mass, 2000, 1e-9)
check.near(report.stiffness, 1e8, 1e-3)
-- The cube's mass, and its moment 2000 / 6 with the points of a patch of 1 m2 half a metre below: r^2 is 5/12.
check.near(report.dt, 0.5 * 2 * math.sqrt(1 / (2 * 1e8 * (1 / 2000 + (5 / 12) / (2000 / 6)))), 1e-12)
model:timestep { rule = "paper" } -- with the fraction 0.1
report = model:timestep()
check.equal(report.block, cube)
check.near(report.dt, 0.1 * 2 * math.sqrt(2000 / (2 * 1e8)), 1e-12)
check.near(report.dt, model.dt, 0)
check.holds(report.message:find("^block " .. cube.id .. " controls the step"), report.message)
model:timestep { rule = "body" }
check.equal(model:timestep().block, cube)
check.equal(model:timestep().partner, nil)
