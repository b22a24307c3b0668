-- The paper's law of rotation, with one moment of inertia: decay under viscous damping and the
-- attitude of an undamped spin.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local case = require("reference_motion")["D.spin.spherical"]

local RATE = 1e-12  -- relative
local SHAPE = 1e-12 -- of the size of the block

local BOX = { 1, 2, 3 } -- under the exact law it would tumble

local function spin_up(damped)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model.rotation = "paper"
    model:generate("box", { min = { 0, 0, 0 }, max = BOX, density = 2000 })
    if damped then
        model:damping("viscous", { alpha = case.alpha })
    end
    model:timestep { dt = case.dt }
    -- Velocities live half-way between steps: set after the first step, w0 is that of t - dt / 2,
    -- and each step that follows kicks over a whole dt.
    model:cycle(1)
    model:blocks():set { angular_velocity = case.w0 }
    return model, model:blocks()[1]
end

figures.case("D.spin.spherical", "A box spins by the paper's equation of rotation, with a single "
    .. "moment of inertia: its angular velocity after 2 s of viscous damping, and without damping "
    .. "its attitude and its shape.", case.source)

local model, block = spin_up(true)
local time, speed = {}, {}
for i = 1, 50 do
    model:cycle(case.steps // 50)
    local w = block.angular_velocity
    time[i], speed[i] = model.time - case.dt, math.sqrt(w[1] ^ 2 + w[2] ^ 2 + w[3] ^ 2)
end
for k = 1, 3 do
    figures.relative("damped: angular velocity " .. k, block.angular_velocity[k], case.w_final[k],
        RATE)
end
figures.plot { title = "D.spin.spherical: decay of the spin", x = "time, s",
    y = "angular velocity, rad/s", series = {
        { name = "obtained", x = time, y = speed },
        { name = "expected at the end", x = { time[#time] },
            y = { math.sqrt(case.w_final[1] ^ 2 + case.w_final[2] ^ 2 + case.w_final[3] ^ 2) },
            style = "points" } } }

model, block = spin_up(false)
local before = block.vertices
model:cycle(case.steps)
local half = case.angle / 2
local q = block.rotation
local sign = q[1] * math.cos(half) < 0 and -1 or 1 -- q and -q are the same attitude
figures.near("undamped: cos of half the angle", sign * q[1], math.cos(half), RATE)
for k = 1, 3 do
    figures.near("undamped: axis " .. k, sign * q[k + 1] / math.sin(half), case.axis[k], 10 * RATE)
    figures.relative("undamped: angular velocity " .. k, block.angular_velocity[k], case.w0[k],
        RATE)
end

-- Distances between all vertices, before and after.
local after, worst = block.vertices, 0
for i = 1, #before do
    for j = 1, i - 1 do
        local function length(v)
            return math.sqrt((v[i][1] - v[j][1]) ^ 2 + (v[i][2] - v[j][2]) ^ 2
                + (v[i][3] - v[j][3]) ^ 2)
        end
        worst = math.max(worst, math.abs(length(after) / length(before) - 1))
    end
end
figures.near("undamped: stretch of the shape", worst, 0, SHAPE)
figures.finish()
