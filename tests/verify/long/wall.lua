-- A dry brick wall on a tilting table: along the wall bricks slide and turn in many ways, across it the
-- wall topples as a whole.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local statics = require "check_statics"
local reference = require("reference_dynamics").wall

local GRAVITY, DENSITY = 10, 2000
local STIFFNESS = 1e10    -- Pa/m: the lowest joint closes by 2.4e-6 m
local AT_REST = 1e-7
local MOVED = 2e-3        -- m in one step of the tilt: many times what the springs yield
local NEAR, COARSE, FINE = 0.8, 0.1, 0.25 -- of the tilt expected; the same; degrees
-- Limit analysis is an upper bound for Coulomb friction; an independent relaxation fails up to this much
-- below it, degrees. Across, nothing slides: a quarter of a degree is the step, and half of that lost.
local BELOW, ACROSS = 1.5, 0.2

local function build(mu)
    -- Bricks lean on their corners as they turn: so limit analysis has it.
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, contact_points = "corners" }
    local l, h, t = reference.length, reference.height, reference.thickness
    local width = reference.bricks_per_course * l
    model:generate("box", { min = { -0.5, -0.5, -0.2 }, max = { width + 0.5, t + 0.5, 0 },
        density = DENSITY, group = "base" })
    for course = 0, reference.courses - 1 do
        local shift = course % 2 == 1 and l / 2 or 0
        for k = 0, reference.bricks_per_course do
            local from, to = math.max(0, k * l - shift), math.min(width, (k + 1) * l - shift)
            if to > from + l / 4 then
                model:generate("box", { min = { from, 0, course * h },
                    max = { to, t, (course + 1) * h }, density = DENSITY, group = "brick" })
            end
        end
    end
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS,
        friction = math.deg(math.atan(mu)) })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    return model, model:blocks { group = "brick" }
end

-- Degrees half-way between the last tilt that stood and the first that did not.
local function limit(row, direction)
    local model, bricks = build(row.mu)
    figures.equal("bricks", #bricks, reference.bricks)
    return statics.search(0, NEAR * row.tilt, COARSE * row.tilt, FINE, function(tilt)
        local level = GRAVITY * math.sin(math.rad(tilt))
        model.gravity = { level * direction[1], level * direction[2],
            -GRAVITY * math.cos(math.rad(tilt)) }
        return (statics.stands(model, bricks, { ratio = AT_REST, moving = MOVED }))
    end)
end

figures.case("S.wall", "A running-bond wall of 27 dry bricks on a tilting table: tilt at which it fails, "
    .. "along the wall for three frictions, and across it", reference.source)
local frictions, bounds, obtained = {}, {}, {}
for i, row in ipairs(reference.along) do
    local tilt = limit(row, { 1, 0 })
    local what = string.format("along, friction coefficient %g: ", row.mu)
    figures.between(what .. "last tilt that stood, degrees", tilt - FINE / 2, 0, row.tilt)
    figures.between(what .. "first tilt that failed, degrees", tilt + FINE / 2, row.tilt - BELOW, 90)
    frictions[i], bounds[i], obtained[i] = row.mu, row.tilt, tilt
end
figures.near("across: tilt at failure, degrees", limit(reference.across, { 0, 1 }),
    reference.across.tilt, ACROSS)
figures.plot { title = "Brick wall: tilt at failure along the wall", x = "friction coefficient",
    y = "tilt, degrees", series = {
        { name = "limit analysis (upper bound)", x = frictions, y = bounds, style = "line" },
        { name = "obtained", x = frictions, y = obtained, style = "points" },
    } }
figures.finish()
