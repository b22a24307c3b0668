-- shapes.lua - shapes, attitudes and numbers that tests draw at random, the same on any machine.
local shapes = {}

-- Numbers between two bounds. They do not depend on Lua's own generator.
function shapes.random(seed)
    local state = (seed * 2654435761 + 12345) % 2147483648
    local function draw(low, high)
        state = (state * 1103515245 + 12345) % 2147483648
        return low + (high - low) * ((state >> 7) / 16777216)
    end
    for _ = 1, 3 do -- neighbouring seeds begin alike
        draw(0, 1)
    end
    return draw
end

function shapes.dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

function shapes.cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

-- a + s b
function shapes.sum(a, s, b)
    return { a[1] + s * b[1], a[2] + s * b[2], a[3] + s * b[3] }
end

function shapes.length(a)
    return math.sqrt(shapes.dot(a, a))
end

-- A unit vector, all directions alike.
function shapes.direction(random)
    local up, around = random(-1, 1), random(0, 2 * math.pi)
    local flat = math.sqrt(1 - up * up)
    return { flat * math.cos(around), flat * math.sin(around), up }
end

-- The matrix that turns by an angle (rad) about a unit vector.
function shapes.turn(axis, angle)
    local c, s, m = math.cos(angle), math.sin(angle), {}
    for i = 1, 3 do
        local j, k = i % 3 + 1, (i + 1) % 3 + 1
        m[i] = m[i] or {}
        m[i][i] = c + (1 - c) * axis[i] ^ 2
        m[i][j] = (1 - c) * axis[i] * axis[j] - s * axis[k]
        m[i][k] = (1 - c) * axis[i] * axis[k] + s * axis[j]
    end
    return m
end

-- A rotation matrix, all attitudes alike enough: a turn by any angle about any axis, twice.
function shapes.attitude(random)
    local one = shapes.turn(shapes.direction(random), random(0, 2 * math.pi))
    return shapes.product(one, shapes.turn(shapes.direction(random), random(0, 2 * math.pi)))
end

function shapes.apply(m, x)
    return { shapes.dot(m[1], x), shapes.dot(m[2], x), shapes.dot(m[3], x) }
end

function shapes.product(a, b)
    local m = { {}, {}, {} }
    for i = 1, 3 do
        for j = 1, 3 do
            m[i][j] = a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j]
        end
    end
    return m
end

-- The vertices turned by a matrix about the origin, then moved.
function shapes.placed(vertices, m, shift)
    local out = {}
    for i, x in ipairs(vertices) do
        out[i] = shapes.sum(shapes.apply(m, x), 1, shift or { 0, 0, 0 })
    end
    return out
end

-- The corners of a box with its middle at the origin, from its three lengths.
function shapes.box(a, b, c)
    local out = {}
    for k = 0, 7 do
        out[k + 1] = { (k % 2 - 0.5) * a, (k // 2 % 2 - 0.5) * b, (k // 4 - 0.5) * c }
    end
    return out
end

-- Points on a sphere about the origin, each of them a corner of their hull.
function shapes.hull(random, corners, radius)
    local out = {}
    for i = 1, corners do
        local d = shapes.direction(random)
        out[i] = { radius * d[1], radius * d[2], radius * d[3] }
    end
    return out
end

-- The largest coordinate along a direction.
function shapes.farthest(vertices, direction)
    local most = -math.huge
    for _, x in ipairs(vertices) do
        most = math.max(most, shapes.dot(x, direction))
    end
    return most
end

-- How far b must be moved along a direction for it to be `gap` beyond a.
function shapes.beyond(a, b, direction, gap)
    return shapes.farthest(a, direction) + gap
        + shapes.farthest(b, { -direction[1], -direction[2], -direction[3] })
end

return shapes
