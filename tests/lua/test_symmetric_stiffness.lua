-- Rock under stress has a potential: where nothing slips, opens or dilates the tangent stiffness matrix of all free bodies is
-- symmetric, whatever stress acts, wherever the blocks have moved to, and whichever block was made first.
-- tests/verify/long/stiffness.lua tries many more models, of every law.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local stiffness = require "stiffness"
local talus = require "talus"

local KN, KS = 1e8, 0.6e8 -- Pa/m
local DENSITY = stiffness.density(KN)
local ASYMMETRY = 1e-8 -- over the largest entry
local ORDER = { "cubes", "inside", "across", "flush", "rock" }

local function box(model, min, max, group)
    model:generate("box", { min = min, max = max, density = DENSITY, group = group or "free" })
end

-- Faces of the same size, faces within faces, faces that cross, faces with one edge in common.
local scenes = {
    cubes = function(m)
        box(m, { 0, 0, 0 }, { 1, 1, 1 }, "fixed")
        box(m, { 1, 0, 0 }, { 2, 1, 1 })
        box(m, { 2, 0, 0 }, { 3, 1, 1 })
    end,
    inside = function(m)
        box(m, { -3, -3, -1 }, { 4, 4, 0 }, "fixed")
        box(m, { 0, 0, 0 }, { 1, 1.2, 1 })
        box(m, { -1, -2, 1 }, { 2, 3, 1.5 })
    end,
    across = function(m)
        box(m, { -2, 0, -1 }, { 2, 1, 0 }, "fixed")
        box(m, { 0.1, -1, 0 }, { 0.9, 3, 1 })
        box(m, { -1, 0.2, 1 }, { 2, 0.8, 2 })
    end,
    flush = function(m)
        box(m, { 0, 0, -1 }, { 3, 2, 0 }, "fixed")
        box(m, { 0, 0.5, 0 }, { 1, 1.5, 1 })
        box(m, { 0.5, 0.5, 1 }, { 2, 2, 2 })
    end,
    rock = function(m)
        box(m, { 0, 0, 0 }, { 3, 3, 3 })
        for _, set in ipairs { { 10, 20 }, { 85, 100 }, { 80, 200 } } do
            m:generate("jointset", { joint = "J", dip = set[1], dip_direction = set[2],
                origin = { 1.5, 1.5, 1.5 }, spacing = 1, number = 10 })
        end
        m:boundary { xmin = "fixed", xmax = "fixed", ymin = "fixed", ymax = "fixed",
            zmin = "fixed", zmax = "fixed" }
    end,
}

local function build(scene, law, stress, reuse)
    local model = talus.model { gravity = { 0, 0, 0 }, reuse_geometry = reuse }
    scenes[scene](model)
    if #model:blocks { group = "fixed" } > 0 then
        model:blocks { group = "fixed" }:fix()
    end
    model:joint("*", law, law == "elastic" and { kn = KN, ks = KS }
        or { kn = KN, ks = KS, friction = 40, cohesion = 1e9 })
    model:insitu { stress = { xx = -stress, yy = -0.8 * stress, zz = -1.2 * stress,
        xy = 0.1 * stress, yz = -0.05 * stress } }
    stiffness.settle(model)
    return model
end

math.randomseed(7)
local function random(low, high)
    return low + (high - low) * math.random()
end

for _, scene in ipairs(ORDER) do
    for _, law in ipairs { "elastic", "coulomb" } do
        for _, state in ipairs(stiffness.STATES) do
            for _, reuse in ipairs { true, false } do
                local model = build(scene, law, KN * state.closure, reuse)
                stiffness.disturb(model, state.motion, random)
                local odd = stiffness.asymmetry(model)
                check.holds(odd < ASYMMETRY, ("%s, %s, closure %g m, motion %g m, reuse %s: asymmetry %.2g"):format(
                    scene, law, state.closure, state.motion, tostring(reuse), odd))
                check.equal(model:energy().friction, 0)
            end
        end
    end
end

-- ---------------------------------------------------------------- motion

local KICK = 0.03 -- m/s: motion of some 6e-5 m, less than 1e-2 of the closure, and tilts of faces far below 0.05 degrees

-- 27 cubes free among 98 that are held, under a pressure, kicked: without damping they keep their energy.
local function lattice(law, stress, kick, reuse)
    local model = talus.model { gravity = { 0, 0, 0 }, reuse_geometry = reuse }
    for cell = 0, 124 do
        local i, j, k = cell % 5, cell // 5 % 5, cell // 25
        local free = i % 4 ~= 0 and j % 4 ~= 0 and k % 4 ~= 0
        model:generate("box", { min = { i, j, k }, max = { i + 1, j + 1, k + 1 }, density = 2500,
            group = free and "free" or "fixed" })
    end
    model:blocks { group = "fixed" }:fix()
    model:joint("*", law, { kn = KN, ks = KN, friction = law == "coulomb" and 35 or nil })
    model:insitu { stress = { xx = -stress, yy = -stress, zz = -stress } }
    model:cycle(1)
    for _, block in ipairs(model:blocks { group = "free" }) do
        model:blocks { id = block.id }:set { velocity = { random(-kick, kick), random(-kick, kick), random(-kick, kick) } }
    end
    return model
end

for _, law in ipairs { "elastic", "coulomb" } do
    for _, reuse in ipairs { true, false } do
        for _, closure in ipairs { 1e-2, 0.1 } do
            local model = lattice(law, KN * closure, KICK, reuse)
            model:cycle(1)
            local begun, most = model:energy().kinetic, 0
            for _ = 1, 10 do
                model:cycle(200)
                most = math.max(most, model:energy().kinetic)
            end
            check.holds(most <= begun, ("%s, closure %g m: kinetic energy %g J from %g J"):format(law, closure, most, begun))
            check.equal(model:energy().friction, 0)
        end
    end
end
