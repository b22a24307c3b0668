-- Walls, arches and domes whose stones come from a file and are a little off stand or fall as those that fit, with their thrust.
-- tests/verify/long/jitter.lua does the same with more.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local jitter_verdicts = require "jitter_verdicts"

for seed = 1, 6 * check.cases(10) do
    local case, jitter = jitter_verdicts.draw(seed), ({ 1e-6, 1e-5, 1e-4, 1e-3 })[seed % 4 + 1]
    local what = ("seed %d, %s, jitter %g"):format(seed, case.kind, jitter)
    local reason, exact = case:exact()
    check.holds(reason == (case.stands and "rest" or "failure"), what .. ": stones that fit: " .. reason)
    local moved, thrust = case:moved(jitter)
    check.holds(moved == reason, what .. ": " .. moved)
    check.holds(math.abs(thrust - exact) <= 0.01 * exact, what .. ": thrust " .. thrust .. " N, not " .. exact)
end
