-- cut_bench.lua - a bench 15 m high, cut by three sets of joints, between rock that is held.
local talus = require "talus"

local SETS = { { "A", 48, 285 }, { "B", 75, 200 }, { "C", 65, 95 } } -- dip, dip direction, degrees
local DEVIATION = 8                      -- of both, degrees
local X, Y, Z, FACE = 25, 20, 15, 62     -- m; dip of the face, degrees
local DENSITY, STIFFNESS = 2600, 1e9     -- kg/m3, Pa/m

local cut_bench = {}

-- Joints of a set are `spacing` m apart on average: 168 free blocks for spacing = 4 and seed = 2, with an angle of friction in degrees.
function cut_bench.build(spacing, seed, friction)
    local model, corners, crest = talus.model { gravity = { 0, 0, -10 }, seed = seed }, {}, Z / math.tan(math.rad(FACE))
    model:generate("box", { { min = { 0, 0, -1 }, max = { X, Y, 0 }, density = DENSITY },
        { min = { X, 0, 0 }, max = { X + 1, Y, Z }, density = DENSITY },
        { min = { 0, -1, 0 }, max = { X, 0, Z }, density = DENSITY },
        { min = { 0, Y, 0 }, max = { X, Y + 1, Z }, density = DENSITY } })
    model:blocks():fix():hide()
    for _, y in ipairs { 0, Y } do
        for _, at in ipairs { { 0, 0 }, { X, 0 }, { X, Z }, { crest, Z } } do
            corners[#corners + 1] = { at[1], y, at[2] }
        end
    end
    model:generate("polyhedron", { vertices = corners, density = DENSITY })
    for _, set in ipairs(SETS) do
        model:generate("jointset", { joint = set[1], dip = set[2], dip_direction = set[3], dip_dev = DEVIATION,
            dip_direction_dev = DEVIATION, spacing = spacing, spacing_dev = 0.3 * spacing, number = math.ceil(36 / spacing),
            origin = { 0, Y / 2, 0 } })
    end
    model:blocks { hidden = true }:show()
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = friction })
    return model
end

return cut_bench
