-- Two blocks with a loaded joint turn together as one rigid piece: the forces of the joint turn
-- with them.
package.path = "tests/verify/?.lua;tests/lua/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"

local FORCE = 1e-9             -- relative; the paper's own formula grows by 1.2e-3 in STEPS steps
local ANGLE, STEPS = math.pi / 2, 1000
local STIFFNESS = 1e8
local CLOSURE, SHEAR = 1e-4, 5e-5 -- m; the shear stays well below the limit
local DT = 1e-3                -- s; everything is driven, so any step will do

local function cross(a, b)
    return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

-- v turned about a unit axis.
local function turned(v, axis, angle)
    local c, s = math.cos(angle), math.sin(angle)
    local across = cross(axis, v)
    local along = (axis[1] * v[1] + axis[2] * v[2] + axis[3] * v[3]) * (1 - c)
    return { c * v[1] + s * across[1] + along * axis[1], c * v[2] + s * across[2] + along * axis[2],
        c * v[3] + s * across[3] + along * axis[3] }
end

-- Presses and shears a joint with normal z, along x.
local function build()
    local model, lower, upper = require "cube_on_block"({ -2, -2, -2 }, { 2, 2, 0 })
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = 45 })
    model:timestep { dt = DT }
    upper:drive { velocity = { 0, 0, -CLOSURE / (100 * DT) } }
    model:cycle(100)
    upper:drive { velocity = { SHEAR / (100 * DT), 0, 0 } }
    model:cycle(100)
    upper:drive { velocity = { 0, 0, 0 } }
    model:cycle(1)
    return model, lower, upper
end

-- Drives a block about the axis through `centre`. A step goes along the chord of its arc, which is
-- shorter than the tangent.
local function drive(block, axis, centre, begin)
    local rate = ANGLE / (STEPS * DT)
    local half = 0.5 * rate * DT
    local chord = math.sin(half) / half
    local start = block[1].centroid
    local arm = { start[1] - centre[1], start[2] - centre[2], start[3] - centre[3] }
    block:drive {
        angular_velocity = { rate * axis[1], rate * axis[2], rate * axis[3] },
        velocity = function(t)
            local v = cross(axis, turned(arm, axis, rate * (t - begin)))
            return { rate * chord * v[1], rate * chord * v[2], rate * chord * v[3] }
        end,
    }
end

local function check(name, axis, series)
    local model, lower, upper = build()
    local contact = model:contacts { between = { lower, upper } }[1]
    local normal, shear, area = contact.normal_force, contact.shear_force, contact.area
    local size = math.sqrt(shear[1] ^ 2 + shear[2] ^ 2 + shear[3] ^ 2)
    figures.relative(name .. "normal force at first, N", normal, STIFFNESS * CLOSURE * area, FORCE)
    figures.relative(name .. "shear force at first, N", size, STIFFNESS * SHEAR * area, FORCE)
    drive(lower, axis, { 3, -2, 5 }, model.time)
    drive(upper, axis, { 3, -2, 5 }, model.time)
    local angles, error = {}, {}
    for i = 1, 20 do
        model:cycle(STEPS // 20)
        local now = contact.shear_force
        -- Forces are those of the places at the last step's beginning.
        local angle = ANGLE * (i / 20 - 1 / STEPS)
        local expected, off = turned(shear, axis, angle), 0
        for k = 1, 3 do
            off = math.max(off, math.abs(now[k] - expected[k]))
        end
        angles[i], error[i] = math.deg(angle), math.max(off / size, 1e-17)
    end
    model:cycle(1)
    local now, expected = contact.shear_force, turned(shear, axis, ANGLE)
    for k = 1, 3 do
        figures.near(string.format("%sshear force %d, N", name, k), now[k], expected[k],
            FORCE * size)
    end
    figures.relative(name .. "size of the shear force, N",
        math.sqrt(now[1] ^ 2 + now[2] ^ 2 + now[3] ^ 2), size, FORCE)
    figures.relative(name .. "normal force, N", contact.normal_force, normal, FORCE)
    series[#series + 1] = { name = name:sub(1, -3), x = angles, y = error, style = "points" }
end

figures.case("S.eq5", "Two blocks with a loaded joint are driven round together by 90 degrees in "
    .. "1000 steps: the shear force keeps its size and turns with them, whether it lies in the "
    .. "plane of the turn, along its axis, or turns within the joint.",
    "rigid rotation; Hart, Cundall and Lemos (1988), "
        .. "equation (5), is the first order of it")
local series = {}
check("in the plane of the turn: ", { 0, 1, 0 }, series)
check("along the axis: ", { 1, 0, 0 }, series)
check("about the normal: ", { 0, 0, 1 }, series)
check("about a slanting axis: ", { 2 / 3, -1 / 3, 2 / 3 }, series)
figures.plot { title = "S.eq5: shear force off the turned one", x = "angle, degrees",
    y = "error / shear force", log_y = true, series = series }
figures.finish()
