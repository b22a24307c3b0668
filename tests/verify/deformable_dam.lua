-- A dam of zones before a reservoir: the thrust of still water and its moment, and what holds the base.
package.path = "tests/verify/?.lua;tests/lua/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local zones = require "check_zones"
local i = require("reference_deformable").reservoir

local EXACT, REST = 1e-12, 1e-6 -- of forces that are integrated; of reactions once the model rests

-- A dam whose face looks along -x, upright or with a batter; heights count from its base.
local function dam(batter)
    local model = zones.model { young = i.young, poisson = i.poisson, gravity = { 0, 0, -i.g } }
    local h, b, w, s = i.height, i.breadth, i.width, batter * i.height
    model:generate("polyhedron", { density = i.density, vertices = { { 0, 0, 0 }, { b, 0, 0 }, { b, 0, h }, { s, 0, h },
        { 0, w, 0 }, { b, w, 0 }, { b, w, h }, { s, w, h } } })
    model:blocks():deformable { zone = i.zone, solid = "rock" }
    return model
end

for _, case in ipairs(i) do
    figures.case(case.name, "A dam of zones under weight and water to " .. case.level .. " m", i.source)
    local model = dam(case.batter)
    local water = model:boundary { facing = { -1, 0, 0.2 }, water_level = case.level, unit_weight = i.unit_weight }
    -- thrust along x and, where the face leans back, downwards; moment about the y axis through {0, 0, 0}
    local across = i.unit_weight * case.level ^ 2 / 2 * i.width
    local down = across * case.batter
    local about = across * case.level / 3 + down * case.batter * case.level / 3
    figures.relative("thrust along x, N", water.force[1], across, EXACT)
    figures.near("thrust along z, N", water.force[3], -down, EXACT * across)
    figures.relative("moment about y, N m", water.moment[2], about, EXACT)
    model:damping "local"
    local base = model:boundary { zmin = "fixed" }
    local r = model:solve { ratio = 1e-9, max_cycles = 200000 }
    figures.between("ratio of unbalanced forces", r.ratio, 0, 1e-9)
    local weight = i.density * i.g * i.width * i.height * (i.breadth - case.batter * i.height / 2)
    figures.relative("base: force along x, N", base.zmin.reaction[1], -across, REST)
    figures.relative("base: force along z, N", base.zmin.reaction[3], weight + down, REST)
    -- moment of what holds the gridpoints of the base, at their height 0
    local held = 0
    for _, point in ipairs(zones.on(model, "z", 0)) do
        local f = model:gridpoints { near = point.position }:reaction()
        held = held - point.position[1] * f[3]
    end
    local arm = (i.breadth ^ 2 / 2 - case.batter ^ 2 * i.height ^ 2 / 6) / (i.breadth - case.batter * i.height / 2)
    figures.relative("base: moment about y, N m", held, -about - weight * arm, i.moment)
end
figures.finish()
