-- Pages for a browser: what a frame may be asked for, mistakes, and how a page goes on. tests/python/test_scene.py reads what is in
-- a page.
local talus = require "talus"
local check = require "check"

local stem = string.format("%s/page_%s", assert(os.getenv("TALUS_TEST_TMP")), tostring({}):match("0x(%x+)") or "0")

local function content_of(path)
    local file = io.open(path, "rb")
    if file then
        local content = file:read("a")
        file:close()
        return content
    end
end

-- Cycles of the frames of a page, "0 10 20".
local function cycles_of(prefix)
    local cycles = {}
    for number, cycle in assert(content_of(prefix .. ".html")):gmatch('data%-frame="(%d+)"[^>]* data%-cycle="(%d+)"') do
        check.equal(tonumber(number), #cycles)
        cycles[#cycles + 1] = cycle
    end
    return table.concat(cycles, " ")
end

-- A tower on a floor.
local function tower(threads)
    local model = talus.model { threads = threads }
    model:generate("box", { min = { 0, 0, -1 }, max = { 4, 4, 0 }, density = 2600, group = "floor" })
    for i = 1, 4 do
        model:generate("box", { min = { 1 + i / 8, 1, i - 1 }, max = { 2 + i / 8, 2, i }, density = 2600 })
    end
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 10 })
    model:damping("local")
    model:blocks { group = "floor" }:fix()
    return model
end

-- ---------------------------------------------------------------- a model stays as it is

local hashes, pages = {}, {}
for threads = 1, 3 do
    local model = tower(threads)
    local prefix = stem .. "_t" .. threads
    for i = 1, 5 do
        model:cycle(10)
        if threads > 1 then -- the first model writes nothing
            model:write_html(prefix, { title = "tower", contacts = i % 2 == 0, keyblocks = { friction = 10 },
                block_fields = { "speed", twice = function(block) return 2 * block.volume end },
                contact_fields = { "area", depth = function(contact) return -contact.gap end } })
        end
    end
    hashes[threads], pages[threads] = model:state_hash(), threads > 1 and content_of(prefix .. ".html")
    check.equal(hashes[threads], hashes[1])
end
check.holds(pages[2] == pages[3], "the same page on any number of threads")
check.equal(cycles_of(stem .. "_t2"), "10 20 30 40 50")

-- ---------------------------------------------------------------- mistakes

local model = tower(1)
local prefix = stem .. "_mistakes"
check.refused(model, function() model:write_html() end, "the prefix must be a string")
check.refused(model, function() model:write_html("") end, "must end in a name for the page")
check.refused(model, function() model:write_html(stem .. "/") end, "must end in a name for the page")
check.refused(model, function() model:write_html(prefix, { contact = true }) end, "did you mean 'contacts'?")
check.refused(model, function() model:write_html(prefix, { titel = "a" }) end, "did you mean 'title'?")
check.refused(model, function() model:write_html(prefix, { title = 3 }) end, "title must be")
check.refused(model, function() model:write_html(prefix, { contacts = "all" }) end, "contacts must be true, false or \"slipping\", not")
check.refused(model, function() model:write_html(prefix, { contacts = 1 }) end, "contacts must be true, false or \"slipping\"")
check.refused(model, function() model:write_html(prefix, "blocks") end, "must be a table")
check.refused(model, function() model:write_html(prefix, {}, 1) end, "too many")
check.refused(model, function() model:write_html(prefix, { keyblocks = true }) end, "keyblocks: the parameters must be a table")
check.refused(model, function() model:write_html(prefix, { keyblocks = { frictoin = 3 } }) end, "did you mean 'friction'?")
check.refused(model, function() model:write_html(prefix, { block_fields = "speed" }) end, "block_fields must be a table")
check.refused(model, function() model:write_html(prefix, { block_fields = { "sped" } }) end, "did you mean 'speed'?")
check.refused(model, function() model:write_html(prefix, { block_fields = { a = "velocity" } }) end,
    "the field 'velocity' of a block has 3 numbers; give a function(block) that returns one")
check.refused(model, function() model:write_html(prefix, { block_fields = { "group" } }) end, "group")
check.refused(model, function() model:write_html(prefix, { block_fields = { "speed", speed = "volume" } }) end, "'speed' is there twice")
check.refused(model, function() model:write_html(prefix, { block_fields = { a = 3 } }) end,
    "'a' must be the name of a field, a table by ids or a function(block), not")
check.refused(model, function() model:write_html(prefix, { block_fields = { 3 } }) end, "item 1 must be the name of a field")
check.refused(model, function() model:write_html(prefix, { block_fields = { [true] = "speed" } }) end, "a field is named by a text")
for _, name in ipairs { "a b", "1a", "_a", "", "a\0b", ("a"):rep(64), "<b>" } do
    check.refused(model, function() model:write_html(prefix, { block_fields = { [name] = "speed" } }) end, "is no name for a field")
end
check.refused(model, function() model:write_html(prefix, { contact_fields = { "are" } }) end, "did you mean 'area'?")
check.refused(model, function() model:write_html(prefix, { contact_fields = { a = function() return "x" end } }) end,
    "contact_fields: 'a': it must give a number or nil, not")
check.refused(model, function() model:write_html("/proc/nowhere/run") end, "/proc/nowhere/run.html")

-- What goes wrong in a function is told at the line of the call and at its own, and the model may be changed again.
for _, act in ipairs {
    { function() error("no such thing") end, "no such thing" },
    { function(block) return block.no_such_field end, "no_such_field" },
    { function() error({}) end, "table" },
    { function() model:cycle(1) end, "cannot be called from a function" },
    { function() model:blocks():fix() end, "from the function of a history or of a field" },
    { function() model:generate("box", { min = { 9, 9, 9 }, max = { 10, 10, 10 }, density = 1 }) end, "while the model is running" },
} do
    local before = model:state_hash()
    local good, message = pcall(function() model:write_html(prefix, { block_fields = { bad = act[1] } }) end)
    check.equal(good, false)
    check.holds(message:match("^[^:]*test_page.lua:%d+: write_html: block_fields: 'bad': "), message)
    check.holds(message:find(act[2], 1, true), message)
    check.equal(model:state_hash(), before)
    model:blocks { group = "floor" }:fix()
end
check.equal(content_of(prefix .. ".html"), nil)

-- ---------------------------------------------------------------- how a page goes on

local file = stem .. ".talus"
local run = stem .. "_run"
for _ = 1, 2 do
    model:cycle(10)
    model:write_html(run)
end
model:save(file)
local saved = content_of(run .. ".html")
for _ = 1, 3 do
    model:cycle(5)
    model:write_html(run)
end
check.equal(cycles_of(run), "10 20 25 30 35")

-- A restored model cuts off what came after it was saved, and goes on.
local again = talus.restore(file)
again:cycle(7)
again:write_html(run)
check.equal(cycles_of(run), "10 20 27")
again:cycle(1)
again:write_html(run)
check.equal(cycles_of(run), "10 20 27 28")
local whole = content_of(run .. ".html")
check.equal(whole:sub(1, #saved - 8), saved:sub(1, -9)) -- but for what ends the file
-- The model that the page was taken from begins it anew.
model:write_html(run)
check.equal(cycles_of(run), "35")

-- So does one whose page is not the one that it was.
again = talus.restore(file)
again:write_html(run)
check.equal(cycles_of(run), "20")
os.remove(run .. ".html")
again:write_html(run)
check.equal(cycles_of(run), "20")

-- A copy has no pages yet.
again:write_html(run)
check.equal(cycles_of(run), "20 20")
again:copy():write_html(run)
check.equal(cycles_of(run), "20")

-- The title is that of the page, and the name of the file where none is given.
model:write_html(stem .. "_title")
check.holds(content_of(stem .. "_title.html"):find("<title>" .. stem:match("[^/]*$") .. "_title</title>", 1, true), "a title")
os.remove(stem .. "_title.html")
model:write_html(stem .. "_title", { title = "a < b & c > d </title><script>" })
check.holds(content_of(stem .. "_title.html"):find("<title>a &lt; b &amp; c &gt; d &lt;/title&gt;&lt;script&gt;</title>", 1, true), "a title")

-- The ending may be given: it is the same page. A file whose whole name it would be keeps it.
model:write_html(stem .. "_ending.html")
model:write_html(stem .. "_ending")
check.equal(select(2, cycles_of(stem .. "_ending"):gsub("%d+", "")), 2)
check.holds(not io.open(stem .. "_ending.html.html"), "no second ending")
check.holds(content_of(stem .. "_ending.html"):find("_ending</title>", 1, true), "the title has no ending")
os.remove(stem .. "_ending.html")
model:write_vtk(stem .. "_ending.vtk", { contacts = false, joints = false })
check.holds(os.remove(stem .. "_ending_blocks_000000.vtk") and os.remove(stem .. "_ending_blocks.vtk.series"), "as without it")

for _, name in ipairs { "_t2.html", "_t3.html", ".talus", "_run.html", "_title.html" } do
    os.remove(stem .. name)
end
