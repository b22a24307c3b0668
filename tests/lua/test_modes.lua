-- Small vibrations: shapes, masses, what is held, mechanisms; refused where a model has none.
local talus = require "talus"
local check = require "check"

local function tower(options)
    options = options or {}
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -1, -1, -1 }, max = { 2, 2, 0 }, density = 2000, group = "base" })
    for k = 0, 3 do
        m:generate("box", { min = { 0, 0, k }, max = { 1, 1.2, k + 1 }, density = 2000, group = "tower" })
    end
    m:blocks { group = "base" }:fix()
    m:joint("*", options.law or "coulomb", options.params or { kn = 1e9, ks = 1e9, friction = 40 })
    m:damping "local"
    m:solve { ratio = 1e-7 }
    return m
end

local m = tower()
local before = m:state_hash()
local modes = m:modes { count = 24 }
check.equal(#modes, 24)
check.equal(m:state_hash(), before)
local mass = { 0, 0, 0 }
for k, mode in ipairs(modes) do
    check.holds(k == 1 or mode.frequency >= modes[k - 1].frequency, "ascending")
    check.near(mode.period * mode.frequency, 1, 1e-12)
    local most = 0
    for _, shift in pairs(mode.shift) do
        for axis = 1, 3 do
            most = math.max(most, shift[axis])
        end
    end
    check.near(most, 1, 1e-12)
    for axis = 1, 3 do
        mass[axis] = mass[axis] + mode.mass[axis]
    end
end
check.near(mass, { 1, 1, 1 }, 1e-6)
-- The tower sways the short way first, and its top the most.
check.holds(math.abs(modes[1].shift[5][1]) > 0.99 and math.abs(modes[1].shift[5][2]) < 1e-6, "the first shape")
-- Fewer are the same.
check.near(m:modes { count = 2 }[2].frequency / modes[2].frequency, 1, 1e-9)

-- Held motions are none; a joined pair is one body.
m:blocks { group = "tower" }:fix { x = true, y = true, rotation = true }
m:cycle(1)
check.equal(#m:modes { count = 100 }, 4)
local chain = m:modes { count = 1 }[1]
check.near(chain.frequency, math.sqrt(1e9 / 2000) * 2 * math.sin(math.pi / 18) / (2 * math.pi), 1e-4)

-- What nothing holds has a frequency of 0.
local free = tower()
free:generate("box", { min = { 5, 0, 0 }, max = { 6, 1, 1 }, density = 2000, group = "free" })
free:blocks { group = "free" }:fix { z = true }
free:solve { ratio = 1e-6 }
local slides = free:modes { count = 6 }
for k = 1, 5 do
    check.equal(slides[k].frequency, 0)
end
check.near(slides[6].frequency / modes[1].frequency, 1, 1e-9)

check.refused(m, function() m:modes { count = 0 } end, "count")
local new = talus.model()
check.refused(new, function() new:modes() end, "has not been run")
local falling = tower()
falling:blocks { group = "base" }:delete()
falling:cycle(5)
check.refused(falling, function() falling:modes() end, "is not at rest")
local held = tower()
held:blocks():fix()
held:cycle(1)
check.refused(held, function() held:modes() end, "nothing can vibrate")
local curved = tower { law = "barton_bandis", params = { jrc = 8, jcs = 80e6, phi_r = 30, kni = 1e10, vm = 1e-3, ks = 1e9 } }
check.refused(curved, function() curved:modes() end, "law 'barton_bandis'")

-- Elements are not counted: that is said, where they hold something that is free.
local path = (os.getenv("TALUS_TEST_TMP") or "/tmp") .. "/modes.lua"
for _, case in ipairs { { "2, 0, 0", true }, { "0, 0, 0.4", false } } do
    local file = assert(io.open(path, "w"))
    file:write(([[
local m = require "talus".model { gravity = { 0, 0, 0 } }
m:generate("box", { min = { -0.5, -0.5, -0.5 }, max = { 0.5, 0.5, 0.5 }, density = 1000 })
m:generate("box", { min = { 1.5, -0.5, -0.5 }, max = { 2.5, 0.5, 0.5 }, density = 1000 })
m:element("spring", { from = { 0, 0, 0 }, to = { %s }, stiffness = 1e5 })
m:blocks { id = 1 }:fix()
m:cycle(1)
m:modes { count = 2 }]]):format(case[1]))
    file:close()
    local pipe = assert(io.popen(("'%s' '%s' 2>&1"):format(os.getenv("TALUS_PROGRAM") or arg[-1], path)))
    check.equal(pipe:read("a"):find("modes: 1 element that holds free blocks", 1, true) ~= nil, case[2])
    pipe:close()
end
