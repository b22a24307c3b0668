-- Gaps of joint sets: the moments of each distribution, what they depend on, and what is refused.
local talus = require "talus"
local check = require "check"

local N = 400

-- The gaps of a set of horizontal planes in a column, ascending with z.
local function gaps(options, seed, before)
    local model = talus.model { seed = seed }
    model:generate("box", { min = { 0, 0, -8 * N }, max = { 1, 1, 8 * N }, density = 2000 })
    if before then
        before(model)
    end
    local given = { joint = "J", dip = 0, dip_direction = 0, spacing = 2, number = N + 1 }
    for key, value in pairs(options) do
        given[key] = value
    end
    local summary = model:generate("jointset", given)
    check.near(summary.volume_error, 0, 1e-12)
    local heights, list = {}, {}
    for _, block in ipairs(model:blocks {}) do
        heights[#heights + 1] = { block.centroid[3], block.volume }
    end
    table.sort(heights, function(a, b) return a[1] < b[1] end)
    for i = 2, #heights - 1 do
        list[#list + 1] = heights[i][2]
    end
    return list, summary
end

local function moments(list)
    local mean, square = 0, 0
    for _, x in ipairs(list) do
        mean = mean + x / #list
    end
    for _, x in ipairs(list) do
        square = square + (x - mean) ^ 2 / #list
    end
    return mean, math.sqrt(square)
end

-- Mean, standard deviation, and the share that is narrower than the mean: 1 - 1/e of exponential gaps, and
-- Phi(s / 2) of lognormal ones, s^2 = log(1 + (deviation / mean)^2); here s = 0.8326, Phi(0.4163) = 0.6614.
local wanted = {
    { { spacing_distribution = "uniform", spacing_dev = 1.2 }, 1.2 / math.sqrt(3), 0.5 },
    { { spacing_distribution = "normal", spacing_dev = 0.4 }, 0.4 * 0.9867, 0.5 },
    { { spacing_distribution = "exponential" }, 2, 1 - math.exp(-1) },
    { { spacing_distribution = "lognormal", spacing_dev = 2 }, 2, 0.6614 },
    { { spacing_distribution = "lognormal", spacing_dev = 0.5 }, 0.5, 0.5491 },
}
local SEEDS = check.cases(20)
for _, case in ipairs(wanted) do
    local all, below, refused = {}, 0, 0
    for seed = 1, SEEDS do
        local list, summary = gaps(case[1], seed)
        refused = refused + summary.refused
        table.move(list, 1, #list, #all + 1, all)
    end
    -- Of exponential gaps those that would leave a sliver are refused, and the next one is wider by as much.
    local mean, deviation = moments(all)
    local n = #all + refused
    mean = mean * #all / n
    for _, x in ipairs(all) do
        below = below + (x < 2 and 1 or 0)
    end
    local what = case[1].spacing_distribution
    check.near(mean / 2, 1, 4 * case[2] / 2 / math.sqrt(n))
    -- The fourth moment of a lognormal variable makes its deviation scatter more.
    local scatter = what == "lognormal" and 25 or what == "exponential" and 6 or 3
    check.near(deviation / case[2], 1, scatter / math.sqrt(n) + 0.5 * refused / n)
    check.near((below + refused) / n, case[3], 2 / math.sqrt(n) + refused / n)
end

-- Gaps depend on seed, name and plane only: not on blocks, other sets, or how attitudes are distributed.
for seed = 1, check.cases(10) do
    for _, options in ipairs { { spacing_distribution = "exponential" },
        { spacing_distribution = "lognormal", spacing_dev = 3 } } do
        local one = gaps(options, seed)
        check.near(gaps(options, seed, function(model)
            model:generate("box", { min = { 5, 5, 5 }, max = { 6, 6, 6 }, density = 2000 })
            model:generate("jointset", { joint = "K", dip = 90, dip_direction = 90, spacing = 1, origin = { 9, 0, 0 } })
            model:blocks { containing = { 5.5, 5.5, 5.5 } }:delete()
        end), one, 1e-9)
        local attitude = { distribution = "normal" }
        for key, value in pairs(options) do
            attitude[key] = value
        end
        check.near(gaps(attitude, seed), one, 1e-9)
        check.holds(math.abs(gaps(options, seed + 1000)[7] - one[7]) > 1e-6, "another seed")
    end
    -- "same" is what there was, and what names it.
    for _, d in ipairs { "uniform", "normal" } do
        check.near(gaps({ distribution = d, spacing_dev = 0.5 }, seed),
            gaps({ distribution = "uniform", spacing_distribution = d, spacing_dev = 0.5 }, seed), 1e-9)
    end
    check.near(gaps({ distribution = "fisher", fisher_k = 1e8, spacing_dev = 0.5 }, seed),
        gaps({ spacing_dev = 0.5 }, seed), 0.01)
end

local function refused(options, part)
    local model = talus.model {}
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
    options.joint, options.dip, options.dip_direction, options.spacing = "J", 0, 0, 2
    check.raises(function()
        model:generate("jointset", options)
    end, part)
    check.equal(#model:joints(), 0)
end
refused({ spacing_distribution = "exponential", spacing_dev = 1 }, "leave it out")
refused({ spacing_distribution = "lognormal" }, "needs spacing_dev")
refused({ spacing_distribution = "lognormal", spacing_dev = 21 }, "needs spacing_dev")
refused({ spacing_distribution = "normal", spacing_dev = 2 }, "must be < spacing")
refused({ spacing_distribution = "exponentiel" }, "exponential")
