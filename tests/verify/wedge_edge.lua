-- The wedge of example 1 in Hart, Cundall and Lemos (1988) once more, with the block below both planes
-- touching its lower edge: three contacts of 10 MN/m each share its weight, and it fails at a higher
-- friction.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local statics = require "check_statics"
local reference = require("reference_dynamics").wedge_edge

local DENSITY, GRAVITY = 2000, 10
local APEX = { 0, 0.5, 1 }
local STIFFNESS = 1e7              -- N/m of every contact, normal and shear
-- Friction coefficient: first under which to settle, and how it is lowered.
local FIRST, COARSE, NEAR, STEP = 0.85, 0.005, 0.75, 0.0005
-- Of the weight: while it settles a little shear across the line is locked in, which the elastic shares
-- leave out.
local SHARE = 0.02
local AT_REST = 1e-6
local MOVING = 0.05                -- m: many times what 10 MN/m yield under the wedge, 2 mm

local function degrees(coefficient)
    return math.deg(math.atan(coefficient))
end

-- The wedge on A and B, with or without force at its edge; `turns` lets it turn.
local function build(edge, turns)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { -2, -1, -1 }, max = { 2, 1, 1 }, density = DENSITY })
    for _, name in ipairs { "A", "B" } do
        model:generate("joint", { joint = name, dip = reference[name][1],
            dip_direction = reference[name][2], origin = APEX })
    end
    local function above(name)
        return { dip = reference[name][1], dip_direction = reference[name][2], origin = APEX }
    end
    model:blocks { above = above "B" }:set { group = "above B" }
    model:blocks():fix()
    local wedge = model:blocks { above = above "A", group = "above B" }:free()
    if not turns then
        wedge:fix { rotation = true }
    end
    -- Stiffness per area such that every contact has the same; the edge takes the area of the face
    -- whose joint it falls to.
    model:joint("*", "coulomb", { kn = 1, ks = 1, friction = degrees(FIRST) })
    for _, name in ipairs { "A", "B" } do
        local area = model:contacts { joint = name, between = { wedge, model:blocks() } }:max "area"
        model:joint(name, "coulomb", { kn = STIFFNESS / area, ks = STIFFNESS / area,
            friction = degrees(FIRST) })
        model:contact_area(edge and { absolute = area, joint = name }
            or { fraction = 0, joint = name })
    end
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    return model, wedge
end

-- Normal force at the edge over the weight: the contact whose normal is neither plane's.
local function edge_share(model, wedge)
    local sum = 0
    for _, contact in ipairs(model:contacts { between = { wedge, model:blocks { fixed = true } } }) do
        local n, cosine = contact.normal, 0
        for _, name in ipairs { "A", "B" } do
            local dip, direction = math.rad(reference[name][1]), math.rad(reference[name][2])
            cosine = math.max(cosine, math.abs(n[1] * math.sin(dip) * math.sin(direction)
                + n[2] * math.sin(dip) * math.cos(direction) + n[3] * math.cos(dip)))
        end
        sum = sum + (cosine < 0.99 and contact.normal_force or 0)
    end
    return sum / (wedge[1].mass * GRAVITY)
end

local function failure(edge, turns)
    local model, wedge = build(edge, turns)
    local share
    local friction = statics.search(FIRST, NEAR, COARSE, STEP, function(mu)
        for _, name in ipairs { "A", "B" } do
            model:joint(name, { friction = degrees(mu) })
        end
        local still = statics.stands(model, wedge, { ratio = AT_REST, moving = MOVING })
        share = still and edge_share(model, wedge) or share
        return still
    end)
    return friction, share
end

figures.case("E1.run2", "The wedge of the first example, its lower edge carrying as well: every contact "
    .. "has 10 MN/m. Friction coefficient at failure, with the wedge free to turn and kept from it",
    reference.source)
local straight, share = failure(true, false)
figures.between("friction coefficient at failure, kept from turning", straight, reference.low,
    reference.high)
figures.near("normal force at the edge over the weight, at failure", share, reference.normal[3],
    SHARE)
figures.between("friction coefficient at failure, free to turn", (failure(true, true)),
    reference.low, reference.high)
-- Without the edge the first run's friction comes back.
figures.between("friction coefficient at failure without the edge, free to turn",
    (failure(false, true)), 0.645, 0.665)
figures.finish()
