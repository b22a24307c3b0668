-- scenes.lua - small models that between them use every phase of a step, every law, damping and generator.
--
-- Each scene is a function that makes a model and says, by note(stage), where its state is to be compared. A scene
-- uses no sine or power of Lua's own: those come from the C library, whose last bits differ between machines. A new
-- scene goes to the end of the list; then run hashes.lua with --renew.
local talus = require "talus"

local scenes = {} -- {name =, run = function(note, folder)}

local function scene(name, run)
    scenes[#scenes + 1] = { name = name, run = run }
end

-- ---------------------------------------------------------------- parts of scenes

local ROCK = { kn = 1e9, ks = 5e8, friction = 35 }

local function floor(model, min, max)
    model:generate("box", { min = min, max = max, density = 2500, group = "floor" })
    model:blocks { group = "floor" }:fix()
end

-- A box of rock cut by three joint sets.
local function cut_box(model, size, sets)
    model:generate("box", { min = { 0, 0, 0 }, max = size, density = 2500, group = "rock" })
    for i, set in ipairs(sets) do
        set.joint, set.number = "J" .. i, set.number or 4
        set.origin = { size[1] / 2, size[2] / 2, size[3] / 2 }
        model:generate("jointset", set)
    end
end

local function brick(model, x, y, z, group)
    model:generate("box", { min = { x, y, z }, max = { x + 1, y + 1, z + 0.5 }, density = 2500, group = group })
end

-- A point of the unit circle with rational coordinates.
local function on_circle(t)
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
end

-- An irregular block about a centre: corners of a box, each drawn in by its own share.
local function pebble(model, center, size, salt)
    local vertices = {}
    for i = 0, 7 do
        local share = 0.7 + 0.3 * ((salt * 7 + i * 5) % 11) / 11
        local corner = { i % 2 * 2 - 1, i // 2 % 2 * 2 - 1, i // 4 * 2 - 1 }
        for k = 1, 3 do
            corner[k] = center[k] + size * share * corner[k] * (1 - 0.07 * ((salt + i + k) % 4))
        end
        vertices[i + 1] = corner
    end
    model:generate("polyhedron", { vertices = vertices, density = 2600, group = "pebbles" })
end

-- A wedge of rock on an inclined plane: the plane is level and gravity is turned.
local function sliding(note, damping, parameters)
    local model = talus.model { gravity = { 6, 1, -8 } }
    floor(model, { -2, -2, -1 }, { 8, 4, 0 })
    brick(model, 0, 0, 0, "block")
    brick(model, 0.25, 0.25, 0.5, "block")
    model:generate("prism", { base = { { 2, 0, 0 }, { 3, 0, 0 }, { 2.5, 1, 0 } }, axis = { 0, 0, 1 }, density = 2500,
        group = "block" })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 25, cohesion = 100 })
    if damping then
        model:damping(damping, parameters)
    end
    model:cycle(1500)
    note(model, "slides")
end

-- ---------------------------------------------------------------- scenes

scene("wall", function(note)
    local model = talus.model {}
    floor(model, { -1, -1, -1 }, { 6, 2, 0 })
    for row = 0, 5 do
        for column = 0, 4 - row % 2 do
            brick(model, column + row % 2 * 0.5, 0, row * 0.5, "wall")
        end
    end
    model:joint("*", "coulomb", ROCK)
    model:damping "local"
    note(model, "built")
    model:cycle(500)
    note(model, "settles")
end)

scene("rock", function(note)
    local model = talus.model { seed = 3, gravity = { 1, 0.5, -10 } }
    cut_box(model, { 4, 4, 3 }, {
        { dip = 45, dip_dev = 5, dip_direction = 220, dip_direction_dev = 8, spacing = 1, spacing_dev = 0.2,
            persistence = 0.8 },
        { dip = 80, dip_dev = 5, dip_direction = 100, spacing = 1.1 },
        { dip = 10, dip_direction = 0, spacing = 1 },
    })
    floor(model, { -2, -2, -1 }, { 6, 6, 0 })
    note(model, "built")
    model:joint("*", "coulomb", ROCK)
    model:joint("J1", "coulomb_tensile", { kn = 1e9, ks = 5e8, friction = 20, cohesion = 1e3, tension = 1e3 })
    model:damping "adaptive"
    model:timestep { rule = "body", fraction = 0.5 }
    model:cycle(400)
    note(model, "settles")
end)

scene("pebbles", function(note)
    local model = talus.model {}
    floor(model, { -4, -4, -1 }, { 4, 4, 0 })
    for i = 0, 11 do
        pebble(model, { i % 3 * 1.1 - 1.1, i // 3 % 2 * 1.2 - 0.6, 0.8 + i // 6 * 1.3 }, 0.5, i)
    end
    local blocks = model:blocks { group = "pebbles" }
    blocks:set { velocity = { 0.3, -0.2, -2 }, angular_velocity = { 3, -4, 2 } }
    model:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 30 })
    model:damping("combined", {})
    model:timestep { rule = "body", fraction = 0.3 }
    model:cycle(800)
    note(model, "tumble")
end)

-- Faster than the series of a turn holds for, and about all axes.
scene("spin", function(note)
    local model = talus.model { gravity = { 0, 0, -1 } }
    for i = 1, 3 do
        pebble(model, { 4 * i, 0, 0 }, 0.5, i)
    end
    for i, block in ipairs(model:blocks()) do
        model:blocks { id = block.id }:set { angular_velocity = { 10 * i, -40, 230 } }
    end
    model:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
    model:timestep { dt = 1e-3 }
    model:cycle(40)
    note(model, "turns")
end)

scene("tunnel", function(note)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -6, -4, -6 }, max = { 6, 4, 6 }, density = 2500, group = "rock" })
    for i, fault in ipairs { { 50, 320 }, { 40, 230 }, { 65, 270 } } do
        model:generate("joint", { joint = "F" .. i, dip = fault[1], dip_direction = fault[2], origin = { 1.5, 0.5, 5 } })
    end
    local function face(y)
        return { { -3, y, -3 }, { -3, y, 2 }, { -1, y, 3 }, { 1, y, 3 }, { 3, y, 2 }, { 3, y, -3 } }
    end
    model:generate("tunnel", { face1 = face(-4), face2 = face(4), group = "tunnel" })
    note(model, "built")
    model:blocks { group = "tunnel" }:delete()
    model:blocks { above = { dip = 0, dip_direction = 0, origin = { 0, 0, 5 } } }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 20 })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    model:cycle(400)
    note(model, "excavated")
end)

scene("arch", function(note)
    local model = talus.model { gravity = { 0, 0, -10 } }
    local angles = { { 1, 0 } }
    for i = 1, 7 do
        angles[#angles + 1] = { on_circle(i / 8) }
    end
    for i = 8, 1, -1 do -- the other quarter, turned about
        angles[#angles + 1] = { 0, 1 }
        angles[#angles] = i == 8 and { 0, 1 } or { -angles[i + 1][1], angles[i + 1][2] }
    end
    angles[#angles + 1] = { -1, 0 }
    for k = 1, #angles - 1 do
        local vertices = {}
        for i = k, k + 1 do
            for _, radius in ipairs { 0.85, 1.15 } do
                for y = 0, 1 do
                    vertices[#vertices + 1] = { radius * angles[i][1], 0.25 * y, radius * angles[i][2] }
                end
            end
        end
        model:generate("polyhedron", { vertices = vertices, density = 2000, group = "arch" })
    end
    for _, x in ipairs { -1.15, 0.85 } do
        floor(model, { x, 0, -0.25 }, { x + 0.3, 0.25, 0 })
    end
    model:joint("*", "coulomb", { kn = 2e9, ks = 2e9, friction = 50 })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    note(model, "built")
    model:cycle(300)
    note(model, "stands")
end)

scene("slide, no damping", function(note)
    sliding(note)
end)
scene("slide, viscous", function(note)
    sliding(note, "viscous", { alpha = 0.7 })
end)
scene("slide, local", function(note)
    sliding(note, "local", { alpha = 0.3 })
end)
scene("slide, adaptive", function(note)
    sliding(note, "adaptive", { start = 0.5 })
end)
scene("slide, combined", function(note)
    sliding(note, "combined", { alpha = 0.6 })
end)
scene("slide, kinetic", function(note)
    sliding(note, "kinetic")
end)

scene("driven and loaded", function(note)
    local model = talus.model { rotation = "paper" }
    floor(model, { -2, -2, -1 }, { 6, 6, 0 })
    for i = 0, 3 do
        brick(model, i * 1.5, i * 0.25, 0, "block" .. i)
    end
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30, dilation = 5 })
    model:blocks { group = "block0" }:drive { velocity = function(t)
        return { 0.5 * t, 0.25, 0 }
    end }
    model:blocks { group = "block1" }:drive { velocity = { 0.1, 0, 0 }, angular_velocity = { 0, 0, 0.3 } }
    model:blocks { group = "block2" }:load { force = { 6e3, 2e3, -1e4 }, at = { 3, 0.75, 0.5 }, moment = { 0, 10, 20 } }
    model:blocks { group = "block3" }:fix { x = true }
    model:damping "local"
    model:cycle(1000)
    note(model, "driven")
    model:blocks { group = "block0" }:free()
    model:mass_scaling(true)
    model:cycle(50)
    note(model, "free")
end)

scene("in situ", function(note)
    local model = talus.model {}
    cut_box(model, { 4, 4, 4 }, {
        { dip = 70, dip_direction = 40, spacing = 1.2 },
        { dip = 60, dip_direction = 200, spacing = 1.5, spacing_dev = 0.3 },
    })
    floor(model, { -1, -1, -1 }, { 5, 5, 0 })
    model:joint("*", "coulomb_tensile", { kn = 1e9, ks = 5e8, friction = 30, cohesion = 1e4, tension = 1e3,
        dilation = 4, dilation_limit = 0.01 })
    model:insitu { stress = { xx = -1e5, yy = -5e4, zz = -2e5, xy = 1e4 }, gradient = { zz = 2.5e4, xx = 1e4 },
        at = { 0, 0, 0 } }
    model:timestep { rule = "body", fraction = 0.5 }
    note(model, "stressed")
    model:cycle(100)
    note(model, "moves")
    model:joint("J1", { kn = 2e9, friction = 15 })
    model:cycle(50)
    note(model, "another kn")
end)

scene("pulled", function(note)
    local model = talus.model { gravity = { 0, 0, -10 } }
    floor(model, { -1, -1, 2 }, { 3, 3, 3 })
    brick(model, 0, 0, 1.5, "hangs")
    brick(model, 0, 1, 1.5, "hangs")
    brick(model, 0, 0, 1, "below")
    model:joint("*", "coulomb_tensile", { kn = 1e9, ks = 5e8, friction = 30, residual_friction = 20, cohesion = 2e4,
        tension = 2e4, residual_tension = 1e3, dilation = 10, dilation_limit = 1e-3 })
    model:cycle(200)
    note(model, "hangs")
    model:blocks { group = "below" }:load { force = { 1e4, 0, -3e4 } }
    model:cycle(300)
    note(model, "broken")
end)

scene("joint sets", function(note)
    local model = talus.model { seed = 11 }
    cut_box(model, { 5, 4, 3 }, {
        { dip = 60, dip_direction = 30, spacing = 1, distribution = "fisher", fisher_k = 80, number = 5 },
        { dip = 35, dip_dev = 6, dip_direction = 150, dip_direction_dev = 9, spacing = 1.1, spacing_dev = 0.2,
            distribution = "normal", persistence = 0.6, number = 5 },
        { dip = 80, dip_dev = 3, dip_direction = 260, spacing = 1.3, radius = 2, number = 3 },
    })
    note(model, "built")
end)

scene("shapes", function(note)
    local model = talus.model { contact_points = "corners" }
    floor(model, { -4, -4, -1 }, { 4, 4, 0 })
    model:generate("drum", { center = { -2, -2, 0.6 }, axis = { 1, 0.2, 0 }, radius = 0.5, height = 1, sides = 14,
        density = 2500, group = "thrown" })
    model:generate("tetrahedron", { vertices = { { 0, 0, 0.1 }, { 1, 0, 0.7 }, { 0, 1, 0.8 }, { -0.5, -0.5, 0.9 } },
        density = 2500, group = "thrown" })
    model:generate("prism", { base = { { 2, 2, 0.05 }, { 3, 2, 0.15 }, { 3, 3, 0.25 }, { 2, 3, 0.15 } },
        axis = { 0.2, 0, 0.7 }, density = 2500, group = "thrown" })
    pebble(model, { 2, -2, 0.6 }, 0.5, 4)
    note(model, "built")
    model:contact_area { absolute = 1e-3 }
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 20 })
    model:damping("viscous", { alpha = 1 })
    model:cycle(1500)
    note(model, "fallen")
end)

scene("read from files", function(note, folder)
    local model = talus.model { seed = 2 }
    cut_box(model, { 3, 3, 2 }, {
        { dip = 55, dip_direction = 70, spacing = 0.9 },
        { dip = 75, dip_direction = 170, spacing = 1.2 },
    })
    model:write_blocks(folder .. "/golden_blocks.json")
    local path = folder .. "/golden_solid.obj"
    local file = assert(io.open(path, "w"))
    file:write("v 0 0 2\nv 0.9 0 2.1\nv 0.1 0.8 2.2\nv 0.3 0.2 3.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
    file:close()

    local copy = talus.model { gravity = { 0, 1, -10 } }
    copy:generate("blocks", { file = folder .. "/golden_blocks.json" })
    copy:generate("import", { file = path, density = 2700, group = "solid", translate = { 1, 1, 0.001 } })
    floor(copy, { -1, -1, -1 }, { 4, 4, 0 })
    copy:joint("*", "coulomb", ROCK)
    copy:timestep { rule = "body", fraction = 0.5 }
    note(copy, "read")
    copy:cycle(150)
    note(copy, "moves")
end)

scene("edited", function(note)
    local model = talus.model { seed = 4, reuse_geometry = false }
    cut_box(model, { 4, 3, 3 }, {
        { dip = 65, dip_direction = 60, spacing = 1.1 },
        { dip = 50, dip_direction = 190, spacing = 1.3 },
    })
    floor(model, { -1, -1, -1 }, { 5, 4, 0 })
    model:joint("*", "coulomb", ROCK)
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    model:cycle(60)
    model:blocks { containing = { 1, 1, 1 } }:delete()
    model:cycle(40)
    note(model, "deleted")
    model:blocks { inside = { min = { 1.5, -0.5, -0.5 }, max = { 4.5, 3.5, 3.5 } } }:join()
    model:cycle(40)
    note(model, "joined")
    model:generate("joint", { joint = "late", dip = 30, dip_direction = 300, origin = { 2, 1.5, 1.5 } })
    model:cycle(40)
    note(model, "cut")
    model:blocks { group = "rock" }:unjoin()
    model:filter { aspect = 6, action = "join" }
    model:cycle(40)
    note(model, "unjoined")
end)

-- Zones of each solid, jointed, on a rigid floor.
scene("deformable", function(note)
    local model = talus.model { gravity = { 1, 0.5, -10 } }
    local strength = { young = 2e7, poisson = 0.25, cohesion = 2e3, friction = 30, dilation = 10, tension = 1e3 }
    floor(model, { -2, -2, -1 }, { 4, 4, 0 })
    cut_box(model, { 2, 2, 2 }, { { dip = 15, dip_direction = 70, spacing = 0.9 } })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    model:solid("rock", "mohr_coulomb", strength)
    model:solid("mass", "hoek_brown", { young = 2e7, poisson = 0.2, sigma_ci = 5e4, mb = 2, s = 0.02, a = 0.51 })
    model:solid("stone", "elastic", { young = 3e7, poisson = 0.3 })
    local solids = { "rock", "mass", "stone" }
    for i, block in ipairs(model:blocks { group = "rock" }) do
        model:blocks { id = block.id }:deformable { zone = 0.45, solid = solids[i % 3 + 1] }
    end
    note(model, "divided")
    model:damping "local"
    model:cycle(300)
    note(model, "settles")
end)

return scenes
