-- bolt_pattern.lua - talus.bolt_pattern{...}: bolts on a grid over faces, as a list for model:element.
--
-- The grid lies in the plane of each face: point (i, j) is origin + i a x + j b y, with the spacings a and b, y the
-- direction `along` as it lies in the face, and x across. Faces in one plane share one grid. Bolts begin where a point of
-- the grid lies in a face.
local talus = require "talus"
local arguments = require "talus.arguments"

local fail = arguments.fail
local WHERE = "bolt_pattern"
local OWN = { along = true, direction = true, length = true, on = true, origin = true, spacing = true, node_spacing = true }
-- Sine of the angle of a bolt to its face below which it does not enter the rock.
local GRAZES = 0.05
-- Of the spacing: by this a point is taken farther on, so that one on the edge between two faces is in one of them.
local NUDGE = { 1e-7, 1.7e-7 }
-- Sine of the angle of `along` to the normal of a face below which it gives no direction there.
local UPRIGHT = 1e-3

local function dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

local function add(a, factor, b)
    return { a[1] + factor * b[1], a[2] + factor * b[2], a[3] + factor * b[3] }
end

local function unit(v)
    local size = math.sqrt(dot(v, v))
    return { v[1] / size, v[2] / size, v[3] / size }, size
end

local function vector(given, key, default)
    local v = given[key] or default
    local good = type(v) == "table" and #v == 3
    for i = 1, 3 do
        good = good and type(v[i]) == "number" and v[i] - v[i] == 0
    end
    if not good then
        fail("%s: %s must be a vector {x, y, z}, not %s", WHERE, key, arguments.describe(v))
    end
    return v
end

-- Faces of what model:boundary gave: corners, outward normal, centroid and area.
local function faces_of(on)
    local faces = {}
    if type(on) ~= "table" or type(on.faces) ~= "table" then
        fail("%s: on must be what model:boundary{...} gives, not %s", WHERE, arguments.describe(on))
    end
    for _, one in ipairs(on.faces) do
        local places, corners = one.block.vertices, {}
        for i, k in ipairs(one.block.faces[one.face].vertices) do
            corners[i] = places[k]
        end
        faces[#faces + 1] = { corners = corners, normal = one.normal, centroid = one.centroid, area = one.area }
    end
    if #faces == 0 then
        fail("%s: on has no faces", WHERE)
    end
    return faces
end

-- Axes x, y of the grid of a face.
local function axes(normal, along)
    local y, size = unit(add(along, -dot(along, normal), normal))
    if size < UPRIGHT then
        y = unit(add({ 0, 0, 1 }, -normal[3], normal))
    end
    return cross(y, normal), y
end

-- Calls `put` with the points of the grid that lie in a face.
local function each_point(face, along, origin, spacing, put)
    local x, y = axes(face.normal, along)
    local low, high, flat = { math.huge, math.huge }, { -math.huge, -math.huge }, {}
    for i, corner in ipairs(face.corners) do
        local from = add(corner, -1, origin)
        flat[i] = { dot(from, x), dot(from, y) }
        for k = 1, 2 do
            low[k], high[k] = math.min(low[k], flat[i][k]), math.max(high[k], flat[i][k])
        end
    end
    local height = dot(add(face.corners[1], -1, origin), face.normal)
    local base = add(origin, height, face.normal)
    for i = math.ceil(low[1] / spacing[1]), math.floor(high[1] / spacing[1]) do
        for j = math.ceil(low[2] / spacing[2]), math.floor(high[2] / spacing[2]) do
            local u, v, sides = (i + NUDGE[1]) * spacing[1], (j + NUDGE[2]) * spacing[2], 0
            for k, a in ipairs(flat) do
                local b = flat[k % #flat + 1]
                sides = sides + ((b[1] - a[1]) * (v - a[2]) - (b[2] - a[2]) * (u - a[1]) >= 0 and 1 or 0)
            end
            if sides == #flat or sides == 0 then
                put(add(add(base, i * spacing[1], x), j * spacing[2], y))
            end
        end
    end
end

local function lay_out(given)
    arguments.table(WHERE, given, "a table")
    local faces = faces_of(given.on)
    local spacing = given.spacing
    if type(spacing) ~= "table" or not (tonumber(spacing[1]) and tonumber(spacing[2])) or spacing[1] <= 0 or spacing[2] <= 0 then
        fail("%s: spacing must be {across, along}, m, both above 0, not %s", WHERE, arguments.describe(spacing))
    end
    local length = arguments.number(WHERE, given, "length", nil, 1e-3, 1e4)
    local normal = given.direction == nil or given.direction == "normal"
    local direction = not normal and unit(vector(given, "direction"))
    local along, size = unit(vector(given, "along", { 0, 1, 0 }))
    if not (size > 0) or direction and direction[1] ~= direction[1] then
        fail("%s: %s must not be {0, 0, 0}", WHERE, size > 0 and "direction" or "along")
    end
    local sum, centre = 0, { 0, 0, 0 }
    for _, face in ipairs(faces) do
        centre, sum = add(centre, face.area, face.centroid), sum + face.area
    end
    local origin = vector(given, "origin", { centre[1] / sum, centre[2] / sum, centre[3] / sum })
    local bolts = {}
    for _, face in ipairs(faces) do
        local way = direction or add({ 0, 0, 0 }, -1, face.normal)
        if dot(way, face.normal) < -GRAZES then
            each_point(face, along, origin, spacing, function(place)
                local bolt = { from = place, to = add(place, length, way), spacing = given.node_spacing }
                for key, value in pairs(given) do
                    if not OWN[key] then
                        bolt[key] = value
                    end
                end
                bolts[#bolts + 1] = bolt
            end)
        end
    end
    if #bolts == 0 then
        fail("%s: no bolt of the grid hits a face: there are %d of %s m2 in all, the spacing is %s by %s m", WHERE, #faces, sum,
            spacing[1], spacing[2])
    end
    return bolts
end

return arguments.call(lay_out)
