-- collapse.lua - the pile of pile.lua when the walls around it are taken away: it falls apart on a wide floor.
--
--     talus tests/bench/collapse.lua file=pile.json threads=1,2
--     talus tests/bench/collapse.lua file=pile.json rule=balance
--     talus tests/bench/collapse.lua file=pile.json write=collapse.json
--
-- `file` is what pile.lua has written. Undamped, 1500 steps after the first 500. `rule` is that of `timestep`, whose
-- step is given. Further rows then tell the seconds that a second of the model takes over the same time: by the usual
-- rule and by this one with that step, and with the rule's own step. With `write` the blocks are written as they stand
-- when the walls have gone, and nothing is measured.
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

-- Processor seconds that a second of a model takes, over the time of the steps that are measured.
local function seconds_per_second(model)
    local span = STEPS * STRETCHES * DT
    model:solve { max_time = WARM * DT }
    local began = bench.clock(model.threads)()
    model:solve { max_time = span }
    local taken = bench.clock(model.threads)() - began
    local balance = model:energy().balance
    assert(math.abs(balance) < BALANCE, string.format("the energy is wrong by %g", balance))
    return taken / span
end

-- What a second takes with the usual step and rule, and all by another rule.
local function compare(file, threads, rule)
    for _, settings in ipairs { { dt = DT }, { dt = DT, rule = rule }, { rule = rule } } do
        local model = collapse.build(file, threads)
        model:timestep(settings)
        local name = (settings.rule or "body") .. (settings.dt and ", step given" or "")
        bench.figure { workload = "collapse by " .. name, size = #model:blocks { fixed = false },
            threads = threads, rate = seconds_per_second(model), unit = "s/s" }
    end
end

function collapse.main()
    local given = bench.arguments { file = "pile.json", threads = "1", write = "", rule = "" }
    if given.write ~= "" then
        collapse.build(given.file, 1):write_blocks(given.write)
        return
    end
    for _, threads in ipairs(bench.list(given.threads)) do
        local function build()
            local model = collapse.build(given.file, threads)
            model:timestep { dt = DT, rule = given.rule ~= "" and given.rule or nil }
            return model
        end
        local count = #build():blocks { fixed = false }
        local name = given.rule ~= "" and "collapse at the step of " .. given.rule or "collapse"
        local model = bench.measure_moving(build, { workload = name, size = count },
            { warm = WARM, steps = STEPS, reps = STRETCHES })
        local balance = model:energy().balance
        assert(math.abs(balance) < BALANCE, string.format("the energy is wrong by %g", balance))
        if given.rule ~= "" then
            compare(given.file, threads, given.rule)
        end
    end
end

-- A script that says require "collapse" wants the functions only.
if ... ~= "collapse" then
    collapse.main()
end
return collapse
