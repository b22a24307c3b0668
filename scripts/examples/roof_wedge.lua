-- roof_wedge.lua - a wedge in the roof of an excavation, clamped by the stress in the rock.
--
--     build/release/talus scripts/examples/roof_wedge.lua
--
-- Three equal joints through one point above the roof z = 0 cut a pyramid of height h. The rock
-- around it is held; a horizontal stress sigma clamps the pyramid. Its weight makes it settle by d,
-- which unloads the joints' normal springs and loads their shear springs. Then the friction is
-- lowered until it drops.
--
-- Closed form, per unit of face area, with s = sin(dip), c = cos(dip):
--     initial stress      N0 = sigma s^2,  S0 = sigma s c  (acting up on the wedge)
--     weight              rho g h c / 3    (whatever the number of faces)
--     settlement          d = (rho g h / 3) c / (ks s^2 + kn c^2)
--     final stress        N = N0 - kn d c,  S = S0 + ks d s
--     friction at failure mu = S / N
-- This is example 2 of Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125,
-- after R. Goodman, G.-h. Shi and W. Boyle (1982), and the same for other joints, stresses and
-- sizes.
local talus = require "talus"

local roof = {}

-- kn, ks in Pa/m, sigma in Pa (compression), dip in degrees, height in m. The first is the paper's.
roof.cases = {
    { kn = 1e7, ks = 1e7, sigma = 5e4, dip = 60, height = 1 },
    { kn = 1e7, ks = 5e6, sigma = 5e4, dip = 60, height = 1 },
    { kn = 1e7, ks = 1e6, sigma = 5e4, dip = 60, height = 1 },
    { kn = 1e7, ks = 2e7, sigma = 5e4, dip = 60, height = 1 },
    { kn = 1e8, ks = 1e8, sigma = 5e4, dip = 60, height = 1 },
    { kn = 1e7, ks = 1e7, sigma = 2e4, dip = 60, height = 1 },
    { kn = 1e7, ks = 1e7, sigma = 1e5, dip = 60, height = 1 },
    { kn = 1e7, ks = 1e7, sigma = 2e4, dip = 65, height = 1 },
    { kn = 5e7, ks = 2e7, sigma = 1e5, dip = 55, height = 2 },
    { kn = 1e7, ks = 1e7, sigma = 5e4, dip = 70, height = 1.5 },
    { kn = 2e7, ks = 1e7, sigma = 3e4, dip = 50, height = 0.5 },
    { kn = 1e9, ks = 1e8, sigma = 5e4, dip = 60, height = 1 },
}

local DENSITY, GRAVITY = 2000, 10              -- kg/m3, m/s2
local DIP_DIRECTIONS = { 30, 150, 270 }        -- degrees
local CONSOLIDATION = 10                       -- friction coefficient to settle under
local FIRST, STEP = 2, 0.999                   -- friction starts here, lowered by 0.1 % a time
local AT_REST = 1e-7                           -- unbalanced force ratio that counts as equilibrium
local DROPPING = 0.02                          -- of the height, in one step of friction

function roof.closed_form(case)
    local s, c = math.sin(math.rad(case.dip)), math.cos(math.rad(case.dip))
    local N0, S0 = case.sigma * s * s, case.sigma * s * c
    local d = DENSITY * GRAVITY * case.height / 3 * c / (case.ks * s * s + case.kn * c * c)
    local N, S = N0 - case.kn * d * c, S0 + case.ks * d * s
    return { mu = S / N, settlement = d, normal_stress = N, shear_stress = S,
             initial_normal_stress = N0, initial_shear_stress = S0 }
end

-- The smallest and the largest normal and shear stress on the three faces of the wedge.
local function face_stresses(model, wedge)
    local rock = model:blocks { fixed = true }
    local result = { normal_min = math.huge, normal_max = 0, shear_min = math.huge, shear_max = 0 }
    for i = 1, #DIP_DIRECTIONS do
        local face = model:contacts { joint = "J" .. i, between = { wedge, rock } }
        -- Stress over the whole face: the neighbours across an edge share it once the wedge has
        -- moved.
        local area, shear = face:sum "area", face:sum "shear_force"
        local normal_stress = face:sum "normal_force" / area
        local shear_stress = math.sqrt(shear[1] ^ 2 + shear[2] ^ 2 + shear[3] ^ 2) / area
        result.normal_min = math.min(result.normal_min, normal_stress)
        result.normal_max = math.max(result.normal_max, normal_stress)
        result.shear_min = math.min(result.shear_min, shear_stress)
        result.shear_max = math.max(result.shear_max, shear_stress)
    end
    return result
end

-- Eight blocks, the lowest of them free, with the in situ stress on their faces; at time 0.
function roof.build(case, options)
    options = options or {}
    local h = case.height
    local apex = { 0, 0, h }
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, threads = options.threads }
    model:generate("box", { min = { -4 * h, -4 * h, 0 }, max = { 4 * h, 4 * h, 2 * h },
        density = DENSITY })
    for i, direction in ipairs(DIP_DIRECTIONS) do
        model:generate("joint", { joint = "J" .. i, dip = case.dip, dip_direction = direction,
            origin = apex })
    end
    local wedge = model:blocks { containing = { 0, 0, h / 10 } }
    model:blocks():fix()
    wedge:free():set { group = "wedge" }

    local friction = math.deg(math.atan(CONSOLIDATION))
    model:joint("*", "coulomb", { kn = case.kn, ks = case.ks, friction = friction })
    -- Edges and the apex carry nothing in the closed form.
    model:contact_area { fraction = 0 }
    -- Tension is positive, so a compressive stress is negative.
    model:insitu { stress = { xx = -case.sigma, yy = -case.sigma } }
    model:damping "local"
    -- One block alone: half the largest stable step is safe, and five times as fast as the default.
    model:timestep { rule = "body", fraction = 0.5 }
    return model, wedge
end

-- Sets the friction coefficient and waits for equilibrium: true, or false when the wedge drops.
function roof.holds(model, wedge, mu, height)
    model:joint("*", { friction = math.deg(math.atan(mu)) })
    local start = wedge[1].displacement[3]
    local run = model:solve { ratio = AT_REST, every = 20, stop = function()
        return start - wedge[1].displacement[3] > DROPPING * height
    end }
    assert(run.reason == "ratio" or run.reason == "stop", "neither at rest nor dropping")
    return run.reason == "ratio"
end

-- Settles the wedge and lowers the friction until it drops. Gives expected and obtained values.
function roof.run(case, options)
    local expected = roof.closed_form(case)
    local model, wedge = roof.build(case, options)
    -- Critically damped: it settles without going too far. Of a face that parts and meets again the shear would be less.
    model:damping("viscous", { alpha = 2 * math.sqrt(GRAVITY / expected.settlement) })
    local settled = model:solve { ratio = AT_REST }
    model:damping "local"
    assert(settled.reason == "ratio", "the wedge does not come to rest under high friction")
    local result = {
        case = case, expected = expected, blocks = #model:blocks(), model = model, wedge = wedge,
        settlement = -wedge[1].displacement[3], stresses = face_stresses(model, wedge),
        volume = wedge[1].volume, centroid = wedge[1].centroid,
    }
    local mu = FIRST
    while roof.holds(model, wedge, mu, case.height) do
        mu = mu * STEP
    end
    result.mu = mu / math.sqrt(STEP) -- the middle of the bracket
    result.error = result.mu / expected.mu - 1
    return result
end

-- How it goes on from there, as a page for a browser.
function roof.film(result, name)
    local model = result.model
    model:stage "the friction at which it drops"
    for _ = 1, 10 do
        model:cycle(100)
        model:write_html(name, { title = "A wedge in a roof" })
    end
end

function roof.main(folder)
    print("Roof wedge: friction coefficient at which it drops, and its settlement before\n")
    print("    kn      ks   sigma  dip  height    mu expected  obtained    error   settlement: "
        .. "expected, obtained")
    for k, case in ipairs(roof.cases) do
        local r = roof.run(case)
        if k == 1 then
            roof.film(r, folder .. "/roof_wedge")
        end
        print(string.format("%6.0e  %6.0e  %6.0e  %3d  %4.1f m       %8.5f  %8.5f  %+5.2f %%"
            .. "     %10.4e  %10.4e m",
            case.kn, case.ks, case.sigma, case.dip, case.height, r.expected.mu, r.mu, 100 * r.error,
            r.expected.settlement, r.settlement))
    end
    print(string.format("\n%s/roof_wedge.html shows the first of them in a browser", folder))
end

-- A test that says require "examples.roof_wedge" wants the functions only.
if ... ~= "examples.roof_wedge" then
    roof.main(arg and arg[1] or "out/roof_wedge")
end
return roof
