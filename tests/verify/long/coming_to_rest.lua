-- Piles of 30 and 500 hulls, and cubes dropped into a groove in many attitudes, come to rest to rounding.
-- tests/lua/test_coming_to_rest.lua does it with smaller ones.
package.path = "tests/verify/?.lua;tests/lua/?.lua;tests/bench/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local resting = require "resting"
local pile = require "pile"

local BLOCKS, SEEDS = 500, 20
local SLOWER = 1.5 -- than what scenes took with other contacts

local function run(name, model, steps)
    local result = resting.run(model)
    figures.between(name .. ": steps to an unbalanced force ratio of 1e-6", result.steps or math.huge, 0,
        steps and SLOWER * steps or resting.MOST)
    figures.between(name .. ": largest speed in the end, m/s", result.speed, 0, resting.REST)
    return result
end

figures.case("S.rest", "Piles, a stack, an arch, a beam on edges and cubes in a groove, under damping", "equilibrium")
local names, sums = {}, {} -- of scenes that count together
for _, scene in ipairs(resting.scenes) do
    for i, kn in ipairs { 1e9, 1e10 } do
        if scene.steps[i] ~= false then
            local among = scene.among and ("%s, kn %.0e"):format(scene.among, kn)
            local result = run(string.format("%s, kn %.0e", scene.name, kn), scene.make(kn), not among and scene.steps[i] or nil)
            if among then
                sums[among] = sums[among] or { taken = 0, allowed = 0 }
                sums[among].taken = sums[among].taken + (result.steps or resting.MOST)
                sums[among].allowed = sums[among].allowed + SLOWER * scene.steps[i]
                names[#names + 1] = sums[among].taken == result.steps and among or nil
            end
        end
    end
end
for _, name in ipairs(names) do
    figures.between(name .. ": steps of all to that ratio", sums[name].taken, 0, sums[name].allowed)
end
for seed = 4, 3 + SEEDS do
    for _, kn in ipairs { 1e9, 1e10 } do
        run(string.format("cube in a groove, kn %.0e, seed %d", kn, seed), resting.groove(kn, seed, "combined"))
    end
    run("stack, kn 1e9, seed " .. seed, resting.stack(1e9, seed), 8291)
end
local path = os.tmpname()
pile.drop(BLOCKS, 1):write_blocks(path)
run(string.format("pile of %d, kn 1e9", BLOCKS), pile.load(path, 1))
os.remove(path)
figures.finish()
