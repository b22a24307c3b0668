-- contact_points = "corners": a block tilts on springs at the corners of its face as rigid statics says, up to some degrees, and
-- goes over to the pressure field without a jump when it falls on.
local talus = require "talus"
local check = require "check"

local GRAVITY, DENSITY = 10, 2000

-- A block b x w x h on an incline of dip psi, degrees, in axes along the incline.
local function incline(kn, psi, b, w, h, friction)
    psi = math.rad(psi)
    local m = talus.model { gravity = { GRAVITY * math.sin(psi), 0, -GRAVITY * math.cos(psi) }, contact_points = "corners" }
    m:generate("box", { { min = { -9 * h, -9 * h, -h }, max = { 9 * h, 9 * h, 0 }, density = DENSITY },
        { min = { -b / 2, -w / 2, 0 }, max = { b / 2, w / 2, h }, density = DENSITY } })
    m:blocks { id = 1 }:fix()
    m:joint("*", "coulomb", { kn = kn, ks = kn, friction = friction })
    return m, m:blocks { id = 2 }[1]
end

local function tilt_of(block)
    local q = block.rotation
    return 2 * math.atan(q[3], q[1])
end

-- Four springs of a quarter of the area: N at e = h/2 tan psi is borne by a tilt of 4 N e / (kn A b^2), tan psi below b/h. 3DEC's
-- stable example (b = h = 10 m, 40 degrees, kn = 1e7 Pa/m) is among them: 0.147 degrees.
for _, case in ipairs { { 1e7, 40, 10, 10, 10 }, { 2e6, 35, 10, 4, 10 }, { 1e6, 20, 1, 1, 1.5 }, { 1e5, 10, 1, 3, 2 } } do
    local kn, psi, b, w, h = table.unpack(case)
    local m, block = incline(kn, psi, b, w, h, 60)
    m:damping "local"
    local full = m.gravity
    for k = 1, 20 do -- in portions, for friction remembers
        m.gravity = { full[1] * k / 20, 0, full[3] * k / 20 }
        m:solve { ratio = 1e-5, max_cycles = 5000 }
    end
    m:solve { ratio = 1e-7, max_cycles = 20000 }
    local stress = DENSITY * GRAVITY * h * math.cos(math.rad(psi))
    local tilt = 2 * stress * h * math.tan(math.rad(psi)) / (kn * b * b)
    check.holds(tilt > math.rad(0.05), "the case tilts beyond what patches of a field stand")
    -- the tilted block's weight moves on by its height times the tilt, and the point of its foot that turns goes back by the closure
    check.near(tilt_of(block) / tilt, 1, 0.01 + 2 * tilt * h / (b * math.tan(math.rad(psi))))
end

-- Toppling through the limits: no energy is made.
for _, kn in ipairs { 1e8, 1e9 } do
    local m, block = incline(kn, 25, 1, 1, 3, 45)
    m:timestep { fraction = 0.2 }
    local worst = 0
    for _ = 1, 140 do
        m:solve { max_time = 0.01, ratio = 1e-12 }
        if tilt_of(block) > math.rad(14) then
            break
        end
        worst = math.max(worst, math.abs(m:energy().balance))
    end
    check.holds(tilt_of(block) > math.rad(14), "it topples")
    check.holds(worst < 1e-3, ("kn %g: balance %g"):format(kn, worst))
end
