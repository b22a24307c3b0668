-- The model's own fields: what is given, what is the default, what may be assigned.
local talus = require "talus"
local check = require "check"

check.holds(talus.version:match("^%d+%.%d+%.%d+$"), "a version of three numbers")

local plain = talus.model {}
check.near(plain.gravity, { 0, 0, -9.81 }, 0)
check.equal(plain.rotation, "exact")
check.equal(plain.reuse_geometry, true)
check.equal(plain.time, 0)
check.equal(plain.cycles, 0)
check.equal(math.type(plain.cycles), "integer")
check.equal(plain.seed, 1)
check.equal(#plain:blocks(), 0)
check.equal(tostring(plain), "model of 0 blocks")
check.equal(#talus.model():blocks(), 0)

local model = talus.model { gravity = { 1, 2, 3 }, seed = 7, threads = 2, rotation = "paper",
    reuse_geometry = false }
check.near(model.gravity, { 1, 2, 3 }, 0)
check.equal(model.seed, 7)
check.equal(model.threads, 2)
check.equal(model.rotation, "paper")
check.equal(model.reuse_geometry, false)

model.gravity = { 0, 0, -10 }
model.rotation = "exact"
model.reuse_geometry = true
check.near(model.gravity, { 0, 0, -10 }, 0)
check.equal(model.rotation, "exact")
check.equal(model.reuse_geometry, true)

-- A vector that was read is a copy.
model.gravity[3] = 5
check.near(model.gravity, { 0, 0, -10 }, 0)

check.raises(function() return talus.model { gravty = { 0, 0, 0 } } end,
    "talus.model: unknown parameter 'gravty'; did you mean 'gravity'?")
check.raises(function() return talus.model { threads = 0 } end, "threads = 0 is outside [1, 256]")
check.raises(function() return talus.model { threads = 1.5 } end, "threads must be a whole number")
check.raises(function() return talus.model { gravity = { 0, 0 } } end, "a list of 2 numbers")
check.raises(function() return talus.model { gravity = { 0, 0 / 0, 0 } } end, "gravity.y = nan")
check.raises(function() return talus.model(3) end, "must be a table, not the number 3")
check.raises(function() return talus.model({}, 4) end, "1 argument too many")

check.refused(model, function() model.gravity = { 0, 0, 1 / 0 } end, "gravity.z = inf")
check.refused(model, function() model.gravity = 9.81 end, "gravity must be a list of 3 numbers")
check.refused(model, function() model.gravity = nil end, "gravity")
check.refused(model, function() model.rotation = "papr" end, "did you mean 'paper'?")
check.refused(model, function() model.reuse_geometry = 1 end, "must be true or false")
check.refused(model, function() model.time = 3 end, "model.time can only be read")
check.refused(model, function() model.threads = 3 end, "chosen when the model is made")
check.refused(model, function() model.gravityy = {} end, "did you mean 'gravity'?")
check.refused(model, function() return model.blcks end, "a model has no field 'blcks'; did you mean 'blocks'?")
check.refused(model, function() return model[1] end, "no field the number 1")
check.refused(model, function() model.cycle(10) end, "write model:cycle(...)")

-- Models live as long as something of them is held, and many may come and go.
local block
do
    local short = talus.model {}
    short:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 1000 })
    block = short:blocks()[1]
end
for _ = 1, 20 do
    talus.model { threads = 2 }
end
collectgarbage()
collectgarbage()
check.near(block.volume, 1, 1e-15)
