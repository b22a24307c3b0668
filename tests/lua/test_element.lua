-- Elements: springs between blocks and the ground swing, yield, hang blocks, follow cuts, joins and deletes, and are saved.
local talus = require "talus"
local check = require "check"

local function cube(gravity)
    local m = talus.model { gravity = { 0, 0, gravity or 0 } }
    m:generate("box", { min = { -0.5, -0.5, -0.5 }, max = { 0.5, 0.5, 0.5 }, density = 1000 })
    return m
end

-- A block on a spring of k swings with the period of its mass, and no energy is made.
local k, mass = 1e5, 1000
local m = cube()
local e = m:element("spring", { from = { 0, 0, 0 }, to = { 3, 0, 0 }, stiffness = k })
local period = 2 * math.pi * math.sqrt(mass / k)
check.near(m.dt > 0 and m.dt < period / math.pi and 1 or 0, 1, 0)
m:timestep { dt = period / 400 }
m:blocks {}:set { velocity = { 0.1, 0, 0 } }
m:cycle(100)
check.near(m:blocks()[1].displacement[1], 0.1 * math.sqrt(mass / k), 1e-5)
check.near(e[1].axial, -k * 0.1 * math.sqrt(mass / k), 1)
m:cycle(300)
check.near(m:blocks()[1].displacement[1], 0, 1e-5)
check.near(m:energy().balance, 0, 1e-12)
check.near(m:energy().stored, e:sum "stored", 1e-12)

-- Beside a dashpot of critical damping it comes to rest; what the dashpot takes is heat, and the step is shorter.
m = cube()
e = m:element("spring", { from = { 0, 0, 0 }, to = { 3, 0, 0 }, stiffness = k, damping = 2 * math.sqrt(k * mass) })
local free = 2 * math.sqrt(mass / k)
check.near(m.dt / free < math.sqrt(2) - 1 and 1 or 0, 1, 0)
m:blocks {}:set { velocity = { 0.1, 0, 0 } }
m:timestep { dt = period / 2000 }
m:cycle(4000)
check.near(m:energy().friction, 0.5 * mass * 0.01, 1e-3)
check.near(m:energy().balance, 0, 1e-9)

-- Yield: a block that hangs on more than the strength sinks with what is left.
m = cube(-10)
e = m:element("spring", { from = { 0, 0, 0 }, to = { 0, 0, 3 }, stiffness = 1e6, strength = 8000 })
m:timestep { dt = 1e-4 }
m:cycle(1000)
local t, v = m.time, m:blocks()[1].velocity[3]
m:cycle(1000)
check.near((m:blocks()[1].velocity[3] - v) / (m.time - t), -2, 1e-6)
check.near(e[1].yielded and 1 or 0, 1, 0)
check.near(m:energy().friction / (8000 * e[1].slip), 1, 1e-3)

-- A block that hangs on it is at rest, and the step of a save goes on to the bit.
m = cube(-10)
m:damping "local"
e = m:element("spring", { from = { 0, 0, 0 }, to = { 0, 0, 3 }, stiffness = 1e6, group = "stay" })
local r = m:solve { measure = "local", ratio = 1e-6, max_cycles = 20000 }
check.equal(r.reason, "ratio")
check.near(e[1].axial, 1e4, 0.1)
check.equal(#m:elements { group = "stay" }, 1)
check.equal(#m:elements { block = 1 }, 1)
check.equal(#m:elements { kind = "water" }, 0)

local function alike(a, what)
    local file = os.tmpname()
    a:save(file)
    local b, c = talus.restore(file), a:copy()
    os.remove(file)
    check.equal(b:state_hash(), a:state_hash())
    check.equal(c:state_hash(), a:state_hash())
    for _ = 1, 3 do
        a:cycle(10)
        b:cycle(10)
        c:cycle(10)
    end
    check.equal(b:state_hash(), a:state_hash())
    check.equal(c:state_hash(), a:state_hash())
end
m:blocks {}:set { velocity = { 0.01, 0.02, 0 } }
alike(m, "a spring")

-- Nodes follow cuts, joins and deletes; what they bear stays.
local function beam(threads)
    local b = talus.model { gravity = { 0, 0, 0 }, threads = threads }
    b:generate("box", { min = { 100, 0, 0 }, max = { 102, 1, 1 }, density = 1000 })
    b:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    b:element("spring", { { from = { 100.5, 0.5, 0.5 }, to = { 100.5, 0.5, 3 }, stiffness = 1e5, pretension = 100 },
        { from = { 101.5, 0.4, 0.5 }, to = { 101.5, 0.5, 3 }, stiffness = 1e5, pretension = 100, damping = 10 } })
    b:cycle(50)
    return b
end
m = beam()
e = m:elements {}
local before = { e[1].nodes[1].position, e[2].nodes[1].position }
m:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 101, 0, 0 } })
for i = 1, 2 do
    local node = e[i].nodes[1]
    check.near(node.position[3] - before[i][3], 0, 1e-12)
    check.near(math.abs(node.block.centroid[1] - node.position[1]), 0, 1e-2)
end
alike(m, "after a cut")
m:blocks {}:join()
m:cycle(1)
check.near(e[1].nodes[1].rest[1], 100.5, 1e-12)
m:blocks {}:unjoin()
m:blocks { id = e[2].nodes[1].block.id }:delete()
check.equal(e[2].detached, true)
check.equal(e[1].detached, false)
m:cycle(1)
check.near(e[2].axial, 0, 0)
e:where(function(one) return one.detached end):delete()
check.equal(#m:elements {}, 1)
check.raises(function() return e[2].axial end, "there is no element")

-- A block is deleted: the digest is that of rows that have gone, before the model is saved and after.
for gone = 1, 3 do
    local b = talus.model { gravity = { 0, 0, -10 } }
    for z = 0, 2 do
        b:generate("box", { min = { 0, 0, z }, max = { 1, 1, z + 1 }, density = 2500 })
    end
    b:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 25 })
    b:element("spring", { from = { 0.5, 0.5, 1.5 }, to = { 0.5, 0.5, 9 }, stiffness = 1e6 })
    b:cycle(5)
    b:blocks { id = gone }:delete()
    local hash = b:state_hash()
    check.equal(b:state_hash(), hash)
    check.equal(b:copy():state_hash(), hash)
end

-- The same bits on several threads.
local one, four = beam(1), beam(4)
one:cycle(20)
four:cycle(20)
check.equal(four:state_hash(), one:state_hash())

-- Parameters are changed one by one; those of the place are not.
m = beam()
e = m:elements {}
e:set { stiffness = 2e5 }
check.near(e[1].params.stiffness, 2e5, 0)
e:where(function(one) return one.id == 1 end):set { damping = 7 }
check.near({ e[1].params.damping, e[2].params.damping, e[1].params.stiffness }, { 7, 10, 2e5 }, 0)
check.raises(function() e:set { from = { 0, 0, 0 } } end, "says where it is")
check.raises(function() e:set { stiffness = -1 } end, "stiffness")
check.near(e[1].params.stiffness, 2e5, 0)

-- Bad input. A failed call leaves the state as it was, with elements and without.
local bare = talus.model()
bare:generate("box", { min = { 100, 0, 0 }, max = { 101, 1, 1 }, density = 2000 })
local function refuse(t, words)
    for _, one in ipairs { m, bare } do
        local all, hash = #one:elements {}, one:state_hash()
        check.raises(function() one:element("spring", t) end, words)
        check.equal(#one:elements {}, all)
        check.equal(one:state_hash(), hash)
    end
end
refuse({ from = { 0, 0, 0 }, to = { 0, 0, 0 }, stiffness = 1 }, "same point")
refuse({ from = { 0, 0, 50 }, to = { 0, 0, 60 }, stiffness = 1 }, "neither end lies in a block")
refuse({ from = { 100.5, 0.5, 0.5 }, to = { 0, 0, 60 } }, "stiffness")
refuse({ from = { 100.5, 0.5, 0.5 }, to = { 0, 0, 60 }, stiffness = 1, pretension = 5, strength = 4 }, "above strength")
refuse({ { from = { 100.5, 0.5, 0.5 }, to = { 0, 0, 60 }, stiffness = 1 }, { from = { 0, 0, 50 }, to = { 0, 0, 60 }, stiffness = 1 } },
    "entry 2")
check.raises(function() m:element("sprink", {}) end, "spring")

-- A dashpot on a deformable block shortens the step: without that its gridpoint would run away.
do
    local function cube(damping)
        local m = talus.model { gravity = { 0, 0, 0 } }
        m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
        m:solid("rock", "elastic", { young = 1e8, poisson = 0.2 })
        m:blocks():deformable { zone = 0.5, solid = "rock" }
        m:element("spring", { from = { 1, 1, 1 }, to = { 1, 1, 3 }, stiffness = 1e5, damping = damping })
        m:blocks():set { velocity = { 0, 0, 1 } }
        m:cycle(1)
        return m
    end
    local free, damped = cube(0), cube(1e7)
    check.holds(damped.dt < 0.1 * free.dt, "the dashpot shortens the step")
    damped:cycle(300)
    check.holds(damped:energy().kinetic < 1001, "a dashpot makes no energy")
    check.near(damped:energy().balance, 0, 1e-3)
end
