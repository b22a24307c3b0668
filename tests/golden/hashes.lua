-- hashes.lua - the state hashes of the scenes of scenes.lua and joints.lua, and hashes of the texts of answers.lua, compared with the
-- committed ones: the same bits from every compiler, processor, vector width and number of threads.
--
--     build/release/talus tests/golden/hashes.lua            compare with tests/golden/hashes.txt
--     build/release/talus tests/golden/hashes.lua --renew    write tests/golden/hashes.txt
--
-- A difference on one build alone breaks rule 1 of docs/architecture.md: look for a function of the C library, a
-- fused product or a sum in another order. A difference on every build is a change of results: renew the table in
-- the commit that brings it about, and say in its message why. Scenes whose first stage differs differ in geometry.
package.path = "tests/golden/?.lua;" .. package.path -- run in the source root

local TABLE = "tests/golden/hashes.txt"
local folder = os.getenv("TALUS_TEST_TMP") or os.tmpname():match("^(.*)/")

-- "scene: stage" -> hash
local function read()
    local hashes = {}
    for line in io.lines(TABLE) do
        local name, hash = line:match("^(.-)%s+(%x+)$")
        assert(name, TABLE .. ": a line is not a name and a hash: " .. line)
        hashes[name] = hash
    end
    return hashes
end

-- FNV-1a of a text, 64 bits.
local function hash_of(text)
    local hash = 0xcbf29ce484222325
    for i = 1, #text do
        hash = (hash ~ text:byte(i)) * 0x100000001b3
    end
    return ("%016x"):format(hash)
end

local found = {} -- {name, hash}, in the order of the scenes
for _, file in ipairs { "scenes", "joints", "answers" } do
    for _, scene in ipairs(require(file)) do
        scene.run(function(model, stage, text)
            found[#found + 1] = { scene.name .. ": " .. stage, text and hash_of(text) or model:state_hash() }
        end, folder)
    end
end

if arg[1] == "--renew" then
    local file <close> = assert(io.open(TABLE, "w"))
    for _, row in ipairs(found) do
        file:write(string.format("%-44s %s\n", row[1], row[2]))
    end
    print(string.format("%s: %d hashes written", TABLE, #found))
    return
end

local committed, different = read(), 0
for _, row in ipairs(found) do
    local name, hash = row[1], row[2]
    if hash ~= committed[name] then
        different = different + 1
        print(string.format("DIFFERENT  %-32s %s, committed %s", name, hash, committed[name] or "nothing"))
    end
    committed[name] = nil
end
for name in pairs(committed) do
    different = different + 1
    print(string.format("MISSING    %s is in the table and in no scene", name))
end
print(string.format("%d hashes, %d different", #found, different))
os.exit(different == 0, true)
