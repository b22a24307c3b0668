-- A cantilever of zones under a load at its end, with four and with eight zones through its depth.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local TIP = { [4] = 0.10, [8] = 0.04 } -- relative, by zones through the depth
local FALLS = 2.5                      -- by which the error falls on halving the zones
local SMALL = 0.01                     -- of the load: the beam is linear then
local AT_REST = 1e-5                   -- unbalanced force ratio

local case = reference["DF.cantilever"]
local i = case.inputs
figures.case("DF.cantilever", "A cantilever under a force at its end: how far this goes down.", case.source)
local off = {}
for _, count in ipairs { 4, 8 } do
    local model = zones.model { young = i.E, poisson = i.nu }
    model:generate("box", { min = { 0, 0, 0 }, max = { i.length, i.side, i.side }, density = 2500 })
    model:blocks():deformable { zone = i.side / count, solid = "rock" }
    -- the theory of beams lets the section become wider and higher at its foot
    zones.on(model, "x", 0):fix { x = true, z = true }
    model:gridpoints { near = { 0, 0, 0 } }:fix { y = true }
    model:gridpoints { near = { i.length, 0, 0 } }:fix { y = true }
    model:boundary { side = "xmax", traction = { 0, 0, -SMALL * i.end_load / i.side ^ 2 } }
    local name = count .. " zones through the depth: "
    figures.equal(name .. "comes to rest", model:relax { ratio = AT_REST }.reason, "rest")
    local tip, sum = zones.on(model, "x", i.length), 0
    for _, p in ipairs(tip) do
        sum = sum - p.displacement[3] / #tip / SMALL
    end
    off[count] = math.abs(sum / case.expected.tip - 1)
    figures.relative(name .. "way of the end, m", sum, case.expected.tip, TIP[count])
end
figures.between("error with four zones over that with eight", off[4] / off[8], FALLS, math.huge)
figures.finish()
