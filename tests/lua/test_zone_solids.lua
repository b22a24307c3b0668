-- Deformable blocks from Lua: zones of other solids, histories of points, held blocks, and what listings tell.
local talus = require "talus"
local check = require "check"

-- Two cubes on each other, the lower one rigid and held unless both shall have zones.
local function cubes(both)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "low" },
        { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500, group = "high" } })
    model:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 30 })
    model:solid("granite", "mohr_coulomb", { young = 1e9, poisson = 0.25, cohesion = 1e6, friction = 30, tension = 1e5,
        cohesion_table = { { 0, 1e6 }, { 0.01, 1e5 } } })
    model:solid("fault", "elastic", { young = 1e8, poisson = 0.25 })
    model:blocks { group = "high" }:deformable { zone = 0.3, solid = "granite" }
    if both then
        model:blocks { group = "low" }:deformable { zone = 0.3, solid = "granite" }
    end
    return model
end

-- ---------------------------------------------------------------- other solids

local model = cubes()
model:blocks { group = "low" }:fix()
model:damping("local")
model:solve { ratio = 1e-5 }
local zones = model:zones()
local before = zones:values("stress", "flat")
local layer = model:zones { inside = { min = { 0, 0, 1 }, max = { 1, 1, 1.4 } } }
layer:set { solid = "fault" }
check.equal(#model:zones { solid = "fault" }, #layer)
check.equal(#model:zones { solid = "granite" }, #zones - #layer)
check.equal(layer[1].solid, "fault")
check.raises(function() return layer[1].plastic_shear end, "a zone has no field 'plastic_shear'")
local after = zones:values("stress", "flat")
for i = 1, #before do
    check.near(after[i], before[i], 0)
end
local top = model:gridpoints { near = { 1, 1, 2 } }
local was = top[1].displacement[3]
model:solve { ratio = 1e-5 }
check.near(layer:sum("volume"), 0.4, 0.2)
check.near(top[1].displacement[3], was, 0.05 * math.abs(was)) -- stress stays, so nothing moves
check.near(model:energy().balance, 0, 1e-3)
model:blocks { group = "high" }:set { solid = "granite", group = "whole" }
check.equal(#model:zones { solid = "granite", group = "whole" }, #zones)

local hash = model:state_hash()
check.raises(function() model:zones():set { solid = "granit" } end, "there is no solid 'granit'")
check.raises(function() model:zones():set {} end, "solid")
check.raises(function() model:blocks():set { solid = "fault", group = "x" } end, "block 1 has no solid: it is rigid")
check.raises(function() model:blocks { group = "whole" }:set { solid = "fault", density = 3000 } end, "density")
check.raises(function() model:blocks():set {} end, "set: give density, group, velocity, angular_velocity or solid")
check.equal(model:state_hash(), hash)

-- Within a run: after some steps a layer grows soft, and a saved model goes on to the same bits.
local runs = cubes()
runs:blocks { group = "low" }:fix()
runs:damping("local")
local softened = false
runs:solve { max_cycles = 60, ratio = 1e-12, every = 20, on_progress = function(m)
    if not softened then
        m:zones { inside = { min = { 0, 0, 1 }, max = { 1, 1, 1.5 } } }:set { solid = "fault" }
        softened = true
    end
end }
check.holds(softened and #runs:zones { solid = "fault" } > 0)
local path = os.getenv("TALUS_TEST_TMP") .. "/zone_solids.talus"

-- ---------------------------------------------------------------- points

local point = { 0.31, 0.42, 1.53 }
local zone = runs:zones { containing = point }[1]
runs:history { name = "stress", every = 5, at = point, field = "stress" }
runs:history { name = "moves", every = 5, at = point, field = "displacement" }
runs:history { name = "place", every = 5, at = point, field = "position" }
runs:history { name = "speed", every = 5, at = point, field = "velocity" }
runs:history { name = "zone", every = 5, of = zone, field = "stress" }
local first = runs:histories()
for k = 1, 3 do
    check.near(first.place.value[1][k], point[k], 1e-14)
end
runs:save(path)
local copy = talus.restore(path)
for _, m in ipairs { runs, copy } do
    m:cycle(50)
end
local here, there = runs:histories(), copy:histories()
check.equal(#here.stress.value, 11)
for _, name in ipairs { "stress", "moves", "place", "speed" } do
    for k = 1, #here[name].value[1] do
        check.near(there[name].value[11][k], here[name].value[11][k], 0)
    end
end
for k = 1, 6 do
    check.near(here.stress.value[11][k], here.zone.value[11][k], 0)
end
-- the place goes as the displacement, and between the corners of the zone
for k = 1, 3 do
    check.near(here.place.value[11][k] - here.place.value[1][k], here.moves.value[11][k] - here.moves.value[1][k], 1e-14)
end
local low, high = math.huge, -math.huge
for _, p in ipairs(runs:gridpoints { inside = { min = { -0.1, 0, 1 }, max = { 0.8, 0.9, 2 } } }) do
    low, high = math.min(low, p.displacement[3]), math.max(high, p.displacement[3])
end
check.holds(here.moves.z[11] > low and here.moves.z[11] < high and here.moves.z[11] < 0)
check.holds(math.abs(here.moves.z[11] - here.moves.z[1]) > 0)

for given, sentence in pairs {
    [{ at = { 5, 5, 5 }, field = "stress" }] = "history 'x': the point (5, 5, 5) is in no zone of a visible deformable block",
    [{ at = { 0.5, 0.5, 0.5 }, field = "stress" }] = "is in no zone",
    [{ at = point }] = "history 'x': say which field is to be sampled",
    [{ at = point, field = "forces" }] = "history 'x': a point has no field of numbers 'forces'",
    [{ at = point, field = "force" }] = "a point has no field of numbers 'force'",
    [{ at = point, field = "solid" }] = "a point has no field of numbers 'solid'",
    [{ at = point, field = "stress", of = zone }] = "with at give field, and neither of, value nor take",
    [{ at = point, field = "mean", take = "max" }] = "with at give field, and neither of, value nor take",
    [{ at = { 1, 2 }, field = "mean" }] = "at",
} do
    given.name = "x"
    check.raises(function() runs:history(given) end, sentence)
end
check.equal(runs:histories().x, nil)

-- ---------------------------------------------------------------- held blocks

local held = cubes(true)
check.equal(#held:blocks { fixed = true }, 0)
check.equal(#held:blocks { fixed = false }, 2)
check.equal(held:blocks()[1].fixed, false)
held:gridpoints { group = "low" }:fix { z = true }
check.equal(#held:blocks { fixed = true }, 0)
held:gridpoints { group = "low" }:fix()
check.equal(#held:blocks { fixed = true }, 1)
check.equal(held:blocks { fixed = true }[1].group, "low")
check.equal(held:blocks { group = "low" }[1].fixed, true)
held:gridpoints { near = { 0, 0, 0 } }:free { x = true }
check.equal(#held:blocks { fixed = true }, 0)

-- ---------------------------------------------------------------- listings

local solids = runs:solids()
check.equal(#solids, 2)
check.equal(solids[1].name, "granite")
check.equal(solids[1].kind, "mohr_coulomb")
check.equal(solids[1].parameters.young, 1e9)
check.equal(#solids[1].parameters.cohesion_table, 2)
check.equal(solids[1].parameters.cohesion_table[2][2], 1e5)
check.equal(solids[1].zones + solids[2].zones, #runs:zones())
check.near(solids[1].volume + solids[2].volume, runs:zones():sum("volume"), 1e-9)
check.equal(runs:parameters().solids.fault.kind, "elastic")
check.equal(runs:parameters().solids.fault.parameters.young, 1e8)
check.equal(#talus.model {}:solids(), 0)

local report = talus.report(runs)
check.equal(report.deformable, 1)
check.equal(report.zones, #runs:zones())
check.equal(report.gridpoints, #runs:gridpoints())
check.holds(report.clusters > 0 and report.segments > 0)
check.holds(report.smallest_altitude > 0.02 and report.smallest_altitude < 0.3)
check.equal(report.smallest_altitude_block.group, "high")
check.holds(report.timestep_message:find("gridpoint %d+ of block 2 controls the step"), report.timestep_message)
check.equal(report.timestep_block.group, "high")
check.equal(talus.report(talus.model {}).zones, 0)

runs:profile(true)
runs:cycle(20)
local cost = runs:profile()
check.equal(cost.zones, report.zones)
check.equal(cost.gridpoints, report.gridpoints)
check.holds(cost.segments > 0 and cost.seconds.zones > 0)
check.holds(runs:memory().zones > 100 * report.zones)

-- ---------------------------------------------------------------- drives

-- The head of a cube is pushed down by a function of time, on a held foot; its reaction is that of the foot.
local function pressed()
    local one = cubes()
    one.gravity = { 0, 0, 0 }
    one:blocks { group = "low" }:delete()
    one:damping("local")
    return one, one:gridpoints { inside = { min = { 0, 0, 1 }, max = { 1, 1, 1 } } },
        one:gridpoints { inside = { min = { 0, 0, 2 }, max = { 1, 1, 2 } } }
end
local one, foot, head = pressed()
foot:fix()
local times = {}
local function speed(t)
    times[#times + 1] = t
    return 0, 0, -0.1 * t
end
head:drive { velocity = speed }
check.equal(one:cycle(400).cycles, 400)
local dt, expected = one:parameters().timestep.dt, 0
for k = 1, 400 do
    check.near(times[k], (k - 0.5) * dt, 1e-9 * dt * k)
    expected = expected - 0.1 * times[k] * dt
end
check.equal(#times, 400)
for _, p in ipairs(head) do
    check.near(p.displacement[3], expected, 1e-12 * 400 * math.abs(expected))
    check.near(p.displacement[1], 0, 0)
    check.near(p.velocity[3], -0.1 * times[400], 0)
end
check.holds(head:reaction()[3] < 0 and foot:reaction()[3] > 0)
local file = os.getenv("TALUS_TEST_TMP") .. "/zone_drives.talus"
one:save(file)
check.raises(function() talus.restore(file) end, "is driven by a function for its velocity")
local twin = talus.restore(file, { drives = { [head[1].block.id] = speed } })
local image = one:copy()
for _, m in ipairs { one, twin, image } do
    m:cycle(50)
    check.equal(m:state_hash(), one:state_hash())
end
head:free()
check.equal(#one:gridpoints { fixed = true }, #foot)
local calls = #times
one:cycle(5)
check.equal(#times, calls, "a drive that ended is not asked for")

-- A gradient stretches; its zones have its strain. One without symmetric part turns, and changes no length.
local pulled = pressed()
pulled:gridpoints():drive { gradient = { { 0.5, 0, 0 }, { 0, 0, 0 }, { 0, 0, -0.25 } }, at = { 0, 0, 1 }, velocity = { 0, 2, 0 } }
pulled:cycle(100)
local done = pulled:parameters().timestep.dt * 100
for _, z in ipairs(pulled:zones()) do
    check.near(z.strain.xx, 0.5 * done, 1e-6 * done)
    check.near(z.strain.zz, -0.25 * done, 1e-6 * done)
    check.near(z.strain.yy, 0, 1e-9 * done)
end
check.near(pulled:gridpoints { near = { 0, 0, 1 } }[1].displacement[2], 2 * done, 1e-12)
local turned = pressed()
turned:gridpoints():drive { gradient = { { 0, -30, 0 }, { 30, 0, 0 }, { 0, 0, 0 } }, at = { 0.5, 0.5, 0 } }
local corner = turned:gridpoints { near = { 1, 1, 2 } }
turned:cycle(300)
local angle = 2 * math.atan(15 * turned:parameters().timestep.dt) * 300 + math.pi / 4
check.near(corner[1].position[1], 0.5 + math.sqrt(0.5) * math.cos(angle), 1e-9)
check.near(corner[1].position[2], 0.5 + math.sqrt(0.5) * math.sin(angle), 1e-9)
check.near(turned:zones():sum("volume"), 1, 1e-10)
turned:save(file)
local same = talus.restore(file)
turned:cycle(10)
same:cycle(10)
check.equal(same:state_hash(), turned:state_hash())

hash = turned:state_hash()
for given, sentence in pairs {
    [{}] = "drive: give velocity, gradient or both",
    [{ velocity = 3 }] = "drive: velocity must be a list of 3 numbers or a function(t), not",
    [{ velocity = { 1, 2 } }] = "velocity",
    [{ gradient = { { 1, 0, 0 }, { 0, 1 } } }] = "drive: gradient must be a list of 3 lists of 3 finite numbers",
    [{ gradient = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 / 0 } } }] = "drive: gradient must be a list of 3 lists",
    [{ speed = 1 }] = "speed",
} do
    check.raises(function() turned:gridpoints():drive(given) end, sentence)
end
turned:blocks():drive { velocity = { 0, 0, 1 } }
check.raises(function() turned:gridpoints():drive { velocity = { 0, 0, 1 } } end, "is driven whole; let it go with")
