-- relax_models.lua - random models of which a run is to say whether they stand: slopes, floors, tunnels and rooms, stacks, columns,
-- arches, walls, wedges, toppling columns, hanging blocks and bodies joined of several blocks. Half of them fail, about.
--
--     model, about = models.build(seed, change)
--
-- The same seed gives the same model, in any order of calls. `change` may name factors: friction (of its tangent), strength (of
-- cohesion and tension) and load (of gravity and of the forces on blocks). What is left out is 1.
--
--     about.kind, about.text     "slope" and so on; the model in a line
--     about.law                  the law of most joints
--     about.brittle              some law loses strength for good, so that the answer depends on the way in which load comes
--     about.stages               a list of { name =, act =, group = }: `act`, where there is one, changes the model; after each the model is
--                                run. `group` is what it excavates
--     about.apply(model, share)  puts on a share of gravity and loads; nil where there is an initial stress
--
-- models.release(model, group) excavates a group, but leaves the forces that its blocks gave as loads on what remains. It gives a function
-- of a share of them that is to be left.
local shapes = require "shapes"
local talus = require "talus"

local models = {}
local G = 9.81 -- m/s2
local MOST_BLOCKS = 80

-- ---------------------------------------------------------------- draws

-- Numbers between two bounds, by splitmix64: those of neighbouring seeds have nothing in common.
local function draws(seed)
    local state = seed
    return function(low, high)
        state = state + 0x9E3779B97F4A7C15
        local x = (state ~ (state >> 30)) * 0xBF58476D1CE4E5B9
        x = (x ~ (x >> 27)) * 0x94D049BB133111EB
        return low + (high - low) * (((x ~ (x >> 31)) >> 11) * 0x1p-53)
    end
end

local function chance(random, probability)
    return random(0, 1) < probability
end

local function whole(random, low, high)
    return math.min(high, low + math.floor(random(0, high - low + 1)))
end

local function pick(random, list)
    return list[whole(random, 1, #list)]
end

-- One of a list of { value, weight }.
local function weighted(random, list)
    local sum = 0
    for _, entry in ipairs(list) do
        sum = sum + entry[2]
    end
    local at = random(0, sum)
    for _, entry in ipairs(list) do
        at = at - entry[2]
        if at < 0 then
            return entry[1]
        end
    end
    return list[#list][1]
end

-- Ends a draw that gives no model; another is made in its place.
local function redraw_unless(good, why)
    if not good then
        error({ redraw = why })
    end
end

-- ---------------------------------------------------------------- parts of models

local function box(model, min, max, group, density)
    model:generate("box", { min = min, max = max, density = density or 2600, group = group or "rock" })
end

local function held(model, min, max)
    box(model, min, max, "held")
end

-- A joint set that scatters.
local function set(random, name, dip, direction, spacing)
    return { joint = name, dip = math.min(90, math.max(0, dip)), dip_direction = direction % 360, spacing = spacing,
        dip_dev = random(1, 8), dip_direction_dev = random(1, 10), spacing_dev = random(0, 0.3) * spacing,
        persistence = chance(random, 0.2) and random(0.6, 1) or 1, number = whole(random, 2, 5),
        distribution = "normal" }
end

-- Rock cut by joint sets: with more spacing and fewer planes until it has few enough blocks. `base` makes the uncut rock, and
-- `finish` what comes after the sets.
local function cut_rock(seed, base, sets, origin, finish)
    local factor, fewer = 1, 0
    while true do
        local model = talus.model { gravity = { 0, 0, -G }, seed = seed }
        base(model)
        for _, s in ipairs(sets) do
            local now = { origin = origin }
            for key, value in pairs(s) do
                now[key] = value
            end
            now.spacing, now.spacing_dev = s.spacing * factor, s.spacing_dev * factor
            now.number = math.max(1, s.number - fewer)
            model:generate("jointset", now)
        end
        if finish then
            finish(model)
        end
        local blocks = #model:blocks()
        if blocks <= MOST_BLOCKS - 8 and blocks >= 3 then
            return model
        end
        redraw_unless(blocks >= 3 and fewer <= 6, "too few blocks or too many")
        factor, fewer = factor * 1.15, fewer + 1
    end
end

-- One block less a thin slice along one of its faces.
local function add_sliver(random, model, about)
    local free = model:blocks { where = function(b) return b.group ~= "held" end }
    local block = pick(random, free)
    local faces, vertices = block.faces, block.vertices
    local face = pick(random, faces)
    local diameter, aspect = 0, 10 ^ random(1.5, 3)
    for i = 1, #vertices do
        for k = 1, i - 1 do
            diameter = math.max(diameter, shapes.length(shapes.sum(vertices[i], -1, vertices[k])))
        end
    end
    local n = face.normal
    local origin = shapes.sum(vertices[face.vertices[1]], -diameter / aspect, n)
    if n[3] < 0 then
        n = { -n[1], -n[2], -n[3] }
    end
    local dip = math.deg(math.acos(math.min(1, n[3])))
    model:blocks():hide()
    model:blocks { id = block.id, hidden = "any" }:show()
    local cut = model:generate("joint", { joint = "sliver", dip = math.min(dip, 90), origin = origin,
        dip_direction = math.deg(math.atan(n[1], n[2])) % 360 })
    model:blocks { hidden = true }:show()
    if cut.cuts > 0 then
        about.text = ("%s, sliver of aspect %.0f"):format(about.text, aspect)
    end
end

-- Joins some blocks to a neighbour.
local function add_joins(random, model, about)
    local contacts = model:contacts { where = function(c)
        return c.area > 0 and c.blocks[1].group ~= "held" and c.blocks[1].group == c.blocks[2].group
    end }
    local joins, pairs = math.min(#contacts, whole(random, 1, 5)), {}
    for k = 1, joins do
        local blocks = pick(random, contacts).blocks
        pairs[k] = { blocks[1].id, blocks[2].id }
    end
    for _, pair in ipairs(pairs) do
        model:blocks { id = pair }:join()
    end
    about.text = ("%s, %d joins"):format(about.text, joins)
end

-- ---------------------------------------------------------------- kinds
--
-- Each gives a model without laws, and a table: `height` of what rests on one block, m; `size` of a block; `friction`, degrees,
-- drawn; and what of `about` it knows.

local kinds = {}

-- A slope of scattered sets on a floor, with a wall behind it.
function kinds.slope(random, seed)
    local high = 4 * 10 ^ random(-0.5, 1)
    local face, behind, thick = math.rad(random(45, 90)), random(1, 2) * high, random(0.4, 1.2) * high
    local top = -high / math.tan(face)
    local sets = {
        set(random, "J1", random(20, 70), 90 + random(-30, 30), random(0.25, 0.6) * high),
        set(random, "J2", random(55, 90), pick(random, { 90, 270 }) + random(-30, 30), random(0.25, 0.7) * high),
    }
    if chance(random, 0.7) then
        sets[3] = set(random, "J3", random(60, 90), pick(random, { 0, 180 }) + random(-30, 30), random(0.3, 0.8) * high)
    end
    local function base(model)
        model:generate("profile", { section = { { -behind + top, 0 }, { 0, 0 }, { top, high }, { -behind + top, high } },
            to = thick, density = 2600, group = "rock" })
    end
    local model = cut_rock(seed, base, sets, { 0.7 * top - 0.2 * behind, thick / 2, 0.4 * high })
    local far = high / 4
    held(model, { -behind + top - far, -far, -far }, { 3 * high, thick + far, 0 })
    held(model, { -behind + top - far, -far, 0 }, { -behind + top, thick + far, high })
    local sides = weighted(random, { { "walls", 1 }, { "one wall", 1 }, { "free", 1 } })
    if sides ~= "free" then
        held(model, { -behind + top, -far, 0 }, { 0, 0, high })
    end
    if sides == "walls" then
        held(model, { -behind + top, thick, 0 }, { 0, thick + far, high })
    end
    return model, { height = high, size = high / 3, friction = random(5, 60),
        text = ("slope of %.0f degrees, sides %s"):format(math.deg(face), sides) }
end

-- A floor of scattered sets in a pit, of which a side may be open, under a gravity that may lean, with a load on one block.
function kinds.floor(random, seed)
    local size = 10 ^ random(-0.5, 1)
    local x, y, z = random(2, 5) * size, random(2, 5) * size, random(1, 2.5) * size
    local sets = {
        set(random, "J1", random(0, 40), random(0, 360), size), set(random, "J2", random(55, 90), random(0, 360), size),
        set(random, "J3", random(55, 90), random(0, 360), size),
    }
    local model = cut_rock(seed, function(m) box(m, { 0, 0, 0 }, { x, y, z }) end, sets, { x / 2, y / 2, z / 2 })
    held(model, { -size, -size, -size }, { x + size, y + size, 0 })
    held(model, { -size, -size, 0 }, { 0, y + size, z })
    held(model, { 0, -size, 0 }, { x, 0, z })
    held(model, { 0, y, 0 }, { x, y + size, z })
    local open = chance(random, 0.7)
    if not open then
        held(model, { x, -size, 0 }, { x + size, y + size, z })
    end
    local lean = math.rad(open and random(5, 45) or random(0, 10))
    local share, at = random(0, 4), { random(0.2, 0.8) * x, random(0.2, 0.8) * y, z * 0.999 }
    local weight = share * 2600 * G * size ^ 3
    return model, { height = z, size = size, friction = random(5, 60),
        gravity = { G * math.sin(lean), 0, -G * math.cos(lean) },
        load = function(m, factor)
            local under = m:blocks { containing = at }
            if #under > 0 and weight > 0 then
                under:load { force = { 0, 0, -factor * weight }, at = at }
            end
        end,
        text = ("floor, %s, leaning %.1f degrees, load %.2f"):format(open and "open" or "closed", math.deg(lean), share) }
end

-- The polygon of an opening at y: of a room, or of a horseshoe.
local function opening(shape, x, z, wide, high, y)
    local ring = { { x - wide / 2, y, z }, { x + wide / 2, y, z }, { x + wide / 2, y, z + 0.6 * high } }
    if shape == "room" then
        ring[3][3] = z + high
        ring[4] = { x - wide / 2, y, z + high }
        return ring
    end
    for k = 1, 3 do
        local angle = math.pi * k / 4
        ring[#ring + 1] = { x + wide / 2 * math.cos(angle), y, z + 0.6 * high + 0.4 * high * math.sin(angle) }
    end
    ring[#ring + 1] = { x - wide / 2, y, z + 0.6 * high }
    return ring
end

-- Tunnels and rooms in rock under an initial stress, excavated in one or more stages.
function kinds.tunnel(random, seed)
    local size = 10 ^ random(-0.3, 0.7) -- of a block
    local wide, long, high = random(4, 6) * size, random(1.5, 3) * size, random(4, 6) * size
    local flat = chance(random, 0.3) -- bedded rock
    local sets = {
        set(random, "J1", flat and random(0, 15) or random(30, 70), random(0, 360), 1.2 * size),
        set(random, "J2", flat and random(70, 90) or random(45, 90), 90 + random(-40, 40), 1.2 * size),
        set(random, "J3", random(60, 90), random(0, 360), 1.6 * size),
    }
    local shape = pick(random, { "room", "horseshoe" })
    local w, h = random(1.3, 2.4) * size, random(1.2, 2) * size
    local openings = weighted(random, { { "one", 3 }, { "two stages", 2 }, { "two rooms", 2 } })
    local x, z = wide / 2 + random(-0.3, 0.3) * size, 0.3 * high
    local function finish(model)
        local function excavate(group, at, below, wall)
            model:generate("tunnel", { face1 = opening(wall or shape, at, below, w, h, 0),
                face2 = opening(wall or shape, at, below, w, h, long), group = group })
        end
        if openings == "one" then
            excavate("first", x, z)
        elseif openings == "two stages" then
            excavate("first", x, z)
            excavate("second", x, z - h, "room")
        else
            excavate("first", x - 0.75 * w, z)
            excavate("second", x + 0.75 * w, z)
        end
    end
    local model = cut_rock(seed, function(m) box(m, { 0, 0, 0 }, { wide, long, high }) end, sets,
        { wide / 2, long / 2, high / 2 }, finish)
    held(model, { -size, -size, -size }, { wide + size, long + size, 0 })
    held(model, { -size, -size, high }, { wide + size, long + size, high + size })
    held(model, { -size, -size, 0 }, { 0, long + size, high })
    held(model, { wide, -size, 0 }, { wide + size, long + size, high })
    held(model, { 0, -size, 0 }, { wide, 0, high })
    held(model, { 0, long, 0 }, { wide, long + size, high })
    local depth, k = 10 ^ random(-0.2, 1.6) * high, 10 ^ random(-1.5, 0.3)
    local stages = { { name = "in situ" } }
    for _, group in ipairs(openings == "one" and { "first" } or { "first", "second" }) do
        stages[#stages + 1] = { name = group, group = group, act = function(m)
            m:blocks { group = group }:delete()
        end }
    end
    return model, { height = depth, size = size, friction = random(5, 33), stages = stages,
        insitu = function(m)
            local zz = -2600 * G * depth
            m:insitu { stress = { xx = k * zz, yy = k * zz, zz = zz }, at = { 0, 0, high },
                gradient = { xx = k * 2600 * G, yy = k * 2600 * G, zz = 2600 * G } }
        end,
        text = ("%s, %s, depth %.3g m, k %.2f"):format(shape, openings, depth, k) }
end

-- Bricks, each set back by a share of what the harmonic series allows.
function kinds.stack(random)
    local bricks, size, share = whole(random, 2, 8), 10 ^ random(-0.7, 0.7), random(0.8, 1.15)
    local h, w = random(0.15, 0.5) * size, random(0.3, 1) * size
    local model = talus.model { gravity = { 0, 0, -G } }
    held(model, { -size, 0, -size }, { 0, w, 0 })
    local x = 0
    for i = bricks, 1, -1 do
        x = x + share * size / (2 * i)
        local z = (bricks - i) * h
        box(model, { x - size, 0, z }, { x, w, z + h })
    end
    return model, { height = bricks * h, size = size, friction = random(20, 60), geometric = true,
        text = ("stack of %d, share %.3f"):format(bricks, share) }
end

-- A column of bricks that lie a little beside each other, under a gravity that leans.
function kinds.column(random)
    local bricks, size = whole(random, 2, 10), 10 ^ random(-0.7, 0.7)
    local h, share = random(0.2, 0.8) * size, random(0.8, 1.15)
    local lean = math.atan(share * size / (bricks * h))
    lean = math.min(lean, math.rad(random(20, 40)))
    local model = talus.model { gravity = { 0, 0, -G } }
    local way = math.rad(pick(random, { 0, 90, random(0, 90) }))
    held(model, { -size, -size, -size }, { 2 * size, 2 * size, 0 })
    for i = 1, bricks do
        local x, y = random(-0.05, 0.05) * size, random(-0.05, 0.05) * size
        box(model, { x, y, (i - 1) * h }, { x + size, y + size, i * h })
    end
    local slides = chance(random, 0.3)
    local friction = math.deg(math.atan(math.tan(lean) * (slides and random(0.85, 1.15) or random(1.1, 3))))
    return model, { height = bricks * h, size = size, friction = math.min(60, math.max(5, friction)), geometric = true,
        gravity = { G * math.sin(lean) * math.cos(way), G * math.sin(lean) * math.sin(way), -G * math.cos(lean) },
        text = ("column of %d, leaning %.2f degrees"):format(bricks, math.deg(lean)) }
end

-- An arch of voussoirs, on springers that are held or on two piers.
function kinds.arch(random)
    local stones, radius = whole(random, 5, 13), 10 ^ random(-0.3, 0.8)
    local half = math.rad(chance(random, 0.5) and 90 or random(45, 85)) -- of the opening
    local least = 0.1075 * (half / math.rad(90)) ^ 3 -- of a semicircle, after Milankovitch; less of a flat one
    local share = random(0.85, 1.6)
    local thick, deep = math.max(share * least, 0.02) * radius, random(0.2, 0.6) * radius
    local inner, outer = radius - thick / 2, radius + thick / 2
    local model = talus.model { gravity = { 0, 0, -G } }
    local function at(r, angle)
        return { r * math.sin(angle), 0, r * math.cos(angle) }
    end
    for i = 1, stones do
        local a, b = -half + 2 * half * (i - 1) / stones, -half + 2 * half * i / stones
        model:generate("prism", { base = { at(inner, a), at(outer, a), at(outer, b), at(inner, b) }, axis = { 0, deep, 0 },
            density = 2600, group = "rock" })
    end
    local piers = half == math.rad(90) and chance(random, 0.6)
    local high, broad = random(0.3, 1.5) * radius, math.max(1.01 * thick, random(0.15, 0.6) * radius)
    for _, side in ipairs { -1, 1 } do
        if piers then
            local near, far = side * inner, side * (inner + broad)
            box(model, { math.min(near, far), 0, -high }, { math.max(near, far), deep, 0 })
        else
            local a, b = side * half, side * (half + 0.2)
            model:generate("prism", { base = { at(inner, a), at(outer, a), at(outer, b), at(inner, b) },
                axis = { 0, deep, 0 }, density = 2600, group = "held" })
        end
    end
    if piers then
        local wide = inner + 2 * broad
        held(model, { -wide, -deep, -high - radius }, { wide, 2 * deep, -high })
    end
    return model, { height = radius, size = 2 * half * radius / stones, friction = random(20, 60), geometric = true,
        text = ("arch of %d, half opening %.0f degrees, thickness %.2f of the least, %s"):format(stones, math.deg(half), share,
            piers and ("on piers %.2f by %.2f"):format(broad / radius, high / radius) or "held") }
end

-- A wall of bricks in bond under a gravity that leans, with a push on one side.
function kinds.wall(random)
    local wide, high, size = whole(random, 1, 5), whole(random, 2, 8), 10 ^ random(-0.7, 0.7)
    local h, deep = random(0.3, 0.7) * size, random(0.3, 1) * size
    local model = talus.model { gravity = { 0, 0, -G } }
    local right = 0
    for k = 0, high - 1 do
        local shift = k % 2 == 1 and size / 2 or 0
        for i = 0, wide - 1 do
            local x = i * size + shift
            box(model, { x, 0, k * h }, { x + size, deep, (k + 1) * h })
            right = math.max(right, x + size)
        end
    end
    held(model, { -size, -size, -size }, { right + size, deep + size, 0 })
    local lean, push = math.rad(random(0, 25)), random(0, 0.6)
    local across = chance(random, 0.5)
    local way = across and { 0, 1, 0 } or { 1, 0, 0 }
    local at, force = whole(random, 2, high), push * 2600 * G * size * h * deep * wide
    return model, { height = high * h, size = size, friction = random(10, 60),
        gravity = { G * math.sin(lean) * way[1], G * math.sin(lean) * way[2], -G * math.cos(lean) },
        load = function(m, factor)
            local row = (at - 1) % 2 == 1 and size / 2 or 0
            local brick = m:blocks { containing = { row + 1e-3 * size, 1e-3 * deep, (at - 0.5) * h } }
            if #brick > 0 then
                brick:load { force = { factor * force * way[1], factor * force * way[2], 0 } }
            end
        end,
        text = ("wall of %d by %d, leaning %.1f degrees %s, push %.2f at %d"):format(wide, high, math.deg(lean),
            across and "across" or "along", push, at) }
end

-- Wedges between two planes in a block of rock: friction near what limit equilibrium asks for.
function kinds.wedge(random, seed)
    local size = 10 ^ random(-0.5, 1)
    local face = math.rad(random(55, 85))
    local model = talus.model { gravity = { 0, 0, -G }, seed = seed }
    local back, high = 3 * size, 2 * size
    local toe = high / math.tan(face)
    model:generate("profile", { section = { { -back, -size }, { toe + size, -size }, { toe + size, 0 }, { toe, 0 }, { 0, high },
        { -back, high } }, from = -3 * size, to = 3 * size, density = 2600, group = "held" })
    local origin = { toe * random(0.5, 0.9), 0, 0 }
    origin[3] = (toe - origin[1]) * math.tan(face)
    model:generate("joint", { joint = "J1", dip = random(40, 80), dip_direction = random(100, 170), origin = origin })
    model:generate("joint", { joint = "J2", dip = random(40, 80), dip_direction = random(10, 80), origin = origin })
    if chance(random, 0.5) then
        model:generate("joint", { joint = "J3", dip = random(70, 90), dip_direction = pick(random, { 90, 270 }) + random(-20, 20),
            origin = { -random(0.1, 1) * size, 0, high } })
    end
    local safety
    for _, key in ipairs(model:keyblocks { friction = 45 }) do
        if key.mode:find "sliding" and (not safety or key.safety < safety) then
            local body = key.block.body
            local inside = model:blocks { where = function(b) return b.body == body end }
            local c = inside[1].centroid
            if c[1] > -back / 2 and math.abs(c[2]) < 2 * size and c[3] > 0 then
                safety = key.safety
                inside:set { group = "rock" }
            end
        end
    end
    redraw_unless(safety, "no wedge")
    local friction = math.deg(math.atan(random(0.85, 1.2) / safety))
    redraw_unless(friction > 5 and friction < 60, "friction out of range")
    return model, { height = size, size = size, friction = friction, text = "wedge", geometric = true }
end

-- Columns side by side on a plane, the highest in the middle, under a gravity that leans.
function kinds.toppling(random)
    local columns, size = whole(random, 4, 14), 10 ^ random(-0.5, 0.7)
    local lean, slender = math.rad(random(8, 35)), random(2, 6)
    local cut = chance(random, 0.4) -- each column in two
    local model = talus.model { gravity = { 0, 0, -G } }
    held(model, { -2 * size, -size, -size }, { (columns + 2) * size, 3 * size, 0 })
    local peak = random(0.3, 0.7) * columns
    for i = 0, columns - 1 do
        local share = i < peak and (i + 1) / (peak + 1) or (columns - i) / (columns - peak)
        local high, x = math.max(0.5, slender * share) * size, i * size
        local half = high * random(0.3, 0.7)
        if cut then
            box(model, { x, 0, 0 }, { x + size, 2 * size, half })
            box(model, { x, 0, half }, { x + size, 2 * size, high })
        else
            box(model, { x, 0, 0 }, { x + size, 2 * size, high })
        end
    end
    if chance(random, 0.35) then
        held(model, { columns * size, 0, 0 }, { (columns + 1) * size, 2 * size, random(0.2, 1) * size })
    end
    local friction = math.deg(math.atan(math.tan(lean) * random(0.6, 1.8)))
    return model, { height = slender * size, size = size, friction = math.min(60, math.max(5, friction)),
        gravity = { G * math.sin(lean), 0, -G * math.cos(lean) },
        text = ("%d columns, leaning %.1f degrees, slender %.1f"):format(columns, math.deg(lean), slender) }
end

-- Blocks that hang from a roof or stick out from a wall by their bond.
function kinds.hanging(random)
    local blocks, size = whole(random, 1, 6), 10 ^ random(-0.7, 0.7)
    local out, h = chance(random, 0.5), random(0.3, 1) * size
    local model = talus.model { gravity = { 0, 0, -G } }
    local stress -- largest tension of the bond, Pa
    if out then
        blocks = math.min(blocks, 4)
        for i = 1, blocks do
            box(model, { (i - 1) * h, 0, 0 }, { i * h, size, size })
        end
        held(model, { -size, 0, -size }, { 0, size, 2 * size })
        stress = 2600 * G * size * (blocks * h) ^ 2 / 2 / (size ^ 2 / 6)
    else
        for i = 1, blocks do
            box(model, { 0, 0, -i * h }, { size, size, -(i - 1) * h })
        end
        held(model, { -size, -size, 0 }, { 2 * size, 2 * size, size })
        stress = 2600 * G * blocks * h
    end
    return model, { height = blocks * h, size = size, friction = random(20, 50), bond = stress * random(0.6, 1.8),
        text = ("%d blocks that %s"):format(blocks, out and "stick out" or "hang") }
end

-- Bodies of several blocks: a stem with an arm, bricks on the arm, and a counterweight.
function kinds.joined(random)
    local size, h, w = 10 ^ random(-0.7, 0.7), random(1, 3), random(0.5, 1.5)
    local arm, thick = random(0.8, 3), random(0.3, 0.8)
    local model = talus.model { gravity = { 0, 0, -G } }
    held(model, { -2 * size, -size, -size }, { 3 * size, (w + 1) * size, 0 })
    box(model, { 0, 0, 0 }, { size, w * size, h * size })
    box(model, { 0, 0, h * size }, { size, w * size, (h + thick) * size })
    box(model, { size, 0, h * size }, { (1 + arm) * size, w * size, (h + thick) * size })
    model:blocks { where = function(b) return b.group == "rock" end }:join()
    -- weights of arm, stem and bricks about the toe x = size
    local pulls, holds = arm * thick * arm / 2, (h + thick) / 2
    local bricks, z, needed = whole(random, 1, 3), h + thick, random(0.8, 1.4)
    for _ = 1, bricks do
        local deep = math.max(0.15, (pulls * needed - holds) / (bricks * 0.5))
        deep = math.min(deep, 2)
        box(model, { 0, 0, z * size }, { size, w * size, (z + deep) * size })
        z = z + deep
    end
    local lean = math.rad(random(0, 15))
    return model, { height = z * size, size = size, friction = random(10, 60), geometric = true,
        gravity = { 0, G * math.sin(lean), -G * math.cos(lean) },
        text = ("arm of %.2f on a stem of %.2f, %d bricks, leaning %.1f degrees"):format(arm, h, bricks, math.deg(lean)) }
end

-- ---------------------------------------------------------------- laws

local function tangent(friction, factor)
    return math.deg(math.atan(math.tan(math.rad(friction)) * factor))
end

local laws = {}

-- Each takes p = { random, kn, ks, friction, stress, f = factor of friction, s = factor of strength, bond = or nil } and gives the name
-- of the law, its parameters, and whether it is brittle.
function laws.coulomb(p)
    return "coulomb", { kn = p.kn, ks = p.ks, friction = tangent(p.friction, p.f) }
end

function laws.cohesion(p)
    local name, params = laws.coulomb(p)
    params.cohesion = p.s * p.stress * 10 ^ p.random(-2, -0.3)
    return name, params
end

function laws.dilation(p)
    local name, params = laws.coulomb(p)
    params.dilation = math.min(p.random(1, 15), 0.95 * params.friction)
    if chance(p.random, 0.5) then
        params.dilation_limit = p.size * 10 ^ p.random(-4, -2)
    end
    return name, params
end

function laws.coulomb_tensile(p)
    local _, params = laws.coulomb(p)
    local strength = p.bond or p.stress * 10 ^ p.random(-2, 0.3)
    params.tension, params.cohesion = p.s * strength, p.s * strength * p.random(0.5, 2)
    if chance(p.random, 0.4) then
        params.residual_friction = params.friction * p.random(0.7, 1)
    end
    return "coulomb_tensile", params, true
end

function laws.cohesive(p)
    local _, params = laws.coulomb(p)
    local strength, shear = p.bond or p.stress * 10 ^ p.random(-2, 0.3), p.random(0.5, 2)
    params.tension, params.cohesion = p.s * strength, p.s * strength * shear
    local ductility = 10 ^ p.random(0.1, 1.5)
    params.energy_tension = ductility * params.tension ^ 2 / (2 * p.kn)
    params.energy_shear = ductility * params.cohesion ^ 2 / (2 * p.ks)
    return "cohesive", params, true
end

function laws.slip_weakening(p)
    local _, params = laws.coulomb(p)
    params.residual_friction = params.friction * p.random(0.6, 1)
    params.distance = p.size * 10 ^ p.random(-4, -2)
    if chance(p.random, 0.5) then
        params.cohesion, params.residual_cohesion = p.s * p.stress * 10 ^ p.random(-2, -0.5), 0
    end
    return "slip_weakening", params, true
end

-- Closure is linear from stresses that are not reached: the stiffness at the wall strength would make the slow run's steps too short.
function laws.barton_bandis(p)
    local jrc, jcs = p.random(2, 12), p.stress * 10 ^ p.random(1.5, 3)
    local rough = jrc * math.log(jcs / p.stress, 10)
    return "barton_bandis", { jrc = jrc, jcs = jcs, phi_r = math.min(60, math.max(3, p.friction - rough)), kni = p.kn / 2,
        vm = 10 * p.stress / p.kn, ks = p.ks, reduction = 1 / p.f, linear_from = 10 * p.stress }, true
end

function laws.continuously_yielding(p)
    local friction = tangent(p.friction, p.f)
    return "continuously_yielding", { an = p.kn, as = p.ks, phi_i = math.min(80, friction + p.random(1, 15)), phi = friction,
        roughness = p.size * 10 ^ p.random(-4, -2) }, true
end

function laws.elastic(p)
    return "elastic", { kn = p.kn, ks = p.ks }
end

local USUAL = { { "coulomb", 42 }, { "cohesion", 8 }, { "dilation", 10 }, { "coulomb_tensile", 14 }, { "cohesive", 8 },
    { "slip_weakening", 7 }, { "barton_bandis", 5 }, { "continuously_yielding", 4 } }
local BONDS = { { "coulomb_tensile", 6 }, { "cohesive", 6 }, { "elastic", 1 } }

-- Gives the joints of a model their laws.
local function set_laws(random, model, about, change)
    local stress = 2600 * G * about.height
    local kn = stress / (10 ^ random(-5, -3) * about.size)
    local p = { random = random, kn = kn, ks = kn * random(0.2, 1), friction = about.friction, stress = stress, size = about.size,
        bond = about.bond, f = change.friction or 1, s = change.strength or 1 }
    local kind = weighted(random, about.bond and BONDS or USUAL)
    local law, params, brittle = laws[kind](p)
    model:joint("*", law, params)
    about.law, about.brittle = kind, brittle or false
    about.text = ("%s; kn %.2g, friction %.1f, %s"):format(about.text, kn, about.friction, kind)
    local other = weighted(random, { { "none", 75 }, { "coulomb", 20 }, { "elastic", 5 } })
    local sets = model:joints()
    if other ~= "none" and #sets > 1 and not about.bond then
        p.friction = math.min(60, math.max(5, p.friction * random(0.6, 1.5)))
        local name = sets[1].name
        model:joint(name, laws[other](p))
        about.text = ("%s, %s %s %.1f"):format(about.text, name, other, p.friction)
    end
end

-- ---------------------------------------------------------------- all together

local KINDS = { { "slope", 22 }, { "tunnel", 19 }, { "stack", 8 }, { "column", 7 }, { "arch", 8 }, { "wall", 7 }, { "wedge", 8 },
    { "toppling", 7 }, { "hanging", 5 }, { "floor", 5 }, { "joined", 5 } }

local function try(seed, number, change)
    local random = draws(100 * seed + number)
    local kind = weighted(random, KINDS)
    local model, about = kinds[kind](random, 1 + seed)
    about.kind = kind
    if chance(random, 0.25) and kind ~= "wedge" then
        add_sliver(random, model, about)
    end
    model:blocks { where = function(b) return b.group == "held" end }:fix()
    local joins = chance(random, 0.2) and kind ~= "wedge" and kind ~= "tunnel"
    set_laws(random, model, about, change)
    if joins then
        add_joins(random, model, about)
    end
    local factor, gravity, load = change.load or 1, about.gravity or { 0, 0, -G }, about.load
    local function apply(m, share)
        m.gravity = shapes.sum({ 0, 0, 0 }, factor * share, gravity)
        if load then
            load(m, factor * share)
        end
    end
    apply(model, 1)
    if about.insitu then
        about.insitu(model)
    else
        about.apply = apply
    end
    about.stages = about.stages or { { name = "weight" } }
    about.blocks = #model:blocks()
    return model, about
end

function models.build(seed, change)
    for number = 0, 99 do -- what cannot be cut is drawn anew
        local good, model, about = pcall(try, seed, number, change or {})
        if good then
            return model, about
        elseif type(model) ~= "table" then
            error(("seed %d: %s"):format(seed, model), 0)
        end
    end
    error(("seed %d: no model"):format(seed))
end

local function add_load(loads, block, force, at)
    local of = loads[block.id] or { force = { 0, 0, 0 }, moment = { 0, 0, 0 } }
    local arm = shapes.sum(at, -1, block.centroid)
    loads[block.id] = { force = shapes.sum(of.force, 1, force), moment = shapes.sum(of.moment, 1, shapes.cross(arm, force)) }
end

function models.release(model, group)
    local loads = {}
    for _, contact in ipairs(model:contacts()) do
        local first, second = contact.blocks[1], contact.blocks[2]
        local keeps = first.group == group and second or first
        if (first.group == group) ~= (second.group == group) and not keeps.fixed then
            local sign = keeps.id == second.id and 1 or -1
            for _, point in ipairs(contact.points) do
                local force = shapes.sum(point.shear_force, point.normal_force, contact.normal)
                add_load(loads, keeps, shapes.sum({ 0, 0, 0 }, sign, force), point.position)
            end
        end
    end
    model:blocks { group = group }:delete()
    return function(share)
        for id, load in pairs(loads) do
            model:blocks { id = id }:load { force = shapes.sum({ 0, 0, 0 }, share, load.force),
                moment = shapes.sum({ 0, 0, 0 }, share, load.moment) }
        end
    end
end

return models
