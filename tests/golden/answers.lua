-- answers.lua - what can be asked of models, as texts with every bit of their numbers: { name =, run = function(note, folder) } with
-- note(model, stage, text), whose text is compared as a state is. Asking changes no state: the scenes are made of the same parts.
local talus = require "talus"

local answers = {}

local function answer(name, run)
    answers[#answers + 1] = { name = name, run = run }
end

-- A value and all that it holds as text: numbers in full, keys in order. Names of files and times of day are left out.
local function told(value, out, depth)
    out, depth = out or {}, depth or 0
    if math.type(value) == "float" then
        out[#out + 1] = ("%a"):format(value)
    elseif type(value) == "table" and depth < 6 then
        local keys = {}
        for key in pairs(value) do
            keys[#keys + 1] = key
        end
        table.sort(keys, function(a, b) return tostring(a) < tostring(b) end)
        for _, key in ipairs(keys) do
            out[#out + 1] = tostring(key) .. "="
            told(value[key], out, depth + 1)
        end
    elseif type(value) == "userdata" then
        out[#out + 1] = value.id and tostring(value.id) -- a block
    elseif type(value) ~= "function" then
        out[#out + 1] = tostring(value)
    end
    return depth == 0 and table.concat(out, " ") or out
end

local function text_of(path)
    local file <close> = assert(io.open(path, "rb"))
    return file:read "a"
end

local function box(model, min, max, group)
    model:generate("box", { min = min, max = max, density = 2500, group = group })
end

-- A slope of jointed rock of which a wedge is let go.
local function slope()
    local model = talus.model { gravity = { 0, 0, -10 }, seed = 12 }
    model:generate("profile", { section = { { 0, 0 }, { 12, 0 }, { 12, 8 }, { 5, 8 }, { 2, 2 }, { 0, 2 } }, to = 6, density = 2600, group = "rock" })
    model:generate("joint", { joint = "D1", dip = 48, dip_direction = 230, origin = { 6, 3.5, 7 } })
    model:generate("joint", { joint = "D2", dip = 52, dip_direction = 310, origin = { 6, 2.5, 7 } })
    model:generate("jointset", { joint = "S", dip = 12, dip_direction = 85, spacing = 1.9, number = 3, origin = { 6, 3, 5 } })
    model:boundary { xmax = "roller", ymin = "roller", ymax = "roller", zmin = "fixed" }
    model:joint("*", "coulomb", { kn = 5e8, ks = 2e8, friction = 33 })
    model:joint("D1", "coulomb_tensile", { kn = 5e8, ks = 2e8, friction = 28, cohesion = 5e3, tension = 2e3, dilation = 3 })
    model:damping "local"
    return model
end

local function facts(model)
    local contacts, blocks, list = model:contacts(), model:blocks(), {}
    for _, field in ipairs { "area", "normal", "point", "gap", "normal_force", "shear_force", "normal_stress", "shear_stress", "shear_displacement" } do
        list[field] = contacts:values(field, "flat")
    end
    for _, field in ipairs { "volume", "mass", "centroid", "displacement", "velocity", "angular_velocity", "speed", "force", "moment" } do
        local good, values = pcall(blocks.values, blocks, field, "flat")
        list["of blocks: " .. field] = good and values or nil
    end
    list.states = {}
    for i, contact in ipairs(contacts) do
        list.states[i] = contact.state .. " " .. contact.law .. " " .. contact.joint
    end
    return told(list)
end

answer("slope", function(note, folder)
    local model = slope()
    note(model, "keyblocks before", told(model:keyblocks { friction = 30 }))
    note(model, "slivers", told(model:filter { volume = 0.6, aspect = 5, edge = 0.5 }))
    note(model, "step", told { model:timestep().dt, model:timestep().message })
    model:cycle(250)
    note(model, "facts", facts(model))
    note(model, "keyblocks", told(model:keyblocks { friction = { ["*"] = 30, D2 = 25 }, cohesion = { ["*"] = 0, D1 = 2e3 } }))
    note(model, "pushed keyblocks", told(model:keyblocks { friction = 30, gravity = { -4, 1, -9 } }))
    local energy = model:energy()
    assert(energy.strain == 0 and energy.plastic == 0, "rigid blocks have no energy in zones")
    energy.strain, energy.plastic = nil, nil
    note(model, "energy", told(energy))
    note(model, "verdict", told(model:verdict()))
    local top = model:boundary { facing = { 0, 0, 1 }, within = 30 }
    note(model, "boundary", told { top.area, top.faces })
    note(model, "loaded", told { model:boundary { side = "xmin", stress = { xx = -1e4, xy = 2e3 }, gradient = { xx = 3e3 }, at = { 0, 0, 1 } }.force })
    model:joint("*", { friction = 10 })
    model:stage "weaker"
    model:history { name = "one", of = model:blocks { containing = { 5, 3, 6 } }, field = "velocity", every = 10 }
    model:history { name = "kinetic", value = "kinetic", every = 7 }
    model:solve { ratio = 1e-4, max_cycles = 600, stop_at_failure = true }
    note(model, "verdict of failure", told(model:verdict()))
    note(model, "facts of failure", facts(model))
    note(model, "histories", told(model:histories()))
    note(model, "keyblocks of failure", told(model:keyblocks { friction = 30 }))
    model:write_section(folder .. "/golden_cut", { dip = 90, dip_direction = 0, origin = { 5, 3, 3 } })
    model:write_vtk(folder .. "/golden", { contacts = true })
    for _, name in ipairs { "cut_section", "blocks", "contacts", "joints" } do
        note(model, name .. " for ParaView", text_of(folder .. "/golden_" .. name .. "_000000.vtk"))
    end
end)

-- Blocks whose corners press, tilted and turned on each other.
answer("tilted", function(note)
    local model = talus.model { gravity = { 0.4, 0.2, -9 }, seed = 2 }
    box(model, { -3, -3, -1 }, { 3, 3, 0 }, "floor")
    model:blocks { group = "floor" }:fix()
    model:generate("polyhedron", { vertices = { { 0, 0, -0.001 }, { 1, 0.1, 0.01 }, { 0.9, 1, 0.02 }, { 0.1, 0.9, 0.03 }, { 0, 0.1, 1 }, { 1, 0.2, 1.1 },
        { 0.9, 0.9, 1 }, { 0.2, 1, 0.9 } }, density = 2500, group = "stone" })
    model:generate("tetrahedron", { vertices = { { 0.2, 0.2, 0.93 }, { 1, 0.4, 1.4 }, { 0.1, 0.9, 1.5 }, { 0.6, 0.6, 2 } }, density = 2500, group = "top" })
    box(model, { 1, -1, 0 }, { 1.5, 2, 2 }, "wall")
    note(model, "facts without laws", facts(model))
    note(model, "keyblocks without laws", told(model:keyblocks { friction = 25 }))
    note(model, "state without laws", model:copy():state_hash() .. model:state_hash())
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    for stage = 1, 6 do
        model:cycle(120)
        note(model, "facts " .. stage, facts(model))
        note(model, "keyblocks " .. stage, told(model:keyblocks { friction = 25 }))
    end
    local rows = {}
    for i, contact in ipairs(model:contacts()) do
        for k, point in ipairs(contact.points) do
            rows[#rows + 1] = { i, k, point.area, point.position, point.normal_force, point.shear_force, point.state }
        end
    end
    note(model, "points", told(rows))
end)

-- ---------------------------------------------------------------- laws on one point

local LAWS = {
    { "coulomb", { kn = 1e10, ks = 5e9, friction = 32, cohesion = 1e5, dilation = 6, dilation_limit = 0.01 } },
    { "coulomb_tensile", { kn = 1e10, ks = 5e9, friction = 32, cohesion = 3e5, tension = 1e5, residual_friction = 25, residual_tension = 1e4 } },
    { "cohesive", { kn = 1e10, ks = 1e10, tension = 2e5, cohesion = 4e5, energy_tension = 20, energy_shear = 60, friction = 30 } },
    { "barton_bandis", { jrc = 11, jcs = 8e7, phi_r = 27, length = 0.4, kni = 1e10, vm = 5e-4, ks = 5e9 } },
    { "continuously_yielding", { an = 4e5, en = 0.6, as = 2e5, es = 0.6, kn_max = 1e11, ks_max = 1e11, phi_i = 48, phi = 30, roughness = 2e-3 } },
    { "rate_state", { kn = 1e10, ks = 1e10, a = 0.012, b = 0.02, distance = 1e-5, damping = 1e6 } },
    { "slip_weakening", { kn = 1e10, ks = 1e10, friction = 38, residual_friction = 20, distance = 2e-3, healing = "instant" } },
    { "elastic", { kn = 1e10, ks = 5e9 } },
}
local WAYS = {
    { "sheared", { normal_stress = 1e6, path = { 0.004, -0.002, 0.006 }, steps = 60 } },
    { "held", { normal_stress = 1e6, stiffness = 2e9, path = { 0.003, { shear = -0.001, speed = 1e-3 }, { time = 5 } }, steps = 50 } },
    { "pressed", { path = { { closure = 2e-4 }, { closure = 0.5e-4 }, { closure = -1e-4 }, { closure = 1e-4, shear = 1e-3 } }, steps = 40 } },
    { "stressed", { normal_stress = 2e5, path = { { normal_stress = 3e6 }, { shear = 0.002 }, { normal_stress = 5e5, shear = 0.001 } }, steps = 40 } },
}

answer("law", function(note)
    for _, law in ipairs(LAWS) do
        for _, way in ipairs(WAYS) do
            local asked = { law = law[1], params = law[2] }
            for key, value in pairs(way[2]) do
                asked[key] = value
            end
            local good, curve = pcall(talus.law_test, asked)
            note(nil, law[1] .. " " .. way[1], good and told(curve) or curve)
        end
    end
end)

return answers
