-- Deformable blocks between steps: asking after edits, saves after a change of the law, calls that fail.
local talus = require "talus"
local check = require "check"

-- Two cubes on each other; those of `deformable` have zones. `law`: of their joint.
local function cubes(deformable, law, parameters)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "low" },
        { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500, group = "high" } })
    model:joint("*", law or "coulomb", parameters or { kn = 1e9, ks = 1e9, friction = 30 })
    model:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
    model:blocks(deformable):deformable { zone = 0.7, solid = "rock" }
    model:cycle(5)
    return model
end

-- ---------------------------------------------------------------- blocks come and go

-- What segments do to bodies is known of those that there are: a new one is held by none, and others get other rows.
local model = cubes { group = "high" }
local before = model.dt
for i = 1, 40 do
    model:generate("box", { min = { 3 * i, 0, 0 }, max = { 3 * i + 1, 1, 1 }, density = 2000, group = "far" })
end
check.equal(model.dt, before)
local copy = model:copy()
check.equal(copy:state_hash(), model:state_hash())
model:cycle(3)
copy:cycle(3)
check.equal(copy:state_hash(), model:state_hash())

-- A rigid block below the others goes, and rows of bodies move; then one on which segments lie.
model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { { min = { 5, 0, 0 }, max = { 6, 1, 1 }, density = 2500, group = "aside" },
    { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "low" },
    { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500, group = "high" } })
model:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 30 })
model:solid("soft", "elastic", { young = 1e6, poisson = 0.25 })
model:blocks { group = "high" }:deformable { zone = 0.7, solid = "soft" }
model:cycle(5)
before = model.dt
model:blocks { group = "aside" }:delete()
check.equal(model.dt, before)
model:cycle(1)
check.equal(model.dt, before)
model:blocks { group = "low" }:delete()
check.holds(model.dt >= before)
check.equal(model:copy():state_hash(), model:state_hash())
model:cycle(5)

-- ---------------------------------------------------------------- another law

-- Before the next step the points of segments have no room for states of the new law.
model = cubes()
model:joint("*", "coulomb_tensile", { kn = 1e9, ks = 1e9, friction = 30, cohesion = 1e5, tension = 1e4 })
local file = os.tmpname()
model:save(file)
local restored = talus.restore(file)
os.remove(file)
check.equal(restored:state_hash(), model:state_hash())
model:cycle(5)
restored:cycle(5)
check.equal(restored:state_hash(), model:state_hash())

-- ---------------------------------------------------------------- a load that one of two blocks cannot take

model = cubes()
check.refused(model, function()
    model:blocks():load { force = { 1, 0, 0 }, at = { 0.5, 0.5, 0.2 } }
end, "lies in no zone of block 2")
