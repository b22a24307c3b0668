-- What the tests of the joint laws share.
local talus = require "talus"
local check = require "check"

local law_tests = {}

-- A function that gives a law's parameters with the changes in `more`; and one that checks that the law refuses a change by
-- an error that contains `part`.
function law_tests.of(law, base)
    local function params(more)
        local p = {}
        for key, value in pairs(base) do
            p[key] = value
        end
        for key, value in pairs(more or {}) do
            p[key] = value
        end
        return p
    end
    local function refused(part, more)
        local p = params(more)
        check.raises(function() talus.law_test { law = law, params = p, path = { 0.001 } } end, part)
    end
    return params, refused
end

return law_tests
