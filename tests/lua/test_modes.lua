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

-- Joints that would pull hold without weight, too: a block on its joint sways, turns and swings as by hand.
do
    local W, D, H, KN, KS, DENSITY = 0.7, 1.1, 2.3, 3e9, 1.3e9, 2000
    local light = talus.model { gravity = { 0, 0, 0 } }
    light:generate("box", { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = DENSITY })
    light:blocks():fix()
    light:generate("box", { min = { -W / 2, -D / 2, 0 }, max = { W / 2, D / 2, H }, density = DENSITY })
    light:joint("*", "coulomb_tensile", { kn = KN, ks = KS, friction = 30, cohesion = 1e6, tension = 1e6 })
    light:cycle(1)
    local expected = { math.sqrt(KN / (DENSITY * H)), math.sqrt(KS / (DENSITY * H)) } -- up and down, and about z
    for _, b in ipairs { W, D } do -- sway and turn about the centroid: half of the sum of squares, and the root of what they differ by
        local turn = (b * b + H * H) / 12
        local slide, rock = KS / (DENSITY * H), (KN * b * b / 12 + KS * H * H / 4) / (DENSITY * H * turn)
        local mean, apart = (slide + rock) / 2, math.sqrt((slide - rock) ^ 2 / 4 + slide * slide * H * H / (4 * turn))
        expected[#expected + 1], expected[#expected + 2] = math.sqrt(mean - apart), math.sqrt(mean + apart)
    end
    table.sort(expected)
    for k, mode in ipairs(light:modes { count = 6 }) do
        check.near(2 * math.pi * mode.frequency / expected[k], 1, 1e-9)
    end
    light:joint("*", "coulomb", { kn = KN, ks = KS, friction = 30 })
    light:cycle(1)
    check.equal(light:modes { count = 6 }[6].frequency, 0) -- what cannot pull and does not press holds nothing
end

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

-- Elements are counted. A block on four springs along z, at (+-a, +-b): up and down, and about x and y.
local function hertz(square)
    return math.sqrt(square) / (2 * math.pi)
end
local function same(model, count, expected, tolerance)
    local hash = model:state_hash()
    local found = model:modes { count = count }
    check.equal(model:state_hash(), hash)
    for k, frequency in ipairs(expected) do
        check.near(found[k].frequency, frequency, (tolerance or 1e-9) * frequency)
    end
    return found
end
local function block(gravity, sizes, at)
    local one = talus.model { gravity = { 0, 0, gravity or 0 } }
    local x, y, z = table.unpack(sizes or { 1, 1, 1 })
    one:generate("box", { min = { -x / 2, -y / 2, -z / 2 }, max = { x / 2, y / 2, z / 2 }, density = 1000 })
    return one
end
local K, A, B = 1e6, 0.4, 0.7
local on = block(0, { 1, 2, 0.5 })
for _, x in ipairs { -A, A } do
    for _, y in ipairs { -B, B } do
        on:element("spring", { from = { x, y, -0.25 }, to = { x, y, -3 }, stiffness = K, damping = 1e3 })
    end
end
on:cycle(1)
local up, about_x, about_y = 4 * K / 1000, 4 * K * B ^ 2 / (1000 * (4 + 0.25) / 12), 4 * K * A ^ 2 / (1000 * (1 + 0.25) / 12)
local expected = { up, about_x, about_y }
table.sort(expected)
for k, square in ipairs(expected) do
    expected[k] = hertz(square)
end
local all = same(on, 6, { 0, 0, 0, table.unpack(expected) })
check.near(all[4].mass[3] + all[5].mass[3] + all[6].mass[3], 1, 1e-6)

-- Two free blocks with a spring between: they swing against each other.
local two = block()
two:generate("box", { min = { 2.5, -0.5, -0.5 }, max = { 3.5, 0.5, 0.5 }, density = 1000 })
two:element("spring", { from = { 0, 0, 0 }, to = { 3, 0, 0 }, stiffness = K })
two:cycle(1)
check.near(same(two, 12, {})[12].frequency / hertz(2 * K / 1000), 1, 1e-9)
check.equal(two:modes { count = 12 }[11].frequency, 0)

-- A block hangs on a bolt: of the elongation d by its weight it swings with sqrt(g / d).
local hung = block(-10)
hung:generate("box", { min = { -1, -1, 0.6 }, max = { 1, 1, 3 }, density = 1000, group = "roof" })
hung:blocks { group = "roof" }:fix()
hung:element("bolt", { from = { 0, 0, -0.4 }, to = { 0, 0, 2.5 }, diameter = 0.025, plate_stiffness = 0 })
hung:damping "local"
hung:solve { measure = "local", ratio = 1e-9 }
local sunk = -hung:blocks()[1].displacement[3]
check.holds(sunk > 1e-6)
local swings = hung:modes { count = 6 }
local found = 0
for _, mode in ipairs(swings) do
    if mode.mass[3] > 0.99 then
        found = mode.frequency
    end
end
check.near(found / hertz(10 / sunk), 1, 1e-8)

-- Contacts and a spring side by side.
local both = talus.model { gravity = { 0, 0, -10 } }
both:generate("box", { min = { -1, -1, -1 }, max = { 1, 1, 0 }, density = 1000, group = "base" })
both:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 1 }, density = 1000 })
both:blocks { group = "base" }:fix()
both:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 40 })
both:damping "local"
both:element("spring", { from = { 0, 0, 0.5 }, to = { 0, 0, 4 }, stiffness = 3e7 })
both:solve { ratio = 1e-8 }
local highest = 0
for _, mode in ipairs(both:modes { count = 6 }) do
    if mode.mass[3] > 0.5 then
        highest = mode.frequency
    end
end
check.near(highest / hertz((1e8 + 3e7) / 1000), 1, 1e-6)

-- A spring at its strength has the stiffness by which it unloads.
local taut = block()
taut:element("spring", { from = { 0, 0, 0 }, to = { 3, 0, 0 }, stiffness = K, pretension = 1e4, strength = 1e4 })
taut:element("spring", { from = { 0, 0, 0 }, to = { -3, 0, 0 }, stiffness = K, pretension = 1e4, strength = 1e4 })
taut:cycle(1)
check.near(taut:modes { count = 6 }[6].frequency / hertz(2 * K / 1000), 1, 1e-9)

-- What stands for the outside is not counted: quiet faces and water.
local bare, outside = tower(), tower()
outside:water("uniform", { pressure = 1e3 })
outside:solve { ratio = 1e-7 }
same(outside, 24, {})
local base = outside:modes { count = 3 }
for k, mode in ipairs(bare:modes { count = 3 }) do
    check.near(base[k].frequency / mode.frequency, 1, 1e-6)
end
local free_base, quiet = block(), block()
quiet:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 40 })
quiet:boundary { zmin = { quiet = true, joint = "*" } }
for _, one in ipairs { free_base, quiet } do
    one:element("spring", { from = { 0, 0, 0 }, to = { 3, 0, 0 }, stiffness = K })
    one:cycle(1)
    check.near(one:modes { count = 6 }[6].frequency / hertz(K / 1000), 1, 1e-9)
end
check.holds(#quiet:elements { kind = "quiet" } > 0)
