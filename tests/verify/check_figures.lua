-- check_figures.lua - how the verification tests compare: every figure is printed with what was
-- expected and how far it may be off, the test goes on after a failure, and finish() ends it with
-- status 1.
--
--     figures.case("S.stack.10", "Ten cubes on each other: ...", "equilibrium")
--     figures.near("top settlement", obtained, expected, tolerance)
--     figures.plot { title = ..., x = ..., y = ..., series = { { name =, x =, y =, style = } } }
--     figures.finish()
--
-- What is checked and plotted belongs to the case() before it; without one, to a case named after
-- the file. Where the environment names a folder in TALUS_VERIFY_DIR, finish() leaves the results
-- there for report.lua: NAME.lua, and the figures as CASE_1.svg, CASE_2.svg, ...
local title_of = require "report_titles"

local figures = { failed = 0, checked = 0 }

local cases = {}

local function file_name()
    return (arg and arg[0] or "verify"):match("([^/]+)%.lua$") or "verify"
end

-- The page heads a case by its title: a case without one ends the test before it runs.
function figures.case(id, sentence, source)
    if not title_of(id) then
        error("the case " .. id .. " has no title in tests/verify/report_titles.lua", 2)
    end
    cases[#cases + 1] = { id = id, sentence = sentence or "", source = source or "", checks = {},
        plots = {} }
end

local function open_case()
    if #cases == 0 then
        figures.case(file_name())
    end
    return cases[#cases]
end

local function judge(good, text, check)
    figures.checked = figures.checked + 1
    check.good = good
    local checks = open_case().checks
    checks[#checks + 1] = check
    if good then
        print("  " .. text)
        return
    end
    figures.failed = figures.failed + 1
    local place = debug.getinfo(3, "Sl")
    print(string.format("FAILED %s:%d: %s", place.short_src, place.currentline, text))
end

-- |obtained - expected| <= tolerance; false for NaN.
function figures.near(what, obtained, expected, tolerance)
    local off = math.abs(obtained - expected)
    judge(off <= tolerance,
        string.format("%s: %.10g, expected %.10g (off %.2e, may be %g)", what, obtained, expected,
            obtained - expected, tolerance),
        { what = what, kind = "near", obtained = obtained, expected = expected, error = off,
            tolerance = tolerance })
end

-- |obtained / expected - 1| <= tolerance.
function figures.relative(what, obtained, expected, tolerance)
    judge(math.abs(obtained - expected) <= tolerance * math.abs(expected),
        string.format("%s: %.8g, expected %.8g (off %+.2e of it, may be %g)", what, obtained,
            expected,
            obtained / expected - 1, tolerance),
        { what = what, kind = "relative", obtained = obtained, expected = expected,
            error = obtained == expected and 0 or math.abs((obtained - expected) / expected),
            tolerance = tolerance })
end

-- low <= obtained <= high. Of what is to be small, and is 0 at the least, the upper bound is the tolerance.
function figures.between(what, obtained, low, high)
    judge(low <= obtained and obtained <= high,
        string.format("%s: %.8g, between %g and %g", what, obtained, low, high),
        { what = what, kind = "between", obtained = obtained, low = low, high = high,
            error = low == 0 and obtained or nil, tolerance = low == 0 and high or nil })
end

function figures.equal(what, obtained, expected)
    judge(obtained == expected,
        string.format("%s: %s, expected %s", what, tostring(obtained), tostring(expected)),
        { what = what, kind = "equal", obtained = tostring(obtained),
            expected = tostring(expected) })
end

-- A figure for the report: see svg_plot.lua for the fields.
function figures.plot(plot)
    local plots = open_case().plots
    plots[#plots + 1] = plot
end

-- ---------------------------------------------------------------- what report.lua reads

local function number_text(value)
    if value ~= value then
        return "0/0"
    elseif math.abs(value) == math.huge then
        return value > 0 and "1/0" or "-1/0"
    end
    return math.type(value) == "integer" and tostring(value) or string.format("%.17g", value)
end

-- A table of strings, numbers, booleans and such tables, as Lua; keys in order.
local function literal(value)
    if type(value) == "number" then
        return number_text(value)
    elseif type(value) ~= "table" then
        return type(value) == "string" and string.format("%q", value) or tostring(value)
    end
    local out, keys = {}, {}
    for _, item in ipairs(value) do
        out[#out + 1] = literal(item)
    end
    for key in pairs(value) do
        if type(key) == "string" then
            keys[#keys + 1] = key
        end
    end
    table.sort(keys)
    for _, key in ipairs(keys) do
        out[#out + 1] = string.format("[%q] = %s", key, literal(value[key]))
    end
    return "{ " .. table.concat(out, ",\n") .. " }"
end

local function write(path, text)
    local file = assert(io.open(path, "w"))
    assert(file:write(text))
    assert(file:close())
end

-- Smaller shares of a tolerance are drawn at this one: a logarithmic axis has no place for 0.
local SMALLEST_SHARE = 1e-6

-- The figure of a case that brings none: the share of its tolerance each error takes.
local function plot_of_errors(case)
    local x, share, one = {}, {}, {}
    for i, check in ipairs(case.checks) do
        local value = check.good and 0 or math.huge
        if check.error and check.tolerance > 0 then
            value = check.error / check.tolerance
        end
        x[i], share[i], one[i] = i, math.max(value, SMALLEST_SHARE), 1
    end
    return { title = case.id .. ": error over tolerance", x = "figure, in the order of the test",
        y = "error / tolerance", log_y = true,
        series = { { name = "obtained", x = x, y = share, style = "points" },
            { name = "tolerance", x = x, y = one, style = "line" } } }
end

local function leave_results(folder)
    local svg_plot = require "svg_plot"
    for _, case in ipairs(cases) do
        case.figures = {}
        if #case.plots == 0 then
            case.plots[1] = plot_of_errors(case)
        end
        for k, plot in ipairs(case.plots) do
            local name = string.format("%s_%d.svg", case.id:gsub("[^%w]+", "_"), k)
            write(folder .. "/" .. name, svg_plot.draw(plot))
            case.figures[k] = { file = name, title = plot.title or case.id }
        end
        case.plots = nil
    end
    write(folder .. "/" .. file_name() .. ".lua", "return " .. literal(cases) .. "\n")
end

function figures.finish()
    local folder = os.getenv "TALUS_VERIFY_DIR"
    if folder then
        leave_results(folder)
    end
    print(string.format("%d figures checked, %d failed", figures.checked, figures.failed))
    os.exit(figures.failed == 0 and figures.checked > 0 and 0 or 1)
end

return figures
