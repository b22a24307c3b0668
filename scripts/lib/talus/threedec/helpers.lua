-- helpers.lua - small functions that a converted script defines for itself, those that it calls only.
return {
    height = [[
-- Height of a place above a plane.
local function height(p, dip, dip_direction, origin)
    local n = normal_of(dip, dip_direction)
    return n[1] * (p[1] - origin[1]) + n[2] * (p[2] - origin[2]) + n[3] * (p[3] - origin[3])
end]],
    normal_of = [[
-- Upward unit normal of a plane.
local function normal_of(dip, dip_direction)
    local d, a = math.rad(dip), math.rad(dip_direction)
    return { math.sin(d) * math.sin(a), math.sin(d) * math.cos(a), math.cos(d) }
end]],
    angle = [[
-- Angle between two axes, degrees.
local function angle(a, b)
    return math.deg(math.acos(math.min(1, math.abs(a[1] * b[1] + a[2] * b[2] + a[3] * b[3]))))
end]],
    distance = [[
-- Distance of two places.
local function distance(a, b)
    return ((a[1] - b[1]) ^ 2 + (a[2] - b[2]) ^ 2 + (a[3] - b[3]) ^ 2) ^ 0.5
end]],
    off_axis = [[
-- Distance of a place from the axis between two ends; beyond them it is infinite.
local function off_axis(p, a, b)
    local along = ((p[1] - a[1]) * (b[1] - a[1]) + (p[2] - a[2]) * (b[2] - a[2]) + (p[3] - a[3]) * (b[3] - a[3])) / distance(a, b)
    return along >= 0 and along <= distance(a, b) and (distance(p, a) ^ 2 - along ^ 2) ^ 0.5 or math.huge
end]],
    nearest = [[
-- The block whose centroid is nearest to a place, of those that hold it or else of all.
local function nearest(p)
    local found, least
    local holding = model:blocks { containing = p }
    for _, b in ipairs(#holding > 0 and holding or model:blocks {}) do
        local far = distance(b.centroid, p)
        if not least or far < least then
            found, least = b, far
        end
    end
    return found
end]],
    load_corners = [[
-- A force on each corner of the blocks' bodies for which `wanted` answers true: as one load at the corners' middle.
local function load_corners(force, wanted)
    for _, b in ipairs(model:blocks {}) do
        local n, x, y, z = 0, 0, 0, 0
        for _, v in ipairs(b.vertices) do
            if wanted { position = v, group = b.group } then
                n, x, y, z = n + 1, x + v[1], y + v[2], z + v[3]
            end
        end
        if n > 0 then
            model:blocks { id = b.id }:load { force = { n * force[1], n * force[2], n * force[3] }, at = { x / n, y / n, z / n } }
        end
    end
end]],
    interpolate = [[
-- Value of a table of rows {time, value} at a time: straight between rows, constant beyond them.
local function interpolate(rows, t)
    for i = 2, #rows do
        if t < rows[i][1] then
            local a, b = rows[i - 1], rows[i]
            return a[2] + (b[2] - a[2]) * math.max(0, t - a[1]) / (b[1] - a[1])
        end
    end
    return rows[#rows][2]
end]],
    joint_again = [[
-- A law of contacts that may all be gone.
local function joint_again(target, law, params)
    local named = target.between or { target.group }
    local living = {}
    for _, b in ipairs(model:blocks { hidden = "any" }) do
        living[b.group] = true
    end
    for _, group in ipairs(named) do
        if not living[group] then
            return
        end
    end
    if not target.contacts or #target.contacts > 0 then
        model:joint(target, law, params)
    end
end]],
    -- Those that another calls come before it.
    order = { "normal_of", "height", "angle", "distance", "off_axis", "nearest", "load_corners", "interpolate", "joint_again" },
    calls = { height = { "normal_of" }, off_axis = { "distance" }, nearest = { "distance" } },
}
