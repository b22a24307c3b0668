-- Blocks laid exactly on each other slide on a joint that slip opens: which points were closed by a rounding does not decide how far it
-- opens. So the motion is the same in whatever attitude and place.
local check = require "check"
local talus = require "talus"

-- How far the upper of two boxes on a floor has risen after 40 steps, and how it spins: turned by an angle about y, and moved.
local function slide(angle, shift, law)
    local c, s = math.cos(angle), math.sin(angle)
    local m = talus.model { gravity = { -9.81 * s, 0, -9.81 * c } }
    m:timestep { dt = 1e-4 }
    local function box(p, q, low, height, group)
        local vertices = {}
        for k = 0, 7 do
            local x, y, z = p * (2 * (k % 2) - 1), q * (2 * (k // 2 % 2) - 1), low + height * (k // 4)
            vertices[k + 1] = { c * x + s * z + shift, y - shift, c * z - s * x }
        end
        m:generate("polyhedron", { vertices = vertices, density = 2500, group = group })
    end
    box(8, 8, -2, 2, "floor")
    box(0.41, 0.37, 0, 0.73, "a")
    box(0.33, 0.31, 0.73, 0.47, "b")
    m:joint("*", table.unpack(law))
    m:blocks { group = "floor" }:fix()
    m:blocks { group = "a" }:set { velocity = { -0.35 * c, 0, 0.35 * s } }
    m:blocks { group = "b" }:set { velocity = { 0.48 * c, 0, -0.48 * s } }
    m:cycle(40)
    local b = m:blocks { group = "b" }[1]
    return s * b.displacement[1] + c * b.displacement[3], b.angular_velocity[2]
end

for _, law in ipairs {
    { "coulomb", { kn = 1e9, ks = 5e8, friction = 23, dilation = 8 } },
    { "coulomb", { kn = 1e10, ks = 5e8, friction = 35, dilation = 2 } },
    { "coulomb_tensile", { kn = 1e9, ks = 5e8, friction = 23, dilation = 6 } },
    { "barton_bandis", { kn = 1e9, ks = 5e8, jrc = 8, jcs = 8e7, phi_r = 28, vm = 1e-3, linear_from = 1e5 } },
} do
    local rise, spin = slide(0, 0, law)
    for _, case in ipairs { { 0.1, 0 }, { 0.2, 0 }, { -0.17, 0 }, { -0.34, 77.7 }, { 0.6, 0 }, { 1.1, -30 } } do
        local other, turns = slide(case[1], case[2], law)
        check.holds(math.abs(other - rise) < 1e-9 and math.abs(turns - spin) < 1e-6,
            ("%s, turned by %g and moved by %g: rises by %.9g, not %.9g m, and spins at %.9g, not %.9g rad/s"):format(law[1], case[1],
                case[2], other, rise, turns, spin))
    end
end
