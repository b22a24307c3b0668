-- reference.lua - writes the generated part of docs/lua.md from what `talus help` prints, which comes
-- from the very tables that check a script; so the reference cannot say otherwise than the program.
--
--     build/release/talus scripts/tools/reference.lua docs/lua.md            writes it anew
--     build/release/talus scripts/tools/reference.lua docs/lua.md --check    fails when it is out of date
--
-- What stands above the line MARK is written by hand and kept.
package.path = arg[0]:match("^(.-)[^/]*$") .. "?.lua;" .. package.path
local pages = require "help_pages"

local MARK = "<!-- Below this line: written by scripts/tools/reference.lua. -->"

local function cell(text)
    return (text:gsub("|", "\\|"))
end

local function write_section(out, section)
    out[#out + 1] = "\n" .. section.title .. ":\n"
    local typed = pages.split_row(section, section.rows[1]) ~= nil
    if typed then
        out[#out + 1] = section.title == "Parameters" and
            "| parameter | type, unit, range, default | meaning |\n| --- | --- | --- |" or
            "| field | type, unit | meaning |\n| --- | --- | --- |"
    else
        out[#out + 1] = "| | |\n| --- | --- |"
    end
    for _, row in ipairs(section.rows) do
        local kind, meaning = pages.split_row(section, row)
        out[#out + 1] = typed and ("| `%s` | %s | %s |"):format(row.name, cell(kind), cell(meaning)) or
            ("| `%s` | %s |"):format(row.name, cell(meaning))
    end
end

local function write_function(out, name)
    local topic = pages.topic(name)
    out[#out + 1] = ("\n### %s\n\n```lua\n%s\n```\n\n%s"):format(name, topic.head[1],
        table.concat(topic.head, " ", 2))
    for _, section in ipairs(topic.sections) do
        if not section.title:match("loaded") then
            write_section(out, section)
        end
    end
end

local function write_kind(out, type, name)
    local topic = pages.plugin(type, name)
    out[#out + 1] = ("\n### %s `%s`\n\n%s"):format(type, name, table.concat(topic.head, " ", 2))
    for _, section in ipairs(topic.sections) do
        write_section(out, section)
    end
end

local function reference()
    local out = {}
    for _, section in ipairs(pages.overview()) do
        out[#out + 1] = "\n## " .. section.title
        for _, row in ipairs(section.rows) do
            if section.title == "Functions" then
                write_function(out, row.name)
            else
                write_kind(out, pages.kinds[section.title], row.name)
            end
        end
    end
    return table.concat(out, "\n") .. "\n"
end

pages.renew_below(MARK, reference, "scripts/tools/reference.lua", ...)
