-- How a run ends: by one of three ratios, by velocity, by a steady failure, and what it says.
local talus = require "talus"
local check = require "check"

local DENSITY, K = 2000, 1e8

-- A block on a plane that dips by `dip`; gravity is tilted instead of the plane.
local function incline(dip, friction, damping, options)
    dip = math.rad(dip)
    local model = talus.model { gravity = { 10 * math.sin(dip), 0, -10 * math.cos(dip) } }
    model:generate("box", { min = { -5, -5, -1 }, max = { 50, 5, 0 }, density = DENSITY, group = "base" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY, group = "block" })
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = K, ks = K, friction = friction })
    model:damping(damping, options)
    return model, model:blocks { group = "block" }[1]
end

-- One that slides is seen to fail, and the run ends by that when it is asked to.
local model, block = incline(40, 30, "local")
local result = model:solve { max_cycles = 20000, stop_at_failure = true }
check.equal(result.reason, "failure")
check.equal(result.failing, block)
check.holds(result.cycles < 20000 and result.ratio > 1e-5, "before other limits")
check.holds(block.velocity[1] > 0, "it slides")
-- Not asked to end, the run goes on, and says so when it ends; the ratio need not be a limit.
model, block = incline(40, 30, "local")
local shown
result = model:solve { max_cycles = 6000, every = 1000, on_progress = function(_, r)
    shown = r.failing or shown
end }
check.equal(result.reason, "cycles")
check.equal(result.failing, block)
check.equal(shown, block)
result = incline(40, 30, "local"):solve { ratio = 0, max_cycles = 20000, stop_at_failure = true }
check.equal(result.reason, "failure")

-- One that holds settles; no failure is seen, whatever the damping.
for _, damping in ipairs { { "local" }, { "viscous", { alpha = 100 } }, { "adaptive" },
    { "combined" }, { "kinetic" } } do
    model = incline(20, 30, damping[1], damping[2])
    result = model:solve { ratio = 1e-6, max_cycles = 200000, stop_at_failure = true }
    check.equal(result.reason, "ratio")
    check.equal(result.failing, nil)
end

-- One that swings up and down without end neither settles nor fails.
model = incline(0, 40, "none")
result = model:solve { ratio = 1e-9, max_cycles = 8000, stop_at_failure = true }
check.equal(result.reason, "cycles")
check.equal(result.failing, nil)
check.holds(result.max_velocity > 1e-4, "it swings")

-- The three ratios. Two like blocks side by side, one of them loaded so that it takes longer: the
-- largest ratio is above the mean one.
local function pair()
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -5, -5, -1 }, max = { 50, 5, 0 }, density = DENSITY, group = "base" })
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY, group = "one" })
    m:generate("box", { min = { 3, 0, 0 }, max = { 4, 1, 4 }, density = DENSITY, group = "two" })
    m:blocks { group = "base" }:fix()
    m:joint("*", "coulomb", { kn = K, ks = K, friction = 30 })
    m:damping("local")
    return m
end
local ends = {}
for _, measure in ipairs { "average", "maximum", "local" } do
    model = pair()
    result = model:solve { ratio = 1e-4, measure = measure }
    check.equal(result.reason, "ratio")
    check.holds((measure == "average" and result.ratio or measure == "maximum" and result.ratio_maximum
        or result.ratio_local) < 1e-4, "below the limit")
    check.holds(result.ratio <= result.ratio_maximum, "the mean is at most the largest")
    ends[measure] = result.cycles
end
check.holds(ends.average <= ends.maximum, "the mean is there first")
-- By hand: unbalanced forces over contact forces of the two blocks.
model = pair()
result = model:cycle(60)
local ones = { model:blocks { group = "one" }[1], model:blocks { group = "two" }[1] }
local unbalanced, carried, largest, worst = 0, 0, 0, 0
for _, b in ipairs(ones) do
    local size = math.abs(b.force[3])
    local contact = b.mass * 10 + b.force[3]
    unbalanced, carried = unbalanced + size, carried + contact
    largest, worst = math.max(largest, size), math.max(worst, size / contact)
end
check.near(result.ratio, unbalanced / carried, 1e-6)
check.near(result.ratio_maximum, 2 * largest / carried, 1e-6)
check.near(result.ratio_local, worst, 1e-6)

-- By velocity.
model = incline(20, 30, "viscous", { alpha = 100 })
model:cycle(50)
result = model:solve { ratio = 0, velocity = 1e-5, max_cycles = 100000 }
check.equal(result.reason, "velocity")
check.holds(result.max_velocity < 1e-5 and result.cycles > 1, "slower than the limit")

check.refused(model, function() model:solve { measure = "mean" } end, "measure")
check.refused(model, function() model:solve { measure = 1 } end, "measure")
check.refused(model, function() model:solve { velocity = -1 } end, "velocity = -1")
check.refused(model, function() model:solve { stop_at_failure = 1 } end, "true or false")
check.refused(model, function() model:solve { stop_at_failur = true } end, "did you mean 'stop_at_failure'?")
