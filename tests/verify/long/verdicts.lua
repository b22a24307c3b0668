-- What is said of models of which it is known: columns and walls that but close their joints, blocks on planes that are steeper or less
-- steep than their friction, and columns of which a box is in parts. tests/lua/test_verdict.lua does the same with fewer.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local verdicts = require "verdicts"

local MODELS = 400

figures.case("L.verdict", MODELS .. " columns and walls under their weight, on joints of random stiffness, are at rest and no block has moved; of as many flat "
    .. "blocks on planes, in any attitude and of any size, those fail that are steeper than their friction: the block, and its direction. Of as many leaning columns "
    .. "the verdict is the same when a box is cut and joined again.",
    "limit equilibrium")
for _, of in ipairs { { "columns and walls", verdicts.stands }, { "blocks on planes", verdicts.slides } } do
    local wrong = 0
    for seed = 1, MODELS do
        wrong = wrong + (of[2](seed) and 1 or 0)
    end
    figures.between(of[1] .. ": wrong verdicts", wrong, 0, 0)
end
local differ, compared = 0, 0
for seed = 1, MODELS do
    local what, stands = verdicts.cuts(seed)
    differ, compared = differ + (what and 1 or 0), compared + (stands and 1 or 0)
end
figures.between("columns with a box in parts: they stand, and are compared", compared, 0.9 * MODELS, MODELS)
figures.between("columns with a box in parts: other verdicts than in one", differ, 0, 0)
figures.finish()
