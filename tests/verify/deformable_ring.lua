-- A thick ring of zones under pressure from within, up to a solid that hardly changes its volume.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local WAY = 0.03      -- relative, with eight rings
local MEAN = 0.03     -- of the pressure, root mean square over zones
local AT_REST = 1e-6  -- unbalanced force ratio
local RINGS = 8

local plot = { title = "DF.lame: radial and tangential stress", x = "radius, m", y = "stress over the pressure", series = {} }
for _, nu in ipairs { "0.3", "0.49", "0.499" } do
    local case = reference["DF.lame_nu" .. nu]
    local i = case.inputs
    figures.case("DF.lame_nu" .. nu, "A sector of ten degrees of a ring in plane strain, its sides on rollers, under pressure from "
        .. "within: eight rings of zones.", case.source)
    local model = zones.model { young = i.E, poisson = i.nu }
    local side = zones.sector(model, { inner = i.inner, outer = i.outer, rings = RINGS, thickness = 0.3 })
    model:boundary { plane = side.inner, pressure = i.pressure }
    figures.equal("comes to rest", model:relax { ratio = AT_REST }.reason, "rest")
    model:cycle(1)
    figures.relative("way of the wall, m", zones.radial(model, i.inner), case.expected.u_inner, WAY)
    local square, volume, r, sr, st = 0, 0, {}, {}, {}
    for k, z in ipairs(model:zones {}) do
        square, volume = square + z.volume * (z.mean - case.expected.mean_stress) ^ 2, volume + z.volume
        local x, y, s = z.centroid[1], z.centroid[2], z.stress
        local c, n = x / math.sqrt(x * x + y * y), y / math.sqrt(x * x + y * y)
        r[k] = math.sqrt(x * x + y * y)
        sr[k] = (s.xx * c * c + s.yy * n * n + 2 * s.xy * c * n) / i.pressure
        st[k] = (s.xx * n * n + s.yy * c * c - 2 * s.xy * c * n) / i.pressure
    end
    figures.near("mean stress off by, of the pressure, root mean square", math.sqrt(square / volume) / i.pressure, 0, MEAN)
    if nu == "0.499" then
        plot.series[1] = { name = "radial, zones", x = r, y = sr, style = "points" }
        plot.series[2] = { name = "tangential, zones", x = r, y = st, style = "points" }
        local x, wr, wt = {}, {}, {}
        for k = 0, 60 do
            x[k + 1] = i.inner + (i.outer - i.inner) * k / 60
            local f = i.inner ^ 2 / (i.outer ^ 2 - i.inner ^ 2)
            wr[k + 1], wt[k + 1] = -f * ((i.outer / x[k + 1]) ^ 2 - 1), f * ((i.outer / x[k + 1]) ^ 2 + 1)
        end
        plot.series[3] = { name = "radial, closed form", x = x, y = wr, style = "line" }
        plot.series[4] = { name = "tangential, closed form", x = x, y = wt, style = "line" }
        figures.plot(plot)
    end
end
figures.finish()
