-- slivers.lua - rock cut at random, in which a few slivers make the time step short; and what the filter gains that the remark on them
-- proposes.
--
--     slivers.gains(models)    a list of { seed, gain, told, off }: by how much longer the step is, by how much longer the remark says that it
--                              can be, and how far its share of the rock is from what was joined, relative
local shapes = require "shapes"
local talus = require "talus"

local slivers = {}

-- A box cut by three sets of which some planes lie close together; its foot is held.
function slivers.rock(seed)
    local random = shapes.random(seed)
    local size = 10 ^ random(-1, 2)
    local model = talus.model { gravity = { 0, 0, -10 }, seed = seed }
    model:generate("box", { min = { 0, 0, 0 }, max = { 4 * size, 4 * size, 4 * size }, density = 2500 })
    for k = 1, 3 do
        local dip, way = random(0, 90), random(0, 360)
        for _ = 1, 2 + seed % 2 do
            local origin = { random(0.5, 3.5) * size, random(0.5, 3.5) * size, random(0.5, 3.5) * size }
            model:generate("joint", { joint = "J" .. k, dip = dip, dip_direction = way, origin = origin })
            if random(0, 1) < 0.3 then
                origin[3] = origin[3] + 10 ^ random(-3, -1) * size
                model:generate("joint", { joint = "J" .. k, dip = math.max(0, math.min(90, dip + random(-2, 2))), dip_direction = way, origin = origin })
            end
        end
    end
    model:blocks { where = function(b) return b.centroid[3] < size end }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 35 })
    model:damping "local"
    model:timestep { fraction = 0.5 }
    return model
end

-- Remarks go to standard error, so another process has them made: it says the step of each model after what there is to say of it.
if ... ~= "slivers" then
    for seed = 1, tonumber(arg[1]) do
        local model = slivers.rock(seed)
        model:cycle(1)
        io.stderr:write(("step %.17g\n"):format(model.dt))
    end
    return
end

local function gain(seed, remark, step)
    local told = tonumber(remark:match("makes? it (%S+) times smaller"))
    local share = tonumber(remark:match("such slivers, (%S+) %% of the rock"))
    local model = slivers.rock(seed)
    local whole, joined = model:blocks { fixed = false }:sum "volume", 0
    local found = assert(load("local model = ... return " .. remark:match "model:filter{[^}]*}"))(model)
    for _, sliver in ipairs(found.slivers) do
        joined = joined + (sliver.joined_to and not sliver.joined_to.fixed and sliver.volume or 0)
    end
    model:cycle(1)
    return { seed = seed, gain = model.dt / step, told = told, off = math.abs(100 * joined / whole / share - 1) }
end

function slivers.gains(models)
    local program = os.getenv("TALUS_PROGRAM") or arg[-1]
    local script = assert(package.searchpath("slivers", package.path))
    local pipe = assert(io.popen(("'%s' '%s' %d 2>&1"):format(program, script, models)))
    local out, seed, remark = {}, 1, nil
    for line in pipe:lines() do
        local step = tonumber(line:match "^step (.*)")
        remark = line:find("model:filter", 1, true) and line or remark
        if step and remark then
            out[#out + 1] = gain(seed, remark, step)
        end
        if step then
            seed, remark = seed + 1, nil
        end
    end
    assert(pipe:close() and seed == models + 1, "the models run")
    return out
end

return slivers
