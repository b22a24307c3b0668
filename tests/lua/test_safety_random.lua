-- Factors of safety of random wedges and slopes: limit equilibrium where it holds, and no difference by units, place, attitude, order or
-- threads. tests/verify/long/random_factors.lua tries many more.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local models = require "safety_models"
local shapes = require "shapes"

for seed = 1, check.cases(20) do
    check.holds(models.compare_wedge(seed))
end
for seed = 1, check.cases(4) do
    check.holds(models.compare_slope(seed))
end

-- A slope comes to rest by the same steps in another attitude, in which other blocks come first in the pairs; and so do its trials.
for _, seed in ipairs(check.few { 63, 2 }) do
    local one, steps, cycles, largest, other = models.draw_slope(seed), {}, {}, 0, 0
    for _, form in ipairs { {}, models.forms(seed)[3] } do
        local model, of = models.slope(one, form), {}
        model:joint("*", { friction = 89, cohesion = 1e6 })
        model:relax { ratio = 1e-6, every = 1, stop = function()
            local way = 0
            for _, block in ipairs(model:blocks { fixed = false }) do
                way = way + shapes.length(block.displacement)
            end
            of[#of + 1] = way
        end }
        steps[#steps + 1] = of
        cycles[#cycles + 1] = models.slope(one, form):factor_of_safety { from = 1, to = 3, resolution = 0.1, least_volume = 0.1 }.cycles
    end
    check.equal(#steps[2], #steps[1])
    for step, way in ipairs(steps[1]) do
        largest = math.max(largest, way)
        other = math.max(other, math.abs(steps[2][step] - way))
    end
    check.holds(other < 1e-9 * largest, string.format("slope %d: the ways of all steps differ by %.2g of them", seed, other / largest))
    check.equal(cycles[2], cycles[1])
end

-- Strengths that are lowered by much at once make fail what rests when they are lowered step by step: a coarse search ends with steps as
-- fine as those of a fine one, and finds no lower factor.
for _, of in ipairs(check.few { { seed = 53, coarse = 0.05 }, { seed = 47, coarse = 0.1 } }) do
    local slope = models.slope(models.draw_slope(of.seed))
    local fine = slope:factor_of_safety { from = 0.1, to = 20, resolution = 0.02, least_volume = 0.1 }
    local coarse = slope:factor_of_safety { from = 0.1, to = 20, resolution = of.coarse, least_volume = 0.1 }
    check.holds(coarse.upper > fine.factor, string.format("slope %d: at most %.3f by steps of %g, and %.3f by steps of 0.02", of.seed,
        coarse.upper, of.coarse, fine.factor))
end

-- Nothing asked changes the model, whatever ends a search; what is not decided is told.
local function ends(model, least_volume)
    local before = model:state_hash()
    for verb, options in pairs { factor_of_safety = { resolution = 0.05, least_volume = least_volume }, safety_map = { step = 0.5 } } do
        options.from, options.to = 0.5, 3
        local at, last = 0, 0
        repeat
            at = at + 1
            local calls = 0
            options.on_trial = function()
                calls = calls + 1
                if calls == at then
                    error("enough", 0)
                end
            end
            local good, message = pcall(model[verb], model, options)
            check.holds(good or message == "enough", tostring(message))
            check.equal(model:state_hash(), before)
            last = good and at or last
        until good or at == 6
        check.holds(at > 1, "a search has trials")
    end
end
ends(models.wedge(models.draw_wedge(1)), 0)
ends(models.slope(models.draw_slope(1)), 0.1)

-- What is not decided counts as failing.
local model = models.wedge(models.draw_wedge(1))
for _, workers in ipairs { 1, 2 } do
    local some, undecided = model:factor_of_safety { max_cycles = 60, from = 0.5, to = 3, workers = workers }, 0
    for _, trial in ipairs(some.trials) do
        check.equal(trial.undecided, trial.why == "undecided")
        check.holds(not (trial.undecided and trial.holds), "what is undecided counts as failing")
        undecided = undecided + (trial.undecided and 1 or 0)
    end
    check.equal(some.undecided, undecided)
    check.holds(undecided > 0, "60 steps do not decide all trials")
end
