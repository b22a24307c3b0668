-- layers.lua - random layered models whose laws are given by groups and by the names of planes.
--
-- Layers of rock between beds, cut by vertical joints, are in a group each, so that "bed:2" is all that lies between two groups. A law for
-- the one and for the other does the same to the bit, whatever the order of lines.
local every_law = require "every_law"
local shapes = require "shapes"
local talus = require "talus"

local layers = {}

local KN, PRESSURE = 1e9, 1e5
local LAWS = every_law(KN, PRESSURE)
local STEPS, ZONED_STEPS = 40, 10

local function whole(random, from, to)
    return math.floor(random(from, to + 1))
end

local function shuffle(random, list)
    for i = #list, 2, -1 do
        local k = whole(random, 1, i)
        list[i], list[k] = list[k], list[i]
    end
    return list
end

-- Layers 1 to n between beds, each in a group of its own, with vertical joints through all of them.
local function layered(number)
    local random = shapes.random(number)
    local count, length = whole(random, 2, 4), 3
    local model = talus.model { seed = number, threads = whole(random, 1, 2) }
    model:generate("box", { min = { 0, 0, 0 }, max = { length, 1.2, count }, density = 2500 })
    local dips = {}
    for bed = 1, count - 1 do
        dips[bed] = random(0, 15)
        model:generate("joint", { joint = "bed", dip = dips[bed], dip_direction = 90, origin = { length / 2, 0.6, bed } })
    end
    local crosses = whole(random, 0, 2)
    for _ = 1, crosses do
        model:generate("joint", { joint = "cross", dip = random(70, 90), dip_direction = random(60, 120),
            origin = { random(0.5, 2.5), 0.6, count / 2 } })
    end
    model:blocks { where = function(block) return block.centroid[3] < 0.5 end }:fix()
    for layer = 1, count do
        local parts = model:blocks { where = function(block)
            local below, at = 0, block.centroid
            for bed = 1, count - 1 do -- beds cross only outside of the rock
                local dip = math.rad(dips[bed])
                below = below + ((at[1] - length / 2) * math.sin(dip) + (at[3] - bed) * math.cos(dip) > 0 and 1 or 0)
            end
            return below == layer - 1
        end }
        parts:set { group = "layer " .. layer }
    end
    return model, count, random, crosses > 0
end

local function state(model)
    local text = {}
    for _, block in ipairs(model:blocks()) do
        local p, u, v = block.centroid, block.displacement, block.velocity
        text[#text + 1] = string.format("%d %a %a %a %a %a %a %a %a %a", block.id, p[1], p[2], p[3], u[1], u[2], u[3], v[1], v[2], v[3])
    end
    return table.concat(text, "\n")
end

-- What names the contacts between two layers, in each of the ways.
local ways = {
    groups = function(_, one, other) return { between = { one, other } } end,
    selections = function(model, one, other)
        return { between = { model:blocks { group = one }, model:blocks { group = other } } }
    end,
    contacts = function(model, one, other)
        return { contacts = model:contacts { between = { model:blocks { group = one }, model:blocks { group = other } } } }
    end,
    joint = function(model, one, other) return { joint = "bed", between = { other, model:blocks { group = one } } } end,
}

-- A random model by planes and by each of the ways. Gives the ways by which it is not the same to the bit, and whether the laws of the
-- beds make a difference. Every fourth model has zones: segments of flush faces obey such laws, too.
function layers.differing(number)
    local reference, count, random, crossed = layered(number)
    local laws, lines = {}, {}
    for layer = 1, count - 1 do
        laws[layer] = LAWS[whole(random, 1, #LAWS)]
        lines[layer] = layer
    end
    local others, zoned = LAWS[whole(random, 1, #LAWS)], number % 4 == 0
    local function run(model, which)
        shuffle(random, lines)
        model:joint("*", others.law, others.params)
        for _, layer in ipairs(which and lines or {}) do
            model:joint(which(model, layer), laws[layer].law, laws[layer].params)
        end
        for layer = 1, crossed and count - 1 or 0 do -- what comes to lie on the other layer across a vertical joint is no bed
            model:joint({ joint = "cross", between = { "layer " .. layer, "layer " .. layer + 1 } }, others.law, others.params)
        end
        if zoned then
            model:solid("rock", "elastic", { young = 1e10, poisson = 0.2 })
            model:blocks():deformable { zone = 0.8, solid = "rock" }
        end
        model:cycle(zoned and ZONED_STEPS or STEPS)
        return state(model)
    end
    local expected, wrong = run(reference, function(_, layer) return "bed:" .. layer end), {}
    for _, way in ipairs(layers.ways) do
        local which = ways[way]
        local got = run(layered(number), function(m, layer) return which(m, "layer " .. layer, "layer " .. layer + 1) end)
        if got ~= expected then
            wrong[#wrong + 1] = way
        end
    end
    return wrong, run((layered(number))) ~= expected
end

layers.ways = { "groups", "selections", "contacts", "joint" }

return layers
