-- A cut changes nothing of what blocks carry: the contacts of the parts take over the stresses, law states and initial stress of those of the
-- whole, whatever is asked, saved or cut again before the next step.
local check = require "check"
local shapes = require "shapes"
local talus = require "talus"

local G, DENSITY = 10, 2000
local SEEDS = check.cases(12)

local function fastest(model)
    local most = 0
    for _, block in ipairs(model:blocks { fixed = false }) do
        local v = block.velocity
        most = math.max(most, math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2))
    end
    return most
end

local function plane(joint, dip, direction, x, y, z)
    return { joint = joint, dip = dip, dip_direction = direction, origin = { x, y, z } }
end

-- ---------------------------------------------------------------- cases

-- A block that friction holds on a slope.
do
    local model = talus.model { gravity = { 0, 0, -G } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 3 }, density = DENSITY })
    model:generate("joint", plane("bed", 20, 90, 2, 2, 1.5))
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 40 })
    model:blocks { below = { dip = 20, dip_direction = 90, origin = { 2, 2, 1.5 } } }:fix()
    model:damping("local")
    model:solve { ratio = 1e-8, max_cycles = 20000 }
    local at_rest = fastest(model)
    model:generate("joint", plane("new", 90, 0, 1.3, 1.3, 1.5))
    local most = 0
    for _ = 1, 200 do
        model:cycle(1)
        most = math.max(most, fastest(model))
    end
    check.holds(#model:blocks { fixed = false } == 2, "the sliding block is cut")
    -- The points of a patch stand up to a sixteenth of its closure, so areas that a cut lays anew are others by that over the
    -- width. The part springs back from so much of the closure.
    local closure = DENSITY * G * 2 / 1e8
    check.near(most, 0, 2 * at_rest + closure / 16 / 4 * math.sqrt(G * closure))
end

-- A block that a bond holds under a roof, with springs so soft that its gap is wider than that of new contacts.
for _, kn in ipairs { 1e9, 1e7 } do
    local model = talus.model { gravity = { 0, 0, -G } }
    model:generate("box", { min = { -1, -1, 1 }, max = { 3, 3, 2 }, density = DENSITY })
    model:blocks():fix()
    model:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = DENSITY, group = "hanging" })
    model:joint("*", "coulomb_tensile", { kn = kn, ks = kn, friction = 30, cohesion = 1e6, tension = 1e6 })
    model:damping("local")
    model:cycle(3000)
    model:generate("joint", plane("new", 80, 90, 1.9, 0, 0.5))
    model:cycle(2000)
    local hanging = model:blocks { group = "hanging" }
    check.holds(#hanging == 2, "the hanging block is cut")
    for _, block in ipairs(hanging) do
        check.near(-block.displacement[3] * kn / (DENSITY * G), 1, 0.2) -- as far as the whole
    end
end

-- A cube that is glued to the side of another, and cut by a plane that begins at the glued face and leaves a wedge before it: the
-- wedge takes the glue, and the rest touches the other cube along an edge only.
for _, tilt in ipairs { 0.2, 5 } do
    local model = talus.model { gravity = { 0, 0, -G } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY, group = "left" })
    model:generate("box", { min = { 1, 0, 0 }, max = { 2, 1, 1 }, density = DENSITY })
    model:blocks { group = "left" }:fix():hide()
    model:joint("*", "coulomb_tensile", { kn = 1e9, ks = 5e8, friction = 35, cohesion = 1e8, tension = 1e8 })
    model:damping("local")
    model:solve {}
    local before = model:energy()
    model:generate("joint", plane("C", 90 - tilt, 270, 1, 0, 0))
    model:cycle(1)
    local now = model:energy()
    -- but for what the springs of the new faces have been given
    check.near(now.stored - (now.external - before.external), before.stored, 0.01 * before.stored)
    model:cycle(40)
    check.near(fastest(model), 0, 1)
end

-- A cube on a base, pushed until its bond is damaged, and cut so that parts rock on edges: vectors that a law keeps go with their planes
-- from patches to field contacts.
for _, case in ipairs {
    { push = { 56933.59375, 38671.875, -1e5 }, steps = 28, cut = plane("J", 78.145751953125, 82.529296875, 1.3359985351562, 1.7572631835938, 1.1426147460937) },
    { push = { 15100.09765625, 61199.951171875, -1e5 }, steps = 62, cut = plane("J", 31.39892578125, 194.205322265625, 2.57806396484375, 2.00982666015625, 1.2758544921875) },
} do
    local model = talus.model {}
    model:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 1 }, density = 2500 })
    model:blocks():fix()
    model:generate("box", { min = { 1, 1, 1 }, max = { 3, 3, 3 }, density = 2500 })
    model:joint("*", "cohesive", { kn = 1e8, ks = 1e8, tension = 1e4, cohesion = 2e4, gi = 10, gii = 20, friction = 30 })
    local cube = model:blocks { fixed = false }
    cube:load { force = case.push }
    model:cycle(case.steps)
    cube:load {}
    model:generate("joint", case.cut)
    model:cycle(60)
    for _, contact in ipairs(model:contacts()) do
        local q, n = contact.points[1].friction_stress, contact.normal
        check.near(q[1] * n[1] + q[2] * n[2] + q[3] * n[3], 0, 1e-3 * math.max(1, math.abs(q[1]) + math.abs(q[2]) + math.abs(q[3])))
    end
end

-- Rock under an initial stress: nothing moves, and the new faces press on each other as the rock did.
do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 9, 9, 9 }, density = DENSITY })
    for k = 1, 2 do
        model:generate("joint", plane("a", 0, 0, 4, 4, 3 * k))
        model:generate("joint", plane("b", 90, 0, 4, 3 * k, 4))
        model:generate("joint", plane("c", 90, 90, 3 * k, 4, 4))
    end
    model:blocks { where = function(b)
        local c = b.centroid
        return math.max(math.abs(c[1] - 4.5), math.abs(c[2] - 4.5), math.abs(c[3] - 4.5)) > 1
    end }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    model:insitu { stress = { xx = -1e6, yy = -2e6, zz = -3e6 } }
    for _, cut in ipairs { plane("n", 90, 90, 4.7, 4, 4), plane("n", 50, 90, 4, 4, 4.2) } do
        model:cycle(200)
        model:generate("joint", cut)
        model:cycle(200)
        check.near(fastest(model), 0, 1e-9)
    end
    local free = model:blocks { fixed = false }
    local pressed = 0
    check.holds(#free == 4, "the free block is cut twice")
    for _, contact in ipairs(model:contacts { joint = "n" }) do
        local n, one, other = contact.normal, contact.blocks[1], contact.blocks[2]
        local stress = n[1] ^ 2 * 1e6 + n[2] ^ 2 * 2e6 + n[3] ^ 2 * 3e6
        if one.fixed == other.fixed and not one.fixed then
            pressed = pressed + 1
            check.near(contact.normal_stress, stress, 1e-6 * stress)
        end
    end
    check.holds(pressed >= 4, "the new faces touch")
end

-- A slab is cut off the foot of a cube, at rest or sliding: its parts go on as the cube did, to a thickness of 1e-3 of the size. A model
-- that is saved between the cut and the next step goes on with the same bits.
for _, case in ipairs { { thickness = 0.1, push = 0 }, { thickness = 1e-3, push = 0 }, { thickness = 1e-3, push = 1 } } do
    local model = talus.model { gravity = { 0, 0, -G } }
    model:generate("box", { min = { -5, -5, -1 }, max = { 6, 6, 0 }, density = DENSITY })
    model:blocks():fix()
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 20 })
    model:damping("local")
    model:solve { ratio = 1e-10, max_cycles = 20000 }
    model:damping("none")
    model:blocks { fixed = false }:set { velocity = { case.push, 0, 0 } }
    model:cycle(5)
    local speed, energy = fastest(model), model:energy().kinetic
    model:generate("joint", plane("slab", 0, 0, 0, 0, case.thickness))
    local path = os.tmpname()
    model:save(path)
    local restored = talus.restore(path)
    os.remove(path)
    local most = 0
    for _ = 1, 50 do
        model:cycle(1)
        restored:cycle(1)
        most = math.max(most, fastest(model))
    end
    check.holds(#model:blocks { fixed = false } == 2, "the cube is cut")
    check.holds(most <= speed + 1e-8, "no part is faster than the cube was")
    check.holds(model:energy().kinetic <= energy + 1e-8, "a cut makes no kinetic energy")
    check.near(model:energy().balance, 0, 1e-3)
    check.holds(fastest(model) == fastest(restored), "a restored model goes on with the same bits")
end

-- Planes of all directions cut a cube at rest, whose bonds bear what they cut: nothing moves.
for seed = 1, 6 do
    local random = shapes.random(seed)
    local model = talus.model { gravity = { 0, 0, -G } }
    model:generate("box", { min = { -5, -5, -1 }, max = { 6, 6, 0 }, density = DENSITY })
    model:blocks():fix():hide()
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, random(0.5, 1.5) }, density = DENSITY })
    model:joint("*", "coulomb_tensile", { kn = 1e9, ks = 5e8, friction = 30, cohesion = 1e8, tension = 1e8 })
    model:damping("local")
    model:solve { ratio = 1e-10, max_cycles = 20000 }
    model:damping("none")
    for _ = 1, 3 do
        model:generate("joint", plane("new", random(0, 90), random(0, 360), random(0.2, 0.8), random(0.2, 0.8), random(0.1, 0.5)))
    end
    local most = 0
    for _ = 1, 50 do
        model:cycle(1)
        most = math.max(most, fastest(model))
    end
    check.holds(#model:blocks { fixed = false } > 2, "the cube is cut")
    check.near(most, 0, 1e-8)
    check.near(model:energy().balance, 0, 1e-9)
end

-- A slice so thin is cut off the foot that the floor comes near the rest through it: the rest does not take the foot's bond over, and
-- the law of the new joint makes none.
local bonds = {
    elastic = { kn = 1e9, ks = 1e9 },
    coulomb_tensile = { kn = 1e9, ks = 1e9, friction = 30, cohesion = 1e8, tension = 1e8 },
    cohesive = { kn = 1e9, ks = 1e9, friction = 30, cohesion = 1e8, tension = 1e8, gi = 1e9, gii = 1e9 },
}
for _, foot in ipairs { "coulomb", "elastic", "cohesive" } do
    for law, values in pairs(bonds) do
        local model = talus.model { gravity = { 0, 0, -G } }
        model:generate("box", { min = { -2, -2, -1 }, max = { 3, 3, 0 }, density = DENSITY })
        model:blocks():fix():hide()
        model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY })
        model:joint("*", foot, bonds[foot] or { kn = 1e9, ks = 1e9, friction = 30 })
        model:damping("local")
        model:solve { ratio = 1e-9 }
        model:damping("none")
        model:generate("joint", plane("thin", 0, 0, 0, 0, 2e-4))
        model:joint("thin", law, values)
        model:cycle(100)
        check.near(fastest(model), 0, 1e-7)
    end
end

-- A tilted block touches on a part of its foot: the parts that touch on more of it share that out until the next step, and none has all of it.
do
    local model = talus.model { gravity = { 0, 0, -G } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 2, 2, 0 }, density = DENSITY })
    model:blocks():fix():hide()
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:damping("local")
    for _, moment in ipairs { 7e3, 4.8e3 } do
        model:blocks():load { moment = { 0, moment, 0 } }
        model:solve { ratio = 1e-6, max_cycles = 20000 }
    end
    local whole = model:contacts()[1]
    local force = whole.normal_force
    check.equal(#whole.points, 1)
    model:generate("joint", plane("new", 90, 90, 0.8, 0.5, 0.5))
    local sum, points = 0, 0
    for _, contact in ipairs(model:contacts()) do
        if contact.joint == "" then
            sum, points = sum + contact.normal_force, points + #contact.points
        end
    end
    check.holds(points > 2, "the parts touch on patches")
    check.near(sum, force, 1e-9 * force)
end

-- A load stays when its block is cut: one on the whole is spread as weight is and asks nothing of the joint, one at a point goes to the part
-- that has the point. Their sums are the same, also in the half of the step in which the load was set.
local function momentum(model)
    local sum = { 0, 0, 0 }
    for _, block in ipairs(model:blocks()) do
        for k = 1, 3 do
            sum[k] = sum[k] + block.mass * block.velocity[k]
        end
    end
    return sum
end

local function loaded(load, set_at, cut_at, cut)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 2, 1 }, density = DENSITY })
    model:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
    model:damping("none")
    model:timestep { dt = 1e-4 }
    for step = 0, 20 do
        if step == set_at then
            model:blocks():load(load)
        end
        if step == cut_at and cut then
            model:generate("joint", plane("one", 20, 70, 0.5, 0.8, 0.5))
            model:generate("joint", plane("two", 90, 40, 0.5, 1.1, 0.5))
        end
        model:cycle(1)
    end
    return model
end

for _, at in ipairs { { 0, 0 }, { 3, 3 }, { 3, 9 } } do
    local force, moment = { 1e3, -2e3, 5e2 }, { 3e2, -1e2, 2e2 }
    local whole = loaded({ force = force }, at[1], at[2], false)
    local parts = loaded({ force = force }, at[1], at[2], true)
    check.equal(#parts:blocks(), 4)
    for _, block in ipairs(parts:blocks()) do
        check.near(block.velocity, whole:blocks()[1].velocity, 1e-12)
    end
    local placed = { force = force, moment = moment, at = { 0.1, 0.2, 0.9 } }
    local p = momentum(loaded(placed, at[1], at[2], false))
    check.near(momentum(loaded(placed, at[1], at[2], true)), p, 1e-9)
    local spin = loaded({ moment = moment }, at[1], at[2], false):blocks()[1].angular_velocity
    for _, block in ipairs(loaded({ moment = moment }, at[1], at[2], true):blocks()) do
        check.near(block.angular_velocity, spin, 1e-9) -- the joints give way to what turns the parts along
    end
end

-- ---------------------------------------------------------------- laws

local function chance(seed)
    local state = seed * 7919 + 13
    return function()
        state = (state * 1103515245 + 12345) % 2147483648
        return (state >> 8) % 100000 / 100000
    end
end

local function random_plane(draw, joint)
    return plane(joint, 90 * draw(), 360 * draw(), 4 * draw(), 3 * draw(), 1 + 2 * draw())
end

-- Rock that has come to rest or is about to slide; each block has a group of its own, which its parts keep.
local function build(seed)
    local draw = chance(seed)
    local model = talus.model { gravity = { 4 * draw() - 2, 4 * draw() - 2, -G } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 4, 3, 3 }, density = DENSITY })
    for k = 1, 3 do
        model:generate("joint", random_plane(draw, "J" .. k))
    end
    for _, block in ipairs(model:blocks()) do
        model:blocks { id = block.id }:set { group = ("%03d"):format(block.id) }
    end
    model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }:fix()
    if draw() < 0.5 then
        model:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 20 + 20 * draw() })
    else
        model:joint("*", "coulomb_tensile", { kn = 1e9, ks = 5e8, friction = 20 + 20 * draw(), cohesion = 1e5, tension = 1e5 })
    end
    if draw() < 0.3 then
        model:insitu { stress = { xx = -2e5, yy = -1e5, zz = -1e5 } }
    end
    model:damping("local")
    model:cycle(300 + math.floor(600 * draw()))
    return model, draw
end

-- Shear forces between blocks as they were before the cut, and the energies of their springs times 2 ks; the largest force.
local function sums(model)
    local out, most = {}, 0
    for _, contact in ipairs(model:contacts()) do
        local a, b, sign = contact.blocks[1].group, contact.blocks[2].group, 1
        if a > b then
            a, b, sign = b, a, -1
        end
        local sum = out[a .. b] or { force = { 0, 0, 0 }, energy = 0, parts = 0, area = 0 }
        out[a .. b] = a ~= b and sum or nil
        sum.parts, sum.area = sum.parts + 1, sum.area + contact.area
        for _, point in ipairs(contact.points) do
            local f = point.shear_force
            for k = 1, 3 do
                sum.force[k] = sum.force[k] + sign * f[k]
            end
            most = math.max(most, math.abs(point.normal_force))
            if point.area > 0 then
                sum.energy = sum.energy + (f[1] ^ 2 + f[2] ^ 2 + f[3] ^ 2) / point.area
            end
        end
    end
    return out, most
end

local function cut(model, draw, look)
    for k = 1, 1 + math.floor(2 * draw()) do
        model:generate("joint", random_plane(draw, "new" .. k))
        look(model)
    end
end

local function quiet() end

local function ask(model) return model:contacts():sum("area") end
local function hash(model) return model:state_hash() end

local split, more = 0, 0
for seed = 1, SEEDS do
    local whole, draw = build(seed)
    local parts = whole:copy()
    cut(parts, draw, quiet)
    local before, most = sums(whole)
    local after = sums(parts)
    for pair, sum in pairs(before) do
        local now = after[pair]
        if now and now.parts > sum.parts and math.abs(now.area - sum.area) < 1e-3 * sum.area then
            split = split + 1
            check.near(now.force, sum.force, 1e-4 * most)
            -- points between those of the whole may bear less, so that others hold more
            more = more + (now.energy > 1.001 * sum.energy and 1 or 0)
            check.holds(now.energy <= 1.05 * sum.energy + 1e-9, "energy of the parts' springs")
        end
    end
    -- whatever is done between the cuts and the next step
    parts:cycle(50)
    for _, look in ipairs { ask, hash } do
        local model, again = build(seed)
        cut(model, again, look)
        model:cycle(50)
        check.equal(model:state_hash(), parts:state_hash())
    end
    local saved, again = build(seed)
    local path = os.getenv "TALUS_TEST_TMP" .. "/cut_keeps.talus"
    cut(saved, again, function(model) model:save(path) end)
    local restored, copy = talus.restore(path, { threads = 2 }), saved:copy()
    restored:cycle(50)
    copy:cycle(50)
    check.holds(restored:state_hash() == parts:state_hash(), ("seed %d, saved between the cuts and the next step"):format(seed))
    check.holds(copy:state_hash() == parts:state_hash(), ("seed %d, copied"):format(seed))
end
check.holds(split > SEEDS and more < 0.1 * split, ("%d contacts were split, %d with more energy"):format(split, more))

-- A body that is driven to turn is not cut in two: no drive says how its parts would go on. One that is driven along is.
for _, motion in ipairs { { angular_velocity = { 0, 0, 1 } }, { velocity = { 1, 0, 0 }, angular_velocity = function() return { 0, 0, 1 } end } } do
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 4, 1, 1 }, density = DENSITY })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:blocks():drive(motion)
    model:cycle(10)
    local hash = model:state_hash()
    check.raises(function() model:generate("joint", plane("k", 90, 90, 2, 0.5, 0.5)) end, "is driven with an angular velocity and cannot be cut in two")
    check.equal(model:state_hash(), hash)
    model:blocks():drive { velocity = { 1, 0, 0 } }
    model:generate("joint", plane("k", 90, 90, 2, 0.5, 0.5))
    model:cycle(50)
    for _, block in ipairs(model:blocks()) do
        check.near(block.velocity, { 1, 0, 0 }, 0)
    end
end

-- Displacements count from their reset, of parts that are cut later, too, and of blocks that were turned before they were joined.
do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { { min = { 0, 0, 0 }, max = { 4, 1, 1 }, density = DENSITY }, { min = { 5, 0, 0 }, max = { 6, 1, 1 }, density = DENSITY } })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8 })
    model:timestep { dt = 1e-3 }
    local turns = model:blocks { id = 1 }
    turns:drive { angular_velocity = { 0, 0, 0.1 } }
    model:cycle(1000)
    turns:free()
    turns:set { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } }
    model:blocks():reset_displacement()
    check.near(turns[1].displacement, { 0, 0, 0 }, 0)
    local function cut(name, x)
        model:generate("joint", plane(name, 90, 90, x, 0.5, 0.5))
        for _, block in ipairs(model:blocks()) do
            check.near(block.displacement, { 0, 0, 0 }, 1e-14)
        end
    end
    cut("k", 1.8)
    model:blocks():join()
    cut("l", 3)
    local path = os.getenv "TALUS_TEST_TMP" .. "/cut_displacement.talus"
    model:save(path)
    model = talus.restore(path)
    cut("m", 1)
    check.equal(#model:blocks() > 4, true)
end

-- Blocks that stand near toppling, on a face of which a part is open, go on standing when they are cut by a joint that bears everything.
for _, case in ipairs {
    { "consistent", "coulomb_tensile", { 0.708, 0.486, 0.509 }, { 1.379, -6.306, -7.638 }, 4485, 5735 },
    { "corners", "coulomb_tensile", { 0.643, 0.868, 0.745 }, { -6.313, -0.718, -7.722 }, 7160, 6596 },
    { "consistent", "coulomb", { 0.959, 0.897, 1.205 }, { 3.88, 1.367, -9.114 } },
} do
    local points, law, size, gravity, tension, cohesion = table.unpack(case, 1, 6)
    local model = talus.model { gravity = gravity, contact_points = points }
    model:generate("box", { min = { -4, -4, -1 }, max = { 4, 4, 0 }, density = DENSITY, group = "floor" })
    model:generate("box", { min = { -size[1] / 2, -size[2] / 2, 0 }, max = { size[1] / 2, size[2] / 2, size[3] }, density = DENSITY, group = "block" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", law, { kn = 1e9, ks = 1e9, friction = 45, tension = tension, cohesion = cohesion })
    model:damping("local")
    model:solve { ratio = 1e-9, max_cycles = 100000 }
    model:damping("none")
    model:timestep { dt = model.dt / 3 }
    model:cycle(1)
    model:blocks { group = "floor" }:hide()
    model:generate("joint", plane("across", 50, 200, 0, 0, 0.4 * size[3]))
    model:joint("across", "elastic", { kn = 1e9, ks = 1e9 })
    model:cycle(200)
    check.near(fastest(model), 0, 1e-8)
end
