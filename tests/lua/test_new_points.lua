-- Contact points laid anew at one place carry what was there. Two equal faces of 3 to 24 corners are pressed on each other, or glued and
-- tilted open, and then turned and slid along each other to and fro by little, so that edges cross at small angles, and points come, go
-- and run along the edges. Normal force, its moments, energy, openings, bonds and damage follow the area and nothing else.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local KN, T, DT, STEPS = 1e8, 1.5e5, 1e-4, 30
local WORK = 4 * T ^ 2 / (2 * KN)
local rock = { kn = KN, ks = KN, friction = 40 }
local function with(more)
    for key, value in pairs(rock) do
        more[key] = more[key] or value
    end
    return more
end
-- `glued`: tilted open; else `stress` or pressed. `linear`: force and moments are those of a given linear stress.
local cases = {
    { "elastic", { kn = KN, ks = KN }, linear = true },
    { "coulomb", { kn = KN, ks = KN }, linear = true },
    { "coulomb", rock },
    { "coulomb", with { dilation = 10 } },
    { "coulomb", with { dilation = 35 } },
    { "coulomb_tensile", with { dilation = 10, tension = 1e4, cohesion = 1e4 } },
    { "coulomb_tensile", with { tension = T, cohesion = T }, glued = true },
    { "coulomb_tensile", with { tension = T, cohesion = T, residual_tension = T / 4, residual_cohesion = T / 3 }, glued = true },
    { "cohesive", with { tension = T, cohesion = T, energy_tension = WORK, energy_shear = WORK }, glued = true, own = true },
    { "barton_bandis", { jrc = 15, jcs = 1e8, phi_r = 28, kni = KN, vm = 10, ks = KN, linear_from = 2e6, length = 1 } },
    { "continuously_yielding", { an = KN, as = KN, phi_i = 50, phi = 40, roughness = 0.01 }, own = true },
    { "slip_weakening", with { residual_friction = 35, distance = 1e-3 } },
    { "rate_state", { kn = KN, ks = KN, mu0 = 0.84, a = 0.01, b = 0.015, dc = 1e-5, v0 = 1e-6 } },
}

local function uniform(a, b)
    return a + (b - a) * math.random()
end

local function log_uniform(a, b)
    return a * (b / a) ^ math.random()
end

local function sign()
    return math.random() < 0.5 and -1 or 1
end

-- Corners of a convex polygon about the origin.
local function polygon(corners)
    local turn, out, step = uniform(0, 2 * math.pi), {}, 2 * math.pi / corners
    local long = uniform(0.4, 0.7)
    for k = 1, corners do
        local a = turn + step * (k + uniform(-0.2, 0.2))
        out[k] = { long * math.cos(a), 0.5 * math.sin(a) }
    end
    return out
end

local function prism(model, face, low, high, group)
    local vertices = {}
    for _, c in ipairs(face) do
        vertices[#vertices + 1] = { low, c[1], c[2] }
        vertices[#vertices + 1] = { high, c[1], c[2] }
    end
    model:generate("polyhedron", { vertices = vertices, density = 2500, group = group })
end

-- Sums over the points, energies, and the least bond and the most damage since `last`.
local function sums(contact, energy, last)
    local s = { force = 0, y = 0, z = 0, area = 0, points = #contact.points }
    for _, p in ipairs(contact.points) do
        s.force = s.force + p.normal_force
        s.y = s.y + p.normal_force * p.position[2]
        s.z = s.z + p.normal_force * p.position[3]
        s.area = s.area + p.area
    end
    for _, values in ipairs { energy, contact.states } do
        for name, value in pairs(values) do
            s[name] = value
        end
    end
    s.least_bond = s.bond and math.min(s.bond, last and last.least_bond or 1)
    s.most_damage = s.damage and math.max(s.damage, last and last.most_damage or 0)
    return s
end

local STRESS, SLOPE = 2e5, 2e5
-- Turns are as precise as the shape of the polygon: what is off goes with the way of a step over the size.
local LIMITS = {
    ["linear force"] = 1e-4, ["linear moment"] = 2e-4, ["linear energy"] = 1e-4, ["opening that is lost"] = 1e-6,
    ["bond that has come back"] = 2e-4, ["damage that has healed"] = 1e-4, ["heat that is lost"] = 1e-6,
    ["balance"] = 1e-2, ["energy from nothing"] = 2.5e-3
}

local function note(what, value, text)
    check.holds(value <= LIMITS[what], ("%s: %s, %g"):format(text, what, value))
end

-- One step from `last` to `now`, sums and energies.
local function compare(case, last, now, text)
    local other = math.abs(now.area / last.area - 1)
    local gain = now.stored + now.friction - last.stored - last.friction - now.external + last.external
    if case.linear then
        note("linear force", math.abs(now.force * last.area / (now.area * last.force) - 1), text)
        note("linear moment", math.sqrt((now.y - last.y) ^ 2 + (now.z - last.z) ^ 2) / last.force, text)
        note("linear energy", math.abs(gain) / last.stored - 3 * other, text)
    else
        note("balance", math.abs(now.balance), text)
    end
    if now.opening then
        note("opening that is lost", (last.opening - now.opening) / math.max(last.opening, 1e-9) - 2 * other, text)
    end
    note("bond that has come back", (now.bond or 0) - (now.least_bond or 1), text)
    note("damage that has healed", (now.most_damage or 0) - (now.damage or 1), text)
    if now.points ~= last.points then
        local whole = last.stored + last.friction
        note("energy from nothing", gain / whole, text)
        -- the heat of a law that keeps a stress beside the force is what the contact has lost: what it gains from nothing is heat that it loses
        note(case.own and "energy from nothing" or "heat that is lost", (last.friction - now.friction) / whole, text)
    end
end

local function run(seed, case)
    math.randomseed(seed)
    local corners = math.random(3, 24)
    local text = ("%s, seed %d, %d corners"):format(case[1], seed, corners)
    local face = polygon(corners)
    local model = talus.model { gravity = { 0, 0, 0 } }
    prism(model, face, -1, 0, "below")
    prism(model, face, 0, 1, "above")
    model:blocks { group = "below" }:fix()
    model:joint("*", case[1], case[2])
    model:timestep { dt = DT }
    local above = model:blocks { group = "above" }
    above:drive { velocity = { 0, 0, 0 } }
    if case.linear then
        model:cycle(2)
        model:insitu { stress = { xx = -STRESS }, gradient = { xx = uniform(-SLOPE, SLOPE) }, at = { 0, 0, 0 } }
    elseif case.glued then
        above:drive { velocity = { 2e-2, 0, 0 }, angular_velocity = { 0, uniform(-5e-2, 5e-2), uniform(-5e-2, 5e-2) } }
        model:cycle(math.random(200, 700))
    else
        above:drive { velocity = { -2e-2, 0, 0 } }
        model:cycle(1000)
        above:drive { velocity = { 0, 0, 0 }, angular_velocity = { 0.05 * sign(), 0, 0 } }
        model:cycle(math.random(100, 1000))
    end
    above:drive { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } }
    model:cycle(2)
    local last
    for _ = 1, 8 do
        local way, turn, a = log_uniform(1e-6, 1e-3), log_uniform(3e-6, 1e-3), uniform(0, 2 * math.pi)
        local v, w = way / (STEPS * DT), turn / (STEPS * DT) * sign()
        v = math.random() < 0.3 and 0 or v
        w = math.random() < 0.3 and 0 or w
        above:drive { velocity = { 0, v * math.cos(a), v * math.sin(a) }, angular_velocity = { w, 0, 0 } }
        for _ = 1, STEPS do
            model:cycle(1)
            local contact = model:contacts()[1]
            if not contact then
                return
            end
            local now = sums(contact, model:energy(), last)
            if last then
                compare(case, last, now, text)
            end
            last = now
        end
    end
end

for seed = 1, check.cases(325) do
    run(seed, cases[seed % #cases + 1])
end
