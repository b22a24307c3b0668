-- relax_judge.lua - judges a quick way to rest by a slow one, on the models of relax_models.lua.
--
--     local judge = require("relax_judge").new { slow = path, work = 40e6 }
--     local row = judge:try(seed, method)       method = "relax"
--
-- The slow way is damping "local", the time step of the rule "body" and half of the critical step, and real masses, to a local ratio
-- of 1e-6. Its answers are kept in the file `slow`, where one is given, and taken from there again: a line for each seed and variant,
-- with a hash of the model, so that a model that has changed is run anew. Steps are counted up to a ratio of 1e-5, as those
-- of the quick way.
--
-- A row has: seed, about, slow and quick (see `outcome`), and
--
--     class     "agree"; "marginal": the answers differ, and the slow one changes under a variant, too; "wrong rest"; "wrong failure";
--               "undecided": one of the two gave no answer
--     why       of marginal ones the variant
--     steps     of the quick way over those of the slow one, where both gave the same answer
--     off       largest difference of the blocks' displacements over the mean closure of the joints, where both are at rest
--     slips     whether anything has slipped in either of them
--
-- judge:near_margin(seed, method) gives two rows, of a friction a little above and below that at which the method's verdict changes, or nil.
local models = require "relax_models"

local judge = {}
judge.__index = judge

local CYCLES = 400000 -- of a stage
local WORK = 40000000 -- blocks times steps of a stage: some minutes
local RATIO, FINE = 1e-5, 1e-6
-- Heat over elastic energy from which something has slipped.
local SLIPPED = 1e-9
local LOAD_STEPS = 20

-- Weight and excavation at once are blows: they throw out blocks that stand, and clamp others that slide, as they come on slowly.
local VARIANTS = {
    { name = "friction x 0.99", change = { friction = 0.99 } },
    { name = "friction x 1.01", change = { friction = 1.01 } },
    { name = "gravity and excavation in 20 steps", change = {}, ramp = true },
    { name = "loads x 0.95", change = { load = 0.95 }, brittle = true },
    { name = "loads x 1.05", change = { load = 1.05 }, brittle = true },
}

-- ---------------------------------------------------------------- ways to rest

-- Each makes a function(model, last) that runs a stage and gives what `solve` gives, with `steps`, those up to RATIO.
local ways = {}

function ways.slow(self)
    return function(model)
        model:damping "local"
        local most = math.min(CYCLES, self.work // #model:blocks { fixed = false })
        local function solve(ratio)
            return model:solve { ratio = ratio, measure = "local", stop_at_failure = true, max_cycles = most }
        end
        local result = solve(RATIO)
        local steps, all = result.cycles, result.cycles
        if result.reason == "ratio" then
            result = solve(FINE)
            all = all + result.cycles
            steps = result.reason == "ratio" and steps or all
        end
        return { reason = result.reason, failing = result.failing, steps = steps, all = all, ratio_local = result.ratio_local,
            worst = result.worst, wall = result.wall }
    end
end

function ways.relax()
    return function(model)
        local result = model:relax { ratio = RATIO, stop_at_failure = true, max_cycles = CYCLES }
        local failing = result.failing
        if failing and type(failing) ~= "number" and #failing > 0 then
            failing = failing[1]
        end
        return { reason = result.reason, failing = failing, steps = result.cycles, ratio_local = result.ratio_local,
            worst = result.worst, wall = result.wall }
    end
end

local VERDICTS = { ratio = "rest", rest = "rest", failure = "failure" }

local function id_of(block)
    if not block then
        return nil
    end
    local good, id = pcall(function() return block.id end)
    return good and id or block
end

-- Mean closure of the joints that carry something, weighted by what they carry, m.
local function mean_closure(model)
    local forces, closures = 0, 0
    for _, contact in ipairs(model:contacts()) do
        for _, point in ipairs(contact.points) do
            local force = math.abs(point.normal_force)
            forces, closures = forces + force, closures + force * math.abs(point.closure)
        end
    end
    return forces > 0 and closures / forces or 0
end

-- Puts on loads in parts, each to rest but the last. Gives the failure of an earlier part, or nil.
local function in_parts(model, put)
    for k = 1, LOAD_STEPS - 1 do
        put(k / LOAD_STEPS)
        model:damping "local"
        local good, result = pcall(model.solve, model, { ratio = 1e-4, max_cycles = CYCLES / 10, stop_at_failure = true })
        if good and result.reason == "failure" then
            return { reason = result.reason, failing = result.failing, steps = result.cycles, ratio_local = result.ratio_local,
                worst = result.worst, wall = result.wall }
        end
    end
    put(1)
    return nil
end

-- Runs a model to its end. An outcome has: verdict ("rest", "failure", "overlap", "cycles", "error"),
-- stage, steps, all (steps to the fine ratio), failing (id), seconds; slip, heat over elastic energy; closure; u, displacements of all
-- blocks one after the other; said, the sentence of an error.
function judge:run(seed, way, change, ramp)
    local model, about = models.build(seed, change)
    local step, outcome = ways[way](self), { steps = 0, all = 0, seconds = 0 }
    local ends = nil
    if ramp and about.apply then
        ends = in_parts(model, function(share) about.apply(model, share) end)
    end
    for _, stage in ipairs(about.stages) do
        outcome.stage = stage.name
        if ramp and stage.group then
            local leave = models.release(model, stage.group)
            ends = in_parts(model, function(share) leave(1 - share) end)
        elseif stage.act then
            stage.act(model)
        end
        local good, result = true, ends
        if not ends then
            good, result = pcall(step, model)
        end
        if not good then
            outcome.verdict, outcome.said = "error", tostring(result)
            break
        end
        outcome.seconds = outcome.seconds + result.wall
        outcome.steps, outcome.all = outcome.steps + result.steps, outcome.all + (result.all or result.steps)
        outcome.verdict, outcome.failing = VERDICTS[result.reason] or result.reason, id_of(result.failing)
        outcome.ratio_local = result.ratio_local
        outcome.worst = id_of(result.worst)
        if outcome.verdict ~= "rest" then
            break
        end
    end
    local energy = model:energy()
    outcome.slip = energy.stored > 0 and energy.friction / energy.stored or 0
    outcome.closure, outcome.u = mean_closure(model), model:blocks { hidden = "any" }:values("displacement", "flat")
    return outcome, about
end

-- ---------------------------------------------------------------- answers that are kept

local function literal(value)
    if type(value) == "table" then
        local items = {}
        for k, v in ipairs(value) do
            items[k] = ("%.9g"):format(v)
        end
        return "{" .. table.concat(items, ",") .. "}"
    elseif type(value) == "string" then
        return ("%q"):format(value):gsub("\n", "n")
    elseif value ~= value or value == math.huge or value == -math.huge then
        return "0/0"
    end
    return type(value) == "number" and ("%.9g"):format(value) or tostring(value)
end

local function load_kept(path)
    local kept = {}
    local file = path and io.open(path, "r")
    if file then
        for line in file:lines() do
            local chunk = load(line, "slow", "t", { keep = function(row) kept[row.key] = row end })
            if chunk then -- a line cut short by a run that was ended is none
                pcall(chunk)
            end
        end
        file:close()
    end
    return kept
end

local function keep(path, row)
    local items = {}
    for name, value in pairs(row) do
        items[#items + 1] = name .. "=" .. literal(value)
    end
    table.sort(items)
    local file = assert(io.open(path, "a"))
    assert(file:write("keep{" .. table.concat(items, ", ") .. "}\n"))
    assert(file:close())
end

-- The slow answer, kept or run; and the table about the model.
function judge:slow(seed, variant)
    variant = variant or { name = "as it is", change = {} }
    local key = ("%d, %s"):format(seed, variant.name)
    local model, about = models.build(seed, variant.change)
    local hash = model:state_hash() .. " " .. about.text
    local kept = self.kept[key]
    if kept and kept.hash == hash then
        return kept, about
    end
    local outcome = self:run(seed, "slow", variant.change, variant.ramp)
    outcome.key, outcome.hash = key, hash
    self.kept[key] = outcome
    if self.path then
        keep(self.path, outcome)
    end
    return outcome, about
end

-- ---------------------------------------------------------------- comparison

-- A variant whose friction is some times as much as that of the seed.
local function with_friction(variant, factor)
    if not factor then
        return variant
    end
    local change = { friction = factor * (variant.change.friction or 1), load = variant.change.load }
    return { name = ("%s, all of friction x %.5f"):format(variant.name, factor), change = change, ramp = variant.ramp }
end

local function decided(outcome)
    return outcome.verdict == "rest" or outcome.verdict == "failure"
end

-- The first variant that changes the slow answer, or nil; and whether some variant gave none.
function judge:variant_that_changes(seed, slow, brittle, friction)
    local unknown = false
    for _, variant in ipairs(VARIANTS) do
        if not variant.brittle or brittle then
            local other = self:slow(seed, with_friction(variant, friction))
            if decided(other) and other.verdict ~= slow.verdict then
                return variant.name
            end
            unknown = unknown or not decided(other)
        end
    end
    return nil, unknown
end

-- The factor of friction at which the verdict of a method changes, between two, to a share of `within`; nil where it does not change
-- or there is no verdict. What is said on both sides of it is compared with the slow answer: a hard test, for the path decides.
function judge:critical_friction(seed, method, low, high, within)
    local function stands(factor)
        return self:run(seed, method, { friction = factor }).verdict
    end
    if stands(low) ~= "failure" or stands(high) ~= "rest" then
        return nil
    end
    while high / low > 1 + within do
        local middle = math.sqrt(low * high)
        local verdict = stands(middle)
        if verdict == "failure" then
            low = middle
        elseif verdict == "rest" then
            high = middle
        else
            return nil
        end
    end
    return math.sqrt(low * high)
end

local function largest_difference(a, b)
    local largest = 0
    for i = 1, #a, 3 do
        local x, y, z = a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]
        largest = math.max(largest, math.sqrt(x * x + y * y + z * z))
    end
    return largest
end

-- With a factor of friction, where one is given.
function judge:try(seed, method, friction)
    local variant = friction and with_friction({ name = "as it is", change = {} }, friction)
    local slow, about = self:slow(seed, variant)
    local quick = self:run(seed, method, variant and variant.change)
    local row = { seed = seed, about = about, slow = slow, quick = quick, friction = friction }
    if not decided(slow) or not decided(quick) then
        row.class = "undecided"
    elseif slow.verdict == quick.verdict then
        row.class = "agree"
        row.steps = quick.steps / math.max(1, slow.steps)
        row.slips = slow.slip > SLIPPED or quick.slip > SLIPPED
        if slow.verdict == "rest" and #slow.u == #quick.u and slow.closure > 0 then
            row.off = largest_difference(slow.u, quick.u) / slow.closure
        end
    else
        row.why = self:variant_that_changes(seed, slow, about.brittle, friction)
        row.class = row.why and "marginal" or "wrong " .. quick.verdict
    end
    return row
end

local MARGIN = 1.02

function judge:near_margin(seed, method)
    local factor = self:critical_friction(seed, method, 0.3, 3, 1e-3)
    if not factor then
        return nil
    end
    return { self:try(seed, method, factor * MARGIN), self:try(seed, method, factor / MARGIN) }
end

local function outcome_text(outcome)
    local text = ("%s at %s after %d"):format(outcome.verdict, outcome.stage, outcome.steps)
    if outcome.failing then
        text = ("%s, block %d"):format(text, outcome.failing)
    end
    return outcome.said and text .. ": " .. outcome.said:sub(1, 100) or text
end

-- A row as a line.
function judge.line(row)
    local parts = { ("%4d %-13s"):format(row.seed, row.class), ("%s of %d"):format(row.about.kind, row.about.blocks),
        "slow " .. outcome_text(row.slow), "quick " .. outcome_text(row.quick),
        row.steps and ("steps %.3f"):format(row.steps) or "steps -",
        row.off and ("off %.2g%s"):format(row.off, row.slips and " with slip" or "") or "off -",
        row.why or "-", row.about.text }
    return table.concat(parts, " | ")
end

local function median(list)
    table.sort(list)
    return #list > 0 and list[(#list + 1) // 2] or 0
end

-- What many rows tell together.
function judge.summary(rows)
    local sum = { rows = #rows, class = {}, seeds = {}, stands = 0, fails = 0, worst_off = 0, offs = 0, off_beyond = 0,
        rest = {}, failure = {}, all = {} }
    for _, row in ipairs(rows) do
        sum.class[row.class] = (sum.class[row.class] or 0) + 1
        if row.class ~= "agree" then
            sum.seeds[row.class] = (sum.seeds[row.class] and sum.seeds[row.class] .. " " or "") .. row.seed
        end
        sum.stands = sum.stands + (row.slow.verdict == "rest" and 1 or 0)
        sum.fails = sum.fails + (row.slow.verdict == "failure" and 1 or 0)
        if row.steps then
            table.insert(sum[row.slow.verdict], row.steps)
            table.insert(sum.all, row.steps)
        end
        if row.off and not row.slips then
            sum.offs, sum.worst_off = sum.offs + 1, math.max(sum.worst_off, row.off)
            sum.off_beyond = sum.off_beyond + (row.off > 0.05 and 1 or 0)
        end
    end
    for _, name in ipairs { "rest", "failure", "all" } do
        sum[name] = { count = #sum[name], median = median(sum[name]), worst = sum[name][#sum[name]] or 0 }
    end
    return sum
end

function judge.summary_text(sum)
    local lines = { ("%d models: slow %d stand, %d fail"):format(sum.rows, sum.stands, sum.fails) }
    for _, class in ipairs { "agree", "marginal", "wrong rest", "wrong failure", "undecided" } do
        lines[#lines + 1] = ("%s: %d  %s"):format(class, sum.class[class] or 0, sum.seeds[class] or "")
    end
    for _, name in ipairs { "all", "rest", "failure" } do
        lines[#lines + 1] = ("steps, quick over slow, of %s (%d): median %.3f, worst %.3f"):format(name, sum[name].count,
            sum[name].median, sum[name].worst)
    end
    lines[#lines + 1] = ("displacements where nothing slips (%d models): off by %.2g of the closure at most, beyond 0.05 in %d"):format(
        sum.offs, sum.worst_off, sum.off_beyond)
    return table.concat(lines, "\n")
end

return {
    new = function(options)
        return setmetatable({ path = options.slow, work = options.work or WORK, kept = load_kept(options.slow) }, judge)
    end,
}
