-- A body of parts is the body: random bodies, whole, and cut by random planes and joined again. tests/lua/test_bodies_of_parts.lua does the same
-- with fewer, and lets them fall.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local parts = require "parts"

local MODELS = 300

figures.case("D.parts", MODELS .. " pairs of hulls and of boxes in any attitude, and as many of bodies that turn inward, pressed into each other by 1e-6 to "
    .. "0.1 of their size, whole and three times in random parts: force and moment of the parts are those of the whole but for 1e-9 of it, and, where "
    .. "faces are flush, kn overlap^2 per metre of edge.", "the same solid")
for _, of in ipairs { { "convex bodies", parts.convex }, { "bodies that turn inward", parts.inward } } do
    local worst, pressing = 0, 0
    for seed = 1, MODELS do
        local off, force = of[2](seed)
        worst, pressing = math.max(worst, off), pressing + (force > 0 and 1 or 0)
    end
    figures.between(of[1] .. ": largest difference, of what it may be", worst, 0, 1)
    figures.between(of[1] .. ": pairs that press", pressing, MODELS / 2, MODELS)
end
figures.finish()
