-- realised.lua - what talus.realisations gives: the rows, and statistics of them.
--
-- Rows with an error count in none of these. Statistics of numbers leave out rows that lack the field.
local arguments = require "talus.arguments"
local chance = require "talus.chance"
local draws = require "talus.draws"

local fail = arguments.fail
local set = {}
set.__index = set

function set.__len(self)
    return #self.list
end

-- Whether a row has a field's event: true, or a number that is not 0.
local function hit(name, row, field)
    local value = row[field]
    if type(value) == "number" and value == value then
        return value ~= 0
    elseif type(value) == "boolean" then
        return value
    end
    fail("%s: realisation %d has no '%s' that is true, false or a number: a screen that decides is to give it, too", name,
        row.row, tostring(field))
end

-- Hits and rows of a field.
function set.count(self, field)
    local hits, count = 0, 0
    for _, row in ipairs(self.list) do
        if not row.error then
            count = count + 1
            hits = hits + (hit("probability", row, field) and 1 or 0)
        end
    end
    return hits, count
end

set.hit = hit

local function known_field(self, name, field)
    if type(field) ~= "string" then
        fail("%s: name a field, as in set:%s(\"volume\"), not %s", name, name, arguments.describe(field))
    end
    for i = 3, #self.columns do
        if self.columns[i] == field then
            return
        end
    end
    local nearest = arguments.nearest(field, table.move(self.columns, 3, #self.columns, 1, {}))
    fail("%s: no realisation has a field '%s'%s", name, field, nearest and ("; did you mean '%s'?"):format(nearest) or "")
end

-- The numbers of a field, and their rows.
local function numbers_of(self, name, field)
    known_field(self, name, field)
    local list, of = {}, {}
    for _, row in ipairs(self.list) do
        local value = row[field]
        value = value == true and 1 or value == false and 0 or value
        if not row.error and type(value) == "number" and value == value then
            list[#list + 1] = value
            of[#of + 1] = row
        end
    end
    if #list == 0 then
        fail("%s: no realisation has a number '%s'", name, field)
    end
    return list, of
end

local methods = {}

function methods.probability(self, field)
    known_field(self, "probability", field)
    local hits, count = self:count(field)
    if count == 0 then
        fail("probability: there is no realisation without an error")
    end
    local low, high = chance.interval(hits, count)
    return hits / count, low, high
end

function methods.mean(self, field)
    local list = numbers_of(self, "mean", field)
    local sum = 0
    for _, value in ipairs(list) do
        sum = sum + value / #list
    end
    return sum
end

function methods.sd(self, field)
    local list = numbers_of(self, "sd", field)
    if #list < 2 then
        fail("sd: '%s' has one number only", field)
    end
    local mean, sum = methods.mean(self, field), 0
    if mean - mean ~= 0 then
        fail("sd: '%s' has numbers that are not finite", field)
    end
    for _, value in ipairs(list) do
        sum = sum + (value - mean) * (value - mean)
    end
    return math.sqrt(sum / (#list - 1))
end

-- Between the sorted numbers linearly: the least at 0, the largest at 1.
function methods.quantile(self, field, share)
    local list = numbers_of(self, "quantile", field)
    if type(share) ~= "number" or not (share >= 0 and share <= 1) then
        fail("quantile: the share must be in [0, 1], not %s", arguments.describe(share))
    end
    table.sort(list)
    local place = 1 + share * (#list - 1)
    local low = math.floor(place)
    local part, a, b = place - low, list[low], list[math.min(low + 1, #list)]
    -- a part of an infinite difference is no number
    if part == 0 or a == b or a == -math.huge then
        return a
    end
    return a + part * (b - a)
end

-- {edges = {n + 1 numbers}, counts = {n}}; the last interval has both of its ends.
function methods.histogram(self, field, intervals)
    local list = numbers_of(self, "histogram", field)
    intervals = intervals or 20
    if math.type(intervals) ~= "integer" or intervals < 1 or intervals > 10000 then
        fail("histogram: the number of intervals must be in [1, 10000], not %s", arguments.describe(intervals))
    end
    table.sort(list)
    local low, high = list[1] + 0.0, list[#list] + 0.0 -- differences of large integers wrap
    if high - low == math.huge or low == -math.huge or high == math.huge then
        fail("histogram: '%s' has numbers that are not finite", field)
    end
    local result = { edges = {}, counts = {} }
    for i = 0, intervals do
        result.edges[i + 1] = i == intervals and high or low + (high - low) * i / intervals
    end
    for i = 1, intervals do
        result.counts[i] = 0
    end
    local at = 1
    for _, value in ipairs(list) do
        while at < intervals and value >= result.edges[at + 1] do
            at = at + 1
        end
        result.counts[at] = result.counts[at] + 1
    end
    return result
end

function methods.rows(self)
    local list = {}
    for i, row in ipairs(self.list) do
        local copy = {}
        for name, value in pairs(row) do
            copy[name] = value
        end
        list[i] = copy
    end
    return list
end

-- The ranks of numbers from 1; equal ones have the mean of theirs.
local function ranks(list)
    local order, rank = {}, {}
    for i = 1, #list do
        order[i] = i
    end
    table.sort(order, function(a, b)
        if list[a] == list[b] then
            return a < b
        end
        return list[a] < list[b]
    end)
    local i = 1
    while i <= #order do
        local j = i
        while j < #order and list[order[j + 1]] == list[order[i]] do
            j = j + 1
        end
        for k = i, j do
            rank[order[k]] = (i + j) / 2
        end
        i = j + 1
    end
    return rank
end

-- The correlation of two lists; nil when one of them does not change.
local function correlation(a, b)
    local n, mean_a, mean_b = #a, 0, 0
    for i = 1, n do
        mean_a, mean_b = mean_a + a[i] / n, mean_b + b[i] / n
    end
    local aa, bb, ab = 0, 0, 0
    for i = 1, n do
        local x, y = a[i] - mean_a, b[i] - mean_b
        aa, bb, ab = aa + x * x, bb + y * y, ab + x * y
    end
    return aa > 0 and bb > 0 and ab / math.sqrt(aa * bb) or nil
end

-- A list of {name =, correlation =, rank_correlation =} of all draws that are numbers, the strongest first.
function methods.sensitivity(self, field)
    local list, of = numbers_of(self, "sensitivity", field)
    local result, rank = {}, ranks(list)
    for i = 3, self.last_draw do
        local name = self.columns[i]
        local values, full = {}, name ~= field
        for k, row in ipairs(of) do
            local value = row[name]
            full = full and type(value) == "number" and value == value
            values[k] = value
        end
        local by_rank = full and correlation(ranks(values), rank)
        if by_rank then
            result[#result + 1] = { name = name, rank_correlation = by_rank, correlation = correlation(values, list) }
        end
    end
    table.sort(result, function(a, b)
        local x, y = math.abs(a.rank_correlation), math.abs(b.rank_correlation)
        if x == y then
            return a.name < b.name
        end
        return x > y
    end)
    return result
end

-- The model of a row, built anew.
function methods.model(self, row)
    if math.type(row) ~= "integer" or row < 1 or row > self.number then
        fail("model: the realisation must be a whole number in [1, %d], not %s", self.number, arguments.describe(row))
    end
    return self.build_row(row)
end

for name, f in pairs(methods) do
    set[name] = arguments.call(f)
end

return set
