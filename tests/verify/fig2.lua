-- The joint sets of Figure 2 in Hart, Cundall and Lemos (1988), without deviations: how many
-- blocks of which volumes, faces, edges and corners.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require("reference_generation").figure_2
local fig2 = require "examples.fig2"

local VOLUME = 1e-12 -- m3, and of the whole

for _, name in ipairs { "printed.cube2", "printed.unit", "variant.cube2", "variant.unit" } do
    local case = reference[name]
    figures.case("C.fig2." .. name, "A cube from " .. case.low .. " to " .. case.high
        .. " is cut by three sets of fifteen planes, the third dipping towards " .. case.third,
        reference.source)
    local model, summary = fig2.build(case.low, case.high, { exact = true, third = case.third })
    local volumes, obtained = {}, { faces = 0, vertices = 0, edges = 0 }
    for i, block in ipairs(model:blocks()) do
        volumes[i] = block.volume
        obtained.vertices = obtained.vertices + #block.vertices
        obtained.faces = obtained.faces + #block.faces
        for _, face in ipairs(block.faces) do
            obtained.edges = obtained.edges + #face.vertices / 2
        end
    end
    table.sort(volumes)
    figures.equal("blocks", #volumes, case.blocks)
    for _, what in ipairs { "faces", "vertices", "edges" } do
        figures.equal(what, math.floor(obtained[what]), case[what])
    end
    local worst = 0
    for i, volume in ipairs(case.volumes) do
        worst = math.max(worst, math.abs((volumes[i] or math.huge) - volume))
    end
    figures.near("largest difference of a volume", worst, 0, VOLUME)
    local whole = (case.high - case.low) ^ 3
    figures.near("sum of volumes", model:blocks():sum "volume", whole, VOLUME * whole)
    figures.near("volume error told", summary.volume_error, 0, VOLUME)
    local x = {}
    for i = 1, #volumes do
        x[i] = i
    end
    figures.plot { title = "Figure 2, " .. name .. ": volumes in order", x = "block", log_y = true,
        y = "volume, m3", series = { { name = "expected", x = x, y = case.volumes, style = "line" },
            { name = "obtained", x = x, y = volumes, style = "points" } } }
end
figures.finish()
