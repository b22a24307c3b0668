-- Water that flows in joints: what it keeps, how it follows blocks, what is refused. Figures: tests/verify/water.lua.
local talus = require "talus"
local check = require "check"

local GW = 1e4 -- N/m3

-- Rock on a held floor: level joints at z = 0 and 2, and one across at x = 3 between them and above.
local function rock(turned, threads)
    local model = talus.model { threads = threads, gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, -2 }, max = { 8, 1, 4 }, density = 2500 })
    if turned then -- the same rock, cut in another order
        model:generate("joint", { joint = "V", dip = 90, dip_direction = 90, origin = { 3, 0, 0 } })
    end
    for _, z in ipairs(turned and { 2, 0 } or { 0, 2 }) do
        model:generate("joint", { joint = "H", dip = 0, dip_direction = 0, origin = { 0, 0, z } })
    end
    if not turned then
        model:generate("joint", { joint = "V", dip = 90, dip_direction = 90, origin = { 3, 0, 0 } })
    end
    model:blocks { where = function(b) return b.centroid[3] < 0 end }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 60 })
    model:damping "local"
    return model
end

local function edge(x, z)
    return { min = { x - 0.01, -1, z - 0.01 }, max = { x + 0.01, 2, z + 0.01 } }
end

local function given(more)
    local with = { aperture = 2e-4, unit_weight = GW, every = 10,
        heads = { { inside = edge(0, 0), head = 5 }, { inside = edge(8, 0), head = 1 } } }
    for k, v in pairs(more or {}) do
        with[k] = v
    end
    return with
end

local function wet(model, more)
    return model:water("flow", given(more))
end

-- What flows in flows out, at once and while apertures follow the load.
local model = rock()
local joints = wet(model)
local r = model:flow()
check.holds(#r.heads == 2 and #r.drains == 0 and #r.joints == #joints - 2 and r.closed == 0)
check.holds(r.heads[1].flow > 0)
check.near(r.heads[1].flow + r.heads[2].flow, 0, 1e-9 * r.heads[1].flow)
local first = r.heads[1].flow
model:cycle(500)
r = model:flow()
check.holds(r.heads[1].flow < 0.99 * first) -- it has been pressed together
check.near(r.heads[1].flow + r.heads[2].flow, 0, 1e-9 * r.heads[1].flow)

-- Joints cut at x = 3 meet there: as series without it the same flow, through joints of one aperture.
local held = rock()
held:blocks():fix()
wet(held)
check.near(held:flow().heads[1].flow, (2e-4) ^ 3 / (12 * 1e-3) * 4 * GW / 8, 1e-9 * first)

-- The order of cuts does not matter.
local other = rock(true)
other:blocks():fix()
wet(other)
check.near(other:flow().heads[1].flow, held:flow().heads[1].flow, 1e-9 * first)

-- Copies and files go on to the last bit; threads give the same bits.
local file = os.tmpname()
model:save(file)
local copy, restored = model:copy(), talus.restore(file)
os.remove(file)
check.holds(copy:state_hash() == model:state_hash() and restored:state_hash() == model:state_hash())
for _, one in ipairs { model, copy, restored } do
    one:cycle(137)
end
check.holds(copy:state_hash() == model:state_hash() and restored:state_hash() == model:state_hash())
check.near(copy:flow().heads[1].flow, model:flow().heads[1].flow, 0)
local threads = rock(false, 2)
wet(threads)
threads:cycle(637)
check.holds(threads:state_hash() == model:state_hash())

-- Steady flow is found in steps that `every` divides only.
local seldom = rock()
wet(seldom, { every = 100000 })
local before = seldom:flow().joints[1].aperture
seldom:cycle(1) -- step 0 is one
local after = seldom:flow().joints[1].aperture
seldom:cycle(300)
check.near(seldom:flow().joints[1].aperture, after, 0)
check.holds(before ~= nil)

-- A drain takes what the heads give.
local drained = rock()
drained:blocks():fix()
wet(drained, { drains = { { { 5.5, 0.5, -1 }, { 5.5, 0.5, 1 }, 0.05 } } })
r = drained:flow()
check.holds(r.drains[1].flow < 0)
check.near(r.heads[1].flow + r.heads[2].flow + r.drains[1].flow, 0, 1e-9 * r.heads[1].flow)

-- Linear pressure in one joint: force and moment of the walls are exact.
local plate = talus.model { gravity = { 0, 0, 0 } }
plate:generate("box", { min = { 0, 0, -1 }, max = { 8, 1, 0 }, density = 2500, group = "floor" })
plate:generate("box", { min = { 0, 0, 0 }, max = { 8, 1, 1 }, density = 2500 })
plate:blocks { group = "floor" }:fix()
plate:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 60 })
wet(plate, { heads = { { inside = edge(0, 0), head = 4 }, { inside = edge(8, 0), head = 0 } } })
local force, moment = 0, 0
plate:cycle(1)
for _, node in ipairs(plate:flow().joints[1].nodes) do
    if node.block.group ~= "floor" then
        force, moment = force + node.force[3], moment + node.force[3] * (node.rest[1] - 4)
    end
end
check.near(force, GW * 4 / 2 * 8, 1e-6)
check.near(moment, -GW * 4 * 8 ^ 2 / 12, 1e-6)
check.near(plate:flow().joints[1].head, 2, 1e-9)

-- Water of another source takes the place of flow, and the other way round.
local turns = rock()
local count = #wet(turns)
turns:water("uniform", { pressure = 1e4 })
check.holds(#turns:elements { kind = "water" } == count - 2)
check.holds(#turns:elements { kind = "flow" } == 0) -- heads go with their joints
turns:generate("joint", { joint = "W", dip = 90, dip_direction = 90, origin = { 6, 0, 0 } })
turns:cycle(1)
check.holds(#turns:elements { kind = "flow" } == 0) -- and do not come back
wet(turns)
wet(turns)
check.holds(#turns:elements { kind = "water" } == 0 and #turns:flow().heads == 2)
turns:water "none"
check.holds(#turns:elements() == 0)
check.holds(#turns:flow().joints == 0 and #turns:flow().heads == 0)

-- Blocks are cut while water flows: the network is found again.
local cut = rock()
cut:blocks():fix()
wet(cut, { drains = { { { 5.5, 0.5, -1 }, { 5.5, 0.5, 1 }, 0.05 } } })
cut:cycle(20)
local whole = cut:flow()
cut:generate("joint", { joint = "W", dip = 90, dip_direction = 90, origin = { 1.5, 0, 0 } })
cut:cycle(20)
r = cut:flow()
check.holds(#r.joints > count - 2)
check.near(r.heads[1].flow + r.heads[2].flow + r.drains[1].flow, 0, 1e-9 * r.heads[1].flow)
check.holds(whole.heads[1].flow > 0 and whole.drains[1].flow < 0)
for _, of in ipairs { "heads", "drains" } do -- they are where they were: about as much flows
    check.near(r[of][1].flow / whole[of][1].flow, 1, 0.2)
end

-- A drain that is as wide as the parts of a joint that is cut takes all that comes: the head there is that of the drain.
local wide = talus.model { gravity = { 0, 0, 0 } }
wide:generate("box", { min = { 0, 0, -1 }, max = { 8, 1, 0 }, density = 2500 })
wide:generate("box", { min = { 0, 0, 0 }, max = { 8, 1, 1 }, density = 2500 })
wide:blocks():fix()
wide:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 60 })
wet(wide, { heads = { { inside = edge(0, 0), head = 5 } }, joints = "*", drains = { { { 5.5, 0.5, -1 }, { 5.5, 0.5, 1 }, 0.5 } } })
for x = 1, 7 do
    wide:generate("joint", { joint = "W", dip = 90, dip_direction = 90, origin = { x, 0, 0 } })
end
wide:cycle(1)
local lowest = math.huge
for _, joint in ipairs(wide:flow().joints) do
    lowest = math.min(lowest, math.abs(joint.nodes[1].rest[3]) < 1e-9 and joint.head or math.huge)
end
check.near(lowest, 0, 0.02)
check.near(-wide:flow().drains[1].flow / wide:flow().heads[1].flow, 1, 1e-9)

-- So it is where blocks have slid, and joints are found again.
local slid = talus.model { gravity = { 0, 0, 0 } }
slid:generate("box", { min = { 0, 0, -1 }, max = { 8, 1, 0 }, density = 2500, group = "floor" })
slid:generate("box", { min = { 0, 0, 0 }, max = { 8, 1, 1 }, density = 2500, group = "top" })
slid:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 0 })
slid:blocks { group = "floor" }:fix()
slid:blocks { group = "top" }:drive { velocity = { 0, 0.1, 0 } }
wet(slid, { steady = false, every = 1, heads = { { inside = edge(0, 0), head = 4 }, { inside = edge(8, 0), head = 0 } } })
slid:timestep { dt = 1e-3 }
slid:cycle(500)
r = slid:flow()
local flows = (2e-4) ^ 3 / (12 * 1e-3) * 0.95 * GW * 4 / 8
check.near(r.heads[1].flow / flows, 1, 0.01)
check.near(r.heads[2].flow / flows, -1, 0.01)

-- What a step that fails has changed is undone.
local undone = rock()
wet(undone)
undone:cycle(30) -- the next step is one in which flow is found
local before_pressure = undone:flow().joints[1].head
undone:blocks { where = function(b) return b.centroid[3] > 0 and b.centroid[3] < 2 end }:set { velocity = { 0, 0, 1e-3 } }
undone:timestep { dt = 1 }
local was = undone:state_hash()
check.raises(function() undone:cycle(1) end, "cycle 31")
check.holds(undone:state_hash() == was)
check.near(undone:flow().joints[1].head, before_pressure, 0)

-- Stored water: what has flowed in is what the pressure has risen by.
local stored = talus.model { gravity = { 0, 0, 0 } }
stored:generate("box", { min = { 0, 0, -1 }, max = { 8, 1, 0 }, density = 2500 })
stored:generate("box", { min = { 0, 0, 0 }, max = { 8, 1, 1 }, density = 2500 })
stored:blocks():fix()
stored:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 60 })
wet(stored, { heads = { { inside = edge(0, 0), head = 4 } }, steady = false, every = 1, bulk = 1e6,
    initial_head = 1 })
check.near(stored:flow().joints[1].head, 1, 1e-9)
stored:timestep { dt = 1e-3 }
local sum = 0
stored:cycle(1) -- at time 0
for _ = 1, 49 do
    stored:cycle(1)
    sum = sum + stored:flow().heads[1].flow * 1e-3
end
local head = stored:flow().joints[1].head
check.holds(head > 1.01)
check.near((head - 1) * GW * 2e-4 * 8 / 1e6, sum, 1e-9 * sum)

-- Walls that move bear steps as much shorter as there are between two solutions.
local steps = {}
for _, every in ipairs { 0, 1, 4 } do
    local moving = rock()
    wet(moving, { steady = false, every = every })
    steps[#steps + 1] = moving.dt
end
check.holds(steps[1] == steps[2])
check.near(steps[3] / steps[1], 0.25, 0.01)

-- A head whose box the joint has left is closed, and nothing comes from it.
local left = talus.model { gravity = { 0, 0, 0 } }
left:generate("box", { min = { 0, 0, -1 }, max = { 8, 1, 0 }, density = 2500, group = "floor" })
left:generate("box", { min = { 0, 0, 0 }, max = { 8, 1, 1 }, density = 2500, group = "top" })
left:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 0 })
left:blocks { group = "floor" }:fix()
left:blocks { group = "top" }:drive { velocity = { 0.1, 0, 0 } }
wet(left)
r = left:flow()
check.holds(not r.heads[1].closed and not r.heads[2].closed and r.heads[1].flow > 0)
left:timestep { dt = 1e-3 }
left:cycle(500)
r = left:flow()
check.holds(r.heads[1].closed and not r.heads[2].closed and r.heads[1].flow == 0)

-- What is refused changes nothing.
local bad = rock()
local function refuse(with, sentence)
    check.refused(bad, function() bad:water("flow", given(with)) end, sentence)
end
wet(bad)
refuse({ aperture = 1e-5 }, "aperture = 1e-05 m must be above residual = 2e-05 m")
refuse({ maximum = 1e-4 }, "maximum = 0.0001 m must be at least aperture = 0.0002 m")
refuse({ aperture = { ["*"] = 2e-4, Q = 1e-4 } }, "'Q'")
refuse({ aperture = { H = 2e-4 } }, "needs \"*\"")
refuse({ aperture = { ["*"] = 2e-4, V = 1e-5 } }, "aperture of 'V' = 1e-05 m must be above")
check.refused(bad, function()
    bad:water("flow", given { aperture = function() return 0 end })
end, "aperture must give a number above residual")
check.refused(bad, function()
    bad:water("flow", given { aperture = function()
        bad:blocks():set { density = 1 }
        return 2e-4
    end })
end, "which may read the model only")
refuse({ joints = "Q" }, "'Q'")
refuse({ heads = {} }, "reaches neither a head nor a drain")
refuse({ heads = { { inside = edge(100, 0), head = 1 } } }, "head 1: no edge of a wet joint")
refuse({ heads = { { head = 1 } } }, "inside is missing")
refuse({ heads = { { inside = edge(0, 0) } } }, "head")
refuse({ heads = 3 }, "heads must be a list")
refuse({ drains = { { { 5, 5, -1 }, { 5, 5, 1 }, 0.05 } } }, "drain 1 passes no wet joint")
refuse({ drains = { { { 5, 0.5, -1 }, { 5, 0.5, 1 }, 3 } } }, "drain 1: its radius = 3 m must be below")
refuse({ drains = { { { 5, 0.5, -1 }, 0.05 } } }, "drain 1: give {from, to, radius}")
refuse({ drains = { { { 5, 0.5, -1 }, { 5, 0.5, 1 }, 0 } } }, "drain 1: its radius = 0 m must be above 0")
local single = talus.model {}
single:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
check.raises(function() single:water("flow", given()) end, "no joint of '*' has water")

-- A network that no head reaches is told, and keeps its pressure.
local apart = rock()
apart:generate("box", { min = { 20, 0, 0 }, max = { 21, 1, 1 }, density = 2500 })
apart:generate("box", { min = { 20, 0, 1 }, max = { 21, 1, 2 }, density = 2500 })
wet(apart)
check.holds(apart:flow().closed == 1)

-- Apertures by joint: the last that fits.
local by = rock()
by:blocks():fix()
wet(by, { aperture = { ["*"] = 2e-4, ["H:1"] = 4e-4 } })
local wide = 0
for _, joint in ipairs(by:flow().joints) do
    wide = wide + (math.abs(joint.aperture - 4e-4) < 1e-12 and 1 or 0)
end
check.holds(wide == 2) -- one level of the two, in two parts

-- Files for ParaView have pressures, apertures and flows.
local prefix = os.tmpname()
os.remove(prefix)
by:write_vtk(prefix)
local name = prefix .. "_elements_000000.vtk"
local vtk = assert(io.open(name, "rb"))
local text = vtk:read "a"
vtk:close()
for _, field in ipairs { "pressure", "aperture", "flow", "head" } do
    check.holds(text:find("\n" .. field .. " 1 %d+ float"), field)
end
for _, kind in ipairs { "elements", "blocks", "contacts", "joints" } do
    os.remove(prefix .. "_" .. kind .. "_000000.vtk")
    os.remove(prefix .. "_" .. kind .. ".vtk.series")
end
