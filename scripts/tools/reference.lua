-- reference.lua - writes the generated part of docs/lua.md from what `talus help` prints, which comes
-- from the very tables that check a script; so the reference cannot say otherwise than the program.
--
--     build/release/talus scripts/tools/reference.lua docs/lua.md            writes it anew
--     build/release/talus scripts/tools/reference.lua docs/lua.md --check    fails when it is out of date
--
-- What stands above the line MARK is written by hand and kept. Only the plugins that belong to the
-- program are listed: TALUS_PLUGIN_PATH is not heeded.

local MARK = "<!-- Below this line: written by scripts/tools/reference.lua. -->"
-- Column in which the help begins the text beside a name.
local TEXT_COLUMN = 21
local KINDS = { Laws = "law", Dampings = "damping", Generators = "generator" }

local function help(topic)
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

-- Sections of a topic: the head (usage and what it does), then titles with their rows.
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
local function split_parameter(text)
    for i = 1, #text do
        local kind = table.concat(text, " ", 1, i)
        if kind:match("required$") or kind:match("may be left out$") or kind:match("default .+$") then
            return kind, table.concat(text, " ", i + 1)
        end
    end
    return text[1], table.concat(text, " ", 2)
end

local function cell(text)
    return (text:gsub("|", "\\|"))
end

local function write_section(out, section)
    out[#out + 1] = "\n" .. section.title .. ":\n"
    if section.title == "Parameters" then
        out[#out + 1] = "| parameter | type, unit, range, default | meaning |\n| --- | --- | --- |"
        for _, row in ipairs(section.rows) do
            local kind, meaning = split_parameter(row.text)
            out[#out + 1] = ("| `%s` | %s | %s |"):format(row.name, cell(kind), cell(meaning))
        end
        return
    end
    out[#out + 1] = "| | |\n| --- | --- |"
    for _, row in ipairs(section.rows) do
        local text = row.text
        if text[1]:match("^list of") and text[2] then
            text[1] = text[1] .. ":"
        end
        out[#out + 1] = ("| `%s` | %s |"):format(row.name, cell(table.concat(text, " ")))
    end
end

local function is_kind(line)
    return line:match("^law '") or line:match("^damping '") or line:match("^generator '")
end

-- A function's help, without that of a plugin of the same name.
local function write_function(out, name)
    local lines, last = help(name), nil
    for i, line in ipairs(lines) do
        last = last or (is_kind(line) and i - 1)
    end
    local topic = read_topic(lines, 1, last or #lines)
    out[#out + 1] = ("\n### %s\n\n```lua\n%s\n```\n\n%s"):format(name, topic.head[1],
        table.concat(topic.head, " ", 2))
    for _, section in ipairs(topic.sections) do
        if not section.title:match("loaded") then
            write_section(out, section)
        end
    end
end

local function write_kind(out, type, name)
    local lines = help(name)
    local first = 1
    while lines[first] ~= ("%s '%s'"):format(type, name) do
        first = first + 1
    end
    local last = first
    while lines[last + 1] and not is_kind(lines[last + 1]) do
        last = last + 1
    end
    local topic = read_topic(lines, first, last)
    out[#out + 1] = ("\n### %s `%s`\n\n%s"):format(type, name, table.concat(topic.head, " ", 2))
    for _, section in ipairs(topic.sections) do
        write_section(out, section)
    end
end

local function reference()
    local out = {}
    local overview = read_topic(help(""), 1, #help(""))
    for _, section in ipairs(overview.sections) do
        out[#out + 1] = "\n## " .. section.title
        for _, row in ipairs(section.rows) do
            if section.title == "Functions" then
                write_function(out, row.name)
            else
                write_kind(out, KINDS[section.title], row.name)
            end
        end
    end
    return table.concat(out, "\n") .. "\n"
end

local function read_file(path)
    local file = assert(io.open(path))
    local text = file:read("a")
    file:close()
    return text
end

local path, option = ...
if not path or (option and option ~= "--check") then
    error("usage: talus scripts/tools/reference.lua FILE.md [--check]", 0)
end
local old = read_file(path)
local from, to = old:find(MARK, 1, true)
assert(from, path .. " has no line " .. MARK)
local new = old:sub(1, to) .. "\n" .. reference()
if option == "--check" then
    assert(old == new, path .. " is out of date: run scripts/tools/reference.lua " .. path)
elseif old ~= new then
    local file = assert(io.open(path, "w"))
    assert(file:write(new))
    assert(file:close())
end
