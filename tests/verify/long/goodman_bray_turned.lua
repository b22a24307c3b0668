-- Toppling of columns on a stepped base (Goodman and Bray, 1976) with the default contact points: once the
-- columns have turned, so far that their forces on each other act at corners, the friction angle at
-- failure is that of limit equilibrium. Before that they stand with less (docs/theory.md).
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local statics = require "check_statics"
local columns_of = require "check_columns"
local reference = require("reference_dynamics").goodman_bray

local SETTLED, WEAK, STANDING = 44, 30, 41 -- friction angles, degrees: to settle and be caught,
                                           -- to topple, to lower it from
local TURNED = 0.04                        -- m: way of the farthest column until it is caught
local STEP = 0.1                           -- how friction is lowered, degrees
local AT_REST, MOVING = 1e-6, 0.02         -- unbalanced force ratio; m in one step of friction
local TOLERANCE = 0.5                      -- degrees

for _, case in ipairs(reference) do
    figures.case(case.name .. ".turned", string.format("%d columns on a stepped base dipping %g degrees, "
        .. "caught when the farthest has gone %g m: friction angle at failure, with the default "
        .. "contact points", case.n, case.psi, TURNED), reference.source)
    local model, columns = columns_of(case, "consistent", SETTLED)
    local options = { ratio = AT_REST, moving = MOVING }
    assert(statics.stands(model, columns, options), "it does not even settle")
    columns:reset_displacement()
    model:joint("*", { friction = WEAK })
    model:solve { ratio = AT_REST / 1000, every = 5,
        stop = function() return statics.travel(columns) > TURNED end }
    model:joint("*", { friction = SETTLED })
    -- stopped as well: on how they fall, which is chaotic, it would depend how far they still turn
    columns:set { velocity = { 0, 0, 0 }, angular_velocity = { 0, 0, 0 } }
    assert(model:solve { ratio = AT_REST }.reason == "ratio", "what has turned is not caught")
    local friction = statics.search(STANDING, WEAK, STEP, STEP, function(angle)
        model:joint("*", { friction = angle })
        return (statics.stands(model, columns, options))
    end)
    figures.near("friction angle at failure, degrees", friction, case.friction, TOLERANCE)
end
figures.finish()
