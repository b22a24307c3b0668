-- Keyblocks of deformable blocks are those of rigid ones: a tunnel under four joints.
local talus = require "talus"
local check = require "check"

local function keyblocks(zoned, hold)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 10, 10, 10 }, density = 2600 })
    for _, joint in ipairs { { "A", 90, 4, 5 }, { "B", 270, 6, 5 }, { "C", 0, 5, 4 }, { "D", 180, 5, 6 } } do
        model:generate("joint", { joint = joint[1], dip = 60, dip_direction = joint[2], origin = { joint[3], joint[4], 3 } })
    end
    model:generate("tunnel", { face1 = { { 3, 0, 1 }, { 7, 0, 1 }, { 7, 0, 3 }, { 3, 0, 3 } },
        face2 = { { 3, 10, 1 }, { 7, 10, 1 }, { 7, 10, 3 }, { 3, 10, 3 } }, group = "tunnel" })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    model:blocks { group = "tunnel" }:delete()
    if zoned then
        model:solid("rock", "elastic", { young = 1e10, poisson = 0.2 })
        model:blocks():deformable { zone = 2, solid = "rock" }
    end
    if hold then
        model:blocks { boundary = "xmax" }:fix()
    end
    local found = {}
    for i, k in ipairs(model:keyblocks { friction = 30 }) do
        found[i] = ("%s %s %.12g"):format(k.block.centroid[3], k.mode, k.safety)
    end
    table.sort(found)
    return table.concat(found, "\n"), #found
end

for _, hold in ipairs { false, true } do
    local rigid, count = keyblocks(false, hold)
    check.holds(count > 5, "there are keyblocks")
    check.equal(keyblocks(true, hold), rigid)
end
check.holds(select(2, keyblocks(true, true)) < select(2, keyblocks(true, false)), "held blocks are none")
