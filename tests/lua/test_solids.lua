-- test_solids.lua - solids on one zone (talus.solid_test) against the figures of solid_reference.lua and closed forms.
local check = require "check"
local reference = require "solid_reference"
local talus = require "talus"

local ORDER = { "xx", "yy", "zz", "xy", "yz", "zx" }

local function components(list)
    local out = {}
    for k, name in ipairs(ORDER) do
        out[name] = list[k]
    end
    return out
end

-- The components of a curve at a point; the last one when none is named.
local function at(curve, what, i)
    local out = {}
    for k, name in ipairs(ORDER) do
        out[k] = curve[what][name][i or #curve.work]
    end
    return out
end

local function largest(list)
    local most = 0
    for _, x in ipairs(list) do
        most = math.max(most, math.abs(x))
    end
    return most
end

-- Work that is neither stored nor dissipated, over the largest of the three.
local function imbalance(curve)
    local n = #curve.work
    local off = math.abs(curve.work[n] - curve.stored[n] - curve.dissipated[n])
    return off / math.max(math.abs(curve.work[n]), curve.stored[n], curve.dissipated[n])
end

-- ------------------------------------------------------------------ elasticity

do
    local case = reference.uniaxial
    local elastic = { young = case.inputs.E, poisson = case.inputs.nu }
    local curve = talus.solid_test { solid = "elastic", params = elastic, path = { { stress = { zz = case.inputs.stress } } } }
    check.near(curve.strain.zz[101], case.expected.strain, 1e-9 * math.abs(case.expected.strain))
    check.near(curve.strain.xx[101], case.expected.lateral, 1e-9 * case.expected.lateral)
    check.near(curve.stored[101], case.expected.energy, 1e-9 * case.expected.energy)
    check.holds(imbalance(curve) < 1e-9)

    case = reference.oedometer
    curve = talus.solid_test { solid = "elastic", params = elastic, steps = 7, every = 3,
        path = { { stress = { zz = case.inputs.stress }, strain = { xx = 0, yy = 0 } } } }
    check.equal(#curve.work, 4)
    check.equal(curve.ends[1], 4)
    check.near(curve.strain.zz[4], case.expected.strain, 1e-9 * math.abs(case.expected.strain))
    check.near(curve.stress.xx[4], case.expected.lateral_stress, 1e-9 * math.abs(case.expected.lateral_stress))

    case = reference.simple_shear
    curve = talus.solid_test { solid = "elastic", params = elastic, path = { { strain = { xy = case.inputs.gamma / 2 } } } }
    check.near(at(curve, "stress"), { 0, 0, 0, case.expected.tau, 0, 0 }, 1e-9 * case.expected.tau)

    -- bulk and shear modulus give the same
    local K, G = 1e10 / 3 / (1 - 0.5), 1e10 / 2 / 1.25
    local same = talus.solid_test { solid = "elastic", params = { bulk = K, shear = G }, path = { { strain = { xy = case.inputs.gamma / 2 } } } }
    check.near(at(same, "stress"), at(curve, "stress"), 1e-6)
end

do -- free ends: the modulus across the layers, along them and between
    local case = reference.transverse
    local i = case.inputs
    for angle, modulus in pairs(case.expected.E_at_angle) do
        -- the load is along z, and the layers dip by the angle between their normal and z
        local params = { young_plane = i.E_plane, young_across = i.E_across, poisson_plane = i.nu_plane, poisson_across = i.nu_across,
            shear_across = i.G_across, dip = tonumber(angle), dip_direction = 37 }
        local curve = talus.solid_test { solid = "transverse", params = params, path = { { stress = { zz = -1e6 } } } }
        check.near(-1e6 / curve.strain.zz[101], modulus, 1e-9 * modulus)
        check.holds(imbalance(curve) < 1e-9)
        check.near(math.abs(curve.states.axis[101][3]), math.cos(math.rad(tonumber(angle))), 1e-12)
    end
end

-- ------------------------------------------------------------------ Mohr-Coulomb

do
    local case = reference.mc_returns
    local yields, worst = 0, 0
    for _, c in ipairs(case.inputs.cases) do
        local params = { bulk = case.inputs.K, shear = case.inputs.G, cohesion = c.cohesion, friction = c.friction, dilation = c.dilation,
            tension = c.tension }
        local curve = talus.solid_test { solid = "mohr_coulomb", params = params, stress = components(c.before), steps = 1,
            path = { { strain = components(c.strain) } } }
        check.equal(curve.shear[2] or curve.tension[2], c.yields == 1)
        check.near(at(curve, "stress"), c.after, 1e-7 * largest(c.after))
        for k, s in ipairs(at(curve, "stress")) do
            worst = math.max(worst, math.abs(s - c.after[k]) / largest(c.after))
        end
        yields = yields + c.yields
    end
    check.holds(yields > 40)
    check.holds(worst < 1e-12, ("returns off by %g"):format(worst))
end

-- Squeezed along z with the sides held at a pressure: the path of a triaxial test.
local function triaxial(solid, params, pressure, strain, steps)
    return talus.solid_test { solid = solid, params = params, stress = { xx = -pressure, yy = -pressure, zz = -pressure },
        path = { { strain = { zz = strain }, stress = { xx = -pressure, yy = -pressure }, steps = steps } } }
end

do
    local case = reference.triaxial_mc
    local i = case.inputs
    local params = { young = i.E, poisson = i.nu, cohesion = i.cohesion, friction = i.friction, dilation = i.dilation }
    for k, pressure in ipairs(i.confining) do
        local curve = triaxial("mohr_coulomb", params, pressure, -0.01, 200)
        check.near(-curve.stress.zz[201], case.expected.peak[k], 1e-9 * case.expected.peak[k])
        check.near(curve.stress.xx[201], -pressure, 1e-9 * case.expected.peak[k])
        check.holds(curve.shear[201] and not curve.shear[2])
        -- at the peak all strain is plastic
        local axial = curve.strain.zz[201] - curve.strain.zz[150]
        local sides = curve.strain.xx[201] - curve.strain.xx[150] + curve.strain.yy[201] - curve.strain.yy[150]
        check.near(sides / axial, case.expected.dilatancy, 1e-6)
        check.holds(imbalance(curve) < 1e-3)
    end
end

do
    local case = reference.tension_cutoff
    local i = case.inputs
    local params = { young = i.E, poisson = i.nu, cohesion = i.cohesion, friction = i.friction, tension = i.tension }
    local curve = talus.solid_test { solid = "mohr_coulomb", params = params, path = { { strain = { xx = 1e-3 } } } }
    check.near(at(curve, "stress"), { case.expected.uniaxial_tension, 0, 0, 0, 0, 0 }, 1e-9 * i.tension)
    check.holds(curve.tension[101] and not curve.shear[101])
    local all = { xx = 1e-3, yy = 1e-3, zz = 1e-3, xy = 0, yz = 0, zx = 0 }
    curve = talus.solid_test { solid = "mohr_coulomb", params = params, path = { { strain = all } } }
    check.near(at(curve, "stress"), { i.tension, i.tension, i.tension, 0, 0, 0 }, 1e-9 * i.tension)
    -- more tension than the apex has is lowered to it; so is none at all
    for _, tension in ipairs { 1e8, false } do
        params.tension = tension or nil
        curve = talus.solid_test { solid = "mohr_coulomb", params = params, path = { { strain = all } } }
        check.near(curve.stress.xx[101], case.expected.apex, 1e-9 * case.expected.apex)
    end
end

do -- strength over plastic strain
    local case = reference.softening
    local i = case.inputs
    local rows = {}
    for k, x in ipairs(i.cohesion_table[1]) do
        rows[k] = { x, i.cohesion_table[2][k] }
    end
    local params = { young = i.E, poisson = i.nu, friction = i.friction, dilation = i.dilation, cohesion_table = rows }
    local curve = talus.solid_test { solid = "mohr_coulomb", params = params, path = { { strain = { zz = -0.01 }, steps = 10000 } } }
    local measure = curve.states.plastic_shear
    for wanted, stress in pairs(case.expected.stress_at_plastic_measure) do
        local k = 1
        while k < #measure and measure[k] < tonumber(wanted) + 1e-12 do
            k = k + 1
        end
        check.near(-curve.stress.zz[k], stress, 0.01 * stress)
    end
    local n = #measure
    local plastic = -(curve.strain.zz[n] - curve.stress.zz[n] / i.E)
    check.near(measure[n] / plastic, case.expected.measure_per_axial_plastic_strain, 1e-6)
    check.holds(imbalance(curve) < 1e-3)
    for k = 2, n do
        check.holds(curve.dissipated[k] >= curve.dissipated[k - 1])
    end
    -- in a zone ten times as large as the table is for, the same strain is ten times as far along it
    params.table_extent = 0.1
    local large = talus.solid_test { solid = "mohr_coulomb", params = params, path = { { strain = { zz = -1e-3 }, steps = 1000 } } }
    check.near(large.states.plastic_shear[1001], 10 * math.sqrt(0.75) * (1e-3 + large.stress.zz[1001] / i.E), 1e-7)
end

do -- tables of friction, dilation and tension
    local params = { young = 1e10, poisson = 0.25, cohesion = 1e6, friction_table = { { 0, 40 }, { 0.01, 20 } },
        dilation_table = { { 0, 12 }, { 0.01, 0 } } }
    local curve = triaxial("mohr_coulomb", params, 1e6, -0.05, 2000)
    local n = math.tan(math.rad(45 + 10)) ^ 2
    check.near(-curve.stress.zz[2001], n * 1e6 + 2e6 * math.sqrt(n), 1e-6 * n * 1e6)
    params = { young = 1e10, poisson = 0.25, cohesion = 1e6, friction = 30, tension_table = { { 0, 4e5 }, { 0.001, 1e5 } } }
    curve = talus.solid_test { solid = "mohr_coulomb", params = params, path = { { strain = { xx = 2e-3 }, steps = 2000 } } }
    check.near(curve.stress.xx[2001], 1e5, 1)
    check.near(math.max(table.unpack(curve.stress.xx)), 4e5, 4e3)
    check.near(curve.states.plastic_tension[2001], 2e-3 - 1e5 / 1e10, 1e-9)
end

-- ------------------------------------------------------------------ the other surfaces

do
    local case = reference.hoek_brown
    local i = case.inputs
    local params = { young = 1e10, poisson = 0.25, sigma_ci = i.sigma_ci, mb = i.mb, s = i.s, a = i.a }
    for _, dilation in ipairs { 0, 15, 60 } do
        params.dilation = dilation
        for k, pressure in ipairs(i.confining) do
            local curve = triaxial("hoek_brown", params, pressure, -0.02, 200)
            check.near(-curve.stress.zz[201], case.expected.peak[k], 1e-9 * case.expected.peak[k])
        end
        -- along one axis alone f is met a little earlier: s1 = F(s1)
        local curve = talus.solid_test { solid = "hoek_brown", params = params, path = { { strain = { xx = 1e-3, yy = 1e-3, zz = 1e-3 } } } }
        check.near(curve.stress.xx[101], case.expected.tension, 1e-9 * case.expected.tension)
    end
    -- from the index: gsi 50, mi 10, D 0.5
    local m, s, a = 10 * math.exp(-50 / 21), math.exp(-50 / 7.5), 0.5 + (math.exp(-50 / 15) - math.exp(-20 / 3)) / 6
    params = { young = 1e10, poisson = 0.25, sigma_ci = 50e6, gsi = 50, mi = 10, disturbance = 0.5 }
    local curve = triaxial("hoek_brown", params, 2e6, -0.02, 200)
    check.near(-curve.stress.zz[201], 2e6 + 50e6 * (m * 2e6 / 50e6 + s) ^ a, 1)
end

do
    local case = reference.drucker_prager
    for _, meridian in ipairs { "outer", "inner" } do
        local e = case.expected[meridian]
        local params = { young = 1e10, poisson = 0.25, friction = case.inputs.friction, cohesion = case.inputs.cohesion, meridian = meridian }
        local curve = triaxial("drucker_prager", params, 1e6, -0.02, 200)
        local s = curve.stress
        local p, root = (s.xx[201] + s.yy[201] + s.zz[201]) / 3, math.abs(s.zz[201] - s.xx[201]) / math.sqrt(3)
        check.near(root + e.q * p, e.k, 1e-9 * e.k)
        local all = { xx = 1e-3, yy = 1e-3, zz = 1e-3 }
        curve = talus.solid_test { solid = "drucker_prager", params = params, path = { { strain = all } } }
        check.near(curve.stress.xx[101], e.k / e.q, 1e-9 * e.k)
    end
end

do -- a weak plane: Jaeger's strength over the angle between plane and load
    local rock = { young = 1e10, poisson = 0.25, cohesion = 2e6, friction = 40, joint_cohesion = 2e5, joint_friction = 30, dip_direction = 200 }
    local t = math.tan(math.rad(30))
    for dip = 0, 90, 15 do
        rock.dip = dip
        local curve = triaxial("ubiquitous", rock, 1e6, -0.01, 200)
        local b = math.rad(dip)
        local n = math.tan(math.rad(65)) ^ 2
        local strength = n * 1e6 + 4e6 * math.sqrt(n)
        local sliding = math.sin(2 * b) * (1 - t / math.tan(b))
        if sliding > 1e-6 then
            strength = math.min(strength, 1e6 + 2 * (2e5 + 1e6 * t) / sliding)
        end
        check.near(-curve.stress.zz[201], strength, 1e-6 * strength)
        check.equal(curve.joint[201], dip > 30 and dip < 90)
        check.holds(imbalance(curve) < 5e-3)
    end
end

-- ------------------------------------------------------------------ what is refused

local soft = { young = 1e10, poisson = 0.25 }
check.raises(function() talus.solid_test { solid = "elastick", params = soft, path = { { strain = { xx = 1 } } } } end, "unknown solid 'elastick'; did you mean 'elastic'?")
check.raises(function() talus.solid_test { solid = "elastic", params = { young = 1e10 }, path = { { strain = { xx = 1 } } } } end,
    "give young and poisson, or bulk and shear")
check.raises(function() talus.solid_test { solid = "elastic", params = { young = 1e10, poisson = 0.5 }, path = { { strain = { xx = 1 } } } } end,
    "poisson = 0.5 is outside (-1, 0.5)")
check.raises(function() talus.solid_test { solid = "elastic", params = soft, path = {} } end, "path has no legs")
check.raises(function() talus.solid_test { solid = "elastic", params = soft, path = { { strain = { xx = 1 }, stress = { xx = 1 } } } } end,
    "path[1]: xx has both a stress and a strain")
check.raises(function() talus.solid_test { solid = "elastic", params = soft, path = { { strain = { xq = 1 } } } } end, "path[1], strain: unknown parameter 'xq'")
check.raises(function() talus.solid_test { solid = "elastic", params = soft, path = { 3 } } end, "path[1] must be a table")
check.raises(function()
    talus.solid_test { solid = "mohr_coulomb", params = { young = 1e10, poisson = 0.25, cohesion = 1e6, friction = 30 }, path = { { stress = { zz = -1e8 } } } }
end, "cannot hold the stress")
check.raises(function()
    talus.solid_test { solid = "mohr_coulomb", params = { young = 1e10, poisson = 0.25, friction = 30, cohesion_table = { { 0, 1 }, { 0, 2 } } },
        path = { { strain = { zz = -1e-3 } } } }
end, "cohesion_table, row 2: its first number, 0, must be larger")
check.raises(function()
    talus.solid_test { solid = "transverse", params = { young_plane = 1e10, young_across = 1e9, poisson_plane = 0.2, poisson_across = 0.4, shear_across = 1e9 },
        path = { { strain = { zz = -1e-3 } } } }
end, "negative energy")

-- ------------------------------------------------------------------ what is loaded

local known = {}
for _, solid in ipairs(talus.solids()) do
    known[solid.name] = solid
end
for _, name in ipairs { "elastic", "transverse", "mohr_coulomb", "ubiquitous", "drucker_prager", "hoek_brown" } do
    check.holds(known[name], name)
end
check.equal(known.ubiquitous.plugin, "talus.solid_ubiquitous")
check.equal(known.ubiquitous.states[3], "normal")
