-- An arch near the thickness at which it falls rests on hinges: contacts there go by slopes of their energy, and go to rest.
local check = require "check"
local talus = require "talus"

local GRAVITY, DENSITY, FRICTION = 10, 2000, 60
local RADIUS, DEPTH, GROUND = 1, 0.2, 0.1 -- of the mean line; across; of the springers
local VOUSSOIRS, LIMIT = 15, 0.10606806755065919 -- least thickness over RADIUS, by limit analysis

local function build(voussoirs, thickness, stiffness)
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    local inner, outer = RADIUS - thickness / 2, RADIUS + thickness / 2
    for k = 1, voussoirs do
        local vertices = {}
        for _, angle in ipairs { math.pi * (k - 1) / voussoirs, math.pi * k / voussoirs } do
            for _, radius in ipairs { inner, outer } do
                for _, y in ipairs { 0, DEPTH } do
                    vertices[#vertices + 1] = { radius * math.cos(angle), y,
                        radius * math.sin(angle) }
                end
            end
        end
        model:generate("polyhedron", { vertices = vertices, density = DENSITY, group = "arch" })
    end
    for _, side in ipairs { { inner, outer }, { -outer, -inner } } do
        model:generate("box", { min = { side[1], 0, -GROUND }, max = { side[2], DEPTH, 0 },
            density = DENSITY, group = "springer" })
    end
    model:blocks { group = "springer" }:fix()
    model:joint("*", "coulomb", { kn = stiffness, ks = stiffness, friction = FRICTION })
    model:damping "local"
    model:timestep { rule = "body", fraction = 0.5 }
    return model, model:blocks { group = "arch" }
end

for _, share in ipairs { 1.155, 1.157 } do
    local model = build(VOUSSOIRS, share * LIMIT * RADIUS, 1.25e5 * DENSITY * GRAVITY)
    local run = model:solve { ratio = 1e-6, max_cycles = 100000 }
    check.equal(run.reason, "ratio")
end
