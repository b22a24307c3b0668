-- The stable step with damping of contacts beside elements that it leaves alone: stable at all of it, unstable far above it,
-- as long as the formula says, and not shorter by what springs and bolts would ask for if they were damped.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local STEPS, BLOCKS, OVERLAP, SPEED, SEEDS = 500, 6, 1e-5, 1e-7, 5

local function numbers(seed)
    return function()
        seed = (1103515245 * seed + 12345) % 2 ^ 31
        return seed / 2 ^ 31
    end
end

-- A row of cubes, pressed on each other between two that are fixed, with springs and a bolt at random.
local function row(seed, options)
    local draw, m = numbers(7919 * seed), talus.model { gravity = { 0, 0, 0 } }
    local list, way = {}, 1 - OVERLAP
    for i = 0, BLOCKS + 1 do
        list[i + 1] = { min = { i * way, 0, 0 }, max = { i * way + 1, 1, 1 }, density = 2500 }
    end
    draw()
    m:generate("box", list)
    m:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
    for _, id in ipairs { 1, BLOCKS + 2 } do
        m:blocks { id = id }:fix()
    end
    if options.zones then
        m:solid("rock", "elastic", { young = 1e9, poisson = 0.2 })
        m:blocks():deformable { zone = 2, solid = "rock" }
        m:timestep { fraction = 0.5, zone_fraction = 0.5 }
        m:damping "local"
        m:solve { ratio = 1e-8 } -- the overlaps press the rock
        m:damping "none"
    end
    local function place()
        return { 1.1 + (BLOCKS - 0.2) * draw(), draw(), draw() }
    end
    for _ = 1, options.elements == false and 0 or 4 do
        local k = 10 ^ (6 + 7 * draw())
        m:element("spring", { from = place(), to = place(), stiffness = k, damping = options.damper and draw() * 1e-4 * k or 0 })
    end
    if options.elements ~= false then
        m:element("bolt", { from = { 0.3, 0.2 + 0.3 * draw(), 0.5 }, to = { BLOCKS + 1.5, 0.6 + 0.3 * draw(), 0.5 },
            grout_stiffness = 10 ^ (8 + 4 * draw()), grout_strength = 1e11, yield = 1e11, dowel_stiffness = 1e9 * draw(),
            dowel_strength = 1e11, plate_stiffness = 0 })
    end
    for id = 2, BLOCKS + 1 do
        local function any()
            return SPEED * (2 * draw() - 1)
        end
        m:blocks { id = id }:set { velocity = { any(), any(), any() } }
    end
    if options.beta then
        m:damping("dashpot", { ratio = 1, frequency = 1 / (math.pi * options.beta) })
    end
    m:timestep { fraction = 1, zone_fraction = 1 }
    if options.scaled then
        m:mass_scaling { dt = options.scaled, most = 1e9 }
    end
    return m
end

-- By how much the kinetic energy has grown; infinite if the model has failed.
local function growth(m, steps)
    m:cycle(1)
    local began = m:energy().kinetic
    local holds = pcall(m.cycle, m, steps)
    return holds and m:energy().kinetic / began or math.huge
end

-- Steps at random, of all that there is: nothing grows.
for _, options in ipairs {
    { beta = 1e-6 }, { beta = 1e-4 }, { beta = 1e-2 }, { beta = 1e-3, damper = true }, { beta = 1e-3, scaled = 1e-3 },
    { beta = 1e-3, scaled = 1e-3, damper = true }, { beta = 1e-3, zones = true }, { beta = 1e-5, zones = true, damper = true },
} do
    for seed = 1, SEEDS do
        local grown = growth(row(seed, options), STEPS)
        check.holds(grown < 20, ("beta %g, seed %d%s%s%s: grows by %g"):format(options.beta, seed,
            options.damper and ", dampers" or "", options.scaled and ", scaled" or "", options.zones and ", zones" or "", grown))
    end
end

-- Far above it most grow without bound.
local wild = 0
for seed = 1, SEEDS do
    local m = row(seed, { beta = 1e-2 })
    m:timestep { dt = 3 * m.dt }
    wild = wild + (growth(m, STEPS) > 1e6 and 1 or 0)
end
check.holds(wild >= SEEDS / 2, ("three times the step: %d of %d models grow without bound"):format(wild, SEEDS))

-- One body that contacts of the rate R and a stiff spring of the rate S hold: 2 / w, w = c + (c^2 + 2 (R + S))^(1/2), c = beta R.
local function held(stiffness, beta)
    local m = talus.model { gravity = { 0, 0, 0 }, rotation = "paper" }
    m:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 }, { min = { 0, 0, 1 - OVERLAP }, max = { 1, 1, 2 }, density = 2500 } })
    m:blocks { id = 1 }:fix()
    m:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
    if stiffness > 0 then
        m:element("spring", { from = { 0.5, 0.5, 0.5 }, to = { 0.5, 0.5, 1.5 - OVERLAP / 2 }, stiffness = stiffness })
    end
    if beta > 0 then
        m:damping("dashpot", { ratio = 1, frequency = 1 / (math.pi * beta) })
    end
    m:timestep { fraction = 1 }
    return m.dt
end
for _, beta in ipairs { 1e-5, 1e-3, 1e-1 } do
    for _, stiffness in ipairs { 1e8, 1e11, 1e14 } do
        local alone, both = 2 / held(0, 0) ^ 2, 2 / held(stiffness, 0) ^ 2
        local c = beta * alone
        check.near(held(stiffness, beta) * (c + math.sqrt(c * c + 2 * both)) / 2, 1, 1e-12)
    end
end

-- The step of a model with stiff springs is not shorter than damping of contacts alone makes it: as if all were damped it
-- would be hundreds of times as short.
for seed = 1, SEEDS do
    local beta = 1e-2
    local bare, damped = row(seed, {}).dt, row(seed, { beta = beta }).dt
    local contacts = row(seed, { beta = beta, elements = false }).dt
    local all = bare / (math.sqrt(1 + (beta / bare) ^ 2) + beta / bare)
    check.holds(damped > 0.6 * math.min(bare, contacts), ("seed %d: step %g, of %g without damping and %g without elements")
        :format(seed, damped, bare, contacts))
    check.holds(damped > 20 * all, ("seed %d: step %g, as if all were damped %g"):format(seed, damped, all))
end

-- Damping that is set in a run counts at once, and so does a relaxation that ends.
local m = row(1, { zones = true })
m:cycle(20)
m:damping("dashpot", { ratio = 1, frequency = 1 / (math.pi * 1e-3) })
check.near(m.dt / row(1, { zones = true, beta = 1e-3 }).dt, 1, 1e-6)

-- By the paper's rule the strongest damper of a node counts as well: a buffer of a light block.
local buffered = talus.model { gravity = { 0, 0, 0 } }
buffered:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
buffered:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
buffered:timestep { rule = "paper", fraction = 1 }
buffered:element("spring", { from = { 0.5, 0.5, 0.5 }, to = { 0.5, 0.5, 3 }, stiffness = 1e8, damping = 1e8 })
buffered:blocks():set { velocity = { 0, 0, 1e-3 } }
local c, k = 1e8 / 2500, 2 * 1e8 / 2500
check.near(buffered.dt * (c + math.sqrt(c * c + k)) / 2, 1, 1e-12)
check.holds(growth(buffered, STEPS) <= 1, "a buffer by the paper's rule")
