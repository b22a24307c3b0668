-- Cubes standing on each other on a fixed base: force and closure of every joint, settlement. Joints that close by less
-- than 0.4 % of the side are linear springs; under ten cubes on soft joints seven close by more (check_joint.lua).
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local joint = require "check_joint"
local reference = require "reference_statics"

local FORCE = 1e-4   -- relative
local CLOSURE = 1e-6 -- relative
local AT_REST = 1e-8 -- unbalanced force ratio: well below FORCE

local function check(name)
    local case = reference[name]
    local side = case.side
    figures.case(name, string.format("%d cubes of %g m are set on each other on a fixed base and "
        .. "come to rest under their weight; force and closure of every joint and the settlement "
        .. "of the top are compared.", case.n, side), case.source)
    local model = talus.model { gravity = { 0, 0, -case.g } }
    model:generate("box", { min = { -side, -side, -side }, max = { 2 * side, 2 * side, 0 },
        density = case.rho, group = "base" })
    for k = 1, case.n do
        model:generate("box", { min = { 0, 0, (k - 1) * side }, max = { side, side, k * side },
            density = case.rho, group = "cube " .. k })
    end
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", { kn = case.kn, ks = case.kn, friction = 30 })
    model:timestep { rule = "body", fraction = 0.5 }
    model:damping "local"
    figures.equal("at rest after", model:solve { ratio = AT_REST }.reason, "ratio")

    local joints, forces, below = {}, {}, model:blocks { group = "base" }
    local closure, settlement = {}, 0
    for k = 1, case.n do
        closure[k] = joint.closure(case.kn, side, case.joint_force[k])
        settlement = settlement + closure[k]
    end
    for k = 1, case.n do
        local cube = model:blocks { group = "cube " .. k }
        local contacts = model:contacts { between = { below, cube } }
        figures.equal(string.format("joint %d contacts", k), #contacts, 1)
        joints[k], forces[k] = k, contacts[1].normal_force
        figures.relative(string.format("joint %d force", k), forces[k], case.joint_force[k], FORCE)
        figures.relative(string.format("joint %d closure", k), -contacts[1].gap, closure[k],
            CLOSURE)
        below = cube
    end
    figures.relative("settlement of the top", -below[1].displacement[3], settlement,
        CLOSURE)
    figures.plot { title = name .. ": force in the joints", x = "joint, 1 at the base",
        y = "normal force, N", series = {
            { name = "weight above", x = joints, y = case.joint_force, style = "line" },
            { name = "obtained", x = joints, y = forces, style = "points" } } }
end

check "S.stack.10"
check "S.stack.3"
figures.finish()
