-- A bolted roof layer of zones that yield: bolts bear what statics ask, and the roof comes down less.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local SPAN, THICK, DENSITY, GRAVITY = 4, 0.5, 2500, 10 -- m, m, kg/m3, m/s2
local WEIGHT = SPAN * THICK * DENSITY * GRAVITY        -- N, of a layer 1 m wide

-- A layer below held rock, which the joint between them does not hold. Its ends lie on ledges, or on nothing.
local function roof(ledges, count, more, threads)
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, threads = threads }
    model:generate("box", { min = { -0.5, 0, THICK }, max = { SPAN + 0.5, 1, THICK + 2 }, density = DENSITY })
    if ledges then
        model:generate("box", { { min = { -0.5, 0, -1 }, max = { 0.25, 1, 0 }, density = DENSITY },
            { min = { SPAN - 0.25, 0, -1 }, max = { SPAN + 0.5, 1, 0 }, density = DENSITY } })
    end
    model:blocks():fix()
    model:generate("box", { min = { 0, 0, 0 }, max = { SPAN, 1, THICK }, density = DENSITY, group = "layer" })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e8, friction = 0 })
    model:solid("shale", "mohr_coulomb", { young = 1e9, poisson = 0.25, cohesion = 4e5, friction = 25, tension = 2.5e5 })
    model:blocks { group = "layer" }:deformable { zone = 0.25, solid = "shale" }
    local list = {}
    for k = 1, count do
        local x = SPAN * (k - 0.5) / count
        list[k] = { from = { x, 0.5, 0 }, to = { x, 0.5, 2 }, spacing = 0.25 }
        for name, value in pairs(more or {}) do
            list[k][name] = value
        end
    end
    model:damping "local"
    return model, count > 0 and model:element("bolt", list) or {}
end

-- Tension of the steel at the joint, and the largest sums of forces of one bolt, over their sizes.
local function at_joint(bolts)
    local sum, off = 0, 0
    for _, bolt in ipairs(bolts) do
        local f, size = { 0, 0, 0 }, 0
        for _, node in ipairs(bolt.nodes) do
            sum = sum + (node.crosses == 1 and node.tension or 0)
            for i = 1, 3 do
                f[i] = f[i] + node.force[i]
                size = size + math.abs(node.force[i])
            end
        end
        off = math.max(off, (math.abs(f[1]) + math.abs(f[2]) + math.abs(f[3])) / size)
    end
    return sum, off
end

-- Without ledges the bolts bear the whole layer, each its share, however it yields between them.
local model, bolts = roof(false, 4)
local run = model:solve { measure = "local", ratio = 1e-5, max_cycles = 60000 }
check.equal(run.reason, "ratio")
local sum, off = at_joint(bolts)
check.near(sum / WEIGHT, 1, 1e-3)
check.near(off, 0, 1e-13)
check.near(bolts[1].axial / bolts[4].axial, 1, 0.02) -- zones are not alike on both sides
check.near(bolts[2].axial / bolts[3].axial, 1, 0.02)
check.near(model:energy().balance, 0, 1e-3)

-- On ledges it sags, and yields where it bends. Bolts hold it up.
local function sags(count, more)
    local one, its = roof(true, count, more)
    one:solve { measure = "local", ratio = 1e-5, max_cycles = 60000 }
    local middle = one:gridpoints { near = { 0.5 * SPAN, 0.5, 0 } }[1]
    return -middle.displacement[3], #one:zones { plastic = true }, (at_joint(its)), one
end
local bare, yielded = sags(0)
local two, yielded_with_two, borne = sags(3)
check.holds(yielded > 20, ("%d zones yield without bolts, so many that it"):format(yielded))
check.holds(two < 0.5 * bare, ("with three bolts the roof comes down by %g m, without by %g m; half of it"):format(two, bare))
check.holds(yielded_with_two < yielded, "fewer zones yield")
check.holds(borne > 0.3 * WEIGHT and borne < WEIGHT, "bolts and ledges share the weight")

-- Weak bolts yield, and hold it up less.
local weak, _, little, its = sags(3, { yield = 5e3 })
check.equal(#its:elements { where = function(bolt) return bolt.yielded end } > 0, true)
check.holds(little <= 1.5e4 + 1 and little < borne, "they bear no more than their yield")
check.holds(weak > two and weak < bare, ("with weak bolts it comes down by %g m, between those that"):format(weak))

-- The same bits on several threads, and after a copy in the middle.
local a, b = roof(true, 2, nil, 1), roof(true, 2, nil, 4)
a:cycle(50)
b:cycle(50)
check.equal(a:state_hash(), b:state_hash())
local c = a:copy()
a:cycle(50)
c:cycle(50)
check.equal(a:state_hash(), c:state_hash())

-- The ledger closes while it falls and swings on them.
model = roof(false, 3)
model:damping "none"
model:cycle(600)
check.near(model:energy().balance, 0, 1e-3)
