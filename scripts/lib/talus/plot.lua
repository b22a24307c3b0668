-- plot.lua - talus.plot{...}: lines of lists and histories as a picture in SVG.
local arguments = require "talus.arguments"
local axis = require "talus.axis"
local svg = require "talus.svg"

local fail = arguments.fail

local KEYS = { "file", "grid", "height", "histories", "legend", "model", "series", "title", "width", "x_axis", "y_axis" }
local SERIES_KEYS = { "against", "colour", "component", "history", "name", "style", "x", "y" }
local DASHES = { "", "7 3", "2 2.5", "8 3 2 3" }
local FONT_SIZE, TITLE_SIZE = 12, 14
local COMPONENTS = { "x", "y", "z" }

-- ------------------------------------------------------------------ what is drawn

-- A list of numbers; of histories the components, where their values are lists.
local function numbers(where, what, list)
    arguments.table(where, list, what)
    local floats = {} -- differences of whole numbers may wrap around
    for i = 1, #list do
        if type(list[i]) ~= "number" then
            fail("%s: %s[%d] must be a number, not %s", where, what, i, arguments.describe(list[i]))
        end
        floats[i] = list[i] + 0.0
    end
    return floats
end

local function is_history(value)
    return type(value) == "table" and type(value.cycle) == "table" and type(value.time) == "table" and
        type(value.value) == "table"
end

-- The place of a component of a history: 1 for "x".
local function component_of(where, given, width)
    local component = given.component
    for k, name in ipairs(COMPONENTS) do
        component = component == name and width == 3 and k or component
    end
    if math.type(component) ~= "integer" or component < 1 or component > width then
        fail("%s: component must be %sa whole number from 1 to %d, not %s", where,
            width == 3 and "\"x\", \"y\", \"z\" or " or "", width, arguments.describe(given.component))
    end
    return component
end

local function pick(values, component)
    local list = {}
    for i, value in ipairs(values) do
        list[i] = value[component]
    end
    return list
end

-- The series of a history: one, or one for each component when none is chosen.
local function history_series(where, given, into)
    local history = given.history
    if not is_history(history) then
        fail("%s: history must be one of model:histories(), not %s", where, arguments.describe(history))
    end
    local against = arguments.choice(where, given, "against", "time", { "time", "cycle" })
    local name = given.name or "history"
    local width = type(history.value[1]) == "table" and #history.value[1] or 0
    local first, last = 1, math.max(width, 1)
    if given.component ~= nil then
        if width == 0 then
            fail("%s: the history is of single numbers and has no component", where)
        end
        first = component_of(where, given, width)
        last = first
    end
    for k = first, last do
        local part = width > 0 and name .. "." .. (width == 3 and COMPONENTS[k] or k) or name
        into[#into + 1] = {
            x = history[against], y = width > 0 and pick(history.value, k) or history.value, against = against,
            name = last > first and part or given.name, style = given.style, colour = given.colour,
        }
    end
end

local function read_series(where, given, into)
    arguments.table(where, given, "the series")
    arguments.check_keys(where, given, SERIES_KEYS)
    if given.name ~= nil then
        arguments.text(where, given, "name")
    end
    arguments.choice(where, given, "style", "line", { "line", "points", "both" })
    if given.colour ~= nil and not arguments.text(where, given, "colour"):match("^#%x%x%x%x%x%x$") then
        fail("%s: colour = '%s' is not of the form '#0072b2'", where, given.colour)
    end
    if given.history ~= nil then
        if given.x ~= nil or given.y ~= nil then
            fail("%s: give either history or x and y", where)
        end
        return history_series(where, given, into)
    end
    for _, key in ipairs { "against", "component" } do
        if given[key] ~= nil then
            fail("%s: %s goes with history", where, key)
        end
    end
    if given.y == nil then
        fail("%s: give y, a list of numbers, or history", where)
    end
    local y = numbers(where, "y", given.y)
    local x = given.x and numbers(where, "x", given.x)
    if x and #x ~= #y then
        fail("%s: x has %d numbers and y %d", where, #x, #y)
    end
    if not x then
        x = {}
        for i = 1, #y do
            x[i] = i
        end
    end
    into[#into + 1] = { x = x, y = y, name = given.name, style = given.style, colour = given.colour }
end

-- The series of the model's histories: those named, or all in the order of their names.
local function model_series(given, into)
    local good, all = pcall(function() return given.model:histories() end)
    if not good then
        fail("plot: model must be a model, not %s", arguments.describe(given.model))
    end
    local names = {}
    for name in pairs(all) do
        names[#names + 1] = name
    end
    table.sort(names)
    if #names == 0 then
        fail("plot: the model has no history; make one with model:history{...}")
    end
    local wanted = given.histories or names
    if type(wanted) == "string" then
        wanted = { wanted }
    end
    arguments.table("plot", wanted, "histories")
    for _, name in ipairs(wanted) do
        if type(name) ~= "string" or not all[name] then
            fail("plot: the model has no history '%s' (it has: %s)", tostring(name), table.concat(names, ", "))
        end
        history_series("plot", { history = all[name], name = name }, into)
    end
end

local function all_series(given)
    local series = {}
    if given.series ~= nil then
        arguments.table("plot", given.series, "series")
        for i, one in ipairs(given.series) do
            read_series("plot, series " .. i, one, series)
        end
    end
    if given.model ~= nil then
        model_series(given, series)
    elseif given.histories ~= nil then
        fail("plot: histories names histories of a model: give model, too")
    end
    if #series == 0 then
        fail("plot: give series = {{x = {...}, y = {...}}, ...}, model or both")
    end
    return series
end

-- ------------------------------------------------------------------ the picture

-- Points in columns of half a pixel: of many that follow one another in one, the first, lowest, highest and last.
local function thin(points)
    local kept, i = {}, 1
    local function keep(k)
        kept[#kept + 1] = points[k]
        kept[#kept + 1] = points[k + 1]
    end
    while i <= #points do
        local column, low, high, last = points[i] * 2 // 1, i, i, i
        while points[last + 2] and points[last + 2] * 2 // 1 == column do
            last = last + 2
            low = points[last + 1] < points[low + 1] and last or low
            high = points[last + 1] > points[high + 1] and last or high
        end
        local order = { i, math.min(low, high), math.max(low, high), last }
        for k, at in ipairs(order) do
            if at ~= order[k - 1] then
                keep(at)
            end
        end
        i = last + 2
    end
    return kept
end

-- Stretches of points of a series that can be drawn, as lists {x, y, x, y, ...} on the page.
local function stretches(series, x_axis, y_axis)
    local list, current = {}, nil
    for i = 1, #series.y do
        local x, y = x_axis:place(series.x[i]), y_axis:place(series.y[i])
        if x and y then
            current = current or {}
            current[#current + 1] = x
            current[#current + 1] = y
        elseif current then
            list[#list + 1], current = current, nil
        end
    end
    list[#list + 1] = current
    return list
end

local function draw_series(page, series, x_axis, y_axis)
    for _, points in ipairs(stretches(series, x_axis, y_axis)) do
        points = thin(points)
        local style = series.style or "line"
        if style ~= "points" then
            page:polyline(points, string.format('stroke="%s" stroke-width="1.5" stroke-linejoin="round"%s', series.colour,
                series.dash ~= "" and ' stroke-dasharray="' .. series.dash .. '"' or ""))
        end
        if style ~= "line" or #points == 2 then
            for k = 1, #points, 2 do
                page:symbol(series.symbol, points[k], points[k + 1], 3, string.format('fill="%s"', series.colour))
            end
        end
    end
end

local function draw_frame(page, area, x_axis, y_axis, grid)
    for _, tick in ipairs(x_axis.ticks) do
        local x = x_axis:place(tick.value)
        if grid then
            page:line(x, area.top, x, area.bottom, 'stroke="#e2e2e2"')
        end
        page:line(x, area.bottom, x, area.bottom + 5, 'stroke="#000000"')
        page:text(x, area.bottom + 19, FONT_SIZE, "middle", tick.label, nil, true)
    end
    for _, tick in ipairs(y_axis.ticks) do
        local y = y_axis:place(tick.value)
        if grid then
            page:line(area.left, y, area.right, y, 'stroke="#e2e2e2"')
        end
        page:line(area.left - 5, y, area.left, y, 'stroke="#000000"')
        page:text(area.left - 8, y + 0.35 * FONT_SIZE, FONT_SIZE, "end", tick.label, nil, true)
    end
end

local function draw_names(page, area, x_axis, y_axis, title)
    if title ~= "" then
        page:text((area.left + area.right) / 2, area.top - 12, TITLE_SIZE, "middle", title, 'font-weight="bold"')
    end
    page:text((area.left + area.right) / 2, area.bottom + 40, FONT_SIZE, "middle", x_axis:label())
    local x, y = area.left - y_axis.room - 22, (area.top + area.bottom) / 2
    page:text(x, y, FONT_SIZE, "middle", y_axis:label(),
        string.format('transform="rotate(-90 %s %s)"', svg.number(x), svg.number(y)))
end

local function draw_legend(page, area, series)
    for i, one in ipairs(series) do
        local x, y = area.right + 16, area.top + 12 + 20 * (i - 1)
        if one.style ~= "points" then
            page:line(x, y, x + 26, y, string.format('stroke="%s" stroke-width="1.5"%s', one.colour,
                one.dash ~= "" and ' stroke-dasharray="' .. one.dash .. '"' or ""))
        end
        if one.style == "points" or one.style == "both" then
            page:symbol(one.symbol, x + 13, y, 3, string.format('fill="%s"', one.colour))
        end
        page:text(x + 32, y + 0.35 * FONT_SIZE, FONT_SIZE, "start", one.name)
    end
end

-- Colours, dashes and symbols; names where there are none.
local function dress(series)
    for i, one in ipairs(series) do
        local round = (i - 1) // #svg.colours
        one.colour = one.colour or svg.colours[(i - 1) % #svg.colours + 1]
        one.dash = DASHES[round % #DASHES + 1]
        one.symbol = i
        one.named = one.name ~= nil
        one.name = one.name or "series " .. i
    end
end

local function wants_legend(given, series)
    local named = false
    for _, one in ipairs(series) do
        named = named or one.named
    end
    return arguments.boolean("plot", given, "legend", #series > 1 or named)
end

-- Names of the axes when none are given.
local function default_names(series)
    local x, y = series[1].against, series[1].named and series[1].name or ""
    for _, one in ipairs(series) do
        x = one.against == x and x or nil
        y = one.name == y and y or ""
    end
    return { name = x or "", unit = x == "time" and "s" or "" }, { name = y, unit = "" }
end

local function draw(given)
    arguments.table("plot", given, "the argument")
    arguments.check_keys("plot", given, KEYS)
    local file = arguments.text("plot", given, "file")
    local series = all_series(given)
    dress(series)
    local width = arguments.number("plot", given, "width", 720, 200, 10000)
    local height = arguments.number("plot", given, "height", 440, 150, 10000)
    local title = arguments.text("plot", given, "title", "")
    local grid, legend = arguments.boolean("plot", given, "grid", true), wants_legend(given, series)
    local x_default, y_default = default_names(series)
    local x_axis = axis.read("plot", given, "x_axis", x_default)
    local y_axis = axis.read("plot", given, "y_axis", y_default)
    axis.fit(x_axis, y_axis, series)

    local area = { top = title ~= "" and 36 or 16, bottom = height - 56, right = width - 20 }
    if legend then
        local longest = 0
        for _, one in ipairs(series) do
            longest = math.max(longest, svg.text_width(one.name, FONT_SIZE))
        end
        area.right = math.max(width - longest - 62, width / 2)
    end
    y_axis:mark((area.bottom - area.top) / 60)
    y_axis.room = y_axis:label_width(FONT_SIZE)
    area.left = 36 + y_axis.room
    x_axis:mark((area.right - area.left) / 85)
    x_axis:span(area.left, area.right)
    y_axis:span(area.bottom, area.top)

    local page = svg.page(width, height)
    draw_frame(page, area, x_axis, y_axis, grid)
    local box = string.format('x="%s" y="%s" width="%s" height="%s"', svg.number(area.left), svg.number(area.top),
        svg.number(area.right - area.left), svg.number(area.bottom - area.top))
    page:add('<clipPath id="area"><rect %s/></clipPath>', box)
    page:add('<g clip-path="url(#area)">')
    for _, one in ipairs(series) do
        draw_series(page, one, x_axis, y_axis)
    end
    page:add('</g>')
    page:add('<rect %s fill="none" stroke="#000000"/>', box)
    draw_names(page, area, x_axis, y_axis, title)
    if legend then
        draw_legend(page, area, series)
    end
    arguments.write("plot", file, page:finish())
end

return arguments.call(draw)
