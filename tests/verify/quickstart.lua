-- The first example runs, finds the failure near the closed form, and leaves a series to look at.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"

local folder = (os.getenv "TALUS_TEST_TMP" or "out") .. "/quickstart"
arg[1] = folder

-- What it prints is read and shown.
local lines, show = {}, print
print = function(text)
    lines[#lines + 1] = text
    show(text)
end
dofile "scripts/examples/quickstart.lua"
print = show

local text = table.concat(lines, "\n")
local failure = tonumber(text:match "slides at a friction coefficient of ([%d.]+)")
figures.between("friction at failure", failure, 0.645, 0.665)
local slid = tonumber(text:match "it slides ([%d.]+) m")
-- T less 3/4 of the friction that just holds it, for 1 s; it also turns, which is left out here.
figures.relative("slide", slid, 0.5 * 10 * (0.60264 - 0.75 * failure * 0.91542), 0.05)

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
