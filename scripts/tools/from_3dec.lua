-- from_3dec.lua - writes the tables of docs/from_3dec.md from those by which data files are converted.
--
--     build/release/talus scripts/tools/from_3dec.lua docs/from_3dec.md            writes them anew
--     build/release/talus scripts/tools/from_3dec.lua docs/from_3dec.md --check    fails when they are out of date
--
-- What stands above the line MARK is written by hand and kept.
package.path = arg[0]:match("^(.-)[^/]*$") .. "?.lua;" .. package.path
local pages = require "help_pages"
require "talus"
local joints = require "talus.threedec.joints"
local range = require "talus.threedec.range"
local words = require "talus.threedec.words"

local MARK = "<!-- Below this line: written by scripts/tools/from_3dec.lua. -->"

local function cell(text)
    return (text:gsub("|", "\\|"))
end

local function prose(text)
    return (cell(text):gsub("%*", "\\*"))
end

local function coded(list)
    local texts = {}
    for i, text in ipairs(list) do
        texts[i] = "`" .. cell(text) .. "`"
    end
    return table.concat(texts, ", ")
end

local function table_of(out, title, head, rows)
    out[#out + 1] = ("\n## %s\n\n%s\n%s"):format(title, head, (head:gsub("[^|]+", " --- ")))
    table.move(rows, 1, #rows, #out + 1, out)
end

local function all()
    local converted, needless, lacks, properties = {}, {}, {}, {}
    for _, row in ipairs(words.rows) do
        if row.lacks then
            lacks[#lacks + 1] = ("| %s | %s |"):format(coded(row.commands), prose(row.lacks))
        elseif row.needless then
            needless[#needless + 1] = ("| %s | %s |"):format(coded(row.commands), prose(row.needless))
        else
            converted[#converted + 1] = ("| %s | %s | %s |"):format(coded(row.commands), row.form == "" and "" or coded { row.form }, prose(row.becomes))
        end
    end
    for _, row in ipairs(joints.properties) do
        properties[#properties + 1] = ("| `%s` | `%s` | `%s` |"):format(row[2], row[3], row[1])
    end

    local out = {}
    table_of(out, "Commands", "| 3DEC | form | Talus |", converted)
    table_of(out, "Joint properties", "| 3DEC 7 to 9 | classic | parameter of the law |", properties)
    out[#out + 1] = "\n## Ranges\n\nConverted: " .. coded(range.elements) .. "; with `not`, `union` and several that must all hold. Told as left out: " ..
        coded(range.lacks) .. "."
    table_of(out, "What Talus does by itself", "| 3DEC | why it needs nothing |", needless)
    table_of(out, "What has no counterpart", "| 3DEC | why |", lacks)
    return table.concat(out, "\n") .. "\n"
end

pages.renew_below(MARK, all, "scripts/tools/from_3dec.lua", ...)
