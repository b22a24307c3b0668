-- rock.lua - a cube of rock cut by three dispersed joint sets, all cuts persistent, under its own weight between
-- fixed plates under it and around it.
--
--     talus tests/bench/rock.lua blocks=1000,10000 threads=1,2 reps=5
--
-- The cube grows with the number of blocks, which are 1 m wide on average; their number is about that asked for.
-- It starts from the stress of its weight, which is in equilibrium but for the few contacts without faces, and is
-- measured from the same unbalanced force ratio on in all sizes.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"

local rock = {}

local SETS = { { joint = "J1", dip = 2, dip_direction = 40 },
    { joint = "J2", dip = 88, dip_direction = 85 },
    { joint = "J3", dip = 86, dip_direction = 175 } }
local DISPERSION = 0.5                 -- deg, of dip and dip direction
local SPACING, DEVIATION = 1, 0.2      -- m
local DENSITY, KN, KS, FRICTION = 2600, 1e9, 5e8, 35
local GRAVITY, SIDEWAYS = 9.81, 0.5    -- m/s2; horizontal over vertical stress
local RATIO, PATIENCE, SETTLE = 1e-6, 200, 20 -- unbalanced force ratio; steps to reach it in; steps in any case
local MANY = 50000                     -- blocks from which on one step is enough to tell how long it takes

-- The cut rock, n^3 blocks about, without plates.
function rock.cut(count, threads)
    local side = math.floor(count ^ (1 / 3) + 0.5)
    local model = talus.model { threads = threads, gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { 0, 0, 0 }, max = { side, side, side }, density = DENSITY,
        group = "rock" })
    for _, set in ipairs(SETS) do
        model:generate("jointset", { joint = set.joint, dip = set.dip, dip_direction = set.dip_direction,
            dip_dev = DISPERSION, dip_direction_dev = DISPERSION, spacing = SPACING,
            spacing_dev = DEVIATION, number = side - 1, origin = { side / 2, side / 2, side / 2 } })
    end
    return model, side
end

-- The same with its plates, laws and damping.
function rock.build(count, threads)
    local model, side = rock.cut(count, threads)
    bench.boxes(model, bench.plates({ 0, 0, 0 }, { side, side, side }), DENSITY)
    model:joint("*", "coulomb", { kn = KN, ks = KS, friction = FRICTION })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    return model, side
end

-- The stress of the weight, tension positive.
function rock.stress(model, side)
    local gradient = DENSITY * GRAVITY
    model:insitu { at = { 0, 0, side }, gradient = { zz = gradient, xx = SIDEWAYS * gradient,
        yy = SIDEWAYS * gradient } }
end

function rock.main()
    local given = bench.arguments { blocks = "1000", threads = "1", reps = 5 }
    for _, count in ipairs(bench.list(given.blocks)) do
        for _, threads in ipairs(bench.list(given.threads)) do
            local model, side = rock.build(count, threads)
            local many = count > MANY
            model:mass_scaling(true)
            rock.stress(model, side)
            model:cycle(SETTLE)
            local reached = model:solve { ratio = RATIO, max_cycles = PATIENCE }
            assert(reached.reason == "ratio", string.format("the ratio is still %g", reached.ratio))
            bench.measure_both(model, { workload = "rock", size = count },
                { reps = given.reps, warm = many and 1 or 5 })
        end
    end
end

-- A script that says require "rock" wants the functions only.
if ... ~= "rock" then
    rock.main()
end
return rock
