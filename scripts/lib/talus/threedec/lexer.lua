-- lexer.lua - reads the text of a data file of 3DEC into statements: commands, FISH lines and FISH functions.
--
-- A command ends with its line unless the line ends with `...` or `&`. A comment begins with `;`, or is a line
-- that begins with `*`. Commas, `=` and
-- parentheses only separate. A value in `[...]` or after `@` is an expression of FISH (fish.lua).
local lexer = {}

-- A mistake in a data file: raised as a table, told with file and line by threedec.lua.
function lexer.mistake(format, ...)
    error({ mistake = string.format(format, ...) }, 0)
end

-- What has no counterpart: raised as a table; the command is left out for this reason.
function lexer.leave(format, ...)
    error({ left_out = string.format(format, ...) }, 0)
end

-- Code of a line before its comment, and the comment without `;`; what is in quotes has no comment. A line that begins
-- with `*` is a comment of classic files.
local function split_comment(line)
    local quote, starred = nil, line:match "^%s*%*+%s?(.*)$"
    if starred then
        return "", (starred:gsub("%s+$", ""))
    end
    for i = 1, #line do
        local c = line:sub(i, i)
        if quote then
            quote = c ~= quote and quote or nil
        elseif c == "'" or c == '"' then
            quote = c
        elseif c == ";" then
            return line:sub(1, i - 1), (line:sub(i + 1):gsub("^;*%s?", ""):gsub("%s+$", ""))
        end
    end
    return line, nil
end

-- The number that a word of 3DEC writes, as Lua writes it and as a value; nil when it is none. 3DEC takes 1d5 for 1e5.
function lexer.number(word)
    local plain = word:lower():gsub("^%+", ""):gsub("d", "e")
    if not plain:match "^%-?%d*%.?%d*e?[+-]?%d*$" or not plain:match "%d" then
        return nil
    end
    plain = plain:gsub("^(%-?)%.", "%10."):gsub("%.$", ""):gsub("%.e", "e")
    local value = tonumber(plain)
    return value and plain, value
end

local function bracket_end(code, from)
    local depth = 0
    for i = from, #code do
        local c = code:sub(i, i)
        depth = depth + (c == "[" and 1 or c == "]" and -1 or 0)
        if depth == 0 then
            return i
        end
    end
    lexer.mistake("the bracket [ is not closed")
end

-- The tokens of a command: {kind = "word" | "text" | "number" | "expression", text =, value =}.
function lexer.tokens(code)
    local tokens, i = {}, 1
    local function add(kind, text, value)
        tokens[#tokens + 1] = { kind = kind, text = text, value = value }
    end
    while true do
        i = code:find("[^%s,=()]", i)
        if not i then
            return tokens
        end
        local c, sign = code:sub(i, i), ""
        if c == "-" and code:match("^%-[@%[]", i) then
            c, sign, i = code:sub(i + 1, i + 1), "-", i + 1
        end
        if c == "'" or c == '"' then
            local close = code:find(c, i + 1, true) or lexer.mistake("the quote %s is not closed", c)
            add("text", code:sub(i + 1, close - 1))
            i = close + 1
        elseif c == "[" then
            local close = bracket_end(code, i)
            local inside = code:sub(i + 1, close - 1)
            add("expression", sign == "" and inside or "-(" .. inside .. ")")
            i = close + 1
        else
            local word = code:match("^[^%s,=()%['\"]+", i)
            local text, value = lexer.number(word)
            if word:sub(1, 1) == "@" then
                add("expression", sign .. word:sub(2))
            elseif text then
                add("number", text, value)
            else
                add("word", word)
            end
            i = i + #word
        end
    end
end

-- Name of the FISH function that begins on this line, and its parameters; nil when none does.
local function function_name(code)
    local lower = code:lower()
    local rest = lower:match "^%s*fish%s+(.*)$" or lower
    local word, name, parameters = rest:match "^%s*(%a+)%s+([%w_%-]+)%s*(.*)$"
    if word and #word >= 3 and (("define"):sub(1, #word) == word or ("operator"):sub(1, #word) == word) then
        local list = {}
        for parameter in parameters:gmatch "[%a_][%w_]*" do
            list[#list + 1] = parameter
        end
        return name, list
    end
    return nil
end

-- Lines from, from + 1 ... are a FISH function, up to the line `end`; gives it and the line after it.
local function read_function(lines, from, name, parameters)
    local body = {}
    for i = from + 1, #lines do
        local code, comment = split_comment(lines[i])
        if code:lower():match "^%s*end%s*$" then
            return { kind = "function", name = name, parameters = parameters, line = from, last = i, body = body }, i + 1
        end
        body[#body + 1] = { line = i, code = code, comment = comment }
    end
    lexer.mistake("the FISH function '%s' has no end", name)
end

-- A command or FISH line that begins at this line; gives it and the line after it.
local function read_command(lines, from)
    local parts, comments, i = {}, {}, from
    while true do
        local code, comment = split_comment(lines[i])
        if comment then
            comments[#comments + 1] = comment
        end
        local plain = code:gsub("%s+$", "")
        local more = plain:match "%.%.%.$" or plain:match "&$"
        parts[#parts + 1] = more and plain:sub(1, -1 - #more) or plain
        i = i + 1
        if not more or not lines[i] then
            break
        end
    end
    local code = table.concat(parts, " "):gsub("^%s+", "")
    local comment = #comments > 0 and table.concat(comments, " ") or nil
    local kind = code == "" and "blank" or (code:match "^%[" or code:match "^@") and "fish" or "command"
    return { kind = kind, line = from, last = i - 1, code = code, comment = comment }, i
end

-- The statements of a text, in order: {kind = "command" | "fish" | "function" | "blank", line =, ...}. A mistake is a
-- statement, too: {kind = "mistake", line =, reason =}.
function lexer.statements(text)
    local lines, statements, i = {}, {}, 1
    for line in (text:gsub("\r\n?", "\n") .. "\n"):gmatch "([^\n]*)\n" do
        lines[#lines + 1] = line
    end
    while i <= #lines do
        local name, parameters = function_name((split_comment(lines[i])))
        local ok, statement, after = pcall(name and read_function or read_command, lines, i, name, parameters)
        if ok and statement.kind == "command" then
            ok, statement.tokens = pcall(lexer.tokens, statement.code)
            if not ok then
                statement = statement.tokens
            elseif #statement.tokens == 0 then
                statement.kind = "blank"
            end
        end
        if ok then
            i = after
        else
            if type(statement) ~= "table" then
                error(statement, 0)
            end
            statement = { kind = "mistake", line = i, code = lines[i], reason = statement.mistake }
            i = name and #lines + 1 or i + 1
        end
        statements[#statements + 1] = statement
    end
    return statements
end

return lexer
