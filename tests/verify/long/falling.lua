-- Trays of 150 stones, dominoes, heaps that collapse and piles that are shaken, at several stiffnesses: how well the energy
-- ledger closes. tests/lua/test_falling.lua does a little of it.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local falling = require "falling"

local SIDE, LAYERS = 5, 6

local function run(name, limit, model, time)
    local result = falling.run(model, time)
    figures.between(name .. ": worst energy balance, of the largest term", result.worst, 0, limit)
    figures.between(name .. ": energy balance in the end", result.last, 0, limit)
end

figures.case("D.tray", "150 stones of 0.8 m fall into a tray, friction 30 degrees, 1 s", "conservation of energy")
for _, kn in ipairs { 2e7, 1e8, 1e9, 1e10 } do
    for seed = 1, 2 do
        run(string.format("kn %.0e, seed %d", kn, seed), falling.TRAY, falling.tray(kn, seed, SIDE, LAYERS))
    end
end
figures.case("D.collapse", "20 dominoes; a pile of 30 hulls whose box is taken away; the same pile shaken",
    "conservation of energy")
for _, kn in ipairs { 1e8, 1e9, 1e10 } do
    for seed = 2, 4 do
        run(string.format("dominoes, kn %.0e, seed %d", kn, seed), falling.OTHERS, falling.dominoes(kn, seed))
        run(string.format("shaken, kn %.0e, seed %d", kn, seed), falling.OTHERS, falling.shaken(kn, seed))
    end
    run(string.format("heap, kn %.0e", kn), falling.OTHERS, falling.heap(kn))
end
figures.finish()
