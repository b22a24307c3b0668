-- Jointed bodies of zones under a stress that is uniform, or grows with depth: they rest, and bear it.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local PATCH = 1e-6     -- of the largest stress
local FIRST = 1e-10    -- unbalanced force ratio in the first step
local STILL = 1e-12    -- m: rounding of places in a thousand steps
local AT_REST = 1e-8   -- unbalanced force ratio

local function components(list, by)
    local out = {}
    for k, name in ipairs(zones.COMPONENTS) do
        out[name] = list[k] * (by or 1)
    end
    return out
end

-- A cube that joints cut; zones of each block as large as its number says, so that meshes do not match.
local function jointed(gravity, sets)
    local model = zones.model { young = 1e10, poisson = 0.25, gravity = gravity }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    for k, set in ipairs(sets) do
        set.joint = "J" .. k
        model:generate("jointset", set)
    end
    model:joint("*", "coulomb_tensile", { kn = 2e10, ks = 1e10, cohesion = 1e12, tension = 1e12, friction = 30 })
    for number, block in ipairs(model:blocks()) do
        model:blocks { id = block.id }:deformable { zone = 0.25 + 0.05 * (number % 4), solid = "rock" }
    end
    return model
end

local PERSISTENT = {
    { dip = 25, dip_direction = 70, spacing = 0.45, number = 3, origin = { 0.5, 0.5, 0.47 } },
    { dip = 72, dip_direction = 205, spacing = 0.6, number = 2, origin = { 0.45, 0.5, 0.5 } },
}
local SIDES = { "xmin", "xmax", "ymin", "ymax", "zmin", "zmax" }

do
    local case = reference["DF.patch_joints"]
    local SMALL = 1e-5 -- of the stress of the reference: strains are of first order then
    figures.case("DF.patch_joints", "A cube with two persistent joint sets, whose blocks have meshes that do not match, comes to rest "
        .. "under tractions of a uniform stress.", case.source)
    local model = jointed({ 0, 0, 0 }, PERSISTENT)
    for _, side in ipairs(SIDES) do
        model:boundary { side = side, stress = components(case.inputs.stress, SMALL) }
    end
    -- six components are held, none more: the tractions are in balance
    model:gridpoints { near = { 0, 0, 0 } }:fix()
    model:gridpoints { near = { 1, 0, 0 } }:fix { y = true, z = true }
    model:gridpoints { near = { 0, 1, 0 } }:fix { z = true }
    local result = model:relax { ratio = AT_REST }
    figures.equal("comes to rest", result.reason, "rest")
    model:cycle(1)
    local all = model:zones {}
    for k, name in ipairs(zones.COMPONENTS) do
        figures.near("stress " .. name .. ", worst zone, Pa", zones.off(all, "stress", name, SMALL * case.inputs.stress[k]), 0,
            PATCH * SMALL * 4e6)
    end
    figures.equal("blocks", #model:blocks() > 4, true)
end

do
    local case = reference["DF.insitu_rest"]
    figures.case("DF.insitu_rest", "A cube with joints that end on others is under a stress that grows with depth as its weight does: "
        .. "first step, and motion in a thousand.", case.source)
    local g, gradient = 10, { xx = 15000, yy = 20000, zz = 25000 }
    for _, persistence in ipairs { 1, 0.6 } do
        local sets = {}
        for k, set in ipairs(PERSISTENT) do
            sets[k] = { persistence = persistence }
            for key, x in pairs(set) do
                sets[k][key] = x
            end
        end
        local name = string.format("persistence %g: ", persistence)
        local model = jointed({ 0, 0, -g }, sets)
        model:cycle(0)
        model:insitu { stress = components(case.inputs.stress), gradient = gradient }
        for _, side in ipairs(SIDES) do
            model:boundary { side = side, stress = components(case.inputs.stress), gradient = gradient }
        end
        local result = model:cycle(1)
        figures.near(name .. "ratio in the first step", result.ratio_local, case.expected.unbalanced_ratio, FIRST)
        model:cycle(1000)
        local most = 0
        for _, p in ipairs(model:gridpoints {}) do
            for c = 1, 3 do
                most = math.max(most, math.abs(p.displacement[c]))
            end
        end
        figures.near(name .. "motion in a thousand steps, m", most, 0, STILL)
    end
end
figures.finish()
