-- The shapes of single blocks: prism, tetrahedron, drum; their volumes, and every kind of wrong input.
local talus = require "talus"
local check = require "check"

local function volume_of(generator, values)
    local model = talus.model {}
    values.density = 2000
    local summary = model:generate(generator, values)
    check.equal(summary.after, 1)
    return model:blocks()[1].volume, model:blocks()[1]
end

-- ---------------------------------------------------------------- tetrahedron

local corners = { { 1, 1, 1 }, { 4, 1, 1 }, { 1, 3, 1 }, { 1, 1, 2 } }
check.near(volume_of("tetrahedron", { vertices = corners }), 1, 1e-14)
check.near(volume_of("tetrahedron", { vertices = { corners[2], corners[1], corners[4], corners[3] } }),
    1, 1e-14)

-- ---------------------------------------------------------------- drum

for _, sides in ipairs { 3, 4, 7, 12, 100, 1000 } do
    local expected = sides / 2 * 2 ^ 2 * math.sin(2 * math.pi / sides) * 5
    for _, axis in ipairs { { 0, 0, 1 }, { 2, 0, 0 }, { -1, 3, 0.2 } } do
        local volume, block = volume_of("drum", { center = { 10, -3, 4 }, axis = axis, radius = 2,
            height = 5, sides = sides })
        check.near(volume, expected, 1e-11 * expected)
        check.near(block.centroid, { 10, -3, 4 }, 1e-12)
        check.equal(#block.faces, sides + 2)
        check.equal(#block.vertices, 2 * sides)
    end
end
local _, drum = volume_of("drum", { radius = 1, height = 2 })
check.equal(#drum.faces, 14)
check.equal(drum.group, "rock")

-- ---------------------------------------------------------------- prism

local hexagon, rhomb = {}, { { 0, 0, 0 }, { 2, 0, 0 }, { 3, 1, 0 }, { 1, 1, 0 } }
for i = 0, 5 do
    hexagon[i + 1] = { math.cos(i * math.pi / 3), math.sin(i * math.pi / 3), 7 }
end
local hexagon_area = 1.5 * math.sqrt(3)
check.near(volume_of("prism", { base = hexagon, axis = { 0, 0, 2 } }), 2 * hexagon_area, 1e-13)
check.near(volume_of("prism", { base = hexagon, axis = { 5, -4, -2 } }), 2 * hexagon_area, 1e-13)
check.near(volume_of("prism", { base = rhomb, axis = { 1, 1, 3 } }), 6, 1e-13)

-- The same the other way round, and with a point on an edge.
local reversed = {}
for i, point in ipairs(hexagon) do
    reversed[7 - i] = point
end
check.near(volume_of("prism", { base = reversed, axis = { 0, 0, 2 } }), 2 * hexagon_area, 1e-13)
local _, flush = volume_of("prism", { base = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 0, 2, 0 } },
    axis = { 0, 0, 1 } })
check.equal(#flush.faces, 5)
check.near(flush.volume, 2, 1e-14)

-- A frustum: h / 3 (A1 + A2 + sqrt(A1 A2)).
local small = { { 0.5, 0.5, 3 }, { 1.5, 0.5, 3 }, { 1.5, 1.5, 3 }, { 0.5, 1.5, 3 } }
local square = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 } }
check.near(volume_of("prism", { base = square, top = small }), 7, 1e-13)

-- Many sides, far from zero.
local circle, sides = {}, 500
for i = 1, sides do
    local angle = 2 * math.pi * i / sides
    circle[i] = { 1e6 + math.cos(angle), -1e6 + math.sin(angle), 1e6 }
end
check.near(volume_of("prism", { base = circle, axis = { 0, 0, 1 } }),
    sides / 2 * math.sin(2 * math.pi / sides), 1e-7)

-- ---------------------------------------------------------------- mistakes

local model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })

local function refused(generator, values, part)
    values.density = values.density or 2000
    check.refused(model, function() model:generate(generator, values) end, part)
end

refused("tetrahedron", { vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } },
    "3 points, but a tetrahedron has 4")
refused("tetrahedron", { vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } } },
    "lie in one plane")
refused("tetrahedron", { vertices = corners, density = 0 }, "density = 0")

refused("drum", { radius = 1, height = 1, axis = { 0, 0, 0 } }, "has no direction")
refused("drum", { radius = 0, height = 1 }, "radius = 0 m must be > 0")
refused("drum", { radius = 1, height = -1 }, "height = -1 m must be > 0")
refused("drum", { radius = 1, height = 1, sides = 2 }, "sides = 2 is outside [3, 1000]")
refused("drum", { radius = 1, height = 1, sides = 1001 }, "sides = 1001 is outside [3, 1000]")
refused("drum", { radius = 1, height = 1e-9 }, "generator 'drum'")

refused("prism", { base = square }, "give axis (a vector) or top (points)")
refused("prism", { base = square, axis = { 0, 0, 1 }, top = small }, "give one of them")
refused("prism", { base = square, axis = { 1, 1, 0 } }, "the ends meet or cross")
refused("prism", { base = square, axis = { 0, 0, 0 } }, "the ends meet or cross")
refused("prism", { base = { { 0, 0, 0 }, { 1, 0, 0 } }, axis = { 0, 0, 1 } },
    "base: 2 points, but a polygon has 3 to 1000")
refused("prism", { base = {}, axis = { 0, 0, 1 } }, "base: 0 points")
refused("prism", { base = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } }, axis = { 0, 0, 1 } },
    "enclose no area")
refused("prism", { base = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0.1 }, { 0, 1, 0 } }, axis = { 0, 0, 1 } },
    "the points must lie in one plane")
refused("prism", { base = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, axis = { 0, 0, 1 } },
    "base: points 2 and 3 coincide")
-- a notch to a top, a bow tie, and a star that turns the same way at every point
refused("prism", { base = { { 0, 0, 0 }, { 2, 0, 0 }, { 1, 0.5, 0 }, { 2, 2, 0 } },
    top = { { 0, 0, 1 }, { 2, 0, 1 }, { 1, 0.5, 1 }, { 2, 2, 1 } } }, "base is not convex or crosses itself")
refused("prism", { base = { { 0, 0, 0 }, { 3, 0, 0 }, { 0, 2, 0 }, { 2, 1, 0 } }, axis = { 0, 0, 1 } },
    "base crosses or touches itself")
local star = {}
for i = 0, 4 do
    star[i + 1] = { math.cos(4 * math.pi * i / 5), math.sin(4 * math.pi * i / 5), 0 }
end
refused("prism", { base = star, axis = { 0, 0, 1 } }, "base crosses or touches itself")
refused("prism", { base = square, top = { small[1], small[2], small[3] } },
    "top has 3 points and base 4")
refused("prism", { base = square, top = { { 0, 0, 1 }, { 2, 0, 1 }, { 2, 2, -1 }, { 0, 2, -1 } } },
    "the ends meet or cross: point 3 of top lies across the plane of base")
