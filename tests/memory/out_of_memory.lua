-- out_of_memory.lua - every call of a small complete model, with each of its allocations failing in turn: there is no crash,
-- one clear sentence, the model is as it was, and the call made again gives what it gives in a model that never ran out.
--
--     LD_PRELOAD=memory_failure.so talus tests/memory/out_of_memory.lua [threads=2] [every=1] [leave=N] [only=NAME]
--
-- `every`: of allocations beyond the first `leave` of a call only each so many is let fail; of these, and of the first ones beyond
-- eight, one in TALUS_TEST_SHARE.
package.cpath = os.getenv "TALUS_TEST_MEMORY" .. "/?.so;" .. package.cpath
local talus = require "talus"
local memory = require "memory_failure"
io.stdout:setvbuf "line"

local options = { threads = "2", every = "1", leave = "40", only = "" }
for _, text in ipairs(arg) do
    local key, value = text:match "^(%w+)=(.*)$"
    assert(options[key], "unknown option " .. text)
    options[key] = value
end
local SHARE = os.getenv "TALUS_TEST_SHARE" or 1
local THREADS, EVERY, LEAVE = tonumber(options.threads), options.every * SHARE, math.max(8, options.leave // SHARE)
local TMP = os.getenv "TALUS_TEST_TMP" .. "/out_of_memory" .. THREADS

-- A mesh of two layers.
package.path = "tests/lua/?.lua;" .. package.path
local meshes = require "meshes"
local MESH = TMP .. "_mesh"
do
    local layers = meshes.box({ 0, 0, 0 }, { 1, 1, 1 }, { 1, 1, 2 }, function(_, _, z) return z < 0.5 and 1 or 2 end)
    meshes.vtk(MESH .. ".vtk", layers, { binary = true, text = "group" })
    meshes.gmsh(MESH .. ".msh", layers, { "low", "high" })
end

local function text_of(name)
    local file = assert(io.open(name))
    local text = file:read "a"
    file:close()
    return text
end

-- The frames of a page, without what is in them: ids of contacts depend on what was asked before.
local function frames_of(name)
    local frames = {}
    for frame in text_of(name):gmatch '<script type="text/talus"[^>]*>[^<]+</script>' do
        frames[#frames + 1] = frame:match "^[^>]*"
    end
    return table.concat(frames, "\n")
end

local COULOMB = { kn = 1e8, ks = 1e8, friction = 30 }

-- Name and work of each call, in order; what a call answers is compared, too (a function: what that answers when there is
-- memory again). `m` holds the model.
local calls = {
    { "model", function(m) m.model = talus.model { gravity = { 0, 0, -10 }, threads = THREADS } end },
    { "box", function(m)
        m.model:generate("box", { min = { 0, 0, 0 }, max = { 6, 6, 6 }, density = 2000, group = "rock" })
    end },
    { "polyhedron", function(m)
        m.model:generate("polyhedron", { vertices = { { 1, 1, 6 }, { 3, 1, 6 }, { 3, 3, 6 }, { 1, 3, 6 }, { 2, 2, 7.5 } },
            density = 2500, group = "cap" })
    end },
    { "jointset", function(m)
        return m.model:generate("jointset", { joint = "J1", dip = 60, dip_direction = 90, spacing = 1.7,
            persistence = 0.7, origin = { 3, 3, 3 } }).after
    end },
    { "joint", function(m)
        return m.model:generate("joint", { joint = "J2", dip = 10, dip_direction = 20, origin = { 3, 3, 2 } }).cuts
    end },
    { "tunnel", function(m)
        return m.model:generate("tunnel", { face1 = { { 2, 0, 2.5 }, { 2, 0, 4 }, { 4, 0, 4 }, { 4, 0, 2.5 } },
            face2 = { { 2, 6, 2.5 }, { 2, 6, 4 }, { 4, 6, 4 }, { 4, 6, 2.5 } }, group = "tunnel" }).after
    end },
    { "prism", function(m)
        m.model:generate("prism", { base = { { 7, 0, 0 }, { 9, 0, 0 }, { 9, 2, 0 }, { 7, 2, 0 } }, axis = { 0, 0, 1 }, density = 2000 })
    end },
    { "prisms", function(m)
        local list = {}
        for i = 1, 3 do
            list[i] = { base = { { 9 + i, 0, 0 }, { 10 + i, 0, 0 }, { 10 + i, 1, 0 } }, axis = { 0, 0, 1 }, density = 2000, group = "row" }
        end
        return m.model:generate("prism", list).after
    end },
    { "section", function(m)
        return m.model:generate("profile", { section = { { 20, 0 }, { 22, 0 }, { 22, 1 }, { 21, 1 }, { 21, 2 }, { 20, 2 } },
            to = 1, density = 2000, group = "wall" }).after
    end },
    { "delete", function(m) m.model:blocks { group = "tunnel" }:delete() end },
    { "delete a single one", function(m) m.model:blocks { group = "row" }:where(function(b) return b.centroid[1] > 12 end):delete() end },
    { "law", function(m) m.model:joint("*", "coulomb", COULOMB) end },
    { "query", function(m) return #m.model:contacts() end },
    { "first hash", function(m) return m.model:state_hash() end },
    { "law of J1", function(m) m.model:joint("J1", "coulomb_tensile", { kn = 2e8, ks = 1e8, friction = 40, cohesion = 1e5 }) end },
    { "fix", function(m) m.model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 0.9 } } }:fix() end },
    { "hide", function(m) m.model:blocks { group = "cap" }:hide() end },
    { "timestep", function(m) m.model:timestep { rule = "body", fraction = 0.2 } end },
    { "contact_area", function(m) m.model:contact_area { fraction = 0.02, joint = "J1" } end },
    { "damping", function(m) m.model:damping("local", { alpha = 0.5 }) end },
    { "insitu", function(m) m.model:insitu { stress = { xx = -1e5, yy = -1e5, zz = -1e5 } } end },
    { "first cycle", function(m) return m.model:cycle(1).ratio end, run = true },
    { "cycles", function(m) return m.model:cycle(20).ratio end, run = true },
    { "contact_area under load", function(m) m.model:contact_area { fraction = 0.015, joint = "J2" } end },
    { "law under load", function(m) m.model:joint("J2", "coulomb", { kn = 3e8, ks = 1e8, friction = 20 }) end },
    -- a trial that fails leaves the model as it is, and the run with it
    { "trial", function(m)
        return m.model:copy():relax { max_cycles = 5, try_stiffer = true }.reason
    end },
    { "set density", function(m) m.model:blocks():set { density = 2100 } end },
    { "set group", function(m) m.model:blocks { group = "rock" }:set { group = "stone", velocity = { 0, 0, 0.1 } } end },
    { "adaptive", function(m) m.model:damping("adaptive", {}) end },
    { "load", function(m) m.model:blocks { group = "cap", hidden = "any" }:load { force = { 100, 0, 0 } } end },
    { "drive", function(m)
        local blocks = m.model:blocks { inside = { min = { 7, 0, 0 }, max = { 9, 2, 1 } } }
        assert(#blocks == 1)
        blocks:drive { velocity = function(t) return -t, 0, 0 end }
    end },
    { "history", function(m) m.model:history { name = "cap", of = m.model:blocks { group = "stone" }, field = "displacement" } end },
    { "history of the model", function(m) m.model:history { name = "kinetic", every = 2, value = "kinetic" } end },
    { "solve", function(m) return m.model:solve { ratio = 1e-9, max_cycles = 30 }.ratio end, run = true, driven = true },
    { "free", function(m) m.model:blocks { inside = { min = { 6, -1, -1 }, max = { 9, 3, 2 } } }:free() end },
    { "join", function(m)
        local stone = m.model:blocks { group = "stone", fixed = false }
        local low = stone:where(function(block) return block.id <= stone[3].id end)
        low:join()
    end },
    { "cycle joined", function(m) return m.model:cycle(5).ratio end, run = true },
    { "unjoin", function(m)
        local stone = m.model:blocks { group = "stone", fixed = false }
        stone:where(function(block) return block.id == stone[2].id end):unjoin()
    end },
    { "delete one", function(m)
        local stone = m.model:blocks { group = "stone", fixed = false }
        stone:where(function(block) return block.id == stone[1].id end):delete()
    end },
    { "stage", function(m) m.model:stage "cut" end },
    { "verdict", function(m) return m.model:verdict().text end },
    { "slivers", function(m) return m.model:filter { volume = 0.05 }.found end },
    { "histories", function(m) return #m.model:histories().kinetic end },
    { "reset", function(m) m.model:blocks():reset_displacement() end },
    { "jointset later", function(m)
        return m.model:generate("jointset", { joint = "J3", dip = 80, dip_direction = 200, spacing = 3, origin = { 1, 1, 1 } }).after
    end },
    { "cycle cut", function(m) return m.model:cycle(5).ratio end, run = true },
    { "filter", function(m) return m.model:filter { volume = 0.05, action = "join" }.joined end },
    { "energy", function(m) return m.model:energy().kinetic end },
    { "report", function(m) return talus.report and m.model.dt end },
    { "keyblocks", function(m) return #m.model:keyblocks { friction = 35 } end },
    { "fields", function(m)
        local sum = 0
        for _, name in ipairs { "mass", "volume" } do sum = sum + m.model:blocks():sum(name) end
        local block = m.model:blocks()[1]
        for _, one in ipairs(m.model:blocks()) do sum = sum + #one.neighbours end
        return sum + #block.vertices + #block.faces + #block.neighbours
    end },
    { "points", function(m)
        local contact, sum = m.model:contacts {}[1], 0
        for _, point in ipairs(contact.points) do sum = sum + point.area end
        for name, value in pairs(m.model:contacts { joint = "J1" }[1].states) do sum = sum + #name + value end
        return sum
    end },
    { "values", function(m) return #m.model:blocks():values("velocity") + #m.model:contacts():values("opening", "flat") end },
    { "lists", function(m) return #m.model:joints() + #m.model:laws() + #m.model:groups() + #talus.laws() end },
    { "outer faces", function(m) return m.model:boundary { facing = { 0, 0, 1 } }.area end },
    { "boundary", function(m)
        return m.model:boundary { facing = { 0, 0, 1 }, within = 60, pressure = 1e3, fixed = true }.force[3]
    end },
    { "boundary beside it", function(m)
        return m.model:boundary { facing = { 1, 0, 0 }, within = 30, pressure = 2e3, add = true }.force[1]
    end },
    { "cycle with boundary", function(m) return m.model:cycle(2).ratio end, run = true },
    { "write_vtk", function(m)
        local function written() return text_of(TMP .. "/vtk_blocks.vtk.series") end
        m.model:write_vtk(TMP .. "/vtk") -- the last that needs memory
        return written
    end },
    { "write_section", function(m) m.model:write_section(TMP .. "/cut", { dip = 90, dip_direction = 0, origin = { 3, 3, 3 } }) end },
    { "write_html", function(m)
        local function written() return frames_of(TMP .. "/page.html") end
        m.model:write_html(TMP .. "/page", { block_fields = { "speed", id = function(block) return block.id end },
            contact_fields = { "gap" }, keyblocks = { friction = 30 } })
        return written
    end },
    { "write_html again", function(m)
        local function written() return frames_of(TMP .. "/page.html") end
        m.model:write_html(TMP .. "/page", { title = "page" })
        return written
    end },
    { "write_blocks", function(m) m.model:write_blocks(TMP .. "/blocks.json") end },
    { "last cycles", function(m) return m.model:cycle(3).ratio end, run = true },
    { "blocks", function(m)
        local copy = talus.model { threads = THREADS }
        copy:generate("blocks", { file = TMP .. "/blocks.json" })
        return copy:state_hash()
    end },
    { "copy", function(m) return m.model:copy():state_hash() end },
    { "save", function(m) m.model:save(TMP .. "/run.talus") end },
    { "zones", function()
        local rock = talus.model { threads = THREADS }
        rock:generate("zones", { file = MESH .. ".vtk", density = 2500 })
        return rock:blocks()[2].group
    end },
    { "deformable", function()
        local rock = talus.model { threads = THREADS }
        rock:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 0.5 }, density = 2500 }, { min = { 0, 0, 0.5 }, max = { 1, 1, 1 }, density = 2500 } })
        rock:solid("rock", "elastic", { young = 1e9, poisson = 0.25 })
        rock:blocks():join()
        rock:blocks():deformable { file = MESH .. ".msh", solid = "rock" }
        return rock:state_hash()
    end },
    { "restore", function() return talus.restore(TMP .. "/run.talus", { threads = THREADS }):state_hash() end },
    { "throw", function(m) m.model:blocks { group = "cap", hidden = "any" }:set { velocity = { 0, 0, 300 } } end },
    { "fast cycle", function(m) return m.model:cycle(2).ratio end, run = true },
    -- the first step there is, without question before it; and a step that is given, in which a block flies far
    { "another model", function()
        local other = talus.model { gravity = { 0, 0, -10 }, threads = THREADS }
        other:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
        other:generate("box", { min = { 0, 0, 50 }, max = { 1, 1, 51 }, density = 2000 })
        other:joint("*", "coulomb", COULOMB)
        other:timestep { dt = 1e-4 }
        other:blocks { id = 2 }:set { velocity = { 0, 0, 5000 } }
        other:cycle(2)
        return other:state_hash()
    end },
    -- a law that comes while blocks are coming near; and a block that is cut under load
    { "law on the way", function()
        local other = talus.model { gravity = { 0, 0, -10 }, threads = THREADS }
        other:generate("box", { min = { 0, 0, 0 }, max = { 3, 1, 1 }, density = 2000 })
        other:generate("box", { min = { 0, 0, 1.205 }, max = { 1, 1, 2 }, density = 2000 })
        other:generate("box", { min = { 2, 0, 1 }, max = { 3, 1, 2 }, density = 2000 })
        other:blocks { id = 1 }:fix()
        other:joint("*", "coulomb", COULOMB)
        other:timestep { dt = 1e-4 }
        other:blocks { id = 2 }:set { velocity = { 0, 0, -1000 } }
        other:blocks { id = 3 }:set { velocity = { 0, 0, -1 } }
        other:cycle(2)
        other:joint("*", "coulomb_tensile", { kn = 3e8, ks = 1e8, friction = 30, cohesion = 1e5 })
        return other:state_hash()
    end },
    { "cut under load", function()
        local other = talus.model { gravity = { 0, 0, -10 }, threads = THREADS }
        other:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
        other:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2000 })
        other:blocks { id = 1 }:fix()
        other:joint("*", "coulomb", COULOMB)
        other:cycle(20)
        other:generate("joint", { joint = "late", dip = 50, dip_direction = 20, origin = { 0.5, 0.5, 1.5 } })
        other:cycle(1)
        return other:state_hash()
    end },
    { "filter away", function(m)
        local filtered = m.model:filter { volume = 1, action = "delete" }
        assert(filtered.found > 0)
        return filtered.found
    end },
    { "state_hash", function(m) return m.model:state_hash() end },
    { "profile", function(m) return m.model:memory().blocks end },
}

local function digest(m)
    if not m.model then
        return "no model"
    end
    local groups = {}
    for i, name in ipairs { "rock", "cap", "tunnel", "stone" } do
        groups[i] = #m.model:blocks { group = name, hidden = "any" }
    end
    local e = m.model:energy()
    return table.concat({ m.model:state_hash(), #m.model:blocks { hidden = "any" }, #m.model:blocks(), m.model.time, m.model.cycles,
        string.format("%a %a %a %a", e.kinetic, e.stored, e.friction, e.external), table.concat(groups, ",") }, " ")
end

local function rebuilt(count)
    local m = {}
    for k = 1, count do
        calls[k][2](m)
    end
    return m
end

-- What a model that never ran out of memory is after each call, and in a run after each step, by the count of steps.
local expected, answers, steps = {}, {}, {}
do
    local m = {}
    for k, call in ipairs(calls) do
        local first = m.model and m.model.cycles
        answers[k] = call[2](m)
        answers[k] = type(answers[k]) == "function" and answers[k]() or answers[k]
        expected[k] = digest(m)
        if call.run then
            local slow = rebuilt(k - 1)
            for cycle = first + 1, m.model.cycles do
                slow.model:cycle(1)
                steps[cycle] = digest(slow)
            end
            assert(digest(slow) == expected[k], "steps one by one differ from a run")
        end
    end
end

local MOST_TOLD = 3
local bad, told = 0, 0
local function complain(format, ...)
    bad, told = bad + 1, told + 1
    if told <= MOST_TOLD then
        print(string.format(format, ...))
    end
end

local SENTENCE = { "out of memory", "not enough memory", "Cannot allocate memory" }
local function is_clean(message)
    if type(message) ~= "string" or message:find("\n", 1, true) then
        return false
    end
    for _, part in ipairs(SENTENCE) do
        if message:find(part, 1, true) then
            return true
        end
    end
    return false
end

-- Lets the n-th allocation of call k fail for each n. Returns the model after it.
local function try(k, m, for_good)
    local name, work = calls[k][1], calls[k][2]
    local before, n, failures, cycles = digest(m), 1, 0, m.model and m.model.cycles
    told = 0
    while true do
        collectgarbage()
        collectgarbage "stop"
        memory.fail(n, for_good)
        local good, answer = pcall(work, m)
        local asked = memory.stop()
        collectgarbage "restart"
        local where = string.format("%s, allocation %d%s", name, n, for_good and " and all after" or "")
        if good then
            answer = type(answer) == "function" and answer() or answer
            if answer ~= answers[k] then
                complain("%s: it answers %s, not %s", where, tostring(answer), tostring(answers[k]))
            end
            local after = digest(m)
            if after ~= expected[k] then
                complain("%s: made, but %s is not %s", where, after, expected[k])
            end
            if asked < n then
                return m, n - 1, failures
            end
            m = rebuilt(k - 1)
        else
            failures = failures + 1
            if not is_clean(answer) then
                complain("%s: '%s'", where, tostring(answer))
            end
            local after = digest(m)
            -- The steps that were made stand; so does one in which a drive's function failed.
            if calls[k].run and (after == steps[m.model.cycles] or calls[k].driven and m.model.cycles > cycles) then
                m = rebuilt(k - 1)
            elseif after ~= before then
                complain("%s: refused with '%s', but %s became %s", where, tostring(answer), before, after)
                m = rebuilt(k - 1)
            elseif calls[k].run then
                m = rebuilt(k - 1) -- the digest has found contacts, which the run has to find itself
            end
        end
        n = n + (n > LEAVE and EVERY or 1)
    end
end

for _, for_good in ipairs { false, true } do
    local m = {}
    for k, call in ipairs(calls) do
        if options.only == "" or options.only == call[1] then
            if options.only ~= "" then
                m = rebuilt(k - 1)
            end
            local t = os.clock()
            local _, count, failures
            m, count, failures = try(k, m, for_good)
            print(string.format("%-16s %6d allocations, %6d refused, %.2f s", call[1], count, failures, os.clock() - t))
        elseif options.only == "" then
            call[2](m)
        end
    end
end
assert(bad == 0, bad .. " complaints")
