-- incline.lua - a cube on an inclined plane: does it stick or slip, how fast, and how far does it
-- coast?
--
--     build/release/talus scripts/examples/incline.lua
--
-- The plane is level and gravity is inclined instead: a dip of theta towards +x is a gravity of
-- g (sin theta, 0, -cos theta). Closed form (Coulomb), friction coefficient mu:
--     sticks when mu >= tan(theta), otherwise slides at a = g (sin theta - mu cos theta);
--     on the level, with a speed v0 at first, stops after t = v0 / (mu g) at x = v0^2 / (2 mu g).
local talus = require "talus"

local incline = {}

local GRAVITY, DENSITY = 10, 2000
-- Very stiff springs: the cube stands on its front edge more than on its rear, and springs that
-- yield by d at the mean would turn it by about d / 1 m and so falsify the inclination. Here d is
-- 1e-8 m.
local STIFFNESS = 2e12
local AT_REST = 1e-8       -- unbalanced force ratio that counts as equilibrium

-- Dip in degrees. In two pairs the friction lies 0.001 above and 0.001 below tan(dip).
incline.cases = {
    { theta = 30, mu = 0.3 },
    { theta = 30, mu = 0.5 },
    { theta = 30, mu = math.tan(math.rad(30)) + 0.001 },
    { theta = 30, mu = math.tan(math.rad(30)) - 0.001 },
    { theta = 45, mu = 0.2 },
    { theta = 20, mu = 0.1 },
    { theta = 20, mu = math.tan(math.rad(20)) + 0.001 },
    { theta = 20, mu = math.tan(math.rad(20)) - 0.001 },
    { theta = 60, mu = 0.8 },
    { theta = 35, mu = 0.7 },
}

incline.coasting = {
    { v0 = 1.0, mu = 0.5 },
    { v0 = 2.0, mu = 0.3 },
    { v0 = 0.5, mu = 0.2 },
}

function incline.closed_form(case)
    local theta = math.rad(case.theta)
    local a = GRAVITY * (math.sin(theta) - case.mu * math.cos(theta))
    return { sticks = a <= 0, acceleration = math.max(0, a) }
end

-- A cube of 1 m at rest on a level plane that presses it with g cos(theta) only.
local function build(theta, mu, fraction)
    local model = talus.model { gravity = { 0, 0, -GRAVITY * math.cos(theta) } }
    model:generate("box", { min = { -2, -2, -1 }, max = { 4, 3, 0 }, density = DENSITY,
        group = "plane" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY,
        group = "cube" })
    model:blocks { group = "plane" }:fix()
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS,
        friction = math.deg(math.atan(mu)) })
    model:timestep { rule = "body", fraction = fraction or 0.5 }
    model:relax { ratio = AT_REST }
    model:damping "local"
    return model, model:blocks { group = "cube" }, model:blocks { group = "plane" }
end

-- Inclines gravity and watches the cube: does it stick, and if not, its acceleration.
function incline.run(case)
    local theta = math.rad(case.theta)
    local model, cube = build(theta, case.mu)
    model.gravity = { GRAVITY * math.sin(theta), 0, -GRAVITY * math.cos(theta) }
    -- Local damping brakes an accelerated block but leaves the forces at which it is steady: after
    -- these steps the cube is at rest, or slides without rocking. On a steep plane part of its joint opens, and it rocks
    -- slowly.
    local settled = model:solve { ratio = AT_REST, max_cycles = 10000 }
    cube:reset_displacement()
    model:damping "none"
    model:cycle(10) -- past the change of the time step that comes with the damping
    local WATCH = 0.1 -- s
    local before, begin = cube[1].velocity[1], model.time
    model:solve { ratio = 0, max_time = WATCH }
    local gained, time = cube[1].velocity[1] - before, model.time - begin
    return {
        sticks = settled.reason == "ratio", acceleration = gained / time,
        slip = cube[1].displacement[1], expected = incline.closed_form(case), model = model,
            cube = cube,
    }
end

-- Lets the cube go at a speed v0 along the level plane: where and when does it stop?
function incline.coast(case)
    local model, cube, plane = build(0, case.mu, case.fraction)
    -- The plane is pulled along under the cube at v0 until the cube does not rock any more.
    cube:fix { x = true }
    plane:drive { velocity = { -case.v0, 0, 0 } }
    model:cycle(3000)
    plane:fix()
    cube:free():reset_displacement()
    cube:set { velocity = { case.v0, 0, 0 } }
    model:damping "none"
    local begin = model.time
    local run = model:solve { ratio = 0, every = 1, max_time = 10, max_cycles = 10000000,
        stop = function()
            return cube[1].velocity[1] <= 0
        end }
    assert(run.reason == "stop", "the cube does not stop")
    return {
        distance = cube[1].displacement[1], time = model.time - begin, model = model,
        expected = { distance = case.v0 ^ 2 / (2 * case.mu * GRAVITY),
            time = case.v0 / (case.mu * GRAVITY) },
    }
end

function incline.main()
    print("A cube on an inclined plane\n")
    print("  dip    friction   expected              obtained              error")
    for _, case in ipairs(incline.cases) do
        local r = incline.run(case)
        local function say(sticks, a)
            return sticks and "sticks" or string.format("slides, %.6f m/s2", a)
        end
        local failed = r.sticks ~= r.expected.sticks
        print(string.format("%4d deg  %.5f   %-22s%-22s%s", case.theta, case.mu,
            say(r.expected.sticks, r.expected.acceleration), say(r.sticks, r.acceleration),
            failed and "WRONG" or r.sticks and "" or
            string.format("%+.4f %%", 100 * (r.acceleration / r.expected.acceleration - 1))))
    end
    print("\nA cube coasting on a level plane\n")
    print("  speed    friction   stops after expected, obtained    at expected, obtained")
    for _, case in ipairs(incline.coasting) do
        local r = incline.coast(case)
        print(string.format("%4.1f m/s    %.1f            %.5f s  %.5f s       %.5f m  %.5f m"
            .. "   (%+.3f %%)",
            case.v0, case.mu, r.expected.time, r.time, r.expected.distance, r.distance,
            100 * (r.distance / r.expected.distance - 1)))
    end
end

-- A test that says require "examples.incline" wants the functions only.
if ... ~= "examples.incline" then
    incline.main()
end
return incline
