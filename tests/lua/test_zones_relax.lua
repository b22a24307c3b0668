-- test_zones_relax.lua - the step of a zoned block that nothing touches, and relaxations of gridpoints that have moved.
local check = require "check"
local talus = require "talus"

local STRAIN = -1e-6
local YOUNG = 1e9

local function cube()
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    model:solid("rock", "elastic", { young = YOUNG, poisson = 0 })
    local report = model:blocks():deformable { zone = 0.5, solid = "rock" }
    return model, report
end

local function at_height(model, z)
    return model:gridpoints { inside = { min = { -1, -1, z - 1e-9 }, max = { 2, 2, z + 1e-9 } } }
end

do -- zones alone say how long a step may be
    local model, report = cube()
    check.near(model.dt, report.time_step, 1e-12 * report.time_step)
    check.holds(model:timestep().dt > 0)
end

do -- what gridpoints moved before a relaxation strains their zones
    local model = cube()
    local top, bottom = at_height(model, 1), at_height(model, 0)
    top:fix()
    bottom:fix()
    top:set { velocity = { 0, 0, STRAIN / model.dt } }
    check.raises(function() model:relax {} end, "of block 1 is driven at")
    model:cycle(1)
    top:set { velocity = { 0, 0, 0 } }
    check.equal(model:relax { ratio = 1e-10 }.reason, "rest")
    model:cycle(1)
    for _, z in ipairs(model:zones {}) do
        check.near(z.stress.zz, YOUNG * STRAIN, 1e-5 * YOUNG * -STRAIN)
    end
    check.near(top:reaction()[3], YOUNG * STRAIN, 1e-5 * YOUNG * -STRAIN)
end

do -- after a relaxation nothing moves, and one that is refused leaves all as it was
    local model = cube()
    at_height(model, 0):fix()
    local rest = model:gridpoints { fixed = false }
    rest:set { velocity = function(p) return { 0, 0, 1e-3 * p[3] } end }
    model:cycle(3)
    local hash, speed = model:state_hash(), rest:values "velocity"
    check.raises(function() model:relax { ratio = 2 } end, "ratio")
    check.equal(model:state_hash(), hash)
    check.holds(speed[1][3] ~= 0)
    model:relax { max_cycles = 5 }
    for _, v in ipairs(rest:values "velocity") do
        check.equal(v[1] == 0 and v[2] == 0 and v[3] == 0, true)
    end
end

do -- what holds a rigid block under a zoned one bears both
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 2, 2, 0 }, density = 1000 })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    model:solid("rock", "elastic", { young = YOUNG, poisson = 0.2 })
    model:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 30 })
    model:blocks { id = 1 }:fix()
    model:blocks { id = 2 }:deformable { zone = 0.5, solid = "rock" }
    check.equal(model:relax { ratio = 1e-8 }.reason, "rest")
    check.near(model:blocks { id = 1 }:reaction()[3], 9 * 1000 * 10 + 2500 * 10, 1e-4 * 25000)
end
