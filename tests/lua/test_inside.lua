-- A block wholly inside another cannot be pressed by it: the step that finds it so fails, names both, and is not made.
local talus = require "talus"
local check = require "check"

local INSIDE = "cycle %d, contact of blocks 1 and 2 (no joint): one lies wholly inside the other, so no contact can part them"

local function model(add)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -2, -2, -2 }, max = { 2, 2, 2 }, density = 2000 })
    add(m)
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    m:blocks { id = 1 }:fix()
    return m
end

local function fails_inside(m, made, what)
    local ok, why = pcall(m.cycle, m, 1000)
    check.holds(not ok and (why:find("one lies wholly inside the other", 1, true) or why:find("they overlap by", 1, true)) and
        why:find("blocks 1 and 2", 1, true),
        what .. ": " .. tostring(why))
    if made then
        check.equal(m.cycles, made, what .. ": steps made")
        check.holds(why:find(INSIDE:format(made + 1), 1, true), what .. ": " .. why)
    end
end

-- placed there, and at every attitude
math.randomseed(5)
for k = 1, 40 do
    local size = 10 ^ (-3 + 3 * math.random())
    local at = {}
    for i = 1, 3 do
        at[i] = (2 - size) * (2 * math.random() - 1)
    end
    local turned = {}
    local a = 6 * math.random()
    for i = 0, 7 do
        local x, y, z = size * (i % 2 - 0.5), size * (i // 2 % 2 - 0.5), size * (i // 4 - 0.5)
        turned[#turned + 1] = { at[1] + x * math.cos(a) - y * math.sin(a), at[2] + x * math.sin(a) + y * math.cos(a), at[3] + z }
    end
    fails_inside(model(function(m) m:generate("polyhedron", { vertices = turned, density = 2000 }) end), 0, "placed " .. k)
end

-- carried there: a chip too fast for the stiffness
for _, speed in ipairs { 30, 100, 300 } do
    local m = model(function(m) m:generate("box", { min = { 0, 0, 2.001 }, max = { 0.01, 0.01, 2.011 }, density = 2500 }) end)
    m:blocks { id = 2 }:set { velocity = { 0, 0, -speed } }
    fails_inside(m, nil, "chip at " .. speed .. " m/s")
end

-- moved out again, the step that failed is made
local m = model(function(m) m:generate("box", { min = { 0, 0, 1 }, max = { 0.5, 0.5, 1.5 }, density = 2500 }) end)
fails_inside(m, 0, "before it is deleted")
m:blocks { id = 2 }:delete()
m:cycle(1)
check.equal(m.cycles, 1, "after it was deleted")
