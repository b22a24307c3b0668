-- Random models that are written and read again come back. tests/verify/long/round_trips.lua does the same with more.
local check = require "check"
local files = require "import_files"
local round_trips = require "round_trips"

-- Rounding of a volume and of places, over those and over the size of the model.
local PLACE, VOLUME = 1e-15, 1e-13
-- What is read of corners that are off by half of `weld` each: a corner goes to where its planes meet, farther where they meet flatly.
local WELDED = 4

local function same(what, of)
    check.equal(of.lost, 0)
    check.holds(of.vertex < PLACE and of.centroid < 2 * PLACE and of.volume < VOLUME, what)
    return of.count
end

local function about(of)
    check.holds(of.vertex < 1e-3 and of.centroid < 1e-3, "what is finer than `flat` moves by little")
end

local compared = 0
for _, ending in ipairs(round_trips.written_endings) do
    local clear, others = round_trips.many(check.cases(40), function(seed) return round_trips.written(seed, ending) end)
    compared = compared + same(ending, clear)
    about(others)
end
for ending in pairs(files.writers) do
    local clear, others = round_trips.many(check.cases(40), function(seed)
        return round_trips.of_others(seed, ending, round_trips.units[seed // 4 % 4 + 1])
    end)
    compared = compared + same(ending, clear)
    about(others)
end
for _, weld in ipairs { 1e-3, 1e-4, 1e-5, 1e-6 } do
    local welded = round_trips.many(check.cases(40), function(seed)
        local errors = round_trips.welded(seed, weld)
        return errors, errors ~= nil
    end)
    check.equal(welded.lost, 0)
    check.holds(welded.vertex < WELDED and welded.centroid < WELDED and welded.volume < WELDED, "within weld")
    compared = compared + welded.count
end
check.holds(compared > 7 * check.cases(40), "models compared")

-- A large block with a bent face among many small ones comes back, though `flat` goes by the small ones.
local talus = require "talus"
local model, vertices = talus.model {}, {}
for k = 0, 7 do
    vertices[k + 1] = { math.pi * (k % 2), math.pi * (k // 2 % 2), math.pi * (k // 4 + (k == 7 and 1e-4 or 0)) }
end
model:generate("polyhedron", { vertices = vertices, density = 2500 })
check.equal(#model:blocks()[1].faces, 6)
for i = 1, 20 do
    model:generate("box", { min = { 2 * math.pi + i, 0, 0 }, max = { 2 * math.pi + i + 0.02, 0.02, 0.02 }, density = 2500 })
end
local path = os.tmpname()
os.remove(path)
for _, ending in ipairs { ".obj", ".stl", ".ply", ".vtk" } do
    local again = talus.model {}
    model:write_blocks(path .. ending)
    again:generate("import", { file = path .. ending, density = 2500 })
    os.remove(path .. ending)
    check.equal(#again:blocks(), 21)
    check.near(again:blocks():max "volume" / model:blocks():max "volume", 1, 2e-5)
end

-- A hull of which two triangles are one face by less than 2e-4 of its size: its triangles bend outward in STL as well.
check.equal(round_trips.written(122, ".stl").lost, 0)
