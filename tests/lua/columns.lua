-- columns.lua - a column under a load beside its middle, on a joint of any law, and what statics says of it.
--
-- Where the joint bears the load, the column sinks and tilts as exact statics of an elastic joint without tension says
-- (no_tension.lua); where the load is off the foot, it topples. A bond may only help.
--
-- Feet are regular and irregular polygons of 3 to 100 corners, on a floor or on another column, in any attitude. Histories
-- before the load goes to its place: `flush`, as made; `gap`, dropped from 1e-3 m; `insitu`, made under a stress that is then
-- gone; `slid` by up to 1e-3 m; `farther`, loaded farther out before. There is no weight, and the load acts at the height of the foot,
-- so that a tilt does not move it. Each model is drawn from its number and is the same for all laws.
local no_tension = require "no_tension"
local shapes = require "shapes"
local talus = require "talus"

local columns = {}

-- How far tilt and closure may be off, relative: of any law, and of one that slip opens. Points next to the open part press so
-- little that they slip while the column comes to rest, and ride up. Where a column fell, or stood on its edge before, its walls
-- have ridden up unevenly, by what is not known from outside: of such laws tilts are not compared then.
-- Where the stress is no line, its slope changes up to ninefold at a knee, which may lie inside a cell of a contact (partly_open.c).
local WITHIN, WITHIN_OPENED, WITHIN_KNEE = 0.01, 0.03, 0.055

function columns.within(joint)
    return joint.curved and WITHIN_KNEE or joint.opens and WITHIN_OPENED or WITHIN
end

-- Beyond this tilt, rad, half of it counts as an error of the pressure field between two faces (theory.md): not compared.
local STEEP = 5e-3
local TOPPLED = 0.03 -- rad, or four times what is expected
columns.HISTORIES = { "flush", "gap", "insitu", "slid", "farther" }
columns.SHARES = { 0.5, 0.7, 0.85, 0.93, 0.97, 1.03 } -- of the way from the middle of the foot to its border
local AT_REST, MOST_CYCLES = 1e-6, 40000
local GAP, SLID = 1e-3, 1e-3 -- m
-- A column slides by so many of its closures, by a part of one in each step: thrown up by its ride, it would come down unevenly.
local CLOSURES, PART = 1000, 0.5
local HIGH, DENSITY = 0.1, 2500
local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

-- ---------------------------------------------------------------- the model

-- A polygon about the origin with the circumscribed radius 1.
local function foot(random)
    local n = math.floor(({ random(3, 9), random(9, 25), random(25, 101) })[math.floor(random(1, 4))])
    local regular, points = random(0, 1) < 0.5, {}
    local turn = random(0, 2 * math.pi)
    for i = 1, n do
        local angle = turn + 2 * math.pi * (i + (regular and 0 or random(-0.45, 0.45))) / n
        points[i] = { math.cos(angle), math.sin(angle) }
    end
    return points
end

-- A model by its number: all that does not depend on the law.
function columns.draw(number)
    local random = shapes.random(number)
    local case = { number = number, polygon = foot(random), history = columns.HISTORIES[number % #columns.HISTORIES + 1] }
    case.kn = 10 ^ random(8, 11)
    case.pressure = case.kn * 10 ^ random(-6.5, -4.5)
    case.below = random(0, 1) < 0.5 and foot(random) or nil
    case.shift = { random(-0.3, 0.3), random(-0.3, 0.3) }
    case.way = random(0, 2 * math.pi)
    case.share = columns.SHARES[math.floor(random(1, #columns.SHARES + 1))]
    case.initial = case.pressure * random(0.2, 8)
    -- What slides is guided along x, so it stands upright.
    case.attitude = case.history == "slid" and NONE or shapes.attitude(random)
    return case
end

-- A vector of the column's own axes, of which z goes up along it, in those of the model.
local function turned(case, x)
    return shapes.apply(case.attitude, x)
end

local function prism(case, model, polygon, low, high)
    local vertices = {}
    for _, p in ipairs(polygon) do
        for _, z in ipairs { low, high } do
            vertices[#vertices + 1] = turned(case, { p[1], p[2], z })
        end
    end
    model:generate("polyhedron", { vertices = vertices, density = DENSITY })
end

local function moved(polygon, x, y)
    local out = {}
    for i, p in ipairs(polygon) do
        out[i] = { p[1] + x, p[2] + y }
    end
    return out
end

local function build(case, joint)
    local model = talus.model { gravity = { 0, 0, 0 } }
    local below = case.below and moved(case.below, table.unpack(case.shift)) or { { -3, -3 }, { 3, -3 }, { 3, 3 }, { -3, 3 } }
    prism(case, model, below, -HIGH, 0)
    local gap = case.history == "gap" and GAP or 0
    prism(case, model, case.polygon, gap, gap + HIGH)
    model:blocks { id = 1 }:fix()
    model:joint("*", joint.law, joint.params)
    model:damping "kinetic"
    return model, model:blocks { id = 2 }
end

-- The vertices of the lower end of the column, in its own axes before it moved.
local function foot_now(case, block)
    local out, back = {}, {}
    for i = 1, 3 do
        back[i] = { case.attitude[1][i], case.attitude[2][i], case.attitude[3][i] }
    end
    for _, v in ipairs(block.vertices) do
        local x = shapes.apply(back, v)
        if x[3] < HIGH / 2 then
            out[#out + 1] = x
        end
    end
    return out
end

-- Where the foot meets what is below, now.
local function contact_polygon(case, model, block)
    local own = no_tension.hull(foot_now(case, block[1]))
    if not case.below then
        return own
    end
    local slid = model:blocks { id = 1 }[1].displacement -- along x, of columns that stand upright
    return no_tension.common(own, no_tension.hull(moved(case.below, case.shift[1] + slid[1], case.shift[2])))
end

-- Angle of a block's whole turn, rad.
local function tilt(block)
    local q = block.rotation
    return 2 * math.atan(math.sqrt(q[2] ^ 2 + q[3] ^ 2 + q[4] ^ 2), math.abs(q[1]))
end

-- The closure {c, gx, gy} of the foot with the plane z = 0: least squares of -z = c + gx x + gy y.
local function closure_of(case, block)
    local corners = foot_now(case, block)
    local n, x, y, z = #corners, 0, 0, 0
    for _, v in ipairs(corners) do
        x, y, z = x + v[1] / n, y + v[2] / n, z + v[3] / n
    end
    local xx, xy, yy, xz, yz = 0, 0, 0, 0, 0
    for _, v in ipairs(corners) do
        local dx, dy, dz = v[1] - x, v[2] - y, v[3] - z
        xx, xy, yy = xx + dx * dx, xy + dx * dy, yy + dy * dy
        xz, yz = xz - dx * dz, yz - dy * dz
    end
    local det = xx * yy - xy * xy
    local gx, gy = (xz * yy - yz * xy) / det, (yz * xx - xz * xy) / det
    return { -z - gx * x - gy * y, gx, gy }
end

-- ---------------------------------------------------------------- its history

-- Where a load acts at a share of the way from the middle of the polygon to its border.
local function place(polygon, way, share)
    local _, middle = no_tension.area(polygon)
    local u = { math.cos(way), math.sin(way) }
    local far = share * no_tension.reach(polygon, middle, u)
    return { middle[1] + far * u[1], middle[2] + far * u[2] }
end

-- Puts the load there and runs. Gives why the run ended: "ratio" at rest, "stop" where the column tilts by more than `most`.
local function load(case, model, block, force, at, most)
    block:load { force = turned(case, { 0, 0, -force }), at = turned(case, { at[1], at[2], 0 }) }
    return model:solve { ratio = AT_REST, max_cycles = MOST_CYCLES, every = 50, stop = function()
        return tilt(block[1]) > most
    end }.reason
end

-- Slips and lets the shear go, while the column is kept from turning: all points slip alike.
local function slide(case, model, block)
    local closure = case.pressure / case.kn
    local far, speed = math.min(SLID, CLOSURES * closure), PART * closure / model.dt
    local below = model:blocks { id = 1 }
    local function shear()
        return model:contacts():sum "shear_force"[1]
    end
    local function move(speed, done)
        below:drive { velocity = { speed, 0, 0 } }
        model:solve { ratio = 0, max_cycles = MOST_CYCLES, every = 1, stop = done }
    end
    block:fix { x = true, y = true, rotation = true }
    local most = 0 -- the shear of the slide
    move(speed, function()
        most = math.abs(shear()) > math.abs(most) and shear() or most
        return math.abs(below[1].displacement[1]) > far
    end)
    move(-speed / 50, function() return shear() * most <= 0 end)
    below:free():fix()
    block:free()
end

-- What comes before the load goes to its place. Gives why the last run ended.
local function prepare(case, model, block, force)
    if case.history == "insitu" then
        local z, s = turned(case, { 0, 0, 1 }), case.initial
        model:insitu { stress = { xx = -s * z[1] * z[1], yy = -s * z[2] * z[2], zz = -s * z[3] * z[3],
            xy = -s * z[1] * z[2], yz = -s * z[2] * z[3], xz = -s * z[1] * z[3] } }
    end
    local polygon = contact_polygon(case, model, block)
    local reason = load(case, model, block, force, place(polygon, 0, 0), TOPPLED)
    if case.history == "slid" then
        slide(case, model, block)
        reason = load(case, model, block, force, place(contact_polygon(case, model, block), 0, 0), TOPPLED)
    elseif case.history == "farther" then
        local share = math.min(0.93, 0.5 + case.share / 2)
        reason = load(case, model, block, force, place(polygon, case.way, share), TOPPLED)
    end
    return reason
end

-- ---------------------------------------------------------------- statics

-- Whether a bond bears a part of the load that counts.
local function bears(case, joint)
    return math.max(joint.tension, joint.tension_after) > 1e-4 * case.pressure
end

-- The closure that the column should have, nil where it should topple. `helped`: that of the joint whose bond is whole, where
-- the bond may hold or break: then the tilt is between both.
local function wanted(case, joint, polygon, force, at)
    local free = no_tension.equilibrium(polygon, force, at, joint.stress, case.kn)
    local whole = joint.tension > 0 and no_tension.equilibrium(polygon, force, at, joint.stress, case.kn, true)
    local tension = case.history == "gap" and joint.tension_after or joint.tension
    if tension == math.huge then
        return whole
    elseif whole and tension > 0 and case.history ~= "farther" and case.history ~= "slid" then
        -- A load that comes at once swings up to twice as far as it rests: below half of the strength the bond is whole.
        if -no_tension.extremes(polygon, whole) * case.kn < 0.45 * tension then
            return whole
        end
    end
    return free, bears(case, joint) and whole or nil
end

local function slope(closure)
    return math.sqrt(closure[2] ^ 2 + closure[3] ^ 2)
end

-- How far the column is off: in tilt, and in closure where it presses, over the largest.
local function off(case, joint, polygon, want, block)
    local got = closure_of(case, block[1])
    local tilts = math.sqrt((got[2] - want[2]) ^ 2 + (got[3] - want[3]) ^ 2) / slope(want)
    if joint.opens and case.history == "slid" then
        return tilts, 0 -- how far slip has lifted the walls is not known from outside
    end
    local _, deepest = no_tension.extremes(polygon, want)
    local before, sinks = case.history == "insitu" and no_tension.closure_of(joint.stress, case.initial) or 0, 0
    for _, p in ipairs(polygon) do
        local should = want[1] + want[2] * p[1] + want[3] * p[2]
        local by = got[1] + got[2] * p[1] + got[3] * p[2] + before - should
        sinks = math.max(sinks, should > 0 and math.abs(by) / deepest or 0)
    end
    return tilts, sinks
end

-- Runs a model with a law of every_law.lua. Gives a sentence on what is wrong, or nil; and how far tilt or closure are off where
-- statics gives both.
function columns.try(case, joint)
    local model, block = build(case, joint)
    local force = case.pressure * no_tension.area(contact_polygon(case, model, block))
    local before = prepare(case, model, block, force)
    if before ~= "ratio" then
        return ("before the load is at its place: %s"):format(before == "stop" and "it topples" or "never at rest")
    end
    local polygon = contact_polygon(case, model, block)
    local at = place(polygon, case.way, case.share)
    local want, helped = wanted(case, joint, polygon, force, at)
    local expected = want and slope(want) or 0
    local reason = load(case, model, block, force, at, math.max(TOPPLED, 4 * expected))
    if not want then
        return reason ~= "stop" and not bears(case, joint) and "it does not topple: " .. reason or nil
    elseif reason ~= "ratio" then
        return reason == "stop" and "it topples" or "never at rest"
    elseif expected > STEEP or joint.opens and (case.history == "gap" or case.history == "farther") then
        return nil
    end
    local within = columns.within(joint)
    if helped then
        local is, least = slope(closure_of(case, block[1])), slope(helped)
        if is > (1 + within) * expected or is < (1 - within) * math.min(least, expected) then
            return ("tilt %.3e rad is not between %.3e with a whole bond and %.3e without"):format(is, least, expected)
        end
        return nil
    end
    local tilts, sinks = off(case, joint, polygon, want, block)
    local wrong = math.max(tilts, sinks) > within
        and ("tilt is off by %.2f %%, closure by %.2f %%"):format(100 * tilts, 100 * sinks) or nil
    return wrong, math.max(tilts, sinks)
end

-- What tells a model in a message.
function columns.title(case)
    return ("model %d (%d corners%s, kn %.1e, %s, load at %g)"):format(case.number, #case.polygon,
        case.below and " on " .. #case.below or "", case.kn, case.history, case.share)
end

return columns
