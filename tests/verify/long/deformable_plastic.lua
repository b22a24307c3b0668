-- Zones that flow: a footing up to its bearing capacity. Constant strain alone bears up to a fifth too much.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local COHESIVE = { [4] = 0.03, [8] = 0.02 } -- relative, by zones a half width
local FRICTIONAL = 0.05                     -- relative
local LEDGER = 5e-3                         -- of the largest term, with plastic zones

local ledger = {}

-- ------------------------------------------------------------------ footings

-- Half of a rough footing of half width `half` on a slice of soil one zone thick in plane strain, driven down by `way`: mean
-- pressures and ways. Velocities fall to zero over the zone beside the footing, so half of a zone bears, too.
local function footing(what)
    local zone = what.half / what.count
    local model = zones.model { solid = "mohr_coulomb", params = what.params }
    model:generate("box", { min = { 0, 0, 0 }, max = { what.width, zone, what.depth }, density = 2000 })
    model:blocks():deformable { solid = "rock", zone = what.coarse and function(p)
        local x, z = math.max(0, p[1] - what.half), p[3] - what.depth
        return zone * math.max(1, math.min(what.coarse, math.sqrt(x * x + z * z) / (4 * what.half) + 0.75))
    end or zone }
    zones.on(model, "z", 0):fix() -- a smooth base would let the whole layer be squeezed out at a lower load
    for _, wall in ipairs { { "x", 0 }, { "x", what.width }, { "y", 0 }, { "y", zone } } do
        zones.on(model, wall[1], wall[2]):fix { [wall[1]] = true }
    end
    local under = model:gridpoints { where = function(p)
        local x = p.position
        return math.abs(x[3] - what.depth) < 1e-9 and x[1] < what.half + 1e-9
    end }
    under:fix()
    local pressures, ways, steps = {}, {}, 40
    local dt = model.dt
    model:timestep { dt = dt }
    model:damping("local", { alpha = 0.8 })
    under:set { velocity = { 0, 0, -what.way / (steps * what.cycles) / dt } }
    for k = 1, steps do
        model:cycle(what.cycles)
        pressures[k] = -under:reaction()[3] / ((what.half + zone / 2) * zone)
        ways[k] = k * what.way / steps
    end
    return pressures, ways, model
end

-- The mean of the last eighth: flow goes on at a load that stays.
local function last(values)
    local sum, count = 0, #values // 8
    for k = #values - count + 1, #values do
        sum = sum + values[k] / count
    end
    return sum
end

do
    local case = reference["DF.prandtl"]
    local i = case.inputs
    figures.case("DF.prandtl", "A rough footing is driven into weightless soil with cohesion alone: mean pressure over cohesion "
        .. "as it flows.", case.source)
    local series = {}
    for _, count in ipairs { 4, 8 } do
        local p, way, model = footing { half = i.half_width, count = count, width = i.domain[1], depth = i.domain[2],
            params = { young = i.E, poisson = i.nu, cohesion = i.cohesion, friction = i.friction, tension = 1e9 }, way = 0.036,
            cycles = 34 * count }
        for k, x in ipairs(p) do
            p[k] = x / i.cohesion
        end
        figures.relative(count .. " zones a half width: q / c", last(p), case.expected.q_over_c, COHESIVE[count])
        ledger[#ledger + 1] = { "DF.prandtl, " .. count .. " zones a half width", model:energy().balance }
        series[#series + 1] = { name = count .. " zones a half width", x = way, y = p, style = "line" }
        series[3] = { name = "2 + pi", x = { 0, way[#way] }, y = { case.expected.q_over_c, case.expected.q_over_c }, style = "line" }
    end
    figures.plot { title = "DF.prandtl: mean pressure", x = "way of the footing, m", y = "pressure over cohesion", series = series }
end
figures.finish()
