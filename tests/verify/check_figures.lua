-- check_figures.lua - how the verification tests compare: every figure is printed with what was
-- expected and how far it may be off, the test goes on after a failure, and finish() ends it with
-- status 1.
local figures = { failed = 0, checked = 0 }

local function judge(good, text)
    figures.checked = figures.checked + 1
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
    judge(math.abs(obtained - expected) <= tolerance,
        string.format("%s: %.10g, expected %.10g (off %.2e, may be %g)", what, obtained, expected,
            obtained - expected, tolerance))
end

-- |obtained / expected - 1| <= tolerance.
function figures.relative(what, obtained, expected, tolerance)
    judge(math.abs(obtained - expected) <= tolerance * math.abs(expected),
        string.format("%s: %.8g, expected %.8g (off %+.2e of it, may be %g)", what, obtained,
            expected,
            obtained / expected - 1, tolerance))
end

function figures.between(what, obtained, low, high)
    judge(low <= obtained and obtained <= high,
        string.format("%s: %.8g, between %g and %g", what, obtained, low, high))
end

function figures.equal(what, obtained, expected)
    judge(obtained == expected,
        string.format("%s: %s, expected %s", what, tostring(obtained), tostring(expected)))
end

function figures.finish()
    print(string.format("%d figures checked, %d failed", figures.checked, figures.failed))
    os.exit(figures.failed == 0 and figures.checked > 0 and 0 or 1)
end

return figures
