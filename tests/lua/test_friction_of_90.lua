-- An angle of friction of 90 degrees: nothing slips while it is pressed, and walls open as they do with another angle.
local check = require "check"
local shapes = require "shapes"
local talus = require "talus"

local KN = 1e9

-- Laws with an angle of friction, and what else they want. What is bonded is so weakly that the bond breaks.
local laws = {
    { "coulomb", {} },
    { "coulomb", { dilation = 10 } },
    { "coulomb_tensile", {} },
    { "coulomb_tensile", { dilation = 5, tension = 10, cohesion = 10 } },
    { "coulomb_tensile", { tension = 1e6, cohesion = 1e6 } },
    { "slip_weakening", { distance = 1e-3 } },
    { "slip_weakening", { distance = 1e-3, residual_friction = 30, form = "exponential" } },
    { "cohesive", { tension = 1, cohesion = 1, energy_tension = 1, energy_shear = 1 } },
}

-- A block on a plane that dips by an angle.
local function on_plane(dip, law)
    local down = { math.sin(math.rad(dip)), 0, -math.cos(math.rad(dip)) }
    local model = talus.model { gravity = { 10 * down[1], 0, 10 * down[3] } }
    model:generate("box", { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = 2500, group = "floor" })
    model:generate("box", { min = { -0.8, -0.6, 0 }, max = { 0.8, 0.6, 0.4 }, density = 2500, group = "block" })
    model:blocks { group = "floor" }:fix()
    local params = { kn = KN, ks = 0.5 * KN, friction = 90 }
    for key, value in pairs(law[2]) do
        params[key] = value
    end
    model:joint("*", law[1], params)
    return model, model:blocks { group = "block" }
end

for number = 1, check.cases(5) do
    local random = shapes.random(number)
    local dip = random(30, 70)
    for k, law in ipairs(laws) do
        for _, way in ipairs { "cycle", "solve", "relax" } do
            local model, block = on_plane(dip, law)
            local name = string.format("%s %d at %.3g degrees, %s", law[1], k, dip, way)
            if way == "relax" then
                check.equal(model:relax().reason, "rest")
            else
                model:damping "local"
                if way == "solve" then
                    check.equal(model:solve { ratio = 1e-6, max_cycles = 20000 }.reason, "ratio")
                else
                    model:cycle(3000)
                end
                check.holds(math.abs(model:energy().balance) < 1e-3, name .. ": balance")
            end
            local u = block[1].displacement
            check.holds(u[1] ^ 2 + u[3] ^ 2 < 1e-8, name .. ": it stays")
            for _, contact in ipairs(model:contacts()) do
                check.holds(contact.state ~= "slipping", name .. ": nothing slips")
            end
            block:load { force = { 0, 0, 1e5 } } -- more than its weight of 1.9e4 N, upward off the plane
            if law[2].tension ~= 1e6 then
                model:damping "none"
                model:cycle(2000)
                check.holds(block[1].displacement[3] > 1e-3, name .. ": it opens")
            else
                model:damping "local"
                model:cycle(2000)
                check.holds(math.abs(block[1].displacement[3]) < 1e-3, name .. ": the bond holds, sheared and pulled")
            end
        end
    end
end

-- Another angle is refused as before, and dilation, which would open without end, at 90.
local model = talus.model {}
check.raises(function() model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 90.1 }) end, "friction = 90.1 deg is outside [0, 90]")
check.raises(function() model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 90, dilation = 90 }) end,
    "dilation = 90 deg is outside [0, 90)")
