-- Solids that are not convex, from files: L, U, a ring with a hole, hollow ones. Their volume and their group are kept, their
-- parts are one body, and what may not be divided is refused with the edge.
local talus = require "talus"
local check = require "check"
local concave = require "concave"

local folder = assert(os.getenv("TALUS_TEST_TMP"))
local stem = string.format("%s/concave_%s", folder, tostring({}):match("0x(%x+)") or "0")
-- Coordinates have 17 digits. What rounding makes of a volume of some 100 m3, relative to it.
local EXACT = 1e-9

local random = 20261
local function draw(least, most)
    random = random * 16807 % 2147483647
    return least + (most - least) * random / 2147483647
end

-- Turned by no round angles, so that no plane is along an axis.
local function turned(p)
    local c, s, d, e = math.cos(0.7), math.sin(0.7), math.cos(0.3), math.sin(0.3)
    local x, y = c * p[1] - s * p[2], s * p[1] + c * p[2]
    return { x, d * y - e * p[3], e * y + d * p[3] }
end

local function write(objects)
    local path, lines, before = stem .. ".obj", {}, 0
    for _, o in ipairs(objects) do
        lines[#lines + 1] = "o " .. o.name .. "\ng " .. o.name
        for _, p in ipairs(o.corners) do
            lines[#lines + 1] = ("v %.17g %.17g %.17g"):format(table.unpack(turned(p)))
        end
        for _, q in ipairs(o.quads) do
            lines[#lines + 1] = ("f %d %d %d %d"):format(q[1] + before, q[2] + before, q[3] + before, q[4] + before)
        end
        before = before + #o.corners
    end
    local file = assert(io.open(path, "wb"))
    file:write(table.concat(lines, "\n"), "\n")
    file:close()
    return path
end

local function import(path, more)
    local values = { file = path, density = 2500 }
    for key, value in pairs(more or {}) do
        values[key] = value
    end
    local model = talus.model {}
    return model, model:generate("import", values)
end

-- All cells of a grid but some.
local function grid(n, without)
    local cells = {}
    for i = 1, n[1] do
        for j = 1, n[2] do
            for k = 1, n[3] do
                if not without(i, j, k) then
                    cells[#cells + 1] = { i, j, k }
                end
            end
        end
    end
    return cells
end

local function middle(i, j, k)
    return i == 2 and j == 2 and k == 2
end
local shapes = {
    { name = "L", most = 2, cells = grid({ 2, 1, 2 }, function(i, _, k) return i == 2 and k == 2 end) },
    { name = "U", most = 3, cells = grid({ 3, 1, 2 }, function(i, _, k) return i == 2 and k == 2 end) },
    { name = "ring", most = 4, cells = grid({ 3, 1, 3 }, function(i, _, k) return i == 2 and k == 2 end) },
    { name = "hollow", most = 6, cells = grid({ 3, 3, 3 }, middle) },
    { name = "two_rooms", most = 12, cells = grid({ 5, 3, 3 }, function(i, j, k) return i % 2 == 0 and j == 2 and k == 2 end) },
}

local function made(shape)
    local lines, volume = { { 0 }, { 0 }, { 0 } }, 0
    for axis = 1, 3 do
        for i = 1, 6 do
            lines[axis][i + 1] = lines[axis][i] + draw(0.5, 2)
        end
    end
    for _, c in ipairs(shape.cells) do
        local part = 1
        for axis = 1, 3 do
            part = part * (lines[axis][c[axis] + 1] - lines[axis][c[axis]])
        end
        volume = volume + part
    end
    local corners, quads = concave.surface(shape.cells, lines)
    return { name = shape.name, corners = corners, quads = quads }, volume
end

for _ = 1, check.cases(20) do
    for _, shape in ipairs(shapes) do
        local object, volume = made(shape)
        local what = shape.name
        local path = write { object }
        local model, summary = import(path)
        local blocks = model:blocks()
        check.near(blocks:sum "volume" / volume, 1, EXACT)
        check.holds(#blocks >= 2 and #blocks <= shape.most, ("%s: %d parts"):format(what, #blocks))
        check.equal(#model:blocks { group = shape.name }, #blocks)
        check.equal(summary.report.solids, 1)
        check.equal(summary.report.blocks, #blocks)
        check.equal(summary.report[1].name, shape.name)
        check.equal(summary.report[1].parts, #blocks)
        check.equal(summary.report[1].shells, nil)
        local body = blocks[1].body
        for _, block in ipairs(blocks) do
            check.equal(block.body, body)
        end
        -- The whole turned inside out is the same solid.
        for _, q in ipairs(object.quads) do
            q[2], q[4] = q[4], q[2]
        end
        check.near(import(write { object }):blocks():sum "volume" / volume, 1, EXACT)
        -- It is refused whole, and what is beside it comes in where that is wanted.
        local box = made { name = "box", cells = { { 1, 1, 1 } } }
        for _, p in ipairs(box.corners) do
            p[1] = p[1] + 100
        end
        path = write { object, box }
        local none = talus.model {}
        check.refused(none, function() none:generate("import", { file = path, density = 1, split = false }) end,
            "object '" .. shape.name .. "' is not convex: it bends inward at the edge from {")
        check.refused(none, function() none:generate("import", { file = path, density = 1, split = false }) end,
            "divide it into convex solids, or set split = true")
        model, summary = import(path, { split = false, skip = true })
        check.equal(#model:blocks(), 1)
        check.holds(summary.report[1].refused:find("is not convex", 1, true), "the report tells why")
    end
end

-- A block that lies in the cavity, and fills it, is a solid of its own.
local hollow = made(shapes[4])
local lines = { {}, {}, {} }
for _, p in ipairs(hollow.corners) do
    for axis = 1, 3 do
        lines[axis][p[axis]] = true
    end
end
for axis = 1, 3 do
    local sorted = {}
    for value in pairs(lines[axis]) do
        sorted[#sorted + 1] = value
    end
    table.sort(sorted)
    lines[axis] = sorted
end
local corners, quads = concave.surface({ { 2, 2, 2 } }, lines)
local model, summary = import(write { hollow, { name = "core", corners = corners, quads = quads } })
local outer = 1
for axis = 1, 3 do
    outer = outer * (lines[axis][4] - lines[axis][1])
end
check.near(model:blocks():sum "volume" / outer, 1, EXACT)
check.equal(summary.report.solids, 2)

-- Random ones, in every format; STL has no faces that are not convex, as those of prisms are. A solid that happens to be convex is another test's.
local divided = 0
for seed = 1, 5 * check.cases(20) do
    local solid = concave.draw(seed)
    for _, ending in ipairs { ".obj", "_big.PLY", "_text.vtk", ".dat", "_model.json", solid.kind ~= "prism" and ".stl" or nil } do
        local off, blocks, bodies = concave.imported(solid, ending, true)
        divided = divided + (blocks > 1 and 1 or 0)
        check.holds(blocks == 1 or off < EXACT, ("seed %d, %s%s: volume off by %g"):format(seed, solid.kind, ending, off))
        check.equal(bodies, 1)
    end
end
check.holds(divided > 20 * check.cases(20), "solids are divided")

os.remove(stem .. ".obj")
