-- What a model costs: phases in time, memory in bytes, and that asking changes nothing.
local talus = require "talus"
local check = require "check"

local PHASES = { "detect", "timestep", "laws", "gather", "damping", "move", "energy" }

-- Three boxes on a held one, one of them in the air.
local function build(count)
    local model = talus.model {}
    model:generate("box", { min = { -1, -1, -1 }, max = { 9, 1, 0 }, density = 2000 })
    model:blocks():fix()
    for i = 1, count or 3 do
        local x, z = 2 * i, i == 3 and 0.5 or 0
        model:generate("box", { min = { x, -0.5, z }, max = { x + 1, 0.5, z + 1 }, density = 2000 })
    end
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:damping "local"
    return model
end

-- Nothing before profiling began.
local model = build()
model:cycle(5)
local idle = model:profile()
check.equal(idle.steps, 0)
for _, phase in ipairs(PHASES) do
    check.equal(idle.seconds[phase], 0)
end

-- Every phase takes time, no more than the run took, and the counts are those of the model.
model:profile(true)
local run = model:cycle(200)
local cost, sum = model:profile(), 0
check.equal(cost.steps, 200)
for _, phase in ipairs(PHASES) do
    check.holds(cost.seconds[phase] > 0, phase .. " takes time")
    sum = sum + cost.seconds[phase]
end
check.holds(sum <= run.wall, "the phases take no more than the run")
check.equal(cost.contacts, #model:contacts())
check.equal(cost.loaded, 2)
check.holds(cost.points >= 4 * cost.loaded, "a face contact has at least four points")
check.holds(cost.pairs >= cost.contacts, "every contact is of a pair")

-- Ended, it counts no more; begun again, it counts from zero.
model:profile(false)
model:cycle(3)
check.equal(model:profile().steps, 200)
model:profile(true)
model:cycle(3)
check.equal(model:profile().steps, 3)

-- The same bits with and without.
local plain, timed = build(), build()
timed:profile(true)
plain:cycle(50)
timed:cycle(50)
check.equal(plain:state_hash(), timed:state_hash())

-- The total is the sum of the parts; blocks and their shapes count before the first step, contacts after.
local function total(bytes)
    local parts = 0
    for name, value in pairs(bytes) do
        check.holds(math.type(value) == "integer" and value >= 0, name .. " is a count of bytes")
        parts = parts + (name ~= "total" and value or 0)
    end
    check.equal(bytes.total, parts)
end
local fresh = build()
local before = fresh:memory()
total(before)
check.holds(before.blocks > 0 and before.bodies > 0 and before.shapes > 0)
check.equal(before.points, 0)
fresh:cycle(1)
local after = fresh:memory()
total(after)
for _, part in ipairs { "step", "broad", "pairs", "contacts", "facets", "points", "index" } do
    check.holds(after[part] > 0, part .. " takes room after a step")
end
check.holds(build(2):memory().shapes < before.shapes, "a block less is a shape less")

check.raises(function() model:profile(1) end, "profile")
check.raises(function() model:memory(1) end, "memory")

-- States that a law with its parameters has no use for take no room, and begin when it has: slip under dilation opens
-- the joint, and the opening stays when dilation is taken back.
local function slide(dilation)
    local slides = build(1)
    slides:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 10, dilation = dilation })
    slides:cycle(200)
    return slides, slides:memory().points
end
local plain, without = slide(0)
local _, with = slide(5)
check.holds(without < with, "no column for what stays 0")
plain:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 10, dilation = 5 })
local moving = plain:blocks { fixed = false }
moving:load { force = { 6000, 0, 0 } }
local before = moving:bounds().max[3]
plain:cycle(100)
check.equal(plain:memory().points, with)
check.holds(moving:bounds().max[3] > before + 1e-6, "slip under dilation lifts the block")
plain:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 10 })
plain:cycle(1)
check.holds(plain:memory().points > with, "how far walls are moved by what slip has opened")
