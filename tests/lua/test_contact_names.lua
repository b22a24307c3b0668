-- A contact is known by its blocks and by when it began: whoever has asked for it, after edits, from the first step on, in copies and in what
-- is restored. Once it has ended its handle raises, also when its blocks have met again.
local check = require "check"
local talus = require "talus"

local path = os.getenv "TALUS_TEST_TMP" .. "/contact_names.talus"

local function ids(model)
    local out = {}
    for _, contact in ipairs(model:contacts()) do
        local a, b = contact.blocks[1].id, contact.blocks[2].id
        check.equal(contact.id, a << 32 | b)
        out[#out + 1] = ("%d-%d %d"):format(a, b, contact.born)
    end
    table.sort(out)
    return table.concat(out, " ")
end

local function cut(model, k)
    model:generate("joint", { joint = "J" .. k, dip = 13 * k, dip_direction = 50 * k, origin = { 1 + 0.2 * k, 1.5, 1 } })
end

-- What is done to all models alike; asking is part of it.
local function go_on(model, k, steps)
    local told = { ids(model) }
    cut(model, k)
    told[2] = ids(model)
    model:cycle(steps)
    told[3] = ids(model)
    model:blocks { id = model:blocks()[#model:blocks()].id }:delete()
    cut(model, k + 1)
    told[4] = ids(model)
    cut(model, k + 2)
    told[5] = ids(model)
    return table.concat(told, "\n")
end

for _, steps in ipairs { 0, 1, 40 } do
    local function build()
        local model = talus.model { gravity = { 0, 0, -10 } }
        model:generate("box", { min = { 0, 0, 0 }, max = { 3, 3, 2 }, density = 2500 })
        cut(model, 0)
        model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
        cut(model, 1)
        model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }:fix()
        ids(model)
        cut(model, 2)
        if steps > 0 then
            model:cycle(steps)
        end
        cut(model, 3)
        ids(model)
        return model
    end
    local model = build()
    model:save(path)
    local copy, restored = model:copy(), talus.restore(path, { threads = 2 })
    local told = go_on(model, 4, 3)
    check.equal(go_on(copy, 4, 3), told)
    check.equal(go_on(restored, 4, 3), told)
end

-- A contact that is asked for twice between two steps has one name, whatever has been cut elsewhere in between.
do
    local model = talus.model { gravity = { 0, 0, -10 } }
    for k = 0, 2 do
        model:generate("box", { min = { 3 * k, 0, 0 }, max = { 3 * k + 1, 1, 1 }, density = 2500 })
        model:generate("box", { min = { 3 * k, 0, 1 }, max = { 3 * k + 1, 1, 2 }, density = 2500 })
    end
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    model:cycle(2)
    model:blocks { id = 6 }:delete()
    model:generate("box", { min = { 6, 0, 1 }, max = { 7, 1, 2 }, density = 2500 })
    local first = ids(model)
    model:generate("box", { min = { 0, 0, 2 }, max = { 1, 1, 3 }, density = 2500 })
    check.holds(ids(model):find(first:match "5%-7 %d+", 1, true), "the name that was told is still the contact's")
end

-- Before the first step, too: what is joined elsewhere leaves a contact its name and its history, whoever has asked in between.
do
    local function told(look)
        local model = talus.model {}
        for x = 0, 3 do
            model:generate("box", { min = { 2 * x, 0, 0 }, max = { 2 * x + 2, 2, 2 }, density = 2500 })
        end
        model:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
        model:history { name = "n", of = model:contacts()[2], field = "normal_force", every = 1 }
        model:blocks { id = { 1, 2 } }:join()
        look(model)
        model:cycle(2)
        return ids(model) .. " " .. table.concat(model:histories().n.value, " ")
    end
    local plain = told(function() end)
    check.equal(told(ids), plain)
    check.equal(told(function(model) model:copy() end), plain)
    check.equal(told(function(model) model:save(path) end), plain)
end

-- Contacts that were asked for before the first step follow another rule as soon as it is set.
do
    local model = talus.model {}
    for z = 0, 1 do
        model:generate("box", { min = { 0, 0, z }, max = { 1, 1, z + 1 }, density = 2500 })
    end
    model:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
    local all = #model:contacts()[1].points
    model.contact_points = "corners"
    local corners = #model:contacts()[1].points
    check.holds(corners < all, "points at corners are fewer")
    check.equal(#model:copy():contacts()[1].points, corners)
end

-- Counts of contacts are those of the last step, whoever has asked for contacts since.
do
    local model = talus.model { gravity = { 5, 0, -10 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 3, 3, 2 }, density = 2500 })
    cut(model, 0)
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 10 })
    model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }:fix()
    model:cycle(30)
    local function count(m, name)
        m:history { name = name, every = 1, value = "slipping" }
        return m:histories()[name].value[1]
    end
    local before = count(model, "before")
    cut(model, 1)
    local copy = model:copy()
    ids(copy)
    check.equal(count(copy, "after"), before)
    check.equal(count(model, "after"), before)
end

-- A handle ends with its contact; a selection keeps to the contacts it has found.
do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2500 })
    model:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2500 })
    model:generate("box", { min = { 1, 0, 0 }, max = { 2, 1, 1 }, density = 2500 })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:cycle(3)
    local all = model:contacts { between = { model:blocks { id = 1 }, model:blocks { id = 2 } } }
    local old = all[1]
    check.equal(old.born, 0)
    check.equal(tostring(old), "contact " .. (1 << 32 | 2))
    check.equal(all:values("id")[1], 1 << 32 | 2)
    check.equal(math.type(all:values("id")[1]), "integer")
    local upper = model:blocks { id = 2 }
    upper:set { velocity = { 0, 0, 10 } }
    model:cycle(400)
    check.equal(#model:contacts { between = { model:blocks { id = 1 }, upper } }, 0)
    check.raises(function() return old.area end, "contact of blocks 1 and 2 no longer exists: its blocks have parted")
    upper:set { velocity = { 0, 0, -10 } }
    for _ = 1, 5000 do
        model:cycle(1)
        if #model:contacts { between = { model:blocks { id = 1 }, upper } } > 0 then
            break
        end
    end
    local new = model:contacts { between = { model:blocks { id = 1 }, upper } }[1]
    check.equal(new.id, 1 << 32 | 2)
    check.holds(new ~= old and new.born > 400, "another contact of the same blocks")
    check.raises(function() return old.area end,
        "its blocks have parted, or were one body, and have met again after cycle " .. new.born)
    check.raises(function() return all:values("area") end, "no longer exists")
    check.raises(function() return all:sum("area") end, "no longer exists")
    model:save(path)
    for _, other in ipairs { model:copy(), talus.restore(path, { threads = 1 }) } do
        check.equal(other:contacts { between = { other:blocks { id = 1 }, other:blocks { id = 2 } } }[1].born, new.born)
    end
    model:blocks { id = { 1, 2 } }:join()
    check.raises(function() return new.area end, "contact of blocks 1 and 2 no longer exists: its blocks were joined into one body")
    model:blocks { id = 2 }:delete()
    check.raises(function() return new.area end, "contact of blocks 1 and 2 no longer exists: block 2 was cut or deleted")
    model:blocks { id = 1 }:delete()
    check.raises(function() return new.area end, "contact of blocks 1 and 2 no longer exists: its blocks were cut or deleted")
end

-- Blocks that slide off each other and stay at that: their contact has ended for all who ask, and begins anew when they meet again.
do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, -1 }, max = { 2, 2, 0 }, density = 2500 })
    model:blocks():fix()
    model:generate("box", { min = { 1.9, 0.5, 0 }, max = { 2.9, 1.5, 1 }, density = 2500 })
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 30 })
    model:timestep { dt = 1e-4 }
    model:cycle(1)
    local all, mover = model:contacts(), model:blocks { id = 2 }
    local old = all[1]
    model:history { name = "gap", of = old, field = "gap", every = 1 }
    mover:drive { velocity = { 8, 0, 0 } }
    for _ = 1, 300 do
        model:cycle(1)
        if #model:contacts() == 0 then
            break
        end
        check.equal(old.born, 0)
    end
    mover:drive { velocity = { 0, 0, 0 } }
    model:cycle(20)
    check.equal(#model:contacts(), 0)
    local parted = "contact of blocks 1 and 2 no longer exists: its blocks have parted"
    check.raises(function() return old.gap end, parted)
    check.raises(function() return #old.points end, parted)
    check.raises(function() return all:max "gap" end, parted)
    for _, gap in ipairs(model:histories().gap.value) do
        check.holds(gap ~= math.huge, "no gap without end is written")
    end
    mover:drive { velocity = { -8, 0, 0 } }
    local met
    for _ = 1, 300 do
        local before = model.cycles
        model:cycle(1)
        if #model:contacts() > 0 then
            met = before
            break
        end
    end
    check.equal(model:contacts()[1].born, met)
    check.raises(function() return old.gap end, "have met again after cycle " .. met)
    check.equal(model:copy():contacts()[1].born, met)
end
