-- report.lua - makes docs/verification.md of what the verification tests left behind.
--
--     talus tests/verify/report.lua RESULTS DOCS TEST.lua...
--
-- RESULTS is the folder the tests wrote to (TALUS_VERIFY_DIR), DOCS the folder that gets
-- verification.md and verification/*.svg (it must exist), then come the tests that should have left
-- results: one that did not is reported as failed. Prints the figures that failed; exit status 1
-- when there are any. The same results give the same text.
package.path = arg[0]:match("^(.-)[^/]*$") .. "?.lua;" .. package.path
local title_of = require "report_titles"
local results, docs = arg[1], arg[2]

-- A case with more figures shows those with the largest share of their tolerance.
local ROWS_SHOWN = 24

local function read(path)
    local file = io.open(path, "r")
    if not file then
        return nil
    end
    local text = file:read "a"
    file:close()
    return text
end

local function write(path, text)
    local file = assert(io.open(path, "w"))
    assert(file:write(text))
    assert(file:close())
end

-- ---------------------------------------------------------------- the cases

-- Share of the tolerance the error takes; 0 for what is only right or wrong.
local function share(check)
    if not check.good then
        return math.huge
    elseif not check.error or check.error == 0 then
        return 0
    end
    return check.error / check.tolerance
end

local function summarise(case)
    case.failed, case.worst = 0, 0
    for i, check in ipairs(case.checks) do
        check.order = i
        case.failed = case.failed + (check.good and 0 or 1)
        case.worst = math.max(case.worst, check.error and check.tolerance > 0
            and check.error / check.tolerance or 0)
    end
end

local function read_cases()
    local cases = {}
    for i = 3, #arg do
        local name = arg[i]:match "([^/]+)%.lua$"
        local text = read(results .. "/" .. name .. ".lua")
        local left = text and assert(load(text, name, "t", {}))() or {
            { id = name, sentence = "The test did not come to its end.", source = "", figures = {},
                checks = { { what = "the test ends", kind = "equal", expected = "true",
                    obtained = "false", good = false } } },
        }
        for _, case in ipairs(left) do
            case.file = arg[i]
            summarise(case)
            cases[#cases + 1] = case
        end
    end
    table.sort(cases, function(a, b)
        if a.id ~= b.id then
            return a.id < b.id
        end
        return a.file < b.file
    end)
    return cases
end

-- ---------------------------------------------------------------- the page

local function number(value)
    return type(value) == "number" and string.format("%.7g", value) or tostring(value)
end

local function cell(text)
    return (text:gsub("|", "\\|"))
end

local function check_row(check)
    local expected, obtained = number(check.expected), number(check.obtained)
    local off, may = "", "exact"
    if check.kind == "between" then
        expected = number(check.low) .. " … " .. number(check.high)
        may = "within"
    elseif check.error then
        off = string.format("%.1e", check.error)
        may = string.format("%g", check.tolerance)
        if check.kind == "relative" then
            off, may = off .. " rel", may .. " rel"
        end
    end
    return string.format("| %s | %s | %s | %s | %s | %s |", cell(check.what), expected, obtained,
        off, may, check.good and "pass" or "**FAIL**")
end

-- The rows to show, in the order of the test, and how many are left out.
local function rows_shown(case)
    local rows = { table.unpack(case.checks) }
    if #rows <= ROWS_SHOWN then
        return rows, 0
    end
    table.sort(rows, function(a, b)
        local one, other = share(a), share(b)
        if one ~= other then
            return one > other
        end
        return a.order < b.order
    end)
    local shown = {}
    for i, check in ipairs(rows) do
        if i <= ROWS_SHOWN or not check.good then
            shown[#shown + 1] = check
        end
    end
    table.sort(shown, function(a, b) return a.order < b.order end)
    return shown, #rows - #shown
end

-- "Free fall (D.freefall)", or the id where there is no title.
local function heading(id)
    local title = title_of(id)
    return title and ("%s%s (%s)"):format(title:sub(1, 1):upper(), title:sub(2), id) or id
end

-- What the heading is linked by; the second of the same heading ends with -1, as hosts have it.
local function anchor(id, seen)
    local name = heading(id):lower():gsub("[^%w%-_ ]", ""):gsub(" ", "-")
    seen[name] = (seen[name] or -1) + 1
    return seen[name] == 0 and name or name .. "-" .. seen[name]
end

local function describe(out, case)
    out[#out + 1] = "## " .. heading(case.id) .. "\n"
    if case.sentence ~= "" then
        out[#out + 1] = case.sentence .. "\n"
    end
    local source = case.source ~= "" and "Source: " .. case.source .. ". " or ""
    out[#out + 1] = source .. "Test: `" .. case.file .. "`.\n"
    out[#out + 1] = "| figure | expected | obtained | error | tolerance | |"
    out[#out + 1] = "| --- | ---: | ---: | ---: | ---: | --- |"
    local rows, left_out = rows_shown(case)
    for _, check in ipairs(rows) do
        out[#out + 1] = check_row(check)
    end
    if left_out > 0 then
        out[#out + 1] = string.format("\n%d more figures pass, each with a smaller share of its "
            .. "tolerance.", left_out)
    end
    out[#out + 1] = ""
    for _, figure in ipairs(case.figures) do
        out[#out + 1] = string.format("![%s](verification/%s)\n", figure.title, figure.file)
    end
end

local function page(cases, checks, failed)
    local out = { "# Verification\n",
        "Made by `./bootstrap verify` from the runs themselves; do not edit. Every case is a test "
            .. "in `tests/verify`,",
        "and what it obtains comes from a simulation. Errors are absolute, or relative (rel) to "
            .. "what is expected.\n",
        string.format("%d cases, %d figures, %d failed.\n", #cases, checks, failed),
        "| case | figures | worst error / tolerance | |", "| --- | ---: | ---: | --- |" }
    local seen = {}
    for _, case in ipairs(cases) do
        out[#out + 1] = string.format("| [%s](#%s) | %d | %.2g | %s |", heading(case.id), anchor(case.id, seen),
            #case.checks, case.worst, case.failed == 0 and "pass" or "**FAIL**")
    end
    out[#out + 1] = ""
    for _, case in ipairs(cases) do
        describe(out, case)
    end
    return table.concat(out, "\n")
end

local cases = read_cases()
local checks, failed = 0, 0
for _, case in ipairs(cases) do
    checks, failed = checks + #case.checks, failed + case.failed
    for _, check in ipairs(case.checks) do
        if not check.good then
            print(string.format("FAILED %s: %s: %s, expected %s (%s)", case.id, check.what,
                number(check.obtained), check.kind == "between"
                and number(check.low) .. " .. " .. number(check.high) or number(check.expected),
                case.file))
        end
    end
    for _, figure in ipairs(case.figures) do
        local picture = assert(read(results .. "/" .. figure.file))
        write(docs .. "/verification/" .. figure.file, picture)
    end
end
write(docs .. "/verification.md", page(cases, checks, failed))
print(string.format("%d cases, %d figures, %d failed: %s/verification.md", #cases, checks, failed,
    docs))
os.exit(failed == 0)
