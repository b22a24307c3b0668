-- Two blocks that a joint has cut from a box touch along their sides, but for roundings: as they come together, from apart to an
-- overlap of a micrometre, the contact lies in both, presses by no more than its area at the deepest, and does not rule the step.
local check = require "check"
local talus = require "talus"

local KN, DENSITY = 1e8, 2500 -- Pa/m, kg/m3
local BLOCKS = {
    {
        { 1.0000000020784385, -1.0000000003834277, -4.5488272324423207e-06 },
        { -1.0000000015104036, -0.99999999972689091, 1.9999954475839254 },
        { 0.99999999848959631, -0.99999999970655273, 1.9999954511727673 },
        { 1.0000000020739974, -0.56327002053159747, -4.5489750382099459e-06 },
        { -1.0000000015200625, -0.050174780847693445, 1.999995447262469 },
        { 1.0000000005436662, -0.5095058101697969, 0.85251807694164827 },
        { 0.99999999848510368, -0.55820763470296686, 1.9999954510232483 },
        { 0.88457492122076931, -0.44400274005271934, -4.5492225240195694e-06 },
        { -0.9999999991321189, -1.0000000001754483, 0.67461819432954173 },
        { -0.99999999967656139, -0.0065609075286229279, 0.97239672155950707 },
        { 0.4125184290092021, -1.0000000003894018, -4.5498814218447592e-06 },
        { 0.77839203166018733, -0.41703054184575816, -4.5494221891928532e-06 },
    },
    {
        { 0.99999999975765519, 1.0000000005878746, 1.9999954480079007 },
        { -0.39084279781887599, 1.0000000005227001, 1.9999954476368846 },
        { 0.99999999982499921, -0.43714032296880168, 1.9999954489877836 },
        { 1.0000000003602072, -0.47332260706093621, -4.550987546148022e-06 },
        { 0.88457491950681866, -0.44400274044930899, -4.5510383275271238e-06 },
        { 1.0000000001344869, -0.50950581026940278, 0.85251807497200627 },
        { 1.0000000002060971, 0.99999999944165796, 0.31890286272458579 },
        { 1.000000000341023, -0.063928603256819372, -4.5512666826397208e-06 },
        { -0.45114493602851458, 0.99999999984621313, 1.0119737377462099 },
        { 0.80989422114168519, -0.36683611659443949, -4.5511108635043485e-06 },
    },
}
local ACROSS = { 0.32033646344987, 0.796600127882, -0.51265269573349 } -- from the first to the second
local INSIDE, WHOLE = 2, 4 -- m: half the box; m2: its side
local LEAST = 1e-4         -- s

local function build(way, fraction)
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("polyhedron", { vertices = BLOCKS[1], density = DENSITY })
    local moved = {}
    for i, v in ipairs(BLOCKS[2]) do
        moved[i] = { v[1] + way * ACROSS[1], v[2] + way * ACROSS[2], v[3] + way * ACROSS[3] }
    end
    model:generate("polyhedron", { vertices = moved, density = DENSITY })
    model:joint("*", "coulomb", { kn = KN, ks = KN / 2, friction = 30 })
    if fraction > 0 then
        model:contact_area { fraction = fraction }
    end
    return model
end

local pressing = 0
for _, fraction in ipairs { 0, 0.01 } do
    for _, way in ipairs { -1e-6, -1e-7, -1e-8, -3e-9, -1e-9, -1e-10, -1e-12, 0, 2e-10, 5e-10, 8e-10, 1e-8 } do
        local model = build(way, fraction)
        model:cycle(1)
        check.holds(model.dt > LEAST, "the step at " .. way)
        for _, contact in ipairs(model:contacts()) do
            for _, x in ipairs(contact.point) do
                check.holds(math.abs(x) < INSIDE, "the point at " .. way)
            end
            check.holds(contact.normal_force <= KN * WHOLE * math.max(-contact.gap, 0), "the force at " .. way)
            pressing = pressing + (contact.normal_force > 0 and 1 or 0)
        end
        model:cycle(100)
    end
end
check.holds(pressing > 8, "contacts that press")
