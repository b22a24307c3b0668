-- Asking changes nothing, whatever is done: where somebody has asked after every act, or now and then, a model comes to the same bits as
-- where nobody has. tests/verify/long/asking.lua tries many more.
local asking = require "asking"
local check = require "check"

local SEEDS = check.cases(20)

for seed = 1, SEEDS do
    local asked = asking.compare(seed)
    check.holds(not asked, ("seed %d: asked for %s, and nothing changes:"):format(seed, asked))
end
check.holds(not asking.compare(160)) -- a patch gets more points than its lane has room for, in scaled mass
