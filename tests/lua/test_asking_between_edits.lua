-- Asking changes nothing: a model whose contacts were asked for after every edit, in whatever order the layout of contacts
-- then has, goes on to the same bits as one that nobody has asked.
-- program only: the models are the same ones with a stock Lua.
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

-- A cut that falls on the faces of another one gives them its joint; blocks that are joined and parted again are what they were.
local function tag_and_join(look)
    local model = talus.model {}
    model:generate("box", { min = { -2, -2, -1 }, max = { 6, 6, 0 }, density = 2500, group = "floor" })
    model:blocks():fix()
    model:blocks():hide()
    model:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2500 })
    look(model)
    model:generate("jointset", { joint = "slip", dip = 35, dip_direction = 90, spacing = 1.3, number = 3, origin = { 2, 2, 2 } })
    model:generate("jointset", { joint = "steep", dip = 80, dip_direction = 200, spacing = 1.7, number = 2, origin = { 2, 2, 2 } })
    model:blocks { hidden = true }:show()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 25 })
    model:damping("local")
    look(model)
    for _, joint in ipairs { "new", "new", "other" } do
        model:generate("joint", { joint = joint, dip = 60, dip_direction = 10, origin = { 2, 2, 2 } })
        look(model)
    end
    local some = model:blocks { where = function(block) return block.id % 3 == 0 end }
    some:join()
    look(model)
    some:unjoin()
    look(model)
    return model
end
for name, look in pairs(looks) do
    local plain, asked = tag_and_join(function() end), tag_and_join(look)
    for _ = 1, 10 do
        plain:cycle(50)
        asked:cycle(50)
        check.holds(asked:state_hash() == plain:state_hash(), "tags and bodies change, " .. name .. " are asked for, and nothing changes:")
    end
end

-- An initial stress is no mere answer: it stays where a face gets another joint.
local model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = 2500 })
model:generate("joint", { joint = "one", dip = 0, dip_direction = 0, origin = { 1, 1, 1 } })
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
model:insitu { stress = { zz = -1e6 }, at = { 1, 1, 1 } }
model:generate("joint", { joint = "other", dip = 0, dip_direction = 0, origin = { 1, 1, 1 } })
local contact = model:contacts()[1]
check.equal(contact.joint, "other:1")
check.near(contact.normal_stress, 1e6, 1)
