-- Steady failure is told by how far a block has gone, whatever the time step, the damping and the scale; and what settles,
-- swings or is poured does not fail.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local DENSITY, K, DIP = 2000, 1e8, math.rad(35)
-- Shares of a block's size, the cube root of its volume: it has gone 0.05 and some steps when it is told.
local EARLIEST, SOON = 0.04, 0.08

-- A slab of side `size` on a plane; friction holds it with a factor of safety.
local function slab(options)
    local size, gravity = options.size or 1, options.gravity or 10
    local model = talus.model { gravity = { gravity * math.sin(DIP), 0, -gravity * math.cos(DIP) } }
    model:generate("box", { min = { -5 * size, -5 * size, -size }, max = { 50 * size, 5 * size, 0 },
        density = DENSITY, group = "base" })
    model:generate("box", { min = { 0, 0, 0 }, max = { size, size, 0.5 * size }, density = DENSITY,
        group = "slab" })
    model:blocks { group = "base" }:fix()
    local k = options.k or K
    if options.parts then
        model:blocks { group = "base" }:hide()
        for i, share in ipairs(options.parts) do
            model:generate("joint", { joint = "part" .. i, dip = 90 - 20 * i, dip_direction = 110 * i,
                origin = { share * size, share * size, 0.5 * share * size } })
        end
        model:blocks { group = "slab" }:join()
        model:blocks { hidden = "any" }:show()
    end
    model:joint("*", "coulomb", { kn = k, ks = k,
        friction = math.deg(math.atan((options.fs or 0.83) * math.tan(DIP))) })
    model:damping(options.damping or "local", options.alpha and { alpha = options.alpha } or nil)
    model:timestep { rule = options.rule, fraction = options.fraction or 0.2 }
    model:mass_scaling(options.scaled or false)
    return model, model:blocks { group = "slab" }[1]
end

-- How far it has gone, relative to its size, when it is told.
local function told(options)
    local model, block = slab(options)
    local result = model:solve { stop_at_failure = true, max_cycles = 300000 }
    check.equal(result.reason, "failure")
    check.equal(result.failing, block)
    local gone = block.displacement[1] / block.volume ^ (1 / 3)
    check.holds(gone > EARLIEST and gone < (options.soon or SOON), "told after a small share of its size")
    return gone, model.time
end

local gone, time = told {}
for _, options in ipairs { { fraction = 0.02 }, { scaled = true }, { rule = "body", fraction = 0.2 } } do
    local again, then_ = told(options)
    check.near(again, gone, 0.01)
    check.near(then_, time, 0.05 * time)
end
for _, options in ipairs(check.some { { k = 1e7 }, { k = 1e10 }, { size = 1e-3, k = 1e11 }, { size = 100, k = 1e7 },
    { gravity = 0.1, k = 1e6 }, { fs = 0 }, { fs = 0.99 }, { damping = "combined" },
    { damping = "viscous", alpha = 1 }, { damping = "viscous", alpha = 30 } }) do
    told(options)
end
-- Stopped with its own vibration again and again, it comes by less speed in each leg.
told { damping = "kinetic", soon = 0.4 }

-- Slabs that hold, even when they slip a little as the weight comes on; also on joints so soft that they settle by more
-- than that share.
for _, fs in ipairs(check.some { 1.01, 1.03, 1.1 }) do
    for _, k in ipairs(check.some { 1e6, 1e7, K }) do
        for _, damping in ipairs { { "local" }, { "combined" }, { "viscous", 100 }, { "kinetic" } } do
            local model = slab { fs = fs, k = k, damping = damping[1], alpha = damping[2] }
            local result = model:solve { stop_at_failure = true, max_cycles = 20000 }
            check.equal(result.reason, "ratio")
            check.equal(result.failing, nil)
        end
    end
end

-- A column of forty settles at its top by 1.7 blocks on joints so soft, and holds. Its lowest joint closes by 9 % of the side;
-- at kn = 1e6 no overlap would carry it, for what two cubes have in common presses with kn L^3 / 3 at most.
-- It is guided, for it would buckle: by 7.84 kn L^5 / 12 H^2 under 0.005 of its weight.
local function column(k, damping)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, -1 }, max = { 1, 1, 0 }, density = DENSITY, group = "base" })
    for z = 0, 39 do
        model:generate("box", { min = { 0, 0, z }, max = { 1, 1, z + 1 }, density = DENSITY, group = "column" })
    end
    model:blocks { group = "base" }:fix()
    model:blocks { group = "column" }:fix { x = true, y = true, rotation = true }
    model:joint("*", "coulomb", { kn = k, ks = k, friction = 30 })
    model:damping(damping)
    model:timestep { rule = "body", fraction = 0.5 }
    return model
end
for _, k in ipairs(check.some { 1e7, 1e8, 1e9 }) do
    for _, damping in ipairs(check.some { "local", "adaptive", "kinetic" }) do
        local result = column(k, damping):solve { stop_at_failure = true, max_cycles = 3000 }
        check.equal(result.failing, nil)
    end
end

-- A block that is slender and leans rocks, and comes to rest.
local function leaning(angle, damping)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -9, -5, -1 }, max = { 9, 5, 0 }, density = DENSITY, group = "base" })
    local c, s, vertices = math.cos(angle), math.sin(angle), {}
    for _, x in ipairs { 0, 1 } do
        for _, y in ipairs { 0, 1 } do
            for _, z in ipairs { 0, 2 } do
                vertices[#vertices + 1] = { x * c + z * s, y, -x * s + z * c + s }
            end
        end
    end
    model:generate("polyhedron", { vertices = vertices, density = DENSITY })
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 45 })
    model:damping(damping)
    model:timestep { rule = "body", fraction = 0.5 }
    return model
end
for _, damping in ipairs { "local", "adaptive", "kinetic" } do
    check.equal(leaning(0.04, damping):solve { stop_at_failure = true, max_cycles = 20000 }.reason, "ratio")
end
check.equal(leaning(0.04, "none"):solve { stop_at_failure = true, max_cycles = 5000 }.failing, nil)

-- A block that drops out of a roof is told at once; one that falls onto a floor has not failed.
local function under_roof(z)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { -3, -3, 1 }, max = { 3, 3, 2 }, density = DENSITY, group = "held" })
    model:generate("box", { min = { -3, -3, -3 }, max = { 3, 3, -2 }, density = DENSITY, group = "held" })
    model:generate("box", { min = { 0, 0, z }, max = { 1, 1, z + 1 }, density = DENSITY, group = "key" })
    model:blocks { group = "held" }:fix()
    model:joint("*", "coulomb", { kn = K, ks = K, friction = 30 })
    model:damping "local"
    return model, model:blocks { group = "key" }[1]
end
local model, key = under_roof(0)
local result = model:solve { stop_at_failure = true, max_cycles = 20000 }
check.equal(result.failing, key)
check.holds(-key.displacement[3] < SOON, "told after a small share of its size")
check.equal(under_roof(-0.5):solve { stop_at_failure = true, max_cycles = 100000 }.reason, "ratio")

-- Hulls that are poured bounce off each other and tumble on, but none of them fails.
local APART, RADIUS, LAYERS, CORNERS = 1.2, 0.45, 3, 14 -- m, m
math.randomseed(3)
local function corner(centre)
    while true do
        local x, y, z = 2 * math.random() - 1, 2 * math.random() - 1, 2 * math.random() - 1
        local r = math.sqrt(x * x + y * y + z * z)
        if r > 0.1 and r < 1 then
            local by = RADIUS / r
            return { centre[1] + by * x, centre[2] + by * y, centre[3] + by * z }
        end
    end
end
model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { -20, -20, -1 }, max = { 20, 20, 0 }, density = DENSITY, group = "floor" })
for i = 1, LAYERS do
    for j = 1, LAYERS do
        for k = 1, LAYERS do
            local vertices = {}
            for n = 1, CORNERS do
                vertices[n] = corner { APART * i, APART * j, APART * (k - 0.4) }
            end
            model:generate("polyhedron", { vertices = vertices, density = DENSITY })
        end
    end
end
model:blocks { group = "floor" }:fix()
model:joint("*", "coulomb", { kn = K, ks = K / 2, friction = 35 })
model:contact_area { fraction = 0.1 }
model:damping "combined"
model:timestep { dt = 5e-4 }
result = model:solve { stop_at_failure = true, max_cycles = check.cases(4500) }
check.equal(result.failing, nil)

-- A block that is carried along feels no force.
model, key = slab { fs = 2 }
model:solve()
model:blocks { group = "base" }:drive { velocity = { 1, 0, 0 } }
model:blocks { group = "slab" }:set { velocity = { 1, 0, 0 } }
result = model:solve { stop_at_failure = true, max_time = 1 }
check.equal(result.reason, "time")
check.holds(key.displacement[1] > 0.9, "it has gone far")

-- A block that flies to and fro between two walls does not slow down, but turns back.
model = talus.model { gravity = { 0, 0, 0 } }
for _, x in ipairs { -1, 1.03 } do
    model:generate("box", { min = { x, -1, -1 }, max = { x + 1, 2, 2 }, density = DENSITY, group = "wall" })
end
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY, group = "ball" })
model:blocks { group = "wall" }:fix()
model:blocks { group = "ball" }:set { velocity = { 0.1, 0, 0 } }
model:joint("*", "coulomb", { kn = K, ks = K, friction = 0 })
result = model:solve { stop_at_failure = true, max_time = 3 }
check.equal(result.reason, "time")

-- A block that lands on a slope and slides off is told, after a whole size of its own.
model = talus.model { gravity = { 10 * math.sin(DIP), 0, -10 * math.cos(DIP) } }
model:generate("box", { min = { -5, -5, -1 }, max = { 50, 5, 0 }, density = DENSITY, group = "base" })
model:generate("box", { min = { 0, 0, 0.05 }, max = { 1, 1, 0.55 }, density = DENSITY, group = "slab" })
model:blocks { group = "base" }:fix()
model:joint("*", "coulomb", { kn = K, ks = K, friction = 15 })
model:damping "local"
result = model:solve { stop_at_failure = true, max_cycles = 20000 }
check.equal(result.reason, "failure")
local size = result.failing.volume ^ (1 / 3)
check.holds(result.failing.displacement[1] > size and result.failing.displacement[1] < 2 * size, "after a size")

-- What a body is made of says nothing of how far it has gone: one with a chip at its corner, with two, in halves.
for _, parts in ipairs { { 0.03 }, { 0.97, 0.03 }, { 0.5 }, { 0.5, 0.2, 0.8 } } do
    local apart, slab_of_parts = slab { parts = parts }
    local volume = 0.5
    result = apart:solve { stop_at_failure = true, max_cycles = 300000 }
    check.equal(result.reason, "failure")
    check.equal(result.failing.group, "slab")
    check.near(slab_of_parts.displacement[1] / volume ^ (1 / 3), gone, 0.03 * gone)
end
local function mast(first)
    local standing = talus.model { gravity = { 0, 0, -9.81 } }
    standing:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = 2400, group = "floor" })
    local parts = { { min = { -0.1, -0.5, 0 }, max = { 0.1, 0.5, 6 } }, { min = { 0, -0.5, 6 }, max = { 0.2, 0.5, 6.5 } } }
    table.insert(parts, first, { min = { -0.01, -0.52, 3 }, max = { 0.01, -0.5, 3.02 } })
    for _, part in ipairs(parts) do
        part.density, part.group = 2400, "mast"
    end
    standing:generate("box", parts)
    standing:blocks { group = "mast" }:join()
    standing:blocks { group = "floor" }:fix()
    standing:joint("*", "coulomb", { kn = 3e8, ks = 3e8, friction = 35 })
    standing:damping "local"
    return standing:solve { ratio = 1e-5, stop_at_failure = true, max_cycles = 20000 }
end
for first = 1, 3 do
    check.equal(mast(first).reason, mast(1).reason)
end
