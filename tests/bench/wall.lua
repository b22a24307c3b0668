-- wall.lua - a wall of n x n x n unit cubes, face to face under gravity, on a fixed base plate.
--
--     talus tests/bench/wall.lua layout=lattice n=10 threads=1,2 reps=5
--     talus tests/bench/wall.lua layout=lattice n=10 write=wall.json
--
-- layout=lattice: cube over cube, between four fixed side plates, with a sideways overlap of 1e-5 m: so
-- little that neighbours over an edge, up to 46 layers down, have nothing in common that is not left alone.
-- layout=bond: every second layer moved by a quarter of a cube both ways, 3 mm apart sideways, no
-- side plates. Each layer overlaps the one below by what its weight needs, so the wall stands in
-- equilibrium from the start. Contacts that carry are contacts of faces: 425, 3200 and 24800 for n = 5, 10 and 20 in
-- lattice, 3349 for n = 10 in bond. Neighbours over an edge or a corner have none.
package.path = (arg[0]:match "^(.*)/" or ".") .. "/?.lua;" .. package.path
local talus = require "talus"
local bench = require "bench"

local wall = {}

local OVERLAP, GAP, SHIFT = 1e-5, 3e-3, 0.25   -- m
local KN, KS = 1e9, 5e8                        -- Pa/m
local DENSITY, GRAVITY = 2600, 9.81            -- kg/m3, m/s2
local FRICTION = math.deg(0.6)
local DAMPING, DT = 0.2, 2e-4                  -- share of the force; s
-- In bond blocks stand on quarters and tilt until their contacts carry evenly: to what unbalanced force ratio they settle
-- first, in how many steps at the most, with what share of the force.
local RATIO, PATIENCE, SETTLING = 1e-6, 10000, 0.8

local COUNTED = 20 -- up to this n the face contacts are counted: in Lua, one by one

-- Brings the blocks of bond to rest.
function wall.settle(model)
    model:damping("local", { alpha = SETTLING })
    local run = model:solve { ratio = RATIO, max_cycles = PATIENCE }
    assert(run.reason == "ratio", string.format("the unbalanced force ratio is still %g", run.ratio))
    model:damping("local", { alpha = DAMPING })
end

-- Number of face contacts: on the base, between layers, sideways, at the side plates.
function wall.faces(layout, n)
    if layout == "lattice" then
        return n * n + n * n * (n - 1) + 2 * n * n * (n - 1) + 4 * n * n
    end
    return n * n + (n - 1) * (2 * n - 1) * (2 * n - 1)
end

function wall.boxes(layout, n)
    local lattice = layout == "lattice"
    local overlap = lattice and OVERLAP or -GAP
    local pitch, boxes, z = 1 - overlap, {}, 0
    for k = 0, n - 1 do
        z = z - DENSITY * GRAVITY * (n - k) / KN
        local shift = not lattice and k % 2 == 1 and SHIFT or 0
        for j = 0, n - 1 do
            for i = 0, n - 1 do
                local x, y = (i + shift) * pitch - overlap / 2, (j + shift) * pitch - overlap / 2
                boxes[#boxes + 1] = { min = { x, y, z }, max = { x + 1, y + 1, z + 1 } }
            end
        end
        z = z + 1
    end
    -- The outer faces lie at -overlap/2 and n pitch + overlap/2; plates overlap them as well.
    local side = n * pitch
    if lattice then
        local inset = OVERLAP / 2
        local plates = bench.plates({ inset, inset, 0 }, { side - inset, side - inset, n })
        table.move(plates, 1, #plates, #boxes + 1, boxes)
    else
        boxes[#boxes + 1] = { min = { -1, -1, -1 }, max = { side + 1, side + 1, 0 }, fixed = true }
    end
    return boxes
end

function wall.build(layout, n, threads)
    local model = talus.model { threads = threads, gravity = { 0, 0, -GRAVITY } }
    bench.boxes(model, wall.boxes(layout, n), DENSITY)
    model:joint("*", "coulomb", { kn = KN, ks = KS, friction = FRICTION })
    model:damping("local", { alpha = DAMPING })
    model:timestep { dt = DT }
    return model
end

-- The contacts that carry, counted.
function wall.count_faces(model)
    return #model:contacts { where = function(contact)
        return contact.normal_force > 0
    end }
end

function wall.main()
    local given = bench.arguments { layout = "lattice", n = "10", threads = "1", reps = 5, write = "" }
    if given.write ~= "" then
        wall.build(given.layout, tonumber(given.n), 1):write_blocks(given.write)
        return
    end
    for _, n in ipairs(bench.list(given.n)) do
        for _, threads in ipairs(bench.list(given.threads)) do
            local model = wall.build(given.layout, n, threads)
            model:cycle(n <= COUNTED and 50 or 5)
            if given.layout == "bond" then
                wall.settle(model)
            end
            local faces = wall.faces(given.layout, n)
            local found = n <= COUNTED and wall.count_faces(model) or faces
            assert(found == faces, string.format("%d face contacts carry, not %d", found, faces))
            bench.measure_both(model, { workload = given.layout == "bond" and "bond" or "wall",
                size = n * n * n, face_contacts = faces }, { reps = given.reps, warm = n <= COUNTED and 5 or 1 })
        end
    end
end

-- A script that says require "wall" wants the functions only.
if ... ~= "wall" then
    wall.main()
end
return wall
