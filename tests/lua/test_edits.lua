-- Edits of a model: that they reach no farther than their neighbours, for any number of threads, and many at once.
local talus = require "talus"
local check = require "check"

local LAW = { kn = 1e8, ks = 5e7, friction = 30 }

-- A heap of cut rock on a plate, at x.
local function heap(model, x, joint)
    model:generate("box", { min = { x - 1, -1, -1 }, max = { x + 4, 4, 0 }, density = 2500, group = "plate" .. joint })
    local plate = model:blocks { group = "plate" .. joint }
    plate:fix():hide()
    model:generate("box", { min = { x, 0, 0 }, max = { x + 3, 3, 2 }, density = 2500, group = "rock" .. joint })
    for i, set in ipairs { { 70, 40 }, { 60, 170 }, { 10, 300 } } do
        model:generate("joint", { joint = joint .. i, dip = set[1], dip_direction = set[2], origin = { x + 1.6, 1.4, 0.9 }, radius = 5 })
        model:generate("joint", { joint = joint .. i, dip = set[1], dip_direction = set[2], origin = { x + 0.8, 0.6, 1.7 }, radius = 5 })
    end
end

local function scene(options)
    local model = talus.model(options or {})
    heap(model, 0, "A")
    heap(model, 20, "B")
    model:joint("*", "coulomb", LAW)
    model:damping "local"
    model:timestep { dt = 2e-4 } -- or else a body of one heap makes the step of both
    model:cycle(30)
    return model
end

local function nth(model, group, n)
    local blocks = model:blocks { group = group }
    return blocks[1 + n % #blocks]
end

local function only(model, ...)
    local ids = {}
    for _, block in ipairs { ... } do
        ids[block.id] = true
    end
    return model:blocks { hidden = "any", where = function(block) return ids[block.id] end }
end

-- What can be done to heap B, one after the other.
local EDITS = {
    { "delete", function(model) model:blocks { id = nth(model, "rockB", 5).id }:delete() end },
    { "join", function(model)
        local block = nth(model, "rockB", 3)
        only(model, block, block.neighbours[1]):join()
    end },
    { "cut", function(model)
        model:generate("joint", { joint = "late", dip = 40, dip_direction = 20, origin = nth(model, "rockB", 7).centroid,
            radius = 0.05 })
    end },
    { "hide", function(model) model:blocks { id = nth(model, "rockB", 2).id }:hide() end },
    { "show", function(model) model:blocks { hidden = true }:show() end },
    { "unjoin", function(model) model:blocks { group = "rockB" }:unjoin() end },
    { "box", function(model)
        model:generate("box", { min = { 20, 0, 3 + model.time }, max = { 21, 1, 4 + model.time }, density = 2500,
            group = "rockB" })
    end },
    { "a joint's property", function(model) model:joint("B1", "coulomb", { kn = 1e8, ks = 5e7, friction = 20 }) end },
    { "contact_area", function(model) model:contact_area { fraction = 1e-4, joint = "B2" } end },
    { "delete of a joined block", function(model)
        local pair = only(model, nth(model, "rockB", 1), nth(model, "rockB", 1).neighbours[1])
        pair:join()
        model:blocks { id = pair[1].id }:delete()
    end },
}

-- Where heap A is, how it moves and what it carries, to the last bit.
local function state(model)
    local words = {}
    local function add(...)
        for _, number in ipairs { ... } do
            words[#words + 1] = string.format("%a", number)
        end
    end
    for _, block in ipairs(model:blocks { group = "rockA" }) do
        add(table.unpack(block.displacement))
        add(table.unpack(block.velocity))
    end
    for _, contact in ipairs(model:contacts()) do
        if contact.blocks[1].group:match "A$" then
            add(contact.normal_force, contact.area, table.unpack(contact.shear_force))
        end
    end
    return table.concat(words, " ")
end

-- ---------------------------------------------------------------- far from an edit nothing changes

for _, reuse in ipairs { true, false } do
    local left, edited = scene { reuse_geometry = reuse }, scene { reuse_geometry = reuse }
    check.equal(state(edited), state(left))
    for _, edit in ipairs(EDITS) do
        edit[2](edited)
        left:cycle(7)
        edited:cycle(7)
        check.holds(state(edited) == state(left), edit[1] .. " changes a heap that it does not touch")
    end
end

-- A law set as it is changes nothing, of contacts that go on by what they know, too.
do
    local left, set = scene(), scene()
    left:cycle(200)
    set:cycle(200)
    set:joint("*", { friction = 30 })
    left:cycle(20)
    set:cycle(20)
    check.equal(state(set), state(left))
end

-- ---------------------------------------------------------------- any number of threads

do
    local hashes = {}
    for threads = 1, 3 do
        local model, found = scene { threads = threads }, {}
        model:timestep { rule = "body", fraction = 0.4 }
        model:mass_scaling(true)
        for i, edit in ipairs(EDITS) do
            edit[2](model)
            if i % 2 == 0 then
                model:cycle(5)
            end
            found[i] = model:state_hash()
        end
        hashes[threads] = table.concat(found, " ")
    end
    check.equal(hashes[2], hashes[1])
    check.equal(hashes[3], hashes[1])
end

-- ---------------------------------------------------------------- rows that have gone

do
    local model = scene()
    local blocks = model:blocks { group = "rockB" }
    local first, last, count = blocks[1], blocks[#blocks], #model:blocks { hidden = "any" }
    local neighbours = #last.neighbours
    local id = first.id
    model:blocks { id = id }:delete()
    check.equal(#model:blocks { id = id }, 0)
    check.raises(function() return first.volume end, "no longer exists")
    check.equal(last.group, "rockB")
    check.holds(#last.neighbours <= neighbours, "a deleted block is no neighbour")
    check.equal(#model:blocks { hidden = "any" }, count - 1)
    check.raises(function() blocks:delete() end, "no longer exists")
    check.equal(#model:blocks { hidden = "any" }, count - 1)
    -- one after the other, with new ones in between
    for _, block in ipairs(model:blocks { group = "rockB" }) do
        model:blocks { id = block.id }:delete()
        local made = model:generate("box", { min = { 40, 0, 0 }, max = { 41, 1, 1 }, density = 2500, group = "made" })
        check.equal(made.after, made.before + 1)
        model:blocks { group = "made" }:delete()
    end
    check.equal(#model:blocks { group = "rockB" }, 0)
    model:cycle(3)
    check.holds(#model:contacts() > 0, "the other heap has contacts")
    for _, contact in ipairs(model:contacts()) do
        check.holds(contact.blocks[1].group:match "A$", "only the other heap has contacts")
    end
end

-- The report of a generator is that of all blocks, though it does not look at all of them again.
do
    local model = talus.model {}
    local function box(x, size)
        return model:generate("box", { min = { x, 0, 0 }, max = { x + size, size, size }, density = 2500 })
    end
    check.near(box(0, 2).smallest_volume, 8, 1e-12)
    check.near(box(4, 1).smallest_edge, 1, 1e-12)
    check.near(box(8, 3).smallest_face, 1, 1e-12)
    model:blocks { id = 2 }:delete()
    local summary = box(12, 5)
    check.near({ summary.smallest_volume, summary.smallest_edge, summary.smallest_face }, { 8, 2, 4 }, 1e-12)
    check.equal(summary.before, 2)
    check.equal(summary.after, 3)
    local cut = model:generate("joint", { joint = "J", dip = 0, dip_direction = 0, origin = { 12, 0, 4 }, radius = 1 })
    check.equal(cut.cuts, 1)
    check.near(cut.smallest_edge, 1, 1e-12)
    check.near(cut.volume_error, 0, 1e-14)
    model:blocks():delete()
    check.near(box(0, 7).smallest_volume, 343, 1e-10)
end

-- ---------------------------------------------------------------- many at once

do
    local function boxes(model)
        local list = {}
        for i = 1, 5 do
            list[i] = { min = { 2 * i, 0, 0 }, max = { 2 * i + 1, 1, 1 }, density = 2000 + i, group = "g" .. i }
        end
        return list
    end
    local one, all = talus.model {}, talus.model {}
    for _, box in ipairs(boxes(one)) do
        one:generate("box", box)
    end
    local summary = all:generate("box", boxes(all))
    check.equal(summary.before, 0)
    check.equal(summary.after, 5)
    check.equal(all:state_hash(), one:state_hash())

    -- joints in one go cut what those before have left
    local joints = {}
    for i = 1, 4 do
        joints[i] = { joint = "J" .. i, dip = 20 * i, dip_direction = 30 * i, origin = { 4.5, 0.5, 0.5 } }
    end
    for _, joint in ipairs(joints) do
        one:generate("joint", joint)
    end
    summary = all:generate("joint", joints)
    check.equal(summary.before, 5)
    check.equal(#all:blocks(), #one:blocks())
    check.near(all:blocks():sum "volume", one:blocks():sum "volume", 1e-12)

    local function bad(list, part)
        check.refused(all, function() all:generate("box", list) end, part)
    end
    local good = { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000, group = "good" }
    bad({ good, good, { min = { 0, 0, 0 }, max = { -1, 1, 1 }, density = 2000 } }, "entry 3: max.x = -1")
    bad({ good, { mim = { 0, 0, 0 } } }, "entry 2: unknown parameter 'mim'")
    bad({ good, 7 }, "entry 2: the parameters must be a table, not the number 7")
    bad({ good, { 1, 2 } }, "entry 2: parameters are given by name")
    bad({ good, min = { 0, 0, 0 } }, "not both")
    -- nothing of a list is passed over in silence
    local keys = ": the keys of a list are 1, 2, 3 and so on, without gaps"
    bad({ [0] = good, good }, "the list of parameter tables has the key 0" .. keys)
    bad({ good, [1.5] = good, [true] = good }, "the list of parameter tables has the key 1.5" .. keys)
    bad({ good, [3] = good }, "the list of parameter tables has the key 3" .. keys)
    bad({ min = { 0, 0, 0, [0] = 1 }, max = { 1, 1, 1 }, density = 2000 }, "min must be a list of 3 numbers {x, y, z}, not a table with the key 0")
    bad({ min = { x = 0, y = 0, z = 0 }, max = { 1, 1, 1 }, density = 2000 }, "a table with the key 'x'" .. keys)
    check.refused(all, function()
        all:generate("polyhedron", { vertices = { { 0, 0, 0 }, { 1, 0, 0, [0] = 3 }, { 0, 1, 0 }, { 0, 0, 1 } }, density = 2000 })
    end, "a list whose row 2 has the key 0" .. keys)
    check.refused(all, function() all:blocks { id = { [0] = 1, 2 } } end, "the list of ids has the key 0" .. keys)
    check.equal(#all:blocks { group = "good" }, 0)
end
