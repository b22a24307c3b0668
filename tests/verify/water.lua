-- Water: joints by the cubic law, networks, a joint that fills in time, and a dam with uplift, with and without flow.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_water"

local GW = 1e4 -- N/m3

-- Rock of a length and width with a level joint "level" at z = 0, in parts along x; all is held.
local function strip(length, width, parts)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, -1 }, max = { length, width, 1 }, density = 2500 })
    model:generate("joint", { joint = "level", dip = 0, dip_direction = 0, origin = { 0, 0, 0 } })
    for k = 1, parts - 1 do
        model:generate("joint", { joint = "parts", dip = 90, dip_direction = 90, origin = { k * length / parts, 0, 0 } })
    end
    model:blocks():fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    return model
end

-- The box about the edge at x.
local function at(x, width)
    return { min = { x - 1e-3, -1, -1e-3 }, max = { x + 1e-3, width + 1, 1e-3 } }
end

local function check_one()
    figures.case("FLOW.one", "A joint of one aperture between two heads, whole and in seven parts.", "closed form")
    local case = reference["FLOW.one"]
    local c, e = case.inputs, case.expected
    for _, parts in ipairs { 1, 7 } do
        local model = strip(c.length, c.width, parts)
        model:water("flow", { joints = "level", aperture = c.aperture, viscosity = c.viscosity, unit_weight = GW,
            heads = { { inside = at(0, c.width), head = c.dp / GW }, { inside = at(c.length, c.width), head = 0 } } })
        local r = model:flow()
        figures.near(parts .. " parts: flow in, m3/s", r.heads[1].flow, e.Q, 1e-9 * e.Q)
        figures.near(parts .. " parts: flow out, m3/s", r.heads[2].flow, -e.Q, 1e-9 * e.Q)
    end
end

local function check_taper()
    figures.case("FLOW.taper", "A joint whose aperture grows along it, in 20 parts.", "closed form")
    local case = reference["FLOW.taper"]
    local c, e = case.inputs, case.expected
    local model = strip(c.length, c.width, 20)
    model:water("flow", { joints = "level", viscosity = c.viscosity, unit_weight = GW,
        aperture = function(x)
            return c.aperture_at_ends[1] + (c.aperture_at_ends[2] - c.aperture_at_ends[1]) * x / c.length
        end,
        heads = { { inside = at(0, c.width), head = c.dp / GW }, { inside = at(c.length, c.width), head = 0 } } })
    figures.near("flow, m3/s", model:flow().heads[1].flow, e.Q, 0.01 * e.Q)
    local sum, count = 0, 0
    for _, joint in ipairs(model:flow().joints) do
        for _, node in ipairs(joint.nodes) do
            if math.abs(node.rest[1] - c.length / 2) < 1e-6 and math.abs(node.rest[3]) < 1e-6 then
                sum, count = sum + node.pressure, count + 1
            end
        end
    end
    figures.near("pressure in the middle, Pa", sum / count, e.pressure_at_middle, 0.02 * e.pressure_at_middle)
end

-- A slice of rock 1 m thick with joints at each x = 0, s, 2 s .. and z = 0, s, 2 s ..
local function check_network(id)
    figures.case(id, "A grid of joints, each piece with an aperture of its own.", "independent calculation")
    local case = reference[id]
    local c, e = case.inputs, case.expected
    local s, nx, nz = c.spacing, c.nx, c.nz
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { -s, 0, -s }, max = { (nx + 1) * s, 1, (nz + 1) * s }, density = 2500 })
    for i = 0, nx do
        model:generate("joint", { joint = "V", dip = 90, dip_direction = 90, origin = { i * s, 0, 0 } })
    end
    for j = 0, nz do
        model:generate("joint", { joint = "H", dip = 0, dip_direction = 0, origin = { 0, 0, j * s } })
    end
    model:blocks():fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    -- Which piece has its middle there: its number in the list of apertures, or nil outside of the grid; its ends.
    local function piece(x, z)
        local i, j = x / s, z / s
        if math.abs(j - math.floor(j + 0.5)) < 0.1 then
            i, j = math.floor(i), math.floor(j + 0.5)
            if i >= 0 and i < nx and j >= 0 and j <= nz then
                return j * nx + i + 1, { i, j }, { i + 1, j }
            end
        else
            i, j = math.floor(i + 0.5), math.floor(j)
            if i >= 0 and i <= nx and j >= 0 and j < nz then
                return (nz + 1) * nx + i * nz + j + 1, { i, j }, { i, j + 1 }
            end
        end
    end
    local function side(x)
        return { min = { x - 0.1, -1, -0.1 }, max = { x + 0.1, 2, nz * s + 0.1 } }
    end
    model:water("flow", { viscosity = c.viscosity, unit_weight = c.unit_weight,
        aperture = function(x, _, z) return c.apertures[piece(x, z)] or c.mean_aperture end,
        heads = { { inside = side(0), head = c.head_left }, { inside = side(nx * s), head = c.head_right } } })
    local r = model:flow()
    figures.near("flow in, m3/s", r.heads[1].flow, e.Q, 1e-6 * e.Q)
    figures.near("flow out, m3/s", r.heads[2].flow, -e.Q, 1e-6 * e.Q)
    local worst, count = 0, 0
    for _, joint in ipairs(r.joints) do
        local x, z = 0, 0
        for _, node in ipairs(joint.nodes) do
            x, z = x + node.rest[1] / #joint.nodes, z + node.rest[3] / #joint.nodes
        end
        local number, a, b = piece(x, z)
        if number then
            local mean = (e.heads[a[1] .. "," .. a[2]] + e.heads[b[1] .. "," .. b[2]]) / 2
            worst, count = math.max(worst, math.abs(joint.head - mean)), count + 1
        end
    end
    figures.near("pieces", count, #c.apertures, 0)
    figures.near("largest error of a head, m", worst, 0, 1e-5)
end

local function check_filling()
    figures.case("FLOW.filling", "A closed joint fills from one end, in 40 parts.", "closed form")
    local case = reference["FLOW.filling"]
    local c, e = case.inputs, case.expected
    local model = strip(c.length, 1, 40)
    model:water("flow", { joints = "level", aperture = c.aperture, viscosity = c.viscosity, unit_weight = GW,
        bulk = c.fluid_bulk, steady = false, heads = { { inside = at(0, 1), head = 1 } } })
    local goal, dt = e.time_to_half_pressure_at_closed_end, 2.5e-4
    model:timestep { dt = dt }
    local function far_end()
        for _, joint in ipairs(model:flow().joints) do
            local x = 0
            for _, node in ipairs(joint.nodes) do
                x = x + node.rest[1] / #joint.nodes
            end
            if x > c.length * 39.25 / 40 then
                return joint.head
            end
        end
    end
    local before = far_end()
    while far_end() < 0.5 do
        before = far_end()
        model:cycle(1)
    end
    local now = far_end() -- of the beginning of the last step
    local time = model.time - dt - dt * (now - 0.5) / (now - before)
    figures.near("time to half of the pressure at the end, s", time, goal, 0.002 * goal)
end

-- The statics of a dam whose water has a table, in the program and in the reference.
local function check_uplift(id)
    figures.case(id, "A gravity dam on its base joint, with uplift.", "statics")
    local case = reference[id]
    local c, e = case.inputs, case.expected
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, -4 }, max = { c.base, 1, 0 }, density = 2700, group = "rock" })
    model:generate("polyhedron", { vertices = { { 0, 0, 0 }, { c.base, 0, 0 }, { 0, 0, c.height },
        { 0, 1, 0 }, { c.base, 1, 0 }, { 0, 1, c.height } }, density = c.unit_weight / 10, group = "dam" })
    model:blocks { group = "rock" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = c.friction_deg, cohesion = c.cohesion })
    model:boundary { facing = { -1, 0, 0 }, box = { min = { 0, 0, 0 }, max = { 0, 1, c.height } },
        water_level = c.water, unit_weight = GW }
    local drain = c.drain_x_and_factor
    model:water("field", { pressure = function(x)
        local full = GW * c.water
        if not drain then
            return full * (1 - x / c.base)
        elseif x < drain[1] then
            return full * (1 + (drain[2] - 1) * x / drain[1])
        end
        return full * drain[2] * (c.base - x) / (c.base - drain[1])
    end })
    local body = model:keyblocks { friction = c.friction_deg, cohesion = c.cohesion }[1]
    -- the field is asked at three points of one polygon: exact where it is linear
    if not drain then
        figures.near("factor of safety", body.safety, e.FS, 0.005 * e.FS)
    end
    return model, c, e
end

-- A drained uplift that is not linear needs the joint cut at the drain.
local function check_drain()
    local id = "DAM.drain"
    figures.case(id, "A gravity dam on its base joint, with a drain that lowers the uplift.", "statics")
    local c, e = reference[id].inputs, reference[id].expected
    local x, k = c.drain_x_and_factor[1], c.drain_x_and_factor[2]
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, -4 }, max = { x, 1, 0 }, density = 2700, group = "rock" })
    model:generate("box", { min = { x, 0, -4 }, max = { c.base, 1, 0 }, density = 2700, group = "rock" })
    model:generate("polyhedron", { vertices = { { 0, 0, 0 }, { c.base, 0, 0 }, { 0, 0, c.height },
        { 0, 1, 0 }, { c.base, 1, 0 }, { 0, 1, c.height } }, density = c.unit_weight / 10, group = "dam" })
    model:blocks { group = "rock" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = c.friction_deg, cohesion = c.cohesion })
    model:boundary { facing = { -1, 0, 0 }, box = { min = { 0, 0, 0 }, max = { 0, 1, c.height } },
        water_level = c.water, unit_weight = GW }
    local full = GW * c.water
    model:water("field", { pressure = function(px)
        return full * (px < x and 1 + (k - 1) * px / x or k * (c.base - px) / (c.base - x))
    end })
    local uplift = 0
    for _, element in ipairs(model:elements { kind = "water", block = model:blocks { group = "dam" }[1].id }) do
        for _, node in ipairs(element.nodes) do
            uplift = uplift + (node.block.group == "dam" and node.weight * node.source or 0)
        end
    end
    figures.near("uplift, N", uplift, e.U, 1e-9 * e.U)
    figures.near("factor of safety", model:keyblocks { friction = c.friction_deg, cohesion = c.cohesion }[1].safety, e.FS,
        0.005 * e.FS)
end

-- A rigid dam that is free to turn on a joint in 32 parts, whose aperture follows the effective stress, with flow.
local function check_coupled(id)
    figures.case(id, "A dam on a joint whose aperture follows the load, with the flow under it.", "independent calculation")
    local c, e = reference[id].inputs, reference[id].expected
    local model = talus.model { gravity = { 0, 0, -10 } }
    for k = 1, 32 do
        model:generate("box", { min = { (k - 1) * c.base / 32, 0, -4 }, max = { k * c.base / 32, 1, 0 }, density = 2700,
            group = "rock" })
    end
    model:generate("polyhedron", { vertices = { { 0, 0, 0 }, { c.base, 0, 0 }, { 0, 0, c.height },
        { 0, 1, 0 }, { c.base, 1, 0 }, { 0, 1, c.height } }, density = c.unit_weight / 10, group = "dam" })
    model:blocks { group = "rock" }:fix()
    model:joint("*", "coulomb", { kn = c.kn, ks = c.kn, friction = 60 })
    model:contact_area { fraction = 0 }
    model:boundary { facing = { -1, 0, 0 }, box = { min = { 0, 0, 0 }, max = { 0, 1, c.height } },
        water_level = c.water, unit_weight = GW }
    model:damping "local"
    model:water("flow", { aperture = c.aperture_at_zero_stress, residual = c.aperture_residual, maximum = 0.01,
        viscosity = c.viscosity, unit_weight = GW, every = 20,
        heads = { { inside = at(0, 1), head = c.water }, { inside = at(c.base, 1), head = 0 } } })
    model:solve { measure = "local", ratio = 1e-7 }
    model:cycle(200)
    local r = model:flow()
    local dam, uplift, ends = model:blocks { group = "dam" }[1], 0, {}
    local pressure = {}
    for _, joint in ipairs(r.joints) do
        local x, on = 0, false
        for _, node in ipairs(joint.nodes) do
            x = x + node.rest[1] / #joint.nodes
            on = on or node.block == dam
            if node.block == dam then
                uplift = uplift + node.force[3]
                pressure[math.floor(node.rest[1] + 0.5)] = node.pressure
            end
        end
        ends[on and x < 1 and 1 or on and x > c.base - 1 and 2 or 3] = joint.aperture
    end
    figures.near("uplift, N", uplift, e.U, 0.02 * e.U)
    figures.near("flow, m3/s", r.heads[1].flow, e.Q, 0.05 * e.Q)
    for _, x in ipairs { 4, 8, 16, 24 } do
        figures.near("pressure at x = " .. x .. ", Pa", pressure[x], e.pressure_at[x], 0.01 * e.pressure_at[4])
    end
    for k, name in ipairs { "heel", "toe" } do
        figures.near("aperture at the " .. name .. ", m", ends[k], e.aperture_heel_toe[k], 0.02 * e.aperture_heel_toe[k])
    end
end

check_one()
check_taper()
check_network("FLOW.network.3x2")
check_network("FLOW.network.8x5")
check_filling()
check_uplift("DAM.full_uplift")
check_drain()
check_uplift("DAM.cohesion")
check_coupled("DAM.coupled.stiff")
check_coupled("DAM.coupled.soft")
figures.finish()
