-- draws.lua - the draws of a realisation: each a pure function of (seed, row, name), as talus/draws.h tells.
--
-- draw.normal("friction", 35, 3, { min = 20 }) gives a number. The same name gives the same number again; with another
-- distribution it is an error. What was drawn is kept in `drawn`, by name, for the row of the realisation.
--
-- Correlated draws of a Latin hypercube: a sum of normal numbers of other strata has none of its own. So the stratum of each row is
-- the rank of its sum among those of all rows (Stein, Technometrics 29, 1987). These are found once in a process.
local arguments = require "talus.arguments"
local chance = require "talus.chance"

local fail = arguments.fail
local draws = {}

-- Realisations up to which correlated draws have strata, for all of them are held at once.
local MOST_SPREAD = 1000000
-- Share of a stratum that is left free at its ends, so that rounding takes no row across.
local INSIDE = 1e-6

local function finite(where, what, value)
    if type(value) ~= "number" or value ~= value or math.abs(value) == math.huge then
        fail("%s: %s must be a number, not %s", where, what, arguments.describe(value))
    end
    return value
end

local function positive(where, what, value)
    if finite(where, what, value) <= 0 then
        fail("%s: %s = %s must be > 0", where, what, value)
    end
    return value
end

local function check_name(where, name)
    if type(name) ~= "string" or name == "" or name:find "[%c,\"]" then
        fail("%s: the first argument is the name of the draw, a text without commas, not %s", where,
            arguments.describe(name))
    end
    if name == "row" or name == "error" then
        fail("%s: '%s' is the name of a column of every file of rows: give the draw another name", where, name)
    end
    return name
end

-- The ends of a range {min =, max =}, infinite where they are left out.
local function read_range(where, range)
    if range == nil then
        return -math.huge, math.huge
    end
    arguments.table(where, range, "the range")
    arguments.check_keys(where, range, { "max", "min" })
    local min = range.min and finite(where, "min", range.min) or -math.huge
    local max = range.max and finite(where, "max", range.max) or math.huge
    if min > max then
        fail("%s: min = %s is above max = %s", where, min, max)
    end
    return min, max
end

-- What mean, sd and range make of u in (0, 1).
local function cut_off(where, family, u, mean, sd, min, max)
    local value = chance.quantile(family, u, mean, sd, 0, min, max)
    if not value then
        fail("%s: fewer than 1 in 1000 draws of mean %s and sd %s are in [%s, %s]: widen the range", where, mean, sd, min,
            max)
    end
    return value
end

local function check_normal(where, family, mean, sd)
    finite(where, "the mean", mean)
    if finite(where, "sd", sd) < 0 then
        fail("%s: sd = %s must be >= 0", where, sd)
    end
    if family == "lognormal" then
        positive(where, "the mean", mean)
    end
end

-- The lower triangular root of a correlation matrix, by Cholesky; nil when it is none.
local function root_of(matrix, count)
    local root = {}
    for i = 1, count do
        root[i] = {}
        for j = 1, i do
            local sum = matrix[i][j]
            for k = 1, j - 1 do
                sum = sum - root[i][k] * root[j][k]
            end
            if i == j then
                -- rounding of a matrix of full correlation
                if sum < -1e-12 then
                    return nil
                end
                root[i][i] = math.sqrt(math.max(sum, 0))
            else
                root[i][j] = root[j][j] > 0 and sum / root[j][j] or 0
                if root[j][j] == 0 and math.abs(sum) > 1e-9 then
                    return nil
                end
            end
        end
    end
    return root
end

-- The matrix of a number, of two draws, or of a table of rows.
local function read_correlation(where, given, count)
    if type(given) == "number" then
        if count ~= 2 then
            fail("%s: one correlation is for two draws: give a matrix of %d rows", where, count)
        end
        given = { { 1, given }, { given, 1 } }
    end
    arguments.table(where, given, "the correlation")
    for i = 1, count do
        for j = 1, count do
            local value = type(given[i]) == "table" and given[i][j]
            if type(value) ~= "number" or not (math.abs(value) <= 1) or (i == j and value ~= 1) or
                value ~= (type(given[j]) == "table" and given[j][i]) then
                fail("%s: entry %d, %d of the correlation matrix must be in [-1, 1], 1 on the diagonal, and as entry %d, %d",
                    where, i, j, j, i)
            end
        end
    end
    return root_of(given, count) or fail("%s: the correlation matrix is none: no draws can have these correlations together",
        where)
end

local function read_marginal(where, given)
    arguments.table(where, given, "each draw")
    arguments.check_keys(where, given, { 1, 2, "distribution", "max", "min" })
    local family = arguments.choice(where, given, "distribution", "normal", { "normal", "lognormal" })
    check_normal(where, family, given[1], given[2])
    local min, max = read_range(where, { min = given.min, max = given.max })
    return { family = family, mean = given[1], sd = given[2], min = min, max = max }
end

-- Correlated normal numbers of a row: the root times independent ones.
local function correlated(seed, row, latin, names, root)
    local normal, sums = {}, {}
    for i, name in ipairs(names) do
        normal[i], sums[i] = chance.normal_quantile(chance.uniform(seed, row, name, 0, latin)), 0
        for k = 1, i do
            sums[i] = sums[i] + root[i][k] * normal[k]
        end
    end
    return sums
end

-- The shares below correlated numbers, lists by draw and row: in each stratum one row. A share lies as far into its stratum as the
-- number lies in that where it would fall.
local function spread(seed, latin, names, root)
    local shares, order = {}, {}
    for i = 1, #names do
        shares[i] = {}
    end
    for row = 1, latin do
        order[row] = row
        for i, sum in ipairs(correlated(seed, row, latin, names, root)) do
            shares[i][row] = sum
        end
    end
    for _, share in ipairs(shares) do
        table.sort(order, function(a, b)
            return share[a] < share[b] or (share[a] == share[b] and a < b)
        end)
        for rank, row in ipairs(order) do
            local at = latin * chance.normal_below(share[row])
            share[row] = (rank - 1 + math.min(math.max(at - math.floor(at), INSIDE), 1 - INSIDE)) / latin
        end
    end
    return shares
end

-- The same, kept while seed, names and correlations are the same.
local kept = {}
local function spread_once(where, seed, latin, names, root)
    if latin > MOST_SPREAD then
        fail("%s: with latin = true correlated draws are for at most %d realisations, not %d", where, MOST_SPREAD, latin)
    end
    local words = { seed, latin }
    for i, name in ipairs(names) do
        words[#words + 1] = name
        table.move(root[i], 1, i, #words + 1, words)
    end
    local set, key = table.concat(names, "\n"), table.concat(words, "\n")
    if not kept[set] or kept[set].key ~= key then
        kept[set] = { key = key, shares = spread(seed, latin, names, root) }
    end
    return kept[set].shares
end

-- The draws of a row. `latin`: rows of the Latin hypercube, 0 for none.
function draws.new(seed, row, latin)
    local draw, drawn, known = { row = row }, {}, {}

    local function uniform(name, part)
        return chance.uniform(seed, row, name, part or 0, latin)
    end

    -- Two distributions of one name would be drawn by the same numbers.
    local function claim(where, name, distribution)
        if known[name] and known[name] ~= distribution then
            fail("%s: '%s' is drawn as %s already: give this draw another name", where, name, known[name])
        end
        known[name] = distribution
    end

    -- Keeps a value under a name, of one distribution only.
    local function keep(where, name, value, distribution)
        claim(where, name, distribution)
        drawn[name] = value
        return value
    end

    local function told(family, ...)
        local values = table.pack(...)
        for i = 1, values.n do
            values[i] = type(values[i]) == "number" and chance.number_text(values[i]) or tostring(values[i])
        end
        return family .. "(" .. table.concat(values, ", ") .. ")"
    end

    local function add(family, f)
        draw[family] = arguments.call(function(name, ...)
            local where = ("draw.%s(%s)"):format(family, type(name) == "string" and ("'%s'"):format(name) or "")
            return f(where, check_name(where, name), ...)
        end)
    end

    for _, family in ipairs { "normal", "lognormal" } do
        add(family, function(where, name, mean, sd, range)
            check_normal(where, family, mean, sd)
            local min, max = read_range(where, range)
            return keep(where, name, cut_off(where, family, uniform(name), mean, sd, min, max),
                told(family, mean, sd, min, max))
        end)
    end

    add("uniform", function(where, name, min, max)
        if finite(where, "min", min) > finite(where, "max", max) then
            fail("%s: min = %s is above max = %s", where, min, max)
        end
        return keep(where, name, chance.quantile("uniform", uniform(name), min, max), told("uniform", min, max))
    end)

    add("triangular", function(where, name, min, mode, max)
        finite(where, "min", min)
        finite(where, "mode", mode)
        if not (min <= mode and mode <= finite(where, "max", max) and min < max) then
            fail("%s: min = %s, mode = %s and max = %s are not in this order", where, min, mode, max)
        end
        return keep(where, name, chance.quantile("triangular", uniform(name), min, mode, max),
            told("triangular", min, mode, max))
    end)

    add("power_law", function(where, name, exponent, min, max)
        positive(where, "the exponent", exponent)
        if positive(where, "min", min) > positive(where, "max", max) then
            fail("%s: min = %s is above max = %s", where, min, max)
        end
        return keep(where, name, chance.quantile("power_law", uniform(name), exponent, min, max),
            told("power_law", exponent, min, max))
    end)

    add("fisher", function(where, name, dip, dip_direction, kappa)
        local given = { dip = dip, dip_direction = dip_direction }
        arguments.number(where, given, "dip", nil, 0, 90)
        arguments.number(where, given, "dip_direction", nil, 0, 360)
        positive(where, "the concentration", kappa)
        local how = told("fisher", dip, dip_direction, kappa)
        claim(where, name, how)
        local a, b = chance.fisher(dip, dip_direction, kappa, uniform(name, 0), uniform(name, 1))
        return keep(where, name .. ".dip", a, how), keep(where, name .. ".dip_direction", b, how)
    end)

    add("choice", function(where, name, list, weights)
        arguments.table(where, list, "the list")
        if #list == 0 then
            fail("%s: the list is empty", where)
        end
        if weights ~= nil and #arguments.table(where, weights, "the weights") > #list then
            fail("%s: there are %d weights for a list of %d: give one for each", where, #weights, #list)
        end
        local sum, ends = 0, {}
        for i = 1, #list do
            local weight = 1
            if weights then
                weight = weights[i]
            end
            if type(weight) ~= "number" or not (weight >= 0 and weight < math.huge) then
                fail("%s: weight %d must be a number >= 0, not %s", where, i, arguments.describe(weight))
            end
            sum = sum + weight
            ends[i] = sum
        end
        if not (sum > 0) then
            fail("%s: no weight is above 0", where)
        end
        local at, i = uniform(name) * sum, 1
        while i < #list and at >= ends[i] do
            i = i + 1
        end
        local plain = type(list[i]) == "number" or type(list[i]) == "string" or type(list[i]) == "boolean"
        keep(where, name, plain and list[i] or i, told("choice", #list, table.unpack(ends)))
        return list[i]
    end)

    add("seed", function(where, name)
        return keep(where, name, chance.key(seed, row, name) >> 33, "seed")
    end)

    draw.correlated = arguments.call(function(names, marginals, correlation)
        local where = "draw.correlated"
        arguments.table(where, names, "the names")
        arguments.table(where, marginals, "the second argument")
        local count = #names
        if count < 2 or #marginals ~= count then
            fail("%s: %d names and %d pairs {mean, sd}: give two or more, and as many of both", where, count, #marginals)
        end
        for i = 1, count do
            check_name(where, names[i])
        end
        local root, values = read_correlation(where, correlation, count), {}
        local shares = latin > 0 and spread_once(where, seed, latin, names, root)
        local sums = not shares and correlated(seed, row, latin, names, root)
        for i = 1, count do
            local m = read_marginal(("%s, '%s'"):format(where, names[i]), marginals[i])
            local share = shares and shares[i][row] or chance.normal_below(sums[i])
            values[i] = keep(where, names[i], cut_off(where, m.family, share, m.mean, m.sd, m.min, m.max),
                told("correlated " .. m.family, m.mean, m.sd, m.min, m.max, table.unpack(root[i])))
        end
        return table.unpack(values)
    end)

    return draw, drawn
end

return draws
