-- Direct shear of a joint under constant normal stress, there and back again.
package.path = "tests/verify/?.lua;tests/lua/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local case = require("reference_statics")["S.shear"]

local STRESS = 1e-3   -- relative to the peak
local AT_REST = 1e-10 -- unbalanced force ratio under the normal stress
local STEPS = 400     -- between two points of the path
local SHOWN = 10      -- points of the figure between two points of the path

-- The upper cube of 1 m lies within the lower block, so that their common area stays; a load holds
-- the normal stress. The lower block is driven, the upper one can only move up and down.
local function build(row)
    local model, lower, upper = require "cube_on_block"({ -1, -1, -1 }, { 2, 2, 0 })
    upper:fix { x = true, y = true, rotation = true }
    upper:load { force = { 0, 0, -row.sigma } }
    model:joint("*", "coulomb", { kn = row.ks, ks = row.ks, friction = row.phi_deg,
        cohesion = row.c })
    model:timestep { rule = "body", fraction = 0.5 }
    model:damping "local"
    figures.equal("at rest after", model:solve { ratio = AT_REST }.reason, "ratio")
    model:timestep { dt = model.dt } -- whole steps for the path
    return model, lower, upper
end

local function check(row, number)
    local model, lower, upper = build(row)
    local contact = model:contacts { between = { lower, upper } }[1]
    local name = string.format("row %d: ", number)
    figures.relative(name .. "normal stress, Pa", contact.normal_stress, row.sigma, STRESS)
    lower:reset_displacement()
    local way, stress = { 0 }, { 0 }
    -- The lower block's way is that of the upper one back over it; the force is that on the upper.
    local speed = 0
    lower:drive { velocity = function() return { -speed, 0, 0 } end }
    for i = 2, #row.path do
        local from = -lower[1].displacement[1]
        speed = (row.path[i] - from) / (STEPS * model.dt)
        for _ = 1, SHOWN do
            model:cycle(STEPS // SHOWN)
            way[#way + 1], stress[#stress + 1] = -lower[1].displacement[1],
                -contact.shear_force[1] / contact.area
        end
        -- Forces are those of the places at the last step's beginning: one step at rest shows them.
        speed = 0
        model:cycle(1)
        local tau = -contact.shear_force[1] / contact.area
        way[#way], stress[#stress] = -lower[1].displacement[1], tau
        figures.near(string.format("%sshear stress at %+.4f mm, Pa", name, 1e3 * row.path[i]), tau,
            row.tau[i], STRESS * row.peak)
    end
    figures.near(name .. "shear stress across, Pa", contact.shear_force[2] / contact.area, 0,
        STRESS * row.peak)
    figures.relative(name .. "normal stress at the end, Pa", contact.normal_stress, row.sigma,
        STRESS)
    return way, stress
end

figures.case("S.shear", "A cube pressed on a block by a constant load is sheared by driving the "
    .. "block, to and fro: the shear stress along the path, for three sets of stiffness, stress "
    .. "and strength.",
    case.source)
local series = {}
for i, row in ipairs(case.rows) do
    local way, stress = check(row, i)
    series[#series + 1] = { name = string.format("row %d, obtained", i), x = way, y = stress,
        colour = i }
    series[#series + 1] = { name = string.format("row %d, expected", i), x = row.path, y = row.tau,
        style = "points", colour = i }
end
figures.plot { title = "S.shear: to and fro", x = "shear displacement, m", y = "shear stress, Pa",
    series = series }
figures.finish()
