-- The wedge of example 1 in Hart, Cundall and Lemos (1988) once more, with the block below both planes touching its lower
-- edge, which is given a minimum area: it takes a share of the weight, most of it from the face on B.
--
-- Where the wedge is pressed into its planes by p and q, q < p, what it has in common with the block below is a prism as long
-- as the edge with a parallelogram for its section. Its mean overlap is s = q - q^2 / 3p, whatever the angle between the
-- planes, and the edge stores k s^2 / 2. So its force is along no one's normal, but along the gradient of s. (In the
-- paper the edge has a normal of its own: 0.70 in place of 0.65 at failure.)
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local statics = require "check_statics"
local reference = require("reference_dynamics").wedge_edge

local DENSITY, GRAVITY = 2000, 10
local APEX = { 0, 0.5, 1 }
local STIFFNESS = 2.5e6            -- N/m of every face, normal and shear: the edge is no strip of a flush face
local EDGE = 3                     -- minimum area over that of the face whose joint the edge falls to, B
-- Friction coefficient: first under which to settle, and how it is lowered.
local FIRST, COARSE, NEAR, STEP = 0.85, 0.005, 0.75, 0.0005
-- Of the weight, and relative: while it settles a little shear across the line is locked in, which the elastic shares
-- leave out.
local SHARE, LOCKED = 0.02, 0.01
local AT_REST = 1e-6
local MOVING = 0.1                 -- m: many times what the joints yield under the wedge, 8 mm

local function degrees(coefficient)
    return math.deg(math.atan(coefficient))
end

-- The wedge on A and B, with or without force at its edge; `turns` lets it turn.
local function build(edge, turns)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { -2, -1, -1 }, max = { 2, 1, 1 }, density = DENSITY,
        group = "box" })
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
    model:blocks { below = above "A", group = "box" }:set { group = "below" }
    if not turns then
        wedge:fix { rotation = true }
    end
    -- Stiffness per area such that both faces have the same. The one on B takes part in the minimum area.
    model:joint("*", "coulomb", { kn = 1, ks = 1, friction = degrees(FIRST) })
    local own = {}
    for _, name in ipairs { "A", "B" } do
        own[name] = model:contacts { joint = name, between = { wedge, model:blocks() } }:max "area"
    end
    local least = edge and EDGE * own.B or 0
    for name, area in pairs(own) do
        area = name == "B" and math.sqrt(area ^ 2 + least ^ 2) or area
        model:joint(name, "coulomb", { kn = STIFFNESS / area, ks = STIFFNESS / area,
            friction = degrees(FIRST) })
    end
    model:contact_area { absolute = least, joint = "B" }
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    return model, wedge
end

-- Normal force at the edge over the weight.
local function edge_share(model, wedge)
    local contacts = model:contacts { between = { wedge, model:blocks { group = "below" } } }
    return (#contacts > 0 and contacts[1].normal_force or 0) / (wedge[1].mass * GRAVITY)
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

-- Friction coefficient at which a wedge that does not turn fails, and the force of the edge over the weight. Across the line
-- of intersection the weight is a n_A + b n_B.
local function expected()
    local function normal(name)
        local dip, direction = math.rad(reference[name][1]), math.rad(reference[name][2])
        return { math.sin(dip) * math.sin(direction), math.sin(dip) * math.cos(direction), math.cos(dip) }
    end
    local na, nb = normal "A", normal "B"
    local c = na[1] * nb[1] + na[2] * nb[2] + na[3] * nb[3]
    local a, b = (na[3] - c * nb[3]) / (1 - c * c), (nb[3] - c * na[3]) / (1 - c * c)
    local along = math.sqrt(1 - a * na[3] - b * nb[3])
    -- Face stiffness 1: p + k s ds/dp = a, q + k s ds/dq = b.
    local k, p, q = EDGE / math.sqrt(1 + EDGE ^ 2), a, b
    local s, by_p, by_q
    for _ = 1, 1000 do
        s, by_p, by_q = q - q * q / (3 * p), (q / p) ^ 2 / 3, 1 - 2 * q / (3 * p)
        p, q = 0.5 * (p + a - k * s * by_p), 0.5 * (q + b - k * s * by_q)
    end
    assert(q < p and math.abs(q + k * s * by_q - b) < 1e-12)
    local edge = k * s * math.sqrt(by_p ^ 2 + by_q ^ 2 + 2 * c * by_p * by_q)
    return along / (p + q + edge), edge
end

figures.case("E1.run2", "The wedge of the first example, its lower edge carrying as well. Friction coefficient at "
    .. "failure, kept from turning and free to turn", reference.source)
local friction, carried = expected()
local straight, share = failure(true, false)
figures.relative("friction coefficient at failure, kept from turning", straight, friction, LOCKED)
figures.near("normal force at the edge over the weight, at failure", share, carried, SHARE)
figures.relative("friction coefficient at failure, free to turn", (failure(true, true)), friction, LOCKED)
-- Without the edge the first run's friction comes back.
figures.between("friction coefficient at failure without the edge, free to turn",
    (failure(false, true)), 0.645, 0.665)
figures.finish()
