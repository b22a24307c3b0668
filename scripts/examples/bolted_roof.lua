-- bolted_roof.lua - a keyblock in the roof of a tunnel, and how many bolts hold it.
--
--     build/release/talus scripts/examples/bolted_roof.lua
--
-- Two joints that strike along a square tunnel cut a prism of 60 degrees out of its roof, and two more across it end the
-- prism. Its weight is known, and so is what friction cannot hold: without stress in the rock it falls. Bolts of
-- a pattern over the roof carry it, each up to its yield. Fewer or weaker bolts let it go.
local talus = require "talus"

local bolted = {}

local DENSITY, GRAVITY = 2600, 9.81
local HALF, LENGTH = 2, 4    -- m: half of the width of the roof, and the length of the keyblock along the tunnel
local DIP = 60               -- degrees, of the joints
local ROCK = 8               -- m of rock above the roof

-- The weight of the prism: its section is a triangle of base 2 HALF, and its joints dip by DIP.
function bolted.weight()
    return DENSITY * GRAVITY * LENGTH * HALF * HALF * math.tan(math.rad(DIP))
end

-- Rock above a roof at z = 0, cut; all is held but the prism.
function bolted.build(threads)
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, threads = threads }
    model:generate("box", { min = { -4, -4, 0 }, max = { 4, 4, ROCK }, density = DENSITY })
    model:generate("joint", { joint = "A", dip = DIP, dip_direction = 90, origin = { HALF, 0, 0 } })
    model:generate("joint", { joint = "B", dip = DIP, dip_direction = 270, origin = { -HALF, 0, 0 } })
    for _, y in ipairs { -0.5 * LENGTH, 0.5 * LENGTH } do
        model:generate("joint", { joint = "C", dip = 90, dip_direction = 0, origin = { 0, y, 0 } })
    end
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    model:blocks():fix()
    local prism = model:blocks { containing = { 0, 0, 0.5 } }
    prism:free():set { group = "keyblock" }
    model:damping "local"
    return model, prism
end

-- Bolts of a yield, N, on a grid over the part of the roof below the prism.
function bolted.bolt(model, spacing, yield)
    local roof = model:boundary { plane = { normal = { 0, 0, -1 }, at = { 0, 0, 0 } } }
    local list = {}
    for _, bolt in ipairs(talus.bolt_pattern { on = roof, spacing = { spacing, spacing }, origin = { 0, 0, 0 }, length = 6,
        yield = yield, plate_strength = yield, dowel_stiffness = 1e8, dowel_strength = 5e4, group = "roof" }) do
        if math.abs(bolt.from[1]) < HALF and math.abs(bolt.from[2]) < 0.5 * LENGTH then
            list[#list + 1] = bolt
        end
    end
    return model:element("bolt", list)
end

-- Whether the prism comes to rest, and how far it has settled, m.
function bolted.holds(model, prism)
    local run = model:solve { ratio = 1e-4, measure = "local", every = 20, max_cycles = 20000, stop = function()
        return prism[1].displacement[3] < -0.3
    end }
    return run.reason == "ratio", -prism[1].displacement[3]
end

function bolted.run(spacing, yield)
    local model, prism = bolted.build()
    local bolts = yield > 0 and bolted.bolt(model, spacing, yield) or {}
    local holds, settled = bolted.holds(model, prism)
    return { model = model, bolts = bolts, holds = holds, settled = settled }
end

function bolted.main(folder)
    print(("A keyblock of %.0f kN in the roof\n"):format(bolted.weight() / 1e3))
    print("   bolts  yield, kN  together, kN   holds   settled, mm   bear, kN")
    for _, case in ipairs { { 1, 0 }, { 1.2, 2e4 }, { 1.2, 5e4 }, { 1.2, 2e5 }, { 0.9, 5e4 } } do
        local spacing, yield = table.unpack(case)
        local r = bolted.run(spacing, yield)
        local bears = #r.bolts > 0 and r.bolts:sum "axial" / 1e3 or 0
        print(("   %5d  %9.0f  %12.0f   %5s   %11.2f   %8.0f"):format(#r.bolts, yield / 1e3, #r.bolts * yield / 1e3, r.holds,
            1e3 * r.settled, bears))
        if r.holds then
            bolted.show(r.model, folder)
        end
    end
    print(("\n%s/bolted_roof.html shows bolts and factors of those that hold"):format(folder))
end

-- Adds a frame with the factor of safety of each block that can move: bolts keep their strengths, joints are divided.
function bolted.show(model, folder)
    local map = model:safety_map { from = 0.5, to = 3, step = 0.25 }
    local field = { block_fields = { safety = map.factor } }
    model:write_vtk(folder .. "/bolted_roof", field)
    field.title = "Bolts in a roof"
    model:write_html(folder .. "/bolted_roof", field)
end

-- A test that says require "examples.bolted_roof" wants the functions only.
if ... ~= "examples.bolted_roof" then
    bolted.main(arg and arg[1] or "out/bolted_roof")
end
return bolted
