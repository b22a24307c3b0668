-- Walls, arches and domes whose stones are a little off. tests/lua/test_jitter.lua does the same with fewer.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local jitter_verdicts = require "jitter_verdicts"

local MODELS = 150
local JITTERS = { 1e-6, 1e-5, 1e-4, 1e-3 }
-- Largest difference of the thrust: stones that are off by 1e-3 make another arch.
local SAME, OFF = 1e-3, 1e-2

figures.case("I.jitter", MODELS .. " random walls on a tilted table, semicircular arches thicker and thinner than 0.1075 of their mean radius, and domes, of which half fall. "
    .. "Each corner of each stone is moved by up to 1e-6 to 1e-3 of the stone; they are written into a file, imported, which makes their faces plane, and seated. "
    .. "What stands stands, with the thrust of the stones that fit, and what falls falls.", "the same stones where they fit")
local rows = {}
for _, kind in ipairs(jitter_verdicts.kinds) do
    rows[kind] = { stand = 0, fall = 0, wrong = 0, other = {}, off = {} }
    for k in ipairs(JITTERS) do
        rows[kind].other[k], rows[kind].off[k] = 0, 0
    end
end
for seed = 1, MODELS do
    local case = jitter_verdicts.draw(seed)
    local row, reason, exact = rows[case.kind], case:exact()
    local wanted = case.stands and "rest" or "failure"
    row.wrong = row.wrong + (reason == wanted and 0 or 1)
    row[case.stands and "stand" or "fall"] = row[case.stands and "stand" or "fall"] + 1
    for k, jitter in ipairs(JITTERS) do
        local moved, thrust = case:moved(jitter)
        row.other[k] = row.other[k] + (moved == reason and 0 or 1)
        if reason == "rest" and moved == "rest" then
            row.off[k] = math.max(row.off[k], math.abs(thrust / exact - 1))
        end
    end
end
local series, exponents = {}, { -6, -5, -4, -3 }
for _, kind in ipairs(jitter_verdicts.kinds) do
    local row = rows[kind]
    figures.between(kind .. ": models that stand", row.stand, MODELS / 8, MODELS)
    figures.between(kind .. ": models that fall", row.fall, MODELS / 8, MODELS)
    figures.equal(kind .. ": stones that fit: other verdicts than by limit equilibrium", row.wrong, 0)
    for k, jitter in ipairs(JITTERS) do
        local what = ("%s, corners off by %g: "):format(kind, jitter)
        figures.equal(what .. "other verdicts than of stones that fit", row.other[k], 0)
        figures.between(what .. "largest difference of the thrust, relative", row.off[k], 0, jitter <= 1e-4 and SAME or OFF)
    end
    series[#series + 1] = { name = kind, x = exponents, y = row.off, style = "points" }
end
figures.plot { title = "Thrust of stones that are off", x = "corners off, of a stone's size, decimal logarithm",
    y = "largest difference of the thrust, relative", log_y = true, series = series }
figures.finish()
