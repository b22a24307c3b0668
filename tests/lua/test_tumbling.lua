-- Where a scene lies, how it is turned, whether it is seen in a mirror and in which units it is given: none of it
-- changes how blocks tumble. Hulls fall on each other and on a floor, all of it by edges, vertices and faces; as long as
-- the motion is not chaotic, the places agree. Nothing that falls gains energy.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local shapes = require "shapes"
local talus = require "talus"

local HULLS = 54
local FALL = 0.35      -- s: all of them have met others by then, for 0.1 s at least
local STEP = 2.5e-5    -- s
local SAME = 2e-8      -- of a hull's size, which is 1 m: rounding, grown by collisions
local GAINED = 0.01    -- balance of the energy ledger, over its largest term
local KN, DENSITY, GRAVITY = 1e9, 2500, 9.81

-- A small generator of its own: scenes must not depend on Lua's.
local function generator(seed)
    local state = seed
    return function(low, high)
        state = (state * 1103515245 + 12345) % 2147483648
        return low + (high - low) * (state / 2147483648)
    end
end

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

-- A rotation matrix from three numbers.
local function rotation(p, q, r)
    local function about(axis, angle)
        local c, s = math.cos(angle), math.sin(angle)
        local i, j = axis % 3 + 1, (axis + 1) % 3 + 1
        local m = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } }
        m[axis][axis], m[i][i], m[j][j], m[i][j], m[j][i] = 1, c, c, -s, s
        return m
    end
    return shapes.product(about(1, p), shapes.product(about(2, q), about(3, r)))
end

local none = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

-- x of the scene as the scene's other form has it: turned, moved, in other units of length.
local function placed(form, x, direction)
    local out = {}
    for i = 1, 3 do
        local row = form.turn[i]
        out[i] = row[1] * x[1] + row[2] * x[2] + row[3] * x[3]
        out[i] = form.unit * (out[i] + (direction and 0 or form.shift[i]))
    end
    return out
end

-- The vertices of all blocks; the floor is the first.
local function shapes(seed)
    local random = generator(seed)
    local floor, list = {}, {}
    for k = 0, 7 do
        floor[k + 1] = { k % 2 * 8 - 1, k // 2 % 2 * 8 - 1, k // 4 - 1 }
    end
    list[1] = floor
    for k = 0, HULLS - 1 do
        local centre = { 1 + 1.25 * (k % 6 % 3) + random(-0.1, 0.1), 1 + 1.25 * (k % 9 // 3) + random(-0.1, 0.1),
            0.75 + 1.25 * (k // 9) }
        local hull = {}
        for i = 1, 14 do
            local up, around = random(-1, 1), random(0, 2 * math.pi)
            local flat = math.sqrt(1 - up * up)
            hull[i] = { centre[1] + 0.55 * flat * math.cos(around), centre[2] + 0.55 * flat * math.sin(around),
                centre[3] + 0.55 * up }
        end
        list[#list + 1] = hull
    end
    return list
end

-- Units: of length; force stays newton and time second, so density goes as length^-4 and kn, force / length^3, as -3.
local function scene(seed, form, friction)
    local model = talus.model { gravity = placed(form, { 0, 0, -GRAVITY }, true) }
    for _, vertices in ipairs(shapes(seed)) do
        local list = {}
        for i, x in ipairs(vertices) do
            list[i] = placed(form, x)
        end
        model:generate("polyhedron", { vertices = list, density = DENSITY / form.unit ^ 4 })
    end
    model:joint("*", "coulomb", { kn = KN / form.unit ^ 3, ks = KN / form.unit ^ 3, friction = friction })
    model:blocks { id = 1 }:fix()
    model:timestep { dt = STEP }
    model:cycle(math.floor(FALL / STEP + 0.5))
    return model
end

-- Displacements of the scene, seen from its first form.
local function motions(model, form)
    local out = {}
    for k, block in ipairs(model:blocks()) do
        local u, back = block.displacement, {}
        for i = 1, 3 do
            back[i] = (form.turn[1][i] * u[1] + form.turn[2][i] * u[2] + form.turn[3][i] * u[3]) / form.unit
        end
        out[k] = back
    end
    return out
end

local first = { turn = none, shift = { 0, 0, 0 }, unit = 1 }
local mirror = { { -1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local forms = {
    { name = "moved", turn = none, shift = { 137.3, -58.1, 20.7 }, unit = 1 },
    { name = "turned", turn = rotation(0.7, -1.1, 2.3), shift = { 0, 0, 0 }, unit = 1 },
    { name = "seen in a mirror", turn = mirror, shift = { 0, 0, 0 }, unit = 1 },
    { name = "in millimetres", turn = none, shift = { 0, 0, 0 }, unit = 1000 },
}

for _, seed in ipairs(check.few { 1, 2, 3 }) do
    local friction = seed == 3 and 0 or 30
    local model = scene(seed, first, friction)
    local expected = motions(model, first)
    check.holds(model:contacts():sum "normal_force" > 0, "that hulls have met")
    check.holds(math.abs(model:energy().balance) < GAINED, "the energy ledger")
    for _, form in ipairs(forms) do
        local worst = 0
        for k, u in ipairs(motions(scene(seed, form, friction), form)) do
            for i = 1, 3 do
                worst = math.max(worst, math.abs(u[i] - expected[k][i]))
            end
        end
        check.holds(worst < SAME, string.format("seed %d: that the scene falls alike when it is %s (%g m off)", seed,
            form.name, worst))
    end
end
