-- opening.lua - the pages that test_opening.py opens: rock.html of more than 200,000 triangles; gems.html of blocks with more faces than
-- vertices, octahedra and bipyramids, besides boxes.
--
--     talus tests/viewer/opening.lua FOLDER
package.path = "tests/bench/?.lua;" .. package.path
local talus = require "talus"
local rock = require "rock"

local folder = assert(arg[1], "the folder is missing")

rock.cut(20000, 1):write_html(folder .. "/rock", { title = "Rock", contacts = false })

local gems = talus.model {}
local CORNERS = { 4, 3, 7 } -- of the bipyramids' waists; of 4 an octahedron
for i = 1, 30 do
    local n, at, points = CORNERS[i % 3 + 1], { 4 * (i % 6), 4 * (i // 6), 0 }, {}
    for k = 1, n do
        local a = 2 * math.pi * (k + 0.1 * i) / n
        points[k] = { at[1] + 1.5 * math.cos(a), at[2] + 1.5 * math.sin(a), at[3] }
    end
    points[n + 1], points[n + 2] = { at[1], at[2], at[3] + 2 }, { at[1], at[2], at[3] - 1.2 }
    gems:generate("polyhedron", { vertices = points, density = 2600, group = "gem" })
end
gems:generate("box", { min = { -4, -4, -6 }, max = { 26, 26, -3 }, density = 2600, group = "floor" })
gems:write_html(folder .. "/gems", { title = "Gems" })
