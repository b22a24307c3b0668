-- A block that rocks on its edges loses angular velocity at each impact (Housner, 1963), and swings between impacts as a rigid
-- one. Its base touches at the corners, and dashpots at the contact take up what the new edge is struck with.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"

local GRAVITY, DENSITY, HEIGHT = 9.81, 2000, 1
local IMPACTS = 4
-- Height over width, and stiffness, Pa/m. Housner's block is rigid: a squat one strikes harder, and needs a stiffer joint.
local CASES = { { 8, 1e10 }, { 4, 1e10 }, { 3, 1e10 }, { 2, 1e11 } }
-- Fraction of critical damping of the block on its joint, up and down. Below 0.3 it bounces; far above 1 the step is short, and the
-- edge on which it turns is slow to give way.
local DAMPING = 0.8
local KEPT, SWING, BALANCE = 0.02, 0.01, 1e-3

-- s from rest at a tilt to upright, by quadrature; the block is h x 2 b.
local function quarter(tilt, slope, radius)
    local steps, sum = 2000, 0
    for i = 1, steps do
        local u = (i - 0.5) / steps
        local at = tilt * (1 - u * u)
        local speed = math.sqrt(1.5 * GRAVITY / radius * (math.cos(slope - tilt) - math.cos(slope - at)))
        sum = sum + 2 * u * tilt / speed / steps
    end
    return sum
end

local function build(width, tilt, stiffness)
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, contact_points = "corners" }
    model:generate("box", { min = { -2, -1, -1 }, max = { 2, 2, 0 }, density = DENSITY, group = "base" })
    local s, c, vertices = math.sin(tilt), math.cos(tilt), {}
    for _, x in ipairs { -width, 0 } do
        for _, y in ipairs { 0, 1 } do
            for _, z in ipairs { 0, HEIGHT } do
                vertices[#vertices + 1] = { x * c + z * s, y, -x * s + z * c }
            end
        end
    end
    model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "block" })
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = stiffness, ks = stiffness, friction = 80 })
    local frequency = math.sqrt(stiffness / (DENSITY * HEIGHT)) / (2 * math.pi)
    model:damping("dashpot", { ratio = DAMPING, frequency = frequency })
    return model, model:blocks { group = "block" }
end

for _, case in ipairs(CASES) do
    local slender, stiffness = case[1], case[2]
    local width = HEIGHT / slender
    local slope, radius = math.atan(width, HEIGHT), math.sqrt(width ^ 2 + HEIGHT ^ 2) / 2
    local tilt, kept = 0.5 * slope, 1 - 1.5 * math.sin(slope) ^ 2
    figures.case("DYN.housner." .. slender, string.format("Block of %.3g x %g m let go at half the tilt at which it would "
        .. "fall", width, HEIGHT), "G. W. Housner, Bull. Seism. Soc. Am. 53 (1963); quadrature of the swing")
    local model, block = build(width, tilt, stiffness)
    local mass = DENSITY * width * HEIGHT
    local upright = mass * GRAVITY * radius * (math.cos(slope - tilt) - math.cos(slope))
    local function energy()
        local e = model:energy()
        return upright + e.kinetic + e.potential + e.stored, e.balance
    end
    local before, time, from, last, impacts, worst = upright, 0, tilt, 0, 0, 0
    while impacts < IMPACTS do
        model:cycle(10)
        local speed = block[1].angular_velocity[2]
        local now, balance = energy()
        worst = time > 0 and math.max(worst, math.abs(balance)) or 0
        if speed * last < 0 then
            local angle = math.abs(tilt + 2 * math.asin(block[1].rotation[3]))
            local whole = quarter(from, slope, radius) + quarter(angle, slope, radius)
            impacts = impacts + 1
            if impacts > 1 then -- the first one begins with a drop onto the edge
                figures.relative("angular velocity kept at impact " .. impacts, math.sqrt(now / before), kept, KEPT)
                figures.relative("time of the swing, s", model.time - time, whole, SWING)
            end
            before, time, from = now, model.time, angle
        end
        last = speed
    end
    figures.between("worst energy balance after the first swing, of the largest term", worst, 0, BALANCE)
end
figures.finish()
