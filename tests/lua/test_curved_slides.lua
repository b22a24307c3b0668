-- Boxes slide on joints whose walls cannot close by more than some tenths of a millimetre (barton_bandis) and that slip opens: however
-- steep the curve is where they press, parts of the face open and close, and no energy is made.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local talus = require "talus"

-- Half sizes and height of the box, m; its velocity, m/s; the joint.
local CASES = {
    { { 0.6, 0.7, 1.5 }, { 0.3, 0.09 }, { jrc = 10.5, jcs = 8e7, phi_r = 30, kn = 1.54e8, ks = 1.34e8, vm = 3e-4 } },
    { { 0.6, 0.7, 1.5 }, { 0.3, 0.09 }, { jrc = 10.5, jcs = 8e7, phi_r = 30, kn = 1.54e8, ks = 1.34e8, vm = 1e-3 } },
    { { 0.43, 0.945, 0.31 }, { 0.768, 0 }, { jrc = 17.25, jcs = 4.822e7, phi_r = 31.85, kn = 1.037e8, ks = 9.353e7, vm = 9.704e-5 } },
}
for number, case in ipairs(check.few(CASES)) do
    local half, velocity, joint = table.unpack(case)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    model:generate("box", { min = { -6, -6, -2 }, max = { 6, 6, 0 }, density = 2500, group = "floor" })
    model:generate("box", { min = { -half[1], -half[2], 0 }, max = { half[1], half[2], half[3] }, density = 2500, group = "box" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "barton_bandis", joint)
    local box = model:blocks { group = "box" }
    box:set { velocity = { velocity[1], velocity[2], 0 } }
    local given, most, worst = box[1].kinetic_energy, 0, 0
    while model.time < 0.1 and model.cycles < 30000 do
        model:cycle(20)
        local e = model:energy()
        most = math.max(most, e.kinetic + e.potential)
        worst = math.max(worst, math.abs(e.balance))
    end
    check.holds(worst < 0.02, ("case %d: balance %g"):format(number, worst))
    check.holds(most < 1.001 * given, ("case %d: %g J were given, and %g J are there"):format(number, given, most))
end

-- Boxes slide, rock and land on joints that are no lines, of both laws there are, opened by slip or not: what is stored, moves and became
-- heat is what there was.
math.randomseed(3)
local R = math.random
for number = 1, check.cases(24) do
    local half = { 0.2 + 0.8 * R(), 0.2 + 0.8 * R(), 0.3 + 1.5 * R() }
    local kn, weight = 10 ^ (7.5 + 2 * R()), 2500 * 9.81 * half[3] -- Pa/m, Pa
    local law, joint = "barton_bandis", nil
    if number % 2 == 0 then
        joint = { jrc = 4 + 10 * R(), jcs = 5e7 + 5e7 * R(), phi_r = 25 + 8 * R(), kn = kn, ks = kn * (0.3 + 0.7 * R()),
            vm = weight / kn * 10 ^ (1.5 * R()), linear_from = 10 * weight, dilation = R() < 0.5 }
    else
        local power = 0.3 + 0.5 * R()
        law = "continuously_yielding"
        joint = { an = kn / weight ^ power, en = power, as = 0.5 * kn / weight ^ power, es = power, kn_max = kn * (1.2 + 3 * R()),
            ks_max = 2 * kn, phi_i = 45, phi = 30, roughness = 1e-3 * (1 + 10 * R()), dilation = R() < 0.5 }
    end
    local tilt, turn, low = 0.3 * R() * (R() < 0.5 and 0.02 or 1), 0.5 * R(), math.huge
    local vertices = {}
    for k = 0, 7 do
        local x, y, z = (2 * (k % 2) - 1) * half[1], (2 * (k // 2 % 2) - 1) * half[2], (k // 4) * half[3]
        x, z = math.cos(tilt) * x + math.sin(tilt) * z, math.cos(tilt) * z - math.sin(tilt) * x
        vertices[k + 1] = { math.cos(turn) * x - math.sin(turn) * y, math.sin(turn) * x + math.cos(turn) * y, z }
        low = math.min(low, z)
    end
    for _, v in ipairs(vertices) do
        v[3] = v[3] - low + (number % 3 == 0 and 2e-3 or 0)
    end
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    model:generate("box", { min = { -6, -6, -2 }, max = { R() < 0.3 and 0.5 * half[1] or 6, 6, 0 }, density = 2500, group = "floor" })
    model:generate("polyhedron", { vertices = vertices, density = 2500, group = "box" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", law, joint)
    model:blocks({ group = "box" }):set { velocity = { R(), 0.5 * R(), 0 } }
    model:timestep { fraction = 0.05 }
    local worst = 0
    while model.time < 0.15 and model.cycles < 8000 do
        model:cycle(20)
        worst = math.max(worst, math.abs(model:energy().balance))
    end
    check.holds(worst < 1e-3, ("box %d on %s: balance %g"):format(number, law, worst))
end
