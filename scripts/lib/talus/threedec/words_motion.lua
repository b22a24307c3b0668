-- words_motion.lua - commands that hold, move and load blocks, and put stress in them.
local fish = require "talus.threedec.fish"
local range = require "talus.threedec.range"
local lexer = require "talus.threedec.lexer"

local COMPONENTS = { "velocity", "velocity-x", "velocity-y", "velocity-z", "rotation", "rotation-x", "rotation-y", "rotation-z",
    "x", "y", "z", "xvelocity", "yvelocity", "zvelocity", "rvelocity", "all" }

-- Which components the words before a range name: {x =, y =, z =, rotation =}; nil for all of them.
local function components(c, a)
    local held
    while not a:at_range() do
        local word = a:keyword(COMPONENTS)
        held = held or {}
        local axis = word:match "^velocity%-(.)$" or word:match "^([xyz])velocity$" or word:match "^([xyz])$"
        if axis then
            held[axis] = true
        elseif word == "velocity" then
            held.x, held.y, held.z = true, true, true
        elseif word == "all" then
            held.x, held.y, held.z, held.rotation = true, true, true, true
        else
            held.rotation = true
            if word:match "%-" then
                c.note "Talus holds the rotation about all axes"
            end
        end
    end
    return held
end

local NAMES = { "x", "y", "z", "rotation" }

local function named(held, value)
    local parts = {}
    for _, name in ipairs(NAMES) do
        if (held[name] or false) == value then
            parts[#parts + 1] = name .. " = true"
        end
    end
    return #parts > 0 and #parts < 4 and "{ " .. table.concat(parts, ", ") .. " }" or "()"
end

local function fix(c, a)
    local held = components(c, a)
    c.emit(c.blocks(range.read(c, a)) .. ":fix" .. (held and " " .. named(held, true) or "()"))
    c.fixed_in_part = c.fixed_in_part or held ~= nil
end

local function free(c, a)
    local freed = components(c, a)
    local text = c.blocks(range.read(c, a)) .. ":free()"
    if freed then
        local rest = named(freed, false)
        text = text .. (rest ~= "()" and ":fix " .. rest or "")
        if c.fixed_in_part then
            c.note "components that are not named are held, as if all had been"
        end
    end
    c.emit(text)
end

-- The factor of a FISH function that only assigns its own name, as `wave = math.sin(6.28*mech.time)`: an expression of t.
local function fish_factor(c, name)
    local called, own = c.functions[fish.name(name)], fish.name(name)
    local list = called and called.tree
    if not list or #list ~= 1 or list[1].kind ~= "assign" or fish.name(list[1].name) ~= own then
        c.leave("the FISH function '" .. name .. "' is not converted; drive takes a function of Lua")
    end
    local time = { lua = "t", value = 1.0 }
    local variables = setmetatable({ mech_time = time, time = time, dynamic_time = time, mech_time_total = time }, { __index = c.variables })
    return "(" .. fish.expression(list[1].text, variables).lua .. ")"
end

-- `fish f` or `table i` after a value: a factor over time. Gives the text of the factor, or nil.
local function factor(c, a)
    if a:take "fish" then
        return fish_factor(c, a:text "the function")
    elseif a:take("table", "history") then
        local name = a:text "the table"
        if not c.tables[name] then
            lexer.mistake("%s: there is no table '%s'", a.command, name)
        end
        c.use "interpolate"
        return ("interpolate(%s, t)"):format(c.tables[name].lua)
    end
    return nil
end

-- Velocity components of a list of blocks or gridpoints; those given before for the same list stay.
local function velocities(c, a, first)
    local own, timed = {}, false
    local word = first or a:keyword { "velocity", "velocity-x", "velocity-y", "velocity-z" }
    repeat
        local axis = word:match "^velocity%-(.)$"
        local list = axis and { a:number(word) } or a:vector "the velocity"
        local by = factor(c, a)
        timed = timed or by ~= nil
        for i, item in ipairs(list) do
            own[axis and ({ x = 1, y = 2, z = 3 })[axis] or i] = by and item.lua .. " * " .. by or item.lua
        end
        word = not a:at_range() and a:keyword { "velocity", "velocity-x", "velocity-y", "velocity-z" } or nil
    until not word
    return own, timed
end

local function drive(c, selection, own, timed)
    local all = c.drives[selection] or {}
    c.drives[selection] = all
    all.timed = all.timed or timed
    local parts = {}
    for i = 1, 3 do
        all[i] = own[i] or all[i]
        parts[i] = all[i] or "0"
    end
    if not (all[1] and all[2] and all[3]) then
        c.note "components of the velocity that are not given are held"
    end
    local text = table.concat(parts, ", ")
    c.emit(selection .. (all.timed and ":drive { velocity = function(t) return " .. text .. " end }" or
        ":drive { velocity = { " .. text .. " } }"))
    c.driven = true
end

local function apply(c, a)
    local own, timed = velocities(c, a)
    drive(c, c.blocks(range.read(c, a)), own, timed)
end

local AXIS = { x = 1, y = 2, z = 3 }

-- Forces and velocities at corners of rigid blocks, or at gridpoints of those that have zones.
local function gridpoint_apply(c, a)
    local word = a:keyword { "force", "force-x", "force-y", "force-z", "velocity", "velocity-x", "velocity-y", "velocity-z",
        "velocity-normal", "quiet", "viscous", "reaction", "source", "temperature", "quiet-x", "quiet-y", "quiet-z" }
    if word:match "^velocity" and word ~= "velocity-normal" then
        local own, timed = velocities(c, a, word)
        local list = range.read(c, a)
        if not c.zoned() then
            drive(c, c.blocks(list), own, timed)
            return
        end
        c.zones_needed()
        local points = "model:gridpoints " .. range.filter(list, "gridpoint", c)
        local still = not timed
        for i = 1, 3 do
            still = still and (not own[i] or tonumber(own[i]) == 0)
        end
        if still then
            c.emit(points .. ":fix " .. named({ x = own[1] ~= nil, y = own[2] ~= nil, z = own[3] ~= nil, rotation = false }, true))
        else
            drive(c, points, own, timed)
        end
        return
    elseif not word:match "^force" then
        c.leave("'" .. word .. "' at gridpoints: model:boundary{..., quiet = true} lets waves out of faces")
    end
    local force = { { lua = "0" }, { lua = "0" }, { lua = "0" } }
    local axis = word:match "%-(.)$"
    if axis then
        force[AXIS[axis]] = a:number "the force"
    else
        force = a:vector "the force"
    end
    if factor(c, a) then
        c.leave "a force that changes in time: call load from on_progress"
    end
    local list = range.read(c, a)
    if c.zoned() then
        c.zones_needed()
        c.emit(("model:gridpoints %s:load { force = %s }"):format(range.filter(list, "gridpoint", c), c.list(force)))
    else
        c.use "load_corners"
        c.emit(("load_corners(%s, %s)"):format(c.list(force), range.predicate(list or {}, "gridpoint", c)))
    end
end

local STRESSES = { "xx", "yy", "zz", "xy", "xz", "yz" }

-- The text {xx =, ...} of six numbers in 3DEC's order, without zeros; nil when all are 0.
local function tensor(list)
    local parts = {}
    for i, name in ipairs(STRESSES) do
        if list[i] and list[i].value ~= 0 then
            parts[#parts + 1] = name .. " = " .. list[i].lua
        end
    end
    return #parts > 0 and "{ " .. table.concat(parts, ", ") .. " }" or nil
end

-- Six stresses, and gradients after them.
local function stresses(c, a)
    local list, gradient = a:numbers(6, "a stress"), nil
    local known = { "gradient-x", "gradient-y", "gradient-z", "xgradient", "ygradient", "zgradient", "nodisplacements",
        "nodis", "gradient" }
    while not a:at_range() do
        local word = a:keyword(known)
        if word == "gradient-z" or word == "zgradient" then
            gradient = a:numbers(6, "a gradient")
        elseif word:match "gradient" then
            if tensor(a:numbers(6, "a gradient")) then
                c.note "stress changes with height only: the gradient along x or y is dropped"
            end
        end
    end
    return tensor(list), gradient and tensor(gradient)
end

local function insitu(c, a)
    local word = a:keyword { "stress", "pore-pressure", "principal", "topography", "fluid-temperature", "nodisplacements" }
    if word ~= "stress" then
        c.leave("in situ '" .. word .. "': give the stress by its six components")
    end
    local stress, gradient = stresses(c, a)
    local list = range.read(c, a)
    c.zones_needed()
    c.emit(("model:insitu { stress = %s%s%s }"):format(stress or "{}", gradient and ", gradient = " .. gradient or "",
        list and ", blocks = " .. c.blocks(list) or ""))
end

-- The faces of a range of positions, as keys of model:boundary.
local function faces(c, list)
    local low, high = range.box(list or {})
    if not low then
        c.leave "faces are found by positions, or by plane and facing of model:boundary"
    end
    return ("box = { min = %s, max = %s }"):format(c.list(low), c.list(high))
end

local function face_apply(c, a)
    local known = { "stress", "velocity-normal", "point-load", "traction", "mass" }
    for _, name in ipairs(STRESSES) do
        known[#known + 1] = "stress-" .. name
    end
    local word = a:keyword(known)
    local what
    if word == "stress" then
        local stress, gradient = stresses(c, a)
        what = ("stress = %s%s, add = true"):format(stress or "{}", gradient and ", gradient = " .. gradient or "")
    elseif word:match "^stress%-" then
        what = ("stress = { %s = %s }, add = true"):format(word:match "%-(.*)$", a:number(word).lua)
        if a:take "gradient" then
            local g = a:vector "the gradient"
            if g[1].value ~= 0 or g[2].value ~= 0 then
                c.note "stress changes with height only: the gradient along x or y is dropped"
            end
            what = what .. (", gradient = { %s = %s }"):format(word:match "%-(.*)$", g[3].lua)
        end
    elseif word == "velocity-normal" then
        if a:number(word).value ~= 0 then
            c.leave "a normal velocity that is not 0: drive the blocks, or give model:boundary a velocity"
        end
        what = "roller = true"
    else
        c.leave("'" .. word .. "' on faces; load{force =, at =} puts a force on a block")
    end
    if factor(c, a) then
        c.leave "a load that changes in time: call model:boundary from on_progress"
    end
    c.zones_needed()
    c.emit(("model:boundary { %s, %s }"):format(faces(c, range.read(c, a)), what))
end

-- Classic `bound`: stress on faces, or velocity and force along an axis.
local function bound(c, a)
    local word = a:keyword { "stress", "xvelocity", "yvelocity", "zvelocity", "xload", "yload", "zload", "nvelocity",
        "material", "xviscous", "yviscous", "zviscous", "ffield", "region" }
    if word == "stress" then
        local stress, gradient = stresses(c, a)
        c.zones_needed()
        c.emit(("model:boundary { %s, stress = %s%s, add = true }"):format(faces(c, range.read(c, a)), stress or "{}",
            gradient and ", gradient = " .. gradient or ""))
    elseif word:match "^[xyz]velocity" then
        table.insert(a.tokens, a.at, { kind = "word", text = "velocity-" .. word:sub(1, 1) })
        gridpoint_apply(c, a)
    elseif word:match "^[xyz]load" then
        table.insert(a.tokens, a.at, { kind = "word", text = "force-" .. word:sub(1, 1) })
        gridpoint_apply(c, a)
    elseif word == "nvelocity" then
        a:number "the velocity"
        c.emit(("model:boundary { %s, roller = true }"):format(faces(c, range.read(c, a))))
    else
        c.leave("bound " .. word .. ": model:boundary{..., quiet = true} lets waves out of faces")
    end
end

local function initial(c, a)
    local word = a:keyword { "velocity", "velocity-x", "velocity-y", "velocity-z", "xvelocity", "yvelocity", "zvelocity",
        "displacement", "displacement-x", "displacement-y", "displacement-z", "density", "rvelocity", "angular-velocity" }
    if word == "density" then
        local item = a:number(word)
        c.emit(("%s:set { density = %s }"):format(c.blocks(range.read(c, a)), item.lua))
        return
    elseif word:match "^displacement" then
        local list = word:match "%-" and { a:number(word) } or a:vector(word)
        for _, item in ipairs(list) do
            if item.value ~= 0 then
                c.leave "displacements count from 0 in Talus"
            end
        end
        c.emit(c.blocks(range.read(c, a), 'hidden = "any"') .. ":reset_displacement()")
        return
    end
    local axis = word:match "^velocity%-(.)$" or word:match "^([xyz])velocity$"
    local v = { { lua = "0" }, { lua = "0" }, { lua = "0" } }
    if axis then
        v[AXIS[axis]] = a:number(word)
        c.note "the other components of the velocity become 0"
    else
        v = a:vector(word)
    end
    local key = (word == "rvelocity" or word == "angular-velocity") and "angular_velocity" or "velocity"
    c.emit(("%s:set { %s = %s }"):format(c.blocks(range.read(c, a)), key, c.list(v)))
end

local function reset(c, a)
    while not a:at_range() do
        local word = a:keyword { "displacement", "velocity", "jdisplacement", "time", "history", "rotation", "damage", "state" }
        if word == "displacement" then
            c.emit 'model:blocks { hidden = "any" }:reset_displacement()'
        elseif word == "velocity" then
            c.emit "model:blocks {}:set { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } }"
        else
            c.note("reset " .. word)
        end
    end
    range.read(c, a)
end

return function(row)
    row("block fix|fix", { form = "[velocity-x | ... | rotation] [range]", becomes = "selection:fix{x = true, ...}, all when none is named",
        example = { "block fix range position-z -1 0.6", "fix xvel yvel range x 0 1", "block fix rotation velocity-z" }, convert = fix })
    row("block free|free", { form = "[velocity-x | ... | rotation] [range]", becomes = "selection:free(), and fix of the others",
        example = { "block fix\nblock free velocity-z", "free range z 0 1" }, convert = free })
    row("block apply", { form = "velocity v | velocity-x f [table s | fish s] [range]", becomes = "selection:drive{velocity = ...}",
        example = { "block apply velocity-x 0.1 range position-z 0 1",
            "table 'push' add 0 0 1 0.5\nblock apply vel-z 1 table 'push' range group 'rock'",
            "fish define wave\n  wave = math.sin(6.28*mech.time)\nend\nblock apply vel-x 0.1 fish wave" }, convert = apply })
    row("block gridpoint apply", { form = "force-z f | velocity-x f [range]", becomes = "selection:load{force =, at =}, of zones " ..
        "model:gridpoints{...}:load{...}, :fix{...}, :drive{...}", example = "block gridpoint apply force-z -100 range position-z 0.9 1.1",
        convert = gridpoint_apply })
    row("block face apply", { form = "stress sxx syy szz sxy sxz syz [gradient-z ...] | stress-zz f [gradient v] | velocity-normal 0 range",
        becomes = "model:boundary{box =, stress =, gradient =} or roller = true",
        example = { "block face apply stress -1e5 -1e5 -2e5 0 0 0 gradient-z 0 0 2e4 0 0 0 range position-z 0.99 1.01",
            "block face apply velocity-normal 0 range pos-x -0.01 0.01" }, convert = face_apply })
    row("boundary", { form = "stress sxx syy szz sxy sxz syz | xvel f | xload f range", becomes = "model:boundary{...}, " ..
        "selection:drive{...}, selection:load{...}", example = { "bound stress 0 0 -1e5 0 0 0 range z 0.99 1.01",
            "bound xvel 0 range z 0 1" }, convert = bound })
    row("block insitu|insitu", { form = "stress sxx syy szz sxy sxz syz [gradient-z ... (zgrad ...)] [range]",
        becomes = "model:insitu{stress =, gradient =}", example = { "block insitu stress -1e6 -1e6 -2e6 0 0 0",
            "insitu stress -1e6,-1e6,-2e6,0,0,0 zgrad 1e4,1e4,2e4,0,0,0" }, convert = insitu })
    row("block initialize|initial|block gridpoint initialize", { form = "velocity v | displacement 0 0 0 | density f [range]",
        becomes = "selection:set{velocity =}, reset_displacement()",
        example = { "block gridpoint ini disp 0 0 0", "initial zvel -1 range x 0 1" }, convert = initial })
    row("reset|block reset", { form = "disp vel jdisp time hist", becomes = "selection:reset_displacement(), set{velocity =}",
        example = "reset disp vel", convert = reset })
    row("block property", { form = "density f [range]", becomes = "selection:set{density =}",
        example = "block property density 2500", convert = function(c, a)
            a:keyword { "density" }
            local item = a:number "density"
            c.set_density(item, range.read(c, a))
        end })
    row("block apply-remove|block gridpoint apply-remove|block face apply-remove", { lacks = "loads are taken off by load{}, drives by free()" })
    row("table", { form = "s add t v t v ... (i t v t v ...)", becomes = "a table of the script, which drives take",
        example = "table 1 0 0 1 2", convert = function(c, a)
            local name = a:text "the table"
            a:take("add", "create")
            local rows = {}
            while a:more() do
                rows[#rows + 1] = a:numbers(2, "a pair of time and value")
            end
            c.table_rows(name, rows)
        end })
end
