-- masonry_earthquake.lua - a free-standing wall of bricks on ground that shakes across it.
--
--     build/release/talus scripts/examples/masonry_earthquake.lua [FOLDER] [PEAK]
--
-- The wall settles, its small vibrations tell how stiff it is, and the ground follows a record. Joints have no mortar: they
-- slide and open. Bricks touch at their corners, and dashpots at the contacts take up what bricks strike with when they rock
-- (docs/earthquakes.md). Put the record of a site in the place of this one: talus.record{file = "site.AT2"}.
local talus = require "talus"

local wall = {}

wall.brick = { 0.4, 0.25, 0.2 } -- m: length, thickness of the wall, height
wall.courses, wall.bricks = 6, 3
wall.kn = 5e8 -- Pa/m
wall.damping = 0.6              -- of critical, of a brick on its bed

function wall.build()
    local model = talus.model { gravity = { 0, 0, -9.81 }, contact_points = "corners" }
    local l, t, h = table.unpack(wall.brick)
    local length = wall.bricks * l
    local boxes = { { min = { -0.5, -1, -0.5 }, max = { length + 0.5, 1 + t, 0 }, density = 2500, group = "ground" } }
    for course = 0, wall.courses - 1 do
        local from = course % 2 == 0 and 0 or -l / 2
        for brick = 0, wall.bricks do
            local low, high = math.max(0, from + brick * l), math.min(length, from + (brick + 1) * l)
            if high > low then
                boxes[#boxes + 1] = { min = { low, 0, course * h }, max = { high, t, (course + 1) * h }, density = 1800,
                    group = "wall" }
            end
        end
    end
    model:generate("box", boxes)
    model:joint("*", "coulomb", { kn = wall.kn, ks = wall.kn / 2, friction = 35 })
    model:blocks { group = "ground" }:fix()
    return model
end

-- Ten seconds of sines under an envelope, m/s2, in samples of 0.01 s.
function wall.record(peak)
    local at, most = {}, 0
    for k = 0, 1000 do
        local t, sum = 0.01 * k, 0
        for i = 1, 30 do
            sum = sum + math.sin(2 * math.pi * (0.5 + 0.33 * i) * t + 2.4 * i * i) / (1 + i / 8)
        end
        at[k + 1] = sum * math.min(t / 1.5, 1, math.exp(0.6 * (6 - t)))
        most = math.max(most, math.abs(at[k + 1]))
    end
    return talus.record { at = at, dt = 0.01, scale = peak / most, baseline = "parabola" }
end

-- Shakes the wall for a time, s, or until it has fallen: run.fell. Gives times, ways of the ground and of the top against it, and the energy that dashpots took.
function wall.shake(model, record, time)
    local ground = model:blocks { group = "ground" }
    local top = model:blocks { group = "wall" }
    local highest = top[#top]
    local frequency = math.sqrt(wall.kn / (1800 * wall.brick[3])) / (2 * math.pi)
    model:damping("dashpot", { ratio = wall.damping, frequency = frequency })
    model:timestep { fraction = 0.9 }
    model:blocks():reset_displacement()
    local start = model.time
    ground:drive { velocity = { 0, record, 0 } }
    local run = { time = {}, ground = {}, top = {} }
    while model.time - start < time do
        model:cycle(50)
        local n, moved = #run.time + 1, ground[1].displacement[2]
        run.time[n], run.ground[n] = model.time - start, 1000 * moved
        run.top[n] = 1000 * (highest.displacement[2] - moved)
        if math.abs(run.top[n]) > 2000 * wall.brick[2] then -- it has fallen
            run.fell = run.time[n]
            break
        end
    end
    run.damped = model:energy().damping
    return run
end

function wall.main(folder, peak)
    local model, record = wall.build(), wall.record(peak)
    model:relax { ratio = 1e-5 }
    for k, mode in ipairs(model:modes { count = 3 }) do
        print(string.format("vibration %d: %5.1f Hz, %2.0f %% of the mass goes with the ground across the wall", k,
            mode.frequency, 100 * mode.mass[2]))
    end
    local peak, speed = record:peak()
    print(string.format("record: %.2f m/s2, %.2f m/s, Arias intensity %.2f m/s", peak, speed, record:arias()))
    local run = wall.shake(model, record, record.duration)
    local most = 0
    for _, way in ipairs(run.top) do
        most = math.max(most, math.abs(way))
    end
    print(run.fell and string.format("the wall has fallen after %.1f s", run.fell)
        or string.format("the top goes %.1f mm against the ground, and stays at %.1f mm", most, run.top[#run.top]))
    local spectrum = record:spectrum(0.05)
    talus.plot { file = folder .. "/spectrum.svg", title = "Record, 5 % of critical damping",
        series = { { name = "record", x = spectrum.period, y = spectrum.acceleration } },
        x_axis = { name = "period", unit = "s" }, y_axis = { name = "pseudo-acceleration", unit = "m/s2" } }
    talus.plot { file = folder .. "/top.svg", title = "A wall in an earthquake",
        series = { { name = "ground", x = run.time, y = run.ground }, { name = "top against it", x = run.time, y = run.top } },
        x_axis = { name = "time", unit = "s" }, y_axis = { name = "displacement across the wall", unit = "mm" } }
    model:write_html(folder .. "/masonry_earthquake", { title = "A wall after an earthquake" })
    print(string.format("%s/top.svg, spectrum.svg and masonry_earthquake.html show it", folder))
end

-- A test that says require "examples.masonry_earthquake" wants the functions only.
if ... ~= "examples.masonry_earthquake" then
    wall.main(arg and arg[1] or "out/masonry_earthquake", tonumber(arg and arg[2] or 2))
end
return wall
