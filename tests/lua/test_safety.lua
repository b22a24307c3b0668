-- Factors of safety by divided strengths: what is found, what is refused, and that the model stays as it is.
local check = require "check"
local every_law = require "every_law"
local talus = require "talus"

local DIP = 30

-- A cube on an inclined block, which is held.
local function incline(law, params, dip)
    local model = talus.model {}
    local t = math.tan(math.rad(dip or DIP))
    model:generate("profile", { section = { { 0, -2 }, { 6, -2 }, { 6, 6 * t }, { 0, 0 } }, to = 2, density = 2500 })
    model:blocks():fix()
    model:generate("profile", { section = { { 2, 2 * t }, { 4, 4 * t }, { 4, 4 * t + 1 }, { 2, 2 * t + 1 } }, from = 0.5, to = 1.5,
        density = 2500 })
    if law then
        model:joint("*", law, params)
    end
    return model
end

local function tangent(degrees)
    return math.tan(math.rad(degrees))
end

local COULOMB = { kn = 1e9, ks = 1e9, friction = 40 }

-- What is found.
local model = incline("coulomb", COULOMB)
local before, calls = model:state_hash(), 0
local r = model:factor_of_safety { on_trial = function(trial)
    calls = calls + 1
    check.holds(trial.F > 0 and trial.cycles > 0 and type(trial.holds) == "boolean", "a trial has its fields")
    check.raises(function()
        model:cycle(1)
    end, "cannot be called from a function")
end }
local expected = tangent(40) / tangent(DIP)
check.near(r.factor / expected, 1, 0.01)
check.holds(r.lower < r.factor and r.factor < r.upper and r.upper <= 1.0101 * r.lower, "the bracket is narrow")
check.equal(calls, #r.trials)
check.equal(model:state_hash(), before)
check.equal(#r.failing, 1)
check.equal(r.failing[1].id, model:blocks { fixed = false }[1].id)
check.near(r.volume, 2, 1e-9)
check.equal(r.mode, "slides")
check.near(r.direction, { -math.cos(math.rad(DIP)), 0, -math.sin(math.rad(DIP)) }, 0.01)
check.near(r.keyblock.factor, expected, 1e-9)
check.equal(r.keyblock.block.id, r.failing[1].id)
check.equal(r.undecided, 0)
check.holds(r.message:find("factor of safety", 1, true), "the message tells the factor")

-- Processes beside this one change nothing: the same trials, in the same order, each told once.
local function told(options)
    local list = {}
    options.on_trial = function(trial)
        list[#list + 1] = string.format("%a %s %s %d %s", trial.F, trial.holds, trial.undecided, trial.cycles,
            trial.why)
    end
    return model:factor_of_safety(options), table.concat(list, "\n")
end
local alone, trials = told { resolution = 0.002 }
for _, workers in ipairs { 2, 3, 8 } do
    local with, same = told { resolution = 0.002, workers = workers }
    check.equal(same, trials)
    check.equal(with.factor, alone.factor)
    check.equal(with.cycles, alone.cycles)
    check.equal(with.failing[1].id, alone.failing[1].id)
    check.near(with.direction, alone.direction, 0)
    check.equal(with.message, alone.message)
end
check.equal(model:state_hash(), before)

-- A function that fails ends the search; the model stays as it was.
for _, workers in ipairs { 1, 2 } do
    check.refused(model, function()
        model:factor_of_safety { workers = workers, on_trial = function()
            error "enough"
        end }
    end, "enough")
end

-- Where the bracket ends.
check.equal(model:factor_of_safety { from = 0.2, to = 0.9 }.factor, math.huge)
local low = model:factor_of_safety { from = 2, to = 3 }
check.equal(low.factor, 2)
check.equal(low.lower, 0)

-- Strengths that only are marked: cohesion, angles, a divisor, works of fracture; and a law of somebody else.
local weight = model:blocks { fixed = false }[1].mass * 9.81
local area = 2 / math.cos(math.rad(DIP))
local normal, shear = weight * math.cos(math.rad(DIP)), weight * math.sin(math.rad(DIP))
local c = 0.4 * shear / area
for _, one in ipairs {
    { "coulomb", { kn = 1e9, ks = 1e9, friction = 30, cohesion = c }, (c * area + normal * tangent(30)) / shear },
    { "coulomb", { kn = 1e9, ks = 1e9, cohesion = 5 * c }, 2 },
    { "coulomb_tensile", { kn = 1e9, ks = 1e9, friction = 40, residual_friction = 35, dilation = 20 }, expected },
    { "barton_bandis", { jrc = 0, jcs = 1e8, phi_r = 40, kni = 1e10, vm = 1e-3, ks = 1e9 }, expected },
    { "my_law", { kn = 1e9, ks = 1e9, friction = 40, residual = 40 }, expected },
    { "slip_weakening", { kn = 1e9, ks = 1e9, friction = 40, residual_friction = 38, distance = 1 }, expected },
} do
    local found = incline(one[1], one[2]):factor_of_safety {}
    check.near(found.factor / one[3], 1, 0.012)
end

-- A factor never makes parameters that a law takes ones that it refuses.
for _, joint in ipairs(every_law(1e9, 1e5)) do
    local other = incline(joint.law, joint.params, 5)
    if joint.law ~= "elastic" and joint.law ~= "glue" then
        check.holds(other:factor_of_safety { from = 0.5, to = 2, resolution = 0.5 }.factor > 0, joint.name)
    end
end

-- Friction of 90 stays: nothing slides, whatever the factor.
check.equal(incline("coulomb", { kn = 1e9, ks = 1e9, friction = 90 }):factor_of_safety {}.factor, math.huge)

-- Nothing holds it.
local falling = incline("coulomb", COULOMB)
falling:generate("box", { min = { 2.5, 0.8, 8 }, max = { 2.7, 1, 8.2 }, density = 2500 })
local none = falling:factor_of_safety {}
check.equal(none.factor, 0)
check.equal(none.mode, "falls")
check.equal(#none.failing, 1)
-- Once it is too small to matter, it goes first.
local rest = falling:factor_of_safety { least_volume = 0.1 }
check.equal(#rest.small, 1)
check.near(rest.factor / expected, 1, 0.01)

-- A map: two cubes at two factors, with one file that shows them.
local two = incline("coulomb", COULOMB)
two:joint("*", { friction = 40 })
local map = two:safety_map { from = 1, to = 2, step = 0.05 }
local id = two:blocks { fixed = false }[1].id
check.holds(math.abs(map.factor[id] - expected) <= 0.06, "the block has its factor")
check.equal(#map.curve, 1)
check.equal(map.curve[1].blocks, 1)
check.near(map.curve[1].volume, 2, 1e-9)
check.equal(two:safety_map { from = 1, to = 2, step = 0.05, failed = "hold" }.factor[id], map.factor[id])
local beside = two:safety_map { from = 1, to = 2, step = 0.05, workers = 3 }
check.equal(beside.factor[id], map.factor[id])
check.equal(beside.cycles, map.cycles)
two:write_vtk(os.getenv "TALUS_TEST_TMP" and os.getenv "TALUS_TEST_TMP" .. "/safety" or os.tmpname(),
    { block_fields = { safety = map.factor } })
check.raises(function()
    two:write_vtk("x", { block_fields = { safety = { [id] = "a" } } })
end, "'safety' has the string 'a' for block " .. id .. ", and not a number")

-- Keyblocks tell what support a factor takes.
local key = model:keyblocks { friction = 40, target = 1.5 }[1]
check.near(key.support / (shear - normal * tangent(40) / 1.5), 1, 1e-9)
check.equal(key.support_pressure, nil) -- its front and its back look along the plane, and cancel
check.equal(model:keyblocks({ friction = 40, target = 1 })[1].support, 0)
check.equal(model:keyblocks({ friction = 40 })[1].support, nil)

-- A pyramid that falls takes all of its weight, over the area of its base.
local roof = talus.model {}
roof:generate("roof_wedge", { dip_a = 60, dip_direction_a = 0, dip_b = 60, dip_direction_b = 120, dip_c = 60, dip_direction_c = 240,
    span = 12, height = 3, density = 2600 })
local hangs = roof:blocks { group = "wedge" }
roof:blocks():fix()
hangs:free()
local pyramid = roof:keyblocks({ friction = 30, target = 2 })[1]
check.equal(pyramid.mode, "falling")
check.near(pyramid.support / (hangs[1].mass * 9.81), 1, 1e-9)
check.near(pyramid.support_pressure * (3 * hangs[1].volume / 3) / pyramid.support, 1, 1e-6)

-- What is refused leaves the model as it was.
local function refused(part, options, other)
    local m = other or model
    check.refused(m, function()
        m:factor_of_safety(options)
    end, part)
end
refused("from = 3 must be below to = 2", { from = 3, to = 2 })
refused("from = 2 must be below to = 2", { from = 2, to = 2 })
refused("from = 0.01 must be >= 0.05", { from = 0.01 })
refused("resolution = 0 is outside [0.0001, 0.5]", { resolution = 0 })
refused("resolution = 0.6 is outside", { resolution = 0.6 })
refused("max_cycles = 0 must be >= 1", { max_cycles = 0 })
refused("least_volume = -1 m3 must be >= 0", { least_volume = -1 })
refused("joints: unknown joint 'A'", { joints = { "A" } })
refused("joints is an empty list", { joints = {} })
refused("joints must be a name or a list of names, not the number 1", { joints = 1 })
refused("on_trial must be a function, not the number 1", { on_trial = 1 })
refused("unknown parameter 'form'; did you mean 'from'?", { form = 1 })
local good, message = pcall(model.factor_of_safety, model, { on_trial = function()
    error("enough", 0)
end })
check.holds(not good and message == "enough", "the error of on_trial comes through")
check.equal(model:state_hash(), before)
local held = incline("coulomb", COULOMB)
held:blocks():fix()
refused("nothing can move: no block is free", {}, held)
local driven = incline("coulomb", COULOMB)
driven:blocks { fixed = false }:drive { velocity = { 0.1, 0, 0 } }
refused("is driven: take the drive off first", {}, driven)
local moving = incline("coulomb", COULOMB)
moving:blocks { fixed = false }:set { velocity = { 0.1, 0, 0 } }
refused("the model moves (block 2 at 0.1 m/s): bring it to rest first, with model:relax{}", {}, moving)
refused("no parameter of the laws 'elastic' is marked as a strength", {}, incline("elastic", { kn = 1e9, ks = 1e9 }))
refused("the model has no law whose strengths could be divided", {}, incline())
refused("workers = 0", { workers = 0 })
refused("workers = 257", { workers = 257 })
do
    local threaded <close> = talus.model { threads = 2 }
    check.refused(model, function()
        model:factor_of_safety { workers = 2 }
    end, "other threads run")
end
check.refused(model, function()
    model:safety_map { failed = "keep" }
end, "unknown failed 'keep'")
check.refused(model, function()
    model:safety_map { step = 0 }
end, "step = 0")
check.refused(model, function()
    model:keyblocks { friction = 40, target = 0 }
end, "target = 0 must be > 0")

-- One joint only: a law of its own is asked for.
local part = incline("coulomb", COULOMB)
part:blocks { fixed = true }
part:generate("joint", { joint = "A", dip = 0, dip_direction = 0, origin = { 0, 0, -1 } })
refused("joint 'A' has no law of its own whose strengths could be divided; give it one", { joints = "A" }, part)
part:joint("A", "coulomb", { kn = 1e9, ks = 1e9, friction = 5 })
check.equal(part:factor_of_safety({ joints = "A" }).factor, math.huge) -- it is level
check.near(part:factor_of_safety({ joints = { "*" } }).factor / expected, 1, 0.01)

-- Strengths of elements: a block that hangs on a bolt of twice its weight, by the steel, by the grout, by a spring. Bolts keep their
-- strengths unless these are asked for; a pretension may be above what is left of them.
local HANGS = 25e3 -- N
local function hanging(kind, params)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { 100, 0, 0 }, max = { 101, 1, 2 }, density = 2500 })
    m:blocks():fix()
    m:generate("box", { min = { 100, 0, -1 }, max = { 101, 1, 0 }, density = 2500 })
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 0 })
    params.from, params.to = { 100.5, 0.5, -1 }, { 100.5, 0.5, 1.5 }
    m:element(kind, params)
    return m
end
for _, one in ipairs {
    { "bolt", { yield = 2 * HANGS } },
    { "bolt", { grout_strength = 2 * HANGS, plate_stiffness = 0 } },
    { "bolt", { yield = 2 * HANGS, pretension = 1.9 * HANGS, rupture_strain = 1e5 } },
    { "spring", { stiffness = 1e7, strength = 2 * HANGS, pretension = HANGS } },
} do
    local hung = hanging(one[1], one[2])
    local was = hung:state_hash()
    local free = hung:factor_of_safety { elements = true }
    check.near(free.factor / 2, 1, 0.012)
    check.equal(free.undecided, 0)
    check.equal(hung:factor_of_safety({ elements = true, workers = 2 }).factor, free.factor)
    check.equal(hung:factor_of_safety({}).factor, math.huge)
    check.equal(hung:state_hash(), was)
end
