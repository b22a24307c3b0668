-- A jointed rock slope, after example 4 of Hart, Cundall and Lemos (1988): its blocks, the
-- friction at which a wedge slides out of it, and which blocks move.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require("reference_generation").slope
local slope = require "examples.slope"

figures.case("E4", "Foliation, fractures and two discontinuities divide a slope into 49 blocks; "
    .. "four of them slide together as a wedge", reference.source)

local VOLUME = 1e-9
local STILL = 0.005 -- m, farthest that a block may move that takes no part

local model = slope.build(35)
local volumes = {}
for i, block in ipairs(model:blocks()) do
    volumes[i] = block.volume
end
table.sort(volumes)
figures.equal("blocks", #volumes, reference.blocks)
figures.equal("held blocks", #model:blocks { fixed = true }, reference.fixed)
local faces = model:contacts { where = function(contact) return contact.area > 1e-6 end }
figures.near("volume", model:blocks():sum "volume", reference.volume, VOLUME * reference.volume)
for i, volume in ipairs(reference.volumes) do
    figures.near("volume " .. i, volumes[i] or math.huge, volume, VOLUME)
end
figures.equal("contacts", #faces, reference.contacts)

local r = slope.identify(25, #reference.pieces)
figures.equal("failure identified at friction 25", r.failed, true)
figures.equal("blocks that move", #r.volumes, #reference.pieces)
for i, volume in ipairs(reference.pieces) do
    figures.near("volume of moving block " .. i, r.volumes[i] or math.huge, volume, VOLUME)
end
figures.between("farthest that another moves", r.still, 0, STILL)

local held, failed = slope.bracket { 30, 27.6, 26.5 }
figures.equal("holds at friction", held, 27.6)
figures.equal("slides at friction", failed, 26.5)
figures.between("friction expected", reference.friction, 26.5, 27.6)

local whole = reference.without_discontinuities
model = slope.build(35, { two_dimensional = true })
figures.equal("blocks without D1 and D2", #model:blocks(), whole.blocks)
figures.equal("held blocks without D1 and D2", #model:blocks { fixed = true }, whole.fixed)
held, failed = slope.bracket({ 14, whole.friction + 0.3, whole.friction - 0.3 },
    { two_dimensional = true })
figures.equal("without D1 and D2 holds at friction", held, whole.friction + 0.3)
figures.equal("without D1 and D2 slides at friction", failed, whole.friction - 0.3)
figures.finish()
