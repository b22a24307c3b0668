-- Solids that are not convex, through files of every format. tests/lua/test_import_concave.lua does the same with fewer.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local concave = require "concave"
local figures = require "check_figures"
local files = require "import_files"

local SOLIDS = 400
local EXACT = 1e-9  -- of the volume, as the sum over the faces has it
local FLAT = 1e-3   -- the same where import takes `flat` by itself: some 1e-4 of the size
local REFUSED = 0.01 -- share of the solids: a part may be a sliver, and then the solid is refused

figures.case("I.concave", SOLIDS .. " random solids: cells of an uneven grid, prisms on a star, rings, refined octahedra whose corners lie at random distances, and "
    .. "the same with a cavity, turned, sheared and of sizes from 0.01 to 100 m. They are written to files and imported, which divides those that are not convex "
    .. "into blocks of one body. STL has no prisms, whose faces are not convex. Volumes are beside the sum over the faces.", "divergence theorem")
local endings = {}
for ending in pairs(files.writers) do
    endings[#endings + 1] = ending
end
table.sort(endings)

local function compare(what, ending, fine, most)
    local worst, divided, apart, refused = 0, 0, 0, 0
    for seed = 1, SOLIDS do
        local solid = concave.draw(seed)
        if not (ending == ".stl" and solid.kind == "prism") then
            local good, off, blocks, bodies = pcall(concave.imported, solid, ending, fine)
            if not good then
                refused = refused + 1
                assert(off:find("could not be divided", 1, true), off)
            elseif blocks > 1 then -- another one is convex
                divided, worst, apart = divided + 1, math.max(worst, off), apart + (bodies > 1 and 1 or 0)
            end
        end
    end
    figures.between(what .. ": solids that are divided", divided, 300, SOLIDS)
    figures.between(what .. ": largest error of the volume, relative", worst, 0, most)
    figures.equal(what .. ": solids whose parts are not one body", apart, 0)
    figures.between(what .. ": solids refused", refused, 0, REFUSED * SOLIDS)
end
for _, ending in ipairs(endings) do
    compare(ending, ending, true, EXACT)
end
compare(".obj, flat by itself", ".obj", false, FLAT)
figures.finish()
