-- What a law answers does not hang on roundings: a block that lands on a floor, slides and rocks moves the same whether its times are
-- in s or in ms, here and 1e5 m away, and as it stands and turned, though every number is rounded otherwise.
local check = require "check"
local every_law = require "every_law"
local shapes = require "shapes"
local talus = require "talus"

local KN, PRESSURE, SPEED = 1e8, 2e4, 0.8
local LOOKS, STEPS = 40, 25
-- m: powers of the unit round products only; turned, the blocks' faces lie elsewhere by 1e-16 m, and at 1e5 m coordinates are rounded to
-- 1e-11 m. A block that lands and rocks makes that some thousand times more.
local SAME, MOVED = 1e-10, 1e-7
local TILTS = { 0, 1e-3, 0.02, 0.2 }
local UPRIGHT = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local TURNED = shapes.turn({ 0.48, 0.6, 0.64 }, 1.1)

-- Places of the block as they would be in s, near the origin, upright. `unit`: of time, over a second.
local function run(number, tilt, unit, shift, turn)
    local joint = every_law(KN / unit ^ 2, PRESSURE / unit ^ 2)[number]
    if joint.law == "rate_state" then
        joint.params.velocity = 1e-6 / unit
    end
    local function vector(x, y, z)
        return shapes.apply(turn, { x / unit, y / unit, z / unit })
    end
    local model = talus.model { gravity = vector(0, 0, -10 / unit) }
    local function add(group, vertices, up, about)
        local placed = shapes.placed(vertices, about, { 0, 0, up })
        model:generate("polyhedron", { vertices = shapes.placed(placed, turn, shift), density = 2500, group = group })
    end
    add("floor", shapes.box(16, 16, 1), -0.5, UPRIGHT)
    model:blocks { group = "floor" }:fix()
    local cube, about = shapes.box(1, 1, 1), shapes.turn({ 0, 1, 0 }, tilt)
    add("block", cube, shapes.farthest(shapes.placed(cube, about), { 0, 0, -1 }), about)
    model:joint("*", joint.law, joint.params)
    model:timestep { fraction = 0.1 }
    local block = model:blocks { group = "block" }
    block:set { velocity = vector(0.5 * SPEED, 0.3 * SPEED, -0.5 * SPEED) }
    local back, places = { {}, {}, {} }, {}
    for i = 1, 3 do
        for k = 1, 3 do
            back[i][k] = turn[k][i]
        end
    end
    for look = 1, LOOKS do
        model:cycle(STEPS)
        places[look] = shapes.apply(back, block[1].displacement)
    end
    return places
end

local function agree(name, one, other, bound)
    local most = 0
    for look, place in ipairs(one) do
        most = math.max(most, shapes.length(shapes.sum(place, -1, other[look])))
    end
    check.holds(most <= bound, ("%s: places differ by %.3g m"):format(name, most))
end

for number, joint in ipairs(check.some(every_law(KN, PRESSURE))) do
    for _, tilt in ipairs(TILTS) do
        local plain = run(number, tilt, 1, { 0, 0, 0 }, UPRIGHT)
        local title = ("%s, tilt %g: "):format(joint.name, tilt)
        agree(title .. "in ms", plain, run(number, tilt, 1000, { 0, 0, 0 }, UPRIGHT), SAME)
        agree(title .. "1e5 m away", plain, run(number, tilt, 1, { 1e5, 0, 0 }, UPRIGHT), MOVED)
        agree(title .. "turned", plain, run(number, tilt, 1, { 0, 0, 0 }, TURNED), MOVED)
    end
end
