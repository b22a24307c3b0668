-- program only
-- Bolts at random through jointed rock that moves: forces add up to zero, energy is kept, nothing hangs on place, attitude,
-- unit, order, threads or files, closed paths make no energy, and openings superpose.
local talus = require "talus"
local check = require "check"
local shapes = require "shapes"
local rock = require "random_bolts"

local MODELS, STEPS = check.cases(300), 80
local SUMS = 1e-13     -- of forces over their sizes: rounding
local ENERGY = 1e-3    -- error of the work of a bolt over all that it has done
local LITTLE = 1e-2    -- J, of bolts that do nothing but for rounding
local SAME = 1e-7      -- of motion, m, and of forces over the largest one: rounding, grown by blocks that touch

local function each_step(model, bolts, steps, each)
    for _ = 1, steps do
        local at, force = {}, {}
        for k, bolt in ipairs(bolts) do
            at[k], force[k] = rock.places(bolt), {}
            for i, node in ipairs(bolt.nodes) do
                force[k][i] = node.force
            end
        end
        model:cycle(1)
        each(at, force)
    end
end

-- Work that blocks do on each bolt, step by step, against what it stores and turns to heat.
local function check_work(seed, model, bolts)
    local error, done, stored, last = {}, {}, {}, nil
    for k, bolt in ipairs(bolts) do
        error[k], done[k], stored[k] = 0, LITTLE + bolt.stored, bolt.stored
    end
    each_step(model, bolts, STEPS, function(at, before)
        for k, bolt in ipairs(bolts) do
            local f, m = rock.sums(bolt, at[k])
            check.near(f, 0, SUMS)
            check.near(m, 0, SUMS)
            if last then
                local work = 0
                for i, node in ipairs(bolt.nodes) do
                    local way = shapes.sum(at[k][i], -1, last[k][i])
                    work = work - 0.5 * shapes.dot(shapes.sum(node.force, 1, before[k][i]), way)
                end
                error[k] = error[k] + work - (bolt.stored - stored[k]) - bolt.lost
                done[k] = math.max(done[k] + math.abs(work), bolt.stored)
            end
            stored[k] = bolt.stored
        end
        last = at
    end)
    for k = 1, #bolts do
        check.holds(math.abs(error[k]) <= ENERGY * done[k],
            ("seed %d, bolt %d: %g J of %g J are missing, which"):format(seed, k, error[k], done[k]))
    end
end

-- Whether two pictures are the same but for rounding.
local function check_same(seed, name, u, f, expected_u, expected_f)
    local most = 1
    for _, x in ipairs(expected_f) do
        most = math.max(most, math.abs(x))
    end
    for i, x in ipairs(u) do
        check.holds(math.abs(x - expected_u[i]) <= SAME, ("seed %d, %s: %g m beside %g m, which"):format(seed, name, x, expected_u[i]))
    end
    for i, x in ipairs(f) do
        check.holds(math.abs(x - expected_f[i]) <= SAME * most * 10,
            ("seed %d, %s: %g N beside %g N, which"):format(seed, name, x, expected_f[i]))
    end
end

local function forms(seed)
    local random = shapes.random(seed + 5000)
    local d = shapes.direction(random)
    local mirror = { { -1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
    local all = {
        { name = "turned", matrix = shapes.attitude(random) },
        { name = "turned and mirrored", matrix = shapes.product(mirror, shapes.attitude(random)) },
        { name = "in units of 4 m", unit = 0.25 },
        { name = "in millimetres", unit = 1000 },
        { name = "moved by 1 km", shift = { 1e3 * d[1], 1e3 * d[2], 1e3 * d[3] } },
        { name = "in the other order", reversed = true },
    }
    return { all[seed % 6 + 1], all[(seed + 3) % 6 + 1] }
end

local function run(one, form, threads, dt)
    local model, bolts, blocks = rock.build(one, form, threads)
    rock.start(one, form, model, blocks, dt)
    return model, bolts, blocks
end

for seed = 1, MODELS do
    local one = rock.draw(seed)
    local model, bolts, blocks = run(one, {}, 1)
    local dt = 0.2 * math.min(model:timestep().dt, 1e-3)
    model:timestep { dt = dt }
    local half = STEPS // 2
    model:cycle(half)
    local file = os.tmpname()
    model:save(file)
    local copy, restored = model:copy(), talus.restore(file)
    os.remove(file)
    model:cycle(half)
    copy:cycle(half)
    restored:cycle(half)
    check.equal(copy:state_hash(), model:state_hash())
    check.equal(restored:state_hash(), model:state_hash())
    local on_four = run(one, {}, 4, dt)
    on_four:cycle(2 * half)
    check.equal(on_four:state_hash(), model:state_hash())
    local u, f = rock.picture({}, bolts, blocks)
    for _, form in ipairs(forms(seed)) do
        local other, its_bolts, its_blocks = run(one, form, 1, dt)
        check.equal(#its_blocks, #blocks)
        other:cycle(2 * half)
        local v, g = rock.picture(form, its_bolts, its_blocks)
        check_same(seed, form.name, v, g, u, f)
    end
    local again, its_bolts = run(one, {}, 1, dt)
    check_work(seed, again, its_bolts)
end

-- Held blocks go around a closed path, in legs of `steps` steps: two translations, a turn, and all of it back.
local function around(one, steps)
    local model, bolts, blocks = rock.build(one, {})
    model:joint("*", "coulomb", { kn = 1, ks = 1, friction = 0 }) -- the bolts alone act
    model:blocks():fix()
    model:timestep { dt = 1e-4 }
    local legs = { { 1, 0, 0 }, { 0, 1, 0 }, { -1, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } }
    for _, leg in ipairs(legs) do
        for k, of in ipairs(blocks) do
            local a, b = one.velocity[k % 16 + 1], one.velocity[(k + 7) % 16 + 1]
            model:blocks { id = of.block.id }:set {
                velocity = shapes.sum(shapes.sum({ 0, 0, 0 }, leg[1], a), leg[2], b),
                angular_velocity = shapes.sum({ 0, 0, 0 }, 0.1 * leg[3], one.spin[k % 16 + 1]) }
        end
        model:cycle(steps)
    end
    model:blocks():set { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } }
    model:cycle(1)
    return model, bolts
end

for seed = 1, check.cases(100) do
    local one = rock.draw(seed, true)
    local model, bolts = rock.build(one, {})
    model:cycle(1)
    local stored, most = {}, {}
    for k, bolt in ipairs(bolts) do
        stored[k] = bolt.stored
    end
    model, bolts = around(one, 20)
    for k, bolt in ipairs(bolts) do
        most[k] = bolt.axial
        check.holds(math.abs(bolt.stored - stored[k]) <= 1e-9 * (1 + stored[k]),
            ("seed %d: an elastic bolt is as it was after a closed path, and it holds %g J, not %g J; this"):format(seed, bolt.stored, stored[k]))
        check.equal(bolt.yielded or bolt.broken, false)
    end
    -- with limits the path turns work to heat, never heat to work
    one = rock.draw(seed)
    model, bolts = around(one, 20)
    local energy = model:energy()
    check.holds(energy.friction >= -1e-3 * math.max(1, energy.stored), ("seed %d: heat of %g J"):format(seed, energy.friction))
end

-- Openings along one elastic bolt: what two do together is the sum of what each does alone.
for seed = 1, check.cases(100) do
    local random = shapes.random(seed)
    local count = math.floor(random(3, 7.999))
    local places, ways = { 0 }, {}
    for k = 1, count do
        places[k + 1] = places[k] + random(0.3, 1.2)
        ways[k] = { random(-1e-4, 1e-4), random(-1e-4, 1e-4) }
    end
    local tilt = { random(0, 30), random(0, 360) }
    local bolt = { diameter = 0.025, grout_stiffness = 10 ^ random(8, 10), yield = 1e12, grout_strength = 1e12,
        plate_stiffness = 0, grouted_from = random(0, 0.4), spacing = random(0.05, 0.2) }
    local function tensions(first, second)
        local model = talus.model { gravity = { 0, 0, 0 } }
        model:generate("box", { min = { -1, -1, 0 }, max = { 1, 1, places[count + 1] }, density = 2500 })
        for k = 2, count do
            model:generate("joint", { joint = "J", dip = tilt[1], dip_direction = tilt[2], origin = { 0, 0, places[k] } })
        end
        model:joint("*", "coulomb", { kn = 1, ks = 1, friction = 0 })
        model:blocks():fix()
        bolt.from, bolt.to = { 0, 0, 0 }, { 0, 0, places[count + 1] }
        local e = model:element("bolt", bolt)[1]
        model:timestep { dt = 1e-3 }
        for k = 1, count do
            local v = 1e3 * (first * ways[k][1] + second * ways[k][2])
            model:blocks { containing = { 0, 0, 0.5 * (places[k] + places[k + 1]) } }:set { velocity = { 0, 0, v } }
        end
        model:cycle(2)
        local out = {}
        for i, node in ipairs(e.nodes) do
            out[i] = node.tension
        end
        return out, e.axial
    end
    local a, b, both, largest = tensions(1, 0), tensions(0, 1), tensions(1, 1)
    for i = 1, #both do
        check.near(both[i], a[i] + b[i], 1e-9 * largest + 1e-9)
    end
end
