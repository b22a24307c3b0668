-- run.lua - the run that test_run.py looks at: the wedge of examples/slope.lua, until there is a file FOLDER/stop.
--
--     talus tests/viewer/run.lua FOLDER [watch]
--
-- Prints the address; at the end what the model has come to, and what a new model comes to by the lines of the log. With "watch" no commands are taken.
package.path = "scripts/?.lua;" .. package.path
local slope = require "examples.slope"

local folder = assert(arg[1], "the folder is missing")
local log = folder .. "/log.lua"

local function build()
    local model = slope.build(20)
    model:timestep { rule = "body", fraction = 0.3 }
    return model
end

local function exists(path)
    local file = io.open(path)
    return file and file:close()
end

local function say(...)
    print(...)
    io.stdout:flush()
end

-- Cycles, blocks, held blocks, bodies and joints.
local function sum(model)
    local bodies, names, held = {}, {}, 0
    for _, block in ipairs(model:blocks()) do
        bodies[block.body] = true
        held = held + (block.fixed and 1 or 0)
    end
    local count = 0
    for _ in pairs(bodies) do
        count = count + 1
    end
    for _, joint in ipairs(model:joints()) do
        names[#names + 1] = joint.name
    end
    return string.format("%d %d %d %d %s", model.cycles, #model:blocks(), held, count, table.concat(names, " "))
end

local model = build()
local watch = arg[2] == "watch"
say(model:view { title = "</script><img src=x onerror=alert(1)>", commands = not watch, prefix = folder .. "/view", log = not watch and log or nil })
if not watch then
    model:view { wait = true }
end
while not exists(folder .. "/stop") do
    model:cycle(100)
end
say(sum(model))
if not watch then
    model = nil
    collectgarbage()
    collectgarbage()
    local again = build()
    assert(loadfile(log))(again)
    say(sum(again))
end
