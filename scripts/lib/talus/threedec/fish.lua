-- fish.lua - turns arithmetic of FISH into Lua: numbers, variables, + - * / ^, functions of math; finds if conditions hold.
--
-- Each expression is evaluated as well, for what a command means may depend on a value. As in FISH the quotient of two
-- whole numbers is a whole number, and angles of sin and cos are in radians.
local lexer = require "talus.threedec.lexer"
local fish = {}

local functions = {
    sin = "sin", cos = "cos", tan = "tan", asin = "asin", acos = "acos", atan = "atan", atan2 = "atan", sqrt = "sqrt",
    abs = "abs", exp = "exp", ln = "log", max = "max", min = "min", floor = "floor", ceiling = "ceil",
}

-- Reserved words of Lua, and names that a converted script uses.
local taken = {}
for word in ([[and break do else elseif end false for function goto if in local nil not or repeat return then true until
        while model talus math print error]]):gmatch "%a+" do
    taken[word] = true
end

-- The name in Lua of a variable of FISH, whose names are the same in upper and lower case.
function fish.name(name)
    local plain = name:lower():gsub("[^%w_]", "_"):gsub("^%d", "_%0")
    return taken[plain] and plain .. "_" or plain
end

local reader = {}
reader.__index = reader

local function split(text)
    local tokens, i = {}, 1
    while true do
        i = text:find("%S", i)
        if not i then
            return tokens
        end
        local token = text:match("^%d+%.?%d*[eEdD][+-]?%d+", i) or text:match("^%.?%d+%.?%d*", i) or
            text:match("^@?[%a_][%w_.]*", i) or text:match("^'[^']*'", i) or text:match('^"[^"]*"', i) or
            text:match("^[<>!=]=", i) or text:sub(i, i)
        tokens[#tokens + 1] = token
        i = i + #token
    end
end

function reader:next(token)
    if token and self[self.at] ~= token then
        return nil
    end
    self.at = self.at + 1
    return self[self.at - 1]
end

-- The text of an operand: in parentheses where its operators bind less than `level`.
local function within(item, level)
    return item.level < level and "(" .. item.lua .. ")" or item.lua
end

local function numeric(item, operator)
    if type(item.value) ~= "number" then
        lexer.leave("FISH: %s needs numbers", operator)
    end
    return item.value
end

local function quotient(a, b)
    local x, y = numeric(a, "/"), numeric(b, "/")
    if y == 0 then
        lexer.leave("FISH: a division by zero")
    end
    if math.type(x) ~= "integer" or math.type(y) ~= "integer" then
        return { lua = within(a, 2) .. " / " .. within(b, 3), value = x / y, level = 2 }
    end
    local whole = math.tointeger(x / y) or (x / y >= 0 and x // y or -(-x // y))
    local text = x / y >= 0 and within(a, 2) .. " // " .. within(b, 3) or tostring(whole)
    return { lua = text, value = whole, level = 2 }
end

local function arithmetic(a, operator, b)
    local x, y = numeric(a, operator), numeric(b, operator)
    if operator == "^" then
        return { lua = within(a, 5) .. "^" .. within(b, 4), value = x ^ y, level = 4 }
    end
    local level = operator == "*" and 2 or 1
    local value = operator == "+" and x + y or operator == "-" and x - y or x * y
    return { lua = within(a, level) .. " " .. operator .. " " .. within(b, level + 1), value = value, level = level }
end

-- A function with its arguments in parentheses, after its name.
local function call(r, name)
    local items = {}
    repeat
        items[#items + 1] = r:sum()
    until not r:next ","
    if not r:next ")" then
        lexer.leave("FISH: %s( is not closed", name)
    end
    local short = name:gsub("^math%.", "")
    if short == "vector" then
        return { vector = items, level = 9 }
    end
    local lua = functions[short]
    if short == "float" and #items == 1 then
        return { lua = "1.0 * " .. within(items[1], 2), value = 1.0 * numeric(items[1], name), level = 2 }
    elseif short == "int" and #items == 1 then
        lua = numeric(items[1], name) >= 0 and "floor" or "ceil"
    elseif not lua then
        lexer.leave("FISH: the function '%s' is not known", name)
    end
    local texts, values = {}, {}
    for i, item in ipairs(items) do
        texts[i], values[i] = item.lua, numeric(item, name)
    end
    return { lua = "math." .. lua .. "(" .. table.concat(texts, ", ") .. ")", value = math[lua](table.unpack(values)), level = 9 }
end

function reader:operand()
    local token = self:next()
    if not token then
        lexer.leave("FISH: a value is missing")
    elseif token == "-" then
        local item = self:power()
        return { lua = "-" .. within(item, 4), value = -numeric(item, "-"), level = 3 }
    elseif token == "+" then
        return self:power()
    elseif token == "(" then
        local item = self:sum()
        if not self:next ")" then
            lexer.leave("FISH: a parenthesis is not closed")
        end
        return item
    end
    local text, value = lexer.number(token)
    if text then
        return { lua = text, value = value, level = 9 }
    elseif token:match "^['\"]" then
        return { lua = ("%q"):format(token:sub(2, -2)), value = token:sub(2, -2), level = 9 }
    elseif not token:match "^@?[%a_]" then
        lexer.leave("FISH: '%s' is not expected", token)
    end
    local name = token:gsub("^@", ""):lower()
    if self:next "(" then
        return call(self, name)
    elseif name == "math.pi" or name == "pi" then
        return { lua = "math.pi", value = math.pi, level = 9 }
    end
    local variable = self.variables[fish.name(name)]
    if not variable then
        lexer.leave("FISH: the variable '%s' has no value that is known here", name)
    end
    return { lua = variable.lua, value = variable.value, level = variable.level or 9 }
end

function reader:power()
    local item = self:operand()
    while self:next "^" do
        item = arithmetic(item, "^", self:operand())
    end
    return item
end

function reader:product()
    local item = self:power()
    while self[self.at] == "*" or self[self.at] == "/" do
        local operator = self:next()
        local other = self:power()
        item = operator == "*" and arithmetic(item, "*", other) or quotient(item, other)
    end
    return item
end

function reader:sum()
    local item = self:product()
    while self[self.at] == "+" or self[self.at] == "-" do
        item = arithmetic(item, self:next(), self:product())
    end
    return item
end

-- ---------------------------------------------------------------- conditions -------------

local compare = {
    ["="] = function(a, b) return a == b end, ["#"] = function(a, b) return a ~= b end,
    ["<"] = function(a, b) return a < b end, ["<="] = function(a, b) return a <= b end,
    [">"] = function(a, b) return a > b end, [">="] = function(a, b) return a >= b end,
}
compare["=="], compare["!="] = compare["="], compare["#"]

-- Whether two values compare so, as in `i < 3`; a condition in parentheses is one, too.
function reader:comparison()
    local from = self.at
    local ok, a = pcall(self.sum, self)
    local test = ok and compare[self[self.at]]
    if test then
        self.at = self.at + 1
        local b = self:sum()
        if type(a.value) ~= type(b.value) or type(a.value) ~= "number" and test ~= compare["="] and test ~= compare["#"] then
            lexer.leave "FISH: a comparison needs two numbers, or two texts for equality"
        end
        return test(a.value, b.value)
    end
    self.at = from
    if not self:next "(" then
        lexer.leave "FISH: a comparison is missing"
    end
    local holds = self:alternative()
    if not self:next ")" then
        lexer.leave "FISH: a parenthesis is not closed"
    end
    return holds
end

function reader:next_word(word)
    local token = self[self.at]
    if token and token:lower() == word then
        self.at = self.at + 1
        return true
    end
    return false
end

function reader:negation()
    if self:next_word "not" then
        return not self:negation()
    end
    return self:comparison()
end

function reader:conjunction()
    local holds = self:negation()
    while self:next_word "and" do
        local other = self:negation()
        holds = holds and other
    end
    return holds
end

function reader:alternative()
    local holds = self:conjunction()
    while self:next_word "or" do
        local other = self:conjunction()
        holds = holds or other
    end
    return holds
end

-- Whether a condition of values that are known here holds.
function fish.condition(text, variables)
    local r = setmetatable(split(text), reader)
    r.at, r.variables = 1, variables
    local holds = r:alternative()
    if r[r.at] then
        lexer.leave("FISH: '%s' is not expected", r[r.at])
    end
    return holds
end

-- {lua = text, value = number or text, level =} of an expression, or {vector = three of these}.
-- `variables`: by name in Lua {lua =, value =}.
function fish.expression(text, variables)
    local r = setmetatable(split(text), reader)
    r.at, r.variables = 1, variables
    local item = r:sum()
    if r[r.at] then
        lexer.leave("FISH: '%s' is not expected", r[r.at])
    end
    return item
end

-- Name and expression of an assignment such as `global kn = 2 * ks`, and whether it is local; nil when the text is none.
function fish.assignment(text)
    local plain = text:gsub("^%s*[gG][lL][oO][bB][aA][lL]%s+", "")
    local rest = plain:gsub("^%s*[lL][oO][cC][aA][lL]%s+", "")
    local name, value = rest:match "^%s*@?([%a_][%w_]*)%s*=%s*([^=].-)%s*$"
    return name, value, rest ~= plain
end

return fish
