-- Rock under stress has a potential: where nothing slips, opens or dilates the tangent stiffness matrix of all free bodies is
-- symmetric, whatever stress acts, wherever the blocks have moved to, and whichever block was made first.
local check = require "check"
local talus = require "talus"

local KN, KS = 1e8, 0.6e8 -- Pa/m
local DENSITY, DT = 1e12, 1e-6 -- so heavy that forces move nothing in a step
local ASYMMETRY = 1e-8 -- over the largest entry
local STEP = 1e-6      -- m, rad: motion for differences
local ORDER = { "cubes", "inside", "across", "flush", "rock" }
-- Closure under stress, m, and motion of the blocks against each other. Where faces are tilted by t, forces are off by some
-- t o of second order, with o the closure over the size: that must be below ASYMMETRY.
local STATES = { { closure = 1e-3, motion = 1e-6 }, { closure = 1e-3, motion = 5e-6 }, { closure = 0.1, motion = 5e-8 } }

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
    model:timestep { dt = DT }
    model:insitu { stress = { xx = -stress, yy = -0.8 * stress, zz = -1.2 * stress,
        xy = 0.1 * stress, yz = -0.05 * stress } }
    model:cycle(1)
    return model
end

-- The free blocks one by one, and all of them.
local function free_of(model)
    local one, free = {}, model:blocks { fixed = false }
    for i, block in ipairs(free) do
        one[i] = model:blocks { id = block.id }
    end
    return one, free
end

local function rest(free)
    free:set { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } }
end

-- Forces and moments of the free blocks in their present places.
local function forces(model, one, free)
    rest(free)
    model:cycle(1)
    rest(free)
    local out = {}
    for _, block in ipairs(one) do
        for _, v in ipairs { block[1].force, block[1].moment } do
            for k = 1, 3 do
                out[#out + 1] = v[k]
            end
        end
    end
    return out
end

-- Moves block i by `way`, three components in m and three in rad.
local function move(model, one, free, i, way)
    rest(free)
    one[i]:set { velocity = { way[1] / DT, way[2] / DT, way[3] / DT },
        angular_velocity = { way[4] / DT, way[5] / DT, way[6] / DT } }
    model:cycle(1)
    rest(free)
end

local function along(k, way)
    local out = { 0, 0, 0, 0, 0, 0 }
    out[k] = way
    return out
end

-- Largest |K_ij - K_ji| over the largest |K_ij|. Turns do not commute, which alone makes the rows of a body's turns asymmetric
-- by the moment M on it: K - K^T = [M] there. That is taken out.
local function asymmetry(model)
    local one, free = free_of(model)
    local at, k = forces(model, one, free), {}
    for i = 1, #one do
        for axis = 1, 6 do
            local function forces_after(way)
                move(model, one, free, i, along(axis, way))
                local found = forces(model, one, free)
                move(model, one, free, i, along(axis, -way))
                forces(model, one, free)
                return found
            end
            -- each step of a turn adds as much to the shear, of second order in STEP: the mean of `ahead` and `again` has it
            -- as `behind` has
            local ahead, behind, again = forces_after(STEP), forces_after(-STEP), forces_after(STEP)
            local row = {}
            for j = 1, #ahead do
                row[j] = (behind[j] - 0.5 * (ahead[j] + again[j])) / (2 * STEP)
            end
            k[#k + 1] = row
        end
    end
    for i = 0, #one - 1 do
        local x, y, z = at[6 * i + 4], at[6 * i + 5], at[6 * i + 6]
        local cross = { { 0, -z, y }, { z, 0, -x }, { -y, x, 0 } }
        for a = 1, 3 do
            for b = 1, 3 do -- k has a motion in each row: it is K^T
                local row = k[6 * i + 3 + b]
                row[6 * i + 3 + a] = row[6 * i + 3 + a] - 0.5 * cross[a][b]
            end
        end
    end
    local largest, odd = 0, 0
    for i = 1, #k do
        for j = 1, #k do
            largest = math.max(largest, math.abs(k[i][j]))
            odd = math.max(odd, math.abs(k[i][j] - k[j][i]))
        end
    end
    return odd / largest
end

math.randomseed(7)
local function random(most)
    return most * (2 * math.random() - 1)
end

for _, scene in ipairs(ORDER) do
    for _, law in ipairs { "elastic", "coulomb" } do
        for _, state in ipairs(STATES) do
            for _, reuse in ipairs { true, false } do
                local model = build(scene, law, KN * state.closure, reuse)
                local one, free = free_of(model)
                for i = 1, #one do
                    local way = {}
                    for axis = 1, 6 do
                        way[axis] = random(state.motion)
                    end
                    move(model, one, free, i, way)
                    forces(model, one, free)
                end
                local odd = asymmetry(model)
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
        model:blocks { id = block.id }:set { velocity = { random(kick), random(kick), random(kick) } }
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
