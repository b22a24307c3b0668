-- Outer faces of the model: by side, plane, box and direction; holding them, loading them.
local talus = require "talus"
local check = require "check"

local function empty(gravity)
    return talus.model { gravity = gravity or { 0, 0, -10 } }
end

-- A 4 x 4 x 4 cube cut into 4 x 1 x 4 bars.
local function bars()
    local model = empty()
    model:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2500 })
    model:generate("jointset", { joint = "A", dip = 0, dip_direction = 0, spacing = 1, number = 3, origin = { 2, 2, 2 } })
    model:generate("jointset", { joint = "B", dip = 90, dip_direction = 90, spacing = 1, number = 3, origin = { 2, 2, 2 } })
    model:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
    return model
end

-- ---------------------------------------------------------------- which faces

do
    local model = bars()
    local out = { xmin = { -1, 0, 0 }, xmax = { 1, 0, 0 }, ymin = { 0, -1, 0 }, ymax = { 0, 1, 0 }, zmin = { 0, 0, -1 }, zmax = { 0, 0, 1 } }
    for side, normal in pairs(out) do
        local found = model:boundary(side)
        check.near(found.area, 16, 1e-12)
        check.equal(#found.blocks, side:sub(1, 1) == "y" and 16 or 4)
        check.equal(#found.faces, #found.blocks)
        check.near(found.force, { 0, 0, 0 }, 0)
        for i, face in ipairs(found.faces) do
            check.near(face.normal, normal, 1e-12)
            check.near(face.block.faces[face.face].normal, face.normal, 1e-12)
            check.equal(face.block, found.blocks[i])
        end
    end
    check.near(model:boundary("zmax").faces[1].centroid[3], 4, 1e-12)
    -- by a plane, along its normal of any length only; the inner planes are no outer faces
    check.near(model:boundary { plane = { normal = { 0, 0, 7 }, at = { 1, 2, 4 } } }.area, 16, 1e-12)
    check.refused(model, function() model:boundary { plane = { normal = { 0, 0, -1 }, at = { 1, 2, 4 } } } end, "no outer face is there")
    check.refused(model, function() model:boundary { plane = { normal = { 1, 0, 0 }, at = { 2, 0, 0 } } } end, "no outer face is there")
    -- in a box: the four faces of the upper end of the first column of bars, and two at its ends
    check.near(model:boundary { box = { min = { 0, 0, 3 }, max = { 1, 4, 4 } } }.area, 4 + 4 + 1 + 1, 1e-12)
    check.near(model:boundary { box = { min = { 0, 0, 3 }, max = { 1, 4, 4 } }, facing = { 0, 0, 1 } }.area, 4, 1e-12)
    check.near(model:boundary { facing = { 1, 0, 0.1 }, within = 30 }.area, 16, 1e-12)
    check.near(model:boundary { facing = { 1, 0, 1 } }.area, 32, 1e-12)
    check.near(model:boundary { facing = { 1, 0, 1 }, within = 180 }.area, 96, 1e-12)
    check.near(model:boundary { side = "xmax", box = { min = { 3, 0, 0 }, max = { 4, 4, 2 } } }.area, 8, 1e-12)
    -- asking changes nothing
    local hash = model:state_hash()
    model:boundary("xmin")
    check.equal(model:state_hash(), hash)
    -- as a condition of blocks
    check.equal(#model:blocks { boundary = "zmin" }, 4)
    check.equal(#model:blocks { boundary = "zmin", inside = { min = { 0, 0, 0 }, max = { 2, 4, 4 } } }, 2)
    check.equal(model:blocks { boundary = "xmax" }[1], model:boundary("xmax").blocks[1])
    check.equal(#model:blocks { boundary = "zmin", group = "none" }, 0)
    check.refused(model, function() model:blocks { boundary = "zmim" } end, "blocks: unknown side 'zmim'; did you mean 'zmin'?")
    -- hidden ones count
    model:blocks {}:hide()
    check.equal(#model:boundary("zmin").blocks, 4)
    check.equal(#model:blocks { boundary = "zmin" }, 0)
    check.equal(#model:blocks { boundary = "zmin", hidden = true }, 4)
end

-- Of a body of several blocks its surface is outer, and no seam.
do
    local model = empty()
    model:generate("profile", { section = { { 0, 0 }, { 3, 0 }, { 3, 1 }, { 2, 1 }, { 2, 3 }, { 1, 3 }, { 1, 1 }, { 0, 1 } },
        to = 2, density = 2000 })
    check.holds(#model:blocks() > 1, "several")
    check.near(model:boundary { facing = { 0, 0, 1 }, within = 180 }.area, 12 * 2 + 2 * 5, 1e-9)
end

-- A cube that stands on a larger one leaves a ring bare; and so does one that is joined to it.
for _, joined in ipairs { false, true } do
    local model = empty()
    model:generate("box", { min = { 0, 0, 0 }, max = { 3, 3, 1 }, density = 2500 })
    model:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500 })
    model:joint("*", "elastic", { kn = 1e9, ks = 1e9 })
    if joined then
        model:blocks {}:join()
    end
    local up = model:boundary { facing = { 0, 0, 1 } }
    check.near(up.area, 9, 1e-12)
    check.near(up.faces[1].area, 8, 1e-12)
    -- centroid of the ring: (9 * 1.5 - 0.5) / 8
    check.near(up.faces[1].centroid, { 13 / 8, 13 / 8, 1 }, 1e-12)
    check.equal(#model:boundary { facing = { 0, 0, -1 } }.faces, 1)
end

-- ---------------------------------------------------------------- holding

do
    local model = bars()
    local held = model:boundary { xmin = "roller", xmax = "roller", zmin = "fixed" }
    check.near(held.zmin.area, 16, 1e-12)
    local fixed = 0
    for _, block in ipairs(model:blocks {}) do
        fixed = fixed + (block.fixed and 1 or 0)
    end
    check.equal(fixed, 4)
    model:damping("local")
    model:solve { ratio = 1e-7 }
    -- the base carries the weight of all that is not held up elsewhere: rollers at the sides carry none
    check.near(held.zmin.reaction[3], 64 * 25000, 64 * 25000 * 1e-5)
    check.near(held.zmin.blocks:reaction(), held.zmin.reaction, 0)
    check.near(model:blocks {}:reaction()[3], held.zmin.reaction[3], 1e-3)
    for _, face in ipairs(held.xmin.faces) do
        check.near(face.block.displacement[1], 0, 0)
    end
    check.holds(math.abs(held.xmax.blocks[4].displacement[3]) > 1e-7, "a roller lets it settle")
    check.holds(not held.xmax.blocks[4].fixed, "held along x only")
end
do
    local model = bars()
    model:boundary { side = "ymin", roller = true, rotation = true }
    check.equal(#model:blocks { fixed = true }, 0)
    model.gravity = { 1, 1, 1 }
    model:cycle(50)
    for _, block in ipairs(model:blocks {}) do
        check.near(block.displacement[2], 0, 0)
        check.near(block.angular_velocity, { 0, 0, 0 }, 0)
        check.holds(block.displacement[1] > 0, "free along x")
    end
end

-- ---------------------------------------------------------------- loading

-- A pressure on a free cube: F = p A, and no moment where it acts in the middle.
do
    local model = empty { 0, 0, 0 }
    model:generate("box", { min = { 10, 0, 0 }, max = { 12, 2, 2 }, density = 1000 })
    local load = model:boundary { side = "xmin", pressure = 3e3 }
    check.near(load.force, { 12e3, 0, 0 }, 1e-9)
    check.near(load.moment, { 0, 12e3, -12e3 }, 1e-8) -- about zero: {10, 1, 1} x F
    model:timestep { dt = 1e-3 }
    model:cycle(100)
    local block = model:blocks {}[1]
    check.near(block.force, { 12e3, 0, 0 }, 1e-9)
    check.near(block.moment, { 0, 0, 0 }, 1e-9)
    check.near(block.displacement[1], 0.5 * 12e3 / 8e3 * model.time ^ 2, 1e-4)
    -- a stress says the same
    check.near(model:boundary { side = "xmin", stress = { xx = -3e3 } }.force, { 12e3, 0, 0 }, 1e-9)
    check.near(model:boundary { side = "xmin", traction = { 1, 2, 3 } }.force, { 4, 8, 12 }, 1e-12)
    check.near(model:boundary { side = "xmin", stress = { xz = 5 } }.force, { 0, 0, -20 }, 1e-12)
    -- what is no number leaves the load that there is
    check.refused(model, function() model:boundary { side = "xmin", traction = { 0, 0, 1e308 } } end,
        "boundary: the load is not finite")
    -- all sides of a body: no force in all
    check.near(model:boundary { facing = { 1, 0, 0 }, within = 180, pressure = 1e5 }.force, { 0, 0, 0 }, 1e-9)
    check.near(block.force, { 12e3, 0, 0 }, 1e-9) -- of the last step
    model:cycle(1)
    check.near(block.force, { 0, 0, 0 }, 1e-9)
end

-- Loads that are no number only together, in force or in moment: nothing is put on.
for _, had in ipairs { { force = { 0, 1e308, 0 } }, { moment = { 0, 0, -1.2e308 } } } do
    local model = empty { 0, 0, 0 }
    model:generate("box", { min = { -1, -1, -1 }, max = { 1, 1, 1 }, density = 1000 })
    model:boundary { side = "xmax", traction = { 0, 1, 0 } }
    model:blocks():load(had)
    check.refused(model, function() model:boundary { side = "xmin", traction = { 0, 2.4e307, 0 }, add = true } end,
        "the load on block 1 is not finite: give smaller numbers")
end

-- A stress that grows with depth, on a tetrahedron and all around it: buoyancy, gamma V upward through the centroid.
do
    local model = empty { 0, 0, 0 }
    model:generate("tetrahedron", { vertices = { { 0, 0, -5 }, { 3, 0, -4 }, { 1, 4, -4.5 }, { 1, 1, -1 } }, density = 1000 })
    local block = model:blocks {}[1]
    local water = { xx = 9810, yy = 9810, zz = 9810 }
    local load = model:boundary { facing = { 0, 0, 1 }, within = 180, gradient = water }
    local lift = 9810 * block.volume
    check.near(load.force, { 0, 0, lift }, 1e-9 * lift)
    local c = block.centroid
    check.near(load.moment, { c[2] * lift, -c[1] * lift, 0 }, 1e-9 * lift)
    model:timestep { dt = 1e-6 }
    model:cycle(1)
    check.near(block.force, { 0, 0, lift }, 1e-9 * lift)
    check.near(block.moment, { 0, 0, 0 }, 1e-9 * lift)
    -- at another level
    local deeper = model:boundary { facing = { 0, 0, 1 }, within = 180, gradient = water, at = { 0, 0, 7 } }
    check.near(deeper.force, { 0, 0, lift }, 1e-8 * lift)
    -- one face: the pressure at its centroid times its area, for it is linear
    local face = model:boundary { facing = { 0, 0, -1 }, within = 60 }.faces[1]
    local one = model:boundary { facing = { 0, 0, -1 }, within = 60, gradient = water }
    local p = -9810 * face.centroid[3]
    check.near(one.force, { -p * face.area * face.normal[1], -p * face.area * face.normal[2], -p * face.area * face.normal[3] }, 1e-8 * p)
end

-- Moment of a triangular pressure on a wall about its foot: gamma h^3 / 6 a metre.
do
    local model = empty { 0, 0, 0 }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 6 }, density = 2400 })
    local load = model:boundary { side = "xmin", gradient = { xx = 9810 }, at = { 0, 0, 6 } }
    check.near(load.force, { 9810 * 36 / 2, 0, 0 }, 1e-6)
    check.near(load.moment[2], 9810 * 216 / 6, 1e-6)
end

-- One call adds up on corner blocks; the next takes the place of the load, or is added to it. The first step tells the load
-- alone: contacts have not been pressed yet.
local function corner_force(...)
    local model = bars()
    model.gravity = { 0, 0, 0 }
    for _, call in ipairs { ... } do
        model:boundary(call)
    end
    model:cycle(1)
    local corner = model:blocks { containing = { 3.5, 2, 3.5 } }[1]
    return corner.force, corner.moment
end
local both = { zmin = "fixed", xmax = { pressure = 1e5 }, zmax = { pressure = 2e5 } }
check.near(corner_force(both), { -4e5, 0, -8e5 }, 1e-6)
check.near(corner_force(both, { side = "zmax", pressure = 1e5, add = true }), { -4e5, 0, -12e5 }, 1e-6)
check.near(corner_force(both, { side = "zmax", pressure = 1e5 }), { 0, 0, -4e5 }, 1e-6)
check.near(corner_force(both, { zmax = { pressure = 1e5 }, xmax = { traction = { 1, 2, 3 } }, add = true }),
    { -4e5 + 4, 8, -12e5 + 12 }, 1e-6)
-- whichever way a load is put together, its moment is the same
local half = { min = { 3, 0, 0 }, max = { 4, 4, 4 } }
local first = { side = "zmax", box = half, gradient = { zz = 1e5, yz = 3e4 } }
local second = { side = "xmax", box = half, stress = { xx = 1e5, xy = 4e4 }, gradient = { xx = 1e4 }, add = true }
local _, one_way = corner_force(first, second)
first.add, second.add = true, false
local _, other_way = corner_force(second, first)
check.holds(math.abs(one_way[3]) > 1e4, "there is a moment")
check.near(one_way, other_way, 1e-6)

-- In situ stress and the same at the sides: nothing moves.
do
    local model = empty { 0, 0, 0 }
    model:generate("box", { min = { 0, 0, 0 }, max = { 3, 3, 3 }, density = 2500 })
    for i, dip in ipairs { { 0, 0 }, { 90, 90 }, { 90, 0 } } do
        model:generate("jointset", { joint = "J" .. i, dip = dip[1], dip_direction = dip[2], spacing = 1, number = 2,
            origin = { 1.5, 1.5, 1.5 } })
    end
    model:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 30 })
    local stress = { xx = -2e6, yy = -3e6, zz = -4e6, xz = 5e5 }
    model:insitu { stress = stress }
    local deed = { stress = stress }
    local all = model:boundary { xmin = deed, xmax = deed, ymin = deed, ymax = deed, zmin = deed, zmax = deed }
    check.near(all.xmin.force, { 18e6, 0, -4.5e6 }, 1e-3)
    model:damping("local")
    model:cycle(200)
    for _, block in ipairs(model:blocks {}) do
        check.near(block.displacement, { 0, 0, 0 }, 1e-9)
    end
end

-- ---------------------------------------------------------------- mistakes

local model = bars()
local function refused(f, part)
    check.refused(model, f, part)
end
refused(function() model:boundary("xmon") end, "unknown side 'xmon'; did you mean 'xmin'?")
refused(function() model:boundary() end, "a side (\"xmin\") or a table is expected, not nil")
refused(function() model:boundary {} end, "say where")
refused(function() model:boundary { fixed = true } end, "say where")
refused(function() model:boundary { side = "left" } end, "unknown side 'left'")
refused(function() model:boundary { xmin = "rolled" } end, "xmin must be \"roller\", \"fixed\", \"free_field\" or a table")
refused(function() model:boundary { xmin = { side = "xmax" } } end, "xmin says where")
refused(function() model:boundary { xmin = "fixed", pressure = 3 } end, "what is to be done goes into their tables")
refused(function() model:boundary { xmim = "fixed" } end, "did you mean 'xmi")
refused(function() model:boundary { side = "xmin", presure = 3 } end, "did you mean 'pressure'?")
refused(function() model:boundary { side = "xmin", pressure = "3" } end, "pressure must be a number")
refused(function() model:boundary { side = "xmin", stress = { xw = 3 } } end, "boundary, stress: unknown parameter 'xw'")
refused(function() model:boundary { side = "xmin", rotation = true } end, "rotation is held with roller")
refused(function() model:boundary { plane = { normal = { 0, 0, 0 }, at = { 0, 0, 0 } } } end, "must not be zero")
refused(function() model:boundary { plane = { normal = { 0, 0, 1 } } } end, "parameter 'at' is missing")
refused(function() model:boundary { box = { min = { 1, 0, 0 }, max = { 0, 1, 1 } } } end, "every component of min")
refused(function() model:boundary { box = { min = { 10, 10, 10 }, max = { 11, 11, 11 } }, fixed = true } end, "no outer face is there")
refused(function() model:boundary { side = "xmin", tolerance = -1 } end, "tolerance")
-- of several sides none is done when one is wrong
refused(function()
    model:boundary { xmin = "fixed", zmax = { box = { min = { 0, 0, 0 }, max = { 1, 1, 1 } } } }
end, "zmax says where")
refused(function() model:boundary { facing = { 0, 0, 1 }, within = 180, roller = true, side = "left" } end, "unknown side")
-- what was joined after it had settled shows no face within
do
    local tower = empty()
    for z = -1, 1 do
        tower:generate("box", { min = { 0, 0, z }, max = { 1, 1, z + 1 }, density = 2500, group = z < 0 and "base" or "tower" })
    end
    tower:joint("*", "coulomb", { kn = 2e7, ks = 2e7, friction = 30 })
    tower:blocks { group = "base" }:fix()
    tower:damping "local"
    tower:solve {}
    check.equal(#tower:boundary { facing = { 0, 0, 1 } }.faces, 1) -- contacts cover the others
    tower:blocks { group = "tower" }:join()
    check.equal(#tower:boundary { facing = { 0, 0, 1 } }.faces, 1)
    check.equal(#tower:boundary { facing = { 0, 0, -1 } }.faces, 1)
    check.equal(#tower:boundary { facing = { 0, 0, 1 }, within = 180 }.faces, 14)
end
do
    local tilted = empty()
    tilted:generate("tetrahedron", { vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, density = 2000 })
    check.refused(tilted, function() tilted:boundary("zmax") end, "no outer face is there")
    check.equal(#tilted:blocks { boundary = "zmax" }, 0)
    check.equal(#tilted:blocks { boundary = "zmin" }, 1)
    check.refused(tilted, function() tilted:boundary { facing = { 1, 1, 1 }, roller = true } end,
        "a roller is held along x, y or z, but face")
    check.refused(empty(), function() empty():boundary("xmin") end, "for the model has no blocks")
end
check.raises(function() return model:boundary("xmin").aera end, "did you mean 'area'?")
local seen
model:blocks { containing = { 0.5, 2, 3.5 } }:drive { velocity = function()
    seen = select(2, pcall(model.boundary, model, { side = "xmin", fixed = true }))
    check.near(model:boundary("xmin").area, 16, 1e-6)
    return 0, 0, 0
end }
model:cycle(1)
check.holds(seen and seen:find("hold or load a boundary", 1, true), "refused in a drive's function")

-- A reservoir: water on all faces lifts by the weight of the water displaced, at any level, turned or not, of rigid and deformable blocks.
local function cube(turn, zones)
    local m = empty()
    local corners, c, s = {}, math.cos(turn), math.sin(turn)
    for _, x in ipairs { -1, 1 } do
        for _, y in ipairs { -1.5, 1.5 } do
            for _, z in ipairs { -2, 2 } do
                local up = s * y + c * z
                corners[#corners + 1] = { c * x + s * up, c * y - s * z, c * up - s * x }
            end
        end
    end
    m:generate("polyhedron", { vertices = corners, density = 2000 })
    if zones then
        m:solid("rock", "elastic", { young = 1e9, poisson = 0.2 })
        m:blocks():deformable { zone = 0.9, solid = "rock" }
    end
    return m
end
for _, zones in ipairs { false, true } do
    for _, turn in ipairs { 0, 0.3 } do
        for _, level in ipairs { -0.7, 0.4, 1.1, 5 } do
            local m = cube(turn, zones)
            local load = m:boundary { facing = { 0, 0, 1 }, within = 180, water_level = level, unit_weight = 1e4 }
            local below = 0 -- of the volume: by cutting a block of the same shape
            local twin = cube(turn, false)
            twin:generate("joint", { joint = "L", dip = 0, dip_direction = 0, origin = { 0, 0, level } })
            local centre = { 0, 0, 0 }
            for _, part in ipairs(twin:blocks()) do
                if part.centroid[3] < level then
                    below = below + part.volume
                    centre = part.centroid
                end
            end
            check.near(load.force[3], 1e4 * below, 1e-7)
            check.near(load.force[1], 0, 1e-7)
            check.near(load.force[2], 0, 1e-7)
            check.near(load.moment[1], centre[2] * load.force[3], 1e-6)
            check.near(load.moment[2], -centre[1] * load.force[3], 1e-6)
        end
    end
end
do
    local m = cube(0, false)
    local wall = { facing = { 1, 0, 0 }, water_level = -3 }
    check.refused(m, function() m:boundary(wall) end, "lies below the level -3 m")
    wall.water_level, wall.pressure = 0, 1
    check.refused(m, function() m:boundary(wall) end, "water_level is a load by itself")
    wall.pressure, wall.unit_weight = nil, 0
    check.refused(m, function() m:boundary(wall) end, "unit_weight")
    check.near(m:boundary { facing = { 1, 0, 0 }, water_level = 0 }.force[1], -9810 * 3 * 2, 1e-8)
end

-- A reservoir that is lowered, or taken away, leaves no load on faces that are above it now.
do
    local function tower(level)
        local m = talus.model { gravity = { 0, 0, -10 } }
        for k = 1, 3 do
            m:generate("box", { min = { 0, 0, k - 1 }, max = { 4, 1, k }, density = 2500 })
        end
        m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 40 })
        for _, height in ipairs(level) do
            m:boundary { facing = { -1, 0, 0 }, water_level = height, unit_weight = 1e4 }
        end
        return m
    end
    local low, lowered = tower { 1.5 }, tower { 3, 2.2, 1.5 }
    check.equal(lowered:state_hash(), low:state_hash())
    lowered:boundary { facing = { -1, 0, 0 }, pressure = 0 }
    check.equal(lowered:state_hash(), tower {}:state_hash())
    low:boundary { facing = { -1, 0, 0 }, pressure = 0, add = true }
    check.equal(low:state_hash(), tower { 1.5 }:state_hash())
    -- A load without a force in all, about the middle of the face, is one, too.
    local turned = tower {}
    turned:boundary { facing = { -1, 0, 0 }, box = { min = { 0, 0, 1 }, max = { 0, 1, 2 } }, gradient = { xx = 1e4 },
        at = { 0, 0, 1.5 } }
    check.holds(turned:state_hash() ~= tower {}:state_hash(), "a moment")
    -- Cuts share out what is there now.
    for _, m in ipairs { low, lowered } do
        m:generate("joint", { joint = "J", dip = 0, dip_direction = 0, origin = { 0, 0, 0.5 } })
        m:damping "local"
        m:blocks { where = function(b) return b.centroid[3] < 0.5 end }:fix()
        m:solve { ratio = 1e-6, measure = "local" }
    end
    check.holds(math.abs(low:blocks()[#low:blocks()].displacement[1]) > 1e-8)
    check.near(lowered:blocks()[#lowered:blocks()].displacement[1], 0, 1e-12)
end
