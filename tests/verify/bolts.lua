-- Bolts against closed forms: pull-out, slip of the grout, opening and shearing joints, a hanging block.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_bolts"

local NONE = 1e12 -- N, a strength that is never reached

-- Held boxes along x with faces at the places `at`; box k moves by move[k] in `steps` steps, and `each` sees every one.
local function drive(at, bolt, move, steps, each)
    local model = talus.model { gravity = { 0, 0, 0 } }
    for k = 1, #at - 1 do
        model:generate("box", { min = { at[k], -0.5, -0.5 }, max = { at[k + 1], 0.5, 0.5 }, density = 2500 })
    end
    model:blocks():fix()
    model:joint("*", "coulomb", { kn = 1, ks = 1, friction = 0 }) -- the joints bear nothing
    bolt.from, bolt.to = { at[1], 0, 0 }, { bolt.length or at[#at], 0, 0 }
    bolt.length = nil
    local e = model:element("bolt", bolt)[1]
    model:timestep { dt = 1e-3 }
    local blocks = model:blocks()
    for k, way in pairs(move) do
        local v = {}
        for i = 1, 3 do
            v[i] = way[i] / (steps * 1e-3)
        end
        model:blocks { id = blocks[k].id }:set { velocity = v }
    end
    for _ = 1, steps do
        model:cycle(1)
        if each then
            each(e)
        end
    end
    blocks:set { velocity = { 0, 0, 0 } } -- one step more: elements act where blocks are when a step begins
    model:cycle(1)
    return e, model
end

-- Force at the mouth of a grouted length, which is where the way through box 2 begins, and how far it has come out.
local function mouth(e)
    for i, node in ipairs(e.nodes) do
        if node.crosses == 1 then
            local inner = e.nodes[i + 1]
            return node.tension, inner.rock - inner.steel, i + 1
        end
    end
end

local function pull(case, spacing, more)
    local c = case.inputs
    local bolt = { diameter = c.diameter, young = c.E, yield = NONE, grout_stiffness = c.grout_stiffness_per_metre,
        grout_strength = NONE, plate_strength = NONE, plate_stiffness = 1e9, spacing = spacing,
        grouted_from = 0.1 / (c.length + 0.1) }
    for k, v in pairs(more or {}) do
        bolt[k] = v
    end
    return bolt, { -0.1, 0, c.length }
end

for _, name in ipairs { "stiff", "soft" } do
    local case = reference["BOLT.pull." .. name]
    local c, expected = case.inputs, case.expected
    figures.case("BOLT.pull." .. name, "A grouted bar is pulled out of rock: stiffness against the chain of as many "
        .. "elements, and forces along the bar against the closed form.", "Cox 1952; Farmer 1975")
    for n, stiffness in pairs(expected.stiffness_of_chain_with_n_elements) do
        local bolt, at = pull(case, c.length / n)
        local force, out = mouth(drive(at, bolt, { { -1e-4, 0, 0 } }, 1))
        figures.relative("stiffness of " .. n .. " elements", force / out, stiffness, 1e-6)
    end
    -- Nodes at distances h make a bar stiffer by (beta h)^2 / 8. Half of h leaves a quarter of that: two bars and a line
    -- through them to h = 0 give the closed form.
    local function shares(spacing)
        local bolt, at = pull(case, spacing)
        local e = drive(at, bolt, { { -1e-4, 0, 0 } }, 1)
        local force, out, first = mouth(e)
        local list = {}
        for x in pairs(expected.axial_force_at) do
            local i = first + math.floor(x / spacing + 0.5)
            list[x] = x > 0 and 0.5 * (e.nodes[i - 1].tension + e.nodes[i].tension) / force
        end
        return force / out, list
    end
    local coarse, fine = 0.01, 0.005 -- m
    local K1, share1 = shares(coarse)
    local K2, share2 = shares(fine)
    figures.relative("stiffness", K2 / (1 + (expected.beta * fine) ^ 2 / 8), expected.stiffness, 1e-6)
    figures.relative("stiffness, without distance", (4 * K2 - K1) / 3, expected.stiffness, 1e-6)
    for x, axial in pairs(expected.axial_force_at) do
        if x > 0 then
            local share = (4 * share2[x] - share1[x]) / 3
            figures.relative("axial force at " .. x .. " m", share * c.force, axial, 1e-5)
        end
    end
end

for _, name in ipairs { "plastic", "brittle" } do
    local case = reference["BOLT.slip." .. name]
    local c = case.inputs
    figures.case("BOLT.slip." .. name, "A grouted bar whose grout slips, the displacement of its mouth controlled: force "
        .. "at the mouth.", "piecewise solution of E A w'' = t")
    -- brittle grout breaks node by node, so its curve is a saw whose teeth are as long as the elements
    local bolt, at = pull(case, name == "brittle" and 0.0125 or 0.05, { grout_strength = c.bond_strength_per_metre,
        grout_residual = c.residual_per_metre, plate_stiffness = 1e12, plate_strength = NONE })
    local curve = {}
    local e, model = drive(at, bolt, { { -2.6e-3, 0, 0 } }, 1300, function(one)
        local force, out = mouth(one)
        curve[#curve + 1] = { out, force }
    end)
    for u, want in pairs(case.expected.force_by_mouth_displacement) do
        local k = 1
        while curve[k][1] < u do
            k = k + 1
        end
        local a, b = curve[k - 1] or { 0, 0 }, curve[k]
        local force = a[2] + (b[2] - a[2]) * (u - a[1]) / (b[1] - a[1])
        figures.relative(("force at %g m"):format(u), force, want.force, 0.02)
    end
    figures.equal("yielded", e.yielded, true)
    figures.near("balance", model:energy().balance, 0, 1e-4)
end

for _, name in ipairs { "1e+09", "5e+09" } do
    local case = reference["BOLT.opening." .. name]
    local c = case.inputs
    figures.case("BOLT.opening." .. name, "A joint opens across a bolt that is grouted on both sides.",
        "two pull-outs in series")
    local function bolt()
        return { diameter = c.diameter, young = c.E, yield = NONE, grout_stiffness = c.grout_stiffness_per_metre,
            grout_strength = NONE, plate_stiffness = 0, spacing = 0.025 } -- (beta h)^2 / 8 is 0.4 % for the stiffer grout
    end
    local e = drive({ -1, 0, 1 }, bolt(), { { -c.opening, 0, 0 } }, 1)
    figures.relative("force at the joint", e.axial, case.expected.force_at_joint, 0.01)
    local at = { -1, 0, 0.4, 1 }
    local a = drive(at, bolt(), { { -1e-4, 0, 0 } }, 1)
    local b = drive(at, bolt(), { [3] = { 2e-4, 0, 0 } }, 1)
    local both = drive(at, bolt(), { { -1e-4, 0, 0 }, [3] = { 2e-4, 0, 0 } }, 1)
    local most = 0
    for i = 1, #both.nodes do
        most = math.max(most, math.abs(both.nodes[i].tension - a.nodes[i].tension - b.nodes[i].tension))
    end
    figures.near("two openings superpose", most / both.axial, 0, 1e-9)
end

for _, angle in ipairs { 0, 30, 45, 60 } do
    local case = reference["BOLT.shear." .. angle]
    local c, alpha = case.inputs, math.rad(angle)
    figures.case("BOLT.shear." .. angle, "A joint slides across a bolt, which is an axial spring and a dowel there.",
        "local reinforcement, small displacement, after Lorig 1985")
    local s, co = math.sin(alpha), math.cos(alpha)
    local area = 0.25 * math.pi * 0.025 ^ 2
    for slip, want in pairs(case.expected.by_shear_displacement) do
        -- the free length, 0.2 m of it on either side, in series with the plate
        local free, along = 200e9 * area / 0.4, c.axial_stiffness
        local bolt = { grouted_from = 0.4 / 0.5, grout_stiffness = 1e13, grout_strength = NONE, yield = c.axial_yield,
            plate_stiffness = 1 / (1 / along - 1 / free), plate_strength = NONE, dowel_stiffness = c.dowel_stiffness,
            dowel_strength = c.dowel_yield, active_length = 1e5, rupture_strain = 100 }
        local e, model = drive({ -0.2, 0, 0.3 }, bolt, { [2] = { slip * s, slip * co, 0 } }, 200)
        local fx, fy = 0, 0
        for _, node in ipairs(e.nodes) do
            if node.block.id == 2 then
                fx, fy = fx + node.force[1], fy + node.force[2]
            end
        end
        local resists, closes = -(fx * s + fy * co), -(fx * co - fy * s)
        local friction = math.tan(math.rad(c.friction_deg))
        local name = ("%g m: "):format(slip)
        figures.relative(name .. "resistance", (c.normal_force + closes) * friction + resists, want.resistance, 0.01)
        figures.near(name .. "axial", e.axial, want.axial, 0.01 * c.axial_yield)
        figures.near(name .. "dowel", e.shear, want.dowel, 0.01 * c.dowel_yield)
        figures.near(name .. "balance", model:energy().balance, 0, 1e-4)
    end
end

figures.case("BOLT.hang", "A roof block hangs on a bolt that is anchored above it: its weight against plate and free length "
    .. "in series.", "springs in series")
local case = reference["BOLT.hang"]
local c, want = case.inputs, case.expected
local function hang(damping)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -1, -1, 0.9 }, max = { 1, 1, 3 }, density = 2500 })
    model:blocks():fix()
    model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 0.9 }, density = c.weight / 9 })
    model:joint("*", "coulomb", { kn = 1, ks = 1, friction = 0 })
    if damping then
        model:damping(damping)
    end
    local bolt = model:element("bolt", { from = { 0, 0, 0 }, to = { 0, 0, 2 }, grouted_from = 0.9, spacing = 0.1,
        diameter = c.diameter, young = c.E, grout_stiffness = 1e13, grout_strength = 1e9, pretension = c.pretension,
        plate_stiffness = c.plate_stiffness })
    return model, bolt[1]
end
local model, bolt = hang "local"
figures.near("pretension", bolt.axial, c.pretension, 1e-6 * c.pretension)
model:solve { measure = "local", ratio = 1e-8, max_cycles = 100000 }
figures.relative("elongation at rest", -model:blocks { fixed = false }[1].displacement[3], want.elongation_at_rest, 1e-4)
figures.relative("tension", bolt.axial, want.force, 1e-4)
figures.relative("plate", bolt.plate, want.force, 1e-4)
model, bolt = hang()
model:timestep { dt = want.period / 1000 }
local block = model:blocks { fixed = false }[1]
-- from rest it swings about where it hangs, and is back at the top after a period
local last, periods, begun = nil, 0, nil
for _ = 1, 5100 do
    model:cycle(1)
    local v = block.velocity[3]
    if last and last > 0 and v <= 0 then
        local at = model.time - model.dt * v / (v - last)
        begun, periods = begun or at, periods + 1
        last = nil
        if periods == 5 then
            figures.relative("period", (at - begun) / 4, want.period, 1e-3)
        end
    end
    last = v
end
figures.equal("periods", periods, 5)
figures.near("balance", model:energy().balance, 0, 1e-6)

-- ------------------------------------------------------------ factors of safety

-- The prism on a plane of tests/verify/safety.lua, its bolt an anchor through the plane instead of a load.
local safety = require "reference_safety"
local plane, cases = safety.plane, {}
for _, one in ipairs(safety.plane.cases) do
    cases[one.id] = one
end
local active = cases["FS.plane.bolt_active"]
local water = cases["FS.plane.water"].load
local along, force = {}, 0
for k = 1, 3 do
    along[k] = active.load[k] - water[k]
    force = math.sqrt(force ^ 2 + along[k] ^ 2)
end

-- The bolt begins 4 m above the toe on the front of the prism and is 10 m long, grouted on its last 2 m.
local function prism(bolt, friction)
    local t = math.tan(math.rad(plane.dip))
    local model = talus.model { gravity = { 0, 0, -plane.g } }
    local function profile(section)
        model:generate("profile", { section = section, from = 0, to = plane.width, density = plane.density })
    end
    profile { { 0, -4 }, { 14, -4 }, { 14, 14 * t }, { 0, 0 } }
    model:blocks():fix()
    profile { { plane.front, plane.front * t }, { plane.rear, plane.rear * t }, { plane.rear, plane.top },
        { plane.front, plane.top } }
    local block = model:blocks { fixed = false }
    block:fix { rotation = true }
    block:load { force = water }
    model:joint("*", "coulomb", { kn = 1e9, ks = 2e8, friction = friction })
    bolt.from = { plane.front, 0.5, plane.front * t + 4 }
    bolt.to = {}
    for k = 1, 3 do
        bolt.to[k] = bolt.from[k] + 10 * along[k] / force
    end
    bolt.grouted_from = bolt.grouted_from or 0.8
    bolt.grout_stiffness, bolt.grout_strength, bolt.plate_strength = 1e10, 1e9, 1e9
    model:element("bolt", bolt)
    return model
end

-- Load of the anchors: a soft one keeps its pretension; a stiff one yields at it.
figures.case("FS.bolt_active", "A prism on a plane with water and a bolt of constant force: a pretensioned anchor that is soft, "
    .. "and stiff ones that yield, one of which nothing has pulled before.", "Hoek and Bray 1977, chapter 7")
local FINE = 0.002 -- width of a bracket, relative
local anchors = {
    soft = { pretension = force, young = 1e8, yield = 1e9, active_length = 100, rupture_strain = 100 },
    ["yields"] = { pretension = 0.999 * force, yield = force, active_length = 100, rupture_strain = 10 },
    ["yields, not pretensioned"] = { yield = force, active_length = 100, rupture_strain = 10 },
}
for _, name in ipairs { "soft", "yields", "yields, not pretensioned" } do
    model = prism(anchors[name], active.friction)
    if name == "soft" then
        figures.relative("keyblocks", model:keyblocks { friction = active.friction }[1].safety, active.FS, 1e-3)
    end
    local r = model:factor_of_safety { resolution = FINE }
    figures.relative(name, r.factor, active.FS, 0.005)
    figures.equal(name .. ": undecided", r.undecided, 0)
end

-- Strengths of plane and bolt over the factor, in equilibrium: both parts of the bolt's force are divided. In the formula the
-- part that presses the plane together is not.
figures.case("FS.bolt_passive", "The same with a bolt whose strength is divided by the factor, as that of the plane is: at 1 % "
    .. "below the factor it holds, at 1 % above it the prism slides.", "Hoek and Bray 1977, chapter 7")
local PASSIVE, EQUILIBRIUM = 1.0416075216, 1.0377728824
for _, grouted in ipairs { 0.8, 0 } do
    local r = prism({ yield = force / EQUILIBRIUM, grouted_from = grouted, active_length = 100, rupture_strain = 10 },
        active.friction):factor_of_safety { resolution = FINE }
    local name = ("grouted from %g: "):format(grouted)
    figures.relative(name .. "equilibrium", r.factor, EQUILIBRIUM, 0.002)
    figures.relative(name .. "formula", r.factor, PASSIVE, 0.005)
end
for _, share in ipairs { 0.99, 1.01 } do
    local F = PASSIVE * share
    local friction = math.deg(math.atan(math.tan(math.rad(active.friction)) / F))
    local one = prism({ yield = force / F, active_length = 100, rupture_strain = 10 }, friction)
    one:damping "local"
    local r = one:solve { ratio = 1e-5, max_cycles = 20000, stop = function()
        return one:blocks { fixed = false }[1].displacement[1] < -0.2
    end, every = 50 }
    figures.equal(("factor %.4f"):format(F), r.reason, share < 1 and "ratio" or "stop")
    figures.relative("tension", one:elements {}[1].axial, force / F, share < 1 and 1e-3 or 1e-9)
end

figures.finish()
