-- Free fields at sides of rigid blocks: bits that do not depend on threads, saves, copies and pieces of a run, axes and order,
-- a step that is undone, what takes their place, damping that changes, and what is refused.
local talus = require "talus"
local check = require "check"

local at = {}
for k = 0, 40 do
    at[k + 1] = 1e-3 * math.sin(math.pi * k / 40) ^ 2
end
local wave = talus.record { at = at, dt = 5e-4, quantity = "velocity" }

-- 4 x 1 x 5 blocks of 1 m along `axis` (1 or 2) and z, which do not turn.
local function site(o)
    local axis, list = o.axis or 1, {}
    local model = talus.model { gravity = { 0, 0, o.gravity or 0 }, threads = o.threads or 1 }
    for k = 0, 4 do
        for j = 0, 3 do
            local low, high = { 0, 0, k }, { 1, 1, k + 1 }
            low[axis], high[axis] = j, j + 1
            table.insert(list, o.reverse and 1 or #list + 1, { min = low, max = high, density = 2500 })
        end
    end
    model:generate("box", list)
    model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
    model:blocks():fix { x = axis == 2, y = axis == 1, rotation = true }
    return model
end

local function sides(model, axis, side)
    axis = axis or 1
    side = side or "free_field"
    model:boundary { zmin = { quiet = true, input = { axis == 1 and wave or 0, axis == 2 and wave or 0, wave } },
        xmin = axis == 1 and side or nil, xmax = axis == 1 and side or nil, ymin = axis == 2 and side or nil,
        ymax = axis == 2 and side or nil }
    return model
end

-- Velocities by places, along the axis and z.
local function speeds(model, axis)
    local out = {}
    for _, place in ipairs { { 0.5, 0.5 }, { 1.5, 2.5 }, { 3.5, 4.5 } } do
        local c = axis == 1 and { place[1], 0.5, place[2] } or { 0.5, place[1], place[2] }
        local v = model:blocks { containing = c }[1].velocity
        out[#out + 1], out[#out + 2] = v[axis], v[3]
    end
    return out
end

local model = sides(site {})
model:cycle(60)
check.equal(#model:elements { kind = "free_field" }, 2)
check.equal(#model:elements { kind = "free_field" }[1].nodes, 5 + 15)
check.near(model:energy().balance, 0, 1e-9)
local first = speeds(model, 1)
check.holds(first[6] > 1e-4, "the wave comes to the top")
for _, o in ipairs { { axis = 2 }, { reverse = true }, { threads = 2 } } do
    local other = sides(site(o), o.axis)
    other:cycle(60)
    for i, v in ipairs(speeds(other, o.axis or 1)) do
        check.near(v, first[i], 1e-9 * 1e-3)
    end
    if o.threads then
        check.equal(other:state_hash(), model:state_hash())
    end
end

-- A run goes on to the bit after a save, in a copy and in pieces.
model = sides(site {})
model:cycle(25)
local file = os.tmpname()
model:save(file)
local back, copy = talus.restore(file), model:copy()
os.remove(file)
local whole = sides(site {})
whole:cycle(60)
for _, m in ipairs { model, back, copy } do
    m:cycle(35)
    check.equal(m:state_hash(), whole:state_hash())
end

-- A step that fails leaves levels and dashpots as they were.
model = sides(site {})
model:cycle(25)
local before = model:state_hash()
model:blocks { containing = { 1.5, 0.5, 2.5 } }:set { velocity = { 1e7, 0, 0 } }
before = model:state_hash()
check.raises(function() model:cycle(1) end, "cycle 26")
check.equal(model:state_hash(), before)

-- Sides that were held go on at rest, and what holds a level along the side stays.
model = site { gravity = -10 }
model:damping "local"
model:boundary { zmin = "roller", xmin = "roller", xmax = "roller" }
model:boundary { side = "xmin", traction = { 0, 0, -1e4 } }
model:solve { ratio = 1e-9 }
model:damping "none"
local places = model:blocks():values("displacement", "flat")
model:boundary { zmin = { quiet = true }, xmin = "free_field", xmax = "free_field" }
check.equal(model:blocks { containing = { 0.5, 0.5, 0.5 } }[1].held, 2 + 8)
model:cycle(500)
for i, u in ipairs(model:blocks():values("displacement", "flat")) do
    check.near(u, places[i], 1e-9)
end

-- Levels that are held move with their blocks, in the components that are held.
model = site {}
model:boundary { zmin = "fixed" }
model:boundary { xmin = "free_field" }
model:boundary { zmin = { velocity = { 0.01, 0, 0 } } }
model:cycle(10)
local field = model:elements { kind = "free_field" }[1]
local base = model:blocks { containing = { 0.5, 0.5, 0.5 } }[1].displacement[1]
model:cycle(1)
check.near(field.nodes[1].moved_x, base, 1e-15)
check.holds(field.nodes[2].moved_x > 0, "the level above follows")

-- Later calls take their place; damping goes to the levels.
model = sides(site {})
sides(model, 1, { free_field = true, p_velocity = 2000, s_velocity = 1265, density = 2600 })
check.equal(#model:elements { kind = "free_field" }, 2)
check.near(model:elements { kind = "free_field" }[1].nodes[1].kn, 2600 * 4e6, 1e-3)
model:damping("rayleigh", { ratio = 0.05, from = 2, to = 10 })
local damped = model:copy()
for _, m in ipairs { model, damped } do
    m:cycle(40)
end
check.equal(model:state_hash(), damped:state_hash())
local undamped = sides(site {})
undamped:cycle(40)
check.holds(damped:elements { kind = "free_field" }[1].nodes[2].speed_x <
    undamped:elements { kind = "free_field" }[1].nodes[2].speed_x, "levels are damped")
model:boundary { xmin = { quiet = true }, xmax = { quiet = true } }
check.equal(#model:elements { kind = "free_field" }, 0)

-- ---------------------------------------------------------------- what is refused

model = site {}
local function refused(o, part)
    check.refused(model, function() model:boundary(o) end, part)
end
refused({ xmin = "free_field" }, "a free field needs a base that is driven or held, or zmin = {quiet = true} in the same call")
refused({ zmin = { quiet = true }, zmax = "free_field" }, "all faces of a side that is a free field are vertical")
refused({ zmin = { quiet = true }, xmin = { free_field = true, quiet = true } }, "give it without quiet, fixed and roller")
refused({ zmin = "fixed", xmin = { free_field = true, velocity = { 0, 0, 0 } } }, "give it no velocity")
refused({ zmin = { quiet = true }, xmin = { free_field = true, joint = "J9" } }, "joint 'J9' has no law")
refused({ zmin = { quiet = true }, xmin = { free_field = true, p_velocity = 9 } }, "both p_velocity and s_velocity")
refused({ zmin = { quiet = true }, xmin = { free_field = true, p_velocity = 9, s_velocity = 9.5 } },
    "shear waves of s_velocity = 9.5 m/s are faster than pressure waves of p_velocity = 9 m/s")
refused({ zmin = { quiet = true, p_velocity = 9, s_velocity = 90 }, xmin = "free_field" },
    "shear waves of s_velocity = 90 m/s are faster")
refused({ zmin = { quiet = true }, xmin = "field" }, "xmin must be \"roller\", \"fixed\", \"free_field\" or a table")
refused({ zmin = { quiet = true }, xmin = { free_field = true, input = { wave, 0, 0 } } }, "go with quiet = true")
model:blocks { containing = { 0.5, 0.5, 3.5 } }:fix { x = true, y = true, z = true, rotation = true }
refused({ zmin = { quiet = true }, xmin = "free_field" }, "is held, and the row below it is not")
model:blocks():fix { x = true, y = true, z = true, rotation = true }
refused({ xmin = "free_field" }, "all blocks of the side are held")
model = site {}
model:generate("box", { min = { -1, 0, 0 }, max = { 0, 1, 1.5 }, density = 2500 })
model:generate("box", { min = { -1, 0, 1.5 }, max = { 0, 1, 5 }, density = 2500 })
model:generate("box", { min = { -1, 1, 0 }, max = { 0, 2, 5 }, density = 2500 })
refused({ zmin = { quiet = true }, xmin = "free_field" }, "blocks at a free field lie in level rows")
model = site {} -- rows whose levels differ by 2 cm
model:generate("box", { min = { -1, 0, 0 }, max = { 0, 1, 2 }, density = 2500 })
model:generate("box", { min = { -1, 0, 2 }, max = { 0, 1, 5 }, density = 2500 })
model:generate("box", { min = { -1, 1, 0 }, max = { 0, 2, 2.02 }, density = 2500 })
model:generate("box", { min = { -1, 1, 2.02 }, max = { 0, 2, 5 }, density = 2500 })
refused({ zmin = { quiet = true }, xmin = "free_field" }, "blocks at a free field lie in level rows")
model = talus.model {} -- a side whose ground falls along it
model:generate("box", { min = { 0, 0, 0 }, max = { 3, 2, 3 }, density = 2500 })
model:generate("joint", { joint = "bed", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
model:generate("joint", { joint = "ground", dip = 20, dip_direction = 0, origin = { 1, 1, 2 } })
model:blocks { above = { dip = 20, dip_direction = 0, origin = { 1, 1, 2 } } }:delete()
model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
refused({ zmin = { quiet = true }, xmin = "free_field" }, "corners between z = 1 and 2.36397 m, so its top or its foot slopes")
for _, axis in ipairs { 1, 2 } do -- beds that dip from the side into the model, by so many degrees
    for _, dip in ipairs { 0.04, 0.1, 20 } do
        model = talus.model {}
        model:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2500 })
        model:generate("joint", { joint = "bed", dip = dip, dip_direction = axis == 1 and 90 or 0, origin = { 2, 2, 2 } })
        model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
        local o = { zmin = { quiet = true }, [axis == 1 and "xmin" or "ymax"] = "free_field" }
        if dip < 0.05 then
            model:boundary(o)
        else
            refused(o, ("dips by %g degrees from the side into the model"):format(dip))
        end
    end
end
model = talus.model {} -- ground that falls from the side
model:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2500 })
model:generate("joint", { joint = "bed", dip = 0, dip_direction = 0, origin = { 2, 2, 1 } })
model:generate("joint", { joint = "ground", dip = 20, dip_direction = 90, origin = { 2, 2, 3 } })
model:blocks { above = { dip = 20, dip_direction = 90, origin = { 2, 2, 3 } } }:delete()
model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
model:boundary { zmin = { quiet = true }, xmin = "free_field", xmax = "free_field" }
model = talus.model {} -- a side that leans by 0.1 degrees
model:generate("polyhedron", { density = 2500, vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
    { 1.7e-3, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 1.7e-3, 1, 1 } } })
model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
refused({ zmin = { quiet = true }, xmin = { free_field = true, tolerance = 0.01 } }, "are vertical and look one way")
model = site {}
model:blocks { containing = { 0.5, 0.5, 4.5 } }:fix { y = true }
model:generate("box", { min = { 0, 1, 4 }, max = { 1, 2, 5 }, density = 2500 })
refused({ zmin = { quiet = true }, xmin = "free_field" }, "held in different components")
model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
model:joint("*", "elastic", { kn = 1e10, ks = 4e9 })
model:solid("rock", "elastic", { young = 1e9, poisson = 0.2 })
model:blocks():deformable { zone = 1, solid = "rock" }
refused({ zmin = { quiet = true }, xmin = "free_field" }, "free fields are at sides of rigid blocks")
