-- large_slope.lua - the slope of the picture on the first page: some ten thousand blocks, and a wedge that comes out of them.
--
--     build/release/talus scripts/tools/large_slope.lua [folder]
--     tests/viewer/pictures.py large_slope       the picture, of the page that it writes
--
-- Two benches of rock, 100 x 80 m and 50 m high, are cut by bedding (18/120) and two sets of joints. Two faults dip towards
-- each other and meet in a line that plunges some 40 degrees out of the slope: the rock between them slides, for the faults have little
-- friction, and comes apart along the joints. All other rock is held. Writes a page of them as they are after SECONDS: large_slope.html in the folder
-- (out when left out).
local talus = require "talus"

local BOX = { min = { 0, 0, 0 }, max = { 100, 80, 50 } } -- m
local FACE = { dip = 68, dip_direction = 270 }
local BENCH, TOE, BERM = 22, 18, 10     -- height of the lower bench; x of its toe; width of the berm, m
local FAULTS = { D1 = { dip = 52, dip_direction = 218, origin = { 40, 40, 24 } }, D2 = { dip = 56, dip_direction = 322, origin = { 40, 40, 24 } } }
local SETS = {
    J1 = { dip = 18, dip_direction = 120, spacing = 3.1 },
    J2 = { dip = 76, dip_direction = 260, spacing = 3.4 },
    J3 = { dip = 84, dip_direction = 350, spacing = 3.7 },
}
local FRICTION, WEAK = 30, 12 -- of joints and of faults, degrees
local SECONDS, STEP = 1.1, 4e-4

local function face(x, z)
    return { dip = FACE.dip, dip_direction = FACE.dip_direction, origin = { x, 0, z } }
end

local function cut_away(model, name, plane)
    model:generate("joint", { joint = name, dip = plane.dip, dip_direction = plane.dip_direction, origin = plane.origin })
    model:blocks { above = plane }:delete()
end

local folder = arg[1] or "out"
local model = talus.model { gravity = { 0, 0, -9.81 }, seed = 5 }
model:generate("box", { min = BOX.min, max = BOX.max, density = 2600, group = "rock" })
local berm = { dip = 0, dip_direction = 0, origin = { 0, 0, BENCH } }
model:generate("joint", { joint = "berm", dip = 0, dip_direction = 0, origin = berm.origin })
local lower = model:blocks { below = berm }
lower:hide()
cut_away(model, "upper face", face(TOE + BENCH / math.tan(math.rad(FACE.dip)) + BERM, BENCH))
model:blocks { hidden = true }:show()
local upper = model:blocks { above = berm }
upper:hide()
cut_away(model, "lower face", face(TOE, 0))
model:blocks { hidden = true }:show()

for _, name in ipairs { "D1", "D2" } do
    local fault = FAULTS[name]
    model:generate("joint", { joint = name, dip = fault.dip, dip_direction = fault.dip_direction, origin = fault.origin })
end
for _, name in ipairs { "J1", "J2", "J3" } do
    local set = SETS[name]
    model:generate("jointset", { joint = name, dip = set.dip, dip_direction = set.dip_direction, spacing = set.spacing,
        number = 60, origin = { 50, 40, 25 } })
end
print(#model:blocks() .. " blocks")

model:filter { volume = 0.2, aspect = 25, action = "join" }
model:joint("*", "coulomb", { kn = 2e8, ks = 1e8, friction = FRICTION })
for name in pairs(FAULTS) do
    model:joint(name, { friction = WEAK })
end
model:blocks():fix()
local wedge = model:blocks { above = FAULTS.D1, where = function(b) return #model:blocks { id = b.id, above = FAULTS.D2 } == 1 end }
wedge:free()
print(#wedge .. " of them free")
model:damping("local", { alpha = 0.1 })
model:mass_scaling { dt = STEP, most = 0.2 }
model:cycle(math.floor(SECONDS / STEP))
model:write_html(folder .. "/large_slope.html", { title = "A wedge between two faults" })
print(string.format("%.2f s, %d steps", model.time, model.cycles))
