-- Strength and stiffness of zones: what one zone answers to paths of strain and stress (talus.solid_test), and a block
-- of zones that is led along the same strains.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local EXACT = 1e-9      -- relative: returns are exact, and straight paths need no small steps
local CONE = 1e-12      -- relative
local PEAK = 1e-6       -- of the peak
local RETURN = 1e-7     -- of the largest stress
local SOFTENING = 0.01  -- relative, with strains of 1e-6 a step
local SAME = 1e-9       -- of the largest stress on the path: a block of zones against one zone
local STEP = 1e-4       -- s, any

local function components(list)
    local out = {}
    for k, name in ipairs(zones.COMPONENTS) do
        out[name] = list[k]
    end
    return out
end

-- A cube of a few zones, all gridpoints held.
local function cube(solid, params)
    local model = zones.model { solid = solid, params = params }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    model:blocks():deformable { zone = 0.6, solid = "rock" }
    model:timestep { dt = STEP }
    local points = model:gridpoints {}
    points:fix()
    return model, points
end

-- Leads a block of zones along the strains of a curve, whose zone began without stress. The largest difference of a
-- component of stress in any zone at every tenth point, over the largest there was.
local function replay(solid, params, curve)
    local model, points = cube(solid, params)
    local off, most = 0, 0
    for i = 2, #curve.work do
        local by = {}
        for k, name in ipairs(zones.COMPONENTS) do
            by[k] = curve.strain[name][i] - curve.strain[name][i - 1]
        end
        zones.strain(model, points, by, STEP)
        if i % 10 == 1 or i == #curve.work then
            points:set { velocity = { 0, 0, 0 } }
            model:cycle(1)
            local all = model:zones {}
            for _, name in ipairs(zones.COMPONENTS) do
                off = math.max(off, zones.off(all, "stress", name, curve.stress[name][i]))
                most = math.max(most, math.abs(curve.stress[name][i]))
            end
        end
    end
    return off / most
end

local function check_replay(name, solid, params, curve)
    figures.near(name .. "block of zones, off by, of the largest stress", replay(solid, params, curve), 0, SAME)
end

-- Pressed on all sides, then squeezed along z by a strain, with the sides held at the pressure.
local function triaxial(solid, params, pressure, strain, steps)
    local all = { xx = -pressure, yy = -pressure, zz = -pressure }
    return talus.solid_test { solid = solid, params = params, path = { { stress = all, steps = 10 },
        { stress = { xx = -pressure, yy = -pressure }, strain = { zz = strain }, steps = steps } } }
end

-- ------------------------------------------------------------------ Mohr-Coulomb

do
    local case = reference["DF.mc_returns"]
    figures.case("DF.mc_returns", "From a stress within the surface of Mohr and Coulomb one step of strain leads out of it: where "
        .. "does the stress come to lie? On planes, edges, the apex and the corners with tension; on one zone, and in a block of "
        .. "zones, which comes to the first stress by the elastic strain.", case.source)
    local K, G = case.inputs.K, case.inputs.G
    local yields, wrong, worst, block = 0, 0, 0, 0
    for _, c in ipairs(case.inputs.cases) do
        local params = { bulk = K, shear = G, cohesion = c.cohesion, friction = c.friction, dilation = c.dilation, tension = c.tension }
        local most = 0
        for k = 1, 6 do
            most = math.max(most, math.abs(c.after[k]))
        end
        local curve = talus.solid_test { solid = "mohr_coulomb", params = params, stress = components(c.before), steps = 1,
            path = { { strain = components(c.strain) } } }
        local model, points = cube("mohr_coulomb", params)
        local mean, elastic = (c.before[1] + c.before[2] + c.before[3]) / 3, {}
        for k = 1, 6 do
            local volume = k <= 3 and mean or 0
            elastic[k] = (c.before[k] - volume) / (2 * G) + volume / (3 * K)
        end
        zones.strain(model, points, elastic, STEP)
        zones.strain(model, points, c.strain, STEP)
        points:set { velocity = { 0, 0, 0 } }
        model:cycle(1)
        local all = model:zones {}
        for k, name in ipairs(zones.COMPONENTS) do
            worst = math.max(worst, math.abs(curve.stress[name][2] - c.after[k]) / most)
            block = math.max(block, zones.off(all, "stress", name, c.after[k]) / most)
        end
        yields = yields + ((curve.shear[2] or curve.tension[2]) and 1 or 0)
        wrong = wrong + ((curve.shear[2] or curve.tension[2]) == (c.yields == 1) and 0 or 1)
    end
    figures.near("worst of " .. #case.inputs.cases .. " cases, of the largest stress", worst, 0, RETURN)
    figures.near("worst in a block of zones, of the largest stress", block, 0, RETURN)
    figures.equal("cases that yield", yields, 44)
    figures.equal("cases that yield and should not, or do not and should", wrong, 0)
end

do
    local case = reference["DF.triaxial_mc"]
    local i = case.inputs
    figures.case("DF.triaxial_mc", "A zone is squeezed along z with its sides at a pressure, up to flow.", case.source)
    local params = { young = i.E, poisson = i.nu, cohesion = i.cohesion, friction = i.friction, dilation = i.dilation }
    for k, pressure in ipairs(i.confining) do
        local name = string.format("at %g MPa: ", pressure / 1e6)
        local curve = triaxial("mohr_coulomb", params, pressure, -0.01, 200)
        local peak, n = case.expected.peak[k], #curve.work
        figures.relative(name .. "peak, Pa", -curve.stress.zz[n], peak, PEAK)
        local axial = curve.strain.zz[n] - curve.strain.zz[n - 50]
        local sides = curve.strain.xx[n] - curve.strain.xx[n - 50] + curve.strain.yy[n] - curve.strain.yy[n - 50]
        figures.relative(name .. "strain of both sides over that along z", sides / axial, case.expected.dilatancy, PEAK)
        check_replay(name, "mohr_coulomb", params, curve)
    end
end

do
    local case = reference["DF.tension_cutoff"]
    local i = case.inputs
    figures.case("DF.tension_cutoff", "A zone is pulled along one axis with free sides, and along all.", case.source)
    local params = { young = i.E, poisson = i.nu, cohesion = i.cohesion, friction = i.friction, tension = i.tension }
    local all = { xx = 1e-3, yy = 1e-3, zz = 1e-3, xy = 0, yz = 0, zx = 0 }
    local function pull(path)
        return talus.solid_test { solid = "mohr_coulomb", params = params, path = { path } }
    end
    local curve = pull { strain = { xx = 1e-3 } }
    figures.relative("along x, Pa", curve.stress.xx[101], case.expected.uniaxial_tension, EXACT)
    check_replay("along x: ", "mohr_coulomb", params, curve)
    curve = pull { strain = all }
    figures.relative("along all axes, Pa", curve.stress.yy[101], case.expected.hydrostatic_tension, EXACT)
    check_replay("along all axes: ", "mohr_coulomb", params, curve)
    params.tension = 1e8
    curve = pull { strain = all }
    figures.relative("with more tension than the apex has, Pa", curve.stress.yy[101], case.expected.apex, EXACT)
    check_replay("at the apex: ", "mohr_coulomb", params, curve)
end

do
    local case = reference["DF.softening"]
    local i, rows = case.inputs, {}
    figures.case("DF.softening", "A zone is squeezed along z with free sides; its cohesion falls with plastic strain.", case.source)
    for k, x in ipairs(i.cohesion_table[1]) do
        rows[k] = { x, i.cohesion_table[2][k] }
    end
    local params = { young = i.E, poisson = i.nu, friction = i.friction, dilation = i.dilation, cohesion_table = rows }
    local path = { { strain = { zz = -0.01 }, steps = 10000 } } -- strains of 1e-6 a step
    local curve = talus.solid_test { solid = "mohr_coulomb", params = params, path = path }
    local measure, found = curve.states.plastic_shear, {}
    for wanted, stress in pairs(case.expected.stress_at_plastic_measure) do
        local k = 1
        while k < #measure and measure[k] < tonumber(wanted) + 1e-12 do
            k = k + 1
        end
        found[#found + 1] = { tonumber(wanted), -curve.stress.zz[k], stress }
    end
    table.sort(found, function(a, b) return a[1] < b[1] end)
    local obtained, wanted, x, y = {}, {}, {}, {}
    for k, row in ipairs(found) do
        figures.relative(string.format("stress at plastic strain %g, Pa", row[1]), row[2], row[3], SOFTENING)
        x[k], wanted[k] = row[1], row[3]
    end
    local n = #measure
    local plastic = -(curve.strain.zz[n] - curve.stress.zz[n] / i.E)
    figures.relative("measure over plastic strain along z", measure[n] / plastic, case.expected.measure_per_axial_plastic_strain, PEAK)
    for k = 1, n, 100 do
        y[#y + 1], obtained[#obtained + 1] = measure[k], -curve.stress.zz[k]
    end
    figures.plot { title = "DF.softening: strength over plastic strain", x = "plastic shear strain", y = "stress, Pa",
        series = { { name = "one zone", x = y, y = obtained, style = "line" },
            { name = "from the table", x = x, y = wanted, style = "points" } } }
    path[1].steps = 1000
    check_replay("with 1000 steps: ", "mohr_coulomb", params,
        talus.solid_test { solid = "mohr_coulomb", params = params, path = path })
end

-- ------------------------------------------------------------------ the other solids

do
    local case = reference["DF.hoek_brown"]
    local i = case.inputs
    figures.case("DF.hoek_brown", "A zone is squeezed along z with its sides at a pressure, and pulled along all axes.", case.source)
    for _, dilation in ipairs { 0, 15 } do
        local params = { young = 1e10, poisson = 0.25, sigma_ci = i.sigma_ci, mb = i.mb, s = i.s, a = i.a, dilation = dilation }
        for k, pressure in ipairs(i.confining) do
            local name = string.format("dilation %g, at %g MPa: ", dilation, pressure / 1e6)
            local curve = triaxial("hoek_brown", params, pressure, -0.02, 200)
            figures.relative(name .. "peak, Pa", -curve.stress.zz[#curve.work], case.expected.peak[k], PEAK)
            if k == 3 then
                check_replay(name, "hoek_brown", params, curve)
            end
        end
        local pulled = talus.solid_test { solid = "hoek_brown", params = params, path = { { strain = { xx = 1e-3, yy = 1e-3, zz = 1e-3 } } } }
        figures.relative(string.format("dilation %g: tension, Pa", dilation), pulled.stress.xx[101], case.expected.tension, PEAK)
    end
end

do
    local case = reference["DF.drucker_prager"]
    figures.case("DF.drucker_prager", "A zone is squeezed along z with its sides at 1 MPa: k = sqrt(J2) + q p at flow; and pulled "
        .. "along all axes, to k / q.", case.source)
    for _, meridian in ipairs { "outer", "inner" } do
        local e = case.expected[meridian]
        local params = { young = 1e10, poisson = 0.25, friction = case.inputs.friction, cohesion = case.inputs.cohesion, meridian = meridian }
        local curve = triaxial("drucker_prager", params, 1e6, -0.02, 200)
        local s, n = curve.stress, #curve.work
        local p, root = (s.xx[n] + s.yy[n] + s.zz[n]) / 3, math.abs(s.zz[n] - s.xx[n]) / math.sqrt(3)
        figures.relative(meridian .. " meridian: k, Pa", root + e.q * p, e.k, CONE)
        check_replay(meridian .. " meridian: ", "drucker_prager", params, curve)
        local pulled = talus.solid_test { solid = "drucker_prager", params = params, path = { { strain = { xx = 1e-3, yy = 1e-3, zz = 1e-3 } } } }
        figures.relative(meridian .. " meridian: tension of the apex, Pa", pulled.stress.xx[101], e.k / e.q, CONE)
    end
end

do
    local case = reference["DF.transverse"]
    local i = case.inputs
    figures.case("DF.transverse", "A layered zone is pressed along z, its sides free: modulus over the angle between the normal of "
        .. "the layers and z.", case.source)
    local angles, moduli, wanted = {}, {}, {}
    for angle in pairs(case.expected.E_at_angle) do
        angles[#angles + 1] = tonumber(angle)
    end
    table.sort(angles)
    for k, angle in ipairs(angles) do
        local params = { young_plane = i.E_plane, young_across = i.E_across, poisson_plane = i.nu_plane, poisson_across = i.nu_across,
            shear_across = i.G_across, dip = angle, dip_direction = 37 }
        local curve = talus.solid_test { solid = "transverse", params = params, path = { { stress = { zz = -1e6 } } } }
        wanted[k] = case.expected.E_at_angle[tostring(angle)]
        moduli[k] = -1e6 / curve.strain.zz[101]
        figures.relative(string.format("modulus at %g degrees, Pa", angle), moduli[k], wanted[k], EXACT)
        check_replay(string.format("at %g degrees: ", angle), "transverse", params, curve)
    end
    figures.plot { title = "DF.transverse: modulus over the dip of the layers", x = "angle, deg", y = "modulus, Pa",
        series = { { name = "closed form", x = angles, y = wanted, style = "line" },
            { name = "one zone", x = angles, y = moduli, style = "points" } } }
end
figures.finish()
