-- Small vibrations: masses on springs, a column of blocks in shear, and the frequencies of a wall measured in a run.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference_earthquakes").site

local EXACT, LATTICE, MEASURED = 1e-6, 1e-9, 2e-3 -- of the first one 1e-7 is the overlap

local function settle(model)
    model:damping "local"
    model:solve { ratio = 1e-8 }
    model:damping "none"
end

figures.case("DYN.modes.cube", "Cube of 1 m on a joint: motion across the joint and about its normal", "springs of a square")
do
    local density, k = 2000, 1e9
    local model = talus.model { gravity = { 0, 0, -1 } }
    model:generate("box", { min = { -2, -2, -1 }, max = { 3, 3, 0 }, density = density, group = "base" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = density })
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = k, ks = k, friction = 80 })
    settle(model)
    local modes = model:modes { count = 6 }
    -- Shear and rocking: k (u - h r) and, about the centroid, k h (u - h r) h with k (1/12) of tilting.
    -- The joint lies in the middle of the overlap.
    local m, i, h = density, density / 6, 0.5 - density / k / 2
    local a, b, c = k / m, -k * h / math.sqrt(m * i), (k * h * h + k / 12) / i
    local mean, half = (a + c) / 2, math.sqrt(((a - c) / 2) ^ 2 + b * b)
    local expected = { mean - half, mean - half, k / m, k / 6 / i, mean + half, mean + half }
    table.sort(expected)
    for n, square in ipairs(expected) do
        figures.relative("frequency " .. n .. ", Hz", modes[n].frequency, math.sqrt(square) / (2 * math.pi), EXACT)
    end
    local sum = 0
    for n = 1, 6 do
        sum = sum + modes[n].mass[1]
    end
    figures.relative("shares of the mass along x, summed", sum, 1, EXACT)
end

figures.case("DYN.site.frequency", "Column of 20 blocks that only shear", reference.source)
do
    local model = talus.model { gravity = { 0, 0, -10 } }
    local n, h = reference.blocks, reference.height
    model:generate("box", { min = { -1, -1, -1 }, max = { 2, 2, 0 }, density = reference.density, group = "base" })
    for i = 1, n do
        model:generate("box", { min = { 0, 0, (i - 1) * h }, max = { 1, 1, i * h }, density = reference.density,
            group = "column" })
    end
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = reference.ks, friction = 80 })
    settle(model)
    model:blocks { group = "column" }:fix { y = true, z = true, rotation = true }
    model:cycle(1)
    local modes = model:modes { count = 3 }
    figures.relative("first frequency, Hz", modes[1].frequency, reference.f1, LATTICE)
    figures.relative("second frequency, Hz", modes[2].frequency, reference.f2, LATTICE)
end

figures.case("DYN.modes.wall", "Wall of bricks in running bond: its first vibration, and the same in a run",
    "marching in time")
do
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 3, 2, 0 }, density = 2000, group = "base" })
    for course = 0, 4 do
        local x = course % 2 == 0 and 0 or -0.2
        for brick = 0, course % 2 == 0 and 3 or 4 do
            local low, high = math.max(0, x + 0.4 * brick), math.min(1.6, x + 0.4 * brick + 0.4)
            model:generate("box", { min = { low, 0, 0.2 * course }, max = { high, 0.3, 0.2 * course + 0.2 },
                density = 2000, group = "wall" })
        end
    end
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = 5e9, ks = 2e9, friction = 60 })
    settle(model)
    local first = model:modes { count = 1 }[1]
    local wall = model:blocks { group = "wall" }
    wall:reset_displacement()
    local top, most = nil, 0
    for _, block in ipairs(wall) do
        local shift, turn = first.shift[block.id], first.turn[block.id]
        local by = 1e-7 * 2 * math.pi * first.frequency -- m: far less than the wall has sunk in
        model:blocks { id = block.id }:set { velocity = { by * shift[1], by * shift[2], by * shift[3] },
            angular_velocity = { by * turn[1], by * turn[2], by * turn[3] } }
        if math.abs(shift[2]) > most then
            top, most = block, math.abs(shift[2])
        end
    end
    local last, crossings, begin, finish = 0, -1, nil, nil
    while crossings < 20 do
        model:cycle(1)
        local u = top.displacement[2]
        if last * u < 0 then
            crossings = crossings + 1
            finish = model.time - model.dt * u / (u - last)
            begin = begin or finish
        end
        last = u
    end
    figures.relative("first frequency, Hz", first.frequency, crossings / 2 / (finish - begin), MEASURED)
end
figures.finish()
