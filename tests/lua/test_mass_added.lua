-- Partial mass scaling: model:mass_scaling { dt = ... } adds inertia to the bodies that need it, and to no others.
local talus = require "talus"
local check = require "check"

local FRICTION, SLOPE, G = math.rad(20), math.rad(35), 10
local T = 0.25 -- s

-- Two cubes with a sliver between them on a slope, down which all three slide, and a thin plate far above it that falls.
-- The slope is level, and gravity is tilted.
local function slope(threads)
    local model = talus.model { gravity = { G * math.sin(SLOPE), 0, -G * math.cos(SLOPE) }, threads = threads }
    model:generate("box", { min = { -1, -1, -1 }, max = { 9, 2, 0 }, density = 2600, group = "base" })
    model:blocks():fix()
    model:blocks():hide()
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 2.002 }, density = 2600, group = "slides" })
    for _, z in ipairs { 1, 1.002 } do
        model:generate("joint", { joint = "J", dip = 0, dip_direction = 0, origin = { 0, 0, z } })
    end
    model:generate("box", { min = { 0, 0, 50 }, max = { 1, 1, 50.002 }, density = 2600, group = "falls" })
    model:blocks { hidden = true }:show()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = math.deg(FRICTION) })
    model:joint("J", "coulomb", { kn = 1e9, ks = 1e9, friction = 60 })
    return model
end

local function masses(blocks)
    return blocks:sum "mass"
end

-- Momentum of what slides, of its own mass, along the slope and across.
local function momentum(model)
    local x, z = 0, 0
    for _, block in ipairs(model:blocks { group = "slides" }) do
        x = x + block.mass * block.velocity[1]
        z = z + block.mass * block.velocity[3]
    end
    return x, z
end

local function steps(model, dt)
    model:cycle(math.floor(T / dt + 0.5))
    return model:energy()
end

-- ---------------------------------------------------------------- a slope

local free = slope(1)
local own = free.dt -- that the sliver allows
local wanted = 5 * own
local plain = steps(free, own)
local model = slope(1)
check.equal(model:mass_scaling().on, false)
check.equal(model:mass_scaling().dt, nil)
model:mass_scaling { dt = wanted }
check.equal(model.mass_scaled, true)
check.equal(model.dt, wanted)
check.equal(model:timestep().dt, wanted)
check.equal(model:mass_scaling().added, 0) -- no step has been made
local energy = steps(model, wanted)
check.equal(model.dt, wanted)
check.near(model.time, model.cycles * wanted, 1e-9)
local told = model:mass_scaling()
check.equal(told.on, true)
check.equal(told.dt, wanted)
check.equal(told.most, 0.05)
check.equal(told.bodies, 1)
local sliver = model:blocks { group = "slides", where = function(b) return b.volume < 0.1 end }[1]
check.equal(told.worst.block, sliver.id)
local all = masses(model:blocks { fixed = false })
check.near(told.added, (told.worst.factor - 1) * sliver.mass / all, 1e-12)
check.holds(told.worst.factor > 10 and told.worst.factor < 40, "25 times the rate, about")
check.holds(told.added > 0.005 and told.added < 0.05, "a share that can be seen")

-- Friction is all the normal force times tan(friction), so along and across add up to weight times time, less what the mass
-- added takes.
local function driven(m)
    local x, z = momentum(m)
    local weight = masses(m:blocks { group = "slides" }) * G
    return (x + math.tan(FRICTION) * z) /
        (weight * m.time * (math.sin(SLOPE) - math.tan(FRICTION) * math.cos(SLOPE)))
end
-- What slides has 1 / (1 - share of the plate that falls) as large a share.
local share = told.added * all / masses(model:blocks { group = "slides" })
check.near(driven(model) / driven(free), 1 / (1 + share), 0.002)
check.near(driven(free), 1, 0.03)
check.holds(math.abs(energy.balance) < 2e-6 and math.abs(plain.balance) < 2e-6, "the energies balance")

-- The plate is as thin, but touches nothing: it falls with g.
local plate = model:blocks { group = "falls" }[1]
check.near(plate.displacement, { 0.5 * G * math.sin(SLOPE) * model.time ^ 2, 0,
    -0.5 * G * math.cos(SLOPE) * model.time ^ 2 }, 1e-11)

-- A given step that is shorter is taken, with the same inertia; a longer one is refused.
model:timestep { dt = wanted / 2 }
check.equal(model.dt, wanted / 2)
model:cycle(1)
check.near(model:mass_scaling().worst.factor, told.worst.factor, 0.01)
model:timestep { dt = 2 * wanted }
check.refused(model, function() model:cycle(1) end, "is longer than")
model:timestep {}

-- ---------------------------------------------------------------- the most

local remarks = model:state_hash()
model:mass_scaling { dt = wanted, most = 0.5 }
check.holds(model:state_hash() ~= remarks, "the most is part of the state")
local message
model:mass_scaling { dt = 20 * own }
check.refused(model, function()
    local good
    good, message = pcall(model.cycle, model, 1)
    error(message, 2)
end, "more than most = 0.05; block " .. sliver.id .. " would get 400 times")
local longest = tonumber(message:match "give dt = (%S+) or less")
model:mass_scaling { dt = 2 ^ 63 } -- by many powers of ten too long: the same is told
check.refused(model, function() model:cycle(1) end, message:match "give dt = %S+ or less")
check.holds(longest > wanted and longest < 20 * own, "a step that would do")
model:mass_scaling { dt = longest * 0.999 }
model:cycle(1)
check.near(model:mass_scaling().added, 0.05, 0.001)
model:mass_scaling { dt = 20 * own, most = 0.6 }
model:cycle(1)
check.holds(model:mass_scaling().added > 0.3, "as much as was allowed")
model:mass_scaling(false)
check.equal(model.mass_scaled, false)
check.near(model.dt, own, 0.01 * own)
check.refused(model, function() model:mass_scaling { dt = 0 } end, "dt = 0")
check.refused(model, function() model:mass_scaling { dt = 1e-4, most = -1 } end, "most = -1")
check.refused(model, function() model:mass_scaling { step = 1e-4 } end, "unknown parameter 'step'")
check.refused(model, function() model:mass_scaling { most = 0.1 } end, "give dt")
check.refused(model, function() model:mass_scaling { on = false, dt = 1e-4 } end, "leave one")

-- ---------------------------------------------------------------- threads

local hash
for threads = 1, 3 do
    local m = slope(threads)
    m:mass_scaling { dt = wanted }
    m:damping("local", {})
    m:cycle(300)
    hash = hash or m:state_hash()
    check.equal(m:state_hash(), hash)
end

-- ---------------------------------------------------------------- inertia that comes and goes

-- A plate falls on three posts, is given inertia there, jumps up again, and so on: the velocity stays, and the
-- energy that comes and goes with the inertia is booked.
local function plate_falls(dt, damping)
    local m = talus.model { gravity = { 0, 0, -G } }
    m:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = 2600 })
    m:blocks():fix()
    m:generate("box", { min = { 0.1, 0.2, 0.01 }, max = { 0.9, 0.7, 0.03 }, density = 2600, group = "plate" })
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 20 })
    if damping then
        m:damping("viscous", { alpha = 5 })
    end
    m:blocks { group = "plate" }:set { velocity = { 0.3, 0.1, 0 }, angular_velocity = { 0.05, -0.1, 0.2 } }
    if dt then
        m:mass_scaling { dt = dt, most = 100 }
    end
    local worst, factors = 0, {}
    while m.time < 0.3 do
        m:cycle(1)
        worst = math.max(worst, math.abs(m:energy().balance))
        local added = m:mass_scaling()
        factors[added.worst and string.format("%.3g", added.worst.factor) or "1"] = true
    end
    local count = 0
    for _ in pairs(factors) do
        count = count + 1
    end
    return worst, count, m:energy()
end

for _, damping in ipairs { false, true } do
    local plain_worst, none, plain_energy = plate_falls(nil, damping)
    local worst, several, scaled_energy = plate_falls(5e-4, damping)
    check.equal(none, 1)
    check.equal(plain_energy.external, 0)
    check.holds(several > 50, "the factor changes")
    check.holds(scaled_energy.external > 5, "inertia has brought energy")
    check.holds(worst < 0.005 and worst < plain_worst, "the energies balance as without added inertia")
end
