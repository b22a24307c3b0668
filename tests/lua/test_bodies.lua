-- join and unjoin: what a body of several blocks keeps, and how it moves.
local talus = require "talus"
local check = require "check"

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

-- Mass, momentum and angular momentum about the origin, and kinetic energy, of a list of blocks.
local function sums(blocks)
    local s = { mass = 0, kinetic = 0, momentum = { 0, 0, 0 }, spin = { 0, 0, 0 } }
    for _, b in ipairs(blocks) do
        local i, w, v = b.inertia, b.angular_velocity, b.velocity
        local own = { i.xx * w[1] + i.xy * w[2] + i.zx * w[3], i.xy * w[1] + i.yy * w[2] + i.yz * w[3],
            i.zx * w[1] + i.yz * w[2] + i.zz * w[3] }
        local orbital = cross(b.centroid, v)
        s.mass, s.kinetic = s.mass + b.mass, s.kinetic + b.kinetic_energy
        for k = 1, 3 do
            s.momentum[k] = s.momentum[k] + b.mass * v[k]
            s.spin[k] = s.spin[k] + b.mass * orbital[k] + own[k]
        end
    end
    return s
end

-- Three unlike boxes in a row that touch, in free space.
local function row_of_three()
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000, group = "a" })
    model:generate("box", { min = { 1, 0, 0 }, max = { 3, 1, 2 }, density = 1500, group = "b" })
    model:generate("box", { min = { 3, 0, 0 }, max = { 3.5, 1, 1 }, density = 2500, group = "c" })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    return model, model:blocks { group = "a" }, model:blocks { group = "b" }, model:blocks { group = "c" }
end

-- Joining keeps mass, momentum and angular momentum, and loses energy of relative motion.
local model, a, b, c = row_of_three()
a:set { velocity = { 1, 2, -1 }, angular_velocity = { 0.3, -0.2, 0.5 } }
b:set { velocity = { -0.5, 0.1, 0.7 }, angular_velocity = { -1, 0.4, 0.1 } }
local both = model:blocks { where = function(block) return block.group ~= "c" end }
local before = sums(both)
check.equal(both:join(), both)
check.equal(a[1].body, b[1].body)
check.equal(a[1].body, a[1].id)
check.equal(c[1].body, c[1].id)
local after = sums(both)
check.near(after.mass, before.mass, 1e-9)
-- Tolerance: roundings of numbers of the size of the momenta, some 1e4.
check.near(after.momentum, before.momentum, 1e-9)
check.near(after.spin, before.spin, 1e-9)
check.holds(after.kinetic < before.kinetic, "energy is lost")
check.near(a[1].angular_velocity, b[1].angular_velocity, 0)

-- Parts that move as one already lose nothing, and joining them again changes nothing.
local hash = model:state_hash()
both:join()
check.equal(model:state_hash(), hash)

-- A member's handle stays good; its distances to the others stay.
local function distance(p, q)
    return math.sqrt((p[1] - q[1]) ^ 2 + (p[2] - q[2]) ^ 2 + (p[3] - q[3]) ^ 2)
end
c:delete()
local corner, far = a[1].vertices[1], b[1].vertices[7]
local apart = distance(corner, far)
model:timestep { dt = 1e-3 }
model:cycle(1000)
check.holds(distance(a[1].vertices[1], corner) > 0.5, "the body has moved")
check.near(distance(a[1].vertices[1], b[1].vertices[7]), apart, 1e-12)
check.near(a[1].rotation, b[1].rotation, 0)
local moved = sums(both)
check.near(moved.momentum, before.momentum, 1e-8)
check.near(moved.spin, before.spin, 1e-7)
-- A free body keeps its energy: the splitting's error is of the order (w dt)^2.
check.near(moved.kinetic, after.kinetic, 1e-6 * after.kinetic)
check.equal(#model:contacts { between = { a, b } }, 0)

-- Unjoining lets each part go on with the velocity it has.
local spin, energy = moved.spin, moved.kinetic
check.equal(both:unjoin(), both)
check.equal(a[1].body, a[1].id)
check.equal(b[1].body, b[1].id)
local parted = sums(both)
check.near(parted.momentum, before.momentum, 1e-8)
check.near(parted.spin, spin, 1e-7)
check.near(parted.kinetic, energy, 1e-9 * energy)

-- Contacts inside a body vanish and come back.
model, a, b, c = row_of_three()
model:cycle(1)
check.equal(#model:contacts(), 2)
both = model:blocks { where = function(block) return block.group ~= "c" end }
both:join()
check.equal(#model:contacts(), 1)
check.equal(#model:contacts { between = { b, c } }, 1)
both:unjoin()
check.equal(#model:contacts(), 2)
check.equal(#model:contacts { between = { a, b } }, 1)

-- One member of a group of three that is unjoined leaves the others together; a join of two members
-- brings whole groups along.
model:blocks():join()
b:unjoin()
check.equal(a[1].body, c[1].body)
check.equal(b[1].body, b[1].id)
check.equal(#model:contacts(), 2)
model:blocks { where = function(block) return block.group ~= "c" end }:join()
check.equal(b[1].body, c[1].body)
check.equal(#model:contacts(), 0)
model:blocks():unjoin()

-- A part that is held holds the body.
a:fix()
both = model:blocks { where = function(block) return block.group ~= "c" end }
c:set { velocity = { -1, 0, 0 } }
both:join()
check.equal(b[1].fixed, true)
model:cycle(200)
check.near(b[1].displacement, { 0, 0, 0 }, 0)
check.holds(c[1].velocity[1] > 0, "it bounced off the held body")

-- A body on a floor rests on all its parts: the arch of two feet and a beam carries its weight.
model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { 0, 0, -1 }, max = { 3, 1, 0 }, density = 2000, group = "floor" })
for _, x in ipairs { 0, 2 } do
    model:generate("box", { min = { x, 0, 0 }, max = { x + 1, 1, 1 }, density = 2000, group = "body" })
end
model:generate("box", { min = { 0, 0, 1 }, max = { 3, 1, 2 }, density = 2000, group = "body" })
model:blocks { group = "floor" }:fix()
local arch = model:blocks { group = "body" }:join()
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
model:damping("local")
model:solve { ratio = 1e-7 }
check.equal(#model:contacts(), 2)
check.near(model:contacts():sum("normal_force"), 1e5, 1)
check.near(model:contacts():max("normal_force"), 5e4, 1)
check.near(arch:min("speed"), arch:max("speed"), 1e-9)

-- What is loaded or driven must be freed first; stale handles and wrong calls are refused.
arch:unjoin()
local foot = model:blocks { id = arch[1].id }
foot:load { force = { 1, 0, 0 } }
check.refused(model, function() arch:join() end, "is loaded; take that off first")
foot:load {}
foot:drive { velocity = { 0, 0, 0 } }
check.refused(model, function() arch:join() end, "is driven; take that off first")
check.refused(model, function() arch:unjoin() end, "is driven; take that off first")
foot:free()
check.refused(model, function() arch:join(1) end, "1 argument too many")
check.refused(model, function() arch.join() end, "write selection:join(...)")
check.refused(model, function() arch:joint() end, "did you mean 'join'?")
check.equal(#model:blocks { group = "nothing" }:join(), 0)
foot:delete()
check.refused(model, function() arch:join() end, "no longer exists")

-- Not from a callback.
check.raises(function()
    model:solve { ratio = 0, max_cycles = 20, every = 5, stop = function()
        model:blocks { group = "body" }:join()
    end }
end, "cannot join blocks while the model is running")

-- What was joined after it had settled stays one body when it is cut, as what was joined before: closures are no gaps.
local function two_on_each_other(kn, settled, size)
    local tower = talus.model { gravity = { 0, 0, -10 } }
    local function box(low, high, group)
        tower:generate("box", { min = { 0, 0, low * size }, max = { 4 * size, 4 * size, high * size }, density = 2500,
            group = group })
    end
    box(-1, 0, "base")
    box(0, 2, "tower")
    box(2, 4, "tower")
    tower:joint("*", "coulomb", { kn = kn, ks = kn, friction = 30 })
    tower:blocks { group = "base" }:fix()
    tower:damping "local"
    if settled then
        tower:solve {}
    end
    tower:blocks { group = "tower" }:join()
    tower:blocks { group = "base" }:hide()
    return tower
end
local function bodies_of(of)
    local seen, count = {}, 0
    for _, block in ipairs(of:blocks { where = function(one) return one.group ~= "base" end }) do
        count = count + (seen[block.body] and 0 or 1)
        seen[block.body] = true
    end
    return count
end
for _, kn in ipairs { 5e6, 1e7, 1e9, 1e10, 1e12 } do
    for _, settled in ipairs { false, true } do
        local function fresh()
            return two_on_each_other(kn, settled, 1)
        end
        local cut = fresh()
        cut:generate("joint", { joint = "K", dip = 90, dip_direction = 90, origin = { 1, 2, 2 } })
        check.equal(#cut:blocks(), 4)
        check.equal(bodies_of(cut), 2)
        cut = fresh()
        cut:generate("joint", { joint = "K", dip = 90, dip_direction = 90, origin = { 2, 2, 3 }, radius = 0.5 })
        check.equal(bodies_of(cut), 1)
        cut = fresh()
        local function portal(x)
            return { { x, 1.5, 1.5 }, { x, 2.5, 1.5 }, { x, 2.5, 2.5 }, { x, 1.5, 2.5 } }
        end
        cut:generate("tunnel", { face1 = portal(-1), face2 = portal(5) })
        check.equal(bodies_of(cut), 2) -- the tower and what is in the tunnel
        -- A slab of 1 % of the size that is sawn out parts what it lay between.
        cut = fresh()
        for k, z in ipairs { 0.99, 1.01 } do
            cut:generate("joint", { joint = "saw" .. k, dip = 0, dip_direction = 0, origin = { 2, 2, z } })
        end
        cut:blocks { where = function(block) return block.volume < 1 end }:delete()
        check.equal(bodies_of(cut), 2)
    end
end
