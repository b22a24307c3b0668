-- Waves that come in through quiet faces of deformable blocks: bits after a save, in a copy and by threads, beside rigid rows,
-- what takes their place, and what is refused.
local talus = require "talus"
local check = require "check"

local at = {}
for k = 0, 40 do
    at[k + 1] = 1e-3 * math.sin(math.pi * k / 40) ^ 2
end
local wave = talus.record { at = at, dt = 2e-4, quantity = "velocity" }

local function bar(o)
    local model = talus.model { gravity = { 0, 0, 0 }, threads = o.threads or 1 }
    model:solid("rock", "elastic", { young = 1e10, poisson = 0 })
    model:solid("stiff", "elastic", { young = 4e10, poisson = 0 })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 8 }, density = 2500 })
    model:blocks():deformable { zone = o.zone or 1, solid = "rock" }
    model:gridpoints {}:fix { y = true, z = true }
    model:boundary { zmin = { quiet = true, input = { wave, 0, 0 } } }
    return model
end

local function top(model)
    return model:gridpoints { near = { 0, 0, 8 } }[1].velocity[1]
end

local model, most = bar {}, 0
check.equal(#model:elements { kind = "incoming" }, 1)
local area, nodes = 0, model:elements { kind = "incoming" }[1].nodes
for _, node in ipairs(nodes) do
    area = area + node.weight
    check.near(node.impedance_p, 5e6, 1)
    check.near(node.impedance_s, 5e6 / math.sqrt(2), 1)
end
check.near(area, 1, 1e-12)
area = 0 -- of zones much smaller than the face, whose other sides lie near it
for _, node in ipairs(bar { zone = 0.25 }:elements { kind = "incoming" }[1].nodes) do
    area = area + node.weight
    check.near(node.position[3], 0, 1e-12)
end
check.near(area, 1, 1e-12)
while model.time < 0.012 do
    model:cycle(1)
    most = math.max(most, top(model))
end
check.near(most, 2e-3, 5e-5)
check.near(model:energy().balance, 0, 1e-6)

-- A run goes on to the bit.
local whole, pieces, threads = bar {}, bar {}, bar { threads = 2 }
whole:cycle(60)
threads:cycle(60)
pieces:cycle(25)
local file = os.tmpname()
pieces:save(file)
local back, copy = talus.restore(file), pieces:copy()
os.remove(file)
for _, m in ipairs { pieces, back, copy } do
    m:cycle(35)
    check.equal(m:state_hash(), whole:state_hash())
end
check.equal(threads:state_hash(), whole:state_hash())

-- What a later call does to the faces takes the place of the wave; with add it stays.
model = bar {}
model:boundary { side = "zmin", add = true, pressure = 1 }
check.equal(#model:elements { kind = "incoming" }, 1)
model:boundary { zmin = { quiet = true, input = { 0, 0, wave } } }
check.equal(#model:elements { kind = "incoming" }, 1)
model:boundary { zmin = { quiet = true } }
check.equal(#model:elements { kind = "incoming" }, 0)
model = bar {}
model:boundary { zmax = "fixed" }
check.equal(#model:elements { kind = "incoming" }, 1)
model:boundary { zmin = "fixed" }
check.equal(#model:elements { kind = "incoming" }, 0)

-- ---------------------------------------------------------------- what is refused

model = bar {}
local function refused(o, part)
    check.refused(model, function() model:boundary(o) end, part)
end
refused({ zmin = { quiet = true, input = { 1, 0, 0 } } }, "each a talus.record or 0")
refused({ zmin = { quiet = true, fixed = true, input = { wave, 0, 0 } } }, "a quiet face moves")
model:generate("box", { min = { 1, 0, 0 }, max = { 2, 0.5, 8 }, density = 2500 })
model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
refused({ facing = { 1, 0, 0 }, box = { min = { 0.9, 0, 0 }, max = { 1.1, 1, 8 } }, quiet = true, input = { wave, 0, 0 } },
    "other blocks cover a part of face")
model:boundary { zmin = "fixed" }
model:damping "local"
refused({ side = "xmin", quiet = true, input = { wave, 0, 0 } }, "under damping 'local'")
check.refused(model, function() model:element("incoming", { nodes = "1 0 0 0" }) end, "rows of 11 finite numbers")
