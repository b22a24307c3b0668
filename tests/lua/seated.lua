-- seated.lua - random assemblies of stones that do not quite fit, seated, on joints of any law.
--
--     seated.model(kind, seed, jitter, law, more)   without gravity, not yet seated; `law` is one of every_law.lua
--     seated.draw(seed, fits, laws)                 such a model, seated, its law and its kind
--     seated.at_rest(seed)                          net forces of its blocks over their weights, before the first step and after it
--     seated.falls(seed, event, fits)               balance of its energy as it falls, with something done to it meanwhile
local every_law = require "every_law"
local jittered = require "jittered"
local talus = require "talus"

local seated = { SIZE = 0.5, KN = 1e9, DENSITY = 2500, GRAVITY = 10 } -- SIZE: of a stone, m

local KN, SIZE, DENSITY, GRAVITY = seated.KN, seated.SIZE, seated.DENSITY, seated.GRAVITY
local JITTERS = { 1e-6, 1e-5, 1e-4, 1e-3, 4e-3 }

seated.laws = every_law(KN, 10 * DENSITY * SIZE) -- of weights

seated.kinds = {
    { name = "wall", make = jittered.wall },
    { name = "arch", make = function(m, o)
        o.inner, o.outer, o.count = 5, 5.6, 13
        jittered.arch(m, o)
    end },
    { name = "dome", make = function(m, o)
        o.inner, o.outer, o.around, o.rings = 4, 4.6, 8, 3
        jittered.dome(m, o)
    end },
}

function seated.model(kind, seed, jitter, law, more)
    local model = talus.model { gravity = { 0, 0, 0 }, contact_points = more and more.points }
    local o = { jitter = jitter, random = jittered.random(seed), density = DENSITY }
    for key, value in pairs(more or {}) do
        o[key] = value
    end
    kind.make(model, o)
    model:joint("*", law.law, law.params)
    return model
end

-- Those that come with Talus. `glue` of tests/plugins books more heat than it loses when it breaks where stones are off, seated or not.
local own_laws = {}
for _, law in ipairs(seated.laws) do
    own_laws[#own_laws + 1] = law.law ~= "glue" and law or nil
end

-- With `fits` the stones fit as they are. `laws`: those of which one is drawn, all without it.
function seated.draw(seed, fits, laws)
    local kind = seated.kinds[seed % 3 + 1]
    laws = laws or seated.laws
    local law, points = laws[seed % #laws + 1], seed // 3 % 4 == 0 and "corners" or nil
    local model = seated.model(kind, seed, fits and 0 or JITTERS[seed % 5 + 1], law, { points = points })
    local result = model:seat { gap = 0.05 * SIZE, overlap = 0.05 * SIZE }
    return model, law, kind, result
end

-- The largest net force of contacts on a free block over its weight.
local function net_force(model)
    local sums, worst = {}, 0
    for _, c in ipairs(model:contacts()) do
        for side = 1, 2 do
            local id, sign = c.blocks[side].id, side == 1 and -1 or 1
            local sum = sums[id] or { 0, 0, 0 }
            for k = 1, 3 do
                sum[k] = sum[k] + sign * (c.normal_force * c.normal[k] + c.shear_force[k])
            end
            sums[id] = sum
        end
    end
    for _, block in ipairs(model:blocks { fixed = false }) do
        local f = sums[block.id]
        if f then
            worst = math.max(worst, math.sqrt(f[1] ^ 2 + f[2] ^ 2 + f[3] ^ 2) / (GRAVITY * block.mass))
        end
    end
    return worst
end

-- Before the first step, after it and after a hundred; and whether a second seat leaves the model as it is, to the bit.
function seated.at_rest(seed)
    local model, _, _, result = seated.draw(seed)
    local hash, before = model:state_hash(), net_force(model)
    local again = model:seat { gap = 0.05 * SIZE, overlap = 0.05 * SIZE }
    local unchanged = again.contacts == 0 and model:state_hash() == hash
    model:cycle(1)
    local first = net_force(model)
    model:cycle(99)
    return { before = before, first = first, later = net_force(model), unchanged = unchanged, contacts = result.contacts }
end

-- What is done to a model that falls; gives the model that goes on.
local events = {
    none = function(model) return model end,
    copy = function(model) return model:copy() end,
    save = function(model)
        local path = os.tmpname()
        model:save(path)
        local restored = talus.restore(path)
        os.remove(path)
        return restored
    end,
    cut = function(model, law, kind, seed)
        model:generate("joint", { joint = "cut", dip = 70, dip_direction = 10 * seed % 360, origin = { 1.5, 0.25, kind.name == "wall" and 1 or 4.5 } })
        model:joint("cut", law.law, law.params)
        return model
    end,
    law = function(model)
        model:joint("*", "coulomb", { kn = 3 * KN, ks = KN, friction = 20 })
        return model
    end,
}

seated.events = { "none", "copy", "save", "cut", "law" }

local STEPS = 300 -- before the event, and after it

-- On its side, so that it falls, without damping: the energy that is missing, over the largest term, and the largest speed, m/s.
function seated.falls(seed, event, fits)
    local model, law, kind = seated.draw(seed, fits, own_laws)
    model.gravity = { 0.8 * GRAVITY, 0, -0.6 * GRAVITY }
    model:timestep { fraction = 0.1 }
    model:cycle(STEPS)
    model = events[event](model, law, kind, seed)
    model:cycle(STEPS)
    local fastest = 0
    for _, block in ipairs(model:blocks { fixed = false }) do
        local v = block.velocity
        fastest = math.max(fastest, math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2))
    end
    return math.abs(model:energy().balance), fastest
end

return seated
