-- The first example runs, finds the failure near the closed form, and leaves a series to look at.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"

local folder = (os.getenv "TALUS_TEST_TMP" or "out") .. "/quickstart"
arg[1] = folder

-- What it prints is read and shown.
local show = print
local function run(chunk)
    local lines = {}
    print = function(text)
        lines[#lines + 1] = text
        show(text)
    end
    chunk()
    print = show
    local text = table.concat(lines, "\n")
    return tonumber(text:match "slides at a friction coefficient of ([%d.]+)"), tonumber(text:match "it slides ([%d.]+) m")
end

-- T less 3/4 of the friction that just holds it, for 1 s, when it moves straight. On joints a hundred times as stiff it
-- hardly turns; on its own, which yield by a millimetre, it turns and slides farther by 6 %.
local example = assert(io.open "scripts/examples/quickstart.lua"):read "a"
local stiff, count = example:gsub("kn = 1e7, ks = 1e7", "kn = 1e9, ks = 1e9")
figures.equal("stiffer joints", count, 1)
local failure, slid = run(assert(load(stiff, "=quickstart.lua on stiff joints")))
figures.relative("slide on stiff joints", slid, 0.5 * 10 * (0.60264 - 0.75 * failure * 0.91542), 0.01)

failure = run(assert(loadfile "scripts/examples/quickstart.lua"))
figures.between("friction at failure", failure, 0.645, 0.665)

for _, name in ipairs { "wedge_blocks", "wedge_contacts", "wedge_joints" } do
    local index = assert(io.open(folder .. "/" .. name .. ".vtk.series")):read "a"
    local files = 0
    for file in index:gmatch('"name"%s*:%s*"([^"]+)"') do
        local head = assert(io.open(folder .. "/" .. file, "rb")):read "l"
        files = files + (head:match "^# vtk DataFile Version 3.0" and 1 or 0)
    end
    figures.equal(name .. " frames", files, 21)
end
figures.finish()
