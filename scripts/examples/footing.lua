-- footing.lua - a rough rigid footing is pressed into weightless clay until this flows.
--
--     build/release/talus scripts/examples/footing.lua [folder]
--
-- Prandtl (1920): the strip of half width b carries q = (2 + pi) c per area, with the cohesion c of a clay without
-- friction. Half of the strip is modelled, in a slice one zone thick. The clay keeps its volume when it flows, which
-- plain tetrahedra cannot: they carry a quarter too much. Zones of Talus share their change of volume in clusters. The clay
-- is stiff, so it flows before its surface has moved much, as the solution has it.
local talus = require "talus"

local footing = {}

footing.cohesion = 100e3 -- Pa
footing.half = 1         -- half width of the strip, m

-- `zones` to the half width.
function footing.build(zones)
    local edge = footing.half / zones
    local wide, deep, thick = 5 * footing.half, 3 * footing.half, edge
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, -deep }, max = { wide, thick, 0 }, density = 2000 })
    model:solid("clay", "mohr_coulomb", { young = 1e9, poisson = 0.3, cohesion = footing.cohesion, friction = 0,
        tension = 10 * footing.cohesion })
    model:blocks():deformable { zone = edge, solid = "clay" }
    model:boundary { xmin = "roller", xmax = "roller", ymin = "roller", ymax = "roller", zmin = "fixed" }
    -- The velocity falls to nothing over the zone beside the strip, half of which counts as loaded.
    local under = model:gridpoints { inside = { min = { 0, 0, -1e-6 }, max = { footing.half + 1e-6, thick, 1e-6 } } }
    under:fix()
    model:damping "local"
    return model, under, (footing.half + edge / 2) * thick
end

-- Presses the strip down by `depth` and gives the curve of settlement, m, against pressure over cohesion.
function footing.press(model, under, area, depth)
    local speed = 2e-7 / model.dt -- so much a step
    local curve = { x = {}, y = {} }
    under:set { velocity = { 0, 0, -speed } }
    for step = 0, 40 do
        while model.time * speed < depth * step / 40 do
            model:cycle(50)
        end
        curve.x[#curve.x + 1] = model.time * speed
        curve.y[#curve.y + 1] = -under:reaction()[3] / area / footing.cohesion
    end
    return curve
end

function footing.main(folder)
    local model, under, area = footing.build(4)
    local curve = footing.press(model, under, area, 0.006)
    local last = curve.y[#curve.y]
    print(string.format("%d zones; the strip carries %.3f c, Prandtl's solution is %.3f c: %+.1f %%", #model:zones(), last,
        2 + math.pi, 100 * (last / (2 + math.pi) - 1)))
    talus.plot { file = folder .. "/footing.svg", title = "A strip footing on clay",
        x_axis = { name = "settlement", unit = "m" }, y_axis = { name = "pressure over cohesion" },
        series = { { x = curve.x, y = curve.y, name = "Talus" },
            { x = { 0, curve.x[#curve.x] }, y = { 2 + math.pi, 2 + math.pi }, name = "2 + pi" } } }
    model:write_html(folder .. "/footing", { title = "A strip footing on clay" })
    print(string.format("%s/footing.svg is the curve, %s/footing.html the clay as it flows", folder, folder))
end

-- A test that says require "examples.footing" wants the functions only.
if ... ~= "examples.footing" then
    footing.main(arg and arg[1] or "out/footing")
end
return footing
