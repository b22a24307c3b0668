-- monitor.lua - histories and pictures of the slope of slope.lua, from which a wedge slides.
--
--     build/release/talus scripts/examples/monitor.lua [folder]
--
-- The keyblocks are found first: the one that two discontinuities cut out has a factor of safety of 0.71 at a friction of
-- 20 degrees. Then the slope is let go for one second. Its displacement and the energies are sampled every 50 cycles,
-- written as a table, and drawn; a stereonet shows the joint sets and where keyblocks can move.
local talus = require "talus"

local here = debug.getinfo(1, "S").source:match("^@(.*/)") or ""
local slope = assert(loadfile(here .. "slope.lua"))("examples.slope")

local FRICTION = 20 -- degrees
local TIME = 1      -- s

local monitor = {}

function monitor.main(folder)
    local model = slope.build(FRICTION)
    model:timestep { rule = "body", fraction = 0.3 }
    local keyblocks = model:keyblocks { friction = FRICTION }
    local loose
    for _, keyblock in ipairs(keyblocks) do
        loose = keyblock.safety < 1 and keyblock or loose
    end
    print(string.format("block %d, %.1f m3: %s, factor of safety %.2f", loose.block.id, loose.volume, loose.mode, loose.safety))

    local wedge = model:blocks { id = loose.block.id }
    model:history { name = "wedge", every = 50, of = wedge, field = "displacement" }
    model:history { name = "along", every = 50, value = function()
        local d, way = wedge[1].displacement, loose.direction
        return d[1] * way[1] + d[2] * way[2] + d[3] * way[3]
    end }
    for _, name in ipairs { "kinetic", "friction", "slipping" } do
        model:history { name = name, every = 50, value = name }
    end
    model:solve { ratio = 0, max_time = TIME }

    model:write_histories(folder .. "/histories.csv")
    talus.plot { file = folder .. "/displacement.svg", title = "Wedge on two discontinuities", model = model,
        histories = { "wedge", "along" }, y_axis = { name = "displacement", unit = "m" } }
    talus.plot { file = folder .. "/energy.svg", model = model, histories = { "kinetic", "friction" },
        y_axis = { name = "energy", unit = "J" } }
    talus.stereonet { file = folder .. "/joints.svg", title = "Joint sets and keyblocks", model = model, keyblocks = keyblocks }
    print(string.format("%s/histories.csv, displacement.svg, energy.svg and joints.svg tell how it goes", folder))
    return model
end

-- A test that says require "examples.monitor" wants the functions only.
if ... ~= "examples.monitor" then
    monitor.main(arg and arg[1] or "out/monitor")
end
return monitor
