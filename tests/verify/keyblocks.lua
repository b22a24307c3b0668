-- Block theory against the limit analysis of wedges: mode, direction, forces and factor of safety.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference")
local wedge = require "examples.wedge"
local roof = require "examples.roof_wedge"

local EXACT = 1e-10 -- relative: both are closed forms, of planes that agree to rounding

local DENSITY, GRAVITY = 2000, 10
local APEX = { 0, 0.5, 1 }

-- The box of the example, cut, all but the wedge held; no laws.
local function build(case)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { -2, -1, -1 }, max = { 2, 1, 1 }, density = DENSITY })
    for _, joint in ipairs { "A", "B" } do
        model:generate("joint", { joint = joint, dip = case[joint][1],
            dip_direction = case[joint][2], origin = APEX })
    end
    local a, b = case.A, case.B
    local rock = model:blocks()
    local block = model:blocks { above = { dip = a[1], dip_direction = a[2], origin = APEX } }
        :where(function(one)
            local over = model:blocks { above = { dip = b[1], dip_direction = b[2],
                origin = APEX } }
            for _, other in ipairs(over) do
                if other.id == one.id then
                    return true
                end
            end
            return false
        end)
    figures.equal("blocks above both planes", #block, 1)
    rock:fix()
    block:free()
    return model, block
end

local function degrees(coefficient)
    return math.deg(math.atan(coefficient))
end

for _, case in ipairs(wedge.cases) do
    local expected = reference.wedge[case.name]
    figures.case("keyblock " .. case.name, "A wedge between two planes: the mode of its motion, its "
        .. "direction, the forces on its faces and its factor of safety by block theory.",
        reference.wedge.source)
    local model, block = build(case)
    local mu = case.friction or { expected.mu, expected.mu }
    local list = model:keyblocks { friction = { A = degrees(mu[1]), B = degrees(mu[2]) } }
    figures.equal(case.name .. " keyblocks", #list, 1)
    local key = list[1]
    figures.equal(case.name .. " is the wedge", key.block.id, block[1].id)
    local faces = { A = 0, B = 0 }
    for _, face in ipairs(key.faces) do
        faces[face.joint:match("^%w+")] = face.normal_force / (key.mass * GRAVITY)
    end
    local mode = #key.faces == 2 and "A and B" or key.faces[1].joint:match("^%w+")
    figures.equal(case.name .. " slides on", mode, expected.mode)
    figures.equal(case.name .. " mode", key.mode, #key.faces == 2 and "sliding on two" or "sliding")
    figures.relative(case.name .. " factor of safety", key.safety, expected.FS or 1, EXACT)
    figures.near(case.name .. " N_A", faces.A, expected.normal[1], EXACT)
    figures.near(case.name .. " N_B", faces.B, expected.normal[2], EXACT)
    local plunge, trend = math.rad(expected.plunge), math.rad(expected.trend)
    local line = { math.cos(plunge) * math.sin(trend), math.cos(plunge) * math.cos(trend),
        -math.sin(plunge) }
    for k = 1, 3 do
        figures.near(case.name .. " direction " .. k, key.direction[k], line[k], EXACT)
    end
end

figures.case("keyblock E2", "The pyramid in the roof falls: without the stress that clamps it, no "
    .. "friction holds it.", reference.roof_wedge.source)
local model, pyramid = roof.build(roof.cases[1])
local list = model:keyblocks { friction = 80, cohesion = 1e9 }
figures.equal("keyblocks", #list, 1)
figures.equal("is the pyramid", list[1].block.id, pyramid[1].id)
figures.equal("mode", list[1].mode, "falling")
figures.equal("factor of safety", list[1].safety, 0)
figures.relative("volume", list[1].volume, reference.roof_wedge.E2.volume, EXACT)
-- The joint pyramid's edges are those of the rock pyramid, from the apex down.
figures.equal("edges", #list[1].pyramid, 3)
for i, edge in ipairs(list[1].pyramid) do
    local corner = { math.tan(math.rad(30)) * 2, 0 } -- of the base: h / tan(dip) over cos(60)
    local down = 1 / math.sqrt(corner[1] ^ 2 + 1)
    figures.near("edge " .. i .. " downwards", edge[3], -down, EXACT)
end

-- Three faults over a square tunnel: the wedge in the roof can only come down, on one fault.
figures.case("keyblock E3", "A tunnel under three faults: the wedge in its roof, its mode and factor "
    .. "of safety.", "Hart, Cundall and Lemos (1988), example 3; FS = mu / tan 65 for sliding on one "
    .. "plane; volume by half-space clipping")
model = talus.model { gravity = { 0, 0, -GRAVITY } }
model:generate("box", { min = { -8, -8, -8 }, max = { 8, 8, 8 }, density = DENSITY })
for i, fault in ipairs { { 50, 320 }, { 40, 230 }, { 65, 270 } } do
    model:generate("joint", { joint = "F" .. i, dip = fault[1], dip_direction = fault[2],
        origin = { 1.5, 0.5, 5 } })
end
local function face(y)
    return { { -3, y, -3 }, { -3, y, 3 }, { 3, y, 3 }, { 3, y, -3 } }
end
model:generate("tunnel", { face1 = face(-8), face2 = face(8), group = "tunnel" })
local hanging = model:blocks { containing = { 0.3, 0.14, 3.5 } }
model:blocks():fix()
hanging:free()
figures.equal("keyblocks before the tunnel is excavated",
    #model:keyblocks { friction = 30 }, 0)
model:blocks { group = "tunnel" }:delete()
list = model:keyblocks { friction = 30 }
figures.equal("keyblocks", #list, 1)
figures.equal("is the wedge", list[1].block.id, hanging[1].id)
figures.relative("volume", list[1].volume, 2.6324706, 1e-7)
figures.equal("mode", list[1].mode, "sliding")
figures.equal("slides on", list[1].faces[1].joint, "F3:1")
figures.relative("factor of safety", list[1].safety,
    math.tan(math.rad(30)) / math.tan(math.rad(65)), EXACT)
figures.equal("edges", #list[1].pyramid, 3)
for i, edge in ipairs(list[1].pyramid) do
    figures.between("edge " .. i .. " goes down", edge[3], -1, -0.1)
end
figures.finish()
