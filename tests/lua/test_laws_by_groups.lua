-- Laws for contacts between groups and selections, of random models.
--
-- Layers of rock that are cut by beds and vertical joints are in groups, so that "bed:2" is all that lies between two groups. A law for
-- the one and for the other does the same to the bit. Which of many random laws rules a contact follows from one sentence, whatever the
-- order of lines, after cuts, changes of groups, saving and copying.
local check = require "check"
local every_law = require "every_law"
local layers = require "layers"
local shapes = require "shapes"
local talus = require "talus"

local KN, PRESSURE = 1e9, 1e5
local LAWS = every_law(KN, PRESSURE)
local NAMED = {} -- a law of each kind, by its name
for _, one in ipairs(LAWS) do
    NAMED[one.law] = NAMED[one.law] or one.params
end
local KINDS = {}
for name in pairs(NAMED) do
    KINDS[#KINDS + 1] = name
end
table.sort(KINDS)

local function whole(random, from, to)
    return math.floor(random(from, to + 1))
end

local different = 0
for number = 1, check.cases(60) do
    local wrong, differs = layers.differing(number)
    check.holds(#wrong == 0, string.format("model %d: by %s as by planes", number, wrong[1]))
    different = different + (differs and 1 or 0)
end
check.holds(different > 0.5 * check.cases(60), "the laws of beds make a difference")

-- ------------------------------------------------------------------ which law rules ------------------------------------------------------

-- "3 7": the ids of the two blocks of a contact, ascending.
local function pair_of(contact)
    local a, b = contact.blocks[1].id, contact.blocks[2].id
    return math.min(a, b) .. " " .. math.max(a, b)
end

local GROUPS = { "stone", "support", "soil" }

local function heap(number)
    local random = shapes.random(1000 + number)
    local model = talus.model { seed = number }
    model:generate("box", { min = { 0, 0, 0 }, max = { 3, 3, 2 }, density = 2500 })
    for k = 1, whole(random, 2, 4) do
        model:generate("joint", { joint = k % 2 == 1 and "A" or "B", dip = random(0, 90), dip_direction = random(0, 360),
            origin = { random(0.8, 2.2), random(0.8, 2.2), random(0.6, 1.4) } })
    end
    for _, block in ipairs(model:blocks()) do
        model:blocks { where = function(other) return other.id == block.id end }:set { group = GROUPS[whole(random, 1, 3)] }
    end
    return model, random
end

local function some_blocks(model, random)
    local chosen, first = {}, true
    local selection = model:blocks { where = function(block)
        chosen[block.id] = first or random(0, 1) < 0.4 or nil
        first = false
        return chosen[block.id]
    end }
    return selection, function(block) return chosen[block] end
end

local function some_side(model, random)
    if random(0, 1) < 0.5 then
        local names = {}
        for _, group in ipairs(model:groups()) do
            names[#names + 1] = group.name
        end
        local group = names[whole(random, 1, #names)]
        return group, function(_, of) return of == group end, group
    end
    return some_blocks(model, random)
end

-- A random law of which the sentence tells what it covers: which, how many blocks it names, the joint, and a test of a pair.
local function some_scope(model, random)
    local joint = ({ nil, nil, "A", "B", "A:1" })[whole(random, 1, 5)]
    local form = whole(random, 1, 5)
    local scope = { joint = joint, names = 0, kind = KINDS[whole(random, 1, #KINDS)] }
    if form == 1 then
        scope.which = joint or "*"
        scope.covers = function() return true end
    elseif form == 2 then
        local side, has, group = some_side(model, random)
        scope.which = group and { joint = joint, group = group } or { joint = joint, blocks = side }
        scope.names = 1
        scope.covers = function(a, ga, b, gb) return has(a, ga) or has(b, gb) end
    elseif form == 3 then
        local chosen, first = {}, true
        local contacts = model:contacts { where = function(contact)
            local is = first or random(0, 1) < 0.4
            first = false
            chosen[pair_of(contact)] = is or nil
            return is
        end }
        scope.which = { joint = joint, contacts = contacts }
        scope.names = 2
        scope.covers = function(a, _, b) return chosen[math.min(a, b) .. " " .. math.max(a, b)] end
    else
        local one, has_one = some_side(model, random)
        local other, has_other = some_side(model, random)
        scope.which = { joint = joint, between = { one, other } }
        scope.names = 2
        scope.covers = function(a, ga, b, gb)
            return has_one(a, ga) and has_other(b, gb) or has_one(b, gb) and has_other(a, ga)
        end
    end
    return scope
end

local function closeness(scope)
    return not scope.joint and 0 or scope.joint:find ":" and 2 or 1
end

-- The law of a contact by the sentence; `origin` maps ids of parts to what they were cut of.
local function ruling(scopes, contact, origin)
    local joint = contact.joint
    local best
    for order, scope in ipairs(scopes) do
        local one, other = contact.blocks[1], contact.blocks[2]
        local a, b = origin[one.id] or one.id, origin[other.id] or other.id
        local covers = (not scope.joint or scope.joint == joint or scope.joint == joint:match "^(.*):") and
            (scope.names == 0 or scope.covers(a, one.group, b, other.group))
        if covers then
            local rank = scope.names * 3 + closeness(scope)
            if not best or rank > best.rank or rank == best.rank and order >= best.order then
                best = { rank = rank, order = order, kind = scope.kind }
            end
        end
    end
    return best.kind
end

local function agree(model, scopes, origin, what)
    local n = 0
    for _, contact in ipairs(model:contacts()) do
        n = n + 1
        check.holds(contact.law == ruling(scopes, contact, origin),
            string.format("%s: contact %d of %d and %d on %s has '%s' and not '%s'", what, n, contact.blocks[1].id, contact.blocks[2].id, contact.joint,
                contact.law, ruling(scopes, contact, origin)))
    end
    check.holds(n > 0, what .. ": contacts")
end

-- After a cut the parts of a block do as it did; contacts between them were none of those chosen.
local function cut(model, random)
    local before, origin = {}, {}
    for _, block in ipairs(model:blocks()) do
        before[#before + 1] = { id = block.id, block = model:blocks { where = function(one) return one.id == block.id end } }
    end
    local chosen = before[whole(random, 1, #before)]
    model:blocks():hide()
    chosen.block:show()
    local c = chosen.block[1].centroid
    local known = {}
    for _, block in ipairs(model:blocks()) do
        known[block.id] = true
    end
    model:generate("joint", { joint = "C", dip = random(0, 90), dip_direction = random(0, 360), origin = { c[1], c[2], c[3] } })
    for _, block in ipairs(model:blocks()) do
        if not known[block.id] then
            origin[block.id] = chosen.id
        end
    end
    model:blocks():show()
    return origin
end

for number = 1, check.cases(100) do
    local model, random = heap(number)
    if #model:contacts() > 0 then
        local scopes = {}
        for k = 1, 8 do
            local scope = k == 1 and { which = "*", names = 0, kind = "coulomb" } or some_scope(model, random)
            local set, message = pcall(function() model:joint(scope.which, scope.kind, NAMED[scope.kind]) end)
            check.holds(set or message:find "unknown joint 'B'" or message:find "the selection is empty", message)
            if set then
                scopes[#scopes + 1] = scope
            end
        end
        local name = "heap " .. number
        agree(model, scopes, {}, name)
        model:cycle(2)
        agree(model, scopes, {}, name .. ", after steps")

        local file = os.tmpname()
        model:save(file)
        local again, copy = talus.restore(file), model:copy()
        os.remove(file)
        check.equal(again:state_hash(), model:state_hash())
        check.equal(copy:state_hash(), model:state_hash())
        for _, m in ipairs { model, again, copy } do
            m:cycle(3)
        end
        check.equal(again:state_hash(), model:state_hash())
        check.equal(copy:state_hash(), model:state_hash())

        local blocks = model:blocks()
        local one = blocks[whole(random, 1, #blocks)].id
        model:blocks { where = function(block) return block.id == one end }:set { group = GROUPS[whole(random, 1, 3)] }
        agree(model, scopes, {}, name .. ", another group")
        model:cycle(1)
        agree(model, scopes, {}, name .. ", another group, after a step")

        local origin = cut(model, random)
        agree(model, scopes, origin, name .. ", cut")
        model:cycle(1)
        agree(model, scopes, origin, name .. ", cut, after a step")
        local hash = model:state_hash()
        local restored
        file = os.tmpname()
        model:save(file)
        restored = talus.restore(file)
        os.remove(file)
        check.equal(restored:state_hash(), hash)
    end
end

-- ------------------------------------------------------------------ what becomes of forces -----------------------------------------------

-- Piers on a floor, of which each gets a group and with it a law: forces stay, and so does what rests.
for number = 1, check.cases(20) do
    local random = shapes.random(3000 + number)
    local model = talus.model {}
    model:generate("box", { min = { 0, 0, -1 }, max = { 4, 1, 0 }, density = 2500, group = "floor" })
    for k = 0, 3 do
        model:generate("box", { min = { k, 0, 0 }, max = { k + 0.9, 1, random(0.5, 2) }, density = 2500, group = "pier" })
    end
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 40 })
    model:joint({ group = "pier" }, "coulomb", { kn = KN, ks = KN, friction = 40 })
    local one = model:blocks { group = "pier", where = function(block) return block.centroid[1] < 1 end }
    one:set { group = "marked" }
    local law = LAWS[whole(random, 1, #LAWS)]
    model:joint({ between = { "marked", "floor" } }, law.law, law.params)
    model:damping "local"
    model:solve { ratio = 1e-8, max_cycles = 20000 }
    local forces, ids = {}, {}
    for _, contact in ipairs(model:contacts()) do
        forces[contact.id] = contact.normal_force
        ids[#ids + 1] = contact.id
    end
    local before = {}
    for _, block in ipairs(model:blocks()) do
        before[block.id] = block.centroid[3]
    end
    model:blocks { group = "pier" }:set { group = "marked" }
    model:timestep { dt = model.dt * 1e-4 }
    model:cycle(1)
    for _, contact in ipairs(model:contacts()) do
        check.equal(contact.law, law.law)
        check.near(contact.normal_force, forces[contact.id], 1e-6 * forces[contact.id])
    end
    check.holds(#ids == 4, "four piers stand")
end

-- A gallery is cut out of a block that stands, and gets a group and with it a law by the same call: its contacts carry what they carry
-- where it gets no group.
for number = 1, check.cases(60) do
    local random = shapes.random(4000 + number)
    local model = talus.model { threads = whole(random, 1, 2) }
    model:generate("box", { { min = { 0, 0, -1 }, max = { 4, 1, 0 }, density = 2500, group = "floor" },
        { min = { 0, 0, 0 }, max = { 4, 1, random(2, 4) }, density = 2500, group = "rock" },
        { min = { 9, 0, 0 }, max = { 10, 1, 1 }, density = 2500, group = "gallery" } })
    model:blocks { where = function(block) return block.group ~= "rock" end }:fix()
    local first, second = LAWS[whole(random, 1, #LAWS)], LAWS[whole(random, 1, #LAWS)]
    model:joint("*", first.law, first.params)
    model:joint({ group = "gallery" }, second.law, second.params)
    model:damping "local"
    model:solve { ratio = 1e-8, max_cycles = 20000 }
    local function cut_out(m, group)
        m:blocks { group = "floor" }:hide()
        local a, b, h = random(0.5, 1), random(2, 3), random(0.5, 1.5)
        m:generate("tunnel", { face1 = { { a, -1, -1 }, { b, -1, -1 }, { b, -1, h }, { a, -1, h } },
            face2 = { { a, 2, -1 }, { b, 2, -1 }, { b, 2, h }, { a, 2, h } }, group = group })
        m:blocks { hidden = true }:show()
        m:timestep { dt = m.dt * 1e-4 }
        m:cycle(1)
        local list = {}
        for _, contact in ipairs(m:contacts { between = { m:blocks { group = "floor" }, m:blocks() } }) do
            list[#list + 1] = { contact.normal_force, contact.law }
        end
        return list
    end
    local reference = model:copy()
    local state = random
    local values = {}
    random = function(from, to) -- the same cut for both
        values[#values + 1] = state(from, to)
        return values[#values]
    end
    local now, at = cut_out(model, "gallery"), 0
    random = function()
        at = at + 1
        return values[at]
    end
    local before, weight, changed = cut_out(reference, "rock"), 0, 0
    check.holds(#now == #before and #now >= 3, "parts stand on the floor")
    for i = 1, #now do
        weight = math.max(weight, before[i][1])
    end
    for i = 1, #now do
        check.near(now[i][1], before[i][1], 1e-6 * weight)
        changed = changed + (now[i][2] == second.law and 1 or 0)
    end
    check.holds(changed >= 1, "the gallery has its law")
end

-- ------------------------------------------------------------------ what is told ---------------------------------------------------------

local model = heap(7)
local names = {}
for _, group in ipairs(model:groups()) do
    names[#names + 1] = group.name
end
check.holds(#names > 1, "groups")
model:joint("*", "coulomb", { kn = KN, ks = KN, friction = 30 })
model:joint({ between = { names[1], names[2] } }, "coulomb", { kn = KN, ks = KN, friction = 20 })
check.equal(#model:laws(), 2)
local turned = model:copy()
model:joint({ between = { names[2], names[1] } }, { friction = 21 }) -- the same
turned:joint({ between = { names[1], names[2] } }, { friction = 21 })
check.equal(turned:state_hash(), model:state_hash())
check.equal(#model:laws(), 2)
check.equal(model:laws()[2].parameters.friction, 21)
check.equal(model:laws()[2].between[1], names[2])
check.equal(model:laws()[2].joint, "*")
check.equal(#model:joints().scoped, 1)
model:joint({ joint = "A", between = { names[1], names[2] } }, { ks = 2 * KN }) -- begins with it
check.equal(model:laws()[3].parameters.friction, 21)
check.equal(model:laws()[3].joint, "A")
model:joint(model:blocks { group = names[1] }, { friction = 25 }) -- begins with that of "*"
check.equal(#model:laws()[4].blocks, #model:blocks { group = names[1] })
check.equal(model:laws()[4].parameters.ks, KN)
model:joint(model:contacts()[1], "elastic", { kn = KN, ks = KN })
check.equal(model:laws()[5].contacts, 1)
model:cycle(1)

local typo = names[1]:sub(1, -2)
check.refused(model, function() model:joint({ group = typo }, { friction = 12 }) end,
    "no block is in the group '" .. typo .. "'; did you mean '" .. names[1] .. "'")
check.refused(model, function() model:joint({ grup = names[1] }, { friction = 12 }) end, "did you mean 'group'")
check.refused(model, function() model:joint({}, { friction = 12 }) end, "give joint, between, group, blocks or contacts")
check.refused(model, function() model:joint({ group = names[1], blocks = model:blocks() }, { friction = 12 }) end,
    "of between, group, blocks and contacts give one")
check.refused(model, function() model:joint({ between = { names[1] } }, { friction = 12 }) end, "not a list of 1")
check.refused(model, function() model:joint({ between = { names[1], 3 } }, { friction = 12 }) end, "item 2 must be a group's name")
check.refused(model, function() model:joint(model:blocks { where = function() return false end }, { friction = 12 }) end,
    "the law is for no block: the selection is empty")
check.refused(model, function() model:joint(heap(8):blocks(), { friction = 12 }) end, "of another model")
check.refused(model, function() model:joint({ group = names[1] }, "coulom", { friction = 12 }) end, "did you mean 'coulomb'")
check.refused(model, function() model:joint({ group = names[1] }, { friction = 95 }) end,
    "contacts of group '" .. names[1] .. "', law 'coulomb': friction = 95 deg")
check.refused(model, function() model:joint({ group = names[1], joint = "J9" }, { friction = 12 }) end, "unknown joint 'J9'")

-- Blocks that are deleted, joined or hidden leave laws as they are; a group that no block is in any more is not refused by files.
model:blocks { group = names[2] }:set { group = "other" }
local file = os.tmpname()
model:save(file)
check.equal(talus.restore(file):state_hash(), model:state_hash())
os.remove(file)
model:blocks { group = names[1] }:delete()
model:cycle(1)
model:blocks():join()
model:cycle(1)
