-- model:view: what it gives, and what it refuses; without a screen one sentence.
local check = require "check"
local talus = require "talus"

local function model_of_box()
    local model = talus.model {}
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    return model
end
local model = model_of_box()
local function refused(options, part)
    check.refused(model, function() model:view(options) end, part)
end

refused({ titel = "x" }, "unknown parameter 'titel'; did you mean 'title'?")
refused({ title = 7 }, "title")
refused({ share = 0 }, "share = 0")
refused({ wait = "yes" }, "wait must be true or false, not the string 'yes'")
refused({ prefix = "" }, "prefix must not be empty")
refused({ prefix = 3 }, "prefix must be a string")
refused({ log = {} }, "log must be a string")
refused({ contacts = "many" }, "view: contacts must be true, false or \"slipping\"")
refused("x", "the parameters must be a table")
if #talus.screens() == 0 then
    refused({}, "no plugin with a screen is there; build Talus where libmicrohttpd is installed")
    return
end
refused({ port = 70000 }, "port = 70000")
refused({ port = "x" }, "port")
refused({ block_fields = { "colour" } }, "colour")
refused({ block_fields = { bad = function() error("no", 0) end } }, "'bad'")
refused({ log = "/dev/null/x" }, "log")
refused({ keyblocks = { friction = -1 } }, "friction = -1")

-- A call that fails leaves no view: the next one begins it.
local address = model:view { title = "Box" }
check.holds(address:find "^http://127%.0%.0%.1:%d+/%?token=%x+$" ~= nil, address)
check.equal(model:view {}, address)
check.equal(model:view { contacts = false, block_fields = { "volume" } }, address)
refused({ title = "Another" }, "the model is shown already, at " .. address)
refused({ port = 0 }, "port is chosen with the first call")
refused({ block_fields = { "colour" } }, "colour")

-- The port of a view is taken, and free again when its model has gone.
local port = tonumber(address:match ":(%d+)/")
local other = model_of_box()
check.refused(other, function() other:view { port = port } end, "port " .. port)
model:blocks():set { velocity = { 0, 0, 1 } }
check.equal(model:state_hash(), (function()
    local plain = model_of_box()
    plain:blocks():set { velocity = { 0, 0, 1 } }
    return plain:state_hash()
end)())
model = nil
collectgarbage()
collectgarbage()
check.holds(other:view { port = port }:find(":" .. port .. "/", 1, true) ~= nil, "the port is free again")
-- A copy is not shown.
check.holds(other:copy():view {} ~= other:view {}, "a copy has a view of its own")
