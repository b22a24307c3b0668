-- Free fall: exact at whole steps; a falling block beside others that touch still has a time step.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference").freefall

figures.case("D.freefall", "A block falls from rest for a second; and one falls past two held "
    .. "blocks that touch, with the step of either rule: their way against g t^2 / 2.",
    reference.source)

local model = talus.model { gravity = { 0, 0, -reference.g } }
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 2, 3 }, density = 2000 })
model:timestep { dt = reference.dt }
local block, time, way = model:blocks()[1], {}, {}
for i = 1, 50 do
    model:cycle(reference.steps // 50)
    time[i], way[i] = model.time, -block.displacement[3]
end
figures.plot { title = "D.freefall: way of the block", x = "time, s", y = "way, m", series = {
    { name = "obtained", x = time, y = way },
    { name = "expected", x = { reference.dt * reference.steps }, y = { reference.drop },
        style = "points" } } }
figures.near("time", model.time, reference.dt * reference.steps, 1e-10)
figures.near("drop", -block.displacement[3], reference.drop, 1e-10)
figures.near("centroid", block.centroid[3], 1.5 - reference.drop, 1e-10)
figures.near("sideways", math.abs(block.displacement[1]) + math.abs(block.displacement[2]), 0, 0)
figures.near("turn", 1 - block.rotation[1], 0, 0)
figures.near("energy balance", model:energy().balance, 0, 1e-12)

-- Two held blocks touch, a third falls past them. Its step is that of a cube that stands on its face: by the paper's rule a
-- tenth of 2 (m / 2k)^(1/2), by the body's half of it, with r^2/I = 6 (1/2^2 + 1/6) / m.
local STANDS = 1e7 / 2000 -- k / m
local steps = { paper = 0.1 * 2 / math.sqrt(2 * STANDS), body = 0.5 * 2 / math.sqrt(2 * STANDS * 3.5) }
for _, rule in ipairs { "paper", "body" } do
    model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000, group = "held" })
    model:generate("box", { min = { 1, 0, 0 }, max = { 2, 1, 1 }, density = 2000, group = "held" })
    model:generate("box", { min = { 5, 0, 0 }, max = { 6, 1, 1 }, density = 2000, group = "falls" })
    model:blocks { group = "held" }:fix()
    model:joint("*", "coulomb", { kn = 1e7, ks = 1e7, friction = 30 })
    model:timestep { rule = rule }
    model:cycle(200)
    figures.equal(rule .. " contacts", #model:contacts(), 1)
    figures.relative(rule .. " step", model.dt, steps[rule], 1e-12)
    figures.relative(rule .. " drop", -model:blocks { group = "falls" }[1].displacement[3],
        5 * model.time ^ 2, 1e-12)
end
figures.finish()
