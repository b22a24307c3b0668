-- random_3ddat.lua RUNS [SEED [RUN]]: changes data files of 3DEC at random and converts each; with RUN that one only.
--
-- A file is some examples of the converter's table of commands, after which words, letters and bytes of it are changed. Whatever comes
-- of it: the conversion raises nothing, what it cannot take is a mistake of one line, and script and chunk are Lua. A file that fails is
-- printed, with its seed and run.
package.path = "tests/lua/?.lua;" .. package.path -- run in the source root
local threedec = require "talus.threedec"
local words = require "talus.threedec.words"
local files = require "threedec_files"

local runs, seed = assert(math.tointeger(tonumber(arg[1] or "1000"))), math.tointeger(tonumber(arg[2] or "1"))
local only = arg[3] and math.tointeger(tonumber(arg[3]))

local ODD = { "0", "-1", "1e308", "1e-320", "nan", "1e9999", "(", ")", "[", "]", "{", "'", '"', "...", "&", ";", ",", "=", "@", "\0", "\xff", "\n", "group",
    "range", "position-x", "command", "[1/0]", "[a]", "fish define a", "end", "loop i (1,1000000)", "if", "endif", "not", "by", "^", "program call 'a'" }

-- The examples, and words of them.
local texts, pieces = {}, {}
for _, row in ipairs(words.rows) do
    local examples = type(row.example) == "table" and row.example or { row.example }
    for _, text in ipairs(examples) do
        texts[#texts + 1] = text .. "\n"
        for piece in text:gmatch "%S+" do
            pieces[#pieces + 1] = piece
        end
    end
end
texts[#texts + 1] = files.cube()
texts[#texts + 1] = files.arch_5()

local CHANGES = {
    function(text, at) return text:sub(1, at - 1) .. text:sub(at + math.random(1, 20)) end,
    function(text, at) return text:sub(1, at - 1) .. ODD[math.random(#ODD)] .. text:sub(at) end,
    function(text, at) return text:sub(1, at - 1) .. string.char(math.random(0, 255)) .. text:sub(at + 1) end,
    function(text, at)
        local from, to = text:find("%S+", at)
        return from and text:sub(1, from - 1) .. pieces[math.random(#pieces)] .. text:sub(to + 1) or text
    end,
    function(text, at) return text:sub(1, at) .. texts[math.random(#texts)] .. text:sub(at + 1) end,
}

local function make()
    local list = {}
    for i = 1, math.random(1, 4) do
        list[i] = texts[math.random(#texts)]
    end
    local text = table.concat(list)
    for _ = 1, math.random(1, 6) do
        text = CHANGES[math.random(#CHANGES)](text, math.random(1, #text + 1))
    end
    return text
end

local function one_line(sentence)
    return type(sentence) == "string" and sentence ~= "" and not sentence:find "\n"
end

-- What is wrong with the conversion of a text; nil when nothing is.
local function fault(text)
    local good, result = pcall(threedec.convert, "soak.3ddat", { text = text, read = function() return nil, "no such file" end })
    if not good then
        return "raised: " .. tostring(result)
    end
    for _, list in ipairs { result.mistakes, result.left_out, result.in_part } do
        for _, item in ipairs(list) do
            if not one_line(item.reason) then
                return "no sentence: " .. tostring(item.reason)
            end
        end
    end
    for _, write in ipairs { threedec.script, threedec.chunk } do
        local written, lua = pcall(write, result)
        local _, why = load(written and lua or "=", "=script", "t")
        if not written or why then
            return "no script: " .. (written and why or tostring(lua))
        end
    end
end

local began = os.clock()
for run = only or 1, only or runs do
    math.randomseed(seed, run)
    local text = make()
    local why = fault(text)
    if why or only then
        print(text)
        error(("seed %d, run %d: %s"):format(seed, run, why or "nothing is wrong"), 0)
    end
end
print(("%d files, %.0f a second"):format(runs, runs / (os.clock() - began)))
