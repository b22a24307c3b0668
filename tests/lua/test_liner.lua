-- program only
-- Liners: a span, a ring, adhesion, cracks, energy, edits, deformable blocks, what is written, and what is refused.
local talus = require "talus"
local check = require "check"

local STRONG = 1e12
-- kn / (4 D) of a shell on its bond: the fourth root is 1 over the length in which it dies out.
local function decay(bond, young, thickness, poisson)
    return (bond / (4 * young * thickness ^ 3 / 12 / (1 - poisson ^ 2))) ^ 0.25
end

-- Sums of the forces and moments of an element, N and N m, over the sizes of forces.
local function sums(element)
    local force, moment, size = { 0, 0, 0 }, { 0, 0, 0 }, 1e-9
    for _, node in ipairs(element.nodes) do
        local f, x = node.force, node.position
        for k = 1, 3 do
            local i, j = k % 3 + 1, (k + 1) % 3 + 1
            force[k], moment[k] = force[k] + f[k], moment[k] + x[i] * f[j] - x[j] * f[i]
        end
        size = size + math.sqrt(f[1] ^ 2 + f[2] ^ 2 + f[3] ^ 2)
    end
    local most = 0
    for k = 1, 3 do
        most = math.max(most, math.abs(force[k]), math.abs(moment[k]))
    end
    return most / size
end

local function alike(a, steps)
    local file = os.tmpname()
    a:save(file)
    local b, c = talus.restore(file), a:copy()
    os.remove(file)
    for _ = 1, 2 do
        a:cycle(steps)
        b:cycle(steps)
        c:cycle(steps)
    end
    check.equal(b:state_hash(), a:state_hash())
    check.equal(c:state_hash(), a:state_hash())
end

-- A block that hangs at the end of a strip of 1 m, which the bond holds at both ends: beam and elastic foundation.
do
    local m = talus.model { gravity = { 0, 0, -10 } }
    for x = -1, 1 do
        m:generate("box", { min = { x, 0, -0.5 }, max = { x + 1, 0.5, 0 }, density = 2500 })
    end
    m:blocks { containing = { -0.5, 0.2, -0.2 } }:fix()
    local middle, last = m:blocks { containing = { 0.5, 0.2, -0.2 } }, m:blocks { containing = { 1.5, 0.2, -0.2 } }[1]
    m:damping "local"
    local t, young, bond, wide = 0.1, 20e9, 1e10, 0.5
    local e = m:element("liner", { facing = { 0, 0, 1 }, within = 1, thickness = t, young = young, poisson = 0, spacing = 0.4,
        tension = STRONG, bond_stiffness = bond, bond_strength = STRONG })
    check.equal(#e, 1)
    middle:delete()
    m:solve { measure = "local", ratio = 1e-6 }
    local P, L, arm, D, k, a = 6250, 1, 0.5, young * wide * t ^ 3 / 12, bond * wide, decay(bond, young, t, 0)
    local root, away = P * (L + arm), P * arm -- moments at both ends of the span
    local turn = 2 * a ^ 2 * P / k + 4 * a ^ 3 * root / k
    local sag = 2 * a * P / k + 2 * a ^ 2 * root / k + turn * L + P * L ^ 3 / 3 / D + away * L ^ 2 / 2 / D
    turn = turn + P * L ^ 2 / 2 / D + away * L / D
    sag = sag + 2 * a * P / k - 2 * a ^ 2 * away / k + (turn - 2 * a ^ 2 * P / k + 4 * a ^ 3 * away / k) * arm
    check.near(-last.displacement[3] / sag, 1, 0.04) -- the bond under the blocks is 6 / a long
    check.near(e[1].most_moment / (root / wide), 1, 0.08) -- of a triangle beside the root
    check.equal(e[1].detached, true)
    check.near(sums(e[1]), 0, 1e-12)
    check.near(m:energy().balance, 0, 1e-6)
    alike(m, 10)
end

-- A ring of blocks that do not touch, drawn outward by a pressure: the liner's pull is pressure times radius.
do
    local n, inner, outer, deep, pressure = 16, 2, 2.5, 0.3, 3e4
    local m = talus.model {}
    m:joint("*", "coulomb", { kn = 1e6, ks = 1e6, friction = 0 })
    local gap = 1e-3
    for i = 0, n - 1 do
        local corners = {}
        for _, at in ipairs { { inner, -1 }, { inner, 1 }, { outer, 1 }, { outer, -1 } } do
            local angle = 2 * math.pi * i / n + at[2] * (math.pi / n - gap)
            local r = at[1] / math.cos(math.pi / n)
            corners[#corners + 1] = { r * math.cos(angle), 0, r * math.sin(angle) }
            corners[#corners + 1] = { r * math.cos(angle), deep, r * math.sin(angle) }
        end
        m:generate("polyhedron", { vertices = corners, density = 2500 })
    end
    m:damping "local"
    local faces = {}
    for _, face in ipairs(m:boundary { facing = { 1, 0, 0 }, within = 180 }.faces) do
        local c, n = face.centroid, face.normal
        if n[1] * c[1] + n[3] * c[3] < -0.9 * math.sqrt(c[1] ^ 2 + c[3] ^ 2) then
            faces[#faces + 1] = c
        end
    end
    check.equal(#faces, n)
    local t = 0.1
    local e = m:element("liner", { faces = faces, thickness = t, young = 10e9, spacing = 0.4, tension = STRONG,
        poisson = 0, bond_strength = STRONG, bond_shear_stiffness = 1e7 }) -- so soft that blocks do not bear a part of it
    local area = 0
    for _, node in ipairs(e[1].nodes) do
        area = area + node.weight
    end
    check.near(area / (n * deep * 2 * inner * math.tan(math.pi / n)), 1, 1e-3) -- it bridges the gaps
    for _, block in ipairs(m:blocks()) do
        local c = block.centroid
        local r = math.sqrt(c[1] ^ 2 + c[3] ^ 2)
        local wide = 2 * outer * math.tan(math.pi / n) * deep
        m:blocks { containing = c }:load { force = { pressure * wide * c[1] / r, 0, pressure * wide * c[3] / r } }
    end
    m:cycle(3000)
    local sum = 0
    for _, node in ipairs(e[1].nodes) do
        sum = sum + node.weight * node.pull
    end
    check.near(sum / area / (pressure * outer), 1, 0.01)
end

-- A roof block between two held ones, which the liner holds at its joints. Each joint loads the end of two semi-infinite
-- beams on their bond by V, N/m: the bond bears 2 V a at most, and the liner 6 * 0.3224 V / (a t^2).
local function keyblock(gravity, threads, spacing)
    local m, deep = talus.model { gravity = { 0, 0, gravity }, threads = threads }, 0.3
    for i, x in ipairs { -1.5, -0.5, 0.5 } do
        m:generate("box", { min = { x, 0, 0 }, max = { x + 1, deep, 1 }, density = 2500 })
        if i ~= 2 then
            m:blocks { containing = { x + 0.5, 0.1, 0.5 } }:fix()
        end
    end
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 0 })
    local t, young, bond = 0.1, 20e9, 1e10
    local a = decay(bond, young, t, 0)
    local e = m:element("liner", { facing = { 0, 0, -1 }, within = 1, thickness = t, young = young, poisson = 0, bond_stiffness = bond,
        spacing = spacing or 0.1, bond_strength = STRONG, tension = STRONG })
    local load = 2500 * 10 * 0.5 -- N for each metre of joint
    return m, e, m:blocks { containing = { 0, 0.1, 0.5 } }[1], load * 2 * a, load * 6 * 0.3224 / a / t ^ 2
end
do
    local m, e, key, bond, stress = keyblock(-10)
    m:damping "local"
    m:solve { measure = "local", ratio = 1e-6 }
    local most, opens = 0, 0
    for _, node in ipairs(e[1].nodes) do
        most, opens = math.max(most, node.stress), math.max(opens, node.bond_tension)
    end
    check.near(opens / bond, 1, 0.03)
    check.near(most / stress, 1, 0.05)
    check.near(m:energy().balance, 0, 1e-9)
    local held = key.displacement[3]
    for _, one in ipairs { { 1.15, 1.15 }, { 0.85, 1e6 }, { 1e6, 0.85 } } do
        local n = m:copy()
        local l, k = n:elements {}, n:blocks { id = key.id }[1]
        l:set { bond_strength = bond * one[1], tension = stress * one[2] }
        alike(n, 100)
        n:cycle(2500)
        if one[1] < 1 then -- it peels off, and the block falls
            check.holds(l[1].debonded > 0.5 and k.displacement[3] < -0.05, "a liner whose bond is too weak holds the block, which")
            check.equal(l[1].cracked, 0)
        elseif one[2] < 1 then -- hinges on both sides
            check.holds(l[1].cracked > 0 and l[1].cracked < 0.1, "the liner is cracked elsewhere, which")
            check.equal(l[1].debonded, 0)
            check.equal(l[1].yielded, true)
        else
            check.equal(l[1].debonded + l[1].cracked, 0)
            check.near(k.displacement[3], held, 1e-9)
        end
        check.near(n:energy().balance, 0, 1e-4)
    end
end

-- It falls and turns: cracks and bonds that fail make no energy, on any number of threads.
local function fall(threads, part)
    local m, e = keyblock(-10, threads, 0.3)
    e:set { bond_strength = 1e6, tension = 1e6 }
    local falls = m:blocks { fixed = false }
    falls:set { velocity = { 0, 0, -0.2 }, angular_velocity = { 0.5, 1, 0 } }
    m:timestep { dt = m:timestep().dt / part }
    m:cycle(1)
    local begin = m:energy().kinetic
    m:cycle(200 * part - 1)
    return m, begin
end
for part = 1, 2 do
    local m, begin = fall(1, part)
    local e, energy = m:elements {}[1], m:energy()
    check.equal(e.broken and e.debonded > 0.05 and e.cracked > 0.01, true)
    check.near(energy.balance / begin, 0, 1e-6)
    check.holds(energy.element_loss > 1, "what broke became no heat, which")
    if part == 1 then
        check.equal(fall(4, 1):state_hash(), m:state_hash())
    end
end

-- Edits: nodes of a block that is cut go to its parts, those of one that is deleted are gone, and nothing moves.
do
    local m, e, key = keyblock(0)
    m:generate("joint", { joint = "late", dip = 90, dip_direction = 90, origin = { 0, 0, 0 } })
    m:cycle(10)
    check.equal(#e[1].nodes, 1944)
    local parts = {}
    for _, node in ipairs(e[1].nodes) do
        parts[node.block.id] = true
    end
    local count = 0
    for _ in pairs(parts) do
        count = count + 1
    end
    check.equal(count, 4)
    m:blocks { containing = { 0.1, 0.1, 0.5 } }:delete()
    m:cycle(10)
    check.equal(e[1].detached, true)
    check.near(m:energy().elements, 0, 1e-20)
    check.near(m:energy().element_loss, 0, 1e-20)
    e:delete()
    check.equal(#m:elements {}, 0)
end

-- On a deformable block that is drawn out it has the strain of the rock.
do
    local m = talus.model {}
    m:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2500 })
    m:solid("rock", "elastic", { young = 1e9, poisson = 0 })
    m:blocks():deformable { zone = 0.5, solid = "rock" }
    m:boundary { xmin = "roller", ymin = "roller", ymax = "roller", zmin = "roller" }
    m:boundary { xmax = { pressure = -1e6 } }
    m:damping "local"
    local e = m:element("liner", { facing = { 0, 0, 1 }, within = 1, thickness = 0.002, young = 10e9, poisson = 0, spacing = 0.3,
        tension = STRONG, bond_strength = STRONG })
    m:solve { measure = "local", ratio = 1e-5 }
    local pull, area = 0, 0
    for _, node in ipairs(e[1].nodes) do
        if math.abs(node.rest[1] - 1) < 0.3 then
            pull, area = pull + node.pull * node.weight, area + node.weight
        end
    end
    check.near(pull / area / (10e9 * 0.002 * 1e-3 / 1.02), 1, 0.02) -- it bears a part of what draws the block
    alike(m, 5)
end

-- What is written.
do
    local m, e = keyblock(-10)
    m:cycle(5)
    local dir = os.getenv "TALUS_TEST_TMP" .. "/liner"
    m:write_vtk(dir)
    m:write_html(dir .. ".html")
    local file = assert(io.open(dir .. "_elements_000000.vtk", "rb"))
    local text = file:read "a"
    file:close()
    check.equal(text:match "CELLS (%d+ %d+)", ("%d %d"):format(#e[1].nodes / 3, 4 * #e[1].nodes / 3))
    check.holds(text:find("bond_tension", 1, true), "states of nodes are missing, which")
end

-- What is refused.
do
    local m = keyblock(0)
    local function refused(more, sentence)
        local t = { thickness = 0.1 }
        for k, v in pairs(more) do
            t[k] = v
        end
        check.raises(function() m:element("liner", t) end, sentence)
        check.equal(#m:elements {}, 1)
    end
    refused({ thickness = 0 }, "thickness = 0")
    refused({ thickness = -1 }, "thickness = -1")
    refused({ poisson = 0.5 }, "poisson = 0.5")
    refused({ bond_strength = -1 }, "bond_strength = -1")
    refused({ tension = -1 }, "tension = -1")
    refused({ facing = { 1, 0, 1 }, within = 1 }, "no outer face looks along")
    refused({ rock = "none" }, "of group 'none'")
    refused({ faces = { { 0, 0.1, 0 }, { 0, 0.1, -0.1 } } }, "point 2 of faces")
    refused({ spacing = 1e-3 }, "make it longer")
    refused({ spacing = 100 }, "would cover 0 m2")
    check.raises(function() m:elements {}:set { spacing = 1 } end, "spacing")
end
