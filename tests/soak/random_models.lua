-- random_models.lua FIRST SECONDS: makes random models and runs them, for a build with sanitizers, until the time is up.
--
-- Model number k is made from the seed FIRST + k: blocks, cuts, tunnels, joins, laws, dampings, loads, drives and runs in
-- any order, some of them with wild numbers. Every call gives a result or one clear sentence. The same model is made on
-- one thread and on two or three, and with its model taken out of a copy or a file again and again: results, sentences and state
-- hashes are equal, and to ask for contacts changes none. What a call must not do is told by the sanitizers; the seed printed last is the one that failed. "random_models.lua SEED" runs one and prints what it does.
local talus = require "talus"

local first, seconds = math.tointeger(tonumber(arg[1] or "1")), tonumber(arg[2])
local verbose = not seconds
local stem = string.format("%s/soak_%s", os.getenv("TALUS_TEST_TMP") or "/tmp", tostring({}):match("0x(%x+)") or "0")

local wild = { 0, -1, 1e-320, 1e-300, 1e-30, 1e-9, 1e9, 1e30, 1e154, 1e160, 1e300, 1.7e308, -1e305, 0 / 0, 1 / 0, -1 / 0 }

-- ---------------------------------------------------------------- one model

local Maker = {}
Maker.__index = Maker

-- Lua's generator is one for all, so each model has its own: the same numbers on any number of threads.
function Maker:random(low, high)
    self.state = (self.state * 6364136223846793005 + 1442695040888963407)
    local x = (self.state >> 11) * 0x1p-53
    if not low then
        return x
    end
    return low + math.floor(x * (high - low + 1))
end

-- A number between two, or now and then a wild one.
function Maker:number(low, high)
    if self:random() < self.wildness then
        return wild[self:random(1, #wild)]
    end
    return low + self:random() * (high - low)
end

function Maker:vector(low, high)
    return { self:number(low, high), self:number(low, high), self:number(low, high) }
end

function Maker:pick(list)
    return list[self:random(1, #list)]
end

-- A result, or one clear sentence with its place.
function Maker:try(what, f, ...)
    local answer = table.pack(pcall(f, ...))
    local text = what .. (answer[1] and "" or ": " .. tostring(answer[2]))
    self.log[#self.log + 1] = text
    if verbose then
        print(text)
    end
    if not answer[1] then
        local message = answer[2]
        assert(type(message) == "string" and message:find("^[^\n]+:%d+: [^\n]+$") and
            not message:find("attempt to", 1, true) and not message:find("assertion", 1, true),
            "no clear sentence: " .. tostring(message))
    end
    return table.unpack(answer, 1, answer.n)
end

function Maker:some_blocks()
    local filter = self:pick { {}, { group = "rock" }, { group = "drift" }, { fixed = false }, { hidden = "any" },
        { below = { dip = 10, dip_direction = 40, origin = { 1, 1, 1 } } } }
    return self.model:blocks(filter)
end

local acts = {}

function acts.block(self)
    local low, m = self:vector(0, 2.5), self.model
    low[3] = low[3] + (self:random() < 0.9 and 2.2 or 0) -- above the rock, now and then in it
    local kind = self:pick { "box", "polyhedron", "tetrahedron", "prism" }
    if kind == "box" then
        local high = {}
        for k = 1, 3 do
            high[k] = low[k] + self:number(0.5, 3)
        end
        self:try("box", m.generate, m, "box", { min = low, max = high, density = self:number(1000, 3000), group = "rock" })
    elseif kind == "prism" then
        self:try("prism", m.generate, m, "prism", { density = self:number(1000, 3000), axis = self:vector(0.5, 2),
            base = { low, { low[1] + 1, low[2], low[3] }, { low[1] + 1, low[2] + 1, low[3] } } })
    else
        local vertices = {}
        for k = 1, kind == "tetrahedron" and 4 or self:random(4, 12) do
            local p = self:vector(0, 1.5)
            vertices[k] = { low[1] + p[1], low[2] + p[2], low[3] + p[3] }
        end
        self:try(kind, m.generate, m, kind, { vertices = vertices, density = self:number(1000, 3000), group = "rock" })
    end
end

function acts.cut(self)
    if #self.model:blocks() > 60 then
        return
    end
    local name = "J" .. self:random(1, 4)
    self:try("cut " .. name, self.model.generate, self.model, "jointset", { joint = name, dip = self:number(0, 90),
        dip_direction = self:number(0, 360), dip_dev = self:number(0, 10), spacing = self:number(0.5, 1.5),
        number = self:random(1, 3), origin = self:vector(0, 2), persistence = self:number(0.5, 1) })
end

function acts.tunnel(self)
    if #self.model:blocks() > 60 then
        return
    end
    local y, z, w, h = self:number(0, 2), self:number(0, 2), self:number(0.3, 1), self:number(0.3, 1)
    local face1, face2 = {}, {}
    for k, at in ipairs { { 0, 0 }, { 0, 1 }, { 1, 1 }, { 1, 0 } } do
        face1[k] = { -2, y + w * at[1], z + h * at[2] }
        face2[k] = { 6, y + w * at[1], z + h * at[2] }
    end
    self:try("tunnel", self.model.generate, self.model, "tunnel", { face1 = face1, face2 = face2, group = "drift" })
end

function acts.law(self)
    local p = { kn = self:number(1e7, 1e10), ks = self:number(1e7, 1e10) }
    local law = self:pick { "coulomb", "coulomb_tensile", "elastic" }
    if law ~= "elastic" then
        p.friction, p.cohesion = self:number(0, 60), self:number(0, 1e5)
        p.dilation = self:number(0, 5)
    end
    if law == "coulomb_tensile" then
        p.tension = self:number(0, 1e5)
    end
    local joint = self:pick { "*", "*", "J1", "J2:1" }
    self:try("law " .. law .. " of " .. joint, self.model.joint, self.model, joint, law, p)
end

function acts.settings(self)
    local m = self.model
    local what = self:random(1, 8)
    if what == 1 then
        self:try("timestep", m.timestep, m, { fraction = self:number(0.05, 1), rule = self:pick { "paper", "body" } })
    elseif what == 2 then
        self:try("dt", m.timestep, m, { dt = self:number(1e-6, 1e-3) })
    elseif what == 3 then
        self:try("gravity", function() m.gravity = self:vector(-20, 20) end)
    elseif what == 4 then
        self:try("mass scaling", m.mass_scaling, m, self:random() < 0.5)
    elseif what == 5 then
        self:try("area", m.contact_area, m, { fraction = self:number(0, 0.1) })
    elseif what == 6 then
        self:try("rotation", function() m.rotation = self:pick { "exact", "paper" } end)
    elseif what == 7 then
        self:try("reuse", function() m.reuse_geometry = self:random() < 0.5 end)
    else
        self:try("insitu", m.insitu, m, { stress = { xx = -self:number(0, 1e5), zz = -self:number(0, 1e5) },
            gradient = { zz = self:number(0, 2e4) } })
    end
end

function acts.damping(self)
    local m, kind = self.model, self:pick { "local", "viscous", "adaptive", "combined", "kinetic", "none" }
    local p = nil
    if kind == "local" or kind == "combined" then
        p = { alpha = self:number(0, 0.9) }
    elseif kind == "viscous" then
        p = { alpha = self:number(0, 10) }
    end
    self:try("damping " .. kind, m.damping, m, kind, p)
end

function acts.bodies(self)
    local some = self:some_blocks()
    local what = self:pick { "fix", "free", "join", "unjoin", "hide", "show", "delete", "reset_displacement" }
    if what == "delete" and self:random() < 0.5 then
        some = self.model:blocks { group = "drift" }
    end
    local options = what == "fix" and self:random() < 0.3 and { x = true, rotation = true } or nil
    self:try(what, some[what], some, options)
end

function acts.motion(self)
    local some, what = self:some_blocks(), self:random(1, 5)
    if what == 1 then
        self:try("set", some.set, some, { velocity = self:vector(-3, 3), angular_velocity = self:vector(-3, 3) })
    elseif what == 2 then
        self:try("drive", some.drive, some, { velocity = self:vector(-1, 1), angular_velocity = self:vector(-1, 1) })
    elseif what == 3 then
        local v = self:vector(-1, 1)
        local function velocity(t) return { v[1] * t, v[2], v[3] } end
        self:try("drive by a function", some.drive, some, { velocity = velocity })
        for _, block in ipairs(some) do
            self.drives[block.id] = velocity
        end
    elseif what == 4 then
        self:try("load", some.load, some, { force = self:vector(-1e5, 1e5), moment = self:vector(-1e4, 1e4) })
    else
        self:try("density", some.set, some, { density = self:number(1000, 3000) })
    end
end

function acts.run(self)
    local m = self.model
    if self:random() < 0.7 then
        self:try("cycle", m.cycle, m, self:random(1, 25))
    else
        self:try("solve", m.solve, m, { ratio = self:number(1e-5, 1e-2), max_cycles = self:random(1, 40) })
    end
end

function acts.ask(self)
    local m = self.model
    self:try("contacts", function()
        local contacts = m:contacts()
        return #contacts > 0 and contacts:sum("normal_force") + contacts:min("gap")
    end)
    self:try("energy", m.energy, m)
    self:try("keyblocks", m.keyblocks, m, { friction = self:number(0, 60) })
    self:try("filter", m.filter, m, { aspect = 50, action = self:pick { "report", "join", "delete" } })
    self:try("neighbours", function()
        for _, block in ipairs(m:blocks()) do
            assert(block.neighbours and block.vertices and block.faces and block.kinetic_energy)
        end
    end)
end

-- What functions sample, by name: given again to what is restored.
local sampled = {
    steps = function(m) return m.cycles, m.time end,
    blocks = function(m) return #m:blocks() end,
}

function acts.watch(self)
    local m, every = self.model, self:random(1, 9)
    local name = self:pick { "steps", "blocks", "kinetic", "slipping", "ratio" }
    if self:random() < 0.4 then
        local items = self:random() < 0.5 and self:some_blocks() or m:contacts()
        local one = self:random() < 0.3 and items[1]
        local field = self:pick { "displacement", "velocity", "volume", "normal_force", "area", "id" }
        self:try("history of " .. field, m.history, m, { name = field, every = every, of = one or items, field = field,
            take = self:pick { "mean", "sum", "min", "max" } })
    else
        self:try("history " .. name, m.history, m, { name = name, every = every, value = sampled[name] or name })
    end
    if self:random() < 0.1 then
        self:try("history ended", m.history, m, { name = name, remove = true })
    end
    local names, all = {}, m:histories()
    for known, h in pairs(all) do
        local last = h.value[#h.value]
        names[#names + 1] = string.format("%s %d at %d: %s", known, #h.value, h.cycle[#h.cycle],
            type(last) == "table" and table.concat(last, ",") or last)
    end
    table.sort(names)
    self.log[#self.log + 1] = table.concat(names, "; ")
end

function acts.write(self)
    local m = self.model
    self:try("write_vtk", m.write_vtk, m, stem)
    self:try("write_section", m.write_section, m, stem, { dip = self:number(0, 90), dip_direction = self:number(0, 360),
        origin = self:vector(0, 2) })
    self:try("write_blocks", m.write_blocks, m, stem .. ".json")
end

local order = { "block", "cut", "cut", "tunnel", "law", "settings", "damping", "bodies", "motion", "run", "run", "run",
    "ask", "watch", "write" }

-- Goes on with a copy of the model, or with what comes out of a file. What cannot be saved or restored, for its contacts cannot be
-- found or a drive's function is not at hand, is copied.
function Maker:take_again(k)
    local path, m = stem .. ".talus", self.model
    if k % 3 == 0 or not pcall(m.save, m, path) then
        self.model = m:copy()
        return
    end
    -- asked of copies, for to ask is to find contacts that the other model finds after its next edit only
    local hash = { pcall(function() return m:copy():state_hash() end) }
    local drives, good, restored, asked = {}
    local histories = {}
    for name, f in pairs(sampled) do
        histories[name] = m:histories()[name] and f
    end
    repeat -- functions are given when they are asked for: who drives what after cuts and joins is the model's to tell
        good, restored = pcall(talus.restore, path, { threads = 1 + k % 3, drives = drives, histories = histories })
        asked = not good and tonumber(restored:match "block (%d+).* is driven by a function")
        if asked and (drives[asked] or not self.drives[asked]) then
            self.model = m:copy()
            return
        elseif asked then
            drives[asked] = self.drives[asked]
        end
    until not asked
    assert(good, restored)
    assert(not hash[1] or hash[2] == restored:copy():state_hash(), "what was restored is another model")
    self.model = restored
end

local function remove_files()
    for _, part in ipairs { "blocks", "contacts", "joints", "section" } do
        os.remove(stem .. "_" .. part .. ".vtk.series")
        for frame = 0, 99 do
            if not os.remove(string.format("%s_%s_%06d.vtk", stem, part, frame)) then
                break
            end
        end
    end
    os.remove(stem .. ".json")
    os.remove(stem .. ".talus")
end

-- To ask changes nothing. (A hash that cannot be told, for want of a law or of room between blocks, says so.)
function Maker:ask_between(name)
    local m = self.model
    local before = { pcall(m.state_hash, m) }
    pcall(m.contacts, m)
    local after = { pcall(m.state_hash, m) }
    assert(before[1] == after[1] and (not before[1] or before[2] == after[2]), "to ask after '" .. name .. "' has changed the hash")
end

-- What happened, and the state at the end. `how`: "again", out of copies and files; "asks", looked at after every call.
local function make(seed, threads, how)
    local self = setmetatable({ state = seed * 7919 + 12345, log = {}, drives = {} }, Maker)
    for _ = 1, 5 do
        self:random()
    end
    self.wildness = self:pick { 0, 0, 0.005, 0.03 }
    self.model = talus.model { gravity = { 0, 0, -10 }, seed = seed % 1000, threads = threads }
    local m = self.model
    self:try("ground", m.generate, m, "box", { min = { -2, -2, -1 }, max = { 5, 5, 0 }, density = 2500, group = "ground" })
    m:blocks():fix()
    self:try("rock", m.generate, m, "box", { min = { 0, 0, 0 }, max = { 3, 2 + self:random(), 2 }, density = 2500, group = "rock" })
    self:try("law", m.joint, m, "*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    for k = 1, self:random(5, 25) do
        local name = self:pick(order)
        acts[name](self)
        if how == "again" then
            self:take_again(seed + k)
        elseif how == "asks" then
            self:ask_between(name)
        end
    end
    self:try("hash", function() self.log[#self.log + 1] = self.model:state_hash() end)
    return self.log
end

local function compare(seed, what, one, other)
    for k = 1, math.max(#one, #other) do
        -- the script's line in a sentence is the same, for the same script made it
        if one[k] ~= other[k] then
            error(string.format("seed %d, step %d: on one thread: %s; %s: %s", seed, k, one[k], what, other[k]), 0)
        end
    end
end

local function run(seed)
    local one = make(seed, 1)
    compare(seed, "on more", one, make(seed, 2 + seed % 2))
    compare(seed, "out of copies and files", one, make(seed, 1, "again"))
    make(seed, 1, "asks")
    remove_files()
end

if verbose then
    run(first)
    return
end
local began, count = os.time(), 0
repeat
    io.write("seed ", first + count, "\n")
    io.flush()
    run(first + count)
    count = count + 1
until os.time() - began >= seconds
print(count .. " models")
