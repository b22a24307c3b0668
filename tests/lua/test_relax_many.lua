-- program only
-- model:relax of more bodies than leaps by secants are for: the right place in few steps, and the same bits for any threads and over a copy or
-- a save in the middle of its leaps.
local talus = require "talus"
local check = require "check"

local TMP = os.tmpname()
local HIGH, KN, WEIGHT = 20, 1e9, 2500 * 10 -- cubes; Pa/m; N of a cube of 1 m

-- More than 6000 cubes, in columns on a floor.
local function columns(threads)
    local m = talus.model { gravity = { 0, 0, -10 }, threads = threads }
    local side = math.ceil(math.sqrt(6001 / HIGH))
    local boxes = { { min = { -1, -1, -1 }, max = { 2 * side, 2 * side, 0 }, density = 2500, group = "floor" } }
    for i = 0, side - 1 do
        for j = 0, side - 1 do
            for k = 0, HIGH - 1 do
                boxes[#boxes + 1] = { min = { 2 * i, 2 * j, k }, max = { 2 * i + 1, 2 * j + 1, k + 1 }, density = 2500 }
            end
        end
    end
    m:generate("box", boxes)
    m:blocks { group = "floor" }:fix()
    m:joint("*", "coulomb", { kn = KN, ks = KN, friction = 35 })
    return m
end

local function relax(threads, middle)
    local m, at = columns(threads), {}
    local r = m:relax {
        ratio = 1e-6,
        every = middle or 1000,
        on_progress = function(model, result)
            if result.cycles == middle then
                at.copy = model:copy()
                model:save(TMP)
            end
        end,
    }
    check.equal(r.reason, "rest")
    return m, r.cycles, at.copy
end

local m, cycles = relax(1)
-- Stops alone take 332 steps.
check.holds(cycles < 150, cycles .. " steps of columns")
-- The joint under the k-th of n cubes bears n - k + 1 of them.
for _, block in ipairs(m:blocks { fixed = false }) do
    local k, down = math.floor(block.centroid[3] + 1), 0
    for i = 1, k do
        down = down + (HIGH - i + 1) * WEIGHT / KN
    end
    check.near(-block.displacement[3], down, 1e-6 * down)
end

local hash = m:state_hash()
local other, _, copy = relax(3, 60) -- leaps begin some 40 steps after the first
check.equal(other:state_hash(), hash)
for _, again in ipairs { copy, talus.restore(TMP) } do
    check.equal(again:relax { ratio = 1e-6 }.reason, "rest")
    check.equal(again:state_hash(), hash)
end
os.remove(TMP)
