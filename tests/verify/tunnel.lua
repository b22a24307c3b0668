-- A square tunnel under three faults, after example 3 of Hart, Cundall and Lemos (1988): its
-- pieces and bodies, and how the wedge in the roof comes down.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require("reference_generation").tunnel
local tunnel = require "examples.tunnel"

figures.case("E3", "A square tunnel is cut through eight fault blocks: 21 pieces, ten bodies, "
    .. "and a wedge that slides out of the roof", reference.source)

local VOLUME, PLACE = 1e-10, 1e-10
local ACCELERATION = 0.02 -- relative: the joints give a little before they slide

local function volumes(selection)
    local list = {}
    for i, block in ipairs(selection) do
        list[i] = block.volume
    end
    table.sort(list)
    return list
end

local function compare(what, obtained, expected)
    figures.equal("number of " .. what, #obtained, #expected)
    for i, volume in ipairs(expected) do
        figures.near(what .. " " .. i, obtained[i] or math.huge, volume, VOLUME)
    end
end

figures.equal("fault blocks", #tunnel.rock():blocks(), reference.fault_blocks)
compare("fault block volumes", volumes(tunnel.rock():blocks()), reference.fault_block_volumes)

local model = tunnel.cut()
local inside = model:blocks { group = "tunnel" }
figures.equal("pieces inside", #inside, reference.excavated_pieces)
figures.near("volume inside", inside:sum "volume", reference.excavated_volume, VOLUME)
inside:delete()
figures.equal("pieces left", #model:blocks(), reference.pieces)
figures.near("volume left", model:blocks():sum "volume", reference.kept_volume, VOLUME)
local body_volume, bodies = {}, {}
for _, block in ipairs(model:blocks()) do
    body_volume[block.body] = (body_volume[block.body] or 0) + block.volume
end
for _, volume in pairs(body_volume) do
    bodies[#bodies + 1] = volume
end
table.sort(bodies)
figures.equal("bodies", #bodies, reference.bodies)
compare("body volumes", bodies, reference.body_volumes)

local wedge = model:blocks { containing = reference.wedge_centroid }[1]
figures.near("wedge volume", wedge.volume, reference.wedge_volume, 1e-6)
figures.near("wedge volume, all digits", wedge.volume, reference.wedge_volume, 1e-12)
for k = 1, 3 do
    figures.near("wedge centroid " .. k, wedge.centroid[k], reference.wedge_centroid[k], PLACE)
end
figures.equal("corners of the wedge", #wedge.vertices, #reference.wedge_vertices)
for i, expected in ipairs(reference.wedge_vertices) do
    local nearest = math.huge
    for _, vertex in ipairs(wedge.vertices) do
        nearest = math.min(nearest, math.sqrt((vertex[1] - expected[1]) ^ 2
            + (vertex[2] - expected[2]) ^ 2 + (vertex[3] - expected[3]) ^ 2))
    end
    figures.near("corner " .. i .. " of the wedge, off by", nearest, 0, PLACE)
end

-- Pure sliding on the fault 65/270.
local mus, expected, obtained = {}, {}, {}
for i, row in ipairs(reference.acceleration) do
    local r = tunnel.drop(math.deg(math.atan(row[1])), 0.3, 5)
    figures.relative(string.format("acceleration over gravity at mu = %g", row[1]), r.acceleration,
        row[2], ACCELERATION)
    for k = 1, 3 do
        figures.near("direction " .. k, r.direction[k], reference.direction[k], 0.005)
    end
    mus[i], expected[i], obtained[i] = row[1], row[2], r.acceleration
end
figures.plot { title = "Roof wedge sliding on one fault", x = "friction coefficient",
    y = "acceleration / gravity", series = {
        { name = "expected", x = mus, y = expected, style = "line" },
        { name = "obtained", x = mus, y = obtained, style = "points" },
    } }

figures.equal("comes down at friction 45", tunnel.drop(45, 0.3, 5).fell, true)
figures.equal("holds at friction 70", tunnel.drop(70, 0.3, 1).fell, false)
local r = tunnel.identify(25)
figures.equal("failure identified at friction 25", r.failed, true)
figures.finish()
