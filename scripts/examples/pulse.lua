-- pulse.lua - a pulse of shear comes to a joint in an elastic bar: a part goes through, a part goes back.
--
--     build/release/talus scripts/examples/pulse.lua [folder]
--
-- A wave of frequency w that comes straight to a joint of the stiffness k, in rock of the impedance z = rho c, goes on with
-- the share |T| and goes back with |R| (Pyrak-Nolte, Myer and Cook 1990):
--
--     |T| = 2 k / sqrt(4 k^2 + (w z)^2),    |R| = w z / sqrt(4 k^2 + (w z)^2)
--
-- The bar is driven at its foot by one wave train; both ends let waves out.
local talus = require "talus"

local pulse = {}

pulse.density, pulse.young, pulse.poisson = 2600, 26e9, 0.25
pulse.long, pulse.side = 100, 1 -- m; the joint is in the middle
pulse.frequency, pulse.waves = 400, 9 -- Hz; waves of the train

function pulse.speed()
    return math.sqrt(pulse.young / (2 * (1 + pulse.poisson)) / pulse.density)
end

-- The bar, with a joint of this shear stiffness, Pa/m.
function pulse.build(stiffness, zone)
    local model = talus.model { gravity = { 0, 0, 0 } }
    local half = pulse.long / 2
    model:generate("box", { { min = { 0, 0, -half }, max = { pulse.side, pulse.side, 0 }, density = pulse.density },
        { min = { 0, 0, 0 }, max = { pulse.side, pulse.side, half }, density = pulse.density } })
    model:joint("*", "elastic", { kn = 100 * stiffness, ks = stiffness })
    model:solid("rock", "elastic", { young = pulse.young, poisson = pulse.poisson })
    model:blocks():deformable { zone = zone, solid = "rock" }
    model:boundary { zmin = { quiet = true }, zmax = { quiet = true } }
    model:gridpoints():fix { y = true, z = true } -- a wave of shear along x alone
    return model
end

-- The train swells over two waves, and ebbs away over two.
local function rise(waves)
    local edge = math.min(waves, pulse.waves - waves, 2)
    return math.sin(math.pi * edge / 4) ^ 2
end

-- Shares of the wave that go through the joint and back from it.
function pulse.run(stiffness, zone)
    local model = pulse.build(stiffness, zone)
    local period, half = 1 / pulse.frequency, pulse.long / 2
    local z = pulse.density * pulse.speed()
    -- an incoming wave of 1 mm/s: twice its traction on the dashpots of the foot
    local foot = model:gridpoints { inside = { min = { 0, 0, -half }, max = { 1, 1, -half + 1e-6 } } }
    local loaded = foot:sum "mass"
    local shares = {}
    for i, point in ipairs(foot) do
        shares[i] = point.mass / loaded
    end
    local low = model:gridpoints { near = { 0.5, 0.5, -half / 2 } }[1]
    local high = model:gridpoints { near = { 0.5, 0.5, half / 2 } }[1]
    local came, back, through = 0, 0, 0
    local passes = half / 2 / pulse.speed() -- from the foot to the lower gauge
    repeat
        local t = model.time
        local v = t < pulse.waves * period and 1e-3 * math.sin(2 * math.pi * t / period) * rise(t / period) or 0
        for i = 1, #foot do
            model:gridpoints { id = foot[i].id }:load { force = { 2 * z * v * shares[i] * pulse.side ^ 2, 0, 0 } }
        end
        model:cycle(1)
        if model.time < passes + (pulse.waves + 0.5) * period then
            came = math.max(came, math.abs(low.velocity[1]))
        else
            back = math.max(back, math.abs(low.velocity[1]))
        end
        through = math.max(through, math.abs(high.velocity[1]))
    until model.time > 3 * passes + (pulse.waves + 1) * period
    return through / came, back / came
end

function pulse.main()
    local z, w = pulse.density * pulse.speed(), 2 * math.pi * pulse.frequency
    print("w z / k    through  expected    back  expected")
    for _, ratio in ipairs { 0.5, 1, 2, 4 } do
        local through, back = pulse.run(w * z / ratio, 0.5)
        local root = math.sqrt(4 + ratio ^ 2)
        print(string.format("%5.1f       %6.3f    %6.3f  %6.3f    %6.3f", ratio, through, 2 / root, back, ratio / root))
    end
end

-- A test that says require "examples.pulse" wants the functions only.
if ... ~= "examples.pulse" then
    pulse.main()
end
return pulse
