-- A block standing on its face resists tilting, and topples where its weight leaves the base: at
-- tan(alpha) = b / h. The joint yields by delta under the weight; the contact points then give a
-- limit lower by 12 (delta / b) (h / b + b / h) of it, 5e-4 at the most here.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"

local WIDTH, DENSITY, GRAVITY = 1, 2000, 10
local OVERLAP = 1e-5       -- mean overlap over the width of the block
local TOLERANCE = 1e-3     -- relative, in tan(alpha)
local FINE = 1e-4          -- relative step of tan(alpha) near the limit
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

-- Tilts gravity towards `direction` and waits: true at rest, false when the block falls.
local function stands(model, block, height, tangent, direction)
    local cosine = 1 / math.sqrt(1 + tangent * tangent)
    local along = GRAVITY * tangent * cosine
    model.gravity = { along * direction[1], along * direction[2], -GRAVITY * cosine }
    block:reset_displacement()
    local run = model:solve { ratio = 1e-7, every = 50, stop = function()
        local u = block[1].displacement
        return math.abs(u[1]) + math.abs(u[2]) > FALLEN * height
    end }
    assert(run.reason == "ratio" or run.reason == "stop", "neither at rest nor falling")
    return run.reason == "ratio"
end

-- tan(alpha) half-way between the last tilt that stood and the first that fell, over b / h.
local function limit(height, direction)
    local model, block = build(height)
    figures.relative(string.format("h = %g: mean overlap", height), -block[1].displacement[3],
        OVERLAP,
        1e-6)
    local share, step = 0, 0.1
    while true do
        local next = share + step
        if next > 0.85 then
            step = 0.01
        end
        if next > 0.98 then
            step = FINE
        end
        if not stands(model, block, height, next * WIDTH / height, direction) then
            return share + (next - share) / 2
        end
        share = next
        assert(share < 1.1, "the block does not topple")
    end
end

for _, height in ipairs { 1, 2, 4 } do
    for _, direction in ipairs { { 1, 0 }, { 0, -1 } } do
        local name = string.format("h / b = %g towards {%g, %g}: tan(alpha) h / b", height,
            direction[1],
            direction[2])
        figures.relative(name, limit(height, direction), 1, TOLERANCE)
    end
end
figures.finish()
