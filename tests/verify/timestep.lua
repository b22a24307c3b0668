-- The stable time step: equation (27), and for chains of blocks and a block held all around the
-- step at which a disturbance begins to grow.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_statics"

local STEP = 1e-12   -- relative
local FLIP = 0.01    -- the step is stable at this share below its limit, unstable above
local SPEED = 1e-9   -- m/s of the disturbance: overlaps stay tiny
local STEPS = 4000   -- at a share FLIP above the limit a disturbance grows by 1.3 a step
local STEPS_SHOWN = 60
local GROWN = 1e3    -- growth of the speed that only an unstable step brings; a stable one below
                     -- the limit by FLIP swells by 1 / sqrt(2 FLIP) at the most
local PILLAR_WIDTH, PILLAR_LENGTH = 1e-3, 0.1 -- as good as a point
local DAMPING = 0.8  -- of the local damping

-- A unit cube at x, and what is done to it.
local function cube(model, density, at, group)
    model:generate("box", { min = at, max = { at[1] + 1, at[2] + 1, at[3] + 1 }, density = density,
        group = group })
    return model:blocks { group = group }
end

local function empty(stiffness)
    local model = talus.model { gravity = { 0, 0, 0 } }
    return model, function()
        model:joint("*", "elastic", { kn = stiffness, ks = stiffness })
    end
end

-- n cubes in a row along x that can only move along it, on a fixed one or free. Every second one is
-- given a speed, for the fastest mode of a chain is that of neighbours against each other.
local function chain(n, on_base, mass, stiffness)
    local model, law = empty(stiffness)
    local blocks = {}
    if on_base then
        cube(model, mass, { -1, 0, 0 }, "base"):fix()
    end
    for i = 1, n do
        blocks[i] = cube(model, mass, { i - 1, 0, 0 }, "cube " .. i)
        blocks[i]:fix { y = true, z = true, rotation = true }
        blocks[i]:set { velocity = { i % 2 == 0 and SPEED or -SPEED, 0, 0 } }
    end
    law()
    return model
end

-- A cube that can only move, with a fixed one on each of its faces.
local function held_on_faces(mass, stiffness)
    local model, law = empty(stiffness)
    for axis = 1, 3 do
        for side = -1, 1, 2 do
            local at = { 0, 0, 0 }
            at[axis] = side
            cube(model, mass, at, "held"):fix()
        end
    end
    local middle = cube(model, mass, { 0, 0, 0 }, "middle")
    middle:fix { rotation = true }
    middle:set { velocity = { SPEED, 0, 0 } }
    law()
    return model
end

-- A cube that can only turn, held by a thin fixed pillar at each corner of each face; on its small area every pillar is as
-- stiff as a quarter of the face.
local function held_at_corners(mass, stiffness)
    local model, law = empty(0.25 * stiffness / PILLAR_WIDTH ^ 2)
    local middle = cube(model, mass, { 0, 0, 0 }, "middle")
    local ends = { { -PILLAR_LENGTH, 0 }, { 1, 1 + PILLAR_LENGTH } }
    local across = { { 0, PILLAR_WIDTH }, { 1 - PILLAR_WIDTH, 1 } }
    for axis = 1, 3 do
        local u, v = axis % 3 + 1, (axis + 1) % 3 + 1
        for corner = 0, 7 do
            local spans = { [axis] = ends[corner % 2 + 1], [u] = across[corner // 2 % 2 + 1],
                [v] = across[corner // 4 + 1] }
            model:generate("box", { min = { spans[1][1], spans[2][1], spans[3][1] },
                max = { spans[1][2], spans[2][2], spans[3][2] }, density = mass, group = "pillar" })
        end
    end
    model:blocks { group = "pillar" }:fix()
    middle:fix { x = true, y = true, z = true }
    middle:set { angular_velocity = { 0, 0, SPEED } }
    law()
    return model
end

-- Does the disturbance grow, and the largest speed over the steps.
local function grows(model, dt, steps, speeds)
    local moving = model:blocks { fixed = false }
    model:timestep { dt = dt }
    local function fastest()
        local speed = 0
        for _, block in ipairs(moving) do
            local w = block.angular_velocity
            speed = math.max(speed, block.speed, math.sqrt(w[1] ^ 2 + w[2] ^ 2 + w[3] ^ 2))
        end
        return speed
    end
    local most = 0
    for _ = 1, steps do
        model:cycle(1)
        local speed = fastest()
        most = math.max(most, speed)
        if speeds then
            speeds[#speeds + 1] = speed / SPEED
        end
        if most > GROWN * SPEED then
            return true
        end
    end
    return false
end

local function check_flip(what, dt, build, damped)
    for _, side in ipairs { -1, 1 } do
        local model = build()
        if damped then
            model:damping("local", { alpha = DAMPING })
        end
        local share = 1 + side * FLIP
        figures.equal(string.format("%s: grows at %g of %.7g s", what, share, dt),
            grows(model, share * dt, STEPS), side > 0)
    end
end

-- The speed beside the limit, step by step.
local function plot_growth(title, dt, build)
    local series = {}
    for _, side in ipairs { -1, 1 } do
        local share, steps, speeds = 1 + side * FLIP, {}, {}
        grows(build(), share * dt, STEPS_SHOWN, speeds)
        for i = 1, #speeds do
            steps[i] = i
        end
        series[#series + 1] = { name = string.format("at %g of the limit", share), x = steps,
            y = speeds, style = "points" }
    end
    figures.plot { title = title .. " beside the limit", x = "step", y = "speed / speed at first",
        log_y = true, series = series }
end

-- ---------------------------------------------------------------- equation (27)

local eq27 = reference["T.eq27"]
figures.case("T.eq27", "The step the engine chooses by equation (27) for pairs of blocks of given "
    .. "mass and stiffness; and the shares of it at which a disturbance of two free blocks, of a "
    .. "block on a base, of a long chain, of a block held on all six faces and of one held at "
    .. "their corners begins to grow.", eq27.source)

-- Two free cubes, the second heavier, and the larger of kn and ks counts.
for i, row in ipairs(eq27.rows) do
    for _, softer in ipairs { "kn", "ks" } do
        local model = talus.model { gravity = { 0, 0, 0 } }
        cube(model, row.mass, { 0, 0, 0 }, "light")
        cube(model, 3 * row.mass, { 1, 0, 0 }, "heavy")
        local law = { kn = row.stiffness, ks = row.stiffness, friction = 30 }
        law[softer] = row.stiffness / 2
        model:joint("*", "coulomb", law)
        model:timestep { rule = "paper", fraction = row.fraction }
        figures.relative(string.format("row %d, softer %s: step, s", i, softer), model.dt, row.dt,
            STEP)
    end
end

local MASS, STIFFNESS = 2000, 1e7
local unit = eq27.rows[1].dt / eq27.rows[1].fraction -- the step of (27) at FRAC 1, for these two
local limits = eq27.limits
local function two_free()
    return chain(2, false, MASS, STIFFNESS)
end
check_flip("two free cubes", limits.two_free * unit, two_free)
check_flip("one cube on a base", limits.one_on_base * unit, function()
    return chain(1, true, MASS, STIFFNESS)
end)
check_flip("chain of 40 cubes", limits.long_chain * unit, function()
    return chain(40, false, MASS, STIFFNESS)
end)
check_flip("cube held on six faces, moving", limits.cube_translation * unit, function()
    return held_on_faces(MASS, STIFFNESS)
end)
check_flip("cube held at 24 corners, turning", limits.cube_rotation_corners * unit, function()
    return held_at_corners(MASS, STIFFNESS)
end)
check_flip("two free cubes, local damping", limits.two_free * unit / math.sqrt(1 + DAMPING),
    two_free, true)

plot_growth("T.eq27: two free cubes", limits.two_free * unit, two_free)

-- ---------------------------------------------------------------- chain of three

local three = reference["T.chain.3"]
figures.case("T.chain.3", "Three equal cubes in a row, free or on a fixed base: a disturbance "
    .. "stays at 1 % below the critical step and grows at 1 % above it.", three.source)
local function three_free()
    return chain(3, false, three.mass, three.stiffness)
end
check_flip("free", three.dt_crit_free, three_free)
check_flip("on a base", three.dt_crit_on_base, function()
    return chain(3, true, three.mass, three.stiffness)
end)
plot_growth("T.chain.3: three free cubes", three.dt_crit_free, three_free)
figures.finish()
