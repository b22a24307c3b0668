-- Saving, restoring and copying: what comes next is the same to the bit, whatever was done before and is done after.
local talus = require "talus"
local check = require "check"

local TMP = os.getenv "TALUS_TEST_TMP" .. "/test_save" .. tostring({}):match "0x(%x+)"
local FILE = TMP .. "/run.talus"

local function swing(t) return { 0.05 * math.sin(40 * t), 0, 0 } end

-- A block of jointed rock on a base, with a law that has states, joined blocks, a load, initial stress and a wedge that slides.
local function rock(threads)
    local m = talus.model { gravity = { 0, 0, -10 }, seed = 7, threads = threads }
    m:generate("box", { min = { 0, 0, 0 }, max = { 4, 3, 3 }, density = 2500, group = "rock" })
    m:generate("jointset", { joint = "J1", dip = 50, dip_direction = 90, spacing = 0.9, number = 4, origin = { 2, 1, 1 } })
    m:generate("jointset", { joint = "J2", dip = 80, dip_direction = 0, spacing = 1.1, number = 3, origin = { 2, 1, 1 }, persistence = 0.8 })
    m:generate("box", { min = { -1, -1, -1 }, max = { 6, 4, 0 }, density = 2500, group = "base" })
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    m:joint("J1", "coulomb_tensile", { kn = 2e8, ks = 1e8, friction = 20, cohesion = 1e3, tension = 500, dilation = 3 })
    m:blocks { group = "base" }:fix()
    m:insitu { stress = { xx = -1e4, yy = -1e4, zz = -3e4 }, gradient = { zz = 1e4 } }
    m:damping("local", { alpha = 0.2 })
    return m
end

local function pile(threads)
    local m = talus.model { gravity = { 0, 0, -10 }, threads = threads }
    m:generate("box", { min = { -3, -3, -1 }, max = { 6, 6, 0 }, density = 2500, group = "floor" })
    m:blocks():fix()
    for i = 0, 3 do
        m:generate("polyhedron", { density = 2500, vertices = { { 0.1 * i, 0, i + 0.1 }, { 1, 0.1, i + 0.15 }, { 0.9, 1.1, i + 0.1 },
            { 0.1, 0.9, i + 0.2 }, { 0.4, 0.5, i + 0.9 }, { 0.8, 0.2, i + 0.8 } } })
    end
    m:joint("*", "coulomb", { kn = 1e8, ks = 5e7, friction = 35 })
    m:damping "kinetic"
    return m
end

local function energies(m)
    local e = m:energy()
    return string.format("%a %a %a %a %a %a", e.kinetic, e.potential, e.stored, e.friction, e.damping, e.external)
end

local function same(one, other)
    check.equal(other:state_hash(), one:state_hash())
    check.equal(energies(other), energies(one))
    check.equal(other.time, one.time)
    check.equal(#other:contacts(), #one:contacts())
end

-- ---------------------------------------------------------------- what comes next is the same

local works = {
    function(m) m:cycle(40) end,
    function(m) m:solve { ratio = 1e-3, max_cycles = 60 } end,
    function(m) m:blocks { group = "rock" }:where(function(b) return b.centroid[3] > 2 end):join() end,
    function(m) m:cycle(25) end,
    function(m) m:joint("J1", { friction = 10 }) end,
    function(m) m:mass_scaling(true) end,
    function(m) m:cycle(25) end,
    function(m) m:mass_scaling(false) m:damping "adaptive" end,
    function(m) m:blocks { id = m:blocks { group = "rock" }[1].id }:set { velocity = { 0, 0.1, 0 } } end,
    function(m) m:generate("joint", { joint = "J3", dip = 30, dip_direction = 10, origin = { 1, 1, 1 } }) end,
    function(m) m:cycle(25) end,
    function(m) m:contact_area { fraction = 0.01 } end,
    function(m) m.reuse_geometry = false m:cycle(12) end,
    function(m) m.rotation = "paper" m:cycle(12) end,
    function(m) m:blocks { group = "rock" }:where(function(b) return b.centroid[1] > 3.5 end):delete() end,
    function(m) m:cycle(30) end,
}
for _, build in ipairs { rock, pile } do
    local plain, kept, copied = build(1), build(1), build(2)
    for k, work in ipairs(works) do
        if build == rock or k < 3 then
            work(plain)
            work(kept)
            work(copied)
            kept:save(FILE)
            if k % 2 == 0 then -- what is saved is left as it was
                kept = talus.restore(FILE, { threads = 1 + k % 3 })
            end
            copied = copied:copy()
        end
    end
    for _ = 1, 3 do
        plain:cycle(20)
        kept:cycle(20)
        copied:cycle(20)
        same(plain, kept)
        same(plain, copied)
    end
end

-- A copy is a model of its own: what is done to one does not touch the other.
do
    local m = rock(1)
    m:cycle(10)
    local twin, hash = m:copy(), m:state_hash()
    twin:cycle(5)
    twin:blocks { group = "rock" }:delete()
    check.equal(m:state_hash(), hash)
    m = nil
    collectgarbage()
    check.equal(#twin:blocks(), 1)
    twin:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2000 })
    twin:cycle(5)
end

-- Any name that a model takes comes back; and copies in a loop are let go of.
do
    local m = talus.model {}
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 1, group = "a\nb\1\127" })
    m:generate("joint", { joint = "a\127", dip = 0, dip_direction = 0, origin = { 0.5, 0.5, 0.5 } })
    m:save(FILE)
    local r <close> = talus.restore(FILE)
    check.equal(r:blocks()[1].group, "a\nb\1\127")
    check.equal(#r:blocks { joint = "a\127" }, 2)
    local big, most, ended = rock(1), 0, 0
    local ballast = {}
    for k = 1, 500000 do
        ballast[k] = k
    end
    for k = 1, 400 do
        local copies = setmetatable({}, { __gc = function() ended = ended + 1 end })
        copies[1] = big:copy()
        most = math.max(most, k - ended)
    end
    check.holds(most < 300, "copies are collected while others are made")
end

-- Names, ids, groups, fields and what is only told come back.
do
    local m = rock(1)
    m:cycle(30)
    m:blocks { group = "rock" }:reset_displacement()
    m:cycle(5)
    m:blocks { id = m:blocks { group = "rock" }[2].id }:hide()
    m:save(FILE)
    local r = talus.restore(FILE)
    for i, block in ipairs(m:blocks { hidden = "any" }) do
        local twin = r:blocks { hidden = "any" }[i]
        for _, name in ipairs { "id", "group", "density", "volume", "mass", "hidden", "fixed", "speed" } do
            check.equal(twin[name], block[name])
        end
        check.near(twin.displacement, block.displacement, 0)
    end
    check.equal(#r:contacts { joint = "J1" }, #m:contacts { joint = "J1" })
    check.equal(talus.report(r).cuts, talus.report(m).cuts)
end

-- Frames of files go on with the next number, and those of before stay in the index.
do
    local m = pile(1)
    for _ = 1, 3 do
        m:write_vtk(TMP .. "/frames", { joints = false })
        m:cycle(2)
    end
    m:write_section(TMP .. "/cut", { dip = 90, dip_direction = 0, origin = { 0.5, 0.5, 0 } })
    m:save(FILE)
    local r = talus.restore(FILE)
    r:write_vtk(TMP .. "/frames")
    r:write_section(TMP .. "/cut", { dip = 90, dip_direction = 0, origin = { 0.5, 0.5, 0 } })
    for _, name in ipairs { "frames_blocks_000003.vtk", "frames_joints_000003.vtk", "cut_section_000001.vtk" } do
        check.holds(io.open(TMP .. "/" .. name), name)
    end
    check.equal(io.open(TMP .. "/frames_blocks_000004.vtk"), nil)
    local index = assert(io.open(TMP .. "/frames_blocks.vtk.series")):read "a"
    check.equal(select(2, index:gsub("frames_blocks_", "")), 4)
    check.equal(select(2, assert(io.open(TMP .. "/frames_joints.vtk.series")):read "a":gsub("frames_joints_", "")), 1)
end

-- An empty model, and one that never ran.
for _, fill in ipairs { function() end, function(m) m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 1 }) end } do
    local m = talus.model { gravity = { 0, 1, 0 }, seed = 3 }
    fill(m)
    m:save(FILE)
    local r = talus.restore(FILE)
    check.equal(r:state_hash(), m:state_hash())
    check.near(r.gravity, { 0, 1, 0 }, 0)
    check.equal(m:copy():state_hash(), m:state_hash())
end

-- ---------------------------------------------------------------- functions of drives

do
    local m = pile(1)
    local driven = m:blocks { fixed = false }[1]
    m:blocks { id = driven.id }:drive { velocity = swing, angular_velocity = function(t) return 0, t, 0 end }
    m:cycle(20)
    local twin = m:copy()
    m:save(FILE)
    check.raises(function() talus.restore(FILE) end, string.format("block %d is driven by a function for its velocity", driven.id))
    check.raises(function() talus.restore(FILE, { drives = { [driven.id] = swing } }) end, "has to be given again")
    check.raises(function() talus.restore(FILE, { drives = { [driven.id] = 3 } }) end, "must be a function(t), not the number 3")
    check.raises(function() talus.restore(FILE, { drives = { base = swing } }) end, "the number of no block")
    check.raises(function() talus.restore(FILE, { drive = {} }) end, "did you mean 'drives'")
    check.raises(function() talus.restore(FILE, { threads = 0 }) end, "threads = 0")
    check.raises(function() talus.restore(FILE, { drives = { [driven.id] = { velocty = swing } } }) end, "did you mean 'velocity'")
    check.raises(function() talus.resumed { drives = 7 } end, "drives must be a table")
    check.raises(function() talus.resumed(3) end, "talus.restore")
    check.equal(talus.resumed { threads = 2 }, nil)
    local turning = { velocity = swing, angular_velocity = function(t) return 0, t, 0 end }
    check.raises(function() talus.restore(FILE, { drives = { [driven.id] = turning, [99] = swing } }) end, "no function drove block 99")
    local r = talus.restore(FILE, { drives = { [driven.id] = { velocity = swing, angular_velocity = function(t) return 0, t, 0 end } } })
    m:cycle(30)
    r:cycle(30)
    m = m:copy()
    collectgarbage()
    twin:cycle(30)
    same(m, r)
    same(m, twin)
    r:blocks { id = driven.id }:free()
    r:cycle(1)
end

-- In a drive's function a step is half made; between two steps it is whole.
do
    local m = pile(1)
    local told
    m:blocks { fixed = false }:drive { velocity = function()
        told = told or { pcall(m.save, m, FILE), pcall(m.copy, m) }
        return 0, 0, 0
    end }
    m:cycle(1)
    check.equal(told[1], false)
    local n = pile(1)
    local hash, saved
    n:solve { ratio = 1e-12, max_cycles = 40, every = 20, on_progress = function(model)
        if not saved then
            model:save(FILE)
            saved = true
        end
    end }
    local r = talus.restore(FILE)
    hash = n:state_hash()
    r:cycle(n.cycles - r.cycles)
    check.equal(r:state_hash(), hash)
end

-- ---------------------------------------------------------------- bad files

local function bytes_of(path)
    local file <close> = assert(io.open(path, "rb"))
    return file:read "a"
end

local function restore_bytes(bytes)
    local file = assert(io.open(FILE, "wb"))
    file:write(bytes)
    file:close()
    return pcall(talus.restore, FILE)
end

do
    local m = pile(1)
    m:cycle(30)
    m:save(FILE)
    local whole = bytes_of(FILE)
    local function refused(bytes, part)
        local good, message = restore_bytes(bytes)
        check.equal(good, false)
        check.holds(message:find(part, 1, true) and not message:find("\n", 1, true), message .. ": '" .. part .. "'")
    end
    refused("", "it is no saved model")
    refused("{}", "it is no saved model")
    refused(whole:sub(1, -2), "damaged")
    refused(whole .. "x", "its end does not fit")
    refused(whole:sub(1, 8) .. string.pack("<I4", 999) .. whole:sub(13), "has format 999")
    local at = 12345
    for _ = 1, 300 do -- a bit that has tipped over is found wherever it is
        at = (at * 1103515245 + 12345) % 2 ^ 31 // 1 | 0
        local k = 17 + at % (#whole - 16)
        local bad = whole:sub(1, k - 1) .. string.char(whole:byte(k) ~ 1 << at // 65536 % 8) .. whole:sub(k + 1)
        refused(bad, "cannot restore")
        refused(whole:sub(1, k - 1), "cannot restore")
    end
    check.equal(restore_bytes(whole), true)
    check.raises(function() talus.restore(TMP .. "/none.talus") end, "No such file")
    check.raises(function() talus.restore(TMP) end, "cannot restore")
    check.raises(function() m:save(TMP) end, "cannot write")
    check.raises(function() m:save("") end, "the name of the file is empty")
    check.raises(function() m:save() end, "save")
    -- a failed save leaves what was there
    os.execute("chmod 555 " .. TMP)
    pcall(m.save, m, FILE)
    os.execute("chmod 755 " .. TMP)
    check.equal(bytes_of(FILE), whole)
end
-- ---------------------------------------------------------------- a model that cannot go on

-- Blocks that lie in each other are told of in the first step, by a copy and a restored model as well.
do
    local m = talus.model { gravity = { 0, 0, -10 } }
    m:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    m:generate("box", { min = { 0.01, 0.02, 0.05 }, max = { 1.01, 1.02, 1.05 }, density = 2500 })
    m:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    check.equal(#m:contacts(), 1)
    m:save(FILE)
    local copy, restored = m:copy(), talus.restore(FILE)
    for _, one in ipairs { m, copy, restored } do
        check.raises(function() one:cycle(3) end, "cycle 1, contact of blocks 1 and 2")
        check.equal(one.cycles, 0)
    end
end
os.execute("rm -r " .. TMP)
