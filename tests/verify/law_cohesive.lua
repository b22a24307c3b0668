-- A bond that softens: opened, sheared and both at once until it breaks.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_laws"

local WORK = 1e-3   -- relative, as in the reference
local PLACE = 1e-3  -- relative: one step of the path
local PEAK = 1e-3   -- relative: the peak lies between two steps

local STEPS = 4000
local series = {}

-- Work of a stress over a displacement, by trapezoids.
local function work(stress, way)
    local sum = 0
    for i = 2, #way do
        sum = sum + 0.5 * (stress[i] + stress[i - 1]) * (way[i] - way[i - 1])
    end
    return sum
end

local function check(id)
    local case = reference[id]
    local given, expected = case.inputs, case.expected
    local length = math.sqrt(given.path[1] ^ 2 + given.path[2] ^ 2)
    local open, slide = given.path[1] / length, given.path[2] / length
    local far = expected.failure * 1.2
    local curve = talus.law_test { law = "cohesive", steps = STEPS,
        params = { kn = given.kn, ks = given.ks, tension = given.tension, cohesion = given.cohesion, gi = given.GI,
            gii = given.GII },
        path = { { closure = -open * far, shear = slide * far } } }
    local way, size, opening, pull, onset, failure = {}, {}, {}, {}, nil, nil
    local normal, shear = 0, 0
    for i = 1, #curve.shear do
        way[i] = far * (i - 1) / STEPS
        opening[i], pull[i] = -curve.closure[i], -curve.normal_stress[i]
        size[i] = math.sqrt(pull[i] ^ 2 + curve.shear_stress[i] ^ 2)
        normal, shear = math.max(normal, pull[i]), math.max(shear, curve.shear_stress[i])
        onset = onset or curve.states.damage[i] > 0 and way[i]
        failure = failure or curve.failed[i] and way[i]
    end
    local of_normal, of_shear = work(pull, opening), work(curve.shear_stress, curve.shear)
    local n = #way
    local step = far / STEPS
    figures.case(id, "A point is moved along one direction until its bond is lost: onset, failure, peaks, and the work done in "
        .. "tension and in shear.", case.source)
    figures.near("onset, m", onset, expected.onset + step / 2, step / 2 * (1 + 1e-9))
    figures.near("failure, m", failure, expected.failure + step / 2, step / 2 * (1 + 1e-9) + expected.failure * 1e-5)
    figures.near("work in tension, J/m2", of_normal, expected.work_normal, WORK * (expected.work_normal + expected.work_shear))
    figures.near("work in shear, J/m2", of_shear, expected.work_shear, WORK * (expected.work_normal + expected.work_shear))
    figures.relative("sum of the shares of GI and GII", of_normal / given.GI + of_shear / given.GII, expected.sum_of_shares,
        WORK)
    if open > 0 then
        figures.relative("peak of the normal stress, Pa", normal, expected.peak_normal, PEAK)
    end
    if slide > 0 then
        figures.relative("peak of the shear stress, Pa", shear, expected.peak_shear, PEAK)
    end
    figures.relative("heat, J/m2", curve.heat[n], of_normal + of_shear, 1e-9)
    figures.near("stress after failure, Pa", size[n], 0, 1e-9)
    series[#series + 1] = { name = id, x = way, y = size }
end

for _, mode in ipairs { "I", "II", "mixed", "mixed30" } do
    check("LAW.cohesive." .. mode)
end
figures.plot { title = "LAW.cohesive: stress along the path", x = "displacement, m", y = "size of the stress, Pa",
    series = series }
figures.finish()
