-- Seated assemblies are without force, stay as they are when seated again, and keep their energy as they fall. tests/lua/test_seat.lua
-- has other cases.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local seated = require "seated"

local MODELS, FALLING = 300, 40
-- Net force over weight: places are known to 1e-15 m, and 1e9 Pa/m of 0.5 m2 make 5e-7 N of it. Stones weigh some 1e3 N.
local FORCE = 1e-8
-- Of the largest term of the ledger. Another law, or a cut of stones that move, changes what joints have stored: as of stones that fit.
local BALANCE = { none = 1e-4, copy = 1e-4, save = 1e-4, law = 1e-3, cut = 5e-3 }

figures.case("S.seat", MODELS .. " walls, arches and domes, each corner of each stone off by 1e-6 to 4e-3 of the stone, on joints of every law, bonds and laws that "
    .. "dilate among them, with both kinds of contact points. They are seated. Net force of the contacts on a block over its weight; gravity is 0.",
    "blocks that are taken as fitting are without force")
local worst, changed, least = { before = 0, first = 0, later = 0 }, 0, math.huge
for seed = 1, MODELS do
    local rest = seated.at_rest(seed)
    for what in pairs(worst) do
        worst[what] = math.max(worst[what], rest[what])
    end
    changed, least = changed + (rest.unchanged and 0 or 1), math.min(least, rest.contacts)
end
figures.between("least number of contacts seated in a model", least, 10, math.huge)
figures.equal("largest net force before the first step, over the weight", worst.before, 0)
figures.between("largest net force after the first step, over the weight", worst.first, 0, FORCE)
figures.between("largest net force after 100 steps, over the weight", worst.later, 0, FORCE)
figures.equal("models that another seat changes by a bit", changed, 0)

figures.case("S.seat.falls", FALLING .. " such assemblies, on joints of the laws of Talus, fall, with gravity on their side and without damping. Meanwhile nothing is done to them, or they go on as a copy, "
    .. "or as a restored file, or are cut, or get another law. What is missing of their energy is beside that of stones that fit.", "conservation of energy")
for _, event in ipairs(seated.events) do
    local off, fits, slowest = 0, 0, math.huge
    for seed = 1, FALLING do
        local balance, fastest = seated.falls(seed, event)
        off, fits, slowest = math.max(off, balance), math.max(fits, (seated.falls(seed, event, true))), math.min(slowest, fastest)
    end
    local most = BALANCE[event]
    figures.between(event .. ": missing energy over the largest term", off, 0, most)
    figures.between(event .. ": the same of stones that fit", fits, 0, most)
    figures.between(event .. ": fastest stone of the slowest model, m/s", slowest, 0.01, math.huge)
end
figures.finish()
