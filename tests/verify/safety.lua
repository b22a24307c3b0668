-- Factors of safety by divided strengths against limit equilibrium, and what they must not depend on.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_safety"
local limit = require "reference"
local wedge = require "examples.wedge"
local slope = require "examples.slope"

local SHARE = tonumber(os.getenv "TALUS_TEST_SHARE" or 1)
local FINE = 0.002 -- width of a bracket, relative
local KN, KS = 1e9, 2e8

local function upward_normal(plane)
    local dip, direction = math.rad(plane[1]), math.rad(plane[2])
    return { math.sin(dip) * math.sin(direction), math.sin(dip) * math.cos(direction), math.cos(dip) }
end

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

local function dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

local function quick(name, result, most)
    figures.between(name .. ": steps of all trials", result.cycles, 0, most)
    figures.equal(name .. ": undecided", result.undecided, 0)
end

-- ------------------------------------------------------------ the examples

local case = wedge.cases[3]
figures.case("FS.W2", "A wedge between two planes, free to turn, whose friction coefficient is 1: 1 over the critical "
    .. "coefficient, whatever the stiffness.", limit.wedge.source)
for _, kn in ipairs { 1e7, 1e8, 1e9, 1e10 } do
    local model = wedge.build(case)
    for _, joint in ipairs { "A", "B" } do
        model:joint(joint, { kn = kn, ks = kn / 5, friction = 45 })
    end
    local before = model:state_hash()
    local r = model:factor_of_safety {}
    local name = string.format("kn %.0e", kn)
    figures.relative(name .. ": factor", r.factor, 1 / limit.wedge[case.name].mu, 0.01)
    figures.equal(name .. ": blocks that go", #r.failing, 1)
    figures.equal(name .. ": mode", r.mode, "slides")
    figures.equal(name .. ": the model is as it was", model:state_hash(), before)
    quick(name, r, 20000)
end

figures.case("FS.slope", "A slope of 49 blocks with friction 30: two discontinuities cut out a wedge that slides at "
    .. "27.14 degrees. Deformed as it is with the softest joints, its shear is locked in.",
    "vector solution for a wedge, Hoek and Bray 1977")
for _, kn in ipairs { 1e7, 1e8, 1e9, 1e10 } do
    local model = slope.build(30)
    model:joint("*", { kn = kn, ks = kn })
    model:relax { ratio = 1e-6 }
    local r = model:factor_of_safety { resolution = 0.005 }
    local name = string.format("kn %.0e", kn)
    figures.relative(name .. ": factor", r.factor, math.tan(math.rad(30)) / math.tan(math.rad(27.14)), 0.01)
    quick(name, r, 20000)
end

-- ------------------------------------------------------------ plane

-- A prism on a plane, without rotation, as the formula supposes.
local function build_plane(one)
    local p = reference.plane
    local t = math.tan(math.rad(p.dip))
    local model = talus.model { gravity = { 0, 0, -p.g } }
    local function profile(section, density)
        return model:generate("profile", { section = section, from = 0, to = p.width, density = density })
    end
    profile({ { 0, -4 }, { 12, -4 }, { 12, 12 * t }, { 0, 0 } }, p.density)
    model:blocks():fix()
    profile({ { p.front, p.front * t }, { p.rear, p.rear * t }, { p.rear, p.top }, { p.front, p.top } }, p.density)
    local prism = model:blocks { fixed = false }
    prism:fix { rotation = true }
    prism:load { force = one.load }
    model:joint("*", "coulomb", { kn = KN, ks = KS, friction = one.friction, cohesion = one.cohesion })
    return model
end

figures.case("FS.plane", "A prism on a plane that does not turn: water in a tension crack and on the plane, cohesion, a "
    .. "bolt of constant force and an earthquake, all as one force.", "Hoek and Bray 1977, chapter 7")
for _, one in ipairs(reference.plane.cases) do
    local r = build_plane(one):factor_of_safety { resolution = FINE }
    figures.relative(one.id, r.factor, one.FS, 0.005)
end

-- ------------------------------------------------------------ wedges

-- A wedge between a box's two planes, face and upper surface; all rock below A or B is held.
local function build_wedge(one)
    local model = talus.model { gravity = { 0, 0, -one.g } }
    local big = 8 * one.height
    local line = cross(upward_normal(one.A), upward_normal(one.B))
    local k = one.height / line[3]
    local top = { k * line[1], k * line[2], one.height }
    model:generate("box", { min = { -big, -big, -big }, max = { big, big, big }, density = one.density })
    local function cut(name, plane, origin)
        model:generate("joint", { joint = name, dip = plane[1], dip_direction = plane[2], origin = origin })
    end
    local function side(plane, origin)
        return { dip = plane[1], dip_direction = plane[2], origin = origin }
    end
    local at = one.crack and { one.crack_at * top[1], one.crack_at * top[2], one.crack_at * top[3] }
    cut("face", one.face, { 0, 0, 0 })
    model:blocks { above = side(one.face, { 0, 0, 0 }) }:delete()
    cut("upper", one.upper, top)
    model:blocks { above = side(one.upper, top) }:delete()
    cut("A", one.A, { 0, 0, 0 })
    cut("B", one.B, { 0, 0, 0 })
    if one.crack then
        cut("T", one.crack, at)
    end
    local nA, nB = upward_normal(one.A), upward_normal(one.B)
    local nT = one.crack and upward_normal(one.crack)
    local outside = nT and dot(nT, at) > 0 and -1 or 1
    model:blocks():fix()
    local block = model:blocks():where(function(b)
        return dot(nA, b.centroid) > 0 and dot(nB, b.centroid) > 0
    end)
    block:where(function(b)
        local off = nT and { b.centroid[1] - at[1], b.centroid[2] - at[2], b.centroid[3] - at[3] }
        return nT and dot(nT, off) * outside < 0
    end):delete()
    block = model:blocks():where(function(b)
        return dot(nA, b.centroid) > 0 and dot(nB, b.centroid) > 0
    end)
    block:free()
    block:load { force = one.load }
    for i, name in ipairs { "A", "B" } do
        model:joint(name, "coulomb", { kn = KN, ks = KS, friction = one.friction[i], cohesion = one.cohesion[i] })
    end
    model:joint("*", "coulomb", { kn = KN, ks = KS, friction = 0 })
    return model, block
end

figures.case("FS.wedges", "A wedge 40 m high with cohesion, water, a crack, an earthquake and a bolt: held against "
    .. "turning, and free to turn, which locks shear into its joints. One that weighs on one plane only, and one that water lifts off a plane.",
    "Hoek and Bray 1977; Wyllie and Mah, Rock Slope Engineering, 4th edition")
for _, one in ipairs(reference.wedges) do
    -- Water takes `lifted` off B: free to turn it falls over, of which the closed form knows nothing.
    for _, held in ipairs(one.id == "FS.wedge.lifted" and { true } or { true, false }) do
        local model, block = build_wedge(one)
        local name = one.id .. (held and ", does not turn" or ", free to turn")
        if held then
            figures.equal(one.id .. ": blocks", #block, 1)
            figures.relative(one.id .. ": volume, m3", block[1].volume, one.volume, 1e-6)
            block:fix { rotation = true }
        end
        local r = model:factor_of_safety { resolution = FINE, from = 0.05 }
        figures.relative(name, r.factor, one.FS, held and 0.005 or 0.02)
    end
end

-- The load of HB_bolt by anchors: they are soft, so their pull stays what it was, and go through the wedge into held rock.
figures.case("FS.wedge.anchors", "The wedge whose load is that of anchors, with six anchors in the place of the load.",
    "Hoek and Bray 1977")
for _, one in ipairs(reference.wedges) do
    if one.id == "FS.wedge.HB_bolt" then
        local pull = math.sqrt(dot(one.load, one.load))
        local along = { one.load[1] / pull, one.load[2] / pull, one.load[3] / pull }
        local model, block = build_wedge(setmetatable({ load = { 0, 0, 0 } }, { __index = one }))
        block:fix { rotation = true }
        local list, side = {}, cross(along, { 0, 0, 1 })
        for k = 0, 5 do
            local from, to = {}, {}
            for i = 1, 3 do
                local at = block[1].centroid[i] + (k % 3 - 1) * 2 * side[i] + (i == 3 and 2 * (k // 3) or 0)
                from[i], to[i] = at - 60 * along[i], at + 60 * along[i]
            end
            list[#list + 1] = { from = from, to = to, pretension = pull / 6, diameter = 0.1, young = 1e9, yield = 1e10,
                grouted_from = 0.9, grout_strength = 1e9, plate_strength = 1e10, plate_stiffness = 1e9, rupture_strain = 10,
                active_length = 100, spacing = 0.5 }
        end
        model:element("bolt", list)
        local r = model:factor_of_safety { resolution = FINE }
        figures.relative("factor", r.factor, one.FS, 0.005)
        figures.equal("undecided", r.undecided, 0)
    end
end

-- ------------------------------------------------------------ two blocks

-- The lower corner of the upper block would run into the other's plane, of which limit equilibrium knows nothing: m of it
-- are cut off.
local CORNER = 0.05
figures.case("FS.two_blocks", "A block on a steep plane pushes one on a flat plane; neither turns, and all three "
    .. "surfaces are at their strength at once. The corner that is cut off holds them once they have slid, whatever the stiffness.", "limit equilibrium of rigid blocks")
local function two_blocks(one, stiffer)
    local model = talus.model { gravity = { 0, 0, -10 } }
    local t1, t2 = math.tan(math.rad(one.dip[1])), math.tan(math.rad(one.dip[2]))
    local a, b_end, h = one.length[1], one.length[1] + one.length[2], one.thickness
    local z1, z2 = -a * t1, -a * t1 - one.length[2] * t2
    local blocks = {
        { { 0, 0 }, { a - CORNER, z1 + CORNER * t1 }, { a, z1 + CORNER }, { a, z1 + h }, { 0, h } },
        { { a, z1 }, { b_end, z2 }, { b_end, z2 + h }, { a, z1 + h } },
    }
    for _, section in ipairs { { { 0, z2 - 4 }, { a, z2 - 4 }, { a, z1 }, { 0, 0 } },
        { { a, z2 - 4 }, { b_end + 2, z2 - 4 }, { b_end + 2, z2 - 2 * t2 }, { a, z1 } } } do
        model:generate("profile", { section = section, from = 0, to = 1, density = 2500 })
    end
    model:blocks():fix()
    for i, section in ipairs(blocks) do
        model:generate("profile", { section = section, from = 0, to = 1, density = one.unit_weight / 10 })
        local block, dip = model:blocks { fixed = false }:where(function(b)
            return math.abs(b.centroid[1] - (i == 1 and a / 2 or (a + b_end) / 2)) < 0.1
        end), math.rad(one.dip[i])
        block:fix { rotation = true }
        block:load { force = { one.uplift[i] * math.sin(dip), 0, one.uplift[i] * math.cos(dip) } }
    end
    model:joint("*", "coulomb", { kn = stiffer * KN, ks = stiffer * KS, friction = one.friction, cohesion = one.cohesion })
    local r = model:factor_of_safety { resolution = FINE }
    local name = string.format("%s, kn %.0e", one.id, stiffer * KN)
    figures.relative(name, r.factor, one.FS, 0.01)
    figures.equal(name .. ": blocks that go", #r.failing, 2)
end

for _, one in ipairs(reference.two_blocks) do
    for _, stiffer in ipairs { 0.1, 1, 10 } do
        two_blocks(one, stiffer)
    end
end

-- ------------------------------------------------------------ random wedges

-- Numbers from 0 to 1, the same on every machine.
local function draws(seed)
    local state = seed
    return function(low, high)
        state = (state * 1103515245 + 12345) % 2147483648
        return low + (high - low) * state / 2147483648
    end
end

local function random_wedge(seed)
    local draw = draws(seed)
    for _ = 1, 20 do
        draw(0, 1)
    end
    local one = { A = { draw(35, 75), draw(100, 160) }, B = { draw(35, 75), draw(200, 260) } }
    local model, block = wedge.build(one)
    local strength = { friction = {}, cohesion = {} }
    for _, joint in ipairs { "A", "B" } do
        strength.friction[joint] = draw(20, 50)
        strength.cohesion[joint] = draw(0, 4e3)
        model:joint(joint, { kn = 1e8, ks = 3e7, friction = strength.friction[joint], cohesion = strength.cohesion[joint] })
    end
    local weight = block[1].mass * 10
    block:load { force = { weight * draw(-0.1, 0.1), weight * draw(-0.1, 0.1), weight * draw(-0.1, 0.1) } }
    return model, block, strength
end

figures.case("FS.random", "Random wedges with friction, cohesion and a load that press on both planes, with normal forces "
    .. "not farther apart than 1 : 0.3.", "model:keyblocks, limit equilibrium")
local found, seed, worst = 0, 0, 0
while found < math.max(4, 40 // SHARE) do
    seed = seed + 1
    local model, block, strength = random_wedge(seed)
    block:fix { rotation = true }
    local key = model:keyblocks(strength)[1]
    local n = key and key.mode == "sliding on two" and { key.faces[1].normal_force, key.faces[2].normal_force }
    if n and math.min(n[1], n[2]) > 0.3 * math.max(n[1], n[2]) then
        local r = model:factor_of_safety { resolution = 0.005 }
        found = found + 1
        worst = math.max(worst, math.abs(r.factor / key.safety - 1))
    end
end
figures.between("largest relative difference from limit equilibrium", worst, 0, 0.015)

-- ------------------------------------------------------------ what it does not depend on

-- The wedge W2 in units of `length` m, moved, turned about the vertical, with planes cut in another order.
local function build_other(length, place, turn, order, threads)
    local c, s = math.cos(math.rad(turn)), math.sin(math.rad(turn))
    local function at(p)
        return { (place[1] + c * p[1] + s * p[2]) / length, (place[2] - s * p[1] + c * p[2]) / length,
            (place[3] + p[3]) / length }
    end
    local model = talus.model { gravity = { 0, 0, -10 / length }, threads = threads }
    local corners = {}
    for i = 0, 7 do
        corners[#corners + 1] = at { i % 2 == 0 and -2 or 2, i // 2 % 2 == 0 and -1 or 1, i // 4 == 0 and -1 or 1 }
    end
    model:generate("polyhedron", { vertices = corners, density = 2000 * length ^ 3 })
    local apex = at { 0, 0.5, 1 }
    for _, joint in ipairs(order) do
        model:generate("joint", { joint = joint, dip = case[joint][1], dip_direction = (case[joint][2] + turn) % 360,
            origin = apex })
    end
    model:blocks():fix()
    local nA = upward_normal { case.A[1], case.A[2] + turn }
    local nB = upward_normal { case.B[1], case.B[2] + turn }
    model:blocks():where(function(b)
        local p = { b.centroid[1] - apex[1], b.centroid[2] - apex[2], b.centroid[3] - apex[3] }
        return dot(nA, p) > 0 and dot(nB, p) > 0
    end):free()
    model:joint("*", "coulomb", { kn = 1e8 * length ^ 2, ks = 2e7 * length ^ 2, friction = 45 })
    return model
end

figures.case("FS.same", "The same wedge in other units and places, turned, cut in another order, on more threads: the "
    .. "factor is the same number.", "what a factor means")
local first = build_other(1, { 0, 0, 0 }, 0, { "A", "B" }, 1):factor_of_safety {}
for name, model in pairs {
    ["in millimetres"] = build_other(1e-3, { 0, 0, 0 }, 0, { "A", "B" }, 1),
    ["10 km away"] = build_other(1, { 1e4, -7e3, 500 }, 0, { "A", "B" }, 1),
    ["turned by 37 degrees"] = build_other(1, { 0, 0, 0 }, 37, { "A", "B" }, 1),
    ["cut in another order"] = build_other(1, { 0, 0, 0 }, 0, { "B", "A" }, 1),
    ["on 3 threads"] = build_other(1, { 0, 0, 0 }, 0, { "A", "B" }, 3),
} do
    figures.equal(name, model:factor_of_safety {}.factor, first.factor)
end

figures.finish()
