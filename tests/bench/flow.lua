-- Speed of flow in joints: a cube of blocks, and a slice one block thick, with some 100,000 wet joints each.
--
--     build/release/talus --quiet tests/bench/flow.lua [joints]
--
-- Steady flow from one side to the other, apertures of joints drawn between 1e-4 and 3e-4 m. Tells the time to find the
-- joints and where they meet, the time to solve the equations from nothing, and that of a step in which they are solved.
local talus = require "talus"

local wanted = tonumber(arg and arg[1]) or 100000

local function uniform(seed)
    return function()
        seed = (1103515245 * seed + 12345) % 2 ^ 31
        return seed / 2 ^ 31
    end
end

local function run(name, nx, ny, nz)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { nx, ny, nz }, density = 2500 })
    for k, n in ipairs { nx, ny, nz } do
        local dip, way = k == 3 and 0 or 90, k == 2 and 0 or 90
        for i = 1, n - 1 do
            model:generate("joint", { joint = "J", dip = dip, dip_direction = way,
                origin = { k == 1 and i or 0, k == 2 and i or 0, k == 3 and i or 0 } })
        end
    end
    model:blocks():fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    local draw = uniform(1)
    local function side(x)
        return { min = { x - 0.1, -1, -1 }, max = { x + 0.1, ny + 1, nz + 1 } }
    end
    local function flow(steady)
        return { aperture = 2e-4, steady = steady, every = 1,
            heads = { { inside = side(0), head = 10 }, { inside = side(nx), head = 0 } } }
    end
    local began = os.clock()
    model:water("flow", flow(false))
    local place = os.clock() - began
    began = os.clock()
    model:water("flow", flow(true))
    local both = os.clock() - began
    local joints = #model:flow().joints
    local other = flow(true)
    other.aperture = function() return 1e-4 + 2e-4 * draw() end
    began = os.clock()
    model:water("flow", other)
    local drawn = os.clock() - began
    model:cycle(1)
    began = os.clock()
    model:cycle(1)
    local step = os.clock() - began
    local r = model:flow()
    local out = r.heads[1].flow + r.heads[2].flow
    print(("%-6s %7d joints: found in %.2f s, solved in %.2f s, with drawn apertures %.2f s in all; a step %.3f s; in less "
        .. "out %.1e of the flow"):format(name, joints, place, both - place, drawn, step, out / r.heads[1].flow))
end

local n = math.floor((wanted / 3) ^ (1 / 3) + 1.5)
run("cube", n, n, n)
n = math.floor((wanted / 2) ^ 0.5 + 1)
run("slice", n, 1, n)
