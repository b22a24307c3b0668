-- verdicts.lua - random models of which it is known what is to be said of them.
--
--     verdicts.stands(seed)   what is wrong with the verdict on a column or wall that only closes its joints, or nil
--     verdicts.slides(seed)   the same of a block on a plane that is steeper or less steep than its friction; and whether it slides
--     verdicts.cuts(seed)     what differs when a box of a leaning column is cut into parts and joined again, or nil; and whether it stands, so
--                             that it is compared
local shapes = require "shapes"
local talus = require "talus"

local verdicts = {}
local G = 9.81 -- m/s2
local RATIO, CYCLES = 1e-5, 100000
local STRAYS = math.cos(math.rad(10)) -- damping works along each axis for itself, so that a way bends by some degrees

local function joint(model, kn, friction)
    model:joint("*", "coulomb", { kn = kn, ks = kn, friction = friction })
end

-- Columns and walls of random sizes on joints of random stiffness.
local function wall(seed)
    local random = shapes.random(seed)
    local size, density = random(0.2, 3), random(1500, 3000)
    local model = talus.model { gravity = { 0, 0, -G } }
    local wide, high = seed % 3 + 1, 2 + seed % 7
    for i = 0, wide - 1 do
        for k = 0, high - 1 do
            local x, z = (i + 0.25 * (k % 2)) * size, k * size
            model:generate("box", { min = { x, 0, z }, max = { x + size, size, z + size }, density = density })
        end
    end
    model:generate("box", { min = { -size, -size, -size }, max = { (wide + 2) * size, 2 * size, 0 }, density = density, group = "floor" })
    model:blocks { group = "floor" }:fix()
    joint(model, density * G * high * 10 ^ random(3, 5), 40)
    model:damping "local"
    return model
end

function verdicts.stands(seed)
    local model = wall(seed)
    if model:verdict().standing ~= "unknown" then
        return "known before anything is known"
    elseif model:solve { ratio = RATIO, max_cycles = CYCLES }.reason ~= "ratio" then
        return "not at rest"
    end
    local verdict = model:verdict()
    if verdict.standing ~= "at rest" or not verdict.text:find("at rest", 1, true) then
        return verdict.text
    elseif verdict.moved ~= 0 or not verdict.text:find("no block has moved", 1, true) or verdict.displacement > verdict.closed then
        return ("displacement %g, closed %g: %s"):format(verdict.displacement, verdict.closed, verdict.text)
    elseif verdict.contacts ~= #model:contacts() then
        return "contacts"
    end
end

-- A flat box on a plane, in any attitude, with gravity at an angle to the plane that is some times the friction.
local function inclined(random)
    local dip, friction = random(15, 40), random(0, 1) < 0.5 and random(0.7, 0.92) or random(1.08, 1.5)
    local long, wide = random(0.5, 2), random(0.5, 2)
    local high, size = random(0.1, 0.5) * math.min(long, wide), 10 ^ random(-2, 2)
    local way, attitude = random(0, 2 * math.pi), shapes.attitude(random)
    local along = shapes.apply(attitude, { math.cos(way), math.sin(way), 0 })
    local down = shapes.apply(attitude, { 0, 0, -1 })
    local angle = math.rad(dip)
    local model = talus.model { gravity = shapes.sum(shapes.sum({ 0, 0, 0 }, G * math.cos(angle), down), G * math.sin(angle), along) }
    for _, box in ipairs { { shapes.box(40 * size, 40 * size, size), -0.5 * size }, { shapes.box(long * size, wide * size, high * size), 0.5 * high * size } } do
        model:generate("polyhedron", { vertices = shapes.placed(box[1], attitude, shapes.apply(attitude, { 0, 0, box[2] })), density = 2500 })
    end
    model:blocks { id = 1 }:fix()
    local kn = 2500 * G * high * size / (10 ^ random(-5, -3) * high * size)
    joint(model, kn, math.deg(math.atan(math.tan(angle) * friction)))
    model:damping "local"
    return model, friction < 1, along
end

function verdicts.slides(seed)
    local model, slides, along = inclined(shapes.random(seed))
    local reason = model:solve { ratio = RATIO, stop_at_failure = true, max_cycles = CYCLES }.reason
    local verdict = model:verdict()
    if reason ~= (slides and "failure" or "ratio") or verdict.standing ~= (slides and "failed" or "at rest") then
        return ("%s: %s"):format(reason, verdict.text), slides
    elseif verdict.moved ~= (slides and 1 or 0) then
        return verdict.text, slides
    elseif slides and (verdict.farthest ~= 2 or shapes.dot(verdict.direction, along) < STRAYS) then
        return "direction: " .. verdict.text, slides
    end
    return nil, slides
end

-- A column of boxes on a plane that is not steep, on joints of any stiffness; one of the boxes is cut by so many planes and joined again.
local function column(seed, planes)
    local random = shapes.random(seed)
    local tilt, boxes, z = math.rad(random(0, 15)), 2 + seed % 3, 0
    local model = talus.model { gravity = { G * math.sin(tilt), 0, -G * math.cos(tilt) } }
    local cut, middle = 1 + seed % boxes, nil
    for i = 1, boxes do
        local x, y, high = random(0, 0.2), random(0, 0.2), random(0.2, 0.6)
        model:generate("box", { min = { x, y, z }, max = { x + 1, y + 1, z + high }, density = 2600 })
        middle = i == cut and { x + 0.5, y + 0.5, z + 0.5 * high } or middle
        z = z + high
    end
    local way = random(0, 360)
    model:blocks():hide()
    model:blocks { id = cut, hidden = true }:show()
    for k = 1, planes do
        model:generate("joint", { joint = "cut", dip = 100 - 10 * k, dip_direction = (way + 100 * k) % 360, origin = middle })
    end
    model:blocks():join()
    model:blocks { hidden = true }:show()
    model:generate("box", { min = { -9, -9, -1 }, max = { 9, 9, 0 }, density = 2600, group = "floor" })
    model:blocks { group = "floor" }:fix()
    joint(model, 10 ^ random(6.5, 9), 45)
    model:damping "local"
    return model
end

function verdicts.cuts(seed)
    local whole
    for planes = 0, 2 do
        local model = column(seed, planes)
        if model:solve { ratio = RATIO, max_cycles = CYCLES }.reason ~= "ratio" then
            return "not at rest"
        end
        local verdict = model:verdict()
        whole = whole or verdict
        if whole.displacement > 0.1 then -- it has toppled or slid
            return nil, false
        end
        if verdict.moved ~= whole.moved or verdict.standing ~= whole.standing then
            return ("%s and, in parts, %s"):format(whole.text, verdict.text)
        end
        for _, name in ipairs { "displacement", "closed", "slip", "opening" } do
            if math.abs(verdict[name] - whole[name]) > 0.01 * whole.displacement then
                return ("%s: %g and, in parts, %g"):format(name, whole[name], verdict[name]), true
            end
        end
    end
    return nil, true
end

return verdicts
