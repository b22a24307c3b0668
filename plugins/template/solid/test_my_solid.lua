-- test_my_solid.lua - a zone that is sheared until only the residual strength is left.
--
--     talus --plugin build/my_solid.so test_my_solid.lua
local talus = require "talus"

local params = { young = 1e10, poisson = 0.25, peak = 2e6, residual = 5e5, distance = 0.002 }
local curve = talus.solid_test { solid = "my_solid", params = params, path = { { strain = { xy = 0.01 }, steps = 5000 } } }

-- in simple shear the root of J2 is the shear stress
local last, peak = #curve.work, math.max(table.unpack(curve.stress.xy))
print(("peak %.6g, residual %.6g Pa"):format(peak, curve.stress.xy[last]))
assert(math.abs(peak - params.peak) < 0.01 * params.peak, "the peak is not what it should be")
assert(math.abs(curve.stress.xy[last] - params.residual) < 1e-6 * params.residual, "nor is the residual strength")
local lost = curve.work[last] - curve.stored[last] - curve.dissipated[last]
assert(math.abs(lost) < 1e-3 * curve.work[last], "the energies do not balance")
