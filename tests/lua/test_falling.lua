-- program only
-- Stones that fall into a tray, dominoes, a heap that collapses and a pile that is shaken: all of it strikes, slides and
-- turns over with friction, and the energy ledger closes. tests/verify/long/falling.lua has more and larger ones.
local check = require "check"
local falling = require "falling"

local failed = 0
local function run(name, limit, model, time)
    local result = falling.run(model, time)
    local good = result.worst < limit and result.heat > 0.05
    print(string.format("%s%s: worst balance %.2e, last %.2e, of %d steps, heat %.2f, overlap %.2g m", good and "" or "FAILED ",
        name, result.worst, result.last, result.steps, result.heat, result.overlap))
    failed = failed + (good and 0 or 1)
end

for _, kn in ipairs(check.some { 2e7, 1e8, 1e9, 1e10 }) do
    run(string.format("27 stones, kn %.0e", kn), falling.TRAY, falling.tray(kn, 5, 3, 3))
end
run("dominoes, kn 1e9", falling.OTHERS, falling.dominoes(1e9, 1))
run("heap, kn 1e9", falling.OTHERS, falling.heap(1e9))
run("shaken, kn 1e9", falling.OTHERS, falling.shaken(1e9, 1))
check.equal(failed, 0)
