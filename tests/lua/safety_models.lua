-- safety_models.lua - random wedges and slopes whose factors of safety are looked for: in other units, places, attitudes, orders and on
-- more threads the factor is the same.
local talus = require "talus"
local shapes = require "shapes"

local models = {}

local NONE = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
local DENSITY, GRAVITY = 2000, 10
local APEX = { 0, 0.5, 1 } -- of a wedge: where its planes meet the top of the box
local DRAIN_GAP = 0.05     -- m

-- The upward normal of an attitude {dip, dip direction}, degrees.
local function normal_of(attitude)
    local dip, direction = math.rad(attitude[1]), math.rad(attitude[2])
    return { math.sin(dip) * math.sin(direction), math.sin(dip) * math.cos(direction), math.cos(dip) }
end

-- What a form makes of the model's own metres: `matrix` turns it, `shift` m moves it, then lengths are measured in units of `length` m
-- and forces in units of `force` N. Seconds stay.
local function view_of(form)
    local matrix, shift, length, force = form.matrix or NONE, form.shift or { 0, 0, 0 }, form.length or 1, form.force or 1
    local view = {}
    function view.point(p)
        local q = shapes.sum(shapes.apply(matrix, p), 1, shift)
        return { q[1] / length, q[2] / length, q[3] / length }
    end
    function view.acceleration(a)
        return shapes.apply(matrix, { a[1] / length, a[2] / length, a[3] / length })
    end
    function view.force(f)
        return shapes.apply(matrix, { f[1] / force, f[2] / force, f[3] / force })
    end
    function view.stress(s)
        return s * length ^ 2 / force
    end
    function view.stiffness(k)
        return k * length ^ 3 / force
    end
    view.density = DENSITY * length ^ 4 / force
    -- The plane of a normal through a point, both in the model's own axes.
    function view.plane(normal, origin)
        local n = shapes.apply(matrix, normal)
        if n[3] < 0 then
            n = { -n[1], -n[2], -n[3] }
        end
        return { dip = math.deg(math.atan(math.sqrt(n[1] ^ 2 + n[2] ^ 2), n[3])),
            dip_direction = math.deg(math.atan(n[1], n[2])) % 360, origin = view.point(origin) }
    end
    -- How far a point of the turned model lies above a plane, m.
    function view.above(p, normal, origin)
        local o = view.point(origin)
        return shapes.dot({ p[1] - o[1], p[2] - o[2], p[3] - o[3] }, shapes.apply(matrix, normal)) * length
    end
    return view
end

local function box(model, view, low, high)
    local corners = {}
    for i = 0, 7 do
        corners[#corners + 1] = view.point { i % 2 == 0 and low[1] or high[1], i // 2 % 2 == 0 and low[2] or high[2],
            i // 4 == 0 and low[3] or high[3] }
    end
    model:generate("polyhedron", { vertices = corners, density = view.density })
end

local function cut(model, view, name, normal, origin)
    local plane = view.plane(normal, origin)
    model:generate("joint", { joint = name, dip = plane.dip, dip_direction = plane.dip_direction, origin = plane.origin })
end

-- ------------------------------------------------------------ wedges

-- What makes up a random wedge. `water` is a share of the pressure of a column of water as high as the wedge.
function models.draw_wedge(seed)
    local draw = shapes.random(seed)
    local one = { A = { draw(35, 75), draw(100, 160) }, B = { draw(35, 75), draw(200, 260) }, friction = {}, cohesion = {}, kn = 1e8,
        ks = 3e7 }
    for _, joint in ipairs { "A", "B" } do
        one.friction[joint] = draw(25, 50)
        one.cohesion[joint] = draw(0, 1) < 0.5 and draw(0, 4e3) or 0
    end
    one.push = { draw(-0.1, 0.1), draw(-0.1, 0.1), draw(-0.1, 0.1) } -- of the weight
    one.water = draw(0, 1) < 0.5 and { A = draw(0, 3e3), B = draw(0, 3e3) } or nil
    return one
end

-- Gives the model and its wedge. Where `form.turns`, the wedge may turn.
function models.wedge(one, form)
    form = form or {}
    local view = view_of(form)
    local model = talus.model { gravity = view.acceleration { 0, 0, -GRAVITY }, threads = form.threads }
    box(model, view, { -2, -1, -1 }, { 2, 1, 1 })
    local normal = { A = normal_of(one.A), B = normal_of(one.B) }
    for _, joint in ipairs(form.order or { "A", "B" }) do
        cut(model, view, joint, normal[joint], APEX)
    end
    local wedge = model:blocks():where(function(b)
        return view.above(b.centroid, normal.A, APEX) > 0 and view.above(b.centroid, normal.B, APEX) > 0
    end)
    model:blocks():fix()
    wedge:free()
    for _, joint in ipairs { "A", "B" } do
        model:joint(joint, "coulomb", { kn = view.stiffness(one.kn), ks = view.stiffness(one.ks), friction = one.friction[joint],
            cohesion = view.stress(one.cohesion[joint]) })
    end
    local length, force = form.length or 1, form.force or 1
    local weight = wedge[1].volume * length ^ 3 * DENSITY * GRAVITY -- N
    wedge:load { force = view.force { weight * one.push[1], weight * one.push[2], weight * one.push[3] } }
    if one.water then
        for joint, pressure in pairs(one.water) do
            if pressure > 0 then
                model:water("uniform", { pressure = view.stress(pressure), drain_gap = DRAIN_GAP / length, joints = { joint } })
            end
        end
    end
    if not form.turns then
        wedge:fix { rotation = true }
    end
    return model, wedge
end

-- ------------------------------------------------------------ slopes

-- Three joint sets in a box 12 m long; what lies before the face is deleted, and what reaches near bottom or rear is held.
function models.draw_slope(seed)
    local draw = shapes.random(1000 + seed)
    local function any(low, high)
        return { draw(low[1], high[1]), draw(low[2], high[2]) }
    end
    return { sets = {
        { name = "A", attitude = any({ 25, 70 }, { 50, 110 }), spacing = draw(2, 3) },
        { name = "B", attitude = any({ 60, 160 }, { 88, 200 }), spacing = draw(3, 4) },
        { name = "C", attitude = any({ 60, 250 }, { 88, 290 }), spacing = draw(2, 3) },
    }, friction = draw(35, 50), cohesion = draw(0, 1) < 0.5 and draw(0, 5e3) or 0, kn = 1e9, ks = 5e8 }
end

function models.slope(one, form)
    form = form or {}
    local view = view_of(form)
    local model = talus.model { gravity = view.acceleration { 0, 0, -GRAVITY }, threads = form.threads }
    box(model, view, { 0, 0, 0 }, { 12, 6, 8 })
    local cuts = {}
    for _, set in ipairs(one.sets) do
        local n = normal_of(set.attitude)
        for k = -4, 4 do
            cuts[#cuts + 1] = { set.name, n, shapes.sum({ 6.1, 3.2, 4.3 }, k * set.spacing, n) }
        end
    end
    local face, foot = { 0.9, 0, math.sqrt(1 - 0.81) }, { 8, 3, 2 }
    cuts[#cuts + 1] = { "face", face, foot }
    cuts[#cuts + 1] = { "floor", { 0, 0, 1 }, foot }
    for i = 1, #cuts do
        local c = cuts[form.backwards and #cuts + 1 - i or i]
        cut(model, view, c[1], c[2], c[3])
    end
    local function above(b, n, p)
        return view.above(b.centroid, n, p) > 0
    end
    model:blocks():where(function(b)
        return above(b, face, foot) and above(b, { 0, 0, 1 }, foot)
    end):delete()
    model:blocks():where(function(b)
        return not above(b, { 0, 0, 1 }, foot) or above(b, { -1, 0, 0 }, { 2, 0, 0 }) or above(b, { 0, 1, 0 }, { 0, 5, 0 })
            or above(b, { 0, -1, 0 }, { 0, 1, 0 })
    end):fix()
    model:joint("*", "coulomb", { kn = view.stiffness(one.kn), ks = view.stiffness(one.ks), friction = one.friction,
        cohesion = view.stress(one.cohesion) })
    return model
end

-- ------------------------------------------------------------ forms

-- The same model as others would have it. `exact`: the same bits are asked for.
function models.forms(seed)
    local draw = shapes.random(2000 + seed)
    return {
        { name = "in other units", length = 10 ^ draw(-3, 3), force = 10 ^ draw(-6, 6) },
        { name = "at another place", shift = { draw(-3e4, 3e4), draw(-3e4, 3e4), draw(-3e3, 3e3) } },
        { name = "in another attitude", matrix = shapes.attitude(draw), shift = { draw(-100, 100), draw(-100, 100), 0 } },
        { name = "cut in another order", order = { "B", "A" }, backwards = true },
        { name = "on 3 threads", threads = 3, exact = true },
    }
end

-- ------------------------------------------------------------ what forces can balance

-- The argument at which a concave function is largest, and its value there.
local function largest(f, low, high)
    local ratio = (math.sqrt(5) - 1) / 2
    local a, b = high - ratio * (high - low), low + ratio * (high - low)
    local fa, fb = f(a), f(b)
    for _ = 1, 26 do
        if fa < fb then
            low, a, fa = a, b, fb
            b = low + ratio * (high - low)
            fb = f(b)
        else
            high, b, fb = b, a, fa
            a = high - ratio * (high - low)
            fa = f(a)
        end
    end
    return math.max(fa, fb)
end

-- The largest factor F with which forces of any direction on planes A and B balance `force`: with outward normals n_i,
--
--     force = sum N_i n_i + t_i,   N_i >= 0,   t_i . n_i = 0,   |t_i| <= (N_i tan(friction_i) + c_i A_i) / F.
--
-- Limit equilibrium has both t_i along the line of both planes, against the motion; a wedge that is held may have others, so its factor
-- is between that and this one. `planes` is a list of two {normal =, area =, friction =, cohesion =}.
function models.balance(force, planes)
    local a, b = planes[1], planes[2]
    local size = shapes.length(force)
    local along = shapes.cross(a.normal, b.normal)
    along = shapes.sum({ 0, 0, 0 }, 1 / shapes.length(along), along)
    local across = shapes.cross(b.normal, along)
    local ca, cb = a.cohesion * a.area / size, b.cohesion * b.area / size
    local mu_a, mu_b = math.tan(math.rad(a.friction)), math.tan(math.rad(b.friction))
    local unit = shapes.sum({ 0, 0, 0 }, 1 / size, force)
    -- Strength that is left on A, over the force: concave in what B bears.
    local function left(F)
        return largest(function(normal)
            local most = (normal * mu_b + cb) / F
            return largest(function(x)
                local reach = math.sqrt(math.max(0, most ^ 2 - x ^ 2))
                return largest(function(y)
                    local rest = shapes.sum(shapes.sum(shapes.sum(unit, -normal, b.normal), -x, across), -y, along)
                    local n = shapes.dot(rest, a.normal)
                    return (n * mu_a + ca) / F - shapes.length(shapes.sum(rest, -n, a.normal)) + math.min(0, n) * 1e3
                end, -reach, reach)
            end, -most, most)
        end, 0, 2)
    end
    local low, high = 0.05, 20
    for _ = 1, 18 do
        local F = math.sqrt(low * high)
        if left(F) >= 0 then
            low = F
        else
            high = F
        end
    end
    return high
end

-- ------------------------------------------------------------ comparisons

local WEDGE_STEP, SLOPE_STEP = 0.005, 0.02 -- of the grid of factors
local AGREES = 0.0175  -- from limit equilibrium, 0.015, and half a step of the grid
local UNEQUAL = 0.3    -- of normal forces, from which on a wedge presses well on both planes
local BETWEEN = 0.004  -- of `models.balance` and of half a step of the grid
local SMALL = 0.1      -- m3, of blocks of a slope that go first

-- Planes of a wedge for `models.balance`.
local function planes_of(one, model, wedge)
    local planes, id = {}, wedge[1].id
    for i, joint in ipairs { "A", "B" } do
        local n, area = normal_of(one[joint]), 0
        for _, c in ipairs(model:contacts()) do
            if c.joint:match "^%a+" == joint and (c.blocks[1].id == id or c.blocks[2].id == id) then
                area = area + c.area
            end
        end
        planes[i] = { normal = { -n[1], -n[2], -n[3] }, area = area, friction = one.friction[joint], cohesion = one.cohesion[joint] }
    end
    return planes
end

-- Whether a factor agrees with the one of limit equilibrium, or lies between that and the largest with which forces balance at all.
local function agrees(one, model, wedge, key, r)
    local difference = r.factor / key.safety - 1
    if math.abs(difference) <= AGREES or (key.safety >= 10 and r.factor == math.huge) then
        return true
    end
    local forces = { key.faces[1].normal_force, key.faces[2] and key.faces[2].normal_force or 0 }
    local share = math.min(forces[1], forces[2]) / math.max(forces[1], forces[2])
    local most = models.balance(key.force, planes_of(one, model, wedge))
    return difference > 0 and r.factor <= most * (1 + BETWEEN) and share < UNEQUAL,
        string.format("limit equilibrium %.4f, divided strengths %.4f, largest that balances %.4f, normal forces 1 : %.3f", key.safety,
            r.factor, most, share)
end

-- Whether the factor of a model is the same in all forms, and asking leaves it as it is.
local function same(seed, build, options, model, r)
    for _, form in ipairs(models.forms(seed)) do
        local other = build(form)
        local before = other:state_hash()
        local given = { resolution = options.resolution, from = options.from, to = options.to,
            least_volume = options.least_volume and options.least_volume / (form.length or 1) ^ 3 }
        local s = other:factor_of_safety(given)
        if s.factor ~= r.factor or s.undecided ~= 0 or (form.exact and s.cycles ~= r.cycles) then
            return false, string.format("seed %d %s: factor %.5f in %d steps, not %.5f in %d (%s)", seed, form.name, s.factor, s.cycles,
                r.factor, r.cycles, s.message)
        end
        if other:state_hash() ~= before then
            return false, string.format("seed %d %s: the model has changed", seed, form.name)
        end
    end
    options.workers = 2
    local s = model:factor_of_safety(options)
    if s.factor ~= r.factor or s.cycles ~= r.cycles or s.message ~= r.message then
        return false, string.format("seed %d: '%s' with 2 workers, '%s' with one", seed, s.message, r.message)
    end
    return true
end

-- true, or false and why.
function models.compare_wedge(seed)
    local one = models.draw_wedge(seed)
    local function build(form)
        return models.wedge(one, form)
    end
    local model, wedge = build {}
    local options, before = { resolution = WEDGE_STEP }, model:state_hash()
    local key = model:keyblocks { friction = one.friction, cohesion = one.cohesion }[1]
    local r = model:factor_of_safety(options)
    if model:state_hash() ~= before then
        return false, string.format("seed %d: the model has changed", seed)
    end
    if r.undecided > 0 or not key or #wedge ~= 1 then
        return false, string.format("seed %d: undecided or no keyblock: %s", seed, r.message)
    end
    local good, why = agrees(one, model, wedge, key, r)
    if not good then
        return false, string.format("wedge %d: %s", seed, why)
    end
    return same(seed, build, options, model, r)
end

function models.compare_slope(seed)
    local one = models.draw_slope(seed)
    local function build(form)
        return models.slope(one, form)
    end
    local model = build {}
    local options = { from = 0.1, to = 20, resolution = SLOPE_STEP, least_volume = SMALL }
    return same(seed, build, options, model, model:factor_of_safety(options))
end

return models
