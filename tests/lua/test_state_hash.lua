-- state_hash: whatever changes what comes after changes it, and nothing else does. Two models of the same hash go on alike.
local talus = require "talus"
local check = require "check"

local TMP = os.getenv "TALUS_TEST_TMP" .. "/state_hash"

local LAW = { kn = 1e8, ks = 1e8, friction = 30 }

local function build(options)
    options = options or {}
    options.gravity = options.gravity or { 0.5, 0, -10 }
    local model = talus.model(options)
    model:generate("box", { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = 2000, group = "base" })
    model:generate("box", { min = { -1, -1, 0 }, max = { 1, 1, 2 }, density = 2000, group = "rock" })
    model:generate("jointset", { joint = "J1", dip = 50, dip_direction = 80, spacing = 0.7, origin = { 0, 0, 1 } })
    model:generate("box", { min = { -0.5, -0.5, 2 }, max = { 0.5, 0.5, 2.5 }, density = 2000, group = "cap" })
    model:blocks { group = "base" }:fix()
    model:joint("*", "coulomb", LAW)
    return model
end

local function rock(model) return model:blocks { group = "rock" } end
local function cap(model) return model:blocks { group = "cap", hidden = "any" } end
local function drive(velocity) return function(model) cap(model):drive { velocity = velocity } end end

-- Name, change, and what undoes it where something does.
local settings = {
    { "gravity", function(m) m.gravity = { 0.5, 0, -9 } end, function(m) m.gravity = { 0.5, 0, -10 } end },
    { "rotation", function(m) m.rotation = "paper" end, function(m) m.rotation = "exact" end },
    { "contact_points", function(m) m.contact_points = "corners" end, function(m) m.contact_points = "consistent" end },
    { "reuse_geometry", function(m) m.reuse_geometry = false end, function(m) m.reuse_geometry = true end },
    { "fraction", function(m) m:timestep { fraction = 0.05, rule = "body" } end },
    { "rule", function(m) m:timestep { fraction = 0.05, rule = "paper" } end },
    { "dt", function(m) m:timestep { dt = 1e-4 } end },
    { "another dt", function(m) m:timestep { dt = 2e-4 } end },
    { "dt let go", function(m) m:timestep { fraction = 0.05, rule = "paper" } end },
    { "mass_scaling", function(m) m:mass_scaling(true) end, function(m) m:mass_scaling(false) end },
    { "mass_scaling for a step", function(m) m:mass_scaling { dt = 1e-3 } end },
    { "its step", function(m) m:mass_scaling { dt = 2e-3 } end },
    { "its most", function(m) m:mass_scaling { dt = 2e-3, most = 0.1 } end, function(m) m:mass_scaling { dt = 2e-3 } end },
    { "mass_scaling off", function(m) m:mass_scaling(false) end },
    { "contact_area", function(m) m:contact_area { fraction = 0.03 } end },
    { "contact_area, absolute", function(m) m:contact_area { absolute = 0.01 } end },
    { "contact_area of a joint", function(m) m:contact_area { fraction = 0.03, joint = "J1" } end },
    { "contact_area of a plane", function(m) m:contact_area { fraction = 0.03, joint = "J1:1" } end },
    { "damping", function(m) m:damping("local", { alpha = 0.5 }) end },
    { "its parameter", function(m) m:damping("local", { alpha = 0.6 }) end },
    { "another damping", function(m) m:damping("viscous", { alpha = 0.6 }) end },
    { "adaptive damping", function(m) m:damping("adaptive", {}) end },
    { "kn", function(m) m:joint("*", { kn = 2e8 }) end },
    { "friction", function(m) m:joint("*", { friction = 31 }) end, function(m) m:joint("*", { friction = 30 }) end },
    { "law", function(m) m:joint("*", "elastic", { kn = 2e8, ks = 1e8 }) end },
    { "law of a joint", function(m) m:joint("J1", "coulomb", LAW) end },
    { "law of a plane", function(m) m:joint("J1:1", "coulomb", LAW) end },
    { "density", function(m) cap(m):set { density = 2100 } end, function(m) cap(m):set { density = 2000 } end },
    { "group", function(m) rock(m):set { group = "stone" } end,
        function(m) m:blocks { group = "stone" }:set { group = "rock" } end },
    { "velocity", function(m) cap(m):set { velocity = { 0, 0, 0.125 } } end },
    { "angular_velocity", function(m) cap(m):set { angular_velocity = { 0, 0, 0.125 } } end },
    { "hide", function(m) cap(m):hide() end, function(m) cap(m):show() end },
    { "fix", function(m) cap(m):fix() end },
    { "free", function(m) cap(m):free() end },
    { "fix x", function(m) cap(m):fix { x = true } end, function(m) cap(m):free() end },
    { "load", function(m) cap(m):load { force = { 0, 0, 1 } } end, function(m) cap(m):load {} end },
    { "load elsewhere", function(m) cap(m):load { force = { 0, 0, 1 }, at = { 0.1, 0, 2 } } end, function(m) cap(m):load {} end },
    { "moment", function(m) cap(m):load { moment = { 0, 0, 1 } } end, function(m) cap(m):load {} end },
    { "drive", drive { 0, 0, 0 } },
    { "drive faster", drive { 0, 0, 0.125 } },
    { "drive by a function", drive(function() return 0, 0, 0.125 end) },
    { "let go", function(m) cap(m):free() end },
    { "insitu", function(m) m:insitu { stress = { xx = -1e4 } } end },
    { "join", function(m) rock(m):join() end },
    { "unjoin", function(m) rock(m):unjoin() end },
    { "generate", function(m) m:generate("box", { min = { 8, 8, 0 }, max = { 9, 9, 1 }, density = 2000, group = "far" }) end },
    { "delete", function(m) m:blocks { group = "far" }:delete() end }, -- the next block has another id than before
    { "cut", function(m) m:generate("joint", { joint = "J2", dip = 5, dip_direction = 0, origin = { 0, 0, 1 } }) end },
    { "cut of nothing", function(m) m:generate("joint", { joint = "J2", dip = 5, dip_direction = 0, origin = { 0, 0, 99 } }) end },
    { "cycle", function(m) m:cycle(1) end },
}

-- On a model that has not run, and on one that has.
for _, steps in ipairs { 0, 25 } do
    local model = build()
    model:cycle(steps)
    for _, setting in ipairs(settings) do
        local name, change, back = table.unpack(setting)
        local before = model:state_hash()
        change(model)
        local after = model:state_hash()
        check.holds(after ~= before, name .. " changes the hash")
        if back then
            back(model)
            -- In a model that has run the step in use and forces that stay are other than before.
            check.holds(steps > 0 or model:state_hash() == before, name .. " undone gives the hash of before")
        end
    end
end

-- What is chosen when the model is made.
local plain = build():state_hash()
check.equal(build():state_hash(), plain)
check.equal(build { threads = 3 }:state_hash(), plain)
for _, options in ipairs { { seed = 2 }, { gravity = { 0, 0, -10 } }, { rotation = "paper" }, { contact_points = "corners" },
    { reuse_geometry = false } } do
    check.holds(build(options):state_hash() ~= plain, "another " .. next(options))
end

-- Orders and places that mean nothing: laws and areas in another order, a property set to what it is, columns that some
-- model has needed and no block uses.
local function laws(first, second)
    local model = build()
    for _, joint in ipairs { first, second } do
        model:joint(joint, "coulomb_tensile", { kn = 1e8, ks = 5e7, friction = #joint, cohesion = 1e5 })
        model:contact_area { fraction = 0.01 * #joint, joint = joint }
    end
    model:cycle(10)
    return model:state_hash()
end
check.equal(laws("J1", "J1:1"), laws("J1:1", "J1"))
local model = build()
model:joint("*", {})
model:joint("*", "coulomb", LAW)
model:damping("local", {})
local damped = model:state_hash()
model:damping("local", {})
cap(model):load {}
model.gravity = model.gravity
check.equal(model:state_hash(), damped)

-- Questions, views and files, and calls that are refused.
local function ask(model)
    local sum = 0
    for _, contact in ipairs { model:contacts()[1], model:contacts()[2] } do
        sum = sum + contact.area + contact.gap
    end
    for _, name in ipairs { "mass", "volume", "displacement", "velocity" } do
        model:blocks { hidden = "any" }:sum(name)
    end
    local block = cap(model)[1]
    sum = sum + #block.neighbours + #block.vertices + model.dt + model:timestep().dt + model.time
    model:profile(true)
    model:memory()
    model:energy()
    model:keyblocks { friction = 30 }
    model:filter { volume = 0.1 }
    model:write_vtk(TMP)
    model:write_section(TMP, { dip = 90, dip_direction = 0, origin = { 0, 0, 0 } })
    model:write_blocks(TMP .. ".json")
    model:state_hash()
    for _, refused in ipairs { function() model:joint("J9", "coulomb", LAW) end, function() model:cycle(-1) end,
        function() model:generate("box", { min = { 0, 0, 0 }, max = { 0, 1, 1 }, density = 1, group = "new" }) end,
        function() model:timestep { dt = -1 } end, function() cap(model):set { density = -1, group = "new" } end,
        function() model:contact_area { fraction = -1 } end, function() model:damping("none at all") end } do
        check.holds(not pcall(refused), "a mistake")
    end
    return sum
end
for _, steps in ipairs { 0, 1, 25 } do
    local asked, unasked = build(), build()
    for _ = 1, 3 do
        asked:cycle(steps)
        unasked:cycle(steps)
        local before = asked:state_hash()
        ask(asked)
        check.equal(asked:state_hash(), before)
        check.equal(unasked:state_hash(), before)
        cap(asked):reset_displacement() -- only what is told begins anew
        check.equal(asked:state_hash(), before)
    end
end

-- A hash between two changes of the bodies changes nothing that follows.
local function change(hashes)
    local model = build()
    model:cycle(25)
    for _, verb in ipairs { "join", "unjoin", "join" } do
        local blocks = rock(model)
        blocks[verb](blocks)
        if hashes then
            model:state_hash()
        end
    end
    model:cycle(10)
    return model:state_hash()
end
check.equal(change(true), change(false))

-- The same hash, the same way on: of hidden blocks and a step that is given, too.
local function hidden(hides)
    local model = build()
    if hides then
        cap(model):hide()
    end
    return model:state_hash(), #model:blocks()
end
local one, count_one = hidden(false)
local two, count_two = hidden(true)
check.holds(one ~= two and count_one ~= count_two, "hiding shows in both")

-- What is left of an initial stress in a contact that is open: it has no points then, and presses more when it closes again.
-- A block in contact with a fixed one is turned out of its face's plane, lifted off, and let down.
local function lifted_off(stress)
    local m = talus.model { gravity = { 0, 0, 0 } }
    m:generate("box", { min = { -3, -3, -1 }, max = { 3, 3, 0 }, density = 2000, group = "base" })
    m:generate("box", { min = { -1, -1, 0 }, max = { 1, 1, 2 }, density = 2000, group = "rock" })
    m:blocks { group = "base" }:fix()
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    m:insitu { stress = { zz = stress } }
    m:blocks():load {} -- what holds the stress
    m:timestep { dt = 1e-4 }
    local block = rock(m)
    block:drive { velocity = { 0, 0, -0.5 }, angular_velocity = { 0.5, 0, 0 } }
    m:cycle(150)
    block:drive { velocity = { 0, 0, 0.5 } }
    repeat
        m:cycle(1)
    until m:contacts():sum "normal_force" == 0
    local open, steps = m:state_hash(), m.cycles
    block:drive { velocity = { 0, 0, -0.5 } }
    m:cycle(20)
    return open, steps, m:contacts():sum "normal_force"
end
local open, steps, force = lifted_off(-10)
local open_of_more, steps_of_more, force_of_more = lifted_off(-20)
check.equal(steps, steps_of_more)
check.holds(force_of_more > force, "a contact that was under more stress presses more")
check.holds(open ~= open_of_more, "and is another state while it is open")
local again, _, force_again = lifted_off(-10)
check.equal(again, open)
check.equal(force_again, force)

-- Blocks that slide in between a floor and a roof, so that contact areas change all the time, and one that only settles. Rates of the
-- bodies that are kept from step to step are part of the state where motion follows from them: models of the same hash go on
-- alike after calls that make rates anew.
local function sliding(setting, threads)
    local m = talus.model { threads = threads, gravity = { 0, 0, -9.81 } }
    m:generate("box", { min = { 0, 0, 0 }, max = { 8, 4, 1 }, density = 2000, group = "floor" })
    m:generate("box", { min = { 0, 0, 2 }, max = { 8, 4, 3 }, density = 2000, group = "floor" })
    m:generate("box", { min = { 7.6, 1, 1 }, max = { 8.6, 2, 2 }, density = 2000, group = "rock" })
    m:generate("box", { min = { 7.2, 3, 1 }, max = { 8.2, 4, 2 }, density = 2000, group = "rock" })
    m:generate("box", { min = { 1, 1, 1 }, max = { 2, 2.5, 2 }, density = 2000, group = "still" })
    m:blocks { group = "floor" }:fix()
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 0 })
    m:blocks { group = "rock" }:set { velocity = { -1.5, 0, 0 } }
    setting(m)
    return m
end
local function floor_of(m) return m:blocks { group = "floor" } end
local function scaled(m) m:mass_scaling(true) end
local function added(m) m:mass_scaling { dt = 1e-3, most = 1e9 } end
local function scaled_step(m) m:mass_scaling(true) m:timestep { dt = 1e-3 } end
local function by_body(m) m:timestep { rule = "body", fraction = 0.5 } end
local function by_paper(m) m:timestep { rule = "paper", fraction = 0.1 } end
local nothing = {
    function(m) floor_of(m):fix() end,
    function(m) rock(m):free() end,
}
local anew = {
    function(m) m:blocks { group = "still" }:set { density = 2000 } end,
    function(m) floor_of(m):load {} end,
    function(m) m:joint("*", { kn = 1e8 }) end,
    function(m) m.contact_points = "consistent" end,
    function(m) m.reuse_geometry = true end,
    function(m) m:timestep() end,
    function(m) m:state_hash() end,
}
local told, quiet = 0, 0 -- calls that the hash tells of, and those that it does not
for _, setting in ipairs { scaled, added, scaled_step, by_body, by_paper } do
    for _, steps in ipairs { 40, 64, 120 } do
        local function after(call, later)
            local m = sliding(setting, 1 + steps % 3)
            m:cycle(steps)
            call(m)
            local now = m:state_hash()
            later(m)
            m:cycle(5)
            return now, m:state_hash()
        end
        for _, later in ipairs { function() end, function(m) m.reuse_geometry = false end } do
            local plain_now, plain_then = after(function() end, later)
            for _, call in ipairs(nothing) do
                local now, afterwards = after(call, later)
                check.equal(now, plain_now)
                check.equal(afterwards, plain_then)
            end
            for k, call in ipairs(anew) do
                local now, afterwards = after(call, later)
                check.holds(now ~= plain_now or afterwards == plain_then, "the same hash goes on alike, call " .. k)
                told = told + (now ~= plain_now and 1 or 0)
                quiet = quiet + (now == plain_now and 1 or 0)
            end
        end
    end
end
check.holds(told > 0 and quiet > 0, "some calls make rates anew, and some change nothing")
