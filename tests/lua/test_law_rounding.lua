-- What a law answers does not hang on roundings: a block that lands on a floor, or is made flush with it, slides and rocks moves the same whether its times are
-- in s or in ms, here and 1e5 m away, and as it stands and turned, though every number is rounded otherwise.
-- program only: the models are the same ones with a stock Lua.
local check = require "check"
local every_law = require "every_law"
local shapes = require "shapes"
local talus = require "talus"

local KN, PRESSURE = 1e8, 2e4
local LOOKS, STEPS = 40, 25
-- m: powers of the unit round products only; turned, the blocks' faces lie elsewhere by 1e-16 m, and at 1e5 m coordinates are rounded to
-- 1e-11 m. A block that lands and rocks makes that some thousand times more.
local SAME, MOVED = 1e-8, 1e-7
local CASES = {} -- tilt, rad; speeds along the floor and down, m/s; spin, rad/s
for k, tilt in ipairs { 0, 1e-3, 0.02, 0.2 } do
    CASES[k] = { tilt = tilt, speed = 0.8, fall = 0.4, spin = 0, points = "consistent" }
end
for _, spin in ipairs { -0.1, 0.02 } do
    for _, points in ipairs { "consistent", "corners" } do
        CASES[#CASES + 1] = { tilt = 0, speed = 3, fall = 0, spin = spin, points = points }
    end
end
local UPRIGHT = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local TURNED = shapes.turn({ 0.48, 0.6, 0.64 }, 1.1)

-- Places of the block as they would be in s, near the origin, upright. `unit`: of time, over a second.
local function run(number, case, unit, shift, turn)
    local joint = every_law(KN / unit ^ 2, PRESSURE / unit ^ 2)[number]
    if joint.law == "rate_state" then
        joint.params.velocity = 1e-6 / unit
    end
    local function vector(x, y, z)
        return shapes.apply(turn, { x / unit, y / unit, z / unit })
    end
    local model = talus.model { gravity = vector(0, 0, -10 / unit), contact_points = case.points }
    local function add(group, vertices, up, about)
        local placed = shapes.placed(vertices, about, { 0, 0, up })
        model:generate("polyhedron", { vertices = shapes.placed(placed, turn, shift), density = 2500, group = group })
    end
    add("floor", shapes.box(16, 16, 1), -0.5, UPRIGHT)
    model:blocks { group = "floor" }:fix()
    local cube, about = shapes.box(1, 1, 1), shapes.turn({ 0, 1, 0 }, case.tilt)
    add("block", cube, shapes.farthest(shapes.placed(cube, about), { 0, 0, -1 }), about)
    model:joint("*", joint.law, joint.params)
    model:timestep { fraction = 0.1 }
    local block = model:blocks { group = "block" }
    block:set { velocity = vector(0.5 * case.speed, 0.3 * case.speed, -case.fall), angular_velocity = vector(case.spin, -case.spin, 0) }
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
    for _, case in ipairs(CASES) do
        local plain = run(number, case, 1, { 0, 0, 0 }, UPRIGHT)
        local title = ("%s, %s, tilt %g, spin %g: "):format(joint.name, case.points, case.tilt, case.spin)
        agree(title .. "in ms", plain, run(number, case, 1000, { 0, 0, 0 }, UPRIGHT), SAME)
        agree(title .. "1e5 m away", plain, run(number, case, 1, { 1e5, 0, 0 }, UPRIGHT), MOVED)
        agree(title .. "turned", plain, run(number, case, 1, { 0, 0, 0 }, TURNED), MOVED)
    end
end
