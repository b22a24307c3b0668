-- rows.lua - the file of realisations: a line that tells the set, a line of names, and a line for each realisation.
--
--     # talus realisations 1: number 1000, seed 7, latin false, draws 1
--     row,error,friction,failed,volume
--     1,,34.2,true,3.25
--     2,"slope.lua:12: no block",36.1,,
--
-- Texts are in quotes, with a quote doubled; true and false are words; numbers are the shortest that read back the same. An
-- empty cell is a value that there is none of.
local arguments = require "talus.arguments"
local chance = require "talus.chance"

local fail = arguments.fail
local rows = {}

rows.MARK = "# talus realisations 1: "

-- `draws`: how many of the columns after row and error are draws; the others are what was measured.
function rows.head(number, seed, latin, draws)
    return ("%snumber %d, seed %d, latin %s, draws %d"):format(rows.MARK, number, seed, tostring(latin), draws)
end

-- {number =, seed =, latin =, draws =} of such a line; nil when it is none.
function rows.read_head(line)
    local number, seed, latin, draws = line:match(
        "^# talus realisations 1: number (%d+), seed (%-?%d+), latin (%a+), draws (%d+)$")
    return number and { number = math.tointeger(number), seed = math.tointeger(seed), latin = latin == "true",
        draws = math.tointeger(draws) }
end

-- A cell; nil and a sentence for a value that has none.
local function cell(value)
    if value == nil then
        return ""
    elseif type(value) == "number" then
        return chance.number_text(value)
    elseif type(value) == "boolean" then
        return tostring(value)
    elseif type(value) == "string" then
        return '"' .. value:gsub("[%c\127]", " "):gsub('"', '""') .. '"'
    end
    return nil
end
rows.cell = cell

-- The line of a realisation: values by the names of columns. The columns row and error come first.
function rows.line(row, sentence, columns, values)
    local cells = { tostring(row), cell(sentence) }
    for i = 3, #columns do
        cells[i] = cell(values[columns[i]])
    end
    return table.concat(cells, ",")
end

local WORDS = { ["true"] = true, ["false"] = false }

-- The cells of a line and their count; nil where there is none. nil for a line that is damaged.
function rows.cells(line)
    local cells, count, at = {}, 0, 1
    repeat
        count = count + 1
        if line:sub(at, at) == '"' then
            local close = at
            repeat
                close = line:find('"', close + 1, true)
                local twice = close and line:sub(close + 1, close + 1) == '"'
                if twice then
                    close = close + 1
                end
            until not twice
            if not close then
                return nil
            end
            cells[count] = line:sub(at + 1, close - 1):gsub('""', '"')
            at = close + 1
        else
            local text = line:match("^[^,]*", at)
            at = at + #text
            if text ~= "" then
                if WORDS[text] ~= nil then
                    cells[count] = WORDS[text]
                else
                    cells[count] = tonumber(text) or text == "nan" and 0 / 0 or text == "inf" and math.huge or
                        text == "-inf" and -math.huge or nil
                    if cells[count] == nil then
                        return nil
                    end
                end
            end
        end
        local next = line:sub(at, at)
        at = at + 1
        if next ~= "," and next ~= "" then
            return nil
        end
    until next == ""
    return cells, count
end

-- A realisation of its line: {row =, error =, NAME = value}; nil when the line is damaged.
function rows.read(line, columns)
    local cells, count = rows.cells(line)
    if not cells or count ~= #columns or math.type(cells[1]) ~= "integer" then
        return nil
    end
    local row = {}
    for i = 1, count do
        row[columns[i]] = cells[i]
    end
    return row
end

-- The line of names, which are quoted where they would be taken for something else.
function rows.names(columns)
    local cells = {}
    for i, name in ipairs(columns) do
        cells[i] = name:find "^[%a_][%w_ .%-]*$" and name or cell(name)
    end
    return table.concat(cells, ",")
end

function rows.read_names(line)
    local columns = {}
    line = line .. ","
    local at = 1
    while at <= #line do
        local quoted, after = line:match('^"([^"]*)",()', at)
        local name = quoted
        if not quoted then
            name, after = line:match("^([^,]*),()", at)
        end
        columns[#columns + 1] = name
        at = after
    end
    return columns
end

-- The parts of a file's text: {head =, first =, names =, columns =, lines =, bytes = of whole lines}. nil when it has no line of names yet: an end
-- has come before. Raises for a file of something else.
function rows.parts(where, path, text)
    local whole = text:match("^.*\n") or ""
    local lines = {}
    for line in whole:gmatch "(.-)\n" do
        lines[#lines + 1] = line
    end
    local first = lines[1] or text
    if first:sub(1, #rows.MARK) ~= rows.MARK:sub(1, #first) or (lines[1] and not rows.read_head(first)) then
        fail("%s: '%s' is no file of realisations: give another name, or delete it", where, path)
    end
    if #lines < 2 then
        return nil
    end
    return { head = rows.read_head(first), first = first, names = lines[2], columns = rows.read_names(lines[2]), lines = table.move(lines, 3, #lines, 1, {}),
        bytes = #whole }
end

return rows
