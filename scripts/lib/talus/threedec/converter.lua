-- converter.lua - what a conversion knows while it goes through a data file, and the lines that it writes.
--
-- A converter `c` has emit, note, leave and the rest that the rows of words.lua call. It keeps what Talus asks for at
-- another time than 3DEC: densities and laws of materials, rules of joints, zones that wait for their law.
local fish = require "talus.threedec.fish"
local helpers = require "talus.threedec.helpers"
local joints = require "talus.threedec.joints"
local lexer = require "talus.threedec.lexer"
local range = require "talus.threedec.range"
local converter = {}

-- Limit: locals of a script that FISH variables become; Lua has 200 in all. Later ones are written as numbers.
local MOST_LOCALS = 140

-- A number as a value of a script.
local function value(number)
    local text = math.type(number) == "integer" and tostring(number) or ("%.15g"):format(number):gsub(",", ".")
    return { lua = text, value = number, level = number < 0 and 3 or 9 }
end

local function list(items)
    local texts = {}
    for i, item in ipairs(items) do
        texts[i] = item.lua
    end
    return "{ " .. table.concat(texts, ", ") .. " }"
end

local function extreme(a, b, sign)
    local corner = {}
    for i = 1, 3 do
        corner[i] = sign * a[i].value <= sign * b[i].value and a[i] or b[i]
    end
    return corner
end

-- Dip, dip direction of the plane with this upward or downward normal, and whether it looks down.
local function plane_of(n)
    local length = (n[1] ^ 2 + n[2] ^ 2 + n[3] ^ 2) ^ 0.5
    if length == 0 then
        lexer.mistake "a normal must not be zero"
    end
    local turned = n[3] < -1e-12 * length
    local sign = turned and -1 or 1
    local x, y, z = sign * n[1] / length, sign * n[2] / length, sign * n[3] / length
    local dip = math.deg(math.acos(math.max(0, math.min(1, z))))
    local direction = math.deg(math.atan(x, y)) % 360
    local function tidy(angle)
        return value(tonumber(("%.10g"):format(angle)))
    end
    return tidy(dip), tidy(direction), turned
end

-- State that `model new` begins anew.
local function fresh(c)
    c.rules, c.joint_materials, c.drives, c.named_ranges = {}, {}, {}, c.named_ranges or {}
    c.materials = { properties = {}, changes = {} }
    c.zone = { waiting = {}, rules = {}, made = false }
    c.joints, c.joint_names, c.histories, c.history_interval = 0, {}, 0, "10"
    c.dynamic, c.scaled, c.driven, c.cuts, c.fixed_in_part = false, false, false, false, false
    c.current_density, c.blocks_made = nil, false
end

-- ---------------------------------------------------------------- writing ----------------

local function add_writing(c)
    function c.emit(code)
        local item = c.item
        item.code[#item.code + 1] = code
        c.blocks_made = c.blocks_made or code:match "^model:generate" ~= nil
    end

    -- Something of the command is lost.
    function c.note(reason)
        c.item.notes[#c.item.notes + 1] = reason
    end

    -- What a reader of the script should know; nothing is lost.
    function c.remark(text)
        c.item.remarks[#c.item.remarks + 1] = text
    end

    function c.leave(reason)
        lexer.leave("%s", reason)
    end

    function c.use(name)
        c.helpers[name] = true
        for _, other in ipairs(helpers.calls[name] or {}) do
            c.helpers[other] = true
        end
    end

    function c.restart()
        fresh(c)
        c.emit("model = " .. c.new_model)
    end
end

-- ---------------------------------------------------------------- values -----------------

local function add_values(c)
    c.value, c.list = value, list

    function c.low(a, b)
        return extreme(a, b, 1)
    end

    function c.high(a, b)
        return extreme(a, b, -1)
    end

    -- Dip and dip direction as Talus takes them, and whether above and below change places.
    function c.plane(dip, direction)
        if c.up == "z" and dip.value >= 0 and dip.value <= 90 and direction.value >= 0 and direction.value <= 360 then
            return dip, direction, false
        end
        local d, a = math.rad(dip.value), math.rad(direction.value)
        local flat_x, flat_y, up = math.sin(d) * math.sin(a), math.sin(d) * math.cos(a), math.cos(d)
        return plane_of(c.up == "z" and { flat_x, flat_y, up } or { flat_x, up, flat_y })
    end

    function c.plane_of_normal(n)
        return plane_of { n[1].value, n[2].value, n[3].value }
    end

    -- A FISH variable gets a value.
    function c.assign(name, item)
        if item.vector then
            lexer.leave "vectors in variables of FISH are not converted"
        end
        local lua = fish.name(name)
        local known = c.variables[lua]
        if known and known.lua == lua then
            c.emit(lua .. " = " .. item.lua)
        elseif not known and c.locals < MOST_LOCALS then
            c.locals = c.locals + 1
            c.emit("local " .. lua .. " = " .. item.lua)
        elseif type(item.value) == "number" then
            local literal = value(item.value)
            c.variables[lua] = literal
            c.nothing = true
            return
        end
        c.variables[lua] = { lua = lua, value = item.value, level = 9 }
    end

    -- Adds rows {time, value} to a table, sorted by time; a row takes the place of one of its time.
    function c.table_rows(name, rows)
        local known = c.tables[name]
        if not known and c.locals >= MOST_LOCALS then
            lexer.leave("more than %d variables and tables", MOST_LOCALS)
        end
        local all = known and known.rows or {}
        for _, row in ipairs(rows) do
            local at = 1
            while all[at] and all[at][1].value < row[1].value do
                at = at + 1
            end
            if all[at] and all[at][1].value == row[1].value then
                all[at] = row
            else
                table.insert(all, at, row)
            end
        end
        local texts = {}
        for i, row in ipairs(all) do
            texts[i] = list(row)
        end
        if not known then
            c.locals = c.locals + 1
            known = { rows = all, lua = "table_" .. name:lower():gsub("[^%w_]", "_") }
            for _, other in pairs(c.tables) do -- names that differ in signs only
                known.lua = other.lua == known.lua and known.lua .. "_" .. c.locals or known.lua
            end
        end
        c.emit(("%s%s = { %s }"):format(c.tables[name] and "" or "local ", known.lua, table.concat(texts, ", ")))
        c.tables[name] = known
    end

    -- Name of a new joint set: that of its number in 3DEC, or the next one.
    function c.new_joint(id)
        if not id then
            repeat
                c.joints = c.joints + 1
            until not c.joint_names[c.joints]
            id = c.joints
        end
        c.joint_names[id] = true
        return "J" .. id
    end

    function c.joint_name(id)
        if not c.joint_names[id] then
            lexer.leave("there is no joint set %d", id)
        end
        return "J" .. id
    end

    function c.law_of(word, command)
        return joints.law(c, word, command) == "elastic" and "elastic" or "coulomb"
    end

    function c.blocks(elements, extra)
        local filter = range.filter(elements, "block", c)
        if extra then
            filter = filter == "{}" and "{ " .. extra .. " }" or "{ " .. extra .. ", " .. filter:sub(3)
        end
        return "model:blocks " .. filter
    end
end

-- ---------------------------------------------------------------- materials --------------

local ZONE_PROPERTIES = { bulk = "bulk", shear = "shear", young = "young", poisson = "poisson", k = "bulk", g = "shear",
    cohesion = "cohesion", bcohesion = "cohesion", friction = "friction", phi = "friction", tension = "tension",
    dilation = "dilation", psi = "dilation" }

local function zone_part(properties)
    local part = {}
    for word, item in pairs(properties) do
        if ZONE_PROPERTIES[word] then
            part[ZONE_PROPERTIES[word]] = item
        end
    end
    return next(part) and part or nil
end

local function add_materials(c)
    -- Density of a block that is made now: what its material has, or else the first that the file names.
    function c.density(material)
        local own = c.materials.properties[material or 1]
        return own and own.density and own.density.lua or c.current_density or c.first_density
    end

    function c.set_density(item, elements)
        c.emit(c.blocks(elements) .. ":set { density = " .. item.lua .. " }")
        if not elements then
            c.current_density = item.lua
        end
    end

    -- `prop mat=number ...`: for the blocks that have the material now, and for those that get it later.
    function c.material(number, changes)
        local properties = c.materials.properties[number] or {}
        c.materials.properties[number] = properties
        for word, item in pairs(changes) do
            properties[word] = item
        end
        local some = #c.materials.changes > 0
        local elements = some and { { kind = "material", material = number } } or nil
        local used = number == 1 or some
        if changes.density and used and c.blocks_made then
            c.emit(c.blocks(elements) .. ":set { density = " .. changes.density.lua .. " }")
        end
        if zone_part(changes) and used then
            c.zone_properties(elements, zone_part(changes))
        end
        c.nothing = true
    end

    function c.change_material(number, elements)
        c.materials.changes[#c.materials.changes + 1] = { material = number, range = elements }
        local properties = c.materials.properties[number] or {}
        if properties.density then
            c.emit(c.blocks(elements) .. ":set { density = " .. properties.density.lua .. " }")
        end
        if zone_part(properties) and c.zoned() then
            c.zone_properties(elements, zone_part(properties))
        end
        c.nothing = true
    end
end

-- ---------------------------------------------------------------- zones ------------------

local function solid_text(rule)
    local p = rule.properties
    local parts = {}
    local function add(name, default)
        if p[name] or default then
            parts[#parts + 1] = name .. " = " .. (p[name] and p[name].lua or default)
        end
    end
    if p.bulk and p.shear then
        add "bulk"
        add "shear"
    elseif p.young and p.poisson then
        add "young"
        add "poisson"
    else
        return nil
    end
    if rule.kind ~= "elastic" then
        add("cohesion", "0")
        add("friction", "0")
        add("tension", "0")
        add "dilation"
    end
    return "{ " .. table.concat(parts, ", ") .. " }"
end

local function add_zones(c)
    -- Blocks are to have zones; they are made when the law of some is known.
    function c.zones(elements, edge)
        local zone = c.zone
        zone.waiting[#zone.waiting + 1] = { blocks = c.blocks(elements), edge = edge }
        c.remark "zones are made where their law is known"
        c.nothing = true
        for _, rule in ipairs(zone.rules) do
            c.write_zones(rule)
        end
    end

    function c.zoned()
        return c.zone.made or #c.zone.waiting > 0
    end

    local function rule_of(elements)
        local blocks = c.blocks(elements)
        for _, rule in ipairs(c.zone.rules) do
            if rule.blocks == blocks then
                return rule
            end
        end
        local rule = { blocks = blocks, all = not elements, kind = "elastic", properties = {} }
        local first = c.zone.rules[1]
        if first and first.all then
            rule.kind = first.kind
            for name, item in pairs(first.properties) do
                rule.properties[name] = item
            end
        end
        c.zone.rules[#c.zone.rules + 1] = rule
        rule.name = "zones " .. #c.zone.rules
        return rule
    end

    -- Names the solid of a rule when its properties are known, and gives it to zones.
    function c.write_zones(rule)
        local text, zone = solid_text(rule), c.zone
        if not text or not c.zoned() then
            c.nothing = true
            return
        end
        c.emit(("model:solid(%q, %q, %s)"):format(rule.name, rule.kind, text))
        for _, waiting in ipairs(zone.waiting) do
            c.emit(("%s:deformable { zone = %s, solid = %q }"):format(waiting.blocks, waiting.edge.lua, rule.name))
        end
        local new = #zone.waiting > 0
        zone.waiting, zone.made = {}, true
        if not rule.all and not (new and #zone.rules == 1) and not rule.given or rule.all and not new and not rule.given then
            c.emit(("%s:set { solid = %q }"):format(rule.blocks, rule.name))
        end
        rule.given = true
    end

    function c.zone_law(elements, kind)
        local rule = rule_of(elements)
        rule.kind = kind
        c.write_zones(rule)
    end

    function c.zone_properties(elements, changes)
        local rule = rule_of(elements)
        for name, item in pairs(changes) do
            if name == "density" then
                c.set_density(item, elements)
            else
                rule.properties[name] = item
            end
        end
        c.write_zones(rule)
    end

    -- Before stress, loads and runs.
    function c.zones_needed()
        if #c.zone.waiting > 0 then
            c.note "blocks are rigid still: zones have no elastic properties yet"
        end
    end

    function c.ready()
        c.zones_needed()
        for _, rule in ipairs(c.rules) do
            if not rule.properties.kn or not rule.properties.ks then
                c.note "contacts have no stiffness: 3DEC asks for stiffness-normal and stiffness-shear, too"
                break
            end
        end
    end
end

-- A converter. options: up = "z" or "y"; read = function(path) that gives the text of a file, or nil and why.
function converter.new(options)
    local c = { up = options.up or "z", read = options.read, variables = {}, functions = {}, tables = {}, helpers = {}, items = {},
        locals = 0, first_density = "1000",
        new_model = 'talus.model { gravity = { 0, 0, 0 }, contact_points = "corners" }' }
    fresh(c)
    add_writing(c)
    add_values(c)
    add_materials(c)
    add_zones(c)
    return c
end

return converter
