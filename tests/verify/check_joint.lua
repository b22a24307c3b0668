-- check_joint.lua - what a cube's face presses on a larger face with, flat on it: the pressure field of their common
-- volume, and the linear springs of their patch while the overlap is small.
--
-- The common volume K is a slab of side L and thickness o. The field stores 2 kn times the integral over K of the
-- distance from its border, which is that over t of the volume deeper than t:
--
--     G = integral from 0 to o/2 of (L - 2t)^2 (o - 2t) dt = L^2 o^2 / 4 - L o^3 / 6 + o^4 / 24
--
-- Without its last two terms, of the slab's border, it is the patch's, of the force kn L^2 o. Between them the share of the
-- border grows as a smoothstep, while o is SHALLOW to DEEP of the root of the area.
local joint = {}

local SHALLOW, DEEP = 4e-3, 1e-2

-- Energy and force at an overlap.
function joint.press(kn, side, overlap)
    local border = -side * overlap ^ 3 / 6 + overlap ^ 4 / 24
    local by_overlap = -side * overlap ^ 2 / 2 + overlap ^ 3 / 6
    local t = math.min(1, math.max(0, (overlap / side - SHALLOW) / (DEEP - SHALLOW)))
    local share, slope = t * t * (3 - 2 * t), 6 * t * (1 - t) / (DEEP - SHALLOW) / side
    return 2 * kn * (side ^ 2 * overlap ^ 2 / 4 + share * border),
        2 * kn * (side ^ 2 * overlap / 2 + share * by_overlap + slope * border)
end

-- The overlap of least value of a function that grows, by halving.
local function overlap_of(side, value)
    local low, high = 0, side / 10
    for _ = 1, 100 do
        local middle = 0.5 * (low + high)
        if value(middle) < 0 then
            low = middle
        else
            high = middle
        end
    end
    return 0.5 * (low + high)
end

-- The overlap under a force.
function joint.closure(kn, side, force)
    return overlap_of(side, function(overlap)
        return select(2, joint.press(kn, side, overlap)) - force
    end)
end

-- A cube of mass m that meets a floor at a speed under gravity: greatest overlap and force, and how long it stays.
function joint.impact(kn, side, mass, gravity, speed)
    local function left(overlap) -- of its energy, negated
        return joint.press(kn, side, overlap) - mass * (speed ^ 2 / 2 + gravity * overlap)
    end
    local most = overlap_of(side, left)
    -- With overlap = most sin(a) the speed goes to 0 as cos(a) does: what is integrated stays smooth. Midpoints.
    local PARTS, time = 4000, 0
    for i = 1, PARTS do
        local a = (i - 0.5) * math.pi / 2 / PARTS
        time = time + most * math.cos(a) / math.sqrt(-2 / mass * left(most * math.sin(a)))
    end
    return most, select(2, joint.press(kn, side, most)), 2 * time * math.pi / 2 / PARTS
end

return joint
