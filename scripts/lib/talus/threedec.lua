-- threedec.lua - reads data files of 3DEC: commands of versions 7 to 9 and the classic ones, as scripts of Talus.
--
--     local threedec = require "talus.threedec"
--     local result = threedec.convert("arch.3ddat")      -- result.items, result.left_out, result.mistakes
--     print(threedec.script(result))                     -- a readable script
--     load(threedec.chunk(result), "@arch.3ddat")()      -- the same with each command on its line of the data file
--
-- What is not converted is never dropped in silence: it is in result.left_out, in the script, and threedec.report
-- tells it. A mistake in the file becomes a line that raises it. The table of commands is threedec/words.lua.
local arguments = require "talus.threedec.arguments"
local converter = require "talus.threedec.converter"
local fish = require "talus.threedec.fish"
local helpers = require "talus.threedec.helpers"
local lexer = require "talus.threedec.lexer"
local match = require "talus.threedec.match"
local program = require "talus.threedec.program"
local words = require "talus.threedec.words"
local threedec = {}

-- Limit: depth of files that call each other.
local MOST_CALLS = 20

-- ---------------------------------------------------------------- commands ---------------

-- What the first word of a command means: words of one row mean the same.
local function row_of(word)
    return words.tree.children[word].row or word
end

-- The row of the table for the first words of a command, how the file calls it, and the token after these words.
local function find_row(tokens)
    local node, at, path = words.tree, 1, {}
    local row, row_at, row_path
    while tokens[at] and tokens[at].kind == "word" do
        local place = #path > 0 and table.concat(path, " ") or "commands"
        local word
        if node == words.tree then
            word = match.need(tokens[at].text, node.names, place, row_of)
        elseif #node.names > 0 then
            word = match.find(tokens[at].text, node.names, place)
        end
        if not word then
            if not row then
                match.need(tokens[at].text, node.names, place)
            end
            break
        end
        node, at = node.children[word], at + 1
        path[#path + 1] = word
        if node.row then
            row, row_at, row_path = node.row, at, table.concat(path, " ")
        end
    end
    if not row then
        lexer.mistake("%s: a word is missing after it: %s", table.concat(path, " "), table.concat(node.names, ", "))
    end
    return row, row_path, row_at
end

local function convert_command(c, statement)
    local tokens = statement.tokens
    if tokens[1].kind ~= "word" then
        lexer.mistake("a command begins with a word, not with '%s'", tokens[1].text)
    elseif #tokens == 1 and c.functions[fish.name(tokens[1].text)] then -- classic files call functions by their names
        program.step(c, { kind = "call", name = tokens[1].text, arguments = {} })
        return
    end
    local row, command, at = find_row(tokens)
    c.item.row = row
    if row.lacks then
        lexer.leave("%s", row.lacks)
    elseif row.needless then
        c.item.needless = row.needless
        return
    end
    local a = arguments.new(tokens, at, command, c.variables)
    row.convert(c, a)
    if a:more() then
        -- A range that a command reads, and anything else, is read by its row.
        lexer.mistake("%s: '%s' is not expected", command, a:peek() and a:peek().text or "a number")
    end
end

-- ---------------------------------------------------------------- FISH -------------------

local function define(c, statement)
    local tree, why = program.read(statement.body)
    c.functions[fish.name(statement.name)] = { name = statement.name, tree = tree, parameters = statement.parameters,
        lines = statement.body }
    if not tree then
        lexer.leave("the FISH function '%s', lines %d to %d: write it in Lua, because of %s", statement.name, statement.line,
            statement.last, why)
    end
    c.remark("FISH " .. statement.name .. ": what it does stands where it is called")
    c.nothing = true
end

local function run_fish(c, statement)
    local code = statement.code:gsub("%s+$", "")
    local inside = code:match "^%[(.*)%]$" or code:match "^@(.*)$"
    if not inside then
        lexer.mistake "the bracket [ is not closed"
    end
    local node = program.simple(inside)
    if not node then
        lexer.leave("'%s' is not converted: write it in Lua", inside)
    end
    program.step(c, node)
end

-- ---------------------------------------------------------------- files ------------------

local handlers = { command = convert_command, fish = run_fish, ["function"] = define,
    program = function(c, statement)
        program.step(c, statement.node, statement.locals)
    end,
    mistake = function(_, statement)
        lexer.mistake("%s", statement.reason)
    end }

-- The first density that the file gives: that of blocks until their own is given.
local function find_density(c, statements)
    for _, statement in ipairs(statements) do
        for i, token in ipairs(statement.tokens or {}) do
            local number = statement.tokens[i + 1]
            if token.kind == "word" and #token.text >= 3 and ("density"):sub(1, #token.text) == token.text:lower() and number and
                number.kind == "number" and number.value > 0 then
                c.first_density = number.text
                return
            end
        end
    end
end

local function convert_statement(c, statement)
    local item = { file = c.file, line = statement.line, place = c.place or statement.line, kind = statement.kind, source = statement.code,
        comment = statement.comment, code = {}, notes = {}, remarks = {} }
    c.items[#c.items + 1] = item
    if statement.kind == "blank" then
        return
    end
    c.item, c.nothing = item, false
    local ok, failure = pcall(handlers[statement.kind], c, statement)
    if not ok then
        if type(failure) ~= "table" or failure.too_long then
            error(failure, 0)
        end
        item.mistake, item.left_out, item.code = failure.mistake, failure.left_out, {}
    end
    item.source = item.source or statement.kind == "function" and "fish define " .. statement.name
end

local function folder_of(path)
    return path:match "^(.*/)" or ""
end

local function convert_text(c, text, file)
    local statements = lexer.statements(text)
    if not c.density_found then
        find_density(c, statements)
        c.density_found = c.first_density ~= "1000"
    end
    for _, statement in ipairs(statements) do
        c.file = file
        convert_statement(c, statement)
    end
end

local function read_file(path)
    local file, why = io.open(path, "rb")
    if not file then
        return nil, why
    end
    local text = file:read "a"
    file:close()
    if not text then
        return nil, path .. ": cannot be read"
    end
    return text
end

-- `program call`: the commands of another file, sought beside the first one and with the endings of data files.
local function add_calls(c, first)
    local depth = 0
    function c.call(name)
        local text, why
        for _, ending in ipairs { "", ".dat", ".3ddat" } do
            local path = (name:match "^/" and "" or folder_of(first)) .. name:gsub("\\", "/") .. ending
            text, why = c.read(path)
            if text then
                name = path
                break
            end
        end
        if not text then
            lexer.mistake("call: the file '%s' cannot be read: %s", name, tostring(why):gsub("^.-: ", ""))
        elseif depth == MOST_CALLS then
            lexer.mistake("call: more than %d files call each other", MOST_CALLS)
        end
        depth = depth + 1
        local own, place, file = c.item, c.place, c.file
        c.place = own.place
        c.nothing = true
        convert_text(c, text, name)
        c.item, c.place, c.file = own, place, file
        depth = depth - 1
    end
end

-- How a line fared, worst first. A line of a loop has an item for each round.
local FATES = { "mistakes", "left_out", "converted", "needless" }

local function fate_of(item)
    return item.mistake and 1 or item.left_out and 2 or item.needless and 4 or item.kind ~= "blank" and 3 or nil
end

-- The worst fate of the items of each line, by "file:line".
local function fates_of(items)
    local worst = {}
    for _, item in ipairs(items) do
        local at, fate = item.file .. ":" .. item.line, fate_of(item)
        worst[at] = fate and math.min(fate, worst[at] or fate) or worst[at]
    end
    return worst
end

-- Collects what was lost and what was wrong, in order: {file =, line =, source =, reason =}, and counts lines.
local function gather(c)
    local result = { items = c.items, helpers = c.helpers, new_model = c.new_model, left_out = {}, mistakes = {}, in_part = {}, converted = 0,
        needless = 0, damped = false }
    local worst, told = fates_of(c.items), {}
    local function add(list, item, reason)
        local key = table.concat({ item.file, item.line, reason }, ":")
        if not told[key] then
            list[#list + 1] = { file = item.file, line = item.line, source = item.source, reason = reason }
        end
        told[key] = true
    end
    for _, item in ipairs(c.items) do
        local at, fate = item.file .. ":" .. item.line, fate_of(item)
        if fate and fate <= 2 then
            add(result[FATES[fate]], item, item.mistake or item.left_out)
        elseif fate and fate == worst[at] then
            result[FATES[fate]] = result[FATES[fate]] + 1
            worst[at] = nil
        end
        for _, note in ipairs(item.left_out and {} or item.notes) do
            add(result.in_part, item, note)
        end
        result.damped = result.damped or item.row ~= nil and item.code[1] ~= nil and item.code[1]:match "^model:damping" ~= nil
    end
    return result
end

-- Converts a file. options: text = its text, where it is at hand; up = "y" for files whose y axis points up and whose
-- dip directions count from z; read = function(path) for the files it calls. Raises when the file cannot be read.
function threedec.convert(path, options)
    options = options or {}
    local texts = {}
    local function read(name)
        local text, why = (options.read or read_file)(name)
        texts[#texts + 1] = text
        return text, why
    end
    local c = converter.new { up = options.up, read = read }
    local text, why = options.text, nil
    if not text then
        text, why = c.read(path)
    end
    if not text then
        error(("cannot read '%s': %s"):format(path, tostring(why):gsub("^.-: ", "")), 0)
    end
    function c.convert(statement)
        convert_statement(c, statement)
    end
    add_calls(c, path)
    convert_text(c, text, path)
    local result = gather(c)
    result.file, result.texts = path, texts
    return result
end

-- Whether a file is one of those that were converted, or a copy of one, by whatever name.
function threedec.was_read(result, path)
    local text = read_file(path)
    for _, one in ipairs(text and result.texts or {}) do
        if one == text then
            return true
        end
    end
    return false
end

-- ---------------------------------------------------------------- as Lua -----------------

local function mistake_line(item)
    return ("error(%q, 0)"):format(("%s:%d: %s"):format(item.file, item.line, item.mistake))
end

local function head(result)
    local lines = { 'local talus = require "talus"', "local model = " .. result.new_model }
    if not result.damped then
        lines[#lines + 1] = 'model:damping "local"'
    end
    return lines
end

local function used_helpers(result)
    local list = {}
    for _, name in ipairs(helpers.order) do
        if result.helpers[name] then
            list[#list + 1] = helpers[name]
        end
    end
    return list
end

-- The comment behind a command, or nil.
local function trailing(item)
    local parts = {}
    parts[#parts + 1] = item.comment
    for _, remark in ipairs(item.remarks) do
        parts[#parts + 1] = remark
    end
    for _, note in ipairs(item.notes) do
        parts[#parts + 1] = "left out in part: " .. note
    end
    return #parts > 0 and table.concat(parts, "; ") or nil
end

local function plain(text)
    return (text:gsub("%s+", " "):gsub("^ ", ""):gsub(" $", ""))
end

local function write_item(lines, item)
    local comment = trailing(item)
    if item.mistake then
        lines[#lines + 1] = mistake_line(item) .. " -- " .. plain(item.source or "")
    elseif item.left_out then
        lines[#lines + 1] = ("-- left out: %s -- %s%s"):format(plain(item.source), item.left_out, item.comment and " -- " .. item.comment or "")
    elseif item.needless then
        lines[#lines + 1] = ("-- %s (%s)%s"):format(plain(item.source), item.needless, item.comment and " -- " .. item.comment or "")
    elseif item.kind == "blank" then
        if item.comment or lines[#lines] ~= "" then
            lines[#lines + 1] = item.comment and ("-- " .. item.comment):gsub("%s+$", "") or ""
        end
    elseif #item.code == 0 then
        lines[#lines + 1] = "-- " .. plain(item.source) .. (comment and " -- " .. comment or "")
    else
        for i, code in ipairs(item.code) do
            lines[#lines + 1] = code .. (i == #item.code and comment and " -- " .. comment or "")
        end
    end
end

-- `3 commands are left out` and the like.
local function count(number, what)
    return ("%d %s%s %s"):format(number, "command", number == 1 and "" or "s", (number == 1 and "is " or "are ") .. what)
end

-- What is told at the end of a script and on the standard error, line by line.
function threedec.report(result)
    local lines = { ("%s: %s converted, %d more need nothing in Talus"):format(result.file, count(result.converted, ""):gsub("%s+$", ""),
        result.needless) }
    local function add(list, what)
        if #list > 0 then
            lines[#lines + 1] = count(#list, what) .. ":"
        end
        for _, one in ipairs(list) do
            lines[#lines + 1] = ("%s:%d: %s: %s"):format(one.file, one.line, plain(one.source or ""):sub(1, 60), one.reason)
        end
    end
    add(result.mistakes, "wrong")
    add(result.left_out, "left out")
    add(result.in_part, "left out in part")
    return lines
end

-- A readable script.
function threedec.script(result)
    local lines = { "-- Written by `talus convert` from " .. result.file .. ".",
        "-- Gravity is 0 until it is given, as in 3DEC. Contacts of rigid faces are at their corners, as those of 3DEC: see",
        "-- docs/from_3dec.md for what changes without contact_points = \"corners\"." }
    table.move(head(result), 1, 3, #lines + 1, lines)
    for _, helper in ipairs(used_helpers(result)) do
        lines[#lines + 1] = ""
        lines[#lines + 1] = helper
    end
    lines[#lines + 1] = ""
    for _, item in ipairs(result.items) do
        write_item(lines, item)
    end
    while lines[#lines] == "" do
        lines[#lines] = nil
    end
    lines[#lines + 1] = ""
    for _, line in ipairs(threedec.report(result)) do
        lines[#lines + 1] = "-- " .. line
    end
    return table.concat(lines, "\n") .. "\n"
end

local function packed(code)
    return (code:gsub("%-%-[^\n]*\n", " "):gsub("\n%s*", " "))
end

-- The same as one chunk in which each command has the line of the data file, so that errors name it.
function threedec.chunk(result)
    local lines = {}
    local function put(line, code)
        for i = #lines + 1, line do
            lines[i] = ""
        end
        lines[line] = lines[line] .. (lines[line] ~= "" and " " or "") .. packed(code)
    end
    for _, code in ipairs(head(result)) do
        put(1, code)
    end
    for _, helper in ipairs(used_helpers(result)) do
        put(1, helper)
    end
    for _, item in ipairs(result.items) do
        if item.mistake then
            put(item.place, mistake_line(item))
        end
        for _, code in ipairs(item.code) do
            put(item.place, code)
        end
    end
    return table.concat(lines, "\n") .. "\n"
end

-- What `talus run` makes of a data file: its chunk. What is left out is told on the standard error.
function threedec.read(path)
    local result = threedec.convert(path)
    local report = threedec.report(result)
    if #report > 1 then
        io.stderr:write(table.concat(report, "\n"), "\n")
    end
    return threedec.chunk(result)
end

return threedec
