-- asking.lua - rock that is cut, joined, parted, held, let go, deleted, scaled and run in any order, and asked in between.
--
--     asking.compare(seed)   nil where the model comes to the same bits as one that is never asked; or what was asked for
local talus = require "talus"

local asking = {}
local ACTS = 25
local SIDE = 4 -- m
local DENSITY, KN, G = 2000, 1e8, 10

-- Numbers below n, from a seed.
local function chance(seed)
    local state = seed * 7919 + 13
    return function(n)
        state = (state * 1103515245 + 12345) % 2147483648
        return (state >> 8) % n
    end
end

local function plane(draw, joint)
    local function real(most) return most * draw(100000) / 100000 end
    return { joint = joint, dip = real(90), dip_direction = real(360), origin = { real(SIDE), real(SIDE), real(SIDE) } }
end

local function build(draw)
    local model = talus.model { gravity = { 3, 0, -G }, reuse_geometry = draw(4) > 0 }
    model:generate("box", { min = { 0, 0, 0 }, max = { SIDE, SIDE, SIDE }, density = DENSITY })
    for _ = 1, 2 + draw(3) do
        model:generate("joint", plane(draw, "J" .. draw(2)))
    end
    model:blocks { where = function(block) return block.centroid[3] < SIDE / 4 end }:fix()
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 30 })
    model:damping(draw(2) == 0 and "local" or "none")
    return model
end

local function some_blocks(draw, model)
    local all, ids = model:blocks(), {}
    for i = 1, 1 + draw(4) do
        ids[i] = all[1 + draw(#all)].id
    end
    return model:blocks { id = ids }
end

local acts = {
    function(draw, model) some_blocks(draw, model):join() end,
    function(draw, model) some_blocks(draw, model):join() end,
    function(draw, model) some_blocks(draw, model):unjoin() end,
    function(draw, model) some_blocks(draw, model):unjoin() end,
    function(draw, model) model:generate("joint", plane(draw, "K")) end,
    function(draw, model)
        local chosen = some_blocks(draw, model)
        if draw(3) == 0 and #model:blocks() > 8 then
            chosen:delete()
        end
    end,
    function(draw, model)
        local chosen = some_blocks(draw, model)
        chosen[draw(2) == 0 and "fix" or "free"](chosen)
    end,
    function(draw, model) model:joint("*", { friction = 20 + draw(20), kn = draw(3) == 0 and 2 * KN or KN }) end,
    function(draw, model) model:contact_area { fraction = draw(3) / 100 } end,
    function(draw, model) model:mass_scaling(draw(2) == 0) end,
    function(draw, model) model:cycle(1 + draw(60)) end,
}

local looks = {
    function(model) return #model:contacts() end,
    function(model) return model.dt end,
    function(model) return model:energy() end,
    function(model) return model:state_hash() end,
    function() end,
}

-- `look(act)` tells how to look after an act.
local function work(seed, look)
    local draw = chance(seed)
    local model = build(draw)
    for act = 1, ACTS do
        pcall(acts[1 + draw(#acts)], draw, model) -- a cycle that fails, or what is refused, changes nothing
        looks[look(act)](model)
    end
    pcall(model.cycle, model, 50)
    return model:state_hash()
end

function asking.compare(seed)
    local plain, pick = work(seed, function() return #looks end), chance(seed + 1000)
    if work(seed, function() return 1 end) ~= plain then
        return "contacts, after every act"
    elseif work(seed, function() return 1 + pick(#looks) end) ~= plain then
        return "now and then something"
    end
end

return asking
