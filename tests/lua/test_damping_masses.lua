-- Dampings of others get the masses that the step uses. One that takes half of the motion in a step by them does so under
-- either kind of mass scaling; by the bodies' own masses it takes another share.
-- program only
local talus = require "talus"
local check = require "check"

-- The program runs this file once more with the plugin.
if not arg[1] then
    for threads = 1, 2 do
        local pipe = io.popen(string.format("'%s' --quiet --threads %d --plugin '%s/halving.so' '%s' inside 2>&1",
            os.getenv "TALUS_PROGRAM", threads, os.getenv "TALUS_BAD_PLUGIN_DIR", arg[0]))
        local text = pipe:read "a"
        check.holds(pipe:close(), text)
    end
    return
end

local SPEED = 1e-6 -- m/s: contacts stay as they are
local SCALINGS = { { name = "own masses" }, { name = "mass scaling", true }, { name = "partial", { dt = 2e-3, most = 1e4 } } }

-- Blocks of several sizes on a fixed one, and one in the air: what a step leaves of velocity and angular velocity, for each.
local function kept(rotation, scaling, own)
    local m = talus.model { gravity = { 0, 0, -10 }, rotation = rotation }
    m:generate("box", { min = { 0, 0, -1 }, max = { 40, 2, 0 }, density = 2500 })
    m:blocks():fix()
    for i = 1, 35 do -- more than a batch
        local edge = 0.1 + 0.7 * (i * 7 % 35) / 35
        m:generate("box", { min = { i, 0.5, 0 }, max = { i + edge, 0.5 + edge, edge }, density = 2500, group = "cube" })
    end
    m:generate("box", { min = { 37, 0.5, 0 }, max = { 37.5, 1, 0.1 }, density = 2500, group = "plate" })
    m:generate("box", { min = { 38, 0.5, 5 }, max = { 39, 1.5, 6 }, density = 2500, group = "cube" })
    m:joint("*", "elastic", { kn = 1e8, ks = 5e7 })
    m:damping("halving", { own = own })
    m:timestep { dt = 1e-5 }
    if scaling then
        m:mass_scaling(scaling)
    end
    m:cycle(2)
    for _, block in ipairs(m:blocks():free()) do
        m:blocks { id = block.id }:set { velocity = { SPEED, 2 * SPEED, 3 * SPEED }, angular_velocity = { 0, -SPEED, 2 * SPEED } }
    end
    m:cycle(1)
    local shares = {}
    for _, block in ipairs(m:blocks():free()) do
        local turned = rotation == "paper" or block.group == "cube" -- a plate has three moments, of which this is the mean
        for k = 1, 3 do
            table.insert(shares, block.velocity[k] / (k * SPEED))
            if turned and k > 1 then
                table.insert(shares, block.angular_velocity[k] / ((3 * k - 7) * SPEED))
            end
        end
    end
    return shares
end

for _, rotation in ipairs { "exact", "paper" } do
    for _, scaling in ipairs(SCALINGS) do
        local name = rotation .. ", " .. scaling.name
        local shares = kept(rotation, scaling[1], false)
        check.holds(#shares >= 37 * 5 - 2, name)
        for i, share in ipairs(shares) do
            check.holds(math.abs(share - 0.5) < 1e-9, ("%s, %d: %.17g"):format(name, i, share))
        end
        local most = 0
        for _, share in ipairs(kept(rotation, scaling[1], true)) do
            most = math.max(most, math.abs(share - 0.5))
        end
        if scaling[1] then
            check.holds(most > 0.05, ("%s: own masses leave half, but for %g"):format(name, most))
        elseif rotation == "exact" then
            check.near(most, 0, 1e-9)
        end
    end
end
