-- One block of zones under uniform strain, turned, and spinning.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local UNIFORM = 1e-9       -- relative: a uniform strain is exact on every mesh
local SHEAR = 1e-7         -- of the shear stress
local SAME = 1e-12         -- of the largest component: how far zones may differ
local TURNED = 1e-8        -- of the largest component, after ten turns
local SPIN = 0.03          -- relative, of rod theory
local KEPT = 1e-6          -- of the angular momentum and of the energy
local AT_REST = 1e-13      -- unbalanced force ratio: rounding
local ZONE = 0.35          -- edge of the zones of a cube of 1 m

-- A cube of 1 m with a corner at the origin.
local function cube(inputs)
    local model = zones.model { young = inputs.E, poisson = inputs.nu }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    model:blocks():deformable { zone = ZONE, solid = "rock" }
    return model
end

-- ------------------------------------------------------------------ one axis

-- Gridpoints begin with the velocities of a bar that is pressed, so nothing swings; then the ends are held, and the
-- sides are free. The strain is logarithmic: Cauchy stress goes with it.
do
    local case = reference["DF.uniaxial"]
    figures.case("DF.uniaxial", "A cube is pressed along z between smooth plates, its sides are free.", case.source)
    local model = cube(case.inputs)
    local top, bottom = zones.on(model, "z", 1), zones.on(model, "z", 0)
    bottom:fix { z = true }
    top:fix { z = true }
    zones.on(model, "x", 0):fix { x = true }
    zones.on(model, "y", 0):fix { y = true }
    local e, side = case.expected.strain, case.expected.lateral
    local function way(p)
        return { p[1] * (math.exp(side) - 1), p[2] * (math.exp(side) - 1), p[3] * (math.exp(e) - 1) }
    end
    zones.displace(model, model:gridpoints {}, way, 200)
    figures.equal("comes to rest", model:relax { ratio = AT_REST }.reason, "rest")
    model:cycle(1) -- zones see the last motion
    local all = model:zones {}
    figures.near("stress along z, worst zone, Pa", zones.off(all, "stress", "zz", case.inputs.stress), 0, UNIFORM * 1e6)
    figures.near("stress along x, worst zone, Pa", zones.off(all, "stress", "xx", 0), 0, UNIFORM * 1e6)
    figures.near("strain along z, worst zone", zones.off(all, "strain", "zz", e), 0, UNIFORM * -e)
    figures.near("strain along x, worst zone", zones.off(all, "strain", "xx", side), 0, UNIFORM * -e)
    local area = math.exp(2 * side)
    figures.relative("force on the plate, N", top:reaction()[3], case.inputs.stress * area, UNIFORM)
    -- The reference has the energy of a volume that stays: here it changes by exp(q s) as the stress grows by s from 0
    -- to 1.
    local q = e + 2 * side
    figures.relative("stored, J", model:energy().strain, 2 * case.expected.energy * (1 / 2 + q / 3 + q * q / 8), UNIFORM)
end

do
    local case = reference["DF.oedometer"]
    figures.case("DF.oedometer", "A cube between rollers is pressed along z.", case.source)
    local model = cube(case.inputs)
    for _, axis in ipairs { "x", "y", "z" } do
        zones.on(model, axis, 0):fix { [axis] = true }
        zones.on(model, axis, 1):fix { [axis] = true }
    end
    local e = case.expected.strain
    zones.displace(model, model:gridpoints {}, function(p) return { 0, 0, p[3] * (math.exp(e) - 1) } end, 10)
    figures.equal("comes to rest", model:relax { ratio = AT_REST }.reason, "rest")
    model:cycle(1)
    local all = model:zones {}
    figures.near("stress along z, worst zone, Pa", zones.off(all, "stress", "zz", case.inputs.stress), 0, UNIFORM * 1e6)
    figures.near("stress along x, worst zone, Pa", zones.off(all, "stress", "xx", case.expected.lateral_stress), 0, UNIFORM * 1e6)
    figures.near("strain along z, worst zone", zones.off(all, "strain", "zz", e), 0, UNIFORM * -e)
end

-- ------------------------------------------------------------------ shear, and any strain

-- In large strain the normal stresses are of second order: a stress that turns with the zone is G sin g in shear, and
-- G (1 - cos g) along x. A step turns the stress of the one before, so that is met in the limit of small steps.
do
    local case = reference["DF.simple_shear"]
    figures.case("DF.simple_shear", "Gridpoints of all sides of a cube are moved along x by their height.", case.source)
    local model = cube(case.inputs)
    zones.hull(model, { 0, 0, 0 }, { 1, 1, 1 }):fix()
    local g, tau = case.inputs.gamma, case.expected.tau
    zones.displace(model, model:gridpoints {}, function(p) return { g * p[3], 0, 0 } end, 2000)
    figures.equal("comes to rest", model:relax { ratio = AT_REST }.reason, "rest")
    model:cycle(1)
    local all = model:zones {}
    local normal = tau / g * (1 - math.cos(g))
    figures.near("shear stress, worst zone, Pa", zones.off(all, "stress", "zx", tau), 0, SHEAR * tau)
    for _, row in ipairs { { "xx", normal }, { "zz", -normal }, { "yy", 0 }, { "xy", 0 }, { "yz", 0 } } do
        figures.near("stress " .. row[1] .. ", worst zone, Pa", zones.off(all, "stress", row[1], row[2]), case.expected.others,
            SHEAR * tau)
    end
end

-- A skew prism: no side is along an axis. Its inner gridpoints come to rest where the field has them.
local function prism(inputs)
    local model = zones.model { young = inputs.E, poisson = inputs.nu }
    local base = { { 0, 0 }, { 1.1, 0.1 }, { 1.4, 0.9 }, { 0.5, 1.3 }, { -0.3, 0.8 } }
    for _, p in ipairs(base) do
        p[3] = 0.2 * p[1] - 0.1 * p[2]
    end
    model:generate("prism", { base = base, axis = { 0.2, -0.3, 1.2 }, density = 2500 })
    model:blocks():deformable { zone = ZONE, solid = "rock" }
    return model
end

do
    local case = reference["DF.patch_affine"]
    local A, S = case.inputs.gradient, case.expected.stress_per_unit
    local SMALL = 1e-8 -- the limit of small steps: terms of second order are 1e-11 of the stress
    local names = { { "xx", "xy", "zx" }, { "xy", "yy", "yz" }, { "zx", "yz", "zz" } }
    local function field(p)
        local u = {}
        for i = 1, 3 do
            u[i] = SMALL * (A[i][1] * p[1] + A[i][2] * p[2] + A[i][3] * p[3])
        end
        return u
    end
    figures.case("DF.patch_affine", "Gridpoints of a skew prism are moved by a linear field: all of them in one step, and those of "
        .. "its surface alone, the inner ones then come to rest.", case.source)
    for _, all_move in ipairs { true, false } do
        local name = all_move and "all gridpoints moved: " or "surface moved: "
        local model = prism(case.inputs)
        local moved = model:gridpoints { surface = not all_move and true or nil }
        figures.equal(name .. "there are inner gridpoints", #model:gridpoints { surface = false } > 0, true)
        moved:fix()
        zones.displace(model, moved, field, 1, 1e-5)
        if not all_move then
            figures.equal(name .. "comes to rest", model:relax { ratio = AT_REST }.reason, "rest")
            model:cycle(1)
        end
        local all, most = model:zones {}, 0
        for i = 1, 3 do
            for k = 1, 3 do
                most = math.max(most, SMALL * math.abs(S[i][k]))
            end
        end
        for i = 1, 3 do
            for k = i, 3 do
                local c = names[i][k]
                figures.near(name .. "stress " .. c .. ", worst zone, Pa", zones.off(all, "stress", c, SMALL * S[i][k]), 0, UNIFORM * most)
                if all_move then
                    figures.near(name .. "stress " .. c .. ", zones differ by, Pa", zones.spread(all, "stress", c), 0, SAME * most)
                end
            end
        end
    end
end

-- ------------------------------------------------------------------ turns

-- A stress is made by straining the cube, then all gridpoints turn about an axis, in chords.
do
    local case = reference["DF.rotation"]
    local wanted, E, nu = case.inputs.stress, 1e10, 0.25
    figures.case("DF.rotation", "A stressed cube is turned ten times about a skew axis: the stress in its axes stays.", case.source)
    for _, steps in ipairs(case.inputs.steps_per_turn) do
        local model = cube { E = E, nu = nu }
        local points = model:gridpoints {}
        points:fix()
        local mean = wanted[1] + wanted[2] + wanted[3]
        local strain = {}
        for k = 1, 6 do
            strain[k] = ((1 + nu) * wanted[k] - (k <= 3 and nu * mean or 0)) / E
        end
        zones.displace(model, points, function(p)
            return { strain[1] * p[1] + strain[4] * p[2] + strain[6] * p[3], strain[4] * p[1] + strain[2] * p[2] + strain[5] * p[3],
                strain[6] * p[1] + strain[5] * p[2] + strain[3] * p[3] }
        end, 1, 1e-4)
        local before = {}
        for i, z in ipairs(model:zones {}) do
            before[i] = z.stress
        end
        -- Rodrigues: x + sin(a) n x x + (1 - cos(a)) n x (n x x)
        local angle, n = 2 * math.pi / steps, { 2 / 3, -1 / 3, 2 / 3 }
        local s, c = math.sin(angle), 1 - math.cos(angle)
        local dt = 1e-4
        local function turn(x)
            local a, b, d = n[2] * x[3] - n[3] * x[2], n[3] * x[1] - n[1] * x[3], n[1] * x[2] - n[2] * x[1]
            return { (s * a + c * (n[2] * d - n[3] * b)) / dt, (s * b + c * (n[3] * a - n[1] * d)) / dt,
                (s * d + c * (n[1] * b - n[2] * a)) / dt }
        end
        for _ = 1, steps * case.inputs.turns do
            points:set { velocity = turn }
            model:cycle(1)
        end
        points:set { velocity = { 0, 0, 0 } }
        model:cycle(1)
        local worst, most = 0, 0
        for i, z in ipairs(model:zones {}) do
            for k, name in ipairs(zones.COMPONENTS) do
                worst = math.max(worst, math.abs(z.stress[name] - before[i][name]))
                most = math.max(most, math.abs(wanted[k]))
            end
        end
        figures.near(steps .. " steps a turn: stress has changed by at most, Pa", worst, 0, TURNED * most)
        figures.near(steps .. " steps a turn: stress xx before, Pa", before[1].xx, wanted[1], 1e-3 * most)
    end
end

-- ------------------------------------------------------------------ a bar that spins

do
    local case = reference["DF.spinning_bar"]
    local i = case.inputs
    figures.case("DF.spinning_bar", "A free bar spins about its middle. It swings along its axis: means over ten of these swings.",
        case.source)
    local model = zones.model { young = i.E, poisson = i.nu }
    local half, thick = i.length / 2, 0.1
    model:generate("box", { min = { -half, -thick, -thick }, max = { half, thick, thick }, density = i.rho })
    model:blocks():deformable { zone = i.length / 20, solid = "rock" }
    local points = model:gridpoints {}
    points:set { velocity = function(p) return { -i.omega * p[2], i.omega * p[1], 0 } end }
    local ends = { model:gridpoints { near = { -half, 0, 0 } }[1], model:gridpoints { near = { half, 0, 0 } }[1] }
    local apart = 0
    local middle = model:zones { inside = { min = { -0.1, -1, -1 }, max = { 0.1, 1, 1 } } }
    local function length()
        local sum = 0
        for k = 1, 3 do
            sum = sum + (ends[1].position[k] - ends[2].position[k]) ^ 2
        end
        return math.sqrt(sum)
    end
    local masses = points:values "mass"
    local function angular_momentum()
        local x, v, sum = points:values("position", "flat"), points:values("velocity", "flat"), 0
        for k = 1, #masses do
            local at = 3 * k - 3
            sum = sum + masses[k] * (x[at + 1] * v[at + 2] - x[at + 2] * v[at + 1])
        end
        return sum
    end
    local function energy()
        local e = model:energy()
        return e.kinetic + e.strain
    end
    -- along the bar: the stress n . sigma n with n from end to end
    local function stress()
        local n, l = {}, length()
        for k = 1, 3 do
            n[k] = (ends[2].position[k] - ends[1].position[k]) / l
        end
        local sum, volume = 0, 0
        for _, z in ipairs(middle) do
            local s = z.stress
            sum = sum + z.volume * (s.xx * n[1] ^ 2 + s.yy * n[2] ^ 2 + s.zz * n[3] ^ 2
                + 2 * (s.xy * n[1] * n[2] + s.yz * n[2] * n[3] + s.zx * n[3] * n[1]))
            volume = volume + z.volume
        end
        return sum / volume
    end
    local before = length()
    model:cycle(1)
    local turn, all = angular_momentum(), energy()
    local period = 2 * i.length / math.sqrt(i.E / i.rho)
    local samples, spun, elongation, pull, times = 200, 0, 0, 0, 10
    local x, y = {}, {}
    for k = 1, samples do
        model:solve { ratio = 0, max_time = times * period / samples }
        elongation = elongation + (length() - before) / samples
        pull = pull + stress() / samples
        spun = math.max(spun, math.abs(energy() / all - 1))
        x[k], y[k] = model.time, length() - before
    end
    figures.relative("mean elongation, m", elongation, case.expected.elongation, SPIN)
    figures.relative("mean stress in the middle, Pa", pull, case.expected.stress_middle, SPIN)
    figures.near("angular momentum, relative change", angular_momentum() / turn - 1, 0, KEPT)
    figures.near("energy, relative change", spun, 0, KEPT)
    figures.plot { title = "DF.spinning_bar: elongation", x = "time, s", y = "elongation, m",
        series = { { name = "bar", x = x, y = y, style = "line" },
            { name = "rod theory, at rest", x = { 0, x[#x] }, y = { case.expected.elongation, case.expected.elongation }, style = "line" } } }
end
figures.finish()
