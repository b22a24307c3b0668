-- Block models in JSON: what is written is read back, and every kind of damaged file is refused.
-- program only: the models are the same ones with a stock Lua.
local talus = require "talus"
local check = require "check"

local stem = string.format("%s/block_model_%s", assert(os.getenv("TALUS_TEST_TMP")),
    tostring({}):match("0x(%x+)") or "0")

local function write(content)
    local path = stem .. ".json"
    local file = assert(io.open(path, "wb"))
    file:write(content)
    file:close()
    return path
end

local function content_of(path)
    local file = assert(io.open(path, "rb"))
    local content = file:read("a")
    file:close()
    return content
end

-- ---------------------------------------------------------------- there and back

-- Far from zero, so that digits count.
local at = { 1e4, -2e4, 500 }
local model = talus.model { seed = 5 }
model:generate("box", { min = at, max = { at[1] + 4, at[2] + 4, at[3] + 3 }, density = 2600, group = "rock" })
for i, set in ipairs { { 60, 80 }, { 75, 200 }, { 15, 320 } } do
    model:generate("jointset", { joint = "J" .. i, dip = set[1], dip_dev = 4, dip_direction = set[2],
        dip_direction_dev = 5, spacing = 1, spacing_dev = 0.2, number = 4,
        origin = { at[1] + 2, at[2] + 2, at[3] + 1.5 }, persistence = 0.8 })
end
model:generate("tetrahedron", { density = 2400, group = 'a "footing"\\', vertices = {
    { at[1], at[2], at[3] + 3 }, { at[1] + 1, at[2], at[3] + 3 }, { at[1], at[2] + 1, at[3] + 3 },
    { at[1], at[2], at[3] + 4 } } })
model:blocks { below = { dip = 0, dip_direction = 0, origin = { at[1], at[2], at[3] + 1 } } }:fix()
local all = model:blocks()
model:blocks { id = all[2].id }:free():fix { x = true, rotation = true }
model:blocks { where = function(block) return block.id == all[3].id or block.id == all[4].id end }:join()
model:blocks { id = all[5].id }:hide()

local function picture(m)
    local list = {}
    for i, block in ipairs(m:blocks { hidden = "any" }) do
        local joints = {}
        for _, face in ipairs(block.faces) do
            joints[#joints + 1] = face.joint or "-"
        end
        list[i] = string.format("%s %g %s %s %d %d %s", block.group, block.density, block.fixed, block.hidden,
            #block.vertices, #block.faces, table.concat(joints, ","))
    end
    return list
end

-- Blocks in order, each with the number of the first block of its body.
local function bodies(m)
    local first, list = {}, {}
    for i, block in ipairs(m:blocks { hidden = "any" }) do
        first[block.body] = first[block.body] or i
        list[i] = first[block.body]
    end
    return list
end

local path = stem .. "_first.json"
model:write_blocks(path)
local copy = talus.model {}
local summary = copy:generate("blocks", { file = path })
local before, after = model:blocks { hidden = "any" }, copy:blocks { hidden = "any" }
check.holds(#before > 40, "a model of many blocks")
check.equal(summary.after, #before)
check.equal(#after, #before)
check.equal(table.concat(picture(copy), "\n"), table.concat(picture(model), "\n"))
check.equal(table.concat(bodies(copy), " "), table.concat(bodies(model), " "))
for i, block in ipairs(before) do
    check.near(after[i].volume, block.volume, 1e-12 * (1 + block.volume))
    check.near(after[i].centroid, block.centroid, 1e-11)
end
for _, joint in ipairs { "J1", "J2:3", "J3:4" } do
    check.equal(#copy:blocks { joint = joint }, #model:blocks { joint = joint })
end
-- The next plane of a set goes on where the file's ended.
copy:generate("joint", { joint = "J1", dip = 1, dip_direction = 0, origin = { at[1], at[2], at[3] + 0.5 } })
check.holds(#copy:blocks { joint = "J1:5" } > 0, "the fifth plane")

-- Written and read once more, the file is the same.
local second = talus.model {}
second:generate("blocks", { file = path })
second:write_blocks(stem .. "_second.json")
local third = talus.model {}
third:generate("blocks", { file = stem .. "_second.json" })
third:write_blocks(stem .. "_third.json")
check.equal(content_of(stem .. "_third.json"), content_of(stem .. "_second.json"))

for _, fixed in ipairs { '"fixed": []', '"fixed": ["x", "rotation"]', '"fixed": ["x", "y", "z", "rotation"]' } do
    local function count(file)
        local number, from = 0, 1
        while true do
            from = content_of(file):find(fixed, from, true)
            if not from then
                return number
            end
            number, from = number + 1, from + 1
        end
    end
    check.holds(count(path) > 0, fixed)
    check.equal(count(stem .. "_second.json"), count(path))
end

-- The copy runs as the model does.
for _, m in ipairs { model, second } do
    m:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    m:damping("local")
    m:cycle(20)
end
check.near(second.time, model.time, 1e-9 * model.time)

-- ---------------------------------------------------------------- files by other hands

local plain = [=[ {"format": "talus block model", "version": 1, "author": {"name": "\u0041nn", "tags": [null, true, -1e3]},
 "joints": [{"name": "bed", "planes": 2}],
 "blocks": [{"density": 2000, "vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]],
 "faces": [{"vertices": [0,2,1], "joint": "bed", "plane": 2}, {"vertices": [0,1,3]}, {"vertices": [0,3,2]},
 {"vertices": [1,2,3]}]}]} ]=]
local small = talus.model {}
small:generate("blocks", { file = write(plain) })
check.near(small:blocks()[1].volume, 1 / 6, 1e-15)
check.equal(small:blocks()[1].group, "")
check.equal(#small:blocks { joint = "bed:2" }, 1)

local function refused(pattern, replacement, part)
    local content, count = plain:gsub(pattern, replacement, 1)
    check.holds(count == 1, "the pattern " .. pattern)
    local file = write(content)
    local message = check.refused(small, function() small:generate("blocks", { file = file }) end, part)
    check.holds(message:find("generator 'blocks' of plugin 'talus.blocks': ", 1, true), "the generator is named in " .. message)
end

refused("talus block", "other", "the file is no block model")
refused('"version": 1', '"version": 2', "not of version 1")
refused('"density": 2000', '"density": 0', "density = 0 kg/m3 must be > 0")
refused('"density": 2000', '"density": "heavy"', "'density' must be a number")
refused('"density": 2000,', "", "'density' is missing; it is a number")
refused('"blocks"', '"blcks"', "'blocks' is missing; it is a list")
refused('"planes": 2', '"planes": 2.5', "planes = 2.5 is not a whole number in [0, 1e+06]")
refused('"planes": 2', '"planes": 1e9', "planes = 1e+09 is not a whole number")
refused('"plane": 2', '"plane": 3', "plane = 3 is not a whole number in [1, 2]")
refused('"joint": "bed"', '"joint": "bad"', "joint 'bad' is not among the file's joints")
refused('"name": "bed"', '"name": "b:d"', "is not a name")
refused("%[0,2,1%]", "[0,2,4]", "a corner must be the number of one of the block's vertices")
refused("%[0,2,1%]", "[0,2]", "face 1 does not have 3 to 4 corners")
refused("%[0,2,1%]", "[0,1,2]", "generator 'blocks'")
refused("%[1,2,3%]", "[1,3,2]", "generator 'blocks'")
refused("%[0,0,1%]", "[0,0,0]", "generator 'blocks'")
refused("%[0,0,1%]", "[0,0,-1]", "generator 'blocks'")
refused("%[0,0,1%]", "[0,0]", "a vertex must be a list of three numbers")
refused("%[0,0,1%]", "[0,0,1e999]", "a finite number or another value is expected")
refused("%[0,0,1%]", "[0,0,0x1]", "is expected")
refused('"density": 2000', '"density": 2000, "fixed": ["w"]', "'fixed' lists some of")
refused('"density": 2000', '"density": 2000, "hidden": 1', "'hidden' must be true or false")
refused('"density": 2000', '"density": 2000, "body": -1', "body = -1 is not a whole number")
refused("%}%]%}%]%} $", "}]} ", "generator 'blocks'")
refused(" $", " x", "something follows the end")
refused("null", ("["):rep(50), "less than 16 lists")
check.refused(small, function() small:generate("blocks", { file = stem .. "_none.json" }) end,
    "cannot be opened")
check.refused(small, function() small:generate("blocks", {}) end, "parameter 'file' is missing")
check.refused(small, function() small:write_blocks(stem .. ".json/x.json") end, ".json")
check.refused(small, function() small:write_blocks() end, "the file's name")

-- Truncated anywhere, and garbled: a sentence and no change, or blocks of some volume.
math.randomseed(7)
local function try(content)
    local file = write(content)
    local state, count = small:state_hash(), #small:blocks { hidden = "any" }
    local good, message = pcall(small.generate, small, "blocks", { file = file })
    if good then
        local made = #small:blocks { hidden = "any" } - count
        if made > 0 then
            check.holds(small:blocks { hidden = "any" }:min("volume") > 0, "volumes")
        end
        small = talus.model {}
        small:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 1000 })
        return
    end
    check.holds(type(message) == "string" and message:find("generator 'blocks' of plugin 'talus.blocks': ", 1, true), "a sentence")
    check.equal(small:state_hash(), state)
end
for length = 0, #plain - 3 do
    local file = write(plain:sub(1, length))
    check.refused(small, function() small:generate("blocks", { file = file }) end, "generator 'blocks'")
end
local letters = '{}[]",:0123456789-.eE \\u\0x'
for _ = 1, 3000 do
    local bytes = { plain:byte(1, -1) }
    for _ = 1, math.random(1, 4) do
        bytes[math.random(1, #bytes)] = letters:byte(math.random(1, #letters))
    end
    try(string.char(table.unpack(bytes)))
end

for _, ending in ipairs { ".json", "_first.json", "_second.json", "_third.json" } do
    os.remove(stem .. ending)
end
