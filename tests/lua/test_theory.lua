-- The forces that docs/theory.md gives in numbers: its table of contacts under "Stored energy", and the minimum area. Each is that
-- of two blocks of a known overlap that are held still.
local talus = require "talus"
local check = require "check"

local KN = 1e9

-- Corners of a cube of unit edges, or of another size, of which `turn` makes what it is to be, its lowest point at z = -depth.
local function hanging(depth, turn, size)
    local corners, lowest = {}, math.huge
    for _, x in ipairs { -0.5, 0.5 } do
        for _, y in ipairs { -0.5, 0.5 } do
            for _, z in ipairs { -0.5, 0.5 } do
                local s = size or { 1, 1, 1 }
                local corner = turn { x * s[1], y * s[2], z * s[3] }
                corners[#corners + 1] = corner
                lowest = math.min(lowest, corner[3])
            end
        end
    end
    for _, corner in ipairs(corners) do
        corner[3] = corner[3] - lowest - depth
    end
    return corners
end

-- About the y axis by an angle.
local function about_y(angle)
    local c, s = math.cos(angle), math.sin(angle)
    return function(v)
        return { c * v[1] + s * v[3], v[2], -s * v[1] + c * v[3] }
    end
end

local function about_x(angle)
    local c, s = math.cos(angle), math.sin(angle)
    return function(v)
        return { v[1], c * v[2] - s * v[3], s * v[2] + c * v[3] }
    end
end

-- The diagonal of the cube upright.
local function on_corner(v)
    return about_y(math.atan(math.sqrt(0.5)))(about_x(math.pi / 4)(v))
end

-- The force between what hangs down and a block with its top at z = 0, or an edge along x there.
local function force(upper, options)
    local model = talus.model { gravity = { 0, 0, 0 } }
    if options and options.edge then
        local lower = hanging(0, about_x(math.pi / 4), { 4, 1, 1 })
        for _, corner in ipairs(lower) do
            corner[3] = corner[3] - math.sqrt(2)
        end
        model:generate("polyhedron", { vertices = lower, density = 2000 })
    else
        model:generate("box", { min = { -4, -4, -2 }, max = { 4, 4, 0 }, density = 2000 })
    end
    model:generate("polyhedron", { vertices = upper, density = 2000 })
    model:joint("*", "elastic", { kn = KN, ks = KN })
    if options and options.area then
        model:contact_area { absolute = options.area }
    end
    model:blocks():fix()
    model:cycle(1)
    local contacts = model:contacts()
    check.equal(#contacts, 1)
    check.near(math.abs(contacts[1].normal[3]), 1, 1e-9)
    return contacts[1].normal_force
end

local function relative(obtained, expected, tolerance)
    check.near(obtained / expected, 1, tolerance)
end

local upright = about_x(0)
for _, depth in ipairs { 1e-5, 1e-4, 1e-3 } do
    -- two flush faces of 1 m2
    relative(force(hanging(depth, upright)), KN * depth, 1e-9)
    -- an edge 2 m long on a face: its ends, where the end faces are nearer, lack a length of the order of the depth
    local edge = hanging(depth, about_y(math.pi / 4), { 1, 2, 1 })
    relative(force(edge), 2 * (math.sqrt(2) - 1) * KN * 2 * depth ^ 2, depth)
    -- a corner on a face, and two edges across each other
    relative(force(hanging(depth, on_corner)), 0.634 * KN * depth ^ 3, 1e-3)
    relative(force(edge, { edge = true }), math.sqrt(2) / 3 * KN * depth ^ 3, 1e-6)
    -- a tilted face: at its edge the next face of the cube is nearer, on a share of up to tan(tilt) / 2 of the energy
    for _, degrees in ipairs { 1, 5 } do
        local tilt = math.rad(degrees)
        relative(force(hanging(depth, about_y(tilt))), KN * depth ^ 2 / (2 * math.tan(tilt)), 0.5 * math.tan(tilt))
    end
end

-- A minimum area that is much larger than the field's own.
relative(force(hanging(1e-5, on_corner), { area = 0.01 }), 0.134 * KN * 0.01 * 1e-5, 3e-3)
relative(force(hanging(1e-6, about_y(math.pi / 4), { 1, 2, 1 }), { area = 0.1 }), 0.305 * KN * 0.1 * 1e-6, 3e-3)
