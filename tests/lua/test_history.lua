-- Histories: what is sampled and when, the file, bad input, and that a run gives the same bits with them and without.
local talus = require "talus"
local check = require "check"

local folder = string.format("%s/history_%s", assert(os.getenv("TALUS_TEST_TMP")),
    tostring({}):match("0x(%x+)") or "0")

-- Cubes in a row on a fixed slab that are let go; one slides.
local function scene(cubes)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 2 * cubes, 2, 0 }, density = 2000, group = "base" })
    for i = 0, cubes - 1 do
        model:generate("box", { min = { 2 * i, 0, 0 }, max = { 2 * i + 1, 1, 1 }, density = 2000, group = "cube" })
    end
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:damping("local", { alpha = 0.8 })
    model:blocks { id = 2 }:set { velocity = { 5, 0, 0 } }
    return model
end

local function read(path)
    local file = assert(io.open(path))
    local text = file:read("a")
    file:close()
    return text
end

-- A sample at once, and one every so many steps of all runs, however they are split up.
local model = scene(2)
local cube = model:blocks { id = 2 }[1]
model:cycle(3)
model:history { name = "x", every = 4, value = function(m)
    check.equal(m, model)
    return cube.displacement[1]
end }
model:history { name = "steps", every = 1, value = function(m) return m.cycles end }
check.raises(function() model:history { name = "time", value = "kinetic" } end, "a column which all files have")
check.raises(function() model:history { name = "k", value = "kinetic", take = "max" } end, "with of")
model:history { name = "vector", every = 5, value = function() return cube.displacement end }
model:history { name = "several", every = 5, value = function(m) return m.time, 2 * m.time end }
local wanted = { [3] = { cube.displacement[1], model.time } }
for _ = 1, 5 do
    model:cycle(2)
    wanted[model.cycles] = { cube.displacement[1], model.time }
end
model:solve { ratio = 0, max_cycles = 1 }
local h = model:histories()
check.equal(table.concat(h.x.cycle, " "), "3 7 11")
check.equal(math.type(h.x.cycle[1]), "integer")
for i, cycle in ipairs(h.x.cycle) do
    check.equal(h.x.value[i], wanted[cycle][1])
    check.equal(h.x.time[i], wanted[cycle][2])
end
check.equal(h.x.x, nil)
check.equal(table.concat(h.steps.cycle, " "), "3 4 5 6 7 8 9 10 11 12 13 14")
check.equal(table.concat(h.steps.value, " "), "3.0 4.0 5.0 6.0 7.0 8.0 9.0 10.0 11.0 12.0 13.0 14.0")
check.equal(table.concat(h.vector.cycle, " "), "3 8 13")
check.equal(#h.vector.value[2], 3)
for k, axis in ipairs { "x", "y", "z" } do
    for i = 1, 3 do
        check.equal(h.vector[axis][i], h.vector.value[i][k])
    end
end
check.near(h.several.value[3], { h.several.time[3], 2 * h.several.time[3] }, 0)
h.x.value[1] = 77 -- a copy
check.equal(model:histories().x.value[1], wanted[3][1])

-- The quantities of the model, and fields of blocks and contacts.
model = scene(3)
local slider, cubes = model:blocks { id = 2 }[1], model:blocks { group = "cube" }
for _, name in ipairs { "kinetic", "potential", "stored", "friction", "damping", "external", "strain", "plastic", "balance", "ratio",
    "ratio_maximum", "ratio_local", "max_velocity", "contacts", "slipping", "open" } do
    model:history { name = name, every = 100, value = name }
end
model:history { name = "one", every = 100, of = slider, field = "speed" }
model:history { name = "mean", every = 100, of = cubes, field = "displacement" }
model:history { name = "total", every = 100, of = cubes, field = "displacement", take = "sum" }
model:history { name = "lowest", every = 100, of = cubes, field = "speed", take = "min" }
model:history { name = "highest", every = 100, of = cubes, field = "speed", take = "max" }
model:history { name = "fixed", every = 100, of = model:blocks(), field = "fixed" }
local result = model:cycle(100)
h = model:histories()
local energy = model:energy()
for _, name in ipairs { "kinetic", "potential", "stored", "friction", "damping", "external", "strain", "plastic", "balance" } do
    check.equal(h[name].value[2], energy[name])
end
for _, name in ipairs { "ratio", "ratio_maximum", "ratio_local", "max_velocity" } do
    check.holds(h[name].value[1] ~= h[name].value[1], "no " .. name .. " before the first step")
    check.equal(h[name].value[2], result[name])
end
local function count(state)
    return #model:contacts():where(function(c) return c.state == state end)
end
check.equal(h.contacts.value[2], #model:contacts())
check.equal(h.slipping.value[2], count("slipping"))
check.equal(h.open.value[2], count("open"))
check.holds(count("slipping") > 0, "a cube slides")
check.equal(h.one.value[2], slider.speed)
check.near(h.total.value[2], cubes:sum("displacement"), 0)
for k = 1, 3 do
    check.near(h.mean.value[2][k], cubes:sum("displacement")[k] / 3, 1e-18)
end
check.equal(h.lowest.value[2], cubes:min("speed"))
check.equal(h.highest.value[2], cubes:max("speed"))
check.equal(h.fixed.value[2], 0.25)
model:history { name = "force", every = 1, of = model:contacts(), field = "normal_force", take = "sum" }
check.equal(model:histories().force.value[1], model:contacts():sum("normal_force"))

-- A block that is deleted is left out; where none is left the value is nan, and the run goes on.
slider = model:blocks { id = 2 }
slider:delete()
model:cycle(100)
h = model:histories()
check.holds(h.one.value[2] == h.one.value[2] and h.one.value[3] ~= h.one.value[3], "nan of a deleted block")
check.near(h.total.value[3], model:blocks { group = "cube" }:sum("displacement"), 0)
check.near(h.mean.value[3][3], model:blocks { group = "cube" }:sum("displacement")[3] / 2, 1e-18)
check.equal(h.highest.value[3], model:blocks { group = "cube" }:max("speed"))

-- A history ends by its name.
model:history { name = "mean", remove = true }
check.equal(model:histories().mean, nil)
check.equal(#model:histories().total.value, 3)
check.raises(function() model:history { name = "totla", remove = true } end, "did you mean 'total'?")
model:history { name = "mean", value = "kinetic" } -- the name is free again; every 10 steps when it is not told
model:cycle(25)
check.equal(table.concat(model:histories().mean.cycle, " "), "200 210 220")

-- The file: one line for each cycle at which anything was sampled, numbers that read back the same.
model = scene(1)
check.raises(function() model:write_histories(folder .. "/none.csv") end, "the model has no history")
cube = model:blocks { id = 2 }[1]
model:history { name = "z", every = 2, value = function() return cube.displacement[3] end }
model:history { name = 'a "b", c', every = 3, value = function(m) return { m.time, 1 / 0, -1 / 0, 0 / 0 } end }
model:history { name = "v", every = 3, of = cube, field = "velocity" }
model:cycle(4)
local path = folder .. "/deep/er/run.csv"
model:write_histories(path)
local lines = {}
for line in read(path):gmatch("([^\n]*)\n") do
    lines[#lines + 1] = line
end
check.equal(#lines, 5)
check.equal(lines[1], 'cycle,time,z,"a ""b"", c.1","a ""b"", c.2","a ""b"", c.3","a ""b"", c.4",v.x,v.y,v.z')
check.equal(lines[2], "0,0,0,0,inf,-inf,nan,5,0,0")
h = model:histories()
check.equal(lines[3], string.format("2,%s,%s,,,,,,,", lines[3]:match("^2,([^,]+),([^,]+),")))
check.equal(tonumber(lines[3]:match("^2,([^,]+),")), h.z.time[2])
check.equal(tonumber(lines[3]:match("^2,[^,]+,([^,]+),")), h.z.value[2])
check.equal(lines[4]:match("^3,[^,]+,,"), "3," .. lines[4]:match("^3,([^,]+)") .. ",,")
check.equal(tonumber(lines[4]:match("([^,]+)$")), h.v.z[2])
check.equal(lines[5]:match("^(%d+),"), "4")
-- A file that cannot be written leaves what was there.
model:cycle(2)
local before = read(path)
os.execute("mkdir -p '" .. folder .. "/taken.csv'")
check.raises(function() model:write_histories(folder .. "/taken.csv") end, "write_histories: cannot write")
check.raises(function() model:write_histories(path .. "/run.csv") end, "write_histories: cannot write")
check.raises(function() model:write_histories("") end, "the name of the file is empty")
check.raises(function() model:write_histories() end, "the file's name must be a string, not nil")
check.raises(function() model:write_histories(path, 1) end, "1 argument too many")
check.equal(read(path), before)

-- The same bits with histories and without, also when they ask for contacts and the step.
local function run(watched)
    local m = scene(4)
    if watched then
        m:history { name = "all", every = 1, value = function(asked)
            asked:energy()
            return #asked:contacts(), asked.dt, asked:blocks():max("speed"), asked:contacts():sum("normal_force")
        end }
        m:history { name = "kinetic", every = 7, value = "kinetic" }
        m:history { name = "open", every = 3, value = "open" }
        m:history { name = "cubes", every = 2, of = m:blocks { group = "cube" }, field = "displacement" }
        m:history { name = "touch", every = 1, of = m:contacts(), field = "normal_force" }
    end
    m:cycle(60)
    m:solve { ratio = 1e-5, max_cycles = 200, every = 50, on_progress = watched and function() end or nil }
    return m:state_hash()
end
check.equal(run(true), run(false))

-- A function that fails, or gives something else than numbers, ends the run after the step at its own line.
local function fails(f, part)
    model = scene(1)
    model:history { name = "bad", every = 5, value = function(m) if m.cycles < 10 then return 1 end return f(m) end }
    local good, message = pcall(model.cycle, model, 100)
    check.equal(good, false)
    check.equal(model.cycles, 10)
    check.holds(message:match("^[^\n]*test_history%.lua:%d+: [^\n]*$") and message:find(part, 1, true), message)
    check.equal(#model:histories().bad.value, 2)
    model:history { name = "bad", remove = true }
    check.equal(model:cycle(1).cycles, 1)
end
fails(function(m) return m.cyles end, "a model has no field 'cyles'; did you mean 'cycles'?")
fails(function() end, "history 'bad': the function must give a number or a list of 1 to 64 numbers, not nothing")
fails(function() return "1" end, "must give a number or a list of numbers, not the string '1'")
fails(function() return nil end, "not nil")
fails(function() return true end, "not true")
fails(function() return {} end, "not an empty list")
fails(function() return { 1, 2 } end, "the function gives 2 numbers, before it gave 1: it must give as many each time")
fails(function() return { 1, "2" } end, "not the string '2'")
fails(function() return { { 1 } } end, "not a table")
fails(function() return 1, 2 end, "before it gave 1")
fails(function() return model:blocks { id = 1 } end, "not a talus.blocks")
local value = {}
model = scene(1)
model:history { name = "table", every = 5, value = function(m) if m.cycles > 1 then error(value) end return 1 end }
check.equal(select(2, pcall(model.cycle, model, 100)), value)

-- It may read the model, but neither change it nor begin a run.
model = scene(2)
local refusals = 0
for _, attempt in ipairs {
    function(m) m:joint("*", { kn = 2e8 }) end,
    function(m) m:blocks():set { velocity = { 1, 0, 0 } } end,
    function(m) m:blocks():delete() end,
    function(m) m:generate("box", { min = { 5, 5, 5 }, max = { 6, 6, 6 }, density = 1 }) end,
    function(m) m.gravity = { 0, 0, 0 } end,
    function(m) m:timestep { dt = 1e-9 } end,
    function(m) m:cycle(1) end,
    function(m) m:history { name = "other", value = "kinetic" } end,
    function(m) m:history { name = "tries", remove = true } end,
} do
    local function tries(m)
        local good, message = pcall(attempt, m)
        refusals = refusals + (good and 0 or 1)
        check.equal(good, false)
        check.holds(message:find("cannot", 1, true) or message:find("read the model", 1, true), message)
        return 1
    end
    local before_it = model:state_hash()
    model:history { name = "tries", every = 1, value = tries }
    check.equal(model:state_hash(), before_it)
    model:cycle(1)
    model:history { name = "tries", remove = true }
end
check.equal(refusals, 18)

-- Wrong input: one sentence, and nothing is sampled.
model = scene(1)
local other = scene(1)
local function refused(args, part)
    check.refused(model, function() model:history(args) end, part)
    check.equal(next(model:histories()), nil)
end
local function one() return 1 end
refused({ value = one }, "'name' is missing")
refused({ name = "a" }, "history 'a': give either value = function(model) ... end or of = a selection with field")
refused({ name = "a", value = one, of = model:blocks() }, "give either")
refused({ name = "", value = one }, "name must have 1 to 63 letters, not 0")
refused({ name = "a\nb", value = one }, "name must be in one line")
refused({ name = ("a"):rep(64), value = one }, "name must have 1 to 63 letters, not 64")
refused({ name = 3, value = one }, "name")
refused({ name = "a", value = one, evry = 3 }, "history: unknown parameter 'evry'; did you mean 'every'?")
refused({ name = "a", value = one, every = 0 }, "every = 0")
refused({ name = "a", value = one, every = 1.5 }, "whole number")
refused({ name = "a", value = one, field = "speed" }, "there is no of")
refused({ name = "a", value = 3 }, "value must be a function(model) or the name of a quantity, not the number 3")
refused({ name = "a", value = "kintic" }, "history 'a': there is no value 'kintic'; did you mean 'kinetic'?")
refused({ name = "a", of = 3, field = "speed" }, "of must be a block, a contact, a zone, a gridpoint or a selection of them, not the number 3")
refused({ name = "a", of = other:blocks(), field = "speed" }, "of is a part of another model")
refused({ name = "a", of = model:blocks { group = "no" }, field = "speed" }, "the selection that of gives is empty")
refused({ name = "a", of = model:blocks() }, 'field = "displacement"')
refused({ name = "a", of = model:contacts() }, 'field = "normal_force"')
refused({ name = "a", of = model:blocks(), field = "sped" }, "a block has no field of numbers 'sped'; did you mean 'speed'?")
refused({ name = "a", of = model:blocks(), field = "group" }, "a block has no field of numbers 'group'")
refused({ name = "a", of = model:blocks(), field = "velocity", take = "max" }, "the field 'velocity' is a vector")
refused({ name = "a", of = model:blocks(), field = "speed", take = "median" }, "take")
refused({ name = "a", remove = true }, "the model has no history")
refused(nil, "'name' is missing")
check.refused(model, function() model:history { name = "a", value = function() error("no") end } end, "no")
check.refused(model, function() model:history { name = "a", value = function() return "x" end } end, "must give a number")
local gone = other:blocks { id = 2 }
gone:delete()
check.raises(function() other:history { name = "a", of = gone, field = "speed" } end, "block 2")
model:history { name = "a", value = one }
check.raises(function() model:history { name = "a", value = one } end,
    "history 'a': there is one of that name; model:history{name = 'a', remove = true} ends it")
check.raises(function() model:histories(1) end, "1 argument too many")

-- Many samples; the functions do not keep the model alive.
model = scene(1)
model:history { name = "long", every = 1, value = "kinetic" }
model:cycle(1000)
check.equal(#model:histories().long.value, 1001)
local weak = setmetatable({ model }, { __mode = "v" })
do
    local kept = model
    model:history { name = "self", value = function() return kept.cycles end }
end
model, slider, cubes, cube = nil, nil, nil, nil
collectgarbage()
collectgarbage()
check.equal(weak[1], nil)

os.execute("rm -rf '" .. folder .. "'")
