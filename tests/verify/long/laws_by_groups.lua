-- Laws for contacts between groups, selections and chosen contacts do what laws for the planes between them do, to the bit.
-- tests/lua/test_laws_by_groups.lua does the same with fewer models.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local layers = require "layers"

local MODELS = 400

figures.case("L.groups", MODELS .. " random models of two to four layers, cut by beds and vertical joints, every fourth one of blocks that deform. Each bed has a law of "
    .. "its own, of all that there are. It is given by the name of the plane, and by the groups on both sides of it (between = ...), by selections, by contacts "
    .. "(contacts = ...), and by groups and the name of all beds (joint = ..., between = ...), in any order of lines. Places, displacements and velocities after some "
    .. "steps are compared to the bit.", "the same model with laws by the names of planes")
local wrong, different = {}, 0
for number = 1, MODELS do
    local ways, differs = layers.differing(number)
    for _, way in ipairs(ways) do
        wrong[way] = (wrong[way] or 0) + 1
    end
    different = different + (differs and 1 or 0)
end
for _, way in ipairs(layers.ways) do
    figures.equal("by " .. way .. ": models that are not the same to the bit", wrong[way] or 0, 0)
end
figures.between("models in which the laws of beds make a difference", different, 0.75 * MODELS, MODELS)
figures.finish()
