-- Factors of safety of cut rock: of a model that has settled as of one that is as cut, at any stiffness, beside chattering slivers.
-- program only: the models are the same ones with a stock Lua.
package.path = "scripts/?.lua;" .. package.path -- run in the source root
local check = require "check"
local cut_bench = require "cut_bench"
local slope = require "examples.slope"
local talus = require "talus"

-- ------------------------------------------------------------ soft joints

-- The slope of 49 blocks has one factor at any stiffness, as cut or settled: soft joints are made stiffer, and begin as cut.
local WEDGE = math.tan(math.rad(30)) / math.tan(math.rad(27.14))
for _, kn in ipairs(check.few { 1e7, 1e8 }) do
    for _, settled in ipairs { false, true } do
        local model = slope.build(30)
        model:joint("*", { kn = kn, ks = kn })
        if settled then
            model:relax { ratio = 1e-6 }
        end
        local before = model:state_hash()
        local r = model:factor_of_safety { from = 1, to = 1.5, resolution = 0.002 }
        check.near(r.factor / WEDGE, 1, 0.003)
        check.equal(r.undecided, 0)
        check.holds(r.cycles < 8000, "steps of all trials")
        check.equal(model:state_hash(), before)
    end
end

-- ------------------------------------------------------------ what has moved

-- A cube that was driven from a steep part of a slope to a flat one, where it has settled, has the factor of the flat one.
local STEEP, FLAT, FRICTION = 35, 20, 40
local function tangent(degrees)
    return math.tan(math.rad(degrees))
end
local moved = talus.model {}
local t, foot = tangent(FLAT), 4
local top = foot * t + 4 * tangent(STEEP)
moved:generate("profile", { section = { { 0, -2 }, { 8, -2 }, { 8, top }, { foot, foot * t }, { 0, 0 } }, to = 2, density = 2500 })
moved:blocks():fix()
local function over(x, slope_of, low)
    return { { x, low }, { x + 1, low + slope_of }, { x + 1, low + slope_of + 1 }, { x, low + 1 } }
end
local START, END = 4.5, 1.5
moved:generate("profile", { section = over(START, tangent(FLAT), foot * t + 1 * tangent(STEEP)), from = 0.5, to = 1.5, density = 2500 })
moved:joint("*", "coulomb", { kn = 1e7, ks = 1e7, friction = FRICTION })
local cube = moved:blocks { fixed = false }
local way = { END - START, 0, END * t - (foot * t + 1 * tangent(STEEP)) + 1e-3 }
cube:drive { velocity = way } -- in 1 s
moved:solve { max_time = 1, stop_at_failure = false, ratio = 0 }
cube:free()
moved:relax { ratio = 1e-5 }
local r = moved:factor_of_safety {}
check.near(r.factor / (tangent(FRICTION) / tangent(FLAT)), 1, 0.012)

-- ------------------------------------------------------------ cut rock

-- Slivers chatter at 0.71, and nothing moves: that is rest.
local rock = cut_bench.build(4, 2, 35)
check.equal(#rock:blocks { fixed = false }, 168)
local still = rock:factor_of_safety { from = 0.69, to = 0.71, resolution = 0.02, least_volume = 0.1, max_cycles = 20000 }
check.equal(still.undecided, 0)
check.equal(still.factor, math.huge)
