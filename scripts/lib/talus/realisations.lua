-- realisations.lua - talus.realisations{...}: many models with draws of their own, each measured, in a file of rows.
--
-- Rows come from worker processes in any order, and are written in the order of their numbers. A row hangs on the script, the
-- seed and its number only. So the file has the same bytes for any number of workers, and one that was cut off goes on.
--
-- The columns of the file are found by a trial: of the first realisation that can be made its draws and all that its
-- screen and its measure give.
local arguments = require "talus.arguments"
local chance = require "talus.chance"
local draws = require "talus.draws"
local rows = require "talus.rows"
local realised = require "talus.realised"
local workers = require "talus.workers"

local fail = arguments.fail

local KEYS = { "build", "file", "latin", "measure", "number", "on_row", "screen", "seed", "stop_when", "workers" }
local STOP_KEYS = { "at_least", "field", "half_width" }
-- Share of the rows that may err; realisations that are tried for the columns; deaths of a worker on one row.
local MOST_ERRORS, MOST_TRIALS, MOST_DEATHS = 0.05, 20, 2
-- The number of a job is that of its row, and this for a trial.
local TRIAL = 1 << 62
-- Rows that workers may be ahead of the one that is written next, each.
local AHEAD = 64

-- ------------------------------------------------------------------ one realisation, in a worker

local function add_fields(into, given, from)
    if type(given) ~= "table" then
        error(("%s gave %s, not a table of fields"):format(from, arguments.describe(given)), 0)
    end
    for name, value in pairs(given) do
        if type(name) ~= "string" or name == "" or name:find "[%c,\"]" or name == "row" or name == "error" then
            error(("%s gave a field '%s': a name is a text without commas, and none of row and error"):format(from,
                tostring(name)), 0)
        end
        if not rows.cell(value) then
            error(("%s: field '%s' must be a number, true, false or text, not a %s"):format(from, name, type(value)), 0)
        end
        into[name] = value
    end
end

local function build_with(run, draw)
    local model = run.build(draw)
    if not chance.is_model(model) then
        error(("build gave %s, not a model"):format(arguments.describe(model)), 0)
    end
    return model
end

-- What math.random gives in a realisation hangs on seed and row, as draws do.
local function seed_random(run, row)
    math.randomseed(chance.key(run.seed, row, "math.random"))
end

-- Builds and measures a realisation. `all`: the measure is taken whatever the screen says.
local function realise(run, row, all, drawn_into)
    seed_random(run, row)
    local draw, drawn = draws.new(run.seed, row, run.latin and run.number or 0)
    drawn_into(drawn)
    local model, fields, decided = build_with(run, draw), {}, false
    if run.screen then
        local given
        given, decided = run.screen(model, draw)
        add_fields(fields, given, "screen")
    end
    if all or not decided then
        add_fields(fields, run.measure(model, draw), "measure")
    end
    return fields
end

local function sorted(list)
    local names = {}
    for name in pairs(list) do
        names[#names + 1] = name
    end
    table.sort(names)
    return names
end

-- The columns by a realisation: the line that tells the set, and that of names.
local function columns_by(run, drawn, fields)
    local columns, names = { "row", "error" }, sorted(drawn)
    local count = #names
    table.move(names, 1, count, 3, columns)
    for _, name in ipairs(sorted(fields)) do
        if drawn[name] ~= nil then
            error(("'%s' is a draw and a field: give one of them another name"):format(name), 0)
        end
        columns[#columns + 1] = name
    end
    return rows.head(run.number, run.seed, run.latin, count) .. "\n" .. rows.names(columns)
end

local function text_of(message)
    return type(message) == "string" and message or ("an error that is a %s"):format(type(message))
end

-- The line of a row. What is no column is a draw, which is left out, or a field, which is an error.
local function line_of(run, row)
    local drawn = {}
    local good, fields = pcall(realise, run, row, false, function(list)
        drawn = list
    end)
    local sentence = not good and text_of(fields) or nil
    local values = {}
    for name, value in pairs(drawn) do
        values[name] = value
    end
    for name, value in pairs(good and fields or {}) do
        if not run.is_field[name] then
            sentence = ("the field '%s' is not among those of the first realisation: give all of them in each"):format(name)
        end
        values[name] = value
    end
    if sentence then
        for name in pairs(run.is_field) do
            values[name] = nil
        end
    end
    return rows.line(row, sentence, run.columns, values)
end

-- "+" and the two first lines of the file, or "-" and a sentence.
local function trial_of(run, row)
    local drawn
    local good, result = pcall(function()
        local fields = realise(run, row, true, function(list)
            drawn = list
        end)
        return columns_by(run, drawn, fields)
    end)
    return (good and "+" or "-") .. (good and result or text_of(result))
end

-- Lua does not see the memory of a model, so models of before are collected. Of the time that takes at most a twentieth.
local collected, cost = 0, 0
local function collect()
    local now = os.clock()
    if now - collected >= 19 * cost then
        collectgarbage()
        collected = os.clock()
        cost = collected - now
    end
end

-- What a worker does.
local function work(run, job)
    collect()
    if job >= TRIAL then
        return trial_of(run, job - TRIAL)
    end
    return line_of(run, job)
end

-- ------------------------------------------------------------------ what the script gives

local function whole(given, key, default, low, high)
    local value = arguments.number("realisations", given, key, default, low, high)
    if value ~= math.floor(value) then
        fail("realisations: %s = %s must be a whole number", key, value)
    end
    return math.tointeger(value)
end

local function callable(given, key, needed)
    local f = given[key]
    if type(f) ~= "function" and (f ~= nil or needed) then
        fail("realisations: %s must be a function, not %s", key, arguments.describe(f))
    end
    return f
end

local function read_stop(given)
    if given == nil then
        return nil
    end
    arguments.table("realisations", given, "stop_when")
    arguments.check_keys("realisations, stop_when", given, STOP_KEYS)
    local where = "realisations, stop_when"
    return { field = arguments.text(where, given, "field"),
        half_width = arguments.number(where, given, "half_width", nil, 1e-9, 1),
        at_least = arguments.number(where, given, "at_least", 1, 1, 1e9) }
end

local function read_arguments(given)
    arguments.table("realisations", given, "the argument")
    arguments.check_keys("realisations", given, KEYS)
    local run = { number = whole(given, "number", nil, 1, 1e9), seed = whole(given, "seed", 1, 0, 2 ^ 53),
        workers = whole(given, "workers", 1, 1, 256), latin = arguments.boolean("realisations", given, "latin", false),
        build = callable(given, "build", true), measure = callable(given, "measure", true),
        screen = callable(given, "screen"), on_row = callable(given, "on_row"), stop = read_stop(given.stop_when),
        file = given.file ~= nil and arguments.text("realisations", given, "file") or nil, first = 1, step = 1 }
    local shard, shards = workers.shard()
    if shard then
        if not run.file then
            fail("realisations: a shard needs file, the name of the file of rows")
        elseif run.stop then
            fail("realisations: stop_when needs all rows in order: leave it out, or run without --shard")
        end
        run.first, run.step = shard, shards
        run.file = ("%s.shard-%d-of-%d"):format(run.file, shard, shards)
    end
    return run
end

-- ------------------------------------------------------------------ the file

local function set_columns(run, head, columns)
    run.columns, run.draws, run.is_field = columns, head.draws, {}
    for i = head.draws + 3, #columns do
        run.is_field[columns[i]] = true
    end
    if run.stop and not run.is_field[run.stop.field] then
        fail("realisations, stop_when: there is no field '%s' (there are: %s)", run.stop.field,
            table.concat(columns, ", ", head.draws + 3))
    end
end

-- Takes a row into the list; true when stop_when holds.
local function take_row(run, line)
    local row = rows.read(line, run.columns)
    local expected = run.first + #run.list * run.step
    if not row or row.row ~= expected then
        fail("realisations: '%s': line %d is not the whole row %d: the file is damaged; delete it from that line on", run.file or "",
            #run.list + 3, expected)
    end
    run.list[#run.list + 1] = row
    if row.error then
        run.errors = run.errors + 1
        run.first_error = run.first_error or row
    elseif run.stop then
        run.hits = run.hits + (realised.hit("realisations, stop_when", row, run.stop.field) and 1 or 0)
        local count = #run.list - run.errors
        if count >= run.stop.at_least then
            local low, high = chance.interval(run.hits, count)
            run.stopped = (high - low) / 2 <= run.stop.half_width
        end
    end
    return run.stopped
end

local function check_errors(run)
    -- Of a shard it is the share of all rows: what one process bears its shards bear, too.
    if run.errors > MOST_ERRORS * run.number then
        fail("realisations: %d of %d rows err, more than %d %% of %d; the first is row %d: %s", run.errors, #run.list,
            100 * MOST_ERRORS, run.number, run.first_error.row, run.first_error.error)
    end
end

-- Reads what is in the file; what an end has cut off is cut away.
local function read_file(run)
    local text = run.log:read()
    local parts = #text > 0 and rows.parts("realisations", run.file, text)
    if not parts then
        run.log:cut(0)
        return
    end
    local head = parts.head
    if head.number ~= run.number or head.seed ~= run.seed or head.latin ~= run.latin then
        fail("realisations: '%s' is of number = %d, seed = %d, latin = %s, not of %d, %d, %s: give another name, or delete it",
            run.file, head.number, head.seed, head.latin, run.number, run.seed, run.latin)
    end
    set_columns(run, head, parts.columns)
    run.log:cut(parts.bytes)
    for _, line in ipairs(parts.lines) do
        if #run.list == run.rows then
            fail("realisations: '%s' has more rows than number = %d: it is damaged", run.file, run.number)
        end
        if take_row(run, line) then
            break
        end
    end
end

local function write_line(run, line)
    if run.log then
        run.log:add(line .. "\n")
    end
end

-- ------------------------------------------------------------------ the run

-- Finds the columns by the first realisation that can be made.
local function try(run, crew)
    local first
    for row = 1, math.min(MOST_TRIALS, run.number) do
        crew:give(1, TRIAL + row)
        local _, _, answer, death = crew:take()
        if answer and answer:sub(1, 1) == "+" then
            local parts = rows.parts("realisations", "", answer:sub(2) .. "\n")
            set_columns(run, parts.head, parts.columns)
            write_line(run, answer:sub(2))
            return
        end
        first = first or answer and answer:sub(2) or "the worker died: " .. death
    end
    fail("realisations: none of the first %d can be made; the first: %s", math.min(MOST_TRIALS, run.number), first)
end

-- The row of a death, or nil when the row is to be tried again.
local function row_of_death(run, row, death)
    run.deaths[row] = (run.deaths[row] or 0) + 1
    if run.deaths[row] < MOST_DEATHS then
        return nil
    end
    return rows.line(row, ("the worker died %d times: %s"):format(MOST_DEATHS, death), run.columns, {})
end

-- Writes the rows that are there, in order; true at the end.
local function write_rows(run, waiting)
    while #run.list < run.rows do
        local row = run.first + #run.list * run.step
        local line = waiting[row]
        if not line then
            return false
        end
        waiting[row] = nil
        write_line(run, line)
        local stopped = take_row(run, line)
        check_errors(run)
        if run.on_row then
            run.on_row(#run.list)
        end
        if stopped then
            return true
        end
    end
    return true
end

local function work_off(run, crew)
    local next_row, waiting, idle = run.first + #run.list * run.step, {}, {}
    for worker = 1, run.crew_size do
        idle[worker] = worker
    end
    repeat
        while #idle > 0 and next_row <= run.number and
            next_row < run.first + (#run.list + AHEAD * run.crew_size) * run.step do
            crew:give(table.remove(idle), next_row)
            next_row = next_row + run.step
        end
        local worker, row, line, death = crew:take()
        line = line or row_of_death(run, row, death)
        if line then
            waiting[row] = line
            idle[#idle + 1] = worker
        else
            crew:give(worker, row)
        end
    until write_rows(run, waiting)
end

-- Makes the rows that are not there yet.
local function compute(run)
    run.crew_size = math.min(run.workers, run.rows - #run.list)
    -- The columns come by a crew of its own: workers that know them are started after it.
    if not run.columns then
        local crew <close> = workers.start(1, function(job)
            return work(run, job)
        end)
        try(run, crew)
    end
    local crew <close> = workers.start(run.crew_size, function(job)
        return work(run, job)
    end)
    work_off(run, crew)
end

local function go(run)
    run.rows = run.first > run.number and 0 or (run.number - run.first) // run.step + 1
    run.list, run.errors, run.hits, run.deaths = {}, 0, 0, {}
    local log <close> = run.file and workers.log(run.file) or nil
    run.log = log
    if log then
        read_file(run)
        if #run.list > 0 then
            workers.remark(("realisations: '%s' has %d rows already, which are not made again: after a change of the script delete it"):
                format(run.file, #run.list))
        end
        check_errors(run)
    end
    if #run.list < run.rows and not run.stopped then
        compute(run)
    elseif not run.columns then
        fail("realisations: shard %d of %d has no row of %d", run.first, run.step, run.number)
    end
end

-- The model of a row, built anew in the script's own process, whose random numbers go on as if it had drawn two of them.
local function build_row(run, row)
    local a, b = math.random(0), math.random(0)
    seed_random(run, row)
    local good, model = pcall(build_with, run, (draws.new(run.seed, row, run.latin and run.number or 0)))
    math.randomseed(a, b)
    if not good then
        error(model, 0)
    end
    return model
end

-- A sentence of the kernel's without the place in these modules.
local function without_place(message)
    return type(message) == "string" and message:match "^.-talus/realisations%.lua:%d+: (.*)$" or nil
end

local function realisations(given)
    local run = read_arguments(given)
    local good, message = pcall(go, run)
    if not good then
        local sentence = without_place(message)
        if sentence then
            fail("realisations: %s", sentence)
        end
        error(message, 0)
    end
    return setmetatable({ list = run.list, columns = run.columns, last_draw = run.draws + 2, errors = run.errors,
        number = run.number, file = run.file, stopped = run.stopped or false, build_row = function(row)
            return build_row(run, row)
        end }, realised)
end

return arguments.call(realisations)
