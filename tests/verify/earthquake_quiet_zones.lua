-- Quiet faces of deformable blocks: energy that a pulse leaves in a bar of zones, and a wave that comes in at its base.
package.path = "tests/verify/?.lua;tests/lua/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local waves = require "check_waves"
local zones = require "check_zones"
local reference = require "reference_earthquakes"

local i = reference.quiet_zones
local PEAK, ARRIVAL, BALANCE = 0.01, 0.02, 1e-3

local function speed_of(wave)
    local shear = i.E / (2 * (1 + i.nu))
    return math.sqrt((wave == "P" and 2 * shear * (1 - i.nu) / (1 - 2 * i.nu) or shear) / i.rho)
end

local function left(energy)
    return energy.kinetic + energy.stored
end

figures.case("DYN.quiet.zones", "A pulse in the middle of a bar of zones leaves by both ends: pressure and shear", i.source)
for _, wave in ipairs { "P", "S" } do
    local model = waves.bars(i, wave, i.zone, 2, { i.length })
    model:boundary { zmin = { quiet = true }, zmax = { quiet = true } }
    for _, point in ipairs(model:gridpoints {}) do
        local x = (point.position[3] - i.length / 2) / i.pulse
        local v = math.abs(x) < 0.5 and i.size * math.cos(math.pi * x) ^ 2 or 0
        model:gridpoints { near = point.position }:set { velocity = wave == "P" and { 0, 0, v } or { v, 0, 0 } }
    end
    model:cycle(1)
    local sent = left(model:energy())
    while model.time < 1.5 * i.length / speed_of(wave) do
        model:cycle(20)
    end
    figures.between(wave .. ": energy left", left(model:energy()) / sent, 0, i.left)
    figures.between(wave .. ": balance", math.abs(model:energy().balance), 0, BALANCE)
end

figures.case("DYN.input.zones", "A wave comes in through the quiet base of a bar of zones, doubles at its free top and leaves", i.source)
for _, wave in ipairs { "P", "S" } do
    local model = waves.bars(i, wave, i.zone, 2, { i.length })
    local at = {}
    local long = i.pulse / speed_of(wave)
    for k = 0, 400 do
        at[k + 1] = i.size * math.sin(math.pi * k / 400) ^ 2
    end
    local rec = talus.record { at = at, dt = long / 400, quantity = "velocity" }
    model:boundary { zmin = { quiet = true, input = wave == "P" and { 0, 0, rec } or { rec, 0, 0 } } }
    local top, peak, when, most = zones.on(model, "z", i.length), 0, 0, 0
    while model.time < long + 2.5 * i.length / speed_of(wave) do
        model:cycle(1)
        local v = waves.speed(top, wave)
        if v > peak then
            peak, when = v, model.time - model.dt / 2
        end
        if model.cycles % 20 == 0 then
            most = math.max(most, left(model:energy()))
        end
    end
    figures.relative(wave .. ": peak velocity at the top over that of the wave", peak / i.size, 2, PEAK)
    figures.relative(wave .. ": way to the top, s", when - long / 2, i.length / speed_of(wave), ARRIVAL)
    figures.between(wave .. ": energy left", left(model:energy()) / most, 0, i.left)
    figures.between(wave .. ": balance", math.abs(model:energy().balance), 0, BALANCE)
end
figures.finish()
