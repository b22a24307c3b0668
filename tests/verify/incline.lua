-- A cube on an inclined plane: sticks or slides, its acceleration, and how far it coasts.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference"
local incline = require "examples.incline"

local ACCELERATION = 0.001 -- relative
local FINE = 0.02          -- of the stable step: omega dt is 0.03
local BALANCE = 1e-3       -- of the largest term of the energy ledger
local COASTING = 0.001     -- relative

local function check(theta, mu, sticks, acceleration)
    local r = incline.run { theta = theta, mu = mu }
    local name = string.format("dip %g, friction %.5f", theta, mu)
    figures.equal(name .. " sticks", r.sticks, sticks)
    if sticks then
        -- Elastic shear of the springs alone, 1e-8 m, and its ringing.
        figures.between(name .. " moves", math.abs(r.slip), 0, 1e-8)
    else
        figures.relative(name .. " acceleration", r.acceleration, acceleration, ACCELERATION)
    end
end

figures.case("D.incline", "A cube rests on an incline, then the friction is given: it sticks, or "
    .. "slides with an acceleration; also a thousandth of friction above and below the threshold.",
    reference.incline.source)
for _, row in ipairs(reference.incline) do
    check(row.theta, row.mu, row.sticks, row.acceleration)
end

-- A thousandth of friction above and below the threshold.
for _, theta in ipairs { 10, 20, 30, 40 } do
    local threshold = math.tan(math.rad(theta))
    check(theta, threshold + 0.001, true)
    check(theta, threshold - 0.001, false, 10 * math.cos(math.rad(theta)) * 0.001)
end

figures.case("D.coast", "A cube slides along a level plane at a given speed: where and when does "
    .. "friction stop it?", reference.coast.source)
for _, row in ipairs(reference.coast) do
    local r = incline.coast { v0 = row.v0, mu = row.mu }
    local name = string.format("at %g m/s, friction %g", row.v0, row.mu)
    figures.relative(name .. " stops at", r.distance, row.distance, COASTING)
    figures.relative(name .. " stops after", r.time, row.time, COASTING)
    r = incline.coast { v0 = row.v0, mu = row.mu, fraction = FINE }
    figures.near(name .. " energy balance at omega dt = 0.03", r.model:energy().balance, 0,
        BALANCE)
end
figures.finish()
