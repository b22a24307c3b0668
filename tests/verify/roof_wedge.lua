-- The roof wedge: friction at failure for every row, geometry, settlement and stresses of the
-- first.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require("reference").roof_wedge
local roof = require "examples.roof_wedge"

local FRICTION_E2 = 0.003 -- relative, in the friction coefficient at failure of the first row
local FRICTION = 0.005   -- relative, in the friction coefficient at failure
local STRESS = 1e-3      -- relative; the faces shrink as the wedge settles, by some 1e-3
local GEOMETRY = 1e-12

figures.case("E2.table", "A pyramid in the roof of an excavation, held by the stress on its "
    .. "faces: the friction at which it falls and how it settles before, for twelve sets of "
    .. "stiffness, stress and shape.", reference.source)
local obtained, expected, rows = {}, {}, {}
for i, row in ipairs(reference.table) do
    local case = roof.cases[i]
    for _, key in ipairs { "kn", "ks", "sigma", "dip", "height" } do
        figures.equal(string.format("row %d %s", i, key), case[key], row[key])
    end
    local r = roof.run(case)
    figures.relative(string.format("row %d friction", i), r.mu, row.mu,
        i == 1 and FRICTION_E2 or FRICTION)
    rows[i], obtained[i], expected[i] = i, r.mu, row.mu
    -- The closed form is of small displacements: it errs by about settlement / height.
    figures.relative(string.format("row %d settlement", i), r.settlement, row.settlement,
        1e-4 + 2 * row.settlement / case.height)
end
figures.equal("rows", #reference.table, #roof.cases)

figures.plot { title = "E2.table: friction at failure", x = "row", y = "friction coefficient",
    series = {
    { name = "closed form", x = rows, y = expected, colour = 2 },
    { name = "obtained", x = rows, y = obtained, style = "points", colour = 1 } } }

local E2 = reference.E2
figures.case("E2", "The first of these pyramids: blocks, volume and faces as cut, stresses on the "
    .. "faces before and after its weight acts.", reference.source)
local r = roof.run(roof.cases[1])
figures.equal("blocks", r.blocks, E2.blocks)
figures.relative("volume", r.volume, E2.volume, GEOMETRY)
figures.relative("settlement", r.settlement, E2.settlement, STRESS)
for _, which in ipairs { "min", "max" } do
    figures.relative("normal stress, " .. which, r.stresses["normal_" .. which], E2.normal_stress,
        STRESS)
    figures.relative("shear stress, " .. which, r.stresses["shear_" .. which], E2.shear_stress,
        STRESS)
end

-- Before the weight acts, the faces carry the initial stress as given.
local model, wedge = roof.build(roof.cases[1])
for k = 1, 3 do
    figures.near("centroid " .. k, wedge[1].centroid[k], E2.centroid[k], GEOMETRY)
end
local rock = model:blocks { fixed = true }
for _, joint in ipairs { "J1", "J2", "J3" } do
    local faces = model:contacts { joint = joint, between = { wedge, rock } }
    figures.relative(joint .. " area", faces:sum "area", E2.face_area, 1e-10)
    figures.relative(joint .. " initial normal stress", faces:sum "normal_force" / faces:sum "area",
        E2.initial_normal_stress, 1e-10)
    figures.relative(joint .. " initial shear stress", faces:max "shear_stress",
        E2.initial_shear_stress, 1e-10)
end
figures.finish()
