-- words_shapes.lua - commands that make, cut, join, hide, delete and name blocks.
local range = require "talus.threedec.range"
local lexer = require "talus.threedec.lexer"

-- The parameters every block has: density and group.
local function common(c, options)
    local group = options.group or options.region and "region " .. options.region
    return ("density = %s%s"):format(c.density(options.material), group and (", group = %q"):format(group) or "")
end

local function make(c, generator, shape, options)
    c.emit(("model:generate(%q, { %s, %s })"):format(generator, shape, common(c, options)))
    if options.material and options.material ~= 1 then
        c.note("material " .. options.material .. " of the block: give it by `change mat` with a range")
    end
end

local OPTIONS = { "group", "slot", "region", "material", "constitutive", "joint-set", "wall", "join" }

-- Reads what may stand before or after a shape.
local function option(c, a, options, word)
    if word == "group" then
        options.group = a:text "the group"
    elseif word == "slot" then
        c.note("Talus has one group a block: the slot '" .. a:text "the slot" .. "' is dropped")
    elseif word == "region" then
        options.region = a:whole "the region's number"
        c.regions = true
    elseif word == "material" then
        options.material = a:whole "the material's number"
    elseif word == "constitutive" then
        a:whole "the number of the constitutive law"
    elseif word == "wall" then
        a:switch()
        c.note "walls are blocks here: hold them by fix"
    elseif word == "join" then
        c.note "join the blocks by `join` with a range"
    else
        while a:sees_number() do
            a:number "the joint set"
        end
    end
end

local shapes = {}

function shapes.brick(c, a, options)
    local x1, x2 = a:number "x1", a:number "x2"
    local y1, y2 = a:optional(), a:optional()
    local z1, z2 = a:optional(), a:optional()
    y1, y2 = y1 or x1, y2 or x2
    z1, z2 = z1 or x1, z2 or x2
    local from, to = { x1, y1, z1 }, { x2, y2, z2 }
    return "box", ("min = %s, max = %s"):format(c.list(c.low(from, to)), c.list(c.high(from, to)))
end

local function points(c, list)
    local texts = {}
    for i, v in ipairs(list) do
        texts[i] = c.list(v)
    end
    return "{ " .. table.concat(texts, ", ") .. " }"
end

-- A polyhedron given by its faces: the convex hull of their corners, each named once.
function shapes.face(c, a, options)
    local corners, seen = {}, {}
    repeat
        while a:sees("joint-set", "face-group", "id", "slot") do
            a:take("joint-set", "face-group", "id", "slot")
            a:text "a name"
        end
        for _, v in ipairs(a:vectors("a face", 3)) do
            local key = ("%.17g %.17g %.17g"):format(v[1].value, v[2].value, v[3].value)
            if not seen[key] then
                seen[key] = true
                corners[#corners + 1] = v
            end
        end
    until not a:take "face"
    return "polyhedron", "vertices = " .. points(c, corners)
end

function shapes.polyhedron(c, a, options)
    while not a:take "face" do
        if not a:more() then
            lexer.mistake("%s: a polyhedron needs faces", a.command)
        end
        option(c, a, options, a:keyword(OPTIONS))
    end
    return shapes.face(c, a, options)
end

local function difference(a, b)
    return { b[1].value - a[1].value, b[2].value - a[2].value, b[3].value - a[3].value }
end

-- Whether a polygon is flat and convex, as far as its digits tell: what the generator of prisms asks for.
local function is_convex(list)
    local n, size, count = { 0, 0, 0 }, 0, #list
    local function edge(i)
        return difference(list[(i - 1) % count + 1], list[i % count + 1])
    end
    local function cross(u, v)
        return { u[2] * v[3] - u[3] * v[2], u[3] * v[1] - u[1] * v[3], u[1] * v[2] - u[2] * v[1] }
    end
    local function dot(u, v)
        return u[1] * v[1] + u[2] * v[2] + u[3] * v[3]
    end
    for i = 1, count do
        local area = cross(difference(list[1], list[i]), edge(i))
        n = { n[1] + area[1], n[2] + area[2], n[3] + area[3] }
        size = math.max(size, dot(edge(i), edge(i)) ^ 0.5)
    end
    local length = dot(n, n) ^ 0.5
    for i = 1, count do
        if dot(cross(edge(i), edge(i + 1)), n) < -1e-9 * size ^ 2 * length or
            math.abs(dot(difference(list[1], list[i]), n)) > 1e-7 * size * length then
            return false
        end
    end
    return true
end

function shapes.prism(c, a, options)
    local ends = {}
    while a:sees("face-1", "face-2", "a", "b", "nonplanar", "table-1") do
        local word = a:take("face-1", "face-2", "a", "b", "nonplanar", "table-1")
        if word == "table-1" then
            c.leave "a prism of tables is not converted"
        elseif word == "nonplanar" then
            a:switch()
        else
            ends[(word == "face-1" or word == "a") and 1 or 2] = a:vectors("an end of the prism", 3)
        end
    end
    if not ends[1] or not ends[2] or #ends[1] ~= #ends[2] then
        lexer.mistake("%s: a prism needs two ends with as many points", a.command)
    end
    if not is_convex(ends[1]) or not is_convex(ends[2]) then
        c.note "an end of the prism is not flat and convex: it is the convex hull of its corners"
        return "polyhedron", "vertices = " .. points(c, table.move(ends[2], 1, #ends[2], #ends[1] + 1, ends[1]))
    end
    return "prism", ("base = %s, top = %s"):format(points(c, ends[1]), points(c, ends[2]))
end

function shapes.tetrahedron(c, a, options)
    local list = a:vectors("a tetrahedron", 4)
    return "tetrahedron", "vertices = " .. points(c, list)
end

function shapes.drum(c, a, options)
    local given = {}
    local known = { "center-1", "center-2", "radius-1", "radius-2", "edges", "angle" }
    while a:sees(table.unpack(known)) do
        local word = a:take(table.unpack(known))
        given[word] = word:match "center" and a:vector "the centre" or a:number(word)
    end
    local from, to, r = given["center-1"], given["center-2"], given["radius-1"]
    if not from or not to or not r or not given.edges then
        lexer.mistake("%s: a drum needs center-1, center-2, radius-1 and edges", a.command)
    elseif given["radius-2"] and given["radius-2"].value ~= r.value then
        c.leave "a drum of two radii is not converted; a prism is"
    end
    local d = difference(from, to)
    local middle = {}
    for i = 1, 3 do
        middle[i] = c.value(from[i].value + d[i] / 2)
    end
    c.note "where its corners lie about the axis is Talus's choice"
    return "drum", ("center = %s, axis = { %s, %s, %s }, radius = %s, height = %s, sides = %s"):format(c.list(middle),
        c.value(d[1]).lua, c.value(d[2]).lua, c.value(d[3]).lua, r.lua,
        c.value((d[1] ^ 2 + d[2] ^ 2 + d[3] ^ 2) ^ 0.5).lua, given.edges.lua)
end

-- What follows `block create` or `poly`: options and one shape in any order.
local function create(shape)
    return function(c, a)
        local options, generator, text = {}, nil, nil
        if shape then
            generator, text = shapes[shape](c, a, options)
        end
        while not a:at_range() do
            local word = a:keyword { "group", "slot", "region", "material", "constitutive", "joint-set", "wall", "join", "brick",
                "face", "polyhedron", "prism", "tetrahedron", "drum", "tunnel", "cube" }
            if word == "tunnel" then
                c.leave "a ready tunnel of annular blocks is not converted"
            elseif word == "cube" then
                generator, text = shapes.brick(c, a, options)
            elseif shapes[word] then
                generator, text = shapes[word](c, a, options)
            else
                option(c, a, options, word)
            end
        end
        if not generator then
            lexer.mistake("%s: a shape is missing: brick, face, prism, tetrahedron or drum", a.command)
        end
        make(c, generator, text, options)
    end
end

-- A cut of the visible blocks of a range: the others are hidden meanwhile.
local function within_range(c, a, code)
    local list = range.read(c, a)
    if list then
        code = ("do\n    local others = model:blocks { where = function(b) return not (%s)(b) end }:hide()\n    %s\n    others:show()\nend")
            :format(range.predicate(list, "block", c), code)
    end
    c.emit(code)
    c.cuts = true
end

local function joint_set(c, a)
    local g = { number = { lua = "1", value = 1 } }
    local zero = { lua = "0", value = 0 }
    local known = { "dip", "dip-direction", "dd", "origin", "org", "spacing", "number", "persistence", "id", "jointset-id",
        "join", "material", "minimum-id", "deviation" }
    while not a:at_range() do
        local word = a:keyword(known)
        if word == "dip" or word == "dip-direction" or word == "dd" or word == "spacing" then
            word = word == "dd" and "dip-direction" or word
            g[word] = a:number(word)
            g[word .. " deviation"] = a:optional()
        elseif word == "origin" or word == "org" then
            g.origin = a:vector "the origin"
        elseif word == "number" or word == "persistence" then
            g[word] = a:number(word)
            a:optional()
        elseif word == "id" or word == "jointset-id" then
            g.id = a:whole "the number of the joint set"
        elseif word == "join" then
            c.note "its blocks are not joined across the cuts: `join` with a range does that"
        else
            c.note("'" .. word .. "' has no counterpart")
            a:text(word)
        end
    end
    local dip, dd = c.plane(g.dip or zero, g["dip-direction"] or zero)
    local parts = { ("joint = %q, dip = %s, dip_direction = %s"):format(c.new_joint(g.id), dip.lua, dd.lua) }
    local single = g.number.value == 1 and not g["dip deviation"] and not g["dip-direction deviation"]
    if not single then
        local function add(name, item)
            if item and item.value ~= 0 then
                parts[#parts + 1] = name .. " = " .. item.lua
            end
        end
        add("dip_dev", g["dip deviation"])
        add("dip_direction_dev", g["dip-direction deviation"])
        add("spacing", g.spacing or { lua = "1", value = 1 })
        add("spacing_dev", g["spacing deviation"])
        add("number", g.number)
    end
    parts[#parts + 1] = "origin = " .. c.list(g.origin or { zero, zero, zero })
    if g.persistence and g.persistence.value < 1 then
        parts[#parts + 1] = "persistence = " .. g.persistence.lua
    end
    within_range(c, a, ("model:generate(%q, { %s })"):format(single and "joint" or "jointset", table.concat(parts, ", ")))
end

local function tunnel(c, a)
    local ends, options = {}, {}
    local known = { "face-1", "face-2", "a", "b", "radial", "group", "slot", "region", "table-1", "id", "tangential" }
    while not a:at_range() do
        local word = a:keyword(known)
        if word == "table-1" then
            c.leave "a tunnel of tables is not converted"
        elseif word == "group" or word == "slot" or word == "region" then
            option(c, a, options, word)
        elseif word == "id" then
            a:text "the number"
        elseif word ~= "radial" and word ~= "tangential" then
            ends[(word == "face-1" or word == "a") and 1 or 2] = a:vectors("an end of the tunnel", 3)
        end
    end
    if not ends[1] or not ends[2] or #ends[1] ~= #ends[2] then
        lexer.mistake("%s: a tunnel needs two ends with as many points", a.command)
    end
    local group = options.group or options.region and "region " .. options.region or "tunnel"
    within_range(c, a, ('model:generate("tunnel", { face1 = %s, face2 = %s, group = %q })'):format(points(c, ends[1]),
        points(c, ends[2]), group))
end

-- A method of the selection of the range's blocks.
local function method(call)
    return function(c, a)
        c.emit(c.blocks(range.read(c, a)) .. ":" .. call)
    end
end

local function group(c, a)
    a:take("block", "zone")
    local name = a:text "the group"
    if a:take "slot" then
        local slot = a:text "the slot"
        if slot:lower() ~= "default" then
            c.note("Talus has one group a block: the slot '" .. slot .. "' is dropped")
        end
    end
    if a:take "remove" then
        c.leave "a group cannot be taken off a block; give it another one"
    end
    local list = range.read(c, a)
    if c.regions then
        c.note "Talus has one group a block: those that get this one are no longer found by their region"
    end
    c.emit(("%s:set { group = %q }"):format(c.blocks(list), name))
end

return function(row)
    row("block create brick", { form = "x1 x2 [y1 y2 [z1 z2]] [group s]", becomes = 'model:generate("box", {...})',
        example = { "block create brick 0 1 0 2 0 3 group 'stone'", "block cre bri -1 1" }, convert = create "brick" })
    row("block create polyhedron", { form = "[group s] face v v v ... face ...",
        becomes = 'model:generate("polyhedron", {...}), the convex hull of the corners',
        example = "block create polyhedron face 0,0,0 1,0,0 0,1,0 face 0,0,0 0,0,1 1,0,0 face 0,0,0 0,1,0 0,0,1 ...\n" ..
            "  face 1,0,0 0,0,1 0,1,0", convert = create "polyhedron" })
    row("block create prism", { form = "face-1 v v v ... face-2 v v v ...", becomes = 'model:generate("prism", {...})',
        example = "block create prism face-1 (0,0,0) (2,0,0) (0,2,0) face-2 (0,0,1) (2,0,1) (0,2,1)", convert = create "prism" })
    row("block create tetrahedron", { form = "v v v v", becomes = 'model:generate("tetrahedron", {...})',
        example = "block create tetra 0 0 0 1 0 0 0 1 0 0 0 1", convert = create "tetrahedron" })
    row("block create drum", { form = "center-1 v center-2 v radius-1 f edges i", becomes = 'model:generate("drum", {...})',
        example = "block create drum center-1 0 0 0 center-2 0 0 2 radius-1 1 radius-2 1 edges 8", convert = create "drum" })
    row("block create", { form = "other shapes", becomes = "as above", convert = create() })
    row("polyhedron", { form = "[region i] [mat i] brick x1 x2 y1 y2 z1 z2 | face v v v ... | prism a v v ... b v v ...",
        becomes = 'model:generate("box", {...}), "polyhedron", "prism"',
        example = { "poly brick (0,1) (0,2) (0,3)", "poly reg=2 mat=1 prism a (0,0,0) (2,0,0) (0,2,0) &\n b (0,0,1) (2,0,1) (0,2,1)",
            "poly face 0 0 0 1 0 0 0 1 0 face 0 0 0 0 0 1 1 0 0 face 0 0 0 0 1 0 0 0 1 face 1 0 0 0 0 1 0 1 0" },
        convert = create() })
    row("block cut joint-set|jset", { form = "dip f [dev] dip-direction f [dev] origin v [spacing f] [number i] [persistence f] " ..
        "[jointset-id i]", becomes = 'model:generate("joint", {...}), of several planes "jointset"',
        example = { "block cut joint-set dip 30 dip-direction 90 origin 0.5 0.5 0.5 spacing 0.2 number 3",
            "jset dip=100 dd=45 org=(0.5,0.5,0.5) id=7" }, convert = joint_set })
    row("block cut tunnel|tunnel", { form = "face-1 v v ... face-2 v v ... [group s] (a v v ... b v v ... [region i])",
        becomes = 'model:generate("tunnel", {...})',
        example = { "block cut tunnel face-1 .2 -1 .2 .8 -1 .2 .5 -1 .8 face-2 .2 2 .2 .8 2 .2 .5 2 .8 group 'drift'",
            "tunnel reg 5 a (.2 -1 .2) (.8 -1 .2) (.5 -1 .8) b (.2 2 .2) (.8 2 .2) (.5 2 .8)" }, convert = tunnel })
    row("block cut", { lacks = "cuts by geometry sets and fracture networks; generate{\"joint\"} cuts by planes and discs" })
    row("block hide", { form = "[off] [range]", becomes = "selection:hide()", example = "block hide range group 'stone'",
        convert = function(c, a)
            local off = a:take("off", "remove", "undo") ~= nil
            a:take "on"
            local list = range.read(c, a)
            c.emit(off and c.blocks(list, "hidden = true") .. ":show()" or c.blocks(list) .. ":hide()")
        end })
    row("hide", { form = "[range]", becomes = "selection:hide()", example = "hide range x 0 1", convert = method "hide()" })
    row("block show|show|seek", { form = "[range]", becomes = "selection:show()", example = { "hide range x 0 1\nseek" },
        convert = function(c, a)
            c.emit(c.blocks(range.read(c, a), "hidden = true") .. ":show()")
        end })
    row("block join|join", { form = "[on | off] [range]", becomes = "selection:join(), selection:unjoin()",
        example = { "block join on range position-z 0 1", "join off" },
        convert = function(c, a)
            local on = a:switch(true)
            c.emit(c.blocks(range.read(c, a)) .. (on and ":join()" or ":unjoin()"))
        end })
    row("block delete|delete|remove|block excavate|excavate", { form = "[range]", becomes = "selection:delete()",
        example = "block delete range group 'drift'", convert = method "delete()" })
    row("block group|group", { form = "s [slot s] [range]", becomes = 'selection:set{group = "..."}',
        example = { "block group 'base' range position-z -1 0.5", "group block base range z -1 0.5" }, convert = group })
    row("mark", { form = "region i [range]", becomes = 'selection:set{group = "region i"}', example = "mark region 3 range x 0 1",
        convert = function(c, a)
            a:keyword { "region" }
            c.regions = true
            local number = a:whole "the region's number"
            c.emit(("%s:set { group = %q }"):format(c.blocks(range.read(c, a)), "region " .. number))
        end })
    row("model range create|range", { form = "s elements | name s elements", becomes = "written out where it is used",
        example = { "model range create 'low' position-z 0 0.5\nblock group 'base' range named-range 'low'",
            "range name low z 0 0.5\nhide range name low" },
        convert = function(c, a)
            a:take "name"
            local name = a:text "the range's name"
            table.insert(a.tokens, a.at, { kind = "word", text = "range" })
            c.named_ranges[name:lower()] = range.read(c, a)
            c.nothing = true
        end })
    row("block generate|generate from-vrml", { lacks = 'files are read by generate("import", {file = ...})' })
end
