-- edits.lua - what edits of a cut rock at rest cost: an edit and the next step together, less a usual step, in usual steps.
--
--     talus tests/bench/edits.lua blocks=10000,100000 reuse=on,off reps=5 loops=on only=plane
--
-- The rock is that of rock.lua. Rows of size "loop_..." are of edits that are made one after the other without a step in
-- between: microseconds an edit, for as many edits as the row has blocks.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"
local rock = require "rock"

local SETTLE, CALM = 20, 10 -- steps before the first edit and between two
local LOOPS = { 500, 1000, 2000, 4000 }

-- Seconds of the processor that a function takes.
local function seconds(f, ...)
    local began = os.clock()
    f(...)
    return os.clock() - began
end

local function median(numbers)
    table.sort(numbers)
    local n = #numbers
    return (numbers[(n + 1) // 2] + numbers[n // 2 + 1]) / 2
end

-- Blocks of the inside of the rock, spread over it.
local function inner(model, side)
    local box = { min = { 2, 2, 2 }, max = { side - 2, side - 2, side - 2 } }
    return model:blocks { inside = box, fixed = false, hidden = false }
end

-- A free block in contact with another.
local function neighbour(block)
    for _, other in ipairs(block.neighbours) do
        if not other.fixed then
            return other
        end
    end
end

-- Another law for planes of the rock's joints: `count` of them from the `first` on, one joint after the other.
local function plane_laws(model, side, first, count, friction)
    for k = first, first + count - 1 do
        local plane = string.format("J%d:%d", 1 + k % 3, 1 + k // 3 % (side - 1))
        model:joint(plane, "coulomb", { kn = 1.2e9, ks = 5e8, friction = friction })
    end
end

-- Each takes the model, a block, the number of the repetition and the rock's width, and says what to time: what is
-- looked for first is no part of it.
local EDITS = {
    { "friction", function(model, _, i)
        return function() model:joint("*", { friction = 35 + 0.01 * i }) end
    end },
    { "joint", function(model, _, i)
        return function() model:joint("J3", "coulomb", { kn = 1e9, ks = 5e8, friction = 40 + 0.01 * i }) end
    end },
    { "plane", function(model, _, i, side)
        return function() plane_laws(model, side, i, 1, 40 + 0.01 * i) end
    end },
    { "ten_planes", function(model, _, i, side)
        return function() plane_laws(model, side, 10 * (i - 1), 10, 40 + 0.01 * i) end
    end },
    { "contact_area", function(model, _, i)
        return function() model:contact_area { fraction = 1e-6 * i } end
    end },
    { "delete", function(model, block)
        return function() model:blocks { id = block.id }:delete() end
    end },
    { "join", function(model, block)
        local other, one = neighbour(block).id, block.id
        local both = model:blocks { where = function(b) return b.id == one or b.id == other end }
        return function() both:join() end
    end },
    { "cut", function(model, block, i)
        local c = block.centroid
        return function()
            model:generate("joint", { joint = "cut" .. i, dip = 45, dip_direction = 30, origin = c, radius = 0.01 })
        end
    end },
    { "hide", function(model, block)
        return function() model:blocks { id = block.id }:hide() end
    end },
    { "box", function(model, _, i)
        return function()
            model:generate("box", { min = { 10 * i, 0, -10 }, max = { 10 * i + 1, 1, -9 }, density = 2600 })
        end
    end },
}

local function usual(model)
    local all = {}
    for i = 1, 5 do
        all[i] = seconds(model.cycle, model, 1)
    end
    return median(all)
end

-- The rock at rest.
local function prepared(count, reuse)
    local model, side = rock.build(count, 1)
    model:mass_scaling(true)
    rock.stress(model, side)
    model:cycle(SETTLE)
    model.reuse_geometry = reuse == "on"
    return model, side
end

-- Each edit in a rock of its own, for the edits before would have set it moving.
local function measure(count, reuse, reps, edits)
    for _, edit in ipairs(edits) do
        local model, side = prepared(count, reuse)
        local costs = {}
        for i = 1, reps do
            local blocks = inner(model, side)
            local block = blocks[1 + (i * 7919 + 13 * #edit[1]) % #blocks]
            local act = edit[2](model, block, i, side)
            model:cycle(CALM)
            local step = usual(model)
            collectgarbage()
            costs[i] = (seconds(act) + seconds(model.cycle, model, 1) - step) / step
        end
        bench.figure { workload = "edits", size = edit[1], blocks = #model:blocks(), threads = 1, reuse = reuse,
            rate = median(costs), unit = "steps" }
    end
end

-- Edits one after the other, without a step.
local function loops(n)
    local model = talus.model { threads = 1 }
    local function row(name, f)
        bench.figure { workload = "edits", size = "loop_" .. name, blocks = n, threads = 1,
            rate = 1e6 * seconds(f) / n, unit = "us" }
    end
    row("box", function()
        for i = 1, n do
            model:generate("box", { min = { 2 * i, 0, 0 }, max = { 2 * i + 1, 1, 1 }, density = 2600 })
        end
    end)
    row("delete", function()
        for id = 1, n do
            model:blocks { id = id }:delete()
        end
    end)
end

local given = bench.arguments { blocks = "10000", reuse = "on", reps = 5, loops = "on", only = "" }
local edits = {}
for _, edit in ipairs(EDITS) do
    if given.only == "" or given.only == edit[1] then
        edits[#edits + 1] = edit
    end
end
for _, count in ipairs(bench.list(given.blocks)) do
    for reuse in given.reuse:gmatch "[^,]+" do
        measure(count, reuse, given.reps, edits)
    end
end
if given.loops == "on" then
    for _, n in ipairs(LOOPS) do
        loops(n)
    end
end
