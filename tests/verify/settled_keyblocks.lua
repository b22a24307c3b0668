-- Keyblocks of rock that has settled are those of rock as it was cut: blocks between random joints sink in, turn and slide by up to 1 % of
-- their size, whatever the stiffness, and have the modes, factors, directions and faces that they had. In every other model a new stage begins then.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local shapes = require "shapes"
local talus = require "talus"

local MODELS, KEPT = 300, 0.01
local QUERY = { friction = 50, cohesion = 1e3 }

-- Three joints through a cube of 4 m; one of its blocks is free.
local function build(random)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -2, -2, -2 }, max = { 2, 2, 2 }, density = 2500 })
    for k = 1, 3 do
        model:generate("joint", { joint = "J" .. k, dip = random(20, 90), dip_direction = random(0, 360),
            origin = { random(-0.8, 0.8), random(-0.8, 0.8), random(-0.8, 0.8) } })
    end
    model:blocks():fix()
    local free = model:blocks()[1 + math.floor(random(0, #model:blocks()))]
    model:blocks { id = free.id }:free()
    model:joint("*", "coulomb", { kn = 10 ^ random(6, 9), ks = 10 ^ random(6, 9), friction = 50 })
    model:damping "local"
    return model, free
end

-- How far a block has gone, and how far its corners have turned, of its size.
local function motion(block)
    local size, turn = block.volume ^ (1 / 3), block.rotation
    return shapes.length(block.displacement) / size, 2 * shapes.length { turn[2], turn[3], turn[4] }
end

local function settle(model, block)
    for _ = 1, 300 do
        model:cycle(2)
        local way, turn = motion(block)
        if way + turn > 0.5 * KEPT then
            return
        end
    end
end

local function difference(a, b)
    return a == b and 0 or math.abs(a / b - 1)
end

-- Whether two keyblocks move alike, on the same faces; and the largest difference of their numbers.
local function compare(before, after)
    local same = after.mode == before.mode and #after.faces == #before.faces and #after.pyramid == #before.pyramid
    local most = difference(after.safety, before.safety)
    for k, face in ipairs(before.faces) do
        local other = after.faces[k]
        same = same and other and other.joint == face.joint
        if same then
            most = math.max(most, difference(other.area, face.area), shapes.length(shapes.sum(other.normal, -1, face.normal)))
        end
    end
    if same and before.direction then
        most = math.max(most, shapes.length(shapes.sum(after.direction, -1, before.direction)))
    end
    return same, most
end

local keyblocks, moved, turned, lost, worst = 0, 0, 0, 0, 0
for seed = 1, MODELS do
    local model, free = build(shapes.random(seed))
    local before = model:keyblocks(QUERY)[1]
    settle(model, free)
    local way, turn = motion(free)
    if seed % 2 == 1 then
        model:stage "settled"
    end
    local after = model:keyblocks(QUERY)[1]
    local same, most = (before == nil) == (after == nil), 0
    if before and after then
        same, most = compare(before, after)
        keyblocks = keyblocks + 1
        moved, turned = moved + (way > 1e-4 and 1 or 0), turned + (turn > 1e-4 and 1 or 0)
    end
    lost, worst = lost + (same and 0 or 1), math.max(worst, most)
end

figures.case("D.keyblocks", "keyblocks of 300 models after settling, beside those before", "the same block, as it was cut")
figures.between("models with a keyblock", keyblocks, 0.2 * MODELS, MODELS)
figures.between("of these, moved by more than 1e-4 of their size", moved, 0.2 * MODELS, MODELS)
figures.between("of these, turned by more than 1e-4", turned, 0.2 * MODELS, MODELS)
figures.between("models in which a keyblock, its mode, joints or pyramid differ", lost, 0, 0)
figures.between("largest difference of factors, areas, normals and directions", worst, 0, 1e-2)
figures.finish()
