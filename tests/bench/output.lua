-- output.lua - how long files of a large model take: a frame for ParaView, each of its files, a frame of a page for a
-- browser, the first one of all the model and those that follow, and the block model in JSON to and fro.
--
--     talus tests/bench/output.lua blocks=100000 threads=1,2 reps=5 folder=/dev/shm
--
-- The model is that of rock.lua after a few steps. Files are removed again. One thread is timed by the processor time of
-- the process, the system's copying counted, several by the clock, to 0.01 s. Of several repetitions the median counts.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"
local rock = require "rock"

local STEPS = 3
local PARTS = { "blocks", "contacts", "joints" }

-- The median of the seconds that `act` takes; `after` is not timed.
local function seconds(threads, reps, act, after)
    local now, taken = bench.clock(threads), {}
    for i = 1, reps do
        local began = now()
        act()
        taken[i] = now() - began
        after(i - 1)
    end
    table.sort(taken)
    return taken[(#taken + 1) // 2]
end

local function remove_frame(prefix, number)
    for _, part in ipairs(PARTS) do
        os.remove(string.format("%s_%s_%06d.vtk", prefix, part, number))
        os.remove(string.format("%s_%s.vtk.series", prefix, part))
    end
end

local function measure(count, threads, given)
    local model = rock.build(count, threads)
    model:cycle(STEPS)
    local stem = string.format("%s/talus_output_%d", given.folder, threads)
    local function row(what, rate)
        bench.figure { workload = "output", size = what, blocks = #model:blocks(),
            contacts = #model:contacts {}, threads = threads, rate = rate, unit = "s" }
    end
    local function frames(what, parts)
        local prefix = stem .. "_" .. what
        row(what, seconds(threads, given.reps, function() model:write_vtk(prefix, parts) end,
            function(number) remove_frame(prefix, number) end))
    end
    frames("vtk", {})
    for _, part in ipairs(PARTS) do
        local only = {}
        for _, other in ipairs(PARTS) do
            only[other] = other == part
        end
        frames("vtk_" .. part, only)
    end
    local page = stem .. ".html"
    local function pages(what, options, first)
        if not first then
            model:write_html(stem, options)
        end
        row(what, seconds(threads, given.reps, function() model:write_html(stem, options) end,
            function() return first and os.remove(page) end))
        os.remove(page)
    end
    pages("html_first", { contacts = false }, true)
    pages("html", { contacts = false })
    pages("html_contacts", { contacts = true })
    local file = stem .. ".json"
    row("write_blocks", seconds(threads, given.reps, function() model:write_blocks(file) end,
        function() end))
    row("read_blocks", seconds(threads, given.reps, function()
        talus.model { threads = threads }:generate("blocks", { file = file })
    end, function() collectgarbage() end))
    os.remove(file)
end

local given = bench.arguments { blocks = "100000", threads = "1", reps = 5, folder = "." }
for _, count in ipairs(bench.list(given.blocks)) do
    for _, threads in ipairs(bench.list(given.threads)) do
        measure(count, threads, given)
    end
end
