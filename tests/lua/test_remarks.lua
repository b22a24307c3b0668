-- program only
-- Remarks: said where one belongs, once, with a name and a remedy, and nowhere else.
local check = require "check"

local program = os.getenv("TALUS_PROGRAM") or arg[-1]
local path = (os.getenv("TALUS_TEST_TMP") or "/tmp") .. "/remarks.lua"

-- A slab that is held, with a cube on it.
local HEAD = [[
local talus = require "talus"
local function stack(settings)
    settings = settings or {}
    local u = settings.unit or 1
    local model = talus.model { gravity = settings.gravity or { 0, 0, -9.81 } }
    model:generate("box", { min = { 0, 0, -u }, max = { 2 * u, 2 * u, 0 }, density = settings.density or 2700, group = "slab" })
    model:generate("box", { min = { 0, 0, 0 }, max = { u, u, u }, density = settings.density or 2700, group = "cube" })
    model:blocks { group = "slab" }:fix()
    model:joint("*", "coulomb", { kn = settings.kn or 1e9, ks = settings.kn or 1e9, friction = settings.friction or 35 })
    model:damping "local"
    return model
end
]]

-- The remarks of a script, one a line.
local function remarks(script)
    local file = assert(io.open(path, "w"))
    file:write(HEAD, script)
    file:close()
    local pipe = assert(io.popen(string.format("'%s' '%s' 2>&1", program, path)))
    local text = pipe:read("a")
    check.holds(pipe:close(), text)
    return text
end

-- Exactly one remark, of one line, with all these parts.
local function says(script, ...)
    local text = remarks(script)
    check.holds(text:match("^talus: [^\n]+\n$"), "one remark: " .. script .. "\n" .. text)
    for _, part in ipairs { ... } do
        check.holds(text:find(part, 1, true), "'" .. part .. "' in: " .. text)
    end
end

local function is_silent(script)
    check.equal(remarks(script), "")
end

-- Empty selections: once for each place, which is named.
for verb, done in pairs { ["fix()"] = "held", ["free()"] = "set free", ["delete()"] = "deleted", ["hide()"] = "hidden",
    ["join()"] = "joined", ["set { density = 2000 }"] = "changed", ["load { force = { 0, 0, 1 } }"] = "loaded",
    ["drive { velocity = { 0, 0, 1 } }"] = "driven", ["fix { x = true }"] = "held" } do
    local name = verb:match("^%a+")
    says("local m = stack()\nfor i = 1, 3 do\n    m:blocks { group = 'cub' }:" .. verb .. "\nend m:cycle(1)",
        "remarks.lua:15: " .. name .. ": the selection is empty: no block was " .. done, "model:blocks{...}")
    is_silent("stack():blocks { group = 'cube' }:" .. verb)
end
local _, count = remarks("local none = stack():blocks { group = 'cub' }\nnone:fix()\nnone:fix()\nnone:free()"):gsub("\n", "\n")
check.equal(count, 3)
is_silent("stack():blocks { group = 'cub' }:show():unjoin():reset_displacement()")

-- Slivers that are left, for blocks with zones are joined to none.
do
    local plates = [[
local m = talus.model {}
for k, z in ipairs { 0, 1, 1.01 } do
    m:generate("box", { min = { 0, 0, z }, max = { 2, 2, k == 2 and 1.01 or z + 1 }, density = 2700, group = k == 2 and "thin" or "thick" })
end
m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
m:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
]]
    local zones = "m:blocks { group = 'thick' }:deformable { zone = 1, solid = 'rock' }\n"
    says(plates .. zones .. "m:filter { auto = true }", "filter: joined 0 of 0 slivers: blocks that have zones, 2 of the visible ones, are joined to none")
    says(plates .. zones .. "m:filter { aspect = 20, action = 'join' }", "filter: joined 0 of 1 slivers")
    is_silent(plates .. zones .. "m:filter { aspect = 20, action = 'report' }")
    is_silent(plates .. "m:filter { auto = true }")
end

-- A time step that is far too long, given before the run or after some of it; of blocks that meet later, too.
says("local m = stack() m:timestep { dt = 0.005 } m:cycle(1) m:cycle(1)", "dt = 0.005 s is", "times the longest stable step",
    "which block 2 sets", "leave dt out")
says("local m = stack() m:cycle(9) m:timestep { dt = 0.05 } m:cycle(1)", "dt = 0.05 s")
says("local m = stack() m:timestep { rule = 'paper', dt = 0.05 } m:cycle(1)", "dt = 0.05 s")
says([[local m = stack() m:blocks { group = "slab" }:delete()
m:generate("box", { min = { 0, 0, -2 }, max = { 1, 1, -1.2 }, density = 2700 })
m:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, -1 } } }:fix()
m:joint("*", { kn = 1e11, ks = 1e11 }) m:timestep { dt = 0.005 } pcall(m.cycle, m, 600)]], "dt = 0.005 s")
-- Far too long is twice the longest.
is_silent("local m = stack() m:timestep { dt = 2.46e-3 } m:cycle(1)")
says("local m = stack() m:timestep { dt = 2.5e-3 } m:cycle(1)", "dt = 0.0025 s is 2.01 times the longest stable step, 0.00124 s")
is_silent("local m = stack() m:timestep { dt = 1.5 * m.dt } m:cycle(200)")
is_silent("local m = stack() m:blocks():fix() m:timestep { dt = 1 } m:cycle(2)")

-- Stiffness against weight, whatever the units: metres and kilograms, millimetres and tonnes, metres and tonnes.
says("local m = stack { kn = 1e5 } m:cycle(1) m:cycle(1)", "joint '*': kn = 100000 is soft: block 2 sinks in by 26.5 %")
says("stack { kn = 1e16 }:cycle(1)", "joint '*': kn = 1e+16 is improbably stiff: block 2")
says("stack { unit = 1000, density = 2.7e-9, gravity = { 0, 0, -9810 }, kn = 1e-4 }:cycle(1)", "is soft", "26.5 %")
is_silent("stack { unit = 1000, density = 2.7e-9, gravity = { 0, 0, -9810 }, kn = 1 }:cycle(1)")
is_silent("stack { density = 2.7, kn = 1e6 }:cycle(1)")
is_silent("stack { kn = 1e5, gravity = { 0, 0, 0 } }:cycle(1)")
says([[local m = stack()
m:generate("joint", { joint = "bed", dip = 0, dip_direction = 0, origin = { 0, 0, 0.5 } })
m:joint("bed", "coulomb", { kn = 1e5, ks = 1e9, friction = 30 }) m:cycle(1)]], "joint 'bed': kn = 100000 is soft")

-- Closure under load: a tenth of the thickness of the thinner block, along the contact, whichever block that is and whatever presses.
local pressed = [[local m = talus.model { gravity = { 0, 0, 0 } }
m:generate("box", { min = { 0, 0, -%s }, max = { 2, 2, 0 }, density = 2700, group = "slab" })
m:generate("box", { min = { 0.5, 0.5, 0 }, max = { 1.5, 1.5, %s }, density = 2700, group = "cube" })
m:blocks { group = "slab" }:fix()
m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 35 })
m:damping("viscous", { alpha = 300 })
m:blocks { group = "cube" }:load { force = { 0, 0, -%s } }
m:cycle(640)]]
says(pressed:format(1, 0.1, "1.1e6"), "joint '*': kn = 1e+08 is soft for what presses", "contact of blocks 1 and 2 (no joint) has closed by 0.01",
    "of the thickness of block 2, 0.1 m", "give a larger kn")
says(pressed:format(0.1, 1, "1.1e6"), "of the thickness of block 1, 0.1 m")
is_silent(pressed:format(0.1, 1, "0.9e6"))
is_silent(pressed:format(1, 0.1, "0.9e6"))
is_silent(pressed:format(1, 1, "1.1e6")) -- a hundredth

-- Density: a weight, or tonnes with a stiffness in pascals.
says("stack { density = 26.5, kn = 1e6 }:cycle(1)", "density = 26.5 of block 2 is not that of a solid", "kg/m3", "t/m3")
for density, kn in pairs { [0.027] = 1e6, [0.27] = 1e6, [50] = 1e6, [26500] = 1e9 } do
    says(("stack { density = %g, kn = %g }:cycle(1)"):format(density, kn), "density = " .. density .. " of block 2 is not that of a solid")
end
says("stack { density = 2.7, kn = 1e9 }:cycle(1)", "kn = 1e+09 goes with density = 2.7 of block 2", "kg/m3")
for _, density in ipairs { 1000, 2000, 2700, 3300, 7850 } do
    is_silent("stack { density = " .. density .. " }:cycle(1)")
end

-- Friction that is a coefficient or in radians; none at all is none.
says("local m = stack { friction = 0.6 } m:joint('*', { friction = 0.7 }) m:cycle(1)",
    "joint '*', law 'coulomb': friction = 0.6 deg", "0.6 is 31 deg", "0.6 rad are 34.4 deg")
says("local m = stack() m:joint('*', 'coulomb_tensile', { kn = 1e9, ks = 1e9, friction = 0.5 })", "friction = 0.5 deg")
is_silent("stack { friction = 0 }:cycle(1)")
is_silent("stack { friction = 5 }:cycle(1)")

-- Moduli of solids against weight, and their friction.
local zoned = [[local m = stack()
m:solid("rock", "mohr_coulomb", { young = %s, poisson = 0.2, cohesion = 1e12, friction = %s })
m:blocks { group = "cube" }:deformable { zone = 1, solid = "rock" }
m:cycle(1) m:cycle(1)]]
says(zoned:format("1e4", "30"), "solid 'rock', of kind 'mohr_coulomb' is soft: block 2 would shorten by 2.38 of its size", "(Pa)")
says(zoned:format("1e15", "30"), "is improbably stiff: block 2 shortens by 2.4e-11 of its size")
says(zoned:format("3e10", "0.6"), "solid 'rock', of kind 'mohr_coulomb': friction = 0.6 deg", "0.6 is 31 deg")
is_silent(zoned:format("3e10", "30"))
is_silent(zoned:format("1e6", "0"))
says((zoned:format("3e10", "30"):gsub("stack%(%)", "stack { density = 26500 }")), "density = 26500 of block 2 is not that of a solid")

-- Triangles of zones that reach out of the box of a boundary; with a joint at its side there are none.
local loaded = [[local m = talus.model {}
m:generate("box", { min = { 0, 0, 0 }, max = { 4, 1, 1 }, density = 2600 })
m:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { %s, 0, 0 } })
m:solid("rock", "elastic", { young = 3e10, poisson = 0.2 })
m:blocks():deformable { zone = 0.5, solid = "rock" }
m:boundary { side = "zmax", box = { min = { 0, 0, 0 }, max = { 1.8, 1, 1 } }, pressure = 1e5 }]]
says(loaded:format(3), "have their middle in the box, but reach out of it and are left out", "m2 are in it")
is_silent(loaded:format(1.8))

-- Gravity.
says("stack { gravity = { 0, 0, 9.81 } }:cycle(1)", "gravity = {0, 0, 9.81} points upward", "{0, 0, -9.81}")
says("local m = stack() m.gravity = { 0, 0, 10 } m.gravity = { 0, 0, 10 } m:cycle(1)", "gravity = {0, 0, 10} points upward")
is_silent("stack { gravity = { 3, 0, -9.81 } }:cycle(1)")
is_silent("stack { gravity = { 9.81, 0, 0 } }:cycle(1)")

-- Initial stress: tension is positive. At a free surface the stress of a gradient may pass through zero.
local held = "local m = stack() m:blocks():fix() m:insitu { %s }"
says(held:format("stress = { xx = 1e6, yy = 1e6, zz = 2e6 }"), "pulls at 1 contact (first: between blocks 1 and 2)",
    "zz = -2e+06")
says(held:format("gradient = { zz = -2.7e4 }, at = { 0, 0, 9 }"), "insitu: the stress pulls at 1 contact")
is_silent(held:format("stress = { xx = -1e6, yy = -1e6, zz = -2e6 }"))
is_silent(held:format("stress = { xx = 1e6, zz = -2e6 }"))
is_silent(held:format("gradient = { zz = 2.7e4 }, at = { 0, 0, 0 }"))

-- No remark is heard of --quiet.
local pipe = io.popen(string.format("'%s' --quiet -e '%s' 2>&1", program,
    "talus.model { gravity = { 0, 0, 10 } }:blocks():fix()"))
check.equal(pipe:read("a"), "")
pipe:close()

-- What the end of a run says of whether the model stands: by its limits nothing, and what has slid until it met something is not where
-- it was. A run that is not for equilibrium says nothing.
says("local m = stack() m:solve { max_cycles = 5 } m:solve { max_time = 1e-3 }", "solve: ended by max_cycles = 5, neither at rest (ratio ",
    "asked for 1e-05) nor failing")
says("stack():solve { max_time = 1e-3 }", "solve: ended by max_time = 0.001, neither at rest")
is_silent "stack():solve { ratio = 0, max_cycles = 5 }"
is_silent "stack():solve { max_cycles = 5, stop = function() return true end, every = 1 }"
is_silent "stack():solve {}"
says([[local m = stack { friction = 20 }
    m:generate("box", { min = { 1.6, 0, 0 }, max = { 1.8, 2, 1 }, density = 2700, group = "stop" })
    m:blocks { group = "stop" }:fix()
    m.gravity = { 9.81 * math.sin(0.6), 0, -9.81 * math.cos(0.6) }
    m:solve {}]], "solve: at rest, but not where it began: block 2 has moved by 0.6", "times its size")

-- Overlaps that press with more than the weight are told before anything moves, and insitu tells what it leaves out for them;
-- neither is told of blocks that are seated, nor of stress that was put on.
local sunk = [[local m = stack()
    m:generate("box", { min = { 1, 0, -0.00095 }, max = { 2, 1, 1 }, density = 2700, group = "sunk" })
    ]]
says(sunk .. "m:cycle(3)", "before the first step overlaps press with ", " times the weight (largest: 0.00095 m between blocks 1 and 3)",
    "model:seat{}")
says(sunk .. "m:seat {} m:cycle(3)", "seat: 1 contact was made to fit", "overlaps up to 0.00095 m", "of the blocks' mean size 1 %")
is_silent(sunk .. "m:blocks():fix() m:insitu { stress = { zz = -1e5 } } m:cycle(3)")
says("local m = stack() m:blocks():fix() m:generate('box', { min = { 1, 0, -0.006 }, max = { 2, 1, 1 }, density = 2700 }) m:blocks():fix() "
    .. "m:insitu { stress = { zz = -1e5 } }", "insitu: 1 contact (first: between blocks 1 and 3, which overlap by 0.006 m) got no stress",
    "model:seat{}")

-- That is told of a contact over more than a tenth of a face, and of none that is smaller, as edges' are.
local function sunk_beside(share, turn)
    return ([[local m = talus.model {} m:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2700 }) local v = {}
    local c, s = math.cos(%g), math.sin(%g)
    for k = 0, 7 do
        local x, z = k %% 2, k // 4
        v[k + 1] = { %g + c * x - s * z, k // 2 %% 2, s * x + c * z - 0.006 }
    end
    m:generate("polyhedron", { vertices = v, density = 2700 })
    m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    m:blocks():fix() assert(#m:contacts() == 1) m:insitu { stress = { zz = -1e5 } }]]):format(turn, turn, 1 - share)
end
says(sunk_beside(0.15, 0), "insitu: 1 contact (first: between blocks 1 and 2, which overlap by 0.006 m) got no stress")
is_silent(sunk_beside(0.06, 0))
is_silent(sunk_beside(0.5, math.pi / 4))

-- Rock of three dispersed sets is full of slivers: the remark names a filter that makes the step a hundred times longer.
local rock = [[
local rock = talus.model { seed = 7 }
rock:generate("box", { min = { 0, 0, 0 }, max = { 40, 40, 40 }, density = 2650 })
for _, set in ipairs { { "J1", 55, 60 }, { "J2", 60, 150 }, { "J3", 20, 270 } } do
    rock:generate("jointset", { joint = set[1], dip = set[2], dip_direction = set[3], dip_dev = 5, dip_direction_dev = 5,
        distribution = "normal", spacing = 4, number = 30, origin = { 20, 20, 20 } })
end
rock:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 40 })
rock:boundary { xmin = "roller", xmax = "roller", ymin = "roller", ymax = "roller", zmin = "fixed" }
rock:damping "local"
]]
local said = remarks(rock .. "rock:cycle(1)")
local filter = said:match "model:filter(%b{})"
check.holds(filter and said:find("and %d%d+ more"), "it names many slivers: " .. said)
check.holds(not remarks(rock .. "rock:mass_scaling(true) rock:cycle(1)"):find("sliver"), "slivers do not limit the step of scaled masses")
local make = assert(load("local talus = ...; " .. rock .. " return rock"))
local model = make(require "talus")
local before, whole = model:timestep().dt, 40 ^ 3
local found = model:filter(load("return " .. filter)())
check.holds(found.joined > 10 and found.volume < 0.05 * whole, "it joins slivers")
check.holds(model:timestep().dt > 50 * before, ("the step is %g times longer"):format(model:timestep().dt / before))

-- The speed at which a body of parts fails is that of the body, whichever part was made first.
local function failing(first, second)
    local text = remarks(([[
local model = talus.model { gravity = { 0, 0, -9.81 } }
local mast = { { min = { 0, 0, 0 }, max = { 1, 1, 2 }, density = 2500, group = "mast" },
    { min = { 0, 0, 2 }, max = { 3, 1, 3 }, density = 2500, group = "mast" } }
model:generate("box", { mast[%d], mast[%d] })
model:blocks():join()
model:generate("box", { min = { -9, -9, -1 }, max = { 9, 9, 0 }, density = 2500, group = "floor" })
model:blocks { group = "floor" }:fix()
model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 40 })
model:damping "local"
model:solve { stop_at_failure = true }
]]):format(first, second))
    return text:match "the model fails: block 1 moves on at (%S+) m/s"
end
check.holds(failing(1, 2), "the mast topples")
check.equal(failing(2, 1), failing(1, 2))

-- An overlap is as deep for a body of parts as for a block: a hundredth of the body's size counts.
local function sunk(depth, in_parts)
    return ([[
        local model = talus.model { gravity = { 0, 0, -9.81 } }
        model:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = 2700, group = "cube" })
        if %s then
            model:generate("joint", { joint = "cut", dip = 0, dip_direction = 0, origin = { 0, 0, 0.2 } })
            model:blocks():join()
        end
        model:generate("box", { min = { -1, -1, -1 }, max = { 3, 3, %g }, density = 2700, group = "floor" })
        model:blocks { group = "floor" }:fix()
        model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
        model:damping "local"
        model:cycle(1)
    ]]):format(in_parts, depth)
end
for _, in_parts in ipairs { false, true } do
    local deep = "1 pair of blocks %b() overlaps by more than 0.01 of their size"
    local less, more = remarks(sunk(0.018, in_parts)), remarks(sunk(0.022, in_parts))
    check.holds(not less:find(deep) and more:find(deep), "a hundredth counts: " .. less .. more)
    check.holds(less:find "press with" and more:find "press with", "both press with more than the weight: " .. less .. more)
end

-- keyblocks tells of a block that has moved against what it lay on, and of one whose wall has gone off while it stayed.
local function trench(mover, way)
    return ([[
        local trench = talus.model { gravity = { 0, 3, -10 } }
        local function box(group, min, max)
            trench:generate("box", { min = min, max = max, density = 2500, group = group })
        end
        box("base", { 0, 0, -1 }, { 1, 1, 0 })
        box("wall", { 0, 1, 0 }, { 1, 10, 9 })
        box("block", { 0, 0, 0 }, { 1, 1, 1 })
        trench:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
        trench:blocks():fix()
        local block = trench:blocks { group = "block" }
        block:free()
        assert(trench:keyblocks { friction = 30 }[1].mode == "stable")
        block:fix()
        local moved = trench:blocks { group = "%s" }
        moved:free()
        moved:drive { velocity = { 0, %g, 0 } }
        trench:timestep { dt = 1e-3 }
        trench:cycle(1000)
        moved:free()
        trench:blocks { group = "wall" }:fix()
        block:free()
        assert(trench:keyblocks { friction = 30 }[1].mode == "%s")
    ]]):format(mover, way, math.abs(way) > 0.01 and "sliding" or "stable")
end
for mover, sign in pairs { wall = 1, block = -1 } do
    is_silent(trench(mover, 0.005 * sign))
    says(trench(mover, 0.02 * sign), "keyblocks: 1 body (first: block 3) has moved against what it touches or touched by more than 1 %")
end

-- Who waits for rest without damping is told of relax; who asks for a time only is not.
local UNDAMPED = [[
local m = talus.model {}
m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2700 })
m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
]]
says(UNDAMPED .. "m:solve { max_cycles = 2 } m:solve { max_cycles = 2 }", "no damping and may never come to rest", "model:relax{}")
says(UNDAMPED .. "m:solve { ratio = 0, velocity = 1e-3, max_cycles = 2 }", "no damping and may never come to rest")
is_silent(UNDAMPED .. "m:solve { ratio = 0, max_time = 0.001 }")

-- Rest after a movement of more than 1 % of a block's size may hang on the stiffness: the lower of two cubes bears both.
local TWO = [[
local m = stack { kn = %s }
m:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2700 })
assert(m:%s.reason == "%s")
m:cycle(1)
assert(m:relax {}.reason == "rest")
]]
for _, run in ipairs { { "relax {}", "rest" }, { "solve { ratio = 1e-5 }", "ratio" } } do
    says(TWO:format("3.9e6", run[1], run[2]), ": at rest, but that may hang on how stiff the joints are: block 3 has moved by 0.020",
        " % of its size of 1 m", "try_stiffer = true")
    is_silent(TWO:format("1e7", run[1], run[2]))
end
