-- Edge along edge: four blocks cut by two planes meet in a line, and the two on opposite sides of it touch in nothing else.
-- While they only touch, nothing is there to press. Pressed into the planes by p and q, q < p, they have a prism in common
-- with a parallelogram for its section, whose mean overlap is s = q - q^2 / 3p. With an area A given by the user the edge
-- stores kn A s^2 / 2 and presses along the gradient of s, whichever plane was cut first, also as a block turns.
local talus = require "talus"
local check = require "check"

local A, B, APEX = { 40, 130 }, { 60, 220 }, { 0, 0.5, 1 }
local AREA = 0.7
local WEDGE, BELOW = { 0.5, -0.6, 0.9 }, { 0, 0.9, -0.9 } -- a point in each

local function normal(plane)
    local dip, direction = math.rad(plane[1]), math.rad(plane[2])
    return { math.sin(dip) * math.sin(direction), math.sin(dip) * math.cos(direction), math.cos(dip) }
end

local function dot(a, b)
    return a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
end

local function unit(a)
    local length = math.sqrt(dot(a, a))
    return { a[1] / length, a[2] / length, a[3] / length }
end

local function build(order)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { -2, -1, -1 }, max = { 2, 1, 1 }, density = 2000 })
    for _, name in ipairs(order) do
        local plane = name == "A" and A or B
        model:generate("joint", { joint = name, dip = plane[1], dip_direction = plane[2],
            origin = APEX })
    end
    model:joint("*", "coulomb", { kn = 1, ks = 1, friction = 30 })
    model:timestep { dt = 1e-3 }
    model:blocks():fix()
    local function holding(point)
        return model:blocks { containing = point }
    end
    return model, holding(WEDGE), holding(BELOW)
end

local a, b = normal(A), normal(B)

-- How far a point lies within both planes: the larger way and the smaller, with the plane of the smaller first.
local function within(from)
    local pa, pb = -dot(from, a), -dot(from, b)
    if pa > pb then
        return pa, pb, b, a
    end
    return pb, pa, a, b
end

for _, order in ipairs { { "A", "B" }, { "B", "A" } } do
    -- Without an area of its own the edge carries nothing to speak of, and nothing at all while it only touches.
    local model, wedge, below = build(order)
    check.equal(#wedge, 1)
    check.equal(#below, 1)
    check.equal(#model:contacts { between = { wedge, below } }, 0)

    -- The wedge sinks straight, far enough that no strip of the planes is a patch to speak of.
    model, wedge, below = build(order)
    model:contact_area { absolute = AREA }
    check.equal(#model:contacts { between = { wedge, below } }, 0)
    local VELOCITY, STEPS = { 1e-4, -2e-4, -1e-3 }, 2001
    wedge:drive { velocity = VELOCITY }
    model:cycle(STEPS)
    local contacts = model:contacts { between = { wedge, below } }
    check.equal(#contacts, 1)
    local time = (STEPS - 1) * model.dt -- contacts are those of the last step's forces
    local p, q, first, second = within { VELOCITY[1] * time, VELOCITY[2] * time, VELOCITY[3] * time }
    local s, by_p, by_q = q - q * q / (3 * p), q * q / (3 * p * p), 1 - 2 * q / (3 * p)
    local push = {}
    for k = 1, 3 do
        push[k] = by_q * first[k] + by_p * second[k]
    end
    check.near(contacts[1].gap, -q, 1e-9)
    check.near(contacts[1].area, AREA, 1e-4)
    -- The edge's own area makes a ten-thousandth of difference, and it ends in the walls of the box.
    check.near(math.abs(dot(contacts[1].normal, unit(push))), 1, 1e-4)
    local force = AREA * s * math.sqrt(dot(push, push)) -- kn is 1
    check.near(contacts[1].normal_force, force, 2e-3 * force)

    -- Turning about the edge and across it, slowly, past many looks at the geometry: the largest overlap is that of the end
    -- that sinks, or a little within, for the end wall is a face, too.
    model, wedge, below = build(order)
    model:contact_area { absolute = AREA }
    local line = unit { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3],
        a[1] * b[2] - a[2] * b[1] }
    local bisector = unit { a[1] + b[1], a[2] + b[2], a[3] + b[3] }
    local across = { line[2] * bisector[3] - line[3] * bisector[2],
        line[3] * bisector[1] - line[1] * bisector[3], line[1] * bisector[2] - line[2] * bisector[1] }
    local SPIN = 1e-2
    wedge:drive { angular_velocity = { SPIN * across[1], SPIN * across[2], SPIN * across[3] } }
    model:cycle(201)
    contacts = model:contacts { between = { wedge, below } }
    check.equal(#contacts, 1)
    -- The ends of the wedge's edge.
    local most = 0
    for _, corner in ipairs(wedge[1].vertices) do
        local from = { corner[1] - APEX[1], corner[2] - APEX[2], corner[3] - APEX[3] }
        local off = { from[1] - line[1] * dot(from, line), from[2] - line[2] * dot(from, line),
            from[3] - line[3] * dot(from, line) }
        if math.sqrt(dot(off, off)) < 1e-2 then
            most = math.max(most, (select(2, within(from))))
        end
    end
    check.near(contacts[1].gap, -most, 0.03 * most) -- a step late, and the planes turn
end

-- Two that only touch along an edge are no contact, with an area or without, nor are they when they have overlapped and
-- parted.
local late = talus.model { gravity = { 0, 0, 0 } }
late:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000, group = "still" })
late:generate("box", { min = { 0.99999, 0.99999, 0 }, max = { 2, 2, 1 }, density = 2000, group = "going" })
late:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
late:blocks { group = "still" }:fix()
late:timestep { dt = 1e-6 }
late:cycle(1)
late:blocks { group = "going" }:set { velocity = { 1, 1, 0 } }
late:cycle(30)
check.equal(#late:contacts(), 0)
late:contact_area { absolute = 0.01 }
late:cycle(1)
check.equal(#late:contacts(), 0)

local function touching()
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000, group = "still" })
    model:generate("box", { min = { 1, 1, 0 }, max = { 2, 2, 1 }, density = 2000, group = "going" })
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    model:blocks { group = "still" }:fix()
    model:timestep { dt = 1e-6 }
    model:cycle(1)
    check.equal(#model:contacts(), 0)
    return model
end

-- Pushes them into each other by o along both planes, until they are a contact; gives o at the last forces.
local function push(model)
    model:blocks { group = "going" }:drive { velocity = { -0.1, -0.1, 0 } }
    local overlap = 0
    while #model:contacts() == 0 and overlap < 1e-3 do
        model:cycle(1)
        overlap = overlap + 0.1 * model.dt
    end
    local before = overlap
    while overlap < 6e-4 do
        model:cycle(1)
        overlap = overlap + 0.1 * model.dt
    end
    return before, overlap - 0.1 * model.dt
end

-- What they have in common, kn o^3 / 3 a metre, goes unseen until o is 2e-4 of their size; with an area it does not. The
-- square of o has the area 2^(1/2) o, that of the two springs of its sides.
local pushed, UNSEEN = touching(), 2e-4
local seen, overlap = push(pushed)
check.near(seen, UNSEEN, 0.02 * UNSEEN)
local contact = pushed:contacts()[1]
check.near(contact.area, math.sqrt(2) * overlap, 1e-3 * overlap)
check.near(contact.normal_force, 1e9 * overlap ^ 2 / math.sqrt(2), 2)
local given = touching()
given:contact_area { absolute = 0.01 }
given:cycle(1)
check.equal(#given:contacts(), 0)
seen, overlap = push(given)
check.holds(seen < 2e-5, "with an area it is seen at once")
contact = given:contacts()[1]
local own = 1.5 * overlap -- A_e = V^2 / 4 G
check.near(contact.area, 0.01, 5e-5)
-- kn s^2 (A_e^2 + A^2)^(1/2) / 2, with s = 2 o / 3 and A_e = 3 o / 2, by o; a half of it on either side
local by_overlap = 1e9 / 2 * ((2 / 3) ^ 2 * 2 * overlap * math.sqrt(own ^ 2 + 1e-4)
    + (2 / 3 * overlap) ^ 2 * 1.5 * own / math.sqrt(own ^ 2 + 1e-4))
check.near(contact.normal_force, by_overlap / math.sqrt(2), 1e-3 * by_overlap)

-- Moved apart and along each other they never are one.
for _, velocity in ipairs { { 0.1, -0.1, 0 }, { -0.1, 0.1, 0 }, { 0, 0, 10 } } do
    local parted = touching()
    parted:blocks { group = "going" }:drive { velocity = velocity }
    parted:cycle(1000)
    check.equal(#parted:contacts(), 0)
end

-- A block beside and over another's edge, in touch without area, slides over its top and comes down: it is carried at
-- once.
local slides, ABOVE = talus.model { gravity = { 0, 0, 0 } }, 2e-5
slides:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000, group = "still" })
slides:generate("box", { min = { 0.9999, 0, 1 + ABOVE }, max = { 2, 1, 2 }, density = 2000, group = "going" })
slides:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 0 })
slides:blocks { group = "still" }:fix()
slides:timestep { dt = 1e-6 }
local going = slides:blocks { group = "going" }
for _, run in ipairs { { 55, 0, steps = 2 }, { 0, 0, steps = 2 }, { -50, 0, steps = 1000 }, { 0, -1, steps = 26 } } do
    going:drive { velocity = { run[1], 0, run[2] } }
    slides:cycle(run.steps)
end
check.equal(#slides:contacts(), 1)
check.near(slides:contacts():max "area", 0.05, 1e-3)
check.near(slides:contacts():max "gap", ABOVE - 26e-6, 1e-9)
