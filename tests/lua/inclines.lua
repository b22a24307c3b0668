-- inclines.lua - a slender block on an incline that is tilted in portions, on a joint of any law: up to which slope it stands.
--
-- Where it does not slide, statics of an elastic joint without tension gives the limit for all laws (no_tension.toppling). A law
-- may raise it by a bond; nothing else may change it, neither dilation nor cohesion nor friction. Each model is drawn from
-- its number and is the same for all laws.
local no_tension = require "no_tension"
local shapes = require "shapes"
local talus = require "talus"

local inclines = {}

local GRAVITY, DENSITY = 10, 2500
-- Slopes, of the limit: the block stands on the first ones, and topples on the last. The limit itself is sought no closer: near
-- it the block leans by what is a small share of a percent of the slope.
inclines.PORTIONS, inclines.BEYOND = { 0.5, 0.7, 0.8, 0.85, 0.9, 0.93, 0.96, 0.98 }, 1.03
-- Near the limit a block comes to rest slowly; that it still stands after so many steps is what is asked.
local AT_REST, MOST_CYCLES = 1e-5, 20000
local FALLEN = 0.15 -- rad

function inclines.draw(number)
    local random = shapes.random(1000 + number)
    local case = { number = number, width = 10 ^ random(-0.5, 0.5), attitude = shapes.attitude(random) }
    case.height, case.depth = case.width * random(2, 5), case.width * random(0.3, 3)
    case.kn = 10 ^ random(8, 11)
    case.pressure = DENSITY * GRAVITY * case.height
    case.limit = no_tension.toppling(case.width, case.height, case.pressure / case.kn)
    return case
end

local function build(case, joint)
    local model = talus.model { gravity = { 0, 0, 0 } }
    local far = 3 * case.height
    local function box(size, z)
        local vertices = {}
        for i, x in ipairs(shapes.box(table.unpack(size))) do
            vertices[i] = shapes.apply(case.attitude, shapes.sum(x, 1, { 0, 0, z }))
        end
        model:generate("polyhedron", { vertices = vertices, density = DENSITY })
    end
    box({ far, far, case.height }, -case.height / 2)
    box({ case.width, case.depth, case.height }, case.height / 2)
    model:blocks { id = 1 }:fix()
    model:joint("*", joint.law, joint.params)
    model:damping "local"
    return model, model:blocks { id = 2 }
end

local function tilt(block)
    local q = block.rotation
    return 2 * math.atan(math.sqrt(q[2] ^ 2 + q[3] ^ 2 + q[4] ^ 2), math.abs(q[1]))
end

local function incline(case, model, slope)
    local c = 1 / math.sqrt(1 + slope ^ 2)
    model.gravity = shapes.apply(case.attitude, { GRAVITY * slope * c, 0, -GRAVITY * c })
end

-- Gives a sentence on what is wrong, or nil.
function inclines.try(case, joint)
    local model, block = build(case, joint)
    local function run()
        return model:solve { ratio = AT_REST, max_cycles = MOST_CYCLES, every = 50, stop = function()
            return tilt(block[1]) > FALLEN
        end }.reason
    end
    for _, share in ipairs(inclines.PORTIONS) do
        incline(case, model, share * case.limit)
        if run() == "stop" then
            return ("on %g of the limit: it topples"):format(share)
        end
    end
    if joint.tension == 0 then
        -- A joint that stiffens lets its edge close less: it is between the one with straight springs and a rigid one.
        local limit = joint.curved and case.width / case.height or case.limit
        incline(case, model, inclines.BEYOND * limit)
        model:damping "none"
        local fallen = run() == "stop" or run() == "stop" or run() == "stop"
        if not fallen then
            return ("on %g of the limit: it does not topple"):format(inclines.BEYOND)
        end
    end
end

inclines.RELAXED = { 0.5, 0.8, 0.9, 0.96, inclines.BEYOND } -- of the limit

-- Gives a sentence on what relaxing tells wrong of a block to which gravity comes at once, or nil.
function inclines.relax(case, joint, shares)
    for _, share in ipairs(shares or inclines.RELAXED) do
        local limit = share > 1 and joint.curved and case.width / case.height or case.limit
        local model = build(case, joint)
        incline(case, model, share * limit)
        local run = model:relax { max_cycles = MOST_CYCLES, stop_at_failure = true }
        local wrong = share < 1 and "failure" or "rest"
        if run.reason == wrong and (share < 1 or joint.tension == 0) then
            return ("on %g of the limit: relax tells %s"):format(share, wrong)
        end
    end
end

-- A model that is not drawn.
function inclines.of(width, height, depth, kn)
    local case = { number = 0, width = width, height = height, depth = depth, kn = kn, attitude = shapes.turn({ 0, 0, 1 }, 0) }
    case.pressure = DENSITY * GRAVITY * height
    case.limit = no_tension.toppling(width, height, case.pressure / kn)
    return case
end

-- What tells a model in a message.
function inclines.title(case)
    return ("model %d (%.2f x %.2f x %.2f m, kn %.1e, limit %.4f)"):format(case.number, case.width, case.depth, case.height,
        case.kn, case.limit)
end

return inclines
