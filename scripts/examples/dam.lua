-- dam.lua - a gravity dam on jointed rock, with uplift under it: how safe it is against sliding, with drains and without.
--
--     build/release/talus scripts/examples/dam.lua
--
-- A slice 1 m thick. The reservoir presses on the upstream face. Water in the joints has the full head at the heel and
-- none at the toe: a table that falls from one to the other. Drains leave a part of its pressure, `factor`.
--
-- Statics of the base, per metre, with the height H, base B, head h, unit weights g_c of concrete and g_w of water:
--     W = g_c H B / 2,    V = g_w h^2 / 2,    U = factor g_w h B / 2
--     F = ((W - U) tan(friction) + cohesion B) / V
local talus = require "talus"

local dam = {}

local HEIGHT, BASE, HEAD = 40, 32, 38             -- m
local DENSITY, GRAVITY, WATER = 2400, 10, 1e4     -- kg/m3, m/s2, N/m3
local DEPTH, LENGTH, SPACING = 16, 64, 8          -- of the rock and its joints, m

-- The part of the uplift that drains leave, and strengths of the base: degrees and Pa.
dam.cases = {
    { name = "no drains", factor = 1, friction = 45, cohesion = 0 },
    { name = "no drains, cohesion", factor = 1, friction = 38, cohesion = 1e5 },
    { name = "drains", factor = 0.49, friction = 40, cohesion = 0 },
    { name = "dry", factor = 0, friction = 45, cohesion = 0 },
}

function dam.statics(case)
    local weight = DENSITY * GRAVITY * HEIGHT * BASE / 2
    local uplift = case.factor * WATER * HEAD * BASE / 2
    local shear = (weight - uplift) * math.tan(math.rad(case.friction)) + case.cohesion * BASE
    return { uplift = uplift, thrust = WATER * HEAD ^ 2 / 2, factor = shear / (WATER * HEAD ^ 2 / 2) }
end

-- The dam on its rock, whose lowest blocks are held; with the reservoir, and water in all joints.
function dam.build(case)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { 0, 0, -DEPTH }, max = { LENGTH, 1, 0 }, density = 2700, group = "rock" })
    for x = SPACING, LENGTH - 1, SPACING do
        model:generate("joint", { joint = "V", dip = 90, dip_direction = 90, origin = { x, 0, 0 } })
    end
    model:generate("joint", { joint = "H", dip = 0, dip_direction = 0, origin = { 0, 0, -DEPTH / 2 } })
    model:generate("polyhedron", { vertices = { { 0, 0, 0 }, { BASE, 0, 0 }, { 0, 0, HEIGHT },
        { 0, 1, 0 }, { BASE, 1, 0 }, { 0, 1, HEIGHT } }, density = DENSITY, group = "dam" })
    model:blocks { group = "rock" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = case.friction, cohesion = case.cohesion })
    model:contact_area { fraction = 0 }
    model:damping "kinetic"
    dam.fill(model, case)
    return model
end

-- The reservoir, on the upstream face of the dam, and the uplift.
function dam.fill(model, case)
    local face = model:boundary { facing = { -1, 0, 0 }, box = { min = { 0, 0, 0 }, max = { 0, 1, HEIGHT } },
        water_level = HEAD, unit_weight = WATER }
    if case.factor > 0 then
        model:water("table", { dip = math.deg(math.atan(HEAD, BASE)), dip_direction = 90, origin = { 0, 0, HEAD },
            unit_weight = WATER, factor = case.factor })
    end
    return face
end

-- What water bears of the dam, N.
local function uplift(model)
    local sum = 0
    for _, element in ipairs(model:elements { kind = "water", block = model:blocks { group = "dam" }[1].id }) do
        for _, node in ipairs(element.nodes) do
            if node.block and node.block.group == "dam" then
                sum = sum + node.force[3]
            end
        end
    end
    return sum
end

function dam.run(case)
    local model = dam.build(case)
    model:solve { measure = "local", ratio = 1e-5 }
    local bodies = model:keyblocks { friction = case.friction, cohesion = case.cohesion }
    local strength = model:factor_of_safety { resolution = 0.005 }
    return { expected = dam.statics(case), uplift = uplift(model), keyblock = bodies[1].safety,
        factor = strength.factor, model = model }
end

function dam.main(folder)
    print("A gravity dam: factor of safety against sliding on its base\n")
    print("                         uplift MN   statics   rigid block   strength reduction")
    for _, case in ipairs(dam.cases) do
        local r = dam.run(case)
        print(("%-22s   %9.3f   %7.4f   %11.4f   %18.4f"):format(case.name, r.uplift / 1e6, r.expected.factor, r.keyblock,
            r.factor))
        if case == dam.cases[1] then
            r.model:write_html(folder .. "/dam", { title = "A gravity dam" })
        end
    end
    print(("\n%s/dam.html shows the first of them in a browser"):format(folder))
end

-- A test that says require "examples.dam" wants the functions only.
if ... ~= "examples.dam" then
    dam.main(arg and arg[1] or "out/dam")
end
return dam
