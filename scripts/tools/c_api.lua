-- c_api.lua - writes the generated part of docs/c_api.md from the comments of the public headers. A function without a comment is an
-- error.
--
--     build/release/talus scripts/tools/c_api.lua docs/c_api.md            writes it anew
--     build/release/talus scripts/tools/c_api.lua docs/c_api.md --check    fails when it is out of date
--
-- What stands above the line MARK is written by hand and kept.
package.path = arg[0]:match("^(.-)[^/]*$") .. "?.lua;" .. package.path
local pages = require "help_pages"

local MARK = "<!-- Below this line: written by scripts/tools/c_api.lua. -->"
local FOLDER = "core/include/talus/"
local HEADERS = { "talus", "boundary", "fields", "history", "keyblocks", "settings", "state", "output", "view", "views", "watch", "values", "defaults",
    "plugins", "types", "check", "law_test", "solid_test" }

-- Text of a comment as Markdown. Lines that stand further in, as in a list or a formula, stay lines.
local function prose(comment)
    local lines = {}
    for line in (comment .. "\n"):gmatch("(.-)\n") do
        line = line:gsub("^%s*/%*+ ?", ""):gsub("%s*%*/%s*$", ""):gsub("^%s*%*%s?", "")
        lines[#lines + 1] = line:match("^    ") and line or line:gsub("([*<|])", "\\%1")
    end
    return (table.concat(lines, "\n"):gsub("^%s+", ""):gsub("%s+$", ""))
end

-- The declarations of a header: { comment =, code = }, and { section = } where one begins. A comment belongs to the declaration that follows it
-- at once; code goes on to the end of its block.
local function read(lines)
    local items, at, comment = {}, 1, nil
    while lines[at] do
        local line = lines[at]
        local section = line:match("^/%* %-%-%-+ (.-) %-+ %*/$")
        if section then
            items[#items + 1], comment = { section = section }, nil
        elseif line:match("^/%*") then
            local first = at
            while not lines[at]:find("*/", 1, true) do
                at = at + 1
            end
            comment = table.concat(lines, "\n", first, at)
        elseif line:match("^TL_API") or line:match("^typedef") or line:match("^static inline") then
            local first, braces, inline = at, 0, line:match("^static inline")
            while true do
                for brace in lines[at]:gsub("/%*.-%*/", ""):gmatch "[{}]" do
                    braces = braces + (brace == "{" and 1 or -1)
                end
                local text = lines[at]
                if braces == 0 and (text:match(";%s*$") or text:match(";%s*/%*.*$") or (inline and text == "}")) then
                    break
                end
                at = at + 1
            end
            local code = table.concat(lines, "\n", first, at)
            items[#items + 1], comment = { comment = comment, code = inline and code:match("^(.-)\n{") .. ";" or code }, nil
        elseif line:match("^%s*$") then
            comment = nil
        end
        at = at + 1
    end
    return items
end

local function name_of(code)
    return code:match("^typedef[^{]*}%s*([%w_]+);%s*$") or code:match("}%s*([%w_]+);%s*$") or code:match("%(%*([%w_]+)%)%(") or
        code:match("([%w_]+)%(") or code:match("([%w_]+);")
end

local function write_header(out, header, undocumented)
    local text = pages.read_file(FOLDER .. header .. ".h")
    local lines = {}
    for line in text:gmatch("([^\n]*)\n") do
        lines[#lines + 1] = line
    end
    local head = text:match("^(/%*.-%*/)")
    out[#out + 1] = ("\n## talus/%s.h\n\n%s"):format(header, prose(head):gsub("^talus/%S+ %- ", "", 1):gsub("^%l", string.upper))
    for _, item in ipairs(read(lines)) do
        if item.section then
            out[#out + 1] = "\n### " .. item.section:gsub("^%l", string.upper)
        elseif not item.code:match("^typedef struct [%w_]+ [%w_]+;$") then
            local name = name_of(item.code)
            if not item.comment and item.code:match("^TL_API") then
                undocumented[#undocumented + 1] = header .. ".h: " .. name
            end
            local code = item.code:gsub("^TL_API ", ""):gsub("^static inline ", "")
            out[#out + 1] = ("\n#### `%s`\n\n```C\n%s\n```%s"):format(name, code, item.comment and "\n\n" .. prose(item.comment) or "")
        end
    end
end

local function all()
    local out, undocumented = {}, {}
    for _, header in ipairs(HEADERS) do
        write_header(out, header, undocumented)
    end
    if #undocumented > 0 then
        error("functions without a comment: " .. table.concat(undocumented, ", "), 0)
    end
    return table.concat(out, "\n") .. "\n"
end

pages.renew_below(MARK, all, "scripts/tools/c_api.lua", ...)
