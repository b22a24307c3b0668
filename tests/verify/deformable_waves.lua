-- Waves along bars of zones: their speed, what ends and a joint make of them, bars that meet, and the energy of it all.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local waves = require "check_waves"
local zones = require "check_zones"

local ARRIVAL = 0.005  -- relative, with 20 zones a wavelength
local AMPLITUDE = 0.02 -- relative, of the incident wave
local JOINT = 0.02     -- of the incident wave
local IMPACT = 0.02    -- of the speed before
local CONTACT = 0.04   -- relative, of the time in contact
local LEDGER = 1e-3    -- of the largest term, without damping and elastic
local ZONES = 20       -- zones a wavelength

local ledger = {}

local function note_balance(name, model)
    ledger[#ledger + 1] = { name, model:energy().balance }
end

-- ------------------------------------------------------------------ speed and ends

do
    local case = reference["DF.wave_speed"]
    local LENGTH, FIRST, SECOND, SIZE = 3, 1, 2, 0.01
    figures.case("DF.wave_speed", "A pulse of 1 m goes along a bar of 3 m to an end that is free, or held: its speed between two "
        .. "places, its size, and what the end makes of it.", case.source)
    for _, wave in ipairs { "P", "S" } do
        local c = wave == "P" and case.expected.cp or case.expected.cs
        local T, shear = 1 / c, wave == "S"
        local function pulse(t)
            return t > 0 and t < T and SIZE * math.sin(math.pi * t / T) ^ 2 or 0
        end
        for _, fate in ipairs { "free", "fixed" } do
            local name = wave .. ", end " .. fate .. ": "
            local model = waves.bars(case.inputs, wave, 1 / ZONES, 1, { LENGTH })
            local last = zones.on(model, "z", LENGTH)
            if fate == "fixed" then
                last:fix()
            end
            local at = { zones.on(model, "z", FIRST), zones.on(model, "z", SECOND), last }
            local stress, most, theory, force = wave == "S" and "zx" or "zz", 0, 0, 0
            local near_end = model:zones { inside = { min = { -1, -1, LENGTH - 2 / ZONES }, max = { 1, 1, LENGTH } } }
            local place, volume = near_end:values "centroid", near_end:values "volume"
            local step = 0
            local out = waves.shoot(model, wave, LENGTH / c + 1.2 * T, pulse, at, function(t)
                step = step + 1
                if fate == "free" and step % 2 == 0 then
                    -- what comes and what the end sends back
                    local wanted, all = 0, 0
                    for k, p in ipairs(place) do
                        local there = pulse(t - p[3] / c) - pulse(t - (2 * LENGTH - p[3]) / c)
                        wanted, all = wanted - waves.impedance(wave) * there * volume[k], all + volume[k]
                    end
                    most = math.max(most, math.abs(zones.mean(near_end, "stress", stress)))
                    theory = math.max(theory, math.abs(wanted) / all)
                end
                force = math.max(force, math.abs(last:reaction()[wave == "S" and 1 or 3]))
            end)
            local function passes(r, z) -- before the end sends it back
                local v = {}
                for k, t in ipairs(out.t) do
                    v[k] = t < z / c + 1.5 * T and out[r][k] or 0
                end
                return v
            end
            local first, second = passes(1, FIRST), passes(2, SECOND)
            local speed_of = (SECOND - FIRST) / (waves.centre_of(out.t, second) - waves.centre_of(out.t, first))
            if fate == "free" then
                figures.relative(name .. "speed, m/s", speed_of, c, ARRIVAL)
                figures.relative(name .. "largest velocity on the way, m/s", waves.largest(second), SIZE, AMPLITUDE)
                figures.relative(name .. "velocity of the end, m/s", waves.largest(out[3]), 2 * SIZE, AMPLITUDE)
                figures.near(name .. "largest stress of the last two layers, of that of the wave", most / (waves.impedance(wave) * SIZE),
                    theory / (waves.impedance(wave) * SIZE), AMPLITUDE)
            else
                figures.relative(name .. "stress of the end, of that of the wave", force * ZONES ^ 2 / (waves.impedance(wave) * SIZE), 2,
                    AMPLITUDE)
                figures.near(name .. "velocity of the end, m/s", waves.largest(out[3]), 0, 0)
            end
            note_balance("DF.wave_speed, " .. name, model)
        end
    end
end

do
    local case = reference["DF.joint_pulse"]
    local T, SIZE, FINE, BEHIND = 0.01, 0.01, 2 * ZONES, 1.75 -- zones, and wavelengths from the source to where it is looked at
    local length = reference["DF.wave_speed"].expected.cp * T
    figures.case("DF.joint_pulse", "A pulse meets a joint of springs, which lets it through as a low pass does.", case.source)
    local params = { kn = case.inputs.kn, ks = case.inputs.kn }
    local model = waves.bars({}, "P", length / FINE, 1, { 1.5 * length, 4 * length }, "elastic", params)
    local after = zones.on(model, "z", BEHIND * length)
    local out = waves.shoot(model, "P", 4.3 * T, function(t)
        return t < T and SIZE * math.sin(math.pi * t / T) ^ 2 or 0
    end, { after })
    local peak, x, y = 0, {}, {}
    for k, t in ipairs(out.t) do
        peak = math.max(peak, out[1][k] / SIZE)
        x[k], y[k] = t - BEHIND * T, out[1][k] / SIZE
    end
    for k, t in ipairs(case.expected.t) do
        local n = 1
        while n < #x - 1 and x[n + 1] < t do
            n = n + 1
        end
        local v = y[n] + (t - x[n]) / (x[n + 1] - x[n]) * (y[n + 1] - y[n])
        figures.near(string.format("transmitted over the peak at %g ms", 1e3 * t), v, case.expected.transmitted_over_peak[k], JOINT)
    end
    figures.near("largest", peak, case.expected.peak, JOINT)
    note_balance("DF.joint_pulse", model)
    figures.plot { title = "DF.joint_pulse: what comes through", x = "time, s", y = "velocity over that of the pulse",
        series = { { name = "zones", x = x, y = y, style = "line" },
            { name = "theory", x = case.expected.t, y = case.expected.transmitted_over_peak, style = "points" } } }
end

-- ------------------------------------------------------------------ bars that meet

do
    local case = reference["DF.bars_impact"]
    local i, e = case.inputs, case.expected
    local M = i.E * (1 - i.nu) / (1 + i.nu) / (1 - 2 * i.nu)
    local zone, GAP = i.L1 / (2 * ZONES), 1e-6
    figures.case("DF.bars_impact", "A bar strikes another one: velocities after, and how long they touch.", case.source)
    local function run(second)
        local model = zones.model { young = i.E, poisson = i.nu }
        model:generate("box", { min = { 0, 0, 0 }, max = { zone, zone, i.L1 }, density = i.rho })
        model:generate("box", { min = { 0, 0, i.L1 + GAP }, max = { zone, zone, i.L1 + GAP + second }, density = i.rho })
        model:joint("*", "coulomb", { kn = 100 * M / zone, ks = 100 * M / zone, friction = 0 })
        model:blocks():deformable { zone = zone, solid = "rock" }
        model:gridpoints {}:fix { x = true, y = true }
        local one, two = model:gridpoints { block = 1 }, model:gridpoints { block = 2 }
        one:set { velocity = { 0, 0, i.v } }
        model:timestep { zone_fraction = 0.5 } -- springs that close within a step make energy
        local function momentum(points)
            local masses, v, sum, all = points:values "mass", points:values("velocity", "flat"), 0, 0
            for k, m in ipairs(masses) do
                sum, all = sum + m * v[3 * k], all + m
            end
            return sum / all, sum
        end
        local dt, force, last = model.dt, {}, 0
        model:timestep { dt = dt }
        for n = 1, math.ceil(1.5 * e.contact_time / dt) do
            model:cycle(1)
            local _, now = momentum(two)
            force[n], last = (now - last) / dt, now
        end
        -- In contact while the force is more than half of what elastic waves give, in the mean over the time that a
        -- wave takes through two zones: fronts ring over a zone's width.
        local plateau, span = 0.5 * math.sqrt(i.rho * M) * zone ^ 2, math.ceil(zone / math.sqrt(M / i.rho) / dt)
        local steps = 0
        for n = 1, #force do
            local sum, count = 0, 0
            for k = math.max(1, n - span), math.min(#force, n + span) do
                sum, count = sum + force[k], count + 1
            end
            steps = steps + (sum / count > plateau / 2 and 1 or 0)
        end
        note_balance(string.format("DF.bars_impact, %g m", second), model)
        return (momentum(one)), (momentum(two)), steps * dt
    end
    local v1, v2, time = run(i.L2)
    figures.near("1 m on 3 m: velocity of the first after, m/s", v1, e.v1_after, IMPACT * i.v)
    figures.near("1 m on 3 m: mean velocity of the second after, m/s", v2, e.v2_mean_after, IMPACT * i.v)
    figures.near("1 m on 3 m: coefficient of restitution", (v2 - v1) / i.v, e.restitution, IMPACT)
    figures.relative("1 m on 3 m: time in contact, s", time, e.contact_time, CONTACT)
    v1, v2, time = run(i.L1)
    figures.near("equal bars: velocity of the first after, m/s", v1, e.equal_bars.v1, IMPACT * i.v)
    figures.near("equal bars: velocity of the second after, m/s", v2, e.equal_bars.v2, IMPACT * i.v)
    figures.relative("equal bars: time in contact, s", time, e.contact_time, CONTACT)
end

-- ------------------------------------------------------------------ energy

figures.case("DF.ledger.waves", "The energy that is gained or lost in waves along bars and impacts of bars, over the largest term.", "first law")
for _, row in ipairs(ledger) do
    figures.near(row[1], row[2], 0, LEDGER)
end
figures.finish()
