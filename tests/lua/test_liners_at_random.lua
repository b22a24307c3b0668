-- program only
-- Liners at random on jointed rock that moves: forces and moments add up to zero, work is stored or turned to heat, and
-- nothing hangs on place, attitude, unit, threads or files.
local talus = require "talus"
local check = require "check"
local shapes = require "shapes"
local rock = require "random_bolts"

local MODELS, STEPS = check.cases(120), 40
local SUMS = 1e-11   -- of forces over their sizes: rounding of a solution
local ENERGY = 1e-5  -- error of the work on a liner over all that has been done
local LITTLE = 1e-6  -- J, of liners that do nothing but for rounding
local SAME = 1e-7    -- m, of motion

local function draw(seed)
    local one, random = rock.draw(seed), shapes.random(seed + 900)
    one.bolts = {}
    local function scaled(low, high)
        return low * (high / low) ^ random(0, 1)
    end
    for k = 1, 16 do -- a liner bears little: of slow blocks
        one.velocity[k], one.spin[k] = shapes.sum({ 0, 0, 0 }, 0.02, one.velocity[k]), shapes.sum({ 0, 0, 0 }, 0.02, one.spin[k])
    end
    local weak = random(0, 1) < 0.6
    one.liner = { facing = shapes.direction(random), within = random(56, 85), thickness = scaled(0.03, 0.3), young = scaled(1e9, 4e10),
        poisson = random(0, 0.4), bond_stiffness = scaled(1e8, 1e10), bond_shear_stiffness = scaled(1e8, 1e10),
        bond_strength = weak and scaled(1e3, 1e6) or 1e10, tension = weak and scaled(1e4, 1e7) or 1e10, spacing = random(0.7, 1.3) }
    one.weak = weak
    return one
end

-- Powers of the unit of length in what is not a length: forces stay N.
local POWER = { thickness = 1, spacing = 1, young = -2, tension = -2, bond_strength = -2, bond_stiffness = -3, bond_shear_stiffness = -3 }

local function run(one, form, threads, dt)
    local model, _, blocks = rock.build(one, form, threads)
    local liner = {}
    for name, value in pairs(one.liner) do
        liner[name] = name == "facing" and shapes.apply(form.matrix or { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, value)
            or value * (form.unit or 1) ^ (POWER[name] or 0)
    end
    local made = model:element("liner", liner)
    rock.start(one, form, model, blocks, dt)
    return model, made, blocks
end

local function sums_of(element, at)
    local force, moment, size, far = { 0, 0, 0 }, { 0, 0, 0 }, 1e-9, 0
    for i, node in ipairs(element.nodes) do
        force = shapes.sum(force, 1, node.force)
        moment = shapes.sum(moment, 1, shapes.cross(at[i], node.force))
        size, far = size + shapes.length(node.force), math.max(far, shapes.length(at[i]))
    end
    return shapes.length(force) / size, shapes.length(moment) / size / far
end

-- Work on each liner that is neither stored nor turned to heat, and what has been done, J.
local function balance(model, made, steps)
    local error, done, stored, forces, last = {}, {}, {}, {}, {}
    for _ = 1, steps do
        local at = {}
        for k, e in ipairs(made) do
            at[k], forces[k] = rock.places(e), {}
            for i, node in ipairs(e.nodes) do
                forces[k][i] = node.force
            end
            stored[k] = e.stored
        end
        model:cycle(1)
        for k, e in ipairs(made) do
            local f, m = sums_of(e, at[k])
            check.near(f, 0, SUMS)
            check.near(m, 0, SUMS)
            local work = 0
            for i, node in ipairs(e.nodes) do
                local way = last[k] and shapes.sum(at[k][i], -1, last[k][i]) or { 0, 0, 0 }
                work = work - 0.5 * shapes.dot(shapes.sum(node.force, 1, forces[k][i]), way)
            end
            error[k] = (error[k] or 0) + work - (e.stored - stored[k]) - e.lost
            done[k] = math.max((done[k] or LITTLE) + math.abs(work), e.stored)
            last[k] = at[k]
        end
    end
    return error, done
end

-- What begins or ends to press within a step leaves an error of the second order in the step: it is nothing in a quarter of it.
local function check_work(seed, one, dt)
    local model, made = run(one, {}, 1, dt)
    local error, done = balance(model, made, STEPS)
    local finer
    for k = 1, #made do
        if math.abs(error[k]) > ENERGY * done[k] and not finer then
            model, made = run(one, {}, 1, dt / 4)
            finer = balance(model, made, 4 * STEPS)
        end
        local missing = finer and finer[k] or error[k]
        check.holds(math.abs(missing) <= ENERGY * done[k],
            ("seed %d, liner %d: %g J of %g J are missing, which"):format(seed, k, missing, done[k]))
    end
end

local failed, lined = 0, 0
for seed = 1, MODELS do
    local one, random = draw(seed), shapes.random(seed + 5000)
    local model, made, blocks = run(one, {}, 1)
    local dt = math.min(0.5 * model:timestep().dt, 1e-4)
    model:timestep { dt = dt }
    model:cycle(STEPS)
    local file = os.tmpname()
    model:save(file)
    local copy, restored = model:copy(), talus.restore(file)
    os.remove(file)
    for _, other in ipairs { model, copy, restored } do
        other:cycle(STEPS)
    end
    check.equal(copy:state_hash(), model:state_hash())
    check.equal(restored:state_hash(), model:state_hash())
    local on_four = run(one, {}, 4, dt)
    on_four:cycle(2 * STEPS)
    check.equal(on_four:state_hash(), model:state_hash())
    for _, e in ipairs(made) do
        lined, failed = lined + 1, failed + (e.yielded and 1 or 0)
    end
    if not one.weak then
        local forms = { { name = "turned", matrix = shapes.attitude(random) }, { name = "in units of 4 m", unit = 0.25 },
            { name = "moved by 1 km", shift = { 600, -700, 300 } } }
        local form = forms[seed % 3 + 1]
        local other, _, its_blocks = run(one, form, 1, dt)
        other:cycle(2 * STEPS)
        local u, v = rock.picture({}, {}, blocks), rock.picture(form, {}, its_blocks)
        for i, x in ipairs(u) do
            check.holds(math.abs(x - v[i]) <= SAME, ("seed %d, %s: %g m beside %g m, which"):format(seed, form.name, v[i], x))
        end
    end
    check_work(seed, one, dt)
end
check.holds(lined >= MODELS and failed > 0.2 * lined, ("of %d liners %d have failed, which"):format(lined, failed))
