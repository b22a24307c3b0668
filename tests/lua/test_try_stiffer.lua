-- Trials with stiffer joints: what they answer, and that the run itself is the same with and without.
local talus = require "talus"
local check = require "check"

-- A half-circle arch of voussoirs on fixed springers, pushed sideways by a share of its weight.
local function arch(kn, push, points)
    local model = talus.model { gravity = { push * 9.81, 0, -9.81 } }
    if points then
        model.contact_points = points
    end
    local n = 7
    local function ring(i, r)
        local a = math.pi * (1 - i / n)
        return r * math.cos(a), r * math.sin(a)
    end
    for i = 0, n - 1 do
        local vertices = {}
        for _, corner in ipairs { { i, 4.6 }, { i, 5.4 }, { i + 1, 4.6 }, { i + 1, 5.4 } } do
            local x, z = ring(corner[1], corner[2])
            table.insert(vertices, { x, 0, z })
            table.insert(vertices, { x, 1, z })
        end
        model:generate("polyhedron", { vertices = vertices, density = 2400, group = "arch" })
    end
    model:generate("box", { min = { -5.4, 0, -1 }, max = { -4.6, 1, 0 }, density = 2400, group = "ground" })
    model:generate("box", { min = { 4.6, 0, -1 }, max = { 5.4, 1, 0 }, density = 2400, group = "ground" })
    model:blocks { group = "ground" }:fix()
    model:joint("*", "coulomb", { kn = kn, ks = kn, friction = 60 })
    model:damping "local"
    return model
end

-- The table of docs/how_stiff.md is for 11 voussoirs; here soft joints fail under a push that stiff ones bear.
local function verdicts(kn, push)
    local soft = arch(kn, push):relax { max_cycles = 200000 }
    local stiff = arch(10 * kn, push):relax { max_cycles = 200000 }
    return soft.reason, stiff.reason
end

local kn, push = 3e7, 0.03
local soft, stiff = verdicts(kn, push)
check.equal(soft, "failure")
check.equal(stiff, "rest")
local model = arch(kn, push)
local plain = arch(kn, push)
local result = model:relax { max_cycles = 200000, try_stiffer = true }
check.equal(result.reason, "failure")
check.equal(result.stiffer.reason, "rest")
check.equal(result.stiffer.differs, true)
check.holds(result.stiffer.message:find("hangs on the stiffness", 1, true), result.stiffer.message)
-- The run itself is that without the trial, to the bit, and the laws are as they were.
local without = plain:relax { max_cycles = 200000 }
check.equal(without.cycles, result.cycles)
check.equal(without.stiffer, nil)
check.equal(plain:state_hash(), model:state_hash())
check.equal(model:laws()[1].parameters.kn, kn)

-- Verdicts that agree; solve; the user's functions are not called by the trial.
model = arch(1e9, 0)
local calls = 0
result = model:solve { ratio = 1e-4, try_stiffer = true, every = 10, stop = function(m)
    check.equal(m, model)
    calls = calls + 1
    return false
end }
check.equal(result.reason, "ratio")
check.equal(result.stiffer.reason, "ratio")
check.equal(result.stiffer.differs, false)
check.equal(result.stiffer.message, nil)
check.equal(calls, result.cycles // 10)
plain = arch(1e9, 0)
plain:solve { ratio = 1e-4 }
check.equal(plain:state_hash(), model:state_hash())

-- A trial that comes to a limit of cycles has no verdict: nothing differs, and what is open is told.
local few = arch(kn, push):relax { max_cycles = 200000 }.cycles
for cycles = few, few + 20000, 500 do
    result = arch(kn, push):relax { max_cycles = cycles, try_stiffer = true }
    check.equal(result.reason, "failure")
    check.equal(result.stiffer.differs, result.stiffer.reason == "rest")
    if result.stiffer.differs then
        break
    end
    check.equal(result.stiffer.reason, "cycles")
    check.holds(result.stiffer.message:find("it is open whether", 1, true) and result.stiffer.message:find("raise max_cycles", 1, true))
end
result = arch(kn, push):relax { max_cycles = 3, try_stiffer = true }
check.equal(result.stiffer.differs, false)
check.equal(result.stiffer.message:find("stiffness", 1, true), nil)

-- A run that is stopped has nothing to compare with.
result = arch(1e9, 0):solve { every = 5, try_stiffer = true, stop = function() return true end }
check.equal(result.reason, "stop")
check.equal(result.stiffer, nil)

check.raises(function() model:relax { try_stiffer = 1 } end, "relax: try_stiffer must be true or false")
check.raises(function() model:relax { try_stifer = true } end, "try_stiffer")
check.raises(function() model:cycle(1, { try_stiffer = true }) end, "try_stiffer")

-- Every law marks its stiffnesses: each trial of a block on a floor rests as stiffly as its law says.
local laws = {
    elastic = {}, coulomb = { friction = 30 }, coulomb_tensile = { friction = 30, tension = 0 },
    barton_bandis = { kn = false, kni = 1e8, vm = 1e-2, jrc = 5, jcs = 5e7, phi_r = 30 },
    continuously_yielding = { kn = false, ks = false, an = 1e8, en = 0, as = 1e8, es = 0, phi_i = 40, phi = 30, roughness = 1e-3 },
}
for law, more in pairs(laws) do
    local given = { kn = 1e8, ks = 1e8 }
    for key, value in pairs(more) do
        given[key] = value or nil
    end
    local floor = talus.model { gravity = { 0, 0, -10 } }
    floor:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500, group = "block" })
    floor:generate("box", { min = { -1, -1, -1 }, max = { 2, 2, 0 }, density = 2500 })
    floor:blocks { group = "rock" }:fix()
    floor:blocks { group = "block" }:fix { x = true, y = true, rotation = true }
    floor:joint("*", law, given)
    floor:damping "local"
    local before = floor:state_hash()
    check.equal(floor:state_hash(), before)
    local answer = floor:relax { try_stiffer = true, ratio = 1e-6 }
    check.equal(answer.reason, "rest")
    check.equal(answer.stiffer.reason, "rest")
end
