-- Parts of joined bodies that meet a plane from both sides without touching: a seam's face alone
-- separates them, and there is no contact.
local talus = require "talus"
local check = require "check"

-- Two joined bodies, each of two parts with a seam at x = 0, interlocked like hands: above, left and
-- right are one body; below likewise. The left part of one and the right part of the other do not touch.
local model = talus.model { gravity = { 0, 0, -10 } }
local function part(points)
    local vertices = {}
    for _, p in ipairs(points) do
        vertices[#vertices + 1] = { p[1], 0, p[2] }
        vertices[#vertices + 1] = { p[1], 4, p[2] }
    end
    model:generate("polyhedron", { vertices = vertices, density = 2000 })
end
-- The interface goes down steeply from (-4, 1) to (0, -1), and level from there to (4, -1).
part { { -4, 1 }, { 0, -1 }, { 0, 6 }, { -4, 6 } }   -- above, left
part { { 0, -1 }, { 4, -1 }, { 4, 6 }, { 0, 6 } }    -- above, right
part { { -4, 1 }, { 0, -1 }, { 0, -6 }, { -4, -6 } } -- below, left
part { { 0, -1 }, { 4, -1 }, { 4, -6 }, { 0, -6 } }  -- below, right
local above = model:blocks { above = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }
local below = model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }
check.equal(#above, 2)
check.equal(#below, 2)
above:join()
below:join():fix()
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
check.near(model:contacts():min "gap", 0, 1e-9)
-- The weight is carried and nothing is pushed apart.
model:damping "local"
check.equal(model:solve { ratio = 1e-6 }.reason, "ratio")
check.holds(model:contacts():min "gap" > -1e-2, "no deep overlap")
check.holds(math.abs(above[1].displacement[3]) < 1e-2, "it settles a little")

-- Three faults and a tunnel: pieces of joined blocks on both sides of the tunnel's planes.
model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { -8, -8, -8 }, max = { 8, 8, 8 }, density = 2000 })
for i, fault in ipairs { { 50, 320 }, { 40, 230 }, { 65, 270 } } do
    model:generate("joint", { joint = "F" .. i, dip = fault[1], dip_direction = fault[2],
        origin = { 1.5, 0.5, 5 } })
end
local function face(y)
    return { { -3, y, -3 }, { -3, y, 3 }, { 3, y, 3 }, { 3, y, -3 } }
end
model:generate("tunnel", { face1 = face(-8), face2 = face(8), group = "tunnel" })
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
check.near(model:contacts():min "gap", 0, 1e-9)
model:blocks { group = "tunnel" }:delete()
check.near(model:contacts():min "gap", 0, 1e-9)

-- Freshly cut rock whose pieces outside a tunnel are joined again: whichever corner of a face is farthest by
-- rounding, parts that share a face touch there, and nothing overlaps.
for seed = 1, 3 do
    local rock = talus.model { seed = seed }
    rock:generate("box", { min = { 0, 0, 0 }, max = { 10, 10, 10 }, density = 2500 })
    for i, set in ipairs { { 45, 30, 1.6, 7 }, { 70, 160, 1.8, 7 }, { 30, 250, 2, 6 } } do
        rock:generate("jointset", { joint = "J" .. i, dip = set[1], dip_direction = set[2], dip_dev = 5,
            spacing = set[3], number = set[4], origin = { 5, 5, 5 } })
    end
    rock:generate("tunnel", { face1 = { { 4, -1, 4 }, { 4, -1, 6.5 }, { 6, -1, 6.5 }, { 6, -1, 4 } },
        face2 = { { 4, 11, 4 }, { 4, 11, 6.5 }, { 6, 11, 6.5 }, { 6, 11, 4 } }, group = "drift" })
    rock:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    check.holds(#rock:contacts() > 900, "contacts are found")
    check.near(rock:contacts():min "gap", 0, 1e-6)
end
