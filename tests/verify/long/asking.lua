-- Asking a model for its contacts, its time step, its energy or its hash changes nothing. tests/lua/test_asking_at_random.lua does the same with
-- fewer.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local asking = require "asking"
local figures = require "check_figures"

local MODELS = 400

figures.case("L.asking", MODELS .. " random models that are cut, joined, parted, held, let go, deleted, scaled and run, 25 times each in any order, and asked "
    .. "for contacts, time step, energy and hash after every act, or now and then.", "the same model, which is never asked")
local differ = 0
for seed = 1, MODELS do
    differ = differ + (asking.compare(seed) and 1 or 0)
end
figures.between("models that come to other bits", differ, 0, 0)
figures.finish()
