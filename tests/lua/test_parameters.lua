-- model:parameters(): all that is in force, as a table and as a printed page; asking changes nothing.
local talus = require "talus"
local check = require "check"

local function empty(list)
    check.equal(next(list), nil)
end

-- A model of defaults.
local model = talus.model { threads = 1 }
local p = model:parameters()
check.near(p.gravity, { 0, 0, -9.81 }, 0)
check.equal(p.seed, 1)
check.equal(math.type(p.seed), "integer")
check.equal(p.threads, 1)
check.equal(p.rotation, "exact")
check.equal(p.contact_points, "consistent")
check.equal(p.reuse_geometry, true)
check.equal(p.timestep.rule, "body")
check.equal(p.timestep.fraction, 0.5)
check.equal(p.timestep.given, nil)
check.equal(p.timestep.dt, model.dt)
check.equal(p.mass_scaling.on, false)
check.equal(p.mass_scaling.dt, nil)
check.equal(p.damping.name, nil)
empty(p.damping.parameters)
empty(p.laws)
empty(p.joints)
check.equal(p.contact_area["*"].fraction, 0)
check.equal(p.contact_area["*"].absolute, nil)

-- What a script has set, and what it has left out.
local function rock()
    local m = talus.model { gravity = { 0, 1, -5 }, seed = 7, rotation = "paper", contact_points = "corners",
        reuse_geometry = false, threads = 2 }
    m:generate("box", { min = { 0, 0, 0 }, max = { 4, 4, 4 }, density = 2500 })
    for i, name in ipairs { "J1", "J2", "J3" } do
        m:generate("joint", { joint = name, dip = 30 * i - 20, dip_direction = 100, origin = { 2, 2, 2 } })
    end
    m:generate("joint", { joint = "J1", dip = 10, dip_direction = 100, origin = { 2, 2, 1 } })
    return m
end
model = rock()
check.equal(model:parameters().joints.J1, "")
check.holds(model:parameters().timestep.message:find("law", 1, true), "no law yet")
check.equal(model:parameters().timestep.dt, nil)
model:joint("*", "coulomb", { kn = 1e8, ks = 2e7, friction = 35 })
model:joint("J1:2", "coulomb_tensile", { kn = 3e8, ks = 1e8, tension = 1e5 })
model:joint("J2", { friction = 20 })
model:damping("local")
model:timestep { rule = "paper" }
model:contact_area { fraction = 0.02 }
model:contact_area { absolute = 0.5, joint = "J3" }
model:mass_scaling { dt = 2e-3, most = 10 }
local before = model:state_hash()
p = model:parameters()
check.equal(model:state_hash(), before)
check.near(p.gravity, { 0, 1, -5 }, 0)
check.equal(p.seed, 7)
check.equal(p.rotation, "paper")
check.equal(p.contact_points, "corners")
check.equal(p.reuse_geometry, false)
check.equal(p.threads, 2)
check.equal(p.timestep.rule, "paper")
check.equal(p.timestep.fraction, 0.1)
check.equal(p.timestep.dt, model.dt)
check.equal(p.mass_scaling.on, true)
check.equal(p.mass_scaling.dt, 2e-3)
check.equal(p.mass_scaling.most, 10)
check.equal(p.damping.name, "local")
check.equal(p.damping.parameters.alpha, 0.8)
check.equal(p.laws["*"].law, "coulomb")
for name, value in pairs { kn = 1e8, ks = 2e7, friction = 35, cohesion = 0, dilation = 0 } do
    check.equal(p.laws["*"].parameters[name], value)
end
check.equal(p.laws["*"].parameters.dilation_limit, nil)
check.equal(p.laws["J1:2"].law, "coulomb_tensile")
check.equal(p.laws["J1:2"].parameters.tension, 1e5)
check.equal(p.laws.J2.parameters.friction, 20)
check.equal(p.laws.J2.parameters.kn, 1e8)
check.equal(p.laws.J1, nil)
check.equal(p.joints.J1, "*")
check.equal(p.joints.J2, "J2")
check.equal(p.joints.J3, "*")
check.equal(p.contact_area["*"].fraction, 0.02)
check.equal(p.contact_area.J3.absolute, 0.5)
check.equal(p.contact_area.J3.fraction, nil)

-- Later changes show.
model:joint("*", { friction = 12 })
model:damping("none")
model:timestep { dt = 1e-3 }
model:mass_scaling(false)
p = model:parameters()
check.equal(p.laws["*"].parameters.friction, 12)
check.equal(p.damping.name, "none")
check.equal(p.timestep.given, 1e-3)
check.equal(p.timestep.dt, 1e-3)
check.equal(p.mass_scaling.on, false)
check.raises(function() model:parameters(1) end, "1 argument too many")

-- The page.
local program = os.getenv("TALUS_PROGRAM")
local script = string.format("%s/parameters_%s.lua", assert(os.getenv("TALUS_TEST_TMP")),
    tostring({}):match("0x(%x+)") or "0")
local file = assert(io.open(script, "w"))
file:write([[
local talus = require "talus"
local m = talus.model { gravity = { 0, 0, -9.81 }, seed = 3 }
m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
m:generate("joint", { joint = "J1", dip = 0, dip_direction = 0, origin = { 0, 0, 0.5 } })
m:joint("*", "coulomb", { kn = 1e8, ks = 123456789, friction = 35 })
m:damping("local", { alpha = 0.7 })
m:timestep { dt = 1e-5 }
m:parameters()
]])
file:close()
local function page(option)
    local pipe = assert(io.popen("'" .. program .. "' " .. option .. " '" .. script .. "'"))
    local text = pipe:read("a")
    check.holds(pipe:close(), "exit status")
    return text
end
local text = page("")
local at = 1
for _, row in ipairs { "gravity             {0, 0, -9.81} m/s2 (default)\n", "seed                3\n",
    "rotation            exact (default)\n", "timestep            given, 1e-05 s\n  dt                1e-05 s\n",
    "mass_scaling        off\n", "damping             local\n  alpha             0.7\n",
    "joint *             coulomb\n  kn                1e+08 Pa/m\n  ks                123456789 Pa/m\n" ..
    "  friction          35 deg\n  cohesion          0 Pa (default)\n", "joint J1            as joint *\n",
    "contact_area        none (default)\n" } do
    local found = text:find(row, at, true)
    check.holds(found, row .. " in " .. text)
    at = found
end
check.equal(page("--quiet"), "")
os.remove(script)
