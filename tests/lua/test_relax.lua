-- program only
-- What model:relax promises: rest and failure are told, nothing of the user's is changed, the same bits for any threads
-- and over a copy or a save in the middle, what is driven is refused.
local talus = require "talus"
local check = require "check"

local TMP = os.tmpname()

-- A slope of a few dozen blocks on two sets of joints.
local function slope(friction, threads)
    local m = talus.model { gravity = { 0, 0, -9.81 }, seed = 7, threads = threads or 1 }
    m:generate("profile", {
        section = { { 0, -5 }, { 30, -5 }, { 30, 0 }, { 20, 0 }, { 12, 12 }, { 0, 12 } }, from = 0, to = 6, density = 2650,
    })
    m:generate("jointset", { joint = "J1", dip = 45, dip_direction = 90, spacing = 3, number = 12, origin = { 15, 3, 3 } })
    m:generate("jointset", { joint = "J2", dip = 80, dip_direction = 270, spacing = 4, number = 12, origin = { 15, 3, 3 } })
    m:boundary { xmin = "roller", xmax = "roller", ymin = "roller", ymax = "roller", zmin = "fixed" }
    m:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = friction })
    return m
end

-- Five bricks, each set back by a share of what makes them topple: joints that press on their edges.
local function bricks(share)
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { -1, 0, -0.5 }, max = { 0, 0.6, 0 }, density = 2300 })
    m:blocks():fix()
    local n, h, x = 5, 0.25, 0
    for i = n, 1, -1 do
        x = x + share / (2 * i)
        m:generate("box", { min = { x - 1, 0, (n - i) * h }, max = { x, 0.6, (n - i + 1) * h }, density = 2300 })
    end
    m:joint("*", "coulomb", { kn = 3e10, ks = 3e10, friction = 35 })
    return m
end

local function largest(m)
    local most = 0
    for _, b in ipairs(m:blocks { fixed = false }) do
        local u = b.displacement
        most = math.max(most, math.sqrt(u[1] ^ 2 + u[2] ^ 2 + u[3] ^ 2))
    end
    return most
end

-- Rest, and all that is the user's as before.
do
    local m = slope(60)
    m:damping("local", { alpha = 0.7 })
    m:timestep { rule = "body", fraction = 0.4 }
    local before = m:timestep()
    local r = m:relax {}
    check.equal(r.reason, "rest")
    check.holds(r.ratio_local < 1e-5, "the local ratio of what rests")
    check.holds(r.cycles > 10 and r.cycles < 300, "steps to rest: " .. r.cycles)
    check.equal(m.cycles, r.cycles)
    check.equal(m.time, 0)
    check.equal(r.failing, nil)
    check.equal(r.volume, nil)
    check.equal(m:blocks():max "speed", 0)
    check.near(m:timestep().dt, before.dt, 0.2 * before.dt)
    check.equal(m:mass_scaling().on, false)
    local on = m:solve { ratio = 2e-5, max_cycles = 200 }
    check.equal(on.reason, "ratio") -- what rests by relax rests
    check.equal(m:relax {}.reason, "rest")
end

-- What fails is told, and where it goes.
do
    local m = slope(20)
    local r = m:relax {}
    check.equal(r.reason, "failure")
    check.holds(#r.failing > 0, "some block fails")
    check.near(r.volume, r.failing:sum "volume", 1e-9 * r.volume)
    check.holds(r.direction[1] > 0.3 and r.direction[3] < -0.3, "down the slope")
    check.holds(r.message:find "fails: %d+ blocks", r.message)
    check.equal(m:blocks():max "speed", 0)
end

-- Neither: what is in the way.
do
    local r = slope(60):relax { max_cycles = 5 }
    check.equal(r.reason, "cycles")
    check.equal(r.cycles, 5)
    check.holds(r.message:find "neither at rest nor failing after 5 steps" and r.worst, r.message)
end

-- Joints that press on their edges come to rest, too: the kinetic damping alone takes some 40,000 steps to the same place.
do
    local m = bricks(0.97)
    local r = m:relax { ratio = 1e-7 }
    check.equal(r.reason, "rest")
    check.holds(r.cycles < 5000, r.cycles .. " steps of bricks that are set back")
    check.near(1e3 * largest(m), 3.1186, 2e-3)
end

-- The same bits for any threads, and over a copy and a save in the middle; during leaps, too.
for _, case in ipairs { { slope, 60 }, { bricks, 0.9 } } do
    local at = {}
    local function run(threads, middle)
        local m = case[1](case[2], threads)
        local r = m:relax {
            every = 1,
            on_progress = function(model)
                if model.cycles == middle then
                    at.copy = model:copy()
                    model:save(TMP)
                end
            end,
        }
        check.equal(r.reason, "rest")
        return m:state_hash(), r.cycles
    end
    local hash, cycles = run(1)
    for _, middle in ipairs { 20, cycles - 3 } do
        check.equal(run(3, middle), hash)
        check.equal(at.copy:relax {}.reason, "rest")
        check.equal(at.copy:state_hash(), hash)
        local restored = talus.restore(TMP)
        check.equal(restored.time, 0)
        check.equal(restored:relax {}.reason, "rest")
        check.equal(restored:state_hash(), hash)
        local other, plain = talus.restore(TMP), case[1](case[2]) -- other steps than those of the relaxation
        other:cycle(2)
        plain:cycle(2)
        check.near(other.dt, plain.dt, 0.3 * plain.dt)
        check.near(other.time, other.dt + other.dt, 1e-6 * other.dt)
    end
end
os.remove(TMP)

-- In parts gravity stores less: friction follows its path.
do
    local at_once, in_parts = slope(50), slope(50)
    local a, b = at_once:relax {}, in_parts:relax { load_steps = 10 }
    check.equal(a.reason, "rest")
    check.equal(b.reason, "rest")
    check.holds(in_parts:energy().stored <= at_once:energy().stored, "in parts no more is stored")
    check.holds(b.cycles > a.cycles, "and it takes more steps")
end

-- A relaxation leaves the balance of energy as it was, so a run that follows tells of its own steps.
do
    local m = slope(50)
    m:relax {}
    check.near(m:energy().balance, 0, 1e-12)
    m:blocks { fixed = false }:set { velocity = { 0, 0, 1e-4 } }
    m:cycle(200)
    check.holds(m:energy().kinetic > 0, "it moves")
    check.near(m:energy().balance, 0, 1e-4)
end

-- What cannot be asked for.
do
    local m = slope(60)
    check.refused(m, function() m:relax { ratio = 0 } end, "ratio")
    check.refused(m, function() m:relax { load_steps = 0 } end, "load_steps")
    check.refused(m, function() m:relax { dt = 1 } end, "dt")
    m:blocks():fix()
    m:blocks():drive { velocity = { 0.1, 0, 0 } }
    check.refused(m, function() m:relax {} end, "is driven at 0.1 m/s")
end

-- What fails in its first step takes no motion away: here a block lies in another.
do
    local m = talus.model {}
    m:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 }, { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2000 } })
    m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    local upper = m:blocks { id = 2 }
    upper:set { velocity = { 0.1, 0, 0 }, angular_velocity = { 0, 0, 1 } }
    m:cycle(3)
    m:generate("box", { min = { 0.4, 0.4, 0.4 }, max = { 0.6, 0.6, 0.6 }, density = 2000 })
    local before = upper[1].velocity[1]
    check.holds(before > 0, "it moves")
    check.refused(m, function() m:relax {} end, "inside")
    check.equal(upper[1].velocity[1], before)
end

-- A roof block that widens downwards by 3 degrees falls, though a heavy neighbour would clamp it as that settles: nothing falls slower
-- than it would. Held until the neighbour has settled it stands.
do
    local function roof(friction)
        local m = talus.model { gravity = { 0, 0, -10 } }
        local h, w, d = 0.5, 0.5 / 3, math.tan(math.rad(30))
        local t = h * math.tan(math.rad(3))
        m:generate("box", { min = { -2, 0, 0 }, max = { 0, 1, 4 }, density = 2500, group = "held" })
        m:generate("prism", { base = { { 0, 0, 1 }, { w + t, 0, 1 }, { w, 0, 1 + h }, { 0, 0, 1 + h } }, axis = { 0, 1, 0 }, density = 2500, group = "key" })
        m:generate("prism", { base = { { w + t, 0, 1 }, { w + t + 4, 0, 1 + d * 4 }, { w + t + 4, 0, 6 + d * 4 }, { w + 1, 0, 6 + d * 4 }, { w, 0, 1 + h } },
            axis = { 0, 1, 0 }, density = 2500, group = "heavy" })
        m:generate("prism", { base = { { w + t, 0, 1 }, { w + t, 0, -1 }, { w + t + 4, 0, -1 }, { w + t + 4, 0, 1 + d * 4 } }, axis = { 0, 1, 0 },
            density = 2500, group = "held" })
        m:blocks { group = "held" }:fix()
        m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = friction })
        return m
    end
    for _, friction in ipairs { 32, 45, 60 } do
        for _, load_steps in ipairs { 1, 10 } do
            local r = roof(friction):relax { load_steps = load_steps }
            check.equal(r.reason, "failure")
            check.equal(r.failing[1].group, "key")
        end
        local m = roof(friction)
        m:blocks { group = "key" }:fix()
        check.equal(m:relax({}).reason, "rest")
        m:blocks { group = "key" }:free()
        check.equal(m:relax({}).reason, "rest")
    end
end

-- What falls does so in few steps, however thin it is, and lands.
for _, case in ipairs { { 1, 1, 500 }, { 0.01, 1, 1500 }, { 0.001, 0.01, 1500 } } do
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { { min = { 0, 0, -1 }, max = { 4, 4, 0 }, density = 2500, group = "floor" }, { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 },
        { min = { 2, 2, case[2] }, max = { 3, 3, case[2] + case[1] }, density = 2500 } })
    m:blocks { group = "floor" }:fix()
    m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    local r = m:relax {}
    check.equal(r.reason, "rest")
    check.near(m:blocks { id = 3 }[1].displacement[3], -case[2] - case[1] * 2500 * 10 / 1e9, 1e-9)
    check.holds(r.cycles < case[3], ("a plate of %g m falls %g m in %d steps"):format(case[1], case[2], r.cycles))
end

-- The user's rule of the step has no say.
do
    local plain, balanced = slope(50), slope(50)
    balanced:timestep { rule = "balance", error = 1 }
    local a, b = plain:relax {}, balanced:relax {}
    check.equal(b.cycles, a.cycles)
    for k, block in ipairs(plain:blocks()) do
        check.equal(balanced:blocks()[k].displacement[3], block.displacement[3])
    end
end

-- Parts of the loads come on at the same steps over a copy at any step.
do
    local whole = bricks(0.8)
    local cycles = whole:relax({ load_steps = 3 }).cycles
    for at = 1, cycles - 1, 3 do
        local m, copy = bricks(0.8), nil
        m:relax { load_steps = 3, every = at, on_progress = function(x) copy = copy or x:copy() end }
        copy:relax { load_steps = 3 }
        check.equal(copy:state_hash(), whole:state_hash())
    end
end

-- No time passes for laws: a surface does not age at rest, and slides from the friction at its reference velocity on, 0.6 or 30.96 degrees.
-- A state that is older than that of steady slip at it is worn off by slip.
do
    local function cube(dip, theta)
        local angle = math.rad(dip)
        local m = talus.model { gravity = { 10 * math.sin(angle), 0, -10 * math.cos(angle) } }
        m:generate("box", { { min = { -5, 0, -1 }, max = { 9, 1, 0 }, density = 2500, group = "plane" }, { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 } })
        m:blocks { group = "plane" }:fix()
        m:joint("*", "rate_state", { kn = 1e9, ks = 1e9, mu0 = 0.6, a = 0.01, b = 0.015, distance = 1e-5, velocity = 1e-6, theta = theta })
        local reason = m:relax({}).reason
        return reason, m:contacts()[1].points[1].theta
    end
    for _, case in ipairs { { 20, 10, "rest", 10 }, { 20, 1e4, "rest", 1e4 }, { 30.9, 10, "rest", 10 }, { 31.02, 10, "failure", 10 }, { 40, 1e4, "failure", 10 } } do
        local reason, theta = cube(case[1], case[2])
        check.equal(reason, case[3])
        check.near(theta, case[4], 1e-9 * case[4])
    end
    local reason, theta = cube(33, 1e4)
    check.equal(reason, "rest")
    check.holds(theta < 9e3 and theta > 10, "slip has worn off some of the state: " .. theta)
end

-- One sliver, a thin slice of some block of a rock, does not stop the others. Where it slips, leaps take along what was too short.
do
    local SIDE = 5
    local function rock()
        local m = talus.model { gravity = { 0, 0, -9.81 }, seed = 1 }
        m:generate("box", { min = { 0, 0, 0 }, max = { SIDE, SIDE, SIDE }, density = 2600 })
        for _, set in ipairs { { "J1", 2, 40 }, { "J2", 88, 85 }, { "J3", 86, 175 } } do
            m:generate("jointset", { joint = set[1], dip = set[2], dip_direction = set[3], dip_dev = 0.5, dip_direction_dev = 0.5,
                spacing = 1, spacing_dev = 0.2, number = SIDE - 1, origin = { SIDE / 2, SIDE / 2, SIDE / 2 } })
        end
        m:boundary { xmin = "fixed", xmax = "fixed", ymin = "fixed", ymax = "fixed", zmin = "fixed" }
        m:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 35 })
        return m
    end
    local plain = rock():relax {}
    local shares = {}
    for k = 1, 10 do
        local m = rock()
        local free = m:blocks { fixed = false }
        local block = free[1 + 37 * k % #free]
        local dip, direction, at = 30 * (k % 4), 36 * k, block.centroid
        local n = { math.sin(math.rad(dip)) * math.sin(math.rad(direction)), math.sin(math.rad(dip)) * math.cos(math.rad(direction)),
            math.cos(math.rad(dip)) }
        local thick = 1e-3 * block.volume ^ (1 / 3)
        m:blocks():hide()
        m:blocks { id = block.id, hidden = "any" }:show()
        m:generate("joint", { joint = "X", dip = dip, dip_direction = direction, origin = at })
        local cut = m:generate("joint", { joint = "X", dip = dip, dip_direction = direction,
            origin = { at[1] + thick * n[1], at[2] + thick * n[2], at[3] + thick * n[3] } })
        m:blocks { hidden = "any" }:show()
        check.equal(cut.slivers, 1)
        local r = m:relax {}
        check.equal(r.reason, "rest")
        shares[k] = r.cycles / plain.cycles
    end
    table.sort(shares)
    check.holds((shares[5] + shares[6]) / 2 < 1.4 and shares[10] < 2.1,
        ("with a sliver %.2f times the steps, %.2f at the most"):format((shares[5] + shares[6]) / 2, shares[10]))
end
