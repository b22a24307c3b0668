-- tunnel.lua - a square tunnel under three faults: a wedge slides out of the roof.
--
--     build/release/talus scripts/examples/tunnel.lua [folder]
--
-- Three faults through one point above the roof (50/320, 40/230 and 65/270) divide a cube of rock
-- into eight blocks; a square tunnel is cut through them and excavated. Of the 21 pieces left,
-- joined into ten bodies, one wedge hangs in the roof: it can only slide along the fault 65/270.
-- Its acceleration is then, over that of gravity,
--
--     a / g = sin 65 - mu cos 65
--
-- and it slides while mu < tan 65. With nothing that clamps it, it also turns and falls off
-- earlier, above a friction of 38 degrees in a mixed motion, below in pure sliding. This is
-- example 3 of Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125; the paper
-- gives the attitudes and the number of pieces, the dimensions are chosen to give that number.
local talus = require "talus"

local tunnel = {}

tunnel.page_every = 5 -- of so many frames the page gets one

tunnel.faults = { { 50, 320 }, { 40, 230 }, { 65, 270 } } -- dip, dip direction
tunnel.apex = { 1.5, 0.5, 5 }                             -- where the faults meet
tunnel.half = 3                                           -- half the width of the tunnel, m
tunnel.slide = { 65, 270 }                                -- the fault the wedge slides on
tunnel.inside = { 0.3, 0.14, 3.5 }                        -- a point of the wedge

-- Across the tunnel, through the wedge.
tunnel.section = { dip = 90, dip_direction = 0, origin = tunnel.inside }

local ROCK = 8                      -- half the size of the cube, m
local DENSITY, GRAVITY = 2000, 10   -- kg/m3, m/s2
local STIFFNESS = 1e8               -- Pa/m, normal and shear
local FAILED = 0.05                 -- displacement that identifies the failure, m

-- The end of the tunnel at y: its edges are the west wall, the roof, the east wall and the floor.
local function face(y)
    local h = tunnel.half
    return { { -h, y, -h }, { -h, y, h }, { h, y, h }, { h, y, -h } }
end

-- Eight blocks, before the tunnel.
function tunnel.rock(options)
    local model = talus.model { gravity = { 0, 0, -GRAVITY },
        threads = options and options.threads }
    model:generate("box", { min = { -ROCK, -ROCK, -ROCK }, max = { ROCK, ROCK, ROCK },
        density = DENSITY, group = "rock" })
    for i, fault in ipairs(tunnel.faults) do
        model:generate("joint", { joint = "F" .. i, dip = fault[1], dip_direction = fault[2],
            origin = tunnel.apex })
    end
    return model
end

-- The model with the tunnel cut; excavate with model:blocks { group = "tunnel" }:delete().
function tunnel.cut(options)
    local model = tunnel.rock(options)
    model:generate("tunnel", { face1 = face(-ROCK), face2 = face(ROCK), group = "tunnel" })
    return model
end

-- Excavated, everything held but the wedge. `friction` in degrees.
function tunnel.build(friction, options)
    local model = tunnel.cut(options)
    model:blocks { group = "tunnel" }:delete()
    local wedge = model:blocks { containing = tunnel.inside }
    model:blocks():fix()
    wedge:free():set { group = "wedge" }
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = friction })
    return model, wedge
end

local function length(v)
    return math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2)
end

-- Lets the wedge go, without damping, until it has moved by `distance` or `patience` seconds are
-- over. Gives its mean acceleration over gravity, and the direction of its way.
function tunnel.drop(friction, distance, patience, options)
    local model, wedge = tunnel.build(friction, options)
    model:timestep { rule = "body", fraction = 0.2 }
    repeat
        model:cycle(10)
        local moved = length(wedge[1].displacement)
    until moved > distance or model.time > patience
    local way = wedge[1].displacement
    local moved = length(way)
    return { model = model, wedge = wedge, fell = moved > distance,
        acceleration = 2 * moved / model.time ^ 2 / GRAVITY,
        direction = { way[1] / moved, way[2] / moved, way[3] / moved } }
end

-- As the paper's run: from a cold start until the failure is identified.
function tunnel.identify(friction, options)
    local model, wedge = tunnel.build(friction, options)
    model:damping "adaptive"
    model:mass_scaling(true)
    local run = model:solve { ratio = 1e-6, max_cycles = 20000, every = 10, stop = function()
        return length(wedge[1].displacement) > FAILED
    end }
    return { model = model, wedge = wedge, failed = run.reason == "stop", run = run }
end

-- The collapse in `frames` pictures after the first, whole and in section, as files for ParaView, and
-- every fifth as a page.
function tunnel.film(friction, frames, name)
    local model = tunnel.build(friction)
    model:timestep { rule = "body", fraction = 0.2 }
    local interval = 0.05 -- s
    for frame = 0, frames do
        while model.time < frame * interval do
            model:cycle(10)
        end
        model:write_vtk(name)
        model:write_section(name, tunnel.section)
        if frame % tunnel.page_every == 0 or frame == frames then
            model:write_html(name, { title = "A wedge in the roof of a tunnel" })
        end
    end
end

function tunnel.main(folder)
    local model = tunnel.cut()
    local wedge = model:blocks { containing = tunnel.inside }
    print(string.format("%d blocks: %d inside the tunnel, %g m3; wedge in the roof, %.7f m3",
        #model:blocks(), #model:blocks { group = "tunnel" },
        model:blocks { group = "tunnel" }:sum "volume", wedge[1].volume))
    local r = tunnel.identify(25)
    print(string.format("friction 25: failure %s after %d cycles, %.2f s",
        r.failed and "identified" or "not found", r.run.cycles, r.run.wall))
    print("\nfriction    a/g  expected")
    local s, c = math.sin(math.rad(tunnel.slide[1])), math.cos(math.rad(tunnel.slide[1]))
    for _, mu in ipairs { 0, 0.2, 0.3, 0.5, 0.577 } do
        r = tunnel.drop(math.deg(math.atan(mu)), 0.3, 5)
        print(string.format("   %5.3f %6.4f    %6.4f", mu, r.acceleration, s - mu * c))
    end
    r = tunnel.drop(45, 0.3, 5)
    print(string.format("friction 45: %s", r.fell and "the wedge comes down" or "the wedge holds"))
    tunnel.film(25, 20, folder .. "/tunnel")
    print(string.format("%s/tunnel.html shows the collapse in a browser,", folder))
    print(string.format("%s/tunnel_blocks.vtk.series shows the collapse at friction 25,", folder))
    print(string.format("%s/tunnel_section.vtk.series a section across the tunnel", folder))
end

-- A test that says require "examples.tunnel" wants the functions only.
if ... ~= "examples.tunnel" then
    tunnel.main(arg and arg[1] or "out/tunnel")
end
return tunnel
