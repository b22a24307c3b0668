-- Quiet faces of rigid blocks: energy that pulses, packets of waves and waves at an angle leave behind; a wave that comes in.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_earthquakes"

local KN, KS, DENSITY = 1e10, 4e9, 2500
local LEFT, BALANCE = 1e-3, 1e-3 -- what a pulse of 12 blocks may leave; of the ledger
local LATTICE = 0.1 -- packets are some waves long
local OBLIQUE = 2e-3
local PEAK, ARRIVAL = 0.01, 0.05 -- 20 blocks are a lattice, not a continuum

-- Cubes of 1 m, nx beside each other and nz above, that move along one axis alone.
local function blocks(nx, nz, axis)
    local model = talus.model { gravity = { 0, 0, 0 } }
    local list = {}
    for i = 1, nx do
        for k = 1, nz do
            list[#list + 1] = { min = { i - 1, 0, k - 1 }, max = { i, 1, k }, density = DENSITY }
        end
    end
    model:generate("box", list)
    model:joint("*", "elastic", { kn = KN, ks = KS })
    model:blocks():fix { x = axis ~= 1, y = axis ~= 2, z = axis ~= 3, rotation = true }
    return model
end

-- Gives the blocks velocities along an axis by their centroids, and the energy that is in them.
local function kick(model, axis, speed)
    for _, block in ipairs(model:blocks()) do
        local v = { 0, 0, 0 }
        v[axis] = speed(block.centroid[1], block.centroid[3])
        model:blocks { id = block.id }:set { velocity = v }
    end
    model:cycle(1)
    local energy = model:energy()
    return energy.kinetic + energy.stored
end

-- What is left of it after a time, and the balance.
local function left(model, energy, time)
    while model.time < time do
        model:cycle(20)
    end
    local now = model:energy()
    return (now.kinetic + now.stored) / energy, math.abs(now.balance)
end

figures.case("DYN.quiet.pulse", "Pulses of 12 blocks in the middle of 48 leave by both ends: pressure and shear",
    reference.quiet.source)
for _, axis in ipairs { 3, 1 } do
    local model = blocks(1, 48, axis)
    model:boundary { zmin = { quiet = true }, zmax = { quiet = true } }
    local sent = kick(model, axis, function(_, z)
        return z > 18 and z < 30 and 1e-3 * math.sin(math.pi * (z - 18) / 12) ^ 2 or 0
    end)
    local c = math.sqrt((axis == 3 and KN or KS) / DENSITY)
    local share, balance = left(model, sent, 100 / c)
    figures.between(axis == 3 and "pressure: energy left" or "shear: energy left", share, 0, LEFT)
    figures.between("balance", balance, 0, BALANCE)
end

figures.case("DYN.quiet.reflection", "Packets of shear waves in a row of blocks leave by both ends: the energy that is sent back",
    reference.quiet.source)
for _, row in ipairs(reference.quiet.reflection) do
    local n = 30 * row.blocks
    local model, q = blocks(1, n, 1), 2 * math.pi / row.blocks
    model:boundary { zmin = { quiet = true }, zmax = { quiet = true } }
    model:timestep { fraction = 0.2 }
    local sent = kick(model, 1, function(_, z)
        local x = z - n / 2
        return 1e-3 * math.exp(-(x / (4 * row.blocks)) ^ 2) * math.cos(q * x)
    end)
    local speed = math.sqrt(KS / DENSITY) * math.cos(q / 2)
    local share = left(model, sent, 0.9 * n / speed)
    figures.relative(row.blocks .. " blocks a wave", share, row.series, LATTICE)
end

figures.case("DYN.quiet.oblique", "Shear waves that move across the plane of the angle, in a layer of blocks", "r = (cos a - 1) / (cos a + 1)")
for _, row in ipairs(reference.quiet.oblique) do
    -- half a wave across the layer, whose sides are free, so its length along the normal is 2 nx tan(a)
    local tangent = math.tan(math.rad(row.angle))
    local nx = math.max(6, math.ceil(9 / tangent))
    local along = 2 * nx * tangent
    local n = math.ceil(8 * along)
    local model = blocks(nx, n, 2)
    model:boundary { zmin = { quiet = true }, zmax = { quiet = true } }
    local sent = kick(model, 2, function(x, z)
        local y = z - n / 2
        return 1e-3 * math.cos(math.pi * x / nx) * math.exp(-(y / (1.3 * along)) ^ 2) * math.cos(2 * math.pi * y / along)
    end)
    local speed = math.sqrt(KS / DENSITY) * math.cos(math.rad(row.angle))
    figures.near(row.angle .. " degrees: energy sent back", left(model, sent, 0.9 * n / speed), row.energy, OBLIQUE)
end

figures.case("DYN.input.compliant", "A shear wave comes in through the quiet base of a column, doubles at its top and leaves",
    reference.input.source)
do
    local i = reference.input
    local model = talus.model { gravity = { 0, 0, 0 } }
    for k = 1, i.blocks do
        model:generate("box", { min = { 0, 0, (k - 1) * i.height }, max = { 1, 1, k * i.height }, density = i.density })
    end
    model:joint("*", "elastic", { kn = 2.5 * i.ks, ks = i.ks })
    model:blocks():fix { y = true, z = true, rotation = true }
    local at = {}
    for k = 0, 400 do
        at[k + 1] = i.size * math.sin(math.pi * k / 400) ^ 2
    end
    local wave = talus.record { at = at, dt = i.T / 400, quantity = "velocity" }
    model:boundary { zmin = { quiet = true, input = { wave, 0, 0 } } }
    local top, peak, when = model:blocks { containing = { 0.5, 0.5, i.blocks * i.height - 0.5 } }[1], 0, 0
    local most, share = 0, 0
    while model.time < i.T + 3 * i.arrival do
        model:cycle(1)
        local energy = model:energy()
        share = energy.kinetic + energy.stored
        most = math.max(most, share)
        if top.velocity[1] > peak then
            peak, when = top.velocity[1], model.time
        end
    end
    figures.relative("peak velocity at the top, m/s", peak, i.peak, PEAK)
    figures.relative("way to the top, s", when - i.T / 2, i.arrival, ARRIVAL)
    figures.between("energy left", share / most, 0, LEFT)
    figures.between("balance", math.abs(model:energy().balance), 0, BALANCE)
end
figures.finish()
