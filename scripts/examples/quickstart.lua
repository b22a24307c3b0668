-- quickstart.lua - a first look: a wedge of rock rests on two joints; when does it slide?
--
--     build/release/talus scripts/examples/quickstart.lua [FOLDER]
--
-- Axes: x east, y north, z up. Angles in degrees, everything else in SI units. The example is the
-- first one of Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125; wedge.lua
-- solves more of its kind and explains the closed form, E. Hoek and J. Bray's.
local talus = require "talus"

local folder = arg[1] or "out/quickstart"
local CLOSED_FORM = 0.6583     -- friction coefficient tan(phi) below which the wedge slides

local function degrees(coefficient)
    return math.deg(math.atan(coefficient))
end

print "A wedge of rock on two joints that dip 40 deg to the south-east and 60 to the south-west."

-- 1. Rock: a box, cut by both joints. What lies above both is the wedge.
local model = talus.model { gravity = { 0, 0, -10 } }
local apex = { 0, 0.5, 1 }
model:generate("box", { min = { -2, -1, -1 }, max = { 2, 1, 1 }, density = 2000, group = "rock" })
model:generate("joint", { joint = "A", dip = 40, dip_direction = 130, origin = apex })
model:generate("joint", { joint = "B", dip = 60, dip_direction = 220, origin = apex })

local wedge = model:blocks { containing = { 0.3, -0.6, 0.7 } }
wedge:set { group = "wedge" }
local rock = model:blocks { group = "rock" }
rock:fix()
print(string.format("%d blocks; the wedge has %.3f m3 and weighs %.1f kN, the others are held.\n",
    #model:blocks(), wedge[1].volume, wedge[1].mass * 10 / 1000))

-- 2. Joints: springs of 10 MPa/m along and across, and friction.
for _, joint in ipairs { "A", "B" } do
    model:joint(joint, "coulomb", { kn = 1e7, ks = 1e7, friction = degrees(10) })
end
model:contact_area { fraction = 0 }         -- edges carry nothing, as in the closed form
model:timestep { rule = "body", fraction = 0.5 }

-- 3. Let it settle under more friction than any joint has.
assert(model:relax { ratio = 1e-6 }.reason == "rest", "the wedge should come to rest")

-- 4. Lower the friction step by step. As long as the forces come to balance, the wedge holds.
local SLIDING = 0.05                        -- m in one step: fifty times what the springs yield

local function slip()
    local u = wedge[1].displacement
    return math.sqrt(u[1] ^ 2 + u[2] ^ 2 + u[3] ^ 2)
end

local function holds(friction)
    for _, joint in ipairs { "A", "B" } do
        model:joint(joint, { friction = degrees(friction) })
    end
    wedge:reset_displacement()
    local run = model:relax { ratio = 1e-6, every = 10,
        stop = function() return slip() > SLIDING end }
    return run.reason == "rest", run
end

local function force_on(joint)
    return model:contacts { joint = joint, between = { wedge, rock } }:sum "normal_force" / 1000
end

print "friction   angle     slip     force on A   force on B"
local function row(friction, outcome)
    print(string.format("  %.3f   %4.1f deg  %6.2f mm  %7.2f kN   %7.2f kN   %s",
        friction, degrees(friction), 1000 * slip(), force_on "A", force_on "B", outcome))
end

local friction, still = 0.800, true
local last = friction
repeat
    still = holds(friction)
    -- The first steps change little: show every tenth, and each one near the end.
    if not still or friction < 0.660 or math.floor(friction * 1000 + 0.5) % 20 == 0 then
        row(friction, still and "holds" or "slides")
    end
    if still then
        last, friction = friction, friction - 0.002
    end
until not still

local failure = 0.5 * (friction + last)
print(string.format([[

It slides at a friction coefficient of %.3f; the closed form says %.3f (%+.1f %%). The closed form
lets it move straight only; here it also turns a little as it settles, which costs a hundredth.
]], failure, CLOSED_FORM, 100 * (failure / CLOSED_FORM - 1)))

-- 5. The slide itself. The wedge comes to rest where it has got to, and is let go at three quarters of
-- that friction without damping: a picture every 0.05 s, as files for ParaView and as frames of a page
-- for a browser.
assert(holds(0.800), "the wedge should come to rest again")
model:damping "none"
wedge:reset_displacement()
for _, joint in ipairs { "A", "B" } do
    model:joint(joint, { friction = degrees(0.75 * failure) })
end
local PICTURES, INTERVAL = 20, 0.05
local begin = model.time
local function picture()
    model:write_vtk(folder .. "/wedge")
    model:write_html(folder .. "/wedge", { title = "A wedge on two joints" })
end
picture()
for number = 1, PICTURES do
    model:solve { ratio = 0, max_time = begin + number * INTERVAL - model.time }
    picture()
end
print(string.format("Let go at a friction of %.3f, it slides %.2f m in %.1f s: %d pictures in %s.",
    0.75 * failure, slip(), model.time - begin, PICTURES + 1, folder))
print(string.format([[
To see it: open %s/wedge.html in a browser, or
paraview %s/wedge_blocks.vtk.series   (then press Apply and Play; the _contacts and
_joints series open the same way)]], folder, folder))
