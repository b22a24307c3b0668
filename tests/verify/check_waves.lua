-- check_waves.lua - bars of zones along z, waves that are sent along them, and what is measured of these.
local reference = require "reference_deformable"
local zones = require "check_zones"

local waves = {}

-- Bars one after the other along z from 0, each as long as `lengths` says, as many zones wide and thick as `wide`, on
-- rollers: P waves move gridpoints along z alone, S waves along x alone. The joints between them are of `law`.
function waves.bars(i, wave, zone, wide, lengths, law, params)
    local model, z = zones.model { young = i.E or 1e10, poisson = i.nu or 0.25 }, 0
    for _, length in ipairs(lengths) do
        model:generate("box", { min = { 0, 0, z }, max = { wide * zone, wide * zone, z + length }, density = i.rho or 2500 })
        z = z + length
    end
    if law then
        model:joint("*", law, params)
    end
    model:blocks():deformable { zone = zone, solid = "rock" }
    model:gridpoints {}:fix(wave == "P" and { x = true, y = true } or { y = true, z = true })
    return model
end

-- Mean velocity of a few gridpoints along the motion of the wave.
function waves.speed(points, wave)
    local values, sum = points:values("velocity", "flat"), 0
    for k = wave == "P" and 3 or 1, #values, 3 do
        sum = sum + values[k]
    end
    return sum / #points
end

-- Runs a model for a time, its end at z = 0 driven by a velocity, a function of time. Gives times and velocities at
-- receivers; `look` is called after each step with the time that stresses are of.
function waves.shoot(model, wave, time, velocity, receivers, look)
    local source, dt, out = zones.on(model, "z", 0), model.dt, { t = {} }
    local driven = wave == "P" and { z = true } or { x = true }
    source:fix(driven)
    model:timestep { dt = dt }
    for r in ipairs(receivers) do
        out[r] = {}
    end
    for n = 1, math.ceil(time / dt) do
        local v = velocity((n - 0.5) * dt)
        source:set { velocity = wave == "P" and { 0, 0, v } or { v, 0, 0 } }
        model:cycle(1)
        out.t[n] = (n - 0.5) * dt
        for r, points in ipairs(receivers) do
            out[r][n] = waves.speed(points, wave)
        end
        if look then
            look((n - 1) * dt) -- stresses and forces are those that the step began with
        end
    end
    return out
end

-- The part of a signal that swings by a frequency, as cosine and sine.
function waves.fourier(t, v, hz)
    local c, s, dt = 0, 0, t[2] - t[1]
    for k, x in ipairs(v) do
        c, s = c + x * math.cos(2 * math.pi * hz * t[k]) * dt, s + x * math.sin(2 * math.pi * hz * t[k]) * dt
    end
    return c, s
end

function waves.centre_of(t, v)
    local all, moment = 0, 0
    for k, x in ipairs(v) do
        all, moment = all + x, moment + x * t[k]
    end
    return moment / all
end

function waves.largest(v)
    local most = 0
    for _, x in ipairs(v) do
        most = math.max(most, math.abs(x))
    end
    return most
end

function waves.impedance(wave)
    local case = reference["DF.wave_speed"]
    return case.inputs.rho * (wave == "P" and case.expected.cp or case.expected.cs)
end

return waves
