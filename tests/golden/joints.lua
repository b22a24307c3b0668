-- joints.lua - scenes of every law in every situation of a contact: pressed, sheared, tilted and partly open, of many corners, torn off, cut,
-- joined and parted. Added to those of scenes.lua.
local talus = require "talus"

local joints = {}

-- Each with what may come of it in these scenes: bonds that hold and break, slip that opens, curves.
local LAWS = {
    { "coulomb", "coulomb", { kn = 1e8, ks = 5e7, friction = 30, cohesion = 200, dilation = 8, dilation_limit = 0.01 } },
    { "stiff in shear", "coulomb", { kn = 5e7, ks = 2e8, friction = 40 } },
    { "bonded", "coulomb_tensile", { kn = 1e8, ks = 6e7, friction = 35, cohesion = 8e4, tension = 4e4, residual_friction = 25,
        residual_cohesion = 500, residual_tension = 200, dilation = 5 } },
    { "held over a gap", "coulomb_tensile", { kn = 1e8, ks = 1e8, friction = 35, cohesion = 3e3, tension = 2e3, residual_tension = 1.5e3 } },
    { "cohesive", "cohesive", { kn = 1e8, ks = 1e8, tension = 3e4, cohesion = 5e4, energy_tension = 30, energy_shear = 60, friction = 30 } },
    { "barton_bandis", "barton_bandis", { jrc = 9, jcs = 5e7, phi_r = 28, length = 0.5, kni = 4e8, vm = 4e-4, ks = 2e8 } },
    { "barton_bandis with a knee", "barton_bandis", { jrc = 6, jcs = 3e7, phi_r = 25, length = 1, kni = 2e8, vm = 5e-4, ks = 1e8, linear_from = 2.5e4,
        reduction = 1.2 } },
    { "yielding with a knee", "continuously_yielding", { an = 4e5, en = 0.5, as = 3e5, es = 0.5, kn_max = 4e7, ks_max = 3e7, phi_i = 40, phi = 25,
        roughness = 5e-3, softening = false } },
    { "yielding", "continuously_yielding", { an = 4e5, en = 0.5, as = 3e5, es = 0.5, kn_max = 2e9, ks_max = 2e9, phi_i = 45, phi = 30,
        roughness = 2e-3 } },
    { "rate_state", "rate_state", { kn = 2e8, ks = 1e8, a = 0.02, b = 0.03, distance = 1e-4, damping = 1e4 } },
    { "weakening", "slip_weakening", { kn = 1e8, ks = 1e8, friction = 38, cohesion = 1e3, residual_friction = 18, distance = 3e-3,
        form = "exponential", healing = "time", healing_time = 0.02 } },
    { "elastic", "elastic", { kn = 1e8, ks = 4e7 } },
}

-- Notes the state and what the ledger of energy says of it.
local function both(note)
    return function(model, stage)
        local energy = model:energy()
        note(model, stage)
        note(model, stage .. ", J", ("%a %a %a %a %a %a"):format(energy.kinetic, energy.potential, energy.stored, energy.friction, energy.damping,
            energy.external))
    end
end

local function box(model, min, max, group)
    model:generate("box", { min = min, max = max, density = 2500, group = group })
end

-- A floor in two pieces; on it a slender block that rocks, a column of three with one turned in, and a drum of many corners on a drum; a block
-- without faces at right angles leans against a wall.
local function build(law, parameters, gravity)
    local model = talus.model { gravity = gravity, seed = 5 }
    box(model, { -3, -3, -1 }, { 1, 5, 0 }, "floor")
    box(model, { 1, -3, -1 }, { 6, 5, 0 }, "floor")
    model:blocks { group = "floor" }:fix()
    box(model, { 0.5, 0, 0 }, { 1.25, 0.5, 1.5 }, "slender") -- over the seam of the floor
    box(model, { 2.5, 0, 0 }, { 3.5, 1, 0.5 }, "column")
    model:generate("prism", { base = { { 2.4, 0.4, 0.5 }, { 3.1, -0.1, 0.5 }, { 3.6, 0.6, 0.5 }, { 2.9, 1.1, 0.5 } }, axis = { 0, 0, 0.5 },
        density = 2500, group = "column" })
    box(model, { 2.5, 0.25, 1 }, { 3.25, 1, 1.75 }, "column")
    for k, height in ipairs { 0.25, 0.8 } do
        model:generate("drum", { center = { -1.5, 2, height }, axis = { 0, 0, 1 }, radius = 0.5 - 0.03 * k, height = 0.5 + 0.05 * (k - 1), sides = 11 + 2 * k,
            density = 2500, group = "drums" })
    end
    model:generate("polyhedron", { vertices = { { 3, 3, 0 }, { 4, 3.2, 0.001 }, { 3.8, 4, 0 }, { 3, 3.9, 0.02 }, { 3.1, 3.1, 1.2 }, { 3.6, 3.4, 1.1 } },
        density = 2500, group = "leaning" })
    box(model, { 4, 2.8, 0 }, { 5, 4.5, 2 }, "wall")
    box(model, { -2.5, -2, 2e-6 }, { -2.3, -1.8, 0.2 }, "near") -- a gap that counts for it and not for the floor
    model:blocks { group = "wall" }:fix { x = true }
    model:joint("*", law, parameters)
    return model
end

local function run(law, parameters, note)
    local model = build(law, parameters, { 1.5, 0.6, -9 })
    model:cycle(250)
    note(model, "leans")
    model:blocks { group = "slender" }:set { velocity = { 0.2, 0.02, 0 }, angular_velocity = { 0.1, 0.5, 0.2 } }
    model:blocks { group = "drums" }:set { velocity = { -0.05, 0.03, 0 }, angular_velocity = { 0.2, -0.1, 0.4 } }
    model:blocks { group = "leaning" }:load { force = { 9e3, 500, -2e3 }, at = { 3.4, 3.4, 0.9 } }
    model:cycle(400)
    note(model, "rocks")
    model:damping("local", { alpha = 0.6 })
    model:generate("joint", { joint = "late", dip = 20, dip_direction = 130, origin = { 0.8, 0.2, 0.9 } })
    model:blocks { group = "column" }:join()
    model:cycle(150)
    note(model, "cut and joined")
    model:blocks { group = "column" }:unjoin()
    model:blocks { group = "wall" }:delete()
    model:joint("late", "coulomb_tensile", { kn = 2e8, ks = 1e8, friction = 20, tension = 1e3, cohesion = 1e4 })
    model:blocks { group = "slender" }:load { force = { 0, 0, 6e3 } }
    model:cycle(250)
    note(model, "lifted")
end

for _, row in ipairs(LAWS) do
    joints[#joints + 1] = { name = row[1], run = function(note) run(row[2], row[3], both(note)) end }
end

-- The same stones, pressed by an initial stress, cut through and let go.
local function stressed(law, parameters, note)
    local model = talus.model { gravity = { 0, 0, -9 }, seed = 8 }
    box(model, { 0, 0, 0 }, { 3, 2, 2 }, "rock")
    model:generate("jointset", { joint = "J1", dip = 62, dip_direction = 80, spacing = 0.9, number = 3, origin = { 1.5, 1, 1 } })
    model:generate("jointset", { joint = "J2", dip = 25, dip_direction = 200, spacing = 1.1, number = 2, origin = { 1.5, 1, 1 } })
    model:joint("*", law, parameters)
    model:insitu { stress = { xx = -4e4, yy = -3e4, zz = -6e4, xz = 8e3 }, gradient = { zz = 2e4 } }
    model:boundary { xmin = "roller", ymin = "roller", zmin = "fixed" }
    model:boundary { side = "xmax", stress = { xx = -4e4, xz = 8e3 }, add = true }
    model:damping "combined"
    model:cycle(80)
    note(model, "pressed")
    model:generate("joint", { joint = "cut", dip = 80, dip_direction = 10, origin = { 1.4, 1.1, 1 } })
    model:cycle(40)
    model:blocks { containing = { 2.8, 1.8, 1.8 } }:delete()
    model:cycle(150)
    note(model, "cut")
end

for _, row in ipairs(LAWS) do
    joints[#joints + 1] = { name = row[1] .. ", stressed", run = function(note) stressed(row[2], row[3], both(note)) end }
end

-- ---------------------------------------------------------------- steps

local function scaled(name, rotation, set)
    joints[#joints + 1] = { name = name, run = function(plain)
        local note = both(plain)
        local model = talus.model { gravity = { 0.5, 1, -9 }, rotation = rotation, seed = 6 }
        box(model, { 0, 0, 0 }, { 2, 2, 1.5 }, "rock")
        model:generate("jointset", { joint = "J1", dip = 70, dip_direction = 300, spacing = 0.4, spacing_dev = 0.2, number = 4, origin = { 1, 1, 0.7 } })
        model:generate("jointset", { joint = "J2", dip = 15, dip_direction = 50, spacing = 0.6, number = 2, origin = { 1, 1, 0.7 } })
        box(model, { -1, -1, -1 }, { 3, 3, 0 }, "floor")
        model:blocks { group = "floor" }:fix()
        model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 25 })
        model:damping "local"
        set(model)
        model:cycle(120)
        note(model, "moves")
        model:blocks { containing = { 0.3, 0.3, 0.3 } }:fix { rotation = true }
        model:joint("J2", { kn = 3e9 })
        model:solve { ratio = 1e-3, max_cycles = 200, stop_at_failure = true }
        note(model, "ends")
    end }
end
scaled("scaled", "paper", function(model) model:mass_scaling(true) end)
scaled("some mass", nil, function(model) model:mass_scaling { dt = 1.5 * model:timestep().dt, most = 2 } end)
scaled("step of the paper", nil, function(model) model:timestep { rule = "paper", fraction = 0.2 } end)

return joints
