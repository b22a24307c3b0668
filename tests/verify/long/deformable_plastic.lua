-- Zones that flow: footings up to their bearing capacity. Constant strain alone bears up to a third too much.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local FRICTION = 0.05 -- relative, of footings on soil with friction
local LEDGER = 5e-3   -- of the largest term, with plastic zones
local STIFF = 100     -- times the modulus of the reference: the solution has small strains
local PARTS = 40      -- in which a footing is driven

-- ------------------------------------------------------------------ footings

-- Half of a rough footing on a slice of soil two zones thick in plane strain. The soil is two blocks that are joined
-- below the edge of the footing, so that gridpoints lie there.
local function footing(what)
    local zone = what.half / what.count
    local thick, deep, wide = 2 * zone, what.depth, what.width
    local model = zones.model { solid = "mohr_coulomb", params = what.params }
    model:generate("box", { { min = { 0, 0, 0 }, max = { what.half, thick, deep }, density = 2000 },
        { min = { what.half, 0, 0 }, max = { wide, thick, deep }, density = 2000 } })
    model:blocks():join()
    model:blocks():deformable { solid = "rock", zone = zone }
    zones.on(model, "z", 0):fix() -- a smooth base would let the whole layer be squeezed out at a lower load
    for _, wall in ipairs { { "x", 0 }, { "x", wide }, { "y", 0 }, { "y", thick } } do
        zones.on(model, wall[1], wall[2]):fix { [wall[1]] = true }
    end
    local under = model:gridpoints { where = function(p)
        local x = p.position
        return math.abs(x[3] - deep) < 1e-9 and x[1] < what.half + 1e-9
    end }
    under:fix()
    model:timestep { dt = model.dt }
    model:damping("local", { alpha = 0.8 })
    return model, under, thick
end

-- The width that a footing moves: what its surface sweeps in the first step, in which nothing else moves yet. The velocity
-- falls to zero over the zones beside the footing, so about half of one bears, too.
local function swept_width(what)
    local model, under, thick = footing(what)
    local way, before = what.half / what.count / 1000, model:zones():sum "volume"
    under:set { velocity = { 0, 0, -way / model.dt } }
    model:cycle(1)
    return (before - model:zones():sum "volume") / way / thick
end

-- Drives a footing down by `way`: mean pressures over cohesion, and ways.
local function drive(what)
    local width = swept_width(what)
    local model, under, thick = footing(what)
    local pressures, ways = {}, {}
    under:set { velocity = { 0, 0, -what.way / (PARTS * what.cycles) / model.dt } }
    for k = 1, PARTS do
        model:cycle(what.cycles)
        pressures[k], ways[k] = -under:reaction()[3] / (width * thick) / what.params.cohesion, k * what.way / PARTS
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

local soil, series = reference["DF.prandtl"].inputs, {}

local function check(name, story, runs)
    local case = reference[name]
    figures.case(name, story, case.source)
    local exact, friction = case.expected.q_over_c or case.expected.Nc, case.inputs.friction
    for _, run in ipairs(runs) do
        local p, way, model = drive { half = soil.half_width, count = run.count, width = run.width or soil.domain[1],
            depth = run.depth or soil.domain[2], way = run.way, cycles = run.cycles, params = { young = STIFF * soil.E, poisson = soil.nu,
                cohesion = soil.cohesion, friction = friction, dilation = friction, tension = 1e9 } }
        local title = string.format("%d zones a half width: ", run.count)
        figures.relative(title .. "q / c", last(p), exact, run.within)
        figures.near(title .. "energy gained or lost, over the largest term", model:energy().balance, 0, LEDGER)
        for k = 1, PARTS do
            p[k], way[k] = p[k] / exact, way[k] * 1000
        end
        series[#series + 1] = { name = string.format("friction %g, %d zones", friction, run.count), x = way, y = p, style = "line" }
    end
end

-- Faster footings overshoot the load at which flow begins. Ways are half as long again as those to flow. Prandtl's wedges
-- end at 3 half widths without friction, at 4.2 with 10 and at 6.1 with 20 degrees, there 2.3 deep.
check("DF.prandtl", "A rough footing is driven into weightless soil with cohesion alone: mean pressure over cohesion as it flows.", {
    { count = 4, way = 4e-4, cycles = 160, within = 0.03 }, { count = 16, way = 4e-4, cycles = 240, within = 0.02 } })
check("DF.prandtl_phi10", "The same with friction, and with as much dilation.", {
    { count = 12, way = 5e-4, cycles = 300, within = FRICTION } })
check("DF.prandtl_phi20", "The same with more friction.", {
    { count = 16, way = 8.5e-4, cycles = 420, width = 12.5, depth = 4.8, within = FRICTION } })
figures.plot { title = "DF.prandtl: mean pressure", x = "way of the footing, mm", y = "pressure over Prandtl's", series = series }
figures.finish()
