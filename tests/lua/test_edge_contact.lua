-- Edge along edge: four blocks cut by two planes meet in a line, and the two on opposite sides of it touch
-- in nothing else. With an area given by the user their contact has the bisector of both planes as its
-- normal, whichever plane was cut first, and a gap that follows the motion, also as a block turns.
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
local bisector = unit { a[1] + b[1], a[2] + b[2], a[3] + b[3] }

for _, order in ipairs { { "A", "B" }, { "B", "A" } } do
    -- Without an area of its own the edge carries nothing.
    local model, wedge, below = build(order)
    check.equal(#wedge, 1)
    check.equal(#below, 1)
    for _, contact in ipairs(model:contacts { between = { wedge, below } }) do
        check.equal(contact.area, 0)
    end

    model, wedge, below = build(order)
    model:contact_area { absolute = AREA }
    local contacts = model:contacts { between = { wedge, below } }
    check.equal(#contacts, 1)
    check.near(contacts[1].area, AREA, 1e-12)
    check.near(math.abs(dot(contacts[1].normal, bisector)), 1, 1e-12)

    -- The wedge sinks straight, without force worth mentioning: the gap is its way along the normal.
    local VELOCITY, STEPS = { 1e-4, -2e-4, -1e-3 }, 101
    wedge:drive { velocity = VELOCITY }
    model:cycle(STEPS)
    check.near(contacts[1].gap, dot(VELOCITY, bisector) * STEPS * model.dt, 1e-9)
    check.near(contacts[1].area, AREA, 1e-12)

    -- Turning about the edge and across it, slowly, past many looks at the geometry: the plane stays with
    -- the edge. The least gap is that of the end that sinks; its rate is bounded by the turn.
    model, wedge, below = build(order)
    model:contact_area { absolute = AREA }
    contacts = model:contacts { between = { wedge, below } }
    local line = unit { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3],
        a[1] * b[2] - a[2] * b[1] }
    local across = { line[2] * bisector[3] - line[3] * bisector[2],
        line[3] * bisector[1] - line[1] * bisector[3], line[1] * bisector[2] - line[2] * bisector[1] }
    local SPIN = 1e-3
    wedge:drive { angular_velocity = { SPIN * across[1], SPIN * across[2], SPIN * across[3] } }
    local least = math.huge
    model:cycle(STEPS)
    -- The ends of the wedge's edge.
    for _, corner in ipairs(wedge[1].vertices) do
        local from = { corner[1] - APEX[1], corner[2] - APEX[2], corner[3] - APEX[3] }
        local off = { from[1] - line[1] * dot(from, line), from[2] - line[2] * dot(from, line),
            from[3] - line[3] * dot(from, line) }
        if math.sqrt(dot(off, off)) < 1e-2 then
            least = math.min(least, dot(from, bisector))
        end
    end
    check.near(contacts[1].gap, least, 0.03 * math.abs(least)) -- a step late, and the bisector turns
end

-- Two blocks that have touched along an edge and parted by less than ends their contact: an area given only
-- then holds for it, too.
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
check.equal(#late:contacts(), 1)
check.near(late:contacts():min "area", 0.01, 1e-12)

-- Two that only touch along an edge are no contact until they overlap by 1e-5 of their size, or are given an area.
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
local given = touching()
given:contact_area { absolute = 0.01 }
given:cycle(1)
check.equal(#given:contacts(), 1)
check.near(given:contacts():min "area", 0.01, 1e-12)

local pushed, UNSEEN = touching(), 1e-5
pushed:blocks { group = "going" }:drive { velocity = { -0.1, -0.1, 0 } }
local overlap = 0
while #pushed:contacts() == 0 and overlap < 3 * UNSEEN do
    pushed:cycle(1)
    overlap = overlap + 0.1 * pushed.dt
end
check.near(overlap, UNSEEN, 3 * 0.1 * pushed.dt)
check.near(pushed:contacts():min "area", overlap, 3 * 0.1 * pushed.dt)

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
