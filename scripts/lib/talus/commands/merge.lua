-- merge.lua - the command `talus merge FILE`: makes the file of talus.realisations of its shards, FILE.shard-i-of-n.
--
-- Shards may be of several numbers n. A row that several have must be the same in all. The file that comes of it has the
-- bytes of one that a single process has written.
local talus = require "talus"
local rows = require "talus.rows"
local workers = require "talus.workers"

local function stop(format, ...)
    io.stderr:write("talus: merge: ", format:format(...), "\n")
    os.exit(1, true)
end

-- FILE and its shards, by their names.
local function sources(file)
    local folder, name = file:match "^(.*/)([^/]*)$"
    folder, name = folder or "", name or file
    local list = {}
    for _, other in ipairs(workers.names(folder == "" and "." or folder)) do
        local rest = other:sub(1, #name) == name and other:sub(#name + 1)
        if rest == "" or rest and rest:find "^%.shard%-%d+%-of%-%d+$" then
            list[#list + 1] = folder .. other
        end
    end
    table.sort(list)
    return list
end

local function parts_of(path)
    local file = io.open(path, "rb") or stop("'%s' cannot be read", path)
    local text = file:read "a"
    file:close()
    local good, parts = pcall(rows.parts, "merge", path, text)
    if not good then
        stop("%s", parts.sentence and parts.sentence:gsub("^merge: ", "") or parts)
    end
    return parts
end

-- Adds the rows of a file to those of others.
local function add(path, parts, lines)
    for i, line in ipairs(parts.lines) do
        local number = math.tointeger(tonumber(line:match "^%d+"))
        if not rows.read(line, parts.columns) or number < 1 or number > parts.head.number then
            stop("'%s': line %d is damaged", path, i + 2)
        elseif lines[number] and lines[number] ~= line then
            stop("'%s' has another row %d than a file before it: they are of two scripts", path, number)
        end
        lines[number] = line
    end
end

-- "3, 7 to 9": the rows that lack, the first of them.
local function lacking(lines, number)
    local list, from = {}, nil
    for row = 1, number + 1 do
        local lacks = row <= number and not lines[row]
        if lacks and not from then
            from = row
        elseif not lacks and from then
            list[#list + 1] = from == row - 1 and tostring(from) or ("%d to %d"):format(from, row - 1)
            from = nil
        end
        if #list > 10 then
            list[#list] = "and more"
            break
        end
    end
    return #list > 0 and table.concat(list, ", ") or nil
end

local words = { ... }
if #words ~= 1 then
    stop "name the file of one process: talus merge FILE merges FILE.shard-1-of-4 and so on"
end
local first, first_path, lines, count = nil, nil, {}, 0
for _, path in ipairs(sources(words[1])) do
    local parts = parts_of(path)
    if parts then
        count = count + 1
        if first and (parts.first ~= first.first or parts.names ~= first.names) then
            stop("'%s' begins with '%s' and '%s' with '%s', or their columns differ: they are of two sets", first_path,
                first.first, path, parts.first)
        end
        first, first_path = first or parts, first_path or path
        add(path, parts, lines)
    end
end
if not first then
    stop("there is no '%s.shard-i-of-n'", words[1])
end
local lack = lacking(lines, first.head.number)
if lack then
    stop("of %d rows there are not: %s", first.head.number, lack)
end
talus.write_file(words[1], ("%s\n%s\n%s\n"):format(first.first, first.names, table.concat(lines, "\n")))
io.stderr:write(("%d rows of %d files\n"):format(first.head.number, count))
