-- A pressed face that is cut: each part gets the traction times its part of the face, whatever the cut, whatever is on other faces, and
-- whatever is copied, saved or cut again in between. Sums of force and moment are those of the whole.
local check = require "check"
local shapes = require "shapes"
local talus = require "talus"

local SEEDS = check.cases(12)
local DENSITY = 2500

local function block_of(random)
    local model = talus.model { gravity = { 0, 0, 0 } }
    local size = { random(0.5, 2), random(0.5, 2), random(0.5, 2) }
    local turn = shapes.attitude(random)
    model:generate("polyhedron", { vertices = shapes.placed(shapes.box(table.unpack(size)), turn, { 3, -2, 1 }), density = DENSITY })
    model:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
    model:damping "none"
    model:timestep { dt = 1e-6 }
    return model, turn
end

-- What is on a face that looks along `normal`: the traction at a place, uniform or rising with the height.
local function put(model, normal, traction, gradient, add)
    return model:boundary { facing = normal, within = 1e-3, traction = traction, gradient = gradient, add = add }
end

local function cut(model, random, count)
    local c = { 3, -2, 1 }
    for _ = 1, count do
        model:generate("joint", { joint = "cut", dip = random(0, 90), dip_direction = random(0, 360),
            origin = { c[1] + random(-0.2, 0.2), c[2] + random(-0.2, 0.2), c[3] + random(-0.2, 0.2) } })
    end
end

-- What loads put on each block: what acts on it when the others are gone.
local function forces(model)
    local out = {}
    for i, block in ipairs(model:blocks()) do
        local alone = model:copy()
        for _, other in ipairs(model:blocks()) do
            if other.id ~= block.id then
                alone:blocks { id = other.id }:delete()
            end
        end
        alone:cycle(1)
        local left = alone:blocks()[1]
        out[i] = { force = left.force, moment = left.moment, block = block }
    end
    return out
end

-- What a traction puts on the faces of a block that look along a normal.
local function expected(model, block, normal, traction, gradient)
    local force, moment = { 0, 0, 0 }, { 0, 0, 0 }
    local single = talus.model { gravity = { 0, 0, 0 } }
    single:generate("polyhedron", { vertices = block.vertices, density = DENSITY })
    local c = single:blocks()[1].centroid
    local ok, found = pcall(put, single, normal, traction, gradient)
    if ok then
        force = found.force
        moment = shapes.sum(found.moment, -1, shapes.cross(c, found.force))
    end
    return force, moment
end

local parts_checked = 0
for seed = 1, SEEDS do
    local random = shapes.random(seed)
    local model, turn = block_of(random)
    local faces = {}
    for axis = 1, 3 do
        local sign = random(0, 1) < 0.5 and -1 or 1
        local normal = { sign * turn[1][axis], sign * turn[2][axis], sign * turn[3][axis] }
        local traction = { random(-1e5, 1e5), random(-1e5, 1e5), random(-1e5, 1e5) }
        -- one that rises with the height is linear, and to be kept must be normal to its face
        local pressure = random(0, 1) < 0.5 and random(-1e5, 1e5) or 0
        local gradient = pressure ~= 0 and { xx = pressure, yy = pressure, zz = pressure } or nil
        faces[axis] = { normal = normal, traction = traction, gradient = gradient }
        put(model, normal, traction, gradient, axis > 1)
    end
    local before = model:copy()
    cut(model, random, 2)
    -- the same on the way through a file, and when it is cut in two goes
    local path = os.getenv "TALUS_TEST_TMP" .. "/cut_loads.talus"
    model:save(path)
    local restored = talus.restore(path)
    os.remove(path)
    check.equal(restored:state_hash(), model:state_hash())
    for _, each in ipairs { model, restored } do
        cut(each, shapes.random(100 + seed), 1)
    end
    check.equal(restored:state_hash(), model:state_hash())
    local sum, moment = { 0, 0, 0 }, { 0, 0, 0 }
    for _, part in ipairs(forces(model)) do
        local block, scale = part.block, 1e5 * 4
        local want, turns = { 0, 0, 0 }, { 0, 0, 0 }
        for _, f in ipairs(faces) do
            local force, about = expected(model, block, f.normal, f.traction, f.gradient)
            want, turns = shapes.sum(want, 1, force), shapes.sum(turns, 1, about)
        end
        check.near(part.force, want, 1e-8 * scale)
        check.near(part.moment, turns, 1e-8 * scale)
        sum = shapes.sum(sum, 1, part.force)
        moment = shapes.sum(shapes.sum(moment, 1, part.moment), 1, shapes.cross(block.centroid, part.force))
        parts_checked = parts_checked + 1
    end
    local whole = forces(before)[1]
    check.near(sum, whole.force, 1e-6)
    check.near(moment, shapes.sum(whole.moment, 1, shapes.cross(whole.block.centroid, whole.force)), 1e-6)
    -- what is set anew takes the place of all of it
    local count = #model:blocks()
    model:blocks():load { force = { 1, 2, 3 } }
    cut(model, random, 1)
    sum = { 0, 0, 0 }
    for _, part in ipairs(forces(model)) do
        sum = shapes.sum(sum, 1, part.force)
    end
    check.near(sum, { count, 2 * count, 3 * count }, 1e-9)
end
check.holds(parts_checked > 3 * SEEDS, "blocks are cut")

-- A block at rest on a floor, pressed from above and cut upright: its parts need nothing of each other, and none starts to move.
for seed = 1, SEEDS do
    local random = shapes.random(500 + seed)
    local kn, pressure = 10 ^ random(9.5, 10.5), random(1e4, 1e6)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 3, 3, 0 }, density = DENSITY })
    model:blocks():fix():hide()
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1.5, 1 }, density = DENSITY })
    model:joint("*", "coulomb", { kn = kn, ks = kn, friction = 30 })
    model:boundary { side = "zmax", pressure = pressure }
    model:damping "local"
    model:solve { ratio = 1e-10, max_cycles = 20000 }
    model:damping "none"
    model:generate("joint", { joint = "cut", dip = 90, dip_direction = random(0, 360), origin = { random(0.3, 0.7), random(0.4, 1), 0.5 } })
    model:joint("cut", "coulomb", { kn = kn, ks = kn, friction = 0 })
    local most = 0
    for _ = 1, 20 do
        model:cycle(1)
        most = math.max(most, model:blocks { fixed = false }:max("speed"))
    end
    check.equal(#model:blocks { fixed = false }, 2)
    check.near(most / math.sqrt(pressure ^ 2 / (DENSITY * kn)), 0, 1e-6)
    check.near(model:energy().balance, 0, 1e-6)
end

-- A body of two blocks: what is on the face of one stays there when the other is cut.
do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY })
    model:generate("box", { min = { 1, 0, 0 }, max = { 3, 1, 1 }, density = DENSITY })
    model:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
    model:timestep { dt = 1e-6 }
    model:blocks():join()
    model:boundary { side = "zmax", traction = { 1e3, 2e3, -3e3 } }
    model:generate("joint", { joint = "cut", dip = 90, dip_direction = 90, origin = { 2.5, 0.5, 0.5 } })
    check.equal(#model:blocks(), 3)
    model:blocks { inside = { min = { 2, 0, 0 }, max = { 3, 1, 1 } } }:delete()
    model:cycle(1)
    for _, block in ipairs(model:blocks()) do
        check.near(block.force, { 2.5e3, 5e3, -7.5e3 }, 1e-6)
    end
end
