-- resting.lua - blocks that touch by faces, edges and corners and come to rest under damping.
--
-- Each scene gives a model that moves at first: a pile of hulls of another stiffness than it was made with, a stack of ten
-- cubes each a millimetre off, an arch of 15 voussoirs, a beam that lies on two edges, a cube dropped into a groove.
--
-- A cube in a groove may slide: with a face flush on one side and an edge on the other it turns until a second face is
-- flush, near limit equilibrium all the way. Local damping does not take the vibration of a body whose velocity keeps its
-- sign, and the vibration brakes the way down by alpha times its mean force: at kn = 1e10 cubes 2 and 3 then slide by 1 mm/s
-- for 50 s until they fit. Combined damping is made for that, and all cubes are asked to rest under it.
local talus = require "talus"
local shapes = require "shapes"

local resting = {}

local DENSITY, FRICTION, ALPHA = 2500, 30, 0.8 -- kg/m3, degrees, share of the force
local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local LOOK = 500 -- steps between looks at the speed

-- A prism along y from a polygon of x and z.
local function prism(model, polygon, half, group)
    local vertices = {}
    for _, p in ipairs(polygon) do
        vertices[#vertices + 1] = { p[1], -half, p[2] }
        vertices[#vertices + 1] = { p[1], half, p[2] }
    end
    model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = group })
end

local function finish(model, kn, held)
    model:joint("*", "coulomb", { kn = kn, ks = kn / 2, friction = FRICTION })
    if not held then
        model:blocks { group = "base" }:fix()
    end
    model:damping("local", { alpha = ALPHA })
    return model
end

-- A file of tests/bench/pile.lua; what holds the pile is fixed in it.
function resting.pile(kn, path)
    local model = talus.model {}
    model:generate("blocks", { file = path or "tests/bench/pile_30.json" })
    return finish(model, kn, true)
end

function resting.stack(kn, seed)
    local random, model = shapes.random(seed), talus.model {}
    model:generate("box", { min = { -2, -2, -1 }, max = { 2, 2, 0 }, density = DENSITY, group = "base" })
    for k = 0, 9 do
        local x, y = random(-1e-3, 1e-3), random(-1e-3, 1e-3)
        model:generate("box", { min = { x, y, k }, max = { x + 1, y + 1, k + 1 }, density = DENSITY })
    end
    return finish(model, kn)
end

function resting.arch(kn)
    local model, voussoirs, inner, outer = talus.model {}, 15, 4.5, 5.5
    for k = 1, voussoirs do
        local polygon = {}
        for i = -1, 0 do
            local angle = math.pi * (k + i) / voussoirs
            for _, radius in ipairs { inner, outer } do
                polygon[#polygon + 1] = { radius * math.cos(angle), radius * math.sin(angle) }
            end
        end
        prism(model, polygon, 0.5, "arch")
    end
    for _, side in ipairs { { inner, outer }, { -outer, -inner } } do
        model:generate("box", { min = { side[1], -0.5, -1 }, max = { side[2], 0.5, 0 }, density = DENSITY,
            group = "base" })
    end
    return finish(model, kn)
end

function resting.beam(kn)
    local model = talus.model {}
    for _, x in ipairs { -2, 2.3 } do
        prism(model, { { x, 0 }, { x - 1, -1 }, { x + 1, -1 } }, 1, "base")
    end
    model:generate("box", { min = { -3, -0.25, 0 }, max = { 3, 0.25, 0.5 }, density = DENSITY })
    return finish(model, kn)
end

function resting.groove(kn, seed, damping)
    local random, model = shapes.random(seed), talus.model {}
    prism(model, { { 0, 0 }, { -3, 0 }, { -3, 3 } }, 3, "base")
    prism(model, { { 0, 0 }, { 3, 0 }, { 3, 3 } }, 3, "base")
    local cube = shapes.placed(shapes.box(1, 1, 1), shapes.attitude(random))
    local up = -math.huge
    for _, side in ipairs { 1, -1 } do -- it must clear both sides, z = x and z = -x
        up = math.max(up, shapes.farthest(cube, { side, 0, -1 }))
    end
    model:generate("polyhedron", { vertices = shapes.placed(cube, NONE, { 0, 0, up + 0.02 }), density = DENSITY })
    finish(model, kn):damping(damping, { alpha = ALPHA })
    return model
end

-- Unbalanced force ratio, largest speed of what rests, m/s, and steps to each at the most.
resting.RATIO, resting.REST, resting.MOST = 1e-6, 1e-10, 60000

local function groove(seed, damping)
    return function(kn) return resting.groove(kn, seed, damping) end
end

-- Scenes by name: how they are made, and the steps to the ratio that contacts by a common plane with minimum areas took at
-- kn = 1e9 and 1e10 (none: not in MOST; false: not asked for), on which nothing may be slower than by half. Those `among` others
-- take steps that hang on the least change of a path, so their sum counts.
resting.scenes = {
    { name = "pile of 30", make = resting.pile, steps = { nil, 41375 } },
    { name = "stack of 10", make = function(kn) return resting.stack(kn, 1) end, steps = { 8291, 8453 } },
    { name = "arch of 15", make = resting.arch, steps = { 2154, 1970 } },
    { name = "beam on two edges", make = resting.beam, steps = { 7003, 6997 } },
    { name = "cube in a groove, 1, local", make = groove(1, "local"), steps = { 11914, 15608 } },
    { name = "cube in a groove, 2, local", make = groove(2, "local"), steps = { nil, false } },
    { name = "cube in a groove, 3, local", make = groove(3, "local"), steps = { nil, false } },
    { name = "cube in a groove, 1, combined", among = "cubes in a groove, combined", make = groove(1, "combined"), steps = { 2522, 31244 } },
    { name = "cube in a groove, 2, combined", among = "cubes in a groove, combined", make = groove(2, "combined"), steps = { 5185, 18552 } },
    { name = "cube in a groove, 3, combined", among = "cubes in a groove, combined", make = groove(3, "combined"), steps = { 3281, 16081 } },
}

-- Runs to the ratio and on until nothing moves. Gives steps to the ratio and to rest (nil: not reached), the time to the
-- ratio, the largest speed and the balance of the ledger in the end.
function resting.run(model)
    local result, free = {}, model:blocks { fixed = false }
    local run = model:solve { ratio = resting.RATIO, max_cycles = resting.MOST }
    result.steps = run.reason == "ratio" and model.cycles or nil
    result.time = model.time
    local limit = model.cycles + resting.MOST
    repeat
        model:cycle(LOOK)
        result.speed = free:max "speed"
    until result.speed < resting.REST or model.cycles >= limit
    result.rest = result.speed < resting.REST and model.cycles or nil
    result.balance = math.abs(model:energy().balance)
    return result
end

return resting
