-- A block that lands on its edge is cut while it presses and slides. What its parts then press on each other with, and how they go on, is
-- the same with times in ms, 1e5 m away and as the whole is turned: the new faces lie on each other but for roundings, which decide
-- nothing.
local check = require "check"
local every_law = require "every_law"
local shapes = require "shapes"
local talus = require "talus"

local KN, PRESSURE = 1e8, 5e4
local BEFORE, LOOKS = 20, { 1, 3, 8 } -- steps before the cut, and after it
local SAME, SAME_MOTION = 1e-4, 1e-5 -- of the force between the parts, and of their velocities, m/s
local UPRIGHT = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local QUARTER = { { 0, -1, 0 }, { 1, 0, 0 }, { 0, 0, 1 } } -- about z
local TILT = shapes.turn({ 0, 1, 0 }, -0.3)
local CUTS = { { 90, 60 }, { 70, 60 }, { 30, 200 }, { 0, 0 } } -- dip, dip direction

-- Force between the parts, N, and their velocities, m/s, in the axes of the model that is not turned. `unit`: of time, over a second.
local function run(number, cut, unit, shift, turned)
    local turn, back = UPRIGHT, UPRIGHT
    if turned then
        turn, back = QUARTER, { { 0, 1, 0 }, { -1, 0, 0 }, { 0, 0, 1 } }
    end
    local joint = every_law(KN / unit ^ 2, PRESSURE / unit ^ 2)[number]
    if joint.law == "rate_state" then
        joint.params.velocity = 1e-6 / unit
    end
    local function vector(x, y, z)
        return shapes.apply(turn, { x / unit, y / unit, z / unit })
    end
    local model = talus.model { gravity = vector(1 / unit, 0.5 / unit, -10 / unit) }
    local function add(group, vertices)
        model:generate("polyhedron", { vertices = shapes.placed(vertices, turn, shift), density = 2500, group = group })
    end
    add("floor", shapes.placed(shapes.box(16, 16, 1), UPRIGHT, { 0, 0, -0.5 }))
    model:blocks { group = "floor" }:fix()
    local cube = shapes.placed(shapes.box(1, 1, 1), TILT)
    add("block", shapes.placed(cube, UPRIGHT, { 0, 0, shapes.farthest(cube, { 0, 0, -1 }) }))
    model:joint("*", joint.law, joint.params)
    model:timestep { fraction = 0.2 }
    local block = model:blocks { group = "block" }
    block:set { velocity = vector(0.3, 0, -0.5) }
    model:cycle(BEFORE)
    model:blocks { group = "floor" }:hide()
    model:generate("joint", { joint = "cut", dip = cut[1], dip_direction = (cut[2] + (turned and 270 or 0)) % 360, origin = block[1].centroid })
    model:blocks { hidden = true }:show()
    local seen = {}
    for k, steps in ipairs(LOOKS) do
        model:cycle(steps - (LOOKS[k - 1] or 0))
        local parts, force = model:blocks { group = "block" }, 0
        for _, contact in ipairs(model:contacts { joint = "cut" }) do
            force = force + contact.normal_force * unit ^ 2
        end
        seen[k] = { force = force, velocities = {} }
        for i, part in ipairs(parts) do
            local v, w = part.velocity, part.angular_velocity
            for axis = 1, 3 do
                v[axis], w[axis] = v[axis] * unit, w[axis] * unit
            end
            seen[k].velocities[2 * i - 1], seen[k].velocities[2 * i] = shapes.apply(back, v), shapes.apply(back, w)
        end
    end
    return seen
end

local WEIGHT = 2500 * 10

local function agree(name, one, other)
    for k, steps in ipairs(LOOKS) do
        local title = ("%s, %d steps after the cut: "):format(name, steps)
        local off = math.abs(one[k].force - other[k].force)
        check.holds(off <= SAME * (math.abs(one[k].force) + 0.1 * WEIGHT), ("%sforces of %.9g and %.9g N"):format(title, one[k].force, other[k].force))
        local most = 0
        for i, v in ipairs(one[k].velocities) do
            most = math.max(most, shapes.length(shapes.sum(v, -1, other[k].velocities[i])))
        end
        check.holds(most <= SAME_MOTION, ("%svelocities differ by %.3g"):format(title, most))
    end
end

for number, joint in ipairs(check.some(every_law(KN, PRESSURE))) do
    for _, cut in ipairs(CUTS) do
        local plain = run(number, cut, 1, { 0, 0, 0 }, false)
        local title = ("%s, cut %g/%g"):format(joint.name, cut[1], cut[2])
        agree(title .. ", in ms", plain, run(number, cut, 1000, { 0, 0, 0 }, false))
        agree(title .. ", 1e5 m away", plain, run(number, cut, 1, { 1e5, -2e5, 5e4 }, false))
        agree(title .. ", turned", plain, run(number, cut, 1, { 0, 0, 0 }, true))
    end
end
