-- program.lua - functions of FISH that assign, loop, branch, fill tables and give commands: read as a tree, then run.
--
-- They run while the file is converted, for their bounds and conditions are known then: a loop becomes what each of its
-- rounds does. A function that does anything else is told as a whole. Of one that runs, each line that cannot be converted
-- is told, and variables that it would have set are not known afterwards.
local fish = require "talus.threedec.fish"
local lexer = require "talus.threedec.lexer"
local program = {}

-- Limit: statements that a call runs; a longer one is told. Limit: depth of functions that call each other.
local MOST_STATEMENTS = 5000
local MOST_DEPTH = 20

-- ---------------------------------------------------------------- reading ----------------

-- The word that a line of code is, without separators: `end_loop` and `end loop` are endloop.
local function plain_word(code)
    return (code:lower():gsub("[%s_%-]", ""))
end

-- Texts between commas that are in no parentheses or brackets.
local function split_arguments(text)
    local list, depth, from = {}, 0, 1
    for i = 1, #text do
        local c = text:sub(i, i)
        depth = depth + ((c == "(" or c == "[") and 1 or (c == ")" or c == "]") and -1 or 0)
        if c == "," and depth == 0 then
            list[#list + 1] = text:sub(from, i - 1)
            from = i + 1
        end
    end
    list[#list + 1] = text:sub(from)
    return #list == 1 and not list[1]:match "%S" and {} or list
end

-- An assignment, a value of a table or a call; nil when the line is something else.
function program.simple(code)
    local text = code:match "^%s*(.-)%s*$"
    local place, value = text:match "^table%s*(%b())%s*=%s*([^=].*)$"
    if not place then
        place, value = text:match "^table%.value%s*(%b())%s*=%s*([^=].*)$"
    end
    local at = place and split_arguments(place:sub(2, -2))
    if at then
        return #at == 2 and { kind = "table", name = at[1], at = at[2], text = value } or nil
    end
    local name, expression, is_local = fish.assignment(text)
    if name then
        return { kind = "assign", name = name, text = expression, is_local = is_local }
    end
    local called, arguments = text:match "^@?([%a_][%w_]*)%s*(%b())$"
    called = called or text:match "^@?([%a_][%w_]*)$"
    if called then
        return { kind = "call", name = called, arguments = arguments and split_arguments(arguments:sub(2, -2)) or {} }
    end
    return nil
end

local reader = {}
reader.__index = reader

function reader:refuse(line)
    error({ left_out = ("'%s' in line %d"):format(line.code:match "^%s*(.-)%s*$", line.line) }, 0)
end

-- The next line with code, its continuations joined; nil at the end.
function reader:line()
    while self.lines[self.at] do
        local first = self.lines[self.at]
        local code = first.code:gsub("%s+$", "")
        self.at = self.at + 1
        while code:match "%.%.%.$" and self.lines[self.at] do
            code = code:gsub("%.%.%.$", " ") .. self.lines[self.at].code:gsub("%s+$", "")
            self.at = self.at + 1
        end
        if code:match "%S" then
            return { line = first.line, code = code }
        end
    end
    return nil
end

-- `command` ... `endcommand`: the statements of the file in it.
function reader:commands(head)
    local texts = {}
    while self.lines[self.at] do
        local line = self.lines[self.at]
        self.at = self.at + 1
        if plain_word(line.code) == "endcommand" then
            local list = lexer.statements(table.concat(texts, "\n"))
            for _, statement in ipairs(list) do
                statement.line = statement.line + head.line
            end
            return { kind = "commands", line = head.line, list = list }
        end
        texts[#texts + 1] = line.code
    end
    self:refuse(head)
end

function reader:loop(head)
    local name, bounds = head.code:lower():match "^%s*loop%s+([%a_][%w_]*)%s*(%b())%s*$"
    if not name then
        name, bounds = head.code:lower():match "^%s*loop%s+local%s+([%a_][%w_]*)%s*(%b())%s*$"
    end
    local list = bounds and split_arguments(bounds:sub(2, -2)) or {}
    if #list ~= 2 then
        self:refuse(head)
    end
    local body, ending = self:block()
    if ending ~= "endloop" then
        self:refuse(head)
    end
    return { kind = "loop", name = name, from = list[1], to = list[2], body = body }
end

local function condition_of(code)
    return (code:gsub("%s+[tT][hH][eE][nN]%s*$", ""))
end

function reader:branches(head)
    local node = { kind = "if" }
    local condition = condition_of(head.code:match "^%s*%a+%s*(.*)$")
    while true do
        local body, ending, line = self:block()
        node[#node + 1] = { condition = condition, body = body }
        if ending == "endif" then
            return node
        elseif ending == "else" and condition then
            condition = nil
        elseif ending == "elseif" and condition then
            local after = line.code:match "^%s*[eE][lL][sS][eE][%s_]*[iI][fF]%s*(.*)$"
            if not after then
                self:refuse(line)
            end
            condition = condition_of(after)
        else
            self:refuse(head)
        end
    end
end

-- Statements up to a line that ends them: that line as a word, and the line itself.
function reader:block()
    local list = {}
    while true do
        local line = self:line()
        local word = line and plain_word(line.code)
        local first = line and line.code:lower():match "^%s*(%a+)"
        if not line or word == "endloop" or word == "endif" or word == "else" then
            return list, word, line
        elseif first == "else" then
            return list, "elseif", line
        end
        local node
        if word == "command" then
            node = self:commands(line)
        elseif first == "loop" then
            node = self:loop(line)
        elseif first == "if" then
            node = self:branches(line)
        elseif first ~= "exit" and first ~= "return" and first ~= "continue" then
            node = program.simple(line.code)
        end
        if not node then
            self:refuse(line)
        end
        node.line, node.code = line.line, line.code
        list[#list + 1] = node
    end
end

-- The tree of a function's lines; nil and why when it does more than this.
function program.read(lines)
    local r = setmetatable({ lines = lines, at = 1 }, reader)
    local ok, tree, ending = pcall(r.block, r)
    if not ok then
        if type(tree) ~= "table" then
            error(tree, 0)
        end
        return nil, tree.left_out or tree.mistake
    elseif ending then
        return nil, "'" .. ending .. "' ends nothing"
    end
    return tree
end

-- ---------------------------------------------------------------- running ----------------

-- Variables that statements may set are not known any more.
local function forget(c, list)
    for _, node in ipairs(list) do
        if node.kind == "assign" then
            c.variables[fish.name(node.name)] = nil
        end
        forget(c, node.body or {})
        for _, branch in ipairs(node.kind == "if" and node or {}) do
            forget(c, branch.body)
        end
    end
end

-- The same of lines that are no tree.
function program.forget_lines(c, lines)
    for _, line in ipairs(lines) do
        local name = fish.assignment(line.code)
        if name then
            c.variables[fish.name(name)] = nil
        end
    end
end

local run

-- Binds a name to a value, until the function ends.
local function bind(c, locals, name, item)
    local lua = fish.name(name)
    if not locals[lua] then
        locals[lua] = { c.variables[lua] }
    end
    c.variables[lua] = type(item.value) == "number" and c.value(item.value) or item
end

local function unbind(c, locals)
    for lua, before in pairs(locals) do
        c.variables[lua] = before[1]
    end
end

local handlers = {}

function handlers.assign(c, node, locals)
    local known, item = pcall(fish.expression, node.text, c.variables)
    if not known then
        c.variables[fish.name(node.name)] = nil
        error(item, 0)
    end
    if not locals or not (node.is_local or locals[fish.name(node.name)]) then
        c.assign(node.name, item)
    elseif item.vector then
        c.variables[fish.name(node.name)] = nil
        lexer.leave "vectors in variables of FISH are not converted"
    else
        bind(c, locals, node.name, item)
        c.nothing = true
    end
end

handlers["table"] = function(c, node)
    local name = fish.expression(node.name, c.variables).value
    local at, value = fish.expression(node.at, c.variables), fish.expression(node.text, c.variables)
    if name == nil or type(at.value) ~= "number" or type(value.value) ~= "number" then
        lexer.leave "FISH: a table needs a name and two numbers"
    end
    c.table_rows(tostring(name), { { at, value } })
end

function handlers.call(c, node)
    local called = c.functions[fish.name(node.name)]
    if not called or not called.tree then
        program.forget_lines(c, called and called.lines or {})
        lexer.leave("the FISH function '%s' is not converted: write it in Lua", node.name)
    end
    program.run(c, called, node.arguments)
end

handlers["loop"] = function(c, node, locals)
    local from, to = fish.expression(node.from, c.variables).value, fish.expression(node.to, c.variables).value
    if type(from) ~= "number" or type(to) ~= "number" then
        lexer.leave "FISH: a loop needs two numbers"
    elseif from > to then
        lexer.leave("FISH: a loop from %s down to %s", from, to)
    end
    for i = from, to do
        bind(c, locals, node.name, { value = i })
        run(c, node.body, locals)
    end
end

handlers["if"] = function(c, node, locals)
    for _, branch in ipairs(node) do
        if not branch.condition or fish.condition(branch.condition, c.variables) then
            run(c, branch.body, locals)
            break
        end
    end
end

function handlers.commands(c, node)
    for _, statement in ipairs(node.list) do
        c.convert(statement)
    end
end

-- Runs statements, each as an item of its own.
function run(c, list, locals)
    for _, node in ipairs(list) do
        c.statements_left = c.statements_left - 1
        if c.statements_left < 0 then
            error({ too_long = true }, 0)
        end
        if node.kind == "commands" then
            handlers.commands(c, node)
        else
            c.convert({ kind = "program", line = node.line, code = node.code, node = node, locals = locals })
        end
    end
end

-- One statement of a function. What it cannot do is told, and what it would have set is not known.
function program.step(c, node, locals)
    local ok, failure = pcall(handlers[node.kind], c, node, locals)
    if not ok then
        forget(c, { node })
        error(failure, 0)
    end
    c.nothing = c.nothing or node.kind ~= "assign" and node.kind ~= "table"
end

-- Runs a function {tree =, parameters =} with the texts of its arguments.
function program.run(c, called, arguments)
    local outermost = not c.statements_left
    local locals = {}
    if #arguments ~= #called.parameters then
        lexer.leave("the FISH function '%s' has %d arguments, not %d", called.name, #called.parameters, #arguments)
    end
    local items = {}
    for i, text in ipairs(arguments) do
        items[i] = fish.expression(text, c.variables)
    end
    c.depth = (c.depth or 0) + 1
    c.statements_left = c.statements_left or MOST_STATEMENTS
    for i, name in ipairs(called.parameters) do
        bind(c, locals, name, items[i])
    end
    local own, place = c.item, c.place
    c.place = own.place
    local ok, failure = true, { too_long = true }
    if c.depth <= MOST_DEPTH then
        ok, failure = pcall(run, c, called.tree, locals)
    else
        ok = false
    end
    c.item, c.place, c.depth = own, place, c.depth - 1
    unbind(c, locals)
    if outermost then
        c.statements_left = nil
    end
    c.nothing = true
    if ok then
        return
    end
    forget(c, called.tree)
    if outermost and type(failure) == "table" and failure.too_long then
        lexer.leave("the FISH function '%s' runs more than %d statements, or calls itself: what comes after them is left out",
            called.name, MOST_STATEMENTS)
    end
    error(failure, 0)
end

return program
