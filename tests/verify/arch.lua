-- A semicircular arch of voussoirs under its own weight stands when it is a little thicker than the
-- least thickness at which a line of thrust fits inside, and falls as a mechanism of hinges when it
-- is a little thinner.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local statics = require "check_statics"
local reference = require("reference_dynamics").arch

local GRAVITY, DENSITY = 10, 2000
local RADIUS, DEPTH, GROUND = 1, 0.2, 0.1   -- of the mean line; across; of the springers
-- kn R / (rho g R): an arch near its limit turns at its hinges by the joints' closure over the
-- thickness, which costs it height; the stiffer the joints, the less.
local STIFFNESS = 1e6 * DENSITY * GRAVITY
local FRICTION = 60               -- degrees: no joint slides
local AT_REST = 1e-6
local FALLEN = 0.05 * RADIUS
local STANDS, FALLS = 1.05, 0.95  -- of the limit thickness
local LOWEST, HIGHEST = 0.97, 1.05 -- of the limit thickness, where failure may be
local BRACKET = 0.01              -- of the limit thickness, in which failure is sought

local function build(voussoirs, thickness)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    local inner, outer = RADIUS - thickness / 2, RADIUS + thickness / 2
    for k = 1, voussoirs do
        local vertices = {}
        for _, angle in ipairs { math.pi * (k - 1) / voussoirs, math.pi * k / voussoirs } do
            for _, radius in ipairs { inner, outer } do
                for _, y in ipairs { 0, DEPTH } do
                    vertices[#vertices + 1] = { radius * math.cos(angle), y,
                        radius * math.sin(angle) }
                end
            end
        end
        model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "arch" })
    end
    for _, side in ipairs { { inner, outer }, { -outer, -inner } } do
        model:generate("box", { min = { side[1], 0, -GROUND }, max = { side[2], DEPTH, 0 },
            density = DENSITY, group = "springer" })
    end
    model:blocks { group = "springer" }:fix()
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = FRICTION })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    return model, model:blocks { group = "arch" }
end

-- Whether the arch stands, its thickness a share of the limit.
local function stands(case, share)
    local model, arch = build(case.voussoirs, share * case.thickness * RADIUS)
    return (statics.stands(model, arch, { ratio = AT_REST, moving = FALLEN }))
end

-- The thickness between the last that stood and the first that fell, over the limit.
local function threshold(case)
    local low, high = FALLS, STANDS
    while high - low > BRACKET do
        local middle = (low + high) / 2
        if stands(case, middle) then
            high = middle
        else
            low = middle
        end
    end
    return (low + high) / 2
end

local numbers, expected, obtained = {}, {}, {}
for i, case in ipairs(reference) do
    figures.case(case.name, string.format("A semicircular arch of %d voussoirs under its own weight: "
        .. "thickness at which it just stands, over the mean radius", case.voussoirs),
        reference.source)
    figures.equal("stands at 1.05 of the limit thickness", stands(case, STANDS), true)
    figures.equal("stands at 0.95 of the limit thickness", stands(case, FALLS), false)
    local share = threshold(case)
    figures.between("thickness at failure over the limit", share, LOWEST, HIGHEST)
    numbers[i], expected[i] = case.voussoirs, case.thickness
    obtained[i] = share * case.thickness
end
figures.plot { title = "Arch: least thickness over the mean radius", x = "voussoirs",
    y = "thickness / radius", series = {
        { name = "limit analysis", x = numbers, y = expected, style = "line" },
        { name = "obtained", x = numbers, y = obtained, style = "points" },
    } }
figures.finish()
