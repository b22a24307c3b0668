-- Rock between walls: water presses on the walls that face each other, not on those behind a thin slab or the tip of a wedge, nor on
-- two that look away from each other.
local talus = require "talus"
local check = require "check"

local P = 1e4 -- Pa

-- Water's force on each block, by its id.
local function pushed(model)
    local force = {}
    for _, element in ipairs(model:elements { kind = "water" }) do
        for _, node in ipairs(element.nodes) do
            local f = force[node.block.id] or { 0, 0, 0 }
            for k = 1, 3 do
                f[k] = f[k] + node.force[k]
            end
            force[node.block.id] = f
        end
    end
    return force
end

local function area_vector(vertices, face)
    local corner, a = face.vertices, { 0, 0, 0 }
    for i = 2, #corner - 1 do
        local o, p, q = vertices[corner[1]], {}, {}
        for k = 1, 3 do
            p[k], q[k] = vertices[corner[i]][k] - o[k], vertices[corner[i + 1]][k] - o[k]
        end
        a[1] = a[1] + 0.5 * (p[2] * q[3] - p[3] * q[2])
        a[2] = a[2] + 0.5 * (p[3] * q[1] - p[1] * q[3])
        a[3] = a[3] + 0.5 * (p[1] * q[2] - p[2] * q[1])
    end
    return a
end

-- In a rock that joints cut through, each wall of a wet joint has the whole pressure on its whole area.
local function whole(model, wet)
    model:water("uniform", { pressure = P, joints = wet })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    model:blocks():fix()
    model:cycle(1)
    local force = pushed(model)
    for _, block in ipairs(model:blocks()) do
        local expected, size = { 0, 0, 0 }, 0
        for _, face in ipairs(block.faces) do
            if face.joint and (wet == "*" or face.joint:match "^[^:]*" == wet or face.joint == wet) then
                local a = area_vector(block.vertices, face)
                for k = 1, 3 do
                    expected[k] = expected[k] - P * a[k]
                    size = size + P * math.abs(a[k])
                end
            end
        end
        check.near(force[block.id] or { 0, 0, 0 }, expected, 1e-7 * math.max(size, P * 0.01))
    end
end

local function cube()
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = 2500 })
    return model
end

local function cut(model, name, dip, dip_direction, origin)
    model:generate("joint", { joint = name, dip = dip, dip_direction = dip_direction, origin = origin })
end

-- A slab of 3 cm between two planes of a set; water on both planes, and on one alone. Two slabs of 2 cm on each other.
for _, wet in ipairs { "*", "A", "A:1", "A:2" } do
    local model = cube()
    cut(model, "A", 0, 0, { 0, 0, 1 })
    cut(model, "A", 0, 0, { 0, 0, 1.03 })
    whole(model, wet)
    local slabs = cube()
    for i = 0, 2 do
        cut(slabs, "A", 0, 0, { 0, 0, 1 + 0.02 * i })
    end
    whole(slabs, wet)
end

-- Planes that cross at 1.5 degrees, cut by others: the tips of wedges are thinner than the gap in which water is.
for k = 0, 3 do
    local model = cube()
    cut(model, "A", 50, 40 + 90 * k, { 1, 1, 1 })
    cut(model, "A", 51.5, 41 + 90 * k, { 1, 1.1, 1 })
    cut(model, "B", 70, (130 + 90 * k) % 360, { 1, 1, 1 })
    cut(model, "B", 69, (131 + 90 * k) % 360, { 0.9, 1, 1 })
    whole(model, k % 2 == 0 and "*" or "A")
end

-- A plate of 2 cm in the middle of a joint of 2 cm: around it the walls face each other, as seen in four pieces.
do
    local model = talus.model { gravity = { 0, 0, 0 } }
    for _, box in ipairs { { { 0, 0, 0 }, { 3, 3, 1 } }, { { 1, 1, 1 }, { 2, 2, 1.02 } }, { { 0, 0, 1.02 }, { 3, 3, 2 } } } do
        model:generate("box", { min = box[1], max = box[2], density = 2500 })
    end
    model:blocks():fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    local joints = model:water("uniform", { pressure = P })
    local area, beside = 0, 0
    for _, joint in ipairs(joints) do
        area = area + joint.area
        beside = beside + (joint.opening > 0.01 and 1 or 0)
        check.near(joint.opening, joint.opening > 0.01 and 0.02 or 0, 1e-12)
    end
    check.equal(beside, 4)
    check.near(area, 8 + 1 + 1, 1e-12)
    model:cycle(1)
    local force = pushed(model)
    check.near(force[1], { 0, 0, -9 * P }, 1e-6)
    check.near(force[2], { 0, 0, 0 }, 1e-6)
    check.near(force[3], { 0, 0, 9 * P }, 1e-6)
end
