-- Tones that meet a joint between bars of zones: a joint of springs, and one that slips.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local waves = require "check_waves"
local zones = require "check_zones"

local JOINT = 0.02  -- of the incident wave, with 20 zones a wavelength
local SLIP = 0.03   -- of the incident energy
local LEDGER = 1e-3 -- of the largest term, without damping and elastic
local ZONES = 20    -- zones a wavelength
local WIDE = 3      -- zones: a joint's own mass is that of half a layer of zones only in the mean over several

local ledger = {}

local function note_balance(name, model)
    ledger[#ledger + 1] = { name, model:energy().balance }
end

-- ------------------------------------------------------------------ one elastic joint

-- A tone of three periods meets a joint after 6 wavelengths. It has passed a place two wavelengths before the joint
-- when what is reflected comes by there. What goes through is beside what goes through a joint that is a hundred times
-- as stiff as for x = 1.
do
    local case = reference["DF.pyrak_nolte"]
    local BEFORE, AFTER, PERIODS, SIZE, HZ, STIFFEST = 6, 12, 3, 0.01, 1000, 0.01
    figures.case("DF.pyrak_nolte", "A tone meets a joint of springs: how much goes through, how much is reflected, and how late it "
        .. "comes, over x = w Z / (2 k).", case.source)
    for _, wave in ipairs { "P", "S" } do
        local c = wave == "P" and reference["DF.wave_speed"].expected.cp or reference["DF.wave_speed"].expected.cs
        local length, Z, w = c / HZ, waves.impedance(wave), 2 * math.pi * HZ
        local function tone(t)
            return t * HZ < PERIODS and SIZE * math.sin(math.pi * t * HZ / PERIODS) ^ 2 * math.sin(w * t) or 0
        end
        local dt
        local function run(x)
            local k = w * Z / (2 * x)
            local model = waves.bars({}, wave, length / ZONES, WIDE, { BEFORE * length, AFTER * length }, "elastic", { kn = k, ks = k })
            dt = dt or model.dt
            model:timestep { dt = dt } -- that of the stiffest: how late waves come depends on it
            local at = { zones.on(model, "z", (BEFORE - 2) * length), zones.on(model, "z", (BEFORE + 0.5) * length) }
            local out = waves.shoot(model, wave, 15.5 / HZ, tone, at)
            note_balance(string.format("DF.pyrak_nolte, %s, x = %g", wave, x), model)
            return out
        end
        local incident = run(STIFFEST)
        local c0, s0 = waves.fourier(incident.t, incident[2], HZ)
        local size = math.sqrt(c0 * c0 + s0 * s0)
        local xs, through, back, wanted_through, wanted_back = {}, {}, {}, {}, {}
        for key in pairs(case.expected.by_x) do
            xs[#xs + 1] = tonumber(key)
        end
        table.sort(xs)
        for n, x in ipairs(xs) do
            local wanted, out = case.expected.by_x[x < 1 and tostring(x) or string.format("%.1f", x)], run(x)
            local name, comes, reflected = string.format("%s, x = %g: ", wave, x), {}, {}
            for step, v in ipairs(out[1]) do
                local early = out.t[step] * HZ < BEFORE + 1.5
                comes[step], reflected[step] = early and v or 0, early and 0 or v
            end
            local ct, st = waves.fourier(out.t, out[2], HZ)
            local cr, sr = waves.fourier(out.t, reflected, HZ)
            local ci, si = waves.fourier(out.t, comes, HZ)
            through[n], back[n] = math.sqrt(ct * ct + st * st) / size, math.sqrt((cr * cr + sr * sr) / (ci * ci + si * si))
            wanted_through[n], wanted_back[n] = wanted.T, wanted.R
            local phase = math.atan(st, ct) - math.atan(s0, c0) + math.atan(STIFFEST)
            phase = (phase + math.pi) % (2 * math.pi) - math.pi
            figures.near(name .. "transmitted", through[n], wanted.T, JOINT)
            figures.near(name .. "reflected", back[n], wanted.R, JOINT)
            figures.near(name .. "late by, rad", phase, wanted.phase, JOINT)
        end
        figures.plot { title = "DF.pyrak_nolte: " .. wave .. " waves", x = "w Z / (2 k)", y = "share of the amplitude", log_x = true,
            series = { { name = "transmitted, theory", x = xs, y = wanted_through, style = "line" },
                { name = "reflected, theory", x = xs, y = wanted_back, style = "line" },
                { name = "transmitted, zones", x = xs, y = through, style = "points" },
                { name = "reflected, zones", x = xs, y = back, style = "points" } } }
    end
end

-- ------------------------------------------------------------------ a joint that slips

do
    local case = reference["DF.miller"]
    local BEFORE, AFTER, SIZE, HZ, STIFF, FINE = 6, 8, 0.01, 1000, 50, 2 * ZONES
    local c, Z = reference["DF.wave_speed"].expected.cs, waves.impedance "S"
    local length, w, tau = c / HZ, 2 * math.pi * HZ, waves.impedance "S" * SIZE
    figures.case("DF.miller", "A shear wave meets a joint that bears a shear stress up to a share of the wave's: energy that goes "
        .. "through, that is reflected, and that slip turns to heat, over three periods.", case.source)
    local function run(strength)
        local k = STIFF * w * Z / 2 -- x = 1 / STIFF: the springs keep next to nothing
        local strong = { kn = k, ks = k, cohesion = strength, residual_cohesion = strength, tension = 1e12, residual_tension = 1e12 }
        local model = waves.bars({}, "S", length / FINE, 1, { BEFORE * length, AFTER * length }, "coulomb_tensile", strong)
        local at = { zones.on(model, "z", (BEFORE - 0.5) * length), zones.on(model, "z", (BEFORE + 0.5) * length) }
        local function tone(t)
            return t > 0 and SIZE * math.sin(w * t) * math.min(1, t * HZ) or 0
        end
        local heat = {}
        local first = waves.shoot(model, "S", (BEFORE + 2.5) / HZ, tone, at)
        heat[1] = model:energy().friction
        local begun = first.t[#first.t]
        local out = waves.shoot(model, "S", 3 / HZ, function(t) return tone(t + begun) end, at)
        heat[2] = model:energy().friction
        note_balance(string.format("DF.miller, strength %g of the stress", strength / tau), model)
        return out, (heat[2] - heat[1]) * (FINE / length) ^ 2
    end
    local function energy(v, t)
        local sum = 0
        for _, x in ipairs(v) do
            sum = sum + Z * x * x * (t[2] - t[1])
        end
        return sum
    end
    local whole = run(100 * tau)
    local all = energy(whole[1], whole.t)
    local x, y, wanted = {}, { {}, {}, {} }, { {}, {}, {} }
    for n, key in ipairs(case.inputs.strength_over_amplitude) do
        local out, heat = run(tonumber(key) * tau)
        local e, back = case.expected.energy[key], {}
        for k, v in ipairs(out[1]) do
            back[k] = v - whole[1][k]
        end
        local got = { energy(out[2], out.t) / all, energy(back, out.t) / all, heat / all }
        for k, what in ipairs { "transmitted", "reflected", "absorbed" } do
            figures.near(string.format("strength %s: %s", key, what), got[k], e[what], SLIP)
            y[k][n], wanted[k][n] = got[k], e[what]
        end
        x[n] = tonumber(key)
    end
    local series = {}
    for k, what in ipairs { "transmitted", "reflected", "absorbed" } do
        series[#series + 1] = { name = what .. ", theory", x = x, y = wanted[k], style = "line" }
        series[#series + 1] = { name = what .. ", zones", x = x, y = y[k], style = "points" }
    end
    figures.plot { title = "DF.miller: energy", x = "strength over the stress of the wave", y = "share of the energy", series = series }
end

-- ------------------------------------------------------------------ energy

figures.case("DF.ledger.joints", "The energy that is gained or lost as tones meet joints between bars, over the largest term.", "first law")
for _, row in ipairs(ledger) do
    figures.near(row[1], row[2], 0, LEDGER)
end
figures.finish()
