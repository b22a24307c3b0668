-- talus.poles: mean, concentration and cone after Fisher, Terzaghi's weights, sets, draws; joint sets of measured poles; files.
local talus = require "talus"
local check = require "check"

local folder = string.format("%s/poles_%s", assert(os.getenv "TALUS_TEST_TMP"), tostring({}):match "0x(%x+)" or "0")

local function write(name, text)
    talus.write_file(folder .. "/" .. name, text)
    return folder .. "/" .. name
end

-- Four poles at one angle t about the vertical: R = 4 cos t, k = 3 / (4 - 4 cos t).
do
    local list = {}
    for _, direction in ipairs { 0, 90, 180, 270 } do
        list[#list + 1] = { 20, direction }
    end
    local p = talus.poles(list)
    local mean, R = p:mean(), 4 * math.cos(math.rad(20))
    check.equal(#p, 4)
    check.near(mean.dip, 0, 1e-9)
    check.near(mean.resultant, R / 4, 1e-14)
    check.near(mean.kappa, 3 / (4 - R), 1e-10)
    check.near(math.cos(math.rad(mean.cone)), 1 - (4 - R) / R * (20 ^ (1 / 3) - 1), 1e-12)
end

-- Poles are axes: steep planes on both sides of the vertical are one set, and their mean is vertical.
do
    local mean = talus.poles({ { 80, 90 }, { 80, 270 }, { 85, 90 }, { 85, 270 } }):mean()
    check.near(mean.dip, 90, 1e-9)
    check.near(mean.dip_direction % 180, 90, 1e-9)
    check.near(mean.resultant, (math.cos(math.rad(10)) + math.cos(math.rad(5))) / 2, 1e-12)
    local one = talus.poles { { 33, 44 } }
    check.near(one:mean().dip, 33, 1e-12)
    check.holds(one:mean().kappa ~= one:mean().kappa and one:mean().cone ~= one:mean().cone)
    check.equal(talus.poles({ { 33, 44 }, { 33, 44 } }):mean().kappa, math.huge)
    -- Two poles that are hardly apart: N - R = 2 - 2 cos(0.0005 degrees).
    local apart = math.rad(5e-4)
    check.near(talus.poles({ { 33, 44 }, { 33.001, 44 } }):mean().kappa * apart ^ 2, 1, 1e-4)
end

-- Along a vertical scan line a plane of dip d has the weight 1 / cos d, at most 10.
do
    local p = talus.poles({ { 0, 0 }, { 60, 90 }, { 90, 90 } }):terzaghi { trend = 0, plunge = 90 }
    local weights = {}
    for i, plane in ipairs(p.planes) do
        weights[i] = plane[3]
    end
    check.near(weights, { 1, 2, 10 }, 1e-12)
    -- a line that plunges 30 degrees to the north meets a plane 60/180 at right angles, 90/090 not at all
    local q = talus.poles({ { 60, 180 }, { 90, 90 } }):terzaghi { trend = 0, plunge = 30, most = 7 }
    check.near({ q.planes[1][3], q.planes[2][3] }, { 1, 7 }, 1e-12)
    local up = talus.poles({ { 60, 180 }, { 90, 90 } }):terzaghi { trend = 180, plunge = -30, most = 7 }
    check.near({ up.planes[1][3], up.planes[2][3] }, { 1, 7 }, 1e-12)
end

-- Sets: three clusters are found, whatever the order of the lines; the largest comes first.
local scattered = {}
for i = 0, 59 do
    scattered[#scattered + 1] = { 70 + 8 * math.sin(i), 200 + 8 * math.cos(1.7 * i) }
end
for i = 0, 39 do
    scattered[#scattered + 1] = { 10 + 6 * math.sin(i), 30 + 30 * math.cos(1.3 * i) }
end
for i = 0, 79 do -- about the vertical
    local dip = 90 + 5 * math.sin(2.1 * i)
    scattered[#scattered + 1] = dip <= 90 and { dip, 100 + 7 * math.cos(i) } or { 180 - dip, 280 + 7 * math.cos(i) }
end
do
    local sets = talus.poles(scattered):sets(3)
    check.near({ #sets[1], #sets[2], #sets[3] }, { 80, 60, 40 }, 0)
    check.near(sets[2]:mean().dip, 70, 1)
    check.near(sets[2]:mean().dip_direction, 200, 2)
    check.near(sets[1]:mean().dip, 90, 1)
    local shuffled = {}
    for i = 1, #scattered do
        shuffled[i] = scattered[(i * 77) % #scattered + 1]
    end
    for seed = 1, 3 do
        local others = talus.poles(shuffled):sets(3, { seed = seed })
        for i = 1, 3 do
            check.equal(others[i]:mean().dip, sets[i]:mean().dip)
            check.equal(others[i]:mean().kappa, sets[i]:mean().kappa)
        end
    end
    check.equal(#talus.poles(scattered):sets(1), 1)
    talus.stereonet { file = folder .. "/net.svg", poles = sets }
    talus.stereonet { file = folder .. "/net.svg", poles = talus.poles(scattered) }
end

-- Draws: measured planes only, by their weights; after Fisher about the mean.
do
    local p = talus.poles { { 10, 10, 1 }, { 50, 50, 3 } }
    local many, steep = p:draw(2000), 0
    for _, plane in ipairs(many) do
        check.holds(plane.dip == 10 or plane.dip == 50)
        steep = steep + (plane.dip == 50 and 1 or 0)
    end
    check.near(steep / 2000, 0.75, 0.04) -- four standard errors
    local set = talus.poles(scattered):sets(3)[2]
    local again = talus.poles(set:draw(3000, { distribution = "fisher", seed = 4 })):mean()
    check.near(again.dip, set:mean().dip, 1)
    check.near(again.kappa / set:mean().kappa, 1, 0.08)
end

-- Files: other columns, separators and names; what is written is read again.
do
    local p = talus.poles(scattered)
    p:write(folder .. "/all.csv")
    check.equal(talus.poles(folder .. "/all.csv"):mean().kappa, p:mean().kappa)
    local q = talus.poles(write("semi.csv", "\u{feff}# bench 3\nname;Dip;Dip Direction\r\nx;30;120\r\n\r\n\"y\";\"40\";130\r\n"))
    check.equal(#q, 2)
    check.near(q.planes[2], { 40, 130, 1 }, 0)
    -- as spreadsheets write them: decimal commas, separators in quotes, empty rows
    q = talus.poles(write("commas.csv", "Note;DIP;dip-direction\r\n\"a; \"\"b\"\"\";30,5;120\r\n;;\r\n;\"40,25\";\"130\"\r\n"))
    check.equal(#q, 2)
    check.near(q.planes[1], { 30.5, 120, 1 }, 0)
    check.near(q.planes[2], { 40.25, 130, 1 }, 0)
    q = talus.poles(write("tabs.csv", "dip\tdip direction\tnote\n30,5\t120\t\"1\t2\"\n31\t121\t\n"))
    check.near(q.planes[1], { 30.5, 120, 1 }, 0)
    for _, case in ipairs {
        { "dip,dip_direction\n30,120\n95,10\n", "line 3, column 'dip': 95 is outside [0, 90]" },
        { "dip,dip_direction\n30,1o0\n", "line 2, column 'dip_direction': '1o0' is no number" },
        { "dip,dip_direction\n30\n", "line 2 has 1 cell, the line of names has 2" },
        { "dip,dip_direction\n30,\n", "line 2, column 'dip_direction': the cell is empty" },
        { "dip,azimuth\n30,100\n", "line 1 does not name a column 'dip_direction', but has 'dip,azimuth': the first" },
        { "dip;dip_direction\n30,5;100\n31.5;110\n", "line 3, column 'dip': '31.5': numbers are to have decimal points or" },
        { "dip;dip_direction\n1.030,5;100\n", "line 2, column 'dip': '1.030,5': numbers are to have decimal points or" },
        { "dip;dip_direction\n30,5,1;100\n", "line 2, column 'dip': '30,5,1' is no number" },
        { "dip,dip_direction\n\"30,5\",100\n", "'30,5' is no number: decimal commas need semicolons between cells" },
        { "dip,dip_direction\n30,5,100,0\n", "line 2 has 4 cells, the line of names has 2 (decimal commas need semicolons" },
        { "dip,dip_direction,note\n30,100,\"a\nb\"\n", "line 3, column 'dip': 'b\"' is no number" },
        { "dip,dip_direction,dip\n30,100,3\n", "line 1 names a column twice" },
        { "dip,dip_direction,weight\n30,100,0\n", "line 2, column 'weight': 0 is outside [1e-09, 1e+09]" },
        { "dip,dip_direction\n30,nan\n", "'nan' is no number" },
        { "", "it is empty" },
        { "dip,dip_direction\n", "it has no row after the line of names" },
        { "dip,dip_direction\n30,100\n\0", "it holds a zero byte: it is no text; save it as UTF-8" },
        { "30,100\n40,100\n", "line 1 does not name a column 'dip'" },
    } do
        local path = write("bad.csv", case[1])
        check.raises(function() talus.poles(path) end, case[2])
        local model = talus.model {}
        model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 1000 })
        check.raises(function() model:generate("jointset", { joint = "J", poles = path, spacing = 1 }) end, case[2])
        check.raises(function() model:generate("dfn", { joint = "J", poles = path, number = 1, size_mean = 1 }) end, case[2])
    end
end

-- Dip directions by a compass become those from true north, east positive; what is written is from true north.
do
    local read = { { 30, 5, 2 }, { 40, 355, 1 }, { 50, 120, 1 } }
    local p = talus.poles(read, { declination = 10.5 })
    check.near(p:list()[1], { 30, 15.5 }, 1e-12)
    check.near(p:list()[2], { 40, 5.5 }, 1e-12)
    check.near(p:list()[3], { 50, 130.5 }, 1e-12)
    check.near(talus.poles(read, { declination = -10.5 }):list()[1], { 30, 354.5 }, 1e-12)
    local mean, turned = talus.poles(read):mean(), p:mean()
    check.near(turned.dip, mean.dip, 1e-9)
    check.near((turned.dip_direction - mean.dip_direction) % 360, 10.5, 1e-9)
    check.near(turned.kappa / mean.kappa, 1, 1e-9)
    p:write(folder .. "/north.csv")
    check.near(talus.poles(folder .. "/north.csv"):list()[2], { 40, 5.5 }, 1e-12)
    check.near(talus.poles(folder .. "/north.csv", { declination = -10.5 }):list()[2], { 40, 355 }, 1e-12)
end

-- A joint set of measured poles: its planes have their attitudes, and lie along the mean pole.
do
    local path = write("two.csv", "dip,dip_direction\n20,90\n20,270\n")
    local model = talus.model { seed = 3 }
    model:generate("box", { min = { -5, -5, -5 }, max = { 5, 5, 5 }, density = 1000 })
    model:generate("jointset", { joint = "J", poles = path, spacing = 1, number = 9, origin = { 0, 0, 0 } })
    local seen, along = {}, {}
    for _, block in ipairs(model:blocks()) do
        for _, face in ipairs(block.faces) do
            local plane = face.joint and tonumber(face.joint:match ":(%d+)$")
            if plane then
                local n = face.normal[3] > 0 and face.normal or { -face.normal[1], -face.normal[2], -face.normal[3] }
                check.near(n[3], math.cos(math.rad(20)), 1e-9)
                seen[n[1] > 0 and "east" or "west"] = true
                along[plane] = true
            end
        end
    end
    check.holds(seen.east and seen.west and #along == 9)
end

for _, case in ipairs {
    { function() talus.poles(folder .. "/none.csv") end, "cannot be read: No such file" },
    { function() talus.poles(folder) end, "cannot be read" },
    { function() talus.poles() end, "poles: name a table of planes, or give a list of {dip, dip_direction}, not nil" },
    { function() talus.poles {} end, "the list: it has no row" },
    { function() talus.poles(scattered, { declination = 181 }) end, "poles: declination = 181 is outside [-180, 180]" },
    { function() talus.poles(scattered, { decl = 3 }) end, "poles: unknown parameter 'decl'" },
    { function() talus.poles(scattered, 3) end, "poles: the second argument must be a table, not the number 3" },
    { function() talus.poles { { 95, 3 } } end, "poles, plane 1: dip = 95 is outside [0, 90]" },
    { function() talus.poles(scattered):sets(0) end, "the number of sets must be a whole number in [1, 180]" },
    { function() talus.poles(scattered):sets(2, { sed = 1 }) end, "unknown parameter 'sed'" },
    { function() talus.poles(scattered):draw(0) end, "the number must be a whole number in [1, 10000000]" },
    { function() talus.poles({ { 3, 3 } }):draw(1, { distribution = "fisher" }) end, "1 pole has no concentration" },
    { function() talus.poles(scattered):terzaghi { trend = 3 } end, "'plunge' is missing" },
    { function() talus.poles(scattered).mean() end, "mean: call it as p:mean(...)" },
    { function() talus.stereonet { file = folder .. "/x.svg", poles = { 3 } } end, "poles must be what talus.poles gives" },
} do
    check.raises(case[1], case[2])
end
