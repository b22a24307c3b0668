-- Asking for contacts between steps changes nothing: neither what comes after a change of rules or laws, nor its last bit.
local talus = require "talus"
local check = require "check"

-- Blocks that turn and slide over each other; then edges get an area of their own.
local function spin(steps, asks)
    local model = talus.model {}
    model:generate("box", { min = { -4, -4, -1 }, max = { 4, 4, 0 }, density = 2500, group = "base" })
    for x = -2, 1 do
        for y = -2, 1 do
            for z = 0, 2 do
                model:generate("box", { min = { x, y, z }, max = { x + 1, y + 1, z + 1 }, density = 2500 })
            end
        end
    end
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 30 })
    model:blocks { above = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }
        :set { velocity = { 0.5, 0.3, 0.2 }, angular_velocity = { 0.2, 0.1, 0.1 } }
    model:cycle(steps)
    model:contact_area { absolute = 0.01 }
    if asks then
        check.holds(#model:contacts() > 0, "there are contacts")
    end
    model:cycle(5)
    return model:state_hash()
end
for _, steps in ipairs { 5, 35, 55 } do
    check.equal(spin(steps, true), spin(steps, false))
end

-- A law that is set anew before the first step: a gap closes and an overlap is pushed out all the same.
local function settle(height, asks)
    local model = talus.model {}
    model:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2500, group = "base" })
    model:generate("box", { min = { 0, 0, height }, max = { 1, 1, 1 + height }, density = 2500, group = "free" })
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    if asks then
        check.equal(#model:contacts(), 1)
    end
    model:joint("*", "coulomb", { kn = 2e9, ks = 1e9, friction = 30 })
    model:damping("local", { alpha = 0.8 })
    model:cycle(3000)
    check.near(model:contacts()[1].gap, -2500 * 9.81 / 2e9, 1e-12)
    return model:state_hash()
end
for _, height in ipairs { 5e-4, -1e-4 } do
    check.equal(settle(height, true), settle(height, false))
end
