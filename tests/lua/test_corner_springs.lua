-- contact_points = "corners": a block tilts on springs at the corners of its face as rigid statics says, up to some degrees, and
-- goes over to the pressure field without a jump when it falls on.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local GRAVITY, DENSITY = 10, 2000

-- A block b x w x h on an incline of dip psi, degrees, in axes along the incline.
local function incline(kn, psi, b, w, h, friction)
    psi = math.rad(psi)
    local m = talus.model { gravity = { GRAVITY * math.sin(psi), 0, -GRAVITY * math.cos(psi) }, contact_points = "corners" }
    m:generate("box", { { min = { -9 * h, -9 * h, -h }, max = { 9 * h, 9 * h, 0 }, density = DENSITY },
        { min = { -b / 2, -w / 2, 0 }, max = { b / 2, w / 2, h }, density = DENSITY } })
    m:blocks { id = 1 }:fix()
    m:joint("*", "coulomb", { kn = kn, ks = kn, friction = friction })
    return m, m:blocks { id = 2 }[1]
end

local function tilt_of(block)
    local q = block.rotation
    return 2 * math.atan(q[3], q[1])
end

-- Four springs of a quarter of the area: N at e = h/2 tan psi is borne by a tilt of 4 N e / (kn A b^2), tan psi below b/h. 3DEC's
-- stable example (b = h = 10 m, 40 degrees, kn = 1e7 Pa/m) is among them: 0.147 degrees.
for _, case in ipairs { { 1e7, 40, 10, 10, 10 }, { 2e6, 35, 10, 4, 10 }, { 1e6, 20, 1, 1, 1.5 }, { 1e5, 10, 1, 3, 2 } } do
    local kn, psi, b, w, h = table.unpack(case)
    local m, block = incline(kn, psi, b, w, h, 60)
    m:damping "local"
    local full = m.gravity
    for k = 1, 20 do -- in portions, for friction remembers
        m.gravity = { full[1] * k / 20, 0, full[3] * k / 20 }
        m:solve { ratio = 1e-5, max_cycles = 5000 }
    end
    m:solve { ratio = 1e-7, max_cycles = 20000 }
    local stress = DENSITY * GRAVITY * h * math.cos(math.rad(psi))
    local tilt = 2 * stress * h * math.tan(math.rad(psi)) / (kn * b * b)
    check.holds(tilt > math.rad(0.05), "the case tilts beyond what patches of a field stand")
    -- the tilted block's weight moves on by its height times the tilt, and the point of its foot that turns goes back by the closure
    check.near(tilt_of(block) / tilt, 1, 0.01 + 2 * tilt * h / (b * math.tan(math.rad(psi))))
end

-- Toppling through the limits: no energy is made.
for _, kn in ipairs { 1e8, 1e9 } do
    local m, block = incline(kn, 25, 1, 1, 3, 45)
    m:timestep { fraction = 0.2 }
    local worst = 0
    for _ = 1, 140 do
        m:solve { max_time = 0.01, ratio = 1e-12 }
        if tilt_of(block) > math.rad(14) then
            break
        end
        worst = math.max(worst, math.abs(m:energy().balance))
    end
    check.holds(tilt_of(block) > math.rad(14), "it topples")
    check.holds(worst < 1e-3, ("kn %g: balance %g"):format(kn, worst))
end

-- Walls that came together from a gap do not pull, however a block has come down (docs/theory.md, "Across a gap"): at any tilt, on
-- a face or an edge, turned flat or not; nor do those whose bond was torn off.
local function lowest_pull(m, block, velocity, spin, cycles)
    local low = 0
    block:drive { velocity = velocity, angular_velocity = spin }
    for _ = 1, cycles / 5 do
        m:cycle(5)
        low = math.min(low, m:contacts():sum "normal_force")
    end
    return low
end

local function turned(vertices, axis, angle)
    local c, s = math.cos(angle), math.sin(angle)
    local out, low = {}, math.huge
    for i, v in ipairs(vertices) do
        local x, y, z = v[1], v[2], v[3]
        if axis == "y" then
            x, z = c * x + s * z, c * z - s * x
        else
            y, z = c * y - s * z, c * z + s * y
        end
        out[i] = { x, y, z }
        low = math.min(low, z)
    end
    return out, low
end

local function cube(size)
    local out = {}
    for k = 0, 7 do
        out[k + 1] = { size * (k % 2 - 0.5), size * (k // 2 % 2 - 0.5), size * (k // 4) }
    end
    return out
end

local bonded = {
    { "coulomb_tensile", { kn = 1e9, ks = 1e9, friction = 30, tension = 1e5, cohesion = 2e5 } },
    { "cohesive", { kn = 1e9, ks = 1e9, tension = 1e5, cohesion = 2e5, gi = 50, gii = 200, friction = 30 } },
}
math.randomseed(11)
for trial = 1, 18 do
    local law = bonded[trial % 2 + 1]
    local size, tilt = 0.3 + 2 * math.random(), math.rad(7 * math.random())
    local gap, depth = size * (0.002 + 0.01 * math.random()), size * 2e-4 * (1 + math.random())
    local axis = math.random() < 0.5 and "x" or "y"
    local m = talus.model { gravity = { 0, 0, 0 }, contact_points = "corners" }
    m:generate("box", { min = { -9, -9, -1 }, max = { 9, 9, 0 }, density = DENSITY, group = "floor" })
    local vertices, low = turned(turned(cube(size), "x", tilt), "y", tilt * math.random())
    for _, v in ipairs(vertices) do
        v[3] = v[3] - low + gap
    end
    m:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "block" })
    m:blocks { group = "floor" }:fix()
    m:joint("*", law[1], law[2])
    m:timestep { dt = 1e-5 }
    local block, cycles = m:blocks { group = "block" }, 100 * math.random(2, 5)
    local down = lowest_pull(m, block, { 0, 0, -(gap + depth) / (cycles * 1e-5) }, { 0, 0, 0 }, cycles)
    local turn = lowest_pull(m, block, { 0, 0, 0 }, { axis == "x" and 0.5 or 0, axis == "y" and -0.5 or 0, 0 }, 100)
    local up = lowest_pull(m, block, { 0, 0, 1 }, { 0, 0, 0 }, 500)
    check.holds(m:contacts():sum "normal_force" == 0, "it has been lifted off")
    check.holds(down == 0 and turn == 0 and up == 0,
        ("%s, tilt %g deg: pulls with %g, %g, %g N"):format(law[1], math.deg(tilt), down, turn, up))
end

-- Bonded, torn off, turned, put back and torn off again: it pulls the first time only.
for _, degrees in ipairs { 0, 0.02, 1, 4 } do
    for k = 1, 2 do
        local m = talus.model { gravity = { 0, 0, 0 }, contact_points = "corners" }
        m:generate("box", { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = DENSITY, group = "floor" })
        m:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 1 }, density = DENSITY, group = "block" })
        m:blocks { group = "floor" }:fix()
        m:joint("*", bonded[k][1], bonded[k][2])
        m:timestep { dt = 1e-5 }
        local block = m:blocks { group = "block" }
        check.near(lowest_pull(m, block, { 0, 0, 1 }, { 0, 0, 0 }, 3000) / -1e5, 1, 0.3)
        lowest_pull(m, block, { 0, 0, 0 }, { 0, math.rad(degrees) / 2e-3, 0 }, 200)
        local low = math.huge
        for _, v in ipairs(block[1].vertices) do
            low = math.min(low, v[3])
        end
        lowest_pull(m, block, { 0, 0, -(low + 2e-4) / 1e-2 }, { 0, 0, 0 }, 1000)
        check.holds(m:contacts():sum "normal_force" > 0, "it presses")
        check.holds(lowest_pull(m, block, { 0, 0, 0.5 }, { 0, 0, 0 }, 200) == 0,
            ("%s turned by %g degrees pulls again"):format(bonded[k][1], degrees))
    end
end

-- A block without friction that hits another in the limits between corners and field, or beside them, leaves with the energy with
-- which it came: whichever is made first, and whichever face lies within the other.
for trial = 1, 16 do
    local tilt, kn, speed = math.rad(4 + 9 * math.random()), 10 ^ (7.5 + math.random()), 0.3 + math.random()
    local first, wide = trial % 2 == 0, trial % 4 < 2
    local m = talus.model { gravity = { 0, 0, 0 }, contact_points = "corners" }
    local function floor()
        local r = wide and 5 or 0.4
        m:generate("box", { min = { -r, -r, -1 }, max = { r, r, 0 }, density = DENSITY, group = "floor" })
    end
    local function block()
        local r = wide and 1 or 4
        local vertices = turned(turned(cube(r), "y", tilt), "x", tilt * math.random() / 2)
        local low = math.huge -- above the floor
        for _, v in ipairs(vertices) do
            low = math.min(low, v[3])
        end
        for _, v in ipairs(vertices) do
            v[3] = v[3] - (wide and low or -0.4 * math.tan(tilt) - 0.4 * math.tan(tilt / 2)) + 2e-3
        end
        m:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "block" })
    end
    if first then
        block()
        floor()
    else
        floor()
        block()
    end
    m:blocks { group = "floor" }:fix()
    local b = m:blocks { group = "block" }
    b:set { velocity = { 0, 0, -speed } }
    m:joint("*", "coulomb", { kn = kn, ks = kn })
    m:timestep { fraction = 0.01 }
    local before, stored, cycles = b[1].kinetic_energy, 0, 0
    repeat
        m:cycle(50)
        cycles = cycles + 1
        local now = m:energy().stored
        local gone = stored > 0 and now == 0
        stored = now
    until gone or cycles > 1000
    check.holds(cycles < 1000, "it has hit and left")
    check.near(b[1].kinetic_energy / before, 1, 5e-4)
end

-- The same where the edge of a table clips the face that hits it: the areas of the corners change as it turns over the edge.
math.randomseed(7)
for _ = 1, 25 do
    local size = { 0.3 + 1.5 * math.random(), 0.3 + 1.5 * math.random(), 0.3 + 2 * math.random() }
    local tilt, lean, turn = math.rad(16) * (math.random() - 0.5), math.rad(12) * (math.random() - 0.5), 3 * math.random()
    local edge, kn = 0.8 * size[1] * (math.random() - 0.5), 10 ^ (7.3 + 1.5 * math.random())
    local vertices = {}
    for k = 0, 7 do
        local x, y = size[1] * (k % 2 - 0.5), size[2] * (k // 2 % 2 - 0.5)
        vertices[k + 1] = { math.cos(turn) * x - math.sin(turn) * y, math.sin(turn) * x + math.cos(turn) * y, size[3] * (k // 4) }
    end
    local low
    vertices, low = turned(turned(vertices, "x", lean), "y", tilt)
    for _, v in ipairs(vertices) do
        v[3] = v[3] - low + 1e-3
    end
    local m = talus.model { gravity = { 0, 0, 0 }, contact_points = "corners" }
    m:generate("box", { min = { -5, -5, -2 }, max = { edge, 5, 0 }, density = DENSITY, group = "floor" })
    m:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "block" })
    m:blocks { group = "floor" }:fix()
    local b = m:blocks { group = "block" }
    b:set { velocity = { 0, 0, -0.5 - 2 * math.random() } }
    m:joint("*", "coulomb", { kn = kn, ks = kn })
    m:timestep { fraction = 0.02 }
    local whole, worst = b[1].kinetic_energy, 0
    for _ = 1, 200 do
        m:solve { max_time = 2e-3, ratio = 1e-14 }
        local e = m:energy()
        worst = math.max(worst, math.abs(e.kinetic + e.stored - whole) / whole)
    end
    check.holds(worst < 4e-3, ("edge at %g, tilt %g deg, kn %g: energy changes by %g"):format(edge, math.deg(tilt), kn, worst))
end

-- Slow impacts on an edge, where overlaps are next to nothing, at tilts from some hundredths of a degree to three.
for _, degrees in ipairs { -3, -1, -0.3, -0.1, -0.05, -0.01, 0.01, 0.05, 0.1, 0.3 } do
    local c, s, vertices = math.cos(math.rad(degrees)), math.sin(math.rad(degrees)), {}
    for k = 0, 7 do
        local x, y, z = k % 2 - 0.3, k // 2 % 2 - 0.5, k // 4
        vertices[k + 1] = { c * x + s * z, y, c * z - s * x + 0.01 }
    end
    local m = talus.model { gravity = { 0, 0, 0 }, contact_points = "corners" }
    m:generate("box", { min = { 0, -5, -1 }, max = { 5, 5, 0 }, density = DENSITY, group = "floor" })
    m:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "block" })
    m:blocks { group = "floor" }:fix()
    m:blocks({ group = "block" }):set { velocity = { 0, 0, -0.3 } }
    m:joint("*", "coulomb", { kn = 2e9, ks = 2e9 })
    m:timestep { fraction = 0.02 }
    m:cycle(1)
    local e = m:energy()
    local whole = e.kinetic + e.stored
    m:solve { ratio = 1e-14, max_time = (0.01 + 0.7 * math.abs(s)) / 0.3 * 1.2 }
    e = m:energy()
    check.near((e.kinetic + e.stored) / whole, 1, 5e-4)
end

-- Of two faces that meet at 20 degrees the one that is flush with the floor has the springs, in whatever order they are listed:
-- the block keeps the energy with which it came. (At 10 degrees both tilt alike: there the choice changes.)
for _, degrees in ipairs { 1, 3, 5, 7, 13, 15, 17, 19 } do
    for mirrored = 0, 1 do
        local side = mirrored == 0 and 1 or -1
        local vertices, low = {}, math.huge
        for _, y in ipairs { -0.5, 0.5 } do
            for _, at in ipairs { { -0.5, 0 }, { 0, 0 }, { 0.5, 0.5 * math.tan(math.rad(20)) }, { -0.5, 1 }, { 0.5, 1 } } do
                vertices[#vertices + 1] = { side * at[1], y, at[2] }
            end
        end
        vertices, low = turned(vertices, "y", side * math.rad(degrees))
        for _, v in ipairs(vertices) do
            v[3] = v[3] - low + 2e-3
        end
        local m = talus.model { gravity = { 0, 0, 0 }, contact_points = "corners" }
        m:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = DENSITY, group = "floor" })
        m:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "block" })
        m:blocks { group = "floor" }:fix()
        local b = m:blocks { group = "block" }
        b:set { velocity = { 0, 0, -1 } }
        m:joint("*", "coulomb", { kn = 1e8, ks = 1e8 })
        m:timestep { fraction = 0.02 }
        local whole, worst = b[1].kinetic_energy, 0
        for _ = 1, 60 do
            m:cycle(50)
            local e = m:energy()
            worst = math.max(worst, math.abs(e.kinetic + e.stored - whole) / whole)
        end
        check.holds(worst < 1e-3, ("%d degrees, side %d: energy changes by %g"):format(degrees, side, worst))
    end
end

-- A keel, two faces that meet more bluntly than 20 degrees, has the default points: the same motion bit for bit, and so no jump where
-- one face takes over from the other.
local function rocked(points, degrees, kn, lean)
    local up, vertices, low = 0.5 * math.tan(math.rad(degrees / 2)), {}, nil
    for _, y in ipairs { -0.4, 0.4 } do
        for _, at in ipairs { { -0.5, up }, { 0, 0 }, { 0.5, up }, { 0.5, 0.6 }, { -0.5, 0.6 } } do
            vertices[#vertices + 1] = { at[1], y, at[2] }
        end
    end
    vertices, low = turned(vertices, "y", math.rad(lean))
    for _, v in ipairs(vertices) do
        v[3] = v[3] - low + 1e-4
    end
    local m = talus.model { gravity = { 0, 0, -GRAVITY }, contact_points = points }
    m:generate("box", { min = { -9, -9, -1 }, max = { 9, 9, 0 }, density = DENSITY, group = "floor" })
    m:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "block" })
    m:blocks { group = "floor" }:fix()
    m:joint("*", "coulomb", { kn = kn, ks = kn, friction = 40 })
    m:timestep { fraction = 0.2 }
    local worst = 0
    for _ = 1, 50 do
        m:solve { max_time = 0.02, ratio = 1e-14 }
        worst = math.max(worst, math.abs(m:energy().balance))
    end
    return worst, m:blocks({ group = "block" })[1].centroid
end

for _, case in ipairs { { 18, 1e7, 10 }, { 18, 1e9, 17 }, { 6, 1e8, 4 }, { 3, 1e8, 9 }, { 12, 1e9, 7 } } do
    local worst, place = rocked("corners", table.unpack(case))
    local _, same = rocked("consistent", table.unpack(case))
    check.holds(worst < 2e-3, ("keel of %g degrees: balance %g"):format(case[1], worst))
    check.holds(place[1] == same[1] and place[2] == same[2] and place[3] == same[3], "with the default points")
end
