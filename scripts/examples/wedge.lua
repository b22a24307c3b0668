-- wedge.lua - a wedge of rock between two planes: at which friction does it slide, and along what?
--
--     build/release/talus scripts/examples/wedge.lua
--
-- A box of rock is cut by two joints, A and B, through one point of its top. The block above both
-- is the wedge; the other three are held. Consolidated under a friction no joint has, it is at
-- rest. Then the friction is lowered, a little at a time, until the wedge no longer finds
-- equilibrium.
--
-- What it must do is known in closed form. Let n_A, n_B be the upward normals of the planes, and W
-- = 1 the weight. The wedge slides
--   on plane A alone   when its line of steepest descent leads away from B; failure at
--                      mu = tan(dip A);
--   on both            when neither does so; its direction s is the line both planes share, and the
--                      forces follow from  N_A n_A + N_B n_B - T s = z  (upwards):
--                      T = sin(plunge of s),
--                      failure at  mu_A N_A + mu_B N_B = T.
-- (E. Hoek and J. Bray, Rock Slope Engineering; R. Goodman and G.-h. Shi, Block Theory. The first
-- case is example 1 of Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125.)
--
-- The closed form lets the wedge move straight only. A real one also turns a little as it settles,
-- which locks some shear across the direction of sliding into the joints and leaves less friction
-- to hold it. The stiffer the joints are in shear, the more: E1.run1 has the paper's ks = kn and
-- fails 1 % early; the others have ks = kn / 5 (with ks = kn the unequal frictions of W6 cost 2.3
-- %, the largest of all).
local talus = require "talus"

local wedge = {}

-- Joints as {dip, dip direction} in degrees; `ks` in Pa/m. `friction` is the pair of friction
-- coefficients whose proportion is kept while they are lowered; without it, both planes have the
-- same.
wedge.cases = {
    { name = "E1.run1", A = { 40, 130 }, B = { 60, 220 }, ks = 1e7 },
    { name = "W1", A = { 30, 130 }, B = { 60, 220 } },
    { name = "W2", A = { 50, 130 }, B = { 60, 220 } },
    { name = "W3", A = { 45, 105 }, B = { 70, 235 } },
    { name = "W4", A = { 50, 120 }, B = { 50, 240 } },
    { name = "W5", A = { 55, 160 }, B = { 40, 250 } },
    { name = "W6.unequal", A = { 40, 130 }, B = { 60, 220 }, friction = { 0.5, 0.9 } },
    { name = "W7.single", A = { 40, 150 }, B = { 60, 110 }, friction = { 0.5, 0.5 } },
    { name = "W8.single", A = { 65, 120 }, B = { 38, 170 }, friction = { 0.6, 0.3 } },
}

local DENSITY, GRAVITY = 2000, 10        -- kg/m3, m/s2
local KN, KS = 1e7, 2e6                  -- Pa/m, of the joints, unless a case says otherwise
local APEX = { 0, 0.5, 1 }               -- where both joints meet the top of the box
local CONSOLIDATION = 10                 -- friction coefficient to settle under
local FIRST, STEP = 3, 0.998             -- the friction scale starts here, lowered by 0.2 % a time
local AT_REST = 1e-6                     -- unbalanced force ratio that counts as equilibrium
local SLIDING = 0.05                     -- m in one step: many times what the joints' springs yield

-- ---------------------------------------------------------------- vectors of the closed form

local function dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

local function unit(a)
    local length = math.sqrt(dot(a, a))
    return { a[1] / length, a[2] / length, a[3] / length }
end

-- Angle between two directions, degrees.
local function angle(a, b)
    return math.deg(math.acos(math.max(-1, math.min(1, dot(unit(a), unit(b))))))
end

local function upward_normal(plane)
    local dip, direction = math.rad(plane[1]), math.rad(plane[2])
    local level = math.sin(dip)
    return { level * math.sin(direction), level * math.cos(direction), math.cos(dip) }
end

local function steepest_descent(plane)
    local dip, direction = math.rad(plane[1]), math.rad(plane[2])
    local level = math.cos(dip)
    return { level * math.sin(direction), level * math.cos(direction), -math.sin(dip) }
end

-- Mode of sliding ("A", "B" or "A and B"), its direction, the normal forces over the weight, and
-- the scale of the friction coefficients at failure.
function wedge.closed_form(case)
    local mu = case.friction or { 1, 1 }
    local n = { upward_normal(case.A), upward_normal(case.B) }
    local down = { steepest_descent(case.A), steepest_descent(case.B) }
    for i, name in ipairs { "A", "B" } do
        if dot(n[3 - i], down[i]) > 0 then
            local normal = { 0, 0 }
            normal[i] = -dot(n[i], { 0, 0, -1 })
            return { mode = name, direction = down[i], normal = normal,
                     scale = -down[i][3] / (mu[i] * normal[i]) }
        end
    end
    local s = unit(cross(n[1], n[2]))
    if s[3] > 0 then
        s = { -s[1], -s[2], -s[3] }
    end
    -- N_A n_A + N_B n_B - T s = z: the product with a vector normal to two of them leaves the
    -- third.
    local z = { 0, 0, 1 }
    local a, b = cross(n[2], s), cross(s, n[1])
    local normal = { dot(z, a) / dot(n[1], a), dot(z, b) / dot(n[2], b) }
    return { mode = "A and B", direction = s, normal = normal,
             scale = -s[3] / (mu[1] * normal[1] + mu[2] * normal[2]) }
end

-- ---------------------------------------------------------------- the model

local function degrees(coefficient)
    return math.deg(math.atan(coefficient))
end

-- The four blocks at rest under high friction. Gives the model and the wedge, a selection of one
-- block.
function wedge.build(case, options)
    options = options or {}
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, threads = options.threads }
    model:generate("box", { min = { -2, -1, -1 }, max = { 2, 1, 1 }, density = DENSITY })
    for _, joint in ipairs { "A", "B" } do
        local dip, direction = case[joint][1], case[joint][2]
        model:generate("joint", { joint = joint, dip = dip, dip_direction = direction,
            origin = APEX })
    end

    local above_A = { dip = case.A[1], dip_direction = case.A[2], origin = APEX }
    local n, top = upward_normal(case.B), APEX
    local block = model:blocks { above = above_A }:where(function(b)
        local c = b.centroid
        return dot(n, { c[1] - top[1], c[2] - top[2], c[3] - top[3] }) > 0
    end)
    model:blocks():fix()
    block:free():set { group = "wedge" }

    local friction = degrees(CONSOLIDATION)
    for _, joint in ipairs { "A", "B" } do
        model:joint(joint, "coulomb", { kn = KN, ks = case.ks or KS, friction = friction })
    end
    -- The wedge's bottom edge touches the block under both planes; the closed form has no force
    -- there.
    model:contact_area { fraction = 0 }
    model:damping "local"
    -- One block alone: half the largest stable step is safe, and five times as fast as the default.
    model:timestep { rule = "body", fraction = 0.5 }
    local settled = model:solve { ratio = AT_REST }
    assert(settled.reason == "ratio", "the wedge does not come to rest under high friction")
    return model, block
end

-- Normal force of the wedge on a joint over its weight.
local function load_share(model, block, joint)
    local others = model:blocks { fixed = true }
    local contacts = model:contacts { joint = joint, between = { block, others } }
    return contacts:sum "normal_force" / (block[1].mass * GRAVITY)
end

-- Sets the friction coefficients and waits for equilibrium: true, or false when the wedge slides,
-- with the mean of the normal forces on A and B on the way.
function wedge.holds(model, block, mu_A, mu_B)
    model:joint("A", { friction = degrees(mu_A) })
    model:joint("B", { friction = degrees(mu_B) })
    block:reset_displacement()
    local sum, looks = { 0, 0 }, 0
    local run = model:solve { ratio = AT_REST, every = 50, stop = function()
        looks = looks + 1
        sum = { sum[1] + load_share(model, block, "A"), sum[2] + load_share(model, block, "B") }
        local u = block[1].displacement
        return dot(u, u) > SLIDING ^ 2
    end }
    assert(run.reason == "ratio" or run.reason == "stop", "neither at rest nor sliding")
    return run.reason == "ratio", { sum[1] / looks, sum[2] / looks }
end

-- Lowers the friction, all history kept, until the wedge slides. Gives what was expected and what
-- happened: the scale of friction between the last that held and the first that did not, the planes
-- that carry the wedge as it slides, its direction, and the angle between that and the expected
-- one.
function wedge.run(case, options)
    local expected = wedge.closed_form(case)
    local model, block = wedge.build(case, options)
    local mu = case.friction or { 1, 1 }
    local scale = FIRST
    local still, share = wedge.holds(model, block, scale * mu[1], scale * mu[2])
    while still do
        scale = scale * STEP
        still, share = wedge.holds(model, block, scale * mu[1], scale * mu[2])
    end
    local CARRIES = 0.01 -- of the weight
    local mode = share[1] < CARRIES and "B" or share[2] < CARRIES and "A" or "A and B"
    local direction = block[1].displacement
    local obtained = scale / math.sqrt(STEP) -- the middle of the bracket
    return {
        name = case.name, expected = expected, obtained = obtained,
        error = obtained / expected.scale - 1, mode = mode, normal = share, direction = direction,
        off_direction = angle(direction, expected.direction), model = model, block = block,
    }
end

-- The quantity a case is known by: with equal frictions the coefficient itself; otherwise the
-- factor of safety of the given frictions, that is by how much they may be divided before the wedge
-- slides.
function wedge.quantity(case, scale)
    if case.friction then
        return "FS", 1 / scale
    end
    return "mu", scale
end

-- How it goes on from there, as a page for a browser.
function wedge.film(result, name)
    local model = result.model
    model:stage "the friction at which it slides"
    for _ = 1, 10 do
        model:cycle(400)
        model:write_html(name, { title = "A wedge on two planes, " .. result.name })
    end
end

function wedge.main(folder)
    print("Wedges on two planes: friction (mu) or factor of safety (FS) at which they slide\n")
    print("case         plane A   plane B         expected  obtained   error   slides on"
        .. "          off line")
    for k, case in ipairs(wedge.cases) do
        local r = wedge.run(case)
        if k == 1 then
            wedge.film(r, folder .. "/wedge")
        end
        local name, obtained = wedge.quantity(case, r.obtained)
        local _, expected = wedge.quantity(case, r.expected.scale)
        print(string.format("%-11s  %d/%03d    %d/%03d     %-4s %8.4f  %8.4f  %+5.2f %%"
            .. "  %-7s (%s)  %6.2f deg",
            case.name, case.A[1], case.A[2], case.B[1], case.B[2], name, expected, obtained,
            100 * (obtained / expected - 1), r.mode,
            r.mode == r.expected.mode and "right" or "WRONG", r.off_direction))
    end
    print(string.format("\n%s/wedge.html shows the first of them in a browser", folder))
end

-- A test that says require "examples.wedge" wants the functions only.
if ... ~= "examples.wedge" then
    wedge.main(arg and arg[1] or "out/wedge")
end
return wedge
