-- how_stiff.lua - the table of docs/how_stiff.md: where four structures fail with joints of ever higher stiffness and both kinds of
-- contact points, beside rigid statics.
--
--     build/release/talus --quiet scripts/tools/how_stiff.lua [arch|wall|dome|slope] ...
--
-- Arch, wall and dome are pushed sideways by a growing share of their weight. The columns of the slope stand on a friction that is
-- lowered. Each value is found by strides and then by halving, from a copy of the model at rest at the last value that stood.
local talus = require "talus"

local STIFFNESS = { 1e8, 1e9, 1e10, 1e11 } -- kn = ks, Pa/m
local GRAVITY, DENSITY = 9.81, 2400
local FRICTION = 60                        -- of arch, wall and dome, degrees: no joint slides
local STRIDES, HALVINGS = 5, 4             -- from the first value to that of rigid statics; after the first failure
local AT_REST = 1e-5                       -- unbalanced force ratio
local LONGEST = 400000                     -- steps within which what stands comes to rest

-- ------------------------------------------------------------------ rigid statics

local function rotated(omega, centre, p) -- velocity of a point that turns about another, in the x-z plane
    return { -omega * (p[2] - centre[2]), omega * (p[1] - centre[1]) }
end

local function crossing(a, b, c, d) -- of the lines a-b and c-d
    local ux, uz, vx, vz = b[1] - a[1], b[2] - a[2], d[1] - c[1], d[2] - c[2]
    local det = ux * vz - uz * vx
    if math.abs(det) < 1e-9 then
        return nil
    end
    local s = ((c[1] - a[1]) * vz - (c[2] - a[2]) * vx) / det
    return { a[1] + s * ux, a[2] + s * uz }
end

-- How far hinge b of a part that turns about hinge a with omega makes the next part turn about its centre.
local function passed_on(omega, a, b, centre)
    local v, r = rotated(omega, a, b), { b[1] - centre[1], b[2] - centre[2] }
    return (v[2] * r[1] - v[1] * r[2]) / (r[1] * r[1] + r[2] * r[2])
end

-- Share of the weight that turns an arch about four hinges; nil where they are no mechanism. `side`: 1 inner, 2 outer.
local function push_of(joints, blocks, at, side)
    local h = {}
    for k = 1, 4 do
        h[k] = joints[at[k]][side[k]]
    end
    local centre = crossing(h[1], h[2], h[4], h[3])
    if not centre then
        return nil
    end
    for _, first in ipairs { 1, -1 } do
        local middle = passed_on(first, h[1], h[2], centre)
        local last = passed_on(middle, centre, h[3], h[4])
        local turns, opens = { 0, first, middle, last, 0 }, true
        for k = 1, 4 do -- a hinge outside opens the joint inside
            local by = turns[k + 1] - turns[k]
            opens = opens and (side[k] == 1 and by > 0 or side[k] == 2 and by < 0)
        end
        local up, along = 0, 0
        for k, part in ipairs { { h[1], first }, { centre, middle }, { h[4], last } } do
            for i = at[k], at[k + 1] - 1 do
                local v = rotated(part[2], part[1], blocks[i].place)
                up, along = up + blocks[i].mass * v[2], along + blocks[i].mass * v[1]
            end
        end
        if opens and along > 0 then
            return up / along
        end
    end
    return nil
end

-- Least share over all mechanisms of four hinges: block i lies between the joints i and i + 1.
local function rigid_arch(joints, blocks)
    local least, n = math.huge, #joints
    for i = 1, n - 3 do for j = i + 1, n - 2 do for k = j + 1, n - 1 do for l = k + 1, n do
        for sides = 0, 15 do
            local side = {}
            for q = 1, 4 do
                side[q] = 1 + (sides >> (q - 1) & 1)
            end
            least = math.min(least, push_of(joints, blocks, { i, j, k, l }, side) or math.huge)
        end
    end end end end
    return least
end

-- ------------------------------------------------------------------ structures

local function new_model(points, stiffness, friction)
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, contact_points = points }
    return model, function()
        model:joint("*", "coulomb", { kn = stiffness, ks = stiffness, friction = friction })
        model:damping "local"
        return model, model:blocks { fixed = false }
    end
end

-- Voussoirs over half a circle; half_width(r, angle) is that of the arch across.
local function vault(voussoirs, radius, thickness, half_width)
    return function(points, stiffness)
        local model, finish = new_model(points, stiffness, FRICTION)
        local inner, outer = radius - thickness / 2, radius + thickness / 2
        local function corners(from, to)
            local list = {}
            for _, angle in ipairs { from, to } do
                for _, r in ipairs { inner, outer } do
                    for _, sign in ipairs { -1, 1 } do
                        list[#list + 1] = { r * math.cos(angle), sign * half_width(r, angle), r * math.sin(angle) }
                    end
                end
            end
            return list
        end
        local joints = {}
        for k = 0, voussoirs do
            local angle = math.pi * k / voussoirs
            joints[k + 1] = { { inner * math.cos(angle), inner * math.sin(angle) }, { outer * math.cos(angle), outer * math.sin(angle) } }
            if k > 0 then
                model:generate("polyhedron", { vertices = corners(math.pi * (k - 1) / voussoirs, angle), density = DENSITY })
            end
        end
        for _, side in ipairs { { inner, outer }, { -outer, -inner } } do
            local w = half_width(outer, 0)
            model:generate("box", { min = { side[1], -w, -0.5 }, max = { side[2], w, 0 }, density = DENSITY, group = "springer" })
        end
        model:blocks { group = "springer" }:fix()
        local blocks = {}
        for i, block in ipairs(model:blocks { fixed = false }) do
            blocks[i] = { mass = block.mass, place = { block.centroid[1], block.centroid[3] } }
        end
        local built, moving = finish()
        return built, moving, { joints = joints, blocks = blocks }
    end
end

local function wall(points, stiffness)
    local model, finish = new_model(points, stiffness, FRICTION)
    for k = 0, 5 do
        model:generate("box", { min = { 0, 0, 0.6 * (k - 1) }, max = { 0.3, 1, 0.6 * k }, density = DENSITY,
            group = k == 0 and "ground" or "wall" })
    end
    model:blocks { group = "ground" }:fix()
    return finish()
end

-- Goodman and Bray (1976), the smaller of the slopes of tests/verify/long/goodman_bray.lua, with columns 1 m deep.
local HEIGHTS = { 3.5, 7, 10.5, 14, 17.5, 21, 24.5, 28, 31.5, 26.5, 21.5, 16.5, 11.5, 6.5 }
local WIDTH, STEP, DIP = 8, 1, math.rad(28)

local function slope(points, stiffness)
    local model, finish = new_model(points, stiffness, 44)
    local function prism(u0, u1, w0, w1, group)
        local list = {}
        for _, u in ipairs { u0, u1 } do
            for _, w in ipairs { w0, w1 } do
                for _, y in ipairs { 0, 1 } do
                    list[#list + 1] = { u * math.cos(DIP) - w * math.sin(DIP), y, u * math.sin(DIP) + w * math.cos(DIP) }
                end
            end
        end
        model:generate("polyhedron", { vertices = list, density = 2550, group = group })
    end
    for i, height in ipairs(HEIGHTS) do
        prism((i - 1) * WIDTH, i * WIDTH, -20, (i - 1) * STEP, "base")
        prism((i - 1) * WIDTH, i * WIDTH, (i - 1) * STEP, (i - 1) * STEP + height, "column")
    end
    model:blocks { group = "base" }:fix()
    return finish()
end

local function push(model, share)
    model.gravity = { share * GRAVITY, 0, -GRAVITY }
end

local CASES = {
    arch = { build = vault(11, 5, 0.8, function() return 0.5 end), fallen = 0.1, first = 0, change = push,
        rigid = function(shape) return rigid_arch(shape.joints, shape.blocks) end },
    wall = { build = wall, fallen = 0.1, first = 0, change = push, rigid = function() return 0.3 / 3 end },
    dome = { build = vault(11, 5, 0.8, function(r, angle) return r * math.abs(math.cos(angle)) * math.tan(math.rad(7.5)) end),
        fallen = 0.1, first = 0, change = push, rigid = function(shape) return rigid_arch(shape.joints, shape.blocks) end },
    slope = { build = slope, fallen = 0.25, first = 44, rigid = function() return 37.4214 end,
        change = function(model, angle) model:joint("*", { friction = angle }) end },
}

-- ------------------------------------------------------------------ failure

local function travel(blocks) -- longest displacement, m
    local longest = 0
    for _, block in ipairs(blocks) do
        local u = block.displacement
        longest = math.max(longest, u[1] ^ 2 + u[2] ^ 2 + u[3] ^ 2)
    end
    return math.sqrt(longest)
end

local function stands(case, model, value)
    local blocks = model:blocks { fixed = false }
    case.change(model, value)
    blocks:reset_displacement()
    local run = model:solve { ratio = AT_REST, max_cycles = LONGEST, every = 100, stop = function()
        return travel(blocks) > case.fallen
    end }
    return run.reason == "ratio"
end

local function failure(case, points, stiffness)
    local model, _, shape = case.build(points, stiffness)
    local rigid = case.rigid(shape)
    local value, stride = case.first, (rigid - case.first) / STRIDES
    if not stands(case, model, value) then
        return nil, rigid
    end
    for halving = 0, HALVINGS do
        while true do
            local trial = model:copy()
            if not stands(case, trial, value + stride) then
                break
            end
            model, value = trial, value + stride
            if halving > 0 then
                break
            end
        end
        stride = stride / 2
    end
    return value + stride, rigid
end

local names = #arg > 0 and arg or { "arch", "wall", "dome", "slope" }
for _, name in ipairs(names) do
    for _, points in ipairs { "consistent", "corners" } do
        for _, stiffness in ipairs(STIFFNESS) do
            local found, rigid = failure(CASES[name], points, stiffness)
            print(("%-6s %-10s kn %.0e  fails at %-8s rigid %-7.4g %s"):format(name, points, stiffness,
                found and ("%.4g"):format(found) or "first", rigid,
                found and ("%+.1f %%"):format(100 * (found / rigid - 1)) or ""))
            io.stdout:flush()
        end
    end
end
