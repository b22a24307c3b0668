-- consolidate.lua - the rock of rock.lua from cut to equilibrium under gravity, timed end to end: fixed on base and
-- sides, mass scaling, kinetic damping, every block to an unbalanced force ratio of 1e-5.
--
--     talus tests/bench/consolidate.lua blocks=1000 damping=local fraction=0.5
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local bench = require "bench"
local rock = require "rock"

local RATIO, PATIENCE = 1e-5, 100000
local TOTAL = "from cut to 1e-5"

local given = bench.arguments { blocks = 1000, damping = "kinetic", fraction = 0.9 }
local began = os.clock()
local model = rock.build(given.blocks, 1)
model:mass_scaling(true)
model:damping(given.damping)
model:timestep { rule = "body", fraction = given.fraction }
local cut = os.clock()
local run = model:solve { ratio = RATIO, max_cycles = PATIENCE }
local done = os.clock()
assert(run.reason == "ratio", "no equilibrium in " .. PATIENCE .. " steps: " .. run.ratio)
local cost, blocks = model:profile(), #model:blocks { fixed = false }
for _, figure in ipairs { { "cut", cut - began }, { run.cycles .. " steps", done - cut },
    { TOTAL, done - began } } do
    local row = { workload = "consolidate", size = figure[1], blocks = blocks, contacts = cost.loaded,
        threads = 1, reuse = "on", rate = figure[2], unit = "s" }
    bench.figure(figure[1] == TOTAL and bench.weigh(row, model, blocks) or row)
end
