-- What overlaps push apart does not fail: the verdict names them. What slides or falls fails, with or without a little overlap.
local check = require "check"
local talus = require "talus"

local function boxes(list, gravity, joint)
    local m = talus.model { gravity = gravity or { 0, 0, -9.81 } }
    m:generate("box", { min = { -20, -20, -1 }, max = { 20, 20, 0 }, density = 2500, group = "floor" })
    for _, b in ipairs(list) do
        m:generate("box", { min = b[1], max = b[2], density = 2500, group = "rock" })
    end
    m:blocks { group = "floor" }:fix()
    m:joint("*", "coulomb", joint or { kn = 1e9, ks = 1e9, friction = 20 })
    m:damping("local")
    return m
end

local function verdict(m)
    return m:solve({ ratio = 1e-6, stop_at_failure = true, max_cycles = 20000 }).reason
end

for _, overlap in ipairs { 0.05, 0.2 } do
    local beside = { { { 0, 0, 0 }, { 1, 1, 1 } }, { { 1 - overlap, 0, 0 }, { 2 - overlap, 1, 1 } } }
    check.equal(verdict(boxes(beside, nil, { kn = 1e9, ks = 1e9, friction = 0 })), "overlap")
    local stacked = { { { 0, 0, 0 }, { 1, 1, 1 } }, { { 0, 0, 1 - overlap }, { 1, 1, 2 - overlap } } }
    check.equal(verdict(boxes(stacked, { 0, 0, -0.1 })), "overlap")
    -- after a save and a copy, too
    local m = boxes(beside, nil, { kn = 1e9, ks = 1e9, friction = 0 })
    m:cycle(5)
    check.equal(verdict(m:copy()), "overlap")
end

-- A slope of 30 degrees with friction 20: it fails, also where its block lies some micrometres too deep.
local tilted = { 9.81 * math.sin(math.rad(30)), 0, -9.81 * math.cos(math.rad(30)) }
for _, depth in ipairs { 0, 1e-6, 1e-4 } do
    check.equal(verdict(boxes({ { { 0, 0, -depth }, { 1, 1, 1 } } }, tilted)), "failure")
end
-- and stands with friction 40, overlap or none
for _, depth in ipairs { 0, 1e-4 } do
    check.equal(verdict(boxes({ { { 0, 0, -depth }, { 1, 1, 1 } } }, tilted, { kn = 1e9, ks = 1e9, friction = 40 })), "ratio")
end
-- Rock under stress that is laid bare fails by its stress: no block was made overlapping.
local m = boxes({ { { 0, 0, 0 }, { 1, 1, 1 } }, { { 1, 0, 0 }, { 2, 1, 1 } } }, nil, { kn = 1e9, ks = 1e9, friction = 5 })
m:insitu { stress = { xx = -2e6, yy = -1e5, zz = -1e5 } }
check.holds(verdict(m) ~= "overlap", "stress is no overlap")
