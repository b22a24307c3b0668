-- Columns of zones on rollers: under their weight, and with joints across.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local SETTLED = 0.005  -- relative, of meshes without layers
local SERIES = 1e-6    -- relative, on any mesh
local AT_REST = 1e-10  -- unbalanced force ratio
local HELD = 1e-9      -- relative: what bears the weight

-- Holds gridpoints of the sides of a column across these.
local function rollers(model, side)
    for _, axis in ipairs { "x", "y" } do
        zones.on(model, axis, 0):fix { [axis] = true }
        zones.on(model, axis, side):fix { [axis] = true }
    end
end

do
    local case = reference["DF.gravity_column"]
    local i, e = case.inputs, case.expected
    figures.case("DF.gravity_column", "A column on rollers settles under its weight: how far, and the stress above its base.",
        case.source)
    local model = zones.model { young = i.E, poisson = i.nu, gravity = { 0, 0, -i.g } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, i.height }, density = i.rho })
    model:blocks():deformable { zone = 0.3, solid = "rock" }
    rollers(model, 1)
    local base = zones.on(model, "z", 0)
    base:fix { z = true }
    figures.equal("comes to rest", model:relax { ratio = AT_REST }.reason, "rest")
    model:cycle(1)
    local top, sum = zones.on(model, "z", i.height), 0
    for _, p in ipairs(top) do
        sum = sum - p.displacement[3] / #top
    end
    figures.relative("settlement of the top, m", sum, e.settlement, SETTLED)
    figures.relative("force of the base, N", base:reaction()[3], -e.szz_base, HELD)
    -- The stress grows with depth alone: the line through the means of the lowest metre, at the base.
    local low = model:zones { inside = { min = { 0, 0, 0 }, max = { 1, 1, 1 } } }
    local high = model:zones { inside = { min = { 0, 0, 1 }, max = { 1, 1, 2 } } }
    local function mean_height(selection)
        local height, volume = 0, 0
        for _, z in ipairs(selection) do
            height, volume = height + z.volume * z.centroid[3], volume + z.volume
        end
        return height / volume
    end
    local s1, s2, z1, z2 = zones.mean(low, "stress", "zz"), zones.mean(high, "stress", "zz"), mean_height(low), mean_height(high)
    figures.relative("stress at the base, Pa", s1 - z1 * (s2 - s1) / (z2 - z1), e.szz_base, SETTLED)
    figures.relative("stress across over that along z, all zones",
        zones.mean(model:zones {}, "stress", "xx") / zones.mean(model:zones {}, "stress", "zz"), e.k0, SETTLED)
end

-- The top is moved down by as much as the closed form shortens zones, by their logarithmic strain, and joints: then the
-- stress must be that of the load.
for _, n in ipairs { 1, 3, 9 } do
    local case = reference["DF.series_column_" .. n]
    local i = case.inputs
    figures.case("DF.series_column_" .. n, "A column with joints across is shortened: stress of zones and of joints. Meshes of "
        .. "the blocks do not match.", case.source)
    local model = zones.model { young = i.E, poisson = i.nu }
    local size = i.height / (n + 1)
    for k = 0, n do
        model:generate("box", { min = { 0, 0, k * size }, max = { 1, 1, (k + 1) * size }, density = 2500 })
    end
    model:joint("*", "coulomb", { kn = i.kn, ks = i.kn, friction = 30 })
    for k, block in ipairs(model:blocks()) do
        model:blocks { id = block.id }:deformable { zone = k % 2 == 0 and 0.5 or 0.4, solid = "rock" }
    end
    rollers(model, 1)
    zones.on(model, "z", 0):fix { z = true }
    local top = zones.on(model, "z", i.height)
    top:fix { z = true }
    local M = i.E * (1 - i.nu) / (1 + i.nu) / (1 - 2 * i.nu)
    local shorter, closure = 1 - math.exp(i.load / M), -i.load / i.kn
    -- blocks are told apart by their own numbers, in the order of height
    zones.displace(model, model:gridpoints {}, function(p, point)
        local number = point.block.id - 1
        return { 0, 0, -shorter * p[3] - number * closure }
    end, 50)
    figures.equal("comes to rest", model:relax { ratio = AT_REST }.reason, "rest")
    model:cycle(1)
    local all = model:zones {}
    figures.near("stress along z, worst zone, Pa", zones.off(all, "stress", "zz", i.load), 0, SERIES * -i.load)
    local small = -top[1].displacement[3] + i.height * (-i.load / M - shorter) -- of small strain, as the reference has it
    figures.relative("shortening under the load, m", small * i.load / top:reaction()[3], case.expected.shortening, SERIES)
    figures.near("force of the top over its area, Pa", top:reaction()[3], i.load, SERIES * -i.load)
end
figures.finish()
