-- A cube falls flat on a fixed floor and rebounds elastically: duration and depth of the contact,
-- speed of the rebound, and the energy ledger.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local joint = require "check_joint"
local reference = require "reference_motion"

local PENETRATION = 0.002 -- relative
local BALANCE = 1e-3      -- of the largest term of the ledger
local CALM = 0.03         -- omega dt up to which BALANCE holds

-- Lowest point of the parabola through the lowest of the heights and its neighbours: the turn lies
-- between two steps.
local function lowest(heights)
    local low = 2
    for i = 2, #heights - 1 do
        low = heights[i] < heights[low] and i or low
    end
    local a, b, c = heights[low - 1], heights[low], heights[low + 1]
    return b - (a - c) ^ 2 / (8 * (a - 2 * b + c))
end

-- Drops the cube and follows it through one rebound, up to its highest point.
local function drop(case, dt)
    local side, high = case.side, case.drop_height
    local model = talus.model { gravity = { 0, 0, -case.g } }
    model:generate("box", { min = { -side, -side, -side }, max = { 2 * side, 2 * side, 0 },
        density = case.rho, group = "floor" })
    model:generate("box", { min = { 0, 0, high }, max = { side, side, high + side },
        density = case.rho, group = "cube" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = case.kn, ks = case.kn, friction = 30 })
    model:timestep { dt = dt }
    local cube = model:blocks { group = "cube" }
    local r = { highest = -math.huge, force = 0, balance = 0, time = {}, height = {},
        kinetic = {}, potential = {}, stored = {} }
    local level = high
    while not r.leaves or cube[1].velocity[3] > 0 do
        local time, before = model.time, level
        model:cycle(1)
        level = high + cube[1].displacement[3]
        -- The floor's plane is passed between two steps, at nearly constant speed.
        local passing = time + dt * before / (before - level)
        if not r.meets and level < 0 then
            r.meets = passing
        elseif r.meets and not r.leaves and level >= 0 then
            r.leaves = passing
        end
        r.highest = r.leaves and math.max(r.highest, level) or r.highest
        r.force = math.max(r.force, cube[1].force[3] + case.g * cube[1].mass)
        local energy = model:energy()
        r.balance = math.max(r.balance, math.abs(energy.balance))
        local n = #r.time + 1
        r.time[n], r.height[n] = model.time, level
        r.kinetic[n], r.potential[n], r.stored[n] = energy.kinetic, energy.potential, energy.stored
    end
    r.lowest = lowest(r.height)
    return r
end

local function check(name)
    local case = reference[name]
    figures.case(name, string.format("A cube of %g m falls flat from %g m on a fixed floor, "
        .. "without damping, and rebounds; time, duration and depth of the contact, the speed "
        .. "that the height of the rebound gives, and the balance of the energy ledger.", case.side,
        case.drop_height), case.source)
    -- It sinks in by 0.5 % of its side: there the joint yields 0.3 % more than linear springs of its area, by the border of
    -- what the cube and the floor have in common.
    local mass = case.rho * case.side ^ 3
    local penetration, force, lasts = joint.impact(case.kn, case.side, mass, case.g, case.v_rebound)
    for _, omega_dt in ipairs { 0.02, CALM, 0.1414 } do
        local dt = omega_dt / case.omega
        local r = drop(case, dt)
        local what = string.format("omega dt = %g: ", omega_dt)
        figures.near(what .. "impact at, s", r.meets, case.t_impact, dt)
        figures.near(what .. "contact lasts, s", r.leaves - r.meets, lasts, dt)
        figures.relative(what .. "rebound speed", math.sqrt(2 * case.g * r.highest),
            case.v_rebound, omega_dt ^ 2 / 8)
        figures.relative(what .. "penetration", -r.lowest, penetration, PENETRATION)
        if omega_dt <= CALM then
            figures.relative(what .. "largest force", r.force, force, PENETRATION)
            figures.between(what .. "energy balance", r.balance, 0, BALANCE)
        end
        if omega_dt == CALM then
            figures.plot { title = name .. ": energy", x = "time, s", y = "energy, J", series = {
                { name = "kinetic", x = r.time, y = r.kinetic },
                { name = "potential, from the start", x = r.time, y = r.potential },
                { name = "stored in the contact", x = r.time, y = r.stored } } }
        end
    end
end

check "D.bounce.1"
check "D.bounce.2"
figures.finish()
