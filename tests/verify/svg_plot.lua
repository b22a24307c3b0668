-- svg_plot.lua - draws a figure as SVG text: axes with round ticks, lines, points and a legend.
--
--     svg_plot.draw {
--         title = "Closure of the joints", x = "joint", y = "closure, m",
--         log_y = false,                     -- a logarithmic y axis
--         series = { { name = "expected", x = {...}, y = {...}, style = "line" },
--                    { name = "obtained", x = {...}, y = {...}, style = "points", colour = 1 } },
--     }
--
-- A series has the colour of its place unless it names another. The same data give the same text:
-- coordinates are rounded to a tenth of a pixel. Colours are those of Okabe and Ito, told apart by
-- colour-blind readers too.
local svg_plot = {}

local WIDTH, HEIGHT = 640, 400
local LEFT, RIGHT, TOP, BOTTOM = 78, 18, 44, 56
local LEGEND_ROW, LEGEND_GAP = 18, 26
local COLOURS = { "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000" }
local TICKS = 6      -- about so many on an axis
local MARGIN = 0.04  -- of the range, left free at either end
local PLAIN_LARGEST, PLAIN_SMALLEST = 1e4, 1e-2 -- ticks beyond get a common power of ten

local SUPERSCRIPT = { ["-"] = "⁻", ["0"] = "⁰", ["1"] = "¹", ["2"] = "²", ["3"] = "³", ["4"] = "⁴",
    ["5"] = "⁵", ["6"] = "⁶", ["7"] = "⁷", ["8"] = "⁸", ["9"] = "⁹" }

local function power_of_ten(exponent)
    return "10" .. string.format("%d", exponent):gsub(".", SUPERSCRIPT)
end

local function escape(text)
    return (text:gsub("&", "&amp;"):gsub("<", "&lt;"):gsub(">", "&gt;"))
end

local function finite(value)
    return value == value and math.abs(value) < math.huge
end

-- Lowest and highest of the values that can be drawn, or nil.
local function range(series, key, log)
    local low, high
    for _, one in ipairs(series) do
        for _, value in ipairs(one[key]) do
            if finite(value) and (not log or value > 0) then
                low, high = math.min(low or value, value), math.max(high or value, value)
            end
        end
    end
    return low, high
end

-- 1, 2 or 5 times a power of ten: a step that makes about TICKS of the range.
local function round_step(width)
    local raw = width / TICKS
    local power = 10 ^ math.floor(math.log(raw, 10))
    for _, factor in ipairs { 1, 2, 5 } do
        if raw <= factor * power * 1.0001 then
            return factor * power
        end
    end
    return 10 * power
end

local function linear_axis(low, high)
    if low == high then
        local half = low == 0 and 1 or math.abs(low) / 2
        low, high = low - half, high + half
    end
    local free = MARGIN * (high - low)
    local axis = { low = low - free, high = high + free, ticks = {} }
    local step = round_step(high - low)
    local largest = math.max(math.abs(low), math.abs(high))
    local exponent = 0
    if largest >= PLAIN_LARGEST or largest < PLAIN_SMALLEST then
        exponent = 3 * math.floor(math.log(largest, 10) / 3)
        axis.power = power_of_ten(exponent)
    end
    local shown = step / 10.0 ^ exponent
    local decimals = math.max(0, -math.floor(math.log(shown, 10) + 1e-9))
    for k = math.ceil(axis.low / step), math.floor(axis.high / step) do
        local text = string.format("%." .. decimals .. "f", k * shown)
        axis.ticks[#axis.ticks + 1] = { at = k * step, text = (text:gsub("^%-", "−")) }
    end
    function axis.place(value)
        return (value - axis.low) / (axis.high - axis.low)
    end
    return axis
end

local function logarithmic_axis(low, high)
    local first, last = math.floor(math.log(low, 10)), math.ceil(math.log(high, 10))
    last = math.max(last, first + 1)
    local axis = { low = 10.0 ^ first, high = 10.0 ^ last, ticks = {} }
    for k = first, last, math.ceil((last - first) / TICKS) do
        axis.ticks[#axis.ticks + 1] = { at = 10.0 ^ k, text = power_of_ten(k) }
    end
    function axis.place(value)
        return (math.log(value, 10) - first) / (last - first)
    end
    return axis
end

local function axis_of(series, key, log)
    local low, high = range(series, key, log)
    if not low then
        low, high = log and 1 or 0, log and 10 or 1
    end
    return (log and logarithmic_axis or linear_axis)(low, high)
end

local function text_at(x, y, size, anchor, text, more)
    return string.format('<text x="%.1f" y="%.1f" font-size="%d" text-anchor="%s"%s>%s</text>', x,
        y, size, anchor, more or "", escape(text))
end

local function line_at(x1, y1, x2, y2, colour, width)
    return string.format(
        '<line x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f" stroke="%s" stroke-width="%g"/>', x1, y1, x2,
        y2, colour, width)
end

local function circle_at(x, y, colour)
    return string.format('<circle cx="%.1f" cy="%.1f" r="3.5" fill="none" stroke="%s"'
        .. ' stroke-width="1.8"/>', x, y, colour)
end

-- The places of a series' points on the sheet; `false` where the line is broken.
local function places_of(one, frame, log_y)
    local places = {}
    for i, x in ipairs(one.x) do
        local y = one.y[i]
        if finite(x) and finite(y) and (not log_y or y > 0) then
            places[#places + 1] = {
                frame.left + frame.x.place(x) * (frame.right - frame.left),
                frame.bottom - frame.y.place(y) * (frame.bottom - frame.top) }
        else
            places[#places + 1] = false
        end
    end
    return places
end

local function draw_series(out, one, places, colour)
    if one.style == "points" then
        for _, place in ipairs(places) do
            if place then
                out[#out + 1] = circle_at(place[1], place[2], colour)
            end
        end
        return
    end
    local path, pen, before = {}, "M", nil
    for _, place in ipairs(places) do
        if not place then
            pen = "M"
        else
            local point = string.format("%.1f %.1f", place[1], place[2])
            if pen == "M" or point ~= before then
                path[#path + 1] = pen .. point
            end
            pen, before = "L", point
        end
    end
    out[#out + 1] = string.format('<path d="%s" fill="none" stroke="%s" stroke-width="1.8"'
        .. ' stroke-linejoin="round"/>', table.concat(path), colour)
end

local function draw_axes(out, frame, figure)
    for _, tick in ipairs(frame.x.ticks) do
        local x = frame.left + frame.x.place(tick.at) * (frame.right - frame.left)
        out[#out + 1] = line_at(x, frame.top, x, frame.bottom, "#e6e6e6", 1)
        out[#out + 1] = text_at(x, frame.bottom + 18, 12, "middle", tick.text)
    end
    for _, tick in ipairs(frame.y.ticks) do
        local y = frame.bottom - frame.y.place(tick.at) * (frame.bottom - frame.top)
        out[#out + 1] = line_at(frame.left, y, frame.right, y, "#e6e6e6", 1)
        out[#out + 1] = text_at(frame.left - 8, y + 4, 12, "end", tick.text)
    end
    out[#out + 1] = string.format('<rect x="%.1f" y="%.1f" width="%.1f" height="%.1f" fill="none"'
        .. ' stroke="#555" stroke-width="1"/>', frame.left, frame.top, frame.right - frame.left,
        frame.bottom - frame.top)
    local middle_x, middle_y = (frame.left + frame.right) / 2, (frame.top + frame.bottom) / 2
    out[#out + 1] = text_at(middle_x, 24, 15, "middle", figure.title or "", ' font-weight="bold"')
    out[#out + 1] = text_at(middle_x, frame.bottom + 42, 13, "middle", figure.x or "")
    out[#out + 1] = text_at(18, middle_y, 13, "middle", figure.y or "",
        string.format(' transform="rotate(-90 18 %.1f)"', middle_y))
    if frame.x.power then
        out[#out + 1] = text_at(frame.right, frame.bottom + 42, 12, "end", "×" .. frame.x.power)
    end
    if frame.y.power then
        out[#out + 1] = text_at(frame.left, frame.top - 7, 12, "start", "×" .. frame.y.power)
    end
end

local function colour_of(one, place)
    return COLOURS[((one.colour or place) - 1) % #COLOURS + 1]
end

-- Below the axes, where it can hide no data: two columns.
local function draw_legend(out, frame, series)
    for i, one in ipairs(series) do
        local x = frame.left + (i - 1) % 2 * (frame.right - frame.left) / 2
        local y = frame.bottom + BOTTOM + LEGEND_ROW * ((i - 1) // 2)
        local colour = colour_of(one, i)
        if one.style == "points" then
            out[#out + 1] = circle_at(x + 14, y, colour)
        else
            out[#out + 1] = line_at(x, y, x + 28, y, colour, 2)
        end
        out[#out + 1] = text_at(x + 36, y + 4, 12, "start", one.name)
    end
end

function svg_plot.draw(figure)
    local rows = (#figure.series + 1) // 2
    local height = HEIGHT + LEGEND_GAP + LEGEND_ROW * (rows - 1)
    local frame = { left = LEFT, right = WIDTH - RIGHT, top = TOP, bottom = HEIGHT - BOTTOM,
        x = axis_of(figure.series, "x", false), y = axis_of(figure.series, "y", figure.log_y) }
    local out = {
        string.format('<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d"'
            .. ' viewBox="0 0 %d %d" font-family="DejaVu Sans, Verdana, Arial, sans-serif"'
            .. ' fill="#222">', WIDTH, height, WIDTH, height),
        string.format('<rect width="%d" height="%d" fill="#ffffff"/>', WIDTH, height),
    }
    draw_axes(out, frame, figure)
    for i, one in ipairs(figure.series) do
        draw_series(out, one, places_of(one, frame, figure.log_y), colour_of(one, i))
    end
    draw_legend(out, frame, figure.series)
    out[#out + 1] = "</svg>\n"
    return table.concat(out, "\n")
end

return svg_plot
