-- Damping of contacts: it takes energy only and all of it is in the ledger, it never pulls what cannot pull, it does not depend on
-- the kind of contact, the law, zones, axes or threads, and steps heed it.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local function model(options)
    options = options or {}
    return talus.model { gravity = options.gravity or { 0, 0, -10 }, threads = options.threads,
        contact_points = options.points }
end

-- A block falls on a base: flat, or turned so that it lands on an edge or a corner.
local function fall(options)
    local m = model(options)
    m:generate("box", { min = { -2, -2, -1 }, max = { 3, 3, 0 }, density = 2500, group = "base" })
    m:blocks():fix()
    local s, c = math.sin(options.turn or 0), math.cos(options.turn or 0)
    local vertices = {}
    for _, x in ipairs { 0, 1 } do
        for _, y in ipairs { 0, 1 } do
            for _, z in ipairs { 0, 1 } do
                vertices[#vertices + 1] = { c * x + s * z, y, c * z - s * x + s + 0.02 }
            end
        end
    end
    m:generate("polyhedron", { vertices = vertices, density = 2500, group = "block" })
    m:joint("*", options.law or "coulomb", options.params or { kn = 1e9, ks = 1e9, friction = 35 })
    if options.zones then
        m:solid("rock", "elastic", { young = 1e9, poisson = 0.2 })
        m:timestep { fraction = 0.25, zone_fraction = 0.25 }
        m:blocks { group = "block" }:deformable { zone = 1, solid = "rock" }
    end
    if options.damping ~= false then
        m:damping("dashpot", { ratio = options.ratio or 0.3, frequency = 400 })
    end
    return m
end

-- Runs until t; the largest balance, what damping took, and the largest part of it that came back.
local function run(m, t)
    local worst, lost, back = 0, 0, 0
    while m.time < t do
        m:cycle(5)
        local e = m:energy()
        worst = math.max(worst, math.abs(e.balance))
        back = math.max(back, lost - e.damping)
        lost = math.max(lost, e.damping)
    end
    return worst, lost, back
end

for name, options in pairs {
    flat = {}, edge = { turn = 0.4 }, corner = { turn = 0.02 }, corners = { points = "corners" },
    bonded = { law = "coulomb_tensile", params = { kn = 1e9, ks = 1e9, friction = 35, cohesion = 1e5, tension = 1e5 } },
    curved = { law = "barton_bandis", params = { jrc = 8, jcs = 80e6, phi_r = 30, kni = 1e9, vm = 1e-3, ks = 1e9 } },
    zones = { zones = true }, zones_edge = { zones = true, turn = 0.4 },
} do
    local time = options.zones and 0.068 or 0.08
    local plain = {}
    for key, value in pairs(options) do
        plain[key] = value
    end
    plain.damping = false
    local worst, lost, back = run(fall(options), time)
    local plain_worst = run(fall(plain), time)
    check.holds(lost > 1, ("%s: %g J were damped"):format(name, lost)) -- it falls with 490 J
    check.holds(back < 1e-6 * lost, ("%s: damping gave back %g of %g J"):format(name, back, lost))
    check.holds(worst < 1e-3 or worst < 1.2 * plain_worst, ("%s: balance %g, %g without"):format(name, worst, plain_worst))
end

-- A dashpot beside a spring that cannot pull: a block thrown up leaves at once, whatever the damping.
for _, ratio in ipairs { 0.5, 5 } do
    local m = fall { ratio = ratio }
    m:damping "local"
    m:solve { ratio = 1e-6 }
    m:damping("dashpot", { ratio = ratio, frequency = 400 })
    m:blocks { group = "block" }:set { velocity = { 0, 0, 1 } }
    local t = m.time
    while m.time < t + 0.05 do
        m:cycle(1)
    end
    local v = m:blocks { group = "block" }[1].velocity[3]
    check.holds(v > 1 - 10 * 0.05 - 0.02, ("thrown up at 1 m/s under ratio %g: %g m/s after 0.05 s"):format(ratio, v))
end

-- Threads and copies: the same bits.
local one, two = fall { turn = 0.4 }, fall { turn = 0.4, threads = 2 }
one:cycle(300)
two:cycle(300)
check.equal(one:state_hash(), two:state_hash())
local copy = one:copy()
copy:cycle(50)
one:cycle(50)
check.equal(copy:state_hash(), one:state_hash())

-- The step is shorter by (1 + l^2)^(1/2) - l, l = beta over the critical step.
local m = fall { damping = false }
m:timestep { fraction = 1 }
local critical = m.dt
local beta = 0.3 / (math.pi * 400)
local l = beta / critical
m:damping("dashpot", { ratio = 0.3, frequency = 400 })
check.near(m.dt / critical, math.sqrt(1 + l * l) - l, 1e-9)

-- A relaxation has its own damping.
m:relax()
check.refused(m, function() m:damping("dashpot", { ratio = 0.3 }) end, "frequency")
check.refused(m, function() m:damping("dashpot", { ratio = -1, frequency = 5 }) end, "ratio")
check.refused(m, function() m:damping("rayleigh", { ratio = 0.05, from = 9, to = 2 }) end, "from = 9 Hz is above to = 2 Hz")
