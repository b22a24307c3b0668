-- Arches of several numbers of voussoirs.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
require "check_arch" (require("reference_dynamics").arch)
