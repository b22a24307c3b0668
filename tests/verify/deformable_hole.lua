-- A hole in rock that yields, by a sector of it in plane strain: how far it yields, and how far the wall comes in.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local RADIUS, WALL = 0.04, 0.05 -- relative, with 22 rings
local LEDGER = 5e-3             -- of the largest term, with plastic zones
local AT_REST = 1e-5            -- unbalanced force ratio
local RINGS, THICK = 22, 0.3    -- and m
local STIFF = 100               -- times the moduli of the reference: its strains are small
local PARTS = 10                -- in which the pressure on the wall goes

local ledger, series = {}, {}
for _, psi in ipairs { 30, 0 } do
    local case = reference["DF.salencon_psi" .. psi]
    local i = case.inputs
    figures.case("DF.salencon_psi" .. psi, "A sector of ten degrees under equal stresses on all sides: the pressure on the wall of "
        .. "the hole goes to 0 in ten parts.", case.source)
    local model = zones.model { solid = "mohr_coulomb", params = { bulk = STIFF * i.K, shear = STIFF * i.G, cohesion = i.cohesion,
        friction = i.friction, dilation = i.dilation } }
    local side = zones.sector(model, { inner = i.radius, outer = i.outer, rings = RINGS, thickness = THICK })
    model:cycle(0)
    model:insitu { stress = { xx = -i.far, yy = -i.far, zz = -i.far } }
    model:boundary { plane = side.outer, pressure = i.far }
    local pressure, ways = {}, {}
    for k = 1, PARTS do
        pressure[k] = 1 - k / PARTS
        model:boundary { plane = side.inner, pressure = i.far * pressure[k] }
        figures.equal(string.format("comes to rest at %g of the pressure", pressure[k]),
            model:relax { ratio = AT_REST, stop_at_failure = false }.reason, "rest")
        ways[k] = -STIFF * zones.radial(model, i.radius)
    end
    -- the section of the zones that have yielded is that of a sector from the wall to the plastic radius
    local section = model:zones({ plastic = true }):sum "volume" / THICK
    local radius = math.sqrt(i.radius ^ 2 + section / zones.SECTOR_AREA)
    figures.relative("plastic radius, m", radius, case.expected.plastic_radius_outer10, RADIUS)
    figures.relative("way of the wall by the moduli of the reference, m", ways[PARTS], case.expected.wall_outer10, WALL)
    ledger[#ledger + 1] = { "DF.salencon_psi" .. psi, model:energy().balance }
    series[#series + 1] = { name = "dilation " .. psi, x = ways, y = pressure, style = "line" }
    series[#series + 1] = { name = "closed form, dilation " .. psi, x = { case.expected.wall_outer10 }, y = { 0 }, style = "points" }
end
figures.plot { title = "DF.salencon: the wall comes in", x = "way of the wall, m", y = "share of the pressure left", series = series }

figures.case("DF.ledger.plastic", "Energy gained or lost as the holes yield, over the largest term.", "first law")
for _, row in ipairs(ledger) do
    figures.near(row[1], row[2], 0, LEDGER)
end
figures.finish()
