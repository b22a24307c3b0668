-- realisations.lua - what thousands of realisations of a slope cost that keyblocks screen.
--
--     talus tests/bench/realisations.lua rows=10000 workers=1,2
--
-- The slope is that of drawn_slope.lua, 184 blocks in the first realisation. Rows are those of talus.realisations, in a file, each of
-- a model built anew and its keyblocks. One worker is timed by the processor time of this process and its worker, several by the
-- clock. The parts of a row are timed alone: making the model, its keyblocks, and what a row costs besides, of which this process
-- has a share.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"
local slope = require "drawn_slope"

-- Processor time of this process and of those that it has waited for, s: fields 14 to 17 of its status, in ticks of 1/100 s.
local function processor_time()
    local file = assert(io.open("/proc/self/stat"), "workers are timed by /proc/self/stat")
    local text = file:read "l"
    file:close()
    local ticks, at = 0, 3
    for word in text:match "%) (.*)$":gmatch "%S+" do
        ticks = ticks + (at >= 14 and at <= 17 and tonumber(word) or 0)
        at = at + 1
    end
    return ticks / 100
end

local function run(rows, workers, path, given)
    os.remove(path)
    local clock = workers == 1 and processor_time or bench.clock(workers)
    local began, own = clock(), os.clock()
    local set = talus.realisations { number = rows, seed = 1, workers = workers, file = path,
        build = given.build, screen = given.screen, measure = given.measure }
    local seconds = clock() - began
    assert(#set == rows and set.errors == 0)
    return seconds, os.clock() - own, set
end

local function screen(model, draw)
    local least, volume = slope.keyblocks(model, slope.friction_of(draw))
    return { blocks = #model:blocks(), safety = least, volume = volume, failed = least < 1 }, true
end

local function figure(what, size, blocks, threads, seconds)
    bench.figure { workload = what, size = size, blocks = blocks, threads = threads, rate = seconds, unit = "s" }
end

-- Whole runs; the bytes of the file are the same for any number of workers.
local function whole(rows, workers, path)
    local seconds, own, set = run(rows, workers, path, { build = slope.build, screen = screen,
        measure = function() return {} end })
    figure("realisations", ("%d rows"):format(rows), set:rows()[1].blocks, workers, seconds)
    figure("realisations parent", "a row", nil, workers, own / rows)
end

-- The parts of a row. `built` and `asked` are seconds in all.
local function parts(rows, path)
    local built, asked, blocks = 0, 0, 0
    local set = talus.realisations { number = 1, seed = 1, build = slope.build, screen = screen,
        measure = function() return {} end }
    for row = 1, math.min(rows, 200) do
        local began = os.clock()
        local model = set:model(1)
        built = built + os.clock() - began
        began = os.clock()
        slope.keyblocks(model, slope.friction[1])
        asked = asked + os.clock() - began
        blocks = #model:blocks()
        if row % 10 == 0 then
            model = nil
            collectgarbage()
        end
    end
    local count = math.min(rows, 200)
    figure("realisation generate", "a row", blocks, 1, built / count)
    figure("realisation keyblocks", "a row", blocks, 1, asked / count)
    local empty = talus.model {}
    local seconds = run(rows, 1, path, { build = function(draw)
        slope.friction_of(draw)
        return empty
    end, screen = function(_, draw) return { friction_2 = slope.friction_of(draw), failed = false }, true end,
        measure = function() return {} end })
    figure("realisation file", "a row", 0, 1, seconds / rows)
end

local given = bench.arguments { rows = "10000", workers = "1,2" }
local path = os.tmpname()
local rows = math.tointeger(tonumber(given.rows))
for _, workers in ipairs(bench.list(given.workers)) do
    whole(rows, workers, path)
end
parts(rows, path)
os.remove(path)
