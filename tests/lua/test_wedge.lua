-- The generators "wedge" and "roof_wedge" against the closed form of a tetrahedron between four planes, and what they refuse.
local talus = require "talus"
local check = require "check"
local bodies = require "bodies"

local function normal(dip, direction)
    local a, b = math.rad(dip), math.rad(direction)
    return { math.sin(a) * math.sin(b), math.sin(a) * math.cos(b), math.cos(a) }
end

local function dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

local function determinant(m)
    local n, result = #m, 0
    if n == 1 then
        return m[1][1]
    end
    for k = 1, n do
        local minor = {}
        for i = 2, n do
            minor[i - 1] = {}
            for j = 1, n do
                if j ~= k then
                    table.insert(minor[i - 1], m[i][j])
                end
            end
        end
        result = result + (k % 2 == 1 and 1 or -1) * m[1][k] * determinant(minor)
    end
    return result
end

-- The volume between four planes n . x = d: |det (n | d)|^3 / (6 times the product of the minors of d).
local function between(planes)
    local whole, minors = {}, 1
    for i = 1, 4 do
        local n, three = planes[i].n, {}
        whole[i] = { n[1], n[2], n[3], planes[i].d }
        for j = 1, 4 do
            if j ~= i then
                table.insert(three, planes[j].n)
            end
        end
        minors = minors * determinant(three)
    end
    return math.abs(determinant(whole)) ^ 3 / (6 * math.abs(minors))
end

local function joints_of(model, block, names)
    for _, name in ipairs(names) do
        check.equal(#model:blocks { joint = name, group = block.group }, 1)
    end
end

local function wedge_planes(w)
    local sine = math.sin(math.rad(w.slope_dip))
    local direction = math.rad(w.slope_dip_direction)
    local crest = { -w.height * math.cos(math.rad(w.slope_dip)) / sine * math.sin(direction),
        -w.height * math.cos(math.rad(w.slope_dip)) / sine * math.cos(direction), w.height }
    local upper = normal(w.upper_dip, w.upper_dip_direction)
    return { { n = normal(w.dip_a, w.dip_direction_a), d = 0 }, { n = normal(w.dip_b, w.dip_direction_b), d = 0 },
        { n = normal(w.slope_dip, w.slope_dip_direction), d = 0 }, { n = upper, d = dot(upper, crest) } }
end

local function shifted(given, origin, scale)
    local other = {}
    for key, value in pairs(given) do
        other[key] = value
    end
    other.origin, other.height, other.span = origin, given.height and scale * given.height, given.span and scale * given.span
    return other
end

-- What must hold of the model that a generator has made.
local function sound(model, volume, names, box)
    local wedge, rock = model:blocks { group = "wedge" }, model:blocks { group = "rock" }
    check.equal(#wedge, 1)
    check.near(wedge[1].volume / volume, 1, 1e-9)
    check.near(wedge[1].mass / (2600 * volume), 1, 1e-9)
    check.equal(bodies(wedge), 1)
    check.equal(bodies(rock), 1)
    check.equal(#rock, #names)
    joints_of(model, wedge[1], names)
    if box then
        check.near(rock:sum "volume" + volume, box, 1e-9 * box)
    end
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 0 })
    rock:fix()
    local keys = model:keyblocks { friction = 0 }
    check.equal(#keys, 1)
    return wedge[1]
end

-- A textbook wedge: dips 45/105 and 70/235 in a slope of 65/185 below one of 12/195.
local book = { dip_a = 45, dip_direction_a = 105, dip_b = 70, dip_direction_b = 235, slope_dip = 65, slope_dip_direction = 185,
    upper_dip = 12, upper_dip_direction = 195, height = 30, density = 2600 }
local model = talus.model { gravity = { 0, 0, -9.81 } }
model:generate("wedge", book)
sound(model, between(wedge_planes(book)), { "A", "B" })

local made, refused = 0, 0
local function real(low, high)
    return low + (high - low) * math.random()
end
for seed = 1, check.cases(300) do
    math.randomseed(seed)
    local direction = real(0, 360)
    local w = { dip_a = real(10, 85), dip_direction_a = (direction + real(-110, 30)) % 360, dip_b = real(10, 85),
        dip_direction_b = (direction + real(-30, 110)) % 360, slope_dip = real(40, 90), slope_dip_direction = direction,
        upper_dip = real(0, 30), upper_dip_direction = (direction + real(-20, 20)) % 360, height = real(5, 50), density = 2600 }
    model = talus.model { gravity = { 0, 0, -9.81 } }
    local good, why = pcall(function() return model:generate("wedge", w) end)
    local planes = wedge_planes(w)
    -- The corners where three planes meet, each on the inner side of the fourth: the wedge is there or is not.
    if good then
        made = made + 1
        local one = sound(model, between(planes), { "A", "B" })
        -- Elsewhere, in other units, beside other rock: the same wedge.
        local other = talus.model { gravity = { 0, 0, -9.81 } }
        other:generate("box", { min = { -1e4, -1e4, -1e4 }, max = { 1e4, 1e4, 0 }, density = 1000, group = "other" })
        local far = shifted(w, { 7, -3, 11 }, 10)
        far.joint_a, far.joint_b = "J2", "J1"
        other:generate("wedge", far)
        check.near(other:blocks { group = "wedge" }[1].volume / one.volume, 1000, 1e-6)
        check.equal(#other:blocks { group = "other" }, 1)
        -- A and B changed round: the same.
        local round = shifted(w, nil, 1)
        round.dip_a, round.dip_b = w.dip_b, w.dip_a
        round.dip_direction_a, round.dip_direction_b = w.dip_direction_b, w.dip_direction_a
        other = talus.model {}
        other:generate("wedge", round)
        check.near(other:blocks { group = "wedge" }[1].volume, one.volume, 1e-9 * one.volume)
    else
        refused = refused + 1
        check.holds(why:find "no wedge", why)
        check.equal(#model:blocks(), 0)
        check.equal(#model:joints(), 0)
    end
end
check.holds(made > refused / 5 and refused > 0, "some of each: " .. made .. " and " .. refused)

local function refuse(changes, part)
    local w = shifted(book, nil, 1)
    for key, value in pairs(changes) do
        w[key] = value
    end
    check.raises(function()
        talus.model {}:generate("wedge", w)
    end, part)
end
refuse({ slope_dip = 28 }, "does not daylight in the slope face")
refuse({ dip_b = 45, dip_direction_b = 105 }, "are parallel")
refuse({ upper_dip = 65, upper_dip_direction = 185 }, "have no crest")
refuse({ upper_dip = 40, upper_dip_direction = 185 }, "does not reach the upper slope")
refuse({ height = -1 }, "height")
refuse({ dip_a = 95 }, "dip_a")

-- Roof wedges. The base triangle and the apex by another way: the planes through an apex at height h over the origin.
made = 0
for seed = 1, check.cases(200) do
    math.randomseed(1000 + seed)
    local r = { dip_a = real(20, 90), dip_direction_a = real(0, 360), dip_b = real(20, 90), dip_direction_b = real(0, 360),
        dip_c = real(20, 90), dip_direction_c = real(0, 360), trend = real(0, 360), span = real(3, 10), density = 2600 }
    model = talus.model { gravity = { 0, 0, -9.81 } }
    local good, why = pcall(function() return model:generate("roof_wedge", r) end)
    if not good then
        check.holds(why:find "no wedge forms" or why:find "too thin" or why:find "sliver", why)
    else
        made = made + 1
        local wedge = model:blocks { group = "wedge" }[1]
        local low, high, apex, least, most = math.huge, -math.huge, nil, math.huge, -math.huge
        local t = math.rad(r.trend)
        for _, v in ipairs(wedge.vertices) do
            local across, along = v[1] * math.cos(t) - v[2] * math.sin(t), v[1] * math.sin(t) + v[2] * math.cos(t)
            if v[3] > 1e-6 then
                apex = v
            else
                low, high = math.min(low, across), math.max(high, across)
                least, most = math.min(least, along), math.max(most, along)
            end
        end
        check.near({ low, high }, { -r.span / 2, r.span / 2 }, 1e-6 * r.span)
        check.near(least + most, 0, 1e-6 * (most - least))
        local planes = { { n = { 0, 0, 1 }, d = 0 } }
        for _, letter in ipairs { "a", "b", "c" } do
            local n = normal(r["dip_" .. letter], r["dip_direction_" .. letter])
            table.insert(planes, { n = n, d = dot(n, apex) })
        end
        sound(model, between(planes), { "A", "B", "C" })
        -- Half as high: an eighth of it.
        r.height = apex[3] / 2
        local half = talus.model {}
        half:generate("roof_wedge", r)
        check.near(half:blocks { group = "wedge" }[1].volume / wedge.volume, 1 / 8, 1e-8)
        r.height = 1.01 * apex[3]
        check.raises(function() half:generate("roof_wedge", r) end, "has an apex of at most")
    end
end
check.holds(made > check.cases(200) / 2, "most make a wedge: " .. made)

local function refuse_roof(changes, part)
    local r = { dip_a = 60, dip_direction_a = 0, dip_b = 60, dip_direction_b = 120, dip_c = 60, dip_direction_c = 240, span = 5,
        density = 2600 }
    for key, value in pairs(changes) do
        r[key] = value
    end
    check.raises(function()
        talus.model {}:generate("roof_wedge", r)
    end, part)
end
refuse_roof({ dip_direction_b = 0 }, "are parallel, or their line of intersection is horizontal")
refuse_roof({ dip_direction_b = 180 }, "are parallel, or their line of intersection is horizontal")
refuse_roof({ dip_a = 90, dip_b = 90, dip_c = 90 }, "along one line of intersection")
refuse_roof({ span = 0 }, "span")
