-- The tunnel generator: what it cuts, what stays joined, what it refuses.
local talus = require "talus"
local check = require "check"

local bodies = require "bodies"

local function rock(low, high)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = low or { -5, -5, -5 }, max = high or { 5, 5, 5 },
        density = 2000, group = "rock" })
    return model
end

-- The section {x, z} at y, moved by dx and dz.
local function face(section, y, dx, dz)
    local corners = {}
    for i, corner in ipairs(section) do
        corners[i] = { corner[1] + (dx or 0), y, corner[2] + (dz or 0) }
    end
    return corners
end

local square = { { -1, -1 }, { -1, 1 }, { 1, 1 }, { 1, -1 } }

-- Through the model: four pieces outside are one body, the inside is another.
local model = rock()
local summary = model:generate("tunnel", { face1 = face(square, -9), face2 = face(square, 9) })
check.equal(summary.before, 1)
check.equal(summary.after, 5)
check.near(summary.volume_error, 0, 1e-14)
local inside = model:blocks { group = "tunnel" }
check.equal(#inside, 1)
check.near(inside[1].volume, 40, 1e-12)
check.equal(bodies(model:blocks()), 2)
check.equal(bodies(model:blocks { group = "rock" }), 1)
inside:delete()
check.equal(bodies(model:blocks()), 1)
check.near(model:blocks():sum "volume", 960, 1e-11)

-- With both ends inside: six pieces outside.
model = rock()
model:generate("tunnel", { face1 = face(square, -2), face2 = face(square, 3), group = "drift" })
check.equal(#model:blocks(), 7)
check.equal(bodies(model:blocks { group = "rock" }), 1)
check.near(model:blocks { group = "drift" }:sum "volume", 20, 1e-12)

-- Only visible blocks in the way are cut; the rest, and hidden ones, keep their ids.
model = rock()
model:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 3, 0, 0 } })
model:generate("joint", { joint = "K", dip = 90, dip_direction = 0, origin = { 0, 0, 0 } })
local away = model:blocks { containing = { 4, 2, 0 } }
local hidden = model:blocks { containing = { 0, 2, 0 } }
hidden:hide()
model:generate("tunnel", { face1 = face(square, -9), face2 = face(square, 9) })
check.near(away[1].volume, 100 * 0.2 * 5, 1e-12)
check.near(hidden[1].volume, 400, 1e-12)
check.near(model:blocks { group = "tunnel" }:sum "volume", 20, 1e-12)
-- The joint J runs on; what a joint parts is not joined.
check.equal(bodies(model:blocks { group = "rock", hidden = "any" }), 4)

-- Two tunnels that cross: the second cuts what the first left, inside and outside.
model = rock()
model:generate("tunnel", { face1 = face(square, -9), face2 = face(square, 9), group = "first" })
local function across(x)
    return { { x, -1, -1 }, { x, -1, 1 }, { x, 1, 1 }, { x, 1, -1 } }
end
model:generate("tunnel", { face1 = across(-9), face2 = across(9), group = "second" })
check.near(model:blocks { group = "first" }:sum "volume", 32, 1e-12)
check.near(model:blocks { group = "second" }:sum "volume", 40, 1e-12)
check.near(model:blocks { group = "rock" }:sum "volume", 1000 - 72, 1e-11)
check.equal(bodies(model:blocks { group = "rock" }), 1)
check.equal(bodies(model:blocks { group = "first" }), 2)
model:blocks { where = function(b) return b.group ~= "rock" end }:delete()
check.equal(bodies(model:blocks()), 1)

-- A tunnel that takes all of a block's middle parts its body.
model = rock({ -5, -5, -1 }, { 5, 5, 1 })
model:generate("tunnel", { face1 = face(square, -9), face2 = face(square, 9) })
check.equal(bodies(model:blocks { group = "rock" }), 2)

-- Later joints cut the lining into bodies that hang together.
model = rock()
model:generate("tunnel", { face1 = face(square, -9), face2 = face(square, 9) })
model:blocks { group = "tunnel" }:delete()
model:generate("joint", { joint = "J", dip = 90, dip_direction = 0, origin = { 0, 0, 0 } })
check.equal(#model:blocks(), 8)
check.equal(bodies(model:blocks()), 2)
model:generate("joint", { joint = "K", dip = 0, dip_direction = 0, origin = { 0, 0, 0 } })
check.equal(bodies(model:blocks()), 4)

-- Sections that are not convex, in both senses, tapered, and far from zero.
local function area(section)
    local sum = 0
    for i, a in ipairs(section) do
        local b = section[i % #section + 1]
        sum = sum + (a[1] * b[2] - a[2] * b[1]) / 2
    end
    return math.abs(sum)
end

local function reversed(section)
    local other = {}
    for i = #section, 1, -1 do
        other[#other + 1] = section[i]
    end
    return other
end

local horseshoe = { { -2, -2 }, { -2.4, -0.5 }, { -2, 1 } }
for i = 1, 9 do
    local angle = math.rad(180 - 18 * i)
    horseshoe[#horseshoe + 1] = { 2 * math.cos(angle), 1 + 2 * math.sin(angle) }
end
for _, corner in ipairs { { 2, 1 }, { 2.4, -0.5 }, { 2, -2 }, { 1, -2 }, { 1, -1.5 }, { -1, -1.5 },
    { -1, -2 } } do
    horseshoe[#horseshoe + 1] = corner
end
local notched = { { -2, -2 }, { -2, 2 }, { -1, 2 }, { -1, 1 }, { 0, 1 }, { 0, 2 }, { 2, 2 },
    { 2, 0 }, { 1, 0 }, { 1, -1 }, { 2, -1 }, { 2, -2 } }
local star = {}
for i = 0, 9 do
    local r, angle = i % 2 == 0 and 3 or 1.2, math.rad(36 * i + 7)
    star[#star + 1] = { r * math.sin(angle), r * math.cos(angle) }
end
for _, section in ipairs { horseshoe, notched, star } do
    for _, corners in ipairs { section, reversed(section) } do
        model = rock()
        model:generate("tunnel", { face1 = face(corners, -9), face2 = face(corners, 9) })
        inside = model:blocks { group = "tunnel" }
        check.near(inside:sum "volume", 10 * area(section), 1e-11)
        check.equal(bodies(inside), 1)
        check.equal(bodies(model:blocks { group = "rock" }), 1)
        check.near(model:blocks():sum "volume", 1000, 1e-11)

        local far = 1e6
        model = rock({ far - 5, far - 5, far - 5 }, { far + 5, far + 5, far + 5 })
        model:generate("tunnel", { face1 = face(corners, far - 9, far, far),
            face2 = face(corners, far + 9, far, far) })
        check.near(model:blocks { group = "tunnel" }:sum "volume", 10 * area(section), 1e-7)

        local narrow = {}
        for i, corner in ipairs(corners) do
            narrow[i] = { corner[1] / 2, corner[2] / 2 }
        end
        model = rock()
        model:generate("tunnel", { face1 = face(corners, -3), face2 = face(narrow, 3) })
        check.near(model:blocks { group = "tunnel" }:sum "volume",
            6 / 3 * area(section) * (1 + 0.5 + 0.25), 1e-10)
    end
end

-- What is refused, with the model as it was.
model = rock()
local function refused(face1, face2, part)
    check.refused(model, function()
        model:generate("tunnel", { face1 = face1, face2 = face2 })
    end, "generator 'tunnel' of plugin 'talus.tunnel': " .. part)
end
refused(face({ { 0, 0 }, { 1, 1 } }, -9), face({ { 0, 0 }, { 1, 1 } }, 9), "face1 has 2 corners")
refused(face(square, -9), face({ { 0, 0 }, { 1, 1 }, { 2, 0 } }, 9),
    "face1 has 4 corners and face2 3")
refused(face(square, -9), face(square, -9), "face1 and face2 are the same")
local bow = { { -1, -1 }, { 1, 1 }, { 1, -1 }, { -1, 1 } }
refused(face(bow, -9), face(bow, 9),
    "face1 crosses or touches itself: its edge from corner 1 to 2 meets")
local folded = { { -1, -1 }, { 1, -1 }, { 0, -1 }, { 0, 1 } }
refused(face(folded, -9), face(folded, 9), "face1 crosses or touches itself")
local line = { { -1, -1 }, { 0, 0 }, { 1, 1 } }
refused(face(line, -9), face(line, 9), "face1 has no area")
local twice = { { -1, -1 }, { -1, -1 }, { 1, 1 }, { 1, -1 } }
refused(face(twice, -9), face(twice, 9), "face1 has the same place {-1, -9, -1} as corners 1 and 2")
local bent = face(square, 9)
bent[2][2] = 9.5
refused(face(square, -9), bent, "face2 is warped")
local turned = { square[2], square[3], square[4], square[1] }
refused(face(square, -9), face(turned, 9), "the side between corners 1 and 2 is warped")
local half_turn = { square[3], square[4], square[1], square[2] }
refused(face(square, -9), face(half_turn, 9),
    "the side between corners 1 and 2 has no area or crosses itself")
refused({ { -1, -9, -1 }, { -1, -9, 1 }, { 1, 9, 1 }, { 1, 9, -1 } },
    { { -1, 9, -1 }, { -1, 9, 1 }, { 1, -9, 1 }, { 1, -9, -1 } }, "")
refused(face(square, -9, 0, 20), face(square, 9, 0, 20), "the tunnel meets no visible block")
check.refused(model, function() model:generate("tunnel", { face1 = face(square, 1) }) end, "face2")
