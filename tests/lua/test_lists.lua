-- What there is: joints, laws and groups of a model; laws, dampings, generators and screens of the program.
local talus = require "talus"
local check = require "check"

local model = talus.model {}
check.equal(#model:joints(), 0)
check.equal(#model:laws(), 0)
check.equal(#model:groups(), 0)

model:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2000 })
model:generate("box", { min = { 4, 0, 0 }, max = { 5, 1, 1 }, density = 2000, group = "toe" })
model:generate("joint", { joint = "fault", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
model:generate("jointset", { joint = "J1", dip = 90, dip_direction = 90, spacing = 1, number = 3, origin = { 2, 0, 0 } })
local joints = model:joints()
check.equal(#joints, 2)
check.equal(joints[1].name, "fault")
check.equal(joints[1].planes, 1)
check.equal(joints[1].law, nil)
check.equal(joints[2].name, "J1")
check.equal(joints[2].planes, 3)

model:joint("*", "elastic", { kn = 1e9, ks = 1e8 })
model:joint("J1", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
model:joint("J1:2", "coulomb_tensile", { kn = 1e9, ks = 1e9, tension = 1e5, friction = 20 })
joints = model:joints()
check.equal(joints[1].law, "elastic")
check.equal(joints[2].law, "coulomb")
local laws = {}
for _, law in ipairs(model:laws()) do
    laws[law.joint] = law
end
check.equal(#model:laws(), 3)
check.equal(laws["*"].law, "elastic")
check.equal(laws["*"].parameters.ks, 1e8)
check.equal(laws["J1"].parameters.friction, 30)
check.equal(laws["J1:2"].law, "coulomb_tensile")
check.equal(laws["J1:2"].parameters.tension, 1e5)
check.equal(laws["J1:2"].parameters.residual_friction, nil)
model:joint("J1", { friction = 25 })
for _, law in ipairs(model:laws()) do
    if law.joint == "J1" then
        check.equal(law.parameters.friction, 25)
        check.equal(law.parameters.kn, 1e9)
    end
end
-- The parameters of a law are what another joint may be given.
model:joint("fault", "coulomb", laws["J1"].parameters)
check.equal(model:joints()[1].law, "coulomb")

local groups = model:groups()
check.equal(#groups, 2)
check.equal(groups[1].name, "rock")
check.near(groups[1].volume, 64, 1e-9)
check.equal(groups[1].blocks, #model:blocks { group = "rock" })
check.equal(groups[2].name, "toe")
model:blocks { group = "toe" }:delete()
check.equal(#model:groups(), 1)
model:blocks {}:hide()
check.equal(#model:groups(), 1)

local function names(list)
    local set = {}
    for _, entry in ipairs(list) do
        set[entry.name] = entry
    end
    return set
end
check.holds(names(talus.laws()).coulomb, "coulomb is loaded")
check.equal(names(talus.laws()).coulomb.plugin, "talus.coulomb")
check.equal(names(talus.laws()).coulomb_tensile.states[1], "bond")
check.equal(names(talus.laws()).elastic.parameters[1], "kn")
check.holds(names(talus.dampings()).adaptive, "adaptive is loaded")
check.holds(names(talus.generators()).profile, "profile is loaded")
local browser = names(talus.screens()).browser -- where its library is
check.equal(browser and browser.plugin or "talus.browser", "talus.browser")
check.equal(browser and browser.parameters[1] or "port", "port")
check.equal(names(talus.laws()).box, nil)

check.refused(model, function() model:joints("J1") end, "1 argument too many")
check.refused(model, function() model:laws {} end, "1 argument too many")
check.refused(model, function() model.groups() end, "write model:groups(...)")
check.raises(function() talus.laws(1) end, "talus.laws: 1 argument too many")
