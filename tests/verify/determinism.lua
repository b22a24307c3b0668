-- The same script gives the same bits: twice, and on one, two and three threads.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"

-- A box of jointed rock that falls apart on a fixed floor.
local function run(threads, seed, reuse)
    local model = talus.model { gravity = { 1, 0.5, -10 }, threads = threads, seed = seed,
        reuse_geometry = reuse }
    model:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 3 }, density = 2000, group = "rock" })
    model:generate("jointset", { joint = "J1", dip = 45, dip_dev = 5, dip_direction = 220,
        dip_direction_dev = 8, spacing = 0.8, spacing_dev = 0.2, number = 7, origin = { 2, 2, 1.5 },
        persistence = 0.8 })
    model:generate("jointset", { joint = "J2", dip = 80, dip_dev = 5, dip_direction = 100,
        spacing = 0.9, number = 5, origin = { 2, 2, 1.5 } })
    model:generate("jointset", { joint = "J3", dip = 10, dip_direction = 0, spacing = 1, number = 3,
        origin = { 2, 2, 1.5 } })
    model:generate("box", { min = { -2, -2, -1 }, max = { 6, 6, 0 }, density = 2000,
        group = "floor" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 30 })
    model:joint("J1", "coulomb_tensile", { kn = 1e8, ks = 5e7, friction = 20, cohesion = 1e3,
        tension = 1e3 })
    model:damping "adaptive"
    model:cycle(150)
    model:damping "local"
    model:cycle(150)
    return model:state_hash(), #model:blocks(), model:blocks():max "speed"
end

local hash, blocks, speed = run(1, 7, true)
figures.between("blocks", blocks, 100, 1000)
figures.between("largest speed", speed, 1e-6, 10) -- the rock does move
figures.equal("again", run(1, 7, true), hash)
figures.equal("2 threads", run(2, 7, true), hash)
figures.equal("3 threads", run(3, 7, true), hash)

local fresh = run(1, 7, false)
figures.equal("geometry not reused, 2 threads", run(2, 7, false), fresh)
-- The hash does tell states apart.
figures.equal("another seed differs", run(1, 8, true) ~= hash, true)
figures.finish()
