-- Blocks that land, slide and turn on joints of every law and are cut while they do: saved some steps later, they are restored with the
-- same hash and go on with the same bits. The parts' faces and what they press with come from those of the whole.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local every_law = require "every_law"
local shapes = require "shapes"
local talus = require "talus"

local MODELS, STEPS = 240, 200
local KN, PRESSURE = 1e8, 2e4
local FILE = os.getenv "TALUS_TEST_TMP" .. "/save_after_cuts.talus"
local joints = every_law(KN, PRESSURE)

-- Deepest corner just at the floor, so that it presses from the first steps on. Most are boxes, whose halves are as large as each other
-- but for roundings.
local function add_block(model, random, number)
    local vertices = random(0, 1) < 0.9 and shapes.box(random(0.6, 1.2), random(0.6, 1.2), random(0.6, 1.2))
        or shapes.hull(random, 10, random(0.5, 0.8))
    local turn = random(0, 1) < 0.3 and shapes.turn({ 0, 1, 0 }, random(0, 0.02)) or shapes.attitude(random)
    vertices = shapes.placed(vertices, turn)
    local up = 1e-4 + shapes.farthest(vertices, { 0, 0, -1 })
    local origin = { 3 * number, 0, up }
    model:generate("polyhedron", { vertices = shapes.placed(vertices, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, origin), density = 2500 })
    model:blocks { fixed = false }:set { velocity = { random(-1, 1), random(-1, 1), random(-0.5, 0) },
        angular_velocity = { random(-1, 1), random(-1, 1), random(-1, 1) } }
end

local function build(number, random)
    local model = talus.model { gravity = { 0, 0, -10 } }
    local joint = joints[number % #joints + 1]
    model:generate("box", { min = { -8, -8, -1 }, max = { 8, 8, 0 }, density = 2500, group = "floor" })
    model:blocks { group = "floor" }:fix()
    for k = 0, 1 do
        add_block(model, random, k)
    end
    model:joint("*", joint.law, joint.params)
    if random(0, 1) < 0.5 then
        model:damping "local"
    end
    return model
end

local function cut(model, random, name)
    local dip = random(0, 1) < 0.5 and 90 or random(0, 90)
    local blocks = model:blocks { fixed = false }
    local origin = blocks[1 + math.floor(random(0, #blocks))].centroid
    model:blocks { group = "floor" }:hide()
    model:generate("joint", { joint = name, dip = dip, dip_direction = random(0, 360), origin = origin })
    model:blocks { hidden = true }:show()
end

local parts = 0
for number = 1, check.cases(MODELS) do
    local random = shapes.random(number)
    local model = build(number, random)
    for k = 1, 2 do
        model:cycle(math.floor(random(5, 60)))
        cut(model, random, "cut" .. k)
    end
    parts = parts + #model:blocks() - 3
    model:cycle(math.floor(random(0, 20)))
    model:save(FILE)
    local restored = talus.restore(FILE)
    local name = ("model %d, %s"):format(number, joints[number % #joints + 1].name)
    check.holds(restored:state_hash() == model:state_hash(), name .. ": hash of what is restored")
    for _, one in ipairs { model, restored } do
        one:cycle(STEPS)
    end
    check.holds(restored:state_hash() == model:state_hash(), name .. ": hash after " .. STEPS .. " steps")
end
os.remove(FILE)
check.holds(parts >= check.cases(MODELS), "blocks were cut")
