-- The arch of the fewest voussoirs; verify/long/arches.lua has all.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local arch = require("reference_dynamics").arch
require "check_arch" { arch[1] }
