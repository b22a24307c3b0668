-- A box spins freely: Euler's equations about its three different moments of inertia, near the
-- intermediate axis, about which it tumbles, and near the major one.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_motion"

local STEPS = 1000     -- at least, in a revolution
local RATE = 1e-3      -- of |w|, in each component
local ATTITUDE = 1e-3  -- rad
local CONSERVED = 1e-6 -- relative, over ten periods
local PERIODS = 10
local INERTIA = 1e-12  -- relative

local function dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

local function norm(a)
    return math.sqrt(dot(a, a))
end

-- v turned by the quaternion q = (w, x, y, z), or back.
local function turn(q, v, back)
    local s = back and -1 or 1
    local x, y, z = s * q[2], s * q[3], s * q[4]
    local t = { 2 * (y * v[3] - z * v[2]), 2 * (z * v[1] - x * v[3]), 2 * (x * v[2] - y * v[1]) }
    return { v[1] + q[1] * t[1] + y * t[3] - z * t[2], v[2] + q[1] * t[2] + z * t[1] - x * t[3],
        v[3] + q[1] * t[3] + x * t[2] - y * t[1] }
end

-- Angle of the turn from one attitude to another, small.
local function angle_between(a, b)
    local sum, difference = 0, 0
    for k = 1, 4 do
        sum, difference = sum + (a[k] + b[k]) ^ 2, difference + (a[k] - b[k]) ^ 2
    end
    return 2 * math.sqrt(math.min(sum, difference)) -- q and -q are the same attitude
end

-- Spins the box up, with a step of which a whole number makes `time`.
local function spin_up(case, time)
    local model = talus.model { gravity = { 0, 0, 0 } }
    local half = { case.box[1] / 2, case.box[2] / 2, case.box[3] / 2 }
    model:generate("box", { min = { -half[1], -half[2], -half[3] }, max = half,
        density = case.density })
    local blocks = model:blocks()
    blocks:set { angular_velocity = case.w0 }
    local dt = time / math.ceil(time * STEPS * norm(case.w0) / (2 * math.pi))
    model:timestep { dt = dt }
    return model, blocks[1], dt
end

-- Angular velocity and momentum, in the body's axes and in space.
local function state(case, block)
    local rate = turn(block.rotation, block.angular_velocity, true)
    local l = { case.inertia[1] * rate[1], case.inertia[2] * rate[2], case.inertia[3] * rate[3] }
    return rate, turn(block.rotation, l)
end

local function check_samples(case)
    local model, block, dt = spin_up(case, case.samples[1].t) -- the others are multiples of it
    local inertia = block.inertia
    for k, entry in ipairs { "xx", "yy", "zz" } do
        figures.relative("moment of inertia " .. entry, inertia[entry], case.inertia[k], INERTIA)
    end
    figures.relative("kinetic energy", block.kinetic_energy, case.energy, INERTIA)
    for _, sample in ipairs(case.samples) do
        model:cycle(math.floor((sample.t - model.time) / dt + 0.5))
        local rate = state(case, block)
        for k = 1, 3 do
            figures.near(string.format("t = %g s: rate %d in the body, rad/s", sample.t, k),
                rate[k], sample.w_body[k], RATE * norm(case.w0))
        end
        figures.near(string.format("t = %g s: attitude, rad off the expected", sample.t),
            angle_between(block.rotation, sample.rotation), 0, ATTITUDE)
    end
end

-- Ten periods of the body's rates: what is conserved, and the rates after the first.
local function check_conserved(case)
    local model, block, dt = spin_up(case, case.period)
    local energy, momentum = 0, 0
    local time, shown = {}, { {}, {}, {} }
    local each = 40 -- looks in a period
    local steps, done = case.period / dt, 0
    for i = 1, PERIODS * each do
        local until_now = math.floor(i * steps / each + 0.5)
        model:cycle(until_now - done)
        done = until_now
        local rate, l = state(case, block)
        local kinetic = 0.5 * (case.inertia[1] * rate[1] ^ 2 + case.inertia[2] * rate[2] ^ 2
            + case.inertia[3] * rate[3] ^ 2)
        energy = math.max(energy, math.abs(kinetic / case.energy - 1))
        local off = { l[1] - case.angular_momentum[1], l[2] - case.angular_momentum[2],
            l[3] - case.angular_momentum[3] }
        momentum = math.max(momentum, norm(off) / norm(case.angular_momentum))
        if i == each then
            for k = 1, 3 do
                figures.near(string.format("after one period: rate %d in the body, rad/s", k),
                    rate[k], case.w0[k], RATE * norm(case.w0))
            end
        end
        if i <= 2 * each then
            time[i] = model.time
            for k = 1, 3 do
                shown[k][i] = rate[k]
            end
        end
    end
    figures.near("energy balance", model:energy().balance, 0, CONSERVED)
    figures.near("energy, largest drift over ten periods", energy, 0, CONSERVED)
    figures.near("angular momentum in space, largest drift over ten periods", momentum, 0,
        CONSERVED)
    return time, shown
end

local function check(name, sentence)
    local case = reference[name]
    figures.case(name, sentence, case.source)
    check_samples(case)
    local time, shown = check_conserved(case)
    local series = {}
    for k = 1, 3 do
        series[k] = { name = "rate " .. k .. ", obtained", x = time, y = shown[k] }
        local x, y = {}, {}
        for i, sample in ipairs(case.samples) do
            x[i], y[i] = sample.t, sample.w_body[k]
        end
        series[3 + k] = { name = "rate " .. k .. ", expected", x = x, y = y, style = "points",
            colour = k }
    end
    figures.plot { title = name .. ": angular velocity in the body", x = "time, s",
        y = "rate, rad/s", series = series }
end

check("D.top.intermediate", "A box of 1 x 2 x 3 m spins in free space about nearly its "
    .. "intermediate axis and tumbles; its rates and attitude at five times, and energy and "
    .. "angular momentum over ten periods.")
check("D.top.major", "A box of 1 x 2 x 3 m spins in free space near its axis of largest inertia "
    .. "and nutates; its rates and attitude at four times, and energy and angular momentum over "
    .. "ten periods.")
figures.finish()
