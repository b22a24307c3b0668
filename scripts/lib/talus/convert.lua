-- convert.lua - `talus.convert`: writes a data file of 3DEC as a script of Talus (threedec.lua).
local arguments = require "talus.arguments"
local threedec = require "talus.threedec"

local KEYS = { "file", "to", "up" }

return arguments.call(function(given)
    arguments.table("convert", given, "the parameters")
    arguments.check_keys("convert", given, KEYS)
    local file = arguments.text("convert", given, "file")
    local to = arguments.text("convert", given, "to", "")
    local up = arguments.choice("convert", given, "up", "z", { "y", "z" })
    local good, result = pcall(threedec.convert, file, { up = up })
    if not good then
        arguments.fail("convert: %s", tostring(result))
    end
    if to ~= "" and threedec.was_read(result, to) then
        arguments.fail("convert: '%s' is the data file, which the script would replace: "
            .. "give the script another name, as one that ends in .lua", to)
    end
    result.script = threedec.script(result)
    result.report = threedec.report(result)
    result.texts = nil
    if to ~= "" then
        arguments.write("convert", to, result.script)
    end
    return result
end)
