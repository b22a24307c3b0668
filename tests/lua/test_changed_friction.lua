-- Friction that changes leaves alone what presses: a tower of two blocks that rocks, its foot open in part, goes on as if nothing had
-- been set, as long as nothing slips.
local check = require "check"
local every_law = require "every_law"
local shapes = require "shapes"
local talus = require "talus"

local KN, PRESSURE = 1e8, 1e5
-- m/m, of the way that the block makes: the time step is found anew; shear springs that yield from the start are softer by friction.
local SAME, YIELDS = 1e-6, 1e-3
local PARAMETER = { barton_bandis = "phi_r", continuously_yielding = "phi_i", glue = "angle", rate_state = "mu0" }

local function tower(joint)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = 2500, group = "floor" })
    model:blocks { group = "floor" }:fix()
    model:generate("box", { min = { -0.5, -0.5, 0 }, max = { 0.5, 0.5, 3 }, density = 2500, group = "tower" })
    model:joint("*", joint.law, joint.params)
    model:timestep { fraction = 0.1 }
    local block = model:blocks { group = "tower" }
    block:set { angular_velocity = { 0.02, 0.05, 0 }, velocity = { 0.05 * 1.5, -0.02 * 1.5, 0 } }
    model:cycle(150)
    return model, block
end

-- Where the block is at some looks after `change`.
local function places(joint, change)
    local model, block = tower(joint)
    if change then
        model:joint("*", change)
    end
    local list = {}
    for look = 1, 10 do
        model:cycle(50)
        list[look] = block[1].displacement
    end
    return list
end

for _, joint in ipairs(every_law(KN, PRESSURE)) do
    local name = PARAMETER[joint.law] or "friction"
    if joint.tension == 0 then -- a part of a bond slips as it breaks
        local plain, other = places(joint), places(joint, { [name] = 1.02 * joint.params[name] })
        local off, way = 0, 0
        for look = 1, #plain do
            off = math.max(off, shapes.length(shapes.sum(plain[look], -1, other[look])))
            way = math.max(way, shapes.length(plain[look]))
        end
        check.holds(off <= (joint.yields and YIELDS or SAME) * way, string.format("%s: off by %g of %g m", joint.name, off, way))
    end
end
