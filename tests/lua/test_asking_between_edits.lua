-- Asking changes nothing: a model whose contacts were asked for after every edit, in whatever order the layout of contacts
-- then has, goes on to the same bits as one that nobody has asked.
local check = require "check"
local talus = require "talus"

-- A slope of blocks, of which some are held late and some deleted; `look` is called after each edit.
local function build(look, seed)
    math.randomseed(seed)
    local model = talus.model { gravity = { 0, 0, -10 } }
    local function generate(joint, dip, direction, x, y, z)
        model:generate("joint", { joint = joint, dip = dip, dip_direction = direction, origin = { x, y, z } })
        look(model)
    end
    model:generate("box", { min = { 0, 0, 0 }, max = { 60, 40, 28 }, density = 2000 })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    model:damping("local")
    look(model)
    for k = 0, 4 do
        generate("foliation", 76, 270, 20 + 5.8 * k, 20, 10)
    end
    for k = 0, 1 do
        generate("fracture", 12, 270, 20, 20, 10 + 12 * k)
    end
    generate("D1", math.random(50, 80), 200, 26, 22, 15)
    generate("D2", math.random(50, 80), 330, 38, 32, 16)
    model:blocks { above = { dip = 45, dip_direction = 270, origin = { 18, 20, 14 } } }:delete()
    look(model)
    model:blocks { boundary = "zmin" }:fix()
    look(model)
    model:blocks { boundary = "xmax" }:fix()
    look(model)
    model:joint("*", { friction = 20 })
    look(model)
    return model
end

local looks = {
    contacts = function(model)
        for _, contact in ipairs(model:contacts()) do
            assert(contact.area >= 0)
        end
    end,
    energy = function(model) model:energy() end,
    slivers = function(model) talus.report(model) end,
}

for seed = 1, 6 do
    local plain = build(function() end, seed)
    plain:cycle(400)
    for name, look in pairs(looks) do
        local asked = build(look, seed)
        for _ = 1, 20 do
            asked:cycle(20)
            look(asked)
        end
        check.holds(asked:state_hash() == plain:state_hash(), "seed " .. seed .. ": " .. name .. " are asked for")
    end
end
