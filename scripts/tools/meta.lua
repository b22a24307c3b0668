-- meta.lua - writes scripts/meta/talus.d.lua, which tells an editor's Lua language server (LuaLS) every function, option and
-- field with its type, unit and meaning.
--
--     build/release/talus --quiet scripts/tools/meta.lua scripts/meta/talus.d.lua            writes it anew
--     build/release/talus --quiet scripts/tools/meta.lua scripts/meta/talus.d.lua --check    fails when it is out of date
--
-- Functions, options and meanings are those that `talus help` prints. The types of options and of fields of blocks and
-- contacts are printed there, too. Those of results are seen from the results: every usage line is run on a small model.
package.path = arg[0]:match("^(.-)[^/]*$") .. "?.lua;" .. package.path
local pages = require "help_pages"
local build = require "usage_model"
local talus = require "talus"

local out = {}

local function warn_of(text)
    io.stderr:write("meta.lua: ", text, "\n")
end

local function put(format, ...)
    out[#out + 1] = select("#", ...) > 0 and format:format(...) or format
end

local function camel(text)
    return (("_" .. text):gsub("[_ ](%l)", string.upper):gsub("[_ ]", ""))
end

-- ---------------------------------------------------------------- types

local to_type

-- Types of named fields that are no numbers.
local FIELDS = { vertices = "integer[]", normal = "talus.Vector", joint = "string?", position = "talus.Vector", at = "talus.Vector", min = "talus.Vector",
    max = "talus.Vector", name = "string?", unit = "string?", log = "boolean?", range = "number[]?",
    style = "string?", colour = "string?", x = "number[]?", y = "number[]?" }

-- The type of {a =, b = {x, y, z}, ...}; nil when the text is none.
local function table_type(text)
    if text == "{x, y, z}" then
        return "talus.Vector"
    elseif text == "{xx =, yy =, zz =, xy =, yz =, zx =}" then
        return "talus.Tensor"
    elseif text == "{selection, selection}" then
        return "(talus.Blocks|talus.Block)[]"
    elseif text == "{number, number}" then
        return "number[]"
    end
    local fields = {}
    local inner = text:match("^{(.*)}$") or ""
    for name, at in inner:gmatch("%f[%a]([%a_]+) =%s*()") do
        local value = inner:match("^%b{}", at)
        fields[#fields + 1] = name .. ": " .. (value and (to_type(value)) or FIELDS[name] or "number")
    end
    return #fields > 0 and "{ " .. table.concat(fields, ", ") .. " }" or nil
end

local WORDS = {
    ["number"] = "number",
    ["whole number"] = "integer",
    ["true or false"] = "boolean",
    ["true, false"] = "boolean",
    ["vector"] = "talus.Vector",
    ["text"] = "string",
    ["text in quotes"] = "string",
    ["list of vectors"] = "talus.Vector[]",
    ["list of blocks"] = "talus.Block[]",
    ["list of 2 blocks"] = "talus.Block[]",
    ["list of 2 numbers"] = "number[]",
    ["list of 4 numbers"] = "number[]",
    ["list of numbers"] = "number[]",
    ["list of numbers or legs"] = "(number|{ shear: number?, closure: number?, normal_stress: number?, time: number?, " ..
        "speed: number?, steps: integer? })[]",
    ["list of legs"] = "{ strain: table<string, number>?, stress: table<string, number>?, steps: integer? }[]",
    ["list of whole numbers"] = "integer[]",
    ["list of names"] = "string[]",
    ["list of keyblocks"] = "talus.Keyblock[]",
    ["model"] = "talus.Model",
    ["block, contact, zone, gridpoint or selection"] = "talus.Block|talus.Contact|talus.Zone|talus.Gridpoint|" ..
        "talus.Blocks|talus.Contacts|talus.Zones|talus.Gridpoints",
    ["selection of blocks"] = "talus.Blocks",
    ["selection of contacts"] = "talus.Contacts",
    ["list of two groups"] = "(string|talus.Blocks|talus.Block)[]",
    ["block or its id"] = "talus.Block|integer",
    ["vector or text"] = "talus.Vector|string",
    ["result of model:boundary"] = "talus.BoundaryResult",
    ["a table of what is to be done"] = "talus.BoundaryOptions",
    ["function(trial)"] = "fun(trial: { F: number, holds: boolean, undecided: boolean, cycles: integer, why: string })",
    ["function(block)"] = "fun(block: talus.Block): any",
    ["function(contact)"] = "fun(contact: talus.Contact): any",
    ["function(zone)"] = "fun(zone: talus.Zone): any",
    ["function(gridpoint)"] = "fun(gridpoint: talus.Gridpoint): any",
    ["list of tables"] = "table[]",
    ["list of {{x, y, z}, {x, y, z}, radius}"] = "(talus.Vector|number)[][]",
    ["function(element)"] = "fun(element: talus.Element): any",
    ["number or function(x, y, z)"] = "number|fun(x: number, y: number, z: number): number",
    ["name or list of names"] = "string|string[]",
    ["number or function({x, y, z})"] = "number|fun(place: talus.Vector): number",
    ["function(model)"] = "fun(model: talus.Model): any",
    ["function(model, result)"] = "fun(model: talus.Model, result: talus.SolveResult)",
    ["function(values)"] = "fun(values: table<string, number>): talus.Model, table?",
    ["function(model, values)"] = "fun(model: talus.Model, values: table<string, number>): table",
    ["function(draw)"] = "fun(draw: table): talus.Model",
    ["function(model, draw)"] = "fun(model: talus.Model, draw: table): table, boolean?",
    ["function(rows)"] = "fun(rows: integer)",
    ["{NAME = {from, to}}"] = "table<string, number[]>",
    ["{FIELD = value}"] = "table<string, number|number[]|boolean>",
    ["{field =, half_width =, at_least =}"] = "{ field: string, half_width: number, at_least: integer? }",
    ["poles or list of poles"] = "table|table[]",
    ["function(t)"] = "(fun(t: number): number|talus.Vector, number?, number?)",
    ["{JOINT = number}"] = "table<string, number>",
    ["{NAME = value}"] = "table<string, number|string|boolean|talus.Vector>",
    ["{friction =, cohesion =, gravity =}"] = "talus.KeyblocksOptions",
    ['true, false or "slipping"'] = 'boolean|"slipping"',
    ['{"FIELD", NAME = "FIELD", {[id] = number} or function(block)}'] = "string[]|table<string, string|table<integer, number>|" ..
        "fun(block: talus.Block): number?>",
    ['{"FIELD", NAME = "FIELD" or function(contact)}'] = "string[]|table<string, string|fun(contact: talus.Contact): number?>",
    ["{BLOCK = function(t)}"] = "table<integer, function|{ velocity: function?, angular_velocity: function? }>",
}

-- The type of one word of the help; nil when it is unknown.
local function simple_type(text)
    if WORDS[text] then
        return WORDS[text]
    elseif text:match('^"[^"]*"$') then
        return text
    elseif (text .. ", "):gsub('"[^"]*", ', "") == "" then -- "a", "b"
        return (text:gsub(", ", "|"))
    elseif text:match("^list of {") then
        local inner = table_type(text:match("^list of (.*)$"))
        return inner and inner .. "[]"
    elseif text:match("^{") then
        return table_type(text)
    end
end

-- The type of "number, Pa/m, > 0, required" and the like.
function to_type(text)
    text = text:gsub(", required$", "")
    local choices = text:match("^one of (.*)$")
    if choices then
        local words = {}
        for word in choices:gmatch('"[^"]*"') do
            words[#words + 1] = word
        end
        if choices:match('default "[^"]*"$') then
            table.remove(words)
        end
        return table.concat(words, "|")
    end
    local left, right = text:match("^(.*) or (.*)$")
    left, right = simple_type(left or ""), simple_type(right or "")
    local found = simple_type(text) or (left and right and left .. "|" .. right) or simple_type(text:match("^[^,]*")) or
        simple_type(text:match("^%b{}") or "") or simple_type(text:match("^list of %b{}") or "")
    if not found then
        warn_of("no type for '" .. text .. "': it belongs into WORDS")
    end
    return found or "any"
end

-- The type of a value that a call gave; nil for nil.
local function seen_type(value)
    local kind = math.type(value) or type(value)
    if kind == "userdata" then
        local word = tostring(value)
        return word:match("^block ") and "talus.Block" or word:match("^contact ") and "talus.Contact" or
            word:match("^model ") and "talus.Model" or word:match("^selection of %d+ block") and "talus.Blocks" or
            word:match("^selection of %d+ contact") and "talus.Contacts" or word:match("^zone ") and "talus.Zone" or
            word:match("^gridpoint ") and "talus.Gridpoint" or word:match("^selection of %d+ zone") and "talus.Zones" or
            word:match("^selection of %d+ gridpoint") and "talus.Gridpoints" or word:match("^element ") and "talus.Element" or
            word:match("^selection of %d+ element") and "talus.Elements" or "userdata"
    elseif kind ~= "table" then
        return ({ float = "number", ["nil"] = false })[kind] or (kind ~= "nil" and kind or nil)
    elseif getmetatable(value) then
        return "table"
    elseif #value == 3 and type(value[1]) == "number" then
        return "talus.Vector"
    elseif #value > 0 then
        local first = seen_type(value[1])
        for i = 2, first == "integer" and #value or 0 do
            first = math.type(value[i]) == "float" and "number" or first
        end
        return first .. "[]"
    end
    local names, fields = {}, {}
    for name in pairs(value) do
        names[#names + 1] = type(name) == "string" and name or nil
    end
    table.sort(names)
    for i, name in ipairs(names) do
        fields[i] = ("%s: %s"):format(name, seen_type(value[name]))
    end
    return #names > 0 and "{ " .. table.concat(fields, ", ") .. " }" or "table"
end

-- A field of a result; nil where it has none, which some results refuse to tell.
local function field_of(value, name)
    local good, field = pcall(function() return value[name] end)
    if good then
        return field
    end
end

-- The type of a field of a result with this value and meaning. What may be nil says so.
local function field_type(value, meaning, class)
    if meaning:match("^where %a+ are given: these fields") then
        return class .. "?"
    elseif meaning:match("each a number or a list of numbers") then
        return "(number|number[])[]"
    end
    local may_be_nil = meaning:match("%f[%w]nil%f[%W]") ~= nil
    local type = seen_type(value)
    if not type then
        type = meaning:match("^table of the same") and "table" or
            (meaning:match("^the block") or meaning:match("^a block")) and "talus.Block" or
            meaning:match("^the selection of blocks") and "talus.Blocks" or meaning:match("^{x, y, z}") and "talus.Vector" or
            meaning:match("^name of the") and "string" or meaning:match("^two groups or") and "(string|talus.Blocks)[]" or
            meaning:match("laws as of model:laws%(%)") and "table[]" or
            meaning:match("^the number of the") and "integer" or meaning:match("^lists? of the %l+") and "number[]" or
            (meaning:match("^how many times") or meaning:match("%f[%w]m3%f[%W]")) and "number" or
            meaning:match("^where a file was read") and "table" or
            meaning:match("^{block =, factor =}") and "{ block: integer, factor: number }" or
            meaning:match("the selection of blocks") and "talus.Blocks" or meaning:match("{x, y, z}") and "talus.Vector" or
            (meaning:match("%f[%w]s%f[%W]") or meaning:match("%f[%w]m3%f[%W]")) and "number" or "any"
    end
    return type .. ((may_be_nil or value == nil) and type ~= "any" and type ~= "table" and "?" or "")
end

-- ---------------------------------------------------------------- classes

local function comment(text)
    put("--- " .. text)
end

-- "Pa, >= 0, default 0: " of "number, Pa, >= 0, default 0": what the type alone does not tell.
local function limits_of(kind)
    if kind:match(" or ") and not kind:match("^true or false") then
        return ""
    end
    local text = kind:match("^one of .*(default .*)$") or kind:match("^[^,{(]*, (.*)$") or kind:match("^%b{}, (.*)$") or ""
    text = text:gsub(",? ?required$", ""):gsub(",? ?may be left out$", "")
    return #text > 0 and text .. ": " or ""
end

-- Second names of a row that are no aliases.
local PAIRS = { height = true, y_axis = true, xmax = true, ymax = true, zmax = true }

-- A row of parameters "name, alias" as fields of an open class.
local function put_options(rows)
    for _, row in ipairs(rows) do
        local kind, meaning = pages.split_parameter(row.text)
        local optional = kind:match("required$") and "" or "?"
        local type = to_type(kind)
        for name in row.name:gmatch("[%w_]+") do
            local alias = (PAIRS[name] or row.name:match("^" .. name)) and "" or " (another name)"
            put("---@field %s%s %s %s%s%s", name, row.name:match(",") and "?" or optional, type, limits_of(kind), meaning, alias)
        end
    end
end

local function section_of(topic, pattern)
    for _, section in ipairs(topic.sections) do
        if section.title:match(pattern) then
            return section
        end
    end
end

-- A class of a result: the rows tell names and meanings, `value` is one.
local function put_result(class, rows, value)
    put("\n---@class (exact) %s", class)
    local nested = {}
    for _, row in ipairs(rows) do
        local meaning = table.concat(row.text, " ")
        for name in row.name:gmatch("[%w_%.]+") do
            local outer = name:match("^([%w_]+)%.")
            if outer and not nested[outer] then
                nested[outer] = true
                put("---@field %s %s", outer, seen_type(field_of(value, outer)) or "table")
            elseif not outer then
                put("---@field %s %s %s", name, field_type(field_of(value, name), meaning, class), meaning)
            end
        end
    end
end

-- ---------------------------------------------------------------- functions

-- The calls of a usage line that are of that function: { owner = "model", arguments = "...", result = "summary" }.
local function calls_of(name, usage)
    local calls = {}
    for part in (usage:gsub("  or  ", "\n"):gsub("; ", "\n") .. "\n"):gmatch("(.-)\n") do
        local text = part:match("^%s*(.-)%s*$")
        local result, rest = text:match("^([%w_]+)%s*=%s*(.*)$")
        local owner, arguments = (rest or text):match("^(%a+)[:.]" .. name .. "(%b())$")
        if not owner then
            owner, arguments = (rest or text):match("^(%a+)[:.]" .. name .. "%s*(%b{})$")
            arguments = arguments and "(" .. arguments .. ")"
        end
        if owner then
            calls[#calls + 1] = { owner = owner, arguments = arguments:sub(2, -2), text = text, result = result }
        end
    end
    return calls
end

-- The functions that a topic tells of: the one of its name, or those of its usage line.
local function functions_of(name, usage)
    local names, seen = {}, {}
    for word in usage:gmatch("%a+[:.]([%a_]+)%(") do
        names[#names + 1] = not seen[word] and word or nil
        seen[word] = true
    end
    return (#calls_of(name, usage) > 0 or #names == 0) and { name } or names
end

local function split_arguments(text)
    local arguments, depth, current = {}, 0, ""
    for character in text:gmatch(".") do
        depth = depth + (character:match("[{(]") and 1 or character:match("[})]") and -1 or 0)
        if character == "," and depth == 0 then
            arguments[#arguments + 1] = current:match("^%s*(.-)%s*$")
            current = ""
        else
            current = current .. character
        end
    end
    if current:match("%S") then
        arguments[#arguments + 1] = current:match("^%s*(.-)%s*$")
    end
    return arguments
end

local OWNERS = { model = "talus.Model", selection = "talus.Blocks", sel = "talus.Blocks", talus = "talus" }
-- What a result is called that no call has given.
local RESULT_WORDS = { model = "talus.Model", selection = "talus.Blocks", text = "string" }
local PLUGIN_WORDS = { GENERATOR = "generator", LAW = "law", DAMPING = "damping", SOLID = "solid" }

-- Name and type of an argument as a usage line writes it; `rows` are the function's parameters.
local function argument_of(text, rows, options, plugins)
    local word = text:match('^"(.*)"$')
    if text:match("^{") then
        local optional = true
        for _, row in ipairs(rows) do
            optional = optional and not pages.split_parameter(row.text):match("required$")
        end
        return "options", options or "table", optional
    elseif word and PLUGIN_WORDS[word] then
        return PLUGIN_WORDS[word], plugins
    elseif #rows == 1 or (not word and not text:match("^[%a_]+$")) or text == "true" then
        local kind, meaning = pages.split_parameter(rows[1] and rows[1].text or { "any" })
        return rows[1] and rows[1].name or "value", to_type(kind), not kind:match("required$"), meaning
    elseif word then
        if word:match("^%u%d*$") then
            return "joint", "string|table|talus.Blocks|talus.Contacts"
        end
        return word:match("/") and "path" or "name", "string"
    elseif text == "model" then
        return "model", "talus.Model"
    end
    return text, "any"
end

local function signature(call, rows, options, plugins)
    local parameters = {}
    for _, text in ipairs(split_arguments(call.arguments)) do
        local name, type, optional, meaning = argument_of(text, rows, options, plugins)
        parameters[#parameters + 1] = { name = name, type = type, optional = optional, meaning = meaning or "" }
    end
    return parameters
end

-- What the call gives on the small model; the topic's first call that gives something.
local function try(calls, usage)
    for _, call in ipairs(calls) do
        if call.result and call.arguments:match('^"out/') then -- there is no such file
            return nil, call.result
        elseif call.result and not call.text:match('"%u%u+"') then
            local environment = build()
            local before = usage:sub(1, usage:find(call.text, 1, true) - 1) -- as in "model:profile(true); result = model:profile()"
            for text in (before:gsub("  or  ", "; ") .. "; "):gmatch("(.-); ") do
                pcall(load(text, "=usage", "t", environment) or error)
            end
            local chunk = load(call.text, "=usage", "t", environment)
            local good, message = pcall(chunk or error)
            if not good then
                warn_of(("'%s' cannot be run on the small model: %s"):format(call.text, message))
            end
            return good and rawget(environment, call.result) or nil, call.result
        elseif call.result then
            return build().model:generate("box", { min = { 9, 9, 9 }, max = { 10, 10, 10 }, density = 1 })
        end
    end
end

local function overload_text(class, parameters, result)
    local parts = class ~= "talus" and { "self: " .. class } or {}
    for _, parameter in ipairs(parameters) do
        parts[#parts + 1] = parameter.name .. (parameter.optional and "?" or "") .. ": " .. parameter.type
    end
    return ("---@overload fun(%s)%s"):format(table.concat(parts, ", "), result and ": " .. result or "")
end

-- Plugins of a type: { name =, class =, doc =, rows =, required = whether a parameter is }.
local function plugins_of(type)
    local list = {}
    for _, section in ipairs(pages.overview()) do
        if pages.kinds[section.title] == type then
            for _, row in ipairs(section.rows) do
                local parameters = section_of(pages.plugin(type, row.name), "^Parameters$") or { rows = {} }
                local plugin = { name = row.name, class = "talus." .. type .. "." .. camel(row.name),
                    doc = table.concat(row.text, " "), rows = parameters.rows }
                for _, parameter in ipairs(plugin.rows) do
                    plugin.required = plugin.required or pages.split_parameter(parameter.text):match("required$") ~= nil
                end
                list[#list + 1] = plugin
            end
        end
    end
    return list
end

-- One overload for each plugin, with its own table of parameters.
local function put_plugin_overloads(class, call, result)
    local type = PLUGIN_WORDS[call.arguments:match('"(%u%u+)"') or ""]
    for _, plugin in ipairs(type and plugins_of(type) or {}) do
        local parameters = signature(call, {}, plugin.class, '"' .. plugin.name .. '"')
        for _, parameter in ipairs(parameters) do
            if parameter.name == "options" then
                parameter.optional = not plugin.required
                parameter.type = plugin.class .. (type == "generator" and "|" .. plugin.class .. "[]" or "")
            end
        end
        put(overload_text(class, parameters, result))
    end
end

-- What is known of those of a list or a table by name: of tables each field of the first that has something there.
local function known_of(list)
    local names, all = {}, {}
    for name in pairs(list) do
        names[#names + 1] = name
    end
    table.sort(names)
    for _, name in ipairs(names) do
        if type(list[name]) ~= "table" then
            return list[name]
        end
        for field, value in pairs(list[name]) do
            local empty = type(value) == "table" and next(value) == nil
            all[field] = all[field] == nil and not empty and value or all[field]
        end
    end
    return names[1] and all
end

-- The class of what a function gives, and the type of what it gives: one, a list or a table by name of them.
local function put_result_of(name, fields, value, known)
    local each = fields.title:match("^Fields of each ([%a ]+)$")
    local class = each and "talus." .. camel(each) or "talus." .. camel(name) .. "Result"
    if not known[class] then
        local one = value
        if each then
            one = assert(known_of(value), "the small model has no " .. each)
        end
        put_result(class, fields.rows, one)
        known[class] = true
    end
    return not each and class or (#value > 0 and class .. "[]" or "table<string, " .. class .. ">")
end

local result_classes = {}

-- A function `name` as the topic tells it.
local function put_function(name, topic)
    local calls = calls_of(name, topic.head[1])
    if not calls[1] or not OWNERS[calls[1].owner] then
        warn_of(("cannot read the usage of %s: %s"):format(name, topic.head[1]))
        return
    end
    local rows = (section_of(topic, "^Parameters$") or { rows = {} }).rows
    local fields = section_of(topic, "^Fields of [et]%w+ ") or section_of(topic, "^Fields of what")
    local options
    if #rows > 0 and topic.head[1]:match("{") then
        options = "talus." .. camel(name) .. "Options"
        put("\n---@class (exact) %s", options)
        put_options(rows)
    end
    local value, of = try(calls, topic.head[1])
    local result = value ~= nil and seen_type(value) or RESULT_WORDS[of]
    if value == nil and result and table.concat(topic.head, " "):match("; nil when") then
        result = result .. "?"
    end
    if fields and type(value) == "table" then
        result = put_result_of(name, fields, value, result_classes)
    end
    local class = OWNERS[calls[1].owner]
    put("")
    comment(table.concat(topic.head, " ", 2))
    comment("")
    comment("    " .. topic.head[1])
    local parameters = signature(calls[1], rows, options, "string")
    for _, parameter in ipairs(parameters) do
        put("---@param %s%s %s %s", parameter.name, parameter.optional and "?" or "", parameter.type, parameter.meaning)
    end
    result = class == "talus.Blocks" and "talus.Blocks" or result
    if result then
        put("---@return %s", result)
    end
    put_plugin_overloads(class, calls[1], result)
    for i = 2, #calls do
        put(overload_text(class, signature(calls[i], rows, options, "string"), result))
    end
    local names = {}
    for i, parameter in ipairs(parameters) do
        names[i] = parameter.name
    end
    put("function %s%s%s(%s) end", class == "talus" and "talus" or class:match("%.(.*)"), class == "talus" and "." or ":",
        name, table.concat(names, ", "))
end

-- ---------------------------------------------------------------- blocks and contacts

local RESULTS = { sum = "number|talus.Vector", max = "number", min = "number",
    bounds = "{ min: talus.Vector, max: talus.Vector }" }

-- Fields and methods of one type: what the topic of their selection tells.
local function put_items(topic_name, item, items, functions)
    local topic = pages.topic(topic_name)
    put("\n---@class (exact) talus.%s", item)
    local fields = section_of(topic, "^Fields of a ")
    for _, row in ipairs(fields.rows) do
        local kind, meaning = pages.split_row(fields, row)
        put("---@field %s %s %s%s", row.name, to_type(kind), limits_of(kind), meaning)
    end
    put("local %s = {}", item)
    put("\n--- A selection of %s: a snapshot, in ascending order of %s.", topic_name,
        topic_name == "contacts" and "their blocks" or "id")
    put("---@class (exact) talus.%s", items)
    put("---@field [integer] talus.%s", item)
    put("---@operator len: integer")
    put("local %s = {}", items)
    for _, row in ipairs(section_of(topic, "^Methods of ").rows) do
        for name, at in row.name:gmatch("sel:([%a_]+)()") do
            local arguments = row.name:match("^%b()", at) or row.name:match("^%b{}", at)
            if arguments and not functions[name] then
                put("")
                comment(table.concat(row.text, " "))
                local argument = arguments:match("^%(function") and "keep" or arguments:match("^%((%a+)%)") or
                    arguments:match("^{") and "options"
                if argument then
                    put("---@param %s %s", argument, argument == "keep" and ("fun(item: talus.%s): any"):format(item) or
                        argument == "field" and "string" or "any")
                end
                put("---@return %s", RESULTS[name] or (argument == "field" and "any" or "talus." .. items))
                put("function %s:%s(%s) end", items, name, argument or "")
            end
        end
    end
end

-- ---------------------------------------------------------------- the file

local function put_head()
    put("---@meta talus\n")
    put("-- Talus for the Lua language server: every function, option and field, with units.")
    put("-- Written by scripts/tools/meta.lua from what `talus help` prints; do not edit.\n")
    put("--- {x, y, z}\n---@alias talus.Vector number[]\n")
    put("--- Components left out are 0.\n---@class (exact) talus.Tensor")
    for _, name in ipairs { "xx", "yy", "zz", "xy", "yz", "zx" } do
        put("---@field %s? number", name)
    end
    put("\n---@class talus\n---@field version string\nlocal talus = {}\n")
    put("--- Prints what `talus help TOPIC` prints: the overview, a function or a plugin.")
    put("---@param topic? string\nfunction talus.help(topic) end")
end

local function put_plugins()
    for _, section in ipairs(pages.overview()) do
        local type = pages.kinds[section.title]
        for _, plugin in ipairs(type and plugins_of(type) or {}) do
            put("")
            comment(plugin.doc)
            put("---@class (exact) %s", plugin.class)
            put_options(plugin.rows)
        end
    end
end

local function put_model()
    put("\n---@class (exact) talus.Model")
    local model = build().model
    for _, row in ipairs(section_of(pages.topic("model"), "^Fields of the model$").rows) do
        local meaning = table.concat(row.text, " ")
        for name in row.name:gmatch("model%.([%a_]+)") do
            put("---@field %s %s %s", name, seen_type(model[name]) or "any", meaning)
        end
    end
    put("local Model = {}")
end

local function whole()
    local overview, names, functions = pages.overview(), {}, {}
    for _, section in ipairs(overview) do
        for _, row in ipairs(section.title == "Functions" and section.rows or {}) do
            names[#names + 1] = row.name
            functions[row.name] = true
        end
    end
    put_head()
    put_plugins()
    put_model()
    put_items("blocks", "Block", "Blocks", functions)
    put_items("contacts", "Contact", "Contacts", functions)
    put_items("zones", "Zone", "Zones", functions)
    put_items("gridpoints", "Gridpoint", "Gridpoints", functions)
    put_items("elements", "Element", "Elements", functions)
    for _, name in ipairs(names) do
        local topic = pages.topic(name)
        for _, of in ipairs(functions_of(name, topic.head[1])) do
            put_function(of, topic)
        end
    end
    put("\nreturn talus")
    return (table.concat(out, "\n"):gsub("[ \t]+\n", "\n"):gsub("%-%-%-\n%-%-%-     ", "---\n---     ")) .. "\n"
end

local path, option = ...
if not path or (option and option ~= "--check") then
    error("usage: talus scripts/tools/meta.lua FILE.d.lua [--check]", 0)
end
local text = whole()
assert(load(text, path))
pages.renew(path, text, option, "scripts/tools/meta.lua")
