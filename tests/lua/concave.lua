-- concave.lua - random solids that are not convex, and what import makes of them.
--
--     concave.kinds                           "cells", "prism", "ring", "hollow", "bumps"
--     local solid = concave.draw(seed)        vertices, faces, exact volume and kind
--     concave.imported(solid, ending, fine)   relative error of the volume, the number of blocks, and of bodies
--
-- Cells are those of an uneven grid; prisms stand on a star, rings have a hole through them, hollow ones a cavity; bumps are refined
-- octahedra whose corners lie at random distances. All are turned and sheared. Faces look outward, those of cavities into them.
local files = require "import_files"
local shapes = require "shapes"
local talus = require "talus"

local FINE = 1e-9 -- over the unit of a solid

local concave = { kinds = { "cells", "prism", "ring", "hollow", "bumps" } }

local function whole(random, from, to)
    return math.floor(random(from, to + 1))
end

-- ---------------------------------------------------------------- cells of a grid

-- The surface of unit cells {i, j, k} on an uneven grid, as corners and quads that look outward; borders between cells are left out.
function concave.surface(cells, lines)
    local filled, corners, number, quads = {}, {}, {}, {}
    for _, c in ipairs(cells) do
        filled[c[1] .. "," .. c[2] .. "," .. c[3]] = true
    end
    local function corner(i, j, k)
        local key = i .. "," .. j .. "," .. k
        if not number[key] then
            corners[#corners + 1] = { lines[1][i], lines[2][j], lines[3][k] }
            number[key] = #corners
        end
        return number[key]
    end
    for _, c in ipairs(cells) do
        for axis = 1, 3 do
            for side = 0, 1 do
                local beside = { c[1], c[2], c[3] }
                beside[axis] = beside[axis] + 2 * side - 1
                if not filled[table.concat(beside, ",")] then
                    local u, v = axis % 3 + 1, (axis + 1) % 3 + 1
                    local quad = {}
                    for _, step in ipairs { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } } do
                        local at = { c[1], c[2], c[3] }
                        at[axis], at[u], at[v] = at[axis] + side, at[u] + step[1], at[v] + step[2]
                        table.insert(quad, side == 1 and #quad + 1 or 1, corner(table.unpack(at)))
                    end
                    quads[#quads + 1] = quad
                end
            end
        end
    end
    return corners, quads
end

-- Whether every edge belongs to two faces.
local function closed(faces)
    local count = {}
    for _, f in ipairs(faces) do
        for i, a in ipairs(f) do
            local b = f[i % #f + 1]
            local key = math.min(a, b) .. " " .. math.max(a, b)
            count[key] = (count[key] or 0) + 1
        end
    end
    for _, n in pairs(count) do
        if n ~= 2 then
            return false
        end
    end
    return true
end

local draws = {}

-- Cells that grow from one, each beside an earlier one, until they touch nowhere along an edge alone.
function draws.cells(random)
    local lines = { { 0 }, { 0 }, { 0 } }
    for axis = 1, 3 do
        for i = 1, 4 do
            lines[axis][i + 1] = lines[axis][i] + random(0.5, 2)
        end
    end
    while true do
        local cells, filled = { { 2, 2, 2 } }, { ["2,2,2"] = true }
        local wanted = whole(random, 3, 9)
        while #cells < wanted do
            local from, axis, step = cells[whole(random, 1, #cells)], whole(random, 1, 3), 2 * whole(random, 0, 1) - 1
            local cell = { from[1], from[2], from[3] }
            cell[axis] = cell[axis] + step
            local key = table.concat(cell, ",")
            if cell[axis] >= 1 and cell[axis] <= 4 and not filled[key] then
                filled[key], cells[#cells + 1] = true, cell
            end
        end
        local corners, quads = concave.surface(cells, lines)
        if closed(quads) then
            return corners, quads
        end
    end
end

-- ---------------------------------------------------------------- stars

-- Points around {0, 0} at random distances.
local function star(random)
    local n, points = whole(random, 5, 11), {}
    for i = 1, n do
        local angle, r = 2 * math.pi * (i + random(0.2, 0.8)) / n, random(0.5, 1.5)
        points[i] = { r * math.cos(angle), r * math.sin(angle) }
    end
    return points, n
end

function draws.prism(random)
    local points, n = star(random)
    local corners, faces, top, bottom = {}, {}, {}, {}
    for i, p in ipairs(points) do
        corners[i], corners[n + i] = { p[1], p[2], 0 }, { p[1], p[2], 1 }
        bottom[n + 1 - i], top[i] = i, n + i
        local j = i % n + 1
        faces[i] = { i, j, n + j, n + i }
    end
    faces[n + 1], faces[n + 2] = bottom, top
    return corners, faces
end

-- A star with a smaller one as a hole.
function draws.ring(random)
    local points, n = star(random)
    local corners, faces, hole = {}, {}, random(0.2, 0.7)
    for level = 0, 1 do
        for _, share in ipairs { 1, hole } do
            for _, p in ipairs(points) do
                corners[#corners + 1] = { share * p[1], share * p[2], level }
            end
        end
    end
    for i = 1, n do
        local j = i % n + 1
        table.move({ { i, j, 2 * n + j, 2 * n + i }, { n + j, n + i, 3 * n + i, 3 * n + j }, { j, i, n + i, n + j },
            { 2 * n + i, 2 * n + j, 3 * n + j, 3 * n + i } }, 1, 4, #faces + 1, faces)
    end
    return corners, faces
end

local function refined(corners, faces)
    local middle, finer = {}, {}
    local function between(a, b)
        local key = math.min(a, b) .. " " .. math.max(a, b)
        if not middle[key] then
            local p, q = corners[a], corners[b]
            corners[#corners + 1] = { (p[1] + q[1]) / 2, (p[2] + q[2]) / 2, (p[3] + q[3]) / 2 }
            middle[key] = #corners
        end
        return middle[key]
    end
    for _, f in ipairs(faces) do
        local ab, bc, ca = between(f[1], f[2]), between(f[2], f[3]), between(f[3], f[1])
        table.move({ { f[1], ab, ca }, { ab, f[2], bc }, { ca, bc, f[3] }, { ab, bc, ca } }, 1, 4, #finer + 1, finer)
    end
    return finer
end

-- An octahedron, each triangle in four, its corners at random distances.
function draws.bumps(random)
    local corners = { { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } }
    local faces = refined(corners, { { 1, 3, 5 }, { 3, 2, 5 }, { 2, 4, 5 }, { 4, 1, 5 }, { 3, 1, 6 }, { 2, 3, 6 }, { 4, 2, 6 }, { 1, 4, 6 } })
    for i, p in ipairs(corners) do
        local scale = random(0.6, 1) / shapes.length(p)
        corners[i] = { scale * p[1], scale * p[2], scale * p[3] }
    end
    return corners, faces
end

-- Bumps with a smaller copy of themselves as a cavity.
function draws.hollow(random)
    local corners, faces = draws.bumps(random)
    local n, m, share = #corners, #faces, random(0.3, 0.6)
    for i = 1, n do
        corners[n + i] = { share * corners[i][1], share * corners[i][2], share * corners[i][3] }
    end
    for i = 1, m do
        faces[m + i] = { n + faces[i][1], n + faces[i][3], n + faces[i][2] }
    end
    return corners, faces
end

-- ---------------------------------------------------------------- all of them

local function volume_of(vertices, faces)
    local six = 0
    for _, t in ipairs(files.fans { vertices = vertices, faces = faces }) do
        six = six + shapes.dot(t[1], shapes.cross(t[2], t[3]))
    end
    return six / 6
end

function concave.draw(seed)
    local random = shapes.random(seed)
    local kind = concave.kinds[seed % #concave.kinds + 1]
    local corners, faces = draws[kind](random)
    local unit = 10 ^ random(-2, 2)
    local map = shapes.product(shapes.attitude(random), { { unit, 0.3 * unit, 0 }, { 0, unit, random(-0.4, 0.4) * unit }, { 0, 0, unit } })
    local vertices = {}
    for i, p in ipairs(corners) do
        vertices[i] = shapes.apply(map, p)
    end
    return { kind = kind, vertices = vertices, faces = faces, volume = volume_of(vertices, faces), unit = unit }
end

-- With `fine` the smallest `weld` and `flat` that rounding allows; without it those that import takes by itself.
function concave.imported(solid, ending, fine)
    local path = os.tmpname()
    os.remove(path)
    path = path .. ending
    local file = assert(io.open(path, "wb"))
    file:write(files.writers[ending]({ { name = "solid", group = "rock", vertices = solid.vertices, faces = solid.faces } }, files.digits "%.17g"))
    file:close()
    local model = talus.model {}
    local good, message = pcall(model.generate, model, "import", { file = path, density = 2500, weld = fine and FINE * solid.unit or nil,
        flat = fine and 10 * FINE * solid.unit or nil })
    os.remove(path)
    if not good then
        error(message, 0)
    end
    local blocks, bodies, seen = model:blocks(), 0, {}
    for _, b in ipairs(blocks) do
        bodies = bodies + (seen[b.body] and 0 or 1)
        seen[b.body] = true
    end
    return math.abs(blocks:sum "volume" / solid.volume - 1), #blocks, bodies
end

return concave
