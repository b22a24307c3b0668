-- Three orthogonal joint sets: the number of blocks, their volumes, and which plane made which
-- face.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference").ortho

figures.case("C.ortho", "A unit cube is cut by three orthogonal joint sets: how many blocks of "
    .. "which volume, and which plane bears which faces.", reference.source)

local VOLUME, PLACE = 1e-12, 1e-12

local model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
for _, set in ipairs(reference.sets) do
    model:generate("jointset", { joint = set.joint, dip = set.dip,
        dip_direction = set.dip_direction,
        spacing = set.spacing, number = set.number, origin = reference.origin })
end

local blocks = model:blocks()
figures.equal("blocks", #blocks, reference.blocks)
figures.near("sum of volumes", blocks:sum "volume", 1, VOLUME)
for _, entry in ipairs(reference.volumes) do
    local count = 0
    for _, block in ipairs(blocks) do
        count = count + (math.abs(block.volume - entry[1]) <= VOLUME and 1 or 0)
    end
    figures.equal(string.format("blocks of %g m3", entry[1]), count, entry[2])
end

-- A plane k of a set of n lies (k - (n + 1) / 2) spacings from the origin, along the set's normal.
local faces, vertices, astray = 0, 0, 0
local on_plane = {}
local axes = { J1 = 1, J2 = 2, J3 = 3 } -- the sets' normals are x, y and z
for _, block in ipairs(blocks) do
    local corners = block.vertices
    vertices, faces = vertices + #corners, faces + #block.faces
    for _, face in ipairs(block.faces) do
        if face.joint then
            on_plane[face.joint] = (on_plane[face.joint] or 0) + 1
            local joint, plane = face.joint:match "^(J%d):(%d+)$"
            local axis = axes[joint]
            local set = reference.sets[axis]
            local place = reference.origin[axis]
                + (tonumber(plane) - (set.number + 1) / 2) * set.spacing
            for _, corner in ipairs(face.vertices) do
                if math.abs(corners[corner][axis] - place) > PLACE then
                    astray = astray + 1
                end
            end
        end
    end
end
figures.equal("faces", faces, reference.faces)
figures.equal("vertices", vertices, reference.vertices)
figures.equal("corners off their plane", astray, 0)

-- Every plane bears a face on both sides of each of the cells of the two other sets.
local cells = { J1 = 4 * 6, J2 = 4 * 6, J3 = 4 * 4 }
for _, set in ipairs(reference.sets) do
    for plane = 1, set.number do
        local name = set.joint .. ":" .. plane
        figures.equal("faces on " .. name, on_plane[name], 2 * cells[set.joint])
        figures.equal("blocks on " .. name, #model:blocks { joint = name }, 2 * cells[set.joint])
    end
end
figures.finish()
