-- arguments.lua - the words of a command, read one after the other: numbers, vectors, texts and keywords.
--
-- A number is {lua = text, value = number, level =}: its text may be an expression of the script's variables.
local fish = require "talus.threedec.fish"
local lexer = require "talus.threedec.lexer"
local match = require "talus.threedec.match"
local arguments = {}
arguments.__index = arguments

-- Of the tokens of a command from the one at `first`. `command` is how the file names it; `variables` are those of FISH.
function arguments.new(tokens, first, command, variables)
    return setmetatable({ tokens = tokens, at = first, command = command, variables = variables, spare = {} }, arguments)
end

function arguments:peek()
    return self.tokens[self.at]
end

function arguments:more()
    return self.at <= #self.tokens or #self.spare > 0
end

-- Whether the next word stands for one of these; it is not read.
function arguments:sees(...)
    local token = self:peek()
    return token and token.kind == "word" and match.find(token.text, { ... }, self.command) or nil
end

-- Reads the next word if it stands for one of these.
function arguments:take(...)
    local word = self:sees(...)
    if word then
        self.at = self.at + 1
    end
    return word
end

-- Whether the next token is a number, or an expression that is one.
function arguments:sees_number()
    local token = self:peek()
    return #self.spare > 0 or token ~= nil and (token.kind == "number" or token.kind == "expression")
end

function arguments:number(what)
    if #self.spare > 0 then
        return table.remove(self.spare, 1)
    end
    local token = self:peek()
    -- classic files write a variable's bare name
    local bare = token and token.kind == "word" and self.variables[fish.name(token.text)] ~= nil
    if not token or token.kind ~= "number" and token.kind ~= "expression" and not bare then
        lexer.mistake("%s: %s must be a number%s", self.command, what, token and ", not '" .. token.text .. "'" or "")
    end
    self.at = self.at + 1
    if token.kind == "number" then
        return { lua = token.text, value = token.value, level = token.value < 0 and 3 or 9 }
    end
    local item = fish.expression(token.text, self.variables)
    if item.vector then
        self.spare = item.vector
        return table.remove(self.spare, 1)
    elseif type(item.value) ~= "number" then
        lexer.mistake("%s: %s must be a number, not \"%s\"", self.command, what, tostring(item.value))
    end
    return item
end

-- A number if one comes next, else nil.
function arguments:optional()
    return self:sees_number() and self:number "a value" or nil
end

function arguments:whole(what)
    local item = self:number(what)
    local whole = math.tointeger(item.value)
    if not whole then
        lexer.mistake("%s: %s must be a whole number, not %s", self.command, what, item.lua)
    end
    return whole
end

-- A list of numbers, as many as `count`.
function arguments:numbers(count, what)
    local list = {}
    for i = 1, count do
        list[i] = self:number(what)
    end
    return list
end

function arguments:vector(what)
    return self:numbers(3, what)
end

-- All vectors up to the next word.
function arguments:vectors(what, least)
    local list = {}
    while self:sees_number() do
        list[#list + 1] = self:vector(what)
    end
    if #list < least then
        lexer.mistake("%s: %s needs at least %d points, not %d", self.command, what, least, #list)
    end
    return list
end

-- A name: a word, a text in quotes, a number or the value of a variable.
function arguments:text(what)
    local token = self:peek()
    if not token or #self.spare > 0 then
        lexer.mistake("%s: %s is missing", self.command, what)
    end
    self.at = self.at + 1
    if token.kind == "expression" then
        return tostring(fish.expression(token.text, self.variables).value)
    end
    return token.text
end

-- The keyword that comes next; a mistake when it is none of these.
function arguments:keyword(known)
    local token = self:peek()
    if #self.spare > 0 or not token or token.kind ~= "word" and token.kind ~= "text" then
        lexer.mistake("%s: '%s' is not expected; a word is: %s", self.command, token and token.text or "a vector", known[1])
    end
    self.at = self.at + 1
    return match.need(token.text, known, self.command)
end

-- Whether the words up to a range are read: the next begins one, or nothing is left.
function arguments:at_range()
    return not self:more() or self:sees "range" ~= nil
end

-- Reads true or false, on or off, yes or no; `default` when none is there.
function arguments:switch(default)
    local word = self:take("on", "off", "yes", "no", "true", "false")
    if not word then
        return default
    end
    return word == "on" or word == "yes" or word == "true"
end

return arguments
