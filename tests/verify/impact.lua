-- A smooth cube falls on a fixed floor with its base tilted and rebounds elastically: what the first
-- impact leaves of its speed and gives of spin, by the impulse on an edge or a corner, and the energy
-- through that and the impacts that follow it.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"

local SIDE, DENSITY, SPEED = 1, 2000, 2 -- m, kg/m3, m/s
local STIFFNESS = 1e12                  -- Pa/m: on an edge it sinks in by some 1e-4 of its side, on a corner by 4e-3
local PHASE = 0.015                     -- omega dt of the cube on the whole of its base
local TIME = 0.2                        -- s: through the impacts that follow
local SAMPLE = 5e-5                     -- s between looks
local OFF = 0.3                         -- of the side: of the middles of two cubes that meet
local IMPULSE, BALANCE = 1e-3, 1e-3    -- relative; of the largest term

-- Corners of the cube turned by `tilt` about y and `roll` about x, its lowest just over the floor.
local function corners(tilt, roll)
    local vertices, low = {}, math.huge
    for _, x in ipairs { -SIDE / 2, SIDE / 2 } do
        for _, y in ipairs { -SIDE / 2, SIDE / 2 } do
            for _, z in ipairs { -SIDE / 2, SIDE / 2 } do
                local px = x * math.cos(tilt) + z * math.sin(tilt)
                local pz = z * math.cos(tilt) - x * math.sin(tilt)
                local py = y * math.cos(roll) - pz * math.sin(roll)
                vertices[#vertices + 1] = { px, py, y * math.sin(roll) + pz * math.cos(roll) }
                low = math.min(low, vertices[#vertices][3])
            end
        end
    end
    local touching = { 0, 0, 0 } -- mean of the vertices it falls on, from the centre
    local count = 0
    for _, v in ipairs(vertices) do
        v[3] = v[3] - low
        if v[3] < 1e-9 then
            touching[1], touching[2], count = touching[1] + v[1], touching[2] + v[2], count + 1
        end
    end
    return vertices, touching[1] / count, touching[2] / count
end

-- Velocities after the first impact; with watch(model) it goes on through the impacts that follow.
local function first_impact(vertices, stiffness, watch)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = DENSITY,
        group = "floor" })
    model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "cube" })
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = stiffness, ks = stiffness, friction = 0 })
    model:timestep { dt = PHASE / math.sqrt(stiffness / (DENSITY * SIDE)) }
    local cubes = model:blocks { group = "cube" }
    cubes:set { velocity = { 0, 0, -SPEED } }
    local left, touched = nil, false
    local stride = math.floor(SAMPLE / model.dt)
    while model.time < TIME and (watch or not left) do
        model:cycle(stride)
        local cube = cubes[1]
        touched = touched or cube.force[3] > 0
        if touched and not left and cube.force[3] == 0 then
            left = { v = cube.velocity, w = cube.angular_velocity }
        end
        if watch then
            watch(model)
        end
    end
    return left
end

-- The limit of hard blocks, from what is obtained and what is with the stiffness with which the cube gets in half as far. So
-- far it turns while it is pressed, and so much is left out by the impulse. An edge is pressed with the square of how deep
-- it is in, a corner with the third power: the depth goes with the third and the fourth root of the stiffness.
local function hard(soft, stiff)
    local out = {}
    for i = 1, 3 do
        out[i] = 2 * stiff[i] - soft[i]
    end
    return out
end

local function fall(degrees, rolled)
    local vertices, x, y = corners(math.rad(degrees), math.rad(rolled))
    local mass, inertia = DENSITY * SIDE ^ 3, DENSITY * SIDE ^ 5 / 6
    local impulse = 2 * SPEED / (1 / mass + (x * x + y * y) / inertia)
    local worst, time, kinetic, stored = 0, {}, {}, {}
    local left = first_impact(vertices, STIFFNESS, function(model)
        local energy = model:energy()
        worst = math.max(worst, math.abs(energy.balance))
        local n = #time + 1
        time[n], kinetic[n], stored[n] = model.time, energy.kinetic, energy.stored
    end)
    local stiff = first_impact(vertices, (rolled > 0 and 16 or 8) * STIFFNESS)
    left = { v = hard(left.v, stiff.v), w = hard(left.w, stiff.w) }
    local id = string.format("D.impact.%g.%g", degrees, rolled)
    figures.case(id, string.format("A smooth cube of side 1 m falls at 2 m/s, turned by %g degrees about y "
        .. "and %g about x", degrees, rolled),
        "impulse 2 v / (1/m + r^2/I) of an elastic impact at a point r off the centre, the limit of hard "
        .. "blocks")
    figures.near("vertical velocity after the first impact, m/s", left.v[3],
        impulse / mass - SPEED, IMPULSE * SPEED)
    figures.near("spin about x, rad/s", left.w[1], impulse * y / inertia, IMPULSE * SPEED / SIDE)
    figures.near("spin about y, rad/s", left.w[2], -impulse * x / inertia, IMPULSE * SPEED / SIDE)
    figures.near("sideways velocity, m/s", math.sqrt(left.v[1] ^ 2 + left.v[2] ^ 2), 0, 1e-6 * SPEED)
    figures.between("worst energy balance, of the largest term", worst, 0, BALANCE)
    figures.plot { title = id .. ": energy", x = "time, s", y = "J", series = {
        { name = "kinetic", x = time, y = kinetic, style = "line" },
        { name = "in the contact", x = time, y = stored, style = "line" },
    } }
end

-- Two equal smooth cubes, one turned both ways and beside the middle of the other: edges cross edges.
local function meet(degrees)
    local vertices = corners(math.rad(degrees), math.rad(degrees))
    for _, v in ipairs(vertices) do
        v[1], v[2] = v[1] + OFF * SIDE, v[2] + OFF * SIDE
    end
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { -SIDE / 2, -SIDE / 2, -SIDE }, max = { SIDE / 2, SIDE / 2, 0 },
        density = DENSITY })
    model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "falling" })
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = 0 })
    model:timestep { dt = PHASE / math.sqrt(STIFFNESS / (DENSITY * SIDE)) }
    model:blocks { group = "falling" }:set { velocity = { 0, 0, -SPEED } }
    local worst, stride = 0, math.floor(SAMPLE / model.dt)
    while model.time < TIME do
        model:cycle(stride)
        worst = math.max(worst, math.abs(model:energy().balance))
    end
    figures.case("D.meet." .. degrees, string.format("Two free smooth cubes meet at 2 m/s, one turned by %g "
        .. "degrees about both axes and off by %g of the side", degrees, OFF),
        "conservation of energy and momentum")
    figures.between("worst energy balance, of the largest term", worst, 0, BALANCE)
    local momentum = 0
    for _, block in ipairs(model:blocks()) do
        momentum = momentum + block.mass * block.velocity[3]
    end
    figures.relative("momentum along the way, kg m/s", momentum, -DENSITY * SIDE ^ 3 * SPEED, 1e-9)
end

fall(3, 0)
fall(8, 0)
fall(12, 0)
fall(35, 0)
fall(7, 7)
fall(12, 12)
for _, degrees in ipairs { 0.5, 1.7, 4, 7, 12 } do
    meet(degrees)
end
figures.finish()
