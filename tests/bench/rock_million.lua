-- Generates a rock mass of about a million blocks: a cube cut by three dispersed joint sets. Run as
--
--     build/release/talus tests/bench/rock_million.lua [planes]
--
-- `planes` is the number of planes of each set (100 when left out; 9, 21 and 46 make 1,000, 10,000 and
-- 100,000 blocks). Tells processor time, cuts per second over the whole of `generate`, and the most
-- memory the process has had, where the system tells it.
local talus = require "talus"

local planes = tonumber(arg and arg[1]) or 100
local side = 100
local model = talus.model { seed = 1 }
model:generate("box", { min = { 0, 0, 0 }, max = { side, side, side }, density = 2600 })

local sets = {
    { joint = "J1", dip = 2, dip_direction = 40 },
    { joint = "J2", dip = 88, dip_direction = 85 },
    { joint = "J3", dip = 86, dip_direction = 175 },
}
local began, cuts, worst = os.clock(), 0, 0
for _, set in ipairs(sets) do
    set.dip_dev, set.dip_direction_dev = 0.5, 0.5
    set.spacing, set.spacing_dev = side / (planes + 1), 0.2 * side / (planes + 1)
    set.number, set.origin = planes, { side / 2, side / 2, side / 2 }
    local start = os.clock()
    local summary = model:generate("jointset", set)
    cuts, worst = cuts + summary.cuts, math.max(worst, summary.volume_error)
    print(string.format("%s: %d blocks, %d cuts, %d refused, %.2f s", set.joint, summary.after,
        summary.cuts, summary.refused, os.clock() - start))
end
local seconds = os.clock() - began
print(string.format("%d blocks, volume kept to %.1e, %.2f s, %.2f million cuts/s",
    #model:blocks(), worst, seconds, 1e-6 * cuts / seconds))
local status = io.open("/proc/self/status")
local peak = status and status:read("a"):match("VmHWM:%s*(%d+) kB")
if peak then
    print(string.format("peak memory %.0f MB, %.0f bytes a block", peak / 1024, 1024 * peak / #model:blocks()))
end
