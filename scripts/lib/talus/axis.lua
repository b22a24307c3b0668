-- axis.lua - axes of plots: their range, ticks at round numbers, labels, and where a value lies on the page.
local arguments = require "talus.arguments"
local svg = require "talus.svg"

local fail = arguments.fail
local axis = {}
axis.__index = axis

local KEYS = { "log", "name", "range", "unit" }
-- Largest numbers that are drawn: differences of larger ones may not be finite.
local FARTHEST = 1e300
-- A logarithmic axis ends there: smaller numbers have fewer digits.
local LEAST = 1e-307
-- Values out of the range are drawn at most so many ranges away.
local FAR = 1000

local SUPERSCRIPTS = { ["-"] = "⁻", ["0"] = "⁰", ["1"] = "¹", ["2"] = "²", ["3"] = "³", ["4"] = "⁴", ["5"] = "⁵",
    ["6"] = "⁶", ["7"] = "⁷", ["8"] = "⁸", ["9"] = "⁹" }

local function power(exponent)
    return "10" .. tostring(exponent):gsub(".", SUPERSCRIPTS)
end

-- 10^n; exact where the table of decimal numbers is.
local function ten(n)
    return tonumber("1e" .. n)
end

-- The largest n with 10^n <= value.
local function magnitude(value)
    value = math.max(1e-307, math.min(value, 1e308)) -- powers of ten that are numbers with all digits
    local n = math.floor(math.log(value, 10) + 0.5)
    while ten(n) > value do
        n = n - 1
    end
    while ten(n + 1) <= value do
        n = n + 1
    end
    return n
end

-- ------------------------------------------------------------------ what the script says

function axis.read(where, given, key, default)
    local value = given[key]
    if value == nil then
        value = default
    elseif type(value) == "string" then
        value = { name = value }
    end
    where = where .. ", " .. key
    arguments.table(where, value, "the axis")
    arguments.check_keys(where, value, KEYS)
    local self = setmetatable({}, axis)
    self.name = arguments.text(where, value, "name", default.name)
    self.unit = arguments.text(where, value, "unit", value.name == nil and default.unit or "")
    self.log = arguments.boolean(where, value, "log", false)
    local range = value.range
    if range ~= nil then
        if type(range) ~= "table" or #range ~= 2 or type(range[1]) ~= "number" or type(range[2]) ~= "number" then
            fail("%s: range must be a list of two numbers", where)
        end
        self.low, self.high = range[1] + 0.0, range[2] + 0.0
        if not (self.low < self.high and self.low >= -FARTHEST and self.high <= FARTHEST) then
            fail("%s: range = {%s, %s} must ascend and be finite", where, range[1], range[2])
        end
        if self.log and self.low < LEAST then
            fail("%s: range = {%s, %s} of a logarithmic axis must be above 0, from %s on", where, range[1], range[2], LEAST)
        end
        self.given = true
    end
    self.where = where
    return self
end

-- Whether a number can be drawn on the axis.
function axis:takes(value)
    return value == value and value >= -FARTHEST and value <= FARTHEST and (not self.log or value >= LEAST)
end

-- ------------------------------------------------------------------ range

function axis:pad(share)
    local low, high = self.low, self.high
    if self.log then
        low, high = math.log(low, 10), math.log(high, 10)
    end
    local room = share * (high - low)
    if high - low <= 1e-12 * math.max(math.abs(low), math.abs(high)) then
        room = self.log and 0.5 or (high ~= 0 and 0.1 * math.abs(high) or 1)
    end
    low, high = low - room, high + room
    if self.log then
        low, high = math.max(10.0 ^ low, LEAST), 10.0 ^ high
    end
    self.low, self.high = math.max(low, -FARTHEST), math.min(high, FARTHEST)
end

-- Finds the ranges from all points that can be drawn on both axes.
function axis.fit(x_axis, y_axis, series)
    local ranges, marked = { {}, {} }, false -- some points are drawn as symbols
    for _, one in ipairs(series) do
        marked = marked or one.style == "points" or one.style == "both"
        for i = 1, #one.y do
            local point = { one.x[i], one.y[i] }
            if x_axis:takes(point[1]) and y_axis:takes(point[2]) then
                for k, r in ipairs(ranges) do
                    r.low = math.min(r.low or point[k], point[k])
                    r.high = math.max(r.high or point[k], point[k])
                end
            end
        end
    end
    if not ranges[1].low then
        fail("plot: no series has a point that can be drawn%s", (x_axis.log or y_axis.log) and
            ": a logarithmic axis takes numbers above 0 only" or ": the lists are empty or not of finite numbers")
    end
    for k, self in ipairs { x_axis, y_axis } do
        if not self.given then
            self.low, self.high = ranges[k].low, ranges[k].high
            if not self.log and self.low > 0 and self.low < 0.05 * self.high then
                self.low = 0
            end
            self:pad(k == 2 and 0.05 or marked and 0.03 or 0.0)
        end
    end
end

-- ------------------------------------------------------------------ ticks

-- The round step (1, 2 or 5 times a power of ten) that makes about `count` of a length: its figure and its power.
local function round_step(length, count)
    local rough = length / math.max(count, 1)
    local n = magnitude(rough)
    for _, figure in ipairs { 1, 2, 5 } do
        if figure * ten(n) >= 0.75 * rough then
            return figure, n
        end
    end
    return 1, n + 1
end

-- Ticks at whole multiples of the step. Numbers far from 1 are shown in a power of ten, which goes to the axis's name.
function axis:mark_linear(count)
    local largest = math.max(math.abs(self.low), math.abs(self.high))
    local shown = magnitude(largest)
    self.power = (shown >= 5 or shown <= -3) and 3 * (shown // 3) or 0
    local figure, n = round_step(self.high - self.low, count)
    local step = figure * ten(n)
    local decimals = math.max(0, self.power - n)
    for i = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9) do
        local whole = i * figure -- in units of 10^n
        local value = n >= 0 and whole * ten(n) or whole / ten(-n)
        local k = n - self.power
        local label = arguments.decimal("%." .. decimals .. "f", k >= 0 and whole * ten(k) or whole / ten(-k))
        self.ticks[#self.ticks + 1] = { value = value, label = (label:gsub("^%-", "−")), width = utf8.len(label) }
    end
end

function axis:mark_log(count)
    self.power = 0
    local first, last = magnitude(self.low), magnitude(self.high)
    local each = math.max(1, math.ceil((last - first) / math.max(count, 1)))
    local figures = last - first <= 2 and { 1, 2, 5 } or { 1 }
    for n = first, last do
        for _, figure in ipairs(figures) do
            local value = figure * ten(n)
            if n % each == 0 and value >= self.low * (1 - 1e-9) and value <= self.high * (1 + 1e-9) then
                local head = figure > 1 and figure .. "·10" or "10"
                local exponent = tostring(n):gsub("^%-", "−")
                self.ticks[#self.ticks + 1] = {
                    value = value, width = utf8.len(head) + 0.8 * utf8.len(exponent),
                    label = string.format('%s<tspan dy="-4" font-size="9">%s</tspan>', head, exponent),
                }
            end
        end
    end
end

-- Makes about `count` ticks, up to twice as many of powers of ten.
function axis:mark(count)
    self.ticks = {}
    if self.log then
        self:mark_log(2 * count)
    end
    if #self.ticks < 2 then -- a part of a decade has no powers of ten
        self.ticks = {}
        self:mark_linear(count)
    end
end

function axis:label_width(size)
    local widest = 0
    for _, tick in ipairs(self.ticks) do
        widest = math.max(widest, tick.width)
    end
    return widest * svg.text_width("0", size)
end

-- "time (s)", "kinetic (10³ J)"
function axis:label()
    local unit = self.unit
    if self.power ~= 0 then
        unit = power(self.power) .. (unit ~= "" and " " .. unit or "")
    end
    if unit == "" then
        return self.name
    end
    return self.name .. (self.name ~= "" and " " or "") .. "(" .. unit .. ")"
end

-- ------------------------------------------------------------------ places

-- From now on the range lies between two coordinates of the page.
function axis:span(first, last)
    self.first, self.last = first, last
end

-- The coordinate of a value, nil where it cannot be drawn. The page cuts off what lies out of the range.
function axis:place(value)
    if not self:takes(value) then
        return nil
    end
    local low, high = self.low, self.high
    if self.log then
        value, low, high = math.log(value, 10), math.log(low, 10), math.log(high, 10)
    end
    local share = (value - low) / (high - low)
    share = math.max(-FAR, math.min(FAR, share))
    return self.first + share * (self.last - self.first)
end

return axis
