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

-- A block that goes far away lets faces be listed anew, and nothing else: a sliding block keeps its bits.
model = talus.model { gravity = { 5, 0, -8 } }
model:generate("box", { { min = { -1, -1, -0.6 }, max = { 4, 2, 0 }, density = 2500, group = "base" },
    { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "top" },
    { min = { 50, 0, 0 }, max = { 51, 1, 1 }, density = 2500, group = "far" } })
model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 20 })
model:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
model:blocks { group = "base" }:fix()
model:blocks { group = "far" }:fix()
local top = model:blocks { group = "top" }
top:deformable { zone = 0.5, solid = "rock" }
top:set { velocity = { 1, 0.2, 0 } }
for _ = 1, 40 do
    local other = model:copy()
    other:blocks { group = "far" }:delete()
    model:cycle(2)
    other:cycle(2)
    local one, two = top[1].velocity, other:blocks { group = "top" }[1].velocity
    for i = 1, 3 do
        check.equal(one[i], two[i])
    end
end

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

-- ---------------------------------------------------------------- copies and saves of what moves

local function restored_from(of)
    local name = os.tmpname()
    of:save(name)
    local made = talus.restore(name)
    os.remove(name)
    return made
end

-- Faces come to lie on others beside them. A copy finds them when the model does.
for seed = 1, 6 do
    model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 },
        { min = { 0, 0, 1 }, max = { 1.3, 1, 2 }, density = 2500 } })
    model:generate("joint", { joint = "J1", dip = 15 * seed, dip_direction = 50 * seed, origin = { 0.5, 0.5, 0.5 } })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    model:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
    model:blocks():deformable { zone = 0.6, solid = "rock" }
    model:blocks { inside = { min = { 0, 0, 1 }, max = { 2, 2, 2 } } }:set { velocity = { 0.1, 0.3, -0.1 } }
    model:cycle(3)
    local others = { model:copy(), restored_from(model) }
    model:cycle(8)
    for _, other in ipairs(others) do
        other:cycle(8)
        check.equal(other:state_hash(), model:state_hash())
    end
end

-- Blocks that meet by segments have no contact of edges beside, in a copy neither, when contacts are found anew.
for _, plane in ipairs { { 39, 39 }, { 75, 256 }, { 48, 9 } } do
    model = talus.model { gravity = { 0, 0, -9.81 } }
    model:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 },
        { min = { 0, 0, 1 }, max = { 1.3, 1, 2 }, density = 2500 } })
    model:generate("joint", { joint = "J1", dip = plane[1], dip_direction = plane[2], origin = { 0.5, 0.5, 0.5 } })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    model:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
    model:blocks():deformable { zone = 0.5, solid = "rock" }
    model:blocks():load { force = { 1e5, 2e5, 0 } }
    model:cycle(20)
    model:contact_area { fraction = 0.05 }
    local others = { model:copy(), restored_from(model) }
    for _, other in ipairs(others) do
        check.equal(other:state_hash(), model:state_hash())
    end
    model:cycle(2)
    for _, other in ipairs(others) do
        other:cycle(2)
        check.equal(other:state_hash(), model:state_hash())
    end
end

-- ---------------------------------------------------------------- saves after blocks have gone

model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 },
    { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500 } })
model:generate("joint", { joint = "J1", dip = 40, dip_direction = 90, origin = { 0.5, 0.5, 1.2 } })
model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
model:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
model:blocks():deformable { zone = 0.7, solid = "rock" }
model:blocks():set { velocity = { 0.1, 0, 0.1 }, angular_velocity = { 1, 0, 0 } }
model:cycle(50)
model:blocks { id = model:blocks()[1].id }:delete()
restored = restored_from(model)
check.equal(restored:state_hash(), model:state_hash())
model:blocks():load { force = { 1, 0, 0 } }
model:blocks():delete()
restored = restored_from(model)
restored:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
restored:cycle(2)

-- ---------------------------------------------------------------- a load that one of two blocks cannot take

model = cubes()
check.refused(model, function()
    model:blocks():load { force = { 1, 0, 0 }, at = { 0.5, 0.5, 0.2 } }
end, "lies in no zone of block 2")

-- ---------------------------------------------------------------- zones for a loaded block and one that has some

model = cubes { group = "high" }
model:blocks { group = "low" }:load { force = { 1, 0, 0 } }
check.refused(model, function() model:blocks():deformable { zone = 0.7, solid = "rock" } end, "it has zones already")

-- ---------------------------------------------------------------- contacts in the order of their blocks

-- Those of zones lie between those of rigid blocks.
model = talus.model { gravity = { 0, 0, -10 } }
local pile = {}
for i = 1, 6 do
    pile[i] = { min = { 0, 0, i - 1 }, max = { 1, 1, i }, density = 2500, group = i == 3 and "soft" or "hard" }
end
model:generate("box", pile)
model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
model:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
model:blocks { group = "soft" }:deformable { zone = 0.7, solid = "rock" }
model:cycle(2)
local ids = model:contacts():values "id"
check.equal(#ids, 5)
for i = 2, #ids do
    check.holds(ids[i] > ids[i - 1], "contacts are in the order of their blocks")
end
