-- A drive's function is called in the middle of a step, which has been chosen for the model as it is. Whatever would change
-- what the step depends on is refused there with a sentence and changes nothing; reading is allowed.
local talus = require "talus"
local check = require "check"

-- Columns of two on a table, with a block beside it that follows the function `motion(t, model)`, turning or moving.
local function scene(threads, key, motion)
    local model = talus.model { threads = threads, gravity = { 0, 0, -9.81 } }
    model:generate("box", { min = { 0, 0, -1 }, max = { 6, 3, 0 }, density = 2000, group = "table" })
    for i = 0, 1 do
        for k = 0, 1 do
            model:generate("box", { min = { 3 * i + 1, 1, k }, max = { 3 * i + 2, 2, k + 1 }, density = 2000,
                group = "column" })
        end
    end
    model:generate("box", { min = { 6, 0, -1 }, max = { 7, 3, 0 }, density = 2000, group = "driven" })
    model:blocks { group = "table" }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:damping("viscous", { alpha = 1 })
    model:blocks { group = "column" }:set { velocity = { 0, 0, -0.1 } }
    model:blocks { group = "driven" }:drive { [key] = function(t)
        motion(t, model)
        return 0, 0, 0.01
    end }
    return model
end

local function column(model)
    return model:blocks { group = "column" }
end

-- { what the sentence says, the call }
local settings = {
    { "set a law or its properties", function(m) m:joint("*", "coulomb", { kn = 1e12, ks = 1e12, friction = 30 }) end },
    { "set a law or its properties", function(m) m:joint("*", { kn = 1e12 }) end },
    { "set a law or its properties", function(m) m:joint("*", "elastic", { kn = 1e8, ks = 1e8 }) end },
    { "set damping", function(m) m:damping("local", { alpha = 0.8 }) end },
    { "set damping", function(m) m:damping("none") end },
    { "put stress on contacts", function(m) m:insitu { stress = { xx = -1e6, yy = -1e6, zz = -1e6 } } end },
    { "set timestep", function(m) m:timestep { fraction = 0.9 } end },
    { "set timestep", function(m) m:timestep { rule = "paper" } end },
    { "set timestep", function(m) m:timestep { dt = 1e-5 } end },
    { "set mass_scaling", function(m) m:mass_scaling(true) end },
    { "set contact_area", function(m) m:contact_area { fraction = 0.5 } end },
    { "set contact_area", function(m) m:contact_area { absolute = 0.1 } end },
    { "set gravity", function(m) m.gravity = { 0, 0, 9.81 } end },
    { "set rotation", function(m) m.rotation = "paper" end },
    { "set contact_points", function(m) m.contact_points = "corners" end },
    { "set reuse_geometry", function(m) m.reuse_geometry = false end },
    { "set properties of blocks", function(m) column(m):set { density = 1 } end },
    { "set properties of blocks", function(m) column(m):set { velocity = { 0, 0, 100 } } end },
    { "set properties of blocks", function(m) column(m):set { angular_velocity = { 0, 3, 0 } } end },
    { "set properties of blocks", function(m) column(m):set { group = "other" } end },
    { "load blocks", function(m) column(m):load { force = { 1e6, 0, 0 } } end },
    { "load blocks", function(m) column(m):load { moment = { 0, 0, 1e6 }, at = { 0, 0, 0 } } end },
    { "fix blocks", function(m) column(m):fix() end },
    { "fix blocks", function(m) column(m):fix { x = true } end },
    { "free blocks", function(m) m:blocks { group = "table" }:free() end },
    { "drive blocks", function(m) column(m):drive { velocity = { 1, 0, 0 } } end },
}

local CYCLES, CALLED = 12, 5

-- The state after a run in whose CALLED-th step the function calls `act`, and the message if that is refused.
local function run(threads, key, act)
    local calls, message = 0, nil
    local model = scene(threads, key, function(_, model)
        calls = calls + 1
        if calls == CALLED and act then
            message = select(2, pcall(act, model))
        end
    end)
    model:cycle(CYCLES)
    check.equal(calls, CYCLES)
    return model:state_hash(), message, model
end

local undisturbed = {}
for _, key in ipairs { "velocity", "angular_velocity" } do
    undisturbed[key] = run(1, key)
end
for i, case in ipairs(settings) do
    local what, act = case[1], case[2]
    local key = i % 2 == 0 and "velocity" or "angular_velocity"
    local hash, message, model = run(i % 3 + 1, key, act)
    check.holds(message and message:find("cannot " .. what .. " from a drive's function", 1, true),
        string.format("case %d (%s): %s", i, what, message))
    check.equal(hash, undisturbed[key])

    -- Between two runs it is allowed, and the state tells.
    act(model)
    check.holds(model:state_hash() ~= hash, what .. " between runs changes the state")

    -- So it is in on_progress, before which the step is whole.
    local acted = 0
    model = scene(1, key, function() end)
    model:solve { ratio = 0, max_cycles = 4, every = 2, on_progress = function()
        if acted == 0 then
            act(model)
        end
        acted = acted + 1
    end }
    check.holds(acted > 0, "progress was called")

    -- What is not caught ends the run after the whole step, with the line of the script.
    local function go()
        local calls = 0
        model = scene(1, key, function(_, m)
            calls = calls + 1
            if calls == CALLED then
                act(m)
            end
        end)
        model:cycle(CYCLES)
    end
    message = select(2, pcall(go))
    check.holds(message:find("test_drive_functions.lua:%d+: cannot " .. what), message)
    check.equal(model.cycles, CALLED)
    model:cycle(CYCLES - CALLED)
    check.equal(model:state_hash(), undisturbed[key])
end

-- Whatever can be read may be read.
local seen
local hash, message = run(2, "velocity", function(m)
    seen = { m.gravity[3], m.time, m.cycles, m.dt, m:timestep().dt, #m:blocks(), #m:contacts(), m:energy().kinetic,
        m.rotation, m.contact_points, column(m)[1].velocity[3], m:contacts()[1].normal_force, m:state_hash() }
end)
check.equal(message, nil)
check.equal(hash, undisturbed.velocity)
check.equal(seen[1], -9.81)
check.equal(seen[3], CALLED - 1)
check.equal(#seen, 13)
