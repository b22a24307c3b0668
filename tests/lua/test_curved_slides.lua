-- Boxes slide on joints whose walls cannot close by more than some tenths of a millimetre (barton_bandis) and that slip opens: however
-- steep the curve is where they press, parts of the face open and close, and no energy is made.
local check = require "check"
local talus = require "talus"

-- Half sizes and height of the box, m; its velocity, m/s; the joint.
local CASES = {
    { { 0.6, 0.7, 1.5 }, { 0.3, 0.09 }, { jrc = 10.5, jcs = 8e7, phi_r = 30, kn = 1.54e8, ks = 1.34e8, vm = 3e-4 } },
    { { 0.6, 0.7, 1.5 }, { 0.3, 0.09 }, { jrc = 10.5, jcs = 8e7, phi_r = 30, kn = 1.54e8, ks = 1.34e8, vm = 1e-3 } },
    { { 0.43, 0.945, 0.31 }, { 0.768, 0 }, { jrc = 17.25, jcs = 4.822e7, phi_r = 31.85, kn = 1.037e8, ks = 9.353e7, vm = 9.704e-5 } },
}
for number, case in ipairs(CASES) do
    local half, velocity, joint = table.unpack(case)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    model:generate("box", { min = { -6, -6, -2 }, max = { 6, 6, 0 }, density = 2500, group = "floor" })
    model:generate("box", { min = { -half[1], -half[2], 0 }, max = { half[1], half[2], half[3] }, density = 2500, group = "box" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "barton_bandis", joint)
    local box = model:blocks { group = "box" }
    box:set { velocity = { velocity[1], velocity[2], 0 } }
    local given, most = box[1].kinetic_energy, 0
    while model.time < 0.1 and model.cycles < 30000 do
        model:cycle(20)
        local e = model:energy()
        most = math.max(most, e.kinetic + e.potential)
    end
    check.holds(most < 1.001 * given, ("case %d: %g J were given, and %g J are there"):format(number, given, most))
end
