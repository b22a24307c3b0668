-- To ask for contacts changes nothing, also of a model of which the first step has failed: what it found counts as asked.
local check = require "check"
local talus = require "talus"

local function tower()
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { 0, 0, -1 }, max = { 4, 4, 0 }, density = 2500 })
    m:generate("box", { min = { 1, 1, 0 }, max = { 3, 3, 2 }, density = 2500 })
    m:blocks { id = 1 }:fix()
    m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    return m
end

local function same_after_asking(m, what)
    local before = m:state_hash()
    check.holds(#m:contacts() > 0, "it has contacts")
    check.equal(what .. m:state_hash(), what .. before)
end

for _, steps in ipairs { 0, 3 } do
    for _, asked in ipairs { false, true } do
        local m = tower()
        m:cycle(steps)
        m:generate("box", { min = { 1.05, 1.05, 0.05 }, max = { 3.05, 3.05, 2.05 }, density = 2500 }) -- in the other one
        local what = ("%d steps, %s: "):format(steps, asked and "asked" or "not asked")
        check.holds(not pcall(m.cycle, m, 1), "the blocks overlap too deeply")
        if asked then
            same_after_asking(m, what)
        end
        for _, height in ipairs { 0.3, 0.6, 1.1 } do
            m:generate("jointset", { joint = "J", dip = 5, dip_direction = 20, spacing = 9, number = 1, origin = { 2, 2, height } })
            same_after_asking(m, what .. "after a cut: ")
        end
    end
end
