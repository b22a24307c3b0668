-- The generator terrain: volumes below the ground against integrals over its triangles, what is cut and what is not, bodies,
-- joints below, units, files, and bad input.
package.path = "scripts/?.lua;" .. package.path
local talus = require "talus"
local check = require "check"
local bodies = require "bodies"

local folder = string.format("%s/terrain_%s", assert(os.getenv "TALUS_TEST_TMP"), tostring({}):match "0x(%x+)" or "0")

local function write(name, text)
    talus.write_file(folder .. "/" .. name, text)
    return folder .. "/" .. name
end

-- A grid of n x n cells over a square of `size`, of a function's heights; and the volume below it: a cell bulges upward.
local function grid(name, n, size, height, options)
    options = options or {}
    local h, scale, lines, volume = size / n, options.scale or 1, {}, 0
    for i = n, 0, -1 do
        local row = {}
        for j = 0, n do
            row[#row + 1] = string.format("%.17g", height(j * h, i * h) / scale)
        end
        lines[#lines + 1] = table.concat(row, " ")
    end
    for i = 0, n - 1 do
        for j = 0, n - 1 do
            local sw, se = height(j * h, i * h), height((j + 1) * h, i * h)
            local nw, ne = height(j * h, (i + 1) * h), height((j + 1) * h, (i + 1) * h)
            local a, b = sw + ne >= se + nw and sw or se, sw + ne >= se + nw and ne or nw -- ends of the diagonal
            volume = volume + h * h * (sw + se + nw + ne + a + b) / 6
        end
    end
    local x0 = (options.x or 0) / scale
    local head = string.format("NCOLS %d\nnrows %d\nxllcenter %.17g\nyllcorner %.17g\ncellsize %.17g\nNODATA_value -9999\n", n + 1, n + 1, x0,
        (x0 - h / scale / 2), h / scale)
    return write(name, head .. table.concat(lines, "\n") .. "\n"), volume
end

-- A cube of 10 m in blocks, cut by planes of joints at random dips or upright.
local function rock(options)
    options = options or {}
    local x = options.x or 0
    local model = talus.model { seed = options.seed or 1 }
    model:generate("box", { min = { x, x, 0 }, max = { x + 10, x + 10, 10 }, density = 2500, group = "rock" })
    local sets = { { "A", 70, 30, 2.5 }, { "B", 80, 130, 3 }, { "C", 15, 250, 2.7 } }
    for k = 1, options.joints or 3 do
        local s = sets[options.turned and 4 - k or k]
        model:generate("jointset", { joint = s[1], dip = s[2], dip_direction = s[3], spacing = s[4], number = 9, origin = { x + 5, x + 5, 5 } })
    end
    return model
end

local function ground(model)
    return model:blocks():where(function(b) return b.group ~= "air" end)
end

local shapes = {
    flat = function() return 4.3 end,
    ramp = function(x, y) return 2 + 0.5 * x + 0.1 * y end,
    cone = function(x, y) return 8 - 0.9 * math.sqrt((x - 4) ^ 2 + (y - 5) ^ 2) end,
    bowl = function(x, y) return 2 + 0.12 * ((x - 4) ^ 2 + (y - 5) ^ 2) end,
    steep = function(x, y) return x < 5 and 2 + 0.1 * y or 7 end,
}

-- The ground's volume is that of its integral, and nothing is lost; bodies below hang together, and joints keep their attitude.
for name, height in pairs(shapes) do
    local file, volume = grid(name .. ".asc", 8, 10, height)
    local model = rock()
    local before = #model:blocks()
    local report = model:generate("terrain", { file = file }).report
    check.near(model:blocks():sum "volume", 1000, 1e-9)
    check.near(ground(model):sum "volume", volume, 1e-9 * volume)
    check.near(model:blocks { group = "air" }:sum "volume", 1000 - volume, 1e-6)
    check.holds(report.cut > 0 and report.cut < before)
    check.equal(report.below + report.above, #model:blocks())
    for _, block in ipairs(model:blocks()) do
        for _, face in ipairs(block.faces) do
            local dip = ({ A = 70, B = 80, C = 15 })[(face.joint or ""):sub(1, 1)]
            if dip then
                check.near(math.deg(math.acos(math.abs(face.normal[3]))), dip, 1e-6)
            end
        end
    end
    model:blocks { group = "air" }:delete()
    check.near(model:blocks():sum "volume", volume, 1e-9 * volume)
end

-- Random grids over random cuts; seeds, and rough ground.
for seed = 1, check.cases(6) do
    local random = seed * 7919
    local heights = {}
    local file, volume = grid("random.asc", 3 + seed % 5, 10, function(x, y)
        local key = string.format("%.6f %.6f", x, y)
        if not heights[key] then
            random = (random * 1103515245 + 12345) % 2147483648
            heights[key] = -1 + 12 * random / 2147483648
        end
        return heights[key]
    end)
    -- the ground may be above or below the rock: that part is no rock
    local low, high = math.huge, -math.huge
    for _, z in pairs(heights) do
        low, high = math.min(low, z), math.max(high, z)
    end
    local model = talus.model { seed = seed }
    model:generate("box", { min = { 0, 0, low - 1 }, max = { 10, 10, high + 1 }, density = 2500 })
    model:generate("jointset", { joint = "A", dip = 60, dip_direction = 10 * seed, spacing = 3, number = 7, origin = { 5, 5, 5 } })
    model:generate("terrain", { file = file, group = "sky" })
    local below = model:blocks():sum "volume" - model:blocks { group = "sky" }:sum "volume"
    check.near(below, volume - 100 * (low - 1), 1e-9 * 100 * (high - low))
end

-- One body for each block below, and one for what hangs together above.
do
    local file = grid("cone1.asc", 8, 10, shapes.cone)
    local model = rock { joints = 0 }
    model:generate("terrain", { file = file })
    check.equal(bodies(model:blocks()), 2)
    local twin = rock { joints = 0 }
    twin:generate("terrain", { file = grid("plane.asc", 8, 10, shapes.ramp) })
    check.equal(#twin:blocks(), 2) -- one plane: one cut
end

-- The order in which joints were cut, units and the place change nothing but roundings.
do
    local function below(model, options)
        model:generate("terrain", options)
        return ground(model):sum "volume", bodies(model:blocks())
    end
    local file = grid("order.asc", 5, 10, shapes.cone)
    local volume, count = below(rock(), { file = file })
    local turned, turned_count = below(rock { turned = true }, { file = file })
    check.near(turned, volume, 1e-9)
    check.equal(turned_count, count)
    local small = below(rock(), { file = grid("mm.asc", 5, 10, shapes.cone, { scale = 0.001 }), scale = 0.001 })
    check.near(small, volume, 1e-9)
    local plain = assert(io.open(grid("plain.asc", 5, 10, shapes.cone), "rb")):read "a"
    local marked = write("mark.asc", "\xef\xbb\xbf" .. plain) -- as some editors begin a text
    check.equal(below(rock(), { file = marked }), below(rock(), { file = grid("order.asc", 5, 10, shapes.cone) }))
    local far = below(rock { x = 5000 }, { file = grid("far.asc", 5, 10, shapes.cone, { x = 5000 }) })
    check.near(far, volume, 1e-6)
    local moved = below(rock { x = 5000 }, { file = file, translate = { 5000, 5000, 0 } })
    check.near(moved, volume, 1e-6)
    for _, every in ipairs { 1, 3, 4, 7, 1000000 } do -- 11 lines: the last strip is wider than the others
        check.near(below(rock(), { file = grid("fine.asc", 10, 10, shapes.ramp), every = every }), 500, 1e-6)
    end
end

-- Blocks wholly below are not touched, those wholly above get the group.
do
    local model = talus.model {}
    for k = 0, 2 do
        model:generate("box", { min = { 0, 0, 4 * k }, max = { 10, 10, 4 * k + 3 }, density = 2500, group = "b" .. k })
    end
    local report = model:generate("terrain", { file = grid("mid.asc", 4, 10, function(x) return 4.2 + x / 10 end) }).report
    check.equal(report.cut, 1)
    check.equal(#model:blocks { group = "b0" }, 1)
    check.equal(#model:blocks { group = "b2" }, 0)
    check.near(model:blocks { group = "b1" }:sum "volume", 70, 1e-9)
    check.near(model:blocks { group = "air" }:sum "volume", 230 + 300, 1e-9)
end

-- Triangles of an STL, as text and binary, in any order and turned either way.
local function stl(triangles)
    local text, binary = { "solid ground" }, { string.rep(" ", 80), string.pack("<I4", #triangles) }
    for _, t in ipairs(triangles) do
        text[#text + 1] = "facet normal 0 0 1\nouter loop"
        binary[#binary + 1] = string.pack("<fff", 0, 0, 1)
        for _, c in ipairs(t) do
            text[#text + 1] = string.format("vertex %g %g %g", table.unpack(c))
            binary[#binary + 1] = string.pack("<fff", table.unpack(c))
        end
        text[#text + 1] = "endloop\nendfacet"
        binary[#binary + 1] = string.pack("<I2", 0)
    end
    return table.concat(text, "\n") .. "\nendsolid ground\n", table.concat(binary)
end
local tent = {
    { { 0, 0, 2 }, { 10, 0, 2 }, { 5, 5, 6 } }, { { 10, 10, 2 }, { 10, 0, 2 }, { 5, 5, 6 } },
    { { 5, 5, 6 }, { 0, 10, 2 }, { 10, 10, 2 } }, { { 0, 0, 2 }, { 5, 5, 6 }, { 0, 10, 2 } },
}
do
    for k, text in ipairs { stl(tent) } do
        local model = rock()
        model:generate("terrain", { file = write("tent" .. k .. ".stl", text) })
        check.near(ground(model):sum "volume", 200 + 400 / 3, 1e-9)
    end
    local hash = {}
    for k, order in ipairs { { 1, 2, 3, 4 }, { 3, 1, 4, 2 } } do
        local list = {}
        for i, t in ipairs(order) do
            list[i] = k == 1 and tent[t] or { tent[t][2], tent[t][3], tent[t][1] }
        end
        local model = rock()
        model:generate("terrain", { file = write("order.stl", (stl(list))) })
        hash[k] = model:state_hash()
    end
    check.equal(hash[1], hash[2])
    local model = rock { joints = 0 }
    model:generate("terrain", { file = folder .. "/tent1.stl" })
    check.equal(#ground(model), 1) -- a pyramid is convex
end

-- Bad input: one sentence, and the model is as it was.
local function refused(options, part, model)
    model = model or rock { joints = 1 }
    check.refused(model, function() model:generate("terrain", options) end, part)
end
local HEAD = "ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 10\n"
local function asc(name, text, part, options)
    options = options or {}
    options.file = write(name, text)
    refused(options, part)
end
asc("hole.asc", HEAD .. "1 2 3\n4 -9999 6\n", "row 2, column 2: the height at x = 10, y = 0 is NODATA")
asc("comma.asc", HEAD .. "1,5 2,5 3,5\n4,5 5,5 6,5\n", "row 1, column 1: the height '1,5' is no number in [-1e9, 1e9]: write decimal points")
asc("nan.asc", HEAD .. "NODATA_value nan\n1 2 3\n4 nan 6\n", "row 2, column 2: the height at x = 10, y = 0 is NODATA")
asc("no_nan.asc", HEAD .. "1 2 3\n4 nan 6\n", "row 2, column 2: the height 'nan' is no number")
asc("float.asc", HEAD .. "NODATA_value -3.4028234663852886e+38\n1 2 3\n4 -3.40282e+38 6\n", "row 2, column 2: the height at x = 10, y = 0 is NODATA")
asc("near.asc", HEAD .. "NODATA_value -3.4028234663852886e+38\n1 2 3\n4 -3.3e+38 6\n", "row 2, column 2: the height '-3.3e+38' is no number")
asc("short.asc", HEAD .. "1 2 3\n4 5       \n\n", "ends before row 2, column 3")
asc("few.asc", HEAD .. "1 2\n", "fewer than 6 heights")
asc("word.asc", HEAD .. "1 2 3\n4 x 6\n", "row 2, column 2: the height 'x' is no number")
asc("huge.asc", HEAD .. "1 2 3\n4 1e10 6\n", "row 2, column 2: the height '1e10' is no number in")
asc("more.asc", HEAD .. "1 2 3\n4 5 6\n7\n", "line 8: '7' is beyond 2 rows of 3 heights")
asc("no_size.asc", "ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\n1 2 3\n4 5 6\n", "cellsize is missing")
asc("two_ways.asc", HEAD .. "xllcorner 3\n1 2 3\n4 5 6\n", "xllcorner is given in two ways")
asc("twice.asc", HEAD .. "ncols 3\n1 2 3\n4 5 6\n", "line 6: ncols is given twice")
asc("columns.asc", "ncols 1.5\n", "line 1: ncols = 1.5 is no whole number")
asc("key.asc", HEAD .. "size 3\n", "line 6: 'size' is no key")
asc("empty.asc", "", "ncols is missing")
asc("zero.asc", HEAD .. "1 2 3\0", "zero byte")
asc("small.asc", "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 9\n1 2\n3 4\n", "give a larger grid")
asc("thin.asc", "ncols 12001\nnrows 2\nxllcenter 0\nyllcenter 0\ndx 0.001\ndy 10\n" .. string.rep("5 ", 2 * 12001), "set every = 2")
refused({ file = folder .. "/none.asc" }, "cannot be opened")
refused({ file = write("tent.obj", "v") }, "ends neither in .asc")
refused({ file = folder .. "/tent1.stl", every = 2 }, "every = 2 is for grids")
refused({ file = folder .. "/hole.asc" }, "create blocks first", talus.model {})
local function triangles(name, list, part)
    local text, binary = stl(list)
    for k, bytes in ipairs { text, binary } do
        refused({ file = write(name .. k .. ".stl", bytes) }, part)
    end
end
local function with(...)
    return table.move({ ... }, 1, select("#", ...), #tent + 1, table.move(tent, 1, #tent, 1, {}))
end
triangles("open", { tent[1], tent[2], tent[3] }, "open of the plan of a block")
triangles("over", with { { 4, 1, 9 }, { 6, 1, 9 }, { 5, 2, 9 } }, "triangles 1 and 5 lie one above the other")
triangles("wall", with { { 0, 0, 2 }, { 10, 0, 2 }, { 5, 0, 0 } }, "triangle 5 at {0, 0, 2}: it is vertical")
-- from its first corner it has an area, but from its last, which is taken for the first, none
triangles("needle", with { { 1e-12, 1e-12, 1e-12 }, { 3e-12, 1e-12, 1e-12 }, { -8388640, 0, 0 } }, "it is vertical or has no area")
triangles("far", with { { 0, 0, 2 }, { 2e9, 0, 2 }, { 5, 9, 0 } }, "triangle 5: the corner {2e+09, 0, 2} is outside")
local text, binary = stl(tent)
for _, bad in ipairs { { text:sub(1, -26), "ends in triangle 4" }, { binary:sub(1, -2), "truncated" }, { "abc", "no STL" },
    { "solid\nendsolid", "has no triangle" }, { (text:gsub("vertex 0 0 2", "vertex 0 0", 1)), "is no number" },
    { (text:gsub("vertex 0 0 2", "", 1)), "line 8: 'endfacet'" } } do
    refused({ file = write("bad.stl", bad[1]) }, bad[2])
end
