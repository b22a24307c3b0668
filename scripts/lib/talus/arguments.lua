-- arguments.lua - checks the tables that Talus's own Lua modules are called with, and raises at the caller's line.
local talus = require "talus"
local arguments = {}

-- Number of insertions, deletions and changes of a letter that lead from one word to the other.
local function distance(a, b)
    local row = {}
    for j = 0, #b do
        row[j] = j
    end
    for i = 1, #a do
        local corner = row[0]
        row[0] = i
        for j = 1, #b do
            local change = corner + (a:byte(i) == b:byte(j) and 0 or 1)
            corner = row[j]
            row[j] = math.min(row[j] + 1, row[j - 1] + 1, change)
        end
    end
    return row[#b]
end

-- The known word that a wrong one most likely means, or nil. Places of a list are no words.
function arguments.nearest(word, known)
    local best, name = #word // 3 + 2, nil
    for _, candidate in ipairs(known) do
        local far = type(candidate) == "string" and distance(word, candidate) or math.huge
        if far < best or far < math.huge and candidate:sub(1, #word) == word and #word > 1 and not name then
            best, name = math.min(far, best), candidate
        end
    end
    return name
end
local nearest = arguments.nearest

-- The text of a number, with a decimal point whatever the locale has.
function arguments.decimal(format, value)
    return (string.format(format, value):gsub("[^%w+-]+", "."))
end

-- Longest sentence, in bytes, and what is kept of its beginning and end.
local LONGEST, KEPT = 2000, 900

-- A sentence in one line of UTF-8: of a text of 100 kB that somebody gave not all is said again.
local function one_line(sentence)
    if #sentence > LONGEST then
        sentence = sentence:sub(1, KEPT) .. " ... " .. sentence:sub(-KEPT)
    end
    local function escaped(byte)
        return ("\\x%02x"):format(byte:byte())
    end
    sentence = sentence:gsub("[%c\127]", escaped)
    local good, at = utf8.len(sentence)
    while not good do
        sentence = sentence:sub(1, at - 1) .. escaped(sentence:sub(at, at)) .. sentence:sub(at + 1)
        good, at = utf8.len(sentence, at)
    end
    return sentence
end

-- Ends the call with a sentence, in which numbers are %s; to be used under arguments.call.
function arguments.fail(format, ...)
    local values = table.pack(...)
    for i = 1, values.n do
        if math.type(values[i]) == "float" then
            values[i] = arguments.decimal("%s", values[i])
        end
    end
    error({ sentence = one_line(string.format(format, table.unpack(values, 1, values.n))) }, 0)
end
local fail = arguments.fail

-- What a value is, in a sentence.
function arguments.describe(value)
    if type(value) == "number" then
        return "the number " .. arguments.decimal("%s", value)
    elseif type(value) == "string" then
        return "the string '" .. value:sub(1, 60):gsub("[%c\127]", "?") .. "'"
    elseif type(value) == "boolean" or value == nil then
        return tostring(value)
    end
    return "a " .. type(value)
end
local describe = arguments.describe

-- A function that calls `f`; what `fail` raises in it gets the file and line of its caller.
function arguments.call(f)
    return function(...)
        local results = table.pack(pcall(f, ...))
        if results[1] then
            return table.unpack(results, 2, results.n)
        end
        local message = results[2]
        if type(message) == "table" and message.sentence then
            error(message.sentence, 2)
        end
        error(message, 0)
    end
end

-- Refuses keys of `given` that are not in the sorted list `known`.
function arguments.check_keys(where, given, known)
    local unknown = {}
    for key in pairs(given) do
        local found = false
        for _, name in ipairs(known) do
            found = found or name == key
        end
        if not found then
            unknown[#unknown + 1] = tostring(key)
        end
    end
    table.sort(unknown)
    local word = unknown[1]
    if not word then
        return
    end
    local name = nearest(word, known)
    fail("%s: unknown parameter '%s'%s", where, word,
        name and string.format("; did you mean '%s'?", name) or " (known: " .. table.concat(known, ", ") .. ")")
end

function arguments.table(where, value, what)
    if type(value) ~= "table" then
        fail("%s: %s must be a table, not %s", where, what, describe(value))
    end
    return value
end

-- The value of a key; `default` when it is left out, an error when there is none.
local function value_of(where, given, key, default, kind, words)
    local value = given[key]
    if value == nil then
        if default == nil then
            fail("%s: '%s' is missing", where, key)
        end
        return default
    end
    if type(value) ~= kind then
        fail("%s: %s must be %s, not %s", where, key, words, describe(value))
    end
    return value
end

function arguments.text(where, given, key, default)
    return value_of(where, given, key, default, "string", "text")
end

function arguments.boolean(where, given, key, default)
    return value_of(where, given, key, default, "boolean", "true or false")
end

-- A finite number in [low, high].
function arguments.number(where, given, key, default, low, high)
    local value = value_of(where, given, key, default, "number", "a number")
    if not (value >= low and value <= high) then
        local function text(number)
            return arguments.decimal("%.10g", number)
        end
        fail("%s: %s = %s is outside [%s, %s]", where, key, text(value), text(low), text(high))
    end
    return value
end

function arguments.choice(where, given, key, default, choices)
    local value = arguments.text(where, given, key, default)
    for _, choice in ipairs(choices) do
        if value == choice then
            return value
        end
    end
    local name = nearest(value, choices)
    fail("%s: %s = '%s' is none of '%s'%s", where, key, value, table.concat(choices, "', '"),
        name and string.format("; did you mean '%s'?", name) or "")
end

-- Writes a picture, whole or not at all.
function arguments.write(where, file, text)
    local good, message = pcall(talus.write_file, file, text)
    if not good then
        fail("%s: %s", where, (message:gsub("^.-write_file: ", "")))
    end
end

return arguments
