-- roof_beam.lua - a roof of rock beds between joints: a beam without tension that bears by arching.
--
--     build/release/talus scripts/examples/roof_beam.lua [folder]
--
-- Cross joints cut the lowest bed above an opening of 10 m into blocks. A joint bears no tension, so the bed cannot bend
-- as a beam does: it cracks at the bottom of midspan and at the top of its ends, and the weight goes to the walls through
-- an arch of compression in it (Evans 1941, "voussoir beam"). Rigid blocks cannot show that, for the arch comes from their
-- squeezing. The weight comes in ten portions: put on at once it would let the
-- blocks slip at the walls before the arch has closed.
local talus = require "talus"

local beam = {}

beam.span = 10      -- m
beam.wide = 0.5     -- m, along the opening
beam.blocks = 6
beam.young = 10e9   -- Pa

-- A bed of this thickness, m, between two walls.
function beam.build(thickness, zone)
    local model = talus.model { gravity = { 0, 0, -9.81 } }
    local boxes, long = {}, beam.span / beam.blocks
    for i = 1, beam.blocks do
        boxes[i] = { min = { (i - 1) * long, 0, 0 }, max = { i * long, beam.wide, thickness }, density = 2600, group = "bed" }
    end
    boxes[#boxes + 1] = { min = { -1, 0, -1 }, max = { 0, beam.wide, 2 }, density = 2600, group = "wall" }
    boxes[#boxes + 1] = { min = { beam.span, 0, -1 }, max = { beam.span + 1, beam.wide, 2 }, density = 2600, group = "wall" }
    model:generate("box", boxes)
    model:joint("*", "coulomb", { kn = 50e9, ks = 25e9, friction = 40 })
    model:solid("rock", "elastic", { young = beam.young, poisson = 0.2 })
    model:blocks { group = "wall" }:fix()
    model:blocks { group = "bed" }:deformable { zone = zone, solid = "rock" }
    return model
end

function beam.main(folder)
    print("bed      sag at midspan   largest compression")
    for _, thickness in ipairs { 1, 0.7, 0.5 } do
        local model = beam.build(thickness, thickness / 3)
        local run = model:relax { ratio = 1e-4, load_steps = 10, max_cycles = 100000 }
        local middle = model:gridpoints { near = { beam.span / 2, beam.wide / 2, 0 } }[1]
        local least = 0
        for _, p in ipairs(model:zones():values "principal") do
            least = math.min(least, p[3])
        end
        print(run.reason == "rest" and string.format("%.1f m    %7.2f mm       %5.2f MPa", thickness,
            -1000 * middle.displacement[3], -least / 1e6) or string.format("%.1f m    %s", thickness, run.message))
        local name = string.format("%s/roof_beam_%.0f_cm", folder, 100 * thickness)
        model:write_html(name, { title = string.format("A roof bed of %.1f m over %.0f m", thickness, beam.span) })
    end
    print(string.format("%s/roof_beam_*.html show the arch: colour zones by the least principal stress, or lay crosses", folder))
end

-- A test that says require "examples.roof_beam" wants the functions only.
if ... ~= "examples.roof_beam" then
    beam.main(arg and arg[1] or "out/roof_beam")
end
return beam
