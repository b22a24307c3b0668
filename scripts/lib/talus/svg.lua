-- svg.lua - pages of SVG. The same calls give the same bytes: coordinates have two decimals, nothing comes from a clock.
local arguments = require "talus.arguments"

local svg = {}

-- Colours that people with any colour vision tell apart (Okabe and Ito), the darker ones first.
svg.colours = { "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000" }

local FONT = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif"
-- Mean width of a letter over the size of its font, for room that texts need.
local LETTER = 0.62

-- Text as it stands in XML. Bytes that are no UTF-8 and control characters become question marks.
function svg.escape(text)
    if not utf8.len(text) then
        text = text:gsub("[\128-\255]", "?")
    end
    return (text:gsub("[%c\127]", "?"):gsub("[&<>\"']",
        { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;", ['"'] = "&quot;", ["'"] = "&apos;" }))
end

-- A coordinate: two decimals at most, and no "-0".
function svg.number(value)
    local text = arguments.decimal("%.2f", value):gsub("%.?0+$", "")
    return text == "-0" and "0" or text
end
local number = svg.number

function svg.text_width(text, size)
    return (utf8.len(text) or #text) * LETTER * size
end

local page = {}
page.__index = page

function svg.page(width, height)
    local self = setmetatable({ lines = {} }, page)
    self:add('<svg xmlns="http://www.w3.org/2000/svg" width="%s" height="%s" viewBox="0 0 %s %s" font-family="%s">',
        number(width), number(height), number(width), number(height), FONT)
    self:add('<rect width="%s" height="%s" fill="#ffffff"/>', number(width), number(height))
    return self
end

function page:add(format, ...)
    self.lines[#self.lines + 1] = string.format(format, ...)
end

function page:line(x1, y1, x2, y2, style)
    self:add('<path d="M%s %sL%s %s" %s/>', number(x1), number(y1), number(x2), number(y2), style)
end

-- A polyline through points {x, y, x, y, ...}; nothing for fewer than two.
function page:polyline(points, style)
    if #points < 4 then
        return
    end
    local parts = { "M", number(points[1]), " ", number(points[2]) }
    for i = 3, #points, 2 do
        parts[#parts + 1] = "L" .. number(points[i]) .. " " .. number(points[i + 1])
    end
    self:add('<path d="%s" fill="none" %s/>', table.concat(parts), style)
end

-- anchor: "start", "middle" or "end". `style`: further attributes, or nil. `markup`: the text is markup already.
function page:text(x, y, size, anchor, text, style, markup)
    self:add('<text x="%s" y="%s" font-size="%s" text-anchor="%s"%s>%s</text>', number(x), number(y), number(size),
        anchor, style and " " .. style or "", markup and text or svg.escape(text))
end

-- Symbols about a point, by number: circle, square, triangle, diamond, inverted triangle.
local corners = {
    false,
    { -0.85, -0.85, 0.85, -0.85, 0.85, 0.85, -0.85, 0.85 },
    { 0, -1.15, 1, 0.75, -1, 0.75 },
    { 0, -1.2, 1.2, 0, 0, 1.2, -1.2, 0 },
    { 0, 1.15, 1, -0.75, -1, -0.75 },
}
svg.symbols = #corners

function page:symbol(which, x, y, radius, style)
    local shape = corners[(which - 1) % #corners + 1]
    if not shape then
        self:add('<circle cx="%s" cy="%s" r="%s" %s/>', number(x), number(y), number(radius), style)
        return
    end
    local parts = {}
    for i = 1, #shape, 2 do
        parts[#parts + 1] = number(x + radius * shape[i]) .. " " .. number(y + radius * shape[i + 1])
    end
    self:add('<path d="M%sZ" %s/>', table.concat(parts, "L"), style)
end

function page:finish()
    return table.concat(self.lines, "\n") .. "\n</svg>\n"
end

return svg
