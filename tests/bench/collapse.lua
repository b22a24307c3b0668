-- collapse.lua - the pile of pile.lua when the walls around it are taken away: it falls apart on a wide floor.
--
--     talus tests/bench/collapse.lua file=pile.json threads=1,2
--     talus tests/bench/collapse.lua file=pile.json write=collapse.json
--
-- `file` is what pile.lua has written. Undamped, 1500 steps after the first 500. With `write` the blocks are written as they
-- stand when the walls have gone, and nothing is measured.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"
local pile = require "pile"

local collapse = {}

local DT = 2e-4                           -- s
local WARM, STEPS, STRETCHES = 500, 100, 15
local WIDE, DENSITY = 50, 2600            -- m, floor beyond the origin; kg/m3
local BALANCE = 1e-4                      -- of the ledger of energy

-- The pile on a wide floor, at the instant when its walls have gone.
function collapse.build(file, threads)
    local model = talus.model { threads = threads }
    model:generate("blocks", { file = file })
    model:blocks { fixed = true }:delete()
    model:generate("box", { min = { -WIDE, -WIDE, -1 }, max = { WIDE, WIDE, 0 }, density = DENSITY,
        group = "floor" })
    model:blocks { group = "floor" }:fix()
    pile.laws(model)
    model:damping "none"
    model:timestep { dt = DT }
    return model
end

function collapse.main()
    local given = bench.arguments { file = "pile.json", threads = "1", write = "" }
    if given.write ~= "" then
        collapse.build(given.file, 1):write_blocks(given.write)
        return
    end
    for _, threads in ipairs(bench.list(given.threads)) do
        local function build()
            return collapse.build(given.file, threads)
        end
        local count = #build():blocks { fixed = false }
        local model = bench.measure_moving(build, { workload = "collapse", size = count },
            { warm = WARM, steps = STEPS, reps = STRETCHES })
        local balance = model:energy().balance
        assert(math.abs(balance) < BALANCE, string.format("the energy is wrong by %g", balance))
    end
end

-- A script that says require "collapse" wants the functions only.
if ... ~= "collapse" then
    collapse.main()
end
return collapse
