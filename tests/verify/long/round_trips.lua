-- Models that are written to files of every format and read again. tests/lua/test_round_trips.lua does the same with fewer.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local files = require "import_files"
local round_trips = require "round_trips"

local MODELS = 900 -- of which some 350 are clear
-- Rounding of places over the size of a model, and of volumes, relative.
local PLACE, VOLUME = 1e-15, 1e-13
-- Of what is read over `weld`. Corners are off by half of it; one goes to where its planes meet, which is farther where they meet flatly.
local WELDED = 4
-- What is taken for none is smaller than `flat`, some 1e-4 of the median size of the blocks, or than 2e-4 of a block.
local FINE = 1e-3

local ABOUT = MODELS .. " random models: boxes cut by one to five joints, walls, hulls of points, and parts joined to bodies that are not convex. "

local function compare(what, clear, others)
    figures.between(what .. ": models that are clear", clear.count, MODELS / 3, MODELS)
    figures.equal(what .. ": blocks that are lost, or have other faces", clear.lost, 0)
    figures.between(what .. ": largest way of a vertex over the size of the model", clear.vertex, 0, PLACE)
    figures.between(what .. ": largest way of a centroid over the size of the model", clear.centroid, 0, PLACE)
    figures.between(what .. ": largest change of a volume, relative", clear.volume, 0, VOLUME)
    figures.between(what .. ": others: largest way of a vertex over the size of the model", others.vertex, 0, FINE)
    figures.between(what .. ": others: models refused for a block thinner than flat", others.refused, 0, 0.01 * MODELS)
end

figures.case("I.written", ABOUT .. "They are written by model:write_blocks and read again. A model is clear where no feature of it is below ten times `flat`, or "
    .. "ten times 2e-4 of a block's size: its blocks come back as they were, to the rounding of the digits.", "the model that is written")
for _, ending in ipairs(round_trips.written_endings) do
    compare(ending, round_trips.many(MODELS, function(seed) return round_trips.written(seed, ending) end))
end

figures.case("I.others", ABOUT .. "They are turned by any angle and written as other programs do, with objects and faces in any order, faces inside out "
    .. "(but of PLY and VTK, where all are one object), and in units of 1e-3, 1, 25.4 and 1e4 m.", "the model that is written")
local endings = {}
for ending in pairs(files.writers) do
    endings[#endings + 1] = ending
end
table.sort(endings)
for _, ending in ipairs(endings) do
    compare(ending, round_trips.many(MODELS, function(seed)
        return round_trips.of_others(seed, ending, round_trips.units[seed // 4 % 4 + 1])
    end))
end

figures.case("I.weld", ABOUT .. "Each triangle of STL has its own corners, which are off by up to half of `weld`; features are larger than ten times `weld`. "
    .. "Distances are over `weld`, volumes over the area times `weld`.", "the model that is written")
for _, weld in ipairs { 1e-3, 1e-4, 1e-5, 1e-6 } do
    local of = round_trips.many(MODELS, function(seed)
        local errors = round_trips.welded(seed, weld)
        return errors, errors ~= nil
    end)
    local what = ("weld = %g m"):format(weld)
    figures.between(what .. ": models", of.count, MODELS / 3, MODELS)
    figures.equal(what .. ": blocks that are lost, or have other faces", of.lost, 0)
    figures.between(what .. ": largest way of a vertex", of.vertex, 0, WELDED)
    figures.between(what .. ": largest way of a centroid", of.centroid, 0, WELDED)
    figures.between(what .. ": largest change of a volume", of.volume, 0, 0.5)
end
figures.finish()
