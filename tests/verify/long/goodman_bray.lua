-- Toppling of columns on a stepped base (Goodman and Bray, 1976): the friction angle at which the
-- slope fails, lowered bit by bit with its history, and what each column then does.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local statics = require "check_statics"
local columns_of = require "check_columns"
local reference = require("reference_dynamics").goodman_bray

local FIRST, LEAST = 44, 20      -- friction angles to settle under and to stop at, degrees
local STEP = 0.25                -- by which it is lowered, degrees
local AT_REST = 1e-6             -- unbalanced force ratio that counts as equilibrium
local MOVING = 0.02              -- m in one step of friction: many times what the springs yield
local TOLERANCE = 0.5            -- degrees
local MOVED, TURNED = 0.05, 0.2  -- of the farthest column's way; of a column's own

-- What a column did in the last step of friction: it topples when turning accounts for a good part of
-- how far its middle went, it slides when it went as far without.
local function mode(column, height, farthest)
    local u, turn = column.displacement, 2 * math.asin(math.abs(column.rotation[3]))
    local went = math.sqrt(u[1] ^ 2 + u[3] ^ 2)
    if went < MOVED * farthest then
        return "stable"
    end
    return turn * height / 2 > TURNED * went and "topple" or "slide"
end

-- One slope with one choice of contact points: limit equilibrium has forces between toppling columns act at their corners,
-- as "corners" does; with the default the pressure moves there as they turn.
local function check(case, name, points)
    figures.case(name, string.format("%d columns on a stepped base dipping %g degrees, contact points %q: friction angle at "
        .. "failure, and what each column then does", case.n, case.psi, points), reference.source)
    local model, columns = columns_of(case, points, FIRST)
    local friction = statics.search(FIRST, LEAST, STEP, STEP, function(angle)
        model:joint("*", { friction = angle })
        return (statics.stands(model, columns, { ratio = AT_REST, moving = MOVING }))
    end)
    figures.near("friction angle at failure, degrees", friction, case.friction, TOLERANCE)
    local farthest, numbers, way, turned = statics.travel(columns), {}, {}, {}
    for i, column in ipairs(columns) do
        local u = column.displacement
        numbers[i], way[i] = i, math.sqrt(u[1] ^ 2 + u[3] ^ 2)
        turned[i] = math.asin(math.abs(column.rotation[3])) * case.heights[i]
        -- The toe and the columns next to a change of mode are in between at limiting equilibrium.
        local expected = case.modes[i]
        if i > 1 and case.modes[i - 1] == expected and (case.modes[i + 1] or expected) == expected then
            figures.equal(string.format("column %d", i), mode(column, case.heights[i], farthest),
                expected)
        end
    end
    figures.plot { title = name .. ": columns as the slope fails", x = "column, from the toe",
        y = "m", series = {
            { name = "way of the middle", x = numbers, y = way, style = "points" },
            { name = "of it by turning", x = numbers, y = turned, style = "line" },
        } }
end

-- "./bootstrap verify" asks for all slopes; else the one of the fewest columns is enough.
local cases = reference
if not os.getenv "TALUS_VERIFY_DIR" then
    cases = { reference[1] }
    for _, case in ipairs(reference) do
        cases[1] = case.n < cases[1].n and case or cases[1]
    end
end
for _, case in ipairs(cases) do
    check(case, case.name, "consistent")
    check(case, case.name .. ".corners", "corners")
end
figures.finish()
