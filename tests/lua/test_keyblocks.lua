-- Removable blocks: what is one and what is not, modes, strengths by joint, mistakes.
local talus = require "talus"
local check = require "check"

-- Nine by nine by three unit cubes; all are held but those at `free`.
local function grid(free)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 5, 5, 3 }, density = 2000 })
    model:generate("jointset", { joint = "X", dip = 90, dip_direction = 90, spacing = 1, number = 4,
        origin = { 2.5, 2.5, 1.5 } })
    model:generate("jointset", { joint = "Y", dip = 90, dip_direction = 0, spacing = 1, number = 4,
        origin = { 2.5, 2.5, 1.5 } })
    model:generate("jointset", { joint = "Z", dip = 0, dip_direction = 0, spacing = 1, number = 2,
        origin = { 2.5, 2.5, 1.5 } })
    check.equal(#model:blocks(), 75)
    model:blocks():fix()
    for _, at in ipairs(free) do
        model:blocks { containing = at }:free()
    end
    return model
end

-- In the floor, the roof, a wall, and within.
local model = grid { { 2.5, 2.5, 2.5 }, { 2.5, 2.5, 0.5 }, { 0.5, 2.5, 1.5 }, { 2.5, 2.5, 1.5 } }
local list = model:keyblocks { friction = 30 }
check.equal(#list, 3)
local by_mode = {}
for _, key in ipairs(list) do
    by_mode[key.mode] = key
    check.near(key.volume, 1, 1e-12)
    check.near(key.mass, 2000, 1e-9)
    check.equal(#key.pyramid, 1)
end
check.near(by_mode.stable.pyramid[1], { 0, 0, 1 }, 1e-12)
check.equal(by_mode.stable.safety, math.huge)
check.equal(by_mode.stable.direction, nil)
check.near(by_mode.falling.pyramid[1], { 0, 0, -1 }, 1e-12)
check.equal(by_mode.falling.safety, 0)
check.near(by_mode.falling.direction, { 0, 0, -1 }, 1e-12)
check.equal(#by_mode.falling.faces, 0)

-- The one in the wall may come out, but its weight does not make it.
local stable = 0
for _, key in ipairs(list) do
    if key.block.centroid[1] < 1 then
        check.near(key.pyramid[1], { -1, 0, 0 }, 1e-12)
        stable = stable + 1
        check.equal(key.mode, "stable")
    end
end
check.equal(stable, 1)

-- An earthquake pulls it out along its floor: N = m g, T = 0.5 m g.
for _, key in ipairs(model:keyblocks { friction = 30, gravity = { -5, 0, -10 } }) do
    if key.block.centroid[1] < 1 then
        check.equal(key.mode, "sliding")
        check.equal(key.faces[1].joint, "Z:1")
        check.near(key.faces[1].area, 1, 1e-12)
        check.near(key.faces[1].normal_force, 20000, 1e-6)
        check.near(key.driving_force, 10000, 1e-6)
        check.near(key.safety, math.tan(math.rad(30)) * 2, 1e-12)
    end
end
-- Without any force nothing falls.
for _, key in ipairs(model:keyblocks { friction = 30, gravity = { 0, 0, 0 } }) do
    check.equal(key.mode, "stable")
    check.equal(key.safety, math.huge)
end
-- A load does the same; cohesion on the floor joint alone, its plane before its set.
model:blocks { containing = { 0.5, 2.5, 1.5 } }:load { force = { -10000, 0, 0 } }
local function safety(parameters)
    for _, key in ipairs(model:keyblocks(parameters)) do
        if key.block.centroid[1] < 1 then
            return key.safety
        end
    end
end
check.near(safety { friction = 30 }, math.tan(math.rad(30)) * 2, 1e-12)
check.near(safety { friction = { ["*"] = 30, Z = 10, ["Z:1"] = 20 } }, math.tan(math.rad(20)) * 2,
    1e-12)
check.near(safety { friction = { ["*"] = 30, X = 10, ["Z:2"] = 20 }, cohesion = { Z = 5000, X = 1e9 } },
    math.tan(math.rad(30)) * 2 + 0.5, 1e-12)

-- What is in the way may go: then the block behind is removable too.
model:blocks { containing = { 2.5, 2.5, 2.5 } }:delete()
list = model:keyblocks { friction = 30 }
check.equal(#list, 3)
check.holds((function()
    for _, key in ipairs(list) do
        if math.abs(key.block.centroid[3] - 1.5) < 0.1 and key.block.centroid[1] > 1 then
            return true
        end
    end
end)(), "the block behind the deleted one is listed")

-- Joined to one that is held fast, a block is no keyblock; two free ones joined are one.
model = grid { { 2.5, 2.5, 0.5 }, { 2.5, 2.5, 1.5 } }
check.equal(#model:keyblocks { friction = 30 }, 1)
model:blocks { fixed = false }:join()
list = model:keyblocks { friction = 30 }
check.equal(#list, 1)
check.near(list[1].volume, 2, 1e-12)
check.equal(list[1].mode, "falling")

-- A plug in the roof that widens upwards is tapered and stays; one that narrows upwards falls.
local function plug(west, east)
    local one = talus.model()
    one:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 2 }, density = 2000 })
    one:generate("joint", { joint = "A", dip = 60, dip_direction = west, origin = { 1.5, 2, 0 } })
    one:generate("joint", { joint = "B", dip = 60, dip_direction = east, origin = { 2.5, 2, 0 } })
    for joint, at in pairs { C = { 0, 0.5 }, D = { 90, 1 }, E = { 90, 3 } } do
        one:generate("joint", { joint = joint, dip = at[1], dip_direction = 0,
            origin = { 2, joint == "C" and 2 or at[2], 0.5 } })
    end
    one:blocks():fix()
    one:blocks { containing = { 2, 2, 0.2 } }:free()
    return one
end
check.equal(#plug(90, 270):keyblocks { friction = 0 }, 0)
model = plug(270, 90)
list = model:keyblocks { friction = 0 }
check.equal(#list, 1)
check.equal(list[1].mode, "falling")

-- A block on an incline that slides, between rollers. What holds it across changes nothing, one along it holds it, and one that bears it has
-- no friction; holding the rotation does not matter, and what is driven is left out.
do
    local DIP = math.rad(35)
    local incline = talus.model { gravity = { 10 * math.sin(DIP), 0, -10 * math.cos(DIP) } }
    incline:generate("box", { min = { -4, -4, -1 }, max = { 4, 4, 0 }, density = 2500, group = "floor" })
    incline:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 1 }, density = 2500, group = "block" })
    incline:blocks { group = "floor" }:fix()
    local block = incline:blocks { group = "block" }
    local function held(axes)
        block:free()
        if next(axes) then
            block:fix(axes)
        end
        return incline:keyblocks { friction = 30 }[1]
    end
    local safety = math.tan(math.rad(30)) / math.tan(DIP)
    for _, case in ipairs { { {}, "sliding", safety, 0 }, { { y = true }, "sliding", safety, 2 },
        { { rotation = true }, "sliding", safety, 0 }, { { x = true }, "stable", math.huge, 2 },
        { { x = true, y = true }, "stable", math.huge, 1 }, { { y = true, z = true }, "falling", 0, 2 } } do
        local key = held(case[1])
        check.equal(key.mode, case[2])
        check.holds(key.safety == case[3] or math.abs(key.safety / case[3] - 1) < 1e-12, "the factor is " .. key.safety)
        check.equal(#key.pyramid, case[4])
    end
    check.equal(held { x = true, y = true, z = true }, nil)
    block:free()
    block:drive { velocity = { 1, 0, 0 } }
    check.equal(#incline:keyblocks { friction = 30 }, 0)
    -- the floor rises across the roller's axis: N cos(lean) bears the weight, and the roller the rest
    local LEAN = math.rad(25)
    local rock = talus.model { gravity = { 4, 0, -10 } }
    rock:generate("box", { min = { -1, -1, -1 }, max = { 1, 1, 1 }, density = 2500 })
    rock:generate("joint", { joint = "floor", dip = math.deg(LEAN), dip_direction = 0, origin = { 0, 0, 0 } })
    local middle = { dip = 0, dip_direction = 0, origin = { 0, 0, 0 } }
    rock:blocks { above = middle }:fix { y = true }
    rock:blocks { below = middle }:fix()
    check.near(rock:keyblocks { friction = 30 }[1].safety, math.tan(math.rad(30)) * 10 / math.cos(LEAN) / 4, 1e-12)
end

-- A block on a floor that is carried away from it: it lies on it as long as it has gone by less than 1 % of its size, and beyond that as long
-- as they touch and share some area.
do
    local function carried(way, turn)
        local model = talus.model { gravity = { 0, 0, -10 } }
        model:generate("box", { min = { -2, -2, -1 }, max = { 2, 2, 0 }, density = 2500, group = "floor" })
        model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 1 }, density = 2500, group = "block" })
        model:blocks { group = "floor" }:fix()
        model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
        model:timestep { dt = 1e-4 }
        local block = model:blocks { group = "block" }
        block:drive { velocity = { 10 * way[1], 10 * way[2], 10 * way[3] }, angular_velocity = { 0, 10 * (turn or 0), 0 } } -- for 0.1 s
        model:cycle(1000)
        block:free()
        return model:keyblocks { friction = 30 }[1].mode
    end
    for _, case in ipairs { { { 0, 0, 0 }, "stable" }, { { 1.5, 0, 0 }, "stable" }, { { 3, 0, 0 }, "falling" }, { { 0, 0, 0.005 }, "stable" },
        { { 0, 0, 0.03 }, "falling" }, { { 0, 0, -0.005 }, "stable" }, { { 0, 0, -0.03 }, "stable" } } do
        check.equal(carried(case[1]), case[2])
    end
    -- turned by some per cent it slides on the face that has turned with it; farther it lies on none
    check.equal(carried({ 0, 0, 0 }, 0.02), "sliding")
    check.equal(carried({ 0, 0, 0 }, 0.05), "falling")
end

-- Asking changes nothing.
check.refused(model, function() model:keyblocks {} end, "no friction is given for the faces")
check.refused(model, function() model:keyblocks() end, "keyblocks: give the parameters in a table")
check.refused(model, function() model:keyblocks { friction = { J = 3 } } end, "'J'")
check.refused(model, function() model:keyblocks { friction = 90 } end, "outside [0, 90)")
check.refused(model, function() model:keyblocks { friction = "30" } end, "must be a number or a table")
check.refused(model, function() model:keyblocks { friction = { A = "x" } } end, "must be a number")
check.refused(model, function() model:keyblocks { friction = { 30 } } end, "named by text")
check.refused(model, function() model:keyblocks { friction = 30, cohesion = -1 } end,
    "cohesion = -1")
check.refused(model, function() model:keyblocks { frction = 30 } end, "friction")

-- Accelerations and strengths beyond the range of numbers, and names that are cut.
do
    local model = talus.model {}
    model:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = 2000 })
    model:generate("joint", { joint = "J1", dip = 30, dip_direction = 90, origin = { 1, 1, 1 } })
    model:blocks { boundary = "zmin" }:fix()
    for _, g in ipairs { 1e-90, 1, 1e90 } do
        check.near(model:keyblocks { friction = 35, gravity = { 0, 0, -g } }[1].safety, math.tan(math.rad(35)) / math.tan(math.rad(30)), 1e-12)
    end
    for _, g in ipairs { 1e-170, 1e160 } do
        check.refused(model, function() model:keyblocks { friction = 35, gravity = { 0, 0, -g } } end, "must be 0 or within [1e-100, 1e+100]")
    end
    check.refused(model, function() model:keyblocks { friction = 35, cohesion = 1e308 } end, "cohesion = 1e+308 Pa is outside [0, 1e+100]")
    check.refused(model, function() model:keyblocks { friction = { ["*"] = 30, ["J1\0x"] = 5 } } end, "keyblocks: the name of a joint must be a string, not one with a zero byte after 'J1'")
    check.refused(model, function() model:timestep { ["dt\0x"] = 1 } end, "timestep: the name of a parameter must be a string, not one with a zero byte after 'dt'")
    check.refused(model, function() model:history { name = "h", value = "kinetic\0junk" } end, "history: value must be a string, not one with a zero byte after 'kinetic'")
    check.refused(model, function() model:history { name = "\xff", value = "kinetic" } end, "UTF-8")
end

-- Where displacements count from is nothing to keyblocks: blocks touch as they did when they were made.
do
    local lean = math.rad(35)
    local slope = talus.model { gravity = { 10 * math.sin(lean), 0, -10 * math.cos(lean) } }
    slope:generate("box", { min = { -9, -9, -1 }, max = { 9, 9, 0 }, density = 2500, group = "slope" })
    slope:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 1.5 }, density = 2500, group = "block" })
    slope:generate("joint", { joint = "cut", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
    slope:blocks { group = "block" }:join()
    slope:blocks { group = "slope" }:fix()
    slope:joint("*", "coulomb", { kn = 1e7, ks = 1e7, friction = 60 })
    slope:damping "local"
    local factor = math.tan(math.rad(30)) / math.tan(lean)
    local function holds(what) check.near(slope:keyblocks { friction = 30 }[1].safety, factor, 1e-9, what) end
    holds "made"
    slope:solve {}
    holds "settled"
    slope:stage "settled"
    holds "a new stage"
    slope:cycle(50)
    slope:blocks { group = "block" }:unjoin()
    slope:blocks { group = "block" }:join()
    holds "joined anew"
    local path = os.getenv "TALUS_TEST_TMP" .. "/slope.talus"
    slope:save(path)
    slope = talus.restore(path)
    holds "restored"
    slope = slope:copy()
    holds "copied"
end

-- Of three faces along the motion the normal forces are not given: of a block in a trough with a floor, that slides along it, the least
-- safe ones count, whatever the order of the cuts. On the floor N = W; on both sides N = W / sqrt(2) each. T = W / 2.
for _, order in ipairs { { "L", "R", "B" }, { "B", "R", "L" }, { "R", "B", "L" } } do
    local trough = talus.model { gravity = { 0, -5, -10 } }
    local cuts = { L = { 45, 90, { -0.5, 0, -0.5 } }, R = { 45, 270, { 0.5, 0, -0.5 } }, B = { 0, 0, { 0, 0, -0.5 } } }
    trough:generate("box", { min = { -2, 0, -2 }, max = { 2, 1, 1 }, density = 2000 })
    for _, name in ipairs(order) do
        trough:generate("joint", { joint = name, dip = cuts[name][1], dip_direction = cuts[name][2], origin = cuts[name][3] })
    end
    local in_it = trough:blocks { containing = { 0, 0.5, 0.5 } }[1]
    trough:blocks { where = function(one) return one.id ~= in_it.id end }:fix()
    local function slides(floor, sides)
        return trough:keyblocks { friction = { B = floor, L = sides, R = sides } }[1]
    end
    local on_sides, on_floor = slides(40, 20), slides(20, 40)
    check.equal(on_sides.mode, "sliding on two")
    check.near(on_sides.safety, 2 * math.sqrt(2) * math.tan(math.rad(20)), 1e-12)
    check.equal(on_floor.mode, "sliding")
    check.equal(on_floor.faces[1].joint, "B:1")
    check.near(on_floor.safety, 2 * math.tan(math.rad(20)), 1e-12)
end
