-- drawn_slope.lua - a rock slope whose three joint sets are drawn anew in each realisation, and what is asked of it.
--
-- The slope is that of scripts/examples/slope.lua: 60 m long, 40 m wide and 28 m high, with a face of 76 degrees over a foot of
-- 12 degrees. The first realisation of seed 1 has 184 blocks. Rock under the foot and behind the face's rear is held.
local talus = require "talus"

local drawn = {}

local LENGTH, WIDTH, HEIGHT = 60, 40, 28 -- m
local TOE, REAR = { 20, 20, 10 }, { 50, 20, 10 }
local FACE, FOOT = { dip = 76, dip_direction = 270 }, { dip = 12, dip_direction = 270 }
local SETS = { { dip = 70, dip_direction = 200, spacing = 5.2 }, { dip = 60, dip_direction = 330, spacing = 5.3 },
    { dip = 24, dip_direction = 265, spacing = 4.6 } } -- means of each set; m
local SCATTER, DEVIATION = 200, 0.2 -- Fisher's concentration; deviation of spacings over their mean
local REACH = 45                    -- m, what a set's planes cover to be everywhere in the slope
local DENSITY, GRAVITY, STIFFNESS = 2000, 10, 1e9 -- kg/m3, m/s2, Pa/m

drawn.friction = { 35, 3 } -- degrees, mean and deviation of all joints
drawn.smallest = 1         -- m3: smaller blocks do not count

local function at(plane, origin)
    return { dip = plane.dip, dip_direction = plane.dip_direction, origin = origin }
end

local function cut(model, name, plane, origin)
    local joint = at(plane, origin)
    joint.joint = name
    model:generate("joint", joint)
    return at(plane, origin)
end

-- The slope without its sets; what is held is hidden, so that no set cuts it.
local function bare(model)
    model:generate("box", { min = { 0, 0, 0 }, max = { LENGTH, WIDTH, HEIGHT }, density = DENSITY })
    local face, foot = cut(model, "face", FACE, TOE), cut(model, "foot", FOOT, TOE)
    local above = {}
    for _, block in ipairs(model:blocks { above = foot }) do
        above[block.id] = true
    end
    model:blocks { above = face, where = function(block) return above[block.id] end }:delete()
    model:blocks { below = foot }:fix():hide()
    local rear = cut(model, "rear", FACE, REAR)
    model:blocks { below = rear, hidden = false }:fix():hide()
end

function drawn.build(draw)
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, seed = draw.seed "joints" }
    bare(model)
    for i, set in ipairs(SETS) do
        local spacing = draw.lognormal("spacing " .. i, set.spacing, DEVIATION * set.spacing)
        model:generate("jointset", { joint = "J" .. i, dip = set.dip, dip_direction = set.dip_direction,
            distribution = "fisher", fisher_k = SCATTER, spacing = spacing, spacing_dev = DEVIATION * spacing,
            number = math.ceil(REACH / spacing), origin = { LENGTH / 2, WIDTH / 2, (TOE[3] + HEIGHT) / 2 } })
    end
    model:blocks { hidden = true }:show()
    return model
end

-- The same between rock: what lies at the sides and the rear is held, so that only the face is free.
function drawn.build_held(draw)
    local model = drawn.build(draw)
    model:boundary { xmax = "fixed", ymin = "fixed", ymax = "fixed", zmin = "fixed" }
    return model
end

function drawn.friction_of(draw)
    return draw.normal("friction", drawn.friction[1], drawn.friction[2], { min = 20, max = 50 })
end

-- The least factor of safety of what can be removed, and the volume of all below 1.
function drawn.keyblocks(model, friction)
    local least, volume, first = 10, 0, nil
    for _, key in ipairs(model:keyblocks { friction = friction }) do
        if key.volume >= drawn.smallest then
            if key.safety < least then
                least, first = key.safety, key
            end
            volume = volume + (key.safety < 1 and key.volume or 0)
        end
    end
    return least, volume, first
end

-- Gives the joints their law, as the measure of a run needs it.
function drawn.strengthen(model, friction)
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = friction })
end

return drawn
