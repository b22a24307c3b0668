-- Blocks that are taken as fitting: without force, under any law, through whatever is done to the model after it; and what
-- stands and falls is what does so where blocks fit exactly.
-- program only: the models are the same ones with a stock Lua.
package.path = "tests/lua/?.lua;" .. package.path -- run in the source root
local check = require "check"
local jittered = require "jittered"
local seated = require "seated"
local talus = require "talus"

local KN, DENSITY, SIZE = seated.KN, seated.DENSITY, seated.SIZE
local LAWS, kinds, model_of = seated.laws, seated.kinds, seated.model
-- What the rounding of places makes of a weight: places are known to 1e-15 m, and 1e9 Pa/m of 0.5 m2 make 5e-7 N of it.
local NONE = 1e-8                               -- force over weight
-- Its energy is some 1e-22 J a contact, and weights are some 1e5 N. An overlap of 1e-7 m would store 1e-6 J. Speed is no measure:
-- the same force moves a thin part of a cut stone faster.
local STILL = 1e-20                             -- m, energy of motion over weight
local BALANCE = 1e-4                            -- of the largest term

local function weight_of(model)
    return 10 * model:blocks { fixed = false }:sum "mass"
end

local function forces(model)
    local sum = 0
    for _, c in ipairs(model:contacts()) do
        sum = sum + math.abs(c.normal_force)
    end
    return sum
end

-- Nothing presses, and nothing begins to move by itself.
local function rests(model, what, cycles)
    check.holds(forces(model) < NONE * weight_of(model), what .. ": presses at once")
    model:cycle(cycles or 100)
    check.holds(forces(model) < NONE * weight_of(model), what .. ": presses by " .. forces(model))
    check.holds(model:energy().kinetic < STILL * weight_of(model), what .. ": moves with " .. model:energy().kinetic .. " J")
end

-- ---- random assemblies under all laws ----

local jitters = { 1e-6, 1e-5, 1e-4, 1e-3, 4e-3 }
for case = 1, check.cases(150) do
    local law, kind, jitter = LAWS[case % #LAWS + 1], kinds[case % 3 + 1], jitters[case % 5 + 1]
    local what = ("case %d, %s, %s, jitter %g"):format(case, kind.name, law.name, jitter)
    local points = case % 4 == 0 and "corners" or nil
    local model = model_of(kind, case, jitter, law, { points = points })
    local result = model:seat { gap = 0.05 * SIZE, overlap = 0.05 * SIZE }
    check.holds(result.contacts > 0 and result.largest_gap > 0 and result.largest_overlap > 0, what .. ": gaps and overlaps")
    check.holds(result.largest_gap < 12 * jitter * SIZE and result.largest_overlap < 12 * jitter * SIZE, what .. ": of the jitter's size")
    check.holds(result.mean_gap <= result.largest_gap and result.mean_overlap <= result.largest_overlap, what)
    check.equal(#result.beyond, 0)
    -- a seated model stays as it is
    local hash = model:state_hash()
    local again = model:seat { gap = 0.05 * SIZE, overlap = 0.05 * SIZE }
    check.equal(again.contacts, 0)
    check.equal(model:state_hash(), hash)
    -- copies and files have it, and go on alike
    local copy = model:copy()
    check.equal(copy:state_hash(), hash)
    local path = os.tmpname()
    model:save(path)
    local file = talus.restore(path)
    os.remove(path)
    check.equal(file:state_hash(), hash)
    rests(model, what)
    for _, other in ipairs { copy, file } do
        other:cycle(100)
        check.equal(other:state_hash(), model:state_hash())
    end
    -- another law, and other properties
    copy:joint("*", "coulomb", { kn = 3 * KN, ks = KN, friction = 20 })
    rests(copy, what .. ", another law", 20)
    -- a cut through everything: parts take over
    local before = #file:blocks()
    file:generate("joint", { joint = "cut", dip = 70, dip_direction = 10 * case % 360, origin = { 1.5, 0.25, kind.name == "wall" and 1 or 4.5 } })
    file:joint("cut", "coulomb", { kn = KN, ks = KN, friction = 30 })
    check.holds(#file:blocks() > before, what .. ": is cut")
    rests(file, what .. ", cut", 50)
    -- and once more, of parts of parts, before any step; then files and copies of those
    model:generate("joint", { joint = "cut", dip = 60, dip_direction = 100, origin = { 1.2, 0.25, kind.name == "wall" and 1 or 4.5 } })
    model:joint("cut", "coulomb", { kn = KN, ks = KN, friction = 30 })
    model:generate("joint", { joint = "more", dip = 75, dip_direction = 20, origin = { 1.2, 0.25, kind.name == "wall" and 1 or 4.5 } })
    model:joint("more", "coulomb", { kn = KN, ks = KN, friction = 30 })
    local twin = model:copy()
    check.equal(twin:state_hash(), model:state_hash())
    rests(model, what .. ", cut twice", 50)
    -- weights make and lose no energy, undamped
    local free = model_of(kind, case, jitter, law, { points = points })
    free:seat { gap = 0.05 * SIZE, overlap = 0.05 * SIZE }
    free.gravity = { 0, 0, -10 }
    free:timestep { fraction = 0.1 }
    free:cycle(300)
    check.holds(math.abs(free:energy().balance) < BALANCE, what .. ": balance " .. free:energy().balance)
end

for seed = 1, check.cases(50) do
    local rest = seated.at_rest(seed)
    check.equal(rest.before, 0)
    check.holds(rest.first < NONE and rest.later < NONE and rest.unchanged, "seed " .. seed .. ": without force, and as it was when seated again")
end

-- ---- what stood stands, with the same thrust; what fell falls ----

local function thrust(jitter, seed, more)
    local model = talus.model { gravity = { 0, 0, -10 }, contact_points = more.points }
    local o = { jitter = jitter, random = jittered.random(seed), inner = 5, outer = more.outer, backward = more.backward }
    jittered.arch(model, o)
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 40 })
    if jitter > 0 then
        model:seat {}
    end
    model:damping "local"
    local run = model:solve { ratio = 1e-6, max_cycles = more.outer < 5.5 and 8000 or 40000 }
    local between = { model:blocks { id = 10 }, model:blocks { id = 11 } }
    local c = model:contacts { between = between }[1]
    return run.reason, c and c.normal_force or 0
end

for _, points in ipairs { "consistent", "corners" } do
    local reason, exact = thrust(0, 1, { outer = 5.5, points = points })
    check.equal(reason, "ratio")
    for case = 1, check.cases(12) do
        local jitter = ({ 1e-6, 1e-5, 1e-4, 1e-3 })[case % 4 + 1]
        local why, force = thrust(jitter, case, { outer = 5.5, points = points, backward = case % 3 == 0 })
        check.equal(why, "ratio")
        check.near(force, exact, (jitter <= 1e-4 and 1e-3 or 1e-2) * exact)
    end
end
for case = 1, check.cases(4) do
    check.equal(thrust(({ 1e-6, 1e-5, 1e-4, 1e-3 })[case], case, { outer = 5.3 }), "cycles")
end

-- ---- the order of blocks, their attitude and the units make no difference ----

local function settled(more)
    local unit = more.unit or 1
    local model = talus.model { gravity = more.gravity or { 0, 0, -10 } }
    jittered.wall(model, { jitter = 1e-3, random = jittered.random(more.seed), place = more.place, backward = more.backward,
        density = DENSITY / unit ^ 3 })
    model:joint("*", "coulomb", { kn = KN / unit ^ 2, ks = KN / unit ^ 2, friction = 40 })
    local result = model:seat {}
    model:damping "local"
    model:solve { ratio = 1e-9 }
    local list = {}
    for _, c in ipairs(model:contacts()) do
        list[#list + 1] = c.normal_force
    end
    table.sort(list)
    return list, result
end

for seed = 1, check.cases(10) do
    local forces, result = settled { seed = seed }
    local most = forces[#forces]
    local a, s, c = seed, math.sin(seed), math.cos(seed)
    local function turned(x)
        local y = { c * x[1] - s * x[3], x[2], s * x[1] + c * x[3] }
        return { y[1] * c - y[2] * s + 30 * a, y[1] * s + y[2] * c - 7, y[3] + 100 }
    end
    local down = { 10 * s * c, 10 * s * s, -10 * c }
    for name, more in pairs {
        backward = { backward = true }, turned = { place = turned, gravity = down },
        millimetres = { unit = 1000, gravity = { 0, 0, -1e4 }, place = function(x) return { 1000 * x[1], 1000 * x[2], 1000 * x[3] } end },
    } do
        more.seed = seed
        local other, told = settled(more)
        local unit = more.unit or 1
        check.equal(#other, #forces)
        check.equal(told.contacts, result.contacts)
        check.near(told.largest_gap / unit, result.largest_gap, 1e-12)
        check.near(told.mean_overlap / unit, result.mean_overlap, 1e-12)
        for i, force in ipairs(forces) do
            local scale = name == "millimetres" and unit or 1
            check.holds(math.abs(other[i] / scale - force) < 2e-4 * most, name .. ": " .. other[i] / scale .. " is not " .. force)
        end
    end
end

-- ---- a seated block that slides off makes no energy, and goes on as from one that was drawn so ----

for case = 1, check.cases(12) do
    local random = jittered.random(case)
    local gap, tilt = 1e-3 * random(), 2e-3 * random()
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 1, 1, 0 }, density = DENSITY })
    local vertices = {}
    for i = 0, 7 do
        local x, y = i % 2, i // 2 % 2
        vertices[#vertices + 1] = { x - 0.5, y - 0.5, i // 4 + gap + (i < 4 and tilt * (x - 0.5) or 0) }
    end
    model:generate("polyhedron", { vertices = vertices, density = DENSITY })
    model:blocks { id = 1 }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = case % 3 * 10 })
    check.equal(model:seat { gap = 0.01, overlap = 0.01 }.contacts, 1)
    check.holds(forces(model) == 0 or forces(model) < 1e-4, "without force")
    model:blocks { id = 2 }:set { velocity = { 3, 0.2, 0 } }
    model:timestep { fraction = 0.1 }
    repeat
        model:cycle(200)
        check.holds(math.abs(model:energy().balance) < 1e-3, "sliding off: balance " .. model:energy().balance)
    until model.time > 1
end

-- ---- whatever is done to a seated model, it stays without force ----

-- Blocks that touch a block picked at random, and it.
local function neighbours(model, pick)
    local contacts = model:contacts()
    local of = contacts[1 + math.floor(pick * #contacts)].blocks
    local ids = { of[1].id, of[2].id }
    return model:blocks():where(function(b) return b.id == ids[1] or b.id == ids[2] end)
end

local bonded = { kn = KN, ks = KN, friction = 30, tension = 1e6, cohesion = 1e6 }
local edits = {
    { "cut", function(model, kind, random)
        local name = "cut " .. #model:joints()
        model:generate("joint", { joint = name, dip = 45 + 44 * random(), dip_direction = 180 + 179 * random(),
            origin = { 1.5 + random(), 0.25, kind.name == "wall" and 1 or 4 } })
        pcall(model.joint, model, name, "coulomb_tensile", bonded) -- which may have cut nothing
    end },
    { "join", function(model, _, random) pcall(function() neighbours(model, 0.5 + 0.5 * random()):join() end) end },
    { "unjoin", function(model) model:blocks():unjoin() end },
    { "filter", function(model, _, random)
        local volume = 0.02 * (1 + random())
        model:filter { volume = volume, aspect = 30, action = random() > 0 and "join" or "delete" }
    end },
    { "group", function(model, _, random)
        local group = random() > 0 and "one" or "other"
        neighbours(model, 0.5 + 0.5 * random()):set { group = group }
        model:joint({ group = group }, random() > 0 and "coulomb" or "elastic", { kn = 2 * KN, ks = KN })
    end },
    { "delete", function(model, _, random) neighbours(model, 0.5 + 0.5 * random()):where(function(b) return not b.fixed end):delete() end },
    { "law", function(model) model:joint("*", "coulomb_tensile", bonded) end },
    -- parts may lie on each other by slivers of faces by which their wholes did not: those are new, and then stay
    { "seat", function(model)
        model:seat { gap = 0.05 * SIZE, overlap = 0.05 * SIZE }
        check.equal(model:seat { gap = 0.05 * SIZE, overlap = 0.05 * SIZE }.contacts, 0)
    end },
}

local function restored(model)
    local path = os.tmpname()
    model:save(path)
    local file = talus.restore(path)
    os.remove(path)
    return file
end

for case = 1, check.cases(100) do
    local kind, jitter, random = kinds[case % 3 + 1], jitters[case % 5 + 1], jittered.random(500 + case)
    local model = model_of(kind, 500 + case, jitter, { law = "coulomb_tensile", params = bonded }, { points = case % 4 == 0 and "corners" or nil })
    model:seat { gap = 0.05 * SIZE, overlap = 0.05 * SIZE }
    local done = ("case %d, %s, jitter %g:"):format(case, kind.name, jitter)
    for _ = 1, 8 do
        local edit = edits[1 + math.floor((0.5 + 0.5 * random()) * #edits)]
        done = done .. " " .. edit[1]
        edit[2](model, kind, random)
        local others = { model:copy(), restored(model) }
        for _, other in ipairs(others) do
            check.equal(other:state_hash(), model:state_hash())
        end
        if random() > 0 then
            rests(model, done, 10)
            for _, other in ipairs(others) do
                other:cycle(10)
                check.equal(other:state_hash(), model:state_hash())
            end
        end
    end
    rests(model, done, 20)
end

-- ---- blocks that overlap by an edge or a vertex ----

for case = 1, check.cases(20) do
    local random = jittered.random(100 + case)
    local model = talus.model { gravity = { 0, 0, 0 } }
    local d = 2e-3 * (1.5 + random())
    local offset = case % 2 == 0 and 1 - d or 0.3 * random() -- of two cubes that meet at a vertex, or along an edge
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY })
    model:generate("box", { min = { 1 - d, 1 - 1.1 * d, offset }, max = { 2 - d, 2 - 1.1 * d, offset + 1 }, density = DENSITY })
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 30 })
    model:seat { gap = 0.01, overlap = 0.01 }
    rests(model, "edge " .. case)
end

-- ---- what lies beyond the limits is told and stays ----

do
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, -1 }, max = { 3, 1, 0 }, density = DENSITY })
    model:generate("box", { min = { 0, 0, -0.02 }, max = { 1, 1, 1 }, density = DENSITY })
    model:generate("box", { min = { 2, 0, 0.001 }, max = { 3, 1, 1 }, density = DENSITY })
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 30 })
    local result = model:seat { gap = 0.002, overlap = 0.01 }
    check.equal(result.contacts, 1)
    check.equal(#result.beyond, 1)
    check.equal(result.beyond[1].a.id, 1)
    check.equal(result.beyond[1].b.id, 2)
    check.near(result.beyond[1].overlap, 0.02, 1e-12)
    check.near(result.largest_gap, 0.001, 1e-12)
    check.near(result.mean_gap, 0.001, 1e-12)
    check.equal(result.largest_overlap, 0)
    check.near(result.gap, 0.002, 0)
    check.equal(#model:seat { gap = 0.002, overlap = 0.05 }.beyond, 0)
    -- by default 1 % of the mean size
    local sizes = { 3 ^ (1 / 3), (1.02) ^ (1 / 3), 0.999 ^ (1 / 3) }
    check.near(model:seat {}.gap, 0.01 * (sizes[1] + sizes[2] + sizes[3]) / 3, 1e-12)
    check.refused(model, function() model:seat { gap = -1 } end, "gap")
    check.refused(model, function() model:seat { gab = 1 } end, "gap")
    check.refused(model, function() model:seat { overlap = "much" } end, "overlap")
    -- rigid blocks only
    model:solid("stone", "elastic", { young = 1e9, poisson = 0.2 })
    check.refused(model, function() model:blocks { id = 3 }:deformable { zone = 0.5, solid = "stone" } end, "seated")
    local soft = talus.model {}
    soft:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY })
    soft:generate("box", { min = { 0, 0, 1.001 }, max = { 1, 1, 2 }, density = DENSITY })
    soft:solid("stone", "elastic", { young = 1e9, poisson = 0.2 })
    soft:joint("*", "coulomb", { kn = KN, ks = KN, friction = 30 })
    soft:blocks { id = 2 }:deformable { zone = 0.5, solid = "stone" }
    check.refused(soft, function() soft:seat {} end, "block 2 is deformable and does not fit block 1")
    check.equal(soft:seat { gap = 1e-4 }.contacts, 0)
    local empty = talus.model {}
    check.equal(empty:seat {}.contacts, 0)
end
