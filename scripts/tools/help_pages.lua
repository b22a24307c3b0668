-- help_pages.lua - reads the pages that `talus help` prints, for the tools that write docs/lua.md and scripts/meta.
--
-- A topic is { head = lines, sections = { { title =, rows = { { name =, text = lines } } } } }. Only the plugins that belong
-- to the program are listed: TALUS_PLUGIN_PATH is not heeded.
local pages = {}

-- Column in which the help begins the text beside a name.
local TEXT_COLUMN = 21
-- Titles of the overview, and what the plugins under them are.
pages.kinds = { Laws = "law", Dampings = "damping", Generators = "generator", Screens = "screen", Solids = "solid", Elements = "element" }

function pages.print(topic)
    local program = os.getenv("TALUS_PROGRAM") or "build/release/talus"
    local pipe = assert(io.popen("env -u TALUS_PLUGIN_PATH " .. program .. " help " .. topic))
    local lines = {}
    for line in pipe:lines() do
        lines[#lines + 1] = line
    end
    assert(pipe:close(), "talus help " .. topic .. " failed")
    return lines
end

-- The name in a row of the help and the text beside it; a name too long for its column stands alone.
local function split_row(line)
    local name = line:sub(3, TEXT_COLUMN - 1)
    local short = name:sub(-1) == " " and select(2, name:gsub("[%({]", "")) ==
                      select(2, name:gsub("[%)}]", ""))
    if #line < TEXT_COLUMN or not short then
        return line:sub(3), {}
    end
    return name:match("^(.-)%s*$"), { line:sub(TEXT_COLUMN) }
end

-- A section of the help as a list of rows { name, lines of text }.
local function read_rows(lines, at)
    local rows = {}
    while lines[at] and lines[at] ~= "" do
        if lines[at]:match("^  %S") then
            local name, text = split_row(lines[at])
            rows[#rows + 1] = { name = name, text = text }
        else
            table.insert(rows[#rows].text, lines[at]:match("^%s*(.*)$"))
        end
        at = at + 1
    end
    return rows, at
end

-- Sections of lines[first] to lines[last]: the head (usage and what it does), then titles with their rows.
local function read_topic(lines, first, last)
    local topic = { head = {}, sections = {} }
    local at = first
    while at <= last do
        local title = lines[at]:match("^(%u.*):$")
        if title then
            local section = { title = title }
            section.rows, at = read_rows(lines, at + 1)
            table.insert(topic.sections, section)
        else
            if lines[at] ~= "" then
                table.insert(topic.head, (lines[at]:gsub("^%s+", "")))
            end
            at = at + 1
        end
    end
    return topic
end

-- What a parameter is (type, unit, range, default), and what it is for. The first ends with "required",
-- "may be left out" or a default; where it has none of these it is the first line.
function pages.split_parameter(text)
    for i = 1, #text do
        local kind = table.concat(text, " ", 1, i)
        if kind:match("required$") or kind:match("may be left out$") or kind:match("default .+$") then
            return kind, table.concat(text, " ", i + 1)
        end
    end
    return text[1], table.concat(text, " ", 2)
end

-- What a row is (type, unit), or nil when it does not say, and what it is for.
function pages.split_row(section, row)
    if section.title == "Parameters" then
        return pages.split_parameter(row.text)
    elseif section.title:match "^Fields of a " or section.title:match "^Keys of a " then
        return row.text[1], table.concat(row.text, " ", 2)
    end
    return nil, table.concat(row.text, " ")
end

local function is_kind(line)
    return line:match("^law '") or line:match("^damping '") or line:match("^generator '") or line:match("^screen '") or
        line:match("^solid '") or line:match("^element '")
end

-- The topics and plugins in the order of the overview: sections { title =, rows = }.
function pages.overview()
    local lines = pages.print("")
    return read_topic(lines, 1, #lines).sections
end

-- A function's help, without that of a plugin of the same name.
function pages.topic(name)
    local lines, last = pages.print(name), nil
    for i, line in ipairs(lines) do
        last = last or (is_kind(line) and i - 1)
    end
    return read_topic(lines, 1, last or #lines)
end

-- A plugin's help: type is "law", "damping", "generator", "screen", "solid" or "element".
function pages.plugin(type, name)
    local lines, first = pages.print(name), 1
    while lines[first] ~= ("%s '%s'"):format(type, name) do
        first = first + 1
        assert(lines[first], ("talus help %s tells of no %s"):format(name, type))
    end
    local last = first
    while lines[last + 1] and not is_kind(lines[last + 1]) do
        last = last + 1
    end
    return read_topic(lines, first, last)
end

function pages.read_file(path)
    local file = assert(io.open(path))
    local text = file:read("a")
    file:close()
    return text
end

-- Writes the text, or with "--check" as the option fails when the file holds another.
function pages.renew(path, new, option, tool)
    local file = io.open(path)
    local old = file and file:read("a")
    if file then
        file:close()
    end
    if option == "--check" then
        assert(old == new, path .. " is out of date: run " .. tool .. " " .. path)
    elseif old ~= new then
        file = assert(io.open(path, "w"))
        assert(file:write(new))
        assert(file:close())
    end
end

-- The same of the part of a page below the line `mark`, which make() gives; what stands above is kept.
function pages.renew_below(mark, make, tool, path, option)
    if not path or (option and option ~= "--check") then
        error("usage: talus " .. tool .. " FILE.md [--check]", 0)
    end
    local old = pages.read_file(path)
    local _, to = old:find(mark, 1, true)
    assert(to, path .. " has no line " .. mark)
    pages.renew(path, old:sub(1, to) .. "\n" .. make(), option, tool)
end

return pages
