-- talus.realisations: rows of a file that are the same for any number of workers, after kills, of shards; errors and deaths;
-- draws and statistics; bad input.
--
-- program only: a script is run, killed and sharded
local talus = require "talus"
local check = require "check"

local folder = assert(os.getenv "TALUS_TEST_TMP")
local program = assert(os.getenv "TALUS_PROGRAM")
local empty = talus.model {}

local function read(path)
    local file = assert(io.open(path, "rb"))
    local text = file:read "a"
    file:close()
    return text
end

local function exists(path)
    local file = io.open(path, "rb")
    if file then
        file:close()
    end
    return file ~= nil
end

local function run(given)
    given.build = given.build or function(draw)
        draw.normal("x", 10, 2)
        return empty
    end
    given.measure = given.measure or function(_, draw)
        local x = draw.normal("x", 10, 2)
        return { failed = x < 8, double = 2 * x }
    end
    return talus.realisations(given)
end

-- ------------------------------------------------------------------ rows

-- The same bytes for any number of workers, with a script that keeps something from row to row, and its own random numbers.
do
    local bytes
    for _, workers in ipairs { 1, 2, 5 } do
        local path = ("%s/rows_%d.csv"):format(folder, workers)
        os.remove(path)
        local set = run { number = 60, seed = 4, workers = workers, file = path, measure = function(_, draw)
            return { failed = draw.normal("x", 10, 2) < 8, own = math.random(), name = 'a "text", two\nlines',
                odd = draw.row % 2 == 1 and 0 / 0 or math.huge }
        end }
        check.equal(#set, 60)
        bytes = bytes or read(path)
        check.equal(read(path), bytes)
        local row = set:rows()[3]
        check.equal(row.row, 3)
        check.equal(row.name, 'a "text", two lines')
        check.holds(row.odd ~= row.odd and set:rows()[4].odd == math.huge)
        check.near(set:rows()[3].x, set:rows()[3].x, 0)
        -- a second call reads all and computes nothing
        local again = run { number = 60, seed = 4, file = path, build = error, measure = error }
        check.equal(again:mean "x", set:mean "x")
        check.equal(again:sensitivity("x")[1], nil)
    end
    -- another variable changes none; another seed all
    local set = run { number = 5, seed = 4, build = function(draw)
        draw.uniform("first", 0, 1)
        draw.normal("x", 10, 2)
        return empty
    end }
    local other = run { number = 5, seed = 5 }
    local first = run { number = 60, seed = 4, file = folder .. "/rows_1.csv", build = error, measure = error }
    for i = 1, 5 do
        check.equal(set:rows()[i].x, first:rows()[i].x)
        check.holds(other:rows()[i].x ~= first:rows()[i].x)
    end
end

-- A build that takes math.random is built anew as it was in its row, and the script's own numbers do not hang on the row.
do
    local set = run { number = 4, build = function()
        local model = talus.model {}
        model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 + math.random() }, density = 1000 })
        return model
    end, measure = function(model)
        return { volume = model:blocks():sum "volume" }
    end }
    local after = {}
    for i, row in ipairs(set:rows()) do
        math.randomseed(5)
        check.equal(set:model(i):blocks():sum "volume", row.volume)
        after[i] = math.random()
        check.equal(after[i], after[1])
    end
end

-- A screen that decides leaves out the measure; the columns are those of the trial all the same.
do
    local set = run { number = 40, screen = function(_, draw)
        local x = draw.normal("x", 10, 2)
        return { near = x < 10, failed = false }, x >= 10
    end, measure = function(_, draw) return { failed = draw.normal("x", 10, 2) < 8, size = 1 } end }
    for _, row in ipairs(set:rows()) do
        check.equal(row.size, row.near and 1 or nil)
    end
    check.equal(set:probability "failed" > 0, true)
    check.equal(set:model(3).cycles, 0)
end

-- A model has the row's own numbers again.
do
    local set = run { number = 3, build = function(draw)
        local model = talus.model { seed = draw.seed "model" }
        model:generate("box", { min = { 0, 0, 0 }, max = { draw.uniform("size", 1, 2), 1, 1 }, density = 1000 })
        return model
    end, measure = function(model, draw) return { volume = model:blocks():sum "volume" } end }
    check.near(set:model(2):blocks():sum "volume", set:rows()[2].volume, 0)
    check.near(set:rows()[2].size, set:rows()[2].volume, 1e-12)
    check.raises(function() set:model(4) end, "must be a whole number in [1, 3], not the number 4")
end

-- stop_when: the file ends at the first row at which the interval is narrow enough.
do
    local bytes
    for _, workers in ipairs { 1, 3 } do
        local path = ("%s/stop_%d.csv"):format(folder, workers)
        os.remove(path)
        local set = run { number = 5000, workers = workers, file = path,
            stop_when = { field = "failed", half_width = 0.05, at_least = 100 } }
        local _, low, high = set:probability "failed"
        check.holds(set.stopped and (high - low) / 2 <= 0.05 and #set >= 100 and #set < 400)
        bytes = bytes or read(path)
        check.equal(read(path), bytes)
    end
end

-- ------------------------------------------------------------------ errors and deaths

-- Rows that err are rows; a worker that dies once is started anew, and twice the row errs.
do
    local path, once = folder .. "/errors.csv", folder .. "/once"
    os.remove(path)
    os.remove(once)
    local function build(draw)
        draw.normal("x", 10, 2)
        if draw.row == 7 then
            error "no block at all, \"none\""
        elseif draw.row == 9 then
            os.exit(3)
        elseif draw.row == 11 and not exists(once) then
            io.open(once, "w"):close()
            os.exit(3)
        end
        return empty
    end
    local set = run { number = 60, workers = 2, file = path, build = build }
    check.equal(set.errors, 2)
    check.holds(set:rows()[7].error:find 'test_realisations.lua:%d+: no block at all, "none"$')
    check.equal(set:rows()[9].error, "the worker died 2 times: it ended with status 3")
    check.equal(set:rows()[11].error, nil)
    check.holds(set:rows()[7].x and not set:rows()[7].failed and exists(once))
    local _, low, high = set:probability "failed"
    check.holds(low >= 0 and high <= 1)
    -- more than 5 % end the run, at the same row for any number of workers, and again when it goes on
    local rows
    for _, workers in ipairs { 1, 3 } do
        os.remove(path)
        for _ = 1, 2 do
            check.raises(function()
                run { number = 60, workers = workers, file = path, build = function(draw)
                    return draw.row % 10 == 5 and error("this one", 0) or empty
                end, measure = function() return { failed = false } end }
            end, "4 of 35 rows err, more than 5 % of 60; the first is row 5: this one")
        end
        rows = rows or read(path)
        check.equal(read(path), rows)
    end
end

-- A field that the first realisation has not is an error of the row.
check.raises(function()
    run { number = 4, measure = function(_, draw) return draw.row == 3 and { failed = true, more = 1 } or { failed = true } end }
end, "the field 'more' is not among those of the first realisation")

-- ------------------------------------------------------------------ kills

local script = folder .. "/script.lua"
local text = [[
local talus = require "talus"
local set = talus.realisations { number = 150, seed = 9, workers = tonumber(arg[2]), file = arg[1], latin = true,
    build = function(draw)
        local model = talus.model { seed = draw.seed "model" }
        model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 1000 })
        model:generate("jointset", { joint = "J", dip = draw.uniform("dip", 0, 90), dip_direction = 90, spacing = 0.2, number = 4,
            origin = { 0.5, 0.5, 0.5 } })
        return model
    end,
    measure = function(model, draw) return { blocks = #model:blocks() } end }
]]
local file = assert(io.open(script, "w"))
file:write(text)
file:close()

local function shell(format, ...)
    return os.execute(format:format(...))
end

local whole = folder .. "/whole.csv"
os.remove(whole)
check.holds(shell("'%s' --quiet '%s' '%s' 1", program, script, whole))
-- that rows are not made again is said
check.holds(shell("'%s' '%s' '%s' 1 2>'%s/said'", program, script, whole, folder))
check.holds(read(folder .. "/said"):find "whole.csv' has 150 rows already, which are not made again")

-- Killed at any moment it goes on, to the same bytes: 100 kills in all, one in ten of them in a short test. The clock of a kill
-- begins with the first bytes of the file, and has steps that share nothing with that of rows.
do
    local WORKERS = { 1, 2, 3, 5 }
    local path, kills, partly = folder .. "/killed.csv", check.cases(100), 0
    for kill = 1, kills do
        os.remove(path)
        for _ = 1, 1 + kill % 3 do
            shell("'%s' --quiet '%s' '%s' %d & p=$!; while kill -0 $p 2>/dev/null && ! [ -s '%s' ]; do :; done; " ..
                "sleep 0.0%02d; kill -9 $p 2>/dev/null; wait $p 2>/dev/null", program, script, path, WORKERS[1 + kill % 4], path,
                (37 * kill) % 31)
        end
        partly = partly + (exists(path) and #read(path) < #read(whole) and 1 or 0)
        check.holds(shell("'%s' --quiet '%s' '%s' %d", program, script, path, WORKERS[1 + kill // 4 % 4]))
        check.equal(read(path), read(whole))
    end
    check.holds(partly > 0, "some kill before the end")
end

-- A file that ends anywhere, as a full disk leaves it, is gone on with: in the first line, in the names, in and between rows.
do
    local path, text = folder .. "/torn.csv", read(whole)
    local first = text:find "\n"
    local names = text:find("\n", first + 1, true)
    for _, bytes in ipairs { 0, 1, first - 1, first, first + 3, names - 1, names, names + 1, names + 9, #text // 2, #text - 1, #text } do
        local torn = assert(io.open(path, "wb"))
        torn:write(text:sub(1, bytes))
        torn:close()
        check.holds(shell("'%s' --quiet '%s' '%s' 2", program, script, path))
        check.equal(read(path), text)
    end
    -- a file as large as it may be: what is in it is kept, and gone on with
    os.remove(path)
    check.holds(not shell("(ulimit -f 8; '%s' --quiet '%s' '%s' 2 2>'%s/said')", program, script, path, folder))
    check.holds(read(folder .. "/said"):find "cannot write '.*torn.csv': File too large")
    check.holds(#read(path) > 0 and text:sub(1, #read(path)) == read(path))
    check.holds(shell("'%s' --quiet '%s' '%s' 2", program, script, path))
    check.equal(read(path), text)
end

-- ------------------------------------------------------------------ shards

do
    local path = folder .. "/shards.csv"
    os.remove(path)
    for _, name in ipairs { "1-of-3", "2-of-3", "3-of-3", "1-of-2", "2-of-2" } do
        os.remove(path .. ".shard-" .. name)
    end
    local function shard(which)
        return shell("'%s' run --quiet --shard %s '%s' '%s' 1 2>'%s/said'", program, which, script, path, folder)
    end
    local function merge()
        return shell("'%s' merge '%s' 2>'%s/said'", program, path, folder), read(folder .. "/said")
    end
    local good, said = merge()
    check.holds(not good and said:find("there is no '.*shards.csv.shard%-i%-of%-n'"))
    check.holds(shard "1/3" and shard "3/3")
    good, said = merge()
    check.holds(not good and said:find("of 150 rows there are not: 2, 5, 8, 11"))
    -- shards of other numbers fill the gaps
    check.holds(shard "2/2" and shell("OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=3 '%s' run --quiet --shard auto '%s' '%s' 2",
        program, script, path))
    good, said = merge()
    check.holds(good and said:find "150 rows of 4 files")
    check.equal(read(path), read(whole))
    -- whatever the number of shards
    for count = 1, check.cases(70) >= 70 and 7 or 3 do
        os.remove(path)
        for i = 1, count do
            check.holds(shell("'%s' run --quiet --shard %d/%d '%s' '%s' %d", program, i, count, script, path .. count, 1 + i % 2))
        end
        check.holds(shell("'%s' merge '%s' 2>'%s/said'", program, path .. count, folder))
        check.equal(read(path .. count), read(whole))
    end
    -- errors are counted among all rows: one that one process bears ends no shard, however few rows that has
    local script_of_one = folder .. "/one_error.lua"
    local text = assert(io.open(script_of_one, "wb"))
    text:write([[
local talus = require "talus"
local model = talus.model {}
talus.realisations { number = 60, file = arg[1], build = function(draw)
    return draw.row == 7 and error("seven", 0) or model
end, measure = function(_, draw) return { x = draw.uniform("u", 0, 1) } end }]])
    text:close()
    local bears = folder .. "/one_error.csv"
    os.remove(bears)
    check.holds(shell("'%s' --quiet '%s' '%s'", program, script_of_one, bears))
    local by_one = read(bears)
    for i = 1, 10 do
        os.remove(("%s.shard-%d-of-10"):format(bears, i))
        check.holds(shell("'%s' run --quiet --shard %d/10 '%s' '%s'", program, i, script_of_one, bears))
    end
    os.remove(bears)
    check.holds(shell("'%s' merge '%s' 2>'%s/said'", program, bears, folder))
    check.equal(read(bears), by_one)
    -- another seed is refused
    local other = assert(io.open(path .. ".shard-2-of-2", "rb")):read "a"
    local changed = assert(io.open(path .. ".shard-2-of-2", "wb"))
    changed:write((other:gsub("seed 9", "seed 8")))
    changed:close()
    good, said = merge()
    check.holds(not good and said:find("they are of two sets", 1, true))
    -- what batch systems tell
    for _, case in ipairs {
        { "SLURM_ARRAY_TASK_ID=7 SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MIN=5", "3-of-3" },
        { "SLURM_ARRAY_TASK_ID=9 SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MIN=5 SLURM_ARRAY_TASK_STEP=2", "3-of-3" },
        { "SLURM_PROCID=0 SLURM_NTASKS=2", "1-of-2" }, { "PMI_RANK=1 PMI_SIZE=2", "2-of-2" } } do
        os.remove(path .. ".shard-" .. case[2])
        check.holds(shell("%s '%s' run --quiet --shard auto '%s' '%s' 1", case[1], program, script, path))
        check.holds(exists(path .. ".shard-" .. case[2]))
    end
    for _, case in ipairs { { "", "auto" }, { "SLURM_PROCID=2 SLURM_NTASKS=2", "auto" }, { "", "0/3" }, { "", "4/3" }, { "", "x" },
        { "", "1/2/3" } } do
        check.holds(not shell("%s '%s' run --quiet --shard %s '%s' '%s' 1 2>'%s/said'", case[1], program, case[2], script, path,
            folder))
        check.holds(read(folder .. "/said"):find "%-%-shard")
    end
end

-- ------------------------------------------------------------------ draws

local function with(f)
    local caught
    run { number = 1, build = function(draw)
        caught = draw
        return empty
    end, measure = function() return { made = 1 } end }
    local set = run { number = 1, build = function(draw)
        caught = draw
        return empty
    end, measure = function() return { made = 1 } end }
    set:model(1) -- in this process
    return f(caught)
end

with(function(draw)
    check.equal(draw.normal("a", 1, 2), draw.normal("a", 1, 2))
    check.equal(draw.normal("zero", 3, 0), 3.0)
    local x = draw.normal("cut", 35, 30, { min = 34, max = 36 })
    check.holds(x >= 34 and x <= 36)
    check.holds(draw.lognormal("l", 5, 1, { min = 5 }) >= 5)
    check.holds(draw.triangular("t", 1, 2, 5) <= 5 and draw.power_law("p", 2.5, 1, 20) >= 1)
    check.equal(draw.choice("c", { "only" }), "only")
    check.equal(draw.choice("w", { "a", "b" }, { 0, 1 }), "b")
    local c, phi = draw.correlated({ "c2", "phi" }, { { 2e4, 5e3, min = 0 }, { 35, 3 } }, -1)
    check.near((c - 2e4) / 5e3, -(phi - 35) / 3, 1e-3)
    for _, case in ipairs {
        { function() draw.normal("a", 1, 3) end, "draw.normal('a'): 'a' is drawn as normal(1, 2, -inf, inf) already" },
        { function() draw.uniform("a", 1, 3) end, "'a' is drawn as normal" },
        { function() draw.fisher("a", 30, 120, 50) end, "'a' is drawn as normal" },
        { function() draw.normal("b", 1, -1) end, "sd = -1 must be >= 0" },
        { function() draw.normal("b", 0 / 0, 1) end, "the mean must be a number" },
        { function() draw.normal("b", 0, 1, { min = 2, max = 1 }) end, "min = 2 is above max = 1" },
        { function() draw.normal("b", 0, 1, { min = 8 }) end, "fewer than 1 in 1000 draws of mean 0 and sd 1 are in [8, inf]" },
        { function() draw.normal("b", 0, 1, { mim = 8 }) end, "unknown parameter 'mim'; did you mean 'min'?" },
        { function() draw.normal(3, 1) end, "the first argument is the name of the draw" },
        { function() draw.lognormal("b", -1, 1) end, "the mean = -1 must be > 0" },
        { function() draw.uniform("b", 2, 1) end, "min = 2 is above max = 1" },
        { function() draw.triangular("b", 1, 6, 5) end, "are not in this order" },
        { function() draw.power_law("b", 2, 0, 5) end, "min = 0 must be > 0" },
        { function() draw.fisher("b", 95, 5, 20) end, "dip = 95 is outside [0, 90]" },
        { function() draw.fisher("b", 5, 5, 0) end, "the concentration = 0 must be > 0" },
        { function() draw.uniform("row", 0, 1) end, "'row' is the name of a column of every file of rows" },
        { function() draw.correlated({ "e", "error" }, { { 0, 1 }, { 0, 1 } }, 0) end, "'error' is the name of a column" },
        { function() draw.choice("b", {}) end, "the list is empty" },
        { function() draw.choice("b", { 1, 2 }, { 1, 2, 3 }) end, "there are 3 weights for a list of 2" },
        { function() draw.choice("b", { 1, 2 }, 3) end, "the weights must be a table" },
        { function() draw.choice("b", { 1, 2 }, { 1 }) end, "weight 2 must be a number >= 0, not nil" },
        { function() draw.correlated({ "e", "f" }, { { 0, 1 }, { 0, 1 } }, 2) end, "must be in [-1, 1]" },
        { function() draw.correlated({ "e", "f", "g" }, { { 0, 1 }, { 0, 1 }, { 0, 1 } },
            { { 1, 0.9, -0.9 }, { 0.9, 1, 0.9 }, { -0.9, 0.9, 1 } }) end, "the correlation matrix is none" },
        { function() draw.correlated({ "e" }, { { 0, 1 } }, 1) end, "give two or more" },
        { function() draw.correlated({ "e", "f" }, { { 0, 1, mim = 0 }, { 0, 1 } }, 0) end, "unknown parameter 'mim'; did you mean 'min'?" },
    } do
        check.raises(case[1], case[2])
    end
end)

-- Correlations and strata of a hypercube, over many rows.
do
    local set = run { number = 400, latin = true, seed = 2, build = function(draw)
        draw.correlated({ "c", "phi", "t" }, { { 2e4, 5e3, distribution = "lognormal" }, { 35, 3 }, { 1, 0.1 } },
            { { 1, -0.5, 0.3 }, { -0.5, 1, 0 }, { 0.3, 0, 1 } })
        draw.uniform("u", 0, 400)
        return empty
    end, measure = function() return { made = true } end }
    local by = {}
    for _, item in ipairs(set:sensitivity "c") do
        by[item.name] = item.rank_correlation
    end
    check.near(by.phi, -0.48, 0.12) -- three standard errors; the rank correlation is 6 / pi asin(r / 2)
    check.near(by.t, 0.29, 0.14)
    check.near(by.u, 0, 0.15)
    local seen = {}
    for _, row in ipairs(set:rows()) do
        seen[math.floor(row.u)] = true
    end
    check.equal(#seen + (seen[0] and 1 or 0), 400)
end

-- Of a Latin hypercube each n-th part of every distribution has one row: cut off or not, correlated or not.
do
    local chance = require "talus.chance"
    local N, shares = 300, {}
    local function add(name, family, range, a, b, c)
        local from, to = range and range.min or -math.huge, range and range.max or math.huge
        shares[name] = function(stratum) return chance.quantile(family, stratum / N, a, b, c or 0, from, to) end
    end
    for _, case in ipairs { { "normal", 10, 2 }, { "lognormal", 10, 2 }, { "normal", 10, 2, { min = 9, max = 13 } },
        { "lognormal", 10, 2, { min = 9 } } } do
        local family, mean, sd, range = table.unpack(case)
        local name = family .. (range and " cut" or "")
        add(name, family, range, mean, sd)
        add("with " .. name, family, range, mean, sd)
        add("against " .. name, family, range, mean, sd)
    end
    add("uniform", "uniform", nil, 0, 1)
    add("triangular", "triangular", nil, 0, 1, 4)
    add("power_law", "power_law", nil, 2.5, 1, 20)
    local function build(draw)
        for name in pairs(shares) do
            local family, cut = name:match "^(%a+)( ?c?u?t?)$"
            local range = cut == " cut" and (family == "normal" and { min = 9, max = 13 } or { min = 9 }) or nil
            if family == "normal" or family == "lognormal" then
                draw[family](name, 10, 2, range)
                local pair = { 10, 2, distribution = family, min = range and range.min, max = range and range.max }
                draw.correlated({ name .. " first", "with " .. name, "against " .. name }, { { 0, 1 }, pair, pair },
                    { { 1, 0.6, -0.3 }, { 0.6, 1, 0 }, { -0.3, 0, 1 } })
            end
        end
        draw.uniform("uniform", 0, 1)
        draw.triangular("triangular", 0, 1, 4)
        draw.power_law("power_law", 2.5, 1, 20)
        return empty
    end
    local set = run { number = N, latin = true, seed = 6, workers = 2, build = build, measure = function() return { made = true } end }
    local rows = set:rows()
    for name, value in pairs(shares) do
        table.sort(rows, function(a, b) return a[name] < b[name] end)
        for i, row in ipairs(rows) do
            check.holds((i == 1 or row[name] >= value(i - 1)) and (i == N or row[name] <= value(i)), name)
        end
    end
    for _, item in ipairs(set:sensitivity "normal first") do
        if item.name == "with normal" or item.name == "against normal" then
            check.near(item.correlation, item.name == "with normal" and 0.6 or -0.3, 0.12)
        end
    end
    local good, message = pcall(run, { number = 1000001, latin = true, build = function(draw)
        draw.correlated({ "a", "b" }, { { 0, 1 }, { 0, 1 } }, 0.5)
        return empty
    end })
    check.holds(not good and message:find "with latin = true correlated draws are for at most 1000000 realisations, not 1000001$")
end

-- ------------------------------------------------------------------ statistics

do
    local values = { 1, 2, 2, 10 }
    local set = run { number = 4, build = function() return empty end, measure = function(_, draw)
        return { v = values[draw.row], some = draw.row < 3 and draw.row or nil, yes = true, n = draw.row - 1 }
    end }
    check.near(set:mean "v", 3.75, 1e-15)
    check.near(set:sd "v", math.sqrt(52.75 / 3), 1e-12)
    check.equal(set:quantile("v", 0), 1)
    check.equal(set:quantile("v", 0.5), 2)
    check.near(set:quantile("v", 0.9), 7.6, 1e-12)
    check.equal((set:probability "yes"), 1)
    check.equal((set:probability "n"), 0.75)
    local histogram = set:histogram("v", 3)
    check.near(histogram.edges, { 1, 4, 7, 10 }, 0)
    check.near(histogram.counts, { 3, 0, 1 }, 0)
    local wide = run { number = 3, measure = function(_, draw)
        return { i = ({ math.mininteger, 0, math.maxinteger })[draw.row] }
    end }
    check.near(wide:histogram("i", 2).edges, { -2.0 ^ 63, 0, 2.0 ^ 63 }, 0)
    check.near(wide:histogram("i", 2).counts, { 1, 2 }, 0)
    -- numbers that are none count nowhere; infinite ones are the last or the first
    local odd = { math.huge, 0 / 0, 1, -math.huge, 3 }
    local far = run { number = 5, build = function() return empty end, measure = function(_, draw)
        return { v = odd[draw.row], top = math.max(odd[draw.row], 1), all = 0 / 0 }
    end }
    check.equal(far:quantile("v", 0), -math.huge)
    check.equal(far:quantile("v", 0.1), -math.huge)
    check.equal(far:quantile("v", 1 / 3), 1)
    check.equal(far:quantile("v", 0.5), 2.0)
    check.equal(far:quantile("v", 2 / 3), 3)
    check.equal(far:quantile("v", 0.9), math.huge)
    check.equal(far:mean "top", math.huge)
    -- one row
    local one = run { number = 1, build = function() return empty end, measure = function() return { v = 7, yes = true, no = false } end }
    check.equal(one:quantile("v", 0.3), 7)
    check.near({ one:probability "yes" }, { 1, 0.025, 1 }, 1e-14)
    check.near({ one:probability "no" }, { 0, 0, 0.975 }, 1e-14)
    for _, case in ipairs {
        { function() far:sd "top" end, "sd: 'top' has numbers that are not finite" },
        { function() far:mean "all" end, "mean: no realisation has a number 'all'" },
        { function() far:probability "v" end, "probability: realisation 2 has no 'v' that is true, false or a number" },
        { function() far:histogram "top" end, "histogram: 'top' has numbers that are not finite" },
        { function() one:sd "v" end, "sd: 'v' has one number only" },
        { function() set:mean "w" end, "mean: no realisation has a field 'w'" },
        { function() set:mean() end, "mean: name a field" },
        { function() set:quantile("v", 2) end, "quantile: the share must be in [0, 1], not the number 2" },
        { function() set:histogram("v", 0) end, "histogram: the number of intervals must be in [1, 10000]" },
        { function() set:probability "some" end, "probability: realisation 3 has no 'some' that is true, false or a number" },
    } do
        check.raises(case[1], case[2])
    end
end

-- ------------------------------------------------------------------ bad input

for _, case in ipairs {
    { {}, "'number' is missing" },
    { { number = 0 }, "number = 0 is outside [1, 1000000000]" },
    { { number = 1.5 }, "number = 1.5 must be a whole number" },
    { { number = 3, workers = 300 }, "workers = 300 is outside [1, 256]" },
    { { number = 3, sed = 1 }, "unknown parameter 'sed'; did you mean 'seed'?" },
    { { number = 3, build = 3 }, "build must be a function, not the number 3" },
    { { number = 3, build = function() end }, "none of the first 3 can be made; the first: build gave nil, not a model" },
    { { number = 3, measure = function() return 3 end }, "measure gave the number 3, not a table of fields" },
    { { number = 3, measure = function() return { row = 3 } end }, "measure gave a field 'row'" },
    { { number = 3, measure = function() return { x = 3 } end }, "'x' is a draw and a field" },
    { { number = 3, measure = function() return { y = {} } end }, "field 'y' must be a number, true, false or text, not a table" },
    { { number = 3, build = function() os.exit(4) end }, "the worker died: it ended with status 4" },
    { { number = 3, stop_when = { field = "fail", half_width = 0.1 } }, "there is no field 'fail' (there are: double, failed)" },
    { { number = 3, stop_when = { field = "failed" } }, "stop_when: 'half_width' is missing" },
    { { number = 3, file = "/dev/null" }, "it is no regular file" },
    { { number = 61, seed = 4, file = folder .. "/rows_1.csv" }, "is of number = 60, seed = 4, latin = false, not of 61, 4, false" },
    { { number = 60, seed = 5, file = folder .. "/rows_1.csv" }, "is of number = 60, seed = 4, latin = false, not of 60, 5, false" },
    { { number = 60, seed = 4, latin = true, file = folder .. "/rows_1.csv" }, "not of 60, 4, true" },
    { { number = 3, file = script }, "is no file of realisations: give another name" },
} do
    check.raises(function()
        run(case[1])
    end, case[2])
end
-- A file that is damaged is not gone on with.
do
    local path = folder .. "/damaged.csv"
    local file = assert(io.open(path, "wb"))
    file:write((read(folder .. "/rows_1.csv"):gsub("\n7,", "\n8,", 1)))
    file:close()
    check.raises(function()
        run { number = 60, seed = 4, file = path }
    end, "line 9 is not the whole row 7: the file is damaged")
end
-- Beside threads no copy is made; another process is kept off the file.
do
    local several = talus.model { threads = 2 }
    check.raises(function() run { number = 3 } end, "realisations: 1 other threads run")
    check.equal(several.cycles, 0)
    several = nil
    check.equal(#run { number = 3 }, 3)
    local path = folder .. "/locked.csv"
    os.remove(path)
    run { number = 3, file = path, on_row = function(rows)
        if rows == 1 then
            check.holds(not shell("'%s' --quiet '%s' '%s' 1 2>'%s/said'", program, script, path, folder))
            check.holds(read(folder .. "/said"):find "another process writes")
        end
    end }
end
