-- usage_model.lua - a small model on which the usage lines of the help can be run: meta.lua looks at what they give, and
-- tests/python/test_docs.py runs them all.
--
-- A function that gives a fresh environment: model, and of it selection, block, contact, zone and gridpoint; a point
-- x, y, z; a text and a function f. The model has a held base, two free blocks above it with the joint J1 between them, down which the upper can
-- slide, a history "roof", and has made a few steps. Apart from them is a held block with zones.
local talus = require "talus"

return function()
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { { min = { 0, 0, 0 }, max = { 4, 4, 1 }, density = 2000, group = "base" },
        { min = { 1, 1, 1 }, max = { 3, 3, 3 }, density = 2000 },
        { min = { 3.2, 0.1, 1.5 }, max = { 3.8, 0.7, 2.1 }, density = 2000, group = "zoned" } })
    model:generate("joint", { joint = "J1", dip = 20, dip_direction = 90, origin = { 2, 2, 2 } })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:joint("J1", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:damping "local"
    model:solid("granite", "elastic", { young = 1e9, poisson = 0.25 })
    model:blocks { group = "zoned" }:deformable { zone = 1, solid = "granite" }
    model:gridpoints():fix()
    model:blocks { group = "base" }:fix()
    local free = model:blocks { fixed = false }
    model:history { name = "roof", of = free, field = "displacement" }
    model:cycle(10)
    free:set { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } } -- factors of safety are asked of what rests
    return setmetatable({ talus = talus, model = model, selection = free, block = free[1],
        contact = model:contacts()[1], zone = model:zones()[1], gridpoint = model:gridpoints()[1], x = 2, y = 2, z = 2, text = "", f = function() end }, { __index = _G })
end
