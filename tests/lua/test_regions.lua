-- Selections by several planes at once, and by a convex region: against each block by itself, in random models.
local talus = require "talus"
local check = require "check"

local function height(plane, c)
    local dip, direction = math.rad(plane.dip), math.rad(plane.dip_direction)
    local n = { math.sin(dip) * math.sin(direction), math.sin(dip) * math.cos(direction), math.cos(dip) }
    local sum = 0
    for k = 1, 3 do
        sum = sum + n[k] * (c[k] - plane.origin[k])
    end
    return sum
end

local function rock(seed)
    local model = talus.model { seed = seed }
    model:generate("box", { min = { 0, 0, 0 }, max = { 6, 6, 6 }, density = 2000 })
    for i, joint in ipairs { { 70, 20 }, { 80, 110 }, { 20, 200 } } do
        model:generate("jointset", { joint = "J" .. i, dip = joint[1], dip_direction = joint[2], spacing = 1.1, number = 5,
            origin = { 3, 3, 3 }, dip_dev = 5 })
    end
    return model
end

local function ids(selection)
    return selection:values "id"
end

for seed = 1, check.cases(40) do
    math.randomseed(seed)
    local model = rock(seed)
    local function plane()
        return { dip = 90 * math.random(), dip_direction = 360 * math.random(),
            origin = { 2 + 2 * math.random(), 2 + 2 * math.random(), 2 + 2 * math.random() } }
    end
    local above, below = {}, {}
    for i = 1, math.random(3) do
        above[i] = plane()
    end
    for i = 1, math.random(3) do
        below[i] = plane()
    end
    local wanted = {}
    for _, block in ipairs(model:blocks {}) do
        local holds = true
        for _, p in ipairs(above) do
            holds = holds and height(p, block.centroid) >= 0
        end
        for _, p in ipairs(below) do
            holds = holds and height(p, block.centroid) <= 0
        end
        if holds then
            table.insert(wanted, block.id)
        end
    end
    check.near(ids(model:blocks { above = above, below = below }), wanted, 0)
    -- In another order, one by one.
    local list = model:blocks { above = { above[#above], above[1] }, below = below[1] }
    for _, block in ipairs(list) do
        check.holds(height(above[1], block.centroid) >= -1e-9 and height(below[1], block.centroid) <= 1e-9, "each")
    end
    check.near(ids(model:blocks { above = { above[1] } }), ids(model:blocks { above = above[1] }), 0)

    -- The hull of a box's corners, and of points within it, is the box; in any order.
    local min, max = {}, {}
    for k = 1, 3 do
        min[k] = 3 * math.random()
        max[k] = min[k] + 0.5 + 2 * math.random()
    end
    local corners = { { (min[1] + max[1]) / 2, (min[2] + max[2]) / 2, (min[3] + max[3]) / 2 } }
    for i = 0, 7 do
        table.insert(corners, math.random(#corners + 1), { i & 1 == 0 and min[1] or max[1], i & 2 == 0 and min[2] or max[2],
            i & 4 == 0 and min[3] or max[3] })
    end
    check.near(ids(model:blocks { region = corners }), ids(model:blocks { inside = { min = min, max = max } }), 0)
    -- A tetrahedron, by the sign of volumes.
    local t = {}
    for i = 1, 4 do
        t[i] = { 6 * math.random(), 6 * math.random(), 6 * math.random() }
    end
    local function volume(a, b, c, d)
        local u, v, w = {}, {}, {}
        for k = 1, 3 do
            u[k], v[k], w[k] = b[k] - a[k], c[k] - a[k], d[k] - a[k]
        end
        return u[1] * (v[2] * w[3] - v[3] * w[2]) - u[2] * (v[1] * w[3] - v[3] * w[1]) + u[3] * (v[1] * w[2] - v[2] * w[1])
    end
    if math.abs(volume(t[1], t[2], t[3], t[4])) > 1 then
        wanted = {}
        for _, block in ipairs(model:blocks {}) do
            local c, whole, holds = block.centroid, volume(t[1], t[2], t[3], t[4]), true
            for i = 1, 4 do
                local p = { t[1], t[2], t[3], t[4] }
                p[i] = c
                holds = holds and volume(p[1], p[2], p[3], p[4]) * whole >= 0
            end
            if holds then
                table.insert(wanted, block.id)
            end
        end
        check.near(ids(model:blocks { region = t }), wanted, 0)
    end
end

local model = rock(1)
check.raises(function()
    model:blocks { above = { { dip = 30, dip_direction = 0, origin = { 0, 0, 0 } }, { dip = 95, dip_direction = 0, origin = { 0, 0, 0 } } } }
end, "blocks, above, plane 2: dip = 95 deg")
check.raises(function()
    model:blocks { above = { { dip = 30, dip_direction = 0, origin = { 0, 0, 0 } }, 7 } }
end, "blocks, above, plane 2")
check.raises(function()
    model:blocks { above = { dip = 30, dipdirection = 0, origin = { 0, 0, 0 } } }
end, "dip_direction")
check.raises(function()
    model:blocks { region = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } }
end, "region has 3 points")
check.raises(function()
    model:blocks { region = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } } }
end, "region")
