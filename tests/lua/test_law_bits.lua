-- The curves of the laws have the same bits from every compiler and on every machine: a sum over the bits of each, obtained
-- once. Any other number means that some machine or compiler computes something else, or that the law has changed.
local talus = require "talus"
local check = require "check"

local slips = { kn = 1e10, ks = 1e10, friction = 35, residual_friction = 25, distance = 1e-3 }
local heals = { kn = 1e10, ks = 1e10, friction = 35, residual_friction = 25, distance = 1e-3, form = "exponential",
    cohesion = 1e5, healing = "time", healing_time = 10 }
local tests = {
    { bits = "c2ac4d9c2cfbff15", law = "slip_weakening", params = heals, normal_stress = 1e6, path = { 3e-3, { time = 5 }, -1e-3 } },
    { bits = "614a44b20673e5e6", law = "slip_weakening", params = slips, normal_stress = 1e6, path = { 3e-3, -1e-3 } },
    { bits = "bd09e5d4bb71751d", law = "cohesive", path = { { closure = -5e-5, shear = 1e-4 }, { closure = 1e-5, shear = -1e-3 },
        { closure = 1e-5, shear = 1e-3 } },
        params = { kn = 4e10, ks = 1.6e10, tension = .25e6, cohesion = .35e6, gi = 18, gii = 125, friction = 35 } },
    { bits = "3f588c02db1d7f45", law = "barton_bandis", normal_stress = 1e6, stiffness = 1e9, path = { 1e-2, -1e-2 },
        params = { jrc = 8, jcs = 5e7, phi_r = 28, kni = 2e9, vm = 5e-4, ks = 2e10, length = 1 } },
    { bits = "514fdfe1421f6aff", law = "continuously_yielding", normal_stress = 2e5, steps = 4000, path = { 2e-3, -2e-3, 1e-3 },
        params = { an = 2e7, en = .5, as = 1e6, es = .5, kn_max = 2e10, ks_max = 1e9, phi_i = 50, phi = 30, roughness = 2e-3 } },
    { bits = "ad374086cd614f1f", law = "rate_state", normal_stress = 1e7,
        path = { { shear = 2.4e-3, time = 1 }, { shear = 3e-3, steps = 6000, speed = 1e-6 } },
        params = { kn = 1e11, ks = 2.5e9, a = .01, b = .015, dc = 1e-5, damping = 5e6 } },
    { bits = "724f29d66a00afb1", law = "rate_state", normal_stress = 1e7,
        path = { { shear = 4e-4, speed = 1e-6 }, { shear = 6e-4, speed = 1e-5 } },
        params = { kn = 1e11, ks = 1e13, a = .01, b = .015, dc = 1e-5, evolution = "slip" } },
}
for _, test in ipairs(tests) do
    local wanted, sum = test.bits, 0
    test.bits = nil
    local curve = talus.law_test(test)
    for _, name in ipairs { "shear_stress", "normal_stress", "closure", "stored", "heat" } do
        for _, value in ipairs(curve[name]) do
            sum = sum * 31 + string.unpack("<i8", string.pack("<d", value))
        end
    end
    check.equal(test.law .. " " .. string.format("%016x", sum), test.law .. " " .. wanted)
end
