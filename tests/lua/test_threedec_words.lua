-- Data files of 3DEC written in other ways mean the same: words abbreviated and in capitals, lines continued, other
-- separators, keywords in another order, comments. And no text at all makes the converter fail.
require "talus"
local check = require "check"
local lexer = require "talus.threedec.lexer"
local threedec = require "talus.threedec"
local words = require "talus.threedec.words"

math.randomseed(39)

local function convert(text)
    return threedec.convert("test.3ddat", { text = text, read = function() return "block fix\n" end })
end

local function code_of(result)
    local all = {}
    for _, item in ipairs(result.items) do
        table.move(item.code, 1, #item.code, #all + 1, all)
        all[#all + 1] = item.left_out
    end
    return table.concat(all, "\n")
end

-- A word with each of its parts cut to at least three letters.
local function shorter(word)
    return (word:gsub("[%a]+", function(part)
        return part:sub(1, math.random(math.min(3, #part), #part))
    end))
end

local function other_case(word)
    return (word:gsub("%a", function(letter)
        return math.random() < 0.3 and letter:upper() or letter
    end))
end

local SEPARATORS = { " ", ", ", "  ", "\t", " = ", " ...\n  ", " & ; why not\n", " ( " }
local NAMES = { base = true, low = true, wave = true } -- of groups, ranges and functions in the examples

-- The tokens of a command as another text; words change by `change`.
local function write(tokens, change)
    local parts = {}
    for i, token in ipairs(tokens) do
        local text = token.text
        if token.kind == "word" and not NAMES[text] then
            text = change(text)
        elseif token.kind == "text" then
            text = (math.random() < 0.5 and "'%s'" or '"%s"'):format(text)
        elseif token.kind == "expression" then
            text = "[" .. text .. "]"
        end
        parts[#parts + 1] = text
        local last = i == #tokens
        parts[#parts + 1] = last and "" or SEPARATORS[math.random(#SEPARATORS)]
    end
    return table.concat(parts) .. (math.random() < 0.3 and " ; a comment" or "")
end

local examples = {}
for _, row in ipairs(words.rows) do
    for _, example in ipairs(type(row.example) == "string" and { row.example } or row.example or {}) do
        examples[#examples + 1] = example
    end
end

local same, ambiguous = 0, 0
for case = 1, check.cases(3000) do
    local example = examples[case % #examples + 1]
    local function rewrite(change)
        local commands = {}
        for _, statement in ipairs(lexer.statements(example)) do
            local text = statement.code
            if statement.kind == "command" then
                text = write(statement.tokens, change)
            elseif statement.kind == "function" then
                text = "FISH def " .. statement.name
                for _, one in ipairs(statement.body) do
                    text = text .. "\n" .. one.code
                end
                text = text .. "\nEnd"
            end
            commands[#commands + 1] = text
        end
        return table.concat(commands, "\n")
    end
    local expected = convert("block create brick 0 1\n" .. example)
    local text = "block create brick 0 1\n" .. rewrite(function(word)
        return other_case(shorter(word))
    end)
    local result = convert(text)
    local wrong = result.mistakes[1]
    if wrong and wrong.reason:match "may be" then
        ambiguous = ambiguous + 1 -- told as such: never another meaning
    else
        assert(not wrong, text .. "\n" .. (wrong and wrong.reason or ""))
        local a, b = code_of(result), code_of(expected)
        assert(a == b, text .. "\n" .. a .. "\n" .. b)
        same = same + 1
    end
end
assert(same > 5 * ambiguous, ("%d the same, %d ambiguous"):format(same, ambiguous))

-- Keywords with their values in any order.
local PAIRS = {
    ["block contact property"] = { "stiffness-normal 1e9", "stiffness-shear 2e9", "friction 30", "cohesion 1e5", "tension 1e4", "dilation 3" },
    ["jset"] = { "dip 30", "dd 60", "origin 1 2 3", "spacing 0.5", "number 3", "persistence 0.5", "id 4" },
    ["prop jmat=1"] = { "jkn 1e9", "jks 2e9", "jfric 30", "jcoh 1e5" },
    ["block fix velocity-x range"] = { "group 'a'", "position-x 0 1", "position-z 0 2" },
}
for _ = 1, check.cases(200) do
    for command, pairs_of in pairs(PAIRS) do
        local order = table.move(pairs_of, 1, #pairs_of, 1, {})
        for i = #order, 2, -1 do
            local k = math.random(i)
            order[i], order[k] = order[k], order[i]
        end
        local result = convert(command .. " " .. table.concat(order, " "))
        assert(#result.mistakes == 0, result.mistakes[1] and result.mistakes[1].reason)
        if not command:match "range" then
            check.equal(code_of(result), code_of(convert(command .. " " .. table.concat(pairs_of, " "))))
        else
            assert(code_of(result):match "group = \"a\"" and code_of(result):match "centroid%[1%]" and code_of(result):match "centroid%[3%]")
        end
    end
end

-- Any text is converted, left out or told as wrong, and the script is Lua.
local BITS = { "block", "create", "brick", "range", "group", "'a'", "'", '"', "[", "]", "@x", "[x = 1]", "1", "-2.5", "1e400", "...", "&", ";",
    "\n", "\n", "fish define f", "end", "position-x", "not", "union", "plane", "dip", "jset", "prop", "mat", "jmat", "=", "(", ")", ",",
    "solve", "ratio", "property", "stiffness-normal", "hist", "zdisp", "table", "poly", "face", "prism", "a", "b", "tunnel", "\0", "\255", "--",
    "]]", "\\", "%s", "change", "zone", "cmodel", "assign", "elastic", "edgelength", "call", "name", "vector(1,2,3)", "[vector(1,2,3)]", "[1/0]",
    "*", "loop", "local", "i", "(1,3)", "endloop", "if", "then", "else", "endif", "command", "endcommand", "table(1,2) = 3", "f", "[f]", "i = i + 1" }
for _ = 1, check.cases(3000) do
    local parts = {}
    for i = 1, math.random(30) do
        parts[i] = BITS[math.random(#BITS)]
    end
    local text = table.concat(parts, " ")
    local good, result = pcall(convert, text)
    assert(good, ("%q: %s"):format(text, tostring(result)))
    local script, why = load(threedec.script(result), "=script", "t")
    assert(script, ("%q: %s"):format(text, tostring(why)))
    script, why = load(threedec.chunk(result), "=chunk", "t")
    assert(script, ("%q: %s"):format(text, tostring(why)))
end

-- Of 20 commands each is converted, needs nothing, is left out or is wrong, and that is counted. So are lines of functions that run.
local COMMANDS = { "def f\nloop i (1,n)\nif i # 2 then\ncommand\npoly brick 0 1 0 1 0 [i]\nplot block\nendcommand\nelse\nq = q + i\nendif\nendloop\nend",
    "def g\ntable(1,n) = q\nf\nend", "def h\nloop while n < 3\nendloop\nend", "@f", "g", "[h]", "[n = 3]", "[n = 20]", "[q = 0]", "[q = r]",
    "* a comment", "; another", "", "blok", "plot create", "block contact property friction [q]", "jset or 0 0 1 dip [10*q]" }
for _, row in ipairs(words.rows) do
    for _, example in ipairs(type(row.example) == "string" and { row.example } or row.example or {}) do
        COMMANDS[#COMMANDS + 1] = not example:match "call" and example or nil
    end
end
for _ = 1, check.cases(500) do
    local parts = {}
    for i = 1, 20 do
        local command = COMMANDS[math.random(#COMMANDS)]
        if math.random(3) == 1 then -- a word of another command in the place of one
            local bits = {}
            for bit in command:gmatch "[^ ]+" do
                bits[#bits + 1] = math.random(6) == 1 and BITS[math.random(#BITS)]:gsub("[\n;&.*]", "") or bit
            end
            command = table.concat(bits, " ")
        end
        parts[i] = command
    end
    local text = table.concat(parts, "\n")
    local good, result = pcall(threedec.convert, "test.3ddat", { text = text, read = function() end }) -- `call` finds no file
    assert(good, ("%q: %s"):format(text, tostring(result)))
    local script, why = load(threedec.script(result), "=script", "t")
    assert(script, ("%q: %s"):format(text, tostring(why)))
    local lines, told, found = {}, {}, 0
    for _, statement in ipairs(lexer.statements(text)) do
        lines[statement.line] = statement.kind ~= "blank" or nil
    end
    for _, item in ipairs(result.items) do -- of functions, too
        lines[item.line] = lines[item.line] or item.kind ~= "blank" or nil
    end
    for _, list in ipairs { result.mistakes, result.left_out } do
        for _, one in ipairs(list) do
            told[one.line] = true
        end
    end
    for line in pairs(lines) do
        found = found + 1
    end
    local count = 0
    for line in pairs(told) do
        assert(lines[line], text)
        count = count + 1
    end
    assert(count + result.converted + result.needless == found, ("%d told, %d converted, %d needless of %d:\n%s"):format(count, result.converted,
        result.needless, found, text))
end
