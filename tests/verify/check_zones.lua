-- check_zones.lua - what the tests of deformable blocks share: a model of one solid, gridpoints on a plane, motions
-- that end where they are to, and means of stress.
local talus = require "talus"

local zones = {}

-- Stress and strain in the order of the reference figures.
zones.COMPONENTS = { "xx", "yy", "zz", "xy", "yz", "zx" }

-- How far off a plane gridpoints on it may be, over the largest coordinate: it holds what rounding leaves.
local ON_PLANE = 1e-9

-- A model without gravity whose solid "rock" is elastic, unless options name another kind with its parameters.
function zones.model(options)
    local model = talus.model { gravity = options.gravity or { 0, 0, 0 }, threads = options.threads }
    local elastic = { young = options.young, poisson = options.poisson }
    model:solid("rock", options.solid or "elastic", options.params or elastic)
    return model
end

-- Gridpoints that were made on a plane across an axis: zones.on(model, "z", 1). More may be asked for, as by
-- { block = 1 }.
function zones.on(model, axis, value, more)
    local k, what = ({ x = 1, y = 2, z = 3 })[axis], {}
    for key, x in pairs(more or {}) do
        what[key] = x
    end
    what.where = function(p)
        return math.abs(p.position[k] - p.displacement[k] - value) < ON_PLANE * math.max(1, math.abs(value))
    end
    return model:gridpoints(what)
end

-- Gridpoints on any of the six sides of a box.
function zones.hull(model, min, max)
    return model:gridpoints { where = function(p)
        local on = false
        for k = 1, 3 do
            local x = p.position[k] - p.displacement[k]
            on = on or math.abs(x - min[k]) < ON_PLANE or math.abs(x - max[k]) < ON_PLANE
        end
        return on
    end }
end

-- Moves gridpoints along a field of displacements, a function of the place and the gridpoint, by `steps` equal steps,
-- and stops them there. The zones have seen all of it at the end.
function zones.displace(model, points, field, steps, dt)
    dt = dt or model.dt
    local way = {}
    for i, p in ipairs(points) do
        way[i] = field(p.position, p)
    end
    local i = 0
    points:set { velocity = function()
        i = i + 1
        local u = way[i]
        return { u[1] / steps / dt, u[2] / steps / dt, u[3] / steps / dt }
    end }
    model:timestep { dt = dt }
    model:cycle(steps)
    points:set { velocity = { 0, 0, 0 } }
    model:cycle(1)
end

-- The inverse of a 3 x 3 matrix.
local function inverse(m)
    local out, cofactor = { {}, {}, {} }, function(i, k)
        local a, b, c, d = i % 3 + 1, (i + 1) % 3 + 1, k % 3 + 1, (k + 1) % 3 + 1
        return m[a][c] * m[b][d] - m[a][d] * m[b][c]
    end
    local det = m[1][1] * cofactor(1, 1) + m[1][2] * cofactor(1, 2) + m[1][3] * cofactor(1, 3)
    for i = 1, 3 do
        for k = 1, 3 do
            out[k][i] = cofactor(i, k) / det
        end
    end
    return out
end

-- Strains all zones of a model in one step by exactly the six components of `by`, without a turn. Zones take the
-- gradient half way, e = H (I + H / 2)^-1, so H = (I - e / 2)^-1 e. All gridpoints must be held.
function zones.strain(model, points, by, dt)
    local e = { { by[1], by[4], by[6] }, { by[4], by[2], by[5] }, { by[6], by[5], by[3] } }
    local half, h = {}, {}
    for i = 1, 3 do
        half[i] = {}
        for k = 1, 3 do
            half[i][k] = (i == k and 1 or 0) - e[i][k] / 2
        end
    end
    half = inverse(half)
    for i = 1, 3 do
        h[i] = {}
        for k = 1, 3 do
            h[i][k] = (half[i][1] * e[1][k] + half[i][2] * e[2][k] + half[i][3] * e[3][k]) / dt
        end
    end
    points:set { velocity = function(p)
        return { h[1][1] * p[1] + h[1][2] * p[2] + h[1][3] * p[3], h[2][1] * p[1] + h[2][2] * p[2] + h[2][3] * p[3],
            h[3][1] * p[1] + h[3][2] * p[2] + h[3][3] * p[3] }
    end }
    model:cycle(1)
end

-- Degrees that a sector of a ring takes up.
local SECTOR = 10

-- A sector of a ring about the z axis in plane strain: rollers on both sides and both ends, zones as many as `rings`
-- from the inner to the outer wall, as large as their radius asks for. Gives the planes of the walls, which are flat.
function zones.sector(model, what)
    local a = math.rad(SECTOR)
    local c, s, half = math.cos(a), math.sin(a), math.cos(a / 2)
    local base = { { what.inner, 0, 0 }, { what.outer, 0, 0 }, { what.outer * c, what.outer * s, 0 },
        { what.inner * c, what.inner * s, 0 } }
    model:generate("prism", { base = base, axis = { 0, 0, what.thickness }, density = 2500 })
    local share = math.log(what.outer / what.inner) / what.rings
    model:blocks():deformable { solid = "rock", zone = function(p)
        return share * math.sqrt(p[1] * p[1] + p[2] * p[2])
    end }
    for _, plane in ipairs { { normal = { 0, -1, 0 }, at = { 0, 0, 0 } }, { normal = { -s, c, 0 }, at = { 0, 0, 0 } },
        { normal = { 0, 0, -1 }, at = { 0, 0, 0 } }, { normal = { 0, 0, 1 }, at = { 0, 0, what.thickness } } } do
        model:boundary { plane = plane, roller = true }
    end
    local n = { math.cos(a / 2), math.sin(a / 2), 0 }
    local function wall(r, sign)
        return { normal = { sign * n[1], sign * n[2], 0 }, at = { r * half * n[1], r * half * n[2], 0 } }
    end
    return { inner = wall(what.inner, -1), outer = wall(what.outer, 1) }
end

-- The section of such a sector from its axis to a radius, over the square of that.
zones.SECTOR_AREA = math.sin(math.rad(SECTOR)) / 2

-- Mean radial displacement of gridpoints of a sector that were made at a radius: its edges there.
function zones.radial(model, radius)
    local sum, count = 0, 0
    for _, p in ipairs(model:gridpoints {}) do
        local x, u = p.position, p.displacement
        local X, Y = x[1] - u[1], x[2] - u[2]
        local r = math.sqrt(X * X + Y * Y)
        if math.abs(r - radius) < ON_PLANE * radius then
            sum, count = sum + (u[1] * X + u[2] * Y) / r, count + 1
        end
    end
    return sum / count
end

-- Mean of a component of stress or strain over zones, by volume.
function zones.mean(selection, what, component)
    local sum, volume = 0, 0
    for _, z in ipairs(selection) do
        sum = sum + z.volume * z[what][component]
        volume = volume + z.volume
    end
    return sum / volume
end

-- How far a component is off a value anywhere.
function zones.off(selection, what, component, value)
    local most = 0
    for _, z in ipairs(selection) do
        most = math.max(most, math.abs(z[what][component] - value))
    end
    return most
end

-- The largest difference of a component between two zones.
function zones.spread(selection, what, component)
    local least, most = math.huge, -math.huge
    for _, z in ipairs(selection) do
        least, most = math.min(least, z[what][component]), math.max(most, z[what][component])
    end
    return most - least
end

return zones
