-- The example of a bolted roof: the bolts bear the weight of the keyblock, and let it go where they are too weak.
package.path = "scripts/?.lua;" .. package.path -- run in the source root
local check = require "check"
local bolted = require "examples.bolted_roof"

local holds = bolted.run(1.2, 2e5)
check.equal(holds.holds, true)
check.equal(#holds.bolts, 9)
check.near(holds.bolts:sum "axial" / bolted.weight(), 1, 1e-3)
check.holds(holds.settled < 1e-3, "it settles by less than 1 mm")
check.near(holds.model:energy().balance, 0, 1e-3)

-- Nine bolts of 50 kN bear 450 kN of 707: it falls, and all of them have yielded.
local falls = bolted.run(1.2, 5e4)
check.equal(falls.holds, false)
check.equal(#falls.bolts:where(function(one) return one.yielded end), 9)
check.near(falls.model:energy().balance, 0, 1e-3)
