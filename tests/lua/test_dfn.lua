-- The generator dfn: what discs cut, intensities against sums of areas by hand, files of discs and of FracMan, bad input; and
-- talus.back_analysis, and the example of a pit slope.
package.path = "scripts/?.lua;" .. package.path
local talus = require "talus"
local check = require "check"

local folder = string.format("%s/dfn_%s", assert(os.getenv "TALUS_TEST_TMP"), tostring({}):match "0x(%x+)" or "0")

local function write(name, text)
    talus.write_file(folder .. "/" .. name, text)
    return folder .. "/" .. name
end

local function cube(seed)
    local model = talus.model { seed = seed or 1 }
    model:generate("box", { min = { 0, 0, 0 }, max = { 10, 10, 10 }, density = 2500 })
    return model
end

-- Discs of a file: areas in the box are known, so are P32, P10 along the vertical mean pole, and P21. The part of a disc of radius 2 beyond a
-- face 1 m from its centre is a segment r^2 (acos(h / r) - h / r sqrt(1 - (h / r)^2)).
do
    local discs = "x,y,z,dip,dip_direction,radius\n5,5,5,0,0,2\n5,5,5,90,0,1\n9,5,2,0,0,2\n5,5,12,0,0,3\n10,10,5,0,0,3\n"
    local model = cube()
    local r = model:generate("dfn", { joint = "D", file = write("discs.csv", discs) }).report
    local segment = 4 * (math.acos(0.5) - 0.5 * math.sqrt(0.75))
    local flat = math.pi * 4 + math.pi * 4 - segment + math.pi * 9 / 4
    check.equal(r.discs, 5)
    check.equal(r.inside, 4)
    check.near(r.p32, (flat + math.pi) / 1000, 1e-15)
    check.near(r.p10, flat / 1000, 1e-15)
    check.near(r.p21, math.pi / 1000, 1e-15)
    -- the largest first: plane 5 (z = 5) meets the cube's corner, then 1 falls on it, 3 cuts below, 2 both halves that it reaches
    local planes = {}
    for _, block in ipairs(model:blocks()) do
        for _, face in ipairs(block.faces) do
            planes[face.joint or ""] = true
        end
    end
    check.holds(planes["D:3"] and planes["D:2"] and not planes["D:4"])
    check.near(model:blocks():sum "volume", 1000, 1e-9)
end

-- A disc cuts only blocks that it reaches.
do
    local model = cube()
    model:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 5, 5, 5 } })
    model:generate("dfn", { joint = "D", file = write("one.csv", "x,y,z,dip,dip_direction,radius\n2,5,5,0,0,2\n") })
    check.equal(#model:blocks(), 3)
end

-- FracMan: a square of 2 m becomes the disc of 4 m2 about its centroid; other sections and normals are passed over.
do
    local fab = [[
BEGIN FORMAT
    Format = Ascii
    XAxis = East
    Length_Unit = Meter
    No_Fractures = 2
END FORMAT
BEGIN PROPERTIES
    Prop1 = (Real*4) "Transmissivity"
END PROPERTIES
BEGIN FRACTURE
    1 4 1 1.0e-7
    1 4 4 5
    2 6 4 5
    3 6 6 5
    4 4 6 5
    0 -1 -1 -1
    2 3 1 2.0e-7
    1 1 1 1
    2 1 3 1
    3 1 1 2
    0 1 0 0
END FRACTURE
BEGIN TESSFRACTURE
    9 9
END TESSFRACTURE
]]
    local model = cube()
    local r = model:generate("dfn", { joint = "F", file = write("two.FAB", fab) }).report
    check.equal(r.discs, 2)
    check.near(r.p32, 5 / 1000, 1e-12)
    check.holds(r.polygons:find "disc of its area")
    check.equal(#model:blocks(), 3)
    for _, case in ipairs {
        { fab:gsub("Meter", "Feet"), "line 4: length_unit = Feet is not read: write the file with length_unit = Meter" },
        { fab:gsub("Ascii", "Binary"), "line 2: Format = Binary is not read" },
        { fab:gsub("1 4 1 1.0e%-7", "1 2 1"), "line 11: 2 is not a number of corners in [3, 10000]" },
        { fab:gsub("6 6 5", "6 x 5"), "line 14: a coordinate 'x' is no number" },
        { fab:gsub("6 6 5", "6 6"), "line 14: a coordinate is missing" },
        { fab:gsub("1 1 3 1", "1 1 1 1"):gsub("2 1 3 1", "2 1 1 1.5"), "line 17: the 3 corners enclose no area" },
        { fab:match "^.-    3 6 6 5\n", "ends in the fracture of line 11: it is damaged" },
        { "BEGIN FORMAT\nEND FORMAT\n", "has no fracture between BEGIN FRACTURE and END FRACTURE" },
    } do
        local text = case[1]
        check.raises(function()
            cube():generate("dfn", { joint = "F", file = write("bad.fab", text) })
        end, case[2]:gsub("length_unit", "Length_Unit"))
    end
end

-- Draws hang on seed, joint and number: the same again, others of another seed; p32 is reached and no disc more.
do
    local given = { joint = "D", p32 = 0.4, dip = 30, dip_direction = 200, fisher_k = 30, size = "lognormal", size_mean = 2,
        size_dev = 1, size_max = 5 }
    local one, again, other = cube(2), cube(2), cube(3)
    local r = one:generate("dfn", given).report
    check.equal(again:generate("dfn", given).report.p32, r.p32)
    check.equal(one:state_hash(), again:state_hash())
    check.holds(other:generate("dfn", given).report.p32 ~= r.p32)
    check.holds(r.p32 >= 0.4 and r.p32 - 0.4 <= math.pi * 25 / 1000)
    local fixed = cube():generate("dfn", { joint = "D", number = 50, dip = 0, dip_direction = 0, size_mean = 3 }).report
    check.near(fixed.p10, fixed.p32, 1e-15) -- all are horizontal
    check.equal(fixed.p21, 0)
    local poles = write("poles.csv", "dip,dip_direction\n90,0\n90,90\n")
    local upright = cube():generate("dfn", { joint = "D", number = 60, poles = poles, size_mean = 3 }).report
    check.near(upright.p21, upright.p32, 1e-15) -- all are vertical
end

local fixed = { joint = "D", number = 5, dip = 3, dip_direction = 3, size_mean = 1 }
local function with(changes)
    local given = {}
    for key, value in pairs(fixed) do
        given[key] = value
    end
    for key, value in pairs(changes) do
        given[key] = value ~= false and value or nil
    end
    return given
end
for _, case in ipairs {
    { { number = false }, "give one of p32, number and file: there is none" },
    { { p32 = 1 }, "give one of p32, number and file: there are two" },
    { { number = false, dip = false, dip_direction = false, size_mean = false, file = "x.csv", size_min = 1 }, "'x.csv' has orientations and sizes" },
    { { number = false, dip = false, dip_direction = false, size_mean = false, file = "x.csv", exponent = 1 }, "'x.csv' has orientations and sizes" },
    { { number = false, dip = false, dip_direction = false, size_mean = false, file = "x.csv", size = "lognormal" },
        "'x.csv' has orientations and sizes" },
    { { number = false, p32 = 5, size = "lognormal", size_mean = 10, size_dev = 30, size_max = 0.04 }, "p32 = 5 1/m takes some 1.9" },
    { { dip = false }, "dip is missing: give dip and dip_direction, poles, or file" },
    { { poles = "x.csv" }, "poles give the orientations: leave out dip, dip_direction and fisher_k" },
    { { size_mean = false }, "size = 'fixed' needs size_mean" },
    { { size_dev = 1 }, "size_dev = 1 does not go with size = 'fixed'" },
    { { size = "power_law", exponent = 2.5, size_min = 1, size_mean = false }, "size = 'power_law' needs size_max" },
    { { size = "power_law", exponent = 2.5, size_min = 3, size_max = 1, size_mean = false }, "size_min = 3 m is above size_max = 1 m" },
    { { size = "lognormal", size_dev = 0.1, size_min = 8, size_max = 9 }, "fewer than 1 in 1000 radii" },
    { { number = false, p32 = 1e6 }, "takes some" },
    { { size_mean = -1 }, "size_mean = -1" },
    { { dip = 95 }, "dip = 95" },
    { { number = false, file = "x.csv" }, "leave out dip, dip_direction" },
    { { number = false, dip = false, dip_direction = false, size_mean = false, file = folder .. "/none.csv" }, "cannot be opened" },
} do
    check.raises(function()
        cube():generate("dfn", with(case[1]))
    end, case[2])
end
check.raises(function() talus.model {}:generate("dfn", fixed) end, "there is no visible block")
check.raises(function()
    cube():generate("dfn", { joint = "D", file = write("bad.csv", "x,y,z,dip,dip_direction,radius\n0,0,0,30,120,0\n") })
end, "line 2, column 'radius': 0 is outside (0, 1e+09]")

-- ------------------------------------------------------------------ back-analysis

do
    local model, calls = talus.model {}, 0
    local function search(given)
        given.build = given.build or function(values)
            calls = calls + 1
            return model, { safety = values.x ^ 2, failed = values.x < 3 }
        end
        given.unknown = given.unknown or { x = { 0, 10 } }
        return talus.back_analysis(given)
    end
    check.near(search({ observed = { safety = 2 } }).value, math.sqrt(2), 1e-3)
    check.holds(calls <= 18)
    check.near(search({ observed = { failed = true } }).value, 3, 1e-3)
    check.near(search({ observed = { safety = 2 }, tolerance = 1e-9 }).value, math.sqrt(2), 1e-8)
    local band = search { observed = { safety = { 1, 4 } } }
    check.near({ band.low, band.high, band.value }, { 1, 2, 1.5 }, 1e-3)
    check.near(search({ build = function() return model end, observed = { y = 0 }, unknown = { x = { from = -1, to = 2 } },
        measure = function(_, values) return { y = -values.x } end }).value, 0, 3e-4) -- falls
    for _, case in ipairs {
        { {}, "observed must be a table, not nil" },
        { { observed = { a = 1, b = 2 } }, "observed must have one name" },
        { { observed = { safety = "x" } }, "observed.safety must be a number, a pair {low, high}, true or false" },
        { { observed = { safety = { 2, 1 } } }, "low = 2 must be below high = 1" },
        { { observed = { safety = 200 } }, "'safety' goes from 0.0 to 100.0, and does not pass 200: widen the interval" },
        { { observed = { other = 2 } }, "build gave no number 'other', but nil" },
        { { observed = { safety = 2 }, build = function() end }, "build gave nil, not a model" },
        { { observed = { safety = 2 }, unknown = { x = { 3, 3 } } }, "from = 3 must be below to = 3" },
        { { observed = { safety = 2 }, unknown = 3 }, "unknown must be a table" },
        { { observed = { safety = 2 }, unknown = { x = { 0, 10, form = 1 } } }, "unknown parameter 'form'; did you mean 'from'?" },
        { { observed = { safety = 2 }, unknown = { x = { 0, 10, 20 } } }, "unknown parameter '3' (known: 1, 2, from, to)" },
        { { observed = { safety = 2 }, measure = 3 }, "measure must be a function" },
        { { observed = { safety = 2 }, tolerence = 3 }, "unknown parameter 'tolerence'; did you mean 'tolerance'?" },
    } do
        check.raises(function() search(case[1]) end, case[2])
    end
end

-- ------------------------------------------------------------------ the example

do
    local pit = require "examples.pit_slope"
    local set = pit.main(folder .. "/pit", 3, 1)
    check.equal(#set, 3)
    check.equal(set.errors, 0)
    check.holds(set:mean "blocks" > 50)
    for _, name in ipairs { "poles.svg", "safety.svg", "realisations.csv", "set_3.csv" } do
        check.holds(io.open(folder .. "/pit/" .. name), name)
    end
    -- the model of a row is that of its realisation
    check.equal(#set:model(2):blocks(), set:rows()[2].blocks)
end
