-- Dampings: a cube on an elastic joint is one degree of freedom, a cube in free fall another. What a
-- damping does to them is read off the motion, never computed from its formula.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_damping"

local DENSITY, GRAVITY = 2000, 10
-- Of the amplitude: small enough that the contact is never lost (a thousandth of the block).
local AMPLITUDE = 5e-4

-- A cube of 1 m that has gone AMPLITUDE into its joint, at rest, without gravity: circular frequency
-- (kn / (density h))^1/2. Or, without `omega`, a cube in free fall.
local function build(omega, dt, damping, options)
    local model = talus.model { gravity = { 0, 0, omega and 0 or -GRAVITY } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 1, 1, 0 }, density = DENSITY, group = "base" })
    local z = omega and -AMPLITUDE or 1e4
    model:generate("box", { min = { -0.5, -0.5, z }, max = { 0.5, 0.5, z + 1 }, density = DENSITY,
        group = "cube" })
    model:blocks { group = "base" }:fix()
    local stiffness = DENSITY * (omega or 1) ^ 2
    model:joint("*", "elastic", { kn = stiffness, ks = stiffness })
    model:timestep { dt = dt }
    model:damping(damping, options)
    return model, model:blocks { group = "cube" }[1]
end

local function height(cube)
    return cube.displacement[3] - AMPLITUDE
end

-- Amplitude ratios and durations of half cycles, and the motion.
local function half_cycles(model, cube, count)
    local ratios, times, motion = {}, {}, { x = {}, y = {} }
    local peak, began, speed, before = AMPLITUDE, 0, 0, 0
    while #ratios < count do
        local x, t = height(cube), model.time
        model:cycle(1)
        before, speed = speed, cube.velocity[3]
        if before * speed < 0 then
            -- Velocities lie half a step before the places.
            local turned = t - 0.5 * model.dt + model.dt * before / (before - speed)
            ratios[#ratios + 1], times[#times + 1] = math.abs(x) / peak, turned - began
            peak, began = math.abs(x), turned
        end
        if model.cycles % 20 == 0 then
            motion.x[#motion.x + 1], motion.y[#motion.y + 1] = t, 1e3 * x
        end
    end
    return ratios, times, motion
end

local function plot_motion(title, motion)
    figures.plot { title = title, x = "time (s)", y = "height (mm)", series = {
        { name = "cube on its joint", x = motion.x, y = motion.y, style = "line" } } }
end

local function median(values)
    table.sort(values)
    return values[(#values + 1) // 2]
end

-- ---------------------------------------------------------------- viscous

local EXACT = 1e-12

for _, case in ipairs(reference.viscous) do
    figures.case(case.id, "A cube on a joint under viscous damping: the factor and the phase of one step, "
        .. "and the approach to the terminal velocity of free fall, as the central difference has them.",
        "Hart, Cundall and Lemos (1988), equations 18 and 20-23")
    local model, cube = build(case.omega, case.dt, "viscous", { alpha = case.alpha })
    local x, motion = {}, { x = {}, y = {} }
    local STEPS = 200
    for n = 1, STEPS + 4 do
        model:cycle(1)
        x[n] = height(cube)
        motion.x[n], motion.y[n] = model.time, 1e3 * x[n]
    end
    -- x(n+1) = T x(n) - D x(n-1) makes x(n)^2 - x(n-1) x(n+1) shrink by D, the square of the factor.
    local function form(n)
        return x[n] * x[n] - x[n - 1] * x[n + 1]
    end
    local D = (form(STEPS + 3) / form(3)) ^ (1 / STEPS)
    figures.relative("amplitude per step", D ^ 0.5, case.amp_per_step, EXACT)
    local T = (x[4] * x[5] - x[3] * x[6]) / (x[4] * x[4] - x[3] * x[5])
    local phase = math.acos(T / (2 * D ^ 0.5))
    -- Tolerance: four places only, whose digits are those of a gap between coordinates of 1 m.
    figures.relative("phase per step", phase, case.phase_per_step, 1e-9)
    figures.relative("steps of a period", 2 * math.pi / phase, case.period_steps, 1e-9)
    plot_motion(string.format("viscous, alpha = %.4g /s", case.alpha), motion)

    model, cube = build(nil, case.dt, "viscous", { alpha = case.alpha })
    model:cycle(1)
    local first = -cube.velocity[3] - case.terminal
    model:cycle(200)
    local later = -cube.velocity[3] - case.terminal
    figures.relative("approach to terminal velocity per step", (later / first) ^ (1 / 200),
        case.velocity_ratio, EXACT)
    model:cycle(20000 - 201)
    figures.relative("terminal velocity", -cube.velocity[3], case.terminal, EXACT)
end

-- ---------------------------------------------------------------- local and combined

local OMEGA = 100
local RATIO = 0.002 -- absolute, for omega dt <= 0.01
-- Of omega times the half cycle: the force changes sign between two steps, first order in omega dt.
local DURATION = 0.02

local function check_half_cycles(case, ratios, times, tolerance, relative)
    for n, ratio in ipairs(ratios) do
        local check = relative and figures.relative or figures.near
        check(string.format("half cycle %d, amplitude ratio", n), ratio, case.half_cycle_ratio, tolerance)
        figures.near(string.format("half cycle %d, omega t", n), OMEGA * times[n],
            case.half_cycle_time_x_omega, relative and 0.05 * case.half_cycle_time_x_omega or DURATION)
    end
end

for _, case in ipairs(reference["local"]) do
    for _, damping in ipairs { "local", "combined" } do
        figures.case(damping == "local" and case.id or "P.combined." .. case.alpha,
            "A cube on a joint under " .. damping .. " damping loses the same share of its amplitude in "
            .. "each half cycle, at any frequency.",
            damping == "local" and "Cundall (1987); closed form of one degree of freedom"
            or "in free vibration the same as local damping")
        local options = { alpha = case.alpha }
        local model, cube = build(OMEGA, 0.002 / OMEGA, damping, options)
        local ratios, times, motion = half_cycles(model, cube, 4)
        check_half_cycles(case, ratios, times, RATIO)
        plot_motion(string.format("%s, alpha = %g", damping, case.alpha), motion)
        model:damping "none"
        model:timestep { fraction = 0.1 }
        local free = model.dt
        model:damping(damping, options)
        figures.relative("time step, share of the undamped one", model.dt / free,
            case.time_step_reduction, EXACT)
    end
    local model, cube = build(nil, 1e-3, "local", { alpha = case.alpha })
    model:cycle(2)
    local first, began = cube.velocity[3], model.time
    model:cycle(1000)
    figures.relative("acceleration of free fall, share of g",
        (first - cube.velocity[3]) / (model.time - began) / GRAVITY, case.free_fall_acceleration_factor,
        1e-10)
end

-- ---------------------------------------------------------------- adaptive

local SERVO = 0.05 -- relative: depends on the servo

-- R of each step: what damping took out over the change of kinetic energy.
local function energy_ratio(before, after)
    return math.abs((after.damping - before.damping) / (after.kinetic - before.kinetic))
end

for _, case in ipairs(reference.adaptive) do
    figures.case(case.id, "Adaptive damping keeps the power it takes at a share of the rate of kinetic "
        .. "energy, in a vibration and in free fall.",
        "Hart, Cundall and Lemos (1988); closed form of an ideal servo")
    local options = { target = case.target }
    local model, cube = build(OMEGA, 0.002 / OMEGA, "adaptive", options)
    local ratios, times, motion = half_cycles(model, cube, 6)
    check_half_cycles(case, ratios, times, SERVO, true)
    plot_motion(string.format("adaptive, target = %g", case.target), motion)

    model = build(OMEGA, 0.002 / OMEGA, "adaptive", options)
    local shares, before = {}, nil
    while model.time * OMEGA < 6 * math.pi do
        model:cycle(1)
        local now = model:energy()
        if before then
            shares[#shares + 1] = energy_ratio(before, now)
        end
        before = now
    end
    figures.relative("median R in vibration", median(shares), case.target, SERVO)

    model, cube = build(nil, 1e-3, "adaptive", options)
    model:cycle(4000)
    shares = {}
    local products = {}
    before = model:energy()
    for _ = 1, 1000 do
        model:cycle(1)
        local now = model:energy()
        shares[#shares + 1] = energy_ratio(before, now)
        -- The damping takes alpha m v.v a second.
        local alpha = (now.damping - before.damping) / (cube.mass * cube.speed ^ 2 * model.dt)
        products[#products + 1] = alpha * model.time
        before = now
    end
    figures.relative("median R in free fall", median(shares), case.target, SERVO)
    figures.relative("alpha t in free fall", median(products), case.free_fall_alpha_times_t, 0.1)
    figures.relative("acceleration of free fall, share of g", cube.speed / model.time / GRAVITY,
        case.free_fall_acceleration_factor, SERVO)
end

-- ---------------------------------------------------------------- kinetic

local ANGLE = 0.01 -- omega dt
figures.case("P.kinetic", "A cube on a joint under kinetic damping starts from rest, is stopped in the first step in "
    .. "which the joint pushes it back, and starts again from there. Free fall is not braked.", "closed form of the central difference: from rest x = a cos(n "
    .. "theta), sin(theta / 2) = omega dt / 2")
do
    local model, cube = build(OMEGA, ANGLE / OMEGA, "kinetic")
    local theta = 2 * math.asin(ANGLE / 2)
    local quarter = math.ceil(0.5 * math.pi / theta) -- steps to the first place beyond the equilibrium
    local place, motion = -AMPLITUDE, { x = {}, y = {} }
    for stop = 1, 2 do
        for n = 1, quarter do
            model:cycle(1)
            motion.x[#motion.x + 1], motion.y[#motion.y + 1] = model.time, 1e3 * height(cube)
        end
        place = place * math.cos(quarter * theta)
        -- Tolerance, of the amplitude at first: the digits of a gap between coordinates of 1 m.
        figures.near("stop " .. stop .. ", height over the amplitude", height(cube) / AMPLITUDE, place / AMPLITUDE, 1e-10)
    end
    figures.near("energy left after two stops, share", 0.5 * cube.mass * (OMEGA * height(cube)) ^ 2
        / (0.5 * cube.mass * (OMEGA * AMPLITUDE) ^ 2), math.cos(quarter * theta) ^ 4, 1e-10)
    plot_motion("kinetic", motion)

    model, cube = build(nil, 1e-3, "kinetic")
    model:cycle(1000)
    figures.relative("speed of free fall, of g t", -cube.velocity[3], GRAVITY * (model.time - 0.5e-3), EXACT)
end
figures.finish()
