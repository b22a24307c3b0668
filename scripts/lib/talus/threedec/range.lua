-- range.lua - reads what follows the word `range`, and writes it as a filter of Talus.
--
-- A range of 3DEC is a list of elements that must all hold, or with `union` one of them. Blocks and zones are asked by
-- their centroids, contacts and gridpoints by their places, as 3DEC does.
local lexer = require "talus.threedec.lexer"
local range = {}

local AXES = { x = 1, y = 2, z = 3 }

-- One table: the words of an element, and a function(c, a) that reads it and gives {kind =, ...}.
local elements = {}

local function element(words, read)
    for word in words:gmatch "%S+" do
        elements[#elements + 1] = word
        elements[word] = read
    end
end

for _, axis in ipairs { "x", "y", "z" } do
    local number = AXES[axis]
    element("position-" .. axis .. " " .. axis .. " " .. axis .. "range", function(c, a)
        local from = a:number "the range's beginning"
        local to = a:optional()
        return { kind = "axis", axis = number, from = from, to = to or from, about = not to }
    end)
end

element("position", function(c, a)
    return { kind = "box", from = a:vector "the first corner", to = a:vector "the second corner" }
end)
element("group", function(c, a)
    local names = { a:text "the group" }
    while a:take "or" do
        names[#names + 1] = a:text "the group"
    end
    if a:take "slot" then
        c.note("Talus has one group a block: the slot '" .. a:text "the slot" .. "' is not asked for")
    end
    return { kind = "group", names = names }
end)
element("group-intersection gintersection", function(c, a)
    return { kind = "between", a:text "the first group", a:text "the second group" }
end)
element("rintersection", function(c, a)
    local first, second = a:whole "the first region", a:whole "the second region"
    return { kind = "between", "region " .. first, "region " .. second }
end)
-- The n-th block that is made has the number n, in 3DEC and here, as long as none is cut.
local function numbered(c)
    if c.cuts then
        c.leave "numbers of blocks after cuts are 3DEC's own"
    end
end
element("id", function(c, a)
    numbered(c)
    local first = a:whole "the number"
    local last = a:sees_number() and a:whole "the last number" or first
    local ids = {}
    for id = first, math.min(last, first + 9999) do
        ids[#ids + 1] = id
    end
    return { kind = "ids", ids = ids }
end)
element("id-list", function(c, a)
    numbered(c)
    local ids = {}
    while a:sees_number() do
        ids[#ids + 1] = a:whole "the number"
    end
    return { kind = "ids", ids = ids }
end)
element("region", function(c, a)
    return { kind = "group", names = { "region " .. a:whole "the region's number" } }
end)
element("material bmaterial", function(c, a)
    return { kind = "material", material = a:whole "the material's number" }
end)
element("joint-set jset jointset", function(c, a)
    return { kind = "joint", joint = c.joint_name(a:whole "the joint set's number") }
end)
element("plane", function(c, a)
    local e = { kind = "plane", origin = { { lua = "0" }, { lua = "0" }, { lua = "0" } } }
    local dip, dd, normal
    while a:sees("dip", "dip-direction", "dd", "origin", "normal", "above", "below", "distance") do
        local word = a:take("dip", "dip-direction", "dd", "origin", "normal", "above", "below", "distance")
        if word == "dip" then
            dip = a:number "dip"
        elseif word == "dd" or word == "dip-direction" then
            dd = a:number "the dip direction"
        elseif word == "origin" then
            e.origin = a:vector "the origin"
        elseif word == "normal" then
            normal = a:vector "the normal"
        elseif word == "distance" then
            e.distance = a:number "the distance"
        else
            e.side = word
        end
    end
    if normal then
        e.dip, e.dip_direction, e.turned = c.plane_of_normal(normal)
    else
        e.dip, e.dip_direction, e.turned = c.plane(dip or { lua = "0", value = 0 }, dd or { lua = "0", value = 0 })
    end
    if e.turned and e.side then
        e.side = e.side == "above" and "below" or "above"
    end
    return e
end)
element("orientation", function(c, a)
    a:take "dip"
    local dip = a:number "the dip"
    a:take("dip-direction", "dd")
    local dd = a:number "the dip direction"
    a:take "tolerance"
    local within = a:optional() or { lua = "2", value = 2 }
    dip, dd = c.plane(dip, dd)
    return { kind = "orientation", dip = dip, dip_direction = dd, within = within }
end)
element("sphere", function(c, a)
    local e = { kind = "sphere" }
    while a:sees("center", "radius") do
        local word = a:take("center", "radius")
        e[word] = word == "center" and a:vector "the centre" or a:number "the radius"
    end
    if not e.center or not e.radius then
        lexer.mistake("%s: a sphere needs center and radius", a.command)
    end
    return e
end)
element("cylinder", function(c, a)
    local e = { kind = "cylinder" }
    while a:sees("end-1", "end-2", "end1", "end2", "radius") do
        local word = a:take("end-1", "end-2", "end1", "end2", "radius"):gsub("%-", "")
        e[word] = word == "radius" and a:number "the radius" or a:vector "an end"
    end
    if not e.end1 or not e.end2 or not e.radius then
        lexer.mistake("%s: a cylinder needs end-1, end-2 and radius", a.command)
    end
    e.inner = a:optional()
    return e
end)
element("volume", function(c, a)
    return { kind = "volume", from = a:number "the least volume", to = a:number "the largest volume" }
end)

-- One name, or several: then what is in one of these ranges.
element("name named-range nrange", function(c, a)
    local list = { union = true }
    repeat
        local name = a:text "the range's name"
        local inner = c.named_ranges[name:lower()]
        if not inner then
            lexer.mistake("%s: there is no range of the name '%s'", a.command, name)
        end
        list[#list + 1] = { kind = "named", range = inner }
        local token = a:peek()
    until not token or not c.named_ranges[token.text:lower()]
    return #list == 1 and list[1] or { kind = "named", range = list }
end)
element("jmodel", function(c, a)
    return { kind = "law", law = c.law_of(a:text "the joint model", a.command) }
end)
element("all", function()
    return { kind = "all" }
end)

local MODIFIERS = { "union", "not", "by", "extent", "or", "and", "use-hidden", "matches" }
local KNOWN = table.move(MODIFIERS, 1, #MODIFIERS, #elements + 1, table.move(elements, 1, #elements, 1, {}))

-- Elements of 3DEC that have no counterpart.
local LACKS = { "annulus", "aspect-ratio", "component-id", "concave", "deformable", "dfn", "displacement", "edge-length",
    "ellipse", "excavated", "extra", "face-area", "fish", "fracture-id", "geometry-distance", "geometry-space", "leader-id",
    "mintersection", "polygon", "rectangle", "selected", "state", "surface", "velocity", "wall", "jmaterial", "sregion" }
table.move(LACKS, 1, #LACKS, #KNOWN + 1, KNOWN)

-- The range that follows, to the end of the command; nil when there is none.
function range.read(c, a)
    if not a:more() then
        return nil
    end
    if not a:take "range" then
        lexer.mistake("%s: '%s' is not expected", a.command, a:peek() and a:peek().text or "a number")
    end
    local list, negate = { }, false
    while a:more() do
        local word = a:keyword(KNOWN)
        if word == "not" then
            negate = true
        elseif word == "union" then
            list.union = true
        elseif word == "by" then
            a:text "the kind of object"
        elseif word == "extent" then
            c.note "extent: Talus asks for centroids, not for all corners"
        elseif word == "matches" then
            a:whole "the number of matches"
        elseif elements[word] then
            local e = elements[word](c, a)
            e.negate, negate = negate, false
            list[#list + 1] = e
        elseif word ~= "or" and word ~= "and" and word ~= "use-hidden" then
            c.leave("Talus has no range by " .. word)
        end
    end
    return list
end

-- ---------------------------------------------------------------- as a condition in Lua ---

-- What is asked of an item of each kind: the variable's name, its place, and how it has a group.
local kinds = {
    block = { name = "b", place = "b.centroid" },
    zone = { name = "z", place = "z.centroid" },
    gridpoint = { name = "p", place = "p.position" },
    contact = { name = "c", place = "c.point" },
}

local function between(place, axis, e)
    local at = ("%s[%d]"):format(place, axis)
    if e.about then
        return ("math.abs(%s%s) < 1e-6"):format(at, e.from.value == 0 and "" or " - " .. (e.from.level < 2 and "(" .. e.from.lua .. ")" or e.from.lua))
    end
    local from, to = e.from, e.to
    if from.value > to.value then
        from, to = to, from
    end
    return ("%s <= %s and %s <= %s"):format(from.lua, at, at, to.lua)
end

local function same(kind, field, value)
    if kind.name ~= "c" then
        return ("%s.%s == %q"):format(kind.name, field, value)
    end
    return ("(c.blocks[1].%s == %q or c.blocks[2].%s == %q)"):format(field, value, field, value)
end

local condition

local writers = {}

function writers.all()
    return "true"
end

function writers.axis(e, kind)
    return between(kind.place, e.axis, e)
end

function writers.box(e, kind)
    local parts = {}
    for axis = 1, 3 do
        parts[axis] = between(kind.place, axis, { from = e.from[axis], to = e.to[axis] })
    end
    return table.concat(parts, " and ")
end

function writers.group(e, kind)
    local parts = {}
    for i, name in ipairs(e.names) do
        parts[i] = same(kind, "group", name)
    end
    return #parts == 1 and parts[1] or "(" .. table.concat(parts, " or ") .. ")"
end

function writers.ids(e, kind, c)
    if kind.name ~= "b" then
        c.leave "numbers of 3DEC are those of blocks here only"
    end
    local parts = {}
    for i, id in ipairs(e.ids) do
        parts[i] = "b.id == " .. id
    end
    return #parts == 1 and parts[1] or "(" .. table.concat(parts, " or ") .. ")"
end

-- The material of a block is what the last command that gave it one says: an expression of the ranges of all of them.
function writers.material(e, kind, c)
    local text = e.material == 1 and "true" or "false"
    for _, change in ipairs(c.materials.changes) do
        local holds = change.range and condition(change.range, kind, c) or "true"
        local is = change.material == e.material
        text = is and ("(%s or %s)"):format(holds, text) or ("(not (%s) and %s)"):format(holds, text)
    end
    return text
end

function writers.joint(e, kind, c)
    if kind.name ~= "c" then
        c.leave "a range by joint set is for contacts"
    end
    return ('c.joint:match "^%s:"'):format(e.joint)
end

function writers.between(e, kind, c)
    if kind.name ~= "c" then
        c.leave "a range between two groups is for contacts"
    end
    return ("(c.blocks[1].group == %q and c.blocks[2].group == %q or c.blocks[1].group == %q and c.blocks[2].group == %q)")
        :format(e[1], e[2], e[2], e[1])
end

function writers.law(e, kind, c)
    if kind.name ~= "c" then
        c.leave "a range by joint model is for contacts"
    end
    return ("c.law == %q"):format(e.law)
end

-- Height of a place above a plane.
local function height(e, kind, c)
    c.use "height"
    return ("height(%s, %s, %s, %s)"):format(kind.place, e.dip.lua, e.dip_direction.lua, c.list(e.origin))
end

function writers.plane(e, kind, c)
    local text = height(e, kind, c)
    if e.distance then
        return ("math.abs(%s) <= %s"):format(text, e.distance.lua)
    end
    return ("%s %s 0"):format(text, e.side == "below" and "<" or ">")
end

function writers.orientation(e, kind, c)
    if kind.name ~= "c" then
        c.leave "a range by orientation is for contacts"
    end
    c.use "normal_of"
    c.use "angle"
    return ("angle(c.normal, normal_of(%s, %s)) <= %s"):format(e.dip.lua, e.dip_direction.lua, e.within.lua)
end

function writers.sphere(e, kind, c)
    c.use "distance"
    return ("distance(%s, %s) <= %s"):format(kind.place, c.list(e.center), e.radius.lua)
end

function writers.cylinder(e, kind, c)
    c.use "distance"
    c.use "off_axis"
    local call = ("off_axis(%s, %s, %s)"):format(kind.place, c.list(e.end1), c.list(e.end2))
    local text = call .. " <= " .. e.radius.lua
    return e.inner and ("%s and %s >= %s"):format(text, call, e.inner.lua) or text
end

function writers.volume(e, kind, c)
    if kind.name ~= "b" then
        c.leave "a range by volume is for blocks"
    end
    return ("%s <= b.volume and b.volume <= %s"):format(e.from.lua, e.to.lua)
end

function writers.named(e, kind, c)
    return "(" .. condition(e.range, kind, c) .. ")"
end

function condition(list, kind, c)
    local parts = {}
    for i, e in ipairs(list) do
        local text = writers[e.kind](e, kind, c)
        parts[i] = e.negate and "not (" .. text .. ")" or list.union and "(" .. text .. ")" or text
    end
    return #parts == 0 and "true" or table.concat(parts, list.union and " or " or " and ")
end

-- The condition as a function of a block, contact, zone or gridpoint.
function range.predicate(list, kind, c)
    return ("function(%s) return %s end"):format(kinds[kind].name, condition(list, kinds[kind], c))
end

-- The range with named ones that hold all of theirs written out.
local function flat(list)
    local all = { union = list.union }
    for _, e in ipairs(list) do
        if e.kind == "named" and not e.negate and not list.union and not e.range.union then
            table.move(flat(e.range), 1, #e.range, #all + 1, all)
        elseif e.kind ~= "all" or list.union or e.negate then
            all[#all + 1] = e
        end
    end
    return all
end
range.flat = flat

-- The text of a filter of model:blocks, model:zones or model:gridpoints, as `{ group = "base" }`.
function range.filter(list, kind, c)
    if not list then
        return "{}"
    end
    list = flat(list)
    if list.union and #list > 1 then
        return "{ where = " .. range.predicate(list, kind, c) .. " }"
    end
    local keys, rest = {}, {}
    local used = {}
    for _, e in ipairs(list) do
        local key
        if e.negate or used[e.kind] then
            key = nil
        elseif e.kind == "group" and #e.names == 1 then
            key = ("group = %q"):format(e.names[1])
        elseif e.kind == "ids" and kind == "block" then
            key = "id = " .. (#e.ids == 1 and e.ids[1] or "{ " .. table.concat(e.ids, ", ") .. " }")
        elseif e.kind == "box" and kind ~= "contact" then
            key = ("inside = { min = %s, max = %s }"):format(c.list(c.low(e.from, e.to)), c.list(c.high(e.from, e.to)))
        elseif e.kind == "plane" and kind == "block" and not e.distance then
            key = ("%s = { dip = %s, dip_direction = %s, origin = %s }"):format(e.side or "above", e.dip.lua,
                e.dip_direction.lua, c.list(e.origin))
        end
        if key then
            keys[#keys + 1] = key
            used[e.kind] = true
        else
            rest[#rest + 1] = e
        end
    end
    if #rest > 0 then
        keys[#keys + 1] = "where = " .. range.predicate(rest, kind, c)
    end
    return #keys == 0 and "{}" or "{ " .. table.concat(keys, ", ") .. " }"
end

-- The box {min, max} of a range of positions only, for faces; nil when it holds other elements.
function range.box(list)
    local low, high = {}, {}
    for _, e in ipairs(flat(list)) do
        if e.negate or list.union or e.kind ~= "axis" and e.kind ~= "box" then
            return nil
        end
        for axis = 1, 3 do
            local from = e.kind == "box" and e.from[axis] or e.axis == axis and e.from
            local to = e.kind == "box" and e.to[axis] or e.axis == axis and e.to
            if from then
                low[axis], high[axis] = from.value <= to.value and from or to, from.value <= to.value and to or from
            end
        end
    end
    local far = 1e9 -- beyond any model
    for axis = 1, 3 do
        low[axis] = low[axis] or { lua = "-1e9", value = -far }
        high[axis] = high[axis] or { lua = "1e9", value = far }
    end
    return low, high
end

range.elements = elements
range.lacks = LACKS
return range
