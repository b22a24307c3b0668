-- every_law.lua - every joint law there is, with several sets of parameters each, for tests that hold for all of them.
--
--     for _, joint in ipairs(every_law(kn, pressure)) do model:joint("*", joint.law, joint.params) end
--
-- `kn`, Pa/m, is the stiffness of all of them at a normal stress of `pressure`, Pa, or about; strengths go with `pressure`, so
-- that a law does the same at any scale. Angles of friction are 40 degrees, or about. The last ones come from another folder:
-- tests/plugins and the template of plugins/template/law.
--
--     name            what tells it in a message
--     law, params     of model:joint
--     stress          normal stress of a closure, as no_tension.lua takes it
--     tension         tensile strength of the bond of walls that were together from the beginning, Pa; 0 for none
--     tension_after   what is left of it once it is lost, or where walls come together from a gap, Pa
--     opens           slip opens the joint
--     curved          the stress is no line
--     yields          shear yields from the first
--     stiffest        bound of the stiffness, Pa/m
local no_tension = require "no_tension"
local talus = require "talus"

local FRICTION = 40 -- degrees

-- Parameters common to laws with linear springs, and more.
local function springs(kn, more)
    local p = { kn = kn, ks = kn, friction = FRICTION }
    for key, value in pairs(more or {}) do
        p[key] = value
    end
    return p
end

-- A bond that softens: its works of fracture are `ductility` times what its springs hold when damage begins.
local function softening(kn, strength, ductility)
    local work = ductility * strength ^ 2 / (2 * kn)
    return springs(kn, { tension = strength, cohesion = strength, energy_tension = work, energy_shear = work })
end

local function coulomb(add, kn, p)
    add("coulomb", "coulomb", springs(kn))
    add("coulomb, cohesion", "coulomb", springs(kn, { cohesion = 0.1 * p }))
    add("coulomb, dilation 1", "coulomb", springs(kn, { dilation = 1 }), { opens = true })
    add("coulomb, dilation 10", "coulomb", springs(kn, { dilation = 10 }), { opens = true })
    add("coulomb, dilation 20, limited", "coulomb", springs(kn, { dilation = 20, dilation_limit = p / kn }), { opens = true })
end

local function bonds(add, kn, p)
    local function tensile(name, tension, more, about)
        about = about or {}
        about.tension = tension
        more.tension, more.cohesion = tension, tension
        add("coulomb_tensile, " .. name, "coulomb_tensile", springs(kn, more), about)
    end
    tensile("faint bond", 1e-5 * p, {})
    tensile("weak bond", 0.1 * p, {})
    tensile("strong bond", 3 * p, { residual_friction = 35 })
    tensile("weak bond, dilation 5", 0.1 * p, { dilation = 5 }, { opens = true })
    tensile("some tension is left", 0.1 * p, { residual_tension = 0.02 * p }, { tension_after = 0.02 * p })
    add("cohesive, faint", "cohesive", softening(kn, 1e-5 * p, 3), { tension = 1e-5 * p })
    add("cohesive, weak and brittle", "cohesive", softening(kn, 0.1 * p, 1.05), { tension = 0.1 * p })
    add("elastic", "elastic", { kn = kn, ks = kn }, { tension = math.huge, tension_after = math.huge })
end

local function rough(add, kn, p)
    local function bandis(name, vm, from, dilates)
        add("barton_bandis, " .. name, "barton_bandis", { jrc = 8, jcs = 1000 * p, phi_r = 35, kni = kn, vm = vm, ks = kn,
            linear_from = from, dilation = dilates }, { opens = dilates, curved = vm < 100 * p / kn,
            stress = no_tension.hyperbolic(kn, vm, from), stiffest = kn * (1 + from / (kn * vm)) ^ 2 })
    end
    bandis("straight", 1e5 * p / kn, 30 * p, true)
    bandis("no dilation", 1e5 * p / kn, 30 * p, false)
    bandis("curved", 5 * p / kn, 5 * p, true)
    add("continuously_yielding", "continuously_yielding", { an = kn, as = kn, phi_i = 50, phi = FRICTION, roughness = 0.01 },
        { opens = true, yields = true })
    add("continuously_yielding, no dilation", "continuously_yielding", { an = kn, as = kn, phi_i = 50, phi = FRICTION,
        roughness = 0.01, softening = false, dilation = false }, { yields = true })
    local at_one = kn / math.sqrt(p)
    add("continuously_yielding, curved", "continuously_yielding", { an = at_one, en = 0.5, as = at_one, es = 0.5,
        kn_max = 3 * kn, ks_max = 3 * kn, phi_i = 50, phi = FRICTION, roughness = 0.01 }, { opens = true, curved = true, yields = true,
        stress = no_tension.power(at_one, 0.5, 3 * kn), stiffest = 3 * kn })
end

local function frictions(add, kn)
    add("slip_weakening", "slip_weakening", springs(kn, { residual_friction = 35, distance = 1e-3 }))
    add("slip_weakening, heals", "slip_weakening", springs(kn, { residual_friction = 35, distance = 1e-3,
        form = "exponential", healing = "instant" }))
    for _, evolution in ipairs { "aging", "slip" } do
        add("rate_state, " .. evolution, "rate_state", { kn = kn, ks = kn, mu0 = 0.84, a = 0.01, b = 0.015, dc = 1e-5,
            evolution = evolution })
    end
end

-- Laws that the program does not bring with it.
local function foreign(add, kn, p)
    local there = {}
    for _, law in ipairs(talus.laws()) do
        there[type(law) == "table" and law.name or law] = true
    end
    if not (there.glue and there.my_law) then
        error("the laws 'glue' and 'my_law' are missing: the environment must have "
            .. "TALUS_PLUGIN_PATH=BUILD_FOLDER/tests/plugins", 0)
    end
    local function glue(name, strength, climb)
        add("glue, " .. name, "glue", { stiff = kn, soft = kn, angle = FRICTION, strength = strength, climb = climb },
            { tension = strength, opens = climb > 0 })
    end
    glue("none", 0, 0)
    glue("faint", 1e-5 * p, 5)
    glue("weak", 0.1 * p, 0)
    add("my_law", "my_law", { kn = kn, ks = kn, friction = FRICTION, residual = 35, distance = 1e-3 })
end

-- Those whose name has `pattern` in it, or all.
return function(kn, pressure, pattern)
    local list = {}
    local function add(name, law, params, about)
        local joint = about or {}
        joint.name, joint.law, joint.params = name, law, params
        joint.stress = joint.stress or no_tension.linear(kn)
        joint.stiffest = joint.stiffest or kn
        joint.tension, joint.tension_after = joint.tension or 0, joint.tension_after or 0
        if not pattern or name:find(pattern) then
            list[#list + 1] = joint
        end
    end
    coulomb(add, kn, pressure)
    bonds(add, kn, pressure)
    rough(add, kn, pressure)
    frictions(add, kn)
    foreign(add, kn, pressure)
    return list
end
