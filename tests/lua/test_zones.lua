-- Deformable blocks from Lua: solids, zoning, zones and gridpoints, histories of them, saves, and bad input.
local talus = require "talus"
local check = require "check"

local function pair_of_cubes()
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "low" },
        { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500, group = "high" } })
    model:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 30 })
    model:solid("granite", "mohr_coulomb",
        { young = 1e9, poisson = 0.25, cohesion = 1e6, friction = 30, tension = 1e5 })
    return model
end

-- ---------------------------------------------------------------- zoning

local model = pair_of_cubes()
local high, low = model:blocks { group = "high" }, model:blocks { group = "low" }
low:fix()
local made = high:deformable { zone = 0.3, solid = "granite" }
check.equal(made.blocks, 1)
check.equal(made.zones, #model:zones())
check.equal(made.gridpoints, #model:gridpoints())
check.equal(made.zones, high[1].zones)
check.equal(made.gridpoints, high[1].gridpoints)
check.holds(made.clusters > made.zones / 10 and made.clusters < made.zones / 4)
check.holds(made.smallest_altitude > 0.05 and made.altitude_ratio > 0.2 and made.time_step > 0 and made.memory > 0)
check.holds(made.inertia > 1 and made.inertia < 1.3)
check.equal(made.worst_block, high[1])
check.equal(high[1].deformable, true)
check.equal(low[1].deformable, false)
check.equal(low[1].zones, 0)
check.near(model:zones():sum("volume"), 1, 1e-12)
check.near(model:gridpoints():sum("mass"), 2500, 1e-9)

-- What is asked for is looked at before zones are made.
local again = pair_of_cubes()
check.raises(function() again:blocks():deformable { edge = 0.3, solid = "granite" } end, "deformable: unknown parameter 'edge'")
check.raises(function() again:blocks():deformable { zone = 1e-3, solid = "granite" } end,
    "block 1 would get some 8.5e+09 zones with an edge of 0.001 m, and can have 5e+08: give larger ones")
check.raises(function() again:blocks():deformable { zone = 0.3, solid = "basalt" } end,
    "there is no solid 'basalt': name it with model:solid first")
check.raises(function() again:solid("basalt", { young = 1e9 }) end,
    "there is no solid 'basalt' in this model yet: name its kind, as in model:solid(\"basalt\", \"elastic\", {...})")
check.raises(function() again:solid("granite", "mohr_coulomb", { young = 1e9, poisson = 0.2, cohesion = { { 0, 1e6 }, { 0.1, 0 } } }) end,
    "cohesion must be a number, not a list of rows of 2 numbers")
check.raises(function() again:solid("granite", "elastic", { young = 1e9, bulk = 1e9 }) end, "none of the other pair")
check.raises(function() again:deformable { zone = 0.3, solid = "granite" } end,
    "a model has no field 'deformable'; a selection has it: model:blocks{...}:deformable")

-- A function of the place: fine below, coarse above.
local graded = pair_of_cubes()
graded:blocks { group = "high" }:deformable { zone = function(p) return 0.15 + 0.4 * (p[3] - 1) end, solid = "granite" }
local halves = { #graded:zones { inside = { min = { 0, 0, 1 }, max = { 1, 1, 1.5 } } },
    #graded:zones { inside = { min = { 0, 0, 1.5 }, max = { 1, 1, 2 } } } }
check.holds(halves[1] > 3 * halves[2], "zones are small where they shall be")

-- ---------------------------------------------------------------- which

check.equal(#model:zones { group = "high" }, made.zones)
check.equal(#model:zones { group = "low" }, 0)
check.equal(#model:zones { block = high[1] }, made.zones)
check.equal(#model:zones { block = low[1].id }, 0)
check.equal(#model:zones { blocks = low }, 0)
check.equal(#model:zones { solid = "granite", plastic = false }, made.zones)
check.equal(#model:zones { plastic = true }, 0)
local one = model:zones { containing = { 0.31, 0.42, 1.53 } }[1]
check.equal(model:zones { id = one.id }[1], one)
check.equal(#model:zones { id = { one.id, 5 } }, 1)
check.equal(one.block, high[1])
check.equal(one.group, "high")
check.equal(one.solid, "granite")
check.equal(one.state, "elastic")
check.equal(one.plastic, false)
check.equal(one.plastic_shear, 0.0)
check.equal(model:zones { near = one.centroid }[1], one)
local corner = model:gridpoints { near = { 1, 1, 2 } }[1]
check.equal(corner.surface, true)
check.near(corner.position[3], 2, 1e-12)
check.equal(#model:gridpoints { surface = true } + #model:gridpoints { surface = false }, made.gridpoints)
local top = model:gridpoints { inside = { min = { 0, 0, 2 - 1e-9 }, max = { 1, 1, 2 + 1e-9 } } }
check.holds(#top > 4)
check.equal(#top, #model:gridpoints { where = function(p) return p.position[3] > 2 - 1e-9 end })
high:hide()
check.equal(#model:zones(), 0, "zones of hidden blocks are left out")
check.equal(#model:zones { blocks = high }, made.zones)
high:show()

-- ---------------------------------------------------------------- coming to rest

model:damping("local")
model:history { name = "stress", every = 50, of = one, field = "stress" }
model:history { name = "top", every = 50, of = top, field = "displacement" }
model:solve { ratio = 1e-6 }
local kept = model:histories()
local low_row = model:gridpoints { inside = { min = { 0, 0, 0.9 }, max = { 1, 1, 1.1 } } }
check.near(one.stress.zz, -10 * 2500 * (2 - one.centroid[3]), 2500)
check.near(one.mean, (one.stress.xx + one.stress.yy + one.stress.zz) / 3, 1e-6)
check.near(one.principal[1] + one.principal[2] + one.principal[3], 3 * one.mean, 1e-6)
check.near(high[1].stress.zz, -10 * 2500 / 2, 10)
check.holds(one.strain.zz < 0)
check.holds(top:max("mass") > 0 and #low_row > 4)
check.near(model:zones():values("stress", "flat")[3], model:zones()[1].stress.zz, 0)
check.equal(#kept.stress.value[1], 6)
check.near(kept.stress.value[1][3], 0, 0)
check.near(kept.stress.value[#kept.stress.value][3], one.stress.zz, 500)
check.holds(kept.top.value[#kept.top.value][3] < 0)

-- ---------------------------------------------------------------- gridpoints

local down = pair_of_cubes()
down.gravity = { 0, 0, 0 }
down:blocks { group = "low" }:delete()
down:blocks():deformable { zone = 0.5, solid = "granite" }
local foot = down:gridpoints { inside = { min = { 0, 0, 1 }, max = { 1, 1, 1 } } }
local head = down:gridpoints { inside = { min = { 0, 0, 2 }, max = { 1, 1, 2 } } }
foot:fix { z = true }
down:gridpoints { near = { 0, 0, 1 } }:fix()
down:gridpoints { near = { 1, 0, 1 } }:fix { y = true }
check.equal(#down:gridpoints { fixed = true }, #foot)
head:load { force = { 0, 0, -1e4 / #head } }
down:damping("local")
down:solve { ratio = 1e-7 }
check.near(foot:reaction()[3], 1e4, 1)
down:gridpoints():set { velocity = { 0, 0, 0.5 } }
check.near(head:max("mass") > 0 and head[1].velocity[3], 0.5, 0)
down:gridpoints():set { velocity = function(p, v) return p[1], 0, v[3] + 1 end }
check.near(head[1].velocity[3], 1.5, 0)
foot:free()
check.equal(#down:gridpoints { fixed = true }, 0)

-- ---------------------------------------------------------------- solids

model:solid("granite", { cohesion = 2e6 })
model:solid("granite", "elastic", { young = 1e9, poisson = 0.25 })
check.equal(one.solid, "granite")
check.raises(function() return one.plastic_shear end, "a zone has no field 'plastic_shear'")
model:solid("granite", "ubiquitous", { young = 1e9, poisson = 0.25, cohesion = 1e6, friction = 30, tension = 1e5,
    joint_cohesion = 1e5, joint_friction = 20, dip = 30, dip_direction = 90 })
check.equal(one.plastic_shear, 0.0)
model:cycle(10)

-- Components of vectors and tensors are columns of their own, and samples of a tensor have their names.
local all = model:zones()
local vertical, stresses = all:values("stress.zz"), all:values("stress")
for i, tensor in ipairs(stresses) do
    check.equal(vertical[i], tensor.zz)
end
check.equal(all:min("stress.zz"), math.min(table.unpack(vertical)))
check.equal(all:max("principal.x") >= all:max("principal.z"), true)
check.near(all:sum("principal.y"), all:sum("principal")[2], 1e-6)
check.raises(function() all:max("stress") end, "max: the field 'stress' of a zone is not a number: ask for a component, as 'stress.zz'")
check.raises(function() all:min("principal") end, "only single numbers are compared: ask for a component, as 'principal.z'")
check.raises(function() model:blocks():min("displacement") end, "only single numbers are compared")
check.equal(model:gridpoints():values("displacement.z")[3], model:gridpoints()[3].displacement[3])
check.raises(function() all:values("stress.z") end, "a zone has no field 'stress.z'")
check.raises(function() all:max("volume.x") end, "a zone has no field of numbers 'volume.x'")
check.raises(function() model:gridpoints():values("displacement.") end, "a gridpoint has no field 'displacement.'")
model:history { name = "six", every = 1, value = function() return 1, 2, 3, 4, 5, 6 end }
local samples = model:histories()
check.equal(samples.stress.zz[2], samples.stress.value[2][3])
check.equal(#samples.stress.zx, #samples.stress.value)
check.equal(samples.six.zz, nil)
local csv = os.getenv("TALUS_TEST_TMP") .. "/zones.csv"
model:write_histories(csv)
local head_line = io.lines(csv)()
check.holds(head_line:find("stress.xx,stress.yy,stress.zz,stress.xy,stress.yz,stress.zx", 1, true), head_line)
check.holds(head_line:find("six.1,six.2", 1, true), head_line)
model:history { name = "six", remove = true }

-- ---------------------------------------------------------------- saves

local path = os.getenv("TALUS_TEST_TMP") .. "/zones.talus"
model:save(path)
local again = talus.restore(path)
check.equal(again:state_hash(), model:state_hash())
model:cycle(20)
again:cycle(20)
check.equal(again:state_hash(), model:state_hash())

-- ---------------------------------------------------------------- bad input

local fresh = pair_of_cubes()
local rock = fresh:blocks()
for given, sentence in pairs {
    [{ zone = 0, solid = "granite" }] = "deformable: zone must be the wanted edge of zones",
    [{ solid = "granite" }] = "deformable: zone must be the wanted edge of zones",
    [{ zone = "small", solid = "granite" }] = "not the string 'small'",
    [{ zone = 1 }] = "solid",
    [{ zone = 1, solid = "granit" }] = "there is no solid 'granit'; did you mean 'granite'?",
    [{ zone = 1, solid = "granite", size = 3 }] = "unknown parameter 'size'",
} do
    local before = fresh:state_hash()
    check.refused(fresh, function() rock:deformable(given) end, sentence)
    check.equal(fresh:state_hash(), before)
    check.equal(rock[1].deformable, false)
end
check.refused(fresh, function() rock:deformable { zone = function() return -1 end, solid = "granite" } end, "gave the number -1")
check.refused(fresh, function() rock:deformable { zone = function() error "no size" end, solid = "granite" } end, "no size")
check.refused(fresh, function() fresh:solid("rock", "mohr_coulom", {}) end, "did you mean 'mohr_coulomb'")
check.refused(fresh, function() fresh:solid("rock", { young = 1 }) end, "there is no solid 'rock' in this model yet")
check.refused(fresh, function() fresh:solid("", "elastic", { young = 1, poisson = 0 }) end, "must have 1 to")
check.refused(fresh, function() fresh:solid("rock", "elastic", { young = 1e9, poisson = 0.5 }) end, "poisson")
check.refused(fresh, function() fresh:zones { solid = "chalk" } end, "there is no solid 'chalk'")
check.refused(fresh, function() fresh:zones { blok = 1 } end, "did you mean 'block'")
check.refused(fresh, function() fresh:zones { block = 99 } end, "block 99 does not exist")
check.refused(fresh, function() fresh:gridpoints { near = 3 } end, "near")
check.refused(model, function() model:gridpoints():fix { x = false } end, "fix: no component is named")
check.refused(model, function() model:gridpoints():set { velocity = function() return 1 end } end,
    "velocity must give three finite numbers")
check.refused(model, function() one.stress = 1 end, "the fields of a zone can only be read")
