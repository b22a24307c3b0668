-- pile.lua - irregular blocks dropped into a box and measured at rest.
--
--     talus tests/bench/pile.lua blocks=500 threads=1,2 reps=5 [write=pile.json]
--
-- A block is the hull of 12 to 20 points on an ellipsoid with half axes of 0.4 to 0.5 m, so every point is a
-- corner. They start apart, turned at random, in layers over the box, and fall. The pile when it is down is written
-- to `write`, and taken from there when the file exists. Forces of a model made from it start from the overlaps, and it
-- comes to rest before it is measured. With reps=0 nothing is measured.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"

local pile = {}

local KN, KS, DENSITY = 1e9, 5e8, 2600 -- Pa/m, kg/m3
local FRICTION = math.deg(0.6)
local SEED = 7
local APART = 1.05                     -- between centres at the start, m: blocks do not touch
local FULL = 1.2                       -- blocks a cubic metre of the box, were it filled to its width
-- A fixed step, as long as is stable about: by the rule, whose default is half of that, the pile takes 2.6 times as many steps.
local DT = 5e-4                        -- s
local DRAG, DOWN = 4, 0.1              -- 1/s: blocks sink at 2.5 m/s; mean speed when they are down, m/s
local DAMPING = 0.7                    -- share of the force, from then on
local STILL = 5e-3                     -- mean speed of blocks of which hardly one falls on, m/s
local LOOK = 250                       -- steps between looks at it
local RATIO, PATIENCE = 1e-5, 40000    -- unbalanced force ratio of a pile at rest; steps

local function gauss()
    return math.sqrt(-2 * math.log(1 - math.random())) * math.cos(2 * math.pi * math.random())
end

local function direction()
    local x, y, z = gauss(), gauss(), gauss()
    local length = math.sqrt(x * x + y * y + z * z)
    return { x / length, y / length, z / length }
end

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

-- Three axes at right angles, turned at random.
local function axes()
    local e, other = direction(), direction()
    local n = cross(e, other)
    local length = math.sqrt(n[1] ^ 2 + n[2] ^ 2 + n[3] ^ 2)
    n = { n[1] / length, n[2] / length, n[3] / length }
    return { e, n, cross(e, n) }
end

-- Corners of a block about a centre.
local function corners(centre)
    local half, turned, points = {}, axes(), {}
    for k = 1, 3 do
        half[k] = 0.4 + 0.1 * math.random()
    end
    for i = 1, math.random(12, 20) do
        local d = direction()
        points[i] = {}
        for k = 1, 3 do
            points[i][k] = centre[k] + half[1] * d[1] * turned[1][k] + half[2] * d[2] * turned[2][k]
                + half[3] * d[3] * turned[3][k]
        end
    end
    return points
end

function pile.laws(model)
    model:joint("*", "coulomb", { kn = KN, ks = KS, friction = FRICTION })
    model:timestep { dt = DT }
    model:damping("local", { alpha = DAMPING })
end

-- The blocks before they fall.
function pile.hang(count, threads)
    math.randomseed(SEED)
    local model = talus.model { threads = threads }
    local side = math.max(2, math.floor((count / FULL) ^ (1 / 3) + 0.5))
    local width = side * APART
    local layers = math.ceil(count / side ^ 2)
    bench.boxes(model, bench.plates({ 0, 0, 0 }, { width, width, (layers + 1) * APART }), DENSITY)
    for i = 0, count - 1 do
        local x, y, z = i % side, i // side % side, i // (side * side)
        model:generate("polyhedron", { density = DENSITY, group = "pile",
            vertices = corners { (x + 0.5) * APART, (y + 0.5) * APART, (z + 0.6) * APART } })
    end
    return model
end

-- Drops the blocks and waits until they lie still.
function pile.drop(count, threads)
    local model = pile.hang(count, threads)
    pile.laws(model)
    local pieces = model:blocks { group = "pile" }
    local function run_until(speed)
        repeat
            model:cycle(LOOK)
            assert(model.cycles < PATIENCE, "the pile does not come to rest")
        until model.cycles > LOOK and pieces:sum "speed" / count < speed
    end
    model:damping("viscous", { alpha = DRAG })
    run_until(DOWN)
    model:damping("local", { alpha = DAMPING })
    run_until(STILL)
    assert(pieces:bounds().min[3] > -0.1, "a block has left the box")
    return model
end

function pile.load(path, threads)
    local model = talus.model { threads = threads }
    model:generate("blocks", { file = path })
    pile.laws(model)
    return model
end

function pile.main()
    local given = bench.arguments { blocks = 500, threads = "1", reps = 5, write = "" }
    local path = given.write ~= "" and given.write or os.tmpname()
    local there = given.write ~= "" and io.open(path)
    if there then
        there:close()
    else
        pile.drop(given.blocks, 1):write_blocks(path)
    end
    for _, threads in ipairs(given.reps > 0 and bench.list(given.threads) or {}) do
        local model = pile.load(path, threads)
        local run = model:solve { ratio = RATIO, max_cycles = PATIENCE }
        assert(run.reason == "ratio", "the pile does not come to rest")
        bench.measure_both(model, { workload = "pile", size = given.blocks }, { reps = given.reps })
    end
    if given.write == "" then
        os.remove(path)
    end
end

-- A script that says require "pile" wants the functions only.
if ... ~= "pile" then
    pile.main()
end
return pile
