-- A layer of soil on rock under shear waves: how much more its surface moves than an outcrop of the rock.
package.path = "tests/verify/?.lua;tests/lua/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local waves = require "check_waves"
local reference = require "reference_earthquakes"

-- 20 blocks are a lattice, not a continuum. `ROCK`: blocks below the soil, the last on a quiet face.
local AMPLIFICATION, BALANCE, ROCK = 0.01, 1e-3, 5
local PULSE, SIZE, END = 0.05, 1e-3, 3 -- s of the pulse, m/s of its peak, and s until the layer is at rest

local i = reference.amplification
local stiffness = i.density * i.speed ^ 2 / i.height

-- What shears as a block of soil over one of rock: half of each.
local function of(kind)
    local rock = stiffness / i.impedance_ratio ^ 2
    local ks = kind == "soil" and stiffness or kind == "rock" and rock or 2 / (1 / stiffness + 1 / rock)
    return { kn = 2.5 * ks, ks = ks }
end

figures.case("DYN.site.amplification", "A pulse comes up through rock into a layer that has a quarter of its impedance: "
    .. "motion of the surface over that of an outcrop", i.source)
local model = talus.model { gravity = { 0, 0, 0 } }
for k = -ROCK, i.blocks - 1 do
    model:generate("box", { min = { 0, 0, k * i.height }, max = { 1, 1, (k + 1) * i.height }, density = i.density,
        group = k < 0 and "rock" or "soil" })
end
model:joint("*", "elastic", of "soil")
model:joint({ between = { "rock", "rock" } }, "elastic", of "rock")
model:joint({ between = { "rock", "soil" } }, "elastic", of "seam")
model:blocks():fix { y = true, z = true, rotation = true }
local at = {}
for k = 0, 200 do
    at[k + 1] = SIZE * math.sin(math.pi * k / 200) ^ 2
end
local wave = talus.record { at = at, dt = PULSE / 200, quantity = "velocity" }
local speed = i.speed / i.impedance_ratio
model:boundary { zmin = { quiet = true, p_velocity = 1.5 * speed, s_velocity = speed, input = { wave, 0, 0 } } }
local top = model:blocks { containing = { 0.5, 0.5, (i.blocks - 0.5) * i.height } }[1]
model:timestep { dt = model.dt }
local t, moved, came = {}, {}, {}
while model.time < END do
    model:cycle(1)
    local n = #t + 1
    t[n], moved[n] = model.time - model.dt / 2, top.velocity[1]
    came[n] = wave:velocity(t[n])
end
for _, row in ipairs(i) do
    local a, b = waves.fourier(t, moved, row.frequency)
    local c, d = waves.fourier(t, came, row.frequency)
    figures.relative(string.format("%.4g Hz: surface over outcrop", row.frequency),
        math.sqrt((a ^ 2 + b ^ 2) / (c ^ 2 + d ^ 2)) / 2, row.ratio, AMPLIFICATION)
end
figures.between("balance", math.abs(model:energy().balance), 0, BALANCE)
figures.finish()
