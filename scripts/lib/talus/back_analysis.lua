-- back_analysis.lua - talus.back_analysis{...}: the value of an unknown for which a model does what was observed.
--
-- The interval of the unknown is halved until it is shorter than a share of the first one. What is measured must lie on
-- both sides of what was observed at its ends: for a number below and above it, for true and false one of each.
local arguments = require "talus.arguments"
local chance = require "talus.chance"

local fail = arguments.fail

local KEYS = { "build", "measure", "observed", "tolerance", "unknown" }
-- Of the first interval the share that is left.
local TOLERANCE = 1e-4

local function only_key(what, given)
    arguments.table("back_analysis", given, what)
    local name = next(given)
    if type(name) ~= "string" or next(given, name) ~= nil then
        fail("back_analysis: %s must have one name, as in %s", what,
            what == "unknown" and "{friction = {20, 60}}" or "{safety = 1}")
    end
    return name, given[name]
end

local function read_interval(name, given)
    local where = ("back_analysis, unknown '%s'"):format(name)
    arguments.table(where, given, "the interval")
    arguments.check_keys(where, given, { 1, 2, "from", "to" })
    local ends = { from = given.from or given[1], to = given.to or given[2] }
    local from = arguments.number(where, ends, "from", nil, -1e300, 1e300)
    local to = arguments.number(where, ends, "to", nil, -1e300, 1e300)
    if not (from < to) then
        fail("%s: from = %s must be below to = %s", where, from, to)
    end
    return from, to
end

-- What is observed: a list of one or two targets, numbers in order or one of true and false.
local function read_observed(name, given)
    local list = type(given) == "table" and given or { given }
    for i = 1, math.max(#list, 1) do
        local number = type(list[i]) == "number" and list[i] == list[i]
        if #list > 2 or not (number or #list == 1 and type(list[i]) == "boolean") then
            fail("back_analysis: observed.%s must be a number, a pair {low, high}, true or false, not %s", name,
                arguments.describe(list[i]))
        end
    end
    if list[2] and not (list[1] < list[2]) then
        fail("back_analysis: observed.%s: low = %s must be below high = %s", name, list[1], list[2])
    end
    return list
end

local function read_arguments(given)
    arguments.table("back_analysis", given, "the argument")
    arguments.check_keys("back_analysis", given, KEYS)
    for _, key in ipairs { "build", "measure" } do
        if type(given[key]) ~= "function" and (key == "build" or given[key] ~= nil) then
            fail("back_analysis: %s must be a function, not %s", key, arguments.describe(given[key]))
        end
    end
    local run = { build = given.build, measure = given.measure, trials = {}, known = {},
        tolerance = arguments.number("back_analysis", given, "tolerance", TOLERANCE, 1e-12, 0.5) }
    local interval, observed
    run.unknown, interval = only_key("unknown", given.unknown)
    run.from, run.to = read_interval(run.unknown, interval)
    run.field, observed = only_key("observed", given.observed)
    run.targets = read_observed(run.field, observed)
    return run
end

-- What is measured with a value of the unknown; each value once.
local function measured(run, value)
    if run.known[value] ~= nil then
        return run.known[value]
    end
    local values = { [run.unknown] = value }
    local model, fields = run.build(values)
    if not chance.is_model(model) then
        fail("back_analysis: build gave %s, not a model", arguments.describe(model))
    end
    if run.measure then
        fields = run.measure(model, values)
    end
    local got = type(fields) == "table" and fields[run.field]
    if type(got) ~= type(run.targets[1]) or got ~= got then
        fail("back_analysis: with %s = %s %s gave no %s '%s', but %s", run.unknown, value, run.measure and "measure" or "build",
            type(run.targets[1]), run.field, arguments.describe(got))
    end
    run.known[value] = got
    run.trials[#run.trials + 1] = { [run.unknown] = value, [run.field] = got }
    return got
end

-- Whether what is measured is beyond a target: above the number, or true.
local function beyond(got, target)
    if type(target) == "boolean" then
        return got
    end
    return got >= target
end

-- The interval in which the target is crossed.
local function search(run, target)
    local low, high = run.from, run.to
    local at_low, at_high = measured(run, low), measured(run, high)
    local side = beyond(at_low, target)
    if side == beyond(at_high, target) then
        fail("back_analysis: with %s from %s to %s '%s' goes from %s to %s, and does not pass %s: widen the interval", run.unknown,
            low, high, run.field, tostring(at_low), tostring(at_high), tostring(target))
    end
    while high - low > run.tolerance * (run.to - run.from) do
        local middle = low + 0.5 * (high - low)
        if middle <= low or middle >= high then
            break
        end
        if beyond(measured(run, middle), target) == side then
            low = middle
        else
            high = middle
        end
    end
    return low, high
end

local function back_analysis(given)
    local run = read_arguments(given)
    local low, high = search(run, run.targets[1])
    local result = { value = 0.5 * (low + high), low = low, high = high, trials = run.trials }
    if run.targets[2] then
        local from, to = search(run, run.targets[2])
        local ends = { 0.5 * (low + high), 0.5 * (from + to) }
        table.sort(ends)
        result.low, result.high = ends[1], ends[2]
        result.value = 0.5 * (ends[1] + ends[2])
    end
    return result
end

return arguments.call(back_analysis)
