-- A block on a plane under part of its weight, out of the slope: the least part that makes it slide or tip.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference_earthquakes").kh

local GRAVITY, TOLERANCE = 10, 0.01
local STIFFNESS = 1e10 -- Pa/m

-- Whether the block stands under kh. The plane lies level, and the gravity dips; down the dip is x.
local function stands(case, kh)
    local dip = math.rad(case.dip)
    local s, c = math.sin(dip), math.cos(dip)
    local model = talus.model { gravity = { GRAVITY * (s + kh * c), 0, -GRAVITY * (c - kh * s) }, contact_points = "corners" }
    model:generate("box", { min = { -3, -1, -1 }, max = { 5, 2, 0 }, density = 2500, group = "base" })
    model:generate("box", { min = { 0, 0, 0 }, max = { case.b, 1, case.h }, density = reference.unit_weight / GRAVITY,
        group = "block" })
    model:blocks { group = "base" }:fix()
    local block = model:blocks { group = "block" }
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = case.friction })
    if case.water then
        -- V at a third of its height, U at a third of the base from the back, both about the centroid
        local moment = case.V * (case.water / 3 - case.h / 2) - case.U * (case.b / 3 - case.b / 2)
        block:load { force = { case.V, 0, case.U }, moment = { 0, moment, 0 } }
    end
    model:damping "local"
    local result = model:solve { ratio = 1e-6, stop_at_failure = true, max_cycles = 200000 }
    return result.failing == nil, block[1]
end

for _, case in ipairs(reference) do
    figures.case(case.name, string.format("Block of %g x %g m on a plane of %g degrees, friction %g degrees: least part of "
        .. "the weight that moves it, which %s", case.b, case.h, case.dip, case.friction, case.tips and "tips" or "slides"),
        reference.source)
    local low, high = 0, 2 * case.kh
    while high - low > 0.002 * case.kh do
        local middle = (low + high) / 2
        if stands(case, middle) then
            low = middle
        else
            high = middle
        end
    end
    figures.relative("kh", (low + high) / 2, case.kh, TOLERANCE)
end
figures.finish()
