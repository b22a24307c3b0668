-- no_tension.lua - exact statics of a rigid foot on an elastic joint that carries no tension, for tests to compare with.
--
-- The foot presses on a convex polygon in the plane xy. Its walls have approached by the closure, which is linear over it:
--
--     o(x, y) = c + gx x + gy y
--     N = ∫ s(o) dA,   Mx = ∫ s(o) x dA,   My = ∫ s(o) y dA
--
-- with the normal stress s(o), compression positive, which is 0 for o < 0 unless the joint pulls. Integrals run over strips
-- between the corners, along the gradient of o, where the width of the polygon is linear; each strip ends at the line o = 0. Gauss
-- points in a strip are exact for a linear s(o). `equilibrium` finds the closure by Newton's method.
local no_tension = {}

-- ---------------------------------------------------------------- polygons: lists of {x, y}, counter-clockwise

-- Area, and centroid {x, y}.
function no_tension.area(polygon)
    local area, x, y, o = 0, 0, 0, polygon[1]
    for i = 2, #polygon - 1 do
        local p, q = polygon[i], polygon[i + 1]
        local twice = (p[1] - o[1]) * (q[2] - o[2]) - (p[2] - o[2]) * (q[1] - o[1])
        area, x, y = area + twice / 2, x + twice * (p[1] + q[1] - 2 * o[1]) / 6, y + twice * (p[2] + q[2] - 2 * o[2]) / 6
    end
    return area, { o[1] + x / area, o[2] + y / area }
end

-- The part of a polygon where a x + b y <= c; empty when there is none.
local function below(polygon, a, b, c)
    local out = {}
    for i, p in ipairs(polygon) do
        local q = polygon[i % #polygon + 1]
        local dp, dq = a * p[1] + b * p[2] - c, a * q[1] + b * q[2] - c
        if dp <= 0 then
            out[#out + 1] = p
        end
        if dp < 0 and dq > 0 or dp > 0 and dq < 0 then
            local s = dp / (dp - dq)
            out[#out + 1] = { p[1] + s * (q[1] - p[1]), p[2] + s * (q[2] - p[2]) }
        end
    end
    return out
end

-- What two convex polygons have in common.
function no_tension.common(first, second)
    local out = first
    for i, p in ipairs(second) do
        local q = second[i % #second + 1]
        local a, b = q[2] - p[2], p[1] - q[1] -- outward
        out = below(out, a, b, a * p[1] + b * p[2])
    end
    return out
end

-- How far it is from a point inside to the border along a unit direction.
function no_tension.reach(polygon, from, direction)
    local most = math.huge
    for i, p in ipairs(polygon) do
        local q = polygon[i % #polygon + 1]
        local a, b = q[2] - p[2], p[1] - q[1]
        local speed = a * direction[1] + b * direction[2]
        if speed > 0 then
            most = math.min(most, (a * (p[1] - from[1]) + b * (p[2] - from[2])) / speed)
        end
    end
    return most
end

-- The corners of a convex hull of points, counter-clockwise (Andrew's monotone chain).
function no_tension.hull(points)
    local sorted = { table.unpack(points) }
    table.sort(sorted, function(p, q) return p[1] < q[1] or p[1] == q[1] and p[2] < q[2] end)
    local function chain(first, last, step)
        local out = {}
        for i = first, last, step do
            local r = sorted[i]
            while #out >= 2 do
                local p, q = out[#out - 1], out[#out]
                if (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1]) > 0 then
                    break
                end
                out[#out] = nil
            end
            out[#out + 1] = r
        end
        out[#out] = nil
        return out
    end
    local out = chain(1, #sorted, 1)
    for _, p in ipairs(chain(#sorted, 1, -1)) do
        out[#out + 1] = p
    end
    return out
end

-- ---------------------------------------------------------------- stresses: s(o), ds/do, and the energy, the integral of s

function no_tension.linear(kn)
    return function(o)
        return kn * o, kn, kn * o * o / 2
    end
end

-- A stress that goes on in a line beyond the closure `last`.
local function straight_beyond(stress, last)
    local s, slope, energy = stress(last)
    return function(o)
        if o <= last then
            return stress(o)
        end
        local more = o - last
        return s + slope * more, slope, energy + s * more + slope * more * more / 2
    end
end

-- Bandis et al. (1983): s = kni o / (1 - o / vm); a line beyond the stress `from`.
function no_tension.hyperbolic(kni, vm, from)
    local function stress(o)
        local left = 1 - o / vm
        return kni * o / left, kni / left ^ 2, -kni * vm * (vm * math.log(left) + o)
    end
    return straight_beyond(stress, from / (kni + from / vm))
end

-- ds/do = an s^en, at most `most`, so s = ((1 - en) an o)^(1 / (1 - en)).
function no_tension.power(an, en, most)
    local function stress(o)
        local base, m = (1 - en) * an * o, 1 / (1 - en)
        return base ^ m, an * base ^ (en * m), base ^ (m + 1) / (an * (2 - en))
    end
    return straight_beyond(stress, (most / an) ^ ((1 - en) / en) / ((1 - en) * an))
end

-- The closure at a stress, which grows with it.
function no_tension.closure_of(stress, value)
    local low, high = 0, 1
    while stress(high) < value do
        high = 2 * high
    end
    for _ = 1, 200 do
        local middle = (low + high) / 2
        if stress(middle) < value then
            low = middle
        else
            high = middle
        end
    end
    return (low + high) / 2
end

-- ---------------------------------------------------------------- integrals

-- Eight Gauss points in [-1, 1] and their weights: exact up to the power 15. Halves; the others mirror them.
local GAUSS = { { 0.1834346424956498, 0.3626837833783620 }, { 0.5255324099163290, 0.3137066458778873 },
    { 0.7966664774136267, 0.2223810344533745 }, { 0.9602898564975363, 0.1012285362903763 } }

-- Where the line at the place s along `u` crosses the border: the least and the largest place across.
local function chord(corners, s)
    local low, high = math.huge, -math.huge
    for i, p in ipairs(corners) do
        local q = corners[i % #corners + 1]
        if p[1] ~= q[1] and math.min(p[1], q[1]) <= s and s <= math.max(p[1], q[1]) then
            local t = p[2] + (q[2] - p[2]) * (s - p[1]) / (q[1] - p[1])
            low, high = math.min(low, t), math.max(high, t)
        end
    end
    return low, high
end

-- Adds what a strip between s1 and s2 gives to the sums of stress {1, s, t} and energy, and of stiffness {1, s, t, ss, st, tt}.
local function add_strip(corners, s1, s2, plane, stress, force, slope)
    -- The width is linear in between; it is taken from inside, where no corner lies.
    local a, b = s1 + 0.25 * (s2 - s1), s2 - 0.25 * (s2 - s1)
    local a_low, a_high = chord(corners, a)
    local b_low, b_high = chord(corners, b)
    local half, middle = (s2 - s1) / 2, (s1 + s2) / 2
    for k = -#GAUSS, #GAUSS do
        local rule = GAUSS[math.abs(k)]
        if rule then
            local s = middle + (k > 0 and 1 or -1) * rule[1] * half
            local part = (s - a) / (b - a)
            local low, high = a_low + part * (b_low - a_low), a_high + part * (b_high - a_high)
            local width, t = high - low, (high + low) / 2
            local value, rise, energy = stress(plane.c + plane.g * s)
            local weight = width * rule[2] * half
            local f, k_ = value * weight, rise * weight
            force[4] = force[4] + energy * weight
            force[1], force[2], force[3] = force[1] + f, force[2] + f * s, force[3] + f * t
            slope[1], slope[2], slope[3] = slope[1] + k_, slope[2] + k_ * s, slope[3] + k_ * t
            slope[4], slope[5] = slope[4] + k_ * s * s, slope[5] + k_ * s * t
            slope[6] = slope[6] + k_ * (t * t + width * width / 12)
        end
    end
end

-- Sums {N, Mx, My} of the stress over a polygon, their derivatives by {c, gx, gy} as a matrix, and the energy. `closure` is
-- {c, gx, gy}. `pulls`: the stress holds for o < 0, too.
function no_tension.sums(polygon, closure, stress, pulls)
    local g = math.sqrt(closure[2] ^ 2 + closure[3] ^ 2)
    local u = g > 0 and { closure[2] / g, closure[3] / g } or { 1, 0 }
    local corners, places = {}, {}
    for i, p in ipairs(polygon) do
        corners[i] = { u[1] * p[1] + u[2] * p[2], u[1] * p[2] - u[2] * p[1] }
        places[i] = corners[i][1]
    end
    table.sort(places)
    local zero = g > 0 and not pulls and -closure[1] / g or -math.huge
    local plane = { c = closure[1], g = g }
    local force, slope = { 0, 0, 0, 0 }, { 0, 0, 0, 0, 0, 0 }
    if g > 0 or closure[1] > 0 or pulls then
        for i = 1, #places - 1 do
            local s1, s2 = math.max(places[i], zero), places[i + 1]
            -- Strips that are rounding have no width to speak of.
            if s2 - s1 > 1e-13 * (places[#places] - places[1]) then
                add_strip(corners, s1, s2, plane, stress, force, slope)
            end
        end
    end
    local c, s = u[1], u[2]
    local one, ss, st, tt = slope[1], slope[4], slope[5], slope[6]
    local kx, ky = c * slope[2] - s * slope[3], s * slope[2] + c * slope[3]
    local kxx, kyy = c * c * ss - 2 * c * s * st + s * s * tt, s * s * ss + 2 * c * s * st + c * c * tt
    local kxy = c * s * (ss - tt) + (c * c - s * s) * st
    return { force[1], c * force[2] - s * force[3], s * force[2] + c * force[3] },
        { { one, kx, ky }, { kx, kxx, kxy }, { ky, kxy, kyy } }, force[4]
end

-- The solution of three linear equations, by Cramer's rule.
local function solve(m, r)
    local function det(a, b, c)
        return a[1] * (b[2] * c[3] - b[3] * c[2]) - a[2] * (b[1] * c[3] - b[3] * c[1]) + a[3] * (b[1] * c[2] - b[2] * c[1])
    end
    local whole, out = det(m[1], m[2], m[3]), {}
    for i = 1, 3 do
        local rows = {}
        for k = 1, 3 do -- columns as rows: the matrix is symmetric
            rows[k] = k == i and r or m[k]
        end
        out[i] = det(rows[1], rows[2], rows[3]) / whole
    end
    return out
end

-- ---------------------------------------------------------------- equilibrium

-- The closure {c, gx, gy} under a force N at a point {x, y} of the polygon's plane, or nil where there is none: a joint without
-- tension needs the point inside. `kn` is a stiffness for the scale of it.
function no_tension.equilibrium(polygon, n, at, stress, kn, pulls)
    local area, middle = no_tension.area(polygon)
    local size = math.sqrt(area)
    -- In coordinates about the centroid, in units of the size, all unknowns are closures of like size.
    local own = {}
    for i, p in ipairs(polygon) do
        own[i] = { (p[1] - middle[1]) / size, (p[2] - middle[2]) / size }
    end
    local x, y = (at[1] - middle[1]) / size, (at[2] - middle[2]) / size
    local far = math.sqrt(x * x + y * y)
    if not pulls and far > 0 and far >= no_tension.reach(own, { 0, 0 }, { x / far, y / far }) then
        return nil
    end
    local pressure = n / area
    local wanted = { pressure, pressure * x, pressure * y }
    -- What is left of the force, the stiffness, the potential, and the error.
    local function look(closure)
        local f, k, energy = no_tension.sums(own, closure, stress, pulls)
        local r, sum = {}, 0
        for i = 1, 3 do
            r[i] = wanted[i] - f[i]
            sum = sum + r[i] ^ 2
            energy = energy - wanted[i] * closure[i]
        end
        return { r = r, k = k, potential = energy, error = math.sqrt(sum) / pressure, closure = closure }
    end
    -- Newton's method goes downhill on the potential, which is convex. Where that is rounding, the error decides.
    local now = look { pressure / kn, 0, 0 }
    for _ = 1, 500 do
        local step, length, better = solve(now.k, now.r), 1, false
        repeat
            local trial = {}
            for i = 1, 3 do
                trial[i] = now.closure[i] + length * step[i]
            end
            local there = look(trial)
            better = there.potential < now.potential or there.error < now.error
            now, length = better and there or now, length / 2
        until better or length < 1e-12
        if now.error < 1e-13 or not better then
            break
        end
    end
    assert(now.error < 1e-9, "no equilibrium found")
    local closure = now.closure
    local gx, gy = closure[2] / size, closure[3] / size
    return { closure[1] - gx * middle[1] - gy * middle[2], gx, gy }
end

-- The least and the largest closure at the corners.
function no_tension.extremes(polygon, closure)
    local least, most = math.huge, -math.huge
    for _, p in ipairs(polygon) do
        local o = closure[1] + closure[2] * p[1] + closure[3] * p[2]
        least, most = math.min(least, o), math.max(most, o)
    end
    return least, most
end

-- ---------------------------------------------------------------- toppling

-- The largest tan(psi) at which a block of width b and height h stands on an incline of psi. c: closure under its weight on
-- the level. Where the weight acts at x from the toe, 3 x of the base are pressed and the block leans by
-- t = 2 c cos(psi) b / (9 x^2):  tan(psi + t) h / 2 = b / 2 - x. About (b / h) (1 - 3 x / b) at x = (2 c h b / 9)^(1/3).
function no_tension.toppling(b, h, c)
    local function tangent(x)
        local whole, psi = math.atan((b - 2 * x) / h), 0
        for _ = 1, 60 do
            psi = whole - 2 * c * b * math.cos(psi) / (9 * x * x)
        end
        return math.tan(psi)
    end
    local about = (2 * c * h * b / 9) ^ (1 / 3)
    local low, high = 0.5 * about, math.min(3 * about, b / 3)
    -- Golden section of a function with one maximum.
    local golden = (math.sqrt(5) - 1) / 2
    for _ = 1, 80 do
        local x1, x2 = high - golden * (high - low), low + golden * (high - low)
        if tangent(x1) < tangent(x2) then
            low = x1
        else
            high = x2
        end
    end
    return tangent((low + high) / 2)
end

return no_tension
