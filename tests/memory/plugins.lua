-- plugins.lua - the plugins are loaded while each allocation fails in turn: there is one clear sentence, and all plugins are there
-- when it is tried again.
--
--     LD_PRELOAD=memory_failure.so talus tests/memory/plugins.lua N [more]
--
-- The N-th allocation fails, and with "more" all that follow. Ends with the status 0 when it could be loaded in spite of that, 3 when
-- it was refused and then loaded.
package.cpath = os.getenv "TALUS_TEST_MEMORY" .. "/?.so;" .. package.cpath
local memory = require "memory_failure"

memory.fail(tonumber(arg[1]), arg[2] == "more")
local good, answer = pcall(require, "talus")
local asked = memory.stop()
if not good then
    local told = answer:match "^[^\n]*"
    assert(answer == told and (told:find("out of memory", 1, true) or told:find("not enough memory", 1, true)), answer)
end
local talus = require "talus"
for _, name in ipairs { "laws", "dampings", "generators" } do
    local names = {}
    for i, kind in ipairs(talus[name]()) do
        names[i] = kind.name
    end
    table.sort(names)
    print(name, table.concat(names, " "))
end
io.stdout:flush()
os.exit(not good and 3 or asked >= tonumber(arg[1]) and 0 or 4)
