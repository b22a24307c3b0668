-- bench.lua - what the workloads share: arguments, measuring, rows of CSV.
--
-- A *contact update* is one contact that carries a force, updated for one step, all its points together.
-- One thread is timed by the processor time of the process, which other programs do not disturb; several
-- are timed by the clock. The phases are timed by the clock always and take their shares of that time. Of
-- several repetitions the median counts. They are stretches of steps of one run, one after the other: what rests
-- is the same in all, what moves is not, and each stretch has its own number of contacts.
local talus = require "talus"

local bench = {}

bench.PHASES = { "detect", "timestep", "laws", "gather", "damping", "move", "energy" }

-- A repetition takes at least this long (s): thousands of ticks of os.clock.
local LEAST = 0.2

local COLUMNS = { "workload", "size", "blocks", "contacts", "face_contacts", "points", "threads", "reuse",
    "rate", "unit", "block_steps_per_s", "ratio" }
for _, phase in ipairs(bench.PHASES) do
    COLUMNS[#COLUMNS + 1] = phase .. "_ns" -- a contact update
end
-- Bytes a free block, in all and by what they are for.
local MEMORY = { "total", "blocks", "shapes", "bodies", "step", "broad", "pairs", "contacts", "facets",
    "points", "index", "spare", "other" }
for _, part in ipairs(MEMORY) do
    COLUMNS[#COLUMNS + 1] = part .. "_bytes"
end

-- "key=value" arguments over the defaults; numbers stay numbers. An unknown key is refused.
function bench.arguments(defaults)
    local given = {}
    for key, value in pairs(defaults) do
        given[key] = value
    end
    for i = 1, #arg do
        local key, value = arg[i]:match "^([%w_]+)=(.*)$"
        assert(key and defaults[key] ~= nil, "unknown argument '" .. arg[i] .. "'")
        given[key] = tonumber(value) or value
    end
    return given
end

-- A comma-separated list of numbers, which may have been given as one number.
function bench.list(text)
    local numbers = {}
    for word in tostring(text):gmatch "[^,]+" do
        numbers[#numbers + 1] = assert(tonumber(word), "not a number: " .. word)
    end
    return numbers
end

local function cell(value)
    if math.type(value) == "float" then
        return string.format("%.5g", value)
    end
    return value == nil and "" or tostring(value)
end

local headed = false
local function print_row(row)
    if not headed then
        print(table.concat(COLUMNS, ","))
        headed = true
    end
    local cells = {}
    for i, column in ipairs(COLUMNS) do
        cells[i] = cell(row[column])
    end
    print(table.concat(cells, ","))
    io.stdout:flush()
end

-- A row with one figure.
function bench.figure(row)
    print_row(row)
end

local function median(numbers)
    table.sort(numbers)
    local n = #numbers
    return (numbers[(n + 1) // 2] + numbers[n // 2 + 1]) / 2
end

-- Seconds since the system began, by the clock.
local function uptime()
    local file = assert(io.open("/proc/uptime"), "several threads are timed by /proc/uptime")
    local text = file:read "l"
    file:close()
    return tonumber(text:match "^%S+")
end

-- What tells the time where more than steps is timed: to 0.01 s with several threads.
function bench.clock(threads)
    return threads == 1 and os.clock or uptime
end

-- Seconds that `steps` steps take, and the same by the clock; the unbalanced force ratio after them.
local function time(model, steps)
    local began = os.clock()
    local run = model:cycle(steps)
    return model.threads == 1 and os.clock() - began or run.wall, run.wall, run.ratio
end

-- Adds what the model holds, a free block, to a row.
function bench.weigh(row, model, blocks)
    local bytes = model:memory()
    for _, part in ipairs(MEMORY) do
        row[part .. "_bytes"] = bytes[part] / blocks
    end
    return row
end

-- Measures a model that is ready, and prints a row: `name` has its workload, size and reuse; `options.warm` steps
-- first, then `options.reps` stretches of `options.steps` steps or as many as take long enough. The contacts of a
-- stretch are the mean of those at its beginning and its end.
function bench.measure(model, name, options)
    model.reuse_geometry = name.reuse == "on"
    local warm = time(model, options.warm or 5) / (options.warm or 5)
    local steps = options.steps or math.max(1, math.ceil(LEAST / warm))
    local seconds, contacts, points, rates, phases, ratio = {}, {}, {}, {}, {}, nil
    local loaded = model:profile().loaded
    for i = 1, options.reps do
        model:profile(true)
        local taken, wall
        taken, wall, ratio = time(model, steps)
        local cost = model:profile()
        seconds[i] = taken / steps
        contacts[i] = (loaded + cost.loaded) / 2
        points[i] = cost.points
        rates[i] = contacts[i] / seconds[i]
        loaded = cost.loaded
        for _, phase in ipairs(bench.PHASES) do
            phases[phase] = phases[phase] or {}
            phases[phase][i] = 1e9 * cost.seconds[phase] / wall / rates[i]
        end
    end
    local blocks = #model:blocks { fixed = false }
    model:profile(false)
    local row = { workload = name.workload, size = name.size, blocks = blocks,
        contacts = math.floor(median(contacts) + 0.5), face_contacts = name.face_contacts,
        points = math.floor(median(points) + 0.5), threads = model.threads, reuse = name.reuse, rate = median(rates), unit = "contacts/s",
        block_steps_per_s = blocks / median(seconds), ratio = ratio }
    bench.weigh(row, model, blocks)
    for _, phase in ipairs(bench.PHASES) do
        row[phase .. "_ns"] = median(phases[phase])
    end
    print_row(row)
end

-- With and without reuse, in this order: what is reused is then as after a run.
function bench.measure_both(model, name, options)
    for _, reuse in ipairs { "on", "off" } do
        name.reuse = reuse
        bench.measure(model, name, options)
    end
end

-- The same of what moves: `build` makes the model anew for each, so both start from one state. Returns the model
-- without reuse.
function bench.measure_moving(build, name, options)
    local model
    for _, reuse in ipairs { "on", "off" } do
        model, name.reuse = build(), reuse
        bench.measure(model, name, options)
    end
    return model
end

-- ---------------------------------------------------------------- many boxes at once

-- Faces of a box whose vertex numbers have bit 0 for x, bit 1 for y, bit 2 for z.
local FACES = '[{"vertices":[0,4,6,2]},{"vertices":[1,3,7,5]},{"vertices":[0,1,5,4]},'
    .. '{"vertices":[2,6,7,3]},{"vertices":[0,2,3,1]},{"vertices":[4,5,7,6]}]'

-- Adds boxes { min, max, fixed = true or nil } in one call: a call for each would look at all
-- that are there already every time.
function bench.boxes(model, boxes, density)
    local path = os.tmpname()
    local file = assert(io.open(path, "w"))
    file:write '{"format":"talus block model","version":1,"blocks":['
    for i, box in ipairs(boxes) do
        local corners = {}
        for k = 0, 7 do
            corners[k + 1] = string.format("[%.17g,%.17g,%.17g]",
                k & 1 == 0 and box.min[1] or box.max[1], k & 2 == 0 and box.min[2] or box.max[2],
                k & 4 == 0 and box.min[3] or box.max[3])
        end
        file:write(i > 1 and ",\n" or "", string.format(
            '{"density":%.17g,%s"vertices":[%s],"faces":%s}', density,
            box.fixed and '"fixed":["x","y","z","rotation"],' or "", table.concat(corners, ","),
            FACES))
    end
    file:write "]}"
    assert(file:close())
    local ok, message = pcall(model.generate, model, "blocks", { file = path })
    os.remove(path)
    assert(ok, message)
end

-- Fixed plates one metre thick under and around the space from `min` to `max`, which they touch; they meet
-- each other along edges only. The first is the base.
function bench.plates(min, max)
    local x0, y0, z0 = min[1], min[2], min[3]
    local x1, y1, z1 = max[1], max[2], max[3]
    return {
        { min = { x0, y0, z0 - 1 }, max = { x1, y1, z0 }, fixed = true },
        { min = { x0 - 1, y0, z0 }, max = { x0, y1, z1 }, fixed = true },
        { min = { x1, y0, z0 }, max = { x1 + 1, y1, z1 }, fixed = true },
        { min = { x0, y0 - 1, z0 }, max = { x1, y0, z1 }, fixed = true },
        { min = { x0, y1, z0 }, max = { x1, y1 + 1, z1 }, fixed = true },
    }
end

return bench
