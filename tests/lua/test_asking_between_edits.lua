-- Asking changes nothing: a model whose contacts were asked for after every edit, in whatever order the layout of contacts
-- then has, goes on to the same bits as one that nobody has asked.
local check = require "check"
local talus = require "talus"

-- A slope of blocks, of which some are held late and some deleted; `look` is called after each edit.
local function build(look, shift)
    local model = talus.model { gravity = { 0, 0, -10 } }
    local function generate(joint, dip, direction, x, y, z)
        model:generate("joint", { joint = joint, dip = dip, dip_direction = direction, origin = { x, y, z } })
        look(model)
    end
    model:generate("box", { min = { 0, 0, 0 }, max = { 60, 40, 28 }, density = 2000 })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    model:damping("local")
    look(model)
    local toe = { 20, 20, 10 }
    local function along(dip, distance) -- the normal of a plane that dips to the west, from the toe
        local angle = math.rad(dip)
        return toe[1] - distance * math.sin(angle), toe[2], toe[3] + distance * math.cos(angle)
    end
    for k = 0, 4 do
        generate("foliation", 76, 270, along(76, -6 * k))
    end
    for k = 0, 2 do
        generate("fracture", 12, 270, along(12, 12 * k))
    end
    model:blocks { where = function(b) return b.id == 24 or b.id == 29 end }:delete()
    look(model)
    generate("D1", 70 + shift, 200, 26, 22, 15)
    generate("D2", 60, 330, 38, 32, 16)
    model:blocks { below = { dip = 12, dip_direction = 270, origin = toe } }:fix()
    look(model)
    local x, y, z = along(76, -24)
    model:blocks { below = { dip = 76, dip_direction = 270, origin = { x, y, z } } }:fix()
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

for shift = 0, 3 do
    local plain = build(function() end, shift)
    plain:cycle(600)
    for name, look in pairs(looks) do
        local asked = build(look, shift)
        for _ = 1, 30 do
            asked:cycle(20)
            look(asked)
        end
        check.holds(asked:state_hash() == plain:state_hash(), "steeper by " .. shift .. " degrees: " .. name .. " are asked for, and nothing changes:")
    end
end
