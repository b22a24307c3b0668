-- Bodies of several blocks that lose blocks: what is left hangs together over shared faces, or parts.
local talus = require "talus"
local check = require "check"

local function row(count)
    local model = talus.model { gravity = { 0, 0, -10 } }
    for i = 1, count do
        model:generate("box", { min = { i - 1, 0, 0 }, max = { i, 1, 1 }, density = 2000 })
    end
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    return model
end

local bodies = require "bodies"

-- The middle of five goes: two bodies of two remain.
local model = row(5)
model:blocks():join()
check.equal(bodies(model:blocks()), 1)
model:blocks { id = 3 }:delete()
check.equal(bodies(model:blocks()), 2)
check.equal(model:blocks { id = 1 }[1].body, 1)
check.equal(model:blocks { id = 2 }[1].body, 1)
check.equal(model:blocks { id = 5 }[1].body, 4)
-- They fall freely, each as one.
model:blocks():set { velocity = { 0, 0, 0 } }
model:timestep { dt = 1e-3 }
model:cycle(100)
for _, block in ipairs(model:blocks()) do
    check.near(block.displacement[3], -10 * 0.1 ^ 2 / 2, 1e-12)
end

-- The end of four goes: three stay one body, and its centroid is theirs.
model = row(4)
model:blocks():join()
model:blocks():set { angular_velocity = { 0, 0, 1 } }
model:blocks { id = 4 }:delete()
check.equal(bodies(model:blocks()), 1)
-- each block still has the velocity it had as a part of the turning body: about x = 2, then x = 1.5
check.near(model:blocks { id = 2 }[1].velocity[2], -0.5, 1e-12)
check.near(model:blocks { id = 3 }[1].velocity[2], 0.5, 1e-12)

-- The face a deleted block lay on is a wall again: a block does not fall through it.
model = row(2)
model:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2000 })
model:generate("box", { min = { 0.2, 0.2, 2.0 }, max = { 0.8, 0.8, 2.6 }, density = 2000, group = "top" })
model:blocks { where = function(b) return b.group ~= "top" end }:join():fix()
model:blocks { id = 3 }:delete()
model:damping "local"
model:solve { ratio = 1e-4, max_cycles = 20000, max_time = 3 }
check.near(model:blocks { group = "top" }[1].centroid[3], 1.3, 1e-3)

-- A joint through a joined body parts it: what is left of each side hangs together.
model = row(3)
model:blocks():join()
model:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 1.5, 0, 0 } })
check.equal(#model:blocks(), 4)
check.equal(bodies(model:blocks()), 2)
check.near(model:blocks():sum("mass"), 6000, 1e-9)
local west = model:blocks { where = function(b) return b.centroid[1] < 1.5 end }
check.equal(#west, 2)
check.equal(west[1].body, west[2].body)

-- A joint along the face between two joined blocks parts them too.
model = row(3)
model:blocks():join()
model:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 2, 0, 0 } })
check.equal(#model:blocks(), 3)
check.equal(bodies(model:blocks()), 2)

-- Blocks joined across a joint stay so when another joint cuts them.
model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2000 })
model:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
model:blocks():join()
model:generate("joint", { joint = "K", dip = 0, dip_direction = 0, origin = { 0, 0, 0.5 } })
check.equal(#model:blocks(), 4)
check.equal(bodies(model:blocks()), 2)

-- A plane through a body that hides a member leaves a crack: the body hangs together around it.
model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2000 })
model:generate("box", { min = { 0, 0, 1 }, max = { 2, 1, 2 }, density = 2000 })
model:blocks():join()
model:blocks { id = 2 }:hide()
model:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
model:blocks { hidden = true }:show()
check.equal(#model:blocks(), 3)
check.equal(bodies(model:blocks()), 1)

-- Persistence is drawn once for a body and a plane: both members are cut, or none.
local cut, whole = 0, 0
for seed = 1, 40 do
    model = talus.model { seed = seed }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
    model:generate("box", { min = { 1, 0, 0 }, max = { 2, 1, 1 }, density = 2000 })
    model:blocks():join()
    model:generate("joint",
        { joint = "J", dip = 0, dip_direction = 0, origin = { 0, 0, 0.5 }, persistence = 0.5 })
    check.equal(bodies(model:blocks()), #model:blocks() / 2)
    cut = cut + (#model:blocks() == 4 and 1 or 0)
    whole = whole + (#model:blocks() == 2 and 1 or 0)
end
check.equal(cut + whole, 40)
check.holds(cut > 8 and whole > 8, "both happen")

-- Another density of one part moves the centroid of all.
model = row(2)
model:blocks():join()
model:blocks { id = 2 }:set { density = 6000 }
model:blocks():set { angular_velocity = { 0, 0, 1 }, velocity = { 0, 0, 0 } }
-- about the common centroid at x = 1.25
check.near(model:blocks { id = 1 }[1].velocity[2], -0.75, 1e-12)
check.near(model:blocks { id = 2 }[1].velocity[2], 0.25, 1e-12)

-- Contacts that outlast a joining keep their forces.
model = talus.model { gravity = { 0, 0, -10 } }
for i = 0, 2 do
    model:generate("box", { min = { 0, 0, i }, max = { 1, 1, i + 1 }, density = 2000 })
end
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
model:blocks { id = 1 }:fix()
model:damping "local"
model:solve { ratio = 1e-6 }
local top = { model:blocks { id = 2 }, model:blocks { id = 3 } }
local base = model:blocks { id = 1 }
local function force()
    return model:contacts { between = { base, top[1] } }:sum("normal_force")
end
check.near(force(), 40000, 1)
model:blocks { where = function(b) return b.id > 1 end }:join()
model:cycle(1)
check.near(force(), 40000, 1)
model:cycle(500)
check.near(force(), 40000, 5)
top[1]:unjoin()
model:cycle(1)
check.near(force(), 40000, 5)
model:solve { ratio = 1e-6 }
check.near(force(), 40000, 1)
check.near(model:contacts { between = { top[1], top[2] } }:sum("normal_force"), 20000, 1)
