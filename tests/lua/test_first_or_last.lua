-- It makes no difference which of two blocks was made first: the lower id is side A of their contact. A box is thrown on a floor that was
-- made before it or after it. Steps, ways, turns and heat are the same but for roundings, which bonds, slip and opening may enlarge.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local function between(least, most)
    return least + (most - least) * math.random()
end

local function random3(most)
    return { between(-most, most), between(-most, most), between(-most, most) }
end

-- Corners of a box on z = 0, turned about its axis.
local function box(a, b, height, turn, x, y)
    local out, c, s = {}, math.cos(turn), math.sin(turn)
    for _, corner in ipairs { { -a, -b }, { a, -b }, { a, b }, { -a, b } } do
        for _, z in ipairs { 0, height } do
            out[#out + 1] = { x + c * corner[1] - s * corner[2], y + s * corner[1] + c * corner[2], z }
        end
    end
    return out
end

local function thrown(of, floor_first)
    local model = talus.model { gravity = { 0, 0, -9.81 }, contact_points = of.points }
    local function floor()
        model:generate("box", { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = 2500, group = "floor" })
    end
    if floor_first then
        floor()
    end
    model:generate("polyhedron", { vertices = of.box, density = 2500, group = "box" })
    if not floor_first then
        floor()
    end
    model:blocks { group = "floor" }:fix()
    model:joint("*", of.law[1], of.law[2])
    model:timestep { fraction = 0.2 }
    model:blocks { group = "box" }:set { velocity = of.velocity, angular_velocity = of.spin }
    return model
end

local function off(a, b)
    local difference, size = 0, 0
    for axis = 1, 3 do
        difference = difference + (a[axis] - b[axis]) ^ 2
        size = size + a[axis] ^ 2
    end
    return math.sqrt(difference / size)
end

local K = 2e9
local laws = {
    { "coulomb", { kn = K, ks = K / 2, friction = 25 } },
    { "coulomb", { kn = K, ks = K / 3, friction = 30, dilation = 8 } },
    { "coulomb_tensile", { kn = K, ks = K / 2, friction = 35, tension = 3e4, cohesion = 2e4, residual_cohesion = 5e3 } },
    { "cohesive", { kn = K, ks = K, friction = 30, tension = 2e4, cohesion = 2e4, gi = 5, gii = 5 } },
    { "elastic", { kn = K / 10, ks = K / 20 } }
}
local STEPS = 60
local pairs_seen, shared_heat = 0, 0
for number, law in ipairs(laws) do
    for seed = 1, 8 do
        math.randomseed(100 * number + seed)
        local speed = between(0.05, 1)
        local of = {
            law = law,
            points = seed % 3 == 0 and "corners" or "consistent",
            box = box(between(0.3, 0.6), between(0.3, 0.6), between(0.4, 1), between(0, 1.5), between(-0.3, 0.3), between(-0.3, 0.3)),
            velocity = random3(0.5 * speed),
            spin = random3(speed)
        }
        local first, last = thrown(of, true), thrown(of, false)
        local what = ("%s, seed %d"):format(law[1], seed)
        for step = 1, STEPS do
            first:cycle(1)
            last:cycle(1)
            check.holds(math.abs(first.time / last.time - 1) < 1e-7, ("%s: the steps differ at step %d"):format(what, step))
        end
        local a, b = first:blocks { group = "box" }[1], last:blocks { group = "box" }[1]
        check.holds(off(a.displacement, b.displacement) < 1e-7, ("%s: ways differ by %g"):format(what, off(a.displacement, b.displacement)))
        check.holds(off(a.angular_velocity, b.angular_velocity) < 1e-5,
            ("%s: spins differ by %g"):format(what, off(a.angular_velocity, b.angular_velocity)))
        local one, other = first:energy(), last:energy()
        check.holds(math.abs(one.friction - other.friction) < 1e-6 * math.max(one.kinetic, one.stored),
            ("%s: heat is %.9g and %.9g J"):format(what, one.friction, other.friction))
        pairs_seen = pairs_seen + 1
        shared_heat = shared_heat + (one.friction > 0 and 1 or 0)
    end
end
check.holds(pairs_seen == 40 and shared_heat > 20, "boxes slip and break their bonds")
