-- poles.lua - talus.poles("poles.csv"): measured orientations of joints, their mean after Fisher, sets and draws.
--
-- Poles are axes: n and -n are one. Formulas are in talus/poles.h. Sets are found by k-means: the distance of a pole n from
-- the axis a of a set is 1 - (n . a)^2, and the axis of a set is the principal one of sum w n n^T. It begins with poles
-- that are drawn by keys, far ones first, several times; the least sum of distances counts.
local arguments = require "talus.arguments"
local chance = require "talus.chance"

local fail = arguments.fail
local poles = {}
poles.__index = poles

-- Starts of k-means, and steps of each.
local STARTS, MOST_STEPS = 20, 200
-- Terzaghi's weight ends here: a joint nearly along the scan line would count for all others.
local MOST_WEIGHT = 10
-- Bytes of a file: a device may never end.
local MOST_BYTES = 1 << 26

-- planes: a sorted list of {dip, dip_direction, weight}.
local function make(planes)
    local self = setmetatable({ planes = planes, normals = {}, weights = {} }, poles)
    local sum = 0
    for _, plane in ipairs(planes) do
        sum = sum + plane[3]
    end
    for i, plane in ipairs(planes) do
        self.normals[i] = chance.normal(plane[1], plane[2])
        self.weights[i] = plane[3] * #planes / sum
    end
    return self
end

local function dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

local function check_self(name, self)
    if getmetatable(self) ~= poles then
        fail("%s: call it as p:%s(...) of what talus.poles gives", name, name)
    end
end

function poles.__len(self)
    return #self.planes
end

local methods = {}

-- {dip =, dip_direction =, resultant =, kappa =, cone =}, degrees; resultant is R / N.
function methods.mean(self)
    local mean = chance.mean(self.normals, self.weights)
    mean.dip, mean.dip_direction = chance.attitude(mean.normal)
    return mean
end

-- The same planes with Terzaghi's weights 1 / |cos| of the angle between pole and scan line.
function methods.terzaghi(self, given)
    arguments.table("terzaghi", given, "the argument")
    arguments.check_keys("terzaghi", given, { "most", "plunge", "trend" })
    local trend = arguments.number("terzaghi", given, "trend", nil, 0, 360)
    local plunge = arguments.number("terzaghi", given, "plunge", nil, -90, 90)
    local most = arguments.number("terzaghi", given, "most", MOST_WEIGHT, 1, 1000)
    -- The plane whose normal is the scan line.
    local line = chance.normal(90 - math.abs(plunge), plunge > 0 and (trend + 180) % 360 or trend)
    local planes = {}
    for i, plane in ipairs(self.planes) do
        local cosine = math.abs(dot(self.normals[i], line))
        planes[i] = { plane[1], plane[2], plane[3] * math.min(1 / math.max(cosine, 1e-9), most) }
    end
    return make(planes)
end

-- The sets of each pole by axes; the sum of distances.
local function assign(self, axes)
    local of, sum = {}, 0
    for i, normal in ipairs(self.normals) do
        local best
        for k, axis in ipairs(axes) do
            local distance = 1 - dot(normal, axis) ^ 2
            if not best or distance < best then
                best, of[i] = distance, k
            end
        end
        sum = sum + self.weights[i] * best
    end
    return of, sum
end

local function axes_of(self, of, axes)
    local made = {}
    for k = 1, #axes do
        local normals, weights = {}, {}
        for i, set in ipairs(of) do
            if set == k then
                normals[#normals + 1], weights[#weights + 1] = self.normals[i], self.weights[i]
            end
        end
        made[k] = #normals > 0 and chance.axis(normals, weights) or axes[k]
    end
    return made
end

-- Poles to begin with: each is drawn with the probability of its distance from those before.
local function start(self, count, seed, attempt)
    local axes, distance = {}, {}
    for i = 1, #self.normals do
        distance[i] = self.weights[i]
    end
    for k = 1, count do
        local sum, at = 0, 1
        for i = 1, #distance do
            sum = sum + distance[i]
        end
        local rest = chance.uniform(seed, attempt, "poles.sets", k) * sum
        while at < #distance and rest >= distance[at] do
            rest = rest - distance[at]
            at = at + 1
        end
        axes[k] = self.normals[at]
        for i, normal in ipairs(self.normals) do
            distance[i] = math.min(distance[i], self.weights[i] * math.max(1 - dot(normal, axes[k]) ^ 2, 0))
        end
    end
    return axes
end

local function cluster(self, count, seed, attempt)
    local axes = start(self, count, seed, attempt)
    local of, sum = assign(self, axes)
    for _ = 1, MOST_STEPS do
        local next_axes = axes_of(self, of, axes)
        local next_of, next_sum = assign(self, next_axes)
        if next_sum >= sum then
            break
        end
        axes, of, sum = next_axes, next_of, next_sum
    end
    return of, sum
end

-- A list of the sets, the one of the most weight first.
function methods.sets(self, count, options)
    if math.type(count) ~= "integer" or count < 1 or count > #self.planes then
        fail("sets: the number of sets must be a whole number in [1, %d], the number of poles, not %s", #self.planes,
            arguments.describe(count))
    end
    options = arguments.table("sets", options or {}, "the second argument")
    arguments.check_keys("sets", options, { "seed" })
    local seed = math.tointeger(arguments.number("sets", options, "seed", 1, 0, 2 ^ 53)) or
        fail("sets: seed must be a whole number")
    local of, least
    for attempt = 1, STARTS do
        local other, sum = cluster(self, count, seed, attempt)
        if not least or sum < least then
            of, least = other, sum
        end
    end
    local lists, weight = {}, {}
    for k = 1, count do
        lists[k], weight[k] = {}, 0
    end
    for i, plane in ipairs(self.planes) do
        local k = of[i]
        lists[k][#lists[k] + 1] = plane
        weight[k] = weight[k] + plane[3]
    end
    local order, made = {}, {}
    for k = 1, count do
        if #lists[k] > 0 then
            order[#order + 1] = k
        end
    end
    table.sort(order, function(a, b)
        if weight[a] == weight[b] then
            return lists[a][1][1] < lists[b][1][1] or lists[a][1][1] == lists[b][1][1] and
                lists[a][1][2] < lists[b][1][2]
        end
        return weight[a] > weight[b]
    end)
    for i, k in ipairs(order) do
        made[i] = make(lists[k])
    end
    return made
end

-- n planes {dip =, dip_direction =}, each one of the measured planes; with distribution = "fisher" about their mean.
function methods.draw(self, number, options)
    if math.type(number) ~= "integer" or number < 1 or number > 1e7 then
        fail("draw: the number must be a whole number in [1, 10000000], not %s", arguments.describe(number))
    end
    options = arguments.table("draw", options or {}, "the second argument")
    arguments.check_keys("draw", options, { "distribution", "seed" })
    local seed = math.tointeger(arguments.number("draw", options, "seed", 1, 0, 2 ^ 53)) or
        fail("draw: seed must be a whole number")
    local how = arguments.choice("draw", options, "distribution", "measured", { "fisher", "measured" })
    local mean = self:mean()
    if how == "fisher" and not (mean.kappa < math.huge) then
        fail("draw: %d pole%s no concentration: draw measured ones", #self, #self == 1 and " has" or "s that agree have")
    end
    local list = {}
    for i = 1, number do
        local dip, direction
        if how == "fisher" then
            dip, direction = chance.fisher(mean.dip, mean.dip_direction, mean.kappa, chance.uniform(seed, i, "poles.draw", 0),
                chance.uniform(seed, i, "poles.draw", 1))
        else
            local rest, at = chance.uniform(seed, i, "poles.draw", 2) * #self, 1
            while at < #self and rest >= self.weights[at] do
                rest = rest - self.weights[at]
                at = at + 1
            end
            dip, direction = self.planes[at][1], self.planes[at][2]
        end
        list[i] = { dip = dip, dip_direction = direction }
    end
    return list
end

-- A list of {dip, dip_direction}, sorted, as talus.stereonet takes for the planes of a set.
function methods.list(self)
    local list = {}
    for i, plane in ipairs(self.planes) do
        list[i] = { plane[1], plane[2] }
    end
    return list
end

-- Writes them as a table that talus.poles and the generators read.
function methods.write(self, path)
    if type(path) ~= "string" then
        fail("write: name the file, not %s", arguments.describe(path))
    end
    local lines = { "dip,dip_direction,weight" }
    for i, plane in ipairs(self.planes) do
        lines[i + 1] = ("%s,%s,%s"):format(chance.number_text(plane[1]), chance.number_text(plane[2]),
            chance.number_text(plane[3]))
    end
    arguments.write("write", path, table.concat(lines, "\n") .. "\n")
end

for name, f in pairs(methods) do
    poles[name] = arguments.call(function(self, ...)
        check_self(name, self)
        return f(self, ...)
    end)
end

-- Planes given as a list of {dip, dip_direction} become the text of a table, which has one reader.
local function text_of(list)
    local lines = { "dip,dip_direction,weight" }
    for i, plane in ipairs(list) do
        local where = ("poles, plane %d"):format(i)
        arguments.table(where, plane, "the plane")
        local values = { dip = plane.dip or plane[1], dip_direction = plane.dip_direction or plane[2], weight = plane.weight or
            plane[3] or 1 }
        lines[i + 1] = ("%s,%s,%s"):format(chance.number_text(arguments.number(where, values, "dip", nil, 0, 90)),
            chance.number_text(arguments.number(where, values, "dip_direction", nil, 0, 360)),
            chance.number_text(arguments.number(where, values, "weight", nil, 1e-9, 1e9)))
    end
    return table.concat(lines, "\n")
end

-- Planes measured by a compass, whose north lies `declination` east of true north.
local function to_true_north(planes, declination)
    if declination ~= 0 then
        for _, plane in ipairs(planes) do
            plane[2] = (plane[2] + declination) % 360
        end
        table.sort(planes, function(a, b)
            for k = 1, 3 do
                if a[k] ~= b[k] then
                    return a[k] < b[k]
                end
            end
            return false
        end)
    end
    return planes
end

local function read(given, options)
    options = arguments.table("poles", options or {}, "the second argument")
    arguments.check_keys("poles", options, { "declination" })
    local declination = arguments.number("poles", options, "declination", 0, -180, 180)
    local text, what
    if type(given) == "table" then
        text, what = text_of(given), "the list"
    elseif type(given) == "string" then
        what = "'" .. given .. "'"
        local file, reason = io.open(given, "rb")
        if file then
            text, reason = file:read(MOST_BYTES)
            text = text or not reason and "" -- an empty file
        end
        if not text then
            fail("poles: %s cannot be read: %s", what, reason and reason:gsub("^.*: ", "") or "it is no regular file")
        end
        file:close()
    else
        fail("poles: name a table of planes, or give a list of {dip, dip_direction}, not %s", arguments.describe(given))
    end
    local planes, sentence = chance.read_poles(text)
    if not planes then
        fail("poles: %s: %s", what, sentence)
    end
    return make(to_true_north(planes, declination))
end

return arguments.call(read)
