-- An arch near the thickness at which it falls rests on hinges: contacts there go by slopes of their energy, and come to rest.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local voussoirs = require "voussoirs"

local COUNT, LIMIT = 15, 0.10606806755065919 -- least thickness over the radius, by limit analysis
local STIFFNESS = 1.25e5                     -- kn / (rho g), 1/m

for _, share in ipairs(check.few { 1.155, 1.157 }) do
    local model = voussoirs.arch(COUNT, share * LIMIT * voussoirs.RADIUS, STIFFNESS)
    local run = model:solve { ratio = 1e-6, max_cycles = 100000 }
    check.equal(run.reason, "ratio")
end
