-- Cubes, hulls, plates and needles that meet without friction, in any attitude, edge on edge and corner on corner: energy,
-- momentum and angular momentum. tests/lua/test_impacts.lua does the same for the first seeds.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local impacts = require "impacts"

local SEEDS = 40

figures.case("D.impacts", "Two blocks meet at 5 m/s without friction, 40 impacts of each kind, at a tenth and a twentieth of "
    .. "the critical step", "conservation of energy and momentum")
impacts.survey(SEEDS, function(row)
    figures.equal(row.name .. ": impacts after which blocks have parted", row.apart, SEEDS)
    figures.between(row.name .. ": worst error of the energy ledger, over the kinetic energy", row.worst, 0, impacts.ENERGY)
    figures.between(row.name .. ": worst error of the energy after the impact", row.parted, 0, impacts.ENERGY)
    if row.half > row.least then
        figures.between(row.name .. ": mean error of the ledger with half the step, over that before",
            row.half / row.mean, 0, impacts.FALL)
    end
    figures.between(row.name .. ": change of momentum", row.momentum, 0, impacts.MOMENTUM)
    figures.between(row.name .. ": change of angular momentum", row.angular, 0, impacts.MOMENTUM)
end)
figures.finish()
