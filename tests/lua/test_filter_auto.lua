-- A filter that chooses its limits by itself makes the time step as much longer as it says, and takes little of the rock; a generator and the
-- report tell what slivers there are.
local check = require "check"
local slivers = require "slivers"
local talus = require "talus"

local LITTLE = 0.05 -- share of the rock that a filter may take by itself

-- ---------------------------------------------------------------- gains that are told, with laws

local some = 0
for seed = 1, check.cases(30) do
    local model = slivers.rock(seed)
    if seed % 2 == 0 then -- what is hidden is left alone, also where it decides the step
        model:blocks { where = function(b) return b.id % 5 == 0 end }:hide()
    end
    local before, hash, whole = model.dt, model:state_hash(), model:blocks():sum "volume"
    local told = model:filter { auto = true, action = "report" }
    check.equal(model:state_hash(), hash)
    check.equal(model.dt, before)
    check.holds(told.joined == 0 and told.volume <= LITTLE * whole, ("model %d: a report of %g m3 of %g"):format(seed, told.volume, whole))
    local done = model:filter { auto = true }
    check.equal(done.found, told.found)
    check.holds(told.found == 0 and told.gain == 1 or told.gain >= 2, ("model %d: %d slivers, a gain of %g"):format(seed, told.found, told.gain))
    check.near(model.dt / before, done.gain, 1e-9)
    if done.joined == done.found then
        check.holds(done.gain > 0.75 * told.gain, ("model %d: told %g, gained %g"):format(seed, told.gain, done.gain))
    end
    check.near(model:blocks():sum "volume" / whole, 1, 1e-12)
    some = some + (done.found > 0 and 1 or 0)
end
check.holds(some > 0, "some model has slivers")

-- ---------------------------------------------------------------- before there is a law

local function cube(size, thickness)
    local model = talus.model {}
    check.equal(model:generate("box", { min = { 0, 0, 0 }, max = { size, size, size }, density = 2500 }).slivers, 0)
    local cut = model:generate("joint", { joint = "J", dip = 0, dip_direction = 0, origin = { 0, 0, thickness } })
    return model, cut
end

-- In any unit of length. The rate is area over volume: that of the slab is 2 (1 + 2 t) / t, that of the rest 2 (1 + 2 r) / r.
for _, size in ipairs { 1e-3, 1, 1e3 } do
    local t = 1e-3
    local model, cut = cube(size, t * size)
    check.equal(cut.slivers, 1)
    local report = talus.report(model)
    local gain = math.sqrt((1 + 2 * t) / t * (1 - t) / (1 + 2 * (1 - t)))
    check.equal(report.slivers, 1)
    check.near(report.sliver_share, t, 1e-9)
    check.near(report.sliver_gain, gain, 1e-9)
    local done = model:filter { auto = true }
    check.equal(done.joined, 1)
    check.near(done.gain, gain, 1e-9)
    check.equal(model:filter({ auto = true }).found, 0)
end

-- What is no sliver is none by a filter either.
local halves, cut = cube(1, 0.5)
check.equal(cut.slivers, 0)
local none = halves:filter { auto = true }
check.equal(none.found, 0)
check.equal(none.gain, 1)
check.equal(talus.report(halves).slivers, 0)

-- What a call makes is counted, also beside blocks that have been deleted before.
local beside = talus.model {}
for k = 1, 3 do
    beside:generate("box", { min = { 2 * k, 0, 0 }, max = { 2 * k + 1, 1, 1 }, density = 2500 })
end
beside:blocks { id = 1 }:delete()
check.equal(beside:generate("box", { min = { 0, 0, 3 }, max = { 1, 1, 3.001 }, density = 2500 }).slivers, 1)
check.equal(beside:generate("box", { min = { 0, 0, 5 }, max = { 1, 1, 6 }, density = 2500 }).slivers, 0)

-- ---------------------------------------------------------------- what is done, and what is refused

local model = cube(1, 1e-3)
check.equal(model:filter({ auto = true, action = "delete" }).deleted, 1)
check.equal(#model:blocks(), 1)

model = cube(1, 1e-3)
check.refused(model, function() model:filter { auto = true, volume = 1 } end, "not both")
check.refused(model, function() model:filter {} end, "auto = true")
check.refused(model, function() model:filter { auto = 1 } end, "true or false")
check.equal(model:filter({ volume = 1e-2 }).gain, nil)
