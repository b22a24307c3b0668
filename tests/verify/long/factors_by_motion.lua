-- Factors of safety of random slopes against long runs of damped motion with the strengths divided: just below the factor no block goes
-- on, just above it those go that are said to.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local models = require "safety_models"
local shapes = require "shapes"

local SHARE = tonumber(os.getenv "TALUS_TEST_SHARE" or 1)
local NUMBER = 60         -- slopes
local STEP = 0.01         -- of the grid of factors
local BESIDE = 0.02       -- how far from the ends of the bracket motion is looked at
local SMALL = 0.1         -- m3, of blocks that go first
local HIGH = 0.05         -- factor while joints settle
local GONE = 0.1          -- m, hundreds of settlements: what has gone so far fails
local CHUNK, CHUNKS = 5000, 12 -- steps
local REST = 1e-5         -- local ratio
local SLOWLY = { 0.6, 0.8, 0.9, 0.95, 0.98 } -- of the factor, one after the other: what is let go at once swings farther

local function divide(model, one, factor)
    local tangent = math.tan(math.rad(one.friction)) / factor
    model:joint("*", { friction = math.deg(math.atan(tangent)), cohesion = one.cohesion / factor })
end

-- Volume of the blocks that have gone since, m3.
local function gone(model, start)
    local volume = 0
    for _, block in ipairs(model:blocks { fixed = false }) do
        local way = shapes.length(shapes.sum(block.displacement, -1, start[block.id]))
        volume = volume + (way > GONE and block.volume or 0)
    end
    return volume
end

-- "rests", "fails" or "open": local damping alone decides, and no criterion of failure.
local function moves(settled, one, factor)
    local model, start = settled:copy(), {}
    for _, block in ipairs(model:blocks { fixed = false }) do
        start[block.id] = block.displacement
    end
    model:damping "local"
    model:mass_scaling(true)
    for _, share in ipairs(SLOWLY) do
        divide(model, one, share * factor)
        model:solve { ratio = REST, max_cycles = CHUNK, stop_at_failure = false }
    end
    divide(model, one, factor)
    for _ = 1, CHUNKS do
        local run = model:solve { ratio = REST, max_cycles = CHUNK, stop_at_failure = false }
        if gone(model, start) >= SMALL then
            return "fails"
        elseif run.reason == "ratio" then
            return "rests"
        end
    end
    return "open"
end

figures.case("FS.motion", "Slopes cut by three sets, with friction and cohesion: what goes by damped motion, over up to 60,000 steps from joints "
    .. "that have settled at high strengths, at 2 % below the largest factor that holds and 2 % above the least that fails. "
    .. "Rock that slips may come to rest by one way and not by another: one verdict in 25 may differ.",
    "model:solve with local damping, and no criterion of failure")
local wrong, open, decided = 0, 0, 0
local first
for seed = 1, math.max(6, NUMBER // SHARE) do
    local one = models.draw_slope(seed)
    local model = models.slope(one)
    local r = model:factor_of_safety { from = 0.1, to = 20, resolution = STEP, least_volume = SMALL }
    local settled = models.slope(one)
    for _, block in ipairs(r.small) do
        settled:blocks { id = block.id }:delete()
    end
    divide(settled, one, HIGH)
    settled:relax { ratio = 1e-4 }
    for _, of in ipairs { { r.lower / (1 + BESIDE), "rests" }, { r.upper * (1 + BESIDE), "fails" } } do
        if of[1] > 0 and of[1] < math.huge then
            local how = moves(settled, one, of[1])
            decided = decided + (how ~= "open" and 1 or 0)
            open = open + (how == "open" and 1 or 0)
            if how ~= "open" and how ~= of[2] then
                wrong = wrong + 1
                first = first or string.format("slope %d at %.4f %s", seed, of[1], how)
            end
            if os.getenv "TALUS_TEST_TELLS" then
                print(seed, #model:blocks { fixed = false }, r.message, of[1], how, of[2])
            end
        end
    end
end
figures.between("verdicts that differ" .. (first and ", first " .. first or ""), wrong, 0, decided // 25)
figures.between("verdicts that motion leaves open, of " .. decided + open, open, 0, (decided + open) // 10)
figures.finish()
