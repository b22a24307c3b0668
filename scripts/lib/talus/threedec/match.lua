-- match.lua - finds the word that an abbreviation stands for, as 3DEC does.
--
-- A word is given by the beginning of each of its parts between hyphens: `pos-x` is position-x, `coh` is cohesion. A
-- whole word goes before a longer one that begins with it. What fits several words is a mistake that names them.
local arguments = require "talus.arguments"
local lexer = require "talus.threedec.lexer"
local match = {}

local function parts_of(word)
    local parts = {}
    for part in (word .. "-"):gmatch "([^-]*)%-" do
        parts[#parts + 1] = part
    end
    return parts
end

local function fits(short, word)
    local given, whole = parts_of(short), parts_of(word)
    if #given > #whole then
        return false
    end
    for i, part in ipairs(given) do
        if whole[i]:sub(1, #part) ~= part then
            return false
        end
    end
    return true
end

-- Words that mean the same as another one.
local SAME = { org = "origin", dd = "dip-direction", ["edge-length"] = "edgelength", edge = "edgelength" }

local function one_meaning(found, meaning)
    for _, word in ipairs(found) do
        if meaning(word) ~= meaning(found[1]) then
            return false
        end
    end
    return true
end

local function usual_meaning(word)
    return SAME[word] or word
end

-- The word of the list `known` that `short` stands for; nil when there is none. `place` is told when it fits several
-- that do not mean the same; `meaning` gives what a word means, where that is not its own matter.
function match.find(short, known, place, meaning)
    local lower, found = short:lower(), {}
    for _, word in ipairs(known) do
        if word == lower then
            return word
        end
        if fits(lower, word) then
            found[#found + 1] = word
        end
    end
    if #found > 1 then -- `dip` is a part of dip-direction, yet a word of fewer parts is meant
        local fewest = {}
        for _, word in ipairs(found) do
            if #parts_of(word) == #parts_of(lower) then
                fewest[#fewest + 1] = word
            end
        end
        found = #fewest == 1 and fewest or found
    end
    if #found > 1 and not one_meaning(found, meaning or usual_meaning) then
        lexer.mistake("%s: '%s' may be %s", place, short, table.concat(found, " or "))
    end
    return found[1]
end

-- The same, and a mistake when there is none.
function match.need(short, known, place, meaning)
    local word = match.find(short, known, place, meaning)
    if word then
        return word
    end
    local nearest = arguments.nearest(short:lower(), known)
    lexer.mistake("%s: unknown word '%s'%s", place, short, nearest and ("; did you mean '%s'?"):format(nearest) or "")
end

return match
