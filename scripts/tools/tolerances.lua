-- tolerances.lua - writes docs/tolerances.md from the comments above the constants of core. A constant without such a comment is an error.
--
--     build/release/talus scripts/tools/tolerances.lua docs/tolerances.md            writes it anew
--     build/release/talus scripts/tools/tolerances.lua docs/tolerances.md --check    fails when it is out of date
--
-- A comment that stands right above one or several lines of #define begins with what they are, one of KINDS, and may end with the tests that
-- fail without them:
--
--     /* Tolerance: gap at which two flush faces become a contact, relative to the size. Test: unit/test_contact. */
--     #define TL_CONTACT_TOLERANCE 1e-3
--
-- Every #define whose value has a decimal point, an exponent or an EPSILON needs one. A literal of twelve digits or more is mathematics and
-- needs none. Whole numbers may have one. What stands above the line MARK is written by hand and kept.
package.path = arg[0]:match("^(.-)[^/]*$") .. "?.lua;" .. package.path
local pages = require "help_pages"

local MARK = "<!-- Below this line: written by scripts/tools/tolerances.lua. -->"
-- What a comment may begin with, and whether the page tells of it.
local KINDS = { Tolerance = true, Limit = true, Default = true, ["Cost only"] = true, Constant = false }
local SUFFIXES = { ".c", ".lua", ".py" }

local function sources()
    local list = {}
    local pipe = assert(io.popen("LC_ALL=C; export LC_ALL; find core -name '*.[ch]' | sort"))
    for path in pipe:lines() do
        list[#list + 1] = path
    end
    assert(pipe:close() and #list > 0, "no sources in core: run this in the root of the source tree")
    return list
end

-- Whether a value must say what it is: "1e-9", "(16.0 / 68)", "(8 * DBL_EPSILON)".
local function is_measured(value)
    value = value:gsub('".-"', "")
    for literal in value:gmatch("%f[%w.][%d.]+[eE]?[-+]?%d*") do
        local digits = literal:gsub("[eE].*$", ""):gsub("%.", "")
        if #digits < 12 and literal:find("[.eE]") then
            return true
        end
    end
    return value:find("EPSILON", 1, true) ~= nil
end

local function check_tests(text, place, faults)
    for test in text:gmatch("[%w_/]+") do
        local found
        for _, suffix in ipairs(SUFFIXES) do
            local file = io.open("tests/" .. test .. suffix)
            found = found or file
            if file then
                file:close()
            end
        end
        if not found then
            faults[#faults + 1] = ("%s: no test '%s'"):format(place, test)
        end
    end
end

-- The rows of a source: { names =, values =, file =, kind =, text =, test = }, one for each comment.
local function read(path, rows, faults)
    local comment, open, row
    local number = 0
    for line in io.lines(path) do
        number = number + 1
        local name, value = line:match("^#define ([%w_]+) +(.+)$")
        if open then
            comment[#comment + 1] = line
            open = not line:find("*/", 1, true)
        elseif line:match("^/%*") then
            comment, open, row = { line }, not line:find("*/", 1, true), nil
        elseif name then
            value = value:gsub("%s*/%*.*$", ""):gsub("^%((.*)%)$", "%1")
            if comment then
                local text = table.concat(comment, "\n"):gsub("^/%*+ ?", ""):gsub("%s*%*/%s*$", ""):gsub("\n %* ?", " ")
                local kind, rest = text:match("^(%u[%l ]+): (.*)$")
                if KINDS[kind] ~= nil then
                    local told, test = rest:match("^(.*) Test: (.*)%.$")
                    row = { names = {}, values = {}, file = path:gsub("^core/", ""), kind = kind, text = told or rest, test = test or "" }
                    rows[#rows + 1] = row
                    check_tests(row.test, path .. ":" .. number, faults)
                end
                comment = nil
            end
            if row then
                row.names[#row.names + 1] = "`" .. name .. "`"
                row.values[#row.values + 1] = value
            elseif is_measured(value) then
                faults[#faults + 1] = ("%s:%d: %s does not say what it is for: begin the comment above with 'Tolerance:', 'Limit:', " ..
                                          "'Default:', 'Cost only:' or 'Constant:'"):format(path, number, name)
            end
        else
            comment, row = nil, nil
        end
    end
end

local function all()
    local rows, faults, out, module = {}, {}, {}, nil
    for _, path in ipairs(sources()) do
        read(path, rows, faults)
    end
    if #faults > 0 then
        error(table.concat(faults, "\n"), 0)
    end
    for _, row in ipairs(rows) do
        if KINDS[row.kind] then
            local folder = row.file:match("^include/talus") or row.file:match("^[^/]+")
            if folder ~= module then
                module = folder
                out[#out + 1] = ("\n## %s\n\n| name | value | file | kind | what for | test |\n| --- | --- | --- | --- | --- | --- |"):format(module)
            end
            local text = row.text:gsub("([*<|])", "\\%1")
            out[#out + 1] = ("| %s | %s | %s | %s | %s | %s |"):format(table.concat(row.names, ", "), table.concat(row.values, ", "):gsub("%*", "\\*"),
                row.file:match("[^/]+$"), row.kind:lower(), text, row.test)
        end
    end
    return table.concat(out, "\n") .. "\n"
end

pages.renew_below(MARK, all, "scripts/tools/tolerances.lua", ...)
