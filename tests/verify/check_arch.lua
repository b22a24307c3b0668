-- check_arch.lua - a semicircular arch of voussoirs under its own weight stands when it is a little thicker than the
-- least thickness at which a line of thrust fits inside, and falls as a mechanism of hinges when it
-- is a little thinner.
package.path = "tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local statics = require "check_statics"
local reference = require "reference_dynamics"
local voussoirs = require "voussoirs"

-- kn / (rho g). An arch near its limit stands on hinges, where its joints open and close: by the third root of their
-- yielding, which costs it height (topple.lua has it for one block). So does the thickness it needs over the limit of rigid
-- blocks; with eight times the stiffness it is half as much, and twice the one less the other is that limit.
local SOFT, STIFF = 1.25e5, 1e6
local MORE = { [SOFT] = 0.145, [STIFF] = 0.0725 } -- about, of the limit thickness
local AT_REST = 1e-6
local MOST_CYCLES = 3000000       -- near its limit an arch rests late: one took 1.5e6
local FALLEN = 0.05 * voussoirs.RADIUS
local AROUND = 0.02               -- of the limit thickness: sought so far below and above
local BRACKET = 0.005             -- of the limit thickness, in which failure is found
local LIMIT = 0.01                -- relative

-- Whether the arch stands, its thickness a share of the limit.
local function stands(case, share, stiffness)
    local model, arch = voussoirs.arch(case.voussoirs, share * case.thickness * voussoirs.RADIUS, stiffness)
    return (statics.stands(model, arch, { ratio = AT_REST, moving = FALLEN, max_cycles = MOST_CYCLES }))
end

-- The thickness between the last that stood and the first that fell, over the limit.
local function threshold(case, stiffness)
    local low, high = 1 + MORE[stiffness] - AROUND, 1 + MORE[stiffness] + AROUND
    local what = string.format("kn = %g rho g: stands at %%g of the limit thickness", stiffness)
    figures.equal(what:format(high), stands(case, high, stiffness), true)
    figures.equal(what:format(low), stands(case, low, stiffness), false)
    while high - low > BRACKET do
        local middle = (low + high) / 2
        if stands(case, middle, stiffness) then
            high = middle
        else
            low = middle
        end
    end
    return (low + high) / 2
end

-- The arches of some cases of reference_dynamics.lua.
return function(cases)
    local numbers, expected, obtained = {}, {}, {}
    for i, case in ipairs(cases) do
        figures.case(case.name, string.format("A semicircular arch of %d voussoirs under its own weight: "
            .. "thickness at which it just stands, over the mean radius", case.voussoirs),
            reference.arch.source)
        local share = 2 * threshold(case, STIFF) - threshold(case, SOFT)
        figures.relative("thickness at failure over the limit, for rigid joints", share, 1, LIMIT)
        numbers[i], expected[i] = case.voussoirs, case.thickness
        obtained[i] = share * case.thickness
    end
    if #cases > 1 then
        figures.plot { title = "Arch: least thickness over the mean radius", x = "voussoirs",
            y = "thickness / radius", series = {
                { name = "limit analysis", x = numbers, y = expected, style = "line" },
                { name = "obtained", x = numbers, y = obtained, style = "points" },
            } }
    end
    figures.finish()
end
