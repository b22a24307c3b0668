-- The friction at which a wedge slides, for planes of many dips: the closed form that identifies the
-- attitudes of example 1 in Hart, Cundall and Lemos (1988), followed by simulation from 20 to 80
-- degrees.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require("reference_dynamics").dip_scan
local wedge = require "examples.wedge"

local TOLERANCE = 0.02 -- relative, as for the wedges: settling turns the wedge a little
local KS = 1e7 -- Pa/m, the paper's: the same as across the joint

figures.case("E1.dipscan", "A wedge on B = 60/220 and a plane A of dip direction 130: friction "
    .. "coefficient at failure against the dip of A", reference.source)
local dips, expected, obtained = {}, {}, {}
for i, row in ipairs(reference) do
    local r = wedge.run { name = "dip " .. row.dip, A = { row.dip, reference.dip_direction },
        B = reference.B, ks = KS }
    figures.relative(string.format("friction coefficient at failure, dip %g", row.dip), r.obtained,
        row.mu, TOLERANCE)
    dips[i], expected[i], obtained[i] = row.dip, row.mu, r.obtained
end
figures.plot { title = "Wedge: friction at failure", x = "dip of plane A, degrees",
    y = "friction coefficient", series = {
        { name = "expected", x = dips, y = expected, style = "line" },
        { name = "obtained", x = dips, y = obtained, style = "points" },
    } }
figures.finish()
