-- stereonet.lua - talus.stereonet{...}: joint sets on the lower hemisphere as a picture in SVG.
--
-- A direction v that points down is drawn at the distance r from the centre, with t its angle from the vertical:
--
--     equal area (Schmidt, Lambert)     r = sqrt(2) sin(t / 2)
--     equal angle (Wulff)               r = tan(t / 2)
--
-- in units of the circle's radius, towards its trend. A plane is drawn by its pole, the downward normal, and by its
-- great circle.
local talus = require "talus"
local arguments = require "talus.arguments"
local svg = require "talus.svg"

local fail = arguments.fail

local KEYS = { "file", "great_circles", "grid", "joints", "keyblocks", "legend", "model", "poles", "projection", "sets",
    "size",
    "title" }
local SET_KEYS = { "dip", "dip_direction", "name", "planes" }
local FONT_SIZE, TITLE_SIZE = 12, 14
local LEGEND_WIDTH, MARGIN = 230, 34
-- Dip, degrees, below which a plane is drawn as a horizontal one.
local HORIZONTAL = 1e-6
local rad, deg, sin, cos = math.rad, math.deg, math.sin, math.cos

-- ------------------------------------------------------------------ directions

-- The downward normal of a plane.
local function pole(dip, dip_direction)
    local d, a = rad(dip), rad(dip_direction)
    return { -sin(d) * sin(a), -sin(d) * cos(a), -cos(d) }
end

-- Dip and dip direction, degrees, of the plane with a normal.
local function orientation(n)
    local sign = n[3] < 0 and -1 or 1
    local x, y, z = sign * n[1], sign * n[2], sign * n[3]
    local across = math.sqrt(x * x + y * y)
    local direction = across > 1e-12 and deg(math.atan(x, y)) or 0
    return deg(math.atan(across, z)), direction < 0 and direction + 360 or direction
end

local function scaled(v, factor)
    return { factor * v[1], factor * v[2], factor * v[3] }
end

local function length(v)
    return math.sqrt(v[1] * v[1] + v[2] * v[2] + v[3] * v[3])
end

-- The direction d for which the sum of (n . d)^2 over unit vectors n is largest: the mean of axes, whose sign means nothing.
local function mean_axis(normals)
    local m = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } }
    for _, n in ipairs(normals) do
        for i = 1, 3 do
            for k = 1, 3 do
                m[i][k] = m[i][k] + n[i] * n[k] / #normals
            end
        end
    end
    local best
    for start = 1, 3 do -- one of the axes is not perpendicular to the mean
        local v = { start == 1 and 1 or 0, start == 2 and 1 or 0, start == 3 and 1 or 0 }
        local size = 0
        for _ = 1, 200 do
            local w = {}
            for i = 1, 3 do
                w[i] = m[i][1] * v[1] + m[i][2] * v[2] + m[i][3] * v[3]
            end
            size = length(w)
            if size < 1e-12 then
                break
            end
            v = scaled(w, 1 / size)
        end
        if not best or size > best.size + 1e-9 then
            best = { v = v, size = size }
        end
    end
    return best.v[3] > 0 and scaled(best.v, -1) or best.v
end

-- ------------------------------------------------------------------ what the script gives

local function read_angles(where, given, into)
    local dip = arguments.number(where, given, "dip", nil, 0, 90)
    local direction = arguments.number(where, given, "dip_direction", nil, 0, 360)
    into[#into + 1] = pole(dip, direction)
end

local function read_set(where, given, number)
    arguments.table(where, given, "the set")
    arguments.check_keys(where, given, SET_KEYS)
    local set = { name = arguments.text(where, given, "name", "set " .. number), poles = {} }
    if given.planes == nil then
        read_angles(where, given, set.poles)
        return set
    end
    if given.dip ~= nil or given.dip_direction ~= nil then
        fail("%s: give either dip and dip_direction or planes, a list of {dip, dip_direction}", where)
    end
    arguments.table(where, given.planes, "planes")
    for i, plane in ipairs(given.planes) do
        local at = where .. ", plane " .. i
        arguments.table(at, plane, "the plane")
        read_angles(at, { dip = plane.dip or plane[1], dip_direction = plane.dip_direction or plane[2] }, set.poles)
    end
    if #set.poles == 0 then
        fail("%s: planes is empty", where)
    end
    return set
end

-- Orders "J2" before "J10".
local function by_number(a, b)
    local head_a, tail_a = a:match("^(.-)(%d*)$")
    local head_b, tail_b = b:match("^(.-)(%d*)$")
    if head_a == head_b and tail_a ~= tail_b then
        local x, y = tonumber(tail_a) or -1, tonumber(tail_b) or -1
        if x ~= y then
            return x < y
        end
    end
    return a < b
end

-- Normals of the faces of each plane of each joint set, as the blocks lie now: sets["J1"]["J1:3"] = {normal, ...}.
local function model_planes(model)
    local sets = {}
    local good, blocks = pcall(function() return model:blocks { hidden = "any" } end)
    if not good then
        fail("stereonet: model must be a model, not %s", arguments.describe(model))
    end
    for _, block in ipairs(blocks) do
        for _, face in ipairs(block.faces) do
            local plane = face.joint or ""
            local name = plane:match("^(.*):%d+$") or plane
            if name ~= "" then
                sets[name] = sets[name] or {}
                sets[name][plane] = sets[name][plane] or {}
                table.insert(sets[name][plane], face.normal)
            end
        end
    end
    return sets
end

local function sorted_keys(list)
    local keys = {}
    for key in pairs(list) do
        keys[#keys + 1] = key
    end
    table.sort(keys, by_number)
    return keys
end

local function model_sets(given, into)
    local sets = model_planes(given.model)
    local known = sorted_keys(sets)
    local wanted = given.joints or known
    if type(wanted) == "string" then
        wanted = { wanted }
    end
    arguments.table("stereonet", wanted, "joints")
    for _, name in ipairs(wanted) do
        if type(name) ~= "string" or not sets[name] then
            fail("stereonet: no face of the model is of a joint '%s' (there are: %s)", tostring(name),
                table.concat(known, ", "))
        end
        local set = { name = name, poles = {} }
        for _, plane in ipairs(sorted_keys(sets[name])) do
            set.poles[#set.poles + 1] = mean_axis(sets[name][plane])
        end
        into[#into + 1] = set
    end
    if #known == 0 then
        fail("stereonet: no face of the model was made by a joint")
    end
end

-- What talus.poles gave, or a list of such, as its method sets gives.
local function add_poles(given, into)
    arguments.table("stereonet", given, "poles")
    for i, one in ipairs(given.planes and { given } or given) do
        if type(one) ~= "table" or type(one.list) ~= "function" then
            fail("stereonet: poles must be what talus.poles gives, or a list of such; item %d is not of it", i)
        end
        into[#into + 1] = read_set("stereonet, poles " .. i, { planes = one:list(), name = given.planes and "poles" or nil }, i)
    end
end

local function all_sets(given)
    local sets = {}
    if given.model ~= nil then
        model_sets(given, sets)
    elseif given.joints ~= nil then
        fail("stereonet: joints names joints of a model: give model, too")
    end
    if given.sets ~= nil then
        arguments.table("stereonet", given.sets, "sets")
        for i, set in ipairs(given.sets) do
            sets[#sets + 1] = read_set("stereonet, set " .. i, set, i)
        end
    end
    if given.poles ~= nil then
        add_poles(given.poles, sets)
    end
    if #sets == 0 and given.keyblocks == nil then
        fail("stereonet: give model, sets = {{dip =, dip_direction =}, ...}, poles or keyblocks")
    end
    for _, set in ipairs(sets) do
        set.mean = mean_axis(set.poles)
    end
    return sets
end

-- Directions in which keyblocks move, unit vectors.
local function all_movements(given)
    local list = {}
    if given.keyblocks == nil then
        return list
    end
    arguments.table("stereonet", given.keyblocks, "keyblocks")
    for i, keyblock in ipairs(given.keyblocks) do
        if type(keyblock) ~= "table" or type(keyblock.mode) ~= "string" then
            fail("stereonet: keyblocks must be a list that model:keyblocks{...} gave; item %d is not of it", i)
        end
        list[#list + 1] = keyblock.direction -- nil: it is stable
    end
    return list
end

-- ------------------------------------------------------------------ the picture

local net = {}
net.__index = net

-- Where a direction of the lower hemisphere lies on the page.
function net:place(v)
    local across = math.sqrt(v[1] * v[1] + v[2] * v[2])
    if across < 1e-15 then
        return self.x, self.y
    end
    local half = math.atan(across, -v[3]) / 2
    local r = self.projection == "equal_angle" and math.tan(half) or math.sqrt(2) * sin(half)
    return self.x + self.radius * r * v[1] / across, self.y - self.radius * r * v[2] / across
end

-- The great circle of the plane with a downward normal, from one end of its strike to the other; of a horizontal plane all round.
function net:great_circle(page, normal, style)
    local dip, direction = orientation(normal)
    local d, a = rad(dip), rad(direction)
    local strike = { -cos(a), sin(a), 0 }
    local down = { cos(d) * sin(a), cos(d) * cos(a), -sin(d) }
    local points = {}
    for i = 0, dip < HORIZONTAL and 180 or 90 do
        local t = rad(2 * i)
        local v = {}
        for k = 1, 3 do
            v[k] = cos(t) * strike[k] + sin(t) * down[k]
        end
        points[#points + 1], points[#points + 2] = self:place(v)
    end
    page:polyline(points, style)
end

function net:frame(page, grid)
    if grid then
        for plunge = 30, 60, 30 do
            local _, y = self:place { 0, cos(rad(plunge)), -sin(rad(plunge)) }
            page:add('<circle cx="%s" cy="%s" r="%s" fill="none" stroke="#dddddd"/>', svg.number(self.x),
                svg.number(self.y), svg.number(self.y - y))
            page:text(self.x + 3, y - 2, 9, "start", plunge .. "°", 'fill="#999999"')
        end
        for trend = 0, 150, 30 do
            local x, y = self.radius * sin(rad(trend)), self.radius * cos(rad(trend))
            page:line(self.x - x, self.y + y, self.x + x, self.y - y, 'stroke="#e8e8e8"')
        end
    end
    page:add('<circle cx="%s" cy="%s" r="%s" fill="none" stroke="#000000"/>', svg.number(self.x), svg.number(self.y),
        svg.number(self.radius))
    for trend = 0, 350, 10 do
        local x, y = sin(rad(trend)), cos(rad(trend))
        local tick = self.radius + (trend % 90 == 0 and 8 or 4)
        page:line(self.x + self.radius * x, self.y - self.radius * y, self.x + tick * x, self.y - tick * y,
            'stroke="#000000"')
    end
    for i, name in ipairs { "N", "E", "S", "W" } do
        local a, r = rad(90 * (i - 1)), self.radius + 18
        page:text(self.x + r * sin(a), self.y - r * cos(a) + 0.35 * FONT_SIZE, FONT_SIZE, "middle", name)
    end
    page:line(self.x - 4, self.y, self.x + 4, self.y, 'stroke="#000000"')
    page:line(self.x, self.y - 4, self.x, self.y + 4, 'stroke="#000000"')
end

function net:sets(page, sets, circles)
    for _, set in ipairs(sets) do
        local style = string.format('stroke="%s" stroke-width="%s"', set.colour, circles == "all" and "0.8" or "1.5")
        if circles == "mean" then
            self:great_circle(page, set.mean, style)
        elseif circles == "all" then
            for _, normal in ipairs(set.poles) do
                self:great_circle(page, normal, style)
            end
        end
    end
    for _, set in ipairs(sets) do
        for _, normal in ipairs(set.poles) do
            local x, y = self:place(normal)
            page:symbol(set.symbol, x, y, 4, string.format('fill="%s" fill-opacity="0.75" stroke="#ffffff" stroke-width="0.7"',
                set.colour))
        end
    end
end

-- A cross, in a ring where the direction points up: then its opposite is drawn.
local function movement_mark(page, x, y, up)
    for _, sign in ipairs { -1, 1 } do
        page:line(x - 5, y - 5 * sign, x + 5, y + 5 * sign, 'stroke="#000000" stroke-width="1.8"')
    end
    if up then
        page:add('<circle cx="%s" cy="%s" r="8" fill="none" stroke="#000000"/>', svg.number(x), svg.number(y))
    end
end

function net:movements(page, list)
    local any_up, any_down = false, false
    for _, direction in ipairs(list) do
        local up = direction[3] > 1e-9
        any_up, any_down = any_up or up, any_down or not up
        local v = scaled(direction, up and -1 or 1)
        if v[3] > 0 then
            v[3] = 0
        end
        local x, y = self:place(v)
        movement_mark(page, x, y, up)
    end
    return any_down, any_up
end

-- "065/120": dip and dip direction of a plane, degrees.
local function angles_text(normal)
    local dip, direction = orientation(normal)
    return string.format("%02d°/%03d°", math.floor(dip + 0.5), math.floor(direction + 0.5) % 360)
end

local function draw_legend(page, x, y, sets, circles, any_down, any_up)
    for _, set in ipairs(sets) do
        if circles ~= "none" then
            page:line(x, y, x + 26, y, string.format('stroke="%s" stroke-width="1.5"', set.colour))
        end
        page:symbol(set.symbol, x + 13, y, 4, string.format('fill="%s"', set.colour))
        page:text(x + 34, y + 0.35 * FONT_SIZE, FONT_SIZE, "start", set.name)
        page:text(x + 34, y + 0.35 * FONT_SIZE + 15, 11, "start", string.format("%s%s, %d plane%s",
            #set.poles > 1 and "mean " or "", angles_text(set.mean), #set.poles, #set.poles == 1 and "" or "s"),
            'fill="#444444"')
        y = y + 40
    end
    for _, row in ipairs { { any_down, "movement of a keyblock", false }, { any_up, "the same, upward", true } } do
        if row[1] then
            movement_mark(page, x + 13, y, row[3])
            page:text(x + 34, y + 0.35 * FONT_SIZE, FONT_SIZE, "start", row[2])
            y = y + 26
        end
    end
end

local function draw(given)
    arguments.table("stereonet", given, "the argument")
    arguments.check_keys("stereonet", given, KEYS)
    local file = arguments.text("stereonet", given, "file")
    local projection = arguments.choice("stereonet", given, "projection", "equal_area", { "equal_area", "equal_angle" })
    local circles = arguments.choice("stereonet", given, "great_circles", "mean", { "mean", "all", "none" })
    local size = arguments.number("stereonet", given, "size", 480, 150, 10000)
    local title = arguments.text("stereonet", given, "title", "")
    local grid = arguments.boolean("stereonet", given, "grid", true)
    local legend = arguments.boolean("stereonet", given, "legend", true)
    local sets, movements = all_sets(given), all_movements(given)
    for i, set in ipairs(sets) do
        set.colour, set.symbol = svg.colours[(i - 1) % #svg.colours + 1], i
    end
    local top = title ~= "" and 28 or 0
    local height = math.max(size + top, legend and top + 2 * MARGIN + 40 * #sets + 60 or 0)
    local page = svg.page(size + (legend and LEGEND_WIDTH or 0), height)
    local self = setmetatable({ x = size / 2, y = top + size / 2, radius = size / 2 - MARGIN, projection = projection }, net)
    if title ~= "" then
        page:text(size / 2, 22, TITLE_SIZE, "middle", title, 'font-weight="bold"')
    end
    self:frame(page, grid)
    self:sets(page, sets, circles)
    local any_down, any_up = self:movements(page, movements)
    if legend then
        draw_legend(page, size + 10, top + MARGIN + 8, sets, circles, any_down, any_up)
        page:text(size + 10, size + top - 14, 11, "start", (projection == "equal_angle" and "equal angle" or "equal area") ..
            ", lower hemisphere", 'fill="#444444"')
    end
    arguments.write("stereonet", file, page:finish())
end

return arguments.call(draw)
