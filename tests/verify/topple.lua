-- A block standing on its face resists tilting, and topples where its weight leaves the base: at tan(alpha) = b / h if it is
-- rigid. The joint yields by c under the weight's part across it and holds no tension. Where the weight acts at x from the
-- toe, 3x of the base are pressed, and the block leans by t = 2cb / 9x^2: tan(alpha + t) h / 2 = b / 2 - x. There is a
-- largest alpha, at about x = (2 c h b / 9)^(1/3), and tan(alpha) is there 1 - 3 x / b of the rigid one.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"

local WIDTH, DENSITY, GRAVITY = 1, 2000, 10
local OVERLAP = 1e-5       -- mean overlap over the width of the block
local FINE = 1e-3          -- relative, of tan(alpha) beside the limit
local LEAN = 2e-3          -- relative, of what it leans where it is watched
local FALLEN = 0.01        -- of the height, in one step of the tilt

-- The block at rest on a level, fixed base.
local function build(height)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = DENSITY,
        group = "base" })
    model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, height }, density = DENSITY,
        group = "block" })
    model:blocks { group = "base" }:fix()
    local stiffness = DENSITY * GRAVITY * height / (OVERLAP * WIDTH)
    model:joint("*", "coulomb", { kn = stiffness, ks = stiffness, friction = 80 })
    model:timestep { rule = "body", fraction = 0.5 }
    model:damping "local"
    model:solve { ratio = 1e-8 }
    return model, model:blocks { group = "block" }
end

-- Tilts gravity towards `direction` and waits: true at rest, within a ratio, false when the block falls. Beside the limit the
-- block goes to its place slowly and one way, and local damping leaves it a vibration of up to 1e-6 of its weight meanwhile.
local function stands(model, block, height, tangent, direction, ratio)
    local cosine = 1 / math.sqrt(1 + tangent * tangent)
    local along = GRAVITY * tangent * cosine
    model.gravity = { along * direction[1], along * direction[2], -GRAVITY * cosine }
    block:reset_displacement()
    local run = model:solve { ratio = ratio, every = 50, stop = function()
        local u = block[1].displacement
        return math.abs(u[1]) + math.abs(u[2]) > FALLEN * height
    end }
    assert(run.reason == "ratio" or run.reason == "stop", "neither at rest nor falling")
    return run.reason == "ratio"
end

-- How far the block leans, rad, where the weight acts at x while it is tilted.
local function lean_at(x, tangent)
    return 2 * OVERLAP * WIDTH ^ 2 / math.sqrt(1 + tangent ^ 2) / (9 * x ^ 2)
end

-- tan(alpha) at which it stands so.
local function tangent_at(height, x)
    local whole, tangent = math.atan((WIDTH - 2 * x) / height), 0
    for _ = 1, 50 do
        tangent = math.tan(whole - lean_at(x, tangent))
    end
    return tangent
end

-- The largest one.
local function limit_of(height)
    local x = (2 * OVERLAP * height / WIDTH / 9) ^ (1 / 3) * WIDTH
    local most = 0
    for i = 50, 200 do
        most = math.max(most, tangent_at(height, x * i / 100))
    end
    return most
end

-- How far it leans at a tilt, from the larger x at which it stands so.
local function lean(height, tangent)
    local low, high = (2 * OVERLAP * height / WIDTH / 9) ^ (1 / 3) * WIDTH, WIDTH / 6
    for _ = 1, 100 do
        local middle = 0.5 * (low + high)
        if tangent_at(height, middle) > tangent then
            low = middle
        else
            high = middle
        end
    end
    return lean_at(low, tangent)
end

for _, height in ipairs { 1, 2, 4 } do
    for _, direction in ipairs { { 1, 0 }, { 0, -1 } } do
        local name = string.format("h / b = %g towards {%g, %g}: ", height, direction[1], direction[2])
        local model, block = build(height)
        figures.relative(name .. "mean overlap", -block[1].displacement[3], OVERLAP, 1e-6)
        local limit = limit_of(height)
        for _, share in ipairs { 0.8, 0.9, 0.97 } do
            stands(model, block, height, share * limit, direction, 1e-7)
            local q = block[1].rotation
            figures.relative(string.format("%sleans at %g of the limit, rad", name, share),
                2 * math.sqrt(q[2] ^ 2 + q[3] ^ 2), lean(height, share * limit), LEAN)
        end
        figures.equal(name .. "stands just below the limit",
            stands(model, block, height, (1 - FINE) * limit, direction, 1e-6), true)
        figures.equal(name .. "stands just above the limit",
            stands(model, block, height, (1 + FINE) * limit, direction, 1e-6), false)
    end
end
figures.finish()
