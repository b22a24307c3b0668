-- random_bolts.lua - bolts through jointed rock, drawn at random, in any place, attitude and unit of length.
local talus = require "talus"
local shapes = require "shapes"

local random_bolts = {}

local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local SIZE = { 4, 3, 3 } -- m, of the rock
local GRAVITY = { 0, 0, -10 }

-- A number with a logarithm drawn between those of two bounds.
local function scaled(random, low, high)
    return low * (high / low) ^ random(0, 1)
end

local function within(random, share)
    local x = {}
    for k = 1, 3 do
        x[k] = share * SIZE[k] * random(-0.5, 0.5)
    end
    return x
end

local function draw_bolt(random, elastic)
    local bolt = { from = within(random, 0.99), to = within(random, 1.1), diameter = random(0.016, 0.04),
        grout_stiffness = scaled(random, 1e8, 1e10), spacing = random(0.08, 0.3), young = 200e9 }
    if random(0, 1) < 0.5 then
        bolt.grouted_from, bolt.grouted_to = random(0, 0.8), random(0.85, 1)
    end
    if random(0, 1) < 0.3 then
        bolt.plate_stiffness = 0
    else
        bolt.plate_stiffness = scaled(random, 1e7, 1e9)
    end
    if random(0, 1) < 0.6 then
        bolt.dowel_stiffness, bolt.dowel_strength = scaled(random, 1e7, 1e9), elastic and 1e12 or scaled(random, 1e3, 1e6)
        bolt.dowel_rupture = elastic and 1e5 or scaled(random, 1e-3, 1e-1)
    end
    bolt.active_length = random(0, 1) < 0.5 and scaled(random, 0.02, 1) or nil
    if elastic then
        bolt.yield, bolt.grout_strength, bolt.plate_strength, bolt.rupture_strain = 1e12, 1e12, 1e12, 1e6
        return bolt
    end
    bolt.yield, bolt.rupture_strain = scaled(random, 3e3, 1e6), scaled(random, 1e-3, 1)
    bolt.grout_strength, bolt.plate_strength = scaled(random, 1e4, 1e6), scaled(random, 1e3, 1e6)
    bolt.grout_residual = random(0, 1) < 0.5 and bolt.grout_strength * random(0, 1) or nil
    if random(0, 1) < 0.3 then
        bolt.grout_friction, bolt.confining = random(10, 50), scaled(random, 1e4, 1e6)
    end
    if random(0, 1) < 0.3 then
        bolt.pretension = random(0, 0.3) * math.min(bolt.yield, bolt.plate_strength, 0.3 * bolt.grout_strength)
        bolt.pretension = bolt.plate_stiffness > 0 and bolt.pretension or nil
    end
    return bolt
end

-- What a seed means: planes of joints, bolts, and how blocks move. Lengths are m.
function random_bolts.draw(seed, elastic)
    local random = shapes.random(seed)
    local one = { planes = {}, bolts = {}, velocity = {}, spin = {}, elastic = elastic }
    for k = 1, math.floor(random(1, 4.999)) do
        one.planes[k] = { shapes.direction(random), within(random, 0.6) }
    end
    for k = 1, math.floor(random(1, 4.999)) do
        one.bolts[k] = draw_bolt(random, elastic)
    end
    for k = 1, 16 do
        local fast = scaled(random, 0.02, 2)
        one.velocity[k] = shapes.sum({ 0, 0, 0 }, fast, shapes.direction(random))
        one.spin[k] = shapes.sum({ 0, 0, 0 }, random(0, 1) < 0.5 and fast or 0, shapes.direction(random))
    end
    one.held = math.floor(random(1, 16.999))
    one.gravity = random(0, 1) < 0.5
    return one
end

-- Parameters of a bolt by the power of the unit of length in them: forces stay N, times s.
local POWER = { diameter = 1, young = -2, grout_stiffness = -2, grout_strength = -1, grout_residual = -1, confining = -2,
    plate_stiffness = -1, dowel_stiffness = -1, dowel_rupture = 1, active_length = 1, spacing = 1 }

local function place_of(form)
    return function(x, free)
        local y = shapes.apply(form.matrix or NONE, x)
        y = free and y or shapes.sum(y, 1, form.shift or { 0, 0, 0 })
        return shapes.sum({ 0, 0, 0 }, form.unit or 1, y)
    end
end

local function attitude_of(n)
    local up = n[3] < 0 and { -n[1], -n[2], -n[3] } or n
    local flat = math.sqrt(up[1] ^ 2 + up[2] ^ 2)
    return math.deg(math.atan(flat, up[3])), math.deg(math.atan(up[1], up[2])) % 360
end

-- The bolts of `one` in a form.
local function bolts_of(one, form)
    local place, list = place_of(form), {}
    for k, bolt in ipairs(one.bolts) do
        local t = {}
        for name, value in pairs(bolt) do
            t[name] = type(value) == "number" and value * (form.unit or 1) ^ (POWER[name] or 0) or place(value)
        end
        list[form.reversed and #one.bolts + 1 - k or k] = t
    end
    return list
end

-- The rock, cut, with its bolts. `form` may have a matrix, a shift (m), a unit (of lengths in the model, over m), and
-- reversed: bolts in the other order. Gives the model, its bolts in the order drawn, and its blocks, those of the first
-- form in the same order.
function random_bolts.build(one, form, threads)
    local place, unit = place_of(form), form.unit or 1
    local model = talus.model { gravity = one.gravity and place(GRAVITY, true) or { 0, 0, 0 }, threads = threads }
    local corners = {}
    for i = 0, 7 do
        corners[#corners + 1] = place { SIZE[1] * (i % 2 - 0.5), SIZE[2] * (i // 2 % 2 - 0.5), SIZE[3] * (i // 4 - 0.5) }
    end
    model:generate("polyhedron", { vertices = corners, density = 2500 / unit ^ 4 })
    for k, plane in ipairs(one.planes) do
        local dip, direction = attitude_of(shapes.apply(form.matrix or NONE, plane[1]))
        model:generate("joint", { joint = "J" .. k, dip = dip, dip_direction = direction, origin = place(plane[2]) })
    end
    model:joint("*", "coulomb", { kn = (one.kn or 1e9) / unit ^ 3, ks = 0.5 * (one.kn or 1e9) / unit ^ 3, friction = 20 })
    local bolts = {}
    local made = #one.bolts > 0 and model:element("bolt", bolts_of(one, form)) or {}
    for k = 1, #made do
        bolts[k] = made[form.reversed and #made + 1 - k or k]
    end
    return model, bolts, random_bolts.blocks(model, form)
end

-- Blocks in an order that their places in the first form give.
function random_bolts.blocks(model, form)
    local list, back, unit = {}, {}, form.unit or 1
    for i = 1, 3 do
        back[i] = {}
        for j = 1, 3 do
            back[i][j] = (form.matrix or NONE)[j][i]
        end
    end
    for _, block in ipairs(model:blocks()) do
        local c = shapes.sum(shapes.sum({ 0, 0, 0 }, 1 / unit, block.centroid), -1, form.shift or { 0, 0, 0 })
        list[#list + 1] = { block = block, at = shapes.apply(back, c), back = back }
    end
    table.sort(list, function(a, b)
        return math.abs(a.at[1] - b.at[1]) > 1e-7 and a.at[1] < b.at[1] or (math.abs(a.at[1] - b.at[1]) <= 1e-7
            and a.at[2] < b.at[2])
    end)
    return list
end

-- Lets blocks go: one is held, the others have velocities. dt in s; nil: as the model chooses.
function random_bolts.start(one, form, model, blocks, dt)
    local place = place_of(form)
    local sense = form.matrix and shapes.dot(form.matrix[1], shapes.cross(form.matrix[2], form.matrix[3])) or 1
    for k, of in ipairs(blocks) do
        if k == one.held % #blocks + 1 then
            model:blocks { id = of.block.id }:fix()
        else
            model:blocks { id = of.block.id }:set { velocity = place(one.velocity[k % 16 + 1], true),
                angular_velocity = shapes.sum({ 0, 0, 0 }, sense,
                    shapes.apply(form.matrix or NONE, one.spin[k % 16 + 1])) }
        end
    end
    if dt then
        model:timestep { dt = dt }
    end
end

-- Displacements of blocks, m, and tensions of bolts, N, seen from the first form.
function random_bolts.picture(form, bolts, blocks)
    local out, forces = {}, {}
    for _, of in ipairs(blocks) do
        local u = shapes.apply(of.back, of.block.displacement)
        for i = 1, 3 do
            out[#out + 1] = u[i] / (form.unit or 1)
        end
    end
    for _, bolt in ipairs(bolts) do
        forces[#forces + 1] = bolt.axial
        forces[#forces + 1] = bolt.shear
    end
    return out, forces
end

-- Places of the nodes, m: forces of the next step act there.
function random_bolts.places(bolt)
    local out = {}
    for i, node in ipairs(bolt.nodes) do
        out[i] = node.position
    end
    return out
end

-- Sums of forces and moments of a bolt over the sums of their sizes.
function random_bolts.sums(bolt, places)
    local f, m, size, arm = { 0, 0, 0 }, { 0, 0, 0 }, 0, 0
    for i, node in ipairs(bolt.nodes) do
        local r = shapes.sum(places[i], -1, places[1])
        f = shapes.sum(f, 1, node.force)
        m = shapes.sum(m, 1, shapes.cross(r, node.force))
        size, arm = size + shapes.length(node.force), math.max(arm, shapes.length(r))
    end
    if size == 0 then
        return 0, 0
    end
    return shapes.length(f) / size, shapes.length(m) / (size * arm)
end

return random_bolts
