-- Networks of discs: directions after Fisher, radii of a power law, and the intensity that Baecher discs reach.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_site"

local POLES = 10000

-- What is drawn in many realisations, without a model to speak of; radii as a Latin hypercube.
local empty = talus.model {}
local function draws(latin, list, f)
    return talus.realisations { number = POLES, seed = 11, latin = latin, build = function(draw)
        for i, case in ipairs(list) do
            f(draw, i, case)
        end
        return empty
    end, measure = function() return { made = true } end }:rows()
end

local poles = draws(false, reference.fisher, function(draw, i, case)
    draw.fisher("J" .. i, 0, 0, case.kappa)
end)
local radii = draws(true, reference.power_law, function(draw, i, case)
    draw.power_law("r" .. i, case.exponent, case.min, case.max)
end)

local function normal(dip, direction)
    local d, a = math.rad(dip), math.rad(direction)
    return { math.sin(d) * math.sin(a), math.sin(d) * math.cos(a), math.cos(d) }
end

for i, case in ipairs(reference.fisher) do
    figures.case("DFN.fisher." .. case.kappa, "Poles about a vertical one, after Fisher: resultant, angles, and the "
        .. "concentration that talus.poles finds.", reference.fisher.source)
    local sum, angles, planes, k = { 0, 0, 0 }, {}, {}, case.kappa
    for row, one in ipairs(poles) do
        local dip, direction = one["J" .. i .. ".dip"], one["J" .. i .. ".dip_direction"]
        local n = normal(dip, direction)
        for axis = 1, 3 do
            sum[axis] = sum[axis] + n[axis] / POLES
        end
        angles[row], planes[row] = dip, { dip, direction }
    end
    table.sort(angles)
    -- The share of poles beyond an angle. A dip is that of an axis: what is beyond 90 degrees counts from below.
    local function beyond(angle)
        return 1 - (1 - math.exp(k * (math.cos(math.rad(angle)) - 1))) / (1 - math.exp(-2 * k))
    end
    local R = math.sqrt(sum[1] ^ 2 + sum[2] ^ 2 + sum[3] ^ 2)
    figures.near("R / N of axes", R, case.cosine, 3 * math.sqrt((1 - case.resultant ^ 2) / POLES) / math.sqrt(2))
    -- Kolmogorov and Smirnov at 0.1 %: the largest distance of the two distribution functions
    local farthest = 0
    for row, angle in ipairs(angles) do
        local below = 1 - beyond(angle) + beyond(180 - angle)
        farthest = math.max(farthest, math.abs(below - row / POLES), math.abs(below - (row - 1) / POLES))
    end
    figures.between("distance of Kolmogorov and Smirnov", farthest, 0, 1.95 / math.sqrt(POLES))
    for _, pair in ipairs(case.angles) do
        local share, expected = 0, pair[1] + beyond(180 - pair[2])
        for _, angle in ipairs(angles) do
            share = share + (angle < pair[2] and 1 or 0) / POLES
        end
        figures.near(("share within %.2f degrees"):format(pair[2]), share, expected,
            3 * math.sqrt(expected * (1 - expected) / POLES))
    end
    -- the standard error of k is k / sqrt(N)
    figures.relative("concentration of the poles", talus.poles(planes):mean().kappa, case.kappa, 0.03)
end

for i, case in ipairs(reference.power_law) do
    figures.case("DFN.power_law." .. case.exponent, "Radii of a power law between two ends: mean, mean square, median.",
        reference.power_law.source)
    local list, mean, square = {}, 0, 0
    for row, one in ipairs(radii) do
        local r = one["r" .. i]
        list[row], mean, square = r, mean + r / POLES, square + r ^ 2 / POLES
    end
    table.sort(list)
    local sd = math.sqrt(case.mean_square - case.mean ^ 2)
    figures.near("mean, m", mean, case.mean, 3 * sd / math.sqrt(POLES))
    -- the fourth moment decides: four standard errors of the sample itself
    local fourth = 0
    for _, r in ipairs(list) do
        fourth = fourth + (r ^ 2 - square) ^ 2 / POLES
    end
    figures.near("mean square, m2", square, case.mean_square, 4 * math.sqrt(fourth / POLES))
    -- of the share below the median 3 / (2 sqrt(N)), over the density there, which is that of the closed form
    local density = case.exponent * case.median ^ (-1 - case.exponent) /
        (case.min ^ -case.exponent - case.max ^ -case.exponent)
    figures.near("median, m", list[POLES // 2], case.median, 3 / (2 * math.sqrt(POLES)) / density)
end

local b = reference.baecher
figures.case("DFN.baecher.P32", "Discs after Baecher in a box: intensity of 20 networks, mean number along the mean "
    .. "pole, and of networks to which discs are added until an intensity is reached.", b.source)

local function network(seed, given)
    local model = talus.model { seed = seed }
    model:generate("box", { min = { 0, 0, 0 }, max = { b.box, b.box, b.box }, density = 2500 })
    given.joint, given.dip, given.dip_direction, given.fisher_k = "D", 35, 210, b.kappa
    given.size, given.exponent, given.size_min, given.size_max = "power_law", b.exponent, b.min, b.max
    return model:generate("dfn", given).report
end

local p32, p10 = 0, 0
for seed = 1, 20 do
    local report = network(seed, { number = math.floor(b.p30 * (b.box + 2 * b.max) ^ 3 + 0.5) })
    p32, p10 = p32 + report.p32 / 20, p10 + report.p10 / 20
end
local error = 3 * b.deviation / math.sqrt(20)
figures.near("P32 of a number, 1/m", p32, b.p32, error)
figures.near("P10 along the mean pole, 1/m", p10, b.p10, error)
for seed = 1, 3 do
    -- the last disc adds at most that of the largest radius
    figures.between(("P32 beyond what was asked for, seed %d"):format(seed), network(seed, { p32 = 0.3 }).p32 - 0.3, 0,
        math.pi * b.max ^ 2 / b.box ^ 3)
end

figures.finish()
