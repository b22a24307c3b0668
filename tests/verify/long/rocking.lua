-- A block rocking about the edges of its base (Housner, 1963): the time to its first impact, the base
-- acceleration that lifts an edge, the pulses that overturn it, and that impacts add no speed.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference_dynamics").rocking

local GRAVITY, DENSITY, DEPTH = 10, 2000, 1
local FRICTION = 80      -- degrees: no sliding
local STIFFNESS = 1e11 -- Pa/m: on its edge the block sinks in by 1e-5 of its width
local PHASE = 0.03       -- of the block's fastest oscillation in one step: omega dt
local SAMPLE = 2e-3      -- s between looks
local SWINGS = 4         -- times from the release to the first impact that it is followed
local TIME, UPLIFT, PULSE, BALANCE = 0.01, 0.01, 0.03, 1e-3 -- relative

-- The block, turned by `tilt` about its edge at x = b, on a base.
local function build(case, tilt)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { -4, -1, -1 }, max = { 4, 1 + DEPTH, 0 }, density = DENSITY,
        group = "base" })
    local s, c, vertices = math.sin(tilt), math.cos(tilt), {}
    for _, x in ipairs { -2 * case.b, 0 } do
        for _, y in ipairs { 0, DEPTH } do
            for _, z in ipairs { 0, 2 * case.h } do
                vertices[#vertices + 1] = { case.b + x * c + z * s, y, -x * s + z * c }
            end
        end
    end
    model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "block" })
    local base, block = model:blocks { group = "base" }, model:blocks { group = "block" }
    base:fix()
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = FRICTION })
    -- The stiffest motion: all of the base in compression, up and down or turning.
    local mass, turning = 2 * case.h * DENSITY, (case.b ^ 2 + case.h ^ 2) / 3
    local fastest = math.sqrt(STIFFNESS / mass
        * math.max(1, case.b ^ 2 / 3 / turning + case.h ^ 2 / turning))
    model:timestep { dt = PHASE / fastest }
    return model, base, block
end

-- Turn about y since the start, rad; positive towards +x.
local function turn(block)
    local q = block[1].rotation
    return 2 * math.asin(q[3])
end

local function settle(model, base, block)
    model:damping "local"
    model:solve { ratio = 1e-9 }
    model:damping "none"
    base:reset_displacement()
    block:reset_displacement()
    return turn(block)
end

-- Runs in samples of SAMPLE, or to `look` answering true.
local function run(model, time, look)
    local stride = math.max(1, math.floor(SAMPLE / model.dt))
    local finish = model.time + time
    while model.time < finish do
        model:cycle(stride)
        if look() then
            return true
        end
    end
    return false
end

-- Let go at a tilt: to the first impact, through it and those that follow.
local function free_rocking(case)
    local tilt, farthest = case.theta0 * math.atan(case.b / case.h), 0
    local upright = 2 * case.b * case.h * 2 * DEPTH * DENSITY * GRAVITY
        * (math.sqrt(case.b ^ 2 + case.h ^ 2) * math.cos(math.atan(case.b / case.h) - tilt) - case.h)
    -- Mechanical energy over that of the block standing upright at rest.
    local function swing(energy)
        return upright + energy.kinetic + energy.potential + energy.stored
    end
    local model, _, block = build(case, tilt)
    local times, angles, impact, balance = {}, {}, nil, 0
    local before, after, previous, previous_time = 0, 0, tilt, 0
    run(model, SWINGS * case.impact, function()
        local angle, speed = tilt + turn(block), math.abs(block[1].angular_velocity[2])
        if not impact and angle <= 0 then
            impact = previous_time + (model.time - previous_time) * previous / (previous - angle)
        end
        local energy = model:energy()
        balance = math.max(balance, math.abs(energy.balance))
        if not impact then
            before = swing(energy)
        else
            after = swing(energy)
        end
        farthest = math.min(farthest, angle)
        previous, previous_time = angle, model.time
        times[#times + 1], angles[#angles + 1] = model.time, math.deg(angle)
    end)
    figures.relative("time from release to the first impact, s", impact, case.impact, TIME)
    figures.relative("period without loss, four times that, s", 4 * impact, case.period, TIME)
    figures.between("angular velocity that the energy past the impact amounts to, over that before",
        math.sqrt(after / before), 0, 1)
    figures.between("largest tilt past the impact over the first", -farthest / tilt, 0, 1)
    figures.between("worst energy balance, of the largest term", balance, 0, BALANCE)
    figures.plot { title = case.name .. ": rocking after release", x = "time, s",
        y = "tilt, degrees", series = {
            { name = "obtained", x = times, y = angles, style = "line" },
            { name = "first impact expected", x = { case.impact }, y = { 0 }, style = "points" },
        } }
end

-- The base acceleration that lifts an edge over that of a block and a base that are rigid, and by how much the block leans
-- there, rad. The joint yields by c under the weight and opens where it would be pulled; the block is lifted for good when
-- its weight acts at x = (2 c H B / 9)^(1/3) from the toe, and leans by x / H (topple.lua).
local function limit(case)
    local width, height = 2 * case.b, 2 * case.h
    local x = (2 * DENSITY * GRAVITY * height / STIFFNESS * height * width / 9) ^ (1 / 3)
    return 1 - 3 * x / width, x / height
end

-- Base acceleration brought up to `level` and held: true when an edge lifts.
local function lifts(case, level)
    local model, base, block = build(case, 0)
    local rest = settle(model, base, block)
    local start, RISE, HOLD, LIFTED = model.time, 0.5, 1, 2 * select(2, limit(case)) -- s, s, rad
    base:drive { velocity = function(t)
        t = t - start
        return -level * (t < RISE and t * t / (2 * RISE) or t - RISE / 2), 0, 0
    end }
    return run(model, RISE + HOLD, function() return math.abs(turn(block) - rest) > LIFTED end)
end

-- A pulse of base acceleration: true when the block overturns before it falls back.
local function overturns(case, shape, duration, level)
    local model, base, block = build(case, 0)
    local rest, alpha = settle(model, base, block), math.atan(case.b / case.h)
    local start, largest, over = model.time, 0, nil
    base:drive { velocity = function(t)
        t = math.min(t - start, duration)
        if shape == "rectangle" then
            return -level * t, 0, 0
        end
        return -level * duration / math.pi * (1 - math.cos(math.pi * t / duration)), 0, 0
    end }
    local BEYOND, BACK = 1.2, 0.02 -- of alpha: past the point of no return; as good as upright
    run(model, 10, function()
        local angle = math.abs(turn(block) - rest)
        largest = math.max(largest, angle)
        if angle > BEYOND * alpha then
            over = true
        elseif largest > 2 * BACK * alpha and angle < BACK * alpha then
            over = false
        end
        return over ~= nil
    end)
    assert(over ~= nil, "neither overturned nor back")
    return over, math.abs(model:energy().balance)
end

for _, case in ipairs(reference) do
    figures.case(case.name, string.format("A block %g m wide and %g m high let go at a tilt of %g of its "
        .. "angle of overturning; the base acceleration that lifts an edge; the pulses that overturn it",
        2 * case.b, 2 * case.h, case.theta0), reference.source)
    free_rocking(case)
    local share = limit(case)
    figures.equal("an edge lifts at 0.99 of that", lifts(case, (1 - UPLIFT) * share * case.uplift), false)
    figures.equal("an edge lifts at 1.01 of that", lifts(case, (1 + UPLIFT) * share * case.uplift), true)
    for _, shape in ipairs { "rectangle", "sine" } do
        for _, duration in ipairs { 0.3, 0.6 } do
            local level = case[shape][duration]
            if level then
                local what = string.format("a %s of %g s overturns at ", shape, duration)
                local over, balance = overturns(case, shape, duration, (1 - PULSE) * level)
                figures.equal(what .. "0.97 of the amplitude", over, false)
                figures.between("energy balance, of the largest term", balance, 0, BALANCE)
                over, balance = overturns(case, shape, duration, (1 + PULSE) * level)
                figures.equal(what .. "1.03 of the amplitude", over, true)
                figures.between("energy balance, of the largest term", balance, 0, BALANCE)
            end
        end
    end
end
figures.finish()
