-- Quality of the blocks: the report, and the filter of slivers.
local talus = require "talus"
local check = require "check"

-- The page goes to standard output; the table is what is checked.
local function cut_box()
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 4, 3, 2 }, density = 2000 })
    model:generate("joint", { joint = "A", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
    return model
end

local model = cut_box()
local report = talus.report(model)
check.equal(report.blocks, 2)
check.equal(report.bodies, 2)
check.near(report.volume, 24, 1e-12)
check.near(report.volume_error, 0, 1e-15)
check.near(report.smallest_volume, 6, 1e-12)
check.near(report.smallest_volume_block.volume, 6, 1e-12)
check.near(report.smallest_edge, 1, 1e-12)
check.near(report.smallest_face, 2, 1e-12)
check.equal(report.smallest_edge_block.id, report.smallest_volume_block.id)
check.near(report.worst_aspect, math.sqrt(1 + 9 + 4), 1e-12) -- 1 thick
check.equal(report.cuts, 1)
check.equal(report.refused, 0)
check.equal(#report.refused_cuts, 0)
check.equal(report.coincident, 0)
check.holds(report.timestep_message:find("law"), "no law yet, so no time step")
check.equal(report.dt, nil)

-- A cut that would leave a sliver, a cut on an existing face; both are told of, nothing is cut.
model:generate("joint", { joint = "B", dip = 90, dip_direction = 90, origin = { 3.99999, 0, 0 } })
model:generate("joint", { joint = "C", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
report = talus.report(model)
check.equal(report.blocks, 2)
check.equal(report.refused, 1)
check.equal(report.coincident, 1)
local cut = report.refused_cuts[1]
check.equal(cut.joint, "B:1")
check.near(model:blocks { id = cut.block }[1].volume, 18, 1e-12)
check.near(cut.thickness, 1e-5, 1e-12)
check.near(cut.limit, 1e-5 * math.sqrt(9 + 9 + 4), 1e-12)
check.near(cut.normal, { 1, 0, 0 }, 1e-15)
check.near(cut.point, { 3.99999, 0, 0 }, 1e-12)
check.holds(cut.reason:find("B:1", 1, true), "the reason names the joint")

-- What is deleted is accounted for; the time step is told once there are laws.
model:blocks { containing = { 0.5, 1, 1 } }:delete()
model:joint("*", "coulomb", { kn = 1e7, ks = 1e7, friction = 30 })
report = talus.report(model)
check.equal(report.blocks, 1)
check.near(report.volume, 18, 1e-12)
check.near(report.volume_error, 0, 1e-15)
check.holds(report.dt > 0, "a time step")
check.holds(report.timestep_message:find "step", "the sentence")
check.raises(function() talus.report() end, "talus.report: give the model, not nil")

-- An empty model has a report too.
report = talus.report(talus.model())
check.equal(report.blocks, 0)
check.equal(report.volume_error, 0)
check.equal(report.smallest_volume_block, nil)

-- ---------------------------------------------------------------- slivers

-- Three dispersed sets in a box.
local function rock(offset)
    offset = offset or 0
    local one = talus.model { gravity = { 0, 0, -10 }, seed = 7 }
    one:generate("box", { min = { offset, 0, 0 }, max = { offset + 10, 10, 10 }, density = 2500 })
    for i, set in ipairs { { 70, 80 }, { 60, 200 }, { 15, 330 } } do
        one:generate("jointset", { joint = "J" .. i, dip = set[1], dip_dev = 8,
            dip_direction = set[2], dip_direction_dev = 8, spacing = 1.8, spacing_dev = 0.6,
            number = 9, origin = { offset + 5, 5, 5 } })
    end
    return one
end

local LIMITS = { volume = 0.05, aspect = 20 }
local function filter(one, action)
    return one:filter { volume = LIMITS.volume, aspect = LIMITS.aspect, action = action }
end

model = rock()
local blocks, before = #model:blocks(), model:state_hash()
local found = filter(model)
check.holds(found.found > 20 and found.found < blocks / 2, "there are slivers: " .. found.found)
check.equal(found.deleted, 0)
check.equal(found.joined, 0)
check.equal(model:state_hash(), before)
check.equal(#found.slivers, found.found)
local volume, last = 0, 0
for _, sliver in ipairs(found.slivers) do
    check.holds(sliver.block > last, "in the order of ids")
    last = sliver.block
    check.holds(sliver.volume < LIMITS.volume or sliver.aspect > LIMITS.aspect, "beyond a limit")
    check.equal(sliver.beyond[1], sliver.volume < LIMITS.volume and "volume" or "aspect")
    check.near(sliver.volume, model:blocks { id = sliver.block }[1].volume, 0)
    check.equal(sliver.joined_to, nil)
    volume = volume + sliver.volume
end
check.near(found.volume, volume, 1e-12)
local marked = {}
for _, sliver in ipairs(found.slivers) do
    marked[sliver.block] = true
end
for _, block in ipairs(model:blocks()) do
    check.holds(marked[block.id] or block.volume >= LIMITS.volume, "no sliver is missed")
end

-- Deleting: the volume that is gone is that of the slivers, and the report knows.
local gone = filter(model, "delete")
check.equal(gone.deleted, found.found)
check.equal(#model:blocks(), blocks - found.found)
report = talus.report(model)
check.near(report.volume, 1000 - volume, 1e-9)
check.holds(report.volume_error < 1e-12, "volume is accounted for")
check.holds(report.smallest_volume >= LIMITS.volume, "no small block is left")
check.holds(report.worst_aspect <= LIMITS.aspect, "no thin block is left")
check.equal(filter(model).found, 0)

-- Joining: all blocks stay, exactly as they were; each sliver moves with its neighbour.
model = rock()
local joined = filter(model, "join")
check.equal(joined.found, found.found)
check.equal(#model:blocks(), blocks)
check.near(model:blocks():sum "volume", 1000, 1e-9)
local done = 0
for _, sliver in ipairs(joined.slivers) do
    if sliver.joined_to then
        done = done + 1
        check.equal(model:blocks { id = sliver.block }[1].body, sliver.joined_to.body)
    end
end
check.equal(done, joined.joined)
check.equal(done, found.found)
report = talus.report(model)
check.holds(report.bodies < blocks and report.bodies >= blocks - done, "fewer bodies")
check.holds(filter(model).found < found.found / 5, "what is joined to a sound block is dealt with")

-- The neighbour with the largest shared face is taken; a body held otherwise is not.
local function stack()
    local one = talus.model()
    one:generate("box", { min = { 0, 0, 0 }, max = { 2, 2, 2 }, density = 2000 })
    one:generate("joint", { joint = "A", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
    one:generate("joint", { joint = "B", dip = 0, dip_direction = 0, origin = { 0, 0, 1.01 } })
    one:blocks { above = { dip = 0, dip_direction = 0, origin = { 0, 0, 1.02 } } }:hide()
    one:generate("joint", { joint = "C", dip = 90, dip_direction = 90, origin = { 1.5, 0, 0 } })
    one:blocks { hidden = "any" }:show()
    return one
end
model = stack()
check.equal(#model:blocks(), 5)
local small = model:blocks { containing = { 0.5, 1, 1.005 } }[1]
local result = model:filter { aspect = 50, action = "join" }
check.equal(result.found, 2)
for _, sliver in ipairs(result.slivers) do
    check.holds(sliver.joined_to.volume > 0.9, "joined to a sound block")
end
model = stack()
model:blocks { containing = { 0.5, 1, 1.5 } }:fix()
result = model:filter { aspect = 50, action = "join" }
check.equal(result.joined, 2)
for _, sliver in ipairs(result.slivers) do
    check.holds(sliver.joined_to.centroid[3] < 1, "not to the one that is held")
end
check.equal(small.fixed, false)

-- Hidden blocks are left alone; the same bits each time and far from zero the same slivers.
model = stack()
model:blocks():hide()
check.equal(model:filter { aspect = 50, action = "delete" }.found, 0)
local a, b = rock(), rock()
filter(a, "join")
filter(b, "join")
check.equal(a:state_hash(), b:state_hash())
check.equal(filter(rock(1048576)).found, found.found)

-- Mistakes leave the model as it was.
model = stack()
check.refused(model, function() model:filter {} end, "give a limit")
check.refused(model, function() model:filter { volume = -1 } end, "volume")
check.refused(model, function() model:filter { volume = 1, action = "merge" } end, "action")
check.refused(model, function() model:filter { aspect = 0.5 } end, "aspect")
check.refused(model, function() model:filter { volum = 1 } end, "volume")

-- Hidden blocks are left alone: a sliver is not joined to one.
local thin = talus.model()
thin:generate("box", { { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 }, { min = { 0, 0, 1 }, max = { 1, 1, 1.01 }, density = 2500 } })
thin:blocks { id = 1 }:hide()
check.equal(thin:filter { aspect = 20, action = "join" }.joined, 0)
thin:blocks { hidden = true }:show()
check.equal(thin:filter { aspect = 20, action = "join" }.joined, 1)
