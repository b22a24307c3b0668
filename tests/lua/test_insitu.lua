-- Initial stress: the contact lasts until its force is relieved, however far the walls have to part for it.
local talus = require "talus"
local check = require "check"

local KN, STRESS, SPEED, DT = 1e7, 1e5, 1, 1e-4
for _, law in ipairs { "elastic", "coulomb" } do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 2 }, density = 2000 })
    model:generate("joint", { joint = "J", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
    model:joint("J", law, { kn = KN, ks = KN })
    local plane = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } }
    model:blocks { below = plane }:fix()
    model:blocks { above = plane }:drive { velocity = { 0, 0, SPEED } }
    model:insitu { stress = { zz = -STRESS } }
    model:timestep { dt = DT }
    -- The stress ends at 1e-2 m; the contact when the walls have parted as far again, and by the tolerance of 1.5e-3 m.
    for _, opening in ipairs { 1e-3, 2e-3, 5e-3, 9.9e-3 } do
        model:cycle(math.floor((opening / SPEED - model.time) / DT + 1.5))
        local force = model:contacts():sum("normal_force")
        check.near(force, STRESS - KN * (model.time - DT) * SPEED, 1e-6 * STRESS)
    end
    model:cycle(25)
    check.near(model:contacts():sum("normal_force"), law == "coulomb" and 0 or STRESS - KN * (model.time - DT) * SPEED, 1e-6 * STRESS)
    model:cycle(110)
    if law == "coulomb" then
        check.equal(#model:contacts(), 0)
    else
        check.holds(model:contacts():sum("normal_force") < 0, "an elastic joint goes on into tension")
    end
    check.near(model:energy().balance, 0, 1e-9)
end

-- Rock in equilibrium with its stress stays in it, also where two joints meet: over the edge of a wedge the blocks
-- above and below it face each other, but the stress goes through the wedge.
local rock = talus.model { gravity = { 0, 0, -10 } }
rock:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2000 })
rock:generate("joint", { joint = "flat", dip = 0, dip_direction = 0, origin = { 2, 2, 2 } })
rock:generate("joint", { joint = "tilted", dip = 2, dip_direction = 90, origin = { 2, 2, 2 } })
check.equal(#rock:blocks(), 4)
for axis = 1, 3 do
    for _, low in ipairs { -1, 4 } do
        local min, max = { 0, 0, 0 }, { 4, 4, 4 }
        min[axis], max[axis] = low, low + 1
        rock:generate("box", { min = min, max = max, density = 2000, group = "plate" })
    end
end
rock:blocks { group = "plate" }:fix()
rock:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 60 })
local gradient = 2000 * 10
rock:insitu { at = { 0, 0, 4 }, stress = { xx = -1e5, yy = -1e5, zz = -1e5 },
    gradient = { xx = gradient, yy = gradient, zz = gradient } }
check.near(rock:cycle(1).ratio, 0, 1e-12)

-- A block that spins up under an unbalanced moment is not in equilibrium, whatever its forces are.
local model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { -2, -2, -1 }, max = { 2, 2, 0 }, density = 2000, group = "base" })
model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 1 }, density = 2000, group = "cube" })
model:blocks { group = "base" }:fix()
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
model:damping "local"
check.equal(model:solve { ratio = 1e-5 }.reason, "ratio")
model:blocks { group = "cube" }:load { moment = { 0, 0, 2e4 } }
check.equal(model:solve { ratio = 1e-5, max_cycles = 2000 }.reason, "cycles")

-- What was made before does not change a joint set's draws.
local function pieces(first)
    local m = talus.model { seed = 11 }
    if first then
        m:generate("box", { min = { 50, 0, 0 }, max = { 51, 1, 1 }, density = 1 })
        m:blocks():hide()
    end
    m:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 1 })
    m:generate("jointset", { joint = "A", dip = 30, dip_direction = 40, spacing = 0.5, number = 9,
        origin = { 2, 2, 2 }, persistence = 0.5 })
    m:generate("jointset", { joint = "B", dip = 70, dip_direction = 130, spacing = 0.5, number = 9,
        origin = { 2, 2, 2 }, persistence = 0.5 })
    local volumes = {}
    for _, block in ipairs(m:blocks()) do
        volumes[#volumes + 1] = string.format("%.9f", block.volume)
    end
    table.sort(volumes)
    return table.concat(volumes, " ")
end
check.equal(pieces(true), pieces(false))

-- The order of the letters of a shear stress does not matter.
do
    local function shear(stress)
        local m = talus.model {}
        m:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = 2000 })
        m:generate("joint", { joint = "x", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
        m:generate("joint", { joint = "z", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
        m:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
        m:insitu { stress = stress }
        return m:state_hash()
    end
    check.equal(shear { xx = -2e5, zx = 1e5, xy = 2e4, yz = 3e4 }, shear { xx = -2e5, xz = 1e5, yx = 2e4, zy = 3e4 })
    check.equal(shear { zx = 1e5, xz = 1e5 }, shear { zx = 1e5 })
    check.holds(shear { zx = 1e5 } ~= shear { zx = 2e5 }, "the stress is put on")
    local m = talus.model {}
    check.refused(m, function() m:insitu { stress = { xz = 1e5, zx = 2e5 } } end,
        "xz and zx are the same parameter: give one of them")
    check.refused(m, function() m:insitu { gradient = { zy = 1, yz = 2 } } end, "insitu, gradient: ")
    check.refused(m, function() m:insitu { stress = { xw = 1 } } end, "unknown parameter 'xw'")
    for _, huge in ipairs { 1e308, math.huge, 0 / 0 } do
        check.refused(m, function() m:insitu { stress = { xx = huge, zz = -1 } } end, "insitu")
    end
end

-- A law that tells its energy takes over a contact at an edge, of which the pressure was found without it.
for law, params in pairs {
    barton_bandis = { jrc = 6, jcs = 5e7, phi_r = 50, kni = 1e8, vm = 5e-2, ks = 1e7 },
    continuously_yielding = { an = 1e8, as = 1e7, phi_i = 65, phi = 60, roughness = 1e-2 },
} do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { -1, -1, -1 }, max = { 0, 2, 2 }, density = 2500, group = "held" })
    model:generate("box", { min = { 1, -1, -1 }, max = { 2, 2, 2 }, density = 2500, group = "held" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "cube" })
    model:blocks { group = "held" }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e7, friction = 60 })
    model:insitu { stress = { xx = -1e6 } }
    model:blocks { group = "cube" }:load { moment = { 0, 60000, 0 } }
    model:damping "local"
    model:solve { ratio = 1e-7 }
    local before = model:contacts():sum "normal_force"
    model:joint("*", law, params)
    model:cycle(1)
    check.near(model:contacts():sum "normal_force" / before, 1, 0.02)
end

-- Shear stress above the strength: what the law lets go of it at once was stored, so the ledger closes.
for _, dilation in ipairs { 0, 5 } do
    local model = talus.model {}
    model:generate("box", { min = { -1, -1, -1 }, max = { 1, 1, 0 }, density = 2500 })
    model:generate("box", { min = { -1, -1, 0 }, max = { 1, 1, 1 }, density = 2500 })
    model:blocks { id = 1 }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 40, dilation = dilation })
    model:timestep { fraction = 0.05 }
    model:insitu { stress = { zz = -1e6, xz = 1.2e6 } }
    model:cycle(1)
    check.holds(model:energy().friction > 1000, "the joint slips at once")
    for _ = 1, 40 do
        model:cycle(5)
        check.near(model:energy().balance, 0, 1e-3)
    end
end

-- The stress is put on the faces of a late cut, too, whether a step has been made since or not.
for _, steps in ipairs { 0, 1 } do
    local model = talus.model {}
    model:generate("box", { min = { 0, 0, -1 }, max = { 4, 4, 0 }, density = 2500, group = "base" })
    model:blocks():fix()
    model:generate("box", { min = { 1, 1, 0 }, max = { 3, 3, 2 }, density = 2500 })
    model:joint("*", "elastic", { kn = 1e8, ks = 5e7 })
    model:timestep { dt = 1e-6 }
    model:cycle(1)
    model:blocks { group = "base" }:hide()
    model:generate("joint", { joint = "late", dip = 0, dip_direction = 0, origin = { 2, 2, 1 } })
    model:blocks { hidden = true }:show()
    model:cycle(steps)
    model:insitu { stress = { xx = -1e5, yy = -1e5, zz = -5e4 } }
    for _ = 1, 3 do
        model:cycle(1)
        for _, contact in ipairs(model:contacts()) do
            check.near(contact.normal_stress, 5e4, 1)
        end
        check.near(model:energy().balance, 0, 1e-6)
    end
end
