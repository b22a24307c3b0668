-- pit_slope.lua - from planes measured along a bench of a pit to the probability that its face fails.
--
--     build/release/talus scripts/examples/pit_slope.lua [FOLDER] [NUMBER] [WORKERS]
--
-- Three joint sets are found among the measured planes. In each realisation the planes of each set take measured attitudes
-- and other spacings, and all joints one friction. Block theory screens: where nothing removable is below a factor of 1.2,
-- and nothing small below 1 that could let larger blocks go, nothing fails. Else the realisation is run until it rests or something has gone. The measured planes are made up.
local talus = require "talus"

local pit = {}

local POLES = "scripts/examples/pit_poles.csv"
pit.height, pit.width, pit.depth, pit.face = 15, 20, 25, 58 -- m, m, m; dip of the face, to the west
pit.spacing = { 2.6, 3.2, 3.6 }                             -- m, mean of each set, the largest set first
pit.friction = { 38, 3 }                                    -- degrees, mean and standard deviation
local DENSITY, GRAVITY, STIFFNESS = 2600, 10, 1e9
local SMALLEST = 0.5                                        -- m3: smaller blocks do not count

-- The bench without joints, above its toe, and the rock around it, which is held and hidden: x is 0 at the toe and goes into
-- the rock.
local function bench(model)
    local x, y, z, corners = pit.depth, pit.width, pit.height, {}
    model:generate("box", { { min = { 0, 0, -1 }, max = { x, y, 0 }, density = DENSITY, group = "around" },
        { min = { x, 0, 0 }, max = { x + 1, y, z }, density = DENSITY, group = "around" },
        { min = { 0, -1, 0 }, max = { x, 0, z }, density = DENSITY, group = "around" },
        { min = { 0, y, 0 }, max = { x, y + 1, z }, density = DENSITY, group = "around" } })
    model:blocks():fix():hide()
    local crest = z / math.tan(math.rad(pit.face))
    for _, side in ipairs { 0, y } do
        for _, at in ipairs { { 0, 0 }, { x, 0 }, { x, z }, { crest, z } } do
            corners[#corners + 1] = { at[1], side, at[2] }
        end
    end
    model:generate("polyhedron", { vertices = corners, density = DENSITY, group = "rock" })
end

-- One realisation. `files`: the measured planes of each set.
function pit.build(draw, files)
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, seed = draw.seed "joints" }
    bench(model)
    local size = math.sqrt(pit.depth ^ 2 + pit.width ^ 2 + pit.height ^ 2)
    for i, file in ipairs(files) do
        local spacing = draw.lognormal("spacing " .. i, pit.spacing[i], 0.2 * pit.spacing[i])
        model:generate("jointset", { joint = "J" .. i, poles = file, spacing = spacing, spacing_distribution = "uniform",
            spacing_dev = 0.5 * spacing, number = math.ceil(0.8 * size / spacing), origin = { 0, pit.width / 2, 0 },
            persistence = 0.7 })
    end
    model:blocks { hidden = true }:show()
    return model
end

local function friction_of(draw)
    return draw.normal("friction", pit.friction[1], pit.friction[2], { min = 20, max = 50 })
end

-- The least factor of safety of what can be removed; whether nothing can fail.
function pit.screen(model, draw)
    local least, holds = 10, true
    for _, key in ipairs(model:keyblocks { friction = friction_of(draw) }) do
        if key.volume >= SMALLEST then
            least = math.min(least, key.safety)
        end
        holds = holds and key.safety > (key.volume >= SMALLEST and 1.2 or 1)
    end
    return { blocks = #model:blocks(), keyblock = least, failed = false, volume = 0 }, holds
end

-- Runs until the bench rests or something that counts has failed; smaller blocks that go first are deleted. The volume that has
-- gone.
function pit.measure(model, draw)
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = friction_of(draw) })
    local run, small
    repeat
        run = model:relax { ratio = 1e-4, max_cycles = 20000 }
        small = run.reason == "failure" and run.volume < SMALLEST
        if small then
            run.failing:delete()
        end
    until not small
    local failed = run.reason == "failure"
    return { failed = failed, volume = failed and run.volume or 0 }
end

function pit.main(folder, number, workers)
    local poles = talus.poles(POLES)
    local sets, files = poles:sets(3), {}
    for i, set in ipairs(sets) do
        local mean = set:mean()
        print(("set %d: %d planes, mean %.0f/%03.0f, concentration %.0f, 95 %% cone %.1f degrees"):format(i, #set, mean.dip,
            mean.dip_direction, mean.kappa, mean.cone))
        files[i] = ("%s/set_%d.csv"):format(folder, i)
        set:write(files[i])
    end
    talus.stereonet { file = folder .. "/poles.svg", poles = sets, title = "Measured planes" }
    local set = talus.realisations { number = number, seed = 1, workers = workers, file = folder .. "/realisations.csv",
        latin = true, screen = pit.screen, measure = pit.measure,
        build = function(draw)
            return pit.build(draw, files)
        end }
    local p, low, high = set:probability "failed"
    print(("%d realisations of %.0f blocks: the face fails with a probability of %.3f (95 %%: %.3f to %.3f)"):format(#set,
        set:mean "blocks", p, low, high))
    print(("volume: mean %.1f m3, of one in ten more than %.1f m3"):format(set:mean "volume", set:quantile("volume", 0.9)))
    for _, item in ipairs(set:sensitivity "keyblock") do
        print(("rank correlation of %s with the least factor: %.2f"):format(item.name, item.rank_correlation))
    end
    local x, y = {}, {}
    for i = 0, 100 do
        x[i + 1], y[i + 1] = set:quantile("keyblock", i / 100), i
    end
    talus.plot { file = folder .. "/safety.svg", series = { { name = "realisations", x = x, y = y } },
        x_axis = { name = "least factor of safety of a keyblock", range = { 0, 3 } },
        y_axis = { name = "share below", unit = "%" } }
    print(("%s/poles.svg and safety.svg show it"):format(folder))
    return set
end

-- A test that says require "examples.pit_slope" wants the functions only.
if ... ~= "examples.pit_slope" then
    pit.main(arg and arg[1] or "out/pit_slope", tonumber(arg and arg[2] or 300), tonumber(arg and arg[3] or 1))
end
return pit
