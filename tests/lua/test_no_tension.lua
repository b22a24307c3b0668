-- The statics that tests of contacts compare with are right themselves: against closed forms, and against sums over a grid.
local check = require "check"
local no_tension = require "no_tension"
local shapes = require "shapes"

local KN, N = 1e9, 1e5

local function rectangle(b, a)
    return { { -b / 2, -a / 2 }, { b / 2, -a / 2 }, { b / 2, a / 2 }, { -b / 2, a / 2 } }
end

local function turned(polygon, angle, shift)
    local c, s, out = math.cos(angle), math.sin(angle), {}
    for i, p in ipairs(polygon) do
        out[i] = { c * p[1] - s * p[2] + shift[1], s * p[1] + c * p[2] + shift[2] }
    end
    return out
end

local function equilibrium(polygon, at)
    return no_tension.equilibrium(polygon, N, at, no_tension.linear(KN), KN)
end

-- A rectangle b x a, force at e: the whole face is pressed up to e = b/6, with tilt 12 N e / (kn a b^3); beyond only 3 (b/2 - e) of
-- it, with tilt 2 N / (9 kn a (b/2 - e)^2). None at e >= b/2.
local b, a = 1.3, 0.7
for _, e in ipairs { 0, 0.1 * b, 0.2 * b, 0.3 * b, 0.4 * b, 0.45 * b, 0.49 * b, 0.499 * b } do
    local closure = equilibrium(rectangle(b, a), { e, 0 })
    local x = b / 2 - e
    local tilt = e < b / 6 and 12 * N * e / (KN * a * b ^ 3) or 2 * N / (9 * KN * a * x ^ 2)
    local middle = e < b / 6 and N / (KN * a * b) or tilt * (3 * x - b / 2)
    check.near(closure, { middle, tilt, 0 }, 1e-9 * (middle + tilt))
    -- The same, turned and moved.
    local angle, shift = 0.7, { 3, -2 }
    local c, s = math.cos(angle), math.sin(angle)
    closure = equilibrium(turned(rectangle(b, a), angle, shift), { c * e + shift[1], s * e + shift[2] })
    check.near({ closure[2], closure[3] }, { c * tilt, s * tilt }, 1e-8 * tilt)
    check.near(closure[1] + closure[2] * shift[1] + closure[3] * shift[2], middle, 1e-8 * (math.abs(middle) + tilt))
end
check.equal(equilibrium(rectangle(b, a), { 0.501 * b, 0 }), nil)

-- A force near a corner, at x and y from its edges, presses a triangle with the legs 4x and 4y: N = kn (closure at the corner)
-- (8 x y) / 3.
for _, way in ipairs { { 0.1, 0.1 }, { 0.2, 0.05 }, { 0.01, 0.15 } } do
    local x, y = way[1], way[2]
    local closure = equilibrium(rectangle(b, a), { b / 2 - x, a / 2 - y })
    local corner = 3 * N / (8 * KN * x * y)
    check.near({ closure[2], closure[3] }, { corner / (4 * x), corner / (4 * y) }, 1e-8 * corner / (4 * math.min(x, y)))
    local _, most = no_tension.extremes(rectangle(b, a), closure)
    check.near(most, corner, 1e-8 * corner)
end

-- With tension: the plane of the second moments, at any e.
local closure = no_tension.equilibrium(rectangle(b, a), N, { 0.8 * b, 0.1 }, no_tension.linear(KN), KN, true)
check.near(closure, { N / (KN * a * b), 12 * N * 0.8 * b / (KN * a * b ^ 3), 12 * N * 0.1 / (KN * b * a ^ 3) }, 1e-9)

-- A strip under the whole of a power law: s = (an o / 2)^2 for en = 1/2. Pressed on 4x at e = b/2 - x (the centroid of o^2 lies at a
-- quarter): N = a (an tilt / 2)^2 (4x)^3 / 3.
local an, x = 1e6, 0.2
closure = no_tension.equilibrium(rectangle(b, a), N, { b / 2 - x, 0 }, no_tension.power(an, 0.5, 1e12), 1e9)
check.near(closure[2], 2 / an * math.sqrt(3 * N / (a * (4 * x) ^ 3)), 1e-8)
-- The hyperbola is linear for closures far below vm.
closure = no_tension.equilibrium(rectangle(b, a), N, { 0.3 * b, 0 }, no_tension.hyperbolic(KN, 1e3, 1e9), KN)
check.near(closure[2], 2 * N / (9 * KN * a * (0.2 * b) ^ 2), 1e-5 * closure[2])

-- Both go on in a line, without a jump, and their energy is the integral of the stress.
for _, stress in ipairs { no_tension.hyperbolic(KN, 1e-3, 1e6), no_tension.power(an, 0.5, 1e9) } do
    local last, steps, sum = 3e-3, 20000, 0
    for i = 1, steps do
        local before, middle, after = stress((i - 1) / steps * last), stress((i - 0.5) / steps * last), stress(i / steps * last)
        sum = sum + (before + 4 * middle + after) / 6 * last / steps
    end
    local value, _, energy = stress(last)
    check.near(energy / sum, 1, 1e-6)
    check.near(no_tension.closure_of(stress, value), last, 1e-12)
end

-- Polygons at random: the sums over a fine grid of the common part are the force and its moments.
local random = shapes.random(5)
for _ = 1, 12 do
    local points = { {}, {} }
    for k = 1, 2 do
        for i = 1, math.floor(random(3, 30)) do
            local angle, r = random(0, 2 * math.pi), random(0.6, 1)
            points[k][i] = { r * math.cos(angle) + (k - 1) * 0.2, r * math.sin(angle) }
        end
    end
    local first, second = no_tension.hull(points[1]), no_tension.hull(points[2])
    local polygon = #first > 2 and #second > 2 and no_tension.common(first, second) or {}
    if #polygon > 2 then
        local area, middle = no_tension.area(polygon)
        local angle = random(0, 2 * math.pi)
        local direction = { math.cos(angle), math.sin(angle) }
        local far = random(0.3, 0.9) * no_tension.reach(polygon, middle, direction)
        local at = { middle[1] + far * direction[1], middle[2] + far * direction[2] }
        closure = equilibrium(polygon, at)
        local sum, cell = { 0, 0, 0, 0 }, 0.01
        for i = -125, 125 do
            for j = -125, 125 do
                local px, py, inside = i * cell, j * cell, true
                for k, p in ipairs(polygon) do
                    local q = polygon[k % #polygon + 1]
                    inside = inside and (q[1] - p[1]) * (py - p[2]) - (q[2] - p[2]) * (px - p[1]) >= 0
                end
                local o = inside and math.max(0, closure[1] + closure[2] * px + closure[3] * py) or 0
                local f = KN * o * cell ^ 2
                sum[1], sum[2], sum[3] = sum[1] + f, sum[2] + f * px, sum[3] + f * py
                sum[4] = sum[4] + (inside and cell ^ 2 or 0)
            end
        end
        -- A grid of 100 lines a unit: edges are off by half a cell on either side.
        check.near(sum[4], area, 0.03 * area)
        check.near(sum[1], N, 0.03 * N)
        check.near({ sum[2], sum[3] }, { N * at[1], N * at[2] }, 0.03 * N)
    end
end

-- The limit of toppling tends to (b/h) (1 - 3 x / b).
for _, case in ipairs { { 1, 3, 1e-6 }, { 1, 2, 1e-5 }, { 0.5, 2, 1e-7 } } do
    local width, height, c = table.unpack(case)
    local toe = (2 * c * height * width / 9) ^ (1 / 3)
    check.near(no_tension.toppling(width, height, c) / (width / height) / (1 - 3 * toe / width), 1, 2e-3)
end
