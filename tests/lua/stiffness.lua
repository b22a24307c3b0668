-- stiffness.lua - how far the tangent stiffness matrix of a model's free blocks is from symmetric, by central differences; and random
-- stacks of boxes under stress, on joints of any law, to try it with.
--
-- Where nothing slips, opens or dilates rock under stress has a potential, so that matrix is symmetric, whatever stress acts, wherever
-- the blocks have moved to, and whichever block was made first.
--
--     stiffness.settle(model)              model:timestep, and a step
--     stiffness.disturb(model, most, random)   moves each free block by up to `most`, m and rad
--     stiffness.asymmetry(model)           largest |K_ij - K_ji| over the largest |K_ij|
--     stiffness.draw(number)               a random case: what does not depend on the law
--     stiffness.try(case, joint)           its asymmetry and the heat of friction over the energy that is stored
--     stiffness.title(case)
local shapes = require "shapes"
local talus = require "talus"

local stiffness = {}

-- A time step so short, s, and blocks so heavy for their springs, kg/m3 for each Pa/m, that forces move nothing in a step.
local DT, HEAVY = 1e-6, 1e4
local STEP = 3e-7 -- m, rad: motion for differences

function stiffness.density(kn)
    return HEAVY * kn
end

function stiffness.settle(model)
    model:timestep { dt = DT }
    model:cycle(1)
end

-- ---------------------------------------------------------------- the matrix

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

function stiffness.disturb(model, most, random)
    local one, free = free_of(model)
    for i = 1, #one do
        local way = {}
        for axis = 1, 6 do
            way[axis] = random(-most, most)
        end
        move(model, one, free, i, way)
        forces(model, one, free)
    end
end

local function along(k, way)
    local out = { 0, 0, 0, 0, 0, 0 }
    out[k] = way
    return out
end

-- A row for each motion of each free block: forces for a unit of it.
local function rows_of(model, one, free)
    local rows = {}
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
            rows[#rows + 1] = row
        end
    end
    return rows
end

-- Turns do not commute, which alone makes the rows of a body's turns asymmetric by the moment M on it: K - K^T = [M] there. That
-- is taken out.
function stiffness.asymmetry(model)
    local one, free = free_of(model)
    local at = forces(model, one, free)
    local k = rows_of(model, one, free)
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

-- ---------------------------------------------------------------- random stacks

-- Closure under stress, m, and motion of the blocks against each other. Where faces are tilted by t, forces are off by some
-- t o of second order, with o the closure over the size: that must be below what an asymmetry may be.
stiffness.STATES = { { closure = 1e-3, motion = 1e-6 }, { closure = 1e-3, motion = 5e-6 }, { closure = 0.1, motion = 5e-8 } }

-- A base that is held, a box on it and one on that, in any attitude; faces lie within each other, cross, or have an edge in common.
function stiffness.draw(number)
    local random = shapes.random(number)
    local case = { number = number, kn = 10 ^ random(8, 11), attitude = shapes.attitude(random), boxes = {} }
    case.state = stiffness.STATES[number % #stiffness.STATES + 1]
    case.reuse = number % 2 == 0
    local top, flush = 0, random(0, 1) < 0.3
    for i = 1, 3 do
        local a, b, c = random(0.8, 2), random(0.8, 2), random(0.5, 1.5)
        local shift = i == 1 and { 0, 0 } or { random(-0.4, 0.4), random(-0.4, 0.4) }
        local before = case.boxes[i - 1]
        local x = before and flush and before.x - before.a / 2 + a / 2 or shift[1]
        case.boxes[i] = { a = a, b = b, c = c, x = x, y = shift[2], z = top + c / 2 }
        top = top + c
    end
    case.stress = { xx = random(0.8, 1.2), yy = random(0.8, 1.2), zz = random(0.8, 1.2), xy = random(-0.1, 0.1),
        yz = random(-0.1, 0.1), zx = random(-0.1, 0.1) }
    return case
end

function stiffness.title(case)
    return ("model %d, kn %.3g Pa/m, closure %g m, motion %g m, reuse %s"):format(case.number, case.kn, case.state.closure,
        case.state.motion, tostring(case.reuse))
end

function stiffness.try(case, joint)
    local model = talus.model { gravity = { 0, 0, 0 }, reuse_geometry = case.reuse }
    for i, box in ipairs(case.boxes) do
        local vertices = shapes.placed(shapes.box(box.a, box.b, box.c), { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
            { box.x, box.y, box.z })
        model:generate("polyhedron", { vertices = shapes.placed(vertices, case.attitude, { 0, 0, 0 }),
            density = stiffness.density(case.kn), group = i == 1 and "fixed" or "free" })
    end
    model:blocks { group = "fixed" }:fix()
    model:joint("*", joint.law, joint.params)
    local stress = {}
    for name, share in pairs(case.stress) do
        stress[name] = (name:sub(1, 1) == name:sub(2, 2) and -1 or 1) * share * case.kn * case.state.closure
    end
    model:insitu { stress = stress }
    stiffness.settle(model)
    stiffness.disturb(model, case.state.motion, shapes.random(case.number))
    local asymmetry = stiffness.asymmetry(model)
    local energy = model:energy()
    return asymmetry, energy.friction / energy.stored
end

return stiffness
