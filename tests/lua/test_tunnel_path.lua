-- A profile along a path: volumes and places by closed forms, the frame, what stays joined, what is refused.
local talus = require "talus"
local bodies = require "bodies"
local check = require "check"
local shapes = require "shapes"

local Z = { 0, 0, 1 }

local function unit(a)
    return shapes.sum({ 0, 0, 0 }, 1 / shapes.length(a), a)
end

local function minus(a, b)
    return shapes.sum(a, -1, b)
end

-- The legs of a path as the README has them: frame, and normals of the planes at both ends.
local function legs_of(path)
    local legs = {}
    for k = 1, #path - 1 do
        local way = unit(minus(path[k + 1], path[k]))
        local right = unit(shapes.cross(way, Z))
        legs[k] = { from = path[k], to = path[k + 1], way = way, right = right, up = shapes.cross(right, way) }
    end
    local closed = shapes.length(minus(path[#path], path[1])) < 1e-9
    for k, leg in ipairs(legs) do
        local before = legs[k - 1] or (closed and legs[#legs]) or leg
        local after = legs[k + 1] or (closed and legs[1]) or leg
        leg.first, leg.last = shapes.sum(before.way, 1, leg.way), shapes.sum(leg.way, 1, after.way)
    end
    return legs
end

local function place(leg, y, z)
    return shapes.sum(shapes.sum(leg.from, y, leg.right), z, leg.up)
end

-- Where the line {y, z} of the profile begins and ends along a leg.
local function reach(leg, y, z)
    local at = place(leg, y, z)
    local function way(n, q)
        return shapes.dot(n, minus(q, at)) / shapes.dot(n, leg.way)
    end
    return way(leg.first, leg.from), way(leg.last, leg.to)
end

local function area_and_centroid(profile)
    local twice, y, z = 0, 0, 0
    for i, a in ipairs(profile) do
        local b = profile[i % #profile + 1]
        local cross = a[1] * b[2] - a[2] * b[1]
        twice, y, z = twice + cross, y + cross * (a[1] + b[1]), z + cross * (a[2] + b[2])
    end
    return math.abs(twice) / 2, y / (3 * twice), z / (3 * twice)
end

-- Area times the way of the centroid: the planes at the ends cut each line of the profile at a linear function of {y, z}.
local function volume_of(profile, path)
    local area, y, z = area_and_centroid(profile)
    local sum = 0
    for _, leg in ipairs(legs_of(path)) do
        local from, to = reach(leg, y, z)
        sum = sum + area * (to - from)
    end
    return sum
end

-- Distance from the outline, negative outside.
local function depth(profile, y, z)
    local inside, nearest = false, math.huge
    for i, a in ipairs(profile) do
        local b = profile[i % #profile + 1]
        if (a[2] > z) ~= (b[2] > z) and y < a[1] + (z - a[2]) / (b[2] - a[2]) * (b[1] - a[1]) then
            inside = not inside
        end
        local dy, dz = b[1] - a[1], b[2] - a[2]
        local t = math.max(0, math.min(1, ((y - a[1]) * dy + (z - a[2]) * dz) / (dy * dy + dz * dz)))
        nearest = math.min(nearest, math.sqrt((y - a[1] - t * dy) ^ 2 + (z - a[2] - t * dz) ^ 2))
    end
    return inside and nearest or -nearest
end

-- How deep a point lies inside a path's tunnel, negative outside; near 0 at the surface and at joints.
local function depth_in(profile, path, x)
    local most = -math.huge
    for _, leg in ipairs(legs_of(path)) do
        local d = minus(x, leg.from)
        local y, z, t = shapes.dot(d, leg.right), shapes.dot(d, leg.up), shapes.dot(d, leg.way)
        local from, to = reach(leg, y, z)
        most = math.max(most, math.min(depth(profile, y, z), t - from, to - t))
    end
    return most
end

local function rock(low, high, length)
    local model = talus.model { gravity = { 0, 0, -10 } }
    local scale = length or 1
    model:generate("box", { min = shapes.sum({ 0, 0, 0 }, scale, low), max = shapes.sum({ 0, 0, 0 }, scale, high), density = 2000 })
    return model
end

local function inside(model)
    return model:blocks { group = "tunnel" }
end

local square = { { -1, -1 }, { -1, 1 }, { 1, 1 }, { 1, -1 } }
local horseshoe = { { -2, 0 }, { -2.4, 1.5 }, { -2, 3 } }
for i = 1, 9 do
    local angle = math.rad(180 - 18 * i)
    table.insert(horseshoe, { 2 * math.cos(angle), 3 + 2 * math.sin(angle) })
end
for _, corner in ipairs { { 2, 3 }, { 2.4, 1.5 }, { 2, 0 }, { 1, 0 }, { 1, 0.5 }, { -1, 0.5 }, { -1, 0 } } do
    table.insert(horseshoe, corner)
end

-- One leg is the tunnel between two faces, to the bit; the profile's first axis is to the right of the way.
local function ends(profile, path)
    local leg = legs_of(path)[1]
    local faces = { {}, {} }
    for i, corner in ipairs(profile) do
        local at = place(leg, corner[1], corner[2])
        faces[1][i], faces[2][i] = at, shapes.sum(at, shapes.length(minus(path[2], path[1])), leg.way)
    end
    return faces
end

for _, profile in ipairs { square, horseshoe } do
    for _, path in ipairs { { { 0.5, -9, 0 }, { 0.5, 9, 0 } }, { { -9, 0.25, -1 }, { 3, 0.25, -1 } }, { { 0, 4, 0 }, { 0, -4, 0 } } } do
        local faces = ends(profile, path)
        local one, other = rock({ -5, -5, -5 }, { 5, 5, 5 }), rock({ -5, -5, -5 }, { 5, 5, 5 })
        one:generate("tunnel", { face1 = faces[1], face2 = faces[2] })
        other:generate("tunnel", { profile = profile, path = path })
        check.equal(other:state_hash(), one:state_hash())
        check.equal(#other:blocks(), #one:blocks())
    end
end
local model = rock({ -5, -5, -5 }, { 5, 5, 5 })
model:generate("tunnel", { profile = { { 1, 0 }, { 2, 0 }, { 2, 3 }, { 1, 3 } }, path = { { 0, -9, 0 }, { 0, 9, 0 } } })
check.near(inside(model)[1].centroid[1], 1.5, 1e-12)
check.near(inside(model)[1].centroid[3], 1.5, 1e-12)

-- A bend in the plan: the mitre by hand; inside is one body, and so is outside.
model = rock({ -9, -9, -5 }, { 9, 9, 5 })
model:generate("tunnel", { profile = square, path = { { -9, 0, 0 }, { 0, 0, 0 }, { 0, -9, 0 } } })
check.near(inside(model):sum "volume", 4 * 18, 1e-11)
check.equal(bodies(inside(model)), 1)
check.equal(bodies(model:blocks { group = "rock" }), 1)
check.equal(#model:blocks { containing = { 0.95, 0.9, 0 }, group = "tunnel" }, 1)
check.equal(#model:blocks { containing = { 1.1, 0.9, 0 }, group = "tunnel" }, 0)

-- A ring of four legs with a corner at each point of the path.
model = rock({ -9, -9, -5 }, { 9, 9, 5 })
model:generate("tunnel", { profile = horseshoe, group = "ring",
    path = { { -5, -5, 0 }, { 5, -5, 0 }, { 5, 5, 0 }, { -5, 5, 0 }, { -5, -5, 0 } } })
local ring = model:blocks { group = "ring" }
check.near(ring:sum "volume", area_and_centroid(horseshoe) * 40, 1e-9)
check.equal(bodies(ring), 1)
check.equal(bodies(model:blocks { group = "rock" }), 1)
check.near(model:blocks():sum "volume", 18 * 18 * 10, 1e-8)

-- A point on a straight leg changes nothing that lies inside; a path that crosses itself is carved once.
model = rock({ -5, -5, -5 }, { 5, 5, 5 })
model:generate("tunnel", { profile = horseshoe, path = { { 0, -9, 0 }, { 0, 1 / 3, 0 }, { 0, 1, 0 }, { 0, 9, 0 } } })
check.near(inside(model):sum "volume", 10 * area_and_centroid(horseshoe), 1e-10)
check.equal(bodies(inside(model)), 1)
model = rock({ -9, -9, -2 }, { 9, 9, 2 })
model:generate("tunnel", { profile = square, path = { { 0, -8, 0 }, { 0, 6, 0 }, { 6, 6, 0 }, { 6, 0, 0 }, { -8, 0, 0 } } })
check.near(inside(model):sum "volume", 4 * (14 + 6 + 6 + 14) - 8, 1e-10)

-- Random paths and profiles, in rock that joints have cut or not; mirrored, turned about the vertical, backwards, in other units.
local function random_profile(random)
    local profile, n = {}, math.floor(random(3, 10.999))
    local jagged = random(0, 1) < 0.5
    for i = 1, n do
        local angle = 2 * math.pi * (i + random(-0.3, 0.3)) / n
        local r = jagged and random(0.4, 1.2) or 1
        profile[i] = { r * math.cos(angle) + 0.2, r * math.sin(angle) - 0.1 }
    end
    return profile
end

local function random_path(random)
    local plan, path = random(0, 2 * math.pi), { { random(-2, 2), random(-2, 2), random(-2, 2) } }
    local bend = random(0, 1) < 0.5 and 0.7 or 0.1
    for k = 1, math.floor(random(1, 5.999)) do
        local slope = random(-0.5, 0.5)
        local way = { math.cos(plan) * math.cos(slope), math.sin(plan) * math.cos(slope), math.sin(slope) }
        path[k + 1] = shapes.sum(path[k], random(3, 5), way)
        plan = plan + bend * random(0, 1)
    end
    return path
end

local function carved(profile, path, cut, scale)
    local built = rock({ -30, -30, -30 }, { 30, 30, 30 }, scale)
    if cut then
        for _, joint in ipairs(cut) do
            built:generate("joint", { joint = "J", dip = joint.dip, dip_direction = joint.direction,
                origin = shapes.sum({ 0, 0, 0 }, scale or 1, joint.origin) })
        end
    end
    local function scaled(list)
        local out = {}
        for i, x in ipairs(list) do
            out[i] = {}
            for j, value in ipairs(x) do
                out[i][j] = value * (scale or 1)
            end
        end
        return out
    end
    local before = bodies(built:blocks())
    built:generate("tunnel", { profile = scaled(profile), path = scaled(path) })
    check.near(built:blocks():sum "volume" / (scale or 1) ^ 3, 60 ^ 3, 1e-6)
    return built, before
end

local function turned(path, m)
    local out = {}
    for i, x in ipairs(path) do
        out[i] = shapes.apply(m, x)
    end
    return out
end

-- Volumes are good to 1e-8: corners are rounded by 1e-9 of the 60 m of the rock that is cut.
for seed = 1, check.cases(100) do
    local random = shapes.random(seed)
    local profile, path, cut = random_profile(random), random_path(random), nil
    if seed % 2 == 0 then
        cut = {}
        for i = 1, 3 do
            cut[i] = { dip = random(0, 90), direction = random(0, 360), origin = { random(-3, 3), random(-3, 3), random(-3, 3) } }
        end
    end
    local volume = volume_of(profile, path)
    local built, before = carved(profile, path, cut)
    check.near(inside(built):sum "volume", volume, 1e-8 * volume)
    check.holds(bodies(built:blocks { group = "rock" }) >= before, "seed " .. seed)
    if not cut then
        check.equal(bodies(inside(built)), 1)
        check.equal(bodies(built:blocks { group = "rock" }), 1)
    end
    for _ = 1, 20 do
        local at = path[math.floor(random(1, #path + 0.999))]
        local x = { at[1] + random(-2, 2), at[2] + random(-2, 2), at[3] + random(-2, 2) }
        local deep = depth_in(profile, path, x)
        if deep > 1e-6 then
            check.equal(#built:blocks { containing = x, group = "tunnel" }, 1)
        elseif shapes.length(minus(x, path[1])) > 0 and deep < -1e-6 then
            check.equal(#built:blocks { containing = x, group = "tunnel" }, 0)
        end
    end
    local mirrored, backwards = {}, {}
    for i, corner in ipairs(profile) do
        mirrored[i] = { -corner[1], corner[2] }
    end
    for i, x in ipairs(path) do
        backwards[#path + 1 - i] = x
    end
    local angle = random(0, 2 * math.pi)
    for _, other in ipairs {
        carved(mirrored, turned(path, { { 1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 1 } })),
        carved(profile, turned(path, shapes.turn(Z, angle))),
        (carved(mirrored, backwards, cut)),
    } do
        check.near(inside(other):sum "volume", volume, 1e-8 * volume)
    end
    for _, scale in ipairs { 1e-3, 1e4 } do
        local other = carved(profile, path, cut, scale)
        check.near(inside(other):sum "volume" / scale ^ 3, volume, 1e-8 * volume)
        check.equal(#other:blocks(), #built:blocks())
    end
end

-- What is refused, with the model as it was.
model = rock({ -5, -5, -5 }, { 5, 5, 5 })
local function refused(given, part)
    check.refused(model, function()
        model:generate("tunnel", given)
    end, "generator 'tunnel' of plugin 'talus.tunnel': " .. part)
end
local straight = { { 0, -9, 0 }, { 0, 9, 0 } }
refused({}, "profile is missing: a tunnel has face1 and face2, or profile and path")
refused({ profile = square }, "path is missing")
refused({ path = straight }, "profile is missing")
local faces = ends(square, straight)
refused({ face1 = faces[1], face2 = faces[2], path = straight }, "path is one too many")
refused({ face1 = faces[1], profile = square, path = straight }, "face2 is missing")
refused({ profile = { { 0, 0 }, { 1, 1 } }, path = straight }, "profile has 2 corners")
refused({ profile = { { 0, 0 }, { 1, 1 }, { 2, 2 } }, path = straight }, "profile has no area")
refused({ profile = { { -1, -1 }, { 1, 1 }, { 1, -1 }, { -1, 1 } }, path = straight }, "profile crosses or touches itself: its edge")
refused({ profile = { { -1, -1 }, { -1, -1 }, { 1, 1 }, { 1, -1 } }, path = straight }, "profile has the same place")
refused({ profile = square, path = { { 0, 0, 0 } } }, "path has 1 point; at least 2 are needed")
refused({ profile = square, path = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 1, 0 } } }, "path has the same place {0, 0, 0} as points 1 and 2")
refused({ profile = square, path = { { 0, 0, 0 }, { 0, 3, 0 }, { 0, 3, 9 } } },
    "path: its leg from point 2 {0, 3, 0} to 3 {0, 3, 9} is vertical")
refused({ profile = square, path = { { 0, 0, 0 }, { 0, 9, 0 }, { 0, 3, 0 } } }, "path folds back on itself at point 2 {0, 9, 0}")
refused({ profile = square, path = { { 0, 0, 0 }, { 0, 9, 0 }, { 0, 0, 0 } } }, "path folds back on itself at point 2 {0, 9, 0}")
refused({ profile = square, path = { { 0, -5, 0 }, { 0, 0, 0 }, { 1.5, 0, 0 }, { 1.5, -5, 0 } } },
    "path: its leg from point 2 {0, 0, 0} to 3 {1.5, 0, 0} is too short for the turns at its ends: corner ")
refused({ profile = square, path = { { 0, -5, 0 }, { 0, 0, 0 }, { 0.1, -5, 0 } } }, "path: its leg from point 1")
refused({ profile = square, path = { { 20, -9, 0 }, { 20, 9, 0 } } }, "the tunnel meets no visible block: it runs from {20, -9, 0}")
check.refused(model, function()
    model:generate("tunnel", { profile = { { 0, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } }, path = straight })
end, "generator 'tunnel': profile must be a list of points in a plane, two numbers each")

-- A path that turns and climbs at once leaves no chip between the sides of two legs, whose profiles are rolled against each other by any
-- angle; the volume is that of the prisms.
local vault = { { -1, 0 }, { -1, 1.2 }, { -0.5, 1.9 }, { 0.5, 1.9 }, { 1, 1.2 }, { 1, 0 } }
for number = 1, check.cases(300) do
    local random = shapes.random(900 + number)
    local sharp = 10 ^ random(-8, 0)
    local plan, path = random(0, 2 * math.pi), { { random(-2, 2), random(-2, 2), random(-2, 2) } }
    for k = 1, math.floor(random(2, 4.999)) do
        local slope = random(-0.3, 0.3)
        local way = { math.cos(plan) * math.cos(slope), math.sin(plan) * math.cos(slope), math.sin(slope) }
        path[k + 1] = shapes.sum(path[k], random(4, 6), way)
        plan = plan + 0.5 * sharp * random(-1, 1)
    end
    model = rock({ -40, -40, -40 }, { 40, 40, 40 })
    model:generate("tunnel", { profile = vault, path = path })
    check.holds(model:blocks():min "volume" > 5, string.format("path %d leaves a block of %g m3", number, model:blocks():min "volume"))
    check.near(inside(model):sum "volume", volume_of(vault, path), 1e-9)
    check.near(model:blocks():sum "volume", 80 ^ 3, 1e-6)
    check.equal(#inside(model), #path - 1)
    check.equal(bodies(inside(model)), 1)
end

-- A section that is not convex is cut along planes that meet in lines. Corners of the tunnel are rounded where they are given, in a
-- grid of a map far more coarsely than the blocks' own frame can tell: no block has an edge of that length, which no file can keep.
local angle = { { -1, -1 }, { 1, -1 }, { 1, 0 }, { 0, 0 }, { 0, 1 }, { -1, 1 } }
local file = os.tmpname()
for number = 1, check.cases(60) do
    local random = shapes.random(500 + number)
    local far = 10 ^ random(2, 6)
    local at = { far, -2 * far, 0.1 * far }
    local half = { random(5, 50), random(5, 50), random(5, 50) }
    local way = { math.cos(number), math.sin(number), random(-0.4, 0.4) }
    model = rock(shapes.sum(at, -1, half), shapes.sum(at, 1, half))
    local made = model:generate("tunnel", { profile = angle, path = { shapes.sum(at, -3, way), shapes.sum(at, 3, way) } })
    check.holds(made.smallest_edge > 1e-3, string.format("tunnel %d: an edge of %g m", number, made.smallest_edge))
    model:write_blocks(file)
    local again = talus.model {}
    again:generate("blocks", { file = file })
    check.equal(#again:blocks(), #model:blocks())
end
os.remove(file)
