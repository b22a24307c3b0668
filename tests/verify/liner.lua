-- Liners of shotcrete against closed forms: a roof block held at its joints, adhesion, and a ring under pressure.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"

local STRONG = 1e12 -- Pa, a strength that is never reached
local THICK, YOUNG, BOND = 0.1, 20e9, 1e10 -- m, Pa, Pa/m
local a = (BOND / (4 * YOUNG * THICK ^ 3 / 12)) ^ 0.25 -- 1/m, over which a load on an edge dies out; poisson = 0

-- A roof block between two held ones without friction: each joint loads the edges of two strips by V, N/m.
local V = 2500 * 10 * 1 / 2
local function roof(more)
    local model = talus.model { gravity = { 0, 0, -10 } }
    for i, x in ipairs { -1.5, -0.5, 0.5 } do
        model:generate("box", { min = { x, 0, 0 }, max = { x + 1, 0.3, 1 }, density = 2500 })
        if i ~= 2 then
            model:blocks { containing = { x + 0.5, 0.1, 0.5 } }:fix()
        end
    end
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 0 })
    model:damping "local"
    local liner = { facing = { 0, 0, -1 }, within = 1, thickness = THICK, young = YOUNG, poisson = 0, bond_stiffness = BOND,
        spacing = 0.1, bond_strength = STRONG, tension = STRONG }
    for name, value in pairs(more) do
        liner[name] = value
    end
    return model, model:element("liner", liner), model:blocks { fixed = false }[1]
end

local function most(liner, name)
    local value = 0
    for _, node in ipairs(liner[1].nodes) do
        value = math.max(value, node[name])
    end
    return value
end

figures.case("LINER.roof", "A liner holds a roof block at two joints. At a joint the liner is two beams on the bond, "
    .. "each loaded at its edge: bond stress 2 V a and fibre stress 6 * 0.3224 V / (a t^2).",
    "Hetenyi (1946), semi-infinite beam on an elastic foundation, load on its free end")
local shares, spacings = {}, { 0.2, 0.1, 0.06 }
for i, spacing in ipairs(spacings) do
    local model, liner = roof { spacing = spacing }
    model:solve { measure = "local", ratio = 1e-6 }
    shares[i] = most(liner, "bond_tension") / (2 * V * a)
    if spacing == 0.06 then
        figures.relative("largest bond stress, Pa, triangles of 0.06 m", most(liner, "bond_tension"), 2 * V * a, 0.03)
        figures.relative("largest fibre stress, Pa, triangles of 0.06 m", most(liner, "stress"), 6 * 0.3224 * V / (a * THICK ^ 2),
            0.05)
    end
end
figures.equal("bond stress nears the closed form with each finer mesh", shares[1] < shares[2] and shares[2] < shares[3], true)
figures.plot { title = "LINER.roof: bond stress over the closed form", x = "spacing, m", y = "obtained / expected",
    series = { { name = "obtained", x = spacings, y = shares, style = "points" } } }

figures.case("LINER.adhesion", "The strength of the bond at which the roof block falls, between two runs: a joint bears strength / (2 a) "
    .. "on each metre.", "Barrett and McCreath (1995), adhesion acts on a strip; Hetenyi (1946)")
for _, part in ipairs { 0.93, 1.05 } do
    local model, liner, key = roof {}
    model:solve { measure = "local", ratio = 1e-6 } -- a load put on at once would pass the one at rest
    liner:set { bond_strength = part * 2 * V * a }
    model:cycle(2000)
    figures.equal(("falls with %g of the strength"):format(part), key.displacement[3] < -0.02, part < 1)
    figures.between("error of the energy, J", model:energy().balance, -1e-3, 1e-3)
    if part > 1 then
        figures.equal("area that is debonded, m2", liner[1].debonded, 0)
    end
end

figures.case("LINER.ring", "A ring of 16 blocks with gaps, drawn outward by a pressure on its liner: pull = pressure * radius.",
    "equilibrium of half a ring")
do
    local n, inner, outer, deep, gap, pressure = 16, 2, 2.5, 0.3, 1e-3, 3e4
    local model, faces = talus.model {}, {}
    model:joint("*", "coulomb", { kn = 1e6, ks = 1e6, friction = 0 })
    model:damping "local"
    for i = 0, n - 1 do
        local corners = {}
        for _, at in ipairs { { inner, -1 }, { inner, 1 }, { outer, 1 }, { outer, -1 } } do
            local angle, r = 2 * math.pi * i / n + at[2] * (math.pi / n - gap), at[1] / math.cos(math.pi / n)
            corners[#corners + 1] = { r * math.cos(angle), 0, r * math.sin(angle) }
            corners[#corners + 1] = { r * math.cos(angle), deep, r * math.sin(angle) }
        end
        model:generate("polyhedron", { vertices = corners, density = 2500 })
    end
    for _, face in ipairs(model:boundary { facing = { 1, 0, 0 }, within = 180 }.faces) do
        local c, m = face.centroid, face.normal
        if m[1] * c[1] + m[3] * c[3] < -0.9 * math.sqrt(c[1] ^ 2 + c[3] ^ 2) then
            faces[#faces + 1] = c
        end
    end
    local liner = model:element("liner", { faces = faces, thickness = THICK, young = 10e9, poisson = 0, spacing = 0.4,
        tension = STRONG, bond_strength = STRONG, bond_shear_stiffness = 1e7 }) -- soft, so that blocks do not stiffen it
    for _, block in ipairs(model:blocks()) do
        local c = block.centroid
        local r, force = math.sqrt(c[1] ^ 2 + c[3] ^ 2), pressure * 2 * outer * math.tan(math.pi / n) * deep
        model:blocks { containing = c }:load { force = { force * c[1] / r, 0, force * c[3] / r } }
    end
    model:cycle(3000)
    local sum, area = 0, 0
    for _, node in ipairs(liner[1].nodes) do
        sum, area = sum + node.weight * node.pull, area + node.weight
    end
    figures.relative("mean pull, N/m", sum / area, pressure * outer, 0.01)
end

figures.finish()
