-- A block between two plates: the joints above and below it act as springs in series.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local joint = require "check_joint"
local case = require("reference_statics")["S.series"]

local STRESS = 1e-4   -- relative to the larger stress
local AT_REST = 1e-8  -- unbalanced force ratio
local PUSH = 0.5      -- s in which the upper plate comes down: many times the period of the block
local LOOKS = 50      -- during the push, for the figure

-- The block is 1 m high and 1 m2 wide, so its weight over area is density times gravity.
local function build(row)
    local gravity = row.w > 0 and 10 or 0
    local density = row.w > 0 and row.w / gravity or 2000
    local model = talus.model { gravity = { 0, 0, -gravity } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 3 }, density = density })
    model:generate("joint", { joint = "lower", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
    model:generate("joint", { joint = "upper", dip = 0, dip_direction = 0, origin = { 0, 0, 2 } })
    model:joint("upper", "coulomb", { kn = row.kn1, ks = row.kn1, friction = 30 })
    model:joint("lower", "coulomb", { kn = row.kn2, ks = row.kn2, friction = 30 })
    local plates = { model:blocks { containing = { 0.5, 0.5, 2.5 } },
        model:blocks { containing = { 0.5, 0.5, 0.5 } } }
    plates[1]:fix()
    plates[2]:fix()
    model:timestep { rule = "body", fraction = 0.1 }
    model:damping "local"
    return model, plates[1], model:blocks { containing = { 0.5, 0.5, 1.5 } }
end

local function stress(model, name)
    local contacts = model:contacts { joint = name }
    return #contacts > 0 and contacts:sum "normal_force" / contacts:sum "area" or 0
end

figures.case("S.series", "A block between two plates carries its weight, then the upper plate is "
    .. "driven down: the stress in both joints, of different stiffness, and the way of the block.",
    case.source)
local series, ends = {}, { name = "springs in series, at the end", x = {}, y = {},
    style = "points" }
for i, row in ipairs(case.rows) do
    local model, plate, block = build(row)
    local way, lower = {}, {}
    model:cycle(1) -- the contacts are made before the plate moves
    local begin = model.time
    plate:drive { velocity = function(t)
        return { 0, 0, t < begin + PUSH and -row.d / PUSH or 0 }
    end }
    for look = 1, LOOKS do
        model:solve { ratio = 0, max_time = PUSH / LOOKS }
        way[look], lower[look] = -plate[1].displacement[3], stress(model, "lower")
    end
    -- The steps need not end where the push does: the rest of the way.
    local left = row.d + plate[1].displacement[3]
    plate:drive { velocity = { 0, 0, -left / model.dt } }
    model:cycle(1)
    plate:drive { velocity = { 0, 0, 0 } }
    local name = string.format("row %d: ", i)
    figures.near(name .. "plate has moved, m", -plate[1].displacement[3], row.d, 1e-12)
    figures.equal(name .. "at rest after", model:solve { ratio = AT_REST }.reason, "ratio")
    local most = math.max(row.sigma_upper, row.sigma_lower)
    figures.near(name .. "upper stress, Pa", stress(model, "upper"), row.sigma_upper, STRESS * most)
    figures.near(name .. "lower stress, Pa", stress(model, "lower"), row.sigma_lower, STRESS * most)
    -- A joint that closes by more than a thousandth of the side is no linear spring.
    local expected = row.sigma_upper > 0 and row.block_displacement
        or joint.closure(row.kn2, 1, row.sigma_lower)
    figures.relative(name .. "way of the block, m", -block[1].displacement[3], expected, STRESS)
    series[i] = { name = string.format("lower joint, row %d", i), x = way, y = lower }
    ends.x[i], ends.y[i] = row.d, row.sigma_lower
end
series[#series + 1] = ends
figures.plot { title = "S.series: stress while the plate comes down", x = "way of the plate, m",
    y = "normal stress, Pa", series = series }
figures.finish()
