-- Quiet faces of rigid blocks: pulses leave, statics are taken over, results do not depend on attitude, units, order or threads,
-- and what is refused.
local talus = require "talus"
local check = require "check"

-- A column of n cubes of side h along `axis`, in the order of `list`; blocks move as they like, but do not turn.
local function column(o)
    local n, h, axis = o.n or 12, o.h or 1, o.axis or 3
    local model = talus.model { gravity = o.gravity or { 0, 0, 0 }, threads = o.threads or 1 }
    for i = 1, n do
        local k = o.reverse and n + 1 - i or i
        local low, high = { 0, 0, 0 }, { h, h, h }
        low[axis], high[axis] = (k - 1) * h, k * h
        model:generate("box", { min = low, max = high, density = o.density or 2500 })
    end
    model:joint("*", "elastic", { kn = o.kn or 1e10, ks = o.ks or 4e9 })
    model:blocks():fix { rotation = true }
    return model
end

local sides = { { "xmin", "xmax" }, { "ymin", "ymax" }, { "zmin", "zmax" } }

local function quiet(model, axis, more)
    local both = {}
    for k = 1, 2 do
        both[sides[axis][k]] = more and more() or { quiet = true }
    end
    return model:boundary(both)
end

-- Kicks the blocks in the middle third, along and across; returns what is left after `crossings` of the column.
local function pulse(model, o)
    local n, h, axis = o.n or 12, o.h or 1, o.axis or 3
    local speed = o.speed or 1e-3
    local across = axis % 3 + 1
    model:blocks { where = function(b)
        local k = b.centroid[axis] / h
        return k > n / 3 and k < 2 * n / 3
    end }:set { velocity = { axis == 1 and speed or across == 1 and speed or 0, axis == 2 and speed or across == 2 and speed or 0,
        axis == 3 and speed or across == 3 and speed or 0 } }
    model:cycle(1)
    local energy = model:energy()
    local sent = energy.kinetic + energy.stored
    model:cycle(o.cycles or 200)
    energy = model:energy()
    check.near(energy.balance, 0, 1e-8)
    return (energy.kinetic + energy.stored) / sent
end

local function shares(o)
    local model = column(o)
    quiet(model, o.axis or 3)
    return pulse(model, o), model
end

-- Sharp pulses leave all but little. What is left does not depend on attitude, units and order.
local share, upright = shares {}
check.holds(share < 0.02 and share > 1e-9, "a pulse leaves")
local free = column {}
free:timestep { dt = upright.dt }
check.holds(pulse(free, {}) > 0.99, "without quiet faces it stays")
check.near(shares { axis = 1 } / share, 1, 1e-9)
check.near(shares { axis = 2 } / share, 1, 1e-9)
check.near(shares { reverse = true } / share, 1, 1e-9)
check.near(shares { h = 1000, density = 2.5e-9 * 1000, kn = 1e10 * 1e-3, ks = 4e9 * 1e-3, speed = 1 } / share, 1, 1e-2)

-- Elements are found, and a second call takes their place; a face is three nodes with its area.
local model = column {}
quiet(model, 3)
quiet(model, 3)
local faces = model:elements { kind = "quiet" }
check.equal(#faces, 2)
local area = 0
for _, node in ipairs(faces[1].nodes) do
    area = area + node.weight
end
check.near(area, 1, 1e-12)
check.near(faces[1].height, 1, 1e-12)
check.near(faces[1].density, 2500, 1e-9)
model:boundary { side = "zmax", quiet = true, p_velocity = 2000, s_velocity = 1265, density = 2600 }
check.equal(#model:elements { kind = "quiet" }, 2)
check.near(model:elements { kind = "quiet" }:max "density", 2600, 1e-9)

-- Rock of the velocities that the lattice has is the same as its joint.
model = column {}
quiet(model, 3, function() return { quiet = true, p_velocity = 2000, s_velocity = math.sqrt(1.6e6) } end)
check.near(pulse(model, {}) / share, 1, 1e-9)

-- A column at rest on a base that was held stays at rest on a quiet one, also where its load does not act in its centroid.
model = column { gravity = { 2, 0, -10 }, n = 4 }
model:damping "local"
model:boundary { zmin = "fixed" }
model:blocks { containing = { 0.5, 0.5, 3.5 } }:load { force = { 0, 3e4, 0 }, at = { 0.9, 0.5, 4 } }
model:solve { ratio = 1e-9 }
model:damping "none"
local held = model:boundary("zmin").reaction
local places = model:blocks():values("displacement", "flat")
model:boundary { zmin = { quiet = true } }
check.equal(model:blocks { containing = { 0.5, 0.5, 0.5 } }[1].fixed, false)
model:cycle(2000)
for i, u in ipairs(model:blocks():values("displacement", "flat")) do
    check.near(u, places[i], 1e-9)
end
check.near(held[3], 1e5, 1)
check.near(model:energy().balance, 0, 1e-3)

-- Rollers of the same call stay, and those of other sides of earlier ones.
model = column { n = 3, gravity = { 5, 5, 0 } }
model:boundary { ymin = "roller" }
model:boundary { xmin = "roller", zmin = { quiet = true } }
model:cycle(5)
check.near(model:blocks()[1].velocity[1], 0, 0)
check.near(model:blocks()[1].velocity[2], 0, 0)
model = column { n = 3, gravity = { 5, 5, 0 } }
model:boundary { zmin = "fixed" }
model:boundary { xmin = "roller", zmin = { quiet = true } }
model:cycle(20)
check.near(model:blocks()[1].velocity[1], 0, 0)
check.holds(model:blocks()[1].velocity[2] > 0, "a body that was held whole moves along the roller")

-- A wave comes in; the run goes on to the bit after a save, in a copy, and in pieces.
local at = {}
for k = 0, 40 do
    at[k + 1] = 0.1 * math.sin(math.pi * k / 40) ^ 2
end
local wave = talus.record { at = at, dt = 5e-4, quantity = "velocity" }
local function shaken(threads)
    local m = column { threads = threads, n = 6 }
    m:boundary { zmin = { quiet = true, joint = "*", input = { wave, 0, wave } } }
    return m
end
model = shaken()
local most = 0
for _ = 1, 200 do
    model:cycle(1)
    most = math.max(most, model:blocks()[6].velocity[1])
end
check.near(most, 0.2, 5e-3)
check.near(model:energy().balance, 0, 1e-9)
check.holds(model:elements():sum "given" >= 0)
local other = shaken(2)
other:cycle(200)
check.equal(other:state_hash(), model:state_hash())
model = shaken()
model:cycle(50)
local file = os.tmpname()
model:save(file)
local back, copy = talus.restore(file), model:copy()
os.remove(file)
for _, m in ipairs { model, back, copy } do
    m:cycle(150)
    check.equal(m:state_hash(), other:state_hash())
end

-- Where the block goes, its faces act no more.
model = column { n = 3 }
quiet(model, 3)
model:blocks { containing = { 0.5, 0.5, 0.5 } }:delete()
model:cycle(5)
check.equal(model:elements { kind = "quiet" }[1].detached, true)

-- ---------------------------------------------------------------- what is refused

model = column { n = 3 }
local function refused(o, part)
    check.refused(model, function() model:boundary(o) end, part)
end
refused({ zmin = { quiet = true, fixed = true } }, "a quiet face moves")
refused({ zmin = { quiet = true }, xmin = "fixed" }, "the same call holds it whole")
refused({ zmin = { quiet = true, joint = "J9" } }, "joint 'J9' has no law to take the stiffness")
refused({ zmin = { quiet = true, p_velocity = 2000 } }, "both p_velocity and s_velocity")
refused({ zmin = { quiet = true, joint = "*", p_velocity = 2000, s_velocity = 1000 } }, "by joint, or by both")
refused({ zmin = { quiet = true, p_velocity = 1000, s_velocity = 1001 } },
    "shear waves of s_velocity = 1001 m/s are faster than pressure waves of p_velocity = 1000 m/s")
refused({ zmin = { quiet = true, density = -1 } }, "density = -1")
refused({ zmin = { quiet = true, input = { 1, 0, 0 } } }, "each a talus.record or 0")
refused({ zmin = { quiet = true, input = 3 } }, "each a talus.record or 0")
refused({ zmin = { input = { wave, 0, 0 } } }, "go with quiet = true")
refused({ zmin = { joint = "*", fixed = true } }, "go with quiet = true")
refused({ quiet = true, side = "zmin", velocity = { 0, 0, 1 } }, "a quiet face moves")
model:damping "local"
refused({ zmin = { quiet = true, input = { wave, 0, 0 } } }, "under damping 'local'")
model:blocks { containing = { 0.5, 0.5, 0.5 } }:drive { velocity = { 0, 0, 0.1 } }
refused({ zmin = { quiet = true } }, "block 1 is driven")
model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
refused({ zmin = { quiet = true } }, "joint '*' has no law")
model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
model:generate("box", { min = { 2, 0, 0 }, max = { 3, 1, 1 }, density = 2500 })
model:solid("rock", "elastic", { young = 1e9, poisson = 0.2 })
model:blocks { containing = { 2.5, 0.5, 0.5 } }:deformable { zone = 1, solid = "rock" }
refused({ zmin = { quiet = true } }, "block 1 is rigid and block 2 deformable")

-- The kind itself refuses what is no face, no rock and no wave.
local good = { faces = "1 0 1 1 2500", kn = 1e10, ks = 4e9 }
model:element("quiet", good)
local function kind(change, part)
    local o = {}
    for key, value in pairs(good) do
        o[key] = value
    end
    for key, value in pairs(change) do
        o[key] = value or nil
    end
    check.refused(model, function() model:element("quiet", o) end, part)
end
kind({ faces = "1 0 1 1" }, "rows of 5 finite numbers")
kind({ faces = "1 0 1 nan 2500" }, "rows of 5 finite numbers")
kind({ faces = "1 0 1 0 2500" }, "all must be > 0")
kind({ faces = "1 99 1 1 2500" }, "1 of 1 faces are no outer faces")
kind({ p_velocity = 2000, s_velocity = 1000 }, "either kn and ks")
kind({ input_x = "0 0.1 0 0" }, "input_x is no list of finite numbers")
kind({ input_y = "0 -1 0 0 0 0" }, "input_y has dt = -1 s")
