-- The time step: what it is by default, where nothing can move, and what it does to blocks that land.
local check = require "check"
local shapes = require "shapes"
local talus = require "talus"

local DENSITY = 2500
-- A body without contact has the step of one that stands on its largest face; where it rests on edges and corners it counts at
-- least this part of the face, so that its step may be so much longer.
local FLOOR = 0.15
local LONGER = 1 / math.sqrt(FLOOR)

-- ---------------------------------------------------------------- by default

-- A free cube on a held one: its points are those of a square of 1 m2 half a metre below, r^2 is 5/12, I is M/6.
local function cube_on_base()
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = DENSITY, group = "base" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY })
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    return model
end
local function body_step(fraction)
    return fraction * 2 * math.sqrt(DENSITY / (2 * 1e8 * (1 + 6 * 5 / 12)))
end
local function paper_step(fraction)
    return fraction * 2 * math.sqrt(DENSITY / (2 * 1e8))
end

local model = cube_on_base()
check.near(model.dt / body_step(0.5), 1, 1e-12)
local default = model:state_hash()
for _, case in ipairs {
    { {}, body_step(0.5) }, { { fraction = 0.2 }, body_step(0.2) }, { { rule = "paper" }, paper_step(0.1) },
    { { rule = "paper", fraction = 0.3 }, paper_step(0.3) }, { { rule = "body" }, body_step(0.5) },
    { { rule = "body", fraction = 1 }, body_step(1) }, { { dt = 1e-3 }, 1e-3 },
} do
    model:timestep(case[1])
    check.near(model.dt / case[2], 1, 1e-12)
end
model:timestep { fraction = 0.5 } -- what is the default is the same state when it is said
check.equal(model:state_hash(), default)
check.refused(model, function() model:timestep { fraction = 2.5 } end, "fraction")

-- ---------------------------------------------------------------- where nothing can move

model = talus.model { gravity = { 0, 0, -10 } }
model:cycle(10)
check.equal(model.time, 0)
check.equal(model.cycles, 10)
check.equal(model.dt, 0)
check.equal(model:timestep().block, nil)
check.equal(model:timestep().message, "no block controls the step: dt = 0.0 s")
check.equal(model:solve { max_time = 5, max_cycles = 100 }.time, 0)
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY })
check.raises(function() model:cycle(1) end, "no law says how stiff a contact is")
model:blocks():fix()
model:cycle(10)
check.equal(model.time, 0)
model:blocks():drive { velocity = { 1, 0, 0 } }
check.raises(function() model:cycle(1) end, "no law says how stiff a contact is")
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
model:cycle(10)
check.near(model.time / (10 * paper_step(0.5)), 1, 1e-12) -- its rotation is held, and not in the step

-- ---------------------------------------------------------------- blocks that land

-- A box of half sides `half`, turned by `turns` {axis, degrees}, its lowest vertex at `height` over x and y.
local function turned_box(half, turns, x, y, height)
    local vertices, low = {}, math.huge
    for i = 0, 7 do
        local p = { (i % 2 * 2 - 1) * half[1], (i // 2 % 2 * 2 - 1) * half[2], (i // 4 * 2 - 1) * half[3] }
        for _, turn in ipairs(turns) do
            local k, s, c = turn[1], math.sin(math.rad(turn[2])), math.cos(math.rad(turn[2]))
            local u, v = k % 3 + 1, (k + 1) % 3 + 1
            p[u], p[v] = c * p[u] - s * p[v], s * p[u] + c * p[v]
        end
        vertices[i + 1] = p
        low = math.min(low, p[3])
    end
    for _, p in ipairs(vertices) do
        p[1], p[2], p[3] = p[1] + x, p[2] + y, p[3] - low + height
    end
    return vertices
end

-- Lets it fall on a held slab for a time and a half of its fall; gives the largest error of the energy on the way and the
-- first and the longest step. Without friction, by the default of the step.
local function land(half, turns, height, kn)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -4, -4, -1 }, max = { 4, 4, 0 }, density = DENSITY, group = "slab" })
    m:blocks { group = "slab" }:fix()
    m:generate("polyhedron", { vertices = turned_box(half, turns, 0.1, 0.2, height), density = DENSITY })
    m:joint("*", "coulomb", { kn = kn, ks = kn, friction = 0 })
    local worst, first, longest = 0, nil, 0
    while m.time < 1.5 * math.sqrt(2 * height / 10) do
        m:cycle(1)
        worst = math.max(worst, math.abs(m:energy().balance))
        first, longest = first or m.dt, math.max(longest, m.dt)
    end
    return worst, first, longest
end

local CUBE, PLATE = { 0.5, 0.5, 0.5 }, { 1, 1, 0.05 }
local CORNER = { { 3, 45 }, { 1, math.deg(math.acos(1 / math.sqrt(3))) } } -- down
-- Bounds: what the steps of 2 to 6 % of a period of the block on its joint may make.
local landings = {
    { "flat", CUBE, {}, 0.06 }, { "3 degrees", PLATE, { { 2, 3 } }, 0.06 },
    { "3 degrees, turned", PLATE, { { 2, 3 }, { 3, 20 } }, 0.06 },
    { "on an edge", CUBE, { { 2, 44 } }, 0.005 }, { "on a corner", CUBE, CORNER, 0.005 },
    { "nearly on an edge", CUBE, { { 2, 30 }, { 3, 10 } }, 0.02 },
}
for _, landing in ipairs(landings) do
    local name, half, turns, bound = table.unpack(landing)
    for _, kn in ipairs { 1e8, 1e9 } do
        for _, height in ipairs { 0.3, 0.41 } do
            local worst, first, longest = land(half, turns, height, kn)
            check.holds(worst < bound, string.format("%s, kn = %g, %g m: energy off by %.2g", name, kn, height, worst))
            check.holds(longest < 1.001 * LONGER * first,
                string.format("%s: %g s in the air, then %g s", name, first, longest))
        end
    end
end

-- A cube that touches a slab with a corner, without going on: FLOOR of its largest face makes the step, and the stiffness
-- that is told is that of this part. Where it goes on fast, all of the face counts.
do
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { -4, -4, -1 }, max = { 4, 4, 0 }, density = DENSITY, group = "slab" })
    m:blocks { group = "slab" }:fix()
    m:generate("polyhedron", { vertices = turned_box(CUBE, CORNER, 0, 0, -1e-3), density = DENSITY, group = "cube" })
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    check.equal(#m:contacts(), 1)
    for speed, part in pairs { [0] = FLOOR, [5] = 1 } do
        m:blocks { group = "cube" }:set { velocity = { 0, 0, -speed } }
        local report = m:timestep()
        check.equal(report.block.group, "cube")
        check.near(report.dt / body_step(0.5) * math.sqrt(part), 1, 1e-9)
        check.near(report.stiffness / (part * 1e8), 1, 1e-9)
    end
end

-- A cube falls corner on corner of another, with no area where they touch first: the step is never longer than
-- it may be on a corner.
for _, share in ipairs { 0, 0.01 } do
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("polyhedron", { vertices = turned_box(CUBE, CORNER, 0, 0, 0), density = DENSITY, group = "held" })
    m:generate("polyhedron", { vertices = turned_box(CUBE, CORNER, 0.01, 0.02, 1.74), density = DENSITY })
    m:blocks { group = "held" }:fix()
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    m:contact_area { fraction = share }
    local longest, step, touched = 0, LONGER * body_step(0.5), false
    for _ = 1, 400 do
        m:cycle(1)
        touched = touched or #m:contacts() > 0
        longest = math.max(longest, m.dt)
    end
    check.holds(touched, "they touch")
    check.holds(longest < 1.001 * step, string.format("a step of %g s, more than %g s", longest, step))
end

-- A cube slides off the end of a slab, until they share nothing: by either rule the step is never longer than
-- it may be on an edge.
for rule, step in pairs { body = LONGER * body_step(0.5), paper = paper_step(0.1) } do
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -1, -1, -1 }, max = { 1, 1, 0 }, density = DENSITY, group = "slab" })
    m:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 1 }, density = DENSITY, group = "cube" })
    m:blocks { group = "slab" }:fix()
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 0 })
    m:timestep { rule = rule }
    m:blocks { group = "cube" }:set { velocity = { 6, 0, 0 } }
    local longest = 0
    while m.time < 0.5 do
        m:cycle(1)
        longest = math.max(longest, m.dt)
    end
    check.holds(m:blocks { group = "cube" }[1].centroid[1] > 2, "it is off")
    check.holds(longest < 1.001 * step, string.format("%s: a step of %g s, more than %g s", rule, longest, step))
end

-- Two joined cubes in free fall, turned: the step is that of the same one of their faces, of which some are equally large.
local same
for angle = 0, 170, 10 do
    local m = talus.model {}
    local turn = shapes.turn({ 2 / 3, 1 / 3, 2 / 3 }, math.rad(angle))
    for side, at in pairs { [0.8] = { 0, 0, 0 }, [0.5] = { 0.65, 0.15, 0.1 } } do
        m:generate("polyhedron", { density = DENSITY,
            vertices = shapes.placed(shapes.box(side, side, side), turn, shapes.apply(turn, at)) })
    end
    m:blocks():join()
    m:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 30 })
    m:cycle(2)
    same = same or m.dt
    check.near(m.dt, same, 1e-6 * same)
end

-- Mass scaling scales masses and moments of inertia each by its own rate. At the critical step slender blocks between
-- fixed ones, on linear joints that stay closed, vibrate and gain nothing; well beyond it they fly apart.
local function fastest(fraction)
    local rock = talus.model { gravity = { 0, 0, 0 }, seed = 3 }
    rock:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2600 })
    for _, set in ipairs { { "J1", 10, 40, 0.3, 12 }, { "J2", 80, 85, 1, 3 }, { "J3", 86, 175, 1.5, 2 } } do
        rock:generate("jointset", { joint = set[1], dip = set[2], dip_direction = set[3], dip_dev = 8,
            dip_direction_dev = 8, spacing = set[4], spacing_dev = 0.2, number = set[5], origin = { 2, 2, 2 } })
    end
    rock:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
    rock:insitu { stress = { xx = -1e6, yy = -1e6, zz = -1e6 } }
    rock:blocks { where = function(b)
        for _, v in ipairs(b.vertices) do
            for k = 1, 3 do
                if v[k] < 1e-6 or v[k] > 4 - 1e-6 then return true end
            end
        end
    end }:fix()
    rock:mass_scaling(true)
    rock:timestep { rule = "body", fraction = fraction }
    local free = rock:blocks { fixed = false }
    for i, b in ipairs(free) do
        rock:blocks { where = function(x) return x.id == b.id end }:set { velocity = { 1e-6 * (i % 3 - 1), 1e-6,
            1e-6 * (i % 5 - 2) }, angular_velocity = { 1e-6 * (i % 4), 1e-6, 0 } }
    end
    check.holds(#free > 20, "blocks within")
    local most = 0
    local good, why = pcall(function()
        for _ = 1, 400 do
            rock:cycle(1)
            most = math.max(most, free:max "speed")
        end
    end)
    return most, good, why
end
check.holds(fastest(1) < 1e-4, "stable at the critical step")
local most, good, why = fastest(1.5)
check.holds(most > 1e-2, "not at half as much again")
check.holds(good or why:find("fraction = 1.5 of timestep is not stable; give 1 or less", 1, true), why)

-- The sentence says what makes the block so fast: its mass on its springs, its turn on them, or its own speed.
local function sentence(size, velocity)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -9, -9, -1 }, max = { 9, 9, 0 }, density = 2500, group = "floor" })
    m:generate("box", { min = { 0, 0, velocity and 1 or 0 }, max = { size[1], size[2], size[3] + (velocity and 1 or 0) }, density = 2500, group = "box" })
    m:blocks { group = "floor" }:fix()
    m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    if velocity then
        m:blocks({ group = "box" }):set { velocity = velocity }
    end
    return m:timestep().message
end
check.holds(sentence({ 1, 1, 1 }):find "^block %d+ controls the step: ", "a cube by its mass")
check.holds(sentence({ 0.1, 0.1, 5 }):find "^block %d+ controls the step by turning: ", "a slender one by its turn")
check.holds(sentence({ 1, 1, 1 }, { 0, 0, -10000 }):find "^block %d+ controls the step by the speed at which it moves: ", "a fast one by its speed")

-- A change of the law and one of the model, between the same two steps: the step is that of a model made so at once.
local function slab(law_first, later, lonely)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    if lonely then
        model:generate("box", { min = { 20, 0, 0 }, max = { 20.1, 0.1, 0.1 }, density = 2500 })
    end
    model:generate("box", { min = { 0, 0, -1 }, max = { 4, 4, 0 }, density = 2500, group = "floor" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 1 }, density = 2500 })
    model:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 1.2 }, density = 2500, group = "light" })
    local function law(kn) model:joint("*", "coulomb", { kn = kn, ks = kn, friction = 30 }) end
    law(later and 1e8 or 4e8)
    model:blocks { group = "floor" }:fix()
    if later then
        model:cycle(2)
        if law_first then law(4e8) end
        model:blocks { group = "light" }:fix()
        if not law_first then law(4e8) end
    else
        model:blocks { group = "light" }:fix()
    end
    model:cycle(2)
    return model.dt
end
for _, lonely in ipairs { false, true } do -- a block without contacts asks for the stiffest law
    local at_once = slab(true, false, lonely)
    check.near(slab(true, true, lonely), at_once, 1e-4 * at_once)
    check.equal(slab(false, true, lonely), slab(true, true, lonely))
end

-- Of a body whose parts have equally large faces, the farthest counts, whichever was made first.
local function row(order)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    for _, i in ipairs(order) do
        model:generate("box", { min = { i, 0, 0 }, max = { i + 1, 1, 1 }, density = 2500 })
    end
    model:blocks():join()
    model:generate("box", { min = { -9, -9, -1 }, max = { 9, 9, 0 }, density = 2500, group = "floor" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:timestep { rule = "body" }
    local said = model:timestep().dt
    model:cycle(1)
    return said
end
check.near(row { 0, 1, 2 }, row { 1, 0, 2 }, 1e-9 * row { 0, 1, 2 })
check.near(row { 0, 1, 2 }, row { 2, 0, 1 }, 1e-9 * row { 0, 1, 2 })

-- Of many bodies the one that needs the shortest step decides, wherever it is in the list; of equal ones the first.
local function cubes(sizes, threads)
    local model = talus.model { threads = threads }
    for i, size in ipairs(sizes) do
        model:generate("box", { min = { 3 * i, 0, 0 }, max = { 3 * i + size, size, size }, density = 2500 })
    end
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    return model
end
local alone = cubes({ 0.5 }, 1).dt
for _, small in ipairs { { 1 }, { 50 }, { 100 }, { 20, 70 } } do
    local sizes = {}
    for i = 1, 100 do sizes[i] = 1 end
    for _, i in ipairs(small) do sizes[i] = 0.5 end
    for threads = 1, 2 do
        local many = cubes(sizes, threads)
        check.near(many.dt, alone, 1e-12 * alone)
        check.equal(many:timestep().block.id, small[1])
    end
end

-- Of two that need the same the first is named, whichever thread has found it.
do
    local sizes = {}
    for i = 1, 1000 do sizes[i] = 1 end
    local many = cubes(sizes, 2)
    for k = 1, 100 do
        local pair = { 1 + 13 * k % 500, 501 + 29 * k % 500 }
        local light = many:blocks { where = function(block) return block.id == pair[1] or block.id == pair[2] end }
        light:set { density = 1000 }
        check.equal(many:timestep().block.id, pair[1])
        light:set { density = 2500 }
    end
end

-- ---------------------------------------------------------------- by the balance

-- A heap of turned boxes that falls apart.
local function heap(threads, settings)
    local random, heap = shapes.random(5), talus.model { threads = threads, gravity = { 0, 0, -10 } }
    heap:generate("box", { min = { -20, -20, -1 }, max = { 20, 20, 0 }, density = DENSITY, group = "base" })
    heap:blocks { group = "base" }:fix()
    for i = 0, 17 do
        local vertices, turn = {}, shapes.turn(shapes.direction(random), random(0, 3))
        for k = 0, 7 do
            local p = { 0.4 * (k % 2 * 2 - 1), 0.5 * (k // 2 % 2 * 2 - 1), 0.45 * (k // 4 * 2 - 1) }
            local at = { i % 3 * 1.1, i // 3 % 2 * 1.1, 0.9 + i // 6 * 1.3 }
            for j = 1, 3 do
                at[j] = at[j] + shapes.dot(turn[j], p)
            end
            vertices[k + 1] = at
        end
        heap:generate("polyhedron", { vertices = vertices, density = DENSITY })
    end
    heap:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 30 })
    heap:timestep(settings)
    return heap
end

-- It begins as the rule body does, and takes twice that step when the balance is good: half of the steps in all, and the
-- balance ends within the error.
do
    local usual, watched = heap(1, {}), heap(1, { rule = "balance", error = 0.02 })
    check.near(watched.dt / usual.dt, 1, 1e-12)
    usual:solve { max_time = 1 }
    watched:solve { max_time = 1 }
    check.equal(watched.cycles < 0.7 * usual.cycles, true)
    check.equal(math.abs(watched:energy().balance) < 0.02, true)
    check.near(watched:energy().friction / usual:energy().friction, 1, 0.1)
end

-- An error that has been passed leaves the step of the rule body, and the slopes of what rests.
do
    local strict, usual = heap(1, { rule = "balance", error = 1e-12 }), heap(1, {})
    strict:cycle(300)
    usual:cycle(300)
    check.near(strict.time / usual.time, 1, 0.1)
end

-- The same bits from any number of threads, and over a file in the middle.
do
    local one, two = heap(1, { rule = "balance" }), heap(3, { rule = "balance" })
    one:cycle(400)
    two:cycle(400)
    check.equal(one:state_hash(), two:state_hash())
    local path = os.tmpname()
    one:save(path)
    local again = talus.restore(path)
    os.remove(path)
    check.equal(again.dt, one.dt)
    again:cycle(400)
    two:cycle(400)
    check.equal(again:state_hash(), two:state_hash())
end
check.refused(model, function() model:timestep { rule = "balance", error = 2 } end, "error")
