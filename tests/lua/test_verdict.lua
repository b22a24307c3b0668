-- The verdict: what has but closed its joints is at rest and has not moved, at any stiffness; what slides on has failed, and moves on; a stage
-- begins to count anew. To ask changes nothing, and copies and files give the same.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local talus = require "talus"
local verdicts = require "verdicts"

local folder = assert(os.getenv "TALUS_TEST_TMP")

-- tests/verify/long/verdicts.lua tries many more.
for seed = 1, check.cases(24) do
    check.equal(verdicts.stands(seed), nil)
    check.equal(verdicts.slides(seed), nil)
    check.equal(verdicts.cuts(seed), nil)
end

local function joint(model, kn, friction)
    model:joint("*", "coulomb", { kn = kn, ks = kn, friction = friction })
end

-- A block on a slope of 30 degrees: it stands, then its joint is made weaker.
local function slope(friction)
    local model = talus.model { gravity = { 5, 0, -8.66 } }
    model:generate("box", { min = { -9, -9, -1 }, max = { 9, 9, 0 }, density = 2500 })
    model:generate("box", { min = { -1, -1, 0 }, max = { 1, 1, 1 }, density = 2500 })
    model:blocks { id = 1 }:fix()
    joint(model, 1e9, friction)
    model:damping "local"
    return model
end

local model = slope(40)
model:cycle(3)
check.equal(model:verdict().standing, "accelerating")
model:solve { ratio = 1e-5 }
check.equal(model:verdict().standing, "at rest")
model:stage "weaker"
joint(model, 1e9, 20)
check.equal(model:solve { ratio = 1e-5, stop_at_failure = true }.reason, "failure")
local failed = model:verdict()
check.equal(failed.standing, "failed")
check.equal(failed.moved, 1)
check.equal(failed.farthest, 2)
check.near(failed.volume, 4, 1e-12)
check.holds(failed.direction[1] > 0.999, "the direction is downhill")
check.near(failed.slip, failed.displacement, 1e-4 * failed.slip)
check.equal(failed.slipping, 1)
check.holds(failed.text:find('failed: 1 block (4 m3) has moved since stage "weaker", towards 090/00, block 2 the farthest', 1, true), failed.text)

-- A block of zones that slides on a rigid one is told as sliding, and by how much: its contacts are by segments.
local function slope_of_zones(friction)
    local zoned = slope(friction)
    zoned:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
    zoned:blocks { id = 2 }:deformable { zone = 0.5, solid = "rock" }
    return zoned
end

local zoned = slope_of_zones(40)
zoned:cycle(3)
check.equal(zoned:verdict().standing, "accelerating")
zoned:solve { ratio = 1e-5 }
local stands = zoned:verdict()
check.equal(stands.contacts, 1)
check.equal(stands.moved, 0)
check.near(stands.slip, zoned:contacts()[1].shear_displacement[1], 1e-6 * stands.slip)
zoned:stage "weaker"
check.holds(zoned:verdict().slip < stands.slip, "what has slipped before a stage does not count")
joint(zoned, 1e9, 20)
zoned:cycle(4000)
local slides = zoned:verdict()
check.equal(slides.moved, 1)
check.equal(slides.farthest, 2)
check.equal(slides.contacts, 1)
check.equal(slides.slipping, 1)
check.near(slides.slip, slides.displacement, 1e-4 * slides.slip)
check.equal(slides.text:match "; largest slip [%d.]+ m%.$" ~= nil, true)

-- Displacements of zones count from a stage as those of the rigid block do that they lie on: both go down together.
local both = slope_of_zones(40)
both:blocks { id = 1 }:drive { velocity = { 0, 0, -10 } }
both:cycle(2000)
local went = both:verdict()
check.holds(went.displacement > 1, "both blocks go down")
local before = went.slip
both:stage "on"
both:cycle(1)
check.holds(both:verdict().slip < 1e-2 and before < 1e-1 and both:verdict().opening < 1e-2, both:verdict().text)

-- A block of zones that nothing bears accelerates, as a rigid one does.
for _, zones in ipairs { false, true } do
    local falls = talus.model { gravity = { 0, 0, -10 } }
    falls:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    falls:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
    if zones then falls:blocks():deformable { zone = 0.5, solid = "rock" } end
    joint(falls, 1e9, 30)
    falls:cycle(50)
    check.equal(falls:verdict().standing, "accelerating")
end

-- The same of a copy and from a file; to ask changes nothing.
local twin = model:copy()
model:save(folder .. "/verdict.talus")
local restored = talus.restore(folder .. "/verdict.talus")
check.equal(twin:verdict().text, failed.text)
check.equal(restored:verdict().text, failed.text)
model:cycle(20)
model:verdict()
model:cycle(20)
twin:cycle(40)
check.equal(model:state_hash(), twin:state_hash())

-- A stage begins to count anew; laws keep what they have.
local hash = model:state_hash()
model:stage ""
check.equal(model:verdict().stage, "")
check.equal(model:verdict().moved, 0)
check.equal(model:verdict().slip, 0)
check.equal(model:verdict().standing, "failed")
model:cycle(500)
check.equal(model:verdict().moved, 1)

-- Names that are none change nothing.
for _, name in ipairs { ("x"):rep(64), "two\nlines", "\xff" } do
    local before = model:verdict().displacement
    check.raises(function() model:stage(name) end, "must be one line of UTF-8 of at most 63 bytes")
    check.equal(model:verdict().displacement, before)
end
check.raises(function() model:stage() end, "stage")
check.holds(hash ~= nil, "a model has a hash")

-- What opens is told as opening: two blocks drawn apart.
local apart = talus.model { gravity = { 0, 0, 0 } }
apart:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 }, { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500 } })
apart:blocks { id = 1 }:fix()
apart:joint("*", "elastic", { kn = 1e7, ks = 1e7 })
apart:damping "local"
apart:blocks { id = 2 }:load { force = { 0, 0, 1e5 } }
apart:solve { ratio = 1e-6 }
check.near(apart:verdict().opening, 0.01, 1e-6)

-- What turns about its edge has moved, at rest or failed, however far the edge sinks in; so has a small block on a large one that is held, and one
-- that has been joined to a fresh one.
local function on_base(gravity, wide, deep)
    local leaning = talus.model { gravity = gravity }
    leaning:generate("box", { min = { -wide, -wide, -deep }, max = { wide, wide, 0 }, density = 2500 })
    leaning:blocks():fix()
    leaning:damping "local"
    return leaning
end
local leaning = on_base({ 2.84, 0, -9 }, 3, 1)
leaning:generate("box", { min = { 0, 0, 0 }, max = { 0.93, 1, 4.47 }, density = 2500 })
joint(leaning, 5e7, 45)
check.equal(leaning:solve { stop_at_failure = true }.reason, "failure")
check.equal(leaning:verdict().moved, 1)
leaning = on_base({ 4, 0, -9 }, 4, 1)
leaning:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 4 }, density = 2500 }, { min = { 1.1, 0, 0 }, max = { 2.1, 1, 4 }, density = 2500 } })
leaning:blocks { id = 3 }:fix()
joint(leaning, 1e8, 50)
leaning:solve {}
check.equal(leaning:verdict().standing, "at rest")
check.equal(leaning:verdict().moved, 1)
local small = on_base({ 6, 0, -8 }, 100, 200)
small:generate("box", { min = { 0, 0, 0 }, max = { 0.2, 0.2, 0.2 }, density = 2500 })
joint(small, 1e9, 20)
small:cycle(400)
check.equal(small:verdict().moved, 1)
small:generate("box", { min = { 0, 0.5, 0 }, max = { 0.2, 0.7, 0.2 }, density = 2500 })
small:blocks { where = function(b) return not b.fixed end }:join()
check.equal(small:verdict().moved, 1)

-- Many blocks on end, each on a soft joint, have slid, and not settled, from a hundredth of their size on; a corner that sinks in as it turns over is
-- no joint that closes.
local row = on_base({ 6, 0, -8 }, 60, 2)
for i = 0, 29 do
    row:generate("box", { min = { i, 0, 0 }, max = { i + 1, 1, 1 }, density = 2500 })
end
joint(row, 1e7, 30)
row:damping("local", { alpha = 0.1 })
row:cycle(80)
check.equal(row:verdict().moved, 30)
local soft = on_base({ 4, 0, -9 }, 4, 1)
soft:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 4 }, density = 2500 })
joint(soft, 1e6, 60)
soft:cycle(200)
check.equal(soft:verdict().moved, 1)

-- Of a body that slides and leans the same is said, however many parts it has.
local function divided(cuts)
    local body = talus.model { gravity = { 4.5, 0, -10 } }
    body:generate("box", { min = { -5, -5, -1 }, max = { 9, 9, 0 }, density = 2600 })
    body:blocks():fix()
    for i = 1, #cuts - 1 do
        body:generate("box", { min = { cuts[i], 0, 0 }, max = { cuts[i + 1], 3, 2.9 }, density = 2600, group = "body" })
    end
    body:blocks { group = "body" }:join()
    body:joint("*", "coulomb", { kn = 1.3e8, ks = 1e8, friction = 16 })
    body:damping "local"
    local said = {}
    for stage = 1, 6 do
        body:cycle(50)
        said[stage] = body:verdict()
    end
    return said
end
local whole = divided { 0, 1.6 }
for _, cuts in ipairs { { 0, 0.8, 1.6 }, { 0, 0.2, 1.5, 1.6 }, { 0, 0.4, 0.8, 1.2, 1.6 } } do
    for stage, said in ipairs(divided(cuts)) do
        check.equal(said.moved, whole[stage].moved)
        check.near(said.slip, whole[stage].slip, 0.06 * whole[stage].slip + 1e-5) -- each part presses as itself
    end
end

-- What has moved by less than a twentieth of the farthest is not told with it, and next to nothing is none.
local function flying(speeds)
    local free = talus.model { gravity = { 0, 0, 0 } }
    for i = 1, #speeds do
        free:generate("box", { min = { 3 * i, 0, 0 }, max = { 3 * i + 1, 1, 1 }, density = 2500 })
        free:blocks { id = i }:set { velocity = { 0, speeds[i], 0 } }
    end
    joint(free, 1e8, 30)
    free:timestep { dt = 1e-3 }
    free:cycle(100)
    return free:verdict().moved
end
check.equal(flying { 1, 0.3, 0.06, 0.04 }, 3)
check.equal(flying { 0.02 }, 1)
check.equal(flying { 0.005 }, 0)

-- A column on soft joints sinks by more than a hundredth of its blocks: each joint has but closed.
local column = on_base({ 0, 0, -10 }, 3, 1)
for k = 0, 9 do
    column:generate("box", { min = { 0, 0, k }, max = { 2, 2, k + 1 }, density = 2500 })
end
joint(column, 2.5e7, 30) -- 2.5e5 Pa press the lowest by 10 mm
column:solve { ratio = 1e-5 }
check.near(column:verdict().displacement, 0.055, 1e-3)
check.equal(column:verdict().moved, 0)

-- Without a solve a model is at rest below a ratio of 1e-5; what friction slows down moves, and does not accelerate.
column = on_base({ 0, 0, -10 }, 3, 1)
column:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
joint(column, 1e8, 30)
repeat column:cycle(1) until column:verdict().ratio < 1e-2
check.holds(column:verdict().standing ~= "at rest", "it still settles")
repeat column:cycle(1) until column:verdict().ratio < 1e-6
check.equal(column:verdict().standing, "at rest")
column:blocks { id = 2 }:set { velocity = { 1, 0, 0 } }
column:damping "none"
column:cycle(50)
check.equal(column:verdict().standing, "moving")

-- Two bodies that meet on two faces: what opens on one is told, though as much closes on the other.
local groove = talus.model { gravity = { 0, 0, 0 } }
groove:generate("box", { min = { -2, 0, 0 }, max = { 2, 1, 2 }, density = 2500 })
for _, way in ipairs { 90, 270 } do
    groove:generate("joint", { joint = "V", dip = 30, dip_direction = way, origin = { 0, 0.5, 0.5 } })
end
local wedge = groove:blocks { containing = { 0, 0.5, 1.9 } }
groove:blocks { where = function(b) return b.id ~= wedge[1].id end }:join():fix()
groove:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
groove:damping "local"
wedge:load { force = { 1e5, 0, 0 } }
groove:solve { ratio = 1e-6 }
check.holds(groove:verdict().opening > 0.3 * groove:verdict().displacement, "one side opens")
