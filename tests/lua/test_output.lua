-- Files of a frame: which ones, their series, and the same bytes on any number of threads.
local talus = require "talus"
local check = require "check"

local stem = string.format("%s/output_%s", assert(os.getenv("TALUS_TEST_TMP")),
    tostring({}):match("0x(%x+)") or "0")

local function content_of(path)
    local file = io.open(path, "rb")
    if file then
        local content = file:read("a")
        file:close()
        return content
    end
end

-- Rock of some thousand blocks, so that each list takes several pieces, some of it moving.
local function rock(threads)
    local model = talus.model { seed = 5, threads = threads }
    model:generate("box", { min = { 0, 0, 0 }, max = { 12, 12, 12 }, density = 2600, group = "rock" })
    for i, set in ipairs { { 60, 80 }, { 75, 200 }, { 15, 320 } } do
        model:generate("jointset", { joint = "J" .. i, dip = set[1], dip_dev = 4, dip_direction = set[2],
            dip_direction_dev = 5, spacing = 0.8, spacing_dev = 0.2, number = 20, origin = { 6, 6, 6 } })
    end
    model:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }:fix()
    model:joint("*", "coulomb", { kn = 1e9, ks = 1e9, friction = 30 })
    return model
end

-- ---------------------------------------------------------------- threads

local files = {}
for threads = 1, 3 do
    local model = rock(threads)
    check.holds(#model:blocks() > 2000, "many blocks")
    model:cycle(4)
    local prefix = stem .. "_t" .. threads
    model:write_vtk(prefix)
    model:write_blocks(prefix .. ".json")
    for _, name in ipairs { "_blocks_000000.vtk", "_contacts_000000.vtk", "_joints_000000.vtk", ".json" } do
        local content = content_of(prefix .. name)
        check.holds(#content > 300000, "a long file " .. name)
        files[name] = files[name] or content
        check.holds(content == files[name], threads .. " threads write the same " .. name)
    end
end

-- ---------------------------------------------------------------- parts

local model = talus.model { gravity = { 0, 0, 0 } }
model:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2600 })
model:generate("joint", { joint = "J", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
model:joint("*", "elastic", { kn = 1e8, ks = 1e8 })
model:blocks { id = model:blocks()[1].id }:fix()
model:timestep { dt = 0.5 }

-- The numbers and times of the frames that a series lists.
local function listed(prefix, part)
    local list = {}
    for number, time in (content_of(prefix .. "_" .. part .. ".vtk.series") or ""):gmatch(
        '"name": "[^"]*_' .. part .. '_(%d+)%.vtk", "time": ([^}]+)}') do
        list[#list + 1] = string.format("%d@%g", tonumber(number), tonumber(time))
    end
    return table.concat(list, " ")
end

local prefix = stem .. "_parts"
local PARTS = { "blocks", "contacts", "joints" }
local wanted, contents = { blocks = {}, contacts = {}, joints = {} }, {}
for frame = 0, 59 do
    -- contacts now and then, joints once, blocks nearly always
    local parts = { contacts = frame % 7 == 0, joints = frame == 3, blocks = frame % 14 ~= 7 }
    model:write_vtk(prefix, parts)
    for _, part in ipairs(PARTS) do
        local path = string.format("%s_%s_%06d.vtk", prefix, part, frame)
        if parts[part] then
            table.insert(wanted[part], string.format("%d@%g", frame, 0.5 * frame))
            contents[path] = content_of(path)
        end
        check.equal(content_of(path) ~= nil, parts[part])
        check.equal(listed(prefix, part), table.concat(wanted[part], " "))
    end
    model:cycle(1)
end
for path, content in pairs(contents) do
    check.holds(content_of(path) == content, path .. " is as it was written")
end
model:write_vtk(prefix) -- all parts
for _, part in ipairs(PARTS) do
    table.insert(wanted[part], "60@30")
    check.equal(listed(prefix, part), table.concat(wanted[part], " "))
end

-- A frame of some files has the same ones as a whole frame.
model:write_vtk(stem .. "_whole")
model:write_vtk(stem .. "_one", { joints = true, blocks = false, contacts = false })
check.holds(content_of(stem .. "_one_joints_000000.vtk") == content_of(stem .. "_whole_joints_000000.vtk"),
    "the same file of the joints")
check.equal(content_of(stem .. "_one_blocks_000000.vtk"), nil)

-- ---------------------------------------------------------------- stages

-- Frames without a step between them are listed at times of their own; the file has the model's.
local stages = stem .. "_stages"
for _, dip in ipairs { 30, 50, 70 } do
    model:write_vtk(stages)
    model:generate("joint", { joint = "S", dip = dip, dip_direction = 0, origin = { 1, 0.5, 0.5 } })
end
model:cycle(1)
model:write_vtk(stages)
local times = {}
for time in content_of(stages .. "_blocks.vtk.series"):gmatch '"time": ([^}]+)}' do
    times[#times + 1] = tonumber(time)
end
check.equal(#times, 4)
for i = 2, 4 do
    check.holds(times[i] > times[i - 1], "times of frames ascend")
    check.near(times[i], i < 4 and times[1] or model.time, 1e-6)
    local number = content_of(("%s_blocks_%06d.vtk"):format(stages, i - 1)):match "TIME 1 1 double\n(........)"
    check.equal((string.unpack(">d", number)), i < 4 and times[1] or model.time)
end

-- ---------------------------------------------------------------- joints

-- A block slides on another: the joint tells it once, and the faces that it has left stand for themselves.
local slide = talus.model { gravity = { 5, 0, -10 } }
slide:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 2 }, density = 2500 })
slide:generate("joint", { joint = "J", dip = 0, dip_direction = 0, origin = { 0, 0, 1 } })
slide:generate("joint", { joint = "K", dip = 90, dip_direction = 90, origin = { 0.5, 0, 0 } })
slide:joint("*", "coulomb", { kn = 1e10, ks = 1e10, friction = 10 }) -- stiff, so that it stays flush
slide:blocks { above = { dip = 90, dip_direction = 90, origin = { 0.5, 0, 0 } } }:delete()
slide:blocks { below = { dip = 0, dip_direction = 0, origin = { 0, 0, 1 } } }:fix()
slide:solve { max_time = 0.1, ratio = 0 }
slide:write_vtk(stem .. "_slide", { blocks = false, contacts = false })
local text = content_of(stem .. "_slide_joints_000000.vtk")
local polygons = tonumber(text:match "POLYGONS (%d+)")
check.equal(polygons, 3) -- the contact, and one face of K on either block
local function cells(name, form)
    local at = select(2, text:find("\n" .. name .. " %d+ %d+ %a+\n")) or
        select(2, text:find("SCALARS " .. name .. " int 1\nLOOKUP_TABLE default\n", 1, true))
    return { string.unpack(">" .. form:rep(polygons), text, at + 1) }
end
local contact = slide:contacts()[1]
local slip = contact.shear_displacement
check.near(slip[1], slide:blocks()[2].displacement[1], 5e-5) -- that of the centroid, half a metre higher
check.near(slip[3], 0, 1e-4 * slip[1]) -- along the contact, which has turned a little with the block
check.holds(slip[1] > 0.01, "it slides")
check.equal(table.concat(cells("joint", "i4"), " ", 1, 3), "1 2 2")
check.equal(table.concat(cells("state", "i4"), " ", 1, 3), "1 4 4")
check.equal(table.concat(cells("block_b", "i4"), " ", 1, 3), contact.blocks[2].id .. " 0 0")
check.near(cells("slip", "f")[1], math.sqrt(slip[1] ^ 2 + slip[2] ^ 2 + slip[3] ^ 2), 1e-8) -- in single precision
check.near(cells("normal_stress", "f")[1], contact.normal_stress, 1e-7 * contact.normal_stress)
check.near(cells("area", "f")[2], 1, 1e-7)

-- Where a law keeps a slip of its own, the joints show that one: it grows whichever way the block moves. Where a law keeps none, how far the
-- block has moved.
slide:joint("J", "slip_weakening", { kn = 1e10, ks = 1e10, friction = 10, distance = 1e-3 })
slide:solve { max_time = 0.005, ratio = 0 }
slide:blocks():reset_displacement()
slide:solve { max_time = 0.001, ratio = 0 }
slide:write_vtk(stem .. "_slip", { blocks = false, contacts = false })
text = content_of(stem .. "_slip_joints_000000.vtk")
polygons = tonumber(text:match "POLYGONS (%d+)")
contact = slide:contacts()[1]
local kept, moved = contact.states.slip, contact.shear_displacement
check.holds(kept > 2 * math.sqrt(moved[1] ^ 2 + moved[2] ^ 2 + moved[3] ^ 2), "the law's slip is not the motion")
check.near(cells("slip", "f")[1], kept, 1e-7 * kept)
check.near(cells("law_slip", "f")[1], kept, 1e-7 * kept)
check.equal(cells("slip", "f")[2], 0)
check.holds(cells("law_slip", "f")[2] ~= cells("law_slip", "f")[2], "a face without contact has no state")
check.equal(select(2, text:gsub("\nslip %d+ %d+ %a+\n", "")), 1)

-- ---------------------------------------------------------------- fields of a script

-- Numbers of blocks and of contacts, by the name of a field and by functions.
slide:write_vtk(stem .. "_fields", {
    block_fields = { "kinetic_energy", height = function(b) return b.id == 4 and b.centroid[3] or nil end },
    contact_fields = { twice = function(c) return 2 * c.area end },
})
local function numbers(part, name, count)
    local content = content_of(stem .. "_fields_" .. part .. "_000000.vtk")
    local at = select(2, content:find("\n" .. name .. " 1 " .. count .. " %a+\n"))
    check.holds(at, "an array " .. name .. " of the " .. part)
    return { string.unpack((part == "joints" and ">ddd" or ">dd"):sub(1, count + 1), content, at + 1) }
end
local height = numbers("blocks", "height", 2)
check.near(height[1], slide:blocks()[1].centroid[3], 1e-12)
check.holds(height[2] ~= height[2], "no number is NaN")
check.near(numbers("blocks", "kinetic_energy", 2)[2], slide:blocks()[2].kinetic_energy, 1e-9)
check.near(numbers("contacts", "twice", 1)[1], 2 * contact.area, 1e-12)
check.near(numbers("joints", "twice", 3)[1], 2 * contact.area, 1e-12)
check.holds(numbers("joints", "twice", 3)[2] ~= numbers("joints", "twice", 3)[2], "none without a contact")
for _, case in ipairs {
    { { block_fields = { volume = "mass" } }, "the file has an array 'volume' already" },
    { { contact_fields = { opening = "gap" } }, "the file has an array 'opening' already" },
    { { block_fields = { f = function() return {} end } }, "it must give a number or nil, not" },
    { { block_fields = { "nothing" } }, "nothing" },
    { { block_fields = 3 }, "must be a table" },
    { { blockfields = {} }, "block_fields" },
} do
    check.refused(slide, function() slide:write_vtk(stem .. "_refused", case[1]) end, case[2])
end
check.equal(content_of(stem .. "_refused_blocks_000000.vtk"), nil)

-- ---------------------------------------------------------------- mistakes

check.refused(model, function() model:write_vtk(prefix, { contact = false }) end, "did you mean 'contacts'?")
check.refused(model, function() model:write_vtk(prefix, { joints = 0 }) end, "joints must be true or false")
check.refused(model, function() model:write_vtk(prefix, "blocks") end, "must be a table")
check.refused(model, function() model:write_vtk(prefix, { blocks = false, contacts = false, joints = false }) end,
    "nothing to write")
check.refused(model, function() model:write_vtk(prefix, {}, 1) end, "too many")
check.equal(content_of(prefix .. "_blocks_000061.vtk"), nil)
