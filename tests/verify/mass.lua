-- Volume, centroid and inertia of convex blocks, from their vertices in any order.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference").mass

-- Where the entries of a symmetric tensor stand.
local ENTRY = { { "xx", "xy", "zx" }, { "xy", "yy", "yz" }, { "zx", "yz", "zz" } }

local TOLERANCE = 1e-13 -- relative to the largest entry of the tensor, or the size of the block

for _, case in ipairs(reference) do
    figures.case(case.name, "Volume, mass, centroid and inertia of a convex block, at the origin "
        .. "and far from it.", reference.source)
    -- Far from the origin as well: mass properties must not lose digits to an offset of exact
    -- numbers.
    for _, offset in ipairs { 0, 64 } do
        local vertices = {}
        for i, v in ipairs(case.vertices) do
            vertices[#case.vertices + 1 - i] = { v[1] + offset, v[2] - offset, v[3] + offset }
        end
        local model = talus.model {}
        model:generate("polyhedron", { vertices = vertices, density = 2 })
        local block = model:blocks()[1]
        local name = string.format("%s at %d", case.name, offset)
        figures.relative(name .. " volume", block.volume, case.volume, TOLERANCE)
        figures.relative(name .. " mass", block.mass, 2 * case.volume, TOLERANCE)
        local shift = { offset, -offset, offset }
        local largest = 0
        for i = 1, 3 do
            figures.near(name .. " centroid " .. i, block.centroid[i] - shift[i], case.centroid[i],
                TOLERANCE * (1 + offset))
            largest = math.max(largest, case.inertia[i][i])
        end
        for i = 1, 3 do
            for j = 1, 3 do
                figures.near(string.format("%s inertia %d%d", name, i, j),
                    block.inertia[ENTRY[i][j]],
                    2 * case.inertia[i][j], 2 * TOLERANCE * largest)
            end
        end
    end
end
figures.finish()
