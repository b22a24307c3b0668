-- Sections that are not convex: the generators "profile" and "prism". One body, whose parts meet without a joint.
local talus = require "talus"
local check = require "check"

local slope = { { 0, 0 }, { 100, 0 }, { 100, 20 }, { 70, 20 }, { 60, 40 }, { 50, 40 }, { 40, 60 }, { 0, 60 } }

-- Area of a polygon by the trapezoids under its edges.
local function area_of(points)
    local sum = 0
    for i, p in ipairs(points) do
        local q = points[i % #points + 1]
        sum = sum + p[1] * q[2] - q[1] * p[2]
    end
    return math.abs(sum) / 2
end

local function make(generator, values)
    local model = talus.model { gravity = { 0, 0, -10 } }
    values.density = values.density or 2500
    local summary = model:generate(generator, values)
    check.equal(summary.after, #model:blocks {})
    return model
end

-- One body of the section's area times its length, with the section's bounds, without contacts between its parts and without
-- joints on its faces.
do
    local model = make("profile", { section = slope, to = 10, group = "hill" })
    local blocks = model:blocks {}
    check.equal(#blocks, 3)
    check.near(blocks:sum("volume"), 10 * area_of(slope), 1e-8)
    local box = blocks:bounds()
    check.near(box.min, { 0, 0, 0 }, 1e-12)
    check.near(box.max, { 100, 10, 60 }, 1e-12)
    for _, block in ipairs(blocks) do
        check.equal(block.body, blocks[1].body)
        check.equal(block.group, "hill")
        for _, face in ipairs(block.faces) do
            check.equal(face.joint, nil)
        end
    end
    check.equal(#model:contacts {}, 0)
end

-- Planes: the letters are those of the two numbers. From a negative place on.
for plane, at in pairs { xz = { 1, 3, 2 }, zx = { 3, 1, 2 }, yz = { 2, 3, 1 }, zy = { 3, 2, 1 }, xy = { 1, 2, 3 }, yx = { 2, 1, 3 } } do
    local model = make("profile", { section = slope, plane = plane, from = -3, to = 2 })
    local box = model:blocks {}:bounds()
    check.near(model:blocks {}:sum("volume"), 5 * area_of(slope), 1e-8)
    local low, high = {}, {}
    low[at[1]], low[at[2]], low[at[3]] = 0, 0, -3
    high[at[1]], high[at[2]], high[at[3]] = 100, 60, 2
    check.near(box.min, low, 1e-12)
    check.near(box.max, high, 1e-12)
end

-- Either way round, with corners on straight lines, as `points`.
local turned, richer = {}, {}
for i, p in ipairs(slope) do
    turned[#slope + 1 - i] = p
    local q = slope[i % #slope + 1]
    richer[#richer + 1] = p
    richer[#richer + 1] = { 0.7 * p[1] + 0.3 * q[1], 0.7 * p[2] + 0.3 * q[2] }
end
check.equal(#make("profile", { section = turned, to = 1 }):blocks {}, 3)
check.equal(#make("profile", { points = richer, to = 1 }):blocks {}, 3)
check.near(make("profile", { section = richer, to = 1 }):blocks {}:sum("volume"), area_of(slope), 1e-9)

-- A convex section is one block; a triangle, too.
check.equal(#make("profile", { section = { { 0, 0 }, { 1, 0 }, { 0, 1 } }, to = 1 }):blocks {}, 1)

-- The prism of the same base, leaning.
do
    local base = {}
    for i, p in ipairs(slope) do
        base[i] = { p[1], 3, p[2] }
    end
    local model = make("prism", { base = base, axis = { 4, 10, -2 } })
    check.equal(#model:blocks {}, 3)
    check.near(model:blocks {}:sum("volume"), 10 * area_of(slope), 1e-8)
    check.equal(#model:contacts {}, 0)
end

-- A joint cuts the body as if it had no seams: two bodies, and one plane of contacts between them. The part that stands free
-- slides down its plane with g (sin a - cos a tan phi), as one block would.
do
    local model = make("profile", { section = { { 0, 0 }, { 4, 0 }, { 4, 0.2 }, { 2, 0.2 }, { 2, 3 }, { 0, 3 } }, to = 1 })
    model:generate("joint", { joint = "J", dip = 30, dip_direction = 90, origin = { 0, 0, 2.8 } })
    local bodies = {}
    for _, block in ipairs(model:blocks {}) do
        bodies[block.body] = (bodies[block.body] or 0) + block.volume
    end
    local count, total = 0, 0
    for _, volume in pairs(bodies) do
        count, total = count + 1, total + volume
    end
    check.equal(count, 2)
    check.near(total, 6.4, 1e-12)
    for _, contact in ipairs(model:contacts {}) do
        check.equal(contact.joint, "J:1")
        check.holds(contact.blocks[1].body ~= contact.blocks[2].body, "of two bodies")
    end
    model:blocks { below = { dip = 30, dip_direction = 90, origin = { 0, 0, 2.8 } } }:fix()
    local top = model:blocks { fixed = false }
    model:joint("J", "coulomb", { kn = 1e10, ks = 1e10, friction = 10 })
    model:timestep { dt = 1e-4 }
    model:cycle(2000)
    local a = math.rad(30)
    local way = 0.5 * 10 * (math.sin(a) - math.cos(a) * math.tan(math.rad(10))) * model.time ^ 2
    local u = top[1].displacement
    check.near(math.sqrt(u[1] ^ 2 + u[3] ^ 2), way, 0.01 * way)
    check.near(u[3] / u[1], -math.tan(a), 1e-3)
end

-- An L of two parts slides over the edge between two slabs without feeling its own seam.
do
    local model = talus.model { gravity = { 3, 0, -10 } }
    model:generate("box", { min = { -5, -5, -1 }, max = { 5, 5, 0 }, density = 2500 })
    model:blocks {}:fix()
    model:generate("profile", { section = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } }, to = 1, density = 2500 })
    model:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 10 })
    model:timestep { dt = 1e-4 }
    model:cycle(2000)
    local way = 0.5 * (3 - 10 * math.tan(math.rad(10))) * model.time ^ 2
    check.near(model:blocks { fixed = false }[1].displacement[1], way, 0.01 * way)
end

-- In a list, beside others.
do
    local model = talus.model {}
    model:generate("profile", { { section = slope, to = 1, density = 2000 }, { section = slope, from = 1, to = 2, density = 2000 } })
    check.equal(#model:blocks {}, 6)
    local bodies = {}
    for _, block in ipairs(model:blocks {}) do
        bodies[block.body] = true
    end
    local count = 0
    for _ in pairs(bodies) do
        count = count + 1
    end
    check.equal(count, 2)
end

-- Mistakes leave nothing behind.
local model = make("profile", { section = slope, to = 10 })
local function refused(values, part, generator)
    values.density = values.density or 2500
    values.to = values.to or (not generator and 1 or nil)
    check.refused(model, function() model:generate(generator or "profile", values) end, part)
end
refused({ section = { { 0, 0 }, { 1, 1 }, { 1, 0 }, { 0, 1 } } },
    "section crosses or touches itself: the edge from point 1 to 2 meets the one from point 3 to 4")
refused({ section = { { 0, 0 }, { 3, 0 }, { 3, 3 }, { 0, 3 }, { 0, 0 }, { 1, 1 }, { 1, 2 }, { 2, 2 }, { 2, 1 }, { 1, 1 } } },
    "a section with a hole is given as several without")
refused({ section = { { { 0, 0 }, { 3, 0 }, { 0, 3 } }, { { 1, 1 }, { 1.2, 1 }, { 1, 1.2 } } } },
    "list of lists of points (holes cannot be given)")
refused({ section = { { 0, 0 }, { 1, 0 }, { 2, 0 } } }, "section crosses or touches itself")
refused({ section = { { 0, 0 }, { 1, 0 } } }, "section: 2 points, but a polygon has 3 to 1000")
refused({ section = {} }, "section: 0 points")
refused({ section = { { 0, 0 }, { 1, 0 }, { 1, 0 }, { 0, 1 } } }, "section: points 2 and 3 coincide")
refused({ section = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 0, 1 } } }, "two numbers each")
refused({ section = { { 0, 0 }, { 1, 0 }, { 0, 0, 1 } } }, "row 3 has 3 numbers, not 2")
refused({ section = { { 0, 0 }, { 1, 0 / 0 }, { 0, 1 } } }, "section, row 2, y = nan is not a finite number")
refused({ section = slope, plane = "xx" }, "plane")
refused({ section = slope, from = 2, to = 2 }, "from = 2 m must be < to = 2 m: they are along y")
refused({ section = slope, plane = "xy", from = 3, to = 2 }, "they are along z")
refused({ section = slope, density = -1 }, "density")
refused({ section = slope, group = ("g"):rep(80) }, "longer than 63 letters")
refused({ base = { { 0, 0 }, { 1, 0 }, { 0, 1 } }, axis = { 0, 0, 1 } }, "not a list of rows of 2 numbers", "prism")
refused({ base = { { 0, 0, 0 }, { 2, 0, 0 }, { 1, 0.5, 0 }, { 2, 2, 0 } }, axis = { 1, 1, 0 } },
    "axis lies in the plane of the base", "prism")
