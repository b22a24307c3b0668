-- program only
-- What is said of waves that come in through quiet faces: steps longer than samples, blocks that are too high, local damping.
local talus = require "talus"
local check = require "check"

local program = os.getenv("TALUS_PROGRAM") or arg[-1]
local path = (os.getenv("TALUS_TEST_TMP") or "/tmp") .. "/wave_checks.lua"

-- A column of blocks of 2 m in which shear waves have 894 m/s, and a record of so many seconds.
local HEAD = [[
local talus = require "talus"
local function column(size, dt, count, step)
    local model = talus.model { gravity = { 0, 0, 0 } }
    for k = 0, 5 do
        model:generate("box", { min = { 0, 0, k * size }, max = { size, size, (k + 1) * size }, density = 2500 })
    end
    model:joint("*", "elastic", { kn = 2e9 / size * 2.5, ks = 2e9 / size })
    model:blocks():fix { y = true, rotation = true }
    local at = {}
    for k = 0, count do
        at[k + 1] = 0.1 * math.sin(math.pi * k / count) ^ 2
    end
    if step then
        model:timestep { dt = step }
    end
    model:boundary { zmin = { quiet = true, input = { talus.record { at = at, dt = dt, quantity = "velocity" }, 0, 0 } } }
    return model
end
]]

local function remarks(script)
    local file = assert(io.open(path, "w"))
    file:write(HEAD, script)
    file:close()
    local pipe = assert(io.popen(string.format("'%s' '%s' 2>&1", program, path)))
    local text = pipe:read("a")
    check.holds(pipe:close(), text)
    return text
end

-- A pulse sin^2 of T has all but 1 % of its energy below some 1.5 / T Hz: 894 m/s over that are 596 T m.
check.equal(remarks "column(2, 1e-3, 100)", "")
local text = remarks "column(20, 1e-3, 100)"
check.holds(text:find("blocks like block 1, 20 m high, make up a wave of", 1, true), text)
local hertz = tonumber(text:match "a wave of ([%d.]+) Hz")
check.holds(hertz and hertz > 10 and hertz < 20, text)
check.near(tonumber(text:match "([%d.]+) blocks like"), 894.427 / hertz / 20, 0.2)
text = remarks "column(2, 1e-4, 1000, 5e-4)"
check.holds(text:find("the step, 0.0005 s, is longer than the 0.0001 s between samples", 1, true), text)

-- Damping that takes out vibrations is refused as long as the wave comes in.
local function site()
    local model, at = talus.model { gravity = { 0, 0, 0 } }, {}
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    model:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500 })
    model:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
    for k = 0, 100 do
        at[k + 1] = 0.1 * math.sin(math.pi * k / 100) ^ 2
    end
    return model, talus.record { at = at, dt = 1e-3, quantity = "velocity" }
end
local model, wave = site()
for _, name in ipairs { "local", "combined" } do
    model:damping(name)
    check.refused(model, function() model:boundary { zmin = { quiet = true, input = { wave, 0, 0 } } } end, "under damping '" .. name .. "'")
end
model:damping "none"
model:boundary { zmin = { quiet = true, input = { wave, 0, 0 } } }
check.refused(model, function() model:damping "local" end, "a wave comes in until 0.1 s")
check.refused(model, function() model:damping "combined" end, "a wave comes in until 0.1 s")
model:damping("rayleigh", { ratio = 0.05, from = 2, to = 10 })
while model.time < 0.1001 do
    model:cycle(10)
end
model:damping "local"
model:cycle(1)
