-- Arches that 3DEC was asked about. Its rigid blocks have springs at the corners of their faces unless they are refined, so they
-- compare with contact_points = "corners"; the default points compare with joints of many springs.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_3dec"

local PRINTED = 1e-3  -- relative, of 3DEC's figures: friction and rounding of its steps
local REFINED = 1e-3  -- relative, of statics with many springs
local LIFTED = 2e-3   -- relative, of an opening
local PORTIONS = 10   -- of gravity, as 3DEC was given it
local SMALL = 100     -- portions, where slip on the way to rest counts: with these its part of the thrust is 1e-4
local MOVED = 5e-3    -- relative, of statics with many springs where blocks move

-- Solves; gives a function for the joint after block `k`: normal force, shear force, force on the first block and its points.
local function solve(case, model)
    local portions = case.slips and SMALL or PORTIONS
    model:damping "local"
    for i = 1, portions do
        model.gravity = { 0, 0, -case.gravity * i / portions }
        model:solve { ratio = i < portions and (case.slips and 1e-5 or 1e-4) or 1e-8, max_cycles = 200000 }
    end
    return function(k)
        local c = model:contacts { between = { model:blocks { id = k }, model:blocks { id = k + 1 } } }[1]
        local f, s = {}, c.shear_force
        for i = 1, 3 do
            f[i] = -(c.normal_force * c.normal[i] + s[i])
        end
        return { normal = c.normal_force, shear = math.sqrt(s[1] ^ 2 + s[2] ^ 2 + s[3] ^ 2), force = f, points = c.points }
    end
end

local function voussoir(model, case, sections)
    local vertices = {}
    for _, section in ipairs(sections) do
        for _, p in ipairs(section) do
            for _, y in ipairs { 0, case.width or 0.5 } do
                vertices[#vertices + 1] = { p[1], y, p[2] }
            end
        end
    end
    model:generate("polyhedron", { vertices = vertices, density = case.density })
end

local function build(case, sections, points)
    local model = talus.model { contact_points = points }
    for k = 1, #sections - 1 do
        voussoir(model, case, { sections[k], sections[k + 1] })
    end
    model:blocks { id = 1 }:fix()
    model:blocks { id = #sections - 1 }:fix()
    -- Where nothing slips in the end, a friction that lets nothing slip on the way.
    model:joint("*", "coulomb", { kn = case.kn, ks = case.ks, friction = case.friction or 80 })
    return model, solve(case, model)
end

local function round_arch(case, points)
    local unit, sections = case.rounding or 1e-6, {}
    for k = 0, 20 do
        local a = math.rad(9 * k)
        for i, r in ipairs { 5, 5.5 } do
            sections[k + 1] = sections[k + 1] or {}
            sections[k + 1][i] = { unit * math.floor(r * math.cos(a) / unit + 0.5), unit * math.floor(r * math.sin(a) / unit + 0.5) }
        end
    end
    return build(case, sections, points)
end

-- Closures at the extrados and at the intrados, from the points at the corners.
local function closures(joint)
    local first, last = joint.points[1], joint.points[1]
    local function from_middle(p)
        return p.position[1] ^ 2 + p.position[3] ^ 2
    end
    for _, p in ipairs(joint.points) do
        first = from_middle(p) > from_middle(first) and p or first
        last = from_middle(p) < from_middle(last) and p or last
    end
    return -first.gap, -last.gap
end

figures.case("S.arch.3dec", "Arch of 20 voussoirs with springs at the corners of its joints: closures at the corners, thrust and force of the "
    .. "first joint. 3DEC's rigid blocks have such springs unless they are refined, so they compare with contact_points = \"corners\".",
    reference.M1.source)
do
    local case = reference.M1
    local _, joint = round_arch(case, "corners")
    figures.relative("thrust, N", joint(10).force[1], case.thrust, PRINTED)
    figures.relative("normal force of the first joint, N", joint(1).normal, case.normal_force, PRINTED)
    for k, row in ipairs(case.joints) do
        local outer, inner = closures(joint(k))
        figures.relative(("joint %d: closure at the extrados, m"):format(k), outer, row[1], PRINTED)
        figures.relative(("joint %d: closure at the intrados, m"):format(k), inner, row[2], row[2] > 0 and PRINTED or LIFTED)
    end
end

figures.case("S.arch.3dec.heavy", "The same arch of other stone, which does not slip: 3DEC's thrust, forces and closures with springs at the corners; and "
    .. "with the default points the thrust of joints of many springs.", reference.M1_161.source
    .. "; many springs: statics of rigid voussoirs on 200 springs a joint without tension")
do
    local case = reference.M1_161
    local model, joint = round_arch(case, "corners")
    figures.relative("thrust, N", joint(10).force[1], case.thrust, PRINTED)
    figures.relative("vertical force at a support, N", -joint(1).force[3] + model:blocks { id = 1 }[1].mass * case.gravity,
        case.vertical, PRINTED)
    figures.relative("first joint: normal force, N", joint(1).normal, case.normal_force, PRINTED)
    figures.relative("first joint: shear force, N", joint(1).shear, case.shear_force, PRINTED)
    for _, row in ipairs(case.closures) do
        local outer, inner = closures(joint(row.joint))
        figures.relative(("joint %d: closure at a corner, m"):format(row.joint), row.intrados and inner or outer, row[1], PRINTED)
    end
    _, joint = round_arch(case, "consistent")
    figures.relative("default points: thrust, N", joint(10).force[1], case.refined.thrust, REFINED)
end

do
    local case = reference.five
    local sections = {}
    for i = 1, 3 do
        local a, b = case.intrados[i], case.extrados[i]
        sections[i], sections[7 - i] = { a, b }, { { -a[1], a[2] }, { -b[1], b[2] } }
    end
    figures.case("S.arch.3dec.five", "Five voussoirs on soft joints, which slip a little: 3DEC with springs at the corners, and with the default points "
        .. "the statics of joints of many springs. A block that comes to rest swings, and slips the further the greater the portion of its weight: with "
        .. "gravity in 1, 10, 100 and 1000 portions the thrust is 2741.5, 2708.5, 2705.0 and 2704.6 N. Statics that grow in proportion have 2703.4 N and "
        .. "-1.1116 mm at the crown on moved blocks, and 2698.2 N and -1.1073 mm on blocks where they were drawn.", case.source
        .. "; many springs: statics of moved rigid voussoirs on 200 springs a joint without tension, with the slip of each")
    local model, joint = build(case, sections, "corners")
    figures.relative("volume of the second block, m3", model:blocks { id = 2 }[1].volume, case.volume, 1e-5)
    figures.relative("thrust, N", joint(2).force[1], case.thrust, PRINTED)
    figures.relative("way of the crown, m", model:blocks { id = 3 }[1].displacement[3], case.crown, PRINTED + case.crown_rounded)
    figures.relative("vertical force at a support, N", -joint(1).force[3] + model:blocks { id = 1 }[1].mass * case.gravity,
        case.vertical, PRINTED)
    model, joint = build(case, sections, "consistent")
    figures.relative("default points: thrust, N", joint(2).force[1], case.refined.thrust, MOVED)
    figures.relative("default points: way of the crown, m", model:blocks { id = 3 }[1].displacement[3], case.refined.crown, MOVED)
end
figures.finish()
