-- Zones that flow: a footing up to its bearing capacity. Constant strain alone bears up to a fifth too much.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local COHESIVE = 0.03 -- relative, with four zones a half width
local LEDGER = 5e-3   -- of the largest term, with plastic zones
local ZONES = 4       -- a half width

-- ------------------------------------------------------------------ footings

-- Half of a rough footing of half width `half` on a slice of soil one zone thick in plane strain, driven down by `way`:
-- mean pressures and ways. Velocities fall to zero over the zone beside the footing, so half of a zone bears, too.
local function footing(what)
    local zone = what.half / what.count
    local model = zones.model { solid = "mohr_coulomb", params = what.params }
    model:generate("box", { min = { 0, 0, 0 }, max = { what.width, zone, what.depth }, density = 2000 })
    model:blocks():deformable { solid = "rock", zone = zone }
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
    local p, way, model = footing { half = i.half_width, count = ZONES, width = i.domain[1], depth = i.domain[2],
        params = { young = i.E, poisson = i.nu, cohesion = i.cohesion, friction = i.friction, tension = 1e9 }, way = 0.036,
        cycles = 160 }
    for k, x in ipairs(p) do
        p[k] = x / i.cohesion
    end
    figures.relative("q / c", last(p), case.expected.q_over_c, COHESIVE)
    figures.near("energy gained or lost, over the largest term", model:energy().balance, 0, LEDGER)
    local exact = case.expected.q_over_c
    local series = { { name = "zones", x = way, y = p, style = "line" },
        { name = "2 + pi", x = { 0, way[#way] }, y = { exact, exact }, style = "line" } }
    figures.plot { title = "DF.prandtl: mean pressure", x = "way of the footing, m", y = "pressure over cohesion", series = series }
end
figures.finish()
