-- convert.lua - the command `talus convert [--up y] FILE [SCRIPT.lua]`: writes a data file of 3DEC as a script.
--
-- The script goes to the standard output, or into the file; what is left out is told on the standard error.
local talus = require "talus"

local USAGE = "name the data file: talus convert [--up y] FILE [SCRIPT.lua]"

local function fail(sentence)
    io.stderr:write("talus: convert: ", sentence, "\n")
    os.exit(1, true)
end

local given, words = {}, { ... }
while #words > 0 do
    local word = table.remove(words, 1)
    if word == "--up" then
        given.up = table.remove(words, 1) or fail "the option --up needs y or z"
    elseif word:match "^%-%-" then
        fail(("unknown option '%s'; %s"):format(word, USAGE))
    elseif not given.file then
        given.file = word
    elseif not given.to then
        given.to = word
    else
        fail(("'%s' is one word too many; %s"):format(word, USAGE))
    end
end
if not given.file then
    fail(USAGE)
end
local good, result = pcall(talus.convert, given)
if not good then
    fail((tostring(result):gsub("^.-convert: ", "")))
end
if not given.to then
    io.write(result.script)
end
io.stderr:write(table.concat(result.report, "\n"), "\n")
if #result.mistakes > 0 then
    os.exit(1, true)
end
