-- Beams of zones: how they ring. Constant strain alone would lock, strains averaged over all neighbours would be too
-- soft.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local BENDING = 0.065 -- relative, with four zones through the depth
local AXIAL = 0.005   -- relative
local LOWEST = 0.95   -- of the first bending mode: no mode may lie between 0 and this
local SPEED = 1e-6    -- m/s: no strain is more than 1e-8, so beams are linear
local RIGID = 1e-6    -- of the stress of a bent beam, after a rigid motion: rounding, and terms of second order

local function beam(i, zone)
    local model = zones.model { young = i.E, poisson = i.nu }
    local half = i.side / 2
    model:generate("box", { min = { -i.length / 2, -half, -half }, max = { i.length / 2, half, half }, density = i.rho })
    local report = model:blocks():deformable { zone = zone, solid = "rock" }
    return model, model:gridpoints {}, report
end

local function product(masses, a, b)
    local sum = 0
    for k, m in ipairs(masses) do
        local at = 3 * k
        sum = sum + m * (a[at - 2] * b[at - 2] + a[at - 1] * b[at - 1] + a[at] * b[at])
    end
    return sum
end

-- Six fields of velocity of a rigid body, made orthogonal by mass.
local function rigid_fields(masses, x)
    local fields = {}
    for kind = 1, 6 do
        local f = {}
        for k = 1, #masses do
            local p = { x[3 * k - 2], x[3 * k - 1], x[3 * k] }
            local v = { 0, 0, 0 }
            if kind <= 3 then
                v[kind] = 1
            else
                local a, b = (kind - 3) % 3 + 1, (kind - 2) % 3 + 1
                v[a], v[b] = -p[b], p[a]
            end
            for c = 1, 3 do
                f[3 * k - 3 + c] = v[c]
            end
        end
        fields[kind] = f
    end
    for n, f in ipairs(fields) do
        for before = 1, n - 1 do
            local share = product(masses, f, fields[before])
            for k = 1, #f do
                f[k] = f[k] - share * fields[before][k]
            end
        end
        local size = math.sqrt(product(masses, f, f))
        for k = 1, #f do
            f[k] = f[k] / size
        end
    end
    return fields
end

local function remove(masses, fields, v)
    for _, f in ipairs(fields) do
        local share = product(masses, v, f)
        for k = 1, #v do
            v[k] = v[k] - share * f[k]
        end
    end
end

local function set(points, v, size)
    local most, k = 0, 0
    for _, x in ipairs(v) do
        most = math.max(most, math.abs(x))
    end
    points:set { velocity = function()
        k = k + 3
        return { size * v[k - 2] / most, size * v[k - 1] / most, size * v[k] / most }
    end }
end

-- The frequency of a motion that begins with velocities alone: how often its share in what comes after passes 0.
local function frequency(i, zone, field, periods, guess)
    local model, points = beam(i, zone)
    local masses = points:values "mass"
    set(points, field, SPEED)
    local began = points:values("velocity", "flat")
    local every = math.max(1, math.floor(1 / guess / model.dt / 40))
    local last, first_at, last_at, passed = product(masses, began, began), nil, nil, 0
    local size = last
    local now, x, y = -model.dt / 2, { 0 }, { 1 } -- velocities are half a step behind
    local dt = model.dt
    while now < periods / guess do
        model:cycle(every)
        now = now + every * dt
        local share = product(masses, points:values("velocity", "flat"), began)
        x[#x + 1], y[#y + 1] = now, share / size
        if last * share < 0 then
            local at = now - every * dt * share / (share - last)
            first_at, last_at, passed = first_at or at, at, passed + 1
        end
        last = share
    end
    return (passed - 1) / 2 / (last_at - first_at), x, y
end

-- The slowest motion that is left of random velocities when all rigid ones are taken out: their mean over time with the
-- weights exp(-(t / s)^2 / 2) has of a mode of w the share exp(-(w s)^2 / 2).
local function slowest(i, zone, guess)
    local model, points = beam(i, zone)
    local masses, x = points:values "mass", points:values("position", "flat")
    local rigid, v, draw = rigid_fields(masses, x), {}, 12345
    for k = 1, #x do
        draw = (1103515245 * draw + 12345) % 2147483648
        v[k] = draw / 2147483648 - 0.5
    end
    remove(masses, rigid, v)
    set(points, v, SPEED)
    local span, sum = 1.5 / (2 * math.pi * guess), {}
    for k = 1, #x do
        sum[k] = 0
    end
    -- every step: what is left out would pass for slow
    local dt, now = model.dt, 0
    while now < 4 * span do
        local weight, values = math.exp(-(now / span) ^ 2 / 2) * (now == 0 and 0.5 or 1), points:values("velocity", "flat")
        for k = 1, #x do
            sum[k] = sum[k] + weight * values[k]
        end
        model:cycle(1)
        now = now + dt
    end
    remove(masses, rigid, sum)
    return sum
end

-- A rigid motion strains nothing: the largest stress after it, beside that of bending at the same speed for as long.
local function check_rigid(i, zone, bent)
    local most = {}
    for kind = 0, 6 do
        local model, points = beam(i, zone)
        local masses, x = points:values "mass", points:values("position", "flat")
        set(points, kind == 0 and bent or rigid_fields(masses, x)[kind], SPEED)
        model:cycle(50)
        most[kind] = math.max(model:zones {}:max "deviator", math.abs(model:zones {}:min "mean"))
    end
    local free = 0
    for kind = 1, 6 do
        free = free + (most[kind] < RIGID * most[0] and 1 or 0)
    end
    return free
end

local ZONE = 0.25
for _, nu in ipairs { 0.25, 0.49 } do
    local case = reference["DF.beam_modes_nu" .. nu]
    local i = case.inputs
    figures.case("DF.beam_modes_nu" .. nu, "A free beam rings: its slowest motion, which is left of random velocities, is its first "
        .. "bending; then it swings along its axis. Four zones through the depth.", case.source)
    local first = case.expected.bending_hz[1]
    local field = slowest(i, ZONE, first)
    local bending, x, y = frequency(i, ZONE, field, 4, first)
    figures.relative("slowest mode, Hz", bending, first, BENDING)
    figures.between("slowest mode over the first of theory", bending / first, LOWEST, math.huge)
    local _, points = beam(i, ZONE)
    local along, place = {}, points:values("position", "flat")
    for k = 1, #place, 3 do
        along[k], along[k + 1], along[k + 2] = math.sin(math.pi * place[k] / i.length), 0, 0
    end
    local axial = frequency(i, ZONE, along, 6, case.expected.axial_hz)
    figures.relative("first mode along the axis, Hz", axial, case.expected.axial_hz, AXIAL)
    figures.equal("rigid motions without stress", check_rigid(i, ZONE, field), case.expected.rigid_modes)
    local theory = {}
    for k, t in ipairs(x) do
        theory[k] = math.cos(2 * math.pi * first * t)
    end
    figures.plot { title = "DF.beam_modes_nu" .. nu .. ": bending", x = "time, s", y = "share of the first motion",
        series = { { name = "zones", x = x, y = y, style = "line" }, { name = "theory", x = x, y = theory, style = "line" } } }
end
figures.finish()
