-- A rectangular block on a rough incline, let go: does it stand, slide, topple, or both?
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference").slope

local GRAVITY, DENSITY = 10, 2000
-- Of the block's base, under its weight: its springs hardly tip it. On its toe, where it is pressed in with the square of the
-- depth, it sinks in by 4e-4 of its base, and slips by a part of that.
local OVERLAP = 1e-7
local AT_REST = 1e-8 -- unbalanced force ratio
local MOVING = 1e-3  -- of the base or as an angle: far beyond what the springs yield
local WATCHED = 1e-2 -- likewise: where the watch over the motion ends
-- Share of the way of the top that its toe slides or that the turn makes, below which it does not.
-- Next to the boundary between toppling and both the toe slides the less the nearer it is.
local SHARE = 0.005

-- The incline is level and gravity inclined, towards +x.
local function build(row)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    local b, h = row.b, row.h
    model:generate("box", { min = { -3 * b, -b, -b }, max = { 4 * b, 2 * b, 0 }, density = DENSITY,
        group = "incline" })
    model:generate("box", { min = { 0, 0, 0 }, max = { b, b, h }, density = DENSITY,
        group = "block" })
    model:blocks { group = "incline" }:fix()
    local stiffness = DENSITY * GRAVITY * h / (OVERLAP * b)
    model:joint("*", "coulomb", { kn = stiffness, ks = stiffness, friction = 89 })
    model:timestep { rule = "body", fraction = 0.5 }
    model:damping "local"
    return model, model:blocks { group = "block" }
end

-- Rest or motion under the inclined weight. Local damping brakes the motion, which leaves the ratio
-- of its accelerations; undamped springs would ring as the block is let go.
local function let_go(row)
    local model, block = build(row)
    assert(model:solve { ratio = AT_REST }.reason == "ratio")
    local psi = math.rad(row.psi)
    model.gravity = { GRAVITY * math.sin(psi), 0, -GRAVITY * math.cos(psi) }
    model:joint("*", { friction = row.phi })
    block:reset_displacement()
    local function motion()
        local angle = 2 * math.asin(block[1].rotation[3])
        -- The toe: the lower front edge, which slides by what the centroid does not owe to the
        -- turn.
        local c, s = math.cos(angle), math.sin(angle)
        local x, z = -row.b / 2, row.h / 2 -- of the centroid from the toe
        local slip = block[1].displacement[1] - (c * x + s * z - x)
        return slip, angle
    end
    local function go_on(far)
        return model:solve { ratio = AT_REST, every = 10, stop = function()
            local slip, angle = motion()
            return math.abs(slip) > far * row.b or math.abs(angle) > far
        end }.reason
    end
    if go_on(MOVING) == "ratio" then
        return "stable", 0, 0
    end
    -- From here on: without the tilt of the springs, and without what they slip as the block is let
    -- go.
    local slip_before, angle_before = motion()
    local reason = go_on(WATCHED)
    local slip, angle = motion()
    slip, angle = slip - slip_before, angle - angle_before
    return reason, slip, angle * row.h
end

-- What moves, of the way of the toe along the incline and that of the top by the turn.
local function mode_of(reason, slip, turn)
    local all = math.abs(slip) + math.abs(turn)
    if reason == "stable" then
        return "stable", 0
    elseif slip <= SHARE * all then
        return "toppling", slip / all
    end
    return turn <= SHARE * all and "sliding" or "sliding+toppling", slip / all
end

figures.case("S.block_on_slope", "A rectangular block at rest on an incline is let go, for nine "
    .. "shapes and frictions: whether it stands, slides, topples, or slides and topples.",
    reference.source)
local rows, shares = {}, {}
for i, row in ipairs(reference) do
    local mode
    mode, shares[i] = mode_of(let_go(row))
    rows[i] = i
    figures.equal(string.format("%g x %g m, dip %g, friction %g degrees", row.b, row.h, row.psi,
        row.phi), mode, row.mode)
end
figures.plot { title = "S.block_on_slope: how much of the motion is sliding",
    x = "row: 1 stands, 2, 6, 8 slide, 7 slides and topples, the others topple",
    y = "slip / (slip + way of the top)", series = {
        { name = "obtained", x = rows, y = shares, style = "points" },
        { name = "below: topples only", x = { 1, #rows }, y = { SHARE, SHARE } },
        { name = "above: slides only", x = { 1, #rows }, y = { 1 - SHARE, 1 - SHARE } } } }
figures.finish()
