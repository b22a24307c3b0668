-- bolt_test.lua - talus.bolt_test{...}: one bolt pulled out of rock, or sheared by a joint, and its curve as lists.
--
-- Pull: the bolt is grouted in a held block; a stiff plate outside draws its mouth out. Shear: a joint crosses the bolt in
-- the middle, its normal at `angle` to the bolt; the far side slides so that the bolt is stretched. The sides neither turn
-- nor part, and bear no friction of their own.
local talus = require "talus"
local arguments = require "talus.arguments"

local fail = arguments.fail
local WHERE = "bolt_test"
local OWN = { angle = true, length = true, pull = true, shear = true, steps = true }
-- m, of the collar before the mouth, and N/m, of what draws it.
local COLLAR, STIFF = 0.1, 1e12
local DT = 1e-3

-- Two held boxes along x, the second moved; the bolt from the beginning of the first to the end of the second.
local function build(at, bolt, velocity)
    local model = talus.model { gravity = { 0, 0, 0 } }
    for k = 1, 2 do
        model:generate("box", { min = { at[k], -0.5, -0.5 }, max = { at[k + 1], 0.5, 0.5 }, density = 2500 })
    end
    model:blocks():fix()
    model:joint("*", "coulomb", { kn = 1, ks = 1, friction = 0 })
    bolt.from, bolt.to = { at[1], 0, 0 }, { at[3], 0, 0 }
    local good, element = pcall(model.element, model, "bolt", bolt)
    if not good then
        fail("%s: %s", WHERE, (tostring(element):gsub("^[^\n]-:%d+: ", "")))
    end
    element = element[1]
    model:timestep { dt = DT }
    model:blocks { containing = { 0.5 * (at[2] + at[3]), 0, 0 } }:set { velocity = velocity }
    return model, element
end

-- The node before the joint, and that behind it.
local function crossing(element)
    for i, node in ipairs(element.nodes) do
        if node.crosses == 1 then
            return node, element.nodes[i + 1]
        end
    end
end

local function pull(given, bolt, length, steps)
    bolt.plate_stiffness, bolt.plate_strength, bolt.pretension = STIFF, STIFF, 0
    for key, default in pairs { grouted_from = 0, grouted_to = 1 } do -- parts of the length behind the collar
        bolt[key] = (COLLAR + arguments.number(WHERE, given, key, default, 0, 1) * length) / (COLLAR + length)
    end
    local model, element = build({ -COLLAR, 0, length }, bolt, { given.pull / (steps * DT), 0, 0 })
    local curve = { displacement = { 0 }, force = { 0 } }
    model:cycle(1)
    for k = 2, steps + 1 do
        model:cycle(1)
        local before, behind = crossing(element)
        curve.displacement[k], curve.force[k] = behind.rock - behind.steel, before.tension
    end
    return curve, element
end

local function shear(given, bolt, length, steps)
    local angle = math.rad(arguments.number(WHERE, given, "angle", 0, 0, 89))
    local s, c = math.sin(angle), math.cos(angle)
    local v = given.shear / (steps * DT)
    local model, element = build({ -0.5 * length, 0, 0.5 * length }, bolt, { v * s, v * c, 0 })
    local curve = { displacement = { 0 }, axial = { 0 }, dowel = { 0 }, along = { 0 }, closing = { 0 } }
    model:cycle(1)
    for k = 2, steps + 1 do
        model:cycle(1)
        local fx, fy = 0, 0
        for _, node in ipairs(element.nodes) do
            if node.rest[1] > 0 or node.block.id == 2 then
                fx, fy = fx + node.force[1], fy + node.force[2]
            end
        end
        curve.displacement[k], curve.axial[k], curve.dowel[k] = (k - 1) / steps * given.shear, element.axial, element.shear
        curve.along[k], curve.closing[k] = -(fx * s + fy * c), -(fx * c - fy * s)
    end
    return curve, element
end

local function run(given)
    arguments.table(WHERE, given, "a table")
    if (given.pull == nil) == (given.shear == nil) then
        fail("%s: give pull or shear, m: how far the mouth is drawn, or the joint slides", WHERE)
    end
    local length = arguments.number(WHERE, given, "length", nil, 0.01, 1000)
    local steps = arguments.number(WHERE, given, "steps", 200, 1, 1e6)
    if steps % 1 ~= 0 then
        fail("%s: steps = %s must be a whole number", WHERE, arguments.decimal("%.10g", steps))
    end
    arguments.number(WHERE, given, given.pull and "pull" or "shear", nil, 1e-9, 100)
    local bolt = {}
    for key, value in pairs(given) do
        if not OWN[key] then
            bolt[key] = value
        end
    end
    local curve, element = (given.pull and pull or shear)(given, bolt, length, steps)
    curve.yielded, curve.broken = element.yielded, element.broken
    return curve
end

return arguments.call(run)
