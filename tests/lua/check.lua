-- check.lua - what the Lua tests check with. A failed check raises at the line of the check, so a test
-- script ends with exit status 1 and says where.
local check = {}

-- "./bootstrap test" tries one case in ten, with --full one in four (with sanitizers one in twenty), and "./bootstrap soak" all.
local SHARE = tonumber(os.getenv "TALUS_TEST_SHARE" or 1)

-- Of a number of cases how many are tried.
function check.cases(count)
    return math.max(1, count // SHARE)
end

-- Of cases that are chosen, and not at random: all, or the first where one in ten of random ones is tried, or fewer (with
-- sanitizers, and in the quick tests).
function check.few(list)
    return SHARE < 10 and list or { list[1] }
end

-- Of a list of cases those that are tried.
function check.some(list)
    return table.move(list, 1, check.cases(#list), 1, {})
end

local function fail(format, ...)
    error(string.format(format, ...), 3)
end

function check.equal(actual, expected)
    if type(actual) == "function" or type(expected) == "function" then
        fail("a function is compared, not what it gives: a method without its call")
    end
    if actual ~= expected then
        fail("%s is not %s", tostring(actual), tostring(expected))
    end
end

-- |actual - expected| <= tolerance, for numbers and for lists of them; false for NaN.
function check.near(actual, expected, tolerance)
    if type(expected) == "table" then
        if #actual ~= #expected then
            fail("%d numbers, not %d", #actual, #expected)
        end
        for i, wanted in ipairs(expected) do
            if not (math.abs(actual[i] - wanted) <= tolerance) then
                fail("component %d: %.17g is not within %g of %.17g", i, actual[i], tolerance, wanted)
            end
        end
    elseif not (math.abs(actual - expected) <= tolerance) then
        fail("%.17g is not within %g of %.17g", actual, tolerance, expected)
    end
end

function check.holds(condition, what)
    if not condition then
        fail("%s does not hold", what or "the condition")
    end
end

-- Why the message is not one clear sentence placed at a line of `f`, or nil when it is.
local function fault(f, message)
    local info = debug.getinfo(f, "S")
    if type(message) ~= "string" then
        return "the error is a " .. type(message)
    end
    local file, line = message:match("^(.-):(%d+): .")
    if not file then
        return "no file and line"
    end
    line = tonumber(line)
    if line < info.linedefined or line > info.lastlinedefined then
        return string.format("line %d is not in %d-%d", line, info.linedefined, info.lastlinedefined)
    end
    if message:find("\n", 1, true) then
        return "more than one line"
    end
    -- The file occurs once: a sentence is not placed twice on its way up.
    if message:find(":%d+: ", #file + 3 + #tostring(line)) then
        return "placed twice"
    end
end

-- `f` raises one sentence with its own file and line that contains the plain text `part`.
local function raises(f, part, level)
    local good, message = pcall(f)
    if good then
        error(string.format("no error; expected '%s'", part), level + 1)
    end
    local why = fault(f, message)
    if not why and not message:find(part, 1, true) then
        why = string.format("'%s' is not in it", part)
    end
    if why then
        error(string.format("%s: %s", why, tostring(message)), level + 1)
    end
    return message
end

function check.raises(f, part)
    return raises(f, part, 2)
end

-- The same, and the model is as it was: number of blocks, state and settings.
function check.refused(model, f, part)
    local function picture()
        return table.concat({ #model:blocks { hidden = "any" }, model:state_hash(), model.time,
            model.cycles, model.rotation, tostring(model.reuse_geometry), model.gravity[1],
            model.gravity[2], model.gravity[3] }, " ")
    end
    local before = picture()
    local message = raises(f, part, 2)
    local after = picture()
    if before ~= after then
        error(string.format("refused, but the model changed: %s became %s", before, after), 2)
    end
    return message
end

return check
