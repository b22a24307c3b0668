-- Records of ground motion: read, integrated exactly, corrected, asked; followed by blocks, saved and copied; refused where
-- they are none.
local talus = require "talus"
local check = require "check"

local TMP = os.getenv "TALUS_TEST_TMP" .. "/test_records" .. tostring({}):match "0x(%x+)"
local function write(name, text)
    local file = assert(io.open(TMP .. name, "w"))
    file:write(text)
    file:close()
    return TMP .. name
end

-- ---------------------------------------------------------------- what it is

local rec = talus.record { at = { 0, 1, 1, -2 }, dt = 0.5 }
check.equal(rec.count, 4)
check.equal(rec.dt, 0.5)
check.equal(rec.duration, 1.5)
check.near(rec:acceleration(0.25), 0.5, 1e-15)
check.near(rec:velocity(0.25), 0.0625, 1e-15)
check.near(rec:velocity(0.5), 0.25, 1e-15)
check.near(rec:displacement(0.5), 0.5 ^ 2 / 6, 1e-15)
check.near(rec:velocity(1), 0.75, 1e-15)
check.near(rec:displacement(1), 1 / 24 + 0.25 * 0.5 + 0.125, 1e-15)
check.near(rec:velocity(1.5), 0.5, 1e-15)
check.near(rec:velocity(9), 0.5, 1e-15) -- it goes on
check.equal(rec:acceleration(9), 0)
check.equal(rec:velocity(-1), 0)
local peak, speed = rec:peak()
check.equal(peak, 2)
check.near(speed, 0.75, 1e-15)
-- int a^2 dt = 1/6 + 1/2 + (1 - 2 + 4) / 6
check.near(rec:arias(), math.pi / 2 / 9.80665 * (1 / 6 + 1 / 2 + 1 / 2), 1e-14)
check.near(talus.record { at = { 0, 1 }, dt = 1, unit = "g", scale = 2 }:peak(), 2 * 9.80665, 1e-12)
check.near(talus.record { at = { 0, 50 }, dt = 1, unit = "cm/s", quantity = "velocity" }:velocity(0.5), 0.25, 1e-15)
check.raises(function() return rec.peek end, "did you mean 'peak'")

-- What drifts: a parabola of velocity is taken off whole, and a mean acceleration.
local drift = {}
for k = 0, 400 do
    drift[k + 1] = 0.3 + 2 * 0.1 * 0.01 * k
end
for _, corrected in ipairs { talus.record { at = drift, dt = 0.01, baseline = "parabola" },
    talus.record { at = { 3, 3, 3 }, dt = 1, baseline = "mean" } } do
    local most, fast = corrected:peak()
    check.near(most, 0, 1e-12)
    check.near(fast, 0, 1e-12)
end

-- Filters: what is in the band stays and is not shifted, what is beyond goes.
local function sine(frequency, options)
    options.at, options.dt = {}, 0.005
    for k = 0, 4000 do
        options.at[k + 1] = math.sin(2 * math.pi * frequency * 0.005 * k)
    end
    return talus.record(options)
end
check.near(sine(3, { band = { 0.2, 20 } }):acceleration(10 + 1 / 12), 1, 0.01)
check.near(sine(40, { band = { 0, 10 } }):acceleration(10 + 1 / 160), 0, 0.01)
check.near(sine(0.05, { band = { 0.5, 20 } }):acceleration(15), 0, 0.01)

-- An oscillator in resonance: |u| grows to (1 - exp(-z w t)) / (2 z); far stiffer, it goes with the ground.
local spectrum = sine(1, {}):spectrum(0.05, { 1, 0.02 })
check.near(spectrum.acceleration[1], 10 * (1 - math.exp(-0.05 * 2 * math.pi * 20)), 0.05)
check.near(spectrum.acceleration[2], 1, 0.001)
local default = rec:spectrum()
check.equal(#default.period, 100)
check.near(default.period[100], 10, 1e-6)

-- ---------------------------------------------------------------- files

local function same(record)
    check.equal(record.count, 4)
    check.near(record.dt, 0.01, 1e-12)
    check.near(record:acceleration(0.02), 0.5 * 9.80665, 1e-12)
end
same(talus.record { file = write("two.csv", "time,acc\n0,0\n0.01,1\n0.02,0.5\n0.03,-1\n"), unit = "g" })
same(talus.record { file = write("three.txt", "# a\n0 9 0\n0.01 9 1\n0.02 9 0.5\n\n0.03 9 -1"), column = 3, unit = "g" })
same(talus.record { file = write("one.txt", "0\r\n1\r\n.5\r\n-1E0\r\n"), dt = 0.01, unit = "g" })
same(talus.record { file = write("mark.csv", "\xef\xbb\xbf0,0\n0.01,1\n0.02,0.5\n0.03,-1\n"), unit = "g" }) -- of an editor
same(talus.record { file = write("new.AT2", "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1/2/1999, A, 90\n"
    .. "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   4, DT=   .0100 SEC,\n  .0000000E+00  .1000000E+01\n  .5  -1\n") })
same(talus.record { file = write("old.AT2", "PEER\nX\nACCELERATION TIME HISTORY IN UNITS OF G\n 4    0.0100    NPTS, DT\n 0 1 .5\n-1\n") })
check.near(talus.record { file = TMP .. "new.AT2", unit = "m/s2" }:peak(), 1, 1e-15)

local function refused(options, part)
    return check.raises(function() talus.record(options) end, part)
end
refused({}, "give either file, or samples in at")
refused({ at = { 1 }, dt = 1 }, "1 samples are outside 2 to")
refused({ at = { 1, 0 / 0 }, dt = 1 }, "which must be a finite number")
refused({ at = { 1, 2 } }, "dt = 0 s must be finite and > 0")
refused({ at = { 1, 2 }, dt = -1 }, "dt")
refused({ at = { 1, "a" }, dt = 1 }, "at[2] must be a number")
refused({ at = { 1, 2 }, dt = 0.01, band = { 5, 60 } }, "1 / (2 dt) = 50 Hz")
refused({ at = { 1, 2 }, dt = 0.01, band = { 5 } }, "band must be {low, high}")
refused({ at = { 1, 2 }, dt = 1, unit = "cm/s" }, "the unit is that of velocities")
refused({ at = { 1e308, 1e308 }, dt = 1e10 }, "leaves the range of numbers")
refused({ file = TMP .. "none" }, "cannot be opened")
refused({ file = TMP .. "one.txt" }, "does not tell the time between its samples")
refused({ file = write("rows", "0 1 2\n1 2 3\n") }, "line 1: it has 3 numbers: say with column")
refused({ file = TMP .. "rows", column = 4 }, "column = 4 is asked for")
refused({ file = write("short", "0 1 2\n1 2\n"), column = 3 }, "line 2: it has fewer numbers")
refused({ file = write("word", "0 1\n0.1 x\n") }, "line 2: it is no line of numbers")
refused({ file = write("uneven", "0 1\n0.1 2\n0.3 1\n") }, "line 3: its time 0.3 s")
refused({ file = write("cut.AT2", "NPTS= 9, DT= .01\n1 2 3\n") }, "after 3 of the 9 samples")
refused({ file = write("empty", "title\n"), dt = 1 }, "has no samples")
refused({ file = write("nan", "0 1\n0.1 nan\n") }, "line 2: sample 2 is nan")

-- ---------------------------------------------------------------- in a model

local function shaken(velocity)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -2, -2, -1 }, max = { 3, 3, 0 }, density = 2500, group = "base" })
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 20 })
    m:cycle(20)
    m:blocks { group = "base" }:drive { velocity = velocity }
    return m
end
local shake = sine(2, {})
local m, base = shaken { shake, 0.01, shake }
base = m:blocks { group = "base" }[1]
local begin, place = m.time, base.displacement
m:cycle(1)
check.near(base.velocity, { shake:velocity(m.dt / 2), 0.01, shake:velocity(m.dt / 2) }, 1e-15)
m:cycle(400)
local t = m.time - begin
check.near(base.displacement[1] - place[1], shake:displacement(t), 1e-4 * shake:displacement(t))
-- as a function of Lua does it
local asked = shaken(function(now) return { shake:velocity(now - begin), 0.01, shake:velocity(now - begin) } end)
asked:cycle(401)
check.near(asked:blocks()[2].centroid, m:blocks()[2].centroid, 1e-12)

-- Saved, copied: the same to the bit. Another record is another state.
m:save(TMP .. "run.talus")
local copy, restored = m:copy(), talus.restore(TMP .. "run.talus")
check.equal(restored:state_hash(), m:state_hash())
check.equal(copy:state_hash(), m:state_hash())
collectgarbage()
for _, other in ipairs { m, copy, restored } do
    other:cycle(100)
end
check.equal(restored:state_hash(), m:state_hash())
check.equal(copy:state_hash(), m:state_hash())
local one, two = shaken { shake, 0, 0 }, shaken { sine(2, { scale = 1.5 }), 0, 0 }
check.holds(one:state_hash() ~= two:state_hash(), "the record is part of the state")
copy:blocks():free()

-- Local damping would hide what the record does.
m:damping "local"
check.refused(m, function() m:cycle(1) end, "follows a record of motion under damping 'local'")
m:damping("rayleigh", { ratio = 0.05, from = 2, to = 20 })
m:cycle(1)
check.refused(m, function() m:blocks { group = "base" }:drive { velocity = { shake, "a", 0 } } end, "must be a finite number")

-- Gridpoints follow it, too.
local z = talus.model { gravity = { 0, 0, 0 } }
z:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
z:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
z:blocks():deformable { zone = 0.6, solid = "rock" }
z:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
z:boundary { side = "zmin", velocity = { shake, 0, 0 } }
z:cycle(50)
check.near(z:gridpoints { near = { 0, 0, 0 } }[1].velocity[1], shake:velocity(z.time - z.dt / 2), 1e-12)
