-- The example of histories and pictures: its files, and what they tell of the wedge.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"

local folder = string.format("%s/monitor_%s", assert(os.getenv("TALUS_TEST_TMP")), tostring({}):match("0x(%x+)") or "0")
local monitor = assert(loadfile("scripts/examples/monitor.lua"))("examples.monitor")
local model = monitor.main(folder)

local function read(name)
    local file = assert(io.open(folder .. "/" .. name))
    local text = file:read("a")
    file:close()
    return text
end

local h = model:histories()
local last = #h.wedge.time
check.near(h.wedge.time[last], 1, 0.01)
-- Down the line in which the two discontinuities meet, 42 degrees, and out of the slope to the west.
local d = h.wedge.value[last]
check.near(math.deg(math.atan(-d[3], math.sqrt(d[1] ^ 2 + d[2] ^ 2))), 42, 0.5)
check.holds(d[1] < -0.5 and math.abs(d[2]) < 0.05, "to the west")
check.near(h.along.value[last], math.sqrt(d[1] ^ 2 + d[2] ^ 2 + d[3] ^ 2), 1e-3)
-- The table has a line for each sample, and the pictures are of the sets there are.
check.equal(select(2, read("histories.csv"):gsub("\n", "")), last + 1)
check.holds(read("histories.csv"):find("^cycle,time,wedge.x,wedge.y,wedge.z,along,kinetic,friction,slipping\n"), "columns")
for _, name in ipairs { "D1", "D2", "foliation", "fracture" } do
    check.holds(read("joints.svg"):find(">" .. name .. "</text>", 1, true), name)
end
for name, label in pairs { displacement = "displacement (m)", energy = "energy (10⁶ J)" } do
    check.holds(read(name .. ".svg"):find(">" .. label .. "</text>", 1, true), label)
end
os.execute("rm -rf '" .. folder .. "'")
