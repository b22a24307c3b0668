-- terrain.lua - how long the ground takes to divide blocks: grids of cells over a box of 100 x 100 x 50 m in 2,000 blocks.
--
--     talus tests/bench/terrain.lua cells=100
--
-- `rate` is cells a second of the processor; beside it are the seconds and how many blocks there are afterwards.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"

local SHAPES = {
    { "ramp", function(x, y) return 10 + 0.31 * x + 0.05 * y end },
    { "cone", function(x, y) return 45 - 0.4 * math.sqrt((x - 50) ^ 2 + (y - 50) ^ 2) end },
    { "hills", function(x, y) return 25 + 10 * math.sin(x / 15) * math.cos(y / 11) end },
    { "rough", function(x, y) return 25 + 10 * math.sin(x / 15) * math.cos(y / 11) + 0.8 * ((x * 12.9898 + y * 78.233) * 43.758 % 1) end },
}

local function write(file, n, height)
    local lines = { string.format("ncols %d\nnrows %d\nxllcenter 0\nyllcenter 0\ncellsize %.17g", n + 1, n + 1, 100 / n) }
    for i = n, 0, -1 do
        local row = {}
        for j = 0, n do
            row[#row + 1] = string.format("%.17g", height(100 / n * j, 100 / n * i))
        end
        lines[#lines + 1] = table.concat(row, " ")
    end
    talus.write_file(file, table.concat(lines, "\n") .. "\n")
end

local given = bench.arguments { cells = 100 }
local name = os.tmpname()
local file = name .. ".asc"
print "workload,size,blocks,rate,unit,seconds"
for _, shape in ipairs(SHAPES) do
    write(file, given.cells, shape[2])
    local model = talus.model {}
    model:generate("box", { min = { 0, 0, 0 }, max = { 100, 100, 50 }, density = 2500 })
    for _, set in ipairs { { "A", 90, 90, 5, 19 }, { "B", 90, 0, 10, 9 }, { "C", 0, 0, 5, 9 } } do
        model:generate("jointset", { joint = set[1], dip = set[2], dip_direction = set[3], spacing = set[4], number = set[5], origin = { 50, 50, 25 } })
    end
    local began = os.clock()
    model:generate("terrain", { file = file })
    local seconds = os.clock() - began
    print(string.format("terrain,%s,%d,%.4g,cells/s,%.3g", shape[1], #model:blocks(), given.cells ^ 2 / seconds, seconds))
end
os.remove(file)
os.remove(name)
