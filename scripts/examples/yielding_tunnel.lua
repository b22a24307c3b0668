-- yielding_tunnel.lua - a tunnel through jointed rock that yields.
--
--     build/release/talus scripts/examples/yielding_tunnel.lua [folder]
--
-- A slice of rock, 24 m wide and 2 m thick, is cut by two joint sets and pressed by 8 and 10 MPa. A tunnel of 6 m is
-- driven through it. The rock between the joints is weak: it yields around the tunnel, and joints slip beside it. Blocks
-- are divided into zones, small at the tunnel and larger away from it. The page shows both: colour zones by "state" and
-- contacts by "slip", or lay crosses of the principal stresses over the rock.
local talus = require "talus"

local tunnel = {}

tunnel.half = 12     -- half the width of the slice, m
tunnel.thick = 2     -- m
tunnel.radius = 3    -- of the tunnel, m
tunnel.pressure = { xx = -8e6, yy = -6e6, zz = -10e6 } -- Pa, before the tunnel

-- The end of the tunnel at y, a polygon of twelve sides.
local function face(y)
    local corners = {}
    for i = 0, 11 do
        local angle = 2 * math.pi * (i + 0.5) / 12
        corners[i + 1] = { tunnel.radius * math.cos(angle), y, tunnel.radius * math.sin(angle) }
    end
    return corners
end

-- The rock before the tunnel, in equilibrium. `zone`: edge of zones at the tunnel, m.
function tunnel.build(zone)
    local model = talus.model { gravity = { 0, 0, 0 } } -- its own weight is little beside 10 MPa
    local half, thick = tunnel.half, tunnel.thick
    model:generate("box", { min = { -half, 0, -half }, max = { half, thick, half }, density = 2600, group = "rock" })
    model:generate("jointset", { joint = "J1", dip = 40, dip_direction = 90, spacing = 4, number = 20, origin = { 1, 0, 0 } })
    model:generate("jointset", { joint = "J2", dip = 65, dip_direction = 270, spacing = 5, number = 20, origin = { 1, 0, 0 } })
    model:generate("tunnel", { face1 = face(0), face2 = face(thick), group = "tunnel" })
    model:joint("*", "coulomb", { kn = 20e9, ks = 10e9, friction = 30, cohesion = 0.2e6 })
    model:solid("rock", "mohr_coulomb",
        { young = 5e9, poisson = 0.25, cohesion = 1.5e6, friction = 35, tension = 0.3e6 })
    model:blocks():deformable { solid = "rock", zone = function(p)
        local away = math.max(0, math.sqrt(p[1] ^ 2 + p[3] ^ 2) - tunnel.radius)
        return zone * (1 + 0.25 * away)
    end }
    model:insitu { stress = tunnel.pressure }
    model:boundary { xmin = "roller", xmax = "roller", ymin = "roller", ymax = "roller", zmin = "roller", zmax = "roller" }
    return model
end

-- Takes the rock out of the tunnel.
function tunnel.excavate(model)
    model:blocks { group = "tunnel" }:delete()
    return model:relax { ratio = 1e-4 }
end

-- How far the walls have come in, m: at the roof, the two sides and the floor.
function tunnel.closure(model)
    local function moved(x, z, axis)
        return model:gridpoints { near = { x, tunnel.thick / 2, z } }[1].displacement[axis]
    end
    local r = tunnel.radius
    return { roof = -moved(0, r, 3), west = moved(-r, 0, 1), east = -moved(r, 0, 1), floor = moved(0, -r, 3) }
end

function tunnel.main(folder)
    local model = tunnel.build(0.5)
    print(string.format("%d blocks, %d zones", #model:blocks(), #model:zones()))
    print("before the tunnel: " .. model:relax { ratio = 1e-4 }.message)
    local run = tunnel.excavate(model)
    print("with the tunnel: " .. run.message)
    local closure = tunnel.closure(model)
    print(string.format("the roof has come down by %.1f mm, the floor up by %.1f mm, the walls in by %.1f and %.1f mm",
        1000 * closure.roof, 1000 * closure.floor, 1000 * closure.west, 1000 * closure.east))
    local yielded = model:zones { plastic = true }
    print(string.format("%.0f m3 of %.0f m3 of rock have yielded", yielded:sum "volume", model:zones():sum "volume"))
    model:write_html(folder .. "/yielding_tunnel", { title = "A tunnel through rock that yields" })
    model:write_vtk(folder .. "/yielding_tunnel")
    print(string.format("%s/yielding_tunnel.html shows it in a browser, the files beside it in ParaView", folder))
end

-- A test that says require "examples.yielding_tunnel" wants the functions only.
if ... ~= "examples.yielding_tunnel" then
    tunnel.main(arg and arg[1] or "out/yielding_tunnel")
end
return tunnel
