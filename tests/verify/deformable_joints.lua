-- Joints between zones: springs at any angle to the load, shear up to slip, a block that slides, and a punch.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local EXACT = 1e-6       -- relative, where outer gridpoints are driven on the exact field
local PLATEAU = 0.005    -- relative
local SLIDES = 0.005     -- relative, in the mean over twenty periods of the block
local PUNCH = 0.03       -- relative, with eight zones a half width
local HALVES = 0.6       -- of the error, when zones are half as large: about a half
local AT_REST = 1e-7     -- unbalanced force ratio: places are known to 1e-16 m, and joints are stiff

-- ------------------------------------------------------------------ springs at an angle

-- A stress s along z strains rock by Hooke's law, and each joint with the normal n gives way by (n.s.n) / kn along n
-- and by the rest of s.n over ks. Blocks so strained and shifted bear s everywhere.
do
    local case = reference["DF.goodman"]
    local i, LOAD = case.inputs, -1e3 -- small, so strains are of first order
    figures.case("DF.goodman", "A prism with a set of joints: outer gridpoints are driven as rock and joints give way under a "
        .. "stress along z; stiffness over the angle between the normal of the joints and z.", case.source)
    local angles, moduli, wanted = {}, {}, {}
    for k, angle in ipairs(i.normal_to_load) do
        local model = zones.model { young = i.E, poisson = i.nu }
        model:generate("box", { min = { 0, 0, 0 }, max = { 1, 0.6, 2 }, density = 2500 })
        local a = math.rad(angle)
        local n, origin = { math.sin(a), 0, math.cos(a) }, { 0.5, 0.3, 0.8 }
        model:generate("jointset", { joint = "J", dip = angle, dip_direction = 90, spacing = i.spacing, number = 9,
            origin = origin })
        model:joint("*", "elastic", { kn = i.kn, ks = i.ks })
        for number, block in ipairs(model:blocks()) do
            model:blocks { id = block.id }:deformable { zone = number % 2 == 0 and 0.3 or 0.25, solid = "rock" }
        end
        local layer = {}
        for _, block in ipairs(model:blocks()) do
            local c = block.centroid
            layer[block.id] = math.floor((n[1] * (c[1] - origin[1]) + n[3] * (c[3] - origin[3])) / i.spacing)
        end
        local normal = LOAD * n[3] * n[3] -- n.s.n
        local jump = {}
        for c = 1, 3 do
            jump[c] = normal / i.kn * n[c] + ((c == 3 and LOAD * n[3] or 0) - normal * n[c]) / i.ks
        end
        local outer = zones.hull(model, { 0, 0, 0 }, { 1, 0.6, 2 })
        outer:fix()
        local e = LOAD / i.E
        zones.displace(model, model:gridpoints {}, function(p, point)
            local m = layer[point.block.id]
            return { -i.nu * e * p[1] + m * jump[1], -i.nu * e * p[2] + m * jump[2], e * p[3] + m * jump[3] }
        end, 10)
        figures.equal(angle .. " degrees: comes to rest", model:relax { ratio = AT_REST }.reason, "rest")
        model:cycle(1)
        local all, name = model:zones {}, angle .. " degrees: "
        figures.near(name .. "stress along z, worst zone, Pa", zones.off(all, "stress", "zz", LOAD), 0, EXACT * -LOAD)
        figures.near(name .. "stress along x, worst zone, Pa", zones.off(all, "stress", "xx", 0), 0, EXACT * -LOAD)
        local strain = e + jump[3] * n[3] / i.spacing
        angles[k], moduli[k] = angle, zones.mean(all, "stress", "zz") / strain
        wanted[k] = case.expected.E_equivalent[tostring(angle)]
        figures.relative(name .. "modulus, Pa", moduli[k], wanted[k], EXACT)
    end
    figures.plot { title = "DF.goodman: modulus of jointed rock", x = "angle between normal and load, deg", y = "modulus, Pa",
        series = { { name = "closed form", x = angles, y = wanted, style = "line" },
            { name = "zones", x = angles, y = moduli, style = "points" } } }
end

-- ------------------------------------------------------------------ shear up to slip

do
    local case = reference["DF.direct_shear"]
    local i = case.inputs
    local YOUNG, POISSON, HEIGHT, WAY = 1e10, 0.25, 0.05, 4e-4
    figures.case("DF.direct_shear", "The upper one of two thin blocks is pressed down and moved sideways: shear force when all of the "
        .. "joint slips.", case.source)
    local model = zones.model { young = YOUNG, poisson = POISSON }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, HEIGHT }, density = 2500 })
    model:generate("box", { min = { 0, 0, HEIGHT }, max = { 1, 1, 2 * HEIGHT }, density = 2500 })
    model:joint("*", "coulomb", { kn = i.kn, ks = i.ks, friction = i.friction, cohesion = i.cohesion })
    model:blocks { id = 1 }:deformable { zone = 0.125, solid = "rock" }
    model:blocks { id = 2 }:deformable { zone = 0.1, solid = "rock" }
    for _, y in ipairs { 0, 1 } do
        zones.on(model, "y", y):fix { y = true }
    end
    local top, base = zones.on(model, "z", 2 * HEIGHT), zones.on(model, "z", 0)
    top:fix()
    base:fix()
    local M = YOUNG * (1 - POISSON) / (1 + POISSON) / (1 - 2 * POISSON)
    local closure, e = i.normal / i.kn, i.normal / M
    zones.displace(model, model:gridpoints {}, function(p, point)
        return { 0, 0, -e * p[3] - (point.block.id - 1) * closure }
    end, 20)
    model:relax { ratio = 1e-6 }
    local x, y = { 0 }, { 0 }
    local STEPS = 20
    for k = 1, STEPS do
        zones.displace(model, top, function() return { WAY / STEPS, 0, 0 } end, 20)
        figures.equal("comes to rest", model:relax { ratio = 1e-6 }.reason, "rest")
        local f = top:reaction()
        x[k + 1], y[k + 1] = k * WAY / STEPS, f[1] / i.area
    end
    local f = base:reaction()
    local strength = i.cohesion * i.area + f[3] * math.tan(math.rad(i.friction))
    figures.relative("shear force under the normal force there is, N", -f[1], strength, PLATEAU)
    figures.relative("shear stress under the wanted normal stress, Pa",
        -f[1] / i.area + (i.normal - f[3] / i.area) * math.tan(math.rad(i.friction)), case.expected.peak, PLATEAU)
    figures.plot { title = "DF.direct_shear: shear stress", x = "way of the upper side, m", y = "shear stress, Pa",
        series = { { name = "zones", x = x, y = y, style = "line" },
            { name = "strength", x = { 0, WAY }, y = { case.expected.peak, case.expected.peak }, style = "line" } } }
end

-- ------------------------------------------------------------------ a block that slides

do
    local case = reference["DF.incline"]
    local i = case.inputs
    figures.case("DF.incline", "A soft cube rests on a plane that is tilted; then friction is given to it: mean acceleration by "
        .. "the way of its centroid, slip waves or not, and whether it sticks.", case.source)
    local POISSON, DENSITY = 0.25, 2500
    local period = 4 / math.sqrt(i.E / 2 / (1 + POISSON) / DENSITY) -- of shear, one side held
    local function run(angle, time)
        local a = math.rad(angle)
        local model = zones.model { young = i.E, poisson = POISSON, gravity = { i.g * math.sin(a), 0, -i.g * math.cos(a) } }
        model:generate("box", { min = { -1, -1, -0.5 }, max = { 4, 2, 0 }, density = DENSITY })
        model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY })
        model:blocks { id = 1 }:fix()
        model:joint("*", "coulomb", { kn = 100 * i.E, ks = 100 * i.E, friction = 80 })
        local block = model:blocks { id = 2 }
        block:deformable { zone = 0.35, solid = "rock" }
        figures.equal(string.format("at %g degrees: at rest with more friction", angle), model:relax { ratio = 1e-7 }.reason, "rest")
        local began, from = model.time, block[1].displacement[1]
        model:joint("*", { friction = i.friction })
        model:solve { ratio = 0, max_time = time }
        local way, time_taken = block[1].displacement[1] - from, model.time - began
        return 2 * way / time_taken ^ 2, way, model:energy().balance
    end
    local acceleration, _, balance = run(i.angle, 20 * period)
    figures.relative("mean acceleration, m/s2", acceleration, case.expected.acceleration, SLIDES)
    figures.near("energy gained or lost, over the largest term", balance, 0, 1e-3)
    local _, way = run(case.expected.sticks_below - 0.5, 20 * period)
    -- a thousandth of the way that the block would fall in this time
    figures.near("half a degree below friction it has moved by, m", way, 0, 1e-3 * i.g / 2 * (20 * period) ^ 2)
end

-- ------------------------------------------------------------------ a punch

do
    local case = reference["DF.punch"]
    local i = case.inputs
    figures.case("DF.punch", "A smooth rigid punch is pressed into a layer in plane strain: mean pressure over the way.", case.source)
    local function run(count)
        local zone = i.half_width / count
        local model = zones.model { young = i.E, poisson = i.nu }
        model:generate("box", { min = { 0, 0, 0 }, max = { i.width, zone, i.depth }, density = 2500 })
        model:generate("box", { min = { 0, 0, i.depth }, max = { i.half_width, zone, i.depth + 0.5 }, density = 2500 })
        model:joint("*", "coulomb", { kn = 100 * i.E / zone, ks = 100 * i.E / zone, friction = 0 })
        model:blocks { id = 1 }:deformable { solid = "rock", zone = function(p)
            local x, z = p[1] - i.half_width, p[3] - i.depth
            return zone * math.max(1, math.min(4, math.sqrt(x * x + z * z) / i.half_width))
        end }
        local wall = { { "x", 0 }, { "x", i.width }, { "z", 0 }, { "y", 0 }, { "y", zone } }
        for _, w in ipairs(wall) do
            zones.on(model, w[1], w[2]):fix { [w[1]] = true }
        end
        local punch, way = model:blocks { id = 2 }, 1e-5
        punch:fix()
        local steps, dt = 200, model.dt
        model:timestep { dt = dt }
        punch:set { velocity = { 0, 0, -way / steps / dt } }
        model:cycle(steps)
        punch:set { velocity = { 0, 0, 0 } }
        local at_rest = model:relax { ratio = 1e-5 }
        local down = -punch[1].displacement[3]
        return -punch:reaction()[3] / (i.half_width * zone) / down, at_rest.reason
    end
    local coarse, reason = run(4)
    figures.equal("4 zones a half width: comes to rest", reason, "rest")
    local fine
    fine, reason = run(8)
    figures.equal("8 zones a half width: comes to rest", reason, "rest")
    local right = case.expected.mean_pressure_per_indentation
    figures.relative("8 zones a half width: mean pressure over the way, Pa/m", fine, right, PUNCH)
    figures.between("error over that with 4 zones a half width", math.abs(fine / right - 1) / math.abs(coarse / right - 1), 0, HALVES)
end
figures.finish()
