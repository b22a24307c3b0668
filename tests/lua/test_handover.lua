-- A block that is pressed and sheared and then tilts on a fixed one is first a patch and then a field contact, and a patch
-- again when it has turned back. Neither force nor moment jumps where one takes over, nor when the base has been joined with
-- another block just then and has got another frame.
local talus = require "talus"
local check = require "check"

local model, block

local function build()
    model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { -2, -2, -1 }, max = { 2, 2, 0 }, density = 2000, group = "base" })
    model:generate("box", { min = { 2, -2, -1 }, max = { 3, 5, 3 }, density = 2000, group = "base" })
    -- so heavy that it keeps its velocities
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 1e13, group = "block" })
    model:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 60 })
    model:blocks { group = "base" }:fix()
    model:timestep { dt = 1e-3 }
    block = model:blocks { group = "block" }
end

-- Force and moment of the contact, and whether it is a field contact, known by the area of its pressure.
local function look()
    local f, m, area = block[1].force, block[1].moment, model:contacts { between = { block, model:blocks { group = "base" } } }[1].area
    return { f[1], f[2], f[3], m[1], m[2], m[3] }, area < 0.999
end

-- Moves the block; calls `each` with what it was before and after a step.
local function go(velocity, turn, steps, each)
    block:set { velocity = velocity, angular_velocity = turn }
    for _ = 1, steps do
        local before, was = look()
        model:cycle(1)
        local after, is = look()
        if each then
            each(before, after, was, is)
        end
    end
end

local function press()
    go({ 0, 0, -1e-2 }, { 0, 0, 0 }, 20)
    go({ 2e-3, 1e-3, 0 }, { 0, 0, 2e-3 }, 20)
end

-- The largest change in a step, of all components over the force: where a contact changes, and elsewhere.
local changes, steps, first, at, else_where = 0, 0, nil, 0, 0
local function note(before, after, was, is)
    local most = 0
    for k = 1, 6 do
        most = math.max(most, math.abs(after[k] - before[k]) / after[3])
    end
    steps = steps + 1
    if was ~= is then
        first = first or steps
        changes, at = changes + 1, math.max(at, most)
    else
        else_where = math.max(else_where, most)
    end
end

build()
press()
go({ 0, 0, 0 }, { 0, 1e-3, 0 }, 1100, note)
check.equal(changes, 1)
go({ 0, 0, 0 }, { 0, -5e-4, 0 }, 1500, note)
check.equal(changes, 2)
check.holds(at < 2 * else_where, string.format("a change by %.2e of the force at a hand-over, by %.2e elsewhere", at, else_where))

for before = 0, 2 do
    build()
    press()
    go({ 0, 0, 0 }, { 0, 1e-3, 0 }, first - before)
    model:blocks { group = "base" }:join()
    at = 0
    go({ 0, 0, 0 }, { 0, 1e-3, 0 }, 3, function(old, new) note(old, new, true, false) end)
    check.holds(at < 2 * else_where, string.format("a change by %.2e when the base is joined", at))
end

-- A cube clamped under an initial stress whose springs are closed by 1 % of its size turns between its walls, and back: force and
-- stored energy go over to the field contact without a jump, and what the turn has put in is got back.
local clamped = talus.model { gravity = { 0, 0, 0 } }
for x = -1, 1 do
    local s = x == 0 and 0 or 1
    clamped:generate("box", { min = { x, -s, -s }, max = { x + 1, 1 + s, 1 + s }, density = x == 0 and 1e13 or 2500,
        group = x == 0 and "clamped" or "wall" })
end
clamped:blocks { group = "wall" }:fix()
clamped:joint("*", "coulomb", { kn = 1e8, ks = 1e7, friction = 60 })
clamped:insitu { stress = { xx = -1e6 } }
clamped:timestep { dt = 1e-3 }
clamped:cycle(1)
local turns, stored = clamped:blocks { group = "clamped" }, clamped:energy().stored
local begun, was, pressed = stored, 9, 1e6
local fields = 0
for _, way in ipairs { 1, -1 } do
    turns:set { angular_velocity = { 0, 4e-3 * way, 0 } }
    for _ = 1, 1000 do
        clamped:cycle(1)
        local now, contact = clamped:energy().stored, clamped:contacts()[1]
        check.near(now, stored, 2e-4 * begun)
        check.near(contact.normal_force, pressed, 2e-4 * 1e6)
        fields = fields + (#contact.points ~= was and 1 or 0)
        stored, was, pressed = now, #contact.points, contact.normal_force
    end
end
check.holds(fields >= 1, "goes over to a field contact")
check.near(stored, begun, 1e-4 * begun)
