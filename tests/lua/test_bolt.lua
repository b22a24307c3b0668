-- program only
-- Bolts: forces on blocks, pretension, yield, rupture, dowels, energy, edits, and what is refused.
local talus = require "talus"
local check = require "check"

-- A held block above z = 0 and a free one of 1 m below it, joined by nothing.
local function roof(gravity, threads)
    local m = talus.model { gravity = { 0, 0, gravity or -10 }, threads = threads }
    m:generate("box", { min = { 100, 0, 0 }, max = { 101, 1, 2 }, density = 2500 })
    m:blocks():fix()
    m:generate("box", { min = { 100, 0, -1 }, max = { 101, 1, 0 }, density = 2500 })
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 0 })
    return m
end

local function bolt(more)
    local t = { from = { 100.5, 0.5, -1 }, to = { 100.5, 0.5, 1.5 } }
    for k, v in pairs(more or {}) do
        t[k] = v
    end
    return t
end

local function alike(a)
    local file = os.tmpname()
    a:save(file)
    local b, c = talus.restore(file), a:copy()
    os.remove(file)
    for _ = 1, 2 do
        a:cycle(20)
        b:cycle(20)
        c:cycle(20)
    end
    check.equal(b:state_hash(), a:state_hash())
    check.equal(c:state_hash(), a:state_hash())
end

-- A block hangs on a grouted bolt: its weight is the tension at the joint, and forces of the bolt add up to zero.
local m = roof()
m:damping "local"
local e = m:element("bolt", bolt { group = "bolts" })
m:solve { measure = "local", ratio = 1e-6, max_cycles = 20000 }
check.near(e[1].axial, 25000, 1)
check.equal(e[1].yielded, false)
local sum = { 0, 0, 0 }
for _, node in ipairs(e[1].nodes) do
    for k = 1, 3 do
        sum[k] = sum[k] + node.force[k]
    end
end
check.near(math.abs(sum[1]) + math.abs(sum[2]) + math.abs(sum[3]), 0, 1e-6)
alike(m)

-- It falls, swings and turns on a bolt that slips and yields: no energy is made, on any number of threads.
local function fall(threads)
    local one = roof(-10, threads)
    one:element("bolt", { bolt { yield = 4e4, grout_strength = 4e4, grout_residual = 2e4, dowel_stiffness = 1e7,
        dowel_strength = 1e4, rupture_strain = 0.5 },
        bolt { from = { 100.8, 0.7, -1 }, to = { 100.9, 0.5, 1.5 }, plate_strength = 3e4, pretension = 1e4 } })
    one:blocks { fixed = false }:set { velocity = { 0.3, 0.1, -1 }, angular_velocity = { 1, 2, 3 } }
    one:cycle(2000)
    return one
end
m = fall(1)
check.equal(m:elements {}[1].yielded and m:elements {}[2].yielded, true)
check.near(m:energy().balance, 0, 1e-3)
check.equal(m:energy().friction > 100, true)
check.equal(fall(4):state_hash(), m:state_hash())

-- Pretension presses the joint together.
m = roof(0)
m:damping "local"
e = m:element("bolt", bolt { grouted_from = 0.8, pretension = 5e4 })
check.near(e[1].axial, 5e4, 1e-3)
check.near(e[1].plate, 5e4, 1e-3)
m:solve { measure = "local", ratio = 1e-6, max_cycles = 20000 }
local pressed = 0
for _, contact in ipairs(m:contacts()) do
    pressed = pressed + contact.normal_force
end
check.near(pressed / e[1].axial, 1, 1e-3)
check.equal(e[1].axial > 4e4, true)

-- A bolt that is pulled beyond its rupture strain lets the block go; a dowel is cut by the slip.
m = roof()
e = m:element("bolt", bolt { yield = 1e4, rupture_strain = 0.05 })
m:cycle(1000)
check.equal(e[1].broken, true)
check.equal(e[1].breaks, 1)
check.near(e[1].axial < 2e4 and 1 or 0, 1, 0)
check.near(m:energy().balance, 0, 1e-3)
check.equal(m:blocks { fixed = false }[1].displacement[3] < -0.02, true)
m = roof(0)
e = m:element("bolt", bolt { dowel_stiffness = 1e7, dowel_strength = 1e5, dowel_rupture = 0.01, yield = 1e9,
    rupture_strain = 100, active_length = 1000, plate_stiffness = 0, grout_strength = 1e9 })
m:blocks { fixed = false }:fix():set { velocity = { 1, 0, 0 } }
m:timestep { dt = 1e-4 }
m:cycle(52)
check.near(e[1].shear, 1e7 * 0.0051, 1)
m:cycle(100)
check.near(e[1].shear, 0, 0)
check.equal(e[1].broken, true)
check.equal(e[1].breaks, 1)

-- Grout that loses its bond all along one side of the joint lets the bolt go; grout that keeps it does not break.
for residual, breaks in pairs { [1e3] = true, [1e4] = false } do
    m = roof()
    e = m:element("bolt", bolt { plate_stiffness = 0, grout_strength = 1e4, grout_residual = residual })
    m:cycle(1000)
    check.equal(e[1].yielded, true)
    check.equal(e[1].broken, breaks)
    check.equal(e[1].breaks, 0)
    check.holds(e[1].slipped >= 1 - 1e-9 and e[1].slipped <= 2.5, "all grout below the joint has slipped")
    for _, node in ipairs(e[1].nodes) do
        check.holds(node.crosses == 0 or math.abs(node.tension - residual) < 1, "the rest of the bond bears")
    end
end

-- Where the block is deleted the rest of the bolt goes on; parameters that do not place it can be set.
m = roof()
e = m:element("bolt", bolt { pretension = 1e4 })
e:set { yield = 1e5 }
check.near(e[1].params.yield, 1e5, 0)
check.raises(function() e:set { grout_residual = 1e9 } end, "grout_residual = 1e+09 N/m is above grout_strength")
check.raises(function() e:set { pretension = 1 } end, "says where it is")
m:cycle(10)
m:blocks { fixed = false }:delete()
m:cycle(10)
check.equal(e[1].detached, true)
check.near(e[1].plate, 0, 0)
check.near(m:energy().balance, 0, 1e-3)

-- Anchors are bolts that are grouted at their far end.
m = roof()
e = m:element("anchor", bolt { pretension = 2e4 })
check.near(e[1].params.grouted_from, 0.8, 0)
check.near(e[1].nodes[1].tension, 2e4, 1e-3)

-- Bad input: one sentence, and nothing is placed.
m = roof()
local function refuse(t, words)
    check.raises(function() m:element("bolt", bolt(t)) end, words)
    check.equal(#m:elements {}, 0)
end
refuse({ from = { 0, 0, 0 }, to = { 0, 0, 1 } }, "lies outside of all blocks")
refuse({ from = { 100.5, 0.5, 0 }, to = { 100.5, 0.5, 0 } }, "same point")
refuse({ yield = -1 }, "yield")
refuse({ grout_strength = -1 }, "grout_strength")
refuse({ grout_residual = 5e5 }, "grout_residual = 500000 N/m is above grout_strength = 400000 N/m")
refuse({ grouted_from = 0.5, grouted_to = 0.5 }, "grouted_from = 0.5 must be below grouted_to = 0.5")
refuse({ pretension = 3e5 }, "pretension = 300000 N is above what steel (240000 N) and plate (200000 N) bear")
refuse({ pretension = 1e5, grout_strength = 1e4 }, "pulls the bolt out of its grout")
refuse({ pretension = 1e5, young = 1e8 }, "pretension = 100000 N strains the steel by 1.6")
refuse({ spacing = 0.002 }, "more than 512 nodes")
refuse({ diameter = 25 }, "diameter = 25 m must be below the length of the bolt, 2.5 m")
refuse({ diameter = 0 }, "diameter = 0")

-- What holds nothing is said.
local path = (os.getenv("TALUS_TEST_TMP") or "/tmp") .. "/bolt.lua"
local function output(script)
    local file = assert(io.open(path, "w"))
    file:write([[
local m = require "talus".model {}
m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 2 }, density = 2500 })
m:generate("box", { min = { 0, 0, -1.5 }, max = { 1, 1, -0.5 }, density = 2500 })
]], script)
    file:close()
    local pipe = assert(io.popen(string.format("'%s' '%s' 2>&1", os.getenv("TALUS_PROGRAM") or arg[-1], path)))
    local text = pipe:read("a")
    pipe:close()
    return text
end
local function says(script, words)
    local text = output(script)
    check.holds(text:find(words, 1, true), words .. " in: " .. text)
end
says("m:element('bolt', { from = { 0.5, 0.5, 0 }, to = { 0.5, 0.5, 1.5 } })", "lies in one body, so it holds nothing")
says("m:element('bolt', { from = { 0.5, 0.5, -1.5 }, to = { 0.5, 0.5, 1.5 } })",
    "passes through a void of 0.5 m: it is free there")
local falls = [[
m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 0 })
m:blocks { containing = { 0.5, 0.5, 1 } }:fix()
m.gravity = { 0, 0, -10 }
local function bolt(x)
    return { from = { x, 0.5, -1.5 }, to = { x, 0.5, 1.5 }, yield = 1e3, rupture_strain = 1e-3, group = "roof" }
end
m:element("bolt", { bolt(0.5), bolt(0.5) })
m:cycle(2000)
]]
says(falls, "2 elements 'bolt' of group 'roof' have broken, the first with id 1")
check.equal(select(2, output(falls):gsub("broken", "")), 1)
os.remove(path)

-- A pattern over a roof: a grid of bolts with the spacings, the same on faces that share a plane.
m = talus.model { gravity = { 0, 0, -10 } }
m:generate("box", { min = { 0, 0, 0 }, max = { 6, 6, 4 }, density = 2500 })
m:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 2, 0, 0 } })
m:generate("joint", { joint = "K", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
local lower = m:boundary "zmin"
local list = talus.bolt_pattern { on = lower, spacing = { 1.6, 1.6 }, length = 3, diameter = 0.02, node_spacing = 0.2 }
check.equal(#list, 9)
check.near(list[1].to[3], 3, 1e-12)
check.equal(list[1].diameter, 0.02)
check.equal(#m:element("bolt", list), 9)
list = talus.bolt_pattern { on = lower, spacing = { 1.5, 1.5 }, length = 3, direction = { 0, 1, 1 }, origin = { 0.75, 0.75, 0 } }
check.equal(#list, 16)
check.near(list[1].to[2] - list[1].from[2], 3 / math.sqrt(2), 1e-12)
check.raises(function() talus.bolt_pattern { on = lower, spacing = { 50, 50 }, length = 3, origin = { -1, -1, 0 } } end,
    "no bolt of the grid hits a face: there are 2 of 36.0 m2")
check.raises(function() talus.bolt_pattern { on = lower, spacing = { 1, 1 }, length = 3, direction = { 0, 0, -1 } } end,
    "no bolt of the grid hits a face")
check.raises(function() talus.bolt_pattern { on = m:blocks(), spacing = { 1, 1 }, length = 3 } end, "model:boundary{...}")
check.raises(function() talus.bolt_pattern { on = lower, spacing = { 1, 0 }, length = 3 } end, "both above 0")
check.raises(function() talus.bolt_pattern { on = lower, spacing = { 1, 1 } } end, "length")

-- Tests of a bolt without a model: pull-out to what its grout bears, and shear to what the dowel bears.
local curve = talus.bolt_test { length = 0.5, pull = 0.01, yield = 1e9, grout_strength = 1e5 }
check.near(curve.force[#curve.force], 5e4, 100)
check.equal(curve.yielded, true)
curve = talus.bolt_test { length = 2, shear = 0.02, angle = 30, dowel_stiffness = 1e8, dowel_strength = 1.2e5 }
check.near(curve.dowel[#curve.dowel], 1.2e5, 1)
local dowel, axial = 1.2e5 * math.cos(math.rad(30)), 2.4e5 * math.sin(math.rad(30))
check.holds(math.max(table.unpack(curve.along)) > dowel + axial, "the axial force helps, more as the bolt turns")
check.near(curve.along[#curve.along], dowel, 1e-4) -- the steel has broken
curve = talus.bolt_test { length = 2, pull = 0.05, yield = 1e9, grout_strength = 1e5, grouted_from = 0.8, grouted_to = 0.9 }
check.near(curve.force[#curve.force] / (0.1 * 2 * 1e5), 1, 1e-6) -- an anchor has the bond of what is grouted
-- The table of a bolt in a model may be tried as it is: its places, its plate and its pretension have no part in a pull.
local drawn = { length = 1, pull = 0.01, grout_strength = 1e5 }
local force = talus.bolt_test(drawn).force
for key, value in pairs { from = { 0, 0, 0 }, to = { 1, 0, 0 }, plate_stiffness = 1e7, plate_strength = 1e5, pretension = 1e5 } do
    drawn[key] = value
end
local with_all = talus.bolt_test(drawn).force
for k, f in ipairs(force) do
    check.equal(with_all[k], f)
end
check.raises(function() talus.bolt_test { length = 1, pull = 0.1, steps = 1.5 } end, "steps = 1.5 must be a whole number")
check.raises(function() talus.bolt_test { length = 1, pull = 0.1, grouted_to = 2 } end, "grouted_to = 2 is outside [0, 1]")
check.raises(function() talus.bolt_test { length = 1 } end, "give pull or shear")
check.raises(function() talus.bolt_test { length = 1, pull = 0.1, yeild = 1 } end, "yield")
